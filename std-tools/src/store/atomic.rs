//! Files that are there whole or not at all.
//!
//! A file is written without its name in the directory where it belongs, brought to disk, and given its name; the
//! directory is brought to disk after that. Whatever ends the work before (a full disk, an error, a signal), the old file
//! is untouched and nothing else is left.
//!
//! Where the system has files without a name (Linux, on most of its file systems), not even `kill -9` or a loss of power
//! leaves anything, but for the instant in which a whole new file takes the place of an old one. Elsewhere the file has
//! a temporary name meanwhile, `.NAME.XXXXXX.tmp` for a file called NAME. What the program can catch removes it
//! ([`abort`]); what it cannot, `kill -9` above all, leaves it behind. It is never read and may be deleted when no
//! program is writing.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{NamedTempFile, TempPath};

/// What becomes of a file that has the name already.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Existing {
    /// It stays, and writing is refused.
    #[default]
    Refuse,
    /// The new file takes its name.
    Replace,
}

/// Why a file is not written. But for [`Sync`](Self::Sync), the name it was to have is in the state it was in before.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The name is taken.
    #[error("{}: the file exists; --force replaces it", path.display())]
    Exists {
        /// The name.
        path: PathBuf,
    },
    /// The name is that of a directory, a device or a pipe, which cannot be replaced by a file.
    #[error("{}: not a file that could be replaced; write to another name, or to `-` for standard output", path.display())]
    NotAFile {
        /// The name.
        path: PathBuf,
    },
    /// The directory is not there, or no file can be made in it.
    #[error("{}: cannot create a file in {}: {error}", path.display(), directory.display())]
    Create {
        /// The name.
        path: PathBuf,
        /// The directory.
        directory: PathBuf,
        /// What the system says.
        #[source]
        error: io::Error,
    },
    /// Writing failed: a full disk, for one.
    #[error("{}: cannot write: {error}; nothing was changed", path.display())]
    Write {
        /// The name.
        path: PathBuf,
        /// What the system says.
        #[source]
        error: io::Error,
    },
    /// The file is there, whole and under its name, but its directory could not be brought to disk: a crash of the system
    /// may yet undo the renaming.
    #[error("{}: written, but its directory cannot be synchronised: {error}", path.display())]
    Sync {
        /// The name.
        path: PathBuf,
        /// What the system says.
        #[source]
        error: io::Error,
    },
}

/// Checks, before the long work starts, that a file called `path` may be written.
///
/// [`write()`] checks again, without a gap between the check and the rename.
///
/// # Errors
/// [`WriteError::Exists`] and [`WriteError::NotAFile`]; [`WriteError::Create`] if there is no such directory.
pub fn check(path: &Path, existing: Existing) -> Result<(), WriteError> {
    if existing == Existing::Refuse && path.is_symlink() {
        return Err(WriteError::Exists { path: path.to_owned() });
    }
    match fs::metadata(path) {
        Ok(found) if !found.is_file() => return Err(WriteError::NotAFile { path: path.to_owned() }),
        Ok(_) if existing == Existing::Refuse => return Err(WriteError::Exists { path: path.to_owned() }),
        _ => {}
    }
    let directory = directory_of(path);
    let create = |error| WriteError::Create { path: path.to_owned(), directory: directory.to_owned(), error };
    let found = fs::metadata(directory).map_err(create)?;
    if found.is_dir() { Ok(()) } else { Err(create(io::ErrorKind::NotADirectory.into())) }
}

/// Writes a file called `path` with what `fill` writes, buffered: when this returns `Ok`, it is on disk, whole and under
/// its name; otherwise nothing has changed.
///
/// # Errors
/// [`WriteError`].
pub fn write(
    path: &Path,
    existing: Existing,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    write_file(path, existing, |file| {
        let mut out = BufWriter::with_capacity(1 << 16, file);
        fill(&mut out).and_then(|()| out.flush()).map_err(|error| WriteError::Write { path: path.to_owned(), error })
    })
}

/// As [`write()`], for a writer that wants the file itself: to write it in any order, from its end to its start.
///
/// # Errors
/// [`WriteError`], and those of `fill`.
pub fn write_file<T, E: From<WriteError>>(
    path: &Path,
    existing: Existing,
    fill: impl FnOnce(&File) -> Result<T, E>,
) -> Result<T, E> {
    check(path, existing)?;
    // A link stays one: what it leads to is replaced.
    let resolved = fs::canonicalize(path).ok().filter(|_| path.is_symlink());
    let path = resolved.as_deref().unwrap_or(path);
    let failed = |error| WriteError::Write { path: path.to_owned(), error };
    let temporary = Temporary::create(path)?;
    let filled = fill(temporary.file())?;
    if let Ok(replaced) = fs::metadata(path) {
        temporary.file().set_permissions(replaced.permissions()).map_err(failed)?;
    }
    temporary.file().sync_all().map_err(failed)?;
    temporary.persist(path, existing)?;
    sync_directory(directory_of(path)).map_err(|error| WriteError::Sync { path: path.to_owned(), error })?;
    Ok(filled)
}

/// Gives the name `path` to a file that is there as `source`, complete: as if [`write()`] had written it. Where the two are
/// on different file systems, it is copied; otherwise `source` is gone.
///
/// # Errors
/// [`WriteError`]; but for [`WriteError::Sync`], `source` is where it was.
pub fn place(source: &Path, path: &Path, existing: Existing) -> Result<(), WriteError> {
    check(path, existing)?;
    let resolved = fs::canonicalize(path).ok().filter(|_| path.is_symlink());
    let path = resolved.as_deref().unwrap_or(path);
    let failed = |error| WriteError::Write { path: path.to_owned(), error };
    let mut file = File::options().read(true).write(true).open(source).map_err(failed)?;
    if let Ok(replaced) = fs::metadata(path) {
        file.set_permissions(replaced.permissions()).map_err(failed)?;
    }
    file.sync_all().map_err(failed)?;
    let mut source = TempPath::try_from_path(source).map_err(failed)?;
    source.disable_cleanup(true);
    let guard = temporaries();
    let placed = match existing {
        Existing::Refuse => source.persist_noclobber(path),
        Existing::Replace => source.persist(path),
    };
    drop(guard);
    match placed.map_err(|failed| failed.error) {
        Err(error) if error.kind() == io::ErrorKind::CrossesDevices => {
            write_file(path, existing, |mut out| io::copy(&mut file, &mut out).map(drop).map_err(failed))
        }
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(WriteError::Exists { path: path.to_owned() }),
        Err(error) => Err(failed(error)),
        Ok(()) => sync_directory(directory_of(path)).map_err(|error| WriteError::Sync { path: path.to_owned(), error }),
    }
}

/// The temporaries that exist.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn temporaries() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporaries and ends the process: for the handler of a signal, not for a signal's context.
///
/// No file is created or renamed in between: a file that is being finished is there under its name, or not at all.
pub fn abort(exit_code: i32) -> ! {
    // Held until the process ends.
    let temporaries = temporaries();
    for path in temporaries.iter() {
        // There is nobody left to tell.
        let _ = fs::remove_file(path);
    }
    std::process::exit(exit_code)
}

/// A file that does not have its name yet.
enum Temporary {
    /// It has none; the system removes it unless it gets one.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// It has another, which [`abort`] knows.
    Named {
        file: NamedTempFile,
        /// After the file: it is removed before it is forgotten.
        registered: Registered,
    },
}

/// A name in the list of temporaries, as long as this lives.
struct Registered(PathBuf);

impl Drop for Registered {
    fn drop(&mut self) {
        temporaries().retain(|path| *path != self.0);
    }
}

impl Temporary {
    fn create(path: &Path) -> Result<Self, WriteError> {
        let directory = directory_of(path);
        #[cfg(target_os = "linux")]
        if let Ok(file) = unnamed::create(directory) {
            return Ok(Self::Unnamed(file));
        }
        let prefix = prefix(path);
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(SUFFIX);
        // A temporary is private by default; this one will be the file, and is given the permissions of any new file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut temporaries = temporaries();
        let file = builder.tempfile_in(directory).map_err(|error| WriteError::Create {
            path: path.to_owned(),
            directory: directory.to_owned(),
            error,
        })?;
        temporaries.push(file.path().to_owned());
        drop(temporaries);
        let registered = Registered(file.path().to_owned());
        Ok(Self::Named { file, registered })
    }

    fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named { file, .. } => file.as_file(),
        }
    }

    fn persist(self, path: &Path, existing: Existing) -> Result<(), WriteError> {
        // So that no signal ends the process between the two halves of a rename.
        let guard = temporaries();
        let persisted = match &self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => unnamed::persist(file, path, existing),
            Self::Named { .. } => Ok(()),
        };
        let (persisted, registered) = match self {
            Self::Named { file, registered } => {
                let persisted = match existing {
                    Existing::Refuse => file.persist_noclobber(path),
                    Existing::Replace => file.persist(path),
                };
                (persisted.map(drop).map_err(|failed| failed.error), Some(registered))
            }
            #[cfg(target_os = "linux")]
            Self::Unnamed(_) => (persisted, None),
        };
        // Forgetting a name takes the lock.
        drop(guard);
        drop(registered);
        persisted.map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => WriteError::Exists { path: path.to_owned() },
            _ => WriteError::Write { path: path.to_owned(), error },
        })
    }
}

/// How the names of temporaries end.
const SUFFIX: &str = ".tmp";

/// How the temporary names of a file called `path` begin.
fn prefix(path: &Path) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(path.file_name().unwrap_or_default());
    prefix.push(".");
    prefix
}

/// Files without a name, as Linux has them.
#[cfg(target_os = "linux")]
mod unnamed {
    use std::os::fd::AsRawFd;

    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};

    use super::{Existing, File, Path, SUFFIX, io, prefix};

    /// Creates one in `directory`, with the permissions of any new file, if that can be given a name later.
    pub(super) fn create(directory: &Path) -> io::Result<File> {
        let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
        let file = File::from(open(directory, flags, Mode::from_raw_mode(0o666))?);
        // Where /proc is not mounted, it cannot.
        std::fs::symlink_metadata(place(&file))?;
        Ok(file)
    }

    /// Gives it a name. One that is taken cannot be replaced at once: the file gets a temporary one, and is renamed.
    pub(super) fn persist(file: &File, path: &Path, existing: Existing) -> io::Result<()> {
        let link = |name: &Path| linkat(CWD, place(file), CWD, name, AtFlags::SYMLINK_FOLLOW).map_err(io::Error::from);
        match link(path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && existing == Existing::Replace => {
                let mut builder = tempfile::Builder::new();
                let named = builder.prefix(&prefix(path)).suffix(SUFFIX).make_in(super::directory_of(path), link)?;
                named.persist(path).map(drop).map_err(|failed| failed.error)
            }
            linked => linked,
        }
    }

    fn place(file: &File) -> String {
        format!("/proc/self/fd/{}", file.as_raw_fd())
    }
}

/// The directory in which a file called `path` is.
pub(crate) fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Brings a directory to disk, and with it a rename in it, where the system lets it be opened.
pub(crate) fn sync_directory(directory: &Path) -> io::Result<()> {
    match File::open(directory) {
        Ok(directory) if cfg!(unix) => directory.sync_all(),
        Err(error) if error.kind() != io::ErrorKind::PermissionDenied && cfg!(unix) => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn refuses_or_replaces_a_file_of_the_name() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.sigc");
        write(&path, Existing::Refuse, |out| out.write_all(b"one")).unwrap();
        let refused = write(&path, Existing::Refuse, |out| out.write_all(b"two"));
        assert!(matches!(refused, Err(WriteError::Exists { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"one");
        write(&path, Existing::Replace, |out| out.write_all(b"three")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"three");
        assert_eq!(names(directory.path()), ["a.sigc"]);
    }

    #[test]
    fn a_file_that_appears_in_the_meantime_stays() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.sigc");
        let refused = write(&path, Existing::Refuse, |out| {
            fs::write(&path, b"theirs")?;
            out.write_all(b"ours")
        });
        assert!(matches!(refused, Err(WriteError::Exists { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"theirs");
        assert_eq!(names(directory.path()), ["a.sigc"]);
    }

    #[test]
    fn an_error_leaves_the_old_file_and_no_debris() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.sigc");
        fs::write(&path, b"old").unwrap();
        let failed = write(&path, Existing::Replace, |out| {
            out.write_all(&[0; 1 << 20])?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert!(matches!(failed, Err(WriteError::Write { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(directory.path()), ["a.sigc"]);
    }

    /// From the same file system, and from another where there is one.
    #[test]
    fn a_file_that_is_there_gets_a_name() {
        let directory = tempfile::tempdir().unwrap();
        let other = tempfile::tempdir_in("/dev/shm").ok();
        for from in [Some(&directory), other.as_ref()].into_iter().flatten() {
            let (source, path) = (from.path().join("source"), directory.path().join("a.sigc"));
            fs::write(&source, "one").unwrap();
            place(&source, &path, Existing::Refuse).unwrap();
            assert_eq!(fs::read(&path).unwrap(), b"one");
            fs::write(&source, "two").unwrap();
            assert!(matches!(place(&source, &path, Existing::Refuse), Err(WriteError::Exists { .. })));
            assert_eq!((fs::read(&path).unwrap(), fs::read(&source).unwrap()), (b"one".to_vec(), b"two".to_vec()));
            place(&source, &path, Existing::Replace).unwrap();
            assert_eq!(fs::read(&path).unwrap(), b"two");
            assert_eq!(names(directory.path()), ["a.sigc"]);
            fs::remove_file(path).unwrap();
        }
    }

    #[test]
    fn directories_and_missing_directories_are_told_apart() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| check(&directory.path().join(name), Existing::Replace);
        assert!(matches!(check(directory.path(), Existing::Replace), Err(WriteError::NotAFile { .. })));
        assert!(matches!(at("missing/a.sigc"), Err(WriteError::Create { .. })));
        fs::write(directory.path().join("file"), b"").unwrap();
        assert!(matches!(at("file/a.sigc"), Err(WriteError::Create { .. })));
        assert!(at("file").is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_has_the_permissions_of_any_other() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().unwrap();
        let (ours, plain) = (directory.path().join("ours"), directory.path().join("plain"));
        write(&ours, Existing::Refuse, |_| Ok(())).unwrap();
        fs::write(&plain, b"").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_stay_when_a_file_is_replaced() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().unwrap();
        let (file, link) = (directory.path().join("file"), directory.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        assert!(matches!(check(&link, Existing::Refuse), Err(WriteError::Exists { .. })));
        write(&link, Existing::Replace, |out| out.write_all(b"new")).unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
        assert_eq!(names(directory.path()), ["file", "link"]);
    }
}
