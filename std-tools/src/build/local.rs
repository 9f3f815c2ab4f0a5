//! All faces whose least vertex is v, where v has more neighbours than a bit mask has room for ([`super::trie`]).
//!
//! What follows v in a listed word is a *tail*. The faces of v are a trie: below v stand the vertices of the tails, and
//! below any node the vertices that follow it in some tail. The trie is walked level by level, and the children of a level
//! are found by sorting. Vertices are *letters* here, positions among the neighbours of v. The facets that keep v are nodes
//! of the same trie, hence known at once: facet i of a child with letter y is the child y of facet i of the parent.

use rayon::slice::ParallelSliceMut;

use crate::build::{BuildError, Reservation, narrow};

/// Mark of a simplex that is listed in an even permutation of its word.
pub(super) const EVEN: u8 = 1;
/// Mark of a simplex that is listed in an odd permutation of its word.
pub(super) const ODD: u8 = 2;
/// Mark of a vertex that is kept though unused.
pub(super) const UNUSED: u8 = 4;

/// Keys from which on sorting them is split among threads.
const PARALLEL_SORT: usize = 1 << 15;

/// The simplices of one dimension with a least vertex. Numbers in it count from the first of these.
#[derive(Default)]
pub(super) struct Level {
    /// The last vertex of each simplex (not kept for the vertices themselves).
    pub(super) labels: Vec<u32>,
    /// The first child of each simplex.
    pub(super) first_child: Vec<u32>,
    /// The facets of each p-simplex but the one without its least vertex: p numbers.
    pub(super) facets: Vec<u32>,
    /// How each simplex is listed; empty if none of this dimension is.
    pub(super) listed: Vec<u8>,
}

impl Level {
    fn mark(&mut self, node: usize, mark: u8) {
        add_mark(&mut self.listed, node, mark);
    }
}

/// Adds a mark to that of number `number`; marks that are not there are 0.
#[inline]
pub(super) fn add_mark(marks: &mut Vec<u8>, number: usize, mark: u8) {
    if marks.len() <= number {
        marks.resize(number + 1, 0);
    }
    marks[number] |= mark;
}

/// A node, and the part of a tail that goes on below it.
struct Visit {
    node: u32,
    /// Where in the letters the part starts and ends.
    next: u32,
    end: u32,
    /// How the listed simplex is listed whose word is that of the node and all of the part; 0 if there is none.
    mark: u8,
}

/// The nodes of one level.
#[derive(Default)]
struct Nodes {
    /// The last letter of each node.
    letters: Vec<u32>,
    /// The first child of each node, and the end of the last node's children.
    first_child: Vec<u32>,
    /// Whether this is v alone, whose children are all letters.
    has_all: bool,
}

impl Nodes {
    /// The child with last letter `letter` of a node; it has one. `below` are the letters of the next level.
    #[inline]
    fn child(&self, node: u32, letter: u32, below: &[u32]) -> u32 {
        if self.has_all {
            return letter;
        }
        let node = node as usize;
        let first = self.first_child[node];
        let siblings = &below[first as usize..self.first_child[node + 1] as usize];
        first + narrow(siblings.partition_point(|&sibling| sibling < letter))
    }
}

/// Working memory, reused from vertex to vertex.
#[derive(Default)]
pub(super) struct Local {
    neighbours: Vec<u32>,
    names: Names,
    /// The letters of all tails.
    letters: Vec<u32>,
    nodes: Vec<Nodes>,
    /// First the tails below v, then what is left of them below the nodes of one level.
    visits: Vec<Visit>,
    next_visits: Vec<Visit>,
    keys: Vec<u64>,
    /// How many simplices of the range the earlier vertices have, in each dimension.
    bases: Vec<usize>,
}

impl Local {
    /// Takes in one tail of the next vertex to be [added](Self::add_vertex): increasing vertices, and the mark of the
    /// listed simplex if the vertex is its first.
    pub(super) fn push_tail(&mut self, tail: &[u32], mark: u8) {
        let next = narrow(self.letters.len());
        // Cheaper than a call to copy a few.
        self.letters.extend(tail.iter().copied());
        self.visits.push(Visit { node: 0, next, end: narrow(self.letters.len()), mark });
    }

    /// Appends one vertex and all faces of which it is the least, given the tails pushed since the last call.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if there are too many for memory or for 32-bit numbers within the range.
    pub(super) fn add_vertex(
        &mut self,
        levels: &mut Vec<Level>,
        reservation: &mut Reservation<'_>,
    ) -> Result<(), BuildError> {
        self.name_letters();
        self.bases.clear();
        self.bases.push(level(levels, 0).first_child.len());
        let root = node_level(&mut self.nodes, 0);
        root.letters.resize(1, 0);
        root.has_all = true;

        let mut dim = 0;
        loop {
            let base = level(levels, dim + 1).labels.len();
            self.bases.push(base);
            let num_children = self.find_children(dim);
            reservation.take(num_children)?;
            if u32::try_from(base + num_children).is_err() {
                return Err(reservation.too_large());
            }
            let base = narrow(base);
            let nodes = &self.nodes[dim];
            let first_children = nodes.first_child[..nodes.first_child.len() - 1].iter().map(|&child| base + child);
            levels[dim].first_child.extend(first_children);
            if num_children == 0 {
                break;
            }
            let labels = self.nodes[dim + 1].letters.iter().map(|&letter| self.neighbours[letter as usize]);
            levels[dim + 1].labels.extend(labels);
            self.push_facets(levels, dim);
            self.descend(levels, dim);
            dim += 1;
        }
        self.letters.clear();
        self.visits.clear();
        Ok(())
    }

    /// Replaces the vertices in the tails by their positions among all of them.
    fn name_letters(&mut self) {
        self.names.clear(self.letters.len());
        self.neighbours.clear();
        for letter in &mut self.letters {
            let slot = self.names.slot(*letter);
            if self.names.slots[slot].0 == ABSENT {
                self.names.slots[slot].0 = *letter;
                self.neighbours.push(*letter);
            }
            *letter = narrow(slot);
        }
        self.neighbours.sort_unstable();
        for (&vertex, letter) in self.neighbours.iter().zip(0..) {
            let slot = self.names.slot(vertex);
            self.names.slots[slot].1 = letter;
        }
        for letter in &mut self.letters {
            *letter = self.names.slots[*letter as usize].1;
        }
    }

    /// Finds the children of the nodes of level `dim` from the visits: how many, their letters, and where the children
    /// of each node start.
    fn find_children(&mut self, dim: usize) -> usize {
        node_level(&mut self.nodes, dim + 1);
        let [here, below] = &mut self.nodes[dim..dim + 2] else { unreachable!("two levels") };
        here.first_child.clear();
        here.first_child.push(0);
        below.letters.clear();
        if here.has_all {
            below.letters.extend((0..).take(self.neighbours.len()));
            here.first_child.push(narrow(below.letters.len()));
        } else {
            sort_children(&mut self.keys, &self.visits, &self.letters);
            let mut keys = self.keys.iter().copied().peekable();
            for node in 0..here.letters.len() as u64 {
                while let Some(key) = keys.next_if(|key| key >> 32 == node) {
                    below.letters.push(low_half(key));
                }
                here.first_child.push(narrow(below.letters.len()));
            }
        }
        below.letters.len()
    }

    /// Appends the facets of the children of the nodes of level `dim`.
    fn push_facets(&self, levels: &mut [Level], dim: usize) {
        let base = narrow(self.bases[dim]);
        let [here, below] = &mut levels[dim..dim + 2] else { unreachable!("two levels") };
        let (nodes, letters) = (&self.nodes[dim], &self.nodes[dim + 1].letters);
        // Not used if there is no level below.
        let lower = dim.saturating_sub(1);
        let (lower_nodes, lower_base) = (&self.nodes[lower], narrow(self.bases[lower]));
        let start = below.facets.len();
        below.facets.resize(start + letters.len() * (dim + 1), 0);
        let mut rows = below.facets[start..].chunks_exact_mut(dim + 1).zip(letters);
        for (node, range) in nodes.first_child.windows(2).enumerate() {
            let facets = &here.facets[(self.bases[dim] + node) * dim..][..dim];
            for (row, &letter) in rows.by_ref().take((range[1] - range[0]) as usize) {
                for (entry, facet) in row.iter_mut().zip(facets) {
                    *entry = base + lower_nodes.child(facet - lower_base, letter, &nodes.letters);
                }
                row[dim] = base + narrow(node);
            }
        }
    }

    /// Takes the visits from the nodes of level `dim` to their children, and marks those that are listed simplices.
    fn descend(&mut self, levels: &mut [Level], dim: usize) {
        let mut next_visits = std::mem::take(&mut self.next_visits);
        next_visits.clear();
        let (nodes, below) = (&self.nodes[dim], &self.nodes[dim + 1].letters);
        for &Visit { node, next, end, mark } in &self.visits {
            for position in next..end.max(1) - 1 {
                let node = nodes.child(node, self.letters[position as usize], below);
                // The others leave out a letter of the tail.
                let mark = if position == next { mark } else { 0 };
                next_visits.push(Visit { node, next: position + 1, end, mark });
            }
            if next + 1 == end && mark != 0 {
                let child = nodes.child(node, self.letters[next as usize], below);
                levels[dim + 1].mark(self.bases[dim + 1] + child as usize, mark);
            }
        }
        self.next_visits = std::mem::replace(&mut self.visits, next_visits);
    }
}

/// Fills `keys` with the pairs (node, letter of a child) of the visits, each once, in order.
fn sort_children(keys: &mut Vec<u64>, visits: &[Visit], letters: &[u32]) {
    keys.clear();
    for visit in visits {
        let letters = &letters[visit.next as usize..visit.end as usize];
        keys.extend(letters.iter().map(|&letter| u64::from(visit.node) << 32 | u64::from(letter)));
    }
    if keys.len() >= PARALLEL_SORT {
        keys.par_sort_unstable();
    } else {
        keys.sort_unstable();
    }
    keys.dedup();
}

/// The lower 32 bits.
#[expect(clippy::cast_possible_truncation)]
fn low_half(key: u64) -> u32 {
    key as u32
}

/// What stands in an empty slot; no vertex id is as large.
const ABSENT: u32 = u32::MAX;

/// A hash table from vertices to letters, by linear probing. It lives for a vertex, and is as small as that needs.
#[derive(Default)]
struct Names {
    slots: Vec<(u32, u32)>,
    shift: u32,
}

impl Names {
    /// Empties the table and makes room for `count` vertices.
    fn clear(&mut self, count: usize) {
        let bits = (2 * count).next_power_of_two().trailing_zeros().max(1);
        self.shift = 64 - bits;
        self.slots.clear();
        self.slots.resize(1 << bits, (ABSENT, 0));
    }

    /// The slot of a vertex, or the empty one where it goes.
    fn slot(&self, vertex: u32) -> usize {
        // Multiplication by 2^64 over the golden ratio spreads consecutive ids.
        let hash = u64::from(vertex).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mut slot = usize::try_from(hash >> self.shift).unwrap_or(0);
        while self.slots[slot].0 != vertex && self.slots[slot].0 != ABSENT {
            slot = (slot + 1) & (self.slots.len() - 1);
        }
        slot
    }
}

/// The level of dimension `dim`, made if it is not there.
fn level(levels: &mut Vec<Level>, dim: usize) -> &mut Level {
    if levels.len() <= dim {
        levels.resize_with(dim + 1, Level::default);
    }
    &mut levels[dim]
}

/// The nodes of level `dim`, made if they are not there.
fn node_level(nodes: &mut Vec<Nodes>, dim: usize) -> &mut Nodes {
    if nodes.len() <= dim {
        nodes.resize_with(dim + 1, Nodes::default);
    }
    &mut nodes[dim]
}
