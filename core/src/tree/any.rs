//! A tree of a width that is known at run time only.

use super::Tree;
use crate::format::{Container, FormatError};
use crate::id::IndexWidth;

/// A tree with indices of any of the three widths; match it, or let [`with_tree!`](crate::with_tree) do so.
#[derive(Clone, Copy, Debug)]
pub enum AnyTree<'a> {
    /// 16-bit indices.
    Bits16(Tree<'a, u16>),
    /// 32-bit indices.
    Bits32(Tree<'a, u32>),
    /// 64-bit indices.
    Bits64(Tree<'a, u64>),
}

impl<'a> AnyTree<'a> {
    /// Opens the tree in `bytes` at the width that the file has: see [`Tree::from_bytes`].
    ///
    /// # Errors
    /// As [`Tree::from_bytes`].
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let container = Container::from_bytes(bytes)?;
        Ok(match container.header().width {
            IndexWidth::Bits16 => Self::Bits16(Tree::from_container(container)?),
            IndexWidth::Bits32 => Self::Bits32(Tree::from_container(container)?),
            IndexWidth::Bits64 => Self::Bits64(Tree::from_container(container)?),
        })
    }
}

/// Evaluates an expression with the [`Tree`] in an [`AnyTree`], whatever its width; the expression is compiled once for
/// each.
///
/// ```
/// # fn vertices(any: sig_core::AnyTree<'_>) -> usize {
/// sig_core::with_tree!(any, tree => tree.num_vertices())
/// # }
/// ```
#[macro_export]
macro_rules! with_tree {
    ($any:expr, $tree:ident => $body:expr) => {
        match $any {
            $crate::AnyTree::Bits16($tree) => $body,
            $crate::AnyTree::Bits32($tree) => $body,
            $crate::AnyTree::Bits64($tree) => $body,
        }
    };
}
