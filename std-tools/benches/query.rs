//! What queries cost: on a Rips complex of many dimensions, on a mapped file of each kind; and on a mesh that does not fit
//! the cache, against their floors.
//!
//! ```text
//! cargo bench --bench query                       50,000 points on the 4-sphere, radius 0.21, up to dimension 7
//! cargo bench --bench query -- 5000 0.35 5        other numbers of points, radius and dimension
//! GUDHI_BENCH=./gudhi_bench cargo bench --bench query   with GUDHI's simplex tree in the same run (see benches/peers)
//! cargo bench --bench query -- floors             sweeps and single queries on the grid of 121³ vertices, about 1 GB
//! cargo bench --bench query -- floors 56 sweeps   of another grid, or of a tetrahedral mesh in a .sigc file; one part alone:
//!                                                 sweeps, single (queries), packed
//! ```
//!
//! Each query is asked of random simplices of one dimension; both kinds of file take turns with the peer, several rounds,
//! and the medians are printed. Read the ratios.

mod common;
mod floors;

use std::collections::BTreeMap;
use std::error::Error;
use std::ffi::OsStr;
use std::hint::black_box;
use std::path::Path;

use common::{Timing, arguments, run, sum, timed, write_points};
use sig_core::{AnyComplex, AnyTree, Relations, SimplexId, VertexId};
use sig_tools::build::{BuildOptions, complete};
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::generate::{SplitMix64, sphere4};
use sig_tools::points::Metric;
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Mapped, OwnedScratch, View};

const ROUNDS: usize = 3;
/// Simplices asked of one dimension.
const SAMPLE: usize = 10_000;

/// Seconds a query, by (query, dimension), of all rounds.
type Timings = BTreeMap<(&'static str, usize), Vec<f64>>;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments();
    match arguments.split_first() {
        Some((mode, rest)) if mode == "floors" => return floors::run(rest),
        Some((mode, rest)) if mode == "watched" => return floors::watched(rest),
        _ => {}
    }
    let argument = |number: usize, default: &str| arguments.get(number).map_or(default, String::as_str).to_owned();
    let (points, radius, max_dim) = (argument(0, "50000").parse()?, argument(1, "0.21"), argument(2, "7"));
    let folder = tempfile::tempdir()?;
    let cloud = folder.path().join("points");
    let points = sphere4(points, 1);
    write_points(&points, &cloud)?;
    let graph = radius_graph(&points, Metric::Euclidean, radius.parse()?, &RadiusOptions::default())?;
    let tree = expand(&graph, &FlagOptions { max_dim: max_dim.parse()?, ..FlagOptions::default() })?;
    println!("{} simplices: {:?}", tree.num_simplices, tree.counts());
    let (small, large) = (folder.path().join("tree.sigc"), folder.path().join("sig.sigc"));
    write(&Encoding::of_tree(&tree, &EncodeOptions::default())?, &small)?;
    write(&Encoding::new(&complete(tree, &BuildOptions::default())?, &EncodeOptions::default())?, &large)?;
    let (small, large) = (Mapped::open(&small)?, Mapped::open(&large)?);
    let (View::Tree(AnyTree::Bits32(tree)), AnyComplex::Bits32(complex)) = (small.view(), large.complex()?) else {
        return Err("not 32 bits: more points, please".into());
    };
    let (mut of_tree, mut of_sig, mut of_peer) = (Timings::new(), Timings::new(), Timings::new());
    for _ in 0..ROUNDS {
        ask(&tree, &mut of_tree);
        ask(&complex, &mut of_sig);
        if let Some(peer) = std::env::var_os("GUDHI_BENCH") {
            ask_peer(&peer, &cloud, &radius, &max_dim, &mut of_peer)?;
        }
    }
    println!("µs a query, medians of {ROUNDS} rounds over {SAMPLE} random simplices; the peer's time over ours");
    println!("query       dim      tree       SIG      peer   / tree    / SIG");
    for (&(name, dim), samples) in &of_tree {
        let [ours, sig, theirs] = [Some(samples), of_sig.get(&(name, dim)), of_peer.get(&(name, dim))]
            .map(|samples| Timing::of(samples.cloned().unwrap_or_default()).median * 1e6);
        let (by_tree, by_sig) = (theirs / ours, theirs / sig);
        println!("{name:<10} {dim:>4} {ours:9.3} {sig:9.3} {theirs:9.3} {by_tree:8.1} {by_sig:8.1}");
    }
    Ok(())
}

fn write(encoding: &Encoding<'_>, path: &Path) -> Result<(), Box<dyn Error>> {
    encoding.write_to(&mut std::fs::File::create(path)?)?;
    println!("{}: {} bytes", path.file_name().unwrap_or_default().display(), encoding.file_bytes()?);
    Ok(())
}

/// Some simplices of a dimension, drawn with a seed, each perhaps more than once.
fn sample(view: &impl Relations, dim: usize) -> Vec<SimplexId> {
    let mut random = SplitMix64::new(7 + dim as u64);
    let (first, _) = view.simplices_of_dim(dim).bounds();
    let count = view.num_simplices_of_dim(dim);
    (0..SAMPLE).map(|_| SimplexId::new(first.index() + random.next_below(count))).collect()
}

/// Asks every query of random simplices of each dimension.
fn ask<V: Relations>(view: &V, timings: &mut Timings) {
    let mut memory = OwnedScratch::new(view);
    let mut scratch = memory.scratch();
    for dim in 0..=view.dim().unwrap_or(0) {
        let simplices = sample(view, dim);
        let words: Vec<Vec<VertexId>> = simplices.iter().map(|&simplex| view.vertices(simplex).collect()).collect();
        let mut measure = |name, query: &mut dyn FnMut(usize) -> usize| {
            let (seconds, total) = timed(|| (0..SAMPLE).map(query).sum::<usize>());
            black_box(total);
            timings.entry((name, dim)).or_default().push(seconds / SAMPLE as f64);
        };
        measure("find", &mut |number| view.find(&words[number]).map_or(0, SimplexId::index));
        measure("vertices", &mut |number| view.vertices(simplices[number]).map(VertexId::index).sum());
        measure("facets", &mut |number| view.facets(simplices[number]).map(SimplexId::index).sum());
        measure("cofaces1", &mut |number| sum(view.coboundary(simplices[number], dim + 1, &mut scratch)));
        measure("star", &mut |number| sum(view.star(simplices[number], &mut scratch)));
        measure("link", &mut |number| sum(view.link(simplices[number], &mut scratch)));
        measure("is top", &mut |number| usize::from(view.is_top(simplices[number])));
    }
}

/// Has the peer ask the same queries of random simplices of its own.
fn ask_peer(
    program: &OsStr,
    points: &Path,
    radius: &str,
    max_dim: &str,
    timings: &mut Timings,
) -> Result<(), Box<dyn Error>> {
    let sample = SAMPLE.to_string();
    // With lists of the nodes of each label where the peer's version has them.
    let ask = |kind: &str| {
        let arguments = ["query", kind].map(OsStr::new).into_iter().chain([points.as_os_str()]);
        run(program, &arguments.chain([radius, max_dim, &sample, "2"].map(OsStr::new)).collect::<Vec<_>>())
    };
    for line in ask("link").or_else(|_| ask("def"))?.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let value = |name: &str| words.iter().find_map(|word| word.strip_prefix(name)?.strip_prefix('='));
        let names = [
            ("find_hit", "find"),
            ("vertices", "vertices"),
            ("boundary", "facets"),
            ("cofaces1", "cofaces1"),
            ("star", "star"),
        ];
        let Some(&(_, name)) = names.iter().find(|(peer, _)| words.get(1) == Some(peer)) else { continue };
        let (Some(dim), Some(time)) = (value("dim"), value("us").or_else(|| value("us/simplex"))) else { continue };
        timings.entry((name, dim.parse()?)).or_default().push(time.parse::<f64>()? * 1e-6);
    }
    Ok(())
}
