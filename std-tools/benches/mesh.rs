//! What a tetrahedral mesh costs: building its SIG, its file, opening it, and the star of every vertex.
//!
//! ```text
//! cargo bench --bench mesh                         all of it, on Freudenthal (Kuhn) grids of 26³, 56³, 121³ vertices
//! cargo bench --bench mesh -- 26 56                on grids of 26³ and 56³ vertices
//! cargo bench --bench mesh -- skull.msh            on a tetrahedral mesh in a file
//! GUDHI_MESH=./gudhi_mesh cargo bench --bench mesh with GUDHI's simplex tree in the same run (see benches/peers)
//! ```
//!
//! Machines are noisy, so whatever is compared is measured in turn, several rounds, and the medians are printed with
//! their spread. Read the ratios.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;

use common::{Timing, figure, grid, peak_memory, run, timed};
use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, with_complex};
use sig_tools::build::{BuildOptions, Built, build};
use sig_tools::soup::Soup;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Mapped, OwnedScratch};

mod common;

const ROUNDS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = common::arguments();
    if let [mode, mesh] = arguments.as_slice()
        && mode == "--peak"
    {
        return peak(mesh);
    }
    let meshes = if arguments.is_empty() { ["26", "56", "121"].map(str::to_owned).to_vec() } else { arguments };
    println!("medians of {ROUNDS} rounds (least, most); threads: {}", rayon::current_num_threads());
    let folder = tempfile::tempdir()?;
    let mut opened = Vec::new();
    for (number, mesh) in meshes.iter().enumerate() {
        println!("\n{mesh}");
        let built = building(&soup_of(mesh)?, folder.path())?;
        let path = folder.path().join(format!("{number}.sigc"));
        filed(&built, &path)?;
        drop(built);
        peak_of_child(mesh)?;
        opened.push((path.clone(), opening(&path)?));
        let map = Mapped::open(&path)?;
        with_complex!(map.complex()?, complex => stars(&complex)?);
    }
    println!("\nopening, alternating between the files:");
    for (path, _) in &opened {
        let samples: Result<Vec<f64>, _> = (0..200).map(|_| opening(path)).collect();
        let megabytes = std::fs::metadata(path)?.len() as f64 / 1e6;
        println!("  {megabytes:9.2} MB  {}", Timing::of(samples?).show(1e6, "µs"));
    }
    Ok(())
}

/// The grid of so many vertices a side, or the mesh in a file.
fn soup_of(mesh: &str) -> Result<Soup, Box<dyn Error>> {
    match mesh.parse() {
        Ok(side) => Ok(grid(side)),
        Err(_) => Ok(sig_tools::io::read_path(mesh, &sig_tools::io::ReadOptions::default())?.0),
    }
}

/// Builds, on all threads and on one, and lets the peer do the same complex in turn.
fn building(soup: &Soup, folder: &Path) -> Result<Built, Box<dyn Error>> {
    let tetrahedra = folder.join("tetrahedra");
    std::fs::write(&tetrahedra, bytemuck::cast_slice(soup.simplices.get(3).map_or(&[][..], Vec::as_slice)))?;
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let peer = std::env::var_os("GUDHI_MESH");
    let (mut all, mut single, mut peers) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = None;
    for _ in 0..ROUNDS {
        drop(last.take());
        let input = soup.clone();
        let (seconds, built) = timed(|| build(input, &BuildOptions::default()));
        let built = built?;
        all.push(seconds / num_simplices(&built));
        last = Some(built);
        let input = soup.clone();
        let (seconds, built) = timed(|| one.install(|| build(input, &BuildOptions::default())));
        single.push(seconds / num_simplices(&built?));
        if let Some(program) = &peer {
            peers.push(run_peer(program.as_ref(), &tetrahedra)?);
        }
    }
    let built = last.ok_or("no round was run")?;
    let (all, single) = (Timing::of(all), Timing::of(single));
    println!("  building {:.0} simplices from {} listed:", num_simplices(&built), soup.num_listed());
    println!("    all threads   {} a simplex", all.show(1e9, "ns"));
    println!("    one thread    {} a simplex", single.show(1e9, "ns"));
    if !peers.is_empty() {
        let peers = Timing::of(peers);
        println!("    GUDHI         {} a simplex", peers.show(1e9, "ns"));
        println!(
            "    GUDHI / SIG   {:.2} all threads, {:.2} one",
            peers.median / all.median,
            peers.median / single.median
        );
    }
    Ok(built)
}

fn num_simplices(built: &Built) -> f64 {
    let count = match &built.arrays {
        sig_tools::build::Arrays::Narrow(arrays) => arrays.num_simplices,
        sig_tools::build::Arrays::Wide(arrays) => arrays.num_simplices,
    };
    count as f64
}

/// Seconds a simplex that the peer takes to insert the same tetrahedra.
fn run_peer(program: &Path, tetrahedra: &Path) -> Result<f64, Box<dyn Error>> {
    let text = run(program.as_os_str(), &["lean".as_ref(), tetrahedra.as_os_str()])?;
    Ok(figure(&text, "s, ")? * 1e-9)
}

/// Writes the file and says what its bytes are.
fn filed(built: &Built, path: &Path) -> Result<(), Box<dyn Error>> {
    let encoding = Encoding::new(built, &EncodeOptions::default())?;
    let (seconds, written) = timed(|| encoding.write_to(&mut std::fs::File::create(path)?));
    written?;
    let map = Mapped::open(path)?;
    with_complex!(map.complex()?, complex => {
        let (file, paper) = (complex.file_storage(), complex.paper_storage().sig());
        let width = complex.container().header().width.bytes();
        println!("  file: {} bytes, written in {:.2} s", file.file_bytes, seconds);
        println!("    the paper's {} integers and {} bits take {} bytes at {} bits an integer",
            paper.integers, paper.bits, paper.integers * width + paper.bits.div_ceil(8), 8 * width);
        println!("    tree sections {} bytes, checksums {}, header and padding {}",
            file.tree_bytes, file.checksum_bytes, file.overhead_bytes);
    });
    Ok(())
}

/// Seconds to map a file, open the complex in it and count its vertices.
fn opening(path: &Path) -> Result<f64, Box<dyn Error>> {
    let (seconds, vertices) = timed(|| {
        let map = Mapped::open(path)?;
        Ok::<_, Box<dyn Error>>(with_complex!(map.complex()?, complex => complex.num_vertices()))
    });
    black_box(vertices?);
    Ok(seconds)
}

/// C_{0,d} of all vertices, beside one sequential pass over the arrays that it reads: the facets of the d-simplices, and
/// the pointers and lists.
fn stars<I: sig_core::Index>(complex: &Complex<'_, I>) -> Result<(), Box<dyn Error>> {
    let top = complex.dim().ok_or("an empty complex")?;
    let mut memory = OwnedScratch::new(complex);
    let mut scratch = memory.scratch();
    let (mut queries, mut passes) = (Vec::new(), Vec::new());
    let mut reported = 0;
    for _ in 0..ROUNDS {
        let (seconds, count) = timed(|| {
            complex
                .simplices_of_dim(0)
                .try_fold(0, |sum, vertex| complex.coboundary(vertex, top, &mut scratch).map(|tops| sum + tops.len()))
        });
        reported = count?;
        queries.push(seconds);
        passes.push(timed(|| black_box(sequential_pass(complex, top))).0);
    }
    let (queries, passes) = (Timing::of(queries), Timing::of(passes));
    println!("  C_0,{top} of all vertices: {reported} simplices reported");
    println!("    {} each", queries.show(1e9 / reported as f64, "ns"));
    println!(
        "    {:.1} times a sequential pass over the arrays it reads ({})",
        queries.median / passes.median,
        passes.show(1e3, "ms")
    );
    Ok(())
}

fn sequential_pass<I: sig_core::Index>(complex: &Complex<'_, I>, top: usize) -> u64 {
    let rows = complex.num_simplices_of_dim(top) * (top + 1);
    let words = |kind, last: usize| {
        let column = complex.container().section(kind).map(|section| section.column);
        let bytes = column.as_ref().map_or(&[][..], Column::as_bytes);
        let start = bytes.len().saturating_sub(last.saturating_mul(I::WIDTH.bytes()));
        bytes[start..]
            .chunks_exact(8)
            .fold(0u64, |sum, word| sum.wrapping_add(u64::from_ne_bytes(word.try_into().unwrap_or_default())))
    };
    words(SectionKind::Boundary, rows)
        .wrapping_add(words(SectionKind::Pointers, usize::MAX))
        .wrapping_add(words(SectionKind::Lists, usize::MAX))
}

/// Builds in a process of its own, which says how much memory it took at its peak.
fn peak_of_child(mesh: &str) -> Result<(), Box<dyn Error>> {
    let output = Command::new(std::env::current_exe()?).args(["--peak", mesh]).output()?;
    print!("{}", String::from_utf8(output.stdout)?);
    Ok(())
}

fn peak(mesh: &str) -> Result<(), Box<dyn Error>> {
    let built = build(soup_of(mesh)?, &BuildOptions::default())?;
    let bytes = Encoding::new(&built, &EncodeOptions::default())?.file_bytes()?;
    let peak = peak_memory().ok_or("the system does not tell")?;
    println!(
        "  peak memory of a build, input included: {:.0} MB, {:.2} times the file",
        peak / 1e6,
        peak / bytes as f64
    );
    Ok(())
}
