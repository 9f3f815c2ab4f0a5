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

use common::{Timing, figure, on_one_thread, run, timed};
use sig_tools::generate::{cube, klein_bottle_grid, sphere4, veronese};
use sig_tools::points::{Metric, Points};
use sig_tools::proximity::{RadiusOptions, radius_graph};

mod common;

const ROUNDS: usize = 5;

/// A name, points, and a radius.
type Cloud = (&'static str, fn() -> Points, f64);

/// Clouds with a radius; S4 and Kl as in the literature, one of many dimensions where a grid helps, one where none does.
const CLOUDS: [Cloud; 4] = [
    ("s4: 50,000 points on the 4-sphere", || sphere4(50_000, 1), 0.253),
    ("kl: 90,000 points of a Klein bottle in R^5", || klein_bottle_grid(300), 0.075),
    ("ver: 15,000 points of a Veronese variety in R^25", || veronese(15_000, 5), 0.2),
    ("cube: 15,000 points of a cube in R^25", || cube(15_000, 25, 4), 1.2),
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
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

/// One graph on all threads and on one, and the peer's in turn.
fn measure(name: &str, points: &Points, radius: f64) -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("points.pts");
    common::write_points(points, &file)?;
    let peer = common::peer();
    let (mut all, mut single, mut peers) = (Vec::new(), Vec::new(), Vec::new());
    let mut edges = 0;
    let graph = || timed(|| radius_graph(points, Metric::Euclidean, radius, &RadiusOptions::default()));
    let text = radius.to_string();
    let arguments = ["rips".as_ref(), "min".as_ref(), file.as_os_str(), text.as_ref(), "1".as_ref()];
    for _ in 0..ROUNDS {
        let (seconds, found) = graph();
        edges = found?.num_edges();
        all.push(seconds);
        single.push(on_one_thread(|| graph().0)?);
        if let Some(peer) = &peer {
            // The time that the peer says it took for its graph.
            peers.push(figure(&run(peer, &arguments)?, "graph_s=")?);
        }
    }
    println!("\n{name}, radius {radius}: {edges} edges");
    let (all, single) = (Timing::of(all), Timing::of(single));
    println!("  all threads  {}", all.show(1e3, "ms"));
    println!("  one thread   {}", single.show(1e3, "ms"));
    if !peers.is_empty() {
        let peers = Timing::of(peers);
        println!("  GUDHI        {}", peers.show(1e3, "ms"));
        let ratio = |own: &Timing| peers.median / own.median;
        println!("  times faster {:.1} on all threads, {:.1} on one", ratio(&all), ratio(&single));
    }
    Ok(())
}
