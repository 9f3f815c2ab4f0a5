//! `sig homology`: Betti numbers, torsion and generators.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::Context;
use num_traits::ToPrimitive;
use sig_core::{Dim, Relations, SimplexId, VertexId};
use sig_tools::export::{self, ExportError, NamedChain, check_chains, export_chains};
use sig_tools::homology::{
    Cells, Chains, Generator, GeneratorOptions, Homology, HomologyError, HomologyOptions, Limits, Simplices,
    generators, homology,
};
use sig_tools::io::Format;
use sig_tools::mcc::Front;
use sig_tools::names::simplex_labels;
use sig_tools::with_view;

use super::expansion::bytes;
use super::homology_input::{Source, marked, marked_cells, open};
use super::homology_report::{Named, NamedGenerators, Report, Ring};
use super::input::How;
use super::{Threads, UsageError, interrupt, output, progress, tree_input};

/// Compute homology: how many components, tunnels and voids there are, and which torsion
///
/// The complex is a file of this program, of any kind, a mesh, a list of simplices, or a cell complex in text. Betti numbers are
/// told for each dimension up to that of the complex, torsion as invariant factors. `critical` are the cells that the reduction
/// left.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig homology bunny.sigc                               over the integers
  sig homology rips.sigc --over Z2 --json               {\"betti\":[1,0,1],\"torsion\":[[],[],[]],…}
  sig homology klein.off --over Q                       of a mesh, without a file
  sig homology ball.sigc --relative sphere.simplices    relative to a subcomplex, by its vertex labels
  sig homology torus.off --generators                   with cycles, by the labels of the vertices
  sig homology torus.off --shorten -o loops.vtu         loops as short as can be, for ParaView
  sig homology lens.cells                               of a cell complex in text
  sig homology bunny.mcc                                of a multi-resolution complex: that of every front
  sig homology bunny.mcc --generators --count 5000      with cycles of the front after 5000 refinements
  sig homology rips.sigc --max-dim 4 --max-seconds 60   what is found within a minute, up to dimension 4")]
pub(super) struct Args {
    /// The complex; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// The coefficients: `Z`, `Q`, or `Zp` for a prime p, as in `Z2`
    #[arg(long, value_name = "RING", default_value = "Z")]
    over: Ring,

    /// Relative to a subcomplex: a file of simplices that must be in the complex, faces of theirs being meant, too; of cells,
    /// a text with the dimension and the number of a cell on each line
    #[arg(long, value_name = "SUB")]
    relative: Option<PathBuf>,

    /// Tell cycles that generate the groups, as sums of simplices with their orientations, or of cells by their numbers in their
    /// dimension; of torsion also a chain, the boundary of which is the cycle times its order
    #[arg(long)]
    generators: bool,

    /// Write the cycles that generate the groups, for other programs to show: .vtu, with the number of the chain and the
    /// coefficient of each simplex, or .obj, a group each
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,

    /// Replace OUT if it exists
    #[arg(long, requires = "output")]
    force: bool,

    /// Make cycles of dimension 1 shorter in their classes, piece by piece: by the lengths of edges where there are coordinates,
    /// else by their number
    #[arg(long)]
    shorten: bool,

    /// Tell cocycles, too, each of them 1 on the cycle of its generator and 0 on the others
    #[arg(long)]
    cocycles: bool,

    /// The highest dimension of a group; simplices of more than one dimension above it are not looked at
    #[arg(long, value_name = "K")]
    max_dim: Option<u8>,

    /// Of a multi-resolution complex, the front after the first N refinements
    #[arg(long, value_name = "N")]
    count: Option<usize>,

    /// Of a multi-resolution complex, the front with the refinements without which the error would be above E
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    error: Option<f32>,

    /// Stop after so many seconds, and tell what was found
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    max_seconds: Option<Duration>,

    /// Stop before so much memory is taken beside the complex, like 4GiB, and tell what was found
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    max_memory: Option<u64>,

    /// The format of meshes and lists of simplices; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,

    #[command(flatten)]
    threads: Threads,

    /// Print a JSON object
    #[arg(long)]
    json: bool,
}

/// A number of seconds.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds.ok_or_else(|| "not a number of seconds".to_owned())
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        self.threads.start()?;
        let written = self.written()?;
        let until = self.max_seconds.and_then(|seconds| Instant::now().checked_add(seconds));
        let source = open(&self.file, &self.how, self.format)?;
        let is_multi_resolution = matches!(source, Source::MultiResolution(_));
        if (self.count.is_some() || self.error.is_some()) && !is_multi_resolution {
            return Err(UsageError("--count and --error want a multi-resolution complex".to_owned()).into());
        }
        if written.is_some() && !matches!(source, Source::Simplicial(_)) {
            return Err(UsageError("-o wants a simplicial complex: cells have no shape".to_owned()).into());
        }
        interrupt::begin();
        let limits = Limits { until, max_bytes: self.max_memory, interrupt: Some(interrupt::flag()), progress: None };
        let options =
            HomologyOptions { over: self.over.0, max_dim: self.max_dim.map(Dim::from), limits, ..Default::default() };
        let options = GeneratorOptions { homology: options, cocycles: self.cocycles, lengths: None };
        let (found, generators) = match source {
            Source::Cells(complex) => {
                self.of_cells(&Cells::new(&complex), &options, &|_, cell| vec![cell.to_string()])?
            }
            Source::MultiResolution(file) => {
                let mut front = Front::new(file.view());
                let mcc = *front.mcc();
                let is_wanted = |refinement: usize| {
                    self.count.is_some_and(|count| refinement < count)
                        || self.error.is_some_and(|error| mcc.error(refinement) > error)
                };
                front.select(is_wanted).with_context(|| self.file.display().to_string())?;
                let cells = Cells::new(front.complex());
                let ids: Vec<_> = (0..cells.counts().len()).map(|dim| cells.of_dim(dim)).collect();
                // By the number in the complex that was simplified: there it was a simplex.
                let name = |dim: Dim, cell: u32| {
                    let id = ids[dim][cell as usize];
                    vec![mcc.origin(id).unwrap_or(id.index()).to_string()]
                };
                self.of_cells(&cells, &options, &name)?
            }
            Source::Simplicial(input) => with_view!(input.view(), complex => {
                let name = tree_input::displayed(&self.file);
                complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
                self.of_simplices(&complex, &options, written)?
            }),
        };
        interrupt::end();
        let stopped = found.stopped;
        let report = Report::new(found, self.over, generators);
        if self.json {
            output::json(&report)?;
        } else {
            let relative =
                self.relative.as_deref().map_or(String::new(), |path| format!(" relative to {}", path.display()));
            let title = format!("{}: homology{relative}", tree_input::displayed(&self.file));
            output::stdout(|out| report.print(&title, self.over, out))?;
        }
        match stopped {
            Some(stopped) => Err(anyhow::anyhow!("{stopped}; what is not told was not found")),
            None => Ok(()),
        }
    }

    /// The format of the chains to be written, if any are.
    fn written(&self) -> anyhow::Result<Option<export::Format>> {
        let Some(path) = &self.output else { return Ok(None) };
        if self.json && output::is_stdout(path) {
            return Err(UsageError("--json and -o - both want standard output".to_owned()).into());
        }
        output::check(path, self.existing(), std::slice::from_ref(&self.file))?;
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        match export::Format::from_name(extension) {
            Some(format @ (export::Format::Obj | export::Format::Vtu)) => Ok(Some(format)),
            _ => {
                let message =
                    format!("{}: the name does not tell the format; end it with .vtu or .obj", path.display());
                Err(UsageError(message).into())
            }
        }
    }

    fn existing(&self) -> sig_tools::store::atomic::Existing {
        use sig_tools::store::atomic::Existing;
        if self.force { Existing::Replace } else { Existing::Refuse }
    }

    fn of_cells(
        &self,
        cells: &Cells<'_>,
        options: &GeneratorOptions<'_>,
        name: &impl Fn(Dim, u32) -> Vec<String>,
    ) -> anyhow::Result<(Homology, Option<NamedGenerators>)> {
        let marks = self.relative.as_deref().map(|path| marked_cells(cells, path, &self.how)).transpose()?;
        let one = |_: u32| 1.0;
        let mut options = *options;
        options.homology.relative_to = marks.as_deref();
        options.lengths = self.shorten.then_some(&one);
        let (found, generators) = self.compute(cells, &options)?;
        Ok((found, generators.map(|generators| named(generators, name))))
    }

    fn of_simplices<C: Relations + Sync>(
        &self,
        complex: &C,
        options: &GeneratorOptions<'_>,
        written: Option<export::Format>,
    ) -> anyhow::Result<(Homology, Option<NamedGenerators>)> {
        let marks = self.relative.as_deref().map(|path| marked(complex, path, &self.how, self.format)).transpose()?;
        let length = |edge: u32| length(complex, edge);
        let mut options = *options;
        let of = |dim: Dim, cell: u32| SimplexId::new(complex.simplices_of_dim(dim).bounds().0.index() + cell as usize);
        options.homology.relative_to = marks.as_deref();
        options.lengths = self.shorten.then_some(&length);
        if let Some(format) = written {
            // Before the long work: whether there are coordinates.
            check_chains(complex, format, &[])?;
        }
        let (found, generators) = self.compute(&Simplices(complex), &options)?;
        if let (Some(path), Some(format), Some(generators)) = (&self.output, written, &generators) {
            let chains = shown(generators, format, of);
            output::to_path(path, self.existing(), |out| {
                export_chains(complex, format, &chains, out).map_err(|error| match error {
                    ExportError::Io(error) => error,
                    other => std::io::Error::other(other),
                })
            })?;
            output::log(format_args!("wrote  {}: {} cycles", path.display(), chains.len()));
        }
        let name = |dim: Dim, cell: u32| simplex_labels(complex, of(dim, cell));
        let is_told = self.generators || self.cocycles || self.shorten || self.json;
        Ok((found, generators.filter(|_| is_told).map(|generators| named(generators, &name))))
    }

    /// The homology, and generators if they are asked for.
    fn compute(
        &self,
        chains: &impl Chains,
        options: &GeneratorOptions<'_>,
    ) -> anyhow::Result<(Homology, Option<Vec<Vec<Generator>>>)> {
        let found = progress::part_of("computing homology", |progress| {
            let mut options = options.homology;
            options.limits.progress = progress;
            homology(chains, &options)
        })?;
        if !(self.generators || self.cocycles || self.shorten || self.output.is_some()) || found.stopped.is_some() {
            return Ok((found, None));
        }
        let result = progress::part_of("finding generators", |progress| {
            let mut options = *options;
            options.homology.limits.progress = progress;
            generators(chains, &options)
        });
        match result {
            Err(HomologyError::Stopped(stopped)) => Ok((Homology { stopped: Some(stopped), ..found }, None)),
            result => Ok((found, Some(result?))),
        }
    }
}

/// Generators in names.
fn named(generators: Vec<Vec<Generator>>, name: &impl Fn(Dim, u32) -> Vec<String>) -> NamedGenerators {
    let of_dim =
        |(dim, all): (Dim, Vec<Generator>)| all.into_iter().map(|generator| Named::new(dim, generator, name)).collect();
    generators.into_iter().enumerate().map(of_dim).collect()
}

/// The cycles of the dimensions that a format holds, as they are shown.
fn shown(
    generators: &[Vec<Generator>],
    format: export::Format,
    simplex: impl Fn(Dim, u32) -> SimplexId,
) -> Vec<NamedChain> {
    let most = if format == export::Format::Obj { 2 } else { 3 };
    let mut chains = Vec::new();
    for (dim, all) in generators.iter().enumerate().take(most + 1) {
        for (number, generator) in all.iter().enumerate() {
            let order = generator.order.as_ref().and_then(ToPrimitive::to_f64).unwrap_or(0.0);
            let terms = generator.cycle.iter();
            let terms = terms.map(|(cell, value)| (simplex(dim, *cell), value.to_f64().unwrap_or(f64::NAN))).collect();
            let name = format!("generator_{dim}_{number}");
            chains.push(NamedChain { name, id: i64::try_from(chains.len()).unwrap_or(0), order, terms });
        }
    }
    chains
}

/// The length of an edge, 1 if there are no coordinates.
fn length(complex: &impl Relations, edge: u32) -> f64 {
    let Some(section) = complex.coordinates() else { return 1.0 };
    let components = section.components as usize;
    let id = complex.simplices_of_dim(1).bounds().0.index() + edge as usize;
    let value =
        |vertex: VertexId, axis: usize| section.column.number_at(vertex.index() * components + axis).unwrap_or(0.0);
    let mut ends = complex.vertices(SimplexId::new(id));
    let Some((one, other)) = ends.next().zip(ends.next()) else { return 0.0 };
    (0..components).map(|axis| (value(one, axis) - value(other, axis)).powi(2)).sum::<f64>().sqrt()
}
