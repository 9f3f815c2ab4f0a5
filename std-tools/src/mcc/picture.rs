//! Fronts drawn on the full complex, as in the paper's Figure 3: each original simplex in the colour of the cell of the front
//! in which it has come to be.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use sig_core::{CellId, Dim};

use super::front::{BadRefinement, Front};
use crate::build::narrow;
use crate::cells::CellComplex;
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

/// Along which axis a picture looks.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum ViewAxis {
    /// From large x to small x.
    X,
    /// From large y to small y.
    Y,
    /// From large z to small z.
    #[default]
    Z,
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
        writeln!(out, r#"<?xml version="1.0"?>"#)?;
        writeln!(
            out,
            r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
        )?;
        writeln!(out, "<UnstructuredGrid>")?;
        writeln!(out, r#"<Piece NumberOfPoints="{}" NumberOfCells="{count}">"#, self.points.len())?;
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

    /// Writes a picture in PNG: parallel projection, the nearer triangle hides the farther one, with lines between cells of the
    /// front. `size` is the longer side in pixels.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_png(&self, axis: ViewAxis, size: u16, out: &mut dyn Write) -> io::Result<()> {
        let view = Projection::new(&self.points, axis, f64::from(size));
        let (width, height) = (view.width(), view.height());
        let mut pixels: Vec<Option<Pixel>> = vec![None; width * height];
        for &(triangle, cell) in &self.triangles {
            let corners = triangle.map(|corner| view.project(self.points[corner as usize]));
            let pixel = |depth| Pixel { depth, cell, shade: shade(corners) };
            fill(corners, width, height, |at, depth| {
                let old = &mut pixels[at];
                if old.as_ref().is_none_or(|old| old.depth < depth) {
                    *old = Some(pixel(depth));
                }
            });
        }
        let mut rows = Vec::with_capacity(height * (3 * width + 1));
        for row in 0..height {
            rows.push(0);
            for column in 0..width {
                let at = row * width + column;
                let here = pixels[at].as_ref();
                let is_line = |other: usize| {
                    here.zip(pixels[other].as_ref()).is_some_and(|(here, other)| here.cell != other.cell)
                };
                let is_line = column + 1 < width && is_line(at + 1) || row + 1 < height && is_line(at + width);
                rows.extend(here.map_or([255; 3], |pixel| {
                    let [r, g, b] = colour(pixel.cell, pixel.shade);
                    if is_line { [r / 4, g / 4, b / 4] } else { [r, g, b] }
                }));
            }
        }
        write_png(width, height, &rows, out)
    }

    /// Writes a picture in SVG: the triangles that face the viewer, the farthest first. `size` is the longer side.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_svg(&self, axis: ViewAxis, size: u16, out: &mut dyn Write) -> io::Result<()> {
        let view = Projection::new(&self.points, axis, f64::from(size));
        let mut triangles: Vec<_> = self
            .triangles
            .iter()
            .map(|&(triangle, cell)| (triangle.map(|corner| view.project(self.points[corner as usize])), cell))
            .collect();
        let depth = |corners: &[[f64; 3]; 3]| corners.iter().map(|corner| corner[2]).sum::<f64>();
        triangles.sort_by(|(a, _), (b, _)| depth(a).total_cmp(&depth(b)));
        let (width, height) = (view.width(), view.height());
        writeln!(out, r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}">"#)?;
        for (corners, cell) in triangles {
            let [r, g, b] = colour(cell, shade(corners));
            let [a, b2, c] = corners.map(|[x, y, _]| format!("{x:.1},{y:.1}"));
            let colour = format!("#{r:02x}{g:02x}{b:02x}");
            writeln!(out, r#"<path d="M{a} {b2} {c}z" fill="{colour}" stroke="{colour}" stroke-width=".3"/>"#)?;
        }
        writeln!(out, "</svg>")
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

/// A picture's coordinates: x to the right, y down, z to the viewer.
struct Projection {
    axes: [usize; 3],
    low: [f64; 3],
    high: [f64; 3],
    scale: f64,
}

const MARGIN: f64 = 4.0;

impl Projection {
    fn new(points: &[[f64; 3]], axis: ViewAxis, size: f64) -> Self {
        let axes = match axis {
            ViewAxis::X => [1, 2, 0],
            ViewAxis::Y => [2, 0, 1],
            ViewAxis::Z => [0, 1, 2],
        };
        let edge = |pick: fn(f64, f64) -> f64| {
            axes.map(|axis| points.iter().map(|point| point[axis]).reduce(pick).unwrap_or(0.0))
        };
        let (low, high) = (edge(f64::min), edge(f64::max));
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let scale = if extent > 0.0 { (size - 2.0 * MARGIN).max(1.0) / extent } else { 1.0 };
        Self { axes, low, high, scale }
    }

    fn side(&self, axis: usize) -> usize {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most the size of the picture")]
        let side = ((self.high[axis] - self.low[axis]) * self.scale + 2.0 * MARGIN).ceil() as usize;
        side.max(1)
    }

    fn width(&self) -> usize {
        self.side(0)
    }

    fn height(&self) -> usize {
        self.side(1)
    }

    fn project(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes.map(|axis| point[axis]);
        let [x, y] = [x - self.low[0], self.high[1] - y].map(|value| value * self.scale + MARGIN);
        [x, y, z * self.scale]
    }
}

/// What a pixel shows.
#[derive(Clone)]
struct Pixel {
    depth: f64,
    cell: Option<u32>,
    shade: f64,
}

/// Visits the pixels whose middles are in a triangle, with the depth there.
fn fill([a, b, c]: [[f64; 3]; 3], width: usize, height: usize, mut visit: impl FnMut(usize, f64)) {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if area == 0.0 {
        return;
    }
    let range = |axis: usize, end: usize| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the picture")]
        let (low, high) = ((low - 0.5).ceil().max(0.0) as usize, (high - 0.5).floor().max(-1.0) + 1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the picture")]
        let high = high as usize;
        low..high.min(end)
    };
    for row in range(1, height) {
        for column in range(0, width) {
            let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
            let of_b = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
            let of_c = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
            if of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0 {
                visit(row * width + column, a[2] + of_b * (b[2] - a[2]) + of_c * (c[2] - a[2]));
            }
        }
    }
}

/// How bright a triangle is, by how it is turned to the viewer: 0.35 to 1.
fn shade([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|point| std::array::from_fn(|axis| point[axis] - a[axis]));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|value| value * value).sum::<f64>().sqrt();
    if length == 0.0 { 1.0 } else { 0.35 + 0.65 * (normal[2] / length).abs() }
}

/// A colour for each cell, near numbers far apart, as bright as told; grey for none.
fn colour(cell: Option<u32>, shade: f64) -> [u8; 3] {
    let hue = cell.map(|cell| f64::from(cell) * 0.618_033_988_749_895 % 1.0 * 6.0);
    let channel = |offset: f64| {
        let light = hue.map_or(0.6, |hue| {
            let distance = ((hue + offset) % 6.0 - 3.0).abs() - 1.0;
            0.35 + 0.65 * distance.clamp(0.0, 1.0)
        });
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
        let byte = (light * shade * 255.0).round() as u8;
        byte
    };
    [0.0, 4.0, 2.0].map(channel)
}

/// Writes rows of a filter byte and red, green and blue.
fn write_png(width: usize, height: usize, rows: &[u8], out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"\x89PNG\r\n\x1a\n")?;
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(kind);
        hasher.update(data);
        out.write_all(&narrow(data.len()).to_be_bytes())?;
        out.write_all(kind)?;
        out.write_all(data)?;
        out.write_all(&hasher.finalize().to_be_bytes())
    };
    let mut header = Vec::new();
    header.extend(narrow(width).to_be_bytes());
    header.extend(narrow(height).to_be_bytes());
    // Eight bits a channel, three channels.
    header.extend([8, 2, 0, 0, 0]);
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(rows)?;
    let data = encoder.finish()?;
    chunk(b"IHDR", &header)?;
    chunk(b"IDAT", &data)?;
    chunk(b"IEND", &[])
}
