//! What queries cost on a Rips complex of many dimensions, on a mapped file of each kind.
//!
//! ```text
//! cargo bench --bench query                       50,000 points on the 4-sphere, radius 0.21, up to dimension 7
//! cargo bench --bench query -- 5000 0.35 5        other numbers of points, radius and dimension
//! GUDHI_BENCH=./gudhi_bench cargo bench --bench query   with GUDHI's simplex tree in the same run (see benches/peers)
//! ```
//!
//! Each query is asked of random simplices of one dimension; both kinds of file take turns with the peer, several rounds,
//! and the medians are printed. Read the ratios.

use std::collections::BTreeMap;
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use sig_core::relations::Simplices;
use sig_core::{AnyComplex, AnyTree, Index, Relations, ScratchError, SimplexId, VertexId};
use sig_tools::build::{BuildOptions, Built, VertexOrder, build};
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::frozen::FrozenTree;
use sig_tools::generate::{SplitMix64, sphere4};
use sig_tools::graph::Graph;
use sig_tools::points::{Metric, Points};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Mapped, OwnedScratch, View};

const ROUNDS: usize = 3;
/// Simplices asked of one dimension.
const SAMPLE: usize = 10_000;

/// Seconds a query, by (query, dimension), of all rounds.
type Timings = BTreeMap<(&'static str, usize), Vec<f64>>;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let argument = |number: usize, default: &str| arguments.get(number).map_or(default, String::as_str).to_owned();
    let (points, radius, max_dim) = (argument(0, "50000").parse()?, argument(1, "0.21"), argument(2, "7"));
    let folder = tempfile::tempdir()?;
    let tree = rips(points, radius.parse()?, max_dim.parse()?)?;
    println!("{} simplices: {:?}", tree.num_simplices, tree.counts());
    let (small, large) = (folder.path().join("tree.sigc"), folder.path().join("sig.sigc"));
    write(&Encoding::of_tree(&tree, &EncodeOptions::default())?, &small)?;
    write(&Encoding::new(&complete(&tree)?, &EncodeOptions::default())?, &large)?;
    drop(tree);
    let (small, large) = (Mapped::open(&small)?, Mapped::open(&large)?);
    let (View::Tree(AnyTree::Bits32(tree)), AnyComplex::Bits32(complex)) = (small.view(), large.complex()?) else {
        return Err("not 32 bits: more points, please".into());
    };
    let (mut of_tree, mut of_sig, mut of_peer) = (Timings::new(), Timings::new(), Timings::new());
    let points = folder.path().join("points");
    write_points(&sphere4(tree.num_vertices(), 1), &points)?;
    for _ in 0..ROUNDS {
        ask(&tree, &mut of_tree);
        ask(&complex, &mut of_sig);
        if let Some(peer) = std::env::var_os("GUDHI_BENCH") {
            ask_peer(peer.as_ref(), &points, &radius, &max_dim, &mut of_peer)?;
        }
    }
    println!("µs a query, medians of {ROUNDS} rounds over {SAMPLE} random simplices; GUDHI's time over ours");
    println!("query       dim      tree       SIG     GUDHI   / tree    / SIG");
    for (key, samples) in &of_tree {
        let [ours, sig, theirs] =
            [Some(samples), of_sig.get(key), of_peer.get(key)].map(|samples| median(samples) * 1e6);
        println!(
            "{:<10} {:>4} {ours:9.3} {sig:9.3} {theirs:9.3} {:8.1} {:8.1}",
            key.0,
            key.1,
            theirs / ours,
            theirs / sig
        );
    }
    Ok(())
}

/// The Rips complex of points on the 4-sphere, numbered as they come.
fn rips(points: usize, radius: f64, max_dim: usize) -> Result<FrozenTree, Box<dyn Error>> {
    let points = sphere4(points, 1);
    let mut edges = Vec::new();
    let by_first = sorted_by_first_coordinate(&points);
    for (place, &p) in by_first.iter().enumerate() {
        for &q in &by_first[place + 1..] {
            let (left, right) = (points.point(p as usize), points.point(q as usize));
            if right[0] - left[0] > radius {
                break;
            }
            if Metric::Euclidean.distance(left, right) <= radius {
                edges.push((p.min(q), p.max(q)));
            }
        }
    }
    let graph = Graph::from_edges(points.len(), &edges, None)?;
    Ok(expand(&graph, &FlagOptions { max_dim, ..FlagOptions::default() })?)
}

/// The whole graph of a tree, by way of its simplices without children; the vertices keep their numbers.
fn complete(tree: &FrozenTree) -> Result<Built, Box<dyn Error>> {
    let mut soup = Soup::new(Labels::Numbered(tree.num_vertices()), true);
    let mut stack: Vec<(usize, Vec<u32>)> = (0..tree.num_vertices()).map(|vertex| (vertex, Vec::new())).collect();
    while let Some((simplex, mut word)) = stack.pop() {
        word.push(tree.last_vertices.at(simplex));
        let children = tree.children(simplex);
        if children.is_empty() {
            soup.push(&word);
        }
        stack.extend(children.map(|child| (child, word.clone())));
    }
    Ok(build(soup, &BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() })?)
}

fn sorted_by_first_coordinate(points: &Points) -> Vec<u32> {
    let mut order: Vec<u32> = (0..).take(points.len()).collect();
    order.sort_by(|&p, &q| points.point(p as usize)[0].total_cmp(&points.point(q as usize)[0]));
    order
}

fn write(encoding: &Encoding<'_>, path: &Path) -> Result<(), Box<dyn Error>> {
    encoding.write_to(&mut std::fs::File::create(path)?)?;
    println!("{}: {} bytes", path.file_name().unwrap_or_default().display(), encoding.file_bytes()?);
    Ok(())
}

/// The points in the peer's format.
fn write_points(points: &Points, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut bytes = b"PTS1".to_vec();
    bytes.extend(u32::try_from(points.dim())?.to_le_bytes());
    bytes.extend((points.len() as u64).to_le_bytes());
    bytes.extend(points.values().iter().flat_map(|value| value.to_le_bytes()));
    Ok(std::fs::write(path, bytes)?)
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
            let start = Instant::now();
            let total: usize = (0..SAMPLE).map(query).sum();
            black_box(total);
            timings.entry((name, dim)).or_default().push(start.elapsed().as_secs_f64() / SAMPLE as f64);
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

/// The sum of the ids, so that every one of an answer is read; no query here lacks memory.
fn sum<I: Index>(answer: Result<Simplices<'_, I>, ScratchError>) -> usize {
    answer.map_or(0, |simplices| simplices.map(SimplexId::index).sum())
}

/// Has the peer ask the same queries of random simplices of its own.
fn ask_peer(
    program: &Path,
    points: &Path,
    radius: &str,
    max_dim: &str,
    timings: &mut Timings,
) -> Result<(), Box<dyn Error>> {
    let sample = SAMPLE.to_string();
    let output =
        Command::new(program).args(["query", "link"]).arg(points).args([radius, max_dim, &sample, "2"]).output()?;
    for line in String::from_utf8(output.stdout)?.lines() {
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

fn median(samples: Option<&Vec<f64>>) -> f64 {
    let mut samples = samples.cloned().unwrap_or_default();
    samples.sort_by(f64::total_cmp);
    samples.get(samples.len() / 2).copied().unwrap_or(f64::NAN)
}
