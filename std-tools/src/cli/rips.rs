//! `sig rips`: points, distances or a graph become the flag complex of the pairs up to a radius.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use clap::ValueEnum;
use clap::builder::ArgPredicate;
use serde::Serialize;
use sig_core::{Dim, MAX_DIM};
use sig_tools::distances::Distances;
use sig_tools::flag::{self, Accuracy, Estimate, FlagOptions};
use sig_tools::frozen::{FrozenTree, LastVertices};
use sig_tools::graph::Graph;
use sig_tools::io::space::{self, Space, SpaceFormat, SpaceOptions, SpaceReport};
use sig_tools::points::{Metric, Points};
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::soup::{Coordinates, Labels};
use sig_tools::subsample::{farthest_points, farthest_points_of};

use super::frozen_output::{self, FrozenTarget, Written};
use super::output::{self, grouped};
use super::{UsageError, progress};

/// Build the Rips complex of points, of a distance matrix or of a graph
///
/// The vertices are the points; a set of points is a simplex if every two of them are at most R apart. A distance is
/// summed in double precision, coordinate by coordinate, and a pair at exactly R is an edge. Points at one place stay
/// apart, joined by an edge of length 0. Vertices are labelled by the rows of the input, from 0, or by the labels of the
/// graph. Inputs may be compressed with gzip.
#[derive(clap::Args)]
#[command(
    mut_arg("kind", |kind| kind.default_value("tree")),
    mut_arg("output", |output| {
        output.required(false).required_unless_present("dry_run").default_value_if("dry_run", ArgPredicate::IsPresent, "-")
    }),
    after_help = "\
Examples:
  sig rips points.csv --radius 0.3 --max-dim 4 -o rips.sigc
  sig rips cloud.npy --radius 0.3 --dry-run                        how large it would be
  sig rips cloud.npy --radius 0.5 --farthest-point 500 -o few.sigc
  sig rips a.lower_distance_matrix --filtration -o a.sigc          all pairs, with their distances
  sig rips graph.edges --max-dim 31 --kind sig -o cliques.sigc     all cliques of a graph"
)]
pub(super) struct Args {
    /// The points, distances or graph; `-` is standard input
    #[arg(value_name = "INPUT")]
    input: PathBuf,

    #[command(flatten)]
    target: FrozenTarget,

    /// The largest distance of an edge. Points need one; by default all pairs of a distance matrix and all edges of a
    /// graph are taken
    #[arg(short, long, value_name = "R", value_parser = radius)]
    radius: Option<f64>,

    /// The largest dimension of a simplex
    #[arg(short = 'k', long, value_name = "K", default_value_t = 2, value_parser = clap::value_parser!(u8).range(0..=MAX_DIM as i64))]
    max_dim: u8,

    /// The distance between points; by default euclidean
    #[arg(short, long, value_enum)]
    metric: Option<Distance>,

    /// Keep N points only, each the farthest from those before it, beginning with the first
    #[arg(long, value_name = "N")]
    farthest_point: Option<usize>,

    /// How vertices are numbered, which decides what lies together in the file
    #[arg(long, value_enum, default_value_t)]
    order: Order,

    /// Keep with every simplex its filtration value, the largest distance of two of its vertices
    #[arg(long)]
    filtration: bool,

    /// Print how many simplices there would be and how large the file, and write nothing
    #[arg(long)]
    dry_run: bool,

    /// Stop before the complex takes more memory than this, like 4GiB; by default, more than is free
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    memory: Option<u64>,

    /// The format of the input; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(SpaceFormat::ALL, SpaceFormat::name, SpaceFormat::description))]
    format: Option<SpaceFormat>,

    /// The number of threads; by default one for each processor. The file is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Print a JSON object on what was read and made
    #[arg(long)]
    json: bool,
}

/// The distances by name.
#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Distance {
    /// √Σ (p − q)²
    #[default]
    Euclidean,
    /// max |p − q|
    Maximum,
    /// Σ |p − q|
    Manhattan,
    /// 1 − cos of the angle at the origin; not a metric, for the triangle inequality fails
    Cosine,
}

impl From<Distance> for Metric {
    fn from(distance: Distance) -> Self {
        match distance {
            Distance::Euclidean => Self::Euclidean,
            Distance::Maximum => Self::Maximum,
            Distance::Manhattan => Self::Manhattan,
            Distance::Cosine => Self::Cosine,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Order {
    /// By row of the input, or by label
    #[default]
    Input,
    /// Along a Hilbert curve through the first three coordinates of points
    Hilbert,
}

fn radius(text: &str) -> Result<f64, String> {
    let radius: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if radius >= 0.0 { Ok(radius) } else { Err("a radius is a number, and not negative".to_owned()) }
}

/// A number of bytes, like 500000, 4GiB, 4Gi or 4GB.
fn bytes(text: &str) -> Result<u64, String> {
    const EXPECTED: &str = "not a number of bytes like 500000, 4GiB or 4GB";
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    let (number, unit) = text.split_at(digits);
    let (power, base) = match unit.trim_start().to_ascii_lowercase().as_str() {
        "" | "b" => (0, 1),
        "ki" | "kib" => (1, 1024),
        "mi" | "mib" => (2, 1024),
        "gi" | "gib" => (3, 1024),
        "ti" | "tib" => (4, 1024),
        "kb" => (1, 1000),
        "mb" => (2, 1000),
        "gb" => (3, 1000),
        "tb" => (4, 1000),
        _ => return Err(EXPECTED.to_owned()),
    };
    let number: u64 = number.parse().map_err(|_| EXPECTED.to_owned())?;
    number.checked_mul(u64::pow(base, power)).ok_or_else(|| "more bytes than 64 bits can count".to_owned())
}

/// What the complex is expanded from, and what its vertices are called.
struct Skeleton {
    graph: Graph,
    labels: Labels,
    coordinates: Option<Coordinates>,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let start = Instant::now();
        if !self.dry_run {
            self.target.check(std::slice::from_ref(&self.input), self.json)?;
        }
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
        }
        let (space, read) = self.read()?;
        let mut report = Report::new(&self, &space, read);
        let skeleton = self.skeleton(space, &mut report)?;
        report.edges = skeleton.graph.num_edges();
        report.log();
        if self.dry_run {
            let estimate = flag::estimate(&skeleton.graph, self.max_dim.into(), 1);
            return Ok(DryRun::new(report, &estimate, start).print(self.json)?);
        }
        let tree = self.expand(skeleton)?;
        self.check_disk(&tree)?;
        let written = frozen_output::write(tree, &self.target)?;
        written.log();
        let seconds = start.elapsed().as_secs_f64();
        output::log(format_args!("took   {seconds:.2} s"));
        if self.json {
            output::json(&Made { report, written, seconds })?;
        }
        Ok(())
    }

    fn read(&self) -> anyhow::Result<(Space, SpaceReport)> {
        let mut options = SpaceOptions { format: self.format, ..SpaceOptions::default() };
        if !progress::is_watched() {
            return Ok(space::read_space_path(&self.input, &options)?);
        }
        let length = std::fs::metadata(&self.input).ok().filter(std::fs::Metadata::is_file).map(|file| file.len());
        let bar = progress::bytes(length, &self.input.display().to_string());
        let show = |bytes| bar.set_position(bytes);
        options.progress = Some(&show);
        let read = space::read_space_path(&self.input, &options);
        bar.finish_and_clear();
        Ok(read?)
    }

    /// The graph of the pairs up to the radius.
    fn skeleton(&self, space: Space, report: &mut Report) -> anyhow::Result<Skeleton> {
        if !matches!(space, Space::Points(_)) {
            let what = report.format;
            let refused = [(self.metric.is_some(), "--metric"), (self.order == Order::Hilbert, "--order hilbert")];
            if let Some((_, option)) = refused.into_iter().find(|(given, _)| *given) {
                return Err(UsageError(format!("{option} is for points, and the input is of format {what}")).into());
            }
        }
        match space {
            Space::Points(points) => self.of_points(points, report),
            Space::Distances(distances) => self.of_distances(distances, report),
            Space::Graph { graph, labels } => self.of_graph(&graph, labels),
        }
    }

    fn of_points(&self, points: Points, report: &mut Report) -> anyhow::Result<Skeleton> {
        let Some(radius) = self.radius else {
            return Err(UsageError("points need a radius: --radius R, or --radius inf for all pairs".to_owned()).into());
        };
        let metric = self.metric.unwrap_or_default().into();
        let mut rows: Vec<usize> = (0..points.len()).collect();
        if let Some(count) = self.farthest_point {
            let chosen = farthest_points(&points, metric, count, 0);
            report.choose(&chosen.indices, &chosen.covering_radii);
            rows = chosen.indices;
            rows.sort_unstable();
        }
        let mut points = if rows.len() < points.len() { points.select(&rows) } else { points };
        if self.order == Order::Hilbert {
            let order = points.hilbert_order();
            points = points.select(&order);
            rows = order.iter().map(|&index| rows[index]).collect();
        }
        let options = RadiusOptions { weighted: self.filtration, max_edges: self.most_edges() };
        let graph =
            radius_graph(&points, metric, radius, &options).with_context(|| format!("{}", self.input.display()))?;
        Ok(Skeleton { graph, labels: numbers(&rows), coordinates: Some(points.into_coordinates()) })
    }

    fn of_distances(&self, distances: Distances, report: &mut Report) -> anyhow::Result<Skeleton> {
        let mut rows: Vec<usize> = (0..distances.len()).collect();
        let mut distances = distances;
        if let Some(count) = self.farthest_point {
            let chosen = farthest_points_of(&distances, count, 0);
            report.choose(&chosen.indices, &chosen.covering_radii);
            rows = chosen.indices;
            rows.sort_unstable();
            distances = distances.select(&rows);
        }
        let graph = distances.radius_graph(self.radius.unwrap_or(f64::INFINITY), self.filtration)?;
        Ok(Skeleton { graph, labels: numbers(&rows), coordinates: None })
    }

    fn of_graph(&self, graph: &Graph, labels: Labels) -> anyhow::Result<Skeleton> {
        let needs_weights = [(self.radius.is_some(), "--radius"), (self.filtration, "--filtration")];
        if let Some((_, option)) = needs_weights.into_iter().find(|(given, _)| *given && !graph.is_weighted()) {
            return Err(UsageError(format!("{option} needs weights, and the edges of the input have none")).into());
        }
        if self.farthest_point.is_some() {
            let message = "--farthest-point needs the distances of all pairs; the input gives some of them";
            return Err(UsageError(message.to_owned()).into());
        }
        let graph = graph.up_to(self.radius.unwrap_or(f64::INFINITY), self.filtration);
        Ok(Skeleton { graph, labels, coordinates: None })
    }

    /// The most edges that fit the memory that was allowed: while they are sorted each takes twelve bytes.
    fn most_edges(&self) -> Option<usize> {
        self.memory.map(|bytes| usize::try_from(bytes / 12).unwrap_or(usize::MAX))
    }

    fn expand(&self, skeleton: Skeleton) -> anyhow::Result<FrozenTree> {
        let bars = progress::Phases::new();
        let show = |phase, done, total| {
            let what = match phase {
                flag::Phase::Counting => "counting simplices",
                flag::Phase::Values => "filtration values",
                _ => "writing simplices",
            };
            bars.step(what, done, total);
        };
        let options = FlagOptions {
            max_dim: Dim::from(self.max_dim),
            max_bytes: self.memory,
            progress: progress::is_watched().then_some(&show),
            ..FlagOptions::default()
        };
        let expanded = flag::expand(&skeleton.graph, &options);
        bars.clear();
        let tree = expanded.with_context(|| format!("{} (--dry-run tells the size)", self.input.display()))?;
        Ok(FrozenTree { labels: skeleton.labels, coordinates: skeleton.coordinates, ..tree })
    }

    /// Refuses to begin a file that the disk cannot hold; a file of kind *sig* takes more than its tree.
    fn check_disk(&self, tree: &FrozenTree) -> anyhow::Result<()> {
        let path = &self.target.target.output;
        let label = if matches!(tree.last_vertices, LastVertices::Bits16(_)) { 2 } else { 4 };
        let value = if tree.filtration.is_some() { 8 } else { 0 };
        let needed = (tree.num_simplices * (label + value)) as u64;
        match free_bytes(path).filter(|&free| free < needed && !output::is_stdout(path)) {
            None => Ok(()),
            Some(free) => Err(anyhow::anyhow!(
                "{}: the file takes more than {} bytes, and the disk has {} free",
                path.display(),
                grouped(needed),
                grouped(free)
            )),
        }
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

/// The rows of the input as labels.
fn numbers(rows: &[usize]) -> Labels {
    if rows.iter().enumerate().all(|(index, &row)| index == row) {
        Labels::Numbered(rows.len())
    } else {
        Labels::Integers(rows.iter().map(|&row| row as u64).collect())
    }
}

/// What was read and joined; as JSON, the names of the fields.
#[derive(Serialize)]
struct Report {
    input: String,
    format: &'static str,
    gzip: bool,
    points: usize,
    /// The dimension of points.
    coordinates: Option<usize>,
    metric: Option<&'static str>,
    radius: Option<f64>,
    /// The points that were kept, and how far any point is from one of them.
    chosen: Option<usize>,
    covering_radius: Option<f64>,
    repeated_edges: usize,
    edges: usize,
}

impl Report {
    fn new(args: &Args, space: &Space, read: SpaceReport) -> Self {
        let metric = match args.metric.unwrap_or_default() {
            Distance::Euclidean => "euclidean",
            Distance::Maximum => "maximum",
            Distance::Manhattan => "manhattan",
            Distance::Cosine => "cosine",
        };
        let (points, coordinates) = match space {
            Space::Points(points) => (points.len(), Some(points.dim())),
            Space::Distances(distances) => (distances.len(), None),
            Space::Graph { graph, .. } => (graph.num_vertices(), None),
        };
        Self {
            input: if output::is_stdout(&args.input) { "<stdin>".to_owned() } else { args.input.display().to_string() },
            format: read.format.name(),
            gzip: read.gzip,
            points,
            coordinates,
            metric: coordinates.map(|_| metric),
            radius: args.radius.filter(|radius| radius.is_finite()),
            chosen: None,
            covering_radius: None,
            repeated_edges: read.repeated,
            edges: 0,
        }
    }

    fn choose(&mut self, chosen: &[usize], covering_radii: &[f64]) {
        self.chosen = Some(chosen.len());
        self.covering_radius = covering_radii.last().copied();
    }

    fn log(&self) {
        let gzip = if self.gzip { ", gzip" } else { "" };
        let space = self.coordinates.map_or(String::new(), |dim| format!(" in R^{dim}"));
        let points = grouped(self.points);
        output::log(format_args!("read   {}: {}{gzip}, {points} points{space}", self.input, self.format));
        if self.repeated_edges > 0 {
            output::log(format_args!("       {} edges repeat another", grouped(self.repeated_edges)));
        }
        if let Some(chosen) = self.chosen {
            let radius = self.covering_radius.unwrap_or(0.0);
            output::log(format_args!("chose  {} points; any is within {radius} of one of them", grouped(chosen)));
        }
        let metric = self.metric.map_or(String::new(), |metric| format!("{metric} "));
        let reach = self.radius.map_or(String::new(), |radius| format!(", {metric}distance up to {radius}"));
        output::log(format_args!("joined {} edges{reach}", grouped(self.edges)));
    }
}

/// The JSON object of a complex that was made.
#[derive(Serialize)]
struct Made {
    #[serde(flatten)]
    report: Report,
    #[serde(flatten)]
    written: Written,
    seconds: f64,
}

/// What `--dry-run` prints; as JSON, the names of the fields.
#[derive(Serialize)]
struct DryRun {
    #[serde(flatten)]
    report: Report,
    simplices: Vec<u64>,
    /// Bytes of a file of kind *tree*, but for its header, coordinates, labels and checksums.
    file_bytes: u64,
    /// `exact`, `estimated`, or `at-least`.
    accuracy: &'static str,
    /// The standard error of the number of simplices, if that is estimated.
    standard_error: Option<f64>,
    seconds: f64,
}

impl DryRun {
    fn new(report: Report, estimate: &Estimate, start: Instant) -> Self {
        let (accuracy, standard_error) = match estimate.accuracy {
            Accuracy::Exact => ("exact", None),
            Accuracy::Sampled { standard_error, .. } => ("estimated", Some(standard_error)),
            _ => ("at-least", None),
        };
        Self {
            report,
            simplices: estimate.counts.clone(),
            file_bytes: estimate.file_bytes,
            accuracy,
            standard_error,
            seconds: start.elapsed().as_secs_f64(),
        }
    }

    fn print(&self, json: bool) -> std::io::Result<()> {
        if json {
            return output::json(self);
        }
        let all: u64 = self.simplices.iter().fold(0, |sum, &count| sum.saturating_add(count));
        let row = |name: String, count: u64| vec![name, grouped(count)];
        let heading = match self.accuracy {
            "exact" => "simplices",
            "estimated" => "simplices, about",
            _ => "simplices, at least",
        };
        let mut rows = vec![vec!["dimension".to_owned(), heading.to_owned()]];
        rows.extend(self.simplices.iter().enumerate().map(|(dim, &count)| row(dim.to_string(), count)));
        rows.push(row("all".to_owned(), all));
        rows.extend(self.standard_error.map(|error| vec!["standard error".to_owned(), grouped(error.ceil())]));
        rows.push(row("bytes of the tree".to_owned(), self.file_bytes));
        output::stdout(|out| output::table(&rows, out))
    }
}

#[cfg(test)]
mod tests {
    use super::bytes;

    #[test]
    fn sizes_are_read_in_powers_of_ten_and_of_two() {
        let sizes = [("0", 0), ("17", 17), ("4GiB", 4 << 30), ("4 Gi", 4 << 30), ("3kb", 3000), ("2TiB", 2 << 40)];
        for (text, size) in sizes {
            assert_eq!(bytes(text), Ok(size), "{text}");
        }
        for text in ["", "GiB", "4G", "-1", "1.5GiB", "20000000TiB"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }
}
