//! `sig rips`: points, distances or a graph become the flag complex of the pairs up to a radius.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;
use clap::ValueEnum;
use clap::builder::RangedU64ValueParser;
use serde::Serialize;
use sig_tools::distances::Distances;
use sig_tools::graph::Graph;
use sig_tools::io::Compression;
use sig_tools::io::space::{self, Space, SpaceFormat, SpaceOptions, SpaceReport};
use sig_tools::points::{Metric, Points};
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::soup::Labels;
use sig_tools::subsample::{farthest_points, farthest_points_of};

use super::expansion::{self, Expansion, Skeleton};
use super::output::{self, grouped};
use super::{UsageError, progress, tree_input};

/// Build the Rips complex of points, of a distance matrix or of a graph
///
/// The vertices are the points; a set of points is a simplex if every two of them are at most R apart. A distance is
/// summed in double precision, coordinate by coordinate, and a pair at exactly R is an edge. Points at one place stay
/// apart, joined by an edge of length 0. Vertices are labelled by the rows of the input, from 0, or by the labels of the
/// graph. Inputs may be compressed with gzip.
#[derive(clap::Args)]
#[command(
    mut_arg("kind", expansion::tree_by_default),
    mut_arg("output", expansion::none_if_dry_run),
    mut_arg("max_dim", |max_dim| max_dim.required(false).default_value("2")),
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
    expansion: Expansion,

    /// The largest distance of an edge. Points need one; by default all pairs of a distance matrix and all edges of a
    /// graph are taken
    #[arg(short, long, value_name = "R", value_parser = radius, allow_negative_numbers = true)]
    radius: Option<f64>,

    /// The distance between points; by default euclidean
    #[arg(short, long, value_enum)]
    metric: Option<Distance>,

    /// Keep N points only, each the farthest from those before it, beginning with the first; all if there are fewer
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..))]
    farthest_point: Option<usize>,

    /// How vertices are numbered, which decides what lies together in the file
    #[arg(long, value_enum, default_value_t)]
    order: Order,

    /// Keep with every simplex its filtration value, the largest distance of two of its vertices
    #[arg(long)]
    filtration: bool,

    /// The format of the input; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(SpaceFormat::ALL, SpaceFormat::name, SpaceFormat::description))]
    format: Option<SpaceFormat>,
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
    /// `hilbert` for points, else `input`
    #[default]
    Auto,
    /// By row of the input, or by label
    Input,
    /// Along a Hilbert curve through the first three coordinates of points
    Hilbert,
}

fn radius(text: &str) -> Result<f64, String> {
    let radius: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if radius >= 0.0 { Ok(radius) } else { Err("a radius is a number, and not negative".to_owned()) }
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let start = Instant::now();
        self.expansion.check(&self.input)?;
        let (space, read) = self.read()?;
        let mut report = Report::new(&self, &space, read);
        let skeleton = self.skeleton(space, &mut report)?;
        report.edges = skeleton.graph.num_edges();
        report.log();
        self.expansion.write(&self.input, skeleton, report, start)
    }

    fn read(&self) -> anyhow::Result<(Space, SpaceReport)> {
        let options = SpaceOptions { format: self.format, ..SpaceOptions::default() };
        Ok(progress::reading(&self.input, |progress| {
            space::read_space_path(&self.input, &SpaceOptions { progress, ..options })
        })?)
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
            let chosen = progress::during("choosing points", || farthest_points(&points, metric, count, 0));
            report.choose(&chosen.indices, &chosen.covering_radii);
            rows = chosen.indices;
            rows.sort_unstable();
        }
        let mut points = if rows.len() < points.len() { points.select(&rows) } else { points };
        if self.order != Order::Input {
            let order = points.hilbert_order();
            points = points.select(&order);
            rows = order.iter().map(|&index| rows[index]).collect();
        }
        let options = RadiusOptions { weighted: self.filtration, max_edges: self.expansion.most_edges() };
        let graph = progress::during("searching near pairs", || radius_graph(&points, metric, radius, &options));
        let graph = graph.with_context(|| self.input.display().to_string())?;
        Ok(Skeleton { graph, labels: numbers(&rows), coordinates: Some(points.into_coordinates()) })
    }

    fn of_distances(&self, distances: Distances, report: &mut Report) -> anyhow::Result<Skeleton> {
        let mut rows: Vec<usize> = (0..distances.len()).collect();
        let mut distances = distances;
        if let Some(count) = self.farthest_point {
            let chosen = progress::during("choosing points", || farthest_points_of(&distances, count, 0));
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
            let message =
                "needs weights, and the edges of the input have none; --format says what it is if not a graph";
            return Err(UsageError(format!("{option} {message}")).into());
        }
        if self.farthest_point.is_some() {
            let message = "--farthest-point needs the distances of all pairs; the input gives some of them";
            return Err(UsageError(message.to_owned()).into());
        }
        let graph = graph.up_to(self.radius.unwrap_or(f64::INFINITY), self.filtration);
        Ok(Skeleton { graph, labels, coordinates: None })
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
    compression: Option<&'static str>,
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
            input: tree_input::displayed(&args.input),
            format: read.format.name(),
            compression: read.compression.map(Compression::name),
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
        let packed = self.compression.map_or(String::new(), |name| format!(", {name}"));
        let space = self.coordinates.map_or(String::new(), |dim| format!(" in R^{dim}"));
        let points = grouped(self.points);
        output::log(format_args!("read   {}: {}{packed}, {points} points{space}", self.input, self.format));
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
