//! What the order of the vertices buys: building, stars of all vertices, and of some at random.
//!
//! ```text
//! cargo bench --bench order                      grids of about a million and of ten million simplices
//! cargo bench --bench order -- a.off b.tetbin.xz meshes in files
//! ```
//!
//! Each mesh is taken as it is and with its vertices and its simplices shuffled, as they come out of some programs; from
//! either every order makes a complex of the same simplices. Built in turn, several rounds; medians.

use std::convert::Infallible;
use std::error::Error;

use common::{Timing, timed};
use sig_core::{VertexId, with_complex};
use sig_tools::OwnedScratch;
use sig_tools::build::{BuildError, BuildOptions, VertexOrder, build};
use sig_tools::generate::{SplitMix64, Triangulation};
use sig_tools::io::{ReadOptions, read_path};
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};
use sig_tools::store::{EncodeOptions, Encoding};

mod common;

const ROUNDS: usize = 3;
/// Vertices whose stars are asked for at random, at most.
const QUERIES: usize = 200_000;
const ORDERS: [(&str, VertexOrder); 3] =
    [("input", VertexOrder::Input), ("hilbert", VertexOrder::Hilbert), ("rcm", VertexOrder::Rcm)];

fn main() -> Result<(), Box<dyn Error>> {
    println!("medians of {ROUNDS} rounds; threads: {}", rayon::current_num_threads());
    println!(
        "| mesh | its vertices | order | build, ns a simplex | all stars, ns a top simplex | random stars, ns each |"
    );
    println!("|---|---|---|---|---|---|");
    let paths = common::arguments();
    let grids = [&[408_u32; 2][..], &[1291; 2], &[34; 3], &[73; 3]];
    for sides in grids.into_iter().filter(|_| paths.is_empty()) {
        measure(&format!("grid {}D, {} a side", sides.len(), sides[0]), grid(sides)?)?;
    }
    for path in paths {
        let name = path.rsplit('/').next().unwrap_or(&path).to_owned();
        measure(&name, read_path(&path, &ReadOptions::default())?.0)?;
    }
    Ok(())
}

/// A grid with coordinates.
fn grid(sides: &[u32]) -> Result<Soup, Box<dyn Error>> {
    let grid = Triangulation::grid(sides)?;
    let mut soup = Soup::new(Labels::Numbered(grid.num_vertices() as usize), true);
    grid.try_for_each(|simplex| {
        soup.push(simplex);
        Ok::<(), Infallible>(())
    })?;
    let mut values = Vec::new();
    for vertex in 0..grid.num_vertices() {
        let mut rest = vertex;
        for side in sides {
            values.push(f64::from(rest % side));
            rest /= side;
        }
    }
    soup.coordinates = Some(Coordinates { dim: sides.len(), values: Scalars::F64(values) });
    Ok(soup)
}

fn measure(name: &str, soup: Soup) -> Result<(), Box<dyn Error>> {
    let shuffled = shuffled(&soup);
    for (numbers, soup) in [("as they are", soup), ("shuffled", shuffled)] {
        for (order_name, order) in ORDERS {
            let mut rounds: [Vec<f64>; 3] = Default::default();
            for _ in 0..ROUNDS {
                match figures(&soup, order) {
                    Ok(figures) => rounds.iter_mut().zip(figures).for_each(|(round, figure)| round.push(figure)),
                    Err(error) if error.is::<BuildError>() => break,
                    Err(error) => return Err(error),
                }
            }
            if !rounds[0].is_empty() {
                let [build, all, random] = rounds.map(|samples| Timing::of(samples).median);
                println!("| {name} | {numbers} | {order_name} | {build:.1} | {all:.1} | {random:.0} |");
            }
        }
    }
    Ok(())
}

/// Nanoseconds a simplex to build, a top simplex in the stars of all vertices one after the other, and a star at random.
fn figures(soup: &Soup, order: VertexOrder) -> Result<[f64; 3], Box<dyn Error>> {
    let input = soup.clone();
    let (building, built) = timed(|| build(input, &BuildOptions { order, ..BuildOptions::default() }));
    let built = built?;
    let bytes = Encoding::new(&built, &EncodeOptions::default())?.to_bytes()?;
    drop(built);
    let complex = sig_core::AnyComplex::from_bytes(&bytes)?;
    with_complex!(complex, complex => {
        let top = complex.dim().ok_or("an empty complex")?;
        let mut memory = OwnedScratch::new(&complex);
        let mut scratch = memory.scratch();
        let mut stars = |vertices: &[usize]| {
            vertices.iter().try_fold(0, |sum, &vertex| {
                complex.coboundary(VertexId::new(vertex).into(), top, &mut scratch).map(|tops| sum + tops.len())
            })
        };
        let count = complex.num_vertices();
        let vertices: Vec<usize> = (0..count).collect();
        let (all, reported) = timed(|| stars(&vertices));
        let mut random = SplitMix64::new(3);
        let queries: Vec<usize> = (0..count.min(QUERIES)).map(|_| random.next_below(count)).collect();
        let (some, answer) = timed(|| stars(&queries));
        answer?;
        Ok([building / complex.num_simplices() as f64, all / reported? as f64, some / queries.len() as f64].map(|s| s * 1e9))
    })
}

/// The same with vertices and simplices in a random order; the vertices of each simplex keep theirs.
fn shuffled(soup: &Soup) -> Soup {
    let count = soup.labels.len();
    let mut random = SplitMix64::new(1);
    let mut permutation = |len: usize| {
        let mut order: Vec<usize> = (0..len).collect();
        (1..len).rev().for_each(|last| order.swap(last, random.next_below(last + 1)));
        order
    };
    // Vertex number i of the result is number old[i] of the soup.
    let old = permutation(count);
    let mut new = vec![0_u32; count];
    old.iter().zip(0..).for_each(|(&old, number)| new[old] = number);
    let mut result = Soup::new(Labels::Numbered(count), soup.declared);
    for dim in 0..soup.simplices.len() {
        let simplices: Vec<&[u32]> = soup.of_dim(dim).collect();
        for row in permutation(simplices.len()) {
            let simplex: Vec<u32> = simplices[row].iter().map(|&vertex| new[vertex as usize]).collect();
            result.push(&simplex);
        }
    }
    result.coordinates = soup.coordinates.as_ref().map(|coordinates| Coordinates {
        dim: coordinates.dim,
        values: match &coordinates.values {
            Scalars::F32(values) => Scalars::F32(rows(values, coordinates.dim, &old)),
            Scalars::F64(values) => Scalars::F64(rows(values, coordinates.dim, &old)),
        },
    });
    result
}

fn rows<T: Copy>(values: &[T], width: usize, order: &[usize]) -> Vec<T> {
    order.iter().flat_map(|&row| &values[row * width..][..width]).copied().collect()
}
