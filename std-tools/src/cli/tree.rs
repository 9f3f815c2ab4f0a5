//! `sig tree`: a complex as a simplex tree, of which words are listed, and which goes from one kind of file to the other.

use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Subcommand, ValueEnum};
use serde::Serialize;
use sig_core::{Dim, Relations, SimplexId, VertexId};
use sig_tools::export::Format;
use sig_tools::frozen::{FrozenTree, MAX_SIMPLICES};
use sig_tools::names::{FindError, find_simplex, simplex_labels};
use sig_tools::store::Access;
use sig_tools::with_view;

use super::frozen_output::{self, FrozenTarget};
use super::input::How;
use super::tree_input::{self, Opened};
use super::{UsageError, output};

/// List a complex as the words of its simplex tree, or write it as another kind of file
///
/// A simplex is one line: the labels of its vertices, separated by commas, in the order of the vertices; then, where the
/// file has filtration values, a blank and its value. With --json an array of objects with simplex and value.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig tree words rips.sigc                       all simplices, by dimension
  sig tree words rips.sigc --order depth-first   as a tree is walked
  sig tree words rips.sigc --dim 2               the triangles
  sig tree children rips.sigc 3,17               the simplices with one vertex more, after the last one
  sig tree prefix rips.sigc 3,17                 all simplices whose words start so
  sig tree convert rips.sigc -o all.sigc --kind sig    compute boundary and co-boundary relations as well
  sig tree convert gudhi.txt -o tree.sigc --kind tree  GUDHI's text becomes a file
  sig tree text rips.sigc -o rips.txt            for GUDHI's Simplex_tree")]
pub(super) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List the simplices
    Words {
        /// The file; `-` is standard input
        file: PathBuf,

        #[command(flatten)]
        how: How,

        /// Only those of one dimension
        #[arg(long, value_name = "P", conflicts_with = "order")]
        dim: Option<Dim>,

        /// The order
        #[arg(long, value_enum, default_value_t)]
        order: Order,

        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// List the children of a simplex: those with one vertex more, after its last one
    Children(OfSimplex),
    /// List the simplices whose words start with the word of a simplex, itself among them
    Prefix(OfSimplex),
    /// Write the complex as a file of either kind
    Convert {
        /// A file of this program, or GUDHI's simplex-tree text; `-` is standard input
        file: PathBuf,

        #[command(flatten)]
        how: How,

        #[command(flatten)]
        target: FrozenTarget,

        /// Print a JSON object on what was written
        #[arg(long)]
        json: bool,
    },
    /// Write GUDHI's simplex-tree text: dimension, vertices and filtration value, one simplex a line
    Text {
        /// The file; `-` is standard input
        file: PathBuf,

        #[command(flatten)]
        how: How,

        #[command(flatten)]
        target: output::Target,
    },
}

#[derive(clap::Args)]
struct OfSimplex {
    /// The file; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// The simplex: the labels of its vertices, separated by commas, in any order
    #[arg(allow_hyphen_values = true)]
    simplex: String,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Order {
    /// By dimension, then lexicographically
    #[default]
    Dimension,
    /// Lexicographically: each simplex before those whose words start with its word
    DepthFirst,
    /// By filtration value, then dimension, then lexicographically
    Filtration,
}

/// A simplex by its labels.
#[derive(Serialize)]
struct Word {
    simplex: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        match self.command {
            Command::Words { file, how, dim, order, json } => {
                let input = how.open(&file, Access::Sequential)?;
                Ok(with_view!(input.view(), complex => words(&complex, dim, order, json))?)
            }
            Command::Children(of) => {
                let input = of.how.open(&of.file, Access::Random)?;
                with_view!(input.view(), complex => of.children(&complex))
            }
            Command::Prefix(of) => {
                let input = of.how.open(&of.file, Access::Random)?;
                with_view!(input.view(), complex => of.prefix(&complex))
            }
            Command::Convert { file, how, target, json } => {
                target.check(std::slice::from_ref(&file), json)?;
                let written = frozen_output::write(frozen(&file, &how)?, &target, None)?;
                written.log();
                Ok(if json { output::json(&written) } else { Ok(()) }?)
            }
            Command::Text { file, how, target } => super::export::export(&file, &how, &target, Format::Gudhi),
        }
    }
}

/// The complex in a file, which is right, or in GUDHI's text.
fn frozen(file: &Path, how: &How) -> anyhow::Result<FrozenTree> {
    let input = match tree_input::open(file, how)? {
        Opened::Ours(input) => input,
        Opened::Other(reader, length) => return Ok(tree_input::read_text(reader, file, length)?.freeze()),
    };
    let name = || tree_input::displayed(file);
    with_view!(input.view(), complex => {
        complex.validate().with_context(|| format!("{}: damaged; see sig verify", name()))?;
        tree_input::say_without_attributes(&complex, &name());
        FrozenTree::of(&complex).with_context(|| format!("{}: more than {MAX_SIMPLICES} simplices", name()))
    })
}

fn words<V: Relations>(complex: &V, dim: Option<Dim>, order: Order, json: bool) -> io::Result<()> {
    match (dim, order) {
        (Some(dim), _) => print(complex, complex.simplices_of_dim(dim), json),
        (None, Order::Dimension) => print(complex, complex.simplices(), json),
        (None, Order::DepthFirst) => print(complex, complex.depth_first(), json),
        (None, Order::Filtration) => {
            if complex.filtration().is_none() {
                output::log("sig: note: the file has no filtration values; the order is that by dimension");
            }
            let mut order = vec![<V::Index as sig_core::Index>::ZERO; complex.num_simplices()];
            print(complex, complex.filtration_order(&mut order).map_err(io::Error::other)?, json)
        }
    }
}

/// Lists simplices, each as it comes: there may be more than memory holds.
fn print(complex: &impl Relations, mut simplices: impl Iterator<Item = SimplexId>, json: bool) -> io::Result<()> {
    let values = complex.filtration();
    let value = |simplex: SimplexId| values.and_then(|values| values.get(simplex.index()).copied());
    output::stdout(|out| {
        if !json {
            return simplices.try_for_each(|simplex| {
                write!(out, "{}", simplex_labels(complex, simplex).join(","))?;
                value(simplex).map_or(Ok(()), |value| write!(out, " {value}"))?;
                writeln!(out)
            });
        }
        out.write_all(b"[")?;
        for (number, simplex) in simplices.enumerate() {
            out.write_all(if number > 0 { b"," } else { b"" })?;
            serde_json::to_writer(
                &mut *out,
                &Word { simplex: simplex_labels(complex, simplex), value: value(simplex) },
            )?;
        }
        writeln!(out, "]")
    })
}

impl OfSimplex {
    fn labels(&self) -> Vec<&str> {
        self.simplex.split(',').map(str::trim).collect()
    }

    fn explained(&self, error: FindError) -> anyhow::Error {
        match error {
            FindError::RepeatedVertex { .. } => UsageError(error.to_string()).into(),
            error => anyhow::Error::new(error).context(self.file.display().to_string()),
        }
    }

    fn children(&self, complex: &impl Relations) -> anyhow::Result<()> {
        let simplex = find_simplex(complex, &self.labels()).map_err(|error| self.explained(error))?;
        Ok(print(complex, complex.children(simplex), self.json)?)
    }

    fn prefix(&self, complex: &impl Relations) -> anyhow::Result<()> {
        let simplex = find_simplex(complex, &self.labels()).map_err(|error| self.explained(error))?;
        let vertices: Vec<VertexId> = complex.vertices(simplex).collect();
        Ok(print(complex, complex.with_prefix(&vertices), self.json)?)
    }
}
