//! `sig witness`: points become the witness complex of some landmarks among them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;
use sig_core::MAX_DIM;
use sig_tools::io::ReadError;
use sig_tools::io::space::{SpaceFormat, SpaceOptions, read_points_path};
use sig_tools::points::{Metric, Points};
use sig_tools::witness::{Landmarks, Relaxation, WitnessOptions, witness_complex};

use super::frozen_output::{self, FrozenTarget, Written};
use super::output::{self, grouped};
use super::rips::Distance;
use super::{Threads, UsageError, progress};

/// Build the witness complex of landmarks and witnesses
///
/// Landmarks carry the simplices. A set of them is a simplex if for each of its subsets there is a witness to which no
/// other landmark is nearer than one of the subset by more than RHO. Vertices are labelled by the number of the landmark,
/// from 0, among the points it was chosen from. Reads points as text, CSV, NPY, or the vertices of a mesh.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig witness points.npy --maxmin 300 -o strict.sigc
  sig witness points.csv --random 1000 --seed 7 --relax 0.1 --max-dim 4 -o relaxed.sigc
  sig witness cloud.off --landmarks landmarks.txt --squared 0.05 --max-dim 5 --filtration --kind tree -o wit.sigc")]
pub(super) struct Args {
    /// The witnesses; `-` is standard input
    #[arg(value_name = "WITNESSES")]
    witnesses: PathBuf,

    #[command(flatten)]
    choice: Choice,

    /// Where --random starts: the same seed chooses the same landmarks on any machine
    #[arg(long, value_name = "S", default_value_t = 0, requires = "random")]
    seed: u64,

    #[command(flatten)]
    relaxation: RelaxationArgs,

    /// The largest dimension of a simplex
    #[arg(short = 'k', long, value_name = "K", default_value_t = 31, value_parser = clap::value_parser!(u8).range(0..=MAX_DIM as i64))]
    max_dim: u8,

    /// The distance
    #[arg(short, long, value_enum, default_value_t)]
    metric: Distance,

    /// Keep for each simplex the least relaxation at which it is there, as its filtration value
    #[arg(long)]
    filtration: bool,

    #[command(flatten)]
    target: FrozenTarget,

    /// The format of the points; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(SpaceFormat::OF_POINTS, SpaceFormat::name, SpaceFormat::description))]
    format: Option<SpaceFormat>,

    #[command(flatten)]
    threads: Threads,

    /// Refuse to build more than N simplices; by default, more than memory holds
    #[arg(long, value_name = "N")]
    max_simplices: Option<u64>,

    /// Print a JSON object on what was read and built
    #[arg(long)]
    json: bool,
}

/// Where landmarks come from.
#[derive(clap::Args)]
#[group(required = true, multiple = false)]
struct Choice {
    /// The landmarks are the points of FILE
    #[arg(long, value_name = "FILE")]
    landmarks: Option<PathBuf>,

    /// The landmarks are N of the witnesses, at random
    #[arg(long, value_name = "N")]
    random: Option<usize>,

    /// The landmarks are N of the witnesses: the first, then each the farthest from those before it
    #[arg(long, value_name = "N")]
    maxmin: Option<usize>,
}

/// How far a witness looks past the nearest landmarks.
#[derive(clap::Args)]
#[group(multiple = false)]
struct RelaxationArgs {
    /// A landmark of a simplex may be farther from the witness than one that is left out by RHO; 0 is the strict complex
    #[arg(long, value_name = "RHO", default_value_t = 0.0, allow_negative_numbers = true)]
    relax: f64,

    /// The same with squares: the square of its distance may be larger by ALPHA2 (GUDHI's convention)
    #[arg(long, value_name = "ALPHA2", allow_negative_numbers = true)]
    squared: Option<f64>,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let start = Instant::now();
        let options = self.options()?;
        let inputs: Vec<PathBuf> = std::iter::once(&self.witnesses).chain(&self.choice.landmarks).cloned().collect();
        self.target.check(&inputs, self.json)?;
        self.threads.start()?;
        let witnesses = self.read(&self.witnesses)?;
        let landmarks = self.landmarks(&witnesses, options.metric)?;
        let build = || witness_complex(&witnesses, &landmarks, &options);
        let complex = progress::during("building the complex", build)?;
        let report = Report {
            witnesses: witnesses.len(),
            coordinates: witnesses.dim(),
            landmarks: landmarks.numbers().len(),
            absent: complex.absent,
            written: frozen_output::write(complex.tree, &self.target, None)?,
            seconds: start.elapsed().as_secs_f64(),
        };
        report.log();
        if self.json {
            output::json(&report)?;
        }
        Ok(())
    }

    /// The options, as far as the command line alone decides on them.
    fn options(&self) -> Result<WitnessOptions, UsageError> {
        let RelaxationArgs { relax, squared } = self.relaxation;
        let relaxation = squared.map_or(Relaxation::Distance(relax), Relaxation::Squared);
        if relaxation.amount().is_nan() || relaxation.amount() < 0.0 {
            let name = if squared.is_some() { "squared" } else { "relax" };
            return Err(UsageError(format!("--{name} {}: a relaxation is 0 or more", relaxation.amount())));
        }
        Ok(WitnessOptions {
            metric: self.metric.into(),
            relaxation,
            max_dim: self.max_dim.into(),
            filtration: self.filtration,
            max_simplices: self.max_simplices,
        })
    }

    fn landmarks(&self, witnesses: &Points, metric: Metric) -> anyhow::Result<Landmarks> {
        Ok(match (&self.choice.landmarks, self.choice.random, self.choice.maxmin) {
            (Some(path), ..) => Landmarks::all(self.read(path)?),
            (_, Some(count), _) => Landmarks::random(witnesses, count, self.seed)?,
            (.., count) => {
                let choose = || Landmarks::maxmin(witnesses, metric, count.unwrap_or(0));
                progress::during("choosing landmarks", choose)?
            }
        })
    }

    fn read(&self, path: &Path) -> Result<Points, ReadError> {
        let options = SpaceOptions { format: self.format, ..SpaceOptions::default() };
        Ok(progress::reading(path, |progress| read_points_path(path, &SpaceOptions { progress, ..options }))?.0)
    }
}

/// What was read and built; as JSON, the names of the fields.
#[derive(Serialize)]
struct Report {
    witnesses: usize,
    coordinates: usize,
    landmarks: usize,
    /// The numbers of the landmarks that are not in the complex.
    absent: Vec<u64>,
    #[serde(flatten)]
    written: Written,
    seconds: f64,
}

impl Report {
    fn log(&self) {
        let (witnesses, landmarks) = (grouped(self.witnesses), grouped(self.landmarks));
        let absent = match self.absent.len() {
            0 => String::new(),
            count => format!(", {} of them nearest to no witness", grouped(count)),
        };
        output::log(format_args!(
            "read   {witnesses} witnesses with {} coordinates, {landmarks} landmarks{absent}",
            self.coordinates
        ));
        self.written.log();
    }
}
