//! `sig formats`: what is read and written, and what is lost on the way.

use serde::Serialize;
use sig_tools::export;
use sig_tools::io::Format;
use sig_tools::io::space::SpaceFormat;

use super::output;

/// List the formats that are read and written, and what each cannot hold
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig formats
  sig formats --json")]
pub(super) struct Args {
    /// Print a JSON array
    #[arg(long)]
    json: bool,
}

/// A format; as JSON, the names of the fields.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    /// What it holds: a complex, or points, distances or a graph.
    of: &'static str,
    extensions: &'static [&'static str],
    /// What is read, if it is.
    read: Option<&'static str>,
    /// What is written, if it is, and what is lost.
    written: Option<&'static str>,
    loses: Option<&'static str>,
}

fn rows() -> Vec<Row> {
    let read = Format::ALL.iter().map(|&format| {
        let written = export::Format::ALL.iter().find(|written| written.name() == format.name());
        Row {
            name: format.name(),
            of: "complex",
            extensions: format.extensions(),
            read: Some(format.description()),
            written: written.map(|written| written.description()),
            loses: written.map(|written| written.loses()),
        }
    });
    let is_read = |name| Format::ALL.iter().any(|format| format.name() == name);
    let written = export::Format::ALL.iter().filter(|format| !is_read(format.name())).map(|format| Row {
        name: format.name(),
        of: "complex",
        extensions: format.extensions(),
        // One of the variants of a format that goes by another name.
        read: Format::from_name(format.name()).map(Format::description),
        written: Some(format.description()),
        loses: Some(format.loses()),
    });
    let spaces = SpaceFormat::ALL.iter().map(|format| Row {
        name: format.name(),
        of: "space",
        extensions: &[],
        read: Some(format.description()),
        written: None,
        loses: None,
    });
    read.chain(written).chain(spaces).collect()
}

const REMARKS: &str = "\
Input may be compressed by gzip, xz or zstd, or come from standard input. Polygons and polyhedra are
split into simplices, of which each has the attributes of the cell, and cells of higher order stand
for their corners. Attributes, numbers at vertices and cells, are read of vtk, vtu, ply, msh, medit
and mfem: data, properties, and as the attribute ref the integer that some have for each cell or
vertex, like physical groups. A complex keeps them; a conversion says which it cannot.";

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let rows = rows();
        if self.json {
            output::json(&rows)?;
            return Ok(());
        }
        output::stdout(|out| {
            for (of, title) in [
                ("complex", "Meshes and lists of simplices (sig build, sig convert, sig export)"),
                ("space", "Points, distances and graphs (sig rips, sig witness)"),
            ] {
                writeln!(out, "{title}\n")?;
                for row in rows.iter().filter(|row| row.of == of) {
                    let extensions: Vec<_> = row.extensions.iter().map(|extension| format!(".{extension}")).collect();
                    writeln!(out, "{}", format!("  {:<12}  {}", row.name, extensions.join(" ")).trim_end())?;
                    if let Some(read) = row.read {
                        writeln!(out, "    read     {read}")?;
                    }
                    if let Some(written) = row.written {
                        writeln!(out, "    written  {written}")?;
                        writeln!(out, "    lost     {}", row.loses.unwrap_or("nothing"))?;
                    }
                }
                writeln!(out)?;
            }
            writeln!(out, "{REMARKS}")
        })?;
        Ok(())
    }
}
