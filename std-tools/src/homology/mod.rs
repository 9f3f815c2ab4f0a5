//! Homology: Betti numbers and torsion coefficients over the integers, the rationals and prime fields, of any complex and
//! relative to any subcomplex.
//!
//! The complex is first reduced, dimension by dimension, by coreductions (`matching`), which pair almost all cells; what is left,
//! the critical cells, are those of a Morse complex with the same homology. Its boundaries come from cochains (`cochains`), its
//! Smith normal form from elimination (`eliminate`). Memory: the boundaries of two dimensions, the inverse of one of them and some
//! bytes a cell of these; never those of the whole complex.
//!
//! [`generators()`] gives cycles, too, as chains of the cells of the complex (`smith`, `generators`).
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

mod chains;
mod cochains;
mod eliminate;
mod generators;
mod matching;
mod ring;
mod smith;

pub use num_bigint::BigInt;
use sig_core::Dim;

pub use chains::{Cells, Chains, Level, Simplices};
use cochains::Cochains;
use eliminate::{Elimination, SmithForm};
pub use generators::{Chain, Generator, generators};
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
#[derive(Clone, Copy, Debug, Default)]
pub struct HomologyOptions<'a> {
    /// The coefficients.
    pub over: Coefficients,
    /// For each dimension and each cell of it whether it belongs to a subcomplex; the homology is then relative to this.
    pub relative_to: Option<&'a [Vec<bool>]>,
}

/// The homology of a complex.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Homology {
    /// The rank of each homology group, up to the dimension of the complex.
    pub betti: Vec<usize>,
    /// The invariant factors of the torsion of each group, each dividing the next; none over a field.
    pub torsion: Vec<Vec<BigInt>>,
    /// The cells of each dimension, without those of the subcomplex.
    pub counts: Vec<usize>,
    /// How many of them are critical, that is, were left by the reduction.
    pub critical: Vec<usize>,
}

impl Homology {
    /// χ = Σ (−1)^i n_i = Σ (−1)^i β_i.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        alternating(&self.betti)
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
    /// The boundary of the boundary of some cell is not zero.
    #[error("in dimension {dim} there is a cell the boundary of whose boundary is not zero")]
    BoundaryOfBoundary {
        /// The dimension of the cell.
        dim: Dim,
    },
}

/// The homology of a complex.
///
/// Over the integers in 64 bits; where they do not suffice, all is done again with integers of any size.
///
/// # Errors
/// [`HomologyError`].
pub fn homology(chains: &impl Chains, options: &HomologyOptions<'_>) -> Result<Homology, HomologyError> {
    if let Coefficients::Prime(prime) = options.over {
        if !is_prime(prime) {
            return Err(HomologyError::NotPrime(prime));
        }
        return match compute(&PrimeField(prime), chains, options.relative_to) {
            Err(Failure::Error(error)) => Err(error),
            Ok(homology) => Ok(homology),
            Err(Failure::Overflow) => unreachable!("a field has no overflow"),
        };
    }
    let mut homology = match compute(&SmallIntegers, chains, options.relative_to) {
        Err(Failure::Overflow) => match compute(&Integers, chains, options.relative_to) {
            Err(Failure::Overflow) => unreachable!("integers of any size have no overflow"),
            Err(Failure::Error(error)) => return Err(error),
            Ok(homology) => homology,
        },
        Err(Failure::Error(error)) => return Err(error),
        Ok(homology) => homology,
    };
    if options.over == Coefficients::Rationals {
        homology.torsion.iter_mut().for_each(Vec::clear);
    }
    Ok(homology)
}

/// Why a computation ended early.
enum Failure {
    Overflow,
    Error(HomologyError),
}

impl From<Overflow> for Failure {
    fn from(_: Overflow) -> Self {
        Self::Overflow
    }
}

impl From<HomologyError> for Failure {
    fn from(error: HomologyError) -> Self {
        Self::Error(error)
    }
}

fn compute<R: Ring>(ring: &R, chains: &impl Chains, relative_to: Option<&[Vec<bool>]>) -> Result<Homology, Failure> {
    let mut gone = check_size(&chains.counts(), relative_to)?;
    let counts: Vec<usize> = gone.iter().map(|gone| gone.iter().filter(|&&gone| !gone).count()).collect();
    let mut critical = Vec::with_capacity(counts.len());
    // Of the boundaries between critical cells of dimension p and p − 1, for each p.
    let mut forms: Vec<SmithForm> = Vec::with_capacity(counts.len() + 1);
    let mut below: Option<Below<R::Element>> = None;
    for dim in 0..counts.len() {
        let (lower, upper) = gone.split_at_mut(dim + 1);
        let (matching, above) = match upper.first_mut() {
            Some(gone_above) => {
                let above = chains.level(dim + 1);
                check_closed(&above, dim + 1, relative_to)?;
                (pair(&lower[dim], &above, gone_above), Some(above))
            }
            None => (all_critical(&lower[dim]), None),
        };
        let (form, columns) = boundaries(ring, dim, below.take(), &matching, above.is_some())?;
        forms.push(form);
        critical.push(matching.critical.len());
        below = match above {
            Some(above) if !matching.critical.is_empty() => {
                let cochains = Cochains::new(ring, lower[dim].len(), &matching, &above)?;
                Some(Below { cochains, level: above, columns })
            }
            _ => None,
        };
        lower[dim] = Vec::new();
    }
    Ok(assemble(counts, critical, forms))
}

/// The marks of the cells of the subcomplex, if they are right, and if cells can be numbered.
fn check_size(counts: &[usize], relative_to: Option<&[Vec<bool>]>) -> Result<Vec<Vec<bool>>, HomologyError> {
    if let Some((dim, &count)) = counts.iter().enumerate().find(|(_, count)| u32::try_from(**count + 1).is_err()) {
        return Err(HomologyError::TooManyCells { dim, count });
    }
    let marks = match relative_to {
        Some(marks) => marks.to_vec(),
        None => counts.iter().map(|&count| vec![false; count]).collect(),
    };
    if marks.len() != counts.len() || marks.iter().zip(counts).any(|(marks, &count)| marks.len() != count) {
        return Err(HomologyError::MalformedSubcomplex);
    }
    Ok(marks)
}

/// What the boundaries of the critical cells of a dimension are computed from.
struct Below<E> {
    cochains: Cochains<E>,
    level: Level,
    /// The boundaries of the critical cells of the dimension below.
    columns: Columns<E>,
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
) -> Result<(SmithForm, Columns<R::Element>), Failure> {
    let mut columns = vec![Vec::new(); if is_wanted { matching.critical.len() } else { 0 }];
    let mut elimination = Elimination::new(ring);
    if let Some(Below { cochains, level, columns: lower }) = below {
        for (number, &cell) in matching.critical.iter().enumerate() {
            let column = cochains.coboundary(ring, level.boundary(cell as usize))?;
            if column.is_empty() {
                continue;
            }
            let mut twice = Vec::new();
            for (face, coefficient) in &column {
                add_multiple(ring, &mut twice, coefficient, &lower[*face as usize])?;
            }
            if !twice.is_empty() {
                return Err(HomologyError::BoundaryOfBoundary { dim }.into());
            }
            if let Some(kept) = columns.get_mut(number) {
                kept.clone_from(&column);
            }
            elimination.push(column)?;
        }
    }
    Ok((elimination.finish()?, columns))
}

fn all_critical(gone: &[bool]) -> Matching {
    let critical = (0_u32..).zip(gone).filter(|(_, gone)| !**gone).map(|(cell, _)| cell).collect();
    Matching { steps: Vec::new(), critical }
}

/// Checks that the faces of the cells of a subcomplex belong to it.
fn check_closed(level: &Level, dim: Dim, relative_to: Option<&[Vec<bool>]>) -> Result<(), HomologyError> {
    let Some([faces, cells]) = relative_to.map(|marks| [&marks[dim - 1], &marks[dim]]) else { return Ok(()) };
    let is_open = |&cell: &usize| cells[cell] && level.faces(cell).iter().any(|&face| !faces[face as usize]);
    match (0..level.num_cells()).find(is_open) {
        Some(cell) => Err(HomologyError::NotClosed { dim, cell }),
        None => Ok(()),
    }
}

/// The homology by the normal forms of the boundaries: that of dimension p begins with number p, and is of the critical p-cells.
fn assemble(counts: Vec<usize>, critical: Vec<usize>, mut forms: Vec<SmithForm>) -> Homology {
    forms.push(SmithForm { rank: 0, factors: Vec::new() });
    let (mut betti, mut torsion) = (Vec::new(), Vec::new());
    for (&critical, pair) in critical.iter().zip(forms.windows(2)) {
        betti.push(critical - pair[0].rank - pair[1].rank);
        torsion.push(pair[1].factors.clone());
    }
    let homology = Homology { betti, torsion, counts, critical };
    assert_eq!(homology.euler_characteristic(), alternating(&homology.counts), "the formula of Euler and Poincaré");
    homology
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
