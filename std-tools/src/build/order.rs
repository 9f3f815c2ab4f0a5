//! Numbering the vertices: the labels decide, or a curve, or the 1-skeleton, with ties broken by label.

use std::cmp::Ordering;

use rayon::prelude::*;

use crate::build::{BuildError, VertexOrder};
use crate::points::Points;
use crate::soup::{Coordinates, Labels, Scalars};

/// The number of a vertex that is not in the complex.
const ABSENT: u32 = u32::MAX;

/// Which vertex of the input has which id, and back.
pub(crate) struct Order {
    /// The id of each vertex number of the input, [`ABSENT`] if it is not in the complex.
    ids: Vec<u32>,
    /// The vertex number of each id.
    inputs: Vec<u32>,
    /// Vertices of the input that no simplex uses, in the complex or not.
    pub(crate) num_unused: usize,
    /// The first of them.
    unused: Vec<u32>,
}

impl Order {
    /// How many unused vertices are named.
    const MOST_NAMED: usize = 8;

    /// The labels of the first unused vertices of a mesh.
    pub(crate) fn name_unused(&self, labels: &Labels, declared: bool) -> Vec<String> {
        self.unused.iter().filter(|_| declared).map(|&vertex| labels.name(vertex)).collect()
    }

    /// The number of vertices in the complex.
    pub(crate) fn num_vertices(&self) -> usize {
        self.inputs.len()
    }

    /// The id of vertex number `input`, which is in the complex.
    pub(crate) fn id(&self, input: u32) -> u32 {
        self.ids[input as usize]
    }

    /// The vertex number of the vertex with id `id`.
    pub(crate) fn input(&self, id: u32) -> u32 {
        self.inputs[id as usize]
    }

    /// The vertex number of each id.
    pub(crate) fn inputs(&self) -> &[u32] {
        &self.inputs
    }

    /// The labels and coordinates of the vertices of the complex, by id.
    pub(crate) fn permute(&self, labels: Labels, coordinates: Option<Coordinates>) -> (Labels, Option<Coordinates>) {
        if self.inputs.len() == labels.len() && self.inputs.iter().zip(0..).all(|(&input, id)| input == id) {
            return (numbered_if_possible(labels), coordinates);
        }
        let labels = match labels {
            Labels::Numbered(_) => Labels::Integers(self.inputs.iter().map(|&input| u64::from(input)).collect()),
            Labels::Integers(labels) => Labels::Integers(permute_rows(&labels, 1, &self.inputs)),
            Labels::Tokens(mut labels) => {
                Labels::Tokens(self.inputs.iter().map(|&input| std::mem::take(&mut labels[input as usize])).collect())
            }
        };
        let coordinates = coordinates.map(|Coordinates { dim, values }| {
            let values = match values {
                Scalars::F32(values) => Scalars::F32(permute_rows(&values, dim, &self.inputs)),
                Scalars::F64(values) => Scalars::F64(permute_rows(&values, dim, &self.inputs)),
            };
            Coordinates { dim, values }
        });
        (numbered_if_possible(labels), coordinates)
    }
}

/// The rows `order` of a table with `width` columns.
fn permute_rows<T: Copy>(rows: &[T], width: usize, order: &[u32]) -> Vec<T> {
    order.iter().flat_map(|&row| &rows[row as usize * width..(row as usize + 1) * width]).copied().collect()
}

/// Labels that are their own positions take no room.
pub(crate) fn numbered_if_possible(labels: Labels) -> Labels {
    match labels {
        Labels::Integers(labels) if labels.iter().zip(0..).all(|(&label, id)| label == id) => {
            Labels::Numbered(labels.len())
        }
        other => other,
    }
}

/// Numbers the vertices that are `used`, and the others if `keep_unused`.
///
/// # Errors
/// [`BuildError::NoCoordinates`] and [`BuildError::MalformedCoordinates`].
pub(crate) fn number_vertices(
    labels: &Labels,
    coordinates: Option<&Coordinates>,
    simplices: &[Vec<u32>],
    used: &[bool],
    keep_unused: bool,
    order: VertexOrder,
) -> Result<Order, BuildError> {
    if let Some(Coordinates { dim, values }) = coordinates {
        let values = match values {
            Scalars::F32(values) => values.len(),
            Scalars::F64(values) => values.len(),
        };
        if dim.checked_mul(labels.len()) != Some(values) {
            return Err(BuildError::MalformedCoordinates { values, vertices: labels.len(), dim: *dim });
        }
    }
    // The check of the simplices has seen that vertex numbers are 32-bit.
    let mut inputs: Vec<u32> = (0..crate::build::narrow(used.len())).collect();
    if !keep_unused {
        inputs.retain(|&input| used[input as usize]);
    }
    match labels {
        Labels::Numbered(_) => {}
        Labels::Integers(labels) => inputs.sort_unstable_by_key(|&input| labels[input as usize]),
        Labels::Tokens(labels) => {
            inputs.sort_unstable_by(|&a, &b| labels[a as usize].as_bytes().cmp(labels[b as usize].as_bytes()));
        }
    }
    // Labels are different, and what follows breaks ties by position, which now is the rank of the label.
    match (order, coordinates) {
        (VertexOrder::Input, _) | (VertexOrder::Auto, None) => {}
        (VertexOrder::Hilbert, None) => return Err(BuildError::NoCoordinates),
        (VertexOrder::Auto | VertexOrder::Hilbert, Some(Coordinates { dim, values })) => match values {
            Scalars::F32(values) => sort_along_curve(&mut inputs, *dim, |at| f64::from(values[at])),
            Scalars::F64(values) => sort_along_curve(&mut inputs, *dim, |at| values[at]),
        },
        (VertexOrder::Rcm, _) => {
            let ids = invert(&inputs, used.len());
            let ranks = reverse_cuthill_mckee(inputs.len(), simplices, &ids);
            inputs = permute_rows(&inputs, 1, &ranks);
        }
    }
    let ids = invert(&inputs, used.len());
    let unused = (0..).zip(used).filter(|(_, used)| !**used).map(|(input, _)| input).take(Order::MOST_NAMED).collect();
    Ok(Order { ids, inputs, num_unused: used.iter().filter(|&&used| !used).count(), unused })
}

/// The id of each of `count` vertex numbers, given the vertex number of each id.
fn invert(inputs: &[u32], count: usize) -> Vec<u32> {
    let mut ids = vec![ABSENT; count];
    for (&input, id) in inputs.iter().zip(0..) {
        ids[input as usize] = id;
    }
    ids
}

/// Bits a coordinate on the curve; three of them fill a 63-bit key.
const CURVE_BITS: u32 = 21;

/// The numbers of points along the Hilbert curve, ties by number.
pub(crate) fn hilbert_order(points: &Points) -> Vec<usize> {
    let mut order: Vec<u32> = (0..crate::build::narrow(points.len())).collect();
    sort_along_curve(&mut order, points.dim(), |at| points.values()[at]);
    order.into_iter().map(|point| point as usize).collect()
}

/// Stable sort by position on the Hilbert curve through the bounding cube of the first three of `dim` coordinates;
/// `value` is a coordinate by its place in the table.
fn sort_along_curve(inputs: &mut Vec<u32>, dim: usize, value: impl Fn(usize) -> f64 + Sync) {
    let axes = dim.min(3);
    let at = |input: u32, axis: usize| {
        let value = value(input as usize * dim + axis);
        // A point that is nowhere has to stand somewhere.
        if value.is_finite() { value } else { 0.0 }
    };
    let mut low = [f64::INFINITY; 3];
    let mut extent = 0.0_f64;
    for (axis, low) in low.iter_mut().enumerate().take(axes) {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for &input in &*inputs {
            least = least.min(at(input, axis));
            most = most.max(at(input, axis));
        }
        *low = least;
        extent = extent.max(most - least);
    }
    let scale = f64::from((1_u32 << CURVE_BITS) - 1);
    // With the position among the inputs, so that ties need no stable sort, which takes as much memory again.
    let mut keyed: Vec<(u64, u32)> = inputs
        .par_iter()
        .zip(0..crate::build::narrow(inputs.len()))
        .map(|(&input, position)| {
            let mut cell = [0_u32; 3];
            for axis in 0..axes {
                // Dividing first cannot overflow where the extent is huge; a saturating cast takes NaN (0/0) to 0.
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let quantised = ((at(input, axis) - low[axis]) / extent * scale) as u32;
                cell[axis] = quantised;
            }
            (hilbert_index(&mut cell[..axes]), position)
        })
        .collect();
    keyed.par_sort_unstable();
    *inputs = keyed.into_iter().map(|(_, position)| inputs[position as usize]).collect();
}

/// The position of a cell on the Hilbert curve of its dimension, [`CURVE_BITS`] a coordinate.
///
/// J. Skilling, *Programming the Hilbert curve*, AIP Conf. Proc. 707 (2004): undo the excess work of the recursive
/// reflections from the highest bit down, Gray decode, interleave.
fn hilbert_index(cell: &mut [u32]) -> u64 {
    let axes = cell.len();
    for bit in (1..CURVE_BITS).rev() {
        let below = (1_u32 << bit) - 1;
        for axis in 0..axes {
            if cell[axis] >> bit & 1 == 1 {
                cell[0] ^= below;
            } else {
                let swap = (cell[0] ^ cell[axis]) & below;
                cell[0] ^= swap;
                cell[axis] ^= swap;
            }
        }
    }
    for axis in 1..axes {
        cell[axis] ^= cell[axis - 1];
    }
    let mut flip = 0;
    for bit in (1..CURVE_BITS).rev() {
        if axes > 0 && cell[axes - 1] >> bit & 1 == 1 {
            flip ^= (1_u32 << bit) - 1;
        }
    }
    let mut index = 0;
    for bit in (0..CURVE_BITS).rev() {
        for coordinate in &*cell {
            index = index << 1 | u64::from((coordinate ^ flip) >> bit & 1);
        }
    }
    index
}

/// The vertices 0..`count` in reverse Cuthill–McKee order: breadth-first in each component from a vertex of least
/// degree, neighbours by increasing degree, all reversed; ties by number. `ids` takes vertex numbers of the input to
/// 0..`count`.
fn reverse_cuthill_mckee(count: usize, simplices: &[Vec<u32>], ids: &[u32]) -> Vec<u32> {
    let mut edges: Vec<(u32, u32)> = Vec::new();
    for (dim, flat) in simplices.iter().enumerate().skip(1) {
        for simplex in flat.chunks_exact(dim + 1) {
            for (k, &a) in simplex.iter().enumerate() {
                for &b in &simplex[..k] {
                    let (a, b) = (ids[a as usize], ids[b as usize]);
                    edges.extend([(a, b), (b, a)]);
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
    }
    let mut starts = vec![0_usize; count + 1];
    for &(a, _) in &edges {
        starts[a as usize + 1] += 1;
    }
    for vertex in 0..count {
        starts[vertex + 1] += starts[vertex];
    }
    let degree = |vertex: u32| starts[vertex as usize + 1] - starts[vertex as usize];
    let by_degree = |a: &u32, b: &u32| -> Ordering { (degree(*a), a).cmp(&(degree(*b), b)) };

    let mut roots: Vec<u32> = (0..).take(count).collect();
    roots.sort_unstable_by(by_degree);
    let mut placed = vec![false; count];
    let mut order = Vec::with_capacity(count);
    let mut neighbours = Vec::new();
    for root in roots {
        if std::mem::replace(&mut placed[root as usize], true) {
            continue;
        }
        let mut next = order.len();
        order.push(root);
        while let Some(&vertex) = order.get(next) {
            next += 1;
            let adjacent = &edges[starts[vertex as usize]..starts[vertex as usize + 1]];
            neighbours.clear();
            neighbours.extend(adjacent.iter().map(|&(_, b)| b).filter(|&b| !placed[b as usize]));
            neighbours.sort_unstable_by(by_degree);
            for &neighbour in &neighbours {
                placed[neighbour as usize] = true;
            }
            order.extend_from_slice(&neighbours);
        }
    }
    order.reverse();
    order
}
