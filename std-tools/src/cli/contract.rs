//! `sig contract`: edge contractions, of one edge or of as many as the homotopy type allows.

use std::path::PathBuf;

use anyhow::Context;
use serde::Serialize;
use sig_tools::simplex_tree::{Contraction, LinkCondition, SimplexTree, Vertices};

use super::frozen_output::{self, FrozenTarget};
use super::input::How;
use super::{UsageError, output, progress, tree_input};

/// Contract edges, keeping the homotopy type
///
/// Contracting the edge A,B makes B become A in every simplex; each simplex gets the least filtration value of those that
/// become it. The homotopy type is kept if Lk(A) ∩ Lk(B) = Lk(AB), the link condition: edges that fail it are refused.
/// A Rips complex that was cut off at its largest dimension has few edges that meet it: build it with a larger --max-dim.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig contract rips.sigc -o small.sigc --edge 17,4         one edge; 17 stays
  sig contract rips.sigc -o small.sigc --all               the least filtration values first
  sig contract rips.sigc -o small.sigc --all --target 100  until 100 vertices are left")]
pub(super) struct Args {
    /// A file of this program, or GUDHI's simplex-tree text; `-` is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    target_file: FrozenTarget,

    /// An edge to contract, by the labels of its vertices, of which the first stays; may be given several times
    #[arg(long, value_name = "A,B", required_unless_present = "all")]
    edge: Vec<String>,

    /// Then contract edges until none is left that may be: those of the least filtration values first, then by label; the
    /// vertex that comes first in the file stays
    #[arg(long)]
    all: bool,

    /// Stop at so many vertices
    #[arg(long, value_name = "N", requires = "all", default_value_t = 1)]
    target: usize,

    /// Contract edges that fail the link condition too, which may change the homotopy type
    #[arg(long)]
    ignore_link_condition: bool,

    /// Print a JSON object on what was done
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    input_simplices: Vec<usize>,
    contractions: usize,
    #[serde(flatten)]
    written: frozen_output::Written,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        self.target_file.check(std::slice::from_ref(&self.input), self.json)?;
        let edges: Vec<(&str, &str)> = self
            .edge
            .iter()
            .map(|edge| edge.split_once(',').filter(|(_, second)| !second.contains(',')))
            .collect::<Option<_>>()
            .ok_or_else(|| UsageError("--edge wants the labels of two vertices, like 17,4".to_owned()))?;
        let condition = if self.ignore_link_condition { LinkCondition::Ignored } else { LinkCondition::Required };
        let (mut tree, vertices) = tree_input::read(&self.input, &self.how)?;
        tree_input::log(&self.input, &tree);
        let input_simplices = tree.counts().to_vec();
        for &edge in &edges {
            contract(&mut tree, &vertices, edge, condition)?;
        }
        let mut contractions: Vec<Contraction> = Vec::new();
        if self.all {
            contractions =
                progress::part_of("contracting", |progress| tree.contract_all(self.target, condition, progress))?;
        }
        let contractions = edges.len() + contractions.len();
        output::log(format_args!("did    {} contractions", output::grouped(contractions)));
        let mut frozen = tree.freeze();
        drop(tree);
        vertices.restore(&mut frozen);
        let written = frozen_output::write(frozen, &self.target_file, None)?;
        written.log();
        if self.json {
            output::json(&Report { input_simplices, contractions, written })?;
        }
        Ok(())
    }
}

fn contract(
    tree: &mut SimplexTree,
    vertices: &Vertices,
    (first, second): (&str, &str),
    condition: LinkCondition,
) -> anyhow::Result<()> {
    let [a, b] = [first, second].map(|name| tree_input::vertex(tree, vertices, name));
    let (a, b) = (a?, b?);
    let is_edge = a != b && tree.contains(&[a.min(b), a.max(b)]);
    is_edge.then_some(()).with_context(|| format!("the vertices {first},{second} do not span an edge"))?;
    if condition == LinkCondition::Required && !tree.link_condition(a, b) {
        anyhow::bail!(
            "the edge {first},{second} fails the link condition: contracting it may change the homotopy type; \
             --ignore-link-condition does so all the same"
        );
    }
    Ok(tree.contract(a, b)?)
}
