//! Generators: cycles by the definition, of the right orders, independent modulo the boundaries.

use std::collections::BTreeMap;

use sig_core::CellId;
use sig_tools::cells::CellComplex;
use sig_tools::homology::{BigInt, Cells, Chain, Coefficients, HomologyOptions, generators};

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
    let found = generators(&Cells::new(complex), &HomologyOptions::default()).unwrap();
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
    let options = HomologyOptions { over: Coefficients::Prime(3), ..Default::default() };
    let modulo = generators(&Cells::new(complex), &options).unwrap();
    assert_eq!(modulo.iter().map(Vec::len).collect::<Vec<_>>(), over(complex, Coefficients::Prime(3)).betti);
    for (dim, all) in modulo.iter().enumerate() {
        for generator in all {
            assert!(boundary(complex, dim, &generator.cycle).values().all(|value| value % 3 == BigInt::from(0)));
        }
    }
    let rational = HomologyOptions { over: Coefficients::Rationals, ..Default::default() };
    let rational = generators(&Cells::new(complex), &rational).unwrap();
    assert_eq!(rational.iter().map(Vec::len).collect::<Vec<_>>(), homology.betti);
}

fn column(chain: &Chain, cells: &[CellId], prime: i64) -> BTreeMap<usize, i64> {
    let entry = |(cell, value): &(u32, BigInt)| (cells[*cell as usize].index(), i64::try_from(value % prime).unwrap());
    chain.iter().map(entry).collect()
}
