//! Opening a file for a command: mapped where that works, loaded where it does not.

use std::borrow::Cow;
use std::io;
use std::path::Path;

use sig_tools::mcc::MccFile;
use sig_tools::store::{Access, OpenError};
use sig_tools::{Loaded, Mapped, View};

/// A file that is open.
pub(super) enum Input {
    Mapped(Mapped),
    Loaded(Loaded),
}

/// How a file is opened.
#[derive(clap::Args)]
pub(super) struct How {
    /// Load the file into memory instead of mapping it: for one that another program may truncate or write into
    #[arg(long)]
    load: bool,
}

impl How {
    /// Opens a multi-resolution complex, or a cell complex.
    pub(super) fn open_mcc(&self, path: &Path) -> Result<MccFile, OpenError> {
        if self.load { MccFile::load(path) } else { MccFile::open(path) }
    }

    /// Opens `path`, which will be read as `access` says; `-` is standard input.
    pub(super) fn open(&self, path: &Path, access: Access) -> Result<Input, OpenError> {
        if self.load && path.as_os_str() != "-" {
            return Loaded::open(path).map(Input::Loaded);
        }
        Input::open(path, access)
    }
}

impl Input {
    /// Opens `path`, mapped if it can be, which will be read as `access` says; `-` is standard input.
    pub(super) fn open(path: &Path, access: Access) -> Result<Self, OpenError> {
        if path.as_os_str() == "-" {
            return Loaded::read(io::stdin().lock(), Path::new("<stdin>"), 0).map(Self::Loaded);
        }
        // Pipes and devices cannot be mapped, and big-endian hosts must swap.
        let is_file = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
        if !is_file || cfg!(target_endian = "big") {
            return Loaded::open(path).map(Self::Loaded);
        }
        let mapped = Mapped::open(path)?;
        // Advice that is not taken costs nothing but time.
        let _ = mapped.advise(access);
        Ok(Self::Mapped(mapped))
    }

    /// The complex, of either kind.
    pub(super) fn view(&self) -> View<'_> {
        match self {
            Self::Mapped(mapped) => mapped.view(),
            Self::Loaded(loaded) => loaded.view(),
        }
    }

    /// The bytes as they lie on disk.
    pub(super) fn file_bytes(&self) -> Cow<'_, [u8]> {
        match self {
            Self::Mapped(mapped) => Cow::Borrowed(mapped.bytes()),
            Self::Loaded(loaded) => loaded.file_bytes(),
        }
    }
}
