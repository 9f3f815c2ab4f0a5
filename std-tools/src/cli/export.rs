//! `sig export`: a complex in the formats of other programs.

use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use sig_tools::export::{self, ExportError, Format};
use sig_tools::store::Access;
use sig_tools::with_view;

use super::input::How;
use super::{UsageError, output};

/// Write a complex in another format
///
/// What the format cannot hold is refused, never left out in silence.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig export bunny.sigc -o bunny.vtu                  for ParaView; the format goes by the name
  sig export rips.sigc -o rips.txt --format simplices
  sig export rips.sigc -o rips.gudhi                  for GUDHI's Simplex_tree: all simplices
  sig export bunny.sigc -o - --format off | gzip > bunny.off.gz")]
pub(super) struct Args {
    /// The file to export; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    target: output::Target,

    /// The format; by default the one that the name of OUT stands for
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        export(&self.file, &self.how, &self.target, self.format()?)
    }

    fn format(&self) -> Result<Format, UsageError> {
        if let Some(format) = self.format {
            return Ok(format);
        }
        let path = &self.target.output;
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension.and_then(Format::from_name).ok_or_else(|| {
            let names: Vec<_> = Format::ALL.iter().map(|format| format.name()).collect();
            let what = if output::is_stdout(path) {
                "standard output has no name"
            } else {
                "the name does not tell the format"
            };
            UsageError(format!("{}: {what}; use --format with one of: {}", path.display(), names.join(", ")))
        })
    }
}

/// Writes the complex in `file` to the target, and says what is left out.
pub(super) fn export(file: &Path, how: &How, target: &output::Target, format: Format) -> anyhow::Result<()> {
    let (path, existing) = (&target.output, target.existing());
    output::check(path, existing, &[file.to_owned()])?;
    let input = how.open(file, Access::Normal)?;
    let view = input.view();
    let file = || file.display().to_string();
    // As long as writing, and a damaged file would come out as a mesh that is another.
    with_view!(view, complex => complex.validate()).with_context(|| format!("{}: damaged; see sig verify", file()))?;
    with_view!(view, complex => export::check(&complex, format)).with_context(file)?;
    let mut notes = Vec::new();
    output::to_path(path, existing, |out| {
        notes = with_view!(view, complex => export::export(&complex, format, out)).map_err(|error| match error {
            ExportError::Io(error) => error,
            other => io::Error::other(other),
        })?;
        Ok(())
    })?;
    for note in notes {
        output::log(format_args!("sig: note: {format}: {note}"));
    }
    Ok(())
}
