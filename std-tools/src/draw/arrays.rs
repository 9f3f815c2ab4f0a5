//! The arrays of a tiny complex, read from the sections of its file, below a sketch in which each simplex has its id.

use std::fmt::{self, Write as _};

use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, Dim, Index, SimplexId};

use super::camera::Camera;
use super::svg::begin;

/// The most simplices whose arrays are drawn.
pub const MAX_SIMPLICES: usize = 100;

/// Why arrays are not drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{simplices} simplices: the arrays of {MAX_SIMPLICES} at most are drawn")]
pub struct TooManySimplices {
    /// How many simplices there are.
    pub simplices: usize,
}

/// The side of a cell, in pixels.
const CELL: usize = 34;
/// Where the cells start.
const LEFT: usize = 112;
/// The cells in a line.
const WIDE: usize = 19;
/// Fills of cells with simplices, by dimension.
const FILLS: [&str; 4] = ["#fff0cc", "#d6e9ff", "#dcf3d0", "#f0dcf5"];
/// Where the sketch is: left, top, width, height.
const SKETCH: [f64; 4] = [LEFT as f64 + 20.0, 34.0, 340.0, 150.0];

/// A number in an array.
struct Cell {
    text: String,
    fill: &'static str,
    /// What stands above: of what the number, or the first of several, is.
    above: String,
    /// What stands below: the place in the array, where others point to it.
    below: String,
}

/// Draws the arrays of a valid complex of which the vertices lie at `points`: the lookup table, the boundary, the pointers
/// with their flags, and the lists with their stop codes, or the pairs of section 7.4.
///
/// # Errors
/// [`TooManySimplices`] of more than [`MAX_SIMPLICES`].
pub fn arrays<I: Index>(
    complex: &Complex<'_, I>,
    points: &[[f64; 3]],
    camera: &Camera,
) -> Result<String, TooManySimplices> {
    let simplices = complex.num_simplices();
    if simplices > MAX_SIMPLICES {
        return Err(TooManySimplices { simplices });
    }
    let mut body = String::new();
    let figure = Figure { complex };
    let places = placed(points, camera);
    let _ = figure.sketch(&places, &mut body);
    let bottom = places.iter().map(|place| place[1]).fold(SKETCH[1], f64::max);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the sketch")]
    let mut y = bottom as usize + 58;
    for (name, note, cells) in figure.rows() {
        let _ = row(name, note, &cells, &mut y, &mut body);
    }
    let mut svg = begin(LEFT + WIDE * CELL + 24, y);
    let _ = writeln!(svg, r#"<g font-family="sans-serif" font-size="14" text-anchor="middle" fill="black">"#);
    Ok(svg + &body + "</g>\n</svg>\n")
}

struct Figure<'c, 'a, I> {
    complex: &'c Complex<'a, I>,
}

impl<I: Index> Figure<'_, '_, I> {
    /// Each simplex with its id, the largest dimension behind.
    fn sketch(&self, places: &[[f64; 2]], svg: &mut String) -> fmt::Result {
        let all = || {
            (0..=self.complex.dim().unwrap_or(0))
                .rev()
                .flat_map(|dim| self.complex.simplices_of_dim(dim).map(move |simplex| (dim, simplex)))
        };
        let corners = |simplex: SimplexId| -> Vec<[f64; 2]> {
            self.complex.vertices(simplex).filter_map(|vertex| places.get(vertex.index()).copied()).collect()
        };
        // Edges lie over all triangles, and numbers over all edges.
        for (dim, simplex) in all().filter(|&(dim, _)| dim == 2 || dim == 1) {
            let points: Vec<String> = corners(simplex).iter().map(|[x, y]| format!("{x:.0},{y:.0}")).collect();
            let points = points.join(" ");
            if dim == 2 {
                writeln!(svg, r#"<polygon points="{points}" fill="{}" fill-opacity=".8"/>"#, FILLS[2])?;
            } else {
                writeln!(svg, r##"<polyline points="{points}" stroke="#2b6cb0" stroke-width="3"/>"##)?;
            }
        }
        for (dim, simplex) in all() {
            let corners = corners(simplex);
            let middle = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>() / corners.len() as f64;
            let (x, y, fill) = (middle(0), middle(1), FILLS[dim.min(3)]);
            match dim {
                0 => writeln!(svg, r##"<circle cx="{x:.0}" cy="{y:.0}" r="13" fill="{fill}" stroke="#333"/>"##)?,
                2 if self.complex.dim() == Some(2) => {}
                _ => {
                    let (x, y) = (x - 12.0, y - 9.0);
                    writeln!(svg, r#"<rect x="{x:.0}" y="{y:.0}" width="24" height="18" rx="4" fill="{fill}"/>"#)?;
                }
            }
            writeln!(svg, r#"<text x="{x:.0}" y="{:.0}">{}</text>"#, y + 5.0, simplex.index())?;
        }
        Ok(())
    }

    fn rows(&self) -> Vec<(&'static str, &'static str, Vec<Cell>)> {
        let mut rows = vec![
            ("lookup", "first ids", self.lookup()),
            ("boundary", "facets", self.boundary()),
            ("pointers", "", self.pointers()),
            ("flags", "one cluster?", self.flags()),
            ("lists", "representatives", self.lists()),
        ];
        if self.complex.has_pairs() {
            rows.push(("pairs", "", self.pairs()));
        }
        rows.retain(|(_, _, cells)| !cells.is_empty());
        rows
    }

    /// The numbers in a section of the file.
    fn numbers(&self, kind: SectionKind) -> Vec<usize> {
        let Some(section) = self.complex.container().section(kind) else { return Vec::new() };
        (0..section.column.len()).map_while(|row| section.column.index_at(row)).collect()
    }

    fn fill(&self, simplex: usize) -> &'static str {
        self.complex.dim_of(SimplexId::new(simplex)).map_or("white", |dim: Dim| FILLS[dim.min(3)])
    }

    fn lookup(&self) -> Vec<Cell> {
        let cell = |(dim, first): (usize, usize)| Cell {
            text: first.to_string(),
            fill: FILLS[dim.min(3)],
            above: format!("p = {dim}"),
            below: String::new(),
        };
        self.numbers(SectionKind::Lookup).into_iter().enumerate().map(cell).collect()
    }

    fn boundary(&self) -> Vec<Cell> {
        let mut numbers = self.numbers(SectionKind::Boundary).into_iter();
        let mut cells = Vec::new();
        for simplex in self.complex.simplices() {
            let facets = self.complex.dim_of(simplex).filter(|&dim| dim > 0).map_or(0, |dim| dim + 1);
            for (position, facet) in numbers.by_ref().take(facets).enumerate() {
                let above = if position == 0 { format!("#{}", simplex.index()) } else { String::new() };
                cells.push(Cell {
                    text: facet.to_string(),
                    fill: self.fill(simplex.index()),
                    above,
                    below: String::new(),
                });
            }
        }
        cells
    }

    fn flag(&self, simplex: usize) -> Option<bool> {
        match self.complex.container().section(SectionKind::Flags)?.column {
            column @ Column::Bits { .. } => column.bit_at(simplex),
            _ => None,
        }
    }

    fn pointers(&self) -> Vec<Cell> {
        let cell = |(simplex, pointer): (usize, usize)| Cell {
            text: pointer.to_string(),
            // A flagged one is a simplex itself.
            fill: if self.flag(simplex) == Some(true) { self.fill(pointer) } else { "white" },
            above: format!("#{simplex}"),
            below: String::new(),
        };
        self.numbers(SectionKind::Pointers).into_iter().enumerate().map(cell).collect()
    }

    fn flags(&self) -> Vec<Cell> {
        let flags = (0..).map_while(|simplex| self.flag(simplex)).enumerate();
        flags
            .map(|(simplex, flag)| Cell {
                text: u8::from(flag).to_string(),
                fill: if flag { FILLS[self.complex.dim().unwrap_or(0).min(3)] } else { "white" },
                above: format!("#{simplex}"),
                below: String::new(),
            })
            .collect()
    }

    fn lists(&self) -> Vec<Cell> {
        // The simplices without a flag, in the order of their lists.
        let pointers = self.numbers(SectionKind::Pointers);
        let starts: Vec<(usize, usize)> =
            pointers.into_iter().enumerate().filter(|&(simplex, _)| self.flag(simplex) != Some(true)).collect();
        let stop = I::STOP.to_usize();
        let cell = |(place, entry): (usize, usize)| {
            let of: Vec<String> =
                starts.iter().filter(|&&(_, start)| start == place).map(|(simplex, _)| format!("#{simplex}")).collect();
            let is_stop = entry == stop;
            Cell {
                text: if is_stop { "■".to_owned() } else { entry.to_string() },
                fill: if is_stop { "#dddddd" } else { self.fill(entry) },
                below: if of.is_empty() { String::new() } else { place.to_string() },
                above: of.join(" "),
            }
        };
        self.numbers(SectionKind::Lists).into_iter().enumerate().map(cell).collect()
    }

    fn pairs(&self) -> Vec<Cell> {
        let first = self.complex.dim().unwrap_or(0).checked_sub(1).map(|dim| self.complex.simplices_of_dim(dim));
        let first = first.map_or(0, |simplices| simplices.bounds().0.index());
        let cell = |(place, entry): (usize, usize)| {
            let is_stop = entry == I::STOP.to_usize();
            Cell {
                text: if is_stop { "■".to_owned() } else { entry.to_string() },
                fill: if is_stop { "#dddddd" } else { self.fill(entry) },
                above: if place % 2 == 0 { format!("#{}", first + place / 2) } else { String::new() },
                below: String::new(),
            }
        };
        self.numbers(SectionKind::Pairs).into_iter().enumerate().map(cell).collect()
    }
}

/// The points in the sketch.
fn placed(points: &[[f64; 3]], camera: &Camera) -> Vec<[f64; 2]> {
    let turned: Vec<[f64; 3]> = points.iter().map(|&point| camera.turn(point)).collect();
    let edge =
        |axis: usize, pick: fn(f64, f64) -> f64| turned.iter().map(|point| point[axis]).reduce(pick).unwrap_or(0.0);
    let (left, right, bottom, top) = (edge(0, f64::min), edge(0, f64::max), edge(1, f64::min), edge(1, f64::max));
    let part = |room: f64, extent: f64| if extent > 0.0 { room / extent } else { f64::INFINITY };
    let scale = part(SKETCH[2], right - left).min(part(SKETCH[3], top - bottom));
    let scale = if scale.is_finite() { scale } else { 1.0 };
    turned.iter().map(|[x, y, _]| [SKETCH[0] + (x - left) * scale, SKETCH[1] + (top - y) * scale]).collect()
}

/// Draws an array in lines of cells, and moves down by them.
fn row(name: &str, note: &str, cells: &[Cell], y: &mut usize, svg: &mut String) -> fmt::Result {
    let (x, middle) = (LEFT - 12, *y + 21);
    writeln!(svg, r#"<text x="{x}" y="{middle}" text-anchor="end" font-weight="bold">{name}</text>"#)?;
    if !note.is_empty() {
        let y = *y + 37;
        writeln!(svg, r##"<text x="{x}" y="{y}" text-anchor="end" font-size="11" fill="#666">{note}</text>"##)?;
    }
    for line in cells.chunks(WIDE) {
        for (position, Cell { text, fill, above, below }) in line.iter().enumerate() {
            let (x, y) = (LEFT + position * CELL, *y);
            let middle = x + CELL / 2;
            writeln!(svg, r##"<rect x="{x}" y="{y}" width="{CELL}" height="{CELL}" fill="{fill}" stroke="#555"/>"##)?;
            writeln!(svg, r#"<text x="{middle}" y="{}">{text}</text>"#, y + 22)?;
            let mut small = |text: &str, y: usize, colour: &str| match text {
                "" => Ok(()),
                _ => writeln!(svg, r#"<text x="{middle}" y="{y}" font-size="11" fill="{colour}">{text}</text>"#),
            };
            small(above, y - 5, "#666")?;
            small(below, y + CELL + 13, "#b00")?;
        }
        *y += CELL + 32;
    }
    Ok(())
}
