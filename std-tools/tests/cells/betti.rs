//! Betti numbers by the rank of the boundary matrices modulo a prime: the oracle of what operators keep.

use std::collections::BTreeMap;

use sig_tools::cells::CellComplex;

/// b_i for each dimension, over the field of `prime` elements.
pub(crate) fn betti(complex: &CellComplex, prime: i64) -> Vec<usize> {
    let dims = complex.counts().len();
    let mut ranks = vec![0; dims + 1];
    for (dim, rank) in ranks.iter_mut().enumerate().take(dims).skip(1) {
        let cells = complex.cells().filter(|&cell| complex.dim_of(cell) == Some(dim));
        let columns = cells.map(|cell| {
            let entries = complex.boundary(cell).map(|arc| (arc.cell.index(), i64::from(arc.incidence.sign)));
            entries.collect::<BTreeMap<_, _>>()
        });
        *rank = rank_of(columns, prime);
    }
    (0..dims).map(|dim| complex.counts()[dim] - ranks[dim] - ranks[dim + 1]).collect()
}

/// Betti numbers over F_2 and F_3.
pub(crate) fn both(complex: &CellComplex) -> [Vec<usize>; 2] {
    [2, 3].map(|prime| betti(complex, prime))
}

/// Gauss elimination: each reduced column is kept by its lowest row, scaled to 1 there.
pub(crate) fn rank_of(columns: impl Iterator<Item = BTreeMap<usize, i64>>, prime: i64) -> usize {
    let mut pivots: BTreeMap<usize, BTreeMap<usize, i64>> = BTreeMap::new();
    for mut column in columns {
        column.values_mut().for_each(|value| *value = value.rem_euclid(prime));
        column.retain(|_, value| *value != 0);
        while let Some((&row, &value)) = column.last_key_value() {
            let Some(pivot) = pivots.get(&row) else {
                let inverse = (1..prime).find(|inverse| inverse * value % prime == 1).expect("a field");
                column.values_mut().for_each(|value| *value = *value * inverse % prime);
                pivots.insert(row, column);
                break;
            };
            for (&row, &entry) in pivot {
                let sum = column.entry(row).or_insert(0);
                *sum = (*sum - value * entry).rem_euclid(prime);
            }
            column.retain(|_, value| *value != 0);
        }
    }
    pivots.len()
}
