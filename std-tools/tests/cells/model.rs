//! The incidence graph as the paper writes it: a label for each pair of cells, and nothing else.

use std::collections::{BTreeMap, BTreeSet};

use sig_core::CellId;
use sig_tools::cells::CellComplex;

#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Model {
    pub(crate) dims: BTreeMap<CellId, usize>,
    /// ϕ and the signed incidence number, by i-cell and (i+1)-cell.
    pub(crate) labels: BTreeMap<(CellId, CellId), (u32, i32)>,
}

impl Model {
    pub(crate) fn of(complex: &CellComplex) -> Self {
        let dims = complex.cells().map(|cell| (cell, complex.dim_of(cell).unwrap())).collect();
        let labels = complex.cells().flat_map(|high| {
            let arcs = complex.boundary(high);
            arcs.map(move |arc| ((arc.cell, high), (arc.incidence.multiplicity, arc.incidence.sign)))
        });
        Self { dims, labels: labels.collect() }
    }

    pub(crate) fn below(&self, cell: CellId) -> BTreeSet<CellId> {
        self.labels.keys().filter(|(_, high)| *high == cell).map(|(low, _)| *low).collect()
    }

    pub(crate) fn above(&self, cell: CellId) -> BTreeSet<CellId> {
        self.labels.keys().filter(|(low, _)| *low == cell).map(|(_, high)| *high).collect()
    }

    /// The pairs that one of the rules of 4.1 and 4.2 allows to kill: for each, whether the first type and the second type do.
    pub(crate) fn feasible(&self) -> Vec<(CellId, CellId, bool, bool)> {
        let once = self.labels.iter().filter(|(_, label)| label.0 == 1).map(|(&pair, _)| pair);
        let rules = once.map(|(low, high)| {
            let numbers = [self.below(high).len(), self.above(low).len()];
            let second = numbers.contains(&1);
            (low, high, numbers.contains(&2) && !second, second)
        });
        rules.filter(|&(_, _, first, second)| first || second).collect()
    }

    /// 4.2: ϕ'(p',r) = ϕ(p',r) + ϕ(p',q)·ϕ(p,r), and the signed numbers so that the p-component of the boundary of r is
    /// cancelled by the boundary of q.
    pub(crate) fn kill(&mut self, low: CellId, high: CellId) {
        let label = |low, high| self.labels.get(&(low, high)).copied();
        let unit = label(low, high).unwrap();
        let mut changes = Vec::new();
        for r in self.above(low) {
            for s in self.below(high) {
                if r != high && s != low {
                    let (phi, sign) = label(s, r).unwrap_or((0, 0));
                    let (along, back) = (label(low, r).unwrap(), label(s, high).unwrap());
                    changes.push(((s, r), (phi + back.0 * along.0, sign - along.1 * unit.1 * back.1)));
                }
            }
        }
        self.labels.extend(changes);
        self.labels.retain(|&(a, b), _| ![a, b].contains(&low) && ![a, b].contains(&high));
        self.dims.retain(|&cell, _| cell != low && cell != high);
    }
}
