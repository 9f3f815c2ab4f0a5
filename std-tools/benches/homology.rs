//! What homology costs: Betti numbers over Z/2 of a flag complex and of a tetrahedral mesh, from their files, beside persistent
//! cohomology with all filtration values 0.
//!
//! ```text
//! cargo bench --bench homology                                the 4-sphere at radius 0.21, a Freudenthal grid
//! cargo bench --bench homology -- rips 50000 0.253 5          points, radius, largest dimension
//! cargo bench --bench homology -- mesh nefertiti.tetbin.xz    a tetrahedral mesh in a file
//! cargo bench --bench homology -- grid 56                     a grid of so many vertices a side
//! GUDHI_HOMOLOGY=./gudhi_homology cargo bench --bench homology    with GUDHI in the same run (see benches/peers)
//! ```
//!
//! Every measurement is a process of its own, for the sake of its peak of memory. The groups up to one dimension below that of
//! the complex are computed, as GUDHI does. Machines are noisy: whatever is compared is measured in turn. Read the ratios.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{Timing, figure, grid, listed, peak_memory, run, timed, write_points, write_tetrahedra};
use sig_tools::build::{BuildOptions, build};
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::generate::sphere4;
use sig_tools::homology::{Coefficients, HomologyOptions, Simplices, homology};
use sig_tools::io::{ReadOptions, read_path};
use sig_tools::points::Metric;
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::soup::Soup;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Mapped, with_view};

mod common;

const ROUNDS: usize = 3;

/// A complex in a file, and what the peer is to be called with.
struct Input {
    name: String,
    file: PathBuf,
    max_dim: usize,
    peer: Vec<String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let folder = tempfile::tempdir()?;
    match words[..] {
        ["alone", file, max_dim] => alone(Path::new(file), max_dim.parse()?),
        ["rips", count, radius, max_dim] => {
            measure(&rips(folder.path(), count.parse()?, radius.parse()?, max_dim.parse()?)?)
        }
        ["mesh", file] => {
            let (soup, _) = read_path(file, &ReadOptions::default())?;
            measure(&mesh(folder.path(), file, soup)?)
        }
        ["grid", side] => measure(&mesh(folder.path(), side, grid(side.parse()?))?),
        _ => {
            measure(&rips(folder.path(), 50_000, 0.21, 5)?)?;
            measure(&mesh(folder.path(), "56", grid(56))?)
        }
    }
}

fn rips(folder: &Path, count: usize, radius: f64, max_dim: usize) -> Result<Input, Box<dyn Error>> {
    let points = sphere4(count, 1);
    let graph = radius_graph(&points, Metric::Euclidean, radius, &RadiusOptions::default())?;
    let tree = expand(&graph, &FlagOptions { max_dim, ..FlagOptions::default() })?;
    let (file, theirs) = (folder.join("rips.sigc"), folder.join("points"));
    std::fs::write(&file, &*Encoding::of_tree(&tree, &EncodeOptions::default())?.to_bytes()?)?;
    write_points(&points, &theirs)?;
    let name = format!("{count} points of the 4-sphere, radius {radius}: {} simplices", tree.num_simplices);
    let peer = ["rips".to_owned(), theirs.display().to_string(), radius.to_string(), max_dim.to_string()];
    Ok(Input { name, file, max_dim: max_dim - 1, peer: peer.to_vec() })
}

fn mesh(folder: &Path, name: &str, soup: Soup) -> Result<Input, Box<dyn Error>> {
    let (file, theirs) = (folder.join("mesh.sigc"), folder.join("tetrahedra"));
    write_tetrahedra(&soup, &theirs)?;
    let built = build(soup, &BuildOptions::default())?;
    std::fs::write(&file, &*Encoding::new(&built, &EncodeOptions::default())?.to_bytes()?)?;
    let name = format!("mesh {name}");
    Ok(Input { name, file, max_dim: 2, peer: vec!["mesh".to_owned(), theirs.display().to_string()] })
}

/// Computes the homology of a file, in a process that does nothing else.
fn alone(file: &Path, max_dim: usize) -> Result<(), Box<dyn Error>> {
    let (seconds, found) = timed(|| -> Result<_, Box<dyn Error>> {
        let file = Mapped::open(file)?;
        let options = HomologyOptions { over: Coefficients::Prime(2), max_dim: Some(max_dim), ..Default::default() };
        Ok(with_view!(file.view(), complex => homology(&Simplices(&complex), &options))?)
    });
    let found = found?;
    let peak = peak_memory().unwrap_or(f64::NAN) / 1e6;
    let simplices: usize = found.counts.iter().sum();
    println!(
        "s={seconds:.3} peak_mb={peak:.1} simplices={simplices} critical={:?} betti={}",
        found.critical,
        listed(&found.betti)
    );
    Ok(())
}

/// The Betti numbers at the end of a line.
fn betti(text: &str) -> Vec<usize> {
    let numbers = text.split("betti=").nth(1).unwrap_or("");
    numbers.split_whitespace().filter_map(|number| number.parse().ok()).collect()
}

fn measure(input: &Input) -> Result<(), Box<dyn Error>> {
    println!("\n{}", input.name);
    let (mut all, mut single, mut theirs) = (Vec::new(), Vec::new(), Vec::new());
    let (mut ours, mut peer) = (String::new(), None);
    for _ in 0..ROUNDS {
        for (threads, samples) in [(None, &mut all), (Some("1"), &mut single)] {
            let mut command = Command::new(std::env::current_exe()?);
            command.args(["alone".as_ref(), input.file.as_os_str(), input.max_dim.to_string().as_ref()]);
            threads.map(|threads| command.env("RAYON_NUM_THREADS", threads));
            let output = command.output()?;
            if !output.status.success() {
                return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
            }
            ours = String::from_utf8(output.stdout)?;
            samples.push(figure(&ours, "s=")?);
        }
        if let Some(program) = std::env::var_os("GUDHI_HOMOLOGY") {
            let arguments: Vec<&std::ffi::OsStr> = input.peer.iter().map(AsRef::as_ref).collect();
            let text = run(&program, &arguments)?;
            theirs.push(figure(&text, "sort_s=")? + figure(&text, "cohomology_s=")?);
            peer = Some(text);
        }
    }
    print!("  {ours}");
    let simplices = figure(&ours, "simplices=")?;
    let peak = figure(&ours, "peak_mb=")?;
    let (all, single) = (Timing::of(all), Timing::of(single));
    println!("  all threads {}, one thread {}", all.show(1.0, "s"), single.show(1.0, "s"));
    println!(
        "  {:.0} ns and {:.1} bytes a simplex, the file among them",
        all.median * 1e9 / simplices,
        peak * 1e6 / simplices
    );
    if let Some(text) = peer {
        if betti(&text) != betti(&ours) {
            return Err(format!("the peer finds {text}").into());
        }
        let (theirs, their_peak) = (Timing::of(theirs), figure(&text, "peak_mb=")?);
        println!("  GUDHI: sort and cohomology {}, peak {their_peak:.0} MB with its tree", theirs.show(1.0, "s"));
        println!(
            "  GUDHI / all threads {:.1}, one thread {:.1}; memory {:.2} of GUDHI's",
            theirs.median / all.median,
            theirs.median / single.median,
            peak / their_peak
        );
    }
    Ok(())
}
