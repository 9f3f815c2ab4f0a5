//! What the witnesses witness of one dimension, as far as its prefixes are in the complex.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::build::narrow;
use crate::witness::levels::{Candidate, Levels, position, sort_and_merge};
use crate::witness::table::Row;

/// A landmark that is not a vertex of the complex.
pub(super) const ABSENT: u32 = u32::MAX;

/// What one task finds: candidates, and which of its witnesses go on.
pub(super) struct Found<C> {
    /// Sorted; each simplex once.
    pub(super) candidates: Vec<C>,
    /// One for each witness, in their order.
    pub(super) outcomes: Vec<Outcome>,
    /// Whether memory held all of them.
    pub(super) is_complete: bool,
}

/// How many candidates all tasks hold, as far as they are many, and may hold.
pub(super) struct Memory {
    pub(super) held: AtomicU64,
    pub(super) limit: u64,
}

/// What a witness has found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Outcome {
    /// Nothing: it is active no longer, as a witness of a simplex witnesses the facet without its farthest vertex too.
    Nothing,
    /// The one simplex of this dimension that it witnesses, as a candidate with this prefix and last vertex.
    One(u32, u32),
    /// It may witness several.
    Several,
}

/// Where an active witness stands before dimension j is looked at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Pointer {
    /// The one (j − 1)-simplex that it witnesses, which is in the complex.
    One(u32),
    /// It may witness several.
    Several,
}

/// Looks for the j-simplices that witnesses witness, in the levels below j.
pub(super) struct Finder<'a, C> {
    levels: &'a Levels,
    /// The vertex of each landmark, or [`ABSENT`].
    vertices: &'a [u32],
    relaxation: f64,
    found: Found<C>,
    /// Candidates that are kept before repeated ones are looked for, and those that are counted in `memory`.
    room: usize,
    counted: usize,
    memory: &'a Memory,
    near: Vec<NearVertex>,
    /// For the landmark of each rank: how many nearer ones every simplex must have that it is the farthest vertex of.
    forced: Vec<u32>,
    word: Vec<u32>,
}

/// A vertex near a witness, and the rank of its landmark among the nearest ones.
#[derive(Clone, Copy)]
struct NearVertex {
    vertex: u32,
    rank: u32,
}

/// A part of a simplex: its first vertices.
#[derive(Clone, Copy)]
struct Prefix {
    /// Its number in the level of its dimension.
    node: u32,
    /// How many vertices it has.
    len: usize,
    /// The largest rank in it.
    farthest: u32,
    /// The ranks in it, as far as they are below 64.
    chosen: u64,
}

impl<'a, C: Candidate> Finder<'a, C> {
    pub(super) fn new(levels: &'a Levels, vertices: &'a [u32], relaxation: f64, memory: &'a Memory) -> Self {
        Self {
            levels,
            vertices,
            relaxation,
            found: Found { candidates: Vec::new(), outcomes: Vec::new(), is_complete: true },
            room: 1 << 20,
            counted: 0,
            memory,
            near: Vec::new(),
            forced: Vec::new(),
            word: Vec::new(),
        }
    }

    pub(super) fn finish(mut self) -> Found<C> {
        sort_and_merge(&mut self.found.candidates);
        self.found
    }

    /// Looks for the j-simplices that the witness with this row and pointer witnesses; j is the number of levels, and
    /// the row has at least j + 1 landmarks or all of them.
    pub(super) fn look(&mut self, row: Row<'_>, pointer: Pointer) {
        let dim = self.levels.len();
        let outcome = match row.distances.get(dim) {
            None => Outcome::Nothing,
            Some(_) if row.width(dim, self.relaxation) == dim + 1 => self.nearest(&row.landmarks[..=dim], pointer),
            Some(_) => self.enumerate(row, dim),
        };
        self.found.outcomes.push(outcome);
    }

    /// Merges repeated candidates when there are many; whether there is room for more.
    fn make_room(&mut self) -> bool {
        if self.found.candidates.len() < self.room {
            return self.found.is_complete;
        }
        sort_and_merge(&mut self.found.candidates);
        let count = self.found.candidates.len();
        let held = self.memory.held.fetch_add((count - self.counted) as u64, Ordering::Relaxed);
        self.found.is_complete &= held + (count - self.counted) as u64 <= self.memory.limit;
        self.counted = count;
        self.room = self.room.max(2 * count);
        self.found.is_complete
    }

    /// The simplex of the j + 1 nearest landmarks, where no other j-simplex is witnessed.
    ///
    /// The word splits at the new landmark, [σ] = [σ′]·[s]·[σ″]; if σ″ is empty, the pointer is the prefix, else it is
    /// found from the root.
    fn nearest(&mut self, landmarks: &[u32], pointer: Pointer) -> Outcome {
        self.word.clear();
        self.word.extend(landmarks.iter().map(|&landmark| self.vertices[landmark as usize]));
        let newest = self.word.last().copied().unwrap_or(ABSENT);
        self.word.sort_unstable();
        let Some((&last, prefix)) = self.word.split_last().filter(|&(&last, _)| last != ABSENT) else {
            return Outcome::Nothing;
        };
        let prefix = match pointer {
            Pointer::One(node) if last == newest => Some(node),
            _ => self.levels.find(prefix),
        };
        let Some(prefix) = prefix else { return Outcome::Nothing };
        self.found.candidates.push(C::new(prefix, last, || 0.0));
        Outcome::One(prefix, last)
    }

    /// All that a witness witnesses.
    ///
    /// Let m_a be the distance of the landmark of rank a, and f_a the number of ranks b with m_a − m_b > ρ. A simplex
    /// whose farthest vertex has rank a is witnessed if and only if it has all of the f_a nearest landmarks. So vertices
    /// are chosen in increasing order, along the tree, as long as no landmark was left out that is needed and there is
    /// room for those that are needed and not yet chosen.
    fn enumerate(&mut self, row: Row<'_>, dim: usize) -> Outcome {
        let width = row.width(dim, self.relaxation);
        let distances = &row.distances[..width];
        self.forced.clear();
        let mut needed = 0;
        for distance in distances {
            while distance - distances[needed] > self.relaxation {
                needed += 1;
            }
            // Ranks up to `width` need at most `dim` others.
            self.forced.push(narrow(needed));
        }
        self.near.clear();
        let mut absent = 0;
        for (rank, &landmark) in (0..).zip(&row.landmarks[..width]) {
            match self.vertices[landmark as usize] {
                ABSENT => absent |= bit(rank),
                vertex => self.near.push(NearVertex { vertex, rank }),
            }
        }
        self.near.sort_unstable_by_key(|near| near.vertex);
        let before = self.found.candidates.len();
        self.extend(Prefix { node: 0, len: 0, farthest: 0, chosen: 0 }, 0, absent, distances);
        if self.found.candidates.len() > before { Outcome::Several } else { Outcome::Nothing }
    }

    /// Finds the candidates with this prefix and further vertices from position `from` of the near ones on; `skipped`
    /// are the ranks that are left out.
    fn extend(&mut self, prefix: Prefix, from: usize, mut skipped: u64, distances: &[f64]) {
        let levels = self.levels;
        let missing = levels.len() - prefix.len;
        if missing == 0 && !self.make_room() {
            return;
        }
        let (mut first, mut children) =
            if prefix.len == 0 || missing == 0 { (0, &[][..]) } else { levels.children(prefix.len - 1, prefix.node) };
        let prefix_needs = if prefix.len == 0 { 0 } else { below(self.forced[prefix.farthest as usize]) };
        for position_of_near in from..self.near.len().saturating_sub(missing) {
            let NearVertex { vertex, rank } = self.near[position_of_near];
            let farthest = rank.max(prefix.farthest);
            let needs = below(self.forced[farthest as usize]);
            let chosen = prefix.chosen | bit(rank);
            if needs & skipped == 0 && (needs & !chosen).count_ones() as usize <= missing {
                if missing == 0 {
                    let value = || relaxation(chosen, farthest, distances);
                    self.found.candidates.push(C::new(prefix.node, vertex, value));
                } else {
                    if prefix.len > 0 {
                        let advance = position(children, vertex);
                        (first, children) = (first + narrow(advance), &children[advance..]);
                    }
                    if prefix.len == 0 || children.first() == Some(&vertex) {
                        let node = if prefix.len == 0 { vertex } else { first };
                        let longer = Prefix { node, len: prefix.len + 1, farthest, chosen };
                        self.extend(longer, position_of_near + 1, skipped, distances);
                    }
                }
            }
            skipped |= bit(rank);
            if prefix_needs & bit(rank) != 0 {
                return;
            }
        }
    }
}

/// The least relaxation at which a simplex is witnessed: how much farther its farthest vertex is than the nearest
/// landmark that it leaves out.
fn relaxation(chosen: u64, farthest: u32, distances: &[f64]) -> f64 {
    // Not past 32: a simplex has no more vertices.
    let left_out = chosen.trailing_ones();
    if left_out > farthest { 0.0 } else { distances[farthest as usize] - distances[left_out as usize] }
}

/// The bit of a rank; none for ranks that are needed by no simplex of up to 32 vertices.
fn bit(rank: u32) -> u64 {
    1_u64.checked_shl(rank).unwrap_or(0)
}

/// The bits of the ranks below one that is at most 31.
fn below(rank: u32) -> u64 {
    bit(rank).wrapping_sub(1)
}
