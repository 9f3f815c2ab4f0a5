//! Places for the vertices of a complex that has none.
//!
//! Each connected component is laid out by itself: distances along edges from a few pivots, in the directions in which they
//! vary most (Brandes and Pich, *Eigensolver Methods for Progressive Multidimensional Scaling of Large Data*, 2006), are where
//! forces start: edges pull, vertices push each other away (Fruchterman and Reingold; far ones by groups, Barnes and Hut;
//! steps as in Hu, *Efficient and High Quality Force-Directed Graph Drawing*, 2005). Components are then put in rows.
//!
//! The same graph and seed give the same places, by any number of threads.

mod forces;
mod pivots;

/// A graph by the neighbours of each vertex.
pub(super) struct Graph {
    /// Where the neighbours of each vertex start, and the number of all at the end.
    offsets: Vec<u32>,
    neighbours: Vec<u32>,
}

/// The most vertices that are laid out: more take too long, and nothing is seen of them.
pub const MAX_VERTICES: usize = 500_000;

/// Why nothing is laid out.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{vertices} vertices without coordinates: layouts end at {MAX_VERTICES}")]
pub struct TooLarge {
    /// How many vertices there are.
    pub vertices: usize,
}

impl Graph {
    pub(super) fn new(vertices: usize, edges: &[[u32; 2]]) -> Self {
        let mut offsets = vec![0; vertices + 1];
        edges.iter().flatten().for_each(|&end| offsets[end as usize + 1] += 1);
        for vertex in 0..vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut next = offsets.clone();
        let mut neighbours = vec![0; 2 * edges.len()];
        for &[a, b] in edges {
            for [from, to] in [[a, b], [b, a]] {
                neighbours[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self { offsets, neighbours }
    }

    pub(super) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    pub(super) fn neighbours(&self, vertex: usize) -> &[u32] {
        &self.neighbours[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// For each vertex the number of its component, by increasing least vertex; and how many there are.
    fn components(&self) -> (Vec<u32>, usize) {
        let mut component = vec![u32::MAX; self.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for start in 0..self.len() {
            if component[start] != u32::MAX {
                continue;
            }
            component[start] = count;
            stack.push(start);
            while let Some(vertex) = stack.pop() {
                for &other in self.neighbours(vertex) {
                    if component[other as usize] == u32::MAX {
                        component[other as usize] = count;
                        stack.push(other as usize);
                    }
                }
            }
            count += 1;
        }
        (component, count as usize)
    }
}

/// Places for the vertices of a graph, in a plane or in space. An edge is about as long as 1; the first coordinate varies most.
///
/// Cost: the edges, times some dozens of pivots; then for each of some rounds of forces, n log n. Less than a second for ten
/// thousand vertices.
///
/// # Errors
/// [`TooLarge`] for more than [`MAX_VERTICES`].
///
/// ```
/// let square = [[0, 1], [1, 2], [2, 3], [3, 0]];
/// let places = sig_tools::draw::layout::layout(4, &square, 2, 0)?;
/// assert!(places.iter().all(|place| place[2] == 0.0));
/// # Ok::<(), sig_tools::draw::layout::TooLarge>(())
/// ```
pub fn layout(vertices: usize, edges: &[[u32; 2]], dims: usize, seed: u64) -> Result<Vec<[f64; 3]>, TooLarge> {
    if vertices > MAX_VERTICES {
        return Err(TooLarge { vertices });
    }
    let graph = Graph::new(vertices, edges);
    let (component, count) = graph.components();
    let mut members = vec![Vec::new(); count];
    (0_u32..).zip(&component).for_each(|(vertex, &component)| members[component as usize].push(vertex));
    // The largest first; of equal ones that of the least vertex.
    members.sort_by_key(|members| std::cmp::Reverse(members.len()));
    let mut number = vec![0_u32; vertices];
    let mut pieces = Vec::with_capacity(count);
    for members in &members {
        (0..).zip(members).for_each(|(place, &vertex)| number[vertex as usize] = place);
        let edges: Vec<[u32; 2]> = members
            .iter()
            .flat_map(|&vertex| graph.neighbours(vertex as usize).iter().map(move |&other| [vertex, other]))
            .filter(|[vertex, other]| vertex < other)
            .map(|ends| ends.map(|end| number[end as usize]))
            .collect();
        pieces.push(connected(&Graph::new(members.len(), &edges), dims.clamp(2, 3), seed));
    }
    let mut places = vec![[0.0; 3]; vertices];
    for ([left, bottom], (piece, members)) in rows(&pieces).into_iter().zip(pieces.iter().zip(&members)) {
        for (&[x, y, z], &vertex) in piece.iter().zip(members) {
            places[vertex as usize] = [x + left, y + bottom, z];
        }
    }
    Ok(places)
}

/// Places for a connected graph, the least coordinates 0 in the first two.
fn connected(graph: &Graph, dims: usize, seed: u64) -> Vec<[f64; 3]> {
    let mut places = pivots::places(graph, dims, seed);
    forces::relax(graph, dims, &mut places);
    let low = [0, 1].map(|axis| places.iter().map(|place| place[axis]).fold(f64::INFINITY, f64::min));
    for place in &mut places {
        place[0] -= low[0];
        place[1] -= low[1];
    }
    places
}

/// Where pieces go, which come by decreasing size: in rows about as wide together as they are high.
fn rows(pieces: &[Vec<[f64; 3]>]) -> Vec<[f64; 2]> {
    let extent =
        |piece: &Vec<[f64; 3]>| [0, 1].map(|axis| piece.iter().map(|place| place[axis]).fold(0.0, f64::max) + 1.0);
    let extents: Vec<[f64; 2]> = pieces.iter().map(extent).collect();
    let area: f64 = extents.iter().map(|[width, height]| width * height).sum();
    let width = extents.iter().map(|extent| extent[0]).fold(1.25 * area.sqrt(), f64::max);
    let ([mut x, mut y], mut row) = ([0.0, 0.0], 0.0_f64);
    let mut corners = Vec::with_capacity(pieces.len());
    for [wide, high] in extents {
        if x > 0.0 && x + wide > width {
            (x, y, row) = (0.0, y - row, 0.0);
        }
        corners.push([x, y - high]);
        x += wide;
        row = row.max(high);
    }
    corners
}
