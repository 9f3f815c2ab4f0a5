//! This project and its peers on the same inputs, in one run: points to a simplex tree and a whole SIG, tetrahedra to a SIG,
//! queries, Betti numbers.
//!
//! ```text
//! std-tools/benches/peers/run                  gets and compiles the peers, and runs this with all of them
//! cargo bench --bench peers                    with the peers that there are: see benches/README.md
//! cargo bench --bench peers -- rips mesh       some of the tasks: rips, mesh, query, betti, ripser
//! ```
//!
//! Every measurement is a process of its own that does its work once. The programs take turns, several rounds; each row gives
//! the median with the least and the most. Before the first figure of a round is kept, the numbers of simplices, or the Betti
//! numbers, are compared: all programs must have the same, or the run ends. The result is a table in Markdown, on standard
//! output, and a chart of the ratios, `benches/figures/peers.svg`.

mod common;

use std::collections::BTreeMap;
use std::error::Error;
use std::ffi::{OsStr, OsString};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{Timing, counts, figure, grid, listed, peak_memory, run, sum, timed, write_points, write_tetrahedra};
use sig_core::{AnyComplex, Relations, SimplexId, VertexId, with_complex};
use sig_tools::build::{BuildOptions, Built, build, complete};
use sig_tools::chart::{Bars, draw_bars};
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::frozen::FrozenTree;
use sig_tools::generate::{SplitMix64, sphere4};
use sig_tools::graph::Graph;
use sig_tools::homology::{self, Coefficients, HomologyOptions, homology};
use sig_tools::io::space::{SpaceOptions, read_points_path};
use sig_tools::points::Metric;
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{AlignedBytes, EncodeOptions, Encoding};
use sig_tools::{OwnedScratch, View, with_view};

const ROUNDS: usize = 3;
/// Simplices of a dimension that are asked.
const SAMPLE: usize = 10_000;
/// Vertices along an edge of the grid.
const GRID: u32 = 56;

/// What a measurement prints, by name: seconds, microseconds a query or bytes a simplex.
type Figures = BTreeMap<String, f64>;

/// The figures of all rounds, by program and name.
type Samples = BTreeMap<(Program, String), Vec<f64>>;

/// Who does the same work.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Program {
    Sig,
    SigOnOneThread,
    Gudhi,
    GudhiPython,
    Ripser,
}

impl Program {
    const ALL: [Self; 5] = [Self::Sig, Self::SigOnOneThread, Self::Gudhi, Self::GudhiPython, Self::Ripser];

    fn name(self) -> &'static str {
        ["SIG", "SIG, one thread", "GUDHI, C++", "GUDHI, Python", "Ripser"][self as usize]
    }

    /// Whether the work is that of this project.
    fn is_ours(self) -> bool {
        self <= Self::SigOnOneThread
    }
}

/// A piece of work that several programs do, and its input.
struct Task {
    name: &'static str,
    title: String,
    /// What each program is called with, after the name of the task.
    arguments: Vec<OsString>,
    /// What each figure is, in the order of the table: its name, what it is called, its unit.
    rows: Vec<(String, String, &'static str)>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["alone", ref task @ ..] => return alone(task),
        ["grid", side, file] => return write_tetrahedra(&grid(side.parse()?), Path::new(file)),
        _ => {}
    }
    let folder = tempfile::tempdir()?;
    let tasks: Vec<Task> = tasks(folder.path())?
        .into_iter()
        .filter(|task| arguments.is_empty() || arguments.iter().any(|a| a == task.name))
        .collect();
    describe_machine();
    println!("\n| task | unit | {} | best peer / SIG |", Program::ALL.map(Program::name).join(" | "));
    println!("|---|---|{}---|", "---|".repeat(Program::ALL.len()));
    let mut panels = Vec::new();
    for task in &tasks {
        let samples = measure(task)?;
        panels.push(report(task, &samples));
    }
    let chart = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/figures/peers.svg");
    let svg = draw_bars("the peers over SIG: times, bytes, memory", &panels).map_err(|error| error.to_string())?;
    std::fs::write(&chart, svg)?;
    eprintln!("wrote {}", chart.display());
    Ok(())
}

/// The inputs, in files that all programs read.
fn tasks(folder: &Path) -> Result<Vec<Task>, Box<dyn Error>> {
    let points = |name: &str, count| -> Result<PathBuf, Box<dyn Error>> {
        let path = folder.join(name);
        write_points(&sphere4(count, 1), &path)?;
        Ok(path)
    };
    let (large, small) = (points("large", 50_000)?, points("small", 2_000)?);
    let tetrahedra = folder.join("tetrahedra");
    write_tetrahedra(&grid(GRID), &tetrahedra)?;
    let with = |file: &Path, rest: &[&str]| {
        std::iter::once(file.as_os_str().to_owned()).chain(rest.iter().map(OsString::from)).collect()
    };
    let row = |key: &str, name: &str, unit| (key.to_owned(), name.to_owned(), unit);
    let queries = [("find", "find"), ("facets", "facets"), ("cofaces1", "cofacets"), ("star", "star")];
    let queries = queries
        .into_iter()
        .flat_map(|(key, name)| [1, 3, 5].map(|dim| (format!("{key}{dim}"), format!("{name}, dimension {dim}"), "µs")));
    Ok(vec![
        Task {
            name: "rips",
            title: "Rips complex: 50,000 points of the 4-sphere, radius 0.253, up to dimension 5".to_owned(),
            arguments: with(&large, &["0.253", "5"]),
            rows: vec![
                row("graph_s", "the graph of near points", "s"),
                row("expansion_s", "its expansion to the simplex tree", "s"),
                row("tree_s", "both", "s"),
                row("tree_bytes", "the tree, a simplex", "B"),
                row("sig_s", "the SIG of that tree, which no peer makes", "s"),
                row("sig_bytes", "the SIG, a simplex", "B"),
            ],
        },
        Task {
            name: "mesh",
            title: format!("Tetrahedral mesh: a grid of {GRID}³ vertices"),
            arguments: with(&tetrahedra, &[]),
            rows: vec![
                row("build_s", "from tetrahedra to the complex", "s"),
                row("bytes", "the complex, a simplex", "B"),
            ],
        },
        Task {
            name: "query",
            title: "Queries of the Rips complex of radius 0.21, up to dimension 5".to_owned(),
            arguments: with(&large, &["0.21", "5"]),
            rows: queries.collect(),
        },
        Task {
            name: "betti",
            title: "Betti numbers over Z/2 of that complex".to_owned(),
            arguments: with(&large, &["0.21", "5"]),
            rows: vec![row("betti_s", "from the complex", "s"), row("peak_mb", "peak of the process", "MB")],
        },
        Task {
            name: "ripser",
            title: "Betti numbers up to dimension 2 at radius 0.6, from 2,000 points of the 4-sphere".to_owned(),
            arguments: with(&small, &["0.6", "3"]),
            rows: vec![row("total_s", "from the points", "s")],
        },
    ])
}

/// All figures of all programs that there are, of all rounds.
fn measure(task: &Task) -> Result<Samples, Box<dyn Error>> {
    let mut samples = Samples::new();
    let mut expected: Option<Vec<usize>> = None;
    for _ in 0..ROUNDS {
        for program in Program::ALL {
            let Some(text) = ask(program, task)? else { continue };
            let found = counts(&text)?;
            if *expected.get_or_insert_with(|| found.clone()) != found {
                return Err(format!("{}: {} has {found:?}, not {expected:?}", task.title, program.name()).into());
            }
            for (name, value) in figures(&text) {
                samples.entry((program, name)).or_default().push(value);
            }
        }
    }
    Ok(samples)
}

/// What a program prints on a task; `None` where it cannot do it, or is not there.
fn ask(program: Program, task: &Task) -> Result<Option<String>, Box<dyn Error>> {
    let arguments: Vec<&OsStr> = task.arguments.iter().map(OsString::as_os_str).collect();
    let with = |first: &[&str]| -> Vec<OsString> {
        first.iter().map(OsString::from).chain(arguments.iter().map(|&argument| argument.to_owned())).collect()
    };
    match program {
        Program::Sig | Program::SigOnOneThread => {
            let mut command = Command::new(std::env::current_exe()?);
            command.args(with(&["alone", task.name]));
            if program == Program::SigOnOneThread {
                command.env("RAYON_NUM_THREADS", "1");
            }
            let output = command.output()?;
            if !output.status.success() {
                return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
            }
            Ok(Some(String::from_utf8(output.stdout)?))
        }
        Program::Gudhi => ask_gudhi(task, &arguments),
        Program::GudhiPython | Program::Ripser => {
            if (program == Program::Ripser) != (task.name == "ripser") {
                return Ok(None);
            }
            let Some(python) = std::env::var_os("PEERS_PYTHON") else { return Ok(None) };
            let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers/python_peers.py");
            let words = with(&[script, task.name]);
            run(&python, &words.iter().map(OsString::as_os_str).collect::<Vec<_>>()).map(Some)
        }
    }
}

/// Asks GUDHI's C++ programs, and turns what they print into figures of the names here.
fn ask_gudhi(task: &Task, arguments: &[&OsStr]) -> Result<Option<String>, Box<dyn Error>> {
    let (variable, mode) = match task.name {
        "rips" => ("GUDHI_BENCH", vec!["rips", "min"]),
        "query" => ("GUDHI_BENCH", vec!["query", "def"]),
        "mesh" => ("GUDHI_MESH", vec!["lean"]),
        "betti" => ("GUDHI_HOMOLOGY", vec!["rips"]),
        _ => return Ok(None),
    };
    let Some(program) = std::env::var_os(variable) else { return Ok(None) };
    let mut words: Vec<&OsStr> = mode.iter().map(OsStr::new).collect();
    words.extend(arguments);
    let sample = SAMPLE.to_string();
    if task.name == "query" {
        words.extend([&*sample, "1"].map(OsStr::new));
    }
    let text = run(&program, &words)?;
    Ok(Some(match task.name {
        "rips" => {
            let (graph, tree) =
                (figure(&text, "graph_s=")?, figure(&text, "insert_graph_s=")? + figure(&text, "expansion_s=")?);
            let bytes = figure(&text, "heap_B/simplex=")?;
            let of = listed(&counts(&text)?);
            format!("graph_s={graph} expansion_s={tree} tree_s={} tree_bytes={bytes} dims={of}", graph + tree)
        }
        "mesh" => {
            let (seconds, bytes) = (figure(&text, "insert ")?, figure(&text, "MB, ")?);
            let of = text.split("simplices ").nth(1).and_then(|rest| rest.split(" =").next()).unwrap_or("");
            format!("build_s={seconds} bytes={bytes} dims={of}")
        }
        "query" => {
            let mut lines = format!("dims={}\n", listed(&counts(&text)?));
            for line in text.lines().filter(|line| line.starts_with("Q ")) {
                let query = line.split_whitespace().nth(1).unwrap_or("");
                let query = if query == "find_hit" {
                    "find"
                } else if query == "boundary" {
                    "facets"
                } else {
                    query
                };
                let time = figure(line, "us=").or_else(|_| figure(line, "us/simplex="))?;
                lines.push_str(&format!("{query}{}={time}\n", figure(line, "dim=")?));
            }
            lines
        }
        _ => {
            let seconds = figure(&text, "sort_s=")? + figure(&text, "cohomology_s=")?;
            let betti = text.split("betti=").nth(1).unwrap_or("").trim();
            format!("betti_s={seconds} peak_mb={} dims={betti}", figure(&text, "peak_mb=")?)
        }
    }))
}

/// All that stands as name=number, but for the numbers of simplices.
fn figures(text: &str) -> Figures {
    text.split_whitespace()
        .filter_map(|word| word.split_once('='))
        .filter(|(name, _)| *name != "dims")
        .filter_map(|(name, value)| Some((name.to_owned(), value.parse().ok()?)))
        .collect()
}

/// Prints the rows of a task, and makes the chart of its ratios.
fn report(task: &Task, samples: &Samples) -> Bars {
    println!("| **{}** | {}", task.title, " |".repeat(Program::ALL.len() + 2));
    let mut groups = Vec::new();
    for (key, name, unit) in &task.rows {
        let timings =
            Program::ALL.map(|program| samples.get(&(program, key.clone())).map(|all| Timing::of(all.clone())));
        let cells = timings.map(|timing| {
            timing.map_or_else(String::new, |Timing { median, least, most }| {
                format!("{median:.3} ({least:.3} to {most:.3})")
            })
        });
        let ratios = Program::ALL.map(|program| {
            let theirs = timings[program as usize].filter(|_| !program.is_ours())?;
            Some(theirs.median / timings[Program::Sig as usize]?.median)
        });
        let best = ratios.iter().flatten().copied().reduce(f64::min);
        println!(
            "| {name} | {unit} | {} | {} |",
            cells.join(" | "),
            best.map_or(String::new(), |best| format!("{best:.1}"))
        );
        if best.is_some() {
            let bar = |ratio: f64| (ratio, format!("{ratio:.*}", usize::from(ratio < 100.0)));
            let bars = ratios.into_iter().skip(2).map(|ratio| ratio.map(bar)).collect();
            groups.push((name.replace("dimension ", ""), bars));
        }
    }
    let series = Program::ALL.into_iter().filter(|program| !program.is_ours());
    Bars {
        title: task.title.clone(),
        log: true,
        series: series.map(|program| program.name().to_owned()).collect(),
        groups,
    }
}

/// The machine and the versions, as far as they tell.
fn describe_machine() {
    let line = |path: &str, key: &str| {
        let text = std::fs::read_to_string(path).ok()?;
        let line = text.lines().find(|line| line.starts_with(key))?.split_once(':')?.1.trim().to_owned();
        Some(line)
    };
    let threads = rayon::current_num_threads();
    let processor = line("/proc/cpuinfo", "model name").unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    println!("- {threads} threads of {processor}; memory {}", line("/proc/meminfo", "MemTotal").unwrap_or_default());
    println!("- SIG {}, {ROUNDS} rounds in turn", env!("CARGO_PKG_VERSION"));
    for version in std::env::var("PEERS_VERSIONS").unwrap_or_default().lines() {
        println!("- {version}");
    }
}

/// Does the work of a task once, and prints what it took.
fn alone(task: &[&str]) -> Result<(), Box<dyn Error>> {
    match *task {
        ["rips", file, radius, max_dim] => {
            let (graph_s, graph) = timed(|| near(file, radius));
            let (expansion_s, tree) = timed(|| flag(&graph?, max_dim));
            let tree = tree?;
            let dims = listed(&tree.counts());
            let simplices = tree.num_simplices as f64;
            let tree_bytes = Encoding::of_tree(&tree, &EncodeOptions::default())?.file_bytes()? as f64 / simplices;
            let (sig_s, built) = timed(|| complete(tree, &BuildOptions::default()));
            let sig_bytes = Encoding::new(&built?, &EncodeOptions::default())?.file_bytes()? as f64 / simplices;
            println!("graph_s={graph_s} expansion_s={expansion_s} tree_s={}", graph_s + expansion_s);
            println!("sig_s={sig_s} sig_bytes={sig_bytes} tree_bytes={tree_bytes} dims={dims}");
        }
        ["mesh", file] => {
            let tetrahedra: Vec<u32> =
                std::fs::read(file)?.as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect();
            let vertices = tetrahedra.iter().max().map_or(0, |&vertex| vertex as usize + 1);
            let mut soup = Soup::new(Labels::Numbered(vertices), true);
            tetrahedra.chunks_exact(4).for_each(|vertices| soup.push(vertices));
            drop(tetrahedra);
            let (build_s, bytes) = timed(|| encoded(&build(soup, &BuildOptions::default())?));
            let bytes = bytes?;
            let counts = with_complex!(complex_in(&bytes)?, complex => num_simplices(&complex));
            let simplices = counts.iter().sum::<usize>() as f64;
            println!("build_s={build_s} bytes={} dims={}", bytes.len() as f64 / simplices, listed(&counts));
        }
        ["query", file, radius, max_dim] => {
            let bytes = encoded(&complete(flag(&near(file, radius)?, max_dim)?, &BuildOptions::default())?)?;
            with_complex!(complex_in(&bytes)?, complex => query(&complex));
        }
        ["betti", file, radius, max_dim] => {
            let tree = flag(&near(file, radius)?, max_dim)?;
            let bytes = Encoding::of_tree(&tree, &EncodeOptions::default())?.to_bytes()?;
            drop(tree);
            let (betti_s, betti) = timed(|| betti(&bytes, max_dim));
            println!("betti_s={betti_s} peak_mb={} dims={}", peak_memory().unwrap_or(f64::NAN) / 1e6, betti?);
        }
        ["ripser", file, radius, max_dim] => {
            let (total_s, betti) = timed(|| {
                let tree = flag(&near(file, radius)?, max_dim)?;
                betti(&Encoding::of_tree(&tree, &EncodeOptions::default())?.to_bytes()?, max_dim)
            });
            println!("total_s={total_s} dims={}", betti?);
        }
        _ => return Err("no such task".into()),
    }
    Ok(())
}

fn near(file: &str, radius: &str) -> Result<Graph, Box<dyn Error>> {
    let (points, _) = read_points_path(file, &SpaceOptions::default())?;
    Ok(radius_graph(&points, Metric::Euclidean, radius.parse()?, &RadiusOptions::default())?)
}

fn flag(graph: &Graph, max_dim: &str) -> Result<FrozenTree, Box<dyn Error>> {
    Ok(expand(graph, &FlagOptions { max_dim: max_dim.parse()?, ..FlagOptions::default() })?)
}

fn encoded(built: &Built) -> Result<AlignedBytes, Box<dyn Error>> {
    Ok(Encoding::new(built, &EncodeOptions::default())?.to_bytes()?)
}

fn complex_in(bytes: &[u8]) -> Result<AnyComplex<'_>, Box<dyn Error>> {
    match View::from_bytes(bytes)? {
        View::Complex(complex) => Ok(complex),
        View::Tree(_) => Err("a tree, not a SIG".into()),
    }
}

fn num_simplices(complex: &impl Relations) -> Vec<usize> {
    (0..=complex.dim().unwrap_or(0)).map(|dim| complex.num_simplices_of_dim(dim)).collect()
}

/// The Betti numbers below a dimension, as a list.
fn betti(bytes: &[u8], max_dim: &str) -> Result<String, Box<dyn Error>> {
    let below = max_dim.parse::<usize>()? - 1;
    let options = HomologyOptions { over: Coefficients::Prime(2), max_dim: Some(below), ..Default::default() };
    let found = with_view!(View::from_bytes(bytes)?, complex => homology(&homology::Simplices(&complex), &options))?;
    Ok(listed(&found.betti))
}

/// Asks each query of random simplices of each dimension, and prints the microseconds that one takes.
fn query(complex: &impl Relations) {
    println!("dims={}", listed(&num_simplices(complex)));
    let mut memory = OwnedScratch::new(complex);
    let mut scratch = memory.scratch();
    for dim in 0..=complex.dim().unwrap_or(0) {
        let mut random = SplitMix64::new(7 + dim as u64);
        let (first, _) = complex.simplices_of_dim(dim).bounds();
        let count = complex.num_simplices_of_dim(dim);
        let simplices: Vec<_> = (0..SAMPLE).map(|_| SimplexId::new(first.index() + random.next_below(count))).collect();
        let words: Vec<Vec<VertexId>> = simplices.iter().map(|&simplex| complex.vertices(simplex).collect()).collect();
        let measure = |name: &str, query: &mut dyn FnMut(usize) -> usize| {
            let (seconds, total) = timed(|| (0..SAMPLE).map(query).sum::<usize>());
            black_box(total);
            println!("{name}{dim}={}", seconds / SAMPLE as f64 * 1e6);
        };
        measure("find", &mut |number| complex.find(&words[number]).map_or(0, SimplexId::index));
        measure("facets", &mut |number| complex.facets(simplices[number]).map(SimplexId::index).sum());
        measure("cofaces1", &mut |number| sum(complex.coboundary(simplices[number], dim + 1, &mut scratch)));
        measure("star", &mut |number| sum(complex.star(simplices[number], &mut scratch)));
    }
}
