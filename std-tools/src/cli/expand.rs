//! `sig expand`: the flag complex of the graph of a complex.

use std::path::PathBuf;

use serde::Serialize;
use sig_core::MAX_DIM;

use super::frozen_output::{self, FrozenTarget};
use super::{output, tree_input};

/// Expand a graph to its flag complex
///
/// Of the input nothing counts but vertices and edges. Every set of vertices that are pairwise joined becomes a simplex, up
/// to the dimension given, with the largest filtration value of its edges.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig expand graph.sigc --max-dim 3 -o flag.sigc
  sig expand graph.txt --max-dim 5 -o flag.sigc --kind tree     GUDHI's text: 0 v value, 1 v w value")]
pub(super) struct Args {
    /// A file of this program, or GUDHI's simplex-tree text; `-` is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,

    #[command(flatten)]
    target: FrozenTarget,

    /// The largest dimension of the simplices
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(0..=MAX_DIM as i64))]
    max_dim: u8,

    /// Print a JSON object on what was done
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    input_simplices: Vec<usize>,
    #[serde(flatten)]
    written: frozen_output::Written,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        self.target.check(std::slice::from_ref(&self.input), self.json)?;
        let (mut tree, vertices) = tree_input::read(&self.input)?;
        tree_input::log(&self.input, &tree);
        let input_simplices = tree.counts().to_vec();
        let max_dim = usize::from(self.max_dim);
        tree.prune_above_dim(max_dim.min(1))?;
        tree.expand(max_dim)?;
        let mut frozen = tree.freeze();
        drop(tree);
        vertices.restore(&mut frozen);
        let written = frozen_output::write(frozen, &self.target)?;
        written.log();
        if self.json {
            output::json(&Report { input_simplices, written })?;
        }
        Ok(())
    }
}
