//! A list for each vertex, without stop codes.

use sig_core::Index;

use super::tops::check_width;
use super::{Refusal, array_bytes};
use crate::build::index;

/// A list for each vertex: n_0 integers that tell where it starts, and the entries; it ends where the next one starts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Lists<I> {
    starts: Vec<I>,
    entries: Vec<I>,
}

impl<I: Index> Lists<I> {
    /// The lists of (vertex, entry), each in the order of the pairs, which are walked twice.
    ///
    /// # Errors
    /// [`Refusal::TooNarrow`] if there are more entries than `I` counts.
    pub(super) fn new(num_vertices: usize, pairs: impl Iterator<Item = (u32, u32)> + Clone) -> Result<Self, Refusal> {
        let mut places = vec![0_usize; num_vertices + 1];
        pairs.clone().for_each(|(vertex, _)| places[vertex as usize + 1] += 1);
        (0..num_vertices).for_each(|vertex| places[vertex + 1] += places[vertex]);
        check_width::<I>(places[num_vertices])?;
        let starts = places[..num_vertices].iter().map(|&start| index(start)).collect();
        let mut entries = vec![I::STOP; places[num_vertices]];
        for (vertex, entry) in pairs {
            let place = &mut places[vertex as usize];
            entries[*place] = index(entry as usize);
            *place += 1;
        }
        Ok(Self { starts, entries })
    }

    /// n_0.
    pub(super) fn num_vertices(&self) -> usize {
        self.starts.len()
    }

    /// Where the list of a vertex starts; the number of entries past the last vertex.
    pub(super) fn start(&self, vertex: usize) -> usize {
        self.starts.get(vertex).map_or(self.entries.len(), |start| start.to_usize())
    }

    /// The list of a vertex.
    pub(super) fn of(&self, vertex: usize) -> &[I] {
        &self.entries[self.start(vertex)..self.start(vertex + 1)]
    }

    /// The entry at a place.
    pub(super) fn entry(&self, place: usize) -> I {
        self.entries[place]
    }

    /// The vertex in whose list a place is: the last one that starts there or before.
    pub(super) fn owner(&self, place: usize) -> usize {
        self.starts.partition_point(|start| start.to_usize() <= place).saturating_sub(1)
    }

    /// Starts and entries.
    pub(super) fn num_integers(&self) -> usize {
        self.starts.len() + self.entries.len()
    }

    pub(super) fn num_entries(&self) -> usize {
        self.entries.len()
    }

    pub(super) fn bytes(&self) -> usize {
        array_bytes(&self.starts) + array_bytes(&self.entries)
    }
}
