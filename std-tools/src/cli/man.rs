//! `sig man`: manual pages.

use std::path::PathBuf;

use anyhow::Context;

/// Write manual pages, one for each command, into a directory
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig man ~/.local/share/man/man1")]
pub(super) struct Args {
    /// The directory, which must exist; pages of the same names are replaced
    directory: PathBuf,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let failed = || format!("{}: cannot write manual pages", self.directory.display());
        clap_mangen::generate_to(super::command(), &self.directory).with_context(failed)
    }
}
