//! All faces whose least vertex is in a bucket, found from the tails that start at each vertex v: a trie below v, as bit
//! masks.
//!
//! Below v stand the vertices of its tails, and below any node the vertices that follow it in some tail. Vertices are
//! *letters* here, positions among the neighbours of v, so that the children of a node are a bit mask, a tail is one too,
//! and the number of a child is a count of bits. The masks are found ([`Finder`]), and take a tenth of the arrays that are
//! [written](Bucket::write) from them once it is known where. Vertices with more neighbours than a mask has bits are
//! handled by [`super::local`].

mod find;
mod write;

use crate::build::local::{self, Level};

pub(super) use find::Finder;
pub(super) use write::Slices;

/// The faces whose least vertex is in a bucket.
#[derive(Default)]
pub(super) struct Bucket {
    /// How many there are of each dimension.
    pub(super) counts: Vec<usize>,
    /// How each simplex is listed, by dimension; empty if none is.
    pub(super) listed: Vec<Vec<u8>>,
    /// Of each vertex.
    shapes: Vec<Shape>,
    /// The neighbours of all vertices but the wide ones, increasing for each.
    neighbours: Vec<u32>,
    /// The children of the nodes of each level, from 1, save those of the last level of each trie: where they fit 16 bits,
    narrow_masks: Vec<Vec<u16>>,
    /// and where they do not.
    masks: Vec<Vec<u64>>,
    wide: Vec<Vec<Level>>,
}

/// How large the trie of a vertex is.
#[derive(Clone, Copy)]
struct Shape {
    /// Neighbours, if it is not wide.
    degree: u8,
    /// Levels; [`WIDE`] if it is one of the wide ones.
    num_levels: u8,
}

/// Stands for the levels of a trie without masks.
const WIDE: u8 = u8::MAX;

impl Bucket {
    fn mark(&mut self, dim: usize, number: usize, mark: u8) {
        local::add_mark(&mut self.listed[dim], number, mark);
    }

    /// Makes room for tries of so many levels.
    fn make_room(&mut self, num_levels: usize) {
        if self.counts.len() <= num_levels {
            self.counts.resize(num_levels + 1, 0);
            self.listed.resize_with(num_levels + 1, Vec::new);
        }
        if self.masks.len() < num_levels {
            self.masks.resize_with(num_levels, Vec::new);
            self.narrow_masks.resize_with(num_levels, Vec::new);
        }
    }
}

/// A bit mask of letters as a bucket keeps it.
trait Mask: Copy {
    /// The largest number of letters.
    const BITS: usize;

    /// Those of a bucket, by level.
    fn of(bucket: &Bucket) -> &[Vec<Self>];
    fn of_mut(bucket: &mut Bucket) -> (&mut [Vec<Self>], &mut [Vec<u8>]);
    /// From one that fits.
    fn new(bits: u64) -> Self;
    fn bits(self) -> u64;
}

impl Mask for u16 {
    const BITS: usize = 16;

    fn of(bucket: &Bucket) -> &[Vec<Self>] {
        &bucket.narrow_masks
    }

    fn of_mut(bucket: &mut Bucket) -> (&mut [Vec<Self>], &mut [Vec<u8>]) {
        (&mut bucket.narrow_masks, &mut bucket.listed)
    }

    #[expect(clippy::cast_possible_truncation, reason = "so few letters")]
    fn new(bits: u64) -> Self {
        bits as u16
    }

    fn bits(self) -> u64 {
        u64::from(self)
    }
}

impl Mask for u64 {
    const BITS: usize = 64;

    fn of(bucket: &Bucket) -> &[Vec<Self>] {
        &bucket.masks
    }

    fn of_mut(bucket: &mut Bucket) -> (&mut [Vec<Self>], &mut [Vec<u8>]) {
        (&mut bucket.masks, &mut bucket.listed)
    }

    fn new(bits: u64) -> Self {
        bits
    }

    fn bits(self) -> u64 {
        self
    }
}
