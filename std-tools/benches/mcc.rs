//! Multi-resolution complexes: the tables of section 7 of mcc-2012 on surfaces and tetrahedral meshes.
//!
//! ```text
//! SIG_DATA=DIR cargo bench --bench mcc            the files of DIR that are there, and grids of 17³, 26³, 47³ vertices
//! cargo bench --bench mcc -- 47 71                grids of 47³ and 71³ vertices alone
//! ```
//!
//! One row a data set, step by step and in batches, by the extent of the cells that go, operators of both types: the number of
//! simplifications and their time, the time to make the multi-resolution complex of them, its storage with the base and that of
//! the full complex (bytes, and bytes a cell), all refinements, and those that have a cell in a box of about a fifth of the
//! complex. Grids have a scalar field like the density of a hydrogen atom as well. The peak of memory is that of the process so
//! far. Single runs: read the ratios.

use std::error::Error;

use common::{grid, peak_memory, timed};
use sig_core::CellId;
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::CellComplex;
use sig_tools::io::{ReadOptions, read_path};
use sig_tools::mcc::{Criterion, Extent, Field, Front, SimplifyOptions, Strategy, simplify};
use sig_tools::soup::{Coordinates, Scalars, Soup};

mod common;

/// Files of the data, by dimension.
const FILES: [&str; 7] = [
    "vaselion.off.gz",
    "lucy_50k.ply.gz",
    "turbineblade.ply.gz",
    "dragon_vrip.ply.gz",
    "monkey.msh.gz",
    "gargoyle.msh.gz",
    "gmsh_mixed_bracket_h0.15.msh.gz",
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<u32> = common::arguments().iter().map(|side| side.parse()).collect::<Result<_, _>>()?;
    println!("threads: {}", rayon::current_num_threads());
    println!(
        "{:<28} {:>9} {:>9} {:>7} {:>8} {:>6} {:>11} {:>11} {:>6} {:>8} {:>7} {:>8} {:>8} {:>6} {:>6}",
        "data, strategy",
        "cells",
        "simpl.",
        "time s",
        "a second",
        "MCC s",
        "MCC+base",
        "full",
        "base",
        "ref. s",
        "a second",
        "box num.",
        "box s",
        "deps",
        "GB"
    );
    if arguments.is_empty()
        && let Some(data) = std::env::var_os("SIG_DATA")
    {
        for file in FILES {
            let path = std::path::Path::new(&data).join(file);
            if path.exists() {
                let (soup, _) = read_path(&path, &ReadOptions::default())?;
                measure(file.split('.').next().unwrap_or(file), soup, false)?;
            }
        }
    }
    for side in if arguments.is_empty() { vec![17, 26, 47] } else { arguments } {
        let mut soup = grid(side);
        let values: Vec<f32> =
            (0..side.pow(3)).flat_map(|at| [at % side, at / side % side, at / side / side]).map(|v| v as f32).collect();
        soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32(values) });
        measure(&format!("grid {side}"), soup, true)?;
    }
    Ok(())
}

fn measure(name: &str, soup: Soup, has_field: bool) -> Result<(), Box<dyn Error>> {
    let built = build(soup, &BuildOptions::default())?;
    let complex = CellComplex::from_built(&built)?;
    let coordinates = built.coordinates.ok_or("no coordinates")?;
    for (strategy, how) in [(Strategy::Step, "step"), (Strategy::Batch, "batch")] {
        row(&format!("{name} {how}"), &complex, &coordinates, &mut Extent::new(&complex, &coordinates), strategy)?;
    }
    if has_field {
        let field: Vec<f32> = density(&coordinates);
        row(&format!("{name} field step"), &complex, &coordinates, &mut Field::new(&complex, &field), Strategy::Step)?;
    }
    Ok(())
}

/// |ψ|² of the 3d_z² orbital around the middle of the points, at a scale by which it fills them.
fn density(coordinates: &Coordinates) -> Vec<f32> {
    let Scalars::F32(values) = &coordinates.values else { return Vec::new() };
    let most = values.iter().copied().fold(1.0, f32::max);
    let of = |row: &[f32]| {
        let [x, y, z] = [0, 1, 2].map(|axis| (row[axis] / most - 0.5) * 30.0);
        let angular = 2.0 * z * z - x * x - y * y;
        let amplitude = angular * (-(x * x + y * y + z * z).sqrt() / 3.0).exp();
        amplitude * amplitude
    };
    values.chunks_exact(3).map(of).collect()
}

fn row(
    name: &str,
    complex: &CellComplex,
    coordinates: &Coordinates,
    criterion: &mut impl Criterion,
    strategy: Strategy,
) -> Result<(), Box<dyn Error>> {
    let options = SimplifyOptions { strategy, ..Default::default() };
    let full = complex.memory_bytes();
    let copy = complex.clone();
    let (total, (recorded, report)) = timed(|| simplify(copy, criterion, &options));
    let seconds = report.simplify_seconds;
    let mcc = recorded.view();
    let num = report.simplifications;
    let mut front = Front::new(mcc);
    let (refine, moved) = timed(|| front.select(|_| true));
    if moved?.refined != num || front.complex().num_cells() != complex.num_cells() {
        return Err("not all refinements were applied".into());
    }
    drop(front);
    // A box around the middle of the points, of about a fifth of them.
    let is_inside = in_box(coordinates);
    let mut front = Front::new(mcc);
    let (boxed, moved) = timed(|| front.select(|refinement| mcc.site(refinement).is_some_and(&is_inside)));
    let dependencies: usize = (0..num).map(|number| mcc.dependencies(number).count()).sum();
    println!(
        "{name:<28} {:>9} {num:>9} {seconds:>7.2} {:>8.0} {:>6.2} {:>11} {:>11} {:>6} {refine:>8.3} {:>7.0} {:>8} {boxed:>8.3} {:>6.2} {:>6.2}",
        complex.num_cells(),
        num as f64 / seconds,
        total - seconds,
        per_cell(recorded.storage_bytes(), complex),
        per_cell(full, complex),
        mcc.num_base_cells(),
        num as f64 / refine,
        moved?.refined,
        dependencies as f64 / num.max(1) as f64,
        peak_memory().unwrap_or(0.0) / 1e9,
    );
    if mcc.dim_of(CellId::new(0)) != Some(0) && num > 0 {
        return Err("a base without a vertex".into());
    }
    Ok(())
}

fn per_cell(bytes: usize, complex: &CellComplex) -> String {
    format!("{:.1}M {:.1}", bytes as f64 / 1e6, bytes as f64 / complex.num_cells() as f64)
}

/// Whether a vertex is in a box that holds about a fifth of the points along each of three cuts.
fn in_box(coordinates: &Coordinates) -> impl Fn(usize) -> bool + use<> {
    let dim = coordinates.dim;
    let values: Vec<f64> = match &coordinates.values {
        Scalars::F32(values) => values.iter().map(|&value| f64::from(value)).collect(),
        Scalars::F64(values) => values.clone(),
    };
    let bounds: Vec<[f64; 2]> = (0..dim.min(3))
        .map(|axis| {
            let mut along: Vec<f64> = values.iter().skip(axis).step_by(dim).copied().collect();
            along.sort_by(f64::total_cmp);
            // The middle 58 % of each axis: a fifth of what is spread evenly.
            let at = |hundredths: usize| along[(along.len() - 1) * hundredths / 100];
            [at(21), at(79)]
        })
        .collect();
    move |vertex| {
        let row = &values[vertex * dim..][..dim];
        bounds.iter().zip(row).all(|(&[low, high], value)| (low..=high).contains(value))
    }
}
