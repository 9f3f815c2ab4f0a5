//! What an edge contraction costs on the arrays of a SIG, beside building the complex again.
//!
//! ```text
//! cargo bench --bench contract             on Freudenthal (Kuhn) grids of 17³, 36³, 77³ vertices
//! cargo bench --bench contract -- 17 36    on grids of 17³ and 36³ vertices
//! ```
//!
//! A contraction has a local part and a pass over the arrays. A list of edges that cannot meet takes one pass, so the
//! two come from the time of one edge and that of as many as fit a plane of the grid. All are measured in turn, and
//! medians are printed with least and most. Read the ratios.

use std::error::Error;
use std::time::Instant;

use sig_core::VertexId;
use sig_tools::build::{Arrays, BuildOptions, Built, build};
use sig_tools::contract::{Edge, contract};
use sig_tools::soup::{Labels, Soup};

const ROUNDS: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<u32> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let sides = if arguments.is_empty() { vec![17, 36, 77] } else { arguments };
    println!("medians of {ROUNDS} rounds (least, most); threads: {}", rayon::current_num_threads());
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for side in sides {
        println!("\n{side}");
        measure(side, "all threads")?;
        one.install(|| measure(side, "one thread").map_err(|error| error.to_string()))?;
    }
    Ok(())
}

fn measure(side: u32, threads: &str) -> Result<(), Box<dyn Error>> {
    let soup = grid(side);
    let number = |x: u32, y: u32, z: u32| VertexId::new((x + side * (y + side * z)) as usize);
    let middle = side / 2;
    let single = [Edge { kept: number(middle, middle, middle), removed: number(middle + 1, middle, middle) }];
    // Four steps apart, their closed stars have no vertex in common.
    let steps = || (1..side - 2).step_by(4);
    let many: Vec<Edge> = steps()
        .flat_map(|x| steps().map(move |y| (x, y)))
        .map(|(x, y)| Edge { kept: number(x, y, middle), removed: number(x + 1, y, middle) })
        .take(200)
        .collect();
    let (mut builds, mut ones, mut lists, mut copies) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut count = 0;
    for _ in 0..ROUNDS {
        let input = soup.clone();
        let (seconds, built) = timed(|| build(input, &BuildOptions::default()));
        builds.push(seconds);
        let built = built?;
        count = num_simplices(&built);
        let (seconds, mut copy) = timed(|| built.clone());
        copies.push(seconds);
        let (seconds, report) = timed(|| contract(&mut copy, &single));
        ones.push(seconds);
        if report?.passes != 1 {
            return Err("one edge, one pass".into());
        }
        let mut copy = built;
        let (seconds, report) = timed(|| contract(&mut copy, &many));
        lists.push(seconds);
        if report?.passes != 1 {
            return Err("the edges do not share a pass".into());
        }
    }
    let [build, one, list, copy] = [builds, ones, lists, copies].map(median);
    let local = (list.0 - one.0) / (many.len() as f64 - 1.0);
    println!("  {threads}, {count} simplices");
    println!("    build again        {}", show(build));
    println!("    copy all arrays    {}", show(copy));
    println!("    contract one       {}, a rebuild takes {:.1} times as long", show(one), build.0 / one.0);
    println!("    contract {:<9} {}, {} an edge", many.len(), show(list), show_one(list.0 / many.len() as f64));
    println!("    local part         {}", show_one(local));
    println!(
        "    pass               {}, {:.2} ns a simplex",
        show_one(one.0 - local),
        (one.0 - local) * 1e9 / count as f64
    );
    Ok(())
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

/// Median, least and most.
fn median(mut samples: Vec<f64>) -> (f64, f64, f64) {
    samples.sort_by(f64::total_cmp);
    let at = |index: usize| samples.get(index).copied().unwrap_or(f64::NAN);
    (at(samples.len() / 2), at(0), at(samples.len().saturating_sub(1)))
}

fn show_one(seconds: f64) -> String {
    format!("{:.3} ms", seconds * 1e3)
}

fn show((median, least, most): (f64, f64, f64)) -> String {
    format!("{:.3} ms ({:.3}, {:.3})", median * 1e3, least * 1e3, most * 1e3)
}

fn num_simplices(built: &Built) -> usize {
    match &built.arrays {
        Arrays::Narrow(arrays) => arrays.num_simplices,
        Arrays::Wide(arrays) => arrays.num_simplices,
    }
}

/// The Freudenthal triangulation of a grid of side³ vertices: six tetrahedra a cube, one for each order of the axes.
fn grid(side: u32) -> Soup {
    let mut soup = Soup::new(Labels::Numbered((side * side * side) as usize), true);
    let steps = [1, side, side * side];
    for corner in (0..side * side * side).filter(|v| steps.iter().all(|step| v / step % side < side - 1)) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let (one, two) = (corner + steps[a], corner + steps[a] + steps[b]);
            soup.push(&[corner, one, two, two + steps[c]]);
        }
    }
    soup
}
