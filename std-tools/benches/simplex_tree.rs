//! What the dynamic simplex tree costs: memory, random insertion, insertion with all faces, removal, cofaces with and
//! without label lists, edge contraction under the link condition.
//!
//! ```text
//! cargo bench --bench simplex_tree                                   all of it
//! cargo bench --bench simplex_tree -- contract                       one part: memory, incr, cofaces or contract
//! GUDHI_BENCH=./gudhi_bench cargo bench --bench simplex_tree         with GUDHI's simplex tree in turn
//! ```
//!
//! Points are uniform on the 4-sphere (`generate::sphere4`, seed 1). Machines are noisy, so whatever is compared is
//! measured in turn, several rounds, and the medians are printed with their spread. Read the ratios.

use std::error::Error;
use std::ffi::{OsStr, OsString};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{Timing, timed};
use sig_tools::generate::{SplitMix64, sphere4};
use sig_tools::graph::Graph;
use sig_tools::points::{Metric, Points};
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::simplex_tree::{LinkCondition, Simplex, SimplexTree};

mod common;

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    let arguments = common::arguments();
    if arguments.first().is_some_and(|mode| mode == "--memory") {
        return memory();
    }
    let wants = |part: &str| arguments.is_empty() || arguments.iter().any(|argument| argument == part);
    let folder = tempfile::tempdir()?;
    let points = sphere4(50_000, 1);
    let peer = Peer::new(&points, folder.path())?;
    if wants("memory") {
        let output = Command::new(std::env::current_exe()?).arg("--memory").output()?;
        print!("{}", String::from_utf8(output.stdout)?);
        let figures = peer.figure(&["rips", "def"], &["0.21", "7"], &["rss_B/simplex="])?;
        print_figures("GUDHI, bytes a simplex", &figures, 1.0);
    }
    if wants("incr") {
        incremental(&points, &peer)?;
    }
    if wants("cofaces") {
        cofaces(&points)?;
    }
    if wants("contract") {
        contraction(&peer)?;
    }
    Ok(())
}

/// The binary to compare with, if the environment names one, and the points in its format.
struct Peer {
    program: Option<OsString>,
    points: PathBuf,
}

impl Peer {
    fn new(points: &Points, folder: &Path) -> Outcome<Self> {
        let path = folder.join("s4.pts");
        common::write_points(points, &path)?;
        Ok(Self { program: common::peer(), points: path })
    }

    /// The figures that follow the keys in what the peer says; none if there is no peer.
    fn figure(&self, mode: &[&str], arguments: &[&str], keys: &[&str]) -> Outcome<Vec<f64>> {
        let Some(program) = &self.program else { return Ok(Vec::new()) };
        let words =
            mode.iter().map(OsStr::new).chain([self.points.as_os_str()]).chain(arguments.iter().map(OsStr::new));
        let text = common::run(program, &words.collect::<Vec<_>>())?;
        let after = |key: &&str| {
            let (head, last) = key.rsplit_once('|').unwrap_or(("", key));
            let line = text.lines().find(|line| line.contains(head) && line.contains(last))?;
            common::figure(line, last).ok()
        };
        let figures: Option<Vec<f64>> = keys.iter().map(after).collect();
        Ok(figures.ok_or_else(|| format!("no figure of the peer in: {text}"))?)
    }
}

fn print_figures(what: &str, figures: &[f64], factor: f64) {
    if !figures.is_empty() {
        let Timing { median, least, most } = Timing::of(figures.to_vec());
        println!("  {what:44} {:9.3} ({:.3}, {:.3})", median * factor, least * factor, most * factor);
    }
}

/// Prints seconds as microseconds, and how many times as long the peer takes.
fn compare(what: &str, own: Vec<f64>, theirs: Vec<f64>) {
    print_figures(what, &own, 1e6);
    print_figures("  GUDHI", &theirs, 1e6);
    if !theirs.is_empty() {
        println!("    GUDHI / SIG {:.2}", Timing::of(theirs).median / Timing::of(own).median);
    }
}

/// The graph of the pairs at distance up to `radius`, of the first `count` points.
fn graph(points: &Points, count: usize, radius: f64) -> Outcome<Graph> {
    let points = points.select(&(0..count).collect::<Vec<_>>());
    Ok(radius_graph(&points, Metric::Euclidean, radius, &RadiusOptions { weighted: true, ..RadiusOptions::default() })?)
}

/// The flag complex of the points.
fn rips(points: &Points, radius: f64, max_dim: usize) -> Outcome<SimplexTree> {
    let mut tree = SimplexTree::from_graph(&graph(points, points.len(), radius)?)?;
    tree.expand(max_dim)?;
    Ok(tree)
}

fn resident() -> Outcome<f64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).ok_or("no VmRSS")?;
    Ok(line.trim().trim_end_matches(" kB").parse::<f64>()? * 1024.0)
}

/// In a process of its own: the memory that trees take, by the operating system.
fn memory() -> Outcome<()> {
    let points = sphere4(50_000, 1);
    let graph = graph(&points, points.len(), 0.21)?;
    let before = resident()?;
    let (time, tree) = timed(|| -> Outcome<SimplexTree> {
        let mut tree = SimplexTree::from_graph(&graph)?;
        tree.expand(7)?;
        Ok(tree)
    });
    let tree = tree?;
    let count = tree.num_simplices() as f64;
    println!("  s4 r 0.21 k 7: {:?}", tree.counts());
    println!("  expansion, ns a simplex                      {:9.3}", time / count * 1e9);
    println!("  bytes a simplex, by the operating system     {:9.3}", (resident()? - before) / count);
    println!("  bytes a simplex, of the sets                 {:9.3}", tree.bytes() as f64 / count);
    let mut words: Vec<(Vec<u32>, f64)> = tree.iter().map(|simplex| (simplex.word(), simplex.value())).collect();
    shuffle(&mut words);
    drop(tree);
    let before = resident()?;
    let mut tree = SimplexTree::new();
    for (word, value) in &words {
        tree.insert_with_prefixes(word, *value)?;
    }
    println!("  the same after random insertion              {:9.3}", tree.bytes() as f64 / count);
    println!("    by the operating system, memory reused     {:9.3}", (resident()? - before) / count);
    tree.make_compact()?;
    println!("    and made compact                           {:9.3}", tree.bytes() as f64 / count);
    Ok(())
}

fn shuffle<T>(items: &mut [T]) {
    let mut random = SplitMix64::new(5);
    for last in (1..items.len()).rev() {
        items.swap(last, random.next_below(last + 1));
    }
}

/// Random insertion, insertion with all faces, removal: as the peer does them.
fn incremental(points: &Points, peer: &Peer) -> Outcome<()> {
    const ROUNDS: usize = 3;
    let tree = rips(points, 0.21, 5)?;
    println!("s4 r 0.21 k 5: {} simplices; microseconds each", tree.num_simplices());
    let mut all: Vec<Vec<u32>> = tree.iter().map(Simplex::word).collect();
    let mut tops: Vec<Vec<u32>> = all.iter().filter(|word| word.len() == 6).cloned().collect();
    shuffle(&mut all);
    shuffle(&mut tops);
    let mut own: [Vec<f64>; 3] = Default::default();
    let mut theirs: [Vec<f64>; 3] = Default::default();
    for _ in 0..ROUNDS {
        let (time, inserted) = timed(|| insert_all(&all, SimplexTree::insert_with_prefixes));
        assert_eq!(inserted?.num_simplices(), tree.num_simplices());
        own[0].push(time / all.len() as f64);
        let some = &tops[..tops.len().min(500_000)];
        let (time, inserted) = timed(|| insert_all(some, SimplexTree::insert_with_faces));
        black_box(inserted?);
        own[1].push(time / some.len() as f64);
        let mut smaller = tree.clone();
        let some = &tops[..tops.len().min(200_000)];
        let (time, removed) = timed(|| some.iter().try_fold(0, |sum, word| smaller.remove(word).map(|one| sum + one)));
        assert_eq!(removed?, some.len());
        own[2].push(time / some.len() as f64);
        let keys = ["insert_simplex random|us=", "insert_simplex_and_subfaces|us="];
        let figures = peer.figure(&["incr", "def"], &["0.21", "5", "insert"], &keys)?;
        let removal = peer.figure(&["incr", "def"], &["0.21", "5", "remove"], &["remove_maximal_simplex|us="])?;
        for (figure, theirs) in figures.iter().chain(&removal).zip(&mut theirs) {
            theirs.push(figure * 1e-6);
        }
    }
    let work = ["insertion in random order", "insertion with faces, dimension 5", "removal of a maximal simplex"];
    for ((work, own), theirs) in work.into_iter().zip(own).zip(theirs) {
        compare(work, own, theirs);
    }
    Ok(())
}

fn insert_all<T>(
    words: &[Vec<u32>],
    insert: impl Fn(&mut SimplexTree, &[u32], f64) -> Result<T, sig_tools::simplex_tree::InsertError>,
) -> Outcome<SimplexTree> {
    let mut tree = SimplexTree::new();
    for word in words {
        insert(&mut tree, word, 0.0)?;
    }
    Ok(tree)
}

/// The star of random simplices of each dimension, with label lists and without.
fn cofaces(points: &Points) -> Outcome<()> {
    let tree = rips(points, 0.21, 7)?;
    let mut listed = tree.clone();
    let (time, kept) = timed(|| listed.keep_label_lists());
    kept?;
    println!("s4 r 0.21 k 7, the star of a simplex, microseconds; making the lists took {time:.2} s");
    for dim in 0..=7 {
        let mut words: Vec<Vec<u32>> = tree.iter().filter(|simplex| simplex.dim() == dim).map(Simplex::word).collect();
        shuffle(&mut words);
        let each = |tree: &SimplexTree, count: usize| {
            let some = &words[..count.min(words.len())];
            let (time, found) = timed(|| some.iter().map(|word| tree.star(word).count()).sum::<usize>());
            (time / some.len() as f64 * 1e6, found as f64 / some.len() as f64)
        };
        let ((with, found), (without, _)) = (each(&listed, 20_000), each(&tree, 100));
        println!("  dimension {dim}: {found:8.1} cofaces   with lists {with:9.2}   without {without:9.2}");
    }
    Ok(())
}

/// Contraction of all edges that satisfy the link condition, shortest first; at one radius, then at one mean degree.
fn contraction(peer: &Peer) -> Outcome<()> {
    let points = sphere4(50_000, 1);
    println!("contraction of all edges that may be, microseconds an edge");
    // The same mean degree as 3,000 points at 0.35: the radius goes with the fourth root of the density.
    let at_degree = |count: usize| 0.35 * (3000.0 / count as f64).powf(0.25);
    let scaled = [12_000, 48_000].map(|count| (count, at_degree(count)));
    let runs = [(3000, 0.35), (6000, 0.35)].into_iter().chain(scaled);
    for (count, radius) in runs {
        let graph = graph(&points, count, radius)?;
        let mut own = Vec::new();
        let mut theirs = Vec::new();
        let mut summary = String::new();
        for _ in 0..3 {
            let mut tree = SimplexTree::from_graph(&graph)?;
            tree.expand(sig_core::MAX_DIM)?;
            let before = tree.num_simplices();
            let (time, contracted) = timed(|| tree.contract_all(1, LinkCondition::Required, None));
            let done = contracted?.len();
            own.push(time / done as f64);
            summary =
                format!("{} edges, {before} simplices, {done} contracted, left {:?}", graph.num_edges(), tree.counts());
            let (radius, count) = (radius.to_string(), count.to_string());
            theirs.extend(peer.figure(&["contract"], &[&radius, &count], &["us/contraction="])?);
        }
        println!(" {count} points, r {radius:.3}: {summary}");
        compare("SIG", own, theirs.into_iter().map(|figure| figure * 1e-6).collect());
    }
    Ok(())
}
