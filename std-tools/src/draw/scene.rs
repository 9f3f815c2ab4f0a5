//! What is drawn: faces, lines and dots in space, and a legend.

use std::fmt::Display;

use super::colour::Rgb;

/// Faces, lines and dots on common points.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The points; a plane complex has the third coordinate 0.
    pub points: Vec<[f64; 3]>,
    /// Triangles.
    pub faces: Vec<Face>,
    /// Segments.
    pub lines: Vec<Line>,
    /// Points that are seen.
    pub dots: Vec<Dot>,
    /// Whether lines are drawn between faces of different groups, instead of around each face that is large enough.
    pub groups: bool,
    /// Whether all lies in the plane of the picture, and wants no light.
    pub flat: bool,
    /// What stands below.
    pub legend: Legend,
}

/// A triangle of a scene.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Face {
    /// Its corners, in the points of the scene.
    pub corners: [u32; 3],
    /// Its colour in full light.
    pub colour: Rgb,
    /// What it is a part of.
    pub group: u32,
    /// Whether it shines through what hides it.
    pub is_mark: bool,
}

/// A segment of a scene.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line {
    /// Its ends.
    pub ends: [u32; 2],
    /// Its colour.
    pub colour: Rgb,
    /// Half its width, in pixels of a picture of 1000.
    pub radius: f64,
    /// Whether it shines through what hides it.
    pub is_mark: bool,
}

/// A dot of a scene.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Dot {
    /// Where it is.
    pub at: u32,
    /// Its colour.
    pub colour: Rgb,
    /// Its radius, in pixels of a picture of 1000.
    pub radius: f64,
    /// Whether it shines through what hides it.
    pub is_mark: bool,
}

/// What the colours of a scene mean.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Legend {
    /// The line above it; none if empty.
    pub title: String,
    /// The colours.
    pub entries: Vec<Entry>,
}

/// A line of a legend.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Entry {
    /// What is drawn in front of it.
    pub swatch: Swatch,
    /// The colour of that.
    pub colour: Rgb,
    /// What it says.
    pub text: String,
}

/// What stands in front of an entry of a legend.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Swatch {
    /// A square, for faces.
    Face,
    /// A line.
    Line,
    /// A dot.
    Dot,
    /// Nothing: a remark.
    None,
}

impl Legend {
    /// Adds an entry.
    pub fn push(&mut self, swatch: Swatch, colour: Rgb, text: String) {
        self.entries.push(Entry { swatch, colour, text });
    }
}

impl Scene {
    /// Visits the points that faces, lines and dots have.
    pub(super) fn corners(&self, mut visit: impl FnMut(u32)) {
        self.faces.iter().flat_map(|face| face.corners).for_each(&mut visit);
        self.lines.iter().flat_map(|line| line.ends).for_each(&mut visit);
        self.dots.iter().map(|dot| dot.at).for_each(visit);
    }

    /// The number of faces, lines and dots.
    #[must_use]
    pub fn len(&self) -> usize {
        self.faces.len() + self.lines.len() + self.dots.len()
    }

    /// Whether nothing is drawn.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether a face, line or dot, by its number in that order, shines through what hides it.
    pub(super) fn is_mark(&self, shape: usize) -> bool {
        let (faces, lines) = (self.faces.len(), self.lines.len());
        match (shape.checked_sub(faces), shape.checked_sub(faces + lines)) {
            (_, Some(dot)) => self.dots.get(dot).is_some_and(|dot| dot.is_mark),
            (Some(line), None) => self.lines[line].is_mark,
            (None, None) => self.faces[shape].is_mark,
        }
    }
}

/// A number with its digits in groups of three, as legends and tables have it.
#[must_use]
pub fn grouped(number: impl Display) -> String {
    let digits = number.to_string();
    let (sign, digits) = digits.strip_prefix('-').map_or(("", digits.as_str()), |digits| ("-", digits));
    let mut grouped = sign.to_owned();
    for (position, digit) in digits.char_indices() {
        if position > 0 && (digits.len() - position) % 3 == 0 {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn digits_are_grouped_from_the_right() {
        let numbers = [(0, "0"), (999, "999"), (1000, "1,000"), (-1_234_567, "-1,234,567"), (-123, "-123")];
        for (number, text) in numbers {
            assert_eq!(grouped(number), text);
        }
    }
}
