//! Cells of a cell complex, how they are incident, and both in one 32-bit word.
//!
//! The incidence graph of a cell complex is a multigraph (mcc-2012, 2): an i-cell may appear several times on the boundary
//! of an (i+1)-cell. An [`Incidence`] holds how often, and the signed incidence number beside it, so that complexes answer
//! over the integers too. A [`PackedArc`] is an incidence seen from one end, as memory and files hold it.

use core::fmt;

/// The number of a cell in its complex.
///
/// Cells keep their numbers while others come and go.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct CellId(u32);

impl CellId {
    /// The most cells that are told apart: 2^29.
    pub const LIMIT: usize = 1 << (32 - PackedArc::CODE_BITS);

    /// The cell with number `index`, which is below [`LIMIT`](Self::LIMIT); its lowest bits otherwise.
    #[must_use]
    pub const fn new(index: u32) -> Self {
        Self(index & (u32::MAX >> PackedArc::CODE_BITS))
    }

    /// The number of the cell: its row in every array over the cells.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The number of the cell, as it is stored.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.0
    }
}

impl fmt::Display for CellId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "c{}", self.0)
    }
}

/// How an i-cell is incident with an (i+1)-cell.
///
/// The two numbers have the same parity, and the sign is not the larger: a cell that appears twice on a boundary, once
/// in each direction, has multiplicity 2 and sign 0.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Incidence {
    /// ϕ, how often the i-cell appears on the boundary of the (i+1)-cell (mcc-2012, 2).
    pub multiplicity: u32,
    /// \[q:p\], the coefficient of the i-cell p in the boundary of the (i+1)-cell q.
    pub sign: i32,
}

impl Incidence {
    /// No incidence.
    pub const NONE: Self = Self { multiplicity: 0, sign: 0 };

    /// A cell that appears once, with the sign 1 or −1 of `sign`.
    #[must_use]
    pub const fn once(sign: i32) -> Self {
        Self { multiplicity: 1, sign }
    }

    /// Whether the two numbers can be those of appearances with signs.
    #[must_use]
    pub const fn is_consistent(self) -> bool {
        let size = self.sign.unsigned_abs();
        size <= self.multiplicity && (self.multiplicity - size).is_multiple_of(2)
    }

    /// What killing a pair adds to this incidence of p' and r: ϕ(p',r) + ϕ(p',q)·ϕ(p,r), and \[r:p'\] − \[r:p\]·\[q:p\]·\[q:p'\]
    /// (mcc-2012, 4.2), where `side` is that of p and r, `back` that of p' and q, and `sign` is \[q:p\] = ±1. `None` if a number
    /// does not fit.
    #[must_use]
    pub fn joined(self, side: Self, back: Self, sign: i32) -> Option<Self> {
        let multiplicity = back.multiplicity.checked_mul(side.multiplicity)?.checked_add(self.multiplicity)?;
        let product = side.sign.checked_mul(sign)?.checked_mul(back.sign)?;
        Some(Self { multiplicity, sign: self.sign.checked_sub(product)? })
    }

    /// The inverse of [`joined`](Self::joined): what is left when a pair is made. `None` if there is less than would be
    /// taken away, or the rest cannot be an incidence.
    #[must_use]
    pub fn parted(self, side: Self, back: Self, sign: i32) -> Option<Self> {
        let taken = back.multiplicity.checked_mul(side.multiplicity)?;
        let product = side.sign.checked_mul(sign)?.checked_mul(back.sign)?;
        let multiplicity = self.multiplicity.checked_sub(taken)?;
        Some(Self { multiplicity, sign: self.sign.checked_add(product)? }).filter(|rest| rest.is_consistent())
    }
}

/// A neighbour in the incidence graph, and how it is incident.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Arc {
    /// The neighbour.
    pub cell: CellId,
    /// How it is incident.
    pub incidence: Incidence,
}

/// An [`Arc`] in 32 bits: the neighbour in the upper 29, a code for the incidence in the lower three. Words compare as the
/// neighbours do.
///
/// Seven incidences have a code; all others stand in a table beside the words, which the eighth code says.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
#[repr(transparent)]
pub struct PackedArc(u32);

impl PackedArc {
    /// The width of the code.
    const CODE_BITS: u32 = 3;
    /// The code of an incidence that stands elsewhere.
    const ELSEWHERE: u32 = 7;
    /// The incidences of the other codes.
    const COMMON: [Incidence; 7] = [
        Incidence { multiplicity: 1, sign: 1 },
        Incidence { multiplicity: 1, sign: -1 },
        Incidence { multiplicity: 2, sign: 0 },
        Incidence { multiplicity: 2, sign: 2 },
        Incidence { multiplicity: 2, sign: -2 },
        Incidence { multiplicity: 3, sign: 1 },
        Incidence { multiplicity: 3, sign: -1 },
    ];

    /// Packs an arc; the incidence must be stored elsewhere if [`is_elsewhere`](Self::is_elsewhere) says so.
    #[must_use]
    #[inline]
    pub const fn new(arc: Arc) -> Self {
        let code = match (arc.incidence.multiplicity, arc.incidence.sign) {
            (1, 1) => 0,
            (1, -1) => 1,
            (2, 0) => 2,
            (2, 2) => 3,
            (2, -2) => 4,
            (3, 1) => 5,
            (3, -1) => 6,
            _ => Self::ELSEWHERE,
        };
        Self(arc.cell.number() << Self::CODE_BITS | code)
    }

    /// The word as it is stored.
    #[must_use]
    pub const fn word(self) -> u32 {
        self.0
    }

    /// The arc of a stored word: every word is one.
    #[must_use]
    pub const fn from_word(word: u32) -> Self {
        Self(word)
    }

    /// The neighbour.
    #[must_use]
    #[inline]
    pub const fn cell(self) -> CellId {
        CellId(self.0 >> Self::CODE_BITS)
    }

    /// The same incidence with another neighbour: seen from the other end, the arc to the cell that this one belongs to.
    #[must_use]
    #[inline]
    pub const fn towards(self, cell: CellId) -> Self {
        Self(cell.number() << Self::CODE_BITS | self.0 & Self::ELSEWHERE)
    }

    /// The incidence, unless it stands elsewhere.
    #[must_use]
    #[inline]
    pub fn incidence(self) -> Option<Incidence> {
        Self::COMMON.get((self.0 & Self::ELSEWHERE) as usize).copied()
    }

    /// Whether the incidence stands elsewhere.
    #[must_use]
    #[inline]
    pub const fn is_elsewhere(self) -> bool {
        self.0 & Self::ELSEWHERE == Self::ELSEWHERE
    }
}
