//! Multi-resolution complexes: Tables 1 and 2 of section 7 of mcc-2012 on surfaces and tetrahedral meshes, in Markdown.
//!
//! ```text
//! SIG_DATA=DIR cargo bench --bench mcc                      everything: the files of DIR that are there, and grids
//! SIG_DATA=DIR cargo bench --bench mcc -- vaselion lucy_50k step    these data sets, this strategy
//! cargo bench --bench mcc -- grid-26 grid-47                grids of 26³ and 47³ vertices, any number
//! ```
//!
//! A data set is named as its file is up to the first point. Simplification is by the extent of the cells that go, with operators
//! of both types; of grids also by the difference of a scalar field like the density of a hydrogen atom (`field`). Table 1 has
//! the paper's columns and what they do not tell: bytes a cell of the full complex, what is left, arcs, memory. The
//! multi-resolution complex is written as a file, and refined as it lies there. Table 2 has boxes of about a fifth of the
//! vertices, of which the first 50, 80 and 100 % of the refinements are wanted, small ones, and one that moves. Single runs:
//! read the ratios.

use std::error::Error;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;

use common::{grid, peak_memory, timed};
use sig_core::mark_words;
use sig_core::mcc::{AxisBox, Mcc};
use sig_tools::build::{BuildOptions, Built, build};
use sig_tools::cells::CellComplex;
use sig_tools::io::{ReadOptions, read_path};
use sig_tools::mcc::{
    Extent, Field, Front, MccFile, MultiResolution, SimplifyOptions, SimplifyReport, Strategy, simplify, write_mcc,
};
use sig_tools::soup::{Coordinates, Scalars, Soup};
use sig_tools::store::AlignedBytes;

mod common;

/// Surfaces, then tetrahedral meshes.
const FILES: [&str; 13] = [
    "vaselion.off.gz",
    "lucy_50k.ply.gz",
    "buddha_49950.obj.gz",
    "turbineblade.ply.gz",
    "igea_from_strips.off.gz",
    "dragon_vrip.ply.gz",
    "alpha_bunny_q40.tops.gz",
    "monkey.msh.gz",
    "gargoyle.msh.gz",
    "gmsh_mixed_bracket_h0.15.msh.gz",
    "armadillo_tet.tetbin.xz",
    "lucy_tet.tetbin.xz",
    "nefertiti_big_tet.tetbin.xz",
];

/// Vertices along each side of the grids: 0.1, 0.58, 1.2 and 2.1 million tetrahedra.
const SIDES: [u32; 4] = [27, 47, 60, 71];

/// How a row simplifies: the name, the strategy, and whether by the field.
const WAYS: [(&str, Strategy, bool); 3] =
    [("step", Strategy::Step, false), ("batch", Strategy::Batch, false), ("field", Strategy::Step, true)];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
    let (ways, names): (Vec<&str>, Vec<&str>) =
        arguments.iter().map(String::as_str).partition(|argument| WAYS.iter().any(|way| way.0 == *argument));
    let is_asked = |of: &[&str], name: &str| of.is_empty() || of.contains(&name);
    println!("{} threads\n", rayon::current_num_threads());
    println!(
        "| data | cells | simpl. | s | a second | MCC s | MCC MB | base MB | full MB | (MCC + base) / full | bytes a cell | \
         base cells | Betti | arcs | dep. | ref. s | a second | stream, a second | peak GB |"
    );
    println!("|---|{}", "---:|".repeat(18));
    let mut boxes = Vec::new();
    let mut run = |name: &str, soup: &dyn Fn() -> Result<Soup, Box<dyn Error>>| -> Result<(), Box<dyn Error>> {
        if !is_asked(&names, name) {
            return Ok(());
        }
        let built = build(soup()?, &BuildOptions::default())?;
        for (way, strategy, by_field) in WAYS {
            if is_asked(&ways, way) && (!by_field || name.starts_with("grid-")) {
                row(&format!("{name} {way}"), &built, strategy, by_field, &mut boxes)?;
            }
        }
        Ok(())
    };
    if let Some(data) = std::env::var_os("SIG_DATA") {
        for file in FILES {
            let path = Path::new(&data).join(file);
            if path.exists() {
                let name = file.split('.').next().unwrap_or(file);
                run(name, &|| Ok(read_path(&path, &ReadOptions::default())?.0))?;
            }
        }
    }
    let named = names.iter().filter_map(|name| name.strip_prefix("grid-")?.parse().ok());
    let sides: Vec<u32> = if names.is_empty() { SIDES.to_vec() } else { named.collect() };
    for side in sides {
        run(&format!("grid-{side}"), &|| Ok(placed_grid(side)))?;
    }
    println!("\n| data | box | wanted | applied | taken back | s | µs an operator |");
    println!("|---|---|{}", "---:|".repeat(5));
    boxes.iter().for_each(|line| println!("{line}"));
    Ok(())
}

/// A Freudenthal tetrahedralisation of a cube.
fn placed_grid(side: u32) -> Soup {
    let mut soup = grid(side);
    let places = (0..side.pow(3)).flat_map(|at| [at % side, at / side % side, at / side / side]);
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32(places.map(|place| place as f32).collect()) });
    soup
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

/// What simplification gave, and what it took.
struct Made {
    recorded: MultiResolution,
    report: SimplifyReport,
    cells: usize,
    euler: i64,
    full_bytes: usize,
    record_seconds: f64,
}

fn make(built: &Built, coordinates: &Coordinates, strategy: Strategy, by_field: bool) -> Result<Made, Box<dyn Error>> {
    let complex = CellComplex::from_built(built)?;
    let (cells, full_bytes) = (complex.num_cells(), complex.memory_bytes());
    let euler = complex.euler_characteristic();
    let options = SimplifyOptions { strategy, ..Default::default() };
    let (total, (recorded, report)) = if by_field {
        let mut criterion = Field::new(&complex, &density(coordinates));
        timed(|| simplify(complex, &mut criterion, &options))
    } else {
        let mut criterion = Extent::new(&complex, coordinates);
        timed(|| simplify(complex, &mut criterion, &options))
    };
    let record_seconds = total - report.simplify_seconds;
    Ok(Made { recorded, report, cells, euler, full_bytes, record_seconds })
}

/// Measures one row of Table 1, prints it, and adds rows of Table 2.
fn row(
    name: &str,
    built: &Built,
    strategy: Strategy,
    by_field: bool,
    boxes: &mut Vec<String>,
) -> Result<(), Box<dyn Error>> {
    // From here on the peak is that of this row, where the system lets us ask for it.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let coordinates = built.coordinates.as_ref().ok_or("no coordinates")?;
    let Made { recorded, report, cells, euler, full_bytes, record_seconds } =
        make(built, coordinates, strategy, by_field)?;
    let peak = peak_memory().unwrap_or(0.0) / 1e9;
    let stored = recorded.storage_bytes();
    let mut bytes = Vec::new();
    write_mcc(&recorded, Some(coordinates), &mut bytes)?;
    drop(recorded);
    let file = MccFile::from_file_bytes(AlignedBytes::from(&bytes[..]))?;
    drop(bytes);
    let mcc = file.view();
    let num = mcc.num_refinements();
    let mut front = Front::new(mcc);
    if front.complex().euler_characteristic() != euler {
        return Err("the base has another Euler characteristic".into());
    }
    let base_bytes = 4 * (mcc.num_base_cells() + 1 + mcc.arrays().base_offsets.last().map_or(0, |&end| end as usize));
    let (refine, moved) = timed(|| front.change(0..num, []));
    if moved?.refined != num || front.complex().num_cells() != cells {
        return Err("not all refinements were applied".into());
    }
    drop(front);
    let arcs = mcc.arrays().arcs.len();
    let dependencies: usize = (0..num).map(|number| mcc.dependencies(number).count()).sum();
    let a_refinement = |count: usize| count as f64 / num.max(1) as f64;
    println!(
        "| {name} | {} | {} | {:.2} | {} | {:.2} | {:.1} | {:.3} | {:.1} | {:.0} % | {:.1} / {:.1} | {} | {} | {:.1} | {:.1} | {refine:.3} | {} | {} | {peak:.2} |",
        grouped(cells),
        grouped(num),
        report.simplify_seconds,
        rate(num, report.simplify_seconds),
        record_seconds,
        (stored - base_bytes) as f64 / 1e6,
        base_bytes as f64 / 1e6,
        full_bytes as f64 / 1e6,
        100.0 * stored as f64 / full_bytes as f64,
        stored as f64 / cells as f64,
        full_bytes as f64 / cells as f64,
        grouped(mcc.num_base_cells()),
        betti(&mcc),
        a_refinement(arcs),
        a_refinement(dependencies),
        rate(num, refine),
        rate(num, stream_seconds(&mcc)),
    );
    std::io::stdout().flush()?;
    boxes.extend(table_two(name, mcc, coordinates)?);
    Ok(())
}

/// The sum of the Betti numbers, which no base can be smaller than, by the ranks of the boundary matrices of the base modulo 2;
/// nothing where the base is too large for that.
fn betti(mcc: &Mcc<'_>) -> String {
    let front = Front::new(*mcc);
    let complex = front.complex();
    if complex.num_cells() > 5000 {
        return String::new();
    }
    // A column for each cell, by the rows with an odd coefficient; reduced from the left, by the last rows.
    let mut by_last: std::collections::HashMap<sig_core::CellId, Vec<sig_core::CellId>> =
        std::collections::HashMap::new();
    let mut rank = 0;
    for cell in complex.cells() {
        let odd = complex.boundary(cell).filter(|arc| arc.incidence.multiplicity % 2 == 1);
        let mut column: Vec<_> = odd.map(|arc| arc.cell).collect();
        while let Some(other) = column.last().and_then(|last| by_last.get(last)) {
            let mut sum: Vec<_> = column.iter().filter(|cell| other.binary_search(cell).is_err()).copied().collect();
            sum.extend(other.iter().filter(|cell| column.binary_search(cell).is_err()));
            sum.sort_unstable();
            column = sum;
        }
        if let Some(&last) = column.last() {
            by_last.insert(last, column);
            rank += 1;
        }
    }
    grouped(complex.num_cells() - 2 * rank)
}

/// How long the core takes to hand over all refinements with all their arcs.
fn stream_seconds(mcc: &Mcc<'_>) -> f64 {
    let mut marks = vec![0; mark_words(mcc.num_refinements())];
    mcc.select(&mut marks, |_| true);
    let (seconds, sum) = timed(|| {
        let mut sum = 0_u64;
        let ended = mcc.stream(&marks, |refinement| {
            sum += refinement.lists.into_iter().flatten().map(|arc| u64::from(arc.cell.number())).sum::<u64>();
            ControlFlow::<()>::Continue(())
        });
        assert!(ended.is_some());
        sum
    });
    std::hint::black_box(sum);
    seconds
}

/// The rows of Table 2: a box of about a fifth of the vertices, small ones, and one that moves by a tenth of its side.
fn table_two(name: &str, mcc: Mcc<'_>, coordinates: &Coordinates) -> Result<Vec<String>, Box<dyn Error>> {
    let mut lines = Vec::new();
    let mut line = |which: &str, wanted: usize, seconds: f64, moved: sig_tools::mcc::Moved| {
        let operators = moved.refined + moved.coarsened;
        lines.push(format!(
            "| {name} | {which} | {} | {} | {} | {seconds:.4} | {:.2} |",
            grouped(wanted),
            grouped(moved.refined),
            grouped(moved.coarsened),
            1e6 * seconds / operators.max(1) as f64,
        ));
    };
    let fifth = middle(coordinates, 0.2, 0.0);
    for percent in [50, 80, 100] {
        let mut front = Front::new(mcc);
        let (seconds, result) = timed(|| {
            let mut wanted: Vec<usize> = mcc.in_box(fifth, AxisBox::EMPTY).ok_or("no tree over the sites")?.collect();
            wanted.sort_unstable();
            wanted.truncate(wanted.len() * percent / 100);
            Ok::<_, Box<dyn Error>>((wanted.len(), front.change(wanted, [])?))
        });
        let (wanted, moved) = result?;
        line(&format!("a fifth, {percent} %"), wanted, seconds, moved);
    }
    for (which, share) in [("a hundredth", 1e-2), ("a ten-thousandth", 1e-4)] {
        let small = middle(coordinates, share, 0.0);
        let mut front = Front::new(mcc);
        let wanted = mcc.in_box(small, AxisBox::EMPTY).map_or(0, Iterator::count);
        let (seconds, moved) = timed(|| front.move_box(AxisBox::EMPTY, small));
        line(which, wanted, seconds, moved?);
        if share == 1e-2 {
            let beside = middle(coordinates, share, 0.1);
            let wanted = mcc.in_box(beside, small).map_or(0, Iterator::count);
            let (seconds, moved) = timed(|| front.move_box(small, beside));
            line("it moves by a tenth", wanted, seconds, moved?);
        }
    }
    Ok(lines)
}

/// A box around the middle that holds about a share of the points, if they are spread evenly along the axes, moved by a part of
/// its side along the first axis.
#[expect(clippy::cast_possible_truncation, reason = "a place in a list")]
fn middle(coordinates: &Coordinates, share: f64, by: f64) -> AxisBox {
    let dim = coordinates.dim;
    let values: Vec<f64> = match &coordinates.values {
        Scalars::F32(values) => values.iter().map(|&value| f64::from(value)).collect(),
        Scalars::F64(values) => values.clone(),
    };
    let part = share.powf(1.0 / dim.min(3) as f64) / 2.0;
    let mut bounds = AxisBox::SPACE;
    for axis in 0..dim.min(3) {
        let mut along: Vec<f64> = values.iter().skip(axis).step_by(dim).copied().collect();
        along.sort_by(f64::total_cmp);
        let at = |place: f64| along[((along.len() - 1) as f64 * place) as usize];
        let shift = if axis == 0 { 2.0 * part * by } else { 0.0 };
        (bounds.low[axis], bounds.high[axis]) = (at(0.5 - part + shift), at(0.5 + part + shift));
    }
    bounds
}

/// A number with commas between thousands.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let comma = |place: usize| place > 0 && (digits.len() - place).is_multiple_of(3);
    let groups =
        digits.char_indices().flat_map(|(place, digit)| comma(place).then_some(',').into_iter().chain([digit]));
    groups.collect()
}

/// How many a second, to three digits.
#[expect(clippy::cast_possible_truncation, reason = "fewer than 2^53 a second")]
fn rate(count: usize, seconds: f64) -> String {
    let rate = count as f64 / seconds.max(1e-9);
    let unit = 10_f64.powf((rate.max(1.0).log10().floor() - 2.0).max(0.0));
    grouped(((rate / unit).round() * unit) as usize)
}
