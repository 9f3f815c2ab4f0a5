//! Writes the tries of a bucket to where they belong.

use sig_core::Index;

use crate::build::local::Level;
use crate::build::trie::{Bucket, Mask, Shape, WIDE};
use crate::build::{index, narrow};

/// The parts of the arrays of the whole that hold the simplices whose least vertices are in a bucket; all by dimension.
pub(in crate::build) struct Slices<'a, I> {
    /// The numbers of the first of them, of each dimension up to d.
    pub(in crate::build) starts: Vec<usize>,
    pub(in crate::build) last_vertices: Vec<&'a mut [u32]>,
    /// Nothing of vertices.
    pub(in crate::build) boundary: Vec<&'a mut [I]>,
    /// Not of dimension d.
    pub(in crate::build) child_offsets: Vec<&'a mut [I]>,
}

impl Bucket {
    /// Writes last vertices, child offsets and facets; of the facets that leave out the least vertex only those of edges,
    /// as the others are in other buckets.
    #[inline(always)]
    pub(in crate::build) fn write<I: Index>(&self, slices: &mut Slices<'_, I>) {
        let read = || vec![0; self.masks.len()];
        let mut writer = Writer { bucket: self, done: vec![0; slices.starts.len()], read_narrow: read(), read: read() };
        let (mut neighbours, mut wide) = (self.neighbours.as_slice(), self.wide.iter());
        for &Shape { degree, num_levels } in &self.shapes {
            if num_levels == WIDE {
                writer.write_levels(wide.next().map_or(&[], Vec::as_slice), slices);
                continue;
            }
            let (here, others) = neighbours.split_at(usize::from(degree));
            neighbours = others;
            if here.len() <= u16::BITS as usize {
                writer.write_trie::<u16, I>(here, num_levels as usize, slices);
            } else {
                writer.write_trie::<u64, I>(here, num_levels as usize, slices);
            }
        }
    }
}

/// Goes through the tries of a bucket.
struct Writer<'a> {
    bucket: &'a Bucket,
    /// What is written of each dimension,
    done: Vec<usize>,
    /// and read of each level of masks, of either width.
    read_narrow: Vec<usize>,
    read: Vec<usize>,
}

impl Writer<'_> {
    /// Writes the next vertex, and what is below it.
    #[inline(always)]
    fn write_trie<M: Mask, I: Index>(&mut self, neighbours: &[u32], num_levels: usize, slices: &mut Slices<'_, I>) {
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
        let all_masks = M::of(self.bucket);
        let read = if M::BITS == u16::BITS as usize { &mut self.read_narrow } else { &mut self.read };
        let mut lower = 1;
        for level in 1..num_levels {
            let nodes = self.done[level]..self.done[level] + count;
            // Where the parents and the nodes stand in the masks.
            let masks = &all_masks[level - 1][read[level - 1]..][..count];
            let above = match level.checked_sub(2) {
                Some(above) => &all_masks[above][read[above] - lower..][..lower],
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
            read[level - 1] += count;
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
struct Parents<'a, M> {
    start: usize,
    /// Nothing of v alone.
    masks: &'a [M],
}

/// The nodes of a level in a trie, and what their children are made of.
struct Family<'a, M, I> {
    first_node: usize,
    first_child: usize,
    /// The facets of the nodes.
    rows: &'a [I],
    neighbours: &'a [u32],
    parents: Parents<'a, M>,
    offsets_above: &'a [I],
}

impl<M: Mask, I: Index> Family<'_, M, I> {
    /// Writes the children of the nodes, and where those of each start; tells how many there are.
    #[inline(always)]
    fn write(&self, level: usize, masks: &[M], offsets: &mut [I], last_vertices: &mut [u32], rows: &mut [I]) -> usize {
        let mut next = 0;
        for (node, (&mask, offset)) in masks.iter().zip(offsets).enumerate() {
            *offset = index(self.first_child + next);
            let facets = &self.rows[node * (level + 1)..][..level + 1];
            let mut rest = mask.bits();
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
                        let before = self.parents.masks[facet].bits() & ((1 << letter) - 1);
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
