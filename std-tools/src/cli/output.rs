//! Writing: data to standard output or, whole or not at all, to a file.

use std::fmt::Display;
use std::io::{self, BufWriter, IsTerminal, Seek, Write};
use std::path::Path;

use serde::Serialize;
pub(super) use sig_tools::draw::grouped;
use sig_tools::store::atomic::{self, Existing};

use super::UsageError;

/// Says something about the work on standard error; if nobody listens there, the work goes on.
pub(super) fn log(message: impl Display) {
    let _ = writeln!(io::stderr(), "{message}");
}

/// Whether a path stands for standard output.
pub(super) fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Writes data to standard output.
pub(super) fn stdout(fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    fill(&mut out).and_then(|()| out.flush()).map_err(|error| match error.raw_os_error() {
        Some(_) => io::Error::new(error.kind(), format!("standard output: cannot write: {error}")),
        None => error,
    })
}

/// Writes one JSON value on one line of standard output.
pub(super) fn json(value: &impl Serialize) -> io::Result<()> {
    stdout(|out| {
        serde_json::to_writer(&mut *out, value)?;
        writeln!(out)
    })
}

/// Checks, before the long work, that [`to_path`] will not be refused, and that it replaces none of the inputs.
pub(super) fn check(path: &Path, existing: Existing, inputs: &[std::path::PathBuf]) -> anyhow::Result<()> {
    if is_stdout(path) {
        return Ok(());
    }
    let place = std::fs::canonicalize(path).ok();
    if let Some(input) = inputs.iter().find(|input| place.is_some() && std::fs::canonicalize(input).ok() == place) {
        let message = format!("{}: the output would replace the input; give it another name", input.display());
        return Err(UsageError(message).into());
    }
    Ok(atomic::check(path, existing)?)
}

/// Writes a file, or to standard output if the path is `-`.
pub(super) fn to_path(
    path: &Path,
    existing: Existing,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> anyhow::Result<()> {
    if is_stdout(path) {
        stdout(fill)?;
    } else {
        atomic::write(path, existing, fill)?;
    }
    Ok(())
}

/// Writes a file in any order of its bytes; standard output by way of a file in `directory`, which has no name.
pub(super) fn to_file<T, E>(
    path: &Path,
    existing: Existing,
    directory: &Path,
    fill: impl FnOnce(&std::fs::File) -> Result<T, E>,
) -> anyhow::Result<T>
where
    anyhow::Error: From<E>,
{
    if !is_stdout(path) {
        return atomic::write_file(path, existing, |file| fill(file).map_err(anyhow::Error::from));
    }
    let mut file = tempfile::tempfile_in(directory)?;
    let filled = fill(&file)?;
    file.rewind()?;
    stdout(|out| io::copy(&mut file, out).map(drop))?;
    Ok(filled)
}

/// Gives its name to a file that is there as `source`, or writes it to standard output.
pub(super) fn place(source: &Path, path: &Path, existing: Existing) -> anyhow::Result<()> {
    if is_stdout(path) {
        let mut file = std::fs::File::open(source)?;
        stdout(|out| io::copy(&mut file, out).map(drop))?;
    } else {
        atomic::place(source, path, existing)?;
    }
    Ok(())
}

/// The arguments of a file to be written.
#[derive(clap::Args)]
pub(super) struct Target {
    /// The file to write; `-` is standard output
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: std::path::PathBuf,

    /// Replace OUT if it exists
    #[arg(long)]
    force: bool,
}

/// What is written, as far as a terminal cares.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    Text,
    Binary,
}

impl Target {
    /// Checks, before the long work, that the file can be written, that it replaces none of the inputs, and that nothing
    /// else wants its place or that of an input: the JSON object standard output, another input standard input.
    pub(super) fn check(&self, inputs: &[std::path::PathBuf], json: bool, content: Content) -> anyhow::Result<()> {
        let path = &self.output;
        if json && is_stdout(path) {
            return Err(UsageError("--json and -o - both want standard output".to_owned()).into());
        }
        if content == Content::Binary && is_stdout(path) && io::stdout().is_terminal() {
            return Err(UsageError("-o - writes a binary file, and standard output is a terminal".to_owned()).into());
        }
        check(path, self.existing(), inputs)?;
        if inputs.iter().filter(|input| input.as_os_str() == "-").count() > 1 {
            return Err(UsageError("standard input can be read only once".to_owned()).into());
        }
        Ok(())
    }

    pub(super) fn existing(&self) -> Existing {
        if self.force { Existing::Replace } else { Existing::Refuse }
    }
}

/// How many simplices there are, and of each dimension: `25 simplices: 5 + 10 + 10`.
pub(super) fn counted<N: Copy + Display + std::iter::Sum>(simplices: &[N]) -> String {
    let counts: Vec<_> = simplices.iter().map(grouped).collect();
    let counts = if counts.is_empty() { String::new() } else { format!(": {}", counts.join(" + ")) };
    format!("{} simplices{counts}", grouped(simplices.iter().copied().sum::<N>()))
}

/// Writes rows as a table: the first column to the left, the others to the right, two blanks between.
pub(super) fn table(rows: &[Vec<String>], out: &mut dyn Write) -> io::Result<()> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column| rows.iter().filter_map(|row| row.get(column)).map(|cell: &String| cell.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            if column == 0 {
                line += &format!("{cell:<width$}");
            } else {
                line += &format!("  {cell:>width$}");
            }
        }
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [vec!["κ".to_owned(), "1".to_owned()], vec!["long".to_owned(), "22".to_owned(), "3".to_owned()]];
        let mut out = Vec::new();
        table(&rows, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "κ      1\nlong  22  3\n");
    }
}
