//! The experiments of the simplex tree's paper (simplex-tree-2012, section 4) on data that anyone can have: its table of
//! complexes (Figure 8) and its charts (Figures 9 to 11), with GUDHI on the same points in the same run.
//!
//! ```text
//! cargo bench --bench figures                      all of it: some minutes, and up to 8 GB with GUDHI
//! cargo bench --bench figures -- 9 10              the charts of two figures
//! GUDHI_BENCH=./gudhi_bench … SIG_DATA=folder …    with the peer (see benches/README.md), and with the data sets
//! ```
//!
//! Tables are printed in Markdown, charts are drawn into `benches/figures`. A data set that is not in `SIG_DATA` is named
//! and passed over. Numbers of simplices are compared with the peer's before any time is.

mod common;

use std::error::Error;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use common::{figure, run, timed};
use sig_tools::build::{BuildOptions, complete};
use sig_tools::chart::{Chart, Series};
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::frozen::FrozenTree;
use sig_tools::generate::{klein_bottle_grid, sphere4};
use sig_tools::io::space::SpaceOptions;
use sig_tools::points::{Metric, Points};
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::witness::{Landmarks, Relaxation, WitnessOptions, witness_complex};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let wanted = common::arguments();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|argument| argument == name);
    let bench = Bench::new()?;
    println!("threads: {}; seconds of one run each", rayon::current_num_threads());
    if is_wanted("8") {
        bench.table_of_rips()?;
        bench.table_of_witness()?;
    }
    if is_wanted("9") {
        bench.sizes_of_rips()?;
        bench.sizes_of_witness()?;
    }
    if is_wanted("10") {
        bench.growth_with_radius()?;
        bench.growth_with_dimension()?;
    }
    if is_wanted("11") {
        bench.growth_with_landmarks()?;
        bench.growth_with_witnesses()?;
        bench.growth_with_relaxation()?;
        bench.growth_of_relaxed_with_dimension()?;
    }
    Ok(())
}

/// Where the data, the peer and the charts are.
struct Bench {
    peer: Option<OsString>,
    data: Option<PathBuf>,
    charts: PathBuf,
    folder: tempfile::TempDir,
}

/// A flag complex that was expanded from points.
struct Expanded {
    edges: usize,
    graph_seconds: f64,
    seconds: f64,
    tree: FrozenTree,
}

/// What the peer says of the same complex.
struct Peer {
    graph_seconds: f64,
    seconds: f64,
    bytes: f64,
}

/// What is known of one complex of a series.
struct Row {
    x: f64,
    edges: usize,
    simplices: usize,
    maximal: Option<usize>,
    seconds: f64,
    peer: Option<f64>,
}

impl Bench {
    fn new() -> Result<Self> {
        let charts = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/figures");
        std::fs::create_dir_all(&charts)?;
        let data = std::env::var_os("SIG_DATA").map(PathBuf::from);
        Ok(Self { peer: std::env::var_os("GUDHI_BENCH"), data, charts, folder: tempfile::tempdir()? })
    }

    /// The points of a file among the data, or a word on its absence.
    fn load(&self, name: &str) -> Result<Option<Points>> {
        let path = self.data.as_ref().map(|folder| folder.join(name));
        let Some(path) = path.filter(|path| path.exists()) else {
            println!("SKIPPED: {name} is not there (SIG_DATA names the folder)");
            return Ok(None);
        };
        Ok(Some(sig_tools::io::space::read_points_path(&path, &SpaceOptions::default())?.0))
    }

    fn expand(&self, points: &Points, radius: f64, max_dim: usize) -> Result<Expanded> {
        let (graph_seconds, graph) =
            timed(|| radius_graph(points, Metric::Euclidean, radius, &RadiusOptions::default()));
        let graph = graph?;
        let (seconds, tree) = timed(|| expand(&graph, &FlagOptions { max_dim, ..FlagOptions::default() }));
        Ok(Expanded { edges: graph.num_edges(), graph_seconds, seconds, tree: tree? })
    }

    /// Runs the peer on the same points; `None` if there is none.
    fn run_peer(&self, points: &Points, arguments: &dyn Fn(&OsStr) -> Vec<OsString>) -> Result<Option<String>> {
        let Some(program) = &self.peer else { return Ok(None) };
        let path = self.folder.path().join("points");
        common::write_points(points, &path)?;
        let arguments = arguments(path.as_os_str());
        let arguments: Vec<&OsStr> = arguments.iter().map(OsString::as_os_str).collect();
        Ok(Some(run(program, &arguments)?))
    }

    fn peer_rips(&self, points: &Points, radius: f64, max_dim: usize, simplices: usize) -> Result<Option<Peer>> {
        let arguments = |path: &OsStr| {
            let numbers = [radius.to_string(), max_dim.to_string()].map(OsString::from);
            ["rips", "min"].map(OsString::from).into_iter().chain([path.to_owned()]).chain(numbers).collect()
        };
        let Some(text) = self.run_peer(points, &arguments)? else { return Ok(None) };
        same_size(figure(&text, "|K|=")?, simplices)?;
        let bytes = figure(&text, "heap_B/simplex=")?;
        let graph_seconds = figure(&text, "graph_s=")?;
        Ok(Some(Peer { graph_seconds, seconds: figure(&text, "expansion_s=")?, bytes }))
    }

    /// Seconds of the peer for a witness complex whose landmarks are the first of the points.
    fn peer_witness(
        &self,
        points: &Points,
        landmarks: usize,
        squared: f64,
        max_dim: usize,
        simplices: usize,
    ) -> Result<Option<f64>> {
        let arguments = |path: &OsStr| {
            let numbers = [landmarks.to_string(), squared.to_string(), max_dim.to_string()].map(OsString::from);
            let mode = OsString::from("e");
            [OsString::from("wit"), path.to_owned()].into_iter().chain(numbers).chain([mode]).collect()
        };
        let Some(text) = self.run_peer(points, &arguments)? else { return Ok(None) };
        same_size(figure(&text, "|K|=")?, simplices)?;
        Ok(Some(figure(&text, " s=")? + figure(&text, "ctor_s=")?))
    }

    /// Figure 8, top: large Rips complexes, written and mapped; beside the paper's own figures.
    fn table_of_rips(&self) -> Result<()> {
        println!(
            "\n| data | points | r | k | edges | simplices | graph s | expansion s | ns | B | GUDHI graph s | \
                  expansion s | ns | B | paper's simplices | graph s | s |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
        let bud = self.load("buddha_49950.obj.gz")?;
        let bro = self.load("natural_patches_15000x25.npy")?;
        let cy8 = self.load("cyclo_octane_6040x24.npy")?;
        let rows = [
            ("Bud, another sample", bud, 0.036, 3, "354,695,000 | 1.5 | 104.5"),
            ("Bro", bro, 0.019, 25, "116,743,000 | 0.6 | 36.5"),
            ("Cy8", cy8, 0.4, 24, "13,379,500 | 0.11 | 4.5"),
            ("Kl", Some(klein_bottle_grid(300)), 0.075, 5, "233,557,000 | 0.46 | 68.1"),
            ("S4", Some(sphere4(50_000, 1)), 0.253, 5, "none"),
            ("S4", Some(sphere4(50_000, 1)), 0.28, 5, "275,126,000 | 2.2 | 95.1"),
        ];
        for (name, points, radius, max_dim, paper) in rows {
            let Some(points) = points else { continue };
            let Expanded { edges, graph_seconds, seconds, tree } = self.expand(&points, radius, max_dim)?;
            let simplices = tree.num_simplices;
            let bytes = self.written_and_mapped(&tree)?;
            drop(tree);
            let peer = match self.peer_rips(&points, radius, max_dim, simplices)? {
                Some(Peer { graph_seconds, seconds, bytes }) => {
                    format!("{graph_seconds:.2} | {seconds:.2} | {:.1} | {bytes:.1}", nanoseconds(seconds, simplices))
                }
                None => "| | | ".to_owned(),
            };
            println!(
                "| {name} | {} | {radius} | {max_dim} | {edges} | {simplices} | {graph_seconds:.3} | {seconds:.3} | \
                 {:.1} | {:.2} | {peer} | {paper} |",
                points.len(),
                nanoseconds(seconds, simplices),
                bytes as f64 / simplices as f64,
            );
        }
        Ok(())
    }

    /// Writes the tree, maps the file and compares it; the bytes of the file.
    fn written_and_mapped(&self, tree: &FrozenTree) -> Result<u64> {
        let path = self.folder.path().join("tree.sigc");
        let encoding = Encoding::of_tree(tree, &EncodeOptions { checksums: false, ..EncodeOptions::default() })?;
        encoding.write_to(&mut std::fs::File::create(&path)?)?;
        let map = sig_tools::Mapped::open(&path)?;
        let counts: Vec<usize> = sig_tools::with_view!(map.view(), view => {
            (0..tree.first.len()).map(|dim| view.num_simplices_of_dim(dim)).collect()
        });
        if counts != tree.counts() {
            return Err("the mapped file is another complex".into());
        }
        Ok(std::fs::metadata(&path)?.len())
    }

    /// Figure 8, bottom: relaxed witness complexes; landmarks are spread evenly over the witnesses.
    fn table_of_witness(&self) -> Result<()> {
        println!("\n| data | landmarks | witnesses | ρ | k | simplices | dimension | s | µs | paper's simplices | s |");
        println!("|---|---|---|---|---|---|---|---|---|---|---|");
        let bro = self.load("natural_patches_15000x25.npy")?;
        let cy8 = self.load("cyclo_octane_6040x24.npy")?;
        let rows = [
            ("Bro", bro, 3_000, 0.01, 25, "2,589,860 | 117.5"),
            ("Cy8", cy8, 800, 0.23, 24, "997,344 | 161.2"),
            ("Kl", Some(klein_bottle_grid(300)), 10_000, 0.11, 5, "109,094,000 | 574.2"),
            ("S4", Some(sphere4(200_000, 1)), 50_000, 0.06, 5, "163,455,000 | 321.8"),
        ];
        for (name, points, landmarks, relaxation, max_dim, paper) in rows {
            let Some(points) = points else { continue };
            let step = points.len() / landmarks;
            let chosen: Vec<usize> = (0..landmarks).map(|number| step * number).collect();
            let chosen = Landmarks::chosen(&points, &chosen)?;
            let relaxation = Relaxation::Distance(relaxation);
            let options = WitnessOptions { relaxation, max_dim, ..WitnessOptions::default() };
            let (seconds, complex) = timed(|| witness_complex(&points, &chosen, &options));
            let tree = complex?.tree;
            println!(
                "| {name} | {landmarks} | {} | {} | {max_dim} | {} | {} | {seconds:.2} | {:.2} | {paper} |",
                points.len(),
                relaxation.amount(),
                tree.num_simplices,
                tree.dim().unwrap_or(0),
                nanoseconds(seconds, tree.num_simplices) / 1e3,
            );
        }
        Ok(())
    }

    /// Figure 9, left.
    fn sizes_of_rips(&self) -> Result<()> {
        let points = sphere4(10_000, 1);
        let mut rows = Vec::new();
        for radius in [0.2, 0.24, 0.28, 0.32, 0.36, 0.4] {
            let Expanded { edges, seconds, tree, .. } = self.expand(&points, radius, 5)?;
            let simplices = tree.num_simplices;
            let peer = self.peer_rips(&points, radius, 5, simplices)?.map(|peer| peer.seconds);
            rows.push(Row { x: radius, edges, simplices, maximal: Some(maximal(tree)?), seconds, peer });
        }
        self.draw("figure-9-rips", "Rips complexes of 10,000 points of S4, k = 5", "r", &rows)
    }

    /// Figure 9, right.
    fn sizes_of_witness(&self) -> Result<()> {
        let points = sphere4(10_000, 1);
        let rows = self.relaxed(&points, &[(2_000, 0.0), (2_000, 0.02), (2_000, 0.04), (2_000, 0.06)], 5, true)?;
        let title = "Relaxed witness complexes, 2,000 landmarks among 10,000 points of S4, k = 5";
        self.draw("figure-9-witness", title, "α² (relaxation on squared distances)", &rows)
    }

    /// Figure 10, left.
    fn growth_with_radius(&self) -> Result<()> {
        let Some(points) = self.load("buddha_49950.obj.gz")? else { return Ok(()) };
        let sample: Vec<usize> = (0..7023).map(|number| number * points.len() / 7023).collect();
        let points = points.select(&sample);
        let mut rows = Vec::new();
        for radius in [0.02, 0.03, 0.04, 0.05, 0.06, 0.07] {
            rows.push(self.rips_row(&points, radius, 3, radius)?);
        }
        self.draw("figure-10-radius", "Rips complexes of 7,023 points of Bud, k = 3", "r", &rows)
    }

    /// Figure 10, right.
    fn growth_with_dimension(&self) -> Result<()> {
        let Some(points) = self.load("cyclo_octane_6040x24.npy")? else { return Ok(()) };
        let rows: Result<Vec<Row>> =
            (1..=10).map(|max_dim| self.rips_row(&points, 0.31, max_dim, max_dim as f64)).collect();
        self.draw("figure-10-dimension", "Rips complexes of Cy8, r = 0.31", "k", &rows?)
    }

    fn rips_row(&self, points: &Points, radius: f64, max_dim: usize, x: f64) -> Result<Row> {
        let Expanded { edges, seconds, tree, .. } = self.expand(points, radius, max_dim)?;
        let simplices = tree.num_simplices;
        let peer = self.peer_rips(points, radius, max_dim, simplices)?.map(|peer| peer.seconds);
        Ok(Row { x, edges, simplices, maximal: None, seconds, peer })
    }

    /// Figure 11, top left.
    fn growth_with_landmarks(&self) -> Result<()> {
        let Some(points) = self.load("natural_patches_15000x25.npy")? else { return Ok(()) };
        let mut rows = Vec::new();
        for landmarks in [300, 600, 1_000, 2_000, 3_000, 5_000] {
            rows.push(Row { x: landmarks as f64, ..self.witness_row(&points, landmarks, 0.0, 25, false)? });
        }
        self.draw("figure-11-landmarks", "Witness complexes of Bro, 15,000 witnesses", "landmarks", &rows)
    }

    /// Figure 11, top right.
    fn growth_with_witnesses(&self) -> Result<()> {
        let mut rows = Vec::new();
        for side in [100, 150, 200, 250, 300] {
            let grid = klein_bottle_grid(side);
            // The landmarks come first, spread over the grid.
            let landmarks = (0..900).map(|number| number * grid.len() / 900);
            let order: Vec<usize> = landmarks.chain(0..grid.len()).collect();
            let points = grid.select(&order);
            rows.push(Row { x: points.len() as f64, ..self.witness_row(&points, 900, 0.0, 5, false)? });
        }
        self.draw("figure-11-witnesses", "Witness complexes of Kl, 900 landmarks", "witnesses", &rows)
    }

    /// Figure 11, bottom left.
    fn growth_with_relaxation(&self) -> Result<()> {
        let Some(points) = self.load("natural_patches_15000x25.npy")? else { return Ok(()) };
        let steps: Vec<(usize, f64)> = [0.0, 0.0005, 0.001, 0.0015, 0.002].map(|squared| (1_000, squared)).to_vec();
        let rows = self.relaxed(&points, &steps, 5, false)?;
        let title = "Relaxed witness complexes of Bro, 1,000 landmarks, k = 5";
        self.draw("figure-11-relaxation", title, "α² (relaxation on squared distances)", &rows)
    }

    /// Figure 11, bottom right.
    fn growth_of_relaxed_with_dimension(&self) -> Result<()> {
        let points = klein_bottle_grid(300);
        let mut rows = Vec::new();
        for max_dim in 1..=5 {
            let row = self.witness_row(&points, 10_000, 0.01, max_dim, false)?;
            rows.push(Row { x: max_dim as f64, ..row });
        }
        self.draw("figure-11-dimension", "Relaxed witness complexes of Kl, 10,000 landmarks, α² = 0.01", "k", &rows)
    }

    /// Relaxed witness complexes for each number of landmarks with its relaxation.
    fn relaxed(&self, points: &Points, steps: &[(usize, f64)], max_dim: usize, with_maximal: bool) -> Result<Vec<Row>> {
        steps
            .iter()
            .map(|&(landmarks, squared)| {
                let row = self.witness_row(points, landmarks, squared, max_dim, with_maximal)?;
                Ok(Row { x: squared, ..row })
            })
            .collect()
    }

    /// A witness complex of which the landmarks are the first points.
    fn witness_row(
        &self,
        points: &Points,
        landmarks: usize,
        squared: f64,
        max_dim: usize,
        with_maximal: bool,
    ) -> Result<Row> {
        let chosen = Landmarks::chosen(points, &(0..landmarks).collect::<Vec<_>>())?;
        let relaxation = Relaxation::Squared(squared);
        let options = WitnessOptions { relaxation, max_dim, ..WitnessOptions::default() };
        let (seconds, complex) = timed(|| witness_complex(points, &chosen, &options));
        let tree = complex?.tree;
        let simplices = tree.num_simplices;
        let peer = self.peer_witness(points, landmarks, squared, max_dim, simplices)?;
        let edges = tree.ids(1).len();
        let maximal = if with_maximal { Some(maximal(tree)?) } else { None };
        Ok(Row { x: 0.0, edges, simplices, maximal, seconds, peer })
    }

    /// Prints the rows of a series and draws two charts: sizes and times.
    fn draw(&self, name: &str, title: &str, x: &str, rows: &[Row]) -> Result<()> {
        println!("\n{title}\n\n| {x} | edges | maximal | simplices | s | GUDHI s | GUDHI / SIG | ns a simplex |");
        println!("|---|---|---|---|---|---|---|---|");
        for Row { x, edges, simplices, maximal, seconds, peer } in rows {
            let maximal = maximal.map_or(String::new(), |maximal| maximal.to_string());
            let ratio = peer.map_or(String::new(), |peer| format!("{:.1}", peer / seconds));
            let peer = peer.map_or(String::new(), |peer| format!("{peer:.3}"));
            let each = nanoseconds(*seconds, *simplices);
            println!("| {x} | {edges} | {maximal} | {simplices} | {seconds:.4} | {peer} | {ratio} | {each:.1} |");
        }
        let of = |name: &str, value: &dyn Fn(&Row) -> Option<f64>| {
            let points = rows.iter().filter_map(|row| Some((row.x, value(row)?))).collect();
            Series { name: name.to_owned(), points }
        };
        let sizes = [
            of("simplices", &|row| Some(row.simplices as f64)),
            of("maximal simplices", &|row| row.maximal.map(|count| count as f64)),
            of("edges", &|row| Some(row.edges as f64)),
        ];
        let times = [of("this project", &|row| Some(row.seconds)), of("GUDHI", &|row| row.peer)];
        for (what, y, series) in [("size", "number", &sizes[..]), ("time", "seconds", &times[..])] {
            let path = self.charts.join(format!("{name}-{what}.svg"));
            Chart { title, x, y, log_x: false, series }.draw(&path)?;
        }
        Ok(())
    }
}

fn same_size(peers: f64, ours: usize) -> Result<()> {
    if peers == ours as f64 { Ok(()) } else { Err(format!("the peer has {peers} simplices, we have {ours}").into()) }
}

/// The number of maximal simplices.
fn maximal(tree: FrozenTree) -> Result<usize> {
    let built = complete(tree, &BuildOptions::default())?;
    Ok(built.report.top_simplices.iter().sum())
}

fn nanoseconds(seconds: f64, simplices: usize) -> f64 {
    seconds * 1e9 / simplices as f64
}
