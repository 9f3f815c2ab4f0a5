//! The multi-resolution cell complex (mcc-2012, 5 and 6), read where it lies: [`Mcc`].
//!
//! A base complex, and refinements, each of which makes a pair of cells (MiC(i+1)C). Cells are numbered as they come: those of
//! the base by dimension, then two for each refinement, the i-cell and the (i+1)-cell. So the number of a cell tells which
//! refinement creates it, and the arcs that a refinement adds *are* its direct dependencies: nothing else is stored for
//! them. Refinements are numbered so that each depends on earlier ones only; increasing order is one of the feasible
//! sequences.
//!
//! What is asked for makes a least closed set of refinements, in memory of the caller's. There are two ways to it, which differ
//! in what they cost:
//!
//! | what is asked for | set | cost |
//! |---|---|---|
//! | any predicate, asked of each refinement | [`select`](Mcc::select), [`close`](Mcc::close), [`stream`](Mcc::stream): a bit for each refinement | that of all refinements |
//! | some refinements by number, as those in a [box](Mcc::in_box) | [`closed_set`](Mcc::closed_set): a list | that of the refinements in the set |
//!
//! One file each: `closure` has these, `sites` finds the refinements in a box, `validate` checks the arrays.
//!
//! ```
//! use sig_core::mcc::{AxisBox, Mcc};
//! use sig_core::{Scratch, ScratchError};
//!
//! /// How many cells the complex has that is as fine as can be in a box, and as coarse as can be elsewhere.
//! fn cells_in(mcc: &Mcc<'_>, inside: AxisBox, scratch: &mut Scratch<'_, u32>) -> Result<Option<usize>, ScratchError> {
//!     let Some(wanted) = mcc.in_box(inside, AxisBox::EMPTY) else { return Ok(None) };
//!     let applied = mcc.closed_set(wanted, scratch)?;
//!     // `mcc.refinement(number)` for each of them, in this order, would make the complex itself.
//!     Ok(Some(mcc.num_base_cells() + 2 * applied.len()))
//! }
//! # let _ = cells_in;
//! ```

mod closure;
mod sites;
mod validate;

use core::ops::Range;

use crate::cell::{Arc, CellId, Incidence, PackedArc};
use crate::format::{Column, Container, FormatError, Kind, Rule, Section, SectionKind};
use crate::id::{Dim, IndexWidth, MAX_DIM};

pub use sites::{AxisBox, InBox};

/// The arrays of a multi-resolution cell complex, as a file has them. b is the number of base cells, m that of refinements.
#[derive(Clone, Copy, Debug, Default)]
pub struct MccArrays<'a> {
    /// The first base cell of each dimension, d + 1 of them.
    pub lookup: &'a [u32],
    /// Where the boundary of each base cell starts in `arcs`, and the end of the last: b + 1.
    pub base_offsets: &'a [u32],
    /// [`PackedArc`]s: the boundaries of the base cells, then the arcs of the refinements.
    pub arcs: &'a [u32],
    /// The place of an arc, its multiplicity and its sign, for each that says so, by increasing place.
    pub large: &'a [u32],
    /// The number in the full complex of each cell: b + 2m.
    pub origins: &'a [u32],
    /// Where the arcs of each refinement start, and the end of the last: m + 1.
    pub offsets: &'a [u32],
    /// The dimension of the lower cell of each refinement, and 128 if the sign is −1: m.
    pub shapes: &'a [u8],
    /// The lengths of the first three of the four lists, ten bits each; all ones if they stand in three words before: m.
    pub splits: &'a [u32],
    /// The errors: m.
    pub errors: &'a [f32],
    /// The sites: m, or none.
    pub sites: &'a [u32],
    /// The refinements as a tree over their sites: m, or none. See [`Mcc::in_box`].
    pub site_tree: &'a [u32],
}

/// What `splits` holds if a length takes more than ten bits.
const LONG_SPLITS: u32 = u32::MAX;

/// The lengths of the first three lists of a refinement as one word of `splits`; `None` if they stand before the arcs instead.
#[must_use]
pub fn pack_splits(lengths: [usize; 3]) -> Option<u32> {
    let fits = lengths.iter().all(|&length| length < 1 << 10);
    let word = lengths.iter().rev().fold(0, |word, &length| word << 10 | length);
    u32::try_from(word).ok().filter(|_| fits)
}

/// The word of `splits` of a refinement whose lengths stand before its arcs.
#[must_use]
pub const fn long_splits() -> u32 {
    LONG_SPLITS
}

/// A multi-resolution cell complex, or, without refinements, a cell complex.
///
/// `Copy`: any number of threads read one buffer.
///
/// # Trust
///
/// [`from_bytes`](Self::from_bytes) makes every query safe whatever the arrays hold. That the refinements make complexes is
/// known after [`validate`](Self::validate), as far as numbers and dimensions tell.
#[derive(Clone, Copy, Debug)]
pub struct Mcc<'a> {
    arrays: MccArrays<'a>,
    container: Option<Container<'a>>,
}

/// A refinement: MiC(i+1)C with all that it needs.
#[derive(Clone, Debug)]
pub struct RefinementView<'a> {
    /// Its number.
    pub number: usize,
    /// The i-cell that it makes.
    pub low: CellId,
    /// The (i+1)-cell that it makes.
    pub high: CellId,
    /// i.
    pub dim: Dim,
    /// \[high:low\].
    pub sign: i32,
    /// What bounds `low`, what else bounds `high`, what else `low` bounds, what `high` bounds.
    pub lists: [Arcs<'a>; 4],
}

/// Arcs of a file.
#[derive(Clone, Debug)]
pub struct Arcs<'a> {
    arrays: MccArrays<'a>,
    range: Range<usize>,
}

impl<'a> Arcs<'a> {
    /// The arcs as they are stored.
    #[must_use]
    #[inline]
    pub fn packed(&self) -> impl ExactSizeIterator<Item = PackedArc> + DoubleEndedIterator + Clone + use<'a> {
        let words = self.arrays.arcs.get(self.range.clone()).unwrap_or(&[]);
        words.iter().map(|&word| PackedArc::from_word(word))
    }
}

impl Iterator for Arcs<'_> {
    type Item = Arc;

    #[inline]
    fn next(&mut self) -> Option<Arc> {
        let at = self.range.next()?;
        let packed = PackedArc::from_word(self.arrays.arcs.get(at).copied().unwrap_or(0));
        let incidence = packed.incidence().unwrap_or_else(|| self.arrays.large_at(at));
        Some(Arc { cell: packed.cell(), incidence })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.range.size_hint()
    }
}

impl ExactSizeIterator for Arcs<'_> {}
impl core::iter::FusedIterator for Arcs<'_> {}

impl MccArrays<'_> {
    /// The incidence of the arc at a place, where it is not in the arc.
    fn large_at(&self, place: usize) -> Incidence {
        let (rows, _) = self.large.as_chunks::<3>();
        let row = rows.binary_search_by_key(&place, |row| row.first().map_or(0, |&place| place as usize));
        match row.ok().and_then(|row| rows.get(row)) {
            Some(&[_, multiplicity, sign]) => Incidence { multiplicity, sign: sign.cast_signed() },
            None => Incidence::NONE,
        }
    }
}

impl<'a> Mcc<'a> {
    /// Opens the complex in `bytes`: see [`from_container`](Self::from_container).
    ///
    /// # Errors
    /// [`FormatError`]. Never a panic, whatever the bytes.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        Self::from_container(Container::from_bytes(bytes)?)
    }

    /// Opens the complex in a container of kind multi-resolution complex, or cell complex, which is one without refinements.
    /// Checks types and lengths of the sections, and looks into none of them but at the ends.
    ///
    /// Cost: O(number of sections).
    ///
    /// # Errors
    /// [`FormatError`].
    pub fn from_container(container: Container<'a>) -> Result<Self, FormatError> {
        let header = container.header();
        let expected = Kind::MultiResolution;
        if !matches!(header.kind, Kind::MultiResolution | Kind::CellComplex) {
            return Err(FormatError::WrongKind { found: header.kind, expected });
        }
        if header.width != IndexWidth::Bits32 {
            return Err(FormatError::WrongWidth { found: header.width, expected: IndexWidth::Bits32 });
        }
        let words = |kind| match container.section(kind) {
            Some(Section { column: Column::U32(words), .. }) => Ok(words),
            Some(_) => Err(FormatError::Invalid { section: kind, element: 0, rule: Rule::ArcOffset }),
            None => Err(FormatError::MissingSection(kind)),
        };
        let optional = |kind| container.section(kind).map_or(Ok(&[][..]), |_| words(kind));
        let mut arrays = MccArrays {
            lookup: words(SectionKind::Lookup)?,
            base_offsets: words(SectionKind::BaseOffsets)?,
            arcs: words(SectionKind::CellArcs)?,
            large: optional(SectionKind::LargeIncidences)?,
            origins: words(SectionKind::Origins)?,
            ..MccArrays::default()
        };
        if header.kind == Kind::MultiResolution {
            arrays.offsets = words(SectionKind::RefinementOffsets)?;
            arrays.splits = words(SectionKind::RefinementSplits)?;
            arrays.sites = optional(SectionKind::RefinementSites)?;
            arrays.site_tree = optional(SectionKind::SiteTree)?;
            arrays.shapes = match container.section(SectionKind::RefinementShapes) {
                Some(Section { column: Column::U8(shapes), .. }) => shapes,
                _ => return Err(FormatError::MissingSection(SectionKind::RefinementShapes)),
            };
            arrays.errors = match container.section(SectionKind::RefinementErrors) {
                Some(Section { column: Column::F32(errors), .. }) => errors,
                _ => return Err(FormatError::MissingSection(SectionKind::RefinementErrors)),
            };
        }
        let mcc = Self { container: Some(container), ..Self::new(arrays)? };
        if mcc.num_cells() as u64 != header.num_simplices || arrays.lookup.len() > header.dims {
            let element = mcc.num_cells() as u64;
            return Err(FormatError::Invalid { section: SectionKind::Origins, element, rule: Rule::Origin });
        }
        Ok(mcc)
    }

    /// The complex of arrays in memory.
    ///
    /// # Errors
    /// [`FormatError::Invalid`] if their lengths do not fit.
    pub fn new(arrays: MccArrays<'a>) -> Result<Self, FormatError> {
        let MccArrays { lookup, base_offsets, offsets, shapes, splits, errors, sites, site_tree, .. } = arrays;
        let MccArrays { origins, large, .. } = arrays;
        let invalid = |section, element: usize, rule| FormatError::Invalid { section, element: element as u64, rule };
        let base = base_offsets.len().checked_sub(1);
        let base = base.ok_or(invalid(SectionKind::BaseOffsets, 0, Rule::ArcOffset))?;
        let num = shapes.len();
        let is_lookup = lookup.len() <= MAX_DIM + 1
            && lookup.is_sorted()
            && lookup.first().is_none_or(|&first| first == 0)
            && lookup.last().map_or(base == 0, |&last| last as usize <= base);
        if !is_lookup {
            return Err(invalid(SectionKind::Lookup, 0, Rule::FirstIds));
        }
        if offsets.len() != num + usize::from(num > 0 || !offsets.is_empty()) {
            return Err(invalid(SectionKind::RefinementOffsets, offsets.len(), Rule::ArcOffset));
        }
        if splits.len() != num {
            return Err(invalid(SectionKind::RefinementSplits, splits.len(), Rule::ArcOffset));
        }
        if errors.len() != num {
            return Err(invalid(SectionKind::RefinementErrors, errors.len(), Rule::ErrorOrder));
        }
        if !sites.is_empty() && sites.len() != num {
            return Err(invalid(SectionKind::RefinementSites, sites.len(), Rule::Origin));
        }
        if !site_tree.is_empty() && site_tree.len() != sites.len() {
            return Err(invalid(SectionKind::SiteTree, site_tree.len(), Rule::SiteTree));
        }
        let cells = num.checked_mul(2).and_then(|made| made.checked_add(base)).filter(|&cells| cells <= CellId::LIMIT);
        if cells != Some(origins.len()) {
            return Err(invalid(SectionKind::Origins, origins.len(), Rule::Origin));
        }
        if !large.len().is_multiple_of(3) {
            return Err(invalid(SectionKind::LargeIncidences, large.len(), Rule::Arc));
        }
        Ok(Self { arrays, container: None })
    }

    /// The arrays.
    #[must_use]
    pub const fn arrays(&self) -> &MccArrays<'a> {
        &self.arrays
    }

    /// The file that the complex lies in, if it lies in one.
    #[must_use]
    pub const fn container(&self) -> Option<&Container<'a>> {
        self.container.as_ref()
    }

    /// b, the number of cells of the base complex.
    #[must_use]
    pub const fn num_base_cells(&self) -> usize {
        self.arrays.base_offsets.len().saturating_sub(1)
    }

    /// m, the number of refinements.
    #[must_use]
    pub const fn num_refinements(&self) -> usize {
        self.arrays.shapes.len()
    }

    /// The number of cells of the full complex, b + 2m.
    #[must_use]
    pub const fn num_cells(&self) -> usize {
        self.arrays.origins.len()
    }

    /// The number of dimensions of the complex.
    #[must_use]
    pub const fn num_dims(&self) -> usize {
        self.arrays.lookup.len()
    }

    /// The refinement that makes a cell; `None` for cells of the base, and past the end.
    #[must_use]
    #[inline]
    pub const fn creator(&self, cell: CellId) -> Option<usize> {
        match cell.index().checked_sub(self.num_base_cells()) {
            Some(made) if made / 2 < self.num_refinements() => Some(made / 2),
            _ => None,
        }
    }

    /// The dimension of a cell; `None` past the end.
    #[must_use]
    #[inline]
    pub fn dim_of(&self, cell: CellId) -> Option<Dim> {
        if cell.index() < self.num_base_cells() {
            let dims = self.arrays.lookup.partition_point(|&first| first as usize <= cell.index());
            return dims.checked_sub(1);
        }
        let refinement = self.creator(cell)?;
        Some(self.shape(refinement)?.0 + (cell.index() - self.num_base_cells()) % 2)
    }

    /// The cell of the full complex, as it was simplified, that a cell is: the number of the simplex, if that was simplicial.
    #[must_use]
    pub fn origin(&self, cell: CellId) -> Option<usize> {
        self.arrays.origins.get(cell.index()).map(|&origin| origin as usize)
    }

    /// The boundary of a cell of the base complex.
    #[must_use]
    pub fn base_boundary(&self, cell: CellId) -> Arcs<'a> {
        self.arcs(self.arrays.base_offsets, cell.index())
    }

    fn arcs(&self, offsets: &[u32], row: usize) -> Arcs<'a> {
        let range = match offsets.get(row..) {
            Some(&[start, end, ..]) => start as usize..(end as usize).min(self.arrays.arcs.len()),
            _ => 0..0,
        };
        Arcs { arrays: self.arrays, range }
    }

    fn shape(&self, refinement: usize) -> Option<(Dim, i32)> {
        let &shape = self.arrays.shapes.get(refinement)?;
        Some((usize::from(shape & 127), if shape & 128 == 0 { 1 } else { -1 }))
    }

    /// A refinement; `None` past the end.
    #[must_use]
    #[inline]
    pub fn refinement(&self, number: usize) -> Option<RefinementView<'a>> {
        let (dim, sign) = self.shape(number)?;
        let low = u32::try_from(self.num_base_cells() + 2 * number).ok()?;
        let Arcs { range, .. } = self.arcs(self.arrays.offsets, number);
        let splits = self.arrays.splits.get(number).copied()?;
        let word = |place| self.arrays.arcs.get(range.start.saturating_add(place)).map_or(0, |&word| word as usize);
        let (skipped, lengths) = if splits == LONG_SPLITS {
            (3, [word(0), word(1), word(2)])
        } else {
            let field = |place: u32| (splits >> (10 * place) & 1023) as usize;
            (0, [field(0), field(1), field(2)])
        };
        let mut start = range.start.saturating_add(skipped).min(range.end);
        let mut next = |length: usize| {
            let part = start..start.saturating_add(length).min(range.end);
            start = part.end;
            Arcs { arrays: self.arrays, range: part }
        };
        let [below_low, below_high, above_low] = lengths.map(&mut next);
        let lists = [below_low, below_high, above_low, next(usize::MAX)];
        Some(RefinementView { number, low: CellId::new(low), high: CellId::new(low + 1), dim, sign, lists })
    }

    /// The error of the complex without a refinement, as the criterion of the simplification measured it: that of a refinement
    /// is not less than that of one that depends on it. NaN past the end.
    #[must_use]
    #[inline]
    pub fn error(&self, refinement: usize) -> f32 {
        self.arrays.errors.get(refinement).copied().unwrap_or(f32::NAN)
    }

    /// The vertex of the full complex near which a refinement is, where sites are stored.
    #[must_use]
    #[inline]
    pub fn site(&self, refinement: usize) -> Option<usize> {
        self.arrays.sites.get(refinement).map(|&site| site as usize)
    }

    /// The coordinates of the vertices of the full complex, if they are stored.
    #[must_use]
    pub fn coordinates(&self) -> Option<Section<'a>> {
        self.container?.section(SectionKind::Coordinates)
    }

    /// The refinements on which one directly depends (mcc-2012, 5), some perhaps several times: those that create a cell which
    /// it connects to one of its two.
    pub fn dependencies(&self, refinement: usize) -> impl Iterator<Item = usize> + use<'a> {
        let mcc = *self;
        let arcs = self.all_arcs(refinement).iter();
        // Only a damaged file has later ones; without them, every closure ends.
        let creator = move |&word: &u32| mcc.creator(PackedArc::from_word(word).cell());
        arcs.filter_map(creator).filter(move |&creator| creator < refinement)
    }

    /// The arcs of a refinement, of all four lists.
    fn all_arcs(&self, refinement: usize) -> &'a [u32] {
        let Arcs { range, .. } = self.arcs(self.arrays.offsets, refinement);
        let skipped = match self.arrays.splits.get(refinement) {
            Some(&LONG_SPLITS) => 3,
            _ => 0,
        };
        self.arrays.arcs.get(range.start.saturating_add(skipped)..range.end).unwrap_or(&[])
    }
}
