//! Homology: Betti numbers and torsion coefficients over the integers, the rationals and prime fields, of any complex and
//! relative to any subcomplex.
//!
//! The complex is first reduced, dimension by dimension, by coreductions (`matching`), which pair almost all cells; what is left,
//! the critical cells, are those of a Morse complex with the same homology. Its boundaries come from cochains (`cochains`), its
//! Smith normal form from elimination (`eliminate`). Memory: the boundaries of two dimensions (`chains`; of one, where the file
//! has them), the inverse of one of them and some bytes a cell of these; never those of the whole complex. Time and memory can be
//! limited (`limits`).
//!
//! [`generators()`] gives cycles, too, as chains of the cells of the complex, and the cocycles dual to them: critical cells of unit
//! incidence cancel (`cancel`), a normal form with its bases takes the rest (`smith`), chains go back along the pairs
//! (`generators`), and loops become shorter in their classes (`shorten`).
//!
//! What it cannot do without is reading each face of each cell thrice, to count, to invert and to pair: 4 bytes each time, and as
//! many for each coface that is read when a cell goes.
//!
//! ```
//! use sig_tools::cells::read_cells;
//! use sig_tools::homology::{Cells, Coefficients, HomologyOptions, homology};
//!
//! // The lens space L(3,1).
//! let complex = read_cells("cells 1 1 1 1\n+0 -0\n3*+0\n+0 -0\n".as_bytes(), "lens")?;
//! let over_z = homology(&Cells::new(&complex), &HomologyOptions::default())?;
//! assert_eq!(over_z.betti, [1, 0, 0, 1]);
//! assert_eq!(over_z.torsion[1], [3_u32.into()]);
//! let options = HomologyOptions { over: Coefficients::Prime(3), ..Default::default() };
//! assert_eq!(homology(&Cells::new(&complex), &options)?.betti, [1, 1, 1, 1]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bits;
mod cancel;
mod chains;
mod cochains;
mod eliminate;
mod generators;
mod limits;
mod matching;
mod ring;
mod shorten;
mod smith;

pub use num_bigint::BigInt;
use sig_core::Dim;

use crate::build::narrow;
use bits::Bits;
pub use chains::{Cells, Chains, Level, Simplices};
use cochains::{Below, Cochains};
use eliminate::{Elimination, SmithForm};
pub use generators::{Chain, Generator, GeneratorOptions, generators};
use limits::Watch;
pub use limits::{Limits, Stopped};
use matching::{Matching, pair};
use ring::{Integers, Overflow, PrimeField, Ring, SmallIntegers, Sparse, add_multiple};

/// What the coefficients of chains are.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Coefficients {
    /// ℤ.
    #[default]
    Integers,
    /// ℚ.
    Rationals,
    /// ℤ/p for a prime p.
    Prime(u32),
}

/// What to compute. Make one by `HomologyOptions { over: Coefficients::Rationals, ..Default::default() }`.
#[derive(Clone, Copy, Default)]
pub struct HomologyOptions<'a> {
    /// The coefficients.
    pub over: Coefficients,
    /// For each dimension and each cell of it whether it belongs to a subcomplex; the homology is then relative to this.
    pub relative_to: Option<&'a [Vec<bool>]>,
    /// The highest dimension of a group; that of the complex if `None`. Cells of more than one dimension above it are not
    /// looked at.
    pub max_dim: Option<Dim>,
    /// Time, memory, progress.
    pub limits: Limits<'a>,
}

/// The homology of a complex.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Homology {
    /// The rank of each homology group, up to the dimension of the complex or the highest that was asked for.
    pub betti: Vec<usize>,
    /// The invariant factors of the torsion of each group, each dividing the next; none over a field.
    pub torsion: Vec<Vec<BigInt>>,
    /// The cells of each dimension, without those of the subcomplex.
    pub counts: Vec<usize>,
    /// How many of them are critical, that is, were left by the reduction; of the dimensions whose groups are known.
    pub critical: Vec<usize>,
    /// Why not all groups are known that were asked for: then those of lower dimensions are.
    pub stopped: Option<Stopped>,
}

impl Homology {
    /// χ = Σ (−1)^i n_i, which is Σ (−1)^i β_i.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        alternating(&self.counts)
    }
}

/// Why there is no homology.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HomologyError {
    /// The modulus is not a prime number.
    #[error("{0} is not a prime number")]
    NotPrime(u32),
    /// What homology shall be relative to is no subcomplex.
    #[error("cell {cell} of dimension {dim} belongs to the subcomplex, and one of its faces does not")]
    NotClosed {
        /// The dimension of the cell.
        dim: Dim,
        /// Its number in the dimension.
        cell: usize,
    },
    /// The marks of the subcomplex are not one for each cell.
    #[error("the marks of the subcomplex are not one for each cell")]
    MalformedSubcomplex,
    /// There are more cells of a dimension than 32-bit numbers.
    #[error("{count} cells of dimension {dim} are too many")]
    TooManyCells {
        /// The dimension.
        dim: Dim,
        /// How many there are.
        count: usize,
    },
    /// The reduction left more critical cells than generators can be told of.
    #[error("{critical} critical cells of dimension {dim} are too many for generators")]
    TooManyCritical {
        /// The dimension.
        dim: Dim,
        /// How many there are.
        critical: usize,
    },
    /// The work was to end early.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The boundary of the boundary of some cell is not zero.
    #[error("in dimension {dim} there is a cell the boundary of whose boundary is not zero")]
    BoundaryOfBoundary {
        /// The dimension of the cell.
        dim: Dim,
    },
}

/// The homology of a complex.
///
/// Over the integers in 64 bits; where they do not suffice, all is done again with integers of any size. The result does not
/// depend on the number of threads.
///
/// # Errors
/// [`HomologyError`]. Where a limit is reached, the result is that of lower dimensions.
pub fn homology(chains: &impl Chains, options: &HomologyOptions<'_>) -> Result<Homology, HomologyError> {
    let mut homology = match options.over {
        Coefficients::Prime(prime) if !is_prime(prime) => return Err(HomologyError::NotPrime(prime)),
        Coefficients::Prime(prime) => compute(&PrimeField(prime), chains, options),
        Coefficients::Integers | Coefficients::Rationals => match compute(&SmallIntegers, chains, options) {
            Err(Failure::Overflow) => compute(&Integers, chains, options),
            other => other,
        },
    }
    .map_err(HomologyError::from)?;
    if options.over == Coefficients::Rationals {
        homology.torsion.iter_mut().for_each(Vec::clear);
    }
    Ok(homology)
}

/// Why a computation ended early.
enum Failure {
    Overflow,
    Stopped(Stopped),
    Error(HomologyError),
}

impl From<Overflow> for Failure {
    fn from(_: Overflow) -> Self {
        Self::Overflow
    }
}

impl From<Stopped> for Failure {
    fn from(stopped: Stopped) -> Self {
        Self::Stopped(stopped)
    }
}

impl From<Failure> for HomologyError {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Error(error) => error,
            Failure::Stopped(stopped) => stopped.into(),
            Failure::Overflow => unreachable!("neither a field nor integers of any size have overflow"),
        }
    }
}

impl From<HomologyError> for Failure {
    fn from(error: HomologyError) -> Self {
        Self::Error(error)
    }
}

/// What is known so far.
#[derive(Default)]
struct Found {
    critical: Vec<usize>,
    /// Of the boundaries between critical cells of dimension p and p − 1, for each p.
    forms: Vec<SmithForm>,
}

fn compute<R: Ring>(ring: &R, chains: &impl Chains, options: &HomologyOptions<'_>) -> Result<Homology, Failure> {
    let all = chains.counts();
    let gone = check_size(&all, options.relative_to)?;
    let counts: Vec<usize> = all.iter().zip(&gone).map(|(&all, gone)| all - gone.count()).collect();
    let wanted = options.max_dim.map_or(all.len(), |max_dim| all.len().min(max_dim.saturating_add(1)));
    let watch = Watch::new(options.limits, counts[..wanted].iter().map(|&count| count as u64).sum());
    let mut found = Found::default();
    let stopped = match find(ring, chains, options, (all, gone), wanted, &watch, &mut found) {
        Err(Failure::Stopped(stopped)) => Some(stopped),
        other => other.map(|()| None)?,
    };
    Ok(assemble(counts, found, wanted, stopped))
}

/// Pairs the cells of one dimension after the other, and finds the normal forms of the boundaries of those that are left.
fn find<R: Ring>(
    ring: &R,
    chains: &impl Chains,
    options: &HomologyOptions<'_>,
    (all, mut gone): (Vec<usize>, Vec<Bits>),
    wanted: usize,
    watch: &Watch<'_>,
    found: &mut Found,
) -> Result<(), Failure> {
    let mut below: Option<Below<R::Element>> = None;
    let mut level = None;
    // Above the highest group that is wanted, boundaries only.
    for dim in 0..all.len().min(wanted + 1) {
        let (lower, upper) = gone.split_at_mut(dim + 1);
        let gone_here = &mut lower[dim];
        let (matching, above) = match upper.first_mut().filter(|_| dim < wanted) {
            Some(gone_above) => {
                watch.need(bytes(&all, dim))?;
                let above = chains.level(dim + 1, level.take().as_ref());
                check_closed(&above, dim + 1, options.relative_to)?;
                (pair(all[dim], gone_here, &above, gone_above, watch)?, Some(above))
            }
            None => (all_critical(all[dim], gone_here), None),
        };
        let (form, columns) = boundaries(ring, dim, below.take(), &matching, above.is_some(), watch)?;
        found.forms.push(form);
        found.critical.push(matching.critical.len());
        if let Some((above, gone_above)) = above.as_ref().zip(upper.first()).filter(|_| !matching.critical.is_empty()) {
            let cochains = Cochains::new(ring, all[dim], &matching, above, watch)?;
            below = Some(Below::new(cochains, above, gone_above, columns));
        }
        *gone_here = Bits::default();
        level = above;
    }
    Ok(())
}

/// About how many bytes it takes to pair the cells of a dimension with their cofaces: the faces of cells and cofaces, the
/// cofaces of cells, and what belongs to each.
fn bytes(counts: &[usize], dim: Dim) -> u64 {
    let (cells, cofaces) = (counts[dim] as u64, counts[dim + 1] as u64);
    let faces = cofaces * (dim as u64 + 2) * 4;
    let faces_below = if dim > 0 { cells * (dim as u64 + 1) * 4 } else { 0 };
    faces + faces.max(faces_below) + cells * 12 + cofaces + Bits::bytes(counts.iter().sum())
}

/// The cells of the subcomplex, if its marks are right, and if cells can be numbered.
fn check_size(counts: &[usize], relative_to: Option<&[Vec<bool>]>) -> Result<Vec<Bits>, HomologyError> {
    if let Some((dim, &count)) = counts.iter().enumerate().find(|(_, count)| u32::try_from(**count + 1).is_err()) {
        return Err(HomologyError::TooManyCells { dim, count });
    }
    let Some(marks) = relative_to else { return Ok(counts.iter().map(|&count| Bits::new(count)).collect()) };
    if marks.len() != counts.len() || marks.iter().zip(counts).any(|(marks, &count)| marks.len() != count) {
        return Err(HomologyError::MalformedSubcomplex);
    }
    Ok(marks.iter().map(|marks| Bits::of(marks)).collect())
}

/// The columns of a sparse matrix.
type Columns<E> = Vec<Sparse<E>>;

/// The boundaries of the critical cells of a dimension, if they are wanted, and their normal form. Checks that they have no
/// boundary themselves.
fn boundaries<R: Ring>(
    ring: &R,
    dim: Dim,
    below: Option<Below<R::Element>>,
    matching: &Matching,
    is_wanted: bool,
    watch: &Watch<'_>,
) -> Result<(SmithForm, Columns<R::Element>), Failure> {
    let mut columns = vec![Vec::new(); if is_wanted { matching.critical.len() } else { 0 }];
    let mut elimination = Elimination::new(ring);
    let Some(below) = below else { return Ok((elimination.finish(watch)?, columns)) };
    for (number, &cell) in matching.critical.iter().enumerate() {
        let column = below.coboundary(ring, cell)?;
        if column.is_empty() {
            continue;
        }
        let mut twice = Vec::new();
        for (face, coefficient) in &column {
            add_multiple(ring, &mut twice, coefficient, &below.columns[*face as usize])?;
        }
        if !twice.is_empty() {
            return Err(HomologyError::BoundaryOfBoundary { dim }.into());
        }
        if let Some(kept) = columns.get_mut(number) {
            kept.clone_from(&column);
        }
        watch.look(0)?;
        elimination.push(column)?;
    }
    Ok((elimination.finish(watch)?, columns))
}

fn all_critical(num_cells: usize, gone: &Bits) -> Matching {
    Matching { steps: Vec::new(), critical: gone.absent(0..num_cells).map(narrow).collect() }
}

/// Checks that the faces of the cells of a subcomplex belong to it.
fn check_closed(level: &Level<'_>, dim: Dim, relative_to: Option<&[Vec<bool>]>) -> Result<(), HomologyError> {
    let Some([faces, cells]) = relative_to.map(|marks| [&marks[dim - 1], &marks[dim]]) else { return Ok(()) };
    let is_open = |&cell: &usize| cells[cell] && level.faces(cell).any(|face| !faces[face as usize]);
    match (0..level.num_cells()).find(is_open) {
        Some(cell) => Err(HomologyError::NotClosed { dim, cell }),
        None => Ok(()),
    }
}

/// The homology by the normal forms of the boundaries: that of dimension p begins with number p, and is of the critical p-cells.
fn assemble(counts: Vec<usize>, found: Found, wanted: usize, stopped: Option<Stopped>) -> Homology {
    let Found { mut critical, mut forms } = found;
    if stopped.is_none() && forms.len() == wanted {
        forms.push(SmithForm { rank: 0, factors: Vec::new() });
    }
    let (mut betti, mut torsion) = (Vec::new(), Vec::new());
    for (&critical, pair) in critical.iter().zip(forms.windows(2)) {
        betti.push(critical - pair[0].rank - pair[1].rank);
        torsion.push(pair[1].factors.clone());
    }
    critical.truncate(betti.len());
    if betti.len() == counts.len() {
        assert_eq!(alternating(&betti), alternating(&counts), "the formula of Euler and Poincaré");
    }
    Homology { betti, torsion, counts, critical, stopped }
}

fn alternating(counts: &[usize]) -> i64 {
    counts.iter().rev().fold(0, |sum, &count| count as i64 - sum)
}

/// Whether a number is prime. Cost: trial division.
#[must_use]
pub fn is_prime(number: u32) -> bool {
    let divides = |divisor: u32| number.is_multiple_of(divisor);
    number >= 2
        && (2_u32..).take_while(|divisor| divisor.saturating_mul(*divisor) <= number).all(|divisor| !divides(divisor))
}
