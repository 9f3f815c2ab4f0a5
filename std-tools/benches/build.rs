//! Building the SIG of Kuhn grids from their tetrahedra, at three sizes a factor ten apart: the cost of a simplex should
//! stay the same. The throughput is in simplices of the complex, of all dimensions.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sig_tools::build::{BuildOptions, build};
use sig_tools::soup::{Labels, Soup};

/// The Kuhn (Freudenthal) tetrahedra of a grid of n × n × n vertices.
fn kuhn_grid(n: u32) -> Soup {
    let mut soup = Soup::new(Labels::Numbered(n.pow(3) as usize), true);
    let steps = [n * n, n, 1];
    for cube in 0..(n - 1).pow(3) {
        let (x, y, z) = (cube / (n - 1).pow(2), cube / (n - 1) % (n - 1), cube % (n - 1));
        let corner = x * steps[0] + y * steps[1] + z * steps[2];
        for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let (one, two) = (corner + steps[a], corner + steps[a] + steps[b]);
            soup.push(&[corner, one, two, two + steps[c]]);
        }
    }
    soup
}

/// The simplices of a Kuhn grid of n × n × n vertices: a chain of steps in {0,1}³ from a corner, as many of them as fit.
fn num_simplices(n: u64) -> u64 {
    let m = n - 1;
    // Edges along 1, 2, 3 axes; triangles by the axes of their two steps; tetrahedra.
    let edges = 3 * m * n * n + 3 * m * m * n + m * m * m;
    let triangles = 6 * m * m * n + 6 * m * m * m;
    n * n * n + edges + triangles + 6 * m * m * m
}

fn kuhn_grids(c: &mut Criterion) {
    let mut group = c.benchmark_group("build Kuhn grid");
    group.sample_size(10).measurement_time(Duration::from_secs(10));
    for n in [16, 34, 73] {
        let soup = kuhn_grid(n);
        let count = num_simplices(u64::from(n));
        group.throughput(Throughput::Elements(count));
        group.bench_with_input(BenchmarkId::from_parameter(count), &soup, |bencher, soup| {
            let input = || soup.clone();
            let run = |soup| black_box(build(soup, &BuildOptions::default()).is_ok());
            bencher.iter_batched(input, run, BatchSize::PerIteration);
        });
    }
    group.finish();
}

criterion_group!(benches, kuhn_grids);
criterion_main!(benches);
