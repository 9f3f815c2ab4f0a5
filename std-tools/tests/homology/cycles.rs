//! Generators: cycles by the definition, of the right orders, independent modulo the boundaries.

use std::collections::BTreeMap;

use sig_core::CellId;
use sig_tools::cells::CellComplex;
use sig_tools::homology::{
    BigInt, Cells, Chain, Coefficients, Generator, GeneratorOptions, HomologyError, HomologyOptions, Limits, Stopped,
    generators, homology,
};

use crate::betti::rank_of;
use crate::known::over;

/// The cells of a dimension, by number.
fn cells(complex: &CellComplex, dim: usize) -> Vec<CellId> {
    complex.cells().filter(|&cell| complex.dim_of(cell) == Some(dim)).collect()
}

/// The boundary of a chain by the definition.
fn boundary(complex: &CellComplex, dim: usize, chain: &Chain) -> BTreeMap<CellId, BigInt> {
    let cells = cells(complex, dim);
    let mut sum = BTreeMap::new();
    for (cell, value) in chain {
        for arc in complex.boundary(cells[*cell as usize]) {
            *sum.entry(arc.cell).or_insert_with(|| BigInt::from(0)) += value * arc.incidence.sign;
        }
    }
    sum.retain(|_, value| *value != BigInt::from(0));
    sum
}

/// Checks the generators over the integers and over ℤ/3.
pub(crate) fn check(complex: &CellComplex) {
    let homology = over(complex, Coefficients::Integers);
    let options = GeneratorOptions { cocycles: true, ..Default::default() };
    let found = generators(&Cells::new(complex), &options).unwrap();
    are_dual(complex, &found);
    assert_eq!(found.len(), homology.betti.len());
    for (dim, all) in found.iter().enumerate() {
        let orders: Vec<BigInt> = all.iter().filter_map(|generator| generator.order.clone()).collect();
        assert_eq!(orders, homology.torsion[dim]);
        assert_eq!(all.len() - orders.len(), homology.betti[dim]);
        let below = cells(complex, dim);
        for generator in all {
            assert!(boundary(complex, dim, &generator.cycle).is_empty());
            assert_eq!(generator.order.is_some(), generator.bounds.is_some());
            if let (Some(order), Some(bounds)) = (&generator.order, &generator.bounds) {
                let multiple: BTreeMap<CellId, BigInt> =
                    generator.cycle.iter().map(|(cell, value)| (below[*cell as usize], value * order)).collect();
                assert_eq!(boundary(complex, dim + 1, bounds), multiple);
            }
        }
        for prime in [2_i64, 3, 5] {
            // Those that do not vanish modulo p are independent of each other and of the boundaries.
            let vanishes = |order: &BigInt| order % prime != BigInt::from(0);
            let cycles = all.iter().filter(|generator| !generator.order.as_ref().is_some_and(vanishes));
            let cycles: Vec<_> = cycles.map(|generator| column(&generator.cycle, &below, prime)).collect();
            let boundaries = cells(complex, dim + 1).into_iter().map(|cell| {
                let arcs = complex.boundary(cell);
                arcs.map(|arc| (arc.cell.index(), i64::from(arc.incidence.sign))).collect::<BTreeMap<_, _>>()
            });
            let boundaries: Vec<_> = boundaries.collect();
            let rank = rank_of(boundaries.iter().cloned(), prime);
            assert_eq!(rank_of(boundaries.into_iter().chain(cycles.clone()), prime), rank + cycles.len());
        }
    }
    let modulo = generators(&Cells::new(complex), &of(Coefficients::Prime(3))).unwrap();
    assert_eq!(modulo.iter().map(Vec::len).collect::<Vec<_>>(), over(complex, Coefficients::Prime(3)).betti);
    for (dim, all) in modulo.iter().enumerate() {
        for generator in all {
            assert!(boundary(complex, dim, &generator.cycle).values().all(|value| value % 3 == BigInt::from(0)));
        }
    }
    let rational = generators(&Cells::new(complex), &of(Coefficients::Rationals)).unwrap();
    assert_eq!(rational.iter().map(Vec::len).collect::<Vec<_>>(), homology.betti);
}

fn of(over: Coefficients) -> GeneratorOptions<'static> {
    GeneratorOptions { homology: HomologyOptions { over, ..Default::default() }, cocycles: true, lengths: None }
}

/// The value of a cochain on a chain.
fn product(cochain: &Chain, chain: &Chain) -> BigInt {
    let values: BTreeMap<u32, &BigInt> = cochain.iter().map(|(cell, value)| (*cell, value)).collect();
    chain.iter().filter_map(|(cell, value)| Some(value * *values.get(cell)?)).sum()
}

/// Checks that there is a cocycle for each free class, by the definition, that is 1 on its cycle and 0 on all others.
fn are_dual(complex: &CellComplex, found: &[Vec<Generator>]) {
    for (dim, all) in found.iter().enumerate() {
        let numbers: BTreeMap<CellId, u32> =
            (0..).zip(cells(complex, dim)).map(|(number, cell)| (cell, number)).collect();
        for (number, generator) in all.iter().enumerate() {
            assert_eq!(generator.cocycle.is_some(), generator.order.is_none());
            let Some(cocycle) = &generator.cocycle else { continue };
            for (other, generator) in all.iter().enumerate() {
                assert_eq!(product(cocycle, &generator.cycle), BigInt::from(u8::from(other == number)));
            }
            for coface in cells(complex, dim + 1) {
                let faces = complex.boundary(coface).map(|arc| (numbers[&arc.cell], BigInt::from(arc.incidence.sign)));
                assert_eq!(product(cocycle, &faces.collect()), BigInt::from(0));
            }
        }
    }
}

/// Loops on a torus of n × n squares: the shortest ones that do not bound have n edges, and there are two of them, or one and a
/// diagonal.
#[test]
fn loops_become_as_short_as_can_be() {
    for side in [3_usize, 7, 12] {
        let torus = crate::spaces::torus(2, side);
        let one = |_: u32| 1.0;
        let options = GeneratorOptions { cocycles: true, lengths: Some(&one), ..Default::default() };
        let found = generators(&Cells::new(&torus), &options).unwrap();
        are_dual(&torus, &found);
        for generator in &found[1] {
            assert!(boundary(&torus, 1, &generator.cycle).is_empty());
            let length: BigInt = generator.cycle.iter().map(|(_, value)| value * value).sum();
            assert_eq!(length, BigInt::from(side), "{side}");
        }
    }
}

/// Of the projective plane the loop, and what it bounds twice, after it was made shorter.
#[test]
fn torsion_stays_certain_when_loops_become_shorter() {
    let plane = crate::known::of_words("012 023 034 045 015 124 235 134 245 135");
    let length = |edge: u32| f64::from(edge % 5 + 1);
    let options = GeneratorOptions { lengths: Some(&length), ..Default::default() };
    let found = generators(&Cells::new(&plane), &options).unwrap();
    let [generator] = &found[1][..] else { panic!("one generator") };
    let edges = cells(&plane, 1);
    let twice = generator.cycle.iter().map(|(cell, value)| (edges[*cell as usize], value * 2)).collect();
    assert_eq!(boundary(&plane, 2, generator.bounds.as_ref().unwrap()), twice);
}

/// A limit ends the work, and what is known is right.
#[test]
fn limits_end_the_work() {
    let torus = crate::spaces::torus(3, 3);
    let cells = Cells::new(&torus);
    let interrupt = std::sync::atomic::AtomicBool::new(true);
    let limited = |limits| HomologyOptions { limits, ..Default::default() };
    let interrupted = limited(Limits { interrupt: Some(&interrupt), ..Default::default() });
    let found = homology(&cells, &interrupted).unwrap();
    assert_eq!((found.betti.len(), found.stopped), (0, Some(Stopped::Interrupted)));
    let late = limited(Limits { until: Some(std::time::Instant::now()), ..Default::default() });
    assert_eq!(homology(&cells, &late).unwrap().stopped, Some(Stopped::Time));
    // 27 vertices, 189 edges, 324 triangles, 162 tetrahedra: the edges and triangles take the most.
    let mut known = Vec::new();
    for max_bytes in (0..20_000).step_by(500) {
        let found = homology(&cells, &limited(Limits { max_bytes: Some(max_bytes), ..Default::default() })).unwrap();
        assert_eq!(found.betti, [1, 3, 3, 1][..found.betti.len()]);
        assert_eq!(found.stopped.is_some(), found.betti.len() < 4);
        known.push(found.betti.len());
    }
    assert!(known.is_sorted() && known.first() == Some(&0) && known.last() == Some(&4));
    let few = GeneratorOptions {
        homology: limited(Limits { max_bytes: Some(10), ..Default::default() }),
        ..Default::default()
    };
    assert!(matches!(generators(&cells, &few), Err(HomologyError::Stopped(Stopped::Memory { allowed: 10, .. }))));
    let told = std::sync::Mutex::new(Vec::new());
    let progress = |done: u64, total: u64| told.lock().unwrap().push((done, total));
    homology(&cells, &limited(Limits { progress: Some(&progress), ..Default::default() })).unwrap();
    let told = told.into_inner().unwrap();
    assert!(told.is_sorted() && told.iter().all(|&(done, total)| done <= total && total == 702));
}

/// Groups up to some dimension are those of all.
#[test]
fn dimensions_above_are_left_out() {
    let torus = crate::spaces::torus(3, 3);
    for max_dim in 0..5 {
        let options = HomologyOptions { max_dim: Some(max_dim), ..Default::default() };
        let wanted = 4.min(max_dim + 1);
        assert_eq!(homology(&Cells::new(&torus), &options).unwrap().betti, [1, 3, 3, 1][..wanted]);
        let options = GeneratorOptions { homology: options, cocycles: true, lengths: None };
        let found = generators(&Cells::new(&torus), &options).unwrap();
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [1, 3, 3, 1][..wanted]);
    }
}

fn column(chain: &Chain, cells: &[CellId], prime: i64) -> BTreeMap<usize, i64> {
    let entry = |(cell, value): &(u32, BigInt)| (cells[*cell as usize].index(), i64::try_from(value % prime).unwrap());
    chain.iter().map(entry).collect()
}
