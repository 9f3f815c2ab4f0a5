//! Temporary data that outlive an interruption: files under names in a directory, and a journal of what in them is whole.
//!
//! The journal is [`MAGIC`] and then a record on each line, its checksum before it. Records are only ever added, and what
//! one of them names is on disk before it is. So every beginning of a journal tells the truth, and reading it ends at the
//! first line that is not whole: one that was torn when the work was interrupted.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

use super::Error;
use super::count::{Dealt, Tally};
use super::key::Key;
use super::output::Written;
use crate::spool::Spool;
use crate::store::atomic::{directory_of, sync_directory};
use crate::store::crc32;

/// The first line of a journal.
const MAGIC: &[u8] = b"sig build --resume, version 1\n";
const JOURNAL: &str = "sig-build.journal";
/// The listed simplices of the pieces, the numbers of the simplices at their borders, and the file.
const DATA: [&str; 3] = ["sig-build.words", "sig-build.borders", "sig-build.file"];

/// A line of the journal.
#[derive(Serialize, Deserialize)]
pub(super) enum Record<'a> {
    /// The first: whether the directory was made for it.
    Opened { made: bool },
    /// The second: of which build the others are.
    Build(Cow<'a, Key>),
    /// The listed simplices are with the pieces.
    Dealt(Cow<'a, Dealt>),
    /// A piece was counted.
    Counted(usize, Cow<'a, Tally>),
    /// A piece was written to the file.
    Written(usize, Cow<'a, Written>),
}

/// What the journal tells of earlier processes.
#[derive(Default)]
pub(super) struct Past {
    key: Key,
    pub(super) dealt: Option<Dealt>,
    pub(super) counted: BTreeMap<usize, Tally>,
    pub(super) written: BTreeMap<usize, Written>,
}

/// A directory in which a build keeps what it has done, so that the same build, after an interruption, goes on from there.
///
/// It holds files called `sig-build.*`, the unfinished file of the complex among them. When this is dropped, they are
/// removed, and so is the directory if it was made for them, unless they are of use: the work was interrupted, or could
/// not write or read, after the first step was done.
pub struct Kept {
    directory: PathBuf,
    made: bool,
    /// Where the first record of the journal ends.
    head: u64,
    /// As in [`DATA`].
    data: [File; 3],
    state: Mutex<State>,
    is_of_use: AtomicBool,
}

struct State {
    journal: File,
    past: Past,
    /// Of the build that has begun.
    key: Option<Key>,
}

impl Kept {
    /// Opens a directory, which is created if it is not there; its parent is.
    ///
    /// # Errors
    /// [`Error::Keep`] if that cannot be done, [`Error::InUse`] if another process works with it, and [`Error::Foreign`] if
    /// files that were not made for this have the names.
    pub fn open(directory: &Path) -> Result<Self, Error> {
        let failed = |error| Error::Keep { path: directory.to_owned(), error };
        let is_new = match fs::create_dir(directory) {
            Ok(()) => true,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => false,
            Err(error) => return Err(failed(error)),
        };
        let path = directory.join(JOURNAL);
        let is_there = |path: &PathBuf| path.symlink_metadata().is_ok();
        if let Some(path) =
            DATA.map(|name| directory.join(name)).into_iter().find(|data| is_there(data) && !is_there(&path))
        {
            return Err(Error::Foreign { path });
        }
        let mut journal = open(path.clone())?;
        // Where the system has no locks, there is none.
        if let Err(TryLockError::WouldBlock) = journal.try_lock() {
            return Err(Error::InUse { directory: directory.to_owned() });
        }
        let mut bytes = Vec::new();
        journal.read_to_end(&mut bytes).map_err(failed)?;
        if !bytes.starts_with(MAGIC) && !MAGIC.starts_with(&bytes) {
            return Err(Error::Foreign { path });
        }
        let mut begin = || {
            let (made, head, past) = match Past::read(&bytes) {
                Some((made, head, end, past)) => {
                    cut(&mut journal, end)?;
                    (made, head, past)
                }
                None => {
                    cut(&mut journal, 0)?;
                    journal.write_all(MAGIC)?;
                    journal.write_all(&line(&Record::Opened { made: is_new })?)?;
                    (is_new, journal.stream_position()?, Past::default())
                }
            };
            journal.sync_all()?;
            Ok((made, head, past))
        };
        let (made, head, past) = begin().map_err(failed)?;
        let [words, borders, file] = DATA.map(|name| open(directory.join(name)));
        let data = [words?, borders?, file?];
        [directory, directory_of(directory)].into_iter().try_for_each(sync_directory).map_err(failed)?;
        let is_of_use = AtomicBool::new(past.dealt.is_some());
        let state = Mutex::new(State { journal, past, key: None });
        Ok(Self { directory: directory.to_owned(), made, head, data, state, is_of_use })
    }

    /// The file that is built, before it is finished.
    #[must_use]
    pub fn file(&self) -> &File {
        &self.data[2]
    }

    /// Where that is.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.directory.join(DATA[2])
    }

    /// What an earlier process has done: in how many pieces it builds, how many of them are counted, and how many
    /// written. `None` if nothing is of use.
    #[must_use]
    pub fn found(&self) -> Option<[usize; 3]> {
        let past = &self.state().past;
        let dealt = past.dealt.as_ref()?;
        Some([dealt.num_pieces(), past.counted.len(), past.written.len()])
    }

    /// Whether anything is of use, so that it stays when this is dropped.
    #[must_use]
    pub fn is_of_use(&self) -> bool {
        self.is_of_use.load(Ordering::Relaxed)
    }

    /// Nothing is of use any more: the file has its place, or cannot be built.
    pub fn finish(&self) {
        self.is_of_use.store(false, Ordering::Relaxed);
    }

    /// What is known already of the build that `key` tells.
    pub(super) fn begin(&self, key: Key) -> Result<Past, Error> {
        let mut state = self.state();
        let past = std::mem::take(&mut state.past);
        if past.dealt.is_some() && past.key != key {
            let differs = past.key.iter().zip(&key).find(|(was, is)| was != is);
            let [what, was, is] = differs.map_or(["program", "another", "this"], |(was, is)| [&was.0, &was.1, &is.1]);
            let [what, was, is] = [what, was, is].map(str::to_owned);
            return Err(Error::OfAnother { directory: self.directory.clone(), what, was, is });
        }
        state.key = Some(key);
        Ok(past)
    }

    /// Forgets what was done.
    pub(super) fn restart(&self) -> io::Result<()> {
        self.finish();
        let State { journal, key, .. } = &mut *self.state();
        cut(journal, self.head)?;
        self.file().set_len(0)?;
        journal.write_all(&line(&Record::Build(Cow::Owned(key.clone().unwrap_or_default())))?)?;
        journal.sync_all()
    }

    /// The build that has begun, if one has, cannot be finished.
    pub(super) fn give_up(&self) {
        if self.state().key.is_some() {
            self.finish();
        }
    }

    /// Brings to disk what was done, and then that it was.
    pub(super) fn record(&self, record: &Record<'_>) -> io::Result<()> {
        let [words, borders, file] = &self.data;
        match record {
            Record::Opened { .. } | Record::Build(_) => {}
            Record::Dealt(_) => words.sync_data()?,
            Record::Counted(..) => borders.sync_data()?,
            Record::Written(..) => file.sync_data()?,
        }
        let line = line(record)?;
        let journal = &mut self.state().journal;
        journal.write_all(&line)?;
        journal.sync_data()?;
        self.is_of_use.store(true, Ordering::Relaxed);
        Ok(())
    }

    /// The numbers of the listed simplices, `len` bytes of which are there.
    pub(super) fn words(&self, len: u64) -> io::Result<Spool> {
        Spool::over(self.data[0].try_clone()?, len)
    }

    /// The numbers at the borders, `len` bytes of which are there.
    pub(super) fn borders(&self, len: u64) -> io::Result<Spool> {
        Spool::over(self.data[1].try_clone()?, len)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if self.is_of_use() {
            return;
        }
        // The journal last: without it, the others are not known to be of this program. There is nobody to tell if it fails.
        for name in DATA.into_iter().rev().chain([JOURNAL]) {
            let _ = fs::remove_file(self.directory.join(name));
        }
        if self.made {
            let _ = fs::remove_dir(&self.directory);
        }
    }
}

impl fmt::Debug for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Kept").field("directory", &self.directory).finish_non_exhaustive()
    }
}

impl Past {
    /// What a journal tells: whether the directory was made for it, where the first record ends, where the last one does,
    /// and the others. `None` if there is no record.
    fn read(journal: &[u8]) -> Option<(bool, u64, u64, Self)> {
        let mut end = MAGIC.len();
        let mut records = journal.get(end..)?.split_inclusive(|&byte| byte == b'\n').map_while(|line| {
            end += line.len();
            Some((end as u64, parse(line)?))
        });
        let Some((head, Record::Opened { made })) = records.next() else { return None };
        let (mut end, mut past) = (head, Self::default());
        for (place, record) in records {
            end = place;
            match record {
                Record::Opened { .. } => {}
                Record::Build(key) => past.key = key.into_owned(),
                Record::Dealt(dealt) => past.dealt = Some(dealt.into_owned()),
                Record::Counted(piece, tally) => drop(past.counted.insert(piece, tally.into_owned())),
                Record::Written(piece, written) => drop(past.written.insert(piece, written.into_owned())),
            }
        }
        Some((made, head, end, past))
    }
}

/// A line of the journal.
fn line(record: &Record<'_>) -> io::Result<Vec<u8>> {
    let json = serde_json::to_string(record)?;
    Ok(format!("{:08x} {json}\n", crc32(0, json.as_bytes())).into_bytes())
}

/// The record on a line, if it is whole.
fn parse(line: &[u8]) -> Option<Record<'static>> {
    let (checksum, json) = str::from_utf8(line.strip_suffix(b"\n")?).ok()?.split_once(' ')?;
    let is_whole = u32::from_str_radix(checksum, 16) == Ok(crc32(0, json.as_bytes()));
    if is_whole { serde_json::from_str(json).ok() } else { None }
}

/// Opens a file for reading and writing, which is created if it is not there.
fn open(path: PathBuf) -> Result<File, Error> {
    let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
    opened.map_err(|error| Error::Keep { path, error })
}

/// Cuts a file, and goes to its end.
fn cut(file: &mut File, len: u64) -> io::Result<()> {
    file.set_len(len)?;
    file.seek(SeekFrom::Start(len)).map(drop)
}
