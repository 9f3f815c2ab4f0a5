//! The paper's comparisons (sig-2004, 7) on real meshes: integers of each structure in multiples of n_0, bytes, times.
//!
//! ```text
//! SIG_DATA=DIR cargo bench --bench compare              the meshes that are in DIR
//! cargo bench --bench compare -- a.off b.msh.gz         other meshes
//! ```
//!
//! Tables are printed in Markdown. Beside what `sig build` reads, files `*.tops.gz` (the numbers of vertices and simplices,
//! the vertices, and lines with the number of vertices and the vertices of each simplex) and, by the program `xz`,
//! `*.tetbin.xz` ("TETB", the numbers of vertices and tetrahedra, coordinates as f32, vertices as u32) are read.

use std::error::Error;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

use sig_core::with_complex;
use sig_tools::Loaded;
use sig_tools::baselines::Tops;
use sig_tools::build::{BuildOptions, build};
use sig_tools::compare::{CompareOptions, Comparison, Relation, Row, compare};
use sig_tools::io::{ReadOptions, read_path};
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};
use sig_tools::store::{EncodeOptions, Encoding};

mod common;

/// Surfaces, tetrahedral meshes, and complexes that are no manifolds.
const MESHES: [&str; 11] = [
    "vaselion.off.gz",
    "lucy_50k.ply.gz",
    "turbineblade.ply.gz",
    "dragon_vrip.ply.gz",
    "buddha_49950.obj.gz",
    "monkey.msh.gz",
    "gargoyle.msh.gz",
    "armadillo_tet.tetbin.xz",
    "lucy_tet.tetbin.xz",
    "gmsh_mixed_bracket_h0.15.msh.gz",
    "alpha_bunny_q40.tops.gz",
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut paths: Vec<PathBuf> = common::arguments().into_iter().map(PathBuf::from).collect();
    if paths.is_empty() {
        let folder = std::env::var_os("SIG_DATA").ok_or("set SIG_DATA to the folder of the meshes, or name some")?;
        paths = MESHES.iter().map(|name| Path::new(&folder).join(name)).collect();
    }
    let mut compared = Vec::new();
    for path in paths.iter().filter(|path| path.exists()) {
        let built = build(soup(path)?, &BuildOptions::default())?;
        let bytes = Encoding::new(&built, &EncodeOptions::default())?.to_bytes()?;
        drop(built);
        let file = Loaded::from_file_bytes(bytes)?;
        let tops = with_complex!(file.complex()?, complex => Tops::of(&complex));
        drop(file);
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        compared.push((name, compare(&tops, CompareOptions::default())?));
    }
    let names: Vec<&str> = sig_tools::compare::STRUCTURES.iter().map(|entry| entry.name).collect();
    println!("Integers, in multiples of n_0:\n");
    println!("| mesh | n_0 | n_1 | n_2 | n_3 | {} |", names.join(" | "));
    println!("|---|{}", "---|".repeat(names.len() + 4));
    for (name, comparison) in &compared {
        let n0 = comparison.simplices[0] as f64;
        let multiple = |count: usize| format!("{:.2}", count as f64 / n0);
        let f = (1..4).map(|p| comparison.simplices.get(p).map_or_else(String::new, |&count| multiple(count)));
        let cells = comparison.structures.iter().map(|row| row.integers.map_or_else(|| "—".to_owned(), multiple));
        println!("| {name} | {} | {} |", comparison.simplices[0], f.chain(cells).collect::<Vec<_>>().join(" | "));
    }
    println!("\nBytes over those of the SIG, and seconds to build from the top simplices:\n");
    println!("| mesh | {} | {} |", names.join(" | "), names.join(", s | ") + ", s");
    println!("|---|{}", "---|".repeat(2 * names.len()));
    for (name, comparison) in &compared {
        let ratios = cells(comparison, |row| row.ratio.map(|ratio| format!("{ratio:.2}")));
        let seconds = cells(comparison, |row| row.build_seconds.map(|seconds| format!("{seconds:.3}")));
        println!("| {name} | {ratios} | {seconds} |");
    }
    println!("\nMean microseconds of a relation:\n");
    println!("| mesh | relation | answers | {} |", names.join(" | "));
    println!("|---|---|{}", "---|".repeat(names.len() + 1));
    for (name, comparison) in &compared {
        times(name, comparison);
    }
    for (name, comparison) in &compared {
        for violation in &comparison.conjecture_violations {
            println!("\n{name}: the conjecture of 7.1 fails: {violation:?}");
        }
    }
    Ok(())
}

fn cells(comparison: &Comparison, cell: impl Fn(&Row) -> Option<String>) -> String {
    let cells = comparison.structures.iter().map(|row| cell(row).unwrap_or_else(|| "—".to_owned()));
    cells.collect::<Vec<_>>().join(" | ")
}

/// The relations that the paper speaks of.
fn times(name: &str, comparison: &Comparison) {
    let top = comparison.simplices.len().saturating_sub(1);
    let relations = [
        Relation::Boundary(top, 0),
        Relation::Coboundary(0, 1),
        Relation::Coboundary(0, top),
        Relation::Coboundary(top - 1, top),
        Relation::Adjacency(0),
        Relation::Adjacency(top),
        Relation::Star(0),
        Relation::Link(0),
    ];
    for relation in relations {
        let timing = |row: &Row| row.relations.iter().find(|timing| timing.relation == relation).copied();
        let Some(found) = comparison.structures.first().and_then(timing).map(|timing| timing.found) else { continue };
        let means = cells(comparison, |row| timing(row).map(|timing| format!("{:.3}", timing.mean_seconds * 1e6)));
        println!("| {name} | {relation} | {found:.1} | {means} |");
    }
}

fn soup(path: &Path) -> Result<Soup, Box<dyn Error>> {
    let name = path.to_string_lossy();
    if name.ends_with(".tops.gz") {
        let mut text = String::new();
        flate2::read::GzDecoder::new(std::fs::File::open(path)?).read_to_string(&mut text)?;
        return tops(&text);
    }
    if name.ends_with(".tetbin.xz") {
        return tetrahedra(&Command::new("xz").arg("-dc").arg(path).output()?.stdout);
    }
    Ok(read_path(path, &ReadOptions { drop_degenerate: true, ..ReadOptions::default() })?.0)
}

fn tops(text: &str) -> Result<Soup, Box<dyn Error>> {
    let mut lines = text.lines();
    let head = lines.next().and_then(|line| line.split_whitespace().next()).ok_or("no head")?;
    let vertices: usize = head.parse()?;
    let mut values = Vec::new();
    for line in lines.by_ref().take(vertices) {
        values.extend(line.split_whitespace().map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()?);
    }
    let mut soup = Soup::new(Labels::Numbered(vertices), true);
    for line in lines {
        let numbers = line.split_whitespace().map(str::parse).collect::<Result<Vec<u32>, _>>()?;
        if let Some((_, word)) = numbers.split_first() {
            soup.push(word);
        }
    }
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F64(values) });
    Ok(soup)
}

fn tetrahedra(bytes: &[u8]) -> Result<Soup, Box<dyn Error>> {
    let words: Vec<[u8; 4]> = bytes.chunks_exact(4).filter_map(|word| word.try_into().ok()).collect();
    let [_, vertices, count, rest @ ..] = words.as_slice() else { return Err("no head".into()) };
    let (vertices, count) = (u32::from_le_bytes(*vertices) as usize, u32::from_le_bytes(*count) as usize);
    let (coordinates, corners) = rest.split_at_checked(3 * vertices).ok_or("too few coordinates")?;
    let mut soup = Soup::new(Labels::Numbered(vertices), true);
    soup.simplices =
        vec![Vec::new(), Vec::new(), Vec::new(), corners.iter().map(|&word| u32::from_le_bytes(word)).collect()];
    let values = coordinates.iter().map(|&word| f32::from_le_bytes(word)).collect();
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32(values) });
    if soup.simplices[3].len() == 4 * count { Ok(soup) } else { Err("too few tetrahedra".into()) }
}
