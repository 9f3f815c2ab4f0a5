//! `sig collapse`: elementary collapses until no free pair is left.

use std::path::PathBuf;

use serde::Serialize;
use sig_tools::simplex_tree::{Collapses, Vertices};

use super::frozen_output::{self, FrozenTarget};
use super::input::How;
use super::{UsageError, output, progress, tree_input};

/// Collapse free pairs until none is left
///
/// A simplex with only one proper coface is removed together with it, which keeps the homotopy type. Pairs of the highest
/// dimension come first, of these those last in the order of the vertices. Simplices that are left keep their filtration
/// values, but the persistent homology of the filtration is not kept.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig collapse rips.sigc -o small.sigc
  sig collapse gudhi.txt -o small.sigc --kind tree --sequence collapses.txt

The sequence has a collapse a line, in order: the labels of the face, a blank, those of the coface.")]
pub(super) struct Args {
    /// A file of this program, or GUDHI's simplex-tree text; `-` is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    target: FrozenTarget,

    /// Write the collapses, in order, into this file
    #[arg(long, value_name = "FILE")]
    sequence: Option<PathBuf>,

    /// Print a JSON object on what was done
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    input_simplices: Vec<usize>,
    collapses: usize,
    #[serde(flatten)]
    written: frozen_output::Written,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let inputs = std::slice::from_ref(&self.input);
        self.target.check(inputs, self.json)?;
        if let Some(sequence) = &self.sequence {
            if output::is_stdout(sequence) && (self.json || output::is_stdout(&self.target.target.output)) {
                return Err(UsageError("only one of them can be standard output".to_owned()).into());
            }
            output::check(sequence, self.target.target.existing(), inputs)?;
        }
        let (mut tree, vertices) = tree_input::read(&self.input, &self.how)?;
        tree_input::log(&self.input, &tree);
        let input_simplices = tree.counts().to_vec();
        let collapses = progress::part_of("collapsing", |progress| tree.collapse_all(progress))?;
        if let Some(path) = &self.sequence {
            let existing = self.target.target.existing();
            output::to_path(path, existing, |out| write_sequence(&collapses, &vertices, out))?;
        }
        output::log(format_args!("did    {} collapses", output::grouped(collapses.len())));
        let mut frozen = tree.freeze();
        drop(tree);
        vertices.restore(&mut frozen);
        let written = frozen_output::write(frozen, &self.target, None)?;
        written.log();
        if self.json {
            output::json(&Report { input_simplices, collapses: collapses.len(), written })?;
        }
        Ok(())
    }
}

fn write_sequence(collapses: &Collapses, vertices: &Vertices, out: &mut dyn std::io::Write) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(out);
    for collapse in collapses.iter() {
        let names = |word: &[u32]| word.iter().map(|&label| vertices.name(label)).collect::<Vec<_>>().join(",");
        std::io::Write::write_fmt(&mut out, format_args!("{} {}\n", names(&collapse.face), names(&collapse.coface)))?;
    }
    std::io::Write::flush(&mut out)
}
