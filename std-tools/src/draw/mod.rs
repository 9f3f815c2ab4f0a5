//! Pictures: a [`Scene`] of faces, lines and dots, as SVG or as PNG.
//!
//! A scene is made of a complex ([`complex`]), of a front of a multi-resolution complex
//! ([`Drawing`](crate::mcc::Drawing)), or by hand. A complex without coordinates gets some from [`layout`](mod@layout). One rasteriser finds what is
//! seen, for both formats: a parallel projection, the nearer shape hides the farther one. [`arrays`] draws the arrays of a
//! tiny complex instead.
//!
//! The same scene gives the same bytes, by any number of threads.
//!
//! ```
//! use sig_tools::draw::{Camera, Face, PictureOptions, Scene};
//!
//! let face = Face { corners: [0, 1, 2], colour: [0, 114, 178], group: 0, is_mark: false };
//! let scene = Scene {
//!     points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
//!     faces: vec![face],
//!     ..Scene::default()
//! };
//! let (svg, is_raster) = scene.to_svg(&Camera::default(), &PictureOptions::default())?;
//! assert!(svg.contains("<path") && !is_raster);
//! # Ok::<(), std::io::Error>(())
//! ```

pub mod arrays;
mod camera;
pub mod colour;
pub mod complex;
mod generators;
pub mod layout;
mod letters;
mod png;
mod raster;
mod scene;
mod svg;

pub use camera::{Axis, Camera};
pub use generators::{GeneratorsError, read_generators};
pub use scene::{Dot, Entry, Face, Legend, Line, Scene, Swatch, grouped};
pub use svg::escaped;

use std::io::{self, Write};

/// How a picture is drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PictureOptions {
    /// The longer side of what is drawn, in pixels, without the legend.
    pub size: usize,
    /// The most faces that SVG has as paths; of more it has an image of pixels.
    pub max_faces: usize,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self { size: 1000, max_faces: 50_000 }
    }
}

impl Scene {
    /// The picture as SVG, and whether the faces are in it as an image of pixels, because too many are seen.
    ///
    /// # Errors
    /// Those of the encoder of the image.
    pub fn to_svg(&self, camera: &Camera, options: &PictureOptions) -> io::Result<(String, bool)> {
        svg::picture(self, camera, options).map_err(io::Error::from)
    }

    /// Writes the picture as PNG, in 8 bits of red, green and blue.
    ///
    /// Cost: the samples that faces cover, nine a pixel for pictures of up to 2500 pixels; in parallel. Memory: 24 bytes a
    /// vertex of the scene, and bands of 32 rows of samples of 16 bytes.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_png(&self, camera: &Camera, options: &PictureOptions, out: &mut dyn Write) -> io::Result<()> {
        png::picture(self, camera, options, out)
    }

    /// Of each face, line and dot, in that order, whether a sample shows it, of which `fine` are along the side of a pixel.
    #[must_use]
    pub fn visible(&self, camera: &Camera, size: usize, fine: usize) -> Vec<bool> {
        raster::Raster::new(&camera::Frame::new(self, camera, size), fine.max(1)).visible()
    }
}
