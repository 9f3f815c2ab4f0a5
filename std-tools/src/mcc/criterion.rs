//! What a simplification costs: [`Criterion`], and those of the library.

use sig_core::CellId;

use crate::build::narrow;
use crate::cells::CellComplex;
use crate::soup::{Coordinates, Scalars};

/// A pair of cells that may be killed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Pair {
    /// The i-cell.
    pub low: CellId,
    /// The (i+1)-cell.
    pub high: CellId,
    /// The cell with which one of the two is merged; `None` if there is none.
    pub kept: Option<CellId>,
}

/// What it costs to kill a pair: the least costs go first, and are the errors of the multi-resolution complex.
///
/// A criterion of one's own: vertices that are marked stay as long as other cells can go.
///
/// ```
/// use sig_tools::cells::{CellComplex, read_cells};
/// use sig_tools::mcc::{Criterion, Pair, SimplifyOptions, simplify};
///
/// struct Keep(Vec<bool>);
///
/// impl Criterion for Keep {
///     fn cost(&self, _: &CellComplex, pair: Pair) -> f32 {
///         if self.0.get(pair.low.index()).is_some_and(|&is_marked| is_marked) { 1.0 } else { 0.0 }
///     }
/// }
///
/// // A path of three vertices, of which the first stays, whatever goes.
/// let path = read_cells(&b"cells 3 2\n+1 -0\n+2 -1\n"[..], "path")?;
/// let (recorded, _) = simplify(path, &mut Keep(vec![true, false, false]), &SimplifyOptions::default());
/// assert_eq!(recorded.view().origin(sig_core::CellId::new(0)), Some(0));
/// # Ok::<(), sig_tools::io::ReadError>(())
/// ```
pub trait Criterion: Sync {
    /// The cost in a complex as it is: a number that is not negative; pairs of infinite cost are never killed.
    fn cost(&self, complex: &CellComplex, pair: Pair) -> f32;

    /// Told of each pair that was killed.
    fn killed(&mut self, pair: Pair) {
        let _ = pair;
    }

    /// Whether the cheapest pair of a cell never gets cheaper when others are killed, also where a neighbour is another one by
    /// then. If so, fewer costs are computed.
    fn is_monotone(&self) -> bool {
        false
    }
}

/// Nothing costs anything: pairs go by number.
#[derive(Clone, Copy, Debug, Default)]
pub struct Free;

impl Criterion for Free {
    fn cost(&self, _: &CellComplex, _: Pair) -> f32 {
        0.0
    }

    fn is_monotone(&self) -> bool {
        true
    }
}

/// The first three coordinates of vertices.
fn positions(coordinates: &Coordinates) -> Vec<[f32; 3]> {
    fn rows<T: Copy>(values: &[T], dim: usize, narrow: fn(T) -> f32) -> Vec<[f32; 3]> {
        let row = |row: &[T]| {
            let mut position = [0.0; 3];
            position.iter_mut().zip(row).for_each(|(to, &from)| *to = narrow(from));
            position
        };
        if dim == 0 { Vec::new() } else { values.chunks_exact(dim).map(row).collect() }
    }
    match &coordinates.values {
        Scalars::F32(values) => rows(values, coordinates.dim, |value| value),
        #[expect(clippy::cast_possible_truncation, reason = "costs are single precision")]
        Scalars::F64(values) => rows(values, coordinates.dim, |value| value as f32),
    }
}

/// A value for each cell, from those of the vertices: each cell's is made of those of its boundary.
///
/// A cell without any is made of nothing.
fn spread<T: Copy>(complex: &CellComplex, vertices: &[T], nothing: T, join: impl Fn(T, T) -> T) -> Vec<T> {
    let mut values = vec![nothing; complex.num_ids()];
    let mut next = vertices.iter();
    let mut by_dim: Vec<CellId> = complex.cells().collect();
    by_dim.sort_by_key(|&cell| complex.dim_of(cell));
    for cell in by_dim {
        values[cell.index()] = if complex.dim_of(cell) == Some(0) {
            next.next().copied().unwrap_or(nothing)
        } else {
            let below = complex.boundary(cell).map(|arc| values[arc.cell.index()]);
            below.reduce(&join).unwrap_or(nothing)
        };
    }
    values
}

/// The extent of the cells that are deleted: the diagonal of the bounding box of their vertices (mcc-2012, 7). A cell that takes
/// in others takes their vertices too.
///
/// 24 bytes a cell.
#[derive(Clone, Debug)]
pub struct Extent {
    boxes: Vec<[[f32; 3]; 2]>,
}

impl Extent {
    /// The boxes of the cells of a complex, of which the k-th 0-cell is at the k-th place of `coordinates`; those after the
    /// third are left out.
    #[must_use]
    pub fn new(complex: &CellComplex, coordinates: &Coordinates) -> Self {
        let vertices: Vec<_> = positions(coordinates).into_iter().map(|position| [position; 2]).collect();
        let empty = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        Self { boxes: spread(complex, &vertices, empty, join) }
    }
}

/// The least box around two.
#[inline]
fn join([low_a, high_a]: [[f32; 3]; 2], [low_b, high_b]: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    let both = |a: [f32; 3], b: [f32; 3], pick: fn(f32, f32) -> f32| std::array::from_fn(|axis| pick(a[axis], b[axis]));
    [both(low_a, low_b, f32::min), both(high_a, high_b, f32::max)]
}

impl Criterion for Extent {
    #[inline]
    fn cost(&self, _: &CellComplex, pair: Pair) -> f32 {
        let [low, high] = join(self.boxes[pair.low.index()], self.boxes[pair.high.index()]);
        let squares = low.iter().zip(&high).map(|(low, high)| (high - low) * (high - low));
        // An empty box has no extent.
        if low[0] > high[0] { 0.0 } else { squares.sum::<f32>().sqrt() }
    }

    #[inline]
    fn killed(&mut self, pair: Pair) {
        if let Some(kept) = pair.kept {
            let deleted = join(self.boxes[pair.low.index()], self.boxes[pair.high.index()]);
            let kept = &mut self.boxes[kept.index()];
            *kept = join(*kept, deleted);
        }
    }

    fn is_monotone(&self) -> bool {
        true
    }
}

/// The length of the edge that is contracted, or its like in other dimensions: the distance between the middles of the cell
/// that is deleted and of the one with which it is merged. The middle of a cell is that of the middles of its boundary, when
/// the complex is full.
///
/// 12 bytes a cell.
#[derive(Clone, Debug)]
pub struct Length {
    middles: Vec<[f32; 3]>,
}

impl Length {
    /// The middles of the cells of a complex, with coordinates as [`Extent::new`] takes them.
    #[must_use]
    pub fn new(complex: &CellComplex, coordinates: &Coordinates) -> Self {
        let vertices: Vec<_> = positions(coordinates).into_iter().map(|position| (position, 1.0_f32)).collect();
        let sum = |(a, m): ([f32; 3], f32), (b, n): ([f32; 3], f32)| {
            let mean = |axis: usize| (a[axis] * m + b[axis] * n) / (m + n);
            (std::array::from_fn(mean), m + n)
        };
        let middles = spread(complex, &vertices, ([0.0; 3], 1.0), sum);
        Self { middles: middles.into_iter().map(|(middle, _)| middle).collect() }
    }
}

impl Criterion for Length {
    #[inline]
    fn cost(&self, complex: &CellComplex, pair: Pair) -> f32 {
        let same_as_low = |kept| complex.dim_of(kept) == complex.dim_of(pair.low);
        let (from, to) = match pair.kept {
            Some(kept) if same_as_low(kept) => (pair.low, kept),
            Some(kept) => (pair.high, kept),
            None => (pair.low, pair.high),
        };
        let (a, b) = (self.middles[from.index()], self.middles[to.index()]);
        a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt()
    }
}

/// The difference of a scalar field between the two cells that are deleted; the value of a cell is the largest of its vertices.
///
/// 4 bytes a cell.
#[derive(Clone, Debug)]
pub struct Field {
    values: Vec<f32>,
}

impl Field {
    /// The field of which the k-th 0-cell has the k-th value.
    #[must_use]
    pub fn new(complex: &CellComplex, vertices: &[f32]) -> Self {
        Self { values: spread(complex, vertices, f32::NEG_INFINITY, f32::max) }
    }

    /// The field with these values on the cells, by number.
    #[must_use]
    pub const fn of_cells(values: Vec<f32>) -> Self {
        Self { values }
    }

    /// A coordinate as a field; 0 where there are fewer.
    #[must_use]
    pub fn of_coordinate(complex: &CellComplex, coordinates: &Coordinates, axis: usize) -> Self {
        let values: Vec<f32> = positions(coordinates).iter().map(|row| row.get(axis).copied().unwrap_or(0.0)).collect();
        Self::new(complex, &values)
    }
}

impl Criterion for Field {
    #[inline]
    fn cost(&self, _: &CellComplex, pair: Pair) -> f32 {
        let value = |cell: CellId| self.values.get(cell.index()).copied().unwrap_or(0.0);
        let difference = (value(pair.low) - value(pair.high)).abs();
        // Two cells without vertices.
        if difference.is_nan() { 0.0 } else { difference }
    }
}

/// The least vertex of each cell, by its number among the cells: where the cell is.
pub(super) fn sites(complex: &CellComplex) -> Vec<u32> {
    let vertices = (0..narrow(complex.num_ids())).filter(|&cell| complex.dim_of(CellId::new(cell)) == Some(0));
    let vertices: Vec<u32> = vertices.collect();
    spread(complex, &vertices, 0, u32::min)
}
