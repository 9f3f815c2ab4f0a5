//! What queries cost on a file that is larger than the memory that may hold it.
//!
//! ```text
//! sig generate grid 340 340 340 --format tetbin | sig build - -o grid.sigc --memory 4GiB
//! cargo bench --bench disk -- grid.sigc           2,000 random simplices of each dimension
//! cargo bench --bench disk -- grid.sigc 10000     another number of them
//! ```
//!
//! Run it where the system holds it to little memory, as `systemd-run --scope -p MemoryMax=4G` does, for what has been read
//! once stays in memory otherwise. The file is opened several times first, then each relation is asked of simplices at random,
//! each of another part of the file. Major faults, the pages that were waited for, are printed beside the times: they are
//! what the time goes to. The simplices are drawn with a seed.

mod common;

use std::error::Error;
use std::hint::black_box;
use std::path::Path;

use common::{Timing, arguments, peak_memory, timed};
use sig_core::{Relations, SimplexId, with_complex};
use sig_tools::generate::SplitMix64;
use sig_tools::{Mapped, OwnedScratch};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments();
    let path = Path::new(arguments.first().ok_or("which file?")?);
    let queries = arguments.get(1).map_or(Ok(2_000), |number| number.parse())?;
    let openings: Result<Vec<f64>, Box<dyn Error>> = (0..20)
        .map(|_| {
            let (seconds, opened) = timed(|| Mapped::open(path).map(|map| map.complex().map(drop)));
            opened??;
            Ok(seconds)
        })
        .collect();
    println!("{}: {} bytes", path.display(), std::fs::metadata(path)?.len());
    println!("opened in {}", Timing::of(openings?).show(1e6, "µs"));
    let map = Mapped::open(path)?;
    with_complex!(map.complex()?, complex => ask(&complex, queries))
}

/// Asks each relation of random simplices of each dimension.
fn ask(complex: &impl Relations, queries: usize) -> Result<(), Box<dyn Error>> {
    let (seconds, mut memory) = timed(|| OwnedScratch::new(complex));
    println!("{} simplices; working memory made in {:.1} ms", complex.num_simplices(), seconds * 1e3);
    println!("µs of a query: median (least, most); mean; answers and major faults a query");
    let mut scratch = memory.scratch();
    let mut random = SplitMix64::new(8);
    for dim in 0..=complex.dim().unwrap_or(0) {
        let (first, _) = complex.simplices_of_dim(dim).bounds();
        let count = complex.num_simplices_of_dim(dim);
        for relation in ["vertices", "coboundary", "star", "link", "adjacency"] {
            let faults = major_faults();
            let (mut samples, mut answers) = (Vec::with_capacity(queries), 0);
            for _ in 0..queries {
                let simplex = SimplexId::new(first.index() + random.next_below(count));
                let (seconds, answer) = timed(|| {
                    Ok::<_, sig_core::ScratchError>(match relation {
                        "vertices" => complex.vertices(simplex).map(black_box).count(),
                        "coboundary" => complex.coboundary(simplex, dim + 1, &mut scratch)?.map(black_box).count(),
                        "star" => complex.star(simplex, &mut scratch)?.map(black_box).count(),
                        "link" => complex.link(simplex, &mut scratch)?.map(black_box).count(),
                        _ => complex.adjacency(simplex, &mut scratch)?.map(black_box).count(),
                    })
                });
                samples.push(seconds);
                answers += answer.map_err(|error| format!("{relation} of {simplex}: {error}"))?;
            }
            let each = |total: f64| total / queries as f64;
            let mean = each(samples.iter().sum()) * 1e6;
            let timing = Timing::of(samples).show(1e6, "µs");
            let faults = each(major_faults().zip(faults).map_or(f64::NAN, |(after, before)| after - before));
            println!("{relation:>10} {dim}  {timing}; {mean:.1} µs; {:.1}, {faults:.2}", each(answers as f64));
        }
    }
    if let Some(peak) = peak_memory() {
        println!("peak of the resident set, pages of the file among it: {:.0} MB", peak / 1e6);
    }
    Ok(())
}

/// The pages that this process has waited for so far; `None` where the system does not tell.
fn major_faults() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/stat").ok()?;
    // After the name, which may hold spaces: the tenth field.
    status.rsplit(')').next()?.split_whitespace().nth(9)?.parse().ok()
}
