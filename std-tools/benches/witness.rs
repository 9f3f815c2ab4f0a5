//! What witness complexes cost: the neighbour table and the complex, and a landmark more.
//!
//! ```text
//! cargo bench --bench witness                            strict in R^25 (cube, Veronese), relaxed on the 4-sphere
//! cargo bench --bench witness -- sphere                  one of them: cube, veronese, sphere, sphere-large, insertion
//! cargo bench --bench witness -- points.pts 5 0.01 25    every fifth point a landmark, ρ = 0.01, dimension up to 25
//! GUDHI_BENCH=./gudhi_bench cargo bench --bench witness  with GUDHI in the same run
//! ```
//!
//! Landmarks are the first points of a cloud, and all points are witnesses. The peer is asked for the complex from the
//! points (its k-d tree) and from a table of neighbours that it finds by brute force; its counts are compared. Machines
//! are noisy, so whatever is compared is measured in turn, several rounds, and the medians are printed with their
//! spread. Read the ratios.

use std::error::Error;
use std::ffi::OsStr;
use std::path::Path;

use common::{Timing, figure, on_one_thread, run, timed, write_points};
use sig_tools::generate::{cube, sphere4, veronese};
use sig_tools::io::space::{SpaceOptions, read_points_path};
use sig_tools::points::Points;
use sig_tools::witness::insertion::GrowingWitnessComplex;
use sig_tools::witness::{Landmarks, Relaxation, WitnessOptions, witness_complex};

mod common;

const ROUNDS: usize = 3;

/// Points, of which the first are landmarks.
struct Case {
    name: &'static str,
    points: fn() -> Points,
    landmarks: usize,
    /// α², on squared distances.
    relaxation: f64,
    max_dim: usize,
    /// Neighbours in the table of the peer.
    neighbours: usize,
}

const CASES: [Case; 4] = [
    Case {
        name: "cube",
        points: || cube(15_000, 25, 4),
        landmarks: 3000,
        relaxation: 0.0,
        max_dim: 31,
        neighbours: 16,
    },
    Case {
        name: "veronese",
        points: || veronese(15_000, 5),
        landmarks: 3000,
        relaxation: 0.0,
        max_dim: 31,
        neighbours: 16,
    },
    Case {
        name: "sphere",
        points: || sphere4(20_000, 3),
        landmarks: 2000,
        relaxation: 0.05,
        max_dim: 5,
        neighbours: 64,
    },
    Case {
        name: "sphere-large",
        points: || sphere4(20_000, 3),
        landmarks: 2000,
        relaxation: 0.1,
        max_dim: 5,
        neighbours: 64,
    },
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
    println!("medians of {ROUNDS} rounds (least, most); threads: {}", rayon::current_num_threads());
    if let [path, step, relaxation, max_dim] = arguments.as_slice()
        && let Ok(step) = step.parse()
    {
        return own_points(path.as_ref(), step, relaxation.parse()?, max_dim.parse()?);
    }
    let wanted = |name: &str| arguments.is_empty() && name != "sphere-large" || arguments.iter().any(|it| it == name);
    for case in CASES.iter().filter(|case| wanted(case.name)) {
        compare(case)?;
    }
    if wanted("insertion") {
        insertion()?;
    }
    Ok(())
}

/// Builds on all threads and on one, with and without filtration, and lets the peer do the same in turn.
fn compare(case: &Case) -> Result<(), Box<dyn Error>> {
    let points = (case.points)();
    let landmarks = Landmarks::chosen(&points, &(0..case.landmarks).collect::<Vec<_>>())?;
    let relaxation = Relaxation::Squared(case.relaxation);
    let options = WitnessOptions { relaxation, max_dim: case.max_dim, ..WitnessOptions::default() };
    let with_filtration = WitnessOptions { filtration: true, ..options };
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("points.pts");
    write_points(&points, &file)?;
    let peer = common::peer();
    let (mut all, mut single, mut filtered) = (Vec::new(), Vec::new(), Vec::new());
    let (mut from_points, mut from_table) = (Vec::new(), Vec::new());
    println!("\n{}: {} landmarks of {} points in R^{}", case.name, case.landmarks, points.len(), points.dim());
    for round in 0..ROUNDS {
        let (seconds, complex) = timed(|| witness_complex(&points, &landmarks, &options));
        let counts = complex?.tree.counts();
        all.push(seconds);
        single.push(on_one_thread(|| timed(|| witness_complex(&points, &landmarks, &options)).0)?);
        filtered.push(timed(|| witness_complex(&points, &landmarks, &with_filtration)).0);
        if round == 0 {
            println!("  {} simplices: {counts:?}", counts.iter().sum::<usize>());
        }
        if let Some(program) = &peer {
            for (mode, samples) in [("e", &mut from_points), ("t", &mut from_table)] {
                let (seconds, peers) = run_peer(program, &file, case, mode)?;
                samples.push(seconds);
                assert_eq!(counts, peers, "the peer has other simplices");
            }
        }
    }
    let (all, single, filtered) = (Timing::of(all), Timing::of(single), Timing::of(filtered));
    let show = |what: &str, timing: &Timing| println!("    {what:20} {}", timing.show(1e3, "ms"));
    show("all threads", &all);
    show("one thread", &single);
    show("with filtration", &filtered);
    if peer.is_some() {
        let (points, table) = (Timing::of(from_points), Timing::of(from_table));
        let better = points.median.min(table.median);
        show("GUDHI from points", &points);
        show("GUDHI from a table", &table);
        println!("    better GUDHI / SIG   {:.1} all threads, {:.1} one", better / all.median, better / single.median);
    }
    Ok(())
}

/// Seconds that the peer takes for neighbours and complex, and its simplices by dimension.
fn run_peer(program: &OsStr, file: &Path, case: &Case, mode: &str) -> Result<(f64, Vec<usize>), Box<dyn Error>> {
    let numbers = [case.landmarks.to_string(), case.relaxation.to_string(), case.max_dim.to_string()];
    let neighbours = case.neighbours.to_string();
    let [landmarks, relaxation, max_dim] = numbers.each_ref().map(OsStr::new);
    let arguments =
        ["wit".as_ref(), file.as_os_str(), landmarks, relaxation, max_dim, mode.as_ref(), neighbours.as_ref()];
    let text = run(program, &arguments)?;
    let line = text.lines().find(|line| line.contains("weak")).ok_or("no figure of the peer")?;
    let neighbours = figure(line, "ctor_s=").or_else(|_| figure(line, "brute_nn_s="))?;
    Ok((neighbours + figure(line, " s=")?, common::counts(line)?))
}

/// A cloud in a file, of which every so many-th point is a landmark, with ρ on distances.
fn own_points(path: &Path, step: usize, relaxation: f64, max_dim: usize) -> Result<(), Box<dyn Error>> {
    let points = read_points_path(path, &SpaceOptions::default())?.0;
    let landmarks = Landmarks::chosen(&points, &(0..points.len()).step_by(step.max(1)).collect::<Vec<_>>())?;
    let options = WitnessOptions { relaxation: Relaxation::Distance(relaxation), max_dim, ..WitnessOptions::default() };
    let mut samples = Vec::new();
    for _ in 0..ROUNDS {
        let (seconds, complex) = timed(|| witness_complex(&points, &landmarks, &options));
        samples.push(seconds);
        let counts = complex?.tree.counts();
        println!("  {} simplices: {counts:?}", counts.iter().sum::<usize>());
    }
    println!("    all threads          {}", Timing::of(samples).show(1e3, "ms"));
    Ok(())
}

/// A hundred landmarks, one after the other, beside building once.
fn insertion() -> Result<(), Box<dyn Error>> {
    const MORE: usize = 100;
    let points = cube(15_000, 25, 4);
    let options = WitnessOptions { max_dim: 4, ..WitnessOptions::default() };
    let landmarks = |count: usize| Landmarks::chosen(&points, &(0..count).collect::<Vec<_>>());
    let mut growing = GrowingWitnessComplex::new(points.clone(), landmarks(3000 - MORE)?, &options)?;
    let (inserting, inserted) =
        timed(|| (3000 - MORE..3000).try_for_each(|number| growing.insert(points.point(number)).map(drop)));
    inserted?;
    let (building, built) = timed(|| witness_complex(&points, &landmarks(3000)?, &options));
    let same = growing.complex() == built?;
    println!("\ninsertion: {MORE} landmarks into {} of 15,000 points in R^25, dimension 4", 3000 - MORE);
    println!("    each                 {:.3} ms", inserting * 1e3 / MORE as f64);
    println!("    building anew        {:.3} ms; the same complex: {same}", building * 1e3);
    Ok(())
}
