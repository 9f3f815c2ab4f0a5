//! `sig export`: a complex in the formats of other programs.

use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use sig_tools::export::{self, ExportError, Format};
use sig_tools::store::Access;
use sig_tools::store::atomic::Existing;
use sig_tools::with_view;

use super::input::{How, Input};
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
        export(&self.file, &self.how, &self.target, format(self.format, &self.target.output, "--format")?)
    }
}

/// The format that an option, if it is given, or the name of the output tells.
pub(super) fn format(given: Option<Format>, path: &Path, option: &str) -> Result<Format, UsageError> {
    if let Some(format) = given {
        return Ok(format);
    }
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.and_then(Format::from_name).ok_or_else(|| {
        let names: Vec<_> = Format::ALL.iter().map(|format| format.name()).collect();
        let what =
            if output::is_stdout(path) { "standard output has no name" } else { "the name does not tell the format" };
        UsageError(format!("{}: {what}; use {option} with one of: {}", path.display(), names.join(", ")))
    })
}

/// Writes the complex in `file` to the target, and says what is left out.
pub(super) fn export(file: &Path, how: &How, target: &output::Target, format: Format) -> anyhow::Result<()> {
    output::check(&target.output, target.existing(), &[file.to_owned()])?;
    let input = how.open(file, Access::Normal)?;
    write(&input, &file.display().to_string(), &target.output, target.existing(), format)
}

/// Writes the complex in an input called `name`, and says what is left out.
pub(super) fn write(input: &Input, name: &str, path: &Path, existing: Existing, format: Format) -> anyhow::Result<()> {
    let view = input.view();
    // As long as writing, and a damaged file would come out as a mesh that is another.
    with_view!(view, complex => complex.validate()).with_context(|| format!("{name}: damaged; see sig verify"))?;
    with_view!(view, complex => export::check(&complex, format)).with_context(|| name.to_owned())?;
    let mut notes = Vec::new();
    let mut write = |path: &Path, file: &str| {
        output::to_path(path, existing, |out| {
            let written = with_view!(view, complex => export::export_file(&complex, format, file, out));
            notes = written.map_err(|error| match error {
                ExportError::Io(error) => error,
                other => io::Error::other(other),
            })?;
            Ok(())
        })
    };
    if format.files().is_empty() {
        write(path, "")?;
    } else {
        let files = with_view!(view, complex => export::files(&complex, format));
        clear(path, existing, format, &files)?;
        files.iter().try_for_each(|file| write(&path.with_extension(file), file))?;
    }
    for note in notes {
        output::log(format_args!("sig: note: {format}: {note}"));
    }
    Ok(())
}

/// Sees to it that beside a mesh of several files there are no others that would be taken for a part of it.
fn clear(path: &Path, existing: Existing, format: Format, files: &[&str]) -> anyhow::Result<()> {
    if output::is_stdout(path) {
        return Err(UsageError(format!("{format} is several files, and standard output is one")).into());
    }
    let all = || format.files().iter().map(|file| (path.with_extension(file), files.contains(file)));
    all().try_for_each(|(path, _)| output::check(&path, existing, &[]))?;
    for (path, _) in all().filter(|(path, is_written)| !is_written && path.exists()) {
        std::fs::remove_file(&path).with_context(|| format!("{}: cannot remove", path.display()))?;
    }
    Ok(())
}
