//! What a mesh costs: building its SIG, its file, opening it, and the star of every vertex.
//!
//! ```text
//! cargo bench --bench mesh                         all of it, on grids of triangles, of tetrahedra, and mixed ones
//! cargo bench --bench mesh -- 2d:10 3d:100 mixed:1 on a grid of about so many million simplices
//! cargo bench --bench mesh -- skull.msh            on a mesh in a file
//! cargo bench --bench mesh -- --build 3d:100       building alone
//! GUDHI_MESH=./gudhi_mesh cargo bench --bench mesh with GUDHI's simplex tree in the same run (see benches/peers)
//! ```
//!
//! Grids are Freudenthal's (Kuhn's); mixed ones are of tetrahedra, with a fin, a triangle that hangs on an edge, a triangle
//! that hangs on a vertex and a wire edge on every fourth vertex each. The peer builds grids of tetrahedra.
//!
//! First touch: memory that is new to a process costs the system's time for each page, and the result is such memory. It is
//! measured apart, by writing to each page of an allocation of the size of the result, on all threads.
//!
//! Machines are noisy, so whatever is compared is measured in turn, several rounds, and the medians are printed with
//! their spread. Read the ratios.

use std::convert::Infallible;
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;

use common::{Timing, figure, peak_memory, run, timed, write_tetrahedra};
use rayon::prelude::*;
use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, with_complex};
use sig_tools::build::{BuildOptions, Built, build};
use sig_tools::generate::Triangulation;
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Mapped, OwnedScratch};

mod common;

const ROUNDS: usize = 5;
/// The most simplices, about, that are built as many times; more are built once.
const MANY: f64 = 3e7;
/// Bytes of a page of memory.
const PAGE: usize = 4096;
/// What is measured if nothing is asked for.
const MESHES: [&str; 9] = ["2d:1", "2d:10", "2d:100", "3d:1", "3d:10", "3d:100", "mixed:1", "mixed:10", "mixed:100"];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = common::arguments();
    if let [mode, mesh] = arguments.as_slice()
        && mode == "--peak"
    {
        return peak(mesh);
    }
    let (modes, mut meshes): (Vec<String>, _) = arguments.into_iter().partition(|argument| argument == "--build");
    if meshes.is_empty() {
        meshes = MESHES.map(str::to_owned).to_vec();
    }
    println!("medians of {ROUNDS} rounds (least, most); threads: {}", rayon::current_num_threads());
    let folder = tempfile::tempdir()?;
    let mut opened = Vec::new();
    for (number, mesh) in meshes.iter().enumerate() {
        println!("\n{mesh}");
        let built = building(&soup_of(mesh)?, folder.path())?;
        if !modes.is_empty() {
            continue;
        }
        let path = folder.path().join(format!("{number}.sigc"));
        filed(&built, &path)?;
        drop(built);
        peak_of_child(mesh)?;
        opened.push((path.clone(), opening(&path)?));
        let map = Mapped::open(&path)?;
        with_complex!(map.complex()?, complex => stars(&complex)?);
    }
    if opened.is_empty() {
        return Ok(());
    }
    println!("\nopening, alternating between the files:");
    for (path, _) in &opened {
        let samples: Result<Vec<f64>, _> = (0..200).map(|_| opening(path)).collect();
        let megabytes = std::fs::metadata(path)?.len() as f64 / 1e6;
        println!("  {megabytes:9.2} MB  {}", Timing::of(samples?).show(1e6, "µs"));
    }
    Ok(())
}

/// The grid of a kind and of so many million simplices, or the mesh in a file.
fn soup_of(mesh: &str) -> Result<Soup, Box<dyn Error>> {
    let grid = mesh.split_once(':').and_then(|(kind, millions)| Some((kind, millions.parse::<f64>().ok()?)));
    let Some((kind, millions)) = grid else {
        return Ok(sig_tools::io::read_path(mesh, &sig_tools::io::ReadOptions::default())?.0);
    };
    // Simplices a vertex.
    let (dim, ratio) = match kind {
        "2d" => (2, 6.0),
        "3d" => (3, 26.0),
        "mixed" => (3, 29.0),
        _ => return Err(format!("{kind}: 2d, 3d or mixed").into()),
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a side of a few thousand vertices")]
    let side = (millions * 1e6 / ratio).powf(1.0 / f64::from(dim)).round() as u32;
    let sides = vec![side.max(2); dim as usize];
    let grid = Triangulation::grid(&sides)?;
    let mut soup = Soup::new(Labels::Numbered(grid.num_vertices() as usize), true);
    grid.try_for_each(|simplex| {
        soup.push(simplex);
        Ok::<(), Infallible>(())
    })?;
    if kind == "mixed" {
        hang(&mut soup, grid.num_vertices());
    }
    Ok(soup)
}

/// Hangs triangles and edges on the `count` vertices of a grid.
fn hang(soup: &mut Soup, count: u32) {
    let mut next = count;
    for vertex in 0..count - 1 {
        match vertex % 4 {
            0 => soup.push(&[vertex, next, next + 1]),
            1 => soup.push(&[vertex, vertex + 1, next]),
            2 => soup.push(&[vertex, next]),
            _ => {}
        }
        next += [2, 1, 1, 0][vertex as usize % 4];
    }
    soup.labels = Labels::Numbered(next as usize);
}

/// Builds, on all threads and on one, and lets the peer do the same complex in turn; then to the bytes of a file.
fn building(soup: &Soup, folder: &Path) -> Result<Built, Box<dyn Error>> {
    let only_tetrahedra = soup.simplices.iter().rposition(|flat| !flat.is_empty()) == Some(3)
        && soup.simplices[..3].iter().all(Vec::is_empty);
    let peer = std::env::var_os("GUDHI_MESH").filter(|_| only_tetrahedra);
    let tetrahedra = folder.join("tetrahedra");
    if peer.is_some() {
        write_tetrahedra(soup, &tetrahedra)?;
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let (mut all, mut single, mut peers) = (Vec::new(), Vec::new(), Vec::new());
    let (mut encoded, mut touched, mut copied) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = None;
    let num_listed = soup.num_listed();
    for _ in 0..ROUNDS {
        drop(last.take());
        let input = soup.clone();
        let (seconds, built) = timed(|| build(input, &BuildOptions::default()));
        let built = built?;
        let count = num_simplices(&built);
        all.push(seconds / count);
        let bytes = {
            let (seconds, bytes) = timed(|| Encoding::new(&built, &EncodeOptions::default())?.to_bytes());
            encoded.push(seconds / count);
            bytes?
        };
        let mut room = vec![0_u8; bytes.len()];
        touched.push(timed(|| room.par_chunks_mut(PAGE).for_each(|page| page[0] = 1)).0 / count);
        copied.push(timed(|| room.copy_from_slice(&bytes)).0 / count);
        drop((black_box(room), bytes));
        last = Some(built);
        if count > MANY {
            break;
        }
        let input = soup.clone();
        let (seconds, built) = timed(|| one.install(|| build(input, &BuildOptions::default())));
        single.push(seconds / num_simplices(&built?));
        if let Some(program) = &peer {
            peers.push(run_peer(program.as_ref(), &tetrahedra)?);
        }
    }
    let built = last.ok_or("no round was run")?;
    let all = Timing::of(all);
    println!("  building {:.0} simplices from {num_listed} listed, each:", num_simplices(&built));
    println!("    all threads   {}", all.show(1e9, "ns"));
    for (what, samples) in
        [("one thread", &single), ("first touch", &touched), ("copy", &copied), ("to bytes", &encoded)]
    {
        if !samples.is_empty() {
            println!("    {what:13} {}", Timing::of(samples.clone()).show(1e9, "ns"));
        }
    }
    if !peers.is_empty() {
        let (peers, single) = (Timing::of(peers), Timing::of(single));
        println!("    GUDHI         {}", peers.show(1e9, "ns"));
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
