//! `sig build`: meshes and lists of simplices become a complex in a file.

use std::fmt;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use sig_core::format::Column;
use sig_core::{Index, IndexWidth, SimplexId};
use sig_tools::attribute;
use sig_tools::build::external::{self, Kept, Resources, build_to_file};
use sig_tools::build::{self, Arrays, BuildOptions, BuildReport, Built, SigArrays, Unused, VertexOrder};
use sig_tools::io::{self as readers, Compression, Format, MergeReport, OnBad, ReadOptions, ReadReport, Weld};
use sig_tools::names::simplex_name;
use sig_tools::soup::Soup;
use sig_tools::spool::Spill;
use sig_tools::store::{EncodeError, EncodeOptions, Encoding};
use sig_tools::{Loaded, with_view};

use super::output::{self, Content, grouped};
use super::{Threads, UsageError, progress};

/// Build a complex from meshes or lists of simplices
///
/// Reads OFF, OBJ, PLY, STL, Gmsh MSH, lists of simplices by labels and more (see --format), also compressed with gzip,
/// xz or zstd. Lists that use the same labels speak of the same vertices; meshes are put beside each other. Polygons are split into triangles.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig build bunny.off -o bunny.sigc
  sig build part1.txt part2.txt -o all.sigc --force     simplices by label, from two files
  sig build bracket.msh.gz -o bracket.sigc --order input --json
  printf 'a,b,c\\nc,d\\n' | sig build - -o small.sigc --format simplices
  sig build huge.msh -o huge.sigc --memory 4GiB         larger than that, by way of the disk
  sig build huge.msh -o huge.sigc --memory 4GiB --resume work   run again, it goes on")]
pub(super) struct Args {
    /// The inputs; `-` is standard input
    #[arg(required = true, value_name = "INPUT")]
    inputs: Vec<PathBuf>,

    #[command(flatten)]
    target: output::Target,

    /// The format of the inputs; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,

    /// How vertices are numbered, which decides what lies together in the file
    #[arg(long, value_enum, default_value_t)]
    order: Order,

    /// The width of the indices in bits; by default the least that holds the complex
    #[arg(long, value_name = "BITS", value_parser = width_parser())]
    index_bits: Option<IndexWidth>,

    #[command(flatten)]
    cleaning: Cleaning,

    /// Leave out the sections that make finding simplices by vertices fast
    #[arg(long)]
    no_tree: bool,

    /// Store the top simplices at each simplex of one dimension less in pairs: less space, for complexes in which it has
    /// at most two
    #[arg(long)]
    pairs: bool,

    /// Leave out the checksums
    #[arg(long)]
    no_checksums: bool,

    /// Text to be kept in the file: where the complex comes from
    #[arg(long, value_name = "TEXT")]
    provenance: Option<String>,

    #[command(flatten)]
    threads: Threads,

    /// Refuse to build more than N simplices; by default, more than memory holds
    #[arg(long, value_name = "N")]
    max_simplices: Option<u64>,

    /// Build out of core, in at most this much memory, like 4GiB: the file is the same, the complex may be many times
    /// larger. What has to fit is the vertices, and on each thread the simplices around any one of them
    #[arg(long, value_name = "BYTES", value_parser = super::expansion::bytes, conflicts_with = "pairs")]
    memory: Option<u64>,

    /// Where to keep temporary data with `--memory`, about as much as the input, twice; by default, beside OUT. They
    /// have no name there, and are gone however the work ends
    #[arg(long, value_name = "DIR", requires = "memory")]
    temp_dir: Option<PathBuf>,

    /// Keep what is done with `--memory` in this directory, so that the same command, after an interruption, goes on from
    /// there. It takes the temporary data and the unfinished file, and should be on the disk of OUT. What this program
    /// made there is removed in the end, and so is the directory if it was not there
    #[arg(long, value_name = "DIR", requires = "memory", conflicts_with = "temp_dir")]
    resume: Option<PathBuf>,

    /// Print a JSON object on what was read and built
    #[arg(long)]
    json: bool,
}

/// What becomes of what is no part of a complex.
#[derive(clap::Args)]
pub(super) struct Cleaning {
    /// Drop the vertices of a mesh that no simplex uses; by default they stay, as simplices of dimension 0
    #[arg(long)]
    pub(super) drop_unused: bool,

    /// Drop simplices that repeat a vertex; by default they are an error
    #[arg(long)]
    drop_degenerate: bool,

    /// What becomes of cells that repeat a vertex or name one that is not there, and of vertices whose coordinates are not
    /// finite: refuse the input, or drop them and the cells at such vertices, and name the first
    #[arg(long, value_name = "refuse|drop", value_parser = bad_parser(), default_value = "refuse", hide_possible_values = true)]
    on_bad: OnBad,

    /// Leave out the attributes of vertices and cells: point and cell data, properties, references, groups
    #[arg(long)]
    drop_attributes: bool,

    /// Which vertices become one: none, those at one place (exact), or those at most DISTANCE apart; by default the corners
    /// of STL's triangles at one place
    #[arg(long, value_name = "none|exact|DISTANCE")]
    weld: Option<Weld>,
}

impl Cleaning {
    /// How to read an input of the given format.
    pub(super) fn options(&self, format: Option<Format>) -> ReadOptions<'static> {
        ReadOptions {
            format,
            drop_degenerate: self.drop_degenerate,
            on_bad: self.on_bad,
            drop_attributes: self.drop_attributes,
            weld: self.weld,
            ..ReadOptions::default()
        }
    }
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum Order {
    /// `hilbert` where there are coordinates, else `input`
    #[default]
    Auto,
    /// By label: numbers by value, other labels bytewise
    Input,
    /// Along a Hilbert curve through the coordinates
    Hilbert,
    /// By the reverse Cuthill–McKee order of the edges
    Rcm,
}

fn bad_parser() -> impl TypedValueParser<Value = OnBad> {
    PossibleValuesParser::new(["refuse", "drop"]).map(|word| if word == "drop" { OnBad::Drop } else { OnBad::Refuse })
}

fn width_parser() -> impl TypedValueParser<Value = IndexWidth> {
    PossibleValuesParser::new(["16", "32", "64"]).map(|bits| match bits.as_str() {
        "16" => IndexWidth::Bits16,
        "32" => IndexWidth::Bits32,
        _ => IndexWidth::Bits64,
    })
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let start = Instant::now();
        self.target.check(&self.inputs, self.json, Content::Binary)?;
        self.threads.start()?;
        let report = match self.memory {
            Some(memory) => self.out_of_core(memory)?,
            None => self.in_memory()?,
        };
        let report = Report { seconds: start.elapsed().as_secs_f64(), ..report };
        report.log();
        if self.json {
            output::json(&report)?;
        }
        Ok(())
    }

    fn in_memory(&self) -> anyhow::Result<Report> {
        let (path, existing) = (&self.target.output, self.target.existing());
        let (soup, inputs, merged) = self.read()?;
        let bars = progress::Phases::new();
        let show = |phase, done, total| bars.show(phase, done, total);
        let built = build::build(soup, &self.build_options(&show));
        bars.clear();
        let built = built?;
        let encoding = Encoding::new(&built, &self.encode_options()).map_err(|error| explain(error, &built))?;
        output::to_path(path, existing, |out| encoding.write_to(out))?;
        let simplices = match &built.arrays {
            Arrays::Narrow(arrays) => counts(arrays),
            Arrays::Wide(arrays) => counts(arrays),
        };
        let attributes = built.attributes.iter().map(|attribute::Attribute { name, dim, components, values }| {
            Attribute::new(name, *dim, *components, &values.column())
        });
        Ok(Report {
            output: path.display().to_string(),
            file_bytes: encoding.file_bytes()?,
            index_bits: encoding.width().bits(),
            attributes: attributes.collect(),
            ..Report::new(simplices, &built.report, inputs, &merged)
        })
    }

    fn out_of_core(&self, memory: u64) -> anyhow::Result<Report> {
        let [input] = self.inputs.as_slice() else {
            return Err(UsageError("--memory is for one input; put several lists into one".to_owned()).into());
        };
        let kept = self.resume.as_deref().map(Kept::open).transpose()?;
        let found = kept.as_ref().and_then(|kept| Some((self.resume.as_deref()?, kept.found()?)));
        if let Some((directory, [pieces, counted, written])) = found {
            let (directory, pieces) = (directory.display(), grouped(pieces));
            let (counted, written) = (grouped(counted), grouped(written));
            output::log(format_args!(
                "resume {directory}: simplices dealt out to {pieces} pieces, {counted} of them counted, {written} written"
            ));
        }
        let report = self.in_pieces(input, memory, kept.as_ref());
        if let (Err(error), Some(directory)) = (&report, &self.resume)
            && kept.is_some_and(|kept| kept.is_of_use())
            && !matches!(error.downcast_ref(), Some(external::Error::OfAnother { .. }))
        {
            let directory = directory.display();
            output::log(format_args!("kept   {directory}: what was done; the same command goes on from there"));
        }
        report
    }

    /// Builds out of core, and keeps what is done in `kept`.
    fn in_pieces(&self, input: &Path, memory: u64, kept: Option<&Kept>) -> anyhow::Result<Report> {
        let (path, existing) = (&self.target.output, self.target.existing());
        let beside = path.parent().filter(|parent| !parent.as_os_str().is_empty() && !output::is_stdout(path));
        let chosen = self.resume.as_deref().or(self.temp_dir.as_deref());
        let directory = chosen.or(beside).unwrap_or(Path::new("."));
        let unusable = || format!("{}: cannot keep temporary data there", directory.display());
        let spill = Spill::new_in(directory).with_context(unusable)?;
        let (soup, read) = self.read_one(input, Some(&spill))?;
        let bars = progress::Phases::new();
        let show = |phase, done, total| bars.show(phase, done, total);
        let (options, encode) = (self.build_options(&show), self.encode_options());
        let resources = Resources { memory, directory, kept };
        let build = |file: &File| build_to_file(soup, spill, &options, &encode, resources, file);
        let outcome = match kept {
            None => output::to_file(path, existing, directory, build),
            Some(kept) => build(kept.file()).map_err(anyhow::Error::from),
        };
        bars.clear();
        let outcome = outcome?;
        if let Some(kept) = kept {
            output::place(&kept.path(), path, existing)?;
            kept.finish();
        }
        let inputs = vec![Input::new(input, read)];
        Ok(Report {
            output: path.display().to_string(),
            file_bytes: outcome.file_bytes,
            index_bits: outcome.width.bits(),
            out_of_core: Some(OutOfCore {
                pieces: outcome.pieces,
                temporary_bytes: outcome.temporary_bytes,
                peak_bytes: peak_memory(),
            }),
            ..Report::new(outcome.simplices, &outcome.report, inputs, &MergeReport::default())
        })
    }

    fn encode_options(&self) -> EncodeOptions<'_> {
        EncodeOptions {
            width: self.index_bits,
            tree: !self.no_tree,
            pairs: self.pairs,
            checksums: !self.no_checksums,
            provenance: self.provenance.as_deref(),
            ..EncodeOptions::default()
        }
    }

    fn read(&self) -> anyhow::Result<(Soup, Vec<Input>, MergeReport)> {
        let (mut soups, mut inputs) = (Vec::new(), Vec::new());
        for path in &self.inputs {
            let (soup, report) = self.read_one(path, None)?;
            soups.push(soup);
            inputs.push(Input::new(path, report));
        }
        let (soup, merged) = readers::merge(soups).context("cannot put the inputs together")?;
        Ok((soup, inputs, merged))
    }

    fn read_one(&self, path: &Path, spill: Option<&Spill>) -> Result<(Soup, ReadReport), readers::ReadError> {
        let options = ReadOptions { spill, ..self.cleaning.options(self.format) };
        progress::reading(path, |progress| readers::read_path(path, &ReadOptions { progress, ..options }))
    }

    fn build_options<'a>(&self, progress: build::Progress<'a>) -> BuildOptions<'a> {
        BuildOptions {
            order: match self.order {
                Order::Auto => VertexOrder::Auto,
                Order::Input => VertexOrder::Input,
                Order::Hilbert => VertexOrder::Hilbert,
                Order::Rcm => VertexOrder::Rcm,
            },
            unused: if self.cleaning.drop_unused { Unused::Drop } else { Unused::Keep },
            max_simplices: self.max_simplices,
            progress: progress::is_watched().then_some(progress),
            ..BuildOptions::default()
        }
    }
}

/// An error that names a simplex by its labels where the encoder has its number only.
fn explain(error: EncodeError, built: &Built) -> anyhow::Error {
    let EncodeError::Crowded { simplex, dim, cofaces } = error else { return error.into() };
    let file = Encoding::new(built, &EncodeOptions::default()).and_then(|encoding| encoding.to_bytes());
    let Some(file) = file.ok().and_then(|bytes| Loaded::from_file_bytes(bytes).ok()) else { return error.into() };
    let name = with_view!(file.view(), complex => simplex_name(&complex, SimplexId::new(simplex)));
    anyhow::anyhow!("simplex {name} is a face of {cofaces} simplices of dimension {dim}, and --pairs has room for two")
}

/// What was read and built; as JSON, the names of the fields.
#[derive(Serialize, Default)]
struct Report {
    output: String,
    file_bytes: u64,
    index_bits: u32,
    dimension: i64,
    simplices: Vec<usize>,
    top_simplices: Vec<usize>,
    inputs: Vec<Input>,
    renumbered: Vec<Renumbered>,
    /// Simplices that the inputs list, and what became of them.
    listed: usize,
    repeated: usize,
    non_maximal: usize,
    conflicting_orientations: usize,
    unused_vertices_kept: usize,
    unused_vertices_dropped: usize,
    /// The labels of the first of them.
    first_unused_vertices: Vec<String>,
    attributes: Vec<Attribute>,
    /// The names of those that inputs have in different shapes.
    attributes_left_out: Vec<String>,
    repeated_with_other_attributes: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    out_of_core: Option<OutOfCore>,
    seconds: f64,
}

/// An attribute that is kept.
#[derive(Serialize)]
pub(super) struct Attribute {
    name: String,
    dimension: usize,
    #[serde(rename = "type")]
    scalar: &'static str,
    components: usize,
}

impl Attribute {
    pub(super) fn new(name: &str, dimension: usize, components: usize, column: &Column<'_>) -> Self {
        Self { name: name.to_owned(), dimension, scalar: attribute::type_name(column), components }
    }

    /// Lists some, by dimension: `attributes, dimension 0` and `red u8, normal 3 × f32`.
    pub(super) fn list(attributes: &[Self]) -> impl Iterator<Item = (String, String)> {
        let of_dim = |attributes: &[Self]| {
            let names: Vec<_> = attributes.iter().map(ToString::to_string).collect();
            let dim = attributes.first().map_or(0, |first| first.dimension);
            (format!("attributes, dimension {dim}"), names.join(", "))
        };
        attributes.chunk_by(|a, b| a.dimension == b.dimension).map(of_dim)
    }
}

impl fmt::Display for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.components {
            1 => write!(f, "{} {}", self.name, self.scalar),
            many => write!(f, "{} {many} × {}", self.name, self.scalar),
        }
    }
}

#[derive(Serialize)]
struct OutOfCore {
    pieces: usize,
    temporary_bytes: u64,
    /// The most memory that was resident, where the system tells.
    peak_bytes: Option<u64>,
}

/// The most memory of this process that was resident so far, if the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[derive(Serialize)]
pub(super) struct Input {
    file: String,
    format: &'static str,
    compression: Option<&'static str>,
    vertices: usize,
    simplices: Vec<usize>,
    polygons: usize,
    polyhedra: usize,
    split_into: usize,
    degenerate_dropped: usize,
    bad_cells_dropped: usize,
    bad_vertices_dropped: usize,
    /// The first that were dropped.
    bad: Vec<String>,
    welded: usize,
    welded_with_other_attributes: usize,
    inner_nodes_dropped: usize,
    ignored: u64,
    ignored_names: Vec<String>,
}

#[derive(Serialize)]
struct Renumbered {
    file: String,
    from: u64,
    to: u64,
}

impl Input {
    pub(super) fn new(path: &Path, report: ReadReport) -> Self {
        let file = if output::is_stdout(path) { "<stdin>".to_owned() } else { path.display().to_string() };
        Self {
            format: report.format.name(),
            compression: report.compression.map(Compression::name),
            vertices: report.vertices,
            simplices: report.simplices,
            polygons: report.polygons,
            polyhedra: report.polyhedra,
            split_into: report.split_into,
            degenerate_dropped: report.degenerate_dropped,
            bad_cells_dropped: report.bad_cells_dropped,
            bad_vertices_dropped: report.bad_vertices_dropped,
            bad: report.bad.into_iter().map(|what| format!("{file}{what}")).collect(),
            welded: report.welded,
            welded_with_other_attributes: report.welded_differing,
            inner_nodes_dropped: report.inner_nodes_dropped,
            ignored: report.ignored.count,
            ignored_names: report.ignored.names,
            file,
        }
    }

    pub(super) fn log(&self) {
        let listed: usize = self.simplices.iter().sum();
        let packed = self.compression.map_or(String::new(), |name| format!(", {name}"));
        let (vertices, listed) = (grouped(self.vertices), grouped(listed));
        output::log(format_args!(
            "read   {}: {}{packed}, {vertices} vertices, {listed} simplices",
            self.file, self.format
        ));
        let split = format!("polygons and polyhedra, split into {} simplices", grouped(self.split_into));
        note(self.polygons + self.polyhedra, &split);
        note(self.degenerate_dropped, "simplices dropped that repeat a vertex");
        note(self.bad_vertices_dropped, "vertices dropped whose coordinates are not finite");
        note(self.bad_cells_dropped, "cells dropped at vertices that are not there or were dropped");
        self.bad.iter().for_each(|what| output::log(format_args!("         {what}")));
        note(self.welded, "corners or vertices welded to one at the same place or near");
        note(self.welded_with_other_attributes, "of them with other attributes than the one that stays");
        note(self.inner_nodes_dropped, "nodes dropped that lie inside elements of higher order");
        if self.ignored > 0 {
            output::log(format_args!(
                "       ignored {} times: {}",
                grouped(self.ignored),
                self.ignored_names.join(", ")
            ));
        }
    }
}

impl Report {
    fn new(simplices: Vec<usize>, report: &BuildReport, inputs: Vec<Input>, merged: &MergeReport) -> Self {
        let &BuildReport { listed, repeated, non_maximal, conflicting, unused_kept, unused_dropped, .. } = report;
        let renumbered = merged.renumbered.iter().filter_map(|renumbered| {
            let file = inputs.get(renumbered.input)?.file.clone();
            Some(Renumbered { file, from: renumbered.from, to: renumbered.to })
        });
        Self {
            dimension: i64::try_from(simplices.len()).unwrap_or(i64::MAX) - 1,
            simplices,
            top_simplices: report.top_simplices.clone(),
            renumbered: renumbered.collect(),
            inputs,
            listed,
            repeated,
            non_maximal,
            conflicting_orientations: conflicting,
            unused_vertices_kept: unused_kept,
            unused_vertices_dropped: unused_dropped,
            first_unused_vertices: report.first_unused.clone(),
            repeated_with_other_attributes: report.differing,
            attributes_left_out: merged.attributes_left_out.iter().map(ToString::to_string).collect(),
            ..Self::default()
        }
    }

    fn log(&self) {
        self.inputs.iter().for_each(Input::log);
        for Renumbered { file, from, to } in
            self.renumbered.iter().filter(|renumbered| renumbered.from != renumbered.to)
        {
            output::log(format_args!("       vertex {from} of {file} is now {to}, and so on"));
        }
        output::log(format_args!("built  dimension {}, {}", self.dimension, output::counted(&self.simplices)));
        note(self.repeated, "simplices merged that repeat another");
        note(self.repeated_with_other_attributes, "of them with other attributes than the first, which stay");
        note(self.non_maximal, "simplices merged that are faces of others");
        note(self.conflicting_orientations, "top simplices without orientation, for they were given in both");
        let unused = first(self.unused_vertices_kept + self.unused_vertices_dropped, &self.first_unused_vertices);
        note(self.unused_vertices_kept, &format!("unused vertices kept (--drop-unused drops them){unused}"));
        note(self.unused_vertices_dropped, &format!("unused vertices dropped{unused}"));
        for (title, names) in Attribute::list(&self.attributes) {
            output::log(format_args!("       {title}: {names}"));
        }
        if !self.attributes_left_out.is_empty() {
            let names = self.attributes_left_out.join(", ");
            output::log(format_args!("       attributes left out, as inputs have them in different shapes: {names}"));
        }
        if let Some(OutOfCore { pieces, temporary_bytes, peak_bytes }) = &self.out_of_core {
            let (pieces, bytes) = (grouped(pieces), grouped(temporary_bytes));
            let peak = peak_bytes.map_or(String::new(), |peak| format!(", {} bytes of memory", grouped(peak)));
            output::log(format_args!("       in {pieces} pieces, {bytes} bytes of temporary data{peak}"));
        }
        let (bytes, width) = (grouped(self.file_bytes), self.index_bits);
        output::log(format_args!("wrote  {}: {bytes} bytes, {width}-bit indices, {:.2} s", self.output, self.seconds));
    }
}

/// The number of simplices of each dimension.
fn counts<I: Index>(arrays: &SigArrays<I>) -> Vec<usize> {
    (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect()
}

/// The names of the first of `count` things.
fn first(count: usize, names: &[String]) -> String {
    let more = if count > names.len() { " …" } else { "" };
    if names.is_empty() { String::new() } else { format!(": {}{more}", names.join(" ")) }
}

/// A line on something that happened so often, if it did.
fn note(count: usize, what: &str) {
    if count > 0 {
        output::log(format_args!("       {} {what}", grouped(count)));
    }
}
