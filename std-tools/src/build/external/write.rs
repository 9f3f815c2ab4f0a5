//! Writes what a piece owns to where it belongs in the file.

use std::collections::HashMap;
use std::io;

use sig_core::format::SectionKind;
use sig_core::{Dim, Index};

use super::output::{Output, Pen, Written};
use super::piece::Piece;
use super::plan::Ranges;
use super::whole::Whole;
use crate::build::report::Counts;
use crate::spool::{Run, Spool, changed};

/// The numbers of simplices that one piece owns and another needs: who owns them, their dimension, and where they are.
pub(super) type Needed = (usize, Dim, Run);

/// A piece, and what it takes to write it.
pub(super) struct Writer<'a> {
    piece: &'a Piece,
    me: usize,
    whole: &'a Whole,
    pen: Pen<'a>,
    /// The ids in the whole of those simplices of the piece that are owned or needed.
    ids: Vec<u64>,
}

impl<'a> Writer<'a> {
    /// Finds the ids of what other pieces own: `needed` are those numbers, in order for each owner and dimension.
    pub(super) fn new(
        (piece, me): (&'a Piece, usize),
        ranges: &Ranges,
        (whole, output): (&'a Whole, &'a Output<'a>),
        (spool, needed): (&Spool, &[Needed]),
    ) -> io::Result<Self> {
        let mut numbers = HashMap::new();
        for &(owner, dim, run) in needed {
            let mut owned = Vec::new();
            spool.read(run, &mut owned)?;
            numbers.insert((owner, dim), owned.into_iter());
        }
        let mut ids = vec![u64::MAX; piece.arrays.num_simplices];
        for (id, &vertex) in ids.iter_mut().zip(&piece.vertices) {
            *id = vertex.into();
        }
        for dim in 1..=piece.dim() {
            let owned = &piece.owned[dim];
            for (id, number) in ids[owned.clone()].iter_mut().zip(whole.ids[me][dim] as u64..) {
                *id = number;
            }
            let mut is_needed = vec![false; piece.arrays.ids(dim).len()];
            let first = piece.arrays.first[dim];
            for id in first..owned.start {
                // Of what begins before the range, the top simplices; they are around a vertex in it.
                is_needed[id - first] = piece.is_top(dim, id);
            }
            if dim < piece.dim() {
                let cofaces = piece.owned[dim + 1].clone();
                let start = piece.arrays.first[dim + 1];
                for row in
                    piece.arrays.facets(dim + 1).chunks_exact(dim + 2).skip(cofaces.start - start).take(cofaces.len())
                {
                    is_needed[row[0] as usize - first] = true;
                }
            }
            for (vertex, block) in piece.blocks(dim).windows(2).enumerate() {
                if piece.is_owned(0, vertex) {
                    continue;
                }
                let mut source = None;
                for id in block[0]..block[1] {
                    if !is_needed[id - first] {
                        continue;
                    }
                    let owner = *source.get_or_insert_with(|| ranges.of(piece.vertices[vertex]));
                    let number = numbers.get_mut(&(owner, dim)).and_then(Iterator::next).ok_or_else(changed)?;
                    ids[id] = whole.ids[owner][dim] as u64 + u64::from(number);
                }
            }
        }
        if numbers.values().any(|left| left.len() > 0) {
            return Err(changed());
        }
        Ok(Self { piece, me, whole, pen: output.pen(), ids })
    }

    /// Writes everything.
    pub(super) fn write(self) -> io::Result<Written> {
        for dim in 0..=self.piece.dim() {
            self.write_faces(dim)?;
            if dim + 1 < self.whole.first.len() {
                self.write_lists(dim)?;
            }
        }
        self.write_parity()?;
        self.write_lower_neighbours()?;
        Ok(self.pen.end())
    }

    /// The boundary relations, child offsets and last vertices of one dimension.
    fn write_faces(&self, dim: Dim) -> io::Result<()> {
        let Self { piece, whole, pen, .. } = self;
        let (owned, start) = (piece.owned[dim].clone(), whole.ids[self.me][dim]);
        if dim > 0 {
            let row = whole.rows(dim) + (start - whole.first[dim]) * (dim + 1);
            let mut run = pen.numbers(SectionKind::Boundary, row);
            let rows = piece.arrays.facets(dim);
            let first = piece.arrays.first[dim];
            for &facet in &rows[(owned.start - first) * (dim + 1)..(owned.end - first) * (dim + 1)] {
                run.push(self.ids[facet as usize])?;
            }
            run.finish()?;
        }
        if dim + 1 < whole.first.len() {
            let mut run = pen.numbers(SectionKind::ChildOffsets, start);
            let child = whole.ids[self.me][dim + 1];
            for id in owned.clone() {
                let before = match piece.owned.get(dim + 1) {
                    Some(children) => piece.arrays.child_offsets[id] as usize - children.start,
                    None => 0,
                };
                run.push((child + before) as u64)?;
            }
            run.finish()?;
        }
        let mut run = pen.numbers(SectionKind::LastVertices, start);
        for &last in &piece.arrays.last_vertices[owned] {
            run.push(piece.vertices[last as usize].into())?;
        }
        run.finish()
    }

    /// Pointers, lists and flags of one dimension below that of the whole.
    fn write_lists(&self, dim: Dim) -> io::Result<()> {
        let Self { piece, whole, pen, .. } = self;
        let start = whole.ids[self.me][dim];
        let mut offset = whole.lists[self.me][dim];
        let mut pointers = pen.numbers(SectionKind::Pointers, start);
        let mut lists = pen.numbers(SectionKind::Lists, offset);
        let mut flags = pen.bits(SectionKind::Flags, start);
        let is_below = dim < piece.dim();
        // Only here are the largest simplices those of the largest dimension.
        let is_flaggable = dim + 2 < whole.first.len() && piece.dim() + 1 == whole.first.len();
        let first_top = piece.arrays.first[piece.dim()];
        for id in piece.owned[dim].clone() {
            let list = if is_below { piece.relation(id) } else { &[] };
            match list {
                &[top] if is_flaggable && top as usize >= first_top => {
                    pointers.push(self.ids[top as usize])?;
                    flags.push(true)?;
                }
                _ => {
                    pointers.push(offset as u64)?;
                    list.iter().try_for_each(|&top| lists.push(self.ids[top as usize]))?;
                    lists.push(u64::STOP)?;
                    offset += list.len() + 1;
                    flags.push(false)?;
                }
            }
        }
        pointers.finish()?;
        lists.finish()?;
        flags.finish()
    }

    fn write_parity(&self) -> io::Result<()> {
        let mut written = Ok(());
        let mut counts = Counts::new(self.piece.owned.len());
        self.piece.for_each_listed(|dim, marks, is_top| {
            let mut run = self.pen.bits(SectionKind::Parity, self.whole.tops[self.me][dim]);
            let mut result = Ok(());
            counts.add(dim, marks, is_top, |is_odd| {
                if result.is_ok() {
                    result = run.push(is_odd);
                }
            });
            let result = result.and_then(|()| run.finish());
            if written.is_ok() {
                written = result;
            }
        });
        written
    }

    fn write_lower_neighbours(&self) -> io::Result<()> {
        let (vertices, first) = (self.whole.ids[self.me][0], self.whole.lower[self.me]);
        let (starts, neighbours) = self.piece.lower_neighbours();
        let mut run = self.pen.numbers(SectionKind::LowerOffsets, vertices);
        starts[..self.piece.owned[0].len()].iter().try_for_each(|&start| run.push((first + start) as u64))?;
        run.finish()?;
        let mut run = self.pen.numbers(SectionKind::LowerNeighbours, first);
        neighbours.iter().try_for_each(|&vertex| run.push(vertex.into()))?;
        run.finish()
    }
}
