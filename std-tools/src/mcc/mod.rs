//! Multi-resolution cell complexes (mcc-2012): made by simplification, refined where one looks.
//!
//! [`simplify`](simplify()) kills pairs of cells of a [`CellComplex`](crate::cells::CellComplex), by a [`Criterion`], and keeps of each what makes
//! it again: the [`MultiResolution`] complex. [`sig_core::mcc::Mcc`] reads it, in memory or in a file (`store`), and a [`Front`] is
//! the complex after a closed set of the refinements.
//!
//! ```
//! # use sig_tools::{build, cells::CellComplex, io, mcc};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (soup, _) = io::read_bytes(b"0 1 2\n1 2 3\n", "strip", &io::ReadOptions::default())?;
//! let complex = CellComplex::from_built(&build::build(soup, &build::BuildOptions::default())?)?;
//! let (strip, report) = mcc::simplify(complex, &mut mcc::Free, &mcc::SimplifyOptions::default());
//! // A disk is a point, by five pairs of cells.
//! assert_eq!((strip.view().num_base_cells(), report.simplifications), (1, 5));
//! let mut front = mcc::Front::new(strip.view());
//! front.select(|refinement| refinement < 2)?;
//! assert_eq!(front.complex().num_cells(), 5);
//! # Ok(())
//! # }
//! ```

mod batch;
mod criterion;
mod front;
mod picture;
mod queue;
mod record;
mod simplify;
mod site_tree;
mod store;
mod verify;

pub use criterion::{Criterion, Extent, Field, Free, Length, Pair};
pub use front::{BadRefinement, Front, Moved, apply_in_order, members};
pub use picture::{DrawError, Drawing};
pub use record::MultiResolution;
pub use simplify::{Precision, SimplifyOptions, SimplifyReport, Strategy, Types, simplify};
pub use store::{MccFile, write_mcc};
pub use verify::{BrokenMcc, verify};
