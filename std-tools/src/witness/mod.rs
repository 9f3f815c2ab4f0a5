//! Witness complexes (simplex-tree-2012, 3.2): few landmarks carry the simplices, many witnesses say which.
//!
//! A witness w *ρ-witnesses* a simplex σ of landmarks if no landmark outside of σ is nearer to w than one inside by
//! more than ρ: d(w, x) − d(w, y) ≤ ρ for all x ∈ σ and y ∉ σ (Definition 2; for ρ = 0 Definition 1, the strict
//! witness complex). The complex has the simplices all of whose faces are witnessed. [`witness_complex`] builds it:
//!
//! 1. `table` finds the nearest landmarks of every witness, all that is needed of the points; `sieve` says cheaply which
//!    are not near;
//! 2. dimension by dimension, `candidates` finds what the active witnesses witness, and `levels` keeps what has all
//!    facets in the level below: the arrays of a [`FrozenTree`].
//!
//! Two invariants hold before dimension j is looked at, as in the paper: the levels are the (j − 1)-skeleton of the
//! complex, and a witness that is active no longer witnesses no (j − 1)-simplex of it. An active witness of a single
//! (j − 1)-simplex points to it.
//!
//! The result is that of the definition, ties included: a witness with several landmarks at one distance witnesses every
//! choice among them. Nowhere does a tie decide on a simplex; tables list the landmark of the lower number first.
//!
//! [`landmarks`] chooses landmarks, [`insertion`] adds one to a complex that stands.

mod candidates;
pub mod insertion;
pub mod landmarks;
mod levels;
mod sieve;
mod table;
#[cfg(test)]
mod tests;

use std::marker::PhantomData;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use sig_core::{Dim, MAX_DIM};

use crate::build::{available_memory, narrow};
use crate::frozen::{FrozenTree, MAX_SIMPLICES};
use crate::points::{Metric, Points, PointsError};

use candidates::{ABSENT, Finder, Found, Memory, Outcome, Pointer};
pub use landmarks::Landmarks;
use levels::{Candidate, Levels};
use table::{Row, Scale, Search, Table};

/// How much farther a landmark of a simplex may be from a witness than one that is left out.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Relaxation {
    /// d(w, x) − d(w, y) ≤ ρ: the paper's ρ, on distances.
    Distance(f64),
    /// d(w, x)² − d(w, y)² ≤ α²: on squared distances, as GUDHI's `max_alpha_square`. For a given bound the complexes
    /// differ, as d² grows faster where d is large; without relaxation they are the same but for distances that only
    /// rounding makes equal.
    Squared(f64),
}

impl Relaxation {
    /// No relaxation: the strict witness complex.
    pub const STRICT: Self = Self::Distance(0.0);

    /// ρ or α².
    #[must_use]
    pub fn amount(self) -> f64 {
        match self {
            Self::Distance(amount) | Self::Squared(amount) => amount,
        }
    }
}

/// Strict.
impl Default for Relaxation {
    fn default() -> Self {
        Self::STRICT
    }
}

/// Which witness complex is built. The default: strict, Euclidean, in all dimensions that a file can hold, without
/// filtration.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct WitnessOptions {
    /// The distance.
    pub metric: Metric,
    /// How far a witness looks past the nearest landmarks.
    pub relaxation: Relaxation,
    /// The k of the k-skeleton that is built; at most [`MAX_DIM`].
    pub max_dim: Dim,
    /// Whether each simplex has as filtration value the least relaxation at which it is in the complex. The simplices up
    /// to a value are then exactly the complex of that relaxation.
    pub filtration: bool,
    /// The most simplices that the complex may have; by default as many as the available memory may hold, and never more
    /// than [`MAX_SIMPLICES`].
    pub max_simplices: Option<u64>,
}

impl Default for WitnessOptions {
    fn default() -> Self {
        Self {
            metric: Metric::Euclidean,
            relaxation: Relaxation::STRICT,
            max_dim: MAX_DIM,
            filtration: false,
            max_simplices: None,
        }
    }
}

impl WitnessOptions {
    fn limit(&self) -> u64 {
        /// Bytes that a simplex takes at the least while the complex is built.
        const LEAST_BYTES: u64 = 16;
        let in_memory = || available_memory().map_or(u64::MAX, |bytes| bytes / LEAST_BYTES);
        self.max_simplices.unwrap_or_else(in_memory).min(MAX_SIMPLICES as u64)
    }

    fn check(&self, witnesses: &Points, landmarks: &Points) -> Result<(), WitnessError> {
        let amount = self.relaxation.amount();
        if landmarks.is_empty() {
            return Err(WitnessError::NoLandmarks);
        }
        if !witnesses.is_empty() && witnesses.dim() != landmarks.dim() {
            return Err(WitnessError::Dimensions { witnesses: witnesses.dim(), landmarks: landmarks.dim() });
        }
        if amount.is_nan() || amount < 0.0 {
            return Err(WitnessError::Relaxation(amount));
        }
        if self.max_dim > MAX_DIM {
            return Err(WitnessError::MaxDim(self.max_dim));
        }
        let most = (u32::MAX - 1) as usize;
        match witnesses.len().max(landmarks.len()) {
            points if points > most => Err(WitnessError::TooManyPoints(points)),
            _ => Ok(()),
        }
    }
}

/// Why there is no witness complex.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WitnessError {
    /// There is no landmark.
    #[error("a witness complex needs at least one landmark")]
    NoLandmarks,
    /// More landmarks are asked for than there are points.
    #[error("{asked} landmarks cannot be chosen among {points} points; ask for at most {points}")]
    TooManyLandmarks {
        /// Landmarks asked for.
        asked: usize,
        /// Points there are.
        points: usize,
    },
    /// A landmark is named that is none of the points.
    #[error("landmark {number} is none of the {points} points, which are numbered from 0")]
    NoSuchPoint {
        /// The number that is no point's.
        number: usize,
        /// Points there are.
        points: usize,
    },
    /// Witnesses and landmarks are not points of one space.
    #[error("witnesses have {witnesses} coordinates and landmarks {landmarks}: they must be points of one space")]
    Dimensions {
        /// Coordinates of a witness.
        witnesses: usize,
        /// Coordinates of a landmark.
        landmarks: usize,
    },
    /// The relaxation is negative or not a number.
    #[error("a relaxation of {0} is none: it must be 0 or more")]
    Relaxation(f64),
    /// The largest dimension asked for is more than a file holds.
    #[error("dimension {0} is more than the {MAX_DIM} that a complex can have; ask for less")]
    MaxDim(Dim),
    /// Points are numbered with 32 bits.
    #[error("{0} points are more than 4294967294")]
    TooManyPoints(usize),
    /// The complex is larger than the options allow.
    #[error(
        "the complex has at least {at_least} simplices, more than the limit of {limit}: \
         lower the relaxation or the largest dimension, or take fewer landmarks"
    )]
    TooLarge {
        /// A lower bound for the number of simplices.
        at_least: u64,
        /// The most that are allowed.
        limit: u64,
    },
    /// The simplices that are witnessed, before it is known which have all facets, are more than the memory holds.
    #[error(
        "the witnesses witness more simplices of dimension {dim} than the memory holds: \
         lower the relaxation or the largest dimension"
    )]
    TooManyCandidates {
        /// Their dimension.
        dim: Dim,
    },
    /// A landmark is no point.
    #[error(transparent)]
    Point(#[from] PointsError),
}

/// A witness complex.
#[derive(Clone, PartialEq, Debug)]
pub struct WitnessComplex {
    /// Its simplex tree. Vertices are the landmarks that are in it, by increasing number, which is their label; with
    /// their coordinates.
    pub tree: FrozenTree,
    /// The numbers of the landmarks that are not in it: those that are nearest to no witness, nor within the relaxation
    /// of being so.
    pub absent: Vec<u64>,
}

impl WitnessComplex {
    /// The complex with these levels, where landmarks are these vertices or [`ABSENT`].
    fn new(levels: Levels, landmarks: &Landmarks, vertices: &[u32]) -> Self {
        let (labels, coordinates, absent) = landmarks.split(|landmark| vertices[landmark] != ABSENT);
        Self { tree: levels.freeze(labels, Some(coordinates.into_coordinates())), absent }
    }
}

/// Builds the witness complex of some witnesses and landmarks.
///
/// The same for any number of threads; work runs in rayon's current pool. Time: O(witnesses · landmarks) distances, then
/// for each dimension j a step along the tree for every pair of an active witness and a j-simplex that it witnesses, and
/// j searches in short lists for every simplex found so. Memory: for each witness 12 bytes for every landmark within the
/// relaxation of its nearest `max_dim` + 1; for each simplex 8 bytes, and those of the last dimension their facets; and 8
/// bytes, 16 with filtration, for each simplex of one dimension and each of 64 groups of witnesses that witness it.
///
/// # Errors
/// [`WitnessError`]: nothing to choose from, points of different spaces, a relaxation that is none, a complex that is
/// too large.
///
/// ```
/// use sig_tools::points::Points;
/// use sig_tools::witness::{Landmarks, WitnessOptions, witness_complex};
///
/// // Four corners of a square, and witnesses between neighbours.
/// let landmarks = Points::new(2, vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])?;
/// let witnesses = Points::new(2, vec![0.4, 0.0, 1.0, 0.4, 0.6, 1.0, 0.0, 0.6])?;
/// let complex = witness_complex(&witnesses, &Landmarks::all(landmarks), &WitnessOptions::default())?;
/// assert_eq!(complex.tree.counts(), [4, 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn witness_complex(
    witnesses: &Points,
    landmarks: &Landmarks,
    options: &WitnessOptions,
) -> Result<WitnessComplex, WitnessError> {
    options.check(witnesses, landmarks.points())?;
    if options.filtration {
        Construction::<(u64, u64)>::run(witnesses, landmarks, options)
    } else {
        Construction::<u64>::run(witnesses, landmarks, options)
    }
}

/// A complex under construction, with one kind of candidates.
struct Construction<'a, C> {
    witnesses: &'a Points,
    options: &'a WitnessOptions,
    /// The most simplices, and how many candidates the memory holds.
    limit: u64,
    most_candidates: u64,
    search: Search<'a>,
    /// The nearest landmarks of every active witness, and how many at least.
    table: Table,
    depth: usize,
    /// The active witnesses with their row in the table, and where they stand.
    active: Vec<Active>,
    /// The vertex of each landmark.
    vertices: Vec<u32>,
    levels: Levels,
    kind: PhantomData<C>,
}

#[derive(Clone, Copy)]
struct Active {
    witness: u32,
    row: u32,
    pointer: Pointer,
}

impl<'a, C: Candidate> Construction<'a, C> {
    fn run(
        witnesses: &'a Points,
        landmarks: &'a Landmarks,
        options: &'a WitnessOptions,
    ) -> Result<WitnessComplex, WitnessError> {
        let scale = Scale { metric: options.metric, relaxation: options.relaxation };
        let search = Search::new(landmarks.points(), scale);
        let mut construction = Self::new(witnesses, landmarks.points().len(), search, options)?;
        while construction.levels.len() <= options.max_dim && construction.grow()? {}
        let Self { vertices, levels, .. } = construction;
        Ok(WitnessComplex::new(levels, landmarks, &vertices))
    }

    /// The vertices, and every witness active.
    fn new(
        witnesses: &'a Points,
        num_landmarks: usize,
        search: Search<'a>,
        options: &'a WitnessOptions,
    ) -> Result<Self, WitnessError> {
        /// Strict complexes seldom reach high dimensions: the table starts with so many columns, and grows for those
        /// witnesses that are still active.
        const FIRST_DEPTH: usize = 8;
        let (most, relaxation) = (options.max_dim + 1, options.relaxation.amount());
        let depth = if relaxation == 0.0 { FIRST_DEPTH.min(most) } else { most };
        let all: Vec<u32> = (0..narrow(witnesses.len())).collect();
        let table = search.nearest(witnesses, &all, depth);
        let rows = || all.iter().map(|&witness| table.row(witness as usize));
        let mut values = least_relaxations(rows(), num_landmarks, relaxation);
        let vertices = number_finite(&values);
        let pointer = |row: Row<'_>| match row.width(0, relaxation) {
            1 => Pointer::One(vertices[row.landmarks[0] as usize]),
            _ => Pointer::Several,
        };
        let active =
            all.iter().zip(rows()).map(|(&witness, row)| Active { witness, row: witness, pointer: pointer(row) });
        let active = active.collect();
        values.retain(|value| value.is_finite());
        let count = values.len();
        let (at_least, limit) = (count as u64, options.limit());
        if at_least > limit {
            return Err(WitnessError::TooLarge { at_least, limit });
        }
        let crowd = rows().map(|row| row.width(0, relaxation)).max();
        refuse_crowd(crowd.unwrap_or(0), options.max_dim, limit)?;
        // They are gathered once more before they are looked at.
        let most_candidates = available_memory().map_or(u64::MAX, |bytes| bytes / (2 * size_of::<C>() as u64));
        let levels = Levels::new(count, if C::WITH_VALUE { values } else { Vec::new() });
        Ok(Self {
            witnesses,
            options,
            limit,
            most_candidates,
            search,
            table,
            depth,
            active,
            vertices,
            levels,
            kind: PhantomData,
        })
    }

    /// Adds the simplices of the next dimension; false if there are none.
    fn grow(&mut self) -> Result<bool, WitnessError> {
        /// Tasks: more than threads, as some witnesses see more than others; but simplices are found once in each.
        const TASKS: usize = 64;
        let dim = self.levels.len();
        if dim >= self.depth && !self.active.is_empty() {
            self.look_farther();
        }
        let (levels, table, relaxation) = (&self.levels, &self.table, self.options.relaxation.amount());
        let memory = Memory { held: AtomicU64::new(0), limit: self.most_candidates };
        let look = |active: &[Active]| {
            let mut finder = Finder::<C>::new(levels, &self.vertices, relaxation, &memory);
            for active in active {
                finder.look(table.row(active.row as usize), active.pointer);
            }
            finder.finish()
        };
        let step = self.active.len().div_ceil(TASKS).max(1);
        let found: Vec<Found<C>> = self.active.par_chunks(step).map(look).collect();
        if found.iter().any(|found| !found.is_complete) {
            return Err(WitnessError::TooManyCandidates { dim });
        }
        let outcomes: Vec<Outcome> = found.iter().flat_map(|found| &found.outcomes).copied().collect();
        let parts: Vec<Vec<C>> = found.into_iter().map(|found| found.candidates).collect();
        let (limit, taken) = (self.limit, AtomicU64::new(self.levels.num_simplices()));
        let count = self.levels.grow(&parts, |count| {
            let at_least = taken.fetch_add(count as u64, Ordering::Relaxed).saturating_add(count as u64);
            if at_least > limit { Err(WitnessError::TooLarge { at_least, limit }) } else { Ok(()) }
        })?;
        if count == 0 {
            return Ok(false);
        }
        let mut outcomes = outcomes.into_iter();
        let levels = &self.levels;
        self.active.retain_mut(|active| {
            let pointer = match outcomes.next() {
                None | Some(Outcome::Nothing) => None,
                Some(Outcome::Several) => Some(Pointer::Several),
                Some(Outcome::One(prefix, last)) => {
                    let (first, children) = levels.children(dim - 1, prefix);
                    children.binary_search(&last).ok().map(|position| Pointer::One(first + narrow(position)))
                }
            };
            active.pointer = pointer.unwrap_or(active.pointer);
            pointer.is_some()
        });
        Ok(true)
    }

    /// Makes the table anew for the active witnesses, with twice as many landmarks for each.
    fn look_farther(&mut self) {
        self.depth = (2 * self.depth).min(self.options.max_dim + 1);
        let witnesses: Vec<u32> = self.active.iter().map(|active| active.witness).collect();
        self.table = self.search.nearest(self.witnesses, &witnesses, self.depth);
        for (row, active) in (0..).zip(&mut self.active) {
            active.row = row;
        }
    }
}

/// For each landmark the least relaxation at which some witness witnesses it, or infinity if it is more than the given one.
fn least_relaxations<'a>(rows: impl Iterator<Item = Row<'a>>, num_landmarks: usize, relaxation: f64) -> Vec<f64> {
    let mut values = vec![f64::INFINITY; num_landmarks];
    for row in rows {
        for near in row.iter().take(row.width(0, relaxation)) {
            let value = &mut values[near.landmark as usize];
            *value = value.min(near.distance - row.distances[0]);
        }
    }
    values
}

/// The vertices of the landmarks with a finite value, numbered in their order; [`ABSENT`] for the others.
fn number_finite(values: &[f64]) -> Vec<u32> {
    let mut next = 0..ABSENT;
    values.iter().map(|value| if value.is_finite() { next.next().unwrap_or(ABSENT) } else { ABSENT }).collect()
}

/// Refuses, before they are looked for, more simplices than are allowed: of a crowd of landmarks that are all nearest to
/// one witness, within the relaxation, every subset is in the complex.
fn refuse_crowd(crowd: usize, max_dim: Dim, limit: u64) -> Result<(), WitnessError> {
    let at_least = (0..=max_dim as u64).fold(0, |sum: u64, dim| sum.saturating_add(binomial(crowd as u64, dim + 1)));
    if at_least > limit { Err(WitnessError::TooLarge { at_least, limit }) } else { Ok(()) }
}

/// The number of `k`-subsets of a set of `n`, or the largest number if it does not fit.
fn binomial(n: u64, k: u64) -> u64 {
    if k > n {
        return 0;
    }
    let product = (0..u128::from(k.min(n - k))).try_fold(1_u128, |product, i| {
        let product = product * (u128::from(n) - i) / (i + 1);
        u64::try_from(product).is_ok().then_some(product)
    });
    product.and_then(|product| u64::try_from(product).ok()).unwrap_or(u64::MAX)
}
