//! Opening multi-resolution complexes and cell complexes for a command.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::Context;
use sig_core::format::{Kind, MAGIC};
use sig_tools::mcc::MccFile;

/// Whether a file is of one of these kinds, by its first bytes; not if it cannot be read.
pub(super) fn is_one(path: &Path) -> bool {
    let mut head = Vec::new();
    let is_read = File::open(path).is_ok_and(|file| file.take(17).read_to_end(&mut head).is_ok());
    // The kind stands behind the magic number and the version.
    let is_kind = |kind: Kind| head.get(16) == Some(&(kind as u8));
    is_read && head.starts_with(&MAGIC) && (is_kind(Kind::CellComplex) || is_kind(Kind::MultiResolution))
}

/// Opens a file and checks its base; refinements are checked when they are applied, so that a part of a large file takes no more
/// time than it must. `sig verify` checks all.
pub(super) fn open(path: &Path) -> anyhow::Result<MccFile> {
    let file = MccFile::open(path)?;
    file.view().validate_base().with_context(|| format!("{}: damaged", path.display()))?;
    Ok(file)
}
