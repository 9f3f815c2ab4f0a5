//! Files: encoding what the builder made, writing it so that a file is there whole or not at all, and opening it.
//!
//! [`Encoding`] turns [`Built`](crate::build::Built) into the bytes of a file, [`atomic`] brings bytes to disk,
//! [`Mapped`] and [`Loaded`] open a file for the views of [`sig_core`], [`OwnedScratch`] is the memory that queries
//! need, and [`verify`] checks what a view cannot check.

pub mod atomic;
mod bytes;
mod encode;
mod mapped;
mod scratch;
#[cfg(test)]
mod tests;
pub mod verify;
mod view;

pub use bytes::AlignedBytes;
pub use encode::{EncodeError, EncodeOptions, Encoding};
pub(crate) use encode::{EncodedLabels, LOWER_NEIGHBOURS_FROM, coordinate_column, crc32, width_for, width_of_vertices};
pub(crate) use mapped::map_file;
pub use mapped::{Access, Loaded, Mapped, OpenError, OpenErrorKind};
pub use scratch::OwnedScratch;
pub use view::View;
