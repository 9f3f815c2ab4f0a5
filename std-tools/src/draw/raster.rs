//! From faces, lines and dots to samples: which is nearest where. Rows are cut into bands, which are drawn in parallel, each
//! with a depth for each of its samples, so that memory stays that of a few bands, whatever the size of the picture.
//!
//! A face covers a sample that lies in it or on its border, so that there are no gaps; of two at the same depth the first one
//! is seen. Lines and dots are as thick in the picture as they are told, and lie a little before the faces that they are on.

use std::ops::Range;

use rayon::prelude::*;

use super::camera::Frame;
use super::colour::{Rgb, lit, mixed};
use crate::build::narrow;

/// No shape.
const NONE: u32 = u32::MAX;
/// Marks a sample that shows the border of a face.
const BORDER: u32 = 1 << 31;
/// The rows of a band, in pixels.
const BAND: usize = 32;
/// How much is seen of a mark through what hides it.
pub(super) const SHINE: f64 = 0.45;

/// What a sample shows.
#[derive(Clone, Copy)]
struct Sample {
    depth: f64,
    /// The number of the shape: faces, then lines, then dots; a face's with [`BORDER`] near its border.
    shape: u32,
    /// The least of the marks that are hidden.
    hidden: u32,
}

const EMPTY: Sample = Sample { depth: f64::NEG_INFINITY, shape: NONE, hidden: NONE };

/// A frame with all that drawing its bands needs.
pub(super) struct Raster<'f, 's> {
    frame: &'f Frame<'s>,
    /// Samples along the side of a pixel.
    fine: usize,
    /// Samples from one pixel to the next that decide about lines between groups.
    reach: usize,
    /// The shapes that may be seen in each band.
    bands: Vec<Vec<u32>>,
    /// Of each shape, whether it is a mark.
    marks: Vec<bool>,
}

impl<'f, 's> Raster<'f, 's> {
    pub(super) fn new(frame: &'f Frame<'s>, fine: usize) -> Self {
        let shapes = frame.scene.len();
        let mut raster = Self {
            frame,
            fine,
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few pixels")]
            reach: ((frame.unit * fine as f64).round() as usize).max(1),
            bands: vec![Vec::new(); frame.height.div_ceil(BAND)],
            marks: (0..shapes).map(|shape| frame.scene.is_mark(shape)).collect(),
        };
        for shape in 0..shapes {
            let Some(rows) = raster.rows_of(shape) else { continue };
            for band in rows {
                raster.bands[band].push(narrow(shape));
            }
        }
        raster
    }

    /// The bands in which a shape may be seen.
    fn rows_of(&self, shape: usize) -> Option<Range<usize>> {
        let (low, high) = match self.shape(shape) {
            Shape::Face(corners) => {
                let rows = corners.map(|corner| corner[1]);
                (rows[0].min(rows[1]).min(rows[2]), rows[0].max(rows[1]).max(rows[2]))
            }
            Shape::Capsule { ends: [a, b], radius } => (a[1].min(b[1]) - radius, a[1].max(b[1]) + radius),
        };
        // Lines between groups look a few rows further.
        let above = self.reach as f64 / self.fine as f64 + 1.0;
        let band = |row: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the picture")]
            let band = (row.max(0.0) / BAND as f64) as usize;
            band.min(self.bands.len())
        };
        (high >= 0.0).then(|| band(low - above)..(band(high + 1.0) + 1).min(self.bands.len()))
    }

    fn shape(&self, shape: usize) -> Shape {
        let (frame, scene) = (self.frame, self.frame.scene);
        if let Some(face) = scene.faces.get(shape) {
            return Shape::Face(frame.triangle(face.corners));
        }
        let shape = shape - scene.faces.len();
        let (ends, radius) = match scene.lines.get(shape) {
            Some(line) => (line.ends, line.radius),
            None => {
                let dot = &scene.dots[shape - scene.lines.len()];
                ([dot.at; 2], dot.radius)
            }
        };
        Shape::Capsule { ends: ends.map(|end| frame.points[end as usize]), radius: radius * frame.unit }
    }

    /// The rows of pixels of a band.
    fn rows(&self, band: usize) -> Range<usize> {
        band * BAND..((band + 1) * BAND).min(self.frame.height)
    }

    fn draw(&self, band: usize) -> Samples {
        let rows = self.rows(band);
        let mut samples = Samples {
            width: self.frame.width * self.fine,
            first: rows.start * self.fine,
            samples: vec![EMPTY; self.frame.width * self.fine * (rows.len() * self.fine + self.reach)],
        };
        let scale = self.fine as f64;
        for &number in &self.bands[band] {
            let is_mark = self.marks[number as usize];
            match self.shape(number as usize) {
                Shape::Face(corners) => {
                    let corners = corners.map(|corner| corner.map(|value| value * scale));
                    samples.fill_face(
                        number,
                        corners,
                        self.frame.outline * scale,
                        |shape| self.is_mark(shape),
                        is_mark,
                    );
                }
                Shape::Capsule { ends, radius } => {
                    let ends = ends.map(|end| end.map(|value| value * scale));
                    samples.fill_capsule(number, ends, radius * scale, |shape| self.is_mark(shape), is_mark);
                }
            }
        }
        samples
    }

    fn is_mark(&self, shape: u32) -> bool {
        self.marks.get((shape & !BORDER) as usize).copied().unwrap_or(false)
    }

    /// Rows of red, green and blue.
    pub(super) fn pixels(&self) -> Vec<u8> {
        let colours = self.colours();
        let bands = (0..self.bands.len()).into_par_iter().map(|band| self.shade(band, &colours));
        bands.collect::<Vec<_>>().concat()
    }

    /// The colours of all shapes in the light that falls on them.
    fn colours(&self) -> Vec<Rgb> {
        let scene = self.frame.scene;
        let faces = scene.faces.par_iter().map(|face| lit(face.colour, self.frame.light(face.corners)));
        let mut colours: Vec<Rgb> = faces.collect();
        colours.extend(scene.lines.iter().map(|line| line.colour));
        colours.extend(scene.dots.iter().map(|dot| dot.colour));
        colours
    }

    fn shade(&self, band: usize, colours: &[Rgb]) -> Vec<u8> {
        let samples = self.draw(band);
        let colour = |x: usize, y: usize| {
            let sample = samples.at(x, y);
            if sample.shape == NONE {
                let hidden = colours.get(sample.hidden as usize);
                return hidden.map_or([255; 3], |&hidden| mixed(hidden, [255; 3], SHINE));
            }
            let (shape, is_border) = ((sample.shape & !BORDER) as usize, sample.shape & BORDER != 0);
            let colour = match colours[shape] {
                colour if is_border => lit(colour, 0.55),
                colour if self.is_between_groups(&samples, x, y) => lit(colour, 0.25),
                colour => colour,
            };
            match colours.get(sample.hidden as usize) {
                Some(&hidden) if !self.marks[shape] => mixed(hidden, colour, SHINE),
                _ => colour,
            }
        };
        let (fine, rows) = (self.fine, self.rows(band));
        let all = narrow(fine * fine);
        let mut pixels = Vec::with_capacity(rows.len() * self.frame.width * 3);
        for row in 0..rows.len() {
            for column in 0..self.frame.width {
                let mut sum = [0_u32; 3];
                for y in row * fine..(row + 1) * fine {
                    for x in column * fine..(column + 1) * fine {
                        let colour = colour(x, y);
                        sum.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += u32::from(channel));
                    }
                }
                #[expect(clippy::cast_possible_truncation, reason = "a mean of bytes")]
                pixels.extend(sum.map(|sum| ((sum + all / 2) / all) as u8));
            }
        }
        pixels
    }

    /// Whether the sample to the right or below, a line's width away, shows a face of another group.
    fn is_between_groups(&self, samples: &Samples, x: usize, y: usize) -> bool {
        if !self.frame.scene.groups {
            return false;
        }
        let group = |sample: Sample| self.frame.scene.faces.get(sample.shape as usize).map(|face| face.group);
        let Some(here) = group(samples.at(x, y)) else { return false };
        let other = |x: usize, y: usize| {
            x < samples.width && samples.get(x, y).and_then(group).is_some_and(|other| other != here)
        };
        other(x + self.reach, y) || other(x, y + self.reach)
    }

    /// Of each face, line and dot, in that order, whether some sample shows it.
    pub(super) fn visible(&self) -> Vec<bool> {
        let bands = (0..self.bands.len()).into_par_iter().map(|band| {
            let samples = self.draw(band);
            let count = samples.width * self.rows(band).len() * self.fine;
            let mut seen: Vec<u32> = samples.samples[..count].iter().map(|sample| sample.shape).collect();
            seen.dedup();
            seen.retain(|&shape| shape != NONE);
            seen.iter_mut().for_each(|shape| *shape &= !BORDER);
            seen.sort_unstable();
            seen.dedup();
            seen
        });
        let mut visible = vec![false; self.marks.len()];
        bands.collect::<Vec<_>>().into_iter().flatten().for_each(|shape| visible[shape as usize] = true);
        visible
    }
}

/// A shape in the picture.
enum Shape {
    Face([[f64; 3]; 3]),
    /// All points as near to a segment as a radius: a line with round ends, or a dot.
    Capsule {
        ends: [[f64; 3]; 2],
        radius: f64,
    },
}

/// The samples of a band.
struct Samples {
    width: usize,
    /// The first row.
    first: usize,
    samples: Vec<Sample>,
}

impl Samples {
    fn at(&self, x: usize, y: usize) -> Sample {
        self.samples[y * self.width + x]
    }

    fn get(&self, x: usize, y: usize) -> Option<Sample> {
        self.samples.get(y * self.width + x).copied()
    }

    /// The rows of the band that are in a range, counted from its first.
    fn rows(&self, low: f64, high: f64) -> Range<usize> {
        let first = self.first as f64;
        whole(low - first, high - first, self.samples.len() / self.width.max(1))
    }

    /// Shows a shape at a sample if nothing is before it.
    fn put(&mut self, at: usize, depth: f64, shape: u32, is_mark: impl Fn(u32) -> bool, shape_is_mark: bool) {
        let old = &mut self.samples[at];
        if depth > old.depth {
            if old.shape != NONE && is_mark(old.shape) {
                old.hidden = old.hidden.min(old.shape & !BORDER);
            }
            (old.depth, old.shape) = (depth, shape);
        } else if shape_is_mark {
            old.hidden = old.hidden.min(shape & !BORDER);
        }
    }

    fn fill_face(
        &mut self,
        number: u32,
        [a, b, c]: [[f64; 3]; 3],
        border: f64,
        is_mark: impl Fn(u32) -> bool + Copy,
        face_is_mark: bool,
    ) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 {
            return;
        }
        // How far from a side its opposite corner is.
        let [of_a, of_b, of_c] = [[b, c], [c, a], [a, b]].map(|[p, q]| area.abs() / (p[0] - q[0]).hypot(p[1] - q[1]));
        let span = |axis: usize| (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        let ((left, right), (top, bottom)) = (span(0), span(1));
        // A mark on a face is seen, and not that face.
        let before = if face_is_mark { 0.25 } else { 0.0 };
        // How much of b and of c is in a point: linear in x along a row.
        let (step_b, step_c) = ((c[1] - a[1]) / area, -(b[1] - a[1]) / area);
        for row in self.rows(top, bottom) {
            let y = (self.first + row) as f64 + 0.5;
            let first_b = (-a[0] * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
            let first_c = ((b[0] - a[0]) * (y - a[1]) + a[0] * (b[1] - a[1])) / area;
            let (mut low, mut high) = (left, right);
            for (first, step) in [(first_b, step_b), (first_c, step_c), (1.0 - first_b - first_c, -step_b - step_c)] {
                // Where the part is not negative; a sample more, which is asked again.
                if step > 0.0 {
                    low = low.max(-first / step - 1.0);
                } else if step < 0.0 {
                    high = high.min(-first / step + 1.0);
                }
            }
            for column in whole(low, high, self.width) {
                let x = column as f64 + 0.5;
                let (at_b, at_c) = (first_b + step_b * x, first_c + step_c * x);
                if at_b < 0.0 || at_c < 0.0 || at_b + at_c > 1.0 {
                    continue;
                }
                let depth = a[2] + at_b * (b[2] - a[2]) + at_c * (c[2] - a[2]) + before;
                let at = row * self.width + column;
                if depth <= self.samples[at].depth && !face_is_mark {
                    continue;
                }
                let to_side = ((1.0 - at_b - at_c) * of_a).min(at_b * of_b).min(at_c * of_c);
                let shape = if to_side < border { number | BORDER } else { number };
                self.put(at, depth, shape, is_mark, face_is_mark);
            }
        }
    }

    fn fill_capsule(
        &mut self,
        number: u32,
        [a, b]: [[f64; 3]; 2],
        radius: f64,
        is_mark: impl Fn(u32) -> bool + Copy,
        capsule_is_mark: bool,
    ) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        // Before the faces around it, which may come nearer within its width; marks before what is not marked.
        let before = if capsule_is_mark { 4.0 } else { 2.0 } * radius;
        for row in self.rows(a[1].min(b[1]) - radius, a[1].max(b[1]) + radius) {
            let y = (self.first + row) as f64 + 0.5;
            // The columns of the part of the segment that comes so near to the row.
            let (mut left, mut right) = (a[0].min(b[0]), a[0].max(b[0]));
            if dy != 0.0 {
                let ends = [y - radius, y + radius].map(|y| a[0] + ((y - a[1]) / dy).clamp(0.0, 1.0) * dx);
                (left, right) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            }
            for column in whole(left - radius, right + radius, self.width) {
                let x = column as f64 + 0.5;
                let along = ((x - a[0]) * dx + (y - a[1]) * dy) / (length * length);
                let along = if length > 0.0 { along.clamp(0.0, 1.0) } else { 0.0 };
                if (x - a[0] - along * dx).hypot(y - a[1] - along * dy) <= radius {
                    let depth = a[2] + along * (b[2] - a[2]) + before;
                    self.put(row * self.width + column, depth, number, is_mark, capsule_is_mark);
                }
            }
        }
    }
}

/// The whole numbers n below an end with n + 1/2 in a range.
fn whole(low: f64, high: f64, end: usize) -> Range<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the end bounds it")]
    let (low, high) = ((low - 0.5).ceil().max(0.0) as usize, ((high - 0.5).floor() + 1.0).max(0.0) as usize);
    low.min(end)..high.min(end)
}
