//! Opening files: mapped where they lie, or loaded into memory.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use memmap2::Mmap;
use sig_core::AnyComplex;
use sig_core::format::{Blocks, FormatError, SectionKind, crc32, swap_byte_order};

use super::{AlignedBytes, View};
use crate::with_view;

/// Why a file cannot be opened.
#[derive(Debug, thiserror::Error)]
#[error("{}: {kind}", path.display())]
#[non_exhaustive]
pub struct OpenError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    #[source]
    pub kind: OpenErrorKind,
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenErrorKind {
    /// The system does not give it.
    #[error("cannot open: {0}")]
    Io(#[source] io::Error),
    /// It is empty.
    #[error("the file is empty, not a SIG file")]
    Empty,
    /// It promises isolated vertices without end.
    #[error("{vertices} vertices and nothing else: more than can be worked with")]
    TooManyVertices {
        /// How many.
        vertices: usize,
    },
    /// It is not a simplicial complex in the format of this crate, or damaged.
    #[error("{0}")]
    Format(#[source] FormatError),
}

impl OpenError {
    pub(crate) fn new(path: &Path, kind: OpenErrorKind) -> Self {
        Self { path: path.to_owned(), kind }
    }

    fn io(path: &Path) -> impl Fn(io::Error) -> Self {
        |error| Self::new(path, OpenErrorKind::Io(error))
    }
}

/// Opens the complex in bytes in the host's byte order.
///
/// The lengths that the section table must have follow from the lookup section, so damage there looks like damage of the
/// table. Where the file has checksums, they tell which of the two it is.
fn open_view(bytes: &[u8]) -> Result<View<'_>, FormatError> {
    View::from_bytes(bytes).map_err(|error| {
        let blocks = || Blocks::of_file(bytes).ok()?.iter().find(|block| block.section == SectionKind::Lookup);
        match error {
            FormatError::Table { .. } | FormatError::Invalid { .. } => {
                blocks().and_then(|block| block.check(crc32).err()).unwrap_or(error)
            }
            _ => error,
        }
    })
}

/// The most simplices that a file may have beyond a few for each of its bytes.
const FREE_VERTICES: usize = 1 << 24;

/// Checks that bytes in the host's byte order are a complex.
fn check(path: &Path, bytes: &[u8]) -> Result<(), OpenError> {
    if bytes.is_empty() {
        return Err(OpenError::new(path, OpenErrorKind::Empty));
    }
    let checked = open_view(bytes).map_err(|error| OpenError::new(path, OpenErrorKind::Format(error)))?;
    // Vertices alone take no bytes, so a small file may promise more of them than any memory has marks for. Where there is a
    // tree, each takes two bytes at least.
    let simplices = with_view!(checked, complex => complex.num_simplices());
    if simplices > FREE_VERTICES && simplices / 16 > bytes.len() {
        return Err(OpenError::new(path, OpenErrorKind::TooManyVertices { vertices: simplices }));
    }
    Ok(())
}

/// How a mapped file will be read, so that the system can read ahead or not.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Access {
    /// As the system sees fit.
    Normal,
    /// Here and there: queries.
    Random,
    /// From the start to the end: checks and sweeps.
    Sequential,
    /// All of it, soon: start reading now.
    WillNeed,
}

/// Maps a file that is not empty.
pub(crate) fn map_file(path: &Path) -> Result<Mmap, OpenError> {
    let file = File::open(path).map_err(OpenError::io(path))?;
    // Mapping nothing fails on some systems, with a message that does not help.
    if file.metadata().map_err(OpenError::io(path))?.len() == 0 {
        return Err(OpenError::new(path, OpenErrorKind::Empty));
    }
    // SAFETY: the map is private to this process and read-only. What remains is that another process may write into
    // the file or truncate it, against which no program can defend itself; the documentation of `Mapped` says what
    // happens then and what to use instead. Every view bounds what it reads by the length of the map and accepts
    // any bytes, so a changed file gives wrong answers, not reads outside the map.
    #[expect(unsafe_code)]
    let map = unsafe { Mmap::map(&file) }.map_err(OpenError::io(path))?;
    Ok(map)
}

/// A file mapped into memory: opened in the time of a few reads whatever its length, read where it lies, shared by all
/// processes that map it.
///
/// # Who may change the file
///
/// Nobody, while it is mapped. A program that *writes* into it changes the arrays under the queries: answers may be
/// wrong, though no query reads outside the map. One that *truncates* it takes pages away, and the system ends the
/// process that touches them (`SIGBUS`). Files written by [`atomic`](super::atomic) are never changed in place: a new
/// file takes the name, and the map keeps the old one. Where others may write, use [`Loaded`].
#[derive(Debug)]
pub struct Mapped {
    map: Mmap,
}

impl Mapped {
    /// Maps the file at `path` and opens the complex in it, a SIG or a tree, as [`View::from_bytes`] does.
    ///
    /// If another program truncates the file while it is mapped, touching what is gone ends this process with `SIGBUS`;
    /// no error can be returned. [`Loaded::open`] is safe from that: it reads the file once and never looks at it again.
    /// On the command line, that is `--load`.
    ///
    /// Cost: O(number of sections), the same for any number of simplices.
    ///
    /// # Errors
    /// [`OpenError`]: a file that cannot be mapped, is empty, is no complex in the format of [`sig_core::format`], or is
    /// damaged in its header or section table. On a big-endian host every file is
    /// [`ForeignByteOrder`](FormatError::ForeignByteOrder): use [`Loaded`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let map = map_file(path)?;
        check(path, &map)?;
        Ok(Self { map })
    }

    /// The complex in the file, a SIG or a tree. Cost: O(number of sections).
    ///
    /// # Panics
    /// If another program has written into the header since the file was opened.
    #[must_use]
    pub fn view(&self) -> View<'_> {
        View::from_bytes(&self.map).expect("a mapped file was changed by another program")
    }

    /// The complex in a file of kind SIG. Cost: O(number of sections).
    ///
    /// # Errors
    /// [`FormatError::WrongKind`] if the file is a tree, of which there is only a [`view`](Self::view).
    pub fn complex(&self) -> Result<AnyComplex<'_>, FormatError> {
        AnyComplex::from_bytes(&self.map)
    }

    /// The bytes of the file.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.map
    }

    /// Tells the system how the file will be read. A hint: nothing happens where there is no such call.
    ///
    /// # Errors
    /// Those of the system.
    pub fn advise(&self, access: Access) -> io::Result<()> {
        #[cfg(unix)]
        self.map.advise(match access {
            Access::Normal => memmap2::Advice::Normal,
            Access::Random => memmap2::Advice::Random,
            Access::Sequential => memmap2::Advice::Sequential,
            Access::WillNeed => memmap2::Advice::WillNeed,
        })?;
        #[cfg(not(unix))]
        let _ = access;
        Ok(())
    }
}

/// A file loaded into memory: for files that others may change, for pipes, and for big-endian hosts.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// A complex in the host's byte order: only [`from_file_bytes`](Self::from_file_bytes) makes one.
    bytes: AlignedBytes,
}

impl Loaded {
    /// Loads the file at `path`. Cost: reading the file; on a big-endian host, a pass over it besides.
    ///
    /// # Errors
    /// As [`Mapped::open`], whatever the byte order of the host.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let file = File::open(path).map_err(OpenError::io(path))?;
        let expected = file.metadata().map_err(OpenError::io(path))?.len();
        Self::read(file, path, usize::try_from(expected).unwrap_or(0))
    }

    /// Loads what a reader gives, called `path` in errors; `expected` bytes are made room for at the start.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn read(mut reader: impl Read, path: &Path, expected: usize) -> Result<Self, OpenError> {
        let bytes = AlignedBytes::read(&mut reader, expected).map_err(OpenError::io(path))?;
        if bytes.is_empty() {
            return Err(OpenError::new(path, OpenErrorKind::Empty));
        }
        let loaded =
            Self::from_file_bytes(bytes).map_err(|error| OpenError::new(path, OpenErrorKind::Format(error)))?;
        check(path, &loaded.bytes)?;
        Ok(loaded)
    }

    /// The complex in the bytes of a file as it lies on disk.
    ///
    /// # Errors
    /// [`FormatError`], as [`View::from_bytes`] says.
    pub fn from_file_bytes(mut bytes: AlignedBytes) -> Result<Self, FormatError> {
        if cfg!(target_endian = "big") {
            swap_byte_order(&mut bytes)?;
        }
        open_view(&bytes)?;
        Ok(Self { bytes })
    }

    /// The complex, a SIG or a tree. Cost: O(number of sections).
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "checked when the value was made, and nothing changes the bytes")]
    pub fn view(&self) -> View<'_> {
        View::from_bytes(&self.bytes).expect("checked when loaded")
    }

    /// The complex of a file of kind SIG. Cost: O(number of sections).
    ///
    /// # Errors
    /// [`FormatError::WrongKind`] if the file is a tree, of which there is only a [`view`](Self::view).
    pub fn complex(&self) -> Result<AnyComplex<'_>, FormatError> {
        AnyComplex::from_bytes(&self.bytes)
    }

    /// The bytes in memory, in the host's byte order.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The bytes as they lie on disk: what [`verify`](super::verify) takes. Cost: on a big-endian host, a copy.
    #[must_use]
    pub fn file_bytes(&self) -> Cow<'_, [u8]> {
        if cfg!(target_endian = "little") {
            return Cow::Borrowed(&self.bytes);
        }
        let mut bytes = self.bytes.to_vec();
        // The header was read before, so this cannot fail; if it did, the checks of the bytes would say so.
        let _ = swap_byte_order(&mut bytes);
        Cow::Owned(bytes)
    }
}
