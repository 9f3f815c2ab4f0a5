//! `sig expand`: the flag complex of the graph of a complex.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;
use serde::Serialize;
use sig_tools::graph::Graph;
use sig_tools::io::space::{Space, SpaceFormat, SpaceOptions, read_space};
use sig_tools::soup::{Coordinates, Labels};
use sig_tools::with_view;

use super::expansion::{self, Expansion, Skeleton};
use super::input::How;
use super::output::{self, grouped};
use super::tree_input::{self, Opened};
use super::{UsageError, progress};

/// Expand a graph to its flag complex
///
/// Of the input nothing counts but vertices and edges. Every set of vertices that are pairwise joined becomes a simplex, up
/// to the dimension given. Where the input has filtration values, a simplex gets the largest of its vertices and edges.
#[derive(clap::Args)]
#[command(
    mut_arg("kind", expansion::tree_by_default),
    mut_arg("output", expansion::none_if_dry_run),
    after_help = "\
Examples:
  sig expand mesh.sigc --max-dim 3 -o flag.sigc      the graph of a complex, of either kind of file
  sig expand gudhi.txt --max-dim 5 -o flag.sigc      GUDHI's simplex-tree text: 0 v value, 1 v w value
  sig expand friends.edges --max-dim 31 --dry-run    how many cliques a graph has, by size

Points and distances become a complex by sig rips."
)]
pub(super) struct Args {
    /// A file of this program, GUDHI's simplex-tree text, or a list of edges; `-` is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    expansion: Expansion,

    /// The format of an input that is no file of this program; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(GRAPHS, SpaceFormat::name, SpaceFormat::description))]
    format: Option<SpaceFormat>,
}

/// The formats of graphs.
const GRAPHS: &[SpaceFormat] = &[SpaceFormat::Gudhi, SpaceFormat::Edges, SpaceFormat::Sparse];

/// What was read; as JSON, the names of the fields.
#[derive(Serialize)]
struct Report {
    input: String,
    format: &'static str,
    vertices: usize,
    edges: usize,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let start = Instant::now();
        self.expansion.check(&self.input)?;
        let (skeleton, format) = self.read()?;
        let report = Report {
            input: tree_input::displayed(&self.input),
            format,
            vertices: skeleton.graph.num_vertices(),
            edges: skeleton.graph.num_edges(),
        };
        let (vertices, edges) = (grouped(report.vertices), grouped(report.edges));
        output::log(format_args!("read   {}: {format}, {vertices} vertices, {edges} edges", report.input));
        self.expansion.write(&self.input, skeleton, report, start)
    }

    /// The graph of the input, and the name of its format.
    fn read(&self) -> anyhow::Result<(Skeleton, &'static str)> {
        let name = tree_input::displayed(&self.input);
        let (reader, length) = match tree_input::open(&self.input, &self.how)? {
            Opened::Other(reader, length) => (reader, length),
            Opened::Ours(input) => {
                if self.format.is_some() {
                    return Err(UsageError(format!("{name} is a file of this program; leave out --format")).into());
                }
                let skeleton = with_view!(input.view(), complex => {
                    let graph = Graph::of(&complex).with_context(|| format!("{name}: damaged; see sig verify"))?;
                    tree_input::say_without_attributes(&complex, &name);
                    Skeleton { graph, labels: Labels::of(&complex), coordinates: Coordinates::of(&complex) }
                });
                return Ok((skeleton, "sigc"));
            }
        };
        let options = SpaceOptions { format: self.format, is_graph: true, ..SpaceOptions::default() };
        let (space, report) = progress::reading_of(length, &name, |progress| {
            read_space(reader, length, &name, &SpaceOptions { progress, ..options })
        })?;
        match space {
            Space::Graph { graph, labels } => Ok((Skeleton { graph, labels, coordinates: None }, report.format.name())),
            _ => anyhow::bail!("{name}: these are distances of all pairs, and a graph is needed; see sig rips"),
        }
    }
}
