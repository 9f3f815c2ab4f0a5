//! What the flag complex of points on the 4-sphere costs: expansion to the frozen tree, and completing it to a whole SIG.
//!
//! ```text
//! cargo bench --bench flag                             5,000, 16,000 and 50,000 points with the same number of neighbours
//! cargo bench --bench flag -- 50000 0.253 5            points, radius, largest dimension
//! GUDHI_BENCH=./gudhi_bench cargo bench --bench flag   with GUDHI's leanest simplex tree in the same run
//! ```
//!
//! `gudhi_bench rips min FILE RADIUS DIM` expands the same points (see benches/peers). Machines are noisy, so whatever is
//! compared is measured in turn, several rounds, and the medians are printed. Read the ratios.

#![allow(clippy::cast_possible_truncation, reason = "inputs are small")]

use std::error::Error;
use std::ffi::OsStr;
use std::hint::black_box;
use std::path::Path;

use common::{Timing, figure, run, timed, write_points};
use sig_tools::build::{BuildOptions, complete};
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::frozen::FrozenTree;
use sig_tools::generate::sphere4;
use sig_tools::points::Metric;
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::store::{EncodeOptions, Encoding};

mod common;

const ROUNDS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
    let runs = match arguments.as_slice() {
        [count, radius, max_dim] => vec![(count.parse()?, radius.parse()?, max_dim.parse()?)],
        // The radius goes with the fourth root of the density, so that the mean degree is the same.
        _ => [5_000, 16_000, 50_000].map(|count| (count, 0.253 * (50_000.0 / count as f64).powf(0.25), 5)).to_vec(),
    };
    println!("medians of {ROUNDS} rounds; threads: {}", rayon::current_num_threads());
    runs.into_iter().try_for_each(|(count, radius, max_dim)| measure(count, radius, max_dim))
}

fn measure(count: usize, radius: f64, max_dim: usize) -> Result<(), Box<dyn Error>> {
    let points = sphere4(count, 1);
    let graph = radius_graph(&points, Metric::Euclidean, radius, &RadiusOptions::default())?;
    let file = tempfile::NamedTempFile::new()?;
    write_points(&points, file.path())?;
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let options = FlagOptions { max_dim, ..FlagOptions::default() };
    let (mut all, mut single, mut floor, mut whole, mut peer) = (vec![], vec![], vec![], vec![], vec![]);
    let mut counts = Vec::new();
    for _ in 0..ROUNDS {
        let (seconds, tree) = timed(|| expand(&graph, &options));
        let tree = tree?;
        all.push(seconds);
        counts = tree.counts();
        if all.len() == 1 {
            println!("\n{count} points, radius {radius:.4}: {} simplices {counts:?}", tree.num_simplices);
            let bytes = Encoding::of_tree(&tree, &EncodeOptions::default())?.file_bytes()?;
            println!("  file of the tree: {:.2} bytes a simplex", bytes as f64 / tree.num_simplices as f64);
        }
        single.push(timed(|| one.install(|| expand(&graph, &options))).0);
        floor.push(timed(|| written(&tree)).0);
        let (seconds, built) = timed(|| complete(tree, &BuildOptions::default()));
        black_box(built?);
        whole.push(all[all.len() - 1] + seconds);
        if let Some(program) = common::peer() {
            peer.push(run_peer(&program, file.path(), radius, max_dim, &counts)?);
        }
    }
    let simplices = counts.iter().sum::<usize>() as f64;
    let each = |seconds: f64| format!("{:.2} ns a simplex", seconds * 1e9 / simplices);
    let median = |samples| Timing::of(samples).median;
    let (all, single, floor, whole) = (median(all), median(single), median(floor), median(whole));
    println!("  expansion, all threads  {}, {:.1} times writing as many bytes on one", each(all), all / floor);
    println!("  expansion, one thread   {}, {:.1} times", each(single), single / floor);
    println!("  the whole SIG           {}", each(whole));
    if !peer.is_empty() {
        let peer = median(peer);
        println!("  GUDHI's tree            {}", each(peer));
        println!("  GUDHI / expansion       {:.1} all threads, {:.1} one", peer / all, peer / single);
        println!("  whole SIG / GUDHI       {:.2}", whole / peer);
    }
    Ok(())
}

/// As many bytes as the tree has, written in memory that is new: no expansion takes less.
fn written(tree: &FrozenTree) -> (Vec<u16>, Vec<u32>) {
    (black_box(vec![1; tree.num_simplices]), black_box(vec![1; tree.child_offsets.len()]))
}

/// Seconds that the peer takes to insert the same edges and expand them; its counts must be the same.
fn run_peer(
    program: &OsStr,
    file: &Path,
    radius: f64,
    max_dim: usize,
    counts: &[usize],
) -> Result<f64, Box<dyn Error>> {
    let arguments = [radius.to_string(), max_dim.to_string()];
    let [radius, max_dim] = &arguments;
    let text = run(program, &["rips".as_ref(), "min".as_ref(), file.as_os_str(), radius.as_ref(), max_dim.as_ref()])?;
    let theirs = common::counts(&text)?;
    if theirs != counts {
        return Err(format!("the peer counts {theirs:?}").into());
    }
    figure(&text, "expansion_s=")
}
