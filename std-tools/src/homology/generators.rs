//! Cycles that generate homology, as chains of the cells of the complex: those of the Morse complex, carried back along the pairs.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use sig_core::Dim;

use super::bits::Bits;
use super::chains::{Chains, Level};
use super::cochains::Cochains;
use super::limits::Watch;
use super::matching::{Matching, NONE, pair};
use super::ring::{Integers, Overflow, PrimeField, Ring, Sparse};
use super::smith::Smith;
use super::{Coefficients, Failure, HomologyError, HomologyOptions, all_critical, check_closed, check_size, is_prime};

/// The most critical cells of a dimension: matrices on them are dense.
const MOST_CRITICAL: usize = 2000;

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
}

/// Generators of the homology groups of a complex, dimension by dimension: of each, those of finite order first, by orders each
/// dividing the next; the group is the direct sum of the cyclic ones that they generate.
///
/// That the boundary of every cycle vanishes, and that the chains bound what they should, is checked before they are returned.
/// Memory: the boundaries of all cells, and dense matrices on the critical cells.
///
/// # Errors
/// [`HomologyError`], among them [`HomologyError::TooManyCritical`].
pub fn generators(chains: &impl Chains, options: &HomologyOptions<'_>) -> Result<Vec<Vec<Generator>>, HomologyError> {
    let found = match options.over {
        Coefficients::Prime(prime) if !is_prime(prime) => return Err(HomologyError::NotPrime(prime)),
        Coefficients::Prime(prime) => Morse::new(&PrimeField(prime), chains, options)?.generators(),
        Coefficients::Integers | Coefficients::Rationals => Morse::new(&Integers, chains, options)?.generators(),
    };
    let mut found = found.map_err(HomologyError::from)?;
    if options.over == Coefficients::Rationals {
        found.iter_mut().for_each(|all| all.retain(|generator| generator.order.is_none()));
    }
    Ok(found)
}

/// The pairs of a complex, with its boundaries.
struct Morse<'r, R: Ring> {
    ring: &'r R,
    watch: Watch<'r>,
    counts: Vec<usize>,
    matchings: Vec<Matching>,
    levels: Vec<Level<'r>>,
    subcomplex: Vec<Bits>,
}

impl<'r, R: Ring> Morse<'r, R> {
    fn new(ring: &'r R, chains: &'r impl Chains, options: &HomologyOptions<'r>) -> Result<Self, HomologyError> {
        let mut counts = chains.counts();
        let subcomplex = check_size(&counts, options.relative_to)?;
        // A group needs the boundaries of one dimension more.
        counts.truncate(options.max_dim.map_or(usize::MAX, |max_dim| max_dim.saturating_add(2)));
        let watch = Watch::new(options.limits, counts.iter().map(|&count| count as u64).sum());
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
                    check_closed(above, dim + 1, options.relative_to)?;
                    pair(counts[dim], &lower[dim], above, gone_above, &watch)?
                }
                None => all_critical(counts[dim], &lower[dim]),
            });
            let critical = matchings[dim].critical.len();
            if critical > MOST_CRITICAL {
                return Err(HomologyError::TooManyCritical { dim, critical });
            }
        }
        Ok(Self { ring, watch, counts, matchings, levels, subcomplex })
    }

    fn generators(&self) -> Result<Vec<Vec<Generator>>, Failure> {
        let mut found = Vec::new();
        let mut cycles = Smith::new(self.ring, Vec::new(), self.matchings.first().map_or(0, |m| m.critical.len()))?;
        for dim in 0..self.matchings.len() {
            let above = self.boundaries(dim + 1)?;
            let columns = self.matchings.get(dim + 1).map_or(0, |matching| matching.critical.len());
            let mut of_dim = Vec::new();
            let kernel = cycles.rank()..cycles.right().len();
            let mut matrix = vec![Vec::with_capacity(columns); kernel.len()];
            for column in 0..columns {
                let vector: Vec<R::Element> = above.iter().map(|row| row[column].clone()).collect();
                for (row, at) in matrix.iter_mut().zip(kernel.clone()) {
                    row.push(cycles.coordinate(at, &vector)?);
                }
            }
            let bounded = Smith::new(self.ring, matrix, columns)?;
            for (at, combination) in bounded.left().iter().enumerate() {
                let order = (at < bounded.rank()).then(|| bounded.entry(at));
                if order.is_some_and(|order| self.ring.inverse(order).is_some()) {
                    continue;
                }
                let mut critical = vec![self.ring.of(0); cycles.right().len()];
                for (factor, vector) in combination.iter().zip(&cycles.right()[cycles.rank()..]) {
                    for (sum, value) in critical.iter_mut().zip(vector) {
                        *sum = self.ring.add_product(sum, factor, value)?;
                    }
                }
                let mut cycle = self.lift(dim, &critical)?;
                let mut order = order.cloned();
                // Orders are positive: the cycle turns round where they are not.
                if let Some(negative) = order.clone().filter(|order| self.ring.integer(order) < BigInt::from(0)) {
                    order = Some(self.ring.negate(&negative)?);
                    for (_, value) in &mut cycle {
                        *value = self.ring.negate(value)?;
                    }
                }
                let bounds = match &order {
                    Some(_) => Some(self.lift(dim + 1, &bounded.right()[at])?),
                    None => None,
                };
                if !self.is_certain(dim, &cycle, order.as_ref().zip(bounds.as_ref()))? {
                    return Err(HomologyError::BoundaryOfBoundary { dim: dim + 1 }.into());
                }
                let chain = |chain: Sparse<R::Element>| {
                    chain.into_iter().map(|(cell, value)| (cell, self.ring.integer(&value))).collect::<Chain>()
                };
                of_dim.push(Generator {
                    order: order.map(|order| self.ring.integer(&order)),
                    cycle: chain(cycle),
                    bounds: bounds.map(chain),
                });
            }
            found.push(of_dim);
            cycles = Smith::new(self.ring, above, columns)?;
        }
        Ok(found)
    }

    /// The boundaries of the critical cells of a dimension, a row for each critical cell of the one below.
    fn boundaries(&self, dim: Dim) -> Result<Vec<Vec<R::Element>>, Failure> {
        let below = &self.matchings[dim - 1];
        let Some((matching, level)) = self.matchings.get(dim).zip(self.levels.get(dim)) else {
            return Ok(vec![Vec::new(); below.critical.len()]);
        };
        let cochains = Cochains::new(self.ring, self.counts[dim - 1], below, level, &self.watch)?;
        let mut matrix = vec![vec![self.ring.of(0); matching.critical.len()]; below.critical.len()];
        for (column, &cell) in matching.critical.iter().enumerate() {
            for (row, value) in cochains.coboundary(self.ring, level, cell as usize)? {
                matrix[row as usize][column] = value;
            }
        }
        Ok(matrix)
    }

    /// A chain of critical cells with such multiples of cells that went with a face that no cell is left on its boundary that
    /// went with a coface.
    fn lift(&self, dim: Dim, critical: &[R::Element]) -> Result<Sparse<R::Element>, Overflow> {
        let ring = self.ring;
        let mut chain: BTreeMap<u32, R::Element> = BTreeMap::new();
        for (&cell, value) in
            self.matchings[dim].critical.iter().zip(critical).filter(|(_, value)| !ring.is_zero(value))
        {
            chain.insert(cell, value.clone());
        }
        if let Some(below) = dim.checked_sub(1) {
            let steps = &self.matchings[below].steps;
            let mut number = vec![NONE; self.counts[below]];
            (0..)
                .zip(steps)
                .filter(|(_, step)| step.coface != NONE)
                .for_each(|(at, step)| number[step.cell as usize] = at);
            let level = &self.levels[dim];
            // The cells on the boundary that went with a coface, by their step. What is added for one lies at earlier steps.
            let mut left: BTreeMap<u32, R::Element> = BTreeMap::new();
            let add = |left: &mut BTreeMap<u32, R::Element>, cell: u32, value: &R::Element| {
                for (face, coefficient) in level.boundary(cell as usize) {
                    if number[face as usize] != NONE {
                        let sum = left.entry(number[face as usize]).or_insert_with(|| ring.of(0));
                        *sum = ring.add_product(sum, value, &ring.of(coefficient))?;
                    }
                }
                Ok::<(), Overflow>(())
            };
            for (&cell, value) in &chain {
                add(&mut left, cell, value)?;
            }
            while let Some((at, value)) = left.pop_last() {
                if ring.is_zero(&value) {
                    continue;
                }
                let step = steps[at as usize];
                let own = level.boundary(step.coface as usize).find(|(face, _)| *face == step.cell);
                let own = own.map_or(1, |(_, coefficient)| coefficient);
                let value = ring.add_product(&ring.of(0), &value, &ring.of(-own))?;
                add(&mut left, step.coface, &value)?;
                left.remove(&at);
                chain.insert(step.coface, value);
            }
        }
        Ok(chain.into_iter().collect())
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
