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

use common::{Timing, grid, on_one_thread, timed};
use sig_core::VertexId;
use sig_tools::build::{Arrays, BuildOptions, Built, build};
use sig_tools::contract::{Edge, contract};

mod common;

const ROUNDS: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<u32> = common::arguments().iter().map(|side| side.parse()).collect::<Result<_, _>>()?;
    let sides = if arguments.is_empty() { vec![17, 36, 77] } else { arguments };
    println!("medians of {ROUNDS} rounds (least, most); threads: {}", rayon::current_num_threads());
    for side in sides {
        println!("\n{side}");
        measure(side, "all threads")?;
        on_one_thread(|| measure(side, "one thread").map_err(|error| error.to_string()))??;
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
    let [build, one, list, copy] = [builds, ones, lists, copies].map(Timing::of);
    let local = (list.median - one.median) / (many.len() as f64 - 1.0);
    println!("  {threads}, {count} simplices");
    println!("    build again        {}", build.show(1e6, "µs"));
    println!("    copy all arrays    {}", copy.show(1e6, "µs"));
    println!(
        "    contract one       {}, a rebuild takes {:.1} times as long",
        one.show(1e6, "µs"),
        build.median / one.median
    );
    println!(
        "    contract {:<9} {}, {} an edge",
        many.len(),
        list.show(1e6, "µs"),
        show(list.median / many.len() as f64)
    );
    println!("    local part         {}", show(local));
    println!(
        "    pass               {}, {:.2} ns a simplex",
        show(one.median - local),
        (one.median - local) * 1e9 / count as f64
    );
    Ok(())
}

fn show(seconds: f64) -> String {
    format!("{:.1} µs", seconds * 1e6)
}

fn num_simplices(built: &Built) -> usize {
    match &built.arrays {
        Arrays::Narrow(arrays) => arrays.num_simplices,
        Arrays::Wide(arrays) => arrays.num_simplices,
    }
}
