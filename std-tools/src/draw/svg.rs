//! Pictures as SVG: the faces of which a pixel is seen, the farthest first. What is hidden is not written, so that a file has
//! no more than what one looks at, and nothing is drawn over what is nearer but within a few pixels.

use std::fmt::{self, Write as _};

use hashbrown::HashMap;

use super::camera::{Camera, Frame};
use super::colour::{INK, Rgb, hex, lit};
use super::letters::Placed;
use super::raster::{Raster, SHINE};
use super::scene::{Scene, Swatch};
use super::{PictureOptions, png};

/// Samples along the side of a pixel that decide what is seen.
const FINE: usize = 3;

/// The width of a letter of the fixed-pitch fonts that browsers have, 14 pixels high.
const LETTER: usize = 9;

/// A picture in SVG, and whether its faces are in it as an image of pixels, for there are too many.
pub(super) fn picture(
    scene: &Scene,
    camera: &Camera,
    options: &PictureOptions,
) -> Result<(String, bool), png::EncodingError> {
    let frame = Frame::new(scene, camera, options.size);
    // A legend does not grow with the picture, for that is scaled to the page.
    let placed = Placed::new(&scene.legend, frame.width, 1000, Some(LETTER));
    let (width, height) = (frame.width.max(placed.width), frame.height + placed.height);
    let left = (width - frame.width) / 2;
    let mut svg = begin(width, height);
    let visible = if scene.faces.len() > HOPELESS { Vec::new() } else { Raster::new(&frame, FINE).visible() };
    let faces = visible.iter().take(scene.faces.len()).filter(|&&seen| seen).count();
    let is_raster = visible.is_empty() && !scene.is_empty() || faces > options.max_faces;
    if left > 0 {
        let _ = writeln!(svg, r#"<g transform="translate({left})">"#);
    }
    if is_raster {
        let image = png::data_uri(frame.width * 2, frame.height * 2, &doubled(scene, camera, options))?;
        let _ = writeln!(svg, r#"<image width="{}" height="{}" href="{image}"/>"#, frame.width, frame.height);
    } else {
        let _ = shapes(&frame, &visible, &mut svg);
    }
    if left > 0 {
        svg.push_str("</g>\n");
    }
    let _ = legend(&placed, frame.height, &mut svg);
    svg.push_str("</svg>\n");
    Ok((svg, is_raster))
}

/// So many faces that those of which a pixel is seen are too many, whatever is asked for.
const HOPELESS: usize = 20_000_000;

/// The pixels of a picture twice as large: it may be looked at closely.
fn doubled(scene: &Scene, camera: &Camera, options: &PictureOptions) -> Vec<u8> {
    let frame = Frame::new(scene, camera, options.size);
    let points = frame.points.iter().map(|point| point.map(|value| value * 2.0)).collect();
    let frame = Frame {
        points,
        width: frame.width * 2,
        height: frame.height * 2,
        unit: frame.unit * 2.0,
        outline: frame.outline * 2.0,
        ..frame
    };
    Raster::new(&frame, 2).pixels()
}

/// The first line of a file, and a white page.
pub(super) fn begin(width: usize, height: usize) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    )
}

/// Text with what XML reserves written otherwise, and without the characters that it forbids.
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' => escaped.push(' '),
            '\0'..' ' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// The shapes that are seen, the farthest first; then the marks that are hidden and shine through, then those that are not.
fn shapes(frame: &Frame<'_>, visible: &[bool], svg: &mut String) -> fmt::Result {
    let scene = frame.scene;
    let (faces, lines) = (scene.faces.len(), scene.lines.len());
    let depth = |corner: u32| frame.points[corner as usize][2];
    let mut seen: Vec<(f64, usize)> = (0..scene.len())
        .filter(|&shape| visible[shape])
        .map(|shape| {
            let depth = match shape {
                face if face < faces => scene.faces[face].corners.map(depth).iter().sum::<f64>() / 3.0,
                // Over the faces at both of its ends.
                line if line < faces + lines => {
                    let line = scene.lines[line - faces];
                    line.ends.map(depth).into_iter().fold(f64::NEG_INFINITY, f64::max) + 2.0 * line.radius * frame.unit
                }
                dot => {
                    let dot = scene.dots[dot - faces - lines];
                    depth(dot.at) + 4.0 * dot.radius * frame.unit
                }
            };
            (depth, shape)
        })
        .collect();
    seen.sort_by(|(a, i), (b, j)| a.total_cmp(b).then(i.cmp(j)));
    let mut layer = |opacity: &str, shapes: &mut dyn Iterator<Item = usize>| {
        writeln!(svg, r#"<g stroke-linejoin="round" stroke-linecap="round"{opacity}>"#)?;
        for shape in shapes {
            write_shape(frame, shape, svg)?;
        }
        if scene.groups && opacity.is_empty() {
            borders(frame, visible, svg)?;
        }
        writeln!(svg, "</g>")
    };
    let is_mark = |shape: &usize| scene.is_mark(*shape);
    layer("", &mut seen.iter().map(|&(_, shape)| shape).filter(|shape| !is_mark(shape)))?;
    if (0..scene.len()).any(|shape| is_mark(&shape)) {
        layer(
            &format!(r#" opacity="{SHINE}""#),
            &mut (0..scene.len()).filter(|shape| is_mark(shape) && !visible[*shape]),
        )?;
        layer(r#" opacity="1""#, &mut seen.iter().map(|&(_, shape)| shape).filter(is_mark))?;
    }
    Ok(())
}

fn write_shape(frame: &Frame<'_>, shape: usize, svg: &mut String) -> fmt::Result {
    let scene = frame.scene;
    if let Some(face) = scene.faces.get(shape) {
        let colour = lit(face.colour, frame.light(face.corners));
        // Without a line around it there would be gaps between it and its neighbours.
        let (line, width) =
            if frame.outline > 0.0 { (lit(colour, 0.55), 2.0 * frame.outline) } else { (colour, 0.4 * frame.unit) };
        let [a, b, c] = frame.triangle(face.corners).map(|[x, y, _]| format!("{x:.1},{y:.1}"));
        let (colour, line) = (hex(colour), hex(line));
        return writeln!(svg, r#"<path d="M{a} {b} {c}z" fill="{colour}" stroke="{line}" stroke-width="{width:.2}"/>"#);
    }
    let shape = shape - scene.faces.len();
    if let Some(line) = scene.lines.get(shape) {
        return write_line(frame, line.ends, line.colour, line.radius * frame.unit, svg);
    }
    let dot = scene.dots[shape - scene.lines.len()];
    let ([x, y, _], radius, colour) = (frame.points[dot.at as usize], dot.radius * frame.unit, hex(dot.colour));
    writeln!(svg, r#"<circle cx="{x:.1}" cy="{y:.1}" r="{radius:.2}" fill="{colour}"/>"#)
}

fn write_line(frame: &Frame<'_>, ends: [u32; 2], colour: Rgb, radius: f64, svg: &mut String) -> fmt::Result {
    let [a, b] = ends.map(|end| frame.points[end as usize]).map(|[x, y, _]| format!("{x:.1},{y:.1}"));
    let (colour, width) = (hex(colour), 2.0 * radius);
    writeln!(svg, r#"<path d="M{a} {b}" fill="none" stroke="{colour}" stroke-width="{width:.2}"/>"#)
}

/// Lines between faces of different groups that are both seen.
fn borders(frame: &Frame<'_>, visible: &[bool], svg: &mut String) -> fmt::Result {
    let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
    for (face, _) in frame.scene.faces.iter().zip(visible).filter(|&(_, &seen)| seen) {
        let [a, b, c] = face.corners;
        for [a, b] in [[a, b], [b, c], [c, a]] {
            let ends = [a.min(b), a.max(b)];
            match sides.get(&ends) {
                Some(&group) if group != face.group => {
                    write_line(frame, ends, lit(face.colour, 0.25), 0.5 * frame.unit, svg)?;
                }
                Some(_) => {}
                None => {
                    sides.insert(ends, face.group);
                }
            }
        }
    }
    Ok(())
}

/// The legend, below a row.
fn legend(placed: &Placed<'_>, top: usize, svg: &mut String) -> fmt::Result {
    if placed.height == 0 {
        return Ok(());
    }
    let (line, size) = (placed.line(), 14);
    writeln!(svg, r#"<g font-family="monospace" font-size="{size}" fill="{}">"#, hex(INK))?;
    let text = |x: usize, y: usize, text: &str, svg: &mut String| {
        writeln!(svg, r#"<text x="{x}" y="{}">{}</text>"#, y + line * 2 / 3, escaped(text))
    };
    if !placed.title().is_empty() {
        text(line / 2, top, placed.title(), svg)?;
    }
    for (entry, (x, y)) in placed.entries() {
        let (y, colour, radius) = (top + y, hex(entry.colour), line as f64 * 0.3);
        let (middle, row) = (x as f64 + line as f64 * 0.4, y as f64 + line as f64 * 0.5);
        let rect = |wide: f64, high: f64, svg: &mut String| {
            let (x, y) = (middle - wide, row - high);
            let (width, height) = (2.0 * wide, 2.0 * high);
            writeln!(svg, r#"<rect x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" fill="{colour}"/>"#)
        };
        match entry.swatch {
            Swatch::Face => rect(radius, radius, svg)?,
            Swatch::Line => rect(radius * 1.2, radius * 0.3, svg)?,
            Swatch::Dot => {
                writeln!(svg, r#"<circle cx="{middle:.1}" cy="{row:.1}" r="{radius:.1}" fill="{colour}"/>"#)?;
            }
            Swatch::None => {}
        }
        text(x + if entry.swatch == Swatch::None { 0 } else { line }, y, &entry.text, svg)?;
    }
    svg.push_str("</g>\n");
    Ok(())
}
