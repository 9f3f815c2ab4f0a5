//! Pictures as PNG.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::PictureOptions;
use super::camera::{Camera, Frame};
use super::letters::{Canvas, Placed};
use super::raster::Raster;
use super::scene::Scene;

pub(super) use ::png::EncodingError;

/// Samples along the side of a pixel, of a picture of some size.
fn fine(size: usize) -> usize {
    match size {
        0..=2500 => 3,
        2501..=6000 => 2,
        _ => 1,
    }
}

/// Writes a picture with its legend.
pub(super) fn picture(scene: &Scene, camera: &Camera, options: &PictureOptions, out: &mut dyn Write) -> io::Result<()> {
    let frame = Frame::new(scene, camera, options.size);
    let placed = Placed::new(&scene.legend, frame.width, options.size, None);
    let mut canvas = Canvas::new(frame.width.max(placed.width), frame.height + placed.height);
    let left = (canvas.width - frame.width) / 2;
    canvas.paste(&Raster::new(&frame, fine(options.size)).pixels(), frame.width, left);
    placed.draw(frame.height, &mut canvas);
    encode(canvas.width, canvas.height, &canvas.pixels, out).map_err(io::Error::from)
}

fn encode(width: usize, height: usize, pixels: &[u8], out: impl Write) -> Result<(), EncodingError> {
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let mut encoder = ::png::Encoder::new(out, side(width), side(height));
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()
}

/// Pixels as an address that pages and SVG take for that of an image.
pub(super) fn data_uri(width: usize, height: usize, pixels: &[u8]) -> Result<String, EncodingError> {
    let mut file = Vec::new();
    encode(width, height, pixels, &mut file)?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(file)))
}
