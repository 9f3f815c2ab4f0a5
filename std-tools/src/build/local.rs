//! All faces whose least vertex is v, found from the listed simplices that contain v: the small problem into which the
//! construction falls apart.
//!
//! What follows v in a listed word is a *tail*. The faces of v are a trie: below v stand the vertices of the tails, and
//! below any node the vertices that follow it in some tail. The trie is walked level by level. Vertices are *letters*
//! here, positions among the neighbours of v, so that the children of a node are a bit mask and the number of a child is
//! a count of bits; nodes of vertices with more neighbours than bits are told apart by sorting. The facets that keep v
//! are nodes of the same trie, hence known at once: facet i of a child with letter y is the child y of facet i of the
//! parent.

use rayon::slice::ParallelSliceMut;

use crate::build::{BuildError, Reservation, narrow};

/// Mark of a simplex that is listed in an even permutation of its word.
pub(super) const EVEN: u8 = 1;
/// Mark of a simplex that is listed in an odd permutation of its word.
pub(super) const ODD: u8 = 2;
/// Mark of a vertex that is kept though unused.
pub(super) const UNUSED: u8 = 4;

/// The largest number of neighbours for which nodes keep their children as a bit mask.
const MASK_BITS: usize = 64;

/// Keys from which on sorting them is split among threads.
const PARALLEL_SORT: usize = 1 << 15;

/// The simplices of one dimension whose least vertices are a range of ids. Numbers in it are relative to that range.
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
        if self.listed.len() < self.labels.len() {
            self.listed.resize(self.labels.len(), 0);
        }
        self.listed[node] |= mark;
    }

    /// To be called when the level has all its simplices.
    pub(super) fn finish(&mut self) {
        if !self.listed.is_empty() {
            self.listed.resize(self.labels.len(), 0);
        }
    }
}

/// The part of a listed word that follows v.
struct Tail {
    /// Where its letters start and end.
    start: usize,
    end: usize,
    /// [`EVEN`] or [`ODD`] if v is the first vertex of the word, else 0.
    mark: u8,
}

/// A node and a tail that goes on below it.
struct Visit {
    node: u32,
    tail: u32,
    /// Where in the letters the tail goes on.
    next: u32,
}

/// The nodes of one level.
#[derive(Default)]
struct Nodes {
    /// The last letter of each node.
    letters: Vec<u32>,
    /// The letters of the children of each node as bits, where there are few enough neighbours.
    masks: Vec<u64>,
    /// The first child of each node, and the end of the last node's children.
    first_child: Vec<u32>,
}

/// Working memory, reused from vertex to vertex.
#[derive(Default)]
pub(super) struct Local {
    neighbours: Vec<u32>,
    /// The letters of all tails.
    letters: Vec<u32>,
    tails: Vec<Tail>,
    nodes: Vec<Nodes>,
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
        let start = self.letters.len();
        self.letters.extend_from_slice(tail);
        self.tails.push(Tail { start, end: self.letters.len(), mark });
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
        self.visits.clear();
        let starts = self.tails.iter().zip(0..).filter(|(tail, _)| tail.start < tail.end);
        self.visits.extend(starts.map(|(tail, number)| Visit { node: 0, tail: number, next: narrow(tail.start) }));
        self.bases.clear();
        self.bases.push(level(levels, 0).first_child.len());
        node_level(&mut self.nodes, 0).letters.resize(1, 0);

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
        self.tails.clear();
        Ok(())
    }

    /// Replaces the vertices in the tails by their positions among all of them.
    fn name_letters(&mut self) {
        self.neighbours.clear();
        self.neighbours.extend_from_slice(&self.letters);
        self.neighbours.sort_unstable();
        self.neighbours.dedup();
        for letter in &mut self.letters {
            *letter = narrow(self.neighbours.partition_point(|&vertex| vertex < *letter));
        }
    }

    /// Finds the children of the nodes of level `dim` from the visits: how many, their letters, and where the children
    /// of each node start.
    fn find_children(&mut self, dim: usize) -> usize {
        let by_mask = self.neighbours.len() <= MASK_BITS;
        node_level(&mut self.nodes, dim + 1);
        let [here, below] = &mut self.nodes[dim..dim + 2] else { unreachable!("two levels") };
        here.masks.clear();
        here.first_child.clear();
        here.first_child.push(0);
        below.letters.clear();
        if by_mask {
            here.masks.resize(here.letters.len(), 0);
            for visit in &self.visits {
                let end = self.tails[visit.tail as usize].end;
                for letter in &self.letters[visit.next as usize..end] {
                    here.masks[visit.node as usize] |= 1 << letter;
                }
            }
            for mut mask in here.masks.iter().copied() {
                while mask != 0 {
                    below.letters.push(mask.trailing_zeros());
                    mask &= mask - 1;
                }
                here.first_child.push(narrow(below.letters.len()));
            }
        } else {
            self.keys.clear();
            for visit in &self.visits {
                let end = self.tails[visit.tail as usize].end;
                let letters = &self.letters[visit.next as usize..end];
                self.keys.extend(letters.iter().map(|&letter| u64::from(visit.node) << 32 | u64::from(letter)));
            }
            if self.keys.len() >= PARALLEL_SORT {
                self.keys.par_sort_unstable();
            } else {
                self.keys.sort_unstable();
            }
            self.keys.dedup();
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
        let nodes = &self.nodes[dim];
        for (node, range) in nodes.first_child.windows(2).enumerate() {
            let row = (self.bases[dim] + node) * dim;
            for &letter in &self.nodes[dim + 1].letters[range[0] as usize..range[1] as usize] {
                for i in 0..dim {
                    let facet = here.facets[row + i] - narrow(self.bases[dim - 1]);
                    below.facets.push(base + self.child(dim - 1, facet, letter));
                }
                below.facets.push(base + narrow(node));
            }
        }
    }

    /// The child with last letter `letter` of a node of level `dim`; it has one.
    fn child(&self, dim: usize, node: u32, letter: u32) -> u32 {
        let nodes = &self.nodes[dim];
        let node = node as usize;
        let first = nodes.first_child[node];
        match nodes.masks.get(node) {
            Some(mask) => first + (mask & ((1 << letter) - 1)).count_ones(),
            None => {
                let siblings = &self.nodes[dim + 1].letters[first as usize..nodes.first_child[node + 1] as usize];
                first + narrow(siblings.partition_point(|&sibling| sibling < letter))
            }
        }
    }

    /// Takes the visits from the nodes of level `dim` to their children, and marks those that are listed simplices.
    fn descend(&mut self, levels: &mut [Level], dim: usize) {
        let mut next_visits = std::mem::take(&mut self.next_visits);
        next_visits.clear();
        for visit in &self.visits {
            let tail = &self.tails[visit.tail as usize];
            for position in visit.next as usize..tail.end {
                let child = self.child(dim, visit.node, self.letters[position]);
                if position + 1 < tail.end {
                    next_visits.push(Visit { node: child, tail: visit.tail, next: narrow(position + 1) });
                } else if tail.mark != 0 && position - tail.start == dim {
                    // No letter of the tail was left out on the way here.
                    levels[dim + 1].mark(self.bases[dim + 1] + child as usize, tail.mark);
                }
            }
        }
        self.next_visits = std::mem::replace(&mut self.visits, next_visits);
    }
}

/// The lower 32 bits.
#[expect(clippy::cast_possible_truncation)]
fn low_half(key: u64) -> u32 {
    key as u32
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
