//! What each structure takes by the paper's formulas, from the numbers of simplices and clusters of a complex (sig-2004,
//! 4.2 and 7).

use std::fmt;

use sig_core::storage::{ClusterCounts, Storage};
use sig_core::{Complex, Dim, Index, SimplexId};

use crate::analysis::Classes;
use crate::combinatorial_map::{darts_of_simplex, map_integers};

/// The numbers of a complex that the formulas are made of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Numbers {
    /// n_p, the number of p-simplices, for p = 0, …, d.
    pub simplices: Vec<usize>,
    /// n'_p, the number of top p-simplices; κ_p^g; and how many p-simplices have the manifold flag.
    pub clusters: Vec<ClusterCounts>,
    /// c_1: the number of connected components of the restricted star of a vertex, summed over the vertices.
    pub components: usize,
}

impl Numbers {
    /// Counts. Cost: one pass over pointers and lists, and a union-find over the ends of all edges that takes each
    /// triangle three times.
    #[must_use]
    pub fn of<I: Index>(complex: &Complex<'_, I>) -> Self {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        Self {
            simplices: (0..dims).map(|dim| complex.num_simplices_of_dim(dim)).collect(),
            clusters: (0..dims).map(|dim| complex.cluster_counts(dim)).collect(),
            components: components(complex),
        }
    }

    /// d; `None` for the empty complex.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.simplices.len().checked_sub(1)
    }

    /// n_p.
    fn n(&self, dim: Dim) -> Symbol {
        Symbol { name: format!("n_{dim}"), value: self.simplices.get(dim).copied().unwrap_or(0) }
    }

    /// n'_p.
    fn tops(&self, dim: Dim) -> Symbol {
        Symbol { name: format!("n'_{dim}"), value: self.clusters.get(dim).map_or(0, |counts| counts.tops) }
    }

    /// κ_p^g.
    fn kappa(&self, p: Dim, g: Dim) -> Symbol {
        let value = self.clusters.get(p).and_then(|counts| counts.by_dim.get(g)).copied().unwrap_or(0);
        Symbol { name: format!("κ_{p}^{g}"), value }
    }

    fn dims(&self) -> usize {
        self.simplices.len()
    }

    /// Σ n_p of the bits, for p below `dims`.
    fn flags(&self, dims: usize) -> Sum {
        Sum::of((0..dims).map(|p| (1, self.n(p))))
    }

    /// The SIG as a file holds it: 4.2, its general case for the simplices without the manifold flag, which have an entry
    /// for each cluster and a stop code, its manifold case for the f others.
    #[must_use]
    pub fn sig(&self) -> Formula {
        self.sig_with(self.dims().saturating_sub(1))
    }

    /// The specialisation of 7.4: two integers in place of pointer, list and stop code at each (d−1)-simplex, for which
    /// no number of clusters counts, and no flags there.
    #[must_use]
    pub fn sig_pairs(&self) -> Formula {
        self.sig_with(self.dims().saturating_sub(2))
    }

    /// Pointers, lists and flags for dimensions below `listed`, two integers for one below d that is not.
    fn sig_with(&self, listed: usize) -> Formula {
        let dims = self.dims();
        let lookup = Symbol { name: "(d+1)".to_owned(), value: dims };
        let flagged = self.clusters.iter().map(|counts| counts.single_cluster).sum();
        let rows = (0..dims).map(|p| {
            let boundary = if p > 0 { p + 1 } else { 0 };
            (boundary + if p + 1 < dims { 2 } else { 0 }, self.n(p))
        });
        let kappa = (0..listed).flat_map(|p| (p + 1..dims).map(move |g| (1, self.kappa(p, g))));
        let integers = Sum::of([(1, lookup)].into_iter().filter(|_| dims > 0).chain(rows).chain(kappa));
        let flagged = Some(Symbol { name: "f".to_owned(), value: flagged }).filter(|f| f.value > 0);
        Formula { integers: Sum { minus_twice: flagged, ..integers }, bits: self.flags(listed) }
    }

    /// The incidence graph: 7.1.
    #[must_use]
    pub fn incidence_graph(&self) -> Formula {
        let both = |p: Dim| if p > 0 { 2 * (p + 1) } else { 0 };
        let start = |p: Dim| usize::from(p + 1 < self.dims());
        let integers = Sum::of((0..self.dims()).map(|p| (both(p) + start(p), self.n(p))));
        Formula { integers, bits: Sum::default() }
    }

    /// A combinatorial map: mcc-2012, section 8, for (n+1)!/2 darts an n-simplex. Asked for a complex that it represents.
    #[must_use]
    pub fn combinatorial_map(&self) -> Formula {
        let times = |dim: Dim| darts_of_simplex(dim).map_or(0, |darts| map_integers(dim, darts));
        let integers = Sum::of(self.dim().map(|dim| (times(dim), self.n(dim))));
        Formula { integers, bits: Sum::default() }
    }

    /// IA: 7.2. Asked for a complex that it represents.
    #[must_use]
    pub fn indexed(&self) -> Formula {
        let integers = Sum::of(self.dim().map(|dim| (2 * (dim + 1), self.n(dim))));
        Formula { integers, bits: Sum::default() }
    }

    /// TS: 7.3. Asked for a complex that it represents.
    #[must_use]
    pub fn triangle_segment(&self) -> Formula {
        Formula {
            integers: Sum::of([(1, self.n(0)), (9, self.n(2)), (1, self.kappa(0, 1)), (1, self.kappa(0, 2))]),
            bits: Sum::of([(1, self.n(0)), (1, self.n(2))]),
        }
    }

    /// NMIA: 7.4. Asked for a complex that it represents.
    #[must_use]
    pub fn non_manifold_indexed(&self) -> Formula {
        let components = Symbol { name: "c_1".to_owned(), value: self.components };
        let [n0, wires, dangling, n3] = [self.n(0), self.tops(1), self.tops(2), self.n(3)];
        let bits = Sum::of([n0.clone(), wires.clone(), dangling.clone(), n3.clone()].map(|symbol| (1, symbol)));
        let integers = Sum::of([(1, n0), (2, wires), (9, dangling), (16, n3), (1, components)]);
        Formula { integers, bits }
    }
}

/// A number with the name that the paper has for it.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Symbol {
    name: String,
    value: usize,
}

/// What a structure takes by a formula.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Formula {
    /// The integers.
    pub integers: Sum,
    /// The bits.
    pub bits: Sum,
}

impl Formula {
    /// The values of the two sums.
    #[must_use]
    pub fn storage(&self) -> Storage {
        Storage { integers: self.integers.value(), bits: self.bits.value() }
    }
}

/// A sum of multiples of named numbers: `{}` shows the names, `{:#}` the numbers and the result.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Sum {
    terms: Vec<(usize, Symbol)>,
    minus_twice: Option<Symbol>,
}

impl Sum {
    fn of(terms: impl IntoIterator<Item = (usize, Symbol)>) -> Self {
        Self { terms: terms.into_iter().filter(|(times, _)| *times > 0).collect(), minus_twice: None }
    }

    /// The sum.
    #[must_use]
    pub fn value(&self) -> usize {
        let sum = self.terms.iter().map(|(times, symbol)| times * symbol.value).sum::<usize>();
        sum - self.minus_twice.as_ref().map_or(0, |symbol| 2 * symbol.value)
    }
}

impl fmt::Display for Sum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.terms.is_empty() {
            return f.write_str("0");
        }
        let numbers = f.alternate();
        for (place, (times, symbol)) in self.terms.iter().enumerate() {
            f.write_str(if place > 0 { " + " } else { "" })?;
            match (*times, numbers) {
                (1, true) => write!(f, "{}", symbol.value)?,
                (1, false) => f.write_str(&symbol.name)?,
                (times, true) => write!(f, "{times}·{}", symbol.value)?,
                (times, false) => write!(f, "{times} {}", symbol.name)?,
            }
        }
        match &self.minus_twice {
            Some(symbol) if numbers => write!(f, " − 2·{}", symbol.value)?,
            Some(symbol) => write!(f, " − 2 {}", symbol.name)?,
            None => {}
        }
        if numbers { write!(f, " = {}", self.value()) } else { Ok(()) }
    }
}

/// c_1: edges at a vertex are connected where a triangle has both.
fn components<I: Index>(complex: &Complex<'_, I>) -> usize {
    let first = complex.simplices_of_dim(1).bounds().0.index();
    // Ends 2e and 2e + 1 of edge e: the one without its first vertex, the one without its last.
    let end = |edge: SimplexId, side: usize| 2 * (edge.index() - first) + side;
    let ends = 2 * complex.num_simplices_of_dim(1);
    let mut classes = Classes::<u64>::new(ends);
    let mut count = ends;
    for triangle in complex.simplices_of_dim(2) {
        let mut edges = complex.facets(triangle);
        let (Some(bc), Some(ac), Some(ab)) = (edges.next(), edges.next(), edges.next()) else { continue };
        let at_vertices = [(end(ac, 1), end(ab, 1)), (end(bc, 1), end(ab, 0)), (end(bc, 0), end(ac, 0))];
        count -= at_vertices.into_iter().filter(|&(one, other)| classes.join(one, other)).count();
    }
    count
}
