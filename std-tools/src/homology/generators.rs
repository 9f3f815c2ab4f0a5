//! Cycles that generate homology, as chains of the cells of the complex: those of the Morse complex, carried back along the pairs.

use std::collections::{BTreeMap, BTreeSet};

use num_bigint::BigInt;
use sig_core::Dim;

use super::bits::Bits;
use super::cancel::{Reduced, cancel};
use super::chains::{Chains, Level};
use super::cochains::{ByCritical, Cochains};
use super::limits::Watch;
use super::matching::{Matching, NONE, pair};
use super::ring::{Integers, Overflow, PrimeField, Ring, Sparse, add_multiple};
use super::shorten::{Graph, shorten};
use super::smith::Smith;
use crate::build::narrow;

use super::{Coefficients, Failure, HomologyError, HomologyOptions, all_critical, check_closed, check_size, is_prime};

/// The most critical cells of a dimension that are left when no two of unit incidence are: matrices on them are dense.
const MOST_LEFT: usize = 2000;

/// A chain: cells by their number in their dimension, increasing, with their coefficients.
pub type Chain = Vec<(u32, BigInt)>;

/// A cycle, the class of which generates a cyclic summand of a homology group.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Generator {
    /// The order of the class; `None` if no multiple of it vanishes.
    pub order: Option<BigInt>,
    /// The cycle.
    pub cycle: Chain,
    /// Of a class of finite order, a chain whose boundary is the cycle times the order.
    pub bounds: Option<Chain>,
    /// Of a class of infinite order, if it was asked for, a cocycle that is 1 on the cycle and 0 on the other ones.
    pub cocycle: Option<Chain>,
}

/// What to tell of generators.
#[derive(Clone, Copy, Default)]
pub struct GeneratorOptions<'a> {
    /// As for the groups.
    pub homology: HomologyOptions<'a>,
    /// Whether to find the dual cocycles.
    pub cocycles: bool,
    /// The lengths of the edges by number, none negative: cycles of dimension 1 are then shortened (`shorten`), if coefficients are no
    /// prime field and homology is not relative.
    pub lengths: Option<&'a (dyn Fn(u32) -> f64 + Sync)>,
}

/// Generators of the homology groups of a complex, dimension by dimension: of each, those of finite order first, by orders each
/// dividing the next; the group is the direct sum of the cyclic ones that they generate.
///
/// That the boundary of every cycle vanishes, that the chains bound what they should, and that cocycles are dual to the cycles is
/// checked before they are returned. Memory: the boundaries of all cells, and dense matrices on what no cancellation of cells of
/// unit incidence takes out: cells that have to do with torsion.
///
/// # Errors
/// [`HomologyError`], among them [`HomologyError::TooManyCritical`] and, where a limit is reached, [`HomologyError::Stopped`].
pub fn generators(chains: &impl Chains, options: &GeneratorOptions<'_>) -> Result<Vec<Vec<Generator>>, HomologyError> {
    let found = match options.homology.over {
        Coefficients::Prime(prime) if !is_prime(prime) => return Err(HomologyError::NotPrime(prime)),
        Coefficients::Prime(prime) => Morse::new(&PrimeField(prime), chains, options)?.generators(),
        Coefficients::Integers | Coefficients::Rationals => Morse::new(&Integers, chains, options)?.generators(),
    };
    let mut found = found.map_err(HomologyError::from)?;
    if options.homology.over == Coefficients::Rationals {
        found.iter_mut().for_each(|all| all.retain(|generator| generator.order.is_none()));
    }
    Ok(found)
}

/// The pairs of a complex, with its boundaries.
pub(super) struct Morse<'r, R: Ring> {
    pub(super) ring: &'r R,
    pub(super) watch: Watch<'r>,
    options: GeneratorOptions<'r>,
    pub(super) counts: Vec<usize>,
    /// How many groups are wanted.
    wanted: usize,
    matchings: Vec<Matching>,
    /// For each matching.
    steps: Vec<Steps>,
    pub(super) levels: Vec<Level<'r>>,
    subcomplex: Vec<Bits>,
}

/// A generator with coefficients of the ring.
struct Found<E> {
    order: Option<E>,
    cycle: Sparse<E>,
    bounds: Option<Sparse<E>>,
    cocycle: Option<Sparse<E>>,
}

/// A generator as a chain of critical cells.
struct OfCritical<E> {
    order: Option<E>,
    cycle: Sparse<E>,
    bounds: Option<Sparse<E>>,
    /// Of a class of infinite order.
    cocycle: Option<Sparse<E>>,
}

impl<'r, R: Ring> Morse<'r, R> {
    fn new(ring: &'r R, chains: &'r impl Chains, options: &GeneratorOptions<'r>) -> Result<Self, HomologyError> {
        let HomologyOptions { relative_to, max_dim, limits, .. } = options.homology;
        let mut counts = chains.counts();
        let subcomplex = check_size(&counts, relative_to)?;
        let wanted = max_dim.map_or(counts.len(), |max_dim| counts.len().min(max_dim.saturating_add(1)));
        // A group needs the boundaries of one dimension more.
        counts.truncate(wanted + 1);
        let watch = Watch::new(limits, counts.iter().map(|&count| count as u64).sum());
        watch.need((1..counts.len()).map(|dim| super::bytes(&counts, dim - 1)).sum())?;
        let mut gone = subcomplex.clone();
        let mut levels: Vec<Level<'_>> = Vec::new();
        for dim in 0..counts.len() {
            levels.push(chains.level(dim, levels.last()));
        }
        let mut matchings = Vec::new();
        for dim in 0..counts.len() {
            let (lower, upper) = gone.split_at_mut(dim + 1);
            let above = levels.get(dim + 1).zip(upper.first_mut());
            matchings.push(match above {
                Some((above, gone_above)) => {
                    check_closed(above, dim + 1, relative_to)?;
                    pair(counts[dim], &lower[dim], above, gone_above, &watch)?
                }
                None => all_critical(counts[dim], &lower[dim]),
            });
        }
        let steps = counts.iter().zip(&matchings).map(|(&count, matching)| Steps::new(count, matching)).collect();
        Ok(Self { ring, watch, options: *options, counts, wanted, matchings, steps, levels, subcomplex })
    }

    fn generators(&self) -> Result<Vec<Vec<Generator>>, Failure> {
        let mut found = Vec::new();
        let mut below = cancel(self.ring, Vec::new(), &BTreeSet::new(), &self.watch)?;
        let graph = self.options.lengths.and(self.levels.get(1)).map(|edges| Graph::new(self.counts[0], edges));
        for dim in 0..self.wanted {
            let cochains = self.cochains(dim)?;
            let above = cancel(self.ring, self.boundaries(dim + 1, cochains.as_ref())?, &below.gone[1], &self.watch)?;
            let mut of_dim = Vec::new();
            let inverse = cochains.as_ref().filter(|_| self.options.cocycles).map(Cochains::by_critical);
            for critical in self.of_critical(dim, &below, &above)? {
                let generator = self.carried_back(dim, critical, inverse.as_ref())?;
                let graph = graph.as_ref().filter(|_| dim == 1);
                of_dim.push(self.shortened(dim, generator, cochains.as_ref().zip(graph))?);
            }
            self.certify(dim, &of_dim)?;
            found.push(of_dim.into_iter().map(|generator| self.in_integers(generator)).collect());
            below = above;
        }
        Ok(found)
    }

    /// The cochains on the cells of a dimension, if any are above.
    fn cochains(&self, dim: Dim) -> Result<Option<Cochains<R::Element>>, Failure> {
        let Some(level) = self.levels.get(dim + 1) else { return Ok(None) };
        Cochains::new(self.ring, self.counts[dim], &self.matchings[dim], level, &self.watch).map(Some)
    }

    /// The boundaries of the critical cells of a dimension, over the critical cells of the one below.
    fn boundaries(&self, dim: Dim, below: Option<&Cochains<R::Element>>) -> Result<Vec<Sparse<R::Element>>, Failure> {
        let (Some(matching), Some(cochains)) = (self.matchings.get(dim), below) else { return Ok(Vec::new()) };
        let level = &self.levels[dim];
        let column = |&cell: &u32| Ok(cochains.coboundary(self.ring, level, cell as usize)?);
        matching.critical.iter().map(column).collect()
    }

    /// The generators as chains of critical cells: the cells that no boundary has to do with, when no two are left of unit
    /// incidence, and what a normal form makes of the rest.
    fn of_critical(
        &self,
        dim: Dim,
        below: &Reduced<R::Element>,
        above: &Reduced<R::Element>,
    ) -> Result<Vec<OfCritical<R::Element>>, Failure> {
        let ring = self.ring;
        let size = self.matchings[dim].critical.len();
        let is_left = |cell: &u32| !below.gone[1].contains(cell) && !above.gone[0].contains(cell);
        // A cell of this dimension that went upwards is on no boundary any more.
        let has_boundary = |cell: &u32| below.columns.get(*cell as usize).is_some_and(|column| !column.is_empty());
        let bounded: BTreeSet<u32> = above.columns.iter().flatten().map(|(row, _)| *row).collect();
        let (tied, free): (Vec<u32>, Vec<u32>) =
            (0..narrow(size)).filter(is_left).partition(|cell| has_boundary(cell) || bounded.contains(cell));
        if tied.len() > MOST_LEFT {
            return Err(HomologyError::TooManyCritical { dim, critical: tied.len() }.into());
        }
        let mut found = self.tied(&tied, below, above)?;
        for cell in free {
            let unit = vec![(cell, ring.of(1))];
            found.push(OfCritical { order: None, cycle: unit.clone(), bounds: None, cocycle: Some(unit) });
        }
        for OfCritical { cycle, bounds, cocycle, .. } in &mut found {
            below.extend_chain(ring, cycle)?;
            if let Some(bounds) = bounds {
                above.extend_chain(ring, bounds)?;
            }
            if let Some(cocycle) = cocycle.as_mut().filter(|_| self.options.cocycles) {
                above.extend_cochain(ring, cocycle)?;
            }
        }
        Ok(found)
    }

    /// Those of the cells that have to do with boundaries.
    fn tied(
        &self,
        tied: &[u32],
        below: &Reduced<R::Element>,
        above: &Reduced<R::Element>,
    ) -> Result<Vec<OfCritical<R::Element>>, Failure> {
        let ring = self.ring;
        let spread = |values: &[R::Element], cells: &[u32]| -> Sparse<R::Element> {
            let values = cells.iter().copied().zip(values.iter().cloned());
            values.filter(|(_, value)| !ring.is_zero(value)).collect()
        };
        let cycles = {
            let columns: Vec<&Sparse<R::Element>> =
                tied.iter().filter_map(|&cell| below.columns.get(cell as usize)).collect();
            Smith::new(ring, dense(ring, &columns), tied.len(), &self.watch)?
        };
        let of_above: Vec<u32> =
            (0_u32..).zip(&above.columns).filter(|(_, column)| !column.is_empty()).map(|(cell, _)| cell).collect();
        let kernel = cycles.rank()..tied.len();
        let mut matrix = vec![Vec::with_capacity(of_above.len()); kernel.len()];
        for &cell in &of_above {
            let mut vector = vec![ring.of(0); tied.len()];
            for (row, value) in &above.columns[cell as usize] {
                if let Ok(at) = tied.binary_search(row) {
                    vector[at] = value.clone();
                }
            }
            for (row, at) in matrix.iter_mut().zip(kernel.clone()) {
                row.push(cycles.coordinate(at, &vector)?);
            }
        }
        let bounded = Smith::new(ring, matrix, of_above.len(), &self.watch)?;
        let mut found = Vec::new();
        for (at, combination) in bounded.left().iter().enumerate() {
            let order = (at < bounded.rank()).then(|| bounded.entry(at));
            if order.is_some_and(|order| ring.inverse(order).is_some()) {
                continue;
            }
            let mut cycle = sum_of(ring, combination, &cycles.right()[kernel.clone()], tied.len())?;
            let mut order = order.cloned();
            // Orders are positive: the cycle turns round where they are not.
            if let Some(negative) = order.clone().filter(|order| ring.integer(order) < BigInt::from(0)) {
                order = Some(ring.negate(&negative)?);
                for value in &mut cycle {
                    *value = ring.negate(value)?;
                }
            }
            let cocycle =
                sum_of(ring, &bounded.left_inverse()[at], &cycles.right_inverse()[kernel.clone()], tied.len())?;
            found.push(OfCritical {
                bounds: order.as_ref().map(|_| spread(&bounded.right()[at], &of_above)),
                cocycle: order.is_none().then(|| spread(&cocycle, tied)),
                cycle: spread(&cycle, tied),
                order,
            });
        }
        Ok(found)
    }

    /// A generator as chains of all cells.
    fn carried_back(
        &self,
        dim: Dim,
        critical: OfCritical<R::Element>,
        cochains: Option<&ByCritical<'_, R::Element>>,
    ) -> Result<Found<R::Element>, Failure> {
        let OfCritical { order, cycle, bounds, cocycle } = critical;
        let cocycle = match (cocycle.filter(|_| self.options.cocycles), cochains) {
            (Some(values), Some(cochains)) => Some(cochains.combination(self.ring, &values)?),
            // Nothing is above: cochains of critical cells are cochains.
            (Some(values), None) => {
                let critical = &self.matchings[dim].critical;
                Some(values.into_iter().map(|(at, value)| (critical[at as usize], value)).collect())
            }
            (None, _) => None,
        };
        Ok(Found {
            order,
            cycle: self.lift(dim, &cycle)?,
            bounds: bounds.map(|bounds| self.lift(dim + 1, &bounds)).transpose()?,
            cocycle,
        })
    }

    /// The generator with a shorter cycle, if that is asked for.
    fn shortened(
        &self,
        dim: Dim,
        mut generator: Found<R::Element>,
        cochains: Option<(&Cochains<R::Element>, &Graph)>,
    ) -> Result<Found<R::Element>, Failure> {
        let is_possible = self.options.homology.relative_to.is_none()
            && !matches!(self.options.homology.over, Coefficients::Prime(_));
        let Some((lengths, (cochains, graph))) = self.options.lengths.zip(cochains).filter(|_| is_possible) else {
            return Ok(generator);
        };
        let shorter = shorten(self, (cochains, graph), &generator.cycle, lengths)?;
        // What the cycle moved over, which is the proof that the class is the same.
        let mut difference = generator.cycle;
        add_multiple(self.ring, &mut difference, &self.ring.of(-1), &shorter)?;
        let between = self.bounding(dim, &difference)?;
        if self.boundary(dim + 1, &between)? != difference {
            return Err(HomologyError::BoundaryOfBoundary { dim: dim + 1 }.into());
        }
        if let Some((order, bounds)) = generator.order.as_ref().zip(generator.bounds.as_mut()) {
            add_multiple(self.ring, bounds, &self.ring.negate(order)?, &between)?;
        }
        generator.cycle = shorter;
        Ok(generator)
    }

    /// A chain whose boundary is a cycle, if there is one: each cell in turn that went with a coface is pushed over it.
    pub(super) fn bounding(&self, dim: Dim, cycle: &Sparse<R::Element>) -> Result<Sparse<R::Element>, Overflow> {
        let mut left: BTreeMap<u32, R::Element> = BTreeMap::new();
        for (cell, value) in cycle {
            if let Some(at) = self.steps[dim].of(*cell) {
                left.insert(at, value.clone());
            }
        }
        let mut chain = BTreeMap::new();
        self.push_down(dim, left, &mut chain)?;
        chain.into_iter().map(|(cell, value)| Ok((cell, self.ring.negate(&value)?))).collect()
    }

    /// A chain of critical cells with such multiples of cells that went with a face that no cell is left on its boundary that
    /// went with a coface.
    fn lift(&self, dim: Dim, critical: &Sparse<R::Element>) -> Result<Sparse<R::Element>, Overflow> {
        let of_critical = &self.matchings[dim].critical;
        let cells = critical.iter().map(|(at, value)| (of_critical[*at as usize], value.clone()));
        let mut chain: BTreeMap<u32, R::Element> = cells.collect();
        if let Some(below) = dim.checked_sub(1) {
            let mut left = BTreeMap::new();
            for (&cell, value) in &chain {
                self.add_boundary(dim, &mut left, cell, value)?;
            }
            self.push_down(below, left, &mut chain)?;
        }
        Ok(chain.into_iter().collect())
    }

    /// Adds the cells on the boundary of a cell that went with a coface, by their step.
    fn add_boundary(
        &self,
        dim: Dim,
        left: &mut BTreeMap<u32, R::Element>,
        cell: u32,
        value: &R::Element,
    ) -> Result<(), Overflow> {
        for (face, coefficient) in self.levels[dim].boundary(cell as usize) {
            if let Some(at) = self.steps[dim - 1].of(face) {
                let sum = left.entry(at).or_insert_with(|| self.ring.of(0));
                *sum = self.ring.add_product(sum, value, &self.ring.of(coefficient))?;
            }
        }
        Ok(())
    }

    /// Adds to a chain such multiples of cofaces that nothing is left of cells of dimension `below`, given by their step, that went
    /// with one. What is added for one lies at earlier steps.
    fn push_down(
        &self,
        below: Dim,
        mut left: BTreeMap<u32, R::Element>,
        chain: &mut BTreeMap<u32, R::Element>,
    ) -> Result<(), Overflow> {
        let level = &self.levels[below + 1];
        while let Some((at, value)) = left.pop_last() {
            if self.ring.is_zero(&value) {
                continue;
            }
            let step = self.matchings[below].steps[at as usize];
            let own = level.boundary(step.coface as usize).find(|(face, _)| *face == step.cell);
            let own = own.map_or(1, |(_, coefficient)| coefficient);
            let value = self.ring.add_product(&self.ring.of(0), &value, &self.ring.of(-own))?;
            self.add_boundary(below + 1, &mut left, step.coface, &value)?;
            left.remove(&at);
            chain.insert(step.coface, value);
        }
        Ok(())
    }

    /// Checks that cycles are cycles, that chains bound what they should, and that cocycles are cocycles and dual to the cycles.
    fn certify(&self, dim: Dim, found: &[Found<R::Element>]) -> Result<(), Failure> {
        let ring = self.ring;
        let cocycles: Vec<&Sparse<R::Element>> = found.iter().filter_map(|found| found.cocycle.as_ref()).collect();
        let values = Values::new(self.counts[dim], &cocycles);
        let mut is_certain = self.are_cocycles(dim, &values)?;
        let mut number = 0;
        for Found { order, cycle, bounds, cocycle } in found {
            self.watch.look(0)?;
            is_certain &= self.is_certain(dim, cycle, order.as_ref().zip(bounds.as_ref()))?;
            if !cocycles.is_empty() && order.is_none() {
                let products = values.on(ring, cycle.iter().map(|(cell, value)| (*cell, value.clone())))?;
                is_certain &= products == [(number, ring.of(1))];
                number += u32::from(cocycle.is_some());
            }
        }
        if is_certain { Ok(()) } else { Err(HomologyError::BoundaryOfBoundary { dim: dim + 1 }.into()) }
    }

    /// Whether cochains vanish on all boundaries.
    fn are_cocycles(&self, dim: Dim, values: &Values<'_, R::Element>) -> Result<bool, Overflow> {
        let Some(level) = self.levels.get(dim + 1) else { return Ok(true) };
        for coface in 0..level.num_cells() {
            let boundary = level.boundary(coface).filter(|(face, _)| values.support.contains(*face as usize));
            let boundary = boundary.map(|(face, coefficient)| (face, self.ring.of(coefficient)));
            if !values.on(self.ring, boundary)?.is_empty() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn in_integers(&self, found: Found<R::Element>) -> Generator {
        let chain = |chain: Sparse<R::Element>| {
            chain.into_iter().map(|(cell, value)| (cell, self.ring.integer(&value))).collect::<Chain>()
        };
        Generator {
            order: found.order.map(|order| self.ring.integer(&order)),
            cycle: chain(found.cycle),
            bounds: found.bounds.map(chain),
            cocycle: found.cocycle.map(chain),
        }
    }

    /// Whether a chain is a cycle, and the boundary of another one is a multiple of it.
    fn is_certain(
        &self,
        dim: Dim,
        cycle: &Sparse<R::Element>,
        bounds: Option<(&R::Element, &Sparse<R::Element>)>,
    ) -> Result<bool, Overflow> {
        let is_cycle = dim == 0 || self.boundary(dim, cycle)?.is_empty();
        let Some((order, bounds)) = bounds else { return Ok(is_cycle) };
        let zero = self.ring.of(0);
        let mut multiple = Vec::new();
        for (cell, value) in cycle {
            multiple.push((*cell, self.ring.add_product(&zero, order, value)?));
        }
        Ok(is_cycle && self.boundary(dim + 1, bounds)? == multiple)
    }

    /// The boundary of a chain, without what lies in the subcomplex.
    fn boundary(&self, dim: Dim, chain: &Sparse<R::Element>) -> Result<Sparse<R::Element>, Overflow> {
        let mut sum: BTreeMap<u32, R::Element> = BTreeMap::new();
        for (cell, value) in chain {
            for (face, coefficient) in self.levels[dim].boundary(*cell as usize) {
                if !self.subcomplex[dim - 1].contains(face as usize) {
                    let entry = sum.entry(face).or_insert_with(|| self.ring.of(0));
                    *entry = self.ring.add_product(entry, value, &self.ring.of(coefficient))?;
                }
            }
        }
        Ok(sum.into_iter().filter(|(_, value)| !self.ring.is_zero(value)).collect())
    }
}

/// The numbers of the steps at which cells went with cofaces.
struct Steps {
    /// Of each cell, [`NONE`] if it did not.
    of_cell: Vec<u32>,
}

impl Steps {
    fn new(num_cells: usize, matching: &Matching) -> Self {
        let mut of_cell = vec![NONE; num_cells];
        for (at, step) in (0..).zip(&matching.steps).filter(|(_, step)| step.coface != NONE) {
            of_cell[step.cell as usize] = at;
        }
        Self { of_cell }
    }

    fn of(&self, cell: u32) -> Option<u32> {
        Some(self.of_cell[cell as usize]).filter(|&at| at != NONE)
    }
}

/// The sum of multiples of vectors of a size.
fn sum_of<R: Ring>(
    ring: &R,
    factors: &[R::Element],
    vectors: &[Vec<R::Element>],
    size: usize,
) -> Result<Vec<R::Element>, Overflow> {
    let mut sum = vec![ring.of(0); size];
    for (factor, vector) in factors.iter().zip(vectors).filter(|(factor, _)| !ring.is_zero(factor)) {
        for (sum, value) in sum.iter_mut().zip(vector) {
            *sum = ring.add_product(sum, factor, value)?;
        }
    }
    Ok(sum)
}

/// The values of some cochains by cell.
struct Values<'v, E> {
    support: Bits,
    /// Cell, cochain, and its value there; sorted.
    values: Vec<(u32, u32, &'v E)>,
}

impl<'v, E: Clone> Values<'v, E> {
    fn new(num_cells: usize, cochains: &[&'v Sparse<E>]) -> Self {
        let mut values = Vec::new();
        for (number, cochain) in (0_u32..).zip(cochains) {
            values.extend(cochain.iter().map(|(cell, value)| (*cell, number, value)));
        }
        values.sort_unstable_by_key(|&(cell, cochain, _)| (cell, cochain));
        let mut support = Bits::new(num_cells);
        values.iter().for_each(|(cell, ..)| support.insert(*cell as usize));
        Self { support, values }
    }

    /// The values of the cochains on a chain, those that are not zero.
    fn on<R: Ring<Element = E>>(&self, ring: &R, chain: impl Iterator<Item = (u32, E)>) -> Result<Sparse<E>, Overflow> {
        let mut sums: BTreeMap<u32, E> = BTreeMap::new();
        for (cell, coefficient) in chain {
            let first = self.values.partition_point(|(other, ..)| *other < cell);
            for (_, cochain, value) in self.values[first..].iter().take_while(|(other, ..)| *other == cell) {
                let sum = sums.entry(*cochain).or_insert_with(|| ring.of(0));
                *sum = ring.add_product(sum, &coefficient, value)?;
            }
        }
        Ok(sums.into_iter().filter(|(_, sum)| !ring.is_zero(sum)).collect())
    }
}

/// Sparse columns as the rows of a dense matrix, without rows of zeros.
fn dense<R: Ring>(ring: &R, columns: &[&Sparse<R::Element>]) -> Vec<Vec<R::Element>> {
    let rows: BTreeSet<u32> = columns.iter().flat_map(|column| column.iter().map(|(row, _)| *row)).collect();
    let rows: Vec<u32> = rows.into_iter().collect();
    let mut matrix = vec![vec![ring.of(0); columns.len()]; rows.len()];
    for (number, column) in columns.iter().enumerate() {
        for (row, value) in *column {
            if let Ok(at) = rows.binary_search(row) {
                matrix[at][number] = value.clone();
            }
        }
    }
    matrix
}
