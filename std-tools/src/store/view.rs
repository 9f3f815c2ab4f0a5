//! A complex in a file of either kind.

use sig_core::format::{Container, FormatError, Kind};
use sig_core::{AnyComplex, AnyTree};

/// The complex in a file: the whole Simplified Incidence Graph, or its simplex tree alone.
///
/// Both are [`Relations`](sig_core::Relations); [`with_view!`](crate::with_view) evaluates an expression with whichever it
/// is.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "made once a file, and copied by nobody in a loop")]
pub enum View<'a> {
    /// A file of kind SIG.
    Complex(AnyComplex<'a>),
    /// A file of kind tree.
    Tree(AnyTree<'a>),
}

impl<'a> View<'a> {
    /// Opens the complex in `bytes`, in the host's byte order, by the kind and the width that the header tells.
    ///
    /// # Errors
    /// As [`AnyComplex::from_bytes`] and [`AnyTree::from_bytes`].
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        match Container::from_bytes(bytes)?.header().kind {
            Kind::Tree => AnyTree::from_bytes(bytes).map(Self::Tree),
            _ => AnyComplex::from_bytes(bytes).map(Self::Complex),
        }
    }
}

/// Evaluates an expression with the complex in a [`View`], whatever its kind and width; the expression is compiled once
/// for each, and asks by [`Relations`](sig_core::Relations).
///
/// ```
/// # fn vertices(view: sig_tools::View<'_>) -> usize {
/// sig_tools::with_view!(view, complex => complex.num_vertices())
/// # }
/// ```
#[macro_export]
macro_rules! with_view {
    ($view:expr, $complex:ident => $body:expr) => {
        match $view {
            $crate::View::Complex(any) => ::sig_core::with_complex!(any, $complex => $body),
            $crate::View::Tree(any) => ::sig_core::with_tree!(any, $complex => $body),
        }
    };
}
