//! Legends: where their parts lie, and letters in pixels.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::colour::{INK, Rgb, mixed};
use super::scene::{Entry, Legend, Swatch};

/// A canvas of pixels: red, green and blue.
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<u8>,
}

/// A legend laid out below a picture: for each part its left end and the top of its line.
pub(super) struct Placed<'l> {
    legend: &'l Legend,
    entries: Vec<(usize, usize)>,
    pub(super) width: usize,
    pub(super) height: usize,
    size: RasterHeight,
}

/// Letters for a picture whose longer side is `size`.
fn letters(size: usize) -> RasterHeight {
    match size {
        0..1400 => RasterHeight::Size16,
        1400..2200 => RasterHeight::Size24,
        _ => RasterHeight::Size32,
    }
}

impl<'l> Placed<'l> {
    /// The legend in lines that are no wider than a picture, or than it takes; with letters of a width, or as wide as those that
    /// are drawn.
    pub(super) fn new(legend: &'l Legend, picture: usize, size: usize, letter: Option<usize>) -> Self {
        let size = letters(size);
        let line = size.val() * 3 / 2;
        let letter = letter.unwrap_or_else(|| get_raster_width(FontWeight::Regular, size));
        let title = legend.title.chars().count() * letter + line;
        let widest = legend.entries.iter().map(|entry| wide(entry, letter, line)).max().unwrap_or(0);
        let width = picture.max(widest + line).max(title);
        let (mut x, mut y) = (line / 2, if legend.title.is_empty() { line / 4 } else { line + line / 4 });
        let mut entries = Vec::new();
        for entry in &legend.entries {
            let wide = wide(entry, letter, line);
            if x + wide > width && x > line / 2 {
                (x, y) = (line / 2, y + line);
            }
            entries.push((x, y));
            x += wide;
        }
        let height = match (legend.title.is_empty(), legend.entries.is_empty()) {
            (true, true) => 0,
            (false, true) => y,
            (_, false) => y + line + line / 4,
        };
        Self { legend, entries, width: if height == 0 { 0 } else { width }, height, size }
    }

    pub(super) fn line(&self) -> usize {
        self.size.val() * 3 / 2
    }

    /// The entries with the left ends and tops of their lines.
    pub(super) fn entries(&self) -> impl Iterator<Item = (&'l Entry, (usize, usize))> {
        self.legend.entries.iter().zip(self.entries.iter().copied())
    }

    pub(super) fn title(&self) -> &'l str {
        &self.legend.title
    }

    /// Draws it onto a canvas, below a row.
    pub(super) fn draw(&self, top: usize, canvas: &mut Canvas) {
        let line = self.line();
        canvas.write(self.title(), line / 2, top + line / 4, self.size, INK);
        for (entry, (x, y)) in self.entries() {
            let text = x + if entry.swatch == Swatch::None { 0 } else { line };
            canvas.write(&entry.text, text, top + y + line / 6, self.size, INK);
            let (middle, radius) = ((x + line / 2) as f64, line as f64 * 0.3);
            canvas.swatch(entry, middle - line as f64 * 0.1, (top + y) as f64 + line as f64 * 0.5, radius);
        }
    }
}

/// How wide an entry is, with its swatch and the gap behind it.
fn wide(entry: &Entry, letter: usize, line: usize) -> usize {
    let swatch = if entry.swatch == Swatch::None { 0 } else { line };
    entry.text.chars().count() * letter + swatch + line
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![255; width * height * 3] }
    }

    /// Copies rows of red, green and blue to a place.
    pub(super) fn paste(&mut self, pixels: &[u8], width: usize, left: usize) {
        for (row, pixels) in pixels.chunks_exact((width * 3).max(1)).enumerate() {
            let at = (row * self.width + left) * 3;
            if let Some(place) = self.pixels.get_mut(at..at + width * 3) {
                place.copy_from_slice(pixels);
            }
        }
    }

    fn blend(&mut self, x: usize, y: usize, colour: Rgb, part: f64) {
        if x < self.width && y < self.height {
            let at = (y * self.width + x) * 3;
            let old = [0, 1, 2].map(|channel| self.pixels[at + channel]);
            self.pixels[at..at + 3].copy_from_slice(&mixed(colour, old, part));
        }
    }

    fn write(&mut self, text: &str, x: usize, y: usize, size: RasterHeight, colour: Rgb) {
        let width = get_raster_width(FontWeight::Regular, size);
        for (number, letter) in text.chars().enumerate() {
            let letter = get_raster(letter, FontWeight::Regular, size).or(get_raster('?', FontWeight::Regular, size));
            for (row, values) in letter.iter().flat_map(|letter| letter.rows().enumerate()) {
                for (column, &value) in values.iter().enumerate() {
                    self.blend(x + number * width + column, y + row, colour, f64::from(value) / 255.0);
                }
            }
        }
    }

    fn swatch(&mut self, entry: &Entry, middle: f64, row: f64, radius: f64) {
        let (wide, high) = match entry.swatch {
            Swatch::None => return,
            Swatch::Face | Swatch::Dot => (radius, radius),
            Swatch::Line => (radius * 1.2, radius * 0.3),
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the picture")]
        let range = |middle: f64, radius: f64| (middle - radius).round() as usize..(middle + radius).round() as usize;
        for y in range(row, high) {
            for x in range(middle, wide) {
                let distance = (x as f64 + 0.5 - middle).hypot(y as f64 + 0.5 - row);
                let part = if entry.swatch == Swatch::Dot { (radius - distance + 0.5).clamp(0.0, 1.0) } else { 1.0 };
                self.blend(x, y, entry.colour, part);
            }
        }
    }
}
