//! All faces whose least vertex is in a bucket, found from the tails that start at each vertex v: a trie below v, as bit
//! masks.
//!
//! Below v stand the vertices of its tails, and below any node the vertices that follow it in some tail. Vertices are
//! *letters* here, positions among the neighbours of v, so that the children of a node are a bit mask, a tail is one too,
//! and the number of a child is a count of bits. The masks take a fourth of the arrays that are [written](Bucket::write)
//! from them once it is known where. Vertices with more neighbours than a mask has bits are handled by [`super::local`].

use sig_core::Index;

use crate::build::local::{self, EVEN, Level, Local, UNUSED};
use crate::build::words::records;
use crate::build::{BuildError, Reservation, index, narrow};

/// The largest number of neighbours for which nodes have their children as a bit mask.
const MASK_BITS: usize = 64;
/// Slots in the table of names, as a power of two.
const SLOT_BITS: u32 = 8;
/// What stands in an empty slot; no vertex id is as large.
const ABSENT: u32 = u32::MAX;

/// The faces whose least vertex is in a bucket.
#[derive(Default)]
pub(super) struct Bucket {
    /// How many there are of each dimension.
    pub(super) counts: Vec<usize>,
    /// How each simplex is listed, by dimension; empty if none is.
    pub(super) listed: Vec<Vec<u8>>,
    /// The neighbours of each vertex, and the levels of its trie; [`WIDE`] if it is one of `wide`.
    shapes: Vec<(u32, u8)>,
    /// The neighbours of all vertices but the wide ones, increasing for each.
    neighbours: Vec<u32>,
    /// The children of the nodes of each level, from 1, save those of the last level of each trie.
    masks: Vec<Vec<u64>>,
    wide: Vec<Vec<Level>>,
}

/// Stands for the levels of a trie without masks.
const WIDE: u8 = u8::MAX;

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
pub(super) struct Finder {
    /// The records of the bucket.
    pub(super) flat: Vec<u32>,
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
    /// How many neighbours and masks of each level the bucket before has.
    sizes: (usize, Vec<usize>),
    local: Local,
}

impl Finder {
    pub(super) fn new() -> Self {
        Self {
            flat: Vec::new(),
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

    /// Finds the faces whose least vertex is one of `vertices`, from the records in `flat`.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`].
    #[inline(always)]
    pub(super) fn find(
        &mut self,
        vertices: std::ops::Range<u32>,
        is_unused: impl Fn(u32) -> bool,
        reservation: &mut Reservation<'_>,
    ) -> Result<Bucket, BuildError> {
        if u32::try_from(self.flat.len()).is_err() {
            return Err(reservation.too_large());
        }
        let mut bucket = Bucket::default();
        bucket.counts.push(vertices.len());
        bucket.listed.push(Vec::new());
        reservation.take(vertices.len())?;
        for vertex in vertices.clone().filter(|&vertex| is_unused(vertex)) {
            bucket.mark(0, (vertex - vertices.start) as usize, UNUSED);
        }
        self.deal(&vertices, &mut bucket);
        // Buckets are alike.
        bucket.neighbours.reserve(self.sizes.0);
        bucket.masks.extend(self.sizes.1.iter().map(|&size| Vec::with_capacity(size)));
        bucket.shapes.reserve(vertices.len());
        for number in 0..vertices.len() {
            let tails = self.starts[number] as usize..self.starts[number + 1] as usize;
            let num_levels = tails.clone().map(|tail| self.tails[tail].len).max().unwrap_or(0);
            if self.name(tails.clone()) {
                self.grow(&mut bucket, num_levels as usize, reservation)?;
            } else {
                self.add_wide(tails, &mut bucket, reservation)?;
            }
        }
        for (listed, &count) in bucket.listed.iter_mut().zip(&bucket.counts).filter(|(listed, _)| !listed.is_empty()) {
            listed.resize(count, 0);
        }
        let room = |len: usize| len + len / 4;
        self.sizes = (room(bucket.neighbours.len()), bucket.masks.iter().map(|masks| room(masks.len())).collect());
        Ok(bucket)
    }

    /// Sorts the tails in the records by their first vertices.
    #[inline(always)]
    fn deal(&mut self, vertices: &std::ops::Range<u32>, bucket: &mut Bucket) {
        let Self { flat, starts, tails, .. } = self;
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
        tails.clear();
        tails.resize_with(starts[vertices.len() + 1] as usize, || Tail { at: 0, len: 0, mark: 0 });
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
    fn name(&mut self, tails: std::ops::Range<usize>) -> bool {
        let Self { flat, tails: all_tails, names, bits, slots, neighbours, visits, .. } = self;
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
                        if neighbours.len() == MASK_BITS {
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
    #[expect(clippy::cast_possible_truncation, reason = "vertices are 32-bit")]
    fn grow(
        &mut self,
        bucket: &mut Bucket,
        num_levels: usize,
        reservation: &mut Reservation<'_>,
    ) -> Result<(), BuildError> {
        let Self { neighbours, visits, next_visits, first_child, .. } = self;
        bucket.shapes.push((narrow(neighbours.len()), u8::try_from(num_levels).unwrap_or(WIDE)));
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
            let Bucket { masks, listed, .. } = &mut *bucket;
            // The masks of the parents, and those of the nodes of this level.
            let (above, here) = masks.split_at_mut(level - 1);
            let above = above.last().map_or(&[][..], |masks| &masks[masks.len() - first_child.len()..]);
            let child = |node: u32, letter: u32| match above.get(node as usize) {
                Some(mask) => first_child[node as usize] + (mask & ((1 << letter) - 1)).count_ones(),
                None => letter,
            };
            // At the last level tails end, and masks would be 0.
            let here = if level < num_levels {
                let start = here[0].len();
                here[0].resize(start + count, 0);
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
                        here[node as usize] |= rest;
                        next_visits.push(Visit { rest, node, mark });
                    } else if mark != 0 {
                        local::add_mark(&mut listed[level], base + child(node, letter) as usize, mark);
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
                next += mask.count_ones();
            }
            count = next as usize;
        }
        Ok(())
    }

    /// Adds a vertex that has too many neighbours for masks.
    fn add_wide(
        &mut self,
        tails: std::ops::Range<usize>,
        bucket: &mut Bucket,
        reservation: &mut Reservation<'_>,
    ) -> Result<(), BuildError> {
        for tail in &self.tails[tails] {
            self.local.push_tail(&self.flat[tail.at as usize..][..tail.len as usize], tail.mark);
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
        bucket.shapes.push((0, WIDE));
        bucket.wide.push(levels);
        Ok(())
    }
}

/// The parts of the arrays of the whole that hold the simplices whose least vertices are in a bucket; all by dimension.
pub(super) struct Slices<'a, I> {
    /// The numbers of the first of them, of each dimension up to d.
    pub(super) starts: Vec<usize>,
    pub(super) last_vertices: Vec<&'a mut [u32]>,
    /// Nothing of vertices.
    pub(super) boundary: Vec<&'a mut [I]>,
    /// Not of dimension d.
    pub(super) child_offsets: Vec<&'a mut [I]>,
}

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
        }
    }

    /// Writes last vertices, child offsets and facets; of the facets that leave out the least vertex only those of edges,
    /// as the others are in other buckets.
    #[inline(always)]
    pub(super) fn write<I: Index>(&self, slices: &mut Slices<'_, I>) {
        let mut writer = Writer { bucket: self, done: vec![0; slices.starts.len()], read: vec![0; self.masks.len()] };
        let (mut neighbours, mut wide) = (self.neighbours.as_slice(), self.wide.iter());
        for &(degree, num_levels) in &self.shapes {
            if num_levels == WIDE {
                writer.write_levels(wide.next().map_or(&[], Vec::as_slice), slices);
            } else {
                let (here, others) = neighbours.split_at(degree as usize);
                neighbours = others;
                writer.write_trie(here, num_levels as usize, slices);
            }
        }
    }
}

/// Goes through the tries of a bucket.
struct Writer<'a> {
    bucket: &'a Bucket,
    /// What is written of each dimension, and read of each level of masks.
    done: Vec<usize>,
    read: Vec<usize>,
}

impl Writer<'_> {
    /// Writes the next vertex, and what is below it.
    #[inline(always)]
    fn write_trie<I: Index>(&mut self, neighbours: &[u32], num_levels: usize, slices: &mut Slices<'_, I>) {
        let Slices { starts, last_vertices, boundary, child_offsets } = slices;
        let (number, vertex) = (self.done[0], starts[0] + self.done[0]);
        last_vertices[0][number] = narrow(vertex);
        self.done[0] += 1;
        let Some(&start) = starts.get(1) else { return };
        let (edges, mut count) = (self.done[1], neighbours.len());
        child_offsets[0][number] = index(start + edges);
        last_vertices[1][edges..edges + count].copy_from_slice(neighbours);
        for (row, &neighbour) in
            boundary[1][2 * edges..2 * (edges + count)].as_chunks_mut().0.iter_mut().zip(neighbours)
        {
            *row = [index(neighbour as usize), index(vertex)];
        }
        let mut lower = 1;
        for level in 1..num_levels {
            let nodes = self.done[level]..self.done[level] + count;
            // Where the parents and the nodes stand in the masks.
            let masks = &self.bucket.masks[level - 1][self.read[level - 1]..][..count];
            let above = match level.checked_sub(2) {
                Some(above) => &self.bucket.masks[above][self.read[above] - lower..][..lower],
                None => &[],
            };
            let parents = Parents { start: starts[level - 1] + self.done[level - 1] - lower, masks: above };
            let (offsets_above, offsets) = child_offsets.split_at_mut(level);
            let offsets_above = &offsets_above[level - 1][self.done[level - 1] - lower..self.done[level - 1]];
            let (rows, rows_below) = boundary.split_at_mut(level + 1);
            let family = Family {
                first_node: starts[level] + nodes.start,
                first_child: starts[level + 1] + self.done[level + 1],
                rows: &rows[level][nodes.start * (level + 1)..nodes.end * (level + 1)],
                neighbours,
                parents,
                offsets_above,
            };
            let children = self.done[level + 1];
            let num_children = family.write(
                level,
                masks,
                &mut offsets[0][nodes.clone()],
                &mut last_vertices[level + 1][children..],
                &mut rows_below[0][children * (level + 2)..],
            );
            self.done[level] = nodes.end;
            self.read[level - 1] += count;
            lower = count;
            count = num_children;
        }
        if num_levels > 0 {
            // Those of the last level have no children.
            let nodes = self.done[num_levels]..self.done[num_levels] + count;
            if let Some(offsets) = child_offsets.get_mut(num_levels) {
                offsets[nodes.clone()].fill(index(starts[num_levels + 1] + self.done[num_levels + 1]));
            }
            self.done[num_levels] = nodes.end;
        }
    }

    /// Writes the next vertex, and what is below it as found by [`Local`].
    fn write_levels<I: Index>(&mut self, levels: &[Level], slices: &mut Slices<'_, I>) {
        let Slices { starts, last_vertices, boundary, child_offsets } = slices;
        let number = |dim: usize, done: &[usize], place: u32| index(starts[dim] + done[dim] + place as usize);
        let vertex = starts[0] + self.done[0];
        last_vertices[0][self.done[0]] = narrow(vertex);
        for (dim, level) in levels.iter().enumerate() {
            let done = &self.done;
            if let Some(offsets) = child_offsets.get_mut(dim) {
                for (offset, &child) in offsets[done[dim]..].iter_mut().zip(&level.first_child) {
                    *offset = number(dim + 1, done, child);
                }
            }
            if dim > 0 {
                last_vertices[dim][done[dim]..][..level.labels.len()].copy_from_slice(&level.labels);
                let rows = boundary[dim][done[dim] * (dim + 1)..].chunks_exact_mut(dim + 1);
                for ((row, facets), &label) in rows.zip(level.facets.chunks_exact(dim)).zip(&level.labels) {
                    // Right for edges; the others wait for the level below.
                    row[0] = index(label as usize);
                    for (entry, &facet) in row[1..].iter_mut().zip(facets) {
                        *entry = number(dim - 1, done, facet);
                    }
                }
            }
        }
        self.done[0] += 1;
        for (done, level) in self.done.iter_mut().zip(levels).skip(1) {
            *done += level.labels.len();
        }
    }
}

/// The nodes of the level above in a trie: their numbers from `start` on, and their children.
struct Parents<'a> {
    start: usize,
    /// Nothing of v alone.
    masks: &'a [u64],
}

/// The nodes of a level in a trie, and what their children are made of.
struct Family<'a, I> {
    first_node: usize,
    first_child: usize,
    /// The facets of the nodes.
    rows: &'a [I],
    neighbours: &'a [u32],
    parents: Parents<'a>,
    offsets_above: &'a [I],
}

impl<I: Index> Family<'_, I> {
    /// Writes the children of the nodes, and where those of each start; tells how many there are.
    #[inline(always)]
    fn write(
        &self,
        level: usize,
        masks: &[u64],
        offsets: &mut [I],
        last_vertices: &mut [u32],
        rows: &mut [I],
    ) -> usize {
        let mut next = 0;
        for (node, (&mask, offset)) in masks.iter().zip(offsets).enumerate() {
            *offset = index(self.first_child + next);
            let facets = &self.rows[node * (level + 1)..][..level + 1];
            let mut rest = mask;
            while rest != 0 {
                let letter = rest.trailing_zeros();
                rest &= rest - 1;
                last_vertices[next] = self.neighbours[letter as usize];
                let row = &mut rows[next * (level + 2)..][..level + 2];
                if level == 1 {
                    // Facet 1 of (v, x) is v, below which a child is a neighbour.
                    row[1] = index(self.offsets_above[0].to_usize() + letter as usize);
                } else {
                    for (entry, facet) in row[1..=level].iter_mut().zip(&facets[1..]) {
                        let facet = facet.to_usize() - self.parents.start;
                        let before = self.parents.masks[facet] & ((1 << letter) - 1);
                        *entry = index(self.offsets_above[facet].to_usize() + before.count_ones() as usize);
                    }
                }
                row[level + 1] = index(self.first_node + node);
                next += 1;
            }
        }
        next
    }
}
