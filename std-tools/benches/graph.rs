//! What a radius graph costs, on clouds of few and of many dimensions.
//!
//! ```text
//! cargo bench --bench graph                            the clouds of `CLOUDS`
//! cargo bench --bench graph -- points.npy 0.4          the points of a file, with a radius
//! GUDHI_BENCH=./gudhi_bench cargo bench --bench graph  with GUDHI's search (brute force) in the same run
//! ```
//!
//! Machines are noisy, so whatever is compared is measured in turn, several rounds, and the medians are printed with
//! their spread. Read the ratios.

use std::error::Error;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use sig_tools::generate::{cube, klein_bottle_grid, sphere4, veronese};
use sig_tools::points::{Metric, Points};
use sig_tools::proximity::{RadiusOptions, radius_graph};

const ROUNDS: usize = 5;

/// Clouds with a radius; S4 and Kl as in the literature, one of many dimensions where a grid helps, one where none does.
const CLOUDS: [(&str, fn() -> Points, f64); 4] = [
    ("s4: 50,000 points on the 4-sphere", || sphere4(50_000, 1), 0.253),
    ("kl: 90,000 points of a Klein bottle in R^5", || klein_bottle_grid(300), 0.075),
    ("ver: 15,000 points of a Veronese variety in R^25", || veronese(15_000, 5), 0.2),
    ("cube: 15,000 points of a cube in R^25", || cube(15_000, 25, 4), 1.2),
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    println!("medians of {ROUNDS} rounds (least, most); threads: {}", rayon::current_num_threads());
    match arguments.as_slice() {
        [] => CLOUDS.iter().try_for_each(|(name, points, radius)| measure(name, &points(), *radius)),
        [file, radius] => measure(file, &read(file)?, radius.parse()?),
        _ => Err("give a file of points and a radius, or nothing".into()),
    }
}

fn read(file: &str) -> Result<Points, Box<dyn Error>> {
    Ok(sig_tools::io::space::read_points_path(file, &sig_tools::io::space::SpaceOptions::default())?.0)
}

/// Median, least and most of some timings, in seconds.
fn show(samples: &mut [f64]) -> String {
    samples.sort_by(f64::total_cmp);
    let milliseconds = |index: usize| samples[index] * 1e3;
    format!("{:.1} ms ({:.1}, {:.1})", milliseconds(ROUNDS / 2), milliseconds(0), milliseconds(ROUNDS - 1))
}

/// One graph on all threads and on one, and the peer's in turn.
fn measure(name: &str, points: &Points, radius: f64) -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("points.pts");
    std::fs::write(&file, pts(points))?;
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let peer = std::env::var_os("GUDHI_BENCH");
    let (mut all, mut single, mut peers) = (Vec::new(), Vec::new(), Vec::new());
    let mut edges = 0;
    let mut graph = || -> Result<f64, Box<dyn Error>> {
        let start = Instant::now();
        edges = radius_graph(points, Metric::Euclidean, radius, &RadiusOptions::default())?.num_edges();
        Ok(start.elapsed().as_secs_f64())
    };
    for _ in 0..ROUNDS {
        all.push(graph()?);
        single.push(one.install(|| graph().map_err(|error| error.to_string()))?);
        if let Some(peer) = &peer {
            peers.push(peer_seconds(Path::new(peer), &file, radius)?);
        }
    }
    println!("\n{name}, radius {radius}: {edges} edges");
    println!("  all threads  {}", show(&mut all));
    println!("  one thread   {}", show(&mut single));
    if !peers.is_empty() {
        println!("  GUDHI        {}", show(&mut peers));
        let ratio = |own: &[f64]| peers[ROUNDS / 2] / own[ROUNDS / 2];
        println!("  times faster {:.1} on all threads, {:.1} on one", ratio(&all), ratio(&single));
    }
    Ok(())
}

/// The points as a file for the peer.
fn pts(points: &Points) -> Vec<u8> {
    let mut bytes = b"PTS1".to_vec();
    bytes.extend(u32::try_from(points.dim()).unwrap_or(u32::MAX).to_le_bytes());
    bytes.extend((points.len() as u64).to_le_bytes());
    bytes.extend(points.values().iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// The time that the peer says it took for its graph.
fn peer_seconds(peer: &Path, file: &Path, radius: f64) -> Result<f64, Box<dyn Error>> {
    let output = Command::new(peer).args(["rips", "min"]).arg(file).args([&radius.to_string(), "1"]).output()?;
    let text = String::from_utf8(output.stdout)?;
    let seconds = text.split_once("graph_s=").and_then(|(_, rest)| rest.split_whitespace().next());
    Ok(seconds.ok_or("the peer did not say how long it took")?.parse()?)
}
