//! Fronts drawn on the full complex, as in the paper's Figure 3: each original simplex in the colour of the cell of the front
//! in which it has come to be.

use std::io::{self, Write};

use sig_core::{CellId, Dim};

use super::front::{BadRefinement, Front};
use crate::build::narrow;
use crate::cells::CellComplex;
use crate::draw::colour;
use crate::draw::{Dot, Face, Line, Scene, Swatch, grouped};
use crate::export::vtu;

/// A cell of a front by its number in the full complex, and its dimension.
type FrontCell = (u32, Dim);

/// The top simplices of the full complex of a front, with the cells of the front that they are in.
#[derive(Clone, Debug)]
pub struct Drawing {
    points: Vec<[f64; 3]>,
    /// The corners of each simplex, and the cell of the front that it is in.
    simplices: Vec<(Vec<u32>, Option<FrontCell>)>,
    /// The triangles that are seen: those of no solid, and those of one. With the cell of the front.
    triangles: Vec<([u32; 3], Option<u32>)>,
}

/// Why a front is not drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// There are no coordinates, or not for all vertices.
    #[error("the file has no coordinates of the vertices: nothing can be drawn")]
    NoCoordinates,
    /// The full complex is no simplicial complex.
    #[error(
        "cell {0} of the full complex is not a simplex of up to three dimensions with different vertices: nothing can be drawn"
    )]
    NotSimplicial(CellId),
    /// The full complex cannot be made.
    #[error(transparent)]
    Refinement(#[from] BadRefinement),
}

impl Drawing {
    /// Draws a front. Cost: that of making the full complex.
    ///
    /// # Errors
    /// [`DrawError`].
    pub fn new(front: &Front<'_>) -> Result<Self, DrawError> {
        let mcc = *front.mcc();
        let mut full = Front::new(mcc);
        full.select(|_| true)?;
        let complex = full.complex();
        let points = points(front, complex.counts().first().copied().unwrap_or(0))?;
        let survivors = front.survivors();
        let survivor = |cell: CellId| survivors.get(cell.index()).copied().flatten();
        let origin = |cell: CellId| narrow(mcc.origin(cell).unwrap_or(0));
        let mut drawing = Self { points, simplices: Vec::new(), triangles: Vec::new() };
        for cell in complex.cells() {
            let above = complex.coboundary(cell).next().map(|arc| arc.cell);
            let dim = complex.dim_of(cell).unwrap_or(0);
            let is_seen = dim == 2 && complex.num_coboundary(cell) <= 1;
            if above.is_some() && !is_seen {
                continue;
            }
            let corners = corners(complex, cell, dim, origin).ok_or(DrawError::NotSimplicial(cell))?;
            if corners.iter().any(|&corner| corner as usize >= drawing.points.len()) {
                return Err(DrawError::NoCoordinates);
            }
            if let (true, &[a, b, c]) = (is_seen, &corners[..]) {
                drawing.triangles.push(([a, b, c], survivor(above.unwrap_or(cell)).map(origin)));
            }
            if above.is_none() {
                let of = survivor(cell).map(|cell| (origin(cell), mcc.dim_of(cell).unwrap_or(0)));
                drawing.simplices.push((corners, of));
            }
        }
        Ok(drawing)
    }

    /// Writes all top simplices as VTU, with the data `cell`, the number in the full complex of the cell of the front in which each
    /// is, −1 if there is none, and `cell_dimension`, its dimension.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_vtu(&self, out: &mut dyn Write) -> io::Result<()> {
        let count = self.simplices.len();
        let corners: usize = self.simplices.iter().map(|(corners, _)| corners.len()).sum();
        vtu::head(out, self.points.len(), count)?;
        writeln!(out, r#"<CellData Scalars="cell">"#)?;
        let of = |of: Option<FrontCell>| of.map_or((-1, -1), |(cell, dim)| (i64::from(cell), dim as i64));
        vtu::array(out, r#"type="Int64" Name="cell""#, count * 8, |data| {
            self.simplices.iter().try_for_each(|&(_, cell)| data.write_all(&of(cell).0.to_le_bytes()))
        })?;
        vtu::array(out, r#"type="Int64" Name="cell_dimension""#, count * 8, |data| {
            self.simplices.iter().try_for_each(|&(_, cell)| data.write_all(&of(cell).1.to_le_bytes()))
        })?;
        writeln!(out, "</CellData>\n<Points>")?;
        vtu::array(out, r#"type="Float64" NumberOfComponents="3""#, self.points.len() * 24, |data| {
            self.points.iter().flatten().try_for_each(|value| data.write_all(&value.to_le_bytes()))
        })?;
        writeln!(out, "</Points>\n<Cells>")?;
        vtu::array(out, r#"type="Int64" Name="connectivity""#, corners * 8, |data| {
            let corners = self.simplices.iter().flat_map(|(corners, _)| corners);
            corners.into_iter().try_for_each(|&corner| data.write_all(&i64::from(corner).to_le_bytes()))
        })?;
        vtu::array(out, r#"type="Int64" Name="offsets""#, count * 8, |data| {
            let mut end = 0_u64;
            self.simplices.iter().try_for_each(|(corners, _)| {
                end += corners.len() as u64;
                data.write_all(&end.to_le_bytes())
            })
        })?;
        vtu::array(out, r#"type="UInt8" Name="types""#, count, |data| {
            self.simplices.iter().try_for_each(|(corners, _)| data.write_all(&[vtu::CELL_TYPES[corners.len() - 1]]))
        })?;
        writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
    }

    /// The front as a scene: the triangles of no solid, and of one; wire edges, and vertices by themselves. Each has a colour by
    /// the cell of the front, and there are lines between the triangles of different cells.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let mut scene = Scene { points: self.points.clone(), groups: true, ..Scene::default() };
        scene.flat = scene.points.iter().all(|point| point[2] == 0.0);
        let face = |&(corners, cell): &([u32; 3], Option<u32>)| {
            let group = cell.map_or(0, |cell| cell + 1);
            Face { corners, colour: colour::of_number(cell), group, is_mark: false }
        };
        scene.faces = self.triangles.iter().map(face).collect();
        for (corners, cell) in &self.simplices {
            let (colour, is_mark) = (colour::of_number(cell.map(|(cell, _)| cell)), false);
            match corners[..] {
                [a, b] => scene.lines.push(Line { ends: [a, b], colour, radius: 2.2, is_mark }),
                [at] => scene.dots.push(Dot { at, colour, radius: 4.0, is_mark }),
                _ => {}
            }
        }
        let mut cells: Vec<Option<FrontCell>> = self.simplices.iter().map(|&(_, cell)| cell).collect();
        cells.sort_unstable();
        cells.dedup();
        let text =
            format!("{} cells of the front in {} top simplices", grouped(cells.len()), grouped(self.simplices.len()));
        scene.legend.push(Swatch::None, colour::INK, text);
        scene
    }
}

/// The points of the vertices, filled up to three coordinates.
fn points(front: &Front<'_>, vertices: usize) -> Result<Vec<[f64; 3]>, DrawError> {
    let section = front.mcc().coordinates().ok_or(DrawError::NoCoordinates)?;
    let components = section.components as usize;
    let point = |vertex: usize| {
        std::array::from_fn(|axis| {
            let value = (axis < components).then(|| section.column.number_at(vertex * components + axis)).flatten();
            value.filter(|value| value.is_finite()).unwrap_or(0.0)
        })
    };
    let is_enough = section.column.len() >= vertices * components;
    is_enough.then(|| (0..vertices).map(point).collect()).ok_or(DrawError::NoCoordinates)
}

/// The vertices of a simplex by their numbers in the full complex; `None` if the cell is none, or of more than three dimensions.
fn corners(complex: &CellComplex, cell: CellId, dim: Dim, origin: impl Fn(CellId) -> u32) -> Option<Vec<u32>> {
    let mut faces = vec![cell];
    for _ in 0..dim {
        faces = faces.iter().flat_map(|&face| complex.boundary(face)).map(|arc| arc.cell).collect();
        faces.sort_unstable();
        faces.dedup();
    }
    (faces.len() == dim + 1 && dim <= 3).then(|| faces.into_iter().map(origin).collect())
}
