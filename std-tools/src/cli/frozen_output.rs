//! Writing a simplex tree in level order as a file of either kind: what every command ends with that makes or changes a
//! complex by its tree.

use std::io::IsTerminal;
use std::path::PathBuf;

use clap::ValueEnum;
use serde::Serialize;
use sig_tools::build::{self, BuildError, BuildOptions, Built, VertexOrder};
use sig_tools::frozen::FrozenTree;
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};

use super::output::{self, grouped};
use super::{UsageError, progress};

/// Which file a complex becomes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, ValueEnum)]
pub(super) enum Kind {
    /// Vertices and children only: the least bytes, for huge complexes
    Tree,
    /// Boundary and co-boundary relations as well, which answer every query
    #[default]
    Sig,
}

/// The arguments of a file of either kind.
#[derive(clap::Args)]
pub(super) struct FrozenTarget {
    #[command(flatten)]
    pub(super) target: output::Target,

    /// What the file holds
    #[arg(long, value_enum, default_value_t)]
    kind: Kind,

    /// Leave out the checksums
    #[arg(long)]
    no_checksums: bool,

    /// Text to be kept in the file: where the complex comes from
    #[arg(long, value_name = "TEXT")]
    provenance: Option<String>,
}

impl FrozenTarget {
    /// Checks, before the long work, that [`write`] will not be refused, and that it replaces none of the inputs.
    pub(super) fn check(&self, inputs: &[PathBuf], json: bool) -> anyhow::Result<()> {
        let path = &self.target.output;
        if json && output::is_stdout(path) {
            return Err(UsageError("--json and -o - both want standard output".to_owned()).into());
        }
        if output::is_stdout(path) && std::io::stdout().is_terminal() {
            return Err(UsageError("-o - writes a binary file, and standard output is a terminal".to_owned()).into());
        }
        output::check(path, self.target.existing(), inputs)
    }
}

/// What was written; as JSON, the names of the fields.
#[derive(Serialize, Debug)]
pub(super) struct Written {
    output: String,
    kind: &'static str,
    file_bytes: u64,
    index_bits: u32,
    dimension: i64,
    simplices: Vec<usize>,
}

/// Writes the tree, completed to a Simplified Incidence Graph if the target asks for one.
pub(super) fn write(tree: FrozenTree, target: &FrozenTarget) -> anyhow::Result<Written> {
    let options = EncodeOptions {
        checksums: !target.no_checksums,
        provenance: target.provenance.as_deref(),
        ..EncodeOptions::default()
    };
    let simplices = tree.counts();
    let write = |encoding: Encoding<'_>| -> anyhow::Result<(u64, u32)> {
        output::to_path(&target.target.output, target.target.existing(), |out| encoding.write_to(out))?;
        Ok((encoding.file_bytes()?, encoding.width().bits()))
    };
    let (file_bytes, index_bits) = match target.kind {
        Kind::Tree => write(Encoding::of_tree(&tree, &options)?)?,
        Kind::Sig => {
            let bars = progress::Phases::new();
            let show = |phase, done, total| bars.show(phase, done, total);
            let progress = progress::is_watched().then_some(&show as build::Progress<'_>);
            let built = complete(tree, &BuildOptions { progress, ..BuildOptions::default() });
            bars.clear();
            write(Encoding::new(&built?, &options)?)?
        }
    };
    Ok(Written {
        output: target.target.output.display().to_string(),
        kind: if target.kind == Kind::Tree { "tree" } else { "sig" },
        file_bytes,
        index_bits,
        dimension: i64::try_from(simplices.len()).unwrap_or(i64::MAX) - 1,
        simplices,
    })
}

impl Written {
    /// Says it on standard error.
    pub(super) fn log(&self) {
        let total: usize = self.simplices.iter().sum();
        let counts: Vec<_> = self.simplices.iter().map(grouped).collect();
        let counts = if counts.is_empty() { String::new() } else { format!(": {}", counts.join(" + ")) };
        output::log(format_args!("made   dimension {}, {} simplices{counts}", self.dimension, grouped(total)));
        let (bytes, width) = (grouped(self.file_bytes), self.index_bits);
        output::log(format_args!("wrote  {}: {}, {bytes} bytes, {width}-bit indices", self.output, self.kind));
    }
}

/// The whole graph of a tree, by way of its simplices. The vertices keep their numbers, so ids are the tree's.
fn complete(tree: FrozenTree, options: &BuildOptions<'_>) -> Result<Built, BuildError> {
    let FrozenTree { labels, coordinates, filtration, .. } = &tree;
    let mut soup = Soup::new(Labels::Numbered(tree.num_vertices()), true);
    let mut word = Vec::new();
    for vertex in 0..tree.num_vertices() {
        push_subtree(&tree, vertex, &mut word, &mut soup);
    }
    let (labels, coordinates, filtration) = (labels.clone(), coordinates.clone(), filtration.clone());
    drop(tree);
    let options = BuildOptions { order: VertexOrder::Input, ..*options };
    Ok(Built { labels, coordinates, filtration, ..build::build(soup, &options)? })
}

fn push_subtree(tree: &FrozenTree, id: usize, word: &mut Vec<u32>, soup: &mut Soup) {
    word.push(tree.last_vertices.at(id));
    let children = tree.children(id);
    // Words that start with this one are its cofaces: listing those is enough.
    if children.is_empty() {
        soup.push(word);
    }
    children.for_each(|child| push_subtree(tree, child, word, soup));
    word.pop();
}
