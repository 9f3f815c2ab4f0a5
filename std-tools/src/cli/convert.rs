//! `sig convert`: a file of one format as one of another, without a complex in a file between them.

use std::path::{Path, PathBuf};

use sig_tools::build::{BuildOptions, Unused, VertexOrder, build};
use sig_tools::io::{self as readers, Format, ReadOptions};
use sig_tools::store::atomic::Existing;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Loaded, export};

use super::build::{Cleaning, Input as Read};
use super::input::{How, Input};
use super::tree_input::{self, Opened};
use super::{export as exporting, output, progress};

/// Convert a mesh or a list of simplices to another format
///
/// Repeated simplices are merged, and simplices that are faces of others left out. What the format cannot hold is refused, or
/// told if the simplices are all there. `sig formats` lists the formats.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig convert part.inp part.vtu
  sig convert scan.stl.xz scan.ply --weld 1e-6 --drop-degenerate
  sig convert bunny.sigc bunny.gltf
  curl … | sig convert - mesh.off --format medit")]
pub(super) struct Args {
    /// The file to read, a complex or in any format that `sig build` reads; `-` is standard input
    input: PathBuf,

    /// The file to write; `-` is standard output
    output: PathBuf,

    /// The format of the input; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,

    /// The format of the output; by default the one that its name stands for
    #[arg(short, long, value_parser = super::named(export::Format::ALL, export::Format::name, export::Format::description))]
    to: Option<export::Format>,

    #[command(flatten)]
    cleaning: Cleaning,

    #[command(flatten)]
    how: How,

    /// Replace OUTPUT if it exists
    #[arg(long)]
    force: bool,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let existing = if self.force { Existing::Replace } else { Existing::Refuse };
        let format = exporting::format(self.to, &self.output, "--to")?;
        output::check(&self.output, existing, std::slice::from_ref(&self.input))?;
        let input = match tree_input::open(&self.input, &self.how)? {
            Opened::Ours(input) => input,
            Opened::Other(reader, length) => self.read(reader, length)?,
        };
        exporting::write(&input, &tree_input::displayed(&self.input), &self.output, existing, format)
    }

    /// Reads the input, and builds its complex with the vertices in the order of the input.
    fn read(&self, reader: impl std::io::Read, length: Option<u64>) -> anyhow::Result<Input> {
        let name = tree_input::displayed(&self.input);
        let options = self.cleaning.options(self.format);
        let (soup, report) = progress::reading_of(length, &name, |progress| {
            let options = ReadOptions { progress, ..options };
            if self.input == Path::new("-") {
                readers::read(reader, "-", &options)
            } else {
                // By its name, as some meshes are several files.
                readers::read_path(&self.input, &options)
            }
        })?;
        Read::new(&self.input, report).log();
        let unused = if self.cleaning.drop_unused { Unused::Drop } else { Unused::Keep };
        let options = BuildOptions { order: VertexOrder::Input, unused, ..BuildOptions::default() };
        let built = progress::during("building", || build(soup, &options))?;
        let options = EncodeOptions { checksums: false, tree: false, ..EncodeOptions::default() };
        Ok(Input::Loaded(Loaded::from_file_bytes(Encoding::new(&built, &options)?.to_bytes()?)?))
    }
}
