//! Numbers on disk that are of no use after the work: what does not fit memory while a complex is built.
//!
//! The file has no name where the system allows that, else one that is removed when the file is opened or closed: whatever
//! ends the process, nothing is left. Where something is to be left, a spool is over a file that has a name.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};
use sig_core::Dim;

use crate::store::crc32;

/// 32-bit numbers in one file, written in runs and read back run by run, from any thread.
#[derive(Debug)]
pub struct Spool {
    /// The file and its length in bytes.
    file: Mutex<(File, u64)>,
}

/// Numbers that were appended together.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Run {
    start: u64,
    pub(crate) len: usize,
}

impl Run {
    /// Where it ends, in bytes.
    pub(crate) fn end(self) -> u64 {
        self.start + (self.len * size_of::<u32>()) as u64
    }

    /// The numbers at some places in it.
    pub(crate) fn part(self, places: Range<usize>) -> Self {
        Self { start: self.start + (places.start * size_of::<u32>()) as u64, len: places.len() }
    }
}

impl Spool {
    /// An empty one in a file in `directory`.
    ///
    /// # Errors
    /// If no file can be created there.
    pub fn new_in(directory: &Path) -> io::Result<Self> {
        Ok(Self { file: Mutex::new((tempfile::tempfile_in(directory)?, 0)) })
    }

    /// The first `len` bytes of `file`; what follows them is dropped.
    ///
    /// # Errors
    /// If there are fewer.
    pub(crate) fn over(file: File, len: u64) -> io::Result<Self> {
        if file.metadata()?.len() < len {
            return Err(changed());
        }
        file.set_len(len)?;
        Ok(Self { file: Mutex::new((file, len)) })
    }

    fn file(&self) -> MutexGuard<'_, (File, u64)> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The bytes on disk.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.file().1
    }

    /// Appends numbers.
    pub(crate) fn append(&self, numbers: &[u32]) -> io::Result<Run> {
        let mut guard = self.file();
        let (file, len) = &mut *guard;
        let run = Run { start: *len, len: numbers.len() };
        write_at(file, run.start, bytemuck::cast_slice(numbers))?;
        *len += size_of_val(numbers) as u64;
        Ok(run)
    }

    /// Appends a run to `numbers`.
    pub(crate) fn read(&self, run: Run, numbers: &mut Vec<u32>) -> io::Result<()> {
        let end = numbers.len();
        numbers.resize(end + run.len, 0);
        let file = &mut self.file().0;
        file.seek(SeekFrom::Start(run.start))?;
        file.read_exact(bytemuck::cast_slice_mut(&mut numbers[end..]))
    }

    /// Writes a run anew, with as many numbers as it has.
    fn overwrite(&self, run: Run, numbers: &[u32]) -> io::Result<()> {
        write_at(&self.file().0, run.start, bytemuck::cast_slice(&numbers[..run.len]))
    }
}

/// What was read is not what was written.
pub(crate) fn changed() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "temporary data were changed by another program")
}

/// Writes at a place in a file.
pub(crate) fn write_at(mut file: &File, start: u64, bytes: &[u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(start))?;
    file.write_all(bytes)
}

/// Rows of the same length one after the other, all but the last of them on disk.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Rows {
    runs: Vec<Run>,
    /// Of what is on disk.
    checksum: u32,
    #[serde(skip)]
    last: Vec<u32>,
}

impl Rows {
    /// Appends a row; what is not on disk stays below `most` numbers.
    #[inline]
    pub(crate) fn push(&mut self, spool: &Spool, row: &[u32], most: usize) -> io::Result<()> {
        self.last.extend_from_slice(row);
        if self.last.len() >= most { self.flush(spool) } else { Ok(()) }
    }

    /// Brings everything to disk.
    pub(crate) fn flush(&mut self, spool: &Spool) -> io::Result<()> {
        if !self.last.is_empty() {
            self.runs.push(spool.append(&self.last)?);
            self.checksum = crc32(self.checksum, bytemuck::cast_slice(&self.last));
            self.last = Vec::new();
        }
        Ok(())
    }

    /// The numbers of all rows, which are on disk.
    pub(crate) fn read(&self, spool: &Spool) -> io::Result<Vec<u32>> {
        let mut numbers = Vec::with_capacity(self.runs.iter().map(|run| run.len).sum());
        self.runs.iter().try_for_each(|&run| spool.read(run, &mut numbers))?;
        if crc32(0, bytemuck::cast_slice(&numbers)) == self.checksum { Ok(numbers) } else { Err(changed()) }
    }
}

/// The simplices of a [`Soup`](crate::soup::Soup) on disk, as [`ReadOptions::spill`](crate::io::ReadOptions::spill) has a
/// reader put them there.
///
/// A failure to write is kept until the simplices are asked for. A clone is the same simplices.
#[derive(Clone, Debug)]
pub struct Spill {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    spool: Spool,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Whole simplices of each dimension.
    runs: Vec<Vec<Run>>,
    failed: Option<io::Error>,
}

impl Spill {
    /// An empty one in a file in `directory`.
    ///
    /// # Errors
    /// If no file can be created there.
    pub fn new_in(directory: &Path) -> io::Result<Self> {
        Ok(Self { shared: Arc::new(Shared { spool: Spool::new_in(directory)?, state: Mutex::default() }) })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The bytes on disk.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.shared.spool.bytes()
    }

    /// Appends simplices of one dimension, `dim` + 1 vertex numbers each.
    pub(crate) fn append(&self, dim: Dim, simplices: &[u32]) {
        let mut state = self.state();
        if simplices.is_empty() || state.failed.is_some() {
            return;
        }
        if state.runs.len() <= dim {
            state.runs.resize_with(dim + 1, Vec::new);
        }
        match self.shared.spool.append(simplices) {
            Ok(run) => state.runs[dim].push(run),
            Err(error) => state.failed = Some(error),
        }
    }

    /// Replaces all vertex numbers.
    pub(crate) fn renumber(&self, number: impl Fn(u32) -> u32) {
        let runs: Vec<Run> = self.state().runs.iter().flatten().copied().collect();
        let mut numbers = Vec::new();
        let renumbered = runs.into_iter().try_for_each(|run| {
            numbers.clear();
            self.shared.spool.read(run, &mut numbers)?;
            numbers.iter_mut().for_each(|vertex| *vertex = number(*vertex));
            self.shared.spool.overwrite(run, &numbers)
        });
        if let Err(error) = renumbered {
            self.state().failed.get_or_insert(error);
        }
    }

    /// The largest dimension of a simplex; `None` if there is none.
    pub(crate) fn dim(&self) -> Option<Dim> {
        self.state().runs.len().checked_sub(1)
    }

    /// How many simplices of each dimension there are.
    #[must_use]
    pub fn counts(&self) -> Vec<usize> {
        let count = |(dim, runs): (usize, &Vec<Run>)| runs.iter().map(|run| run.len).sum::<usize>() / (dim + 1);
        self.state().runs.iter().enumerate().map(count).collect()
    }

    /// Calls `visit` with the vertex numbers of all simplices.
    pub(crate) fn for_each_vertex(&self, mut visit: impl FnMut(u32)) {
        let visited = self.try_for_each(|_, numbers| {
            numbers.iter().for_each(|&vertex| visit(vertex));
            Ok::<(), io::Error>(())
        });
        if let Err(error) = visited {
            self.state().failed.get_or_insert(error);
        }
    }

    /// Calls `visit` with all simplices in the order in which they came, dimension by dimension, many of one dimension at
    /// a time, until it fails.
    ///
    /// # Errors
    /// What went wrong when they were written, or does now; that of `visit`.
    pub(crate) fn try_for_each<E: From<io::Error>>(
        &self,
        mut visit: impl FnMut(Dim, &[u32]) -> Result<(), E>,
    ) -> Result<(), E> {
        let runs = {
            let mut state = self.state();
            if let Some(error) = state.failed.take() {
                return Err(error.into());
            }
            state.runs.clone()
        };
        let mut numbers = Vec::new();
        for (dim, runs) in runs.into_iter().enumerate() {
            for run in runs {
                numbers.clear();
                self.shared.spool.read(run, &mut numbers)?;
                visit(dim, &numbers)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_in_order() {
        let directory = tempfile::tempdir().unwrap();
        let spool = Spool::new_in(directory.path()).unwrap();
        let mut rows = [Rows::default(), Rows::default()];
        for number in 0..100 {
            rows[number as usize % 2].push(&spool, &[number, number + 1], 7).unwrap();
        }
        for (which, rows) in (0..).zip(&mut rows) {
            rows.flush(&spool).unwrap();
            let all = rows.read(&spool).unwrap();
            let expected: Vec<u32> = (0..50).flat_map(|pair| [2 * pair + which, 2 * pair + which + 1]).collect();
            assert_eq!(all, expected);
        }
        assert_eq!(spool.bytes(), 800);
        spool.overwrite(Run { start: 400, len: 1 }, &[1000]).unwrap();
        assert_eq!(rows.map(|rows| rows.read(&spool).is_ok()), [false, true], "number 100 is in a run of the first");
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0, "the file has no name");
    }

    #[test]
    fn spilled_simplices_can_be_renumbered() {
        let directory = tempfile::tempdir().unwrap();
        let spill = Spill::new_in(directory.path()).unwrap();
        spill.append(2, &[0, 1, 2, 1, 2, 3]);
        spill.append(0, &[7]);
        spill.append(2, &[4, 5, 6]);
        spill.renumber(|vertex| 10 * vertex);
        let mut all = Vec::new();
        spill
            .try_for_each(|dim, rows| {
                all.push((dim, rows.to_vec()));
                Ok::<(), io::Error>(())
            })
            .unwrap();
        assert_eq!(all, [(0, vec![70]), (2, vec![0, 10, 20, 10, 20, 30]), (2, vec![40, 50, 60])]);
        assert_eq!((spill.counts(), spill.dim()), (vec![1, 0, 3], Some(2)));
    }
}
