//! Finds the tries of a bucket.

use crate::build::local::{self, EVEN, Local, UNUSED};
use crate::build::trie::{Bucket, Mask, Shape, WIDE};
use crate::build::words::records;
use crate::build::{BuildError, Reservation, narrow};

/// Slots in the table of names, as a power of two.
const SLOT_BITS: u32 = 8;
/// What stands in an empty slot; no vertex id is as large.
const ABSENT: u32 = u32::MAX;

/// A node, and the part of a tail that goes on below it.
struct Visit {
    /// The letters of the part; some.
    rest: u64,
    node: u32,
    /// How the listed simplex is listed whose word is that of the node and all of the part; 0 if there is none.
    mark: u8,
}

/// Where a tail is: from `at` on there are `len` letters.
struct Tail {
    at: u32,
    len: u8,
    mark: u8,
}

/// Working memory, reused from bucket to bucket.
pub(in crate::build) struct Finder {
    starts: Vec<u32>,
    tails: Vec<Tail>,
    /// A hash table of the neighbours of one vertex, empty between vertices: which vertex is in a slot, and its bit.
    names: [u32; 1 << SLOT_BITS],
    bits: [u64; 1 << SLOT_BITS],
    /// Slots of the letters of all tails.
    slots: Vec<u8>,
    /// Neighbours, each with its slot in the low bits.
    neighbours: Vec<u64>,
    /// The tails below the vertex, then what is left of them below the nodes of one level.
    visits: Vec<Visit>,
    next_visits: Vec<Visit>,
    /// The first child of each node of a level.
    first_child: Vec<u32>,
    /// How many neighbours and masks of each level the bucket before has, of either width.
    sizes: (usize, Vec<(usize, usize)>),
    local: Local,
}

impl Finder {
    pub(in crate::build) fn new() -> Self {
        Self {
            starts: Vec::new(),
            tails: Vec::new(),
            names: [ABSENT; 1 << SLOT_BITS],
            bits: [0; 1 << SLOT_BITS],
            slots: Vec::new(),
            neighbours: Vec::new(),
            visits: Vec::new(),
            next_visits: Vec::new(),
            first_child: Vec::new(),
            sizes: (0, Vec::new()),
            local: Local::default(),
        }
    }

    /// Finds the faces whose least vertex is one of `vertices`, from the records `flat`.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`].
    #[inline(always)]
    pub(in crate::build) fn find(
        &mut self,
        flat: &[u32],
        vertices: std::ops::Range<u32>,
        is_unused: impl Fn(u32) -> bool,
        reservation: &mut Reservation<'_>,
    ) -> Result<Bucket, BuildError> {
        if u32::try_from(flat.len()).is_err() {
            return Err(reservation.too_large());
        }
        let mut bucket = Bucket::default();
        bucket.counts.push(vertices.len());
        bucket.listed.push(Vec::new());
        reservation.take(vertices.len())?;
        for vertex in vertices.clone().filter(|&vertex| is_unused(vertex)) {
            bucket.mark(0, (vertex - vertices.start) as usize, UNUSED);
        }
        self.deal(flat, &vertices, &mut bucket);
        // Buckets are alike.
        bucket.neighbours.reserve(self.sizes.0);
        for &(narrow, other) in &self.sizes.1 {
            bucket.narrow_masks.push(Vec::with_capacity(narrow));
            bucket.masks.push(Vec::with_capacity(other));
        }
        bucket.shapes.reserve(vertices.len());
        for number in 0..vertices.len() {
            let tails = self.starts[number] as usize..self.starts[number + 1] as usize;
            let num_levels = tails.clone().map(|tail| self.tails[tail].len).max().unwrap_or(0);
            if !self.name(flat, tails.clone()) {
                self.add_wide(flat, tails, &mut bucket, reservation)?;
            } else if self.neighbours.len() <= u16::BITS as usize {
                self.grow::<u16>(&mut bucket, num_levels, reservation)?;
            } else {
                self.grow::<u64>(&mut bucket, num_levels, reservation)?;
            }
        }
        for (listed, &count) in bucket.listed.iter_mut().zip(&bucket.counts).filter(|(listed, _)| !listed.is_empty()) {
            listed.resize(count, 0);
        }
        let room = |len: usize| len + len / 4;
        let masks = bucket.narrow_masks.iter().zip(&bucket.masks).map(|(a, b)| (room(a.len()), room(b.len())));
        self.sizes = (room(bucket.neighbours.len()), masks.collect());
        Ok(bucket)
    }

    /// Sorts the tails in the records by their first vertices.
    #[inline(always)]
    fn deal(&mut self, flat: &[u32], vertices: &std::ops::Range<u32>, bucket: &mut Bucket) {
        let Self { starts, tails, .. } = self;
        // Shifted by one, so that filling in moves each start to where it belongs.
        starts.clear();
        starts.resize(vertices.len() + 2, 0);
        let followed =
            |word: &[u32]| word.iter().take(word.len() - 1).take_while(|&&vertex| vertex < vertices.end).count();
        for (_, word) in records(flat) {
            for &vertex in &word[..followed(word)] {
                starts[(vertex - vertices.start) as usize + 2] += 1;
            }
        }
        for number in 2..starts.len() {
            starts[number] += starts[number - 1];
        }
        // What is left of the bucket before is overwritten, or beyond the last start.
        let num_tails = starts[vertices.len() + 1] as usize;
        tails.resize_with(num_tails.max(tails.len()), || Tail { at: 0, len: 0, mark: 0 });
        let mut end = 0;
        for (mut mark, word) in records(flat) {
            if let [vertex] = word {
                bucket.mark(0, (vertex - vertices.start) as usize, EVEN);
            }
            let start = end + 1;
            end = start + word.len();
            for (place, &vertex) in word[..followed(word)].iter().enumerate() {
                let next = &mut starts[(vertex - vertices.start) as usize + 1];
                let len = u8::try_from(word.len() - place - 1).unwrap_or(0);
                tails[*next as usize] = Tail { at: narrow(start + place + 1), len, mark };
                *next += 1;
                mark = 0;
            }
        }
        starts.pop();
    }

    /// Finds the neighbours of a vertex with the given tails, and makes its tails visits; false if there are too many.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "slots are numbered by bytes")]
    fn name(&mut self, flat: &[u32], tails: std::ops::Range<usize>) -> bool {
        let Self { tails: all_tails, names, bits, slots, neighbours, visits, .. } = self;
        let tails = &all_tails[tails];
        slots.clear();
        neighbours.clear();
        visits.clear();
        let mut fits = true;
        'tails: for tail in tails {
            for &vertex in &flat[tail.at as usize..][..tail.len as usize] {
                // Multiplication by 2^32 over the golden ratio spreads consecutive ids.
                let mut slot = (vertex.wrapping_mul(0x9E37_79B9) >> (32 - SLOT_BITS)) as u8;
                while names[slot as usize] != vertex {
                    if names[slot as usize] == ABSENT {
                        if neighbours.len() == u64::BITS as usize {
                            fits = false;
                            break 'tails;
                        }
                        names[slot as usize] = vertex;
                        neighbours.push(u64::from(vertex) << SLOT_BITS | u64::from(slot));
                        break;
                    }
                    slot = slot.wrapping_add(1);
                }
                slots.push(slot);
            }
        }
        neighbours.sort_unstable();
        for (letter, &neighbour) in neighbours.iter().enumerate() {
            let slot = usize::from(neighbour as u8);
            names[slot] = ABSENT;
            bits[slot] = 1 << letter;
        }
        if fits {
            let mut rest = slots.as_slice();
            for tail in tails {
                let (slots, others) = rest.split_at(tail.len as usize);
                rest = others;
                let rest = slots.iter().fold(0, |mask, &slot| mask | bits[slot as usize]);
                // Of a neighbour alone all is known but whether it is listed.
                if tail.len > 1 || tail.mark != 0 {
                    visits.push(Visit { rest, node: 0, mark: tail.mark });
                }
            }
        }
        fits
    }

    /// Adds the trie of a vertex that is named.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "vertices are 32-bit, and a mask has few bits")]
    fn grow<M: Mask>(
        &mut self,
        bucket: &mut Bucket,
        num_levels: u8,
        reservation: &mut Reservation<'_>,
    ) -> Result<(), BuildError> {
        let Self { neighbours, visits, next_visits, first_child, .. } = self;
        // At most 64.
        bucket.shapes.push(Shape { degree: neighbours.len() as u8, num_levels });
        let num_levels = usize::from(num_levels);
        bucket.neighbours.extend(neighbours.iter().map(|&neighbour| (neighbour >> SLOT_BITS) as u32));
        bucket.make_room(num_levels);
        // Below v the number of a child is its letter.
        first_child.clear();
        first_child.push(0);
        let mut count = neighbours.len();
        for level in 1..=num_levels {
            reservation.take(count)?;
            let base = bucket.counts[level];
            bucket.counts[level] += count;
            let (masks, listed) = M::of_mut(bucket);
            // The masks of the parents, and those of the nodes of this level.
            let (above, here) = masks.split_at_mut(level - 1);
            let above = above.last().map_or(&[][..], |masks| &masks[masks.len() - first_child.len()..]);
            let child = |node: u32, letter: u32| match above.get(node as usize) {
                Some(mask) => first_child[node as usize] + (mask.bits() & ((1 << letter) - 1)).count_ones(),
                None => letter,
            };
            // At the last level tails end, and masks would be 0.
            let here = if level < num_levels {
                let start = here[0].len();
                here[0].resize(start + count, M::new(0));
                &mut here[0][start..]
            } else {
                &mut []
            };
            next_visits.clear();
            for &Visit { mut rest, node, mut mark } in &*visits {
                while rest != 0 {
                    let letter = rest.trailing_zeros();
                    rest &= rest - 1;
                    if rest != 0 {
                        let node = child(node, letter);
                        let mask = &mut here[node as usize];
                        *mask = M::new(mask.bits() | rest);
                        // Of one letter more all is known but whether it is listed.
                        if rest & (rest - 1) != 0 || mark != 0 {
                            next_visits.push(Visit { rest, node, mark });
                        }
                    } else if mark != 0 {
                        let marks = &mut listed[level];
                        if marks.len() < base + count {
                            marks.resize(base + count, 0);
                        }
                        marks[base + child(node, letter) as usize] |= mark;
                    }
                    // The others leave out a letter of the tail.
                    mark = 0;
                }
            }
            std::mem::swap(visits, next_visits);
            first_child.clear();
            let mut next = 0;
            for mask in &*here {
                first_child.push(next);
                next += mask.bits().count_ones();
            }
            count = next as usize;
        }
        Ok(())
    }

    /// Adds a vertex that has too many neighbours for masks.
    fn add_wide(
        &mut self,
        flat: &[u32],
        tails: std::ops::Range<usize>,
        bucket: &mut Bucket,
        reservation: &mut Reservation<'_>,
    ) -> Result<(), BuildError> {
        for tail in &self.tails[tails] {
            self.local.push_tail(&flat[tail.at as usize..][..tail.len as usize], tail.mark);
        }
        let mut levels = Vec::new();
        self.local.add_vertex(&mut levels, reservation)?;
        // The last is empty, as it found that nothing is below.
        levels.truncate(levels.iter().rposition(|level| !level.labels.is_empty()).map_or(1, |last| last + 1));
        bucket.make_room(levels.len() - 1);
        for (dim, level) in levels.iter_mut().enumerate().skip(1) {
            for (node, mark) in std::mem::take(&mut level.listed).into_iter().enumerate().filter(|(_, mark)| *mark != 0)
            {
                local::add_mark(&mut bucket.listed[dim], bucket.counts[dim] + node, mark);
            }
            bucket.counts[dim] += level.labels.len();
        }
        bucket.shapes.push(Shape { degree: 0, num_levels: WIDE });
        bucket.wide.push(levels);
        Ok(())
    }
}
