//! Writing a simplex tree in level order as a file of either kind, or as text: what every command ends with that makes or changes a
//! complex by its tree.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::ValueEnum;
use serde::Serialize;
use sig_core::IndexWidth;
use sig_tools::build::{self, BuildError, BuildOptions, Built};
use sig_tools::export::{Format, export};
use sig_tools::frozen::{FrozenTree, LastVertices};
use sig_tools::store::{EncodeOptions, Encoding, Loaded};
use sig_tools::with_view;

use super::output::{self, Content, grouped};
use super::progress;

/// Which file a complex becomes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, ValueEnum)]
pub(super) enum Kind {
    /// Vertices and children only: the least bytes, for huge complexes
    Tree,
    /// Boundary and co-boundary relations as well, which answer every query
    #[default]
    Sig,
    /// GUDHI's simplex-tree text, by filtration value; vertices without integer labels by their numbers
    Gudhi,
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
    /// Checks, before the long work, that [`write`](write()) will not be refused, and that it replaces none of the inputs.
    pub(super) fn check(&self, inputs: &[PathBuf], json: bool) -> anyhow::Result<()> {
        self.target.check(inputs, json, if self.kind == Kind::Gudhi { Content::Text } else { Content::Binary })
    }

    /// The bytes that are free on the disk of the file, if the system tells. A file of this program takes at least what its
    /// tree takes in memory; of text there is no such bound.
    pub(super) fn free_bytes(&self) -> Option<u64> {
        let path = &self.target.output;
        if self.kind == Kind::Gudhi || output::is_stdout(path) { None } else { free_bytes(path) }
    }

    /// Refuses to begin a file that the disk cannot hold.
    fn check_disk(&self, tree: &FrozenTree) -> anyhow::Result<()> {
        let needed = least_bytes(tree, self.kind);
        match self.free_bytes().filter(|&free| free < needed) {
            None => Ok(()),
            Some(free) => {
                Err(anyhow::anyhow!("{}", self.full_disk(&format!("more than {} bytes", grouped(needed)), free)))
            }
        }
    }

    /// Says that the file takes more than is free.
    pub(super) fn full_disk(&self, needed: &str, free: u64) -> String {
        let path = self.target.output.display();
        format!("{path}: the file takes {needed}, and the disk has {} free", grouped(free))
    }
}

/// The bytes that are free on the disk of a file to be written, if the system tells.
fn free_bytes(path: &Path) -> Option<u64> {
    #[cfg(unix)]
    {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let disk = rustix::fs::statvfs(folder).ok()?;
        disk.f_bavail.checked_mul(disk.f_frsize)
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        None
    }
}

/// Bytes that the file takes at the least: vertices and values, and of the relations all but the lists.
fn least_bytes(tree: &FrozenTree, kind: Kind) -> u64 {
    let label = if matches!(tree.last_vertices, LastVertices::Bits16(_)) { 2 } else { 4 };
    let value = if tree.filtration.is_some() { 8 } else { 0 };
    let index = IndexWidth::least_for(tree.num_simplices as u64).map_or(8, |width| width.bytes() as u64);
    let facets = |dim: u64| if kind == Kind::Sig { (dim + 1) * index } else { 0 };
    (0..).zip(tree.counts()).map(|(dim, count)| count as u64 * (label + value + facets(dim))).sum()
}

/// Adds the relations to a tree.
fn complete(tree: FrozenTree, memory: Option<u64>) -> anyhow::Result<Built> {
    let bars = progress::Phases::new();
    let show = |phase, done, total| bars.show(phase, done, total);
    let progress = progress::is_watched().then_some(&show as build::Progress<'_>);
    let built = build::complete(tree, &BuildOptions { progress, max_bytes: memory, ..BuildOptions::default() });
    bars.clear();
    match built {
        Err(error @ BuildError::TooLarge { .. }) => {
            Err(error).context("the relations do not fit into memory; --kind tree does without them")
        }
        built => Ok(built?),
    }
}

/// What was written; as JSON, the names of the fields.
#[derive(Serialize, Debug)]
pub(super) struct Written {
    output: String,
    kind: &'static str,
    file_bytes: u64,
    /// Of a file of this program.
    #[serde(skip_serializing_if = "Option::is_none")]
    index_bits: Option<u32>,
    dimension: i64,
    simplices: Vec<usize>,
}

/// Writes the tree, completed to a Simplified Incidence Graph if the target asks for one; that may take as many bytes of
/// memory as are told, or are free.
pub(super) fn write(tree: FrozenTree, target: &FrozenTarget, memory: Option<u64>) -> anyhow::Result<Written> {
    target.check_disk(&tree)?;
    let options = EncodeOptions {
        checksums: !target.no_checksums,
        provenance: target.provenance.as_deref(),
        ..EncodeOptions::default()
    };
    let simplices = tree.counts();
    let write = |encoding: Encoding<'_>| -> anyhow::Result<(u64, Option<u32>)> {
        to_path(target, |out| encoding.write_to(out))?;
        Ok((encoding.file_bytes()?, Some(encoding.width().bits())))
    };
    let (file_bytes, index_bits) = match target.kind {
        Kind::Tree => write(Encoding::of_tree(&tree, &options)?)?,
        Kind::Sig => write(Encoding::new(&complete(tree, memory)?, &options)?)?,
        Kind::Gudhi => {
            // As it would be in a file, from which `sig tree text` and `sig export` write.
            let file = Loaded::from_file_bytes(Encoding::of_tree(&tree, &EncodeOptions::default())?.to_bytes()?)?;
            drop(tree);
            let view = file.view();
            let mut bytes = 0;
            to_path(target, |out| {
                let mut out = io::BufWriter::new(Counted { out, bytes: &mut bytes });
                with_view!(view, complex => export(&complex, Format::Gudhi, &mut out)).map_err(io::Error::other)?;
                out.flush()
            })?;
            (bytes, None)
        }
    };
    Ok(Written {
        output: target.target.output.display().to_string(),
        kind: match target.kind {
            Kind::Tree => "tree",
            Kind::Sig => "sig",
            Kind::Gudhi => "gudhi",
        },
        file_bytes,
        index_bits,
        dimension: i64::try_from(simplices.len()).unwrap_or(i64::MAX) - 1,
        simplices,
    })
}

fn to_path(target: &FrozenTarget, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> anyhow::Result<()> {
    let (path, existing) = (&target.target.output, target.target.existing());
    if output::is_stdout(path) {
        // A bar would run across the data.
        return output::to_path(path, existing, fill);
    }
    progress::during("writing the file", || output::to_path(path, existing, fill))
}

impl Written {
    /// Says it on standard error.
    pub(super) fn log(&self) {
        output::log(format_args!("made   dimension {}, {}", self.dimension, output::counted(&self.simplices)));
        let width = self.index_bits.map_or(String::new(), |width| format!(", {width}-bit indices"));
        output::log(format_args!("wrote  {}: {}, {} bytes{width}", self.output, self.kind, grouped(self.file_bytes)));
    }
}

/// A writer that counts.
struct Counted<'a> {
    out: &'a mut dyn Write,
    bytes: &'a mut u64,
}

impl Write for Counted<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        *self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
