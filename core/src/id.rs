//! Identifiers, dimensions and index widths.
//!
//! Every other module speaks of simplices by [`SimplexId`], of vertices by [`VertexId`] and of dimensions by [`Dim`].
//! The three widths in which a buffer may hold indices are the types that implement [`Index`]; this is the one
//! module that narrows integers and the one that knows the stop code.

use core::fmt;

/// The dimension of a simplex or of a complex: 0 for a vertex, 1 for an edge, and so on, at most [`MAX_DIM`].
///
/// An alias, for dimensions are counted with and looped over everywhere.
pub type Dim = usize;

/// The largest dimension that a complex may have: vertex subsets of a simplex are 32-bit masks.
///
/// A limit of the masks, not a promise of memory: one 31-simplex has 2³² − 1 faces.
pub const MAX_DIM: Dim = 31;

/// The number of a simplex in its complex: simplices are numbered by (dimension, lexicographic order of the vertex
/// word), from 0.
///
/// Ids of different complexes do not mix; an id past the end of a complex is never an error, it has no relations.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct SimplexId(usize);

impl SimplexId {
    /// The simplex with number `index`.
    #[must_use]
    pub const fn new(index: usize) -> Self {
        Self(index)
    }

    /// The number of the simplex: its row in every array over the simplices.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}

impl fmt::Display for SimplexId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// The number of a vertex in its complex, from 0: the order in which vertex words are sorted.
///
/// A vertex is also the 0-simplex of the same number ([`SimplexId::from`]).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct VertexId(usize);

impl VertexId {
    /// The vertex with number `index`.
    #[must_use]
    pub const fn new(index: usize) -> Self {
        Self(index)
    }

    /// The number of the vertex: its row in every array over the vertices.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}

impl From<VertexId> for SimplexId {
    fn from(vertex: VertexId) -> Self {
        Self(vertex.0)
    }
}

impl fmt::Display for VertexId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

/// How many bits an index takes in a buffer.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum IndexWidth {
    /// 16-bit indices: ids and list offsets up to 65,534.
    Bits16,
    /// 32-bit indices: ids and list offsets up to 4,294,967,294.
    Bits32,
    /// 64-bit indices.
    Bits64,
}

impl IndexWidth {
    /// Every width, narrowest first.
    pub const ALL: [Self; 3] = [Self::Bits16, Self::Bits32, Self::Bits64];

    /// Bits an index.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Bits16 => 16,
            Self::Bits32 => 32,
            Self::Bits64 => 64,
        }
    }

    /// Bytes an index.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Bits16 => 2,
            Self::Bits32 => 4,
            Self::Bits64 => 8,
        }
    }

    /// The largest value that is not the stop code: 2^w − 2.
    #[must_use]
    pub const fn max_value(self) -> u64 {
        (u64::MAX >> (64 - self.bits())) - 1
    }

    /// The least width that holds `largest` beside the stop code; `None` for `u64::MAX`, which none does.
    #[must_use]
    pub fn least_for(largest: u64) -> Option<Self> {
        Self::ALL.into_iter().find(|width| largest <= width.max_value())
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u16 {}
    impl Sealed for u32 {}
    impl Sealed for u64 {}
}

/// An unsigned integer that a buffer may use for its indices: `u16`, `u32` or `u64`. Sealed.
pub trait Index: bytemuck::Pod + Ord + core::hash::Hash + fmt::Debug + Send + Sync + sealed::Sealed {
    /// The width of this type.
    const WIDTH: IndexWidth;
    /// The stop code, which ends a list: all ones.
    const STOP: Self;
    /// Zero.
    const ZERO: Self;

    /// `value` at this width; `None` if it is the stop code or more.
    fn from_usize(value: usize) -> Option<Self>;

    /// This index as a `usize`; `usize::MAX`, an index of nothing, where the host's `usize` is too narrow.
    fn to_usize(self) -> usize;
}

macro_rules! impl_index {
    ($($int:ty => $width:ident),*) => {$(
        impl Index for $int {
            const WIDTH: IndexWidth = IndexWidth::$width;
            const STOP: Self = <$int>::MAX;
            const ZERO: Self = 0;

            #[inline]
            fn from_usize(value: usize) -> Option<Self> {
                <$int>::try_from(value).ok().filter(|&index| index != Self::STOP)
            }

            #[inline]
            fn to_usize(self) -> usize {
                usize::try_from(self).unwrap_or(usize::MAX)
            }
        }
    )*};
}

impl_index!(u16 => Bits16, u32 => Bits32, u64 => Bits64);
