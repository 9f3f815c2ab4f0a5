//! A complex of a width that is known at run time only.

use super::Complex;
use crate::format::{Container, FormatError};
use crate::id::IndexWidth;

/// A complex with indices of any of the three widths; match it, or let
/// [`with_complex!`](crate::with_complex) do so.
#[derive(Clone, Copy, Debug)]
pub enum AnyComplex<'a> {
    /// 16-bit indices.
    Bits16(Complex<'a, u16>),
    /// 32-bit indices.
    Bits32(Complex<'a, u32>),
    /// 64-bit indices.
    Bits64(Complex<'a, u64>),
}

impl<'a> AnyComplex<'a> {
    /// Opens the complex in `bytes` at the width that the file has: see [`Complex::from_bytes`].
    ///
    /// # Errors
    /// As [`Complex::from_bytes`].
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let container = Container::from_bytes(bytes)?;
        Ok(match container.header().width {
            IndexWidth::Bits16 => Self::Bits16(Complex::from_container(container)?),
            IndexWidth::Bits32 => Self::Bits32(Complex::from_container(container)?),
            IndexWidth::Bits64 => Self::Bits64(Complex::from_container(container)?),
        })
    }
}

/// Evaluates an expression with the [`Complex`] in an [`AnyComplex`], whatever its width; the expression is compiled
/// once for each.
///
/// ```
/// # fn vertices(any: sig_core::AnyComplex<'_>) -> usize {
/// sig_core::with_complex!(any, complex => complex.num_vertices())
/// # }
/// ```
#[macro_export]
macro_rules! with_complex {
    ($any:expr, $complex:ident => $body:expr) => {
        match $any {
            $crate::AnyComplex::Bits16($complex) => $body,
            $crate::AnyComplex::Bits32($complex) => $body,
            $crate::AnyComplex::Bits64($complex) => $body,
        }
    };
}
