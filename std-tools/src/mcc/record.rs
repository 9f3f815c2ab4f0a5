//! From a sequence of simplifications to the arrays of a multi-resolution complex.

use sig_core::mcc::{Mcc, MccArrays, long_splits, pack_splits};
use sig_core::{Arc, CellId, Incidence, PackedArc};

use super::criterion::sites;
use crate::build::narrow;
use crate::cells::{CellComplex, Refinement};

/// A multi-resolution cell complex in memory: a base complex, and refinements by increasing number. The arrays are those of
/// [`MccArrays`].
#[derive(Clone, PartialEq, Debug, Default)]
pub struct MultiResolution {
    pub(super) lookup: Vec<u32>,
    pub(super) base_offsets: Vec<u32>,
    pub(super) arcs: Vec<u32>,
    pub(super) large: Vec<u32>,
    pub(super) origins: Vec<u32>,
    pub(super) offsets: Vec<u32>,
    pub(super) shapes: Vec<u8>,
    pub(super) splits: Vec<u32>,
    pub(super) errors: Vec<f32>,
    pub(super) sites: Vec<u32>,
}

impl MultiResolution {
    /// The complex, to be read. Cost: O(1).
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "the recorder makes arrays that fit, and nothing changes them")]
    pub fn view(&self) -> Mcc<'_> {
        Mcc::new(self.arrays()).expect("arrays that were recorded")
    }

    fn arrays(&self) -> MccArrays<'_> {
        MccArrays {
            lookup: &self.lookup,
            base_offsets: &self.base_offsets,
            arcs: &self.arcs,
            large: &self.large,
            origins: &self.origins,
            offsets: &self.offsets,
            shapes: &self.shapes,
            splits: &self.splits,
            errors: &self.errors,
            sites: &self.sites,
            // In memory there are no coordinates: those who write a file have them.
            site_tree: &[],
        }
    }

    /// Bytes of the base complex and of the refinements with their dependencies, without what leads back to the full complex
    /// (origins, sites).
    #[must_use]
    pub fn storage_bytes(&self) -> usize {
        let words = [&self.lookup, &self.base_offsets, &self.arcs, &self.large, &self.offsets, &self.splits];
        let words: usize = words.iter().map(|words| words.len()).sum();
        4 * (words + self.errors.len()) + self.shapes.len()
    }

    /// A cell complex as one without refinements: its cells are numbered anew, by dimension, then by their numbers.
    pub(super) fn of_complex(complex: &CellComplex, origin: impl Fn(CellId) -> u32) -> Self {
        let mut recorded = Self::default();
        let order = recorded.begin(complex);
        recorded.origins = order.iter().map(|&cell| origin(cell)).collect();
        recorded
    }

    /// Writes the base complex, and returns its cells in their order.
    fn begin(&mut self, complex: &CellComplex) -> Vec<CellId> {
        let mut order: Vec<CellId> = complex.cells().collect();
        order.sort_by_key(|&cell| complex.dim_of(cell));
        let mut first = 0;
        for count in complex.counts() {
            self.lookup.push(narrow(first));
            first += count;
        }
        let mut numbers = vec![u32::MAX; complex.num_ids()];
        order.iter().zip(0..).for_each(|(cell, number)| numbers[cell.index()] = number);
        self.base_offsets.push(0);
        let mut arcs = Vec::new();
        for &cell in &order {
            arcs.clear();
            arcs.extend(complex.boundary(cell));
            self.push_arcs(&mut arcs, &numbers);
            self.base_offsets.push(narrow(self.arcs.len()));
        }
        order
    }

    /// Adds arcs to cells by their numbers in another complex.
    fn push_arcs(&mut self, arcs: &mut [Arc], numbers: &[u32]) {
        for arc in &mut *arcs {
            arc.cell = CellId::new(numbers[arc.cell.index()]);
        }
        arcs.sort_unstable_by_key(|arc| arc.cell);
        for &arc in &*arcs {
            let packed = PackedArc::new(arc);
            if packed.is_elsewhere() {
                let Incidence { multiplicity, sign } = arc.incidence;
                self.large.extend([narrow(self.arcs.len()), multiplicity, sign.cast_unsigned()]);
            }
            self.arcs.push(packed.word());
        }
    }

    /// Makes errors at least those of the refinements that depend on them, so that every threshold takes a closed set.
    fn order_errors(&mut self) {
        let mut errors = std::mem::take(&mut self.errors);
        self.errors = vec![0.0; errors.len()];
        let view = self.view();
        for refinement in (0..errors.len()).rev() {
            for dependency in view.dependencies(refinement) {
                errors[dependency] = errors[dependency].max(errors[refinement]);
            }
        }
        self.errors = errors;
    }
}

/// The simplifications done so far, by the numbers of the full complex.
#[derive(Debug)]
pub(super) struct Recorder {
    num_dims: usize,
    sites: Vec<u32>,
    pairs: Vec<Killed>,
    arcs: Vec<PackedArc>,
    /// Incidences that are in no arc, in the order of the arcs.
    large: Vec<Incidence>,
}

#[derive(Debug)]
struct Killed {
    low: CellId,
    high: CellId,
    /// The dimension, and 128 if the sign is −1.
    shape: u8,
    error: f32,
    lengths: [u32; 4],
}

impl Recorder {
    pub(super) fn new(complex: &CellComplex) -> Self {
        let (pairs, arcs, large) = (Vec::new(), Vec::new(), Vec::new());
        Self { num_dims: complex.counts().len(), sites: sites(complex), pairs, arcs, large }
    }

    pub(super) const fn len(&self) -> usize {
        self.pairs.len()
    }

    /// d + 1 of the full complex.
    pub(super) const fn num_dims(&self) -> usize {
        self.num_dims
    }

    pub(super) fn push(&mut self, refinement: &Refinement, error: f32) {
        for &arc in refinement.arcs() {
            let packed = PackedArc::new(arc);
            if packed.is_elsewhere() {
                self.large.push(arc.incidence);
            }
            self.arcs.push(packed);
        }
        let lists = [refinement.below_low(), refinement.below_high(), refinement.above_low(), refinement.above_high()];
        #[expect(clippy::cast_possible_truncation, reason = "a dimension is at most 31")]
        let dim = refinement.dim as u8;
        self.pairs.push(Killed {
            low: refinement.low,
            high: refinement.high,
            shape: dim | if refinement.sign < 0 { 128 } else { 0 },
            error,
            lengths: lists.map(|list| narrow(list.len())),
        });
    }

    /// The multi-resolution complex with this base.
    pub(super) fn finish(mut self, base: &CellComplex) -> MultiResolution {
        let mut recorded = MultiResolution::default();
        let num = self.pairs.len();
        let order = recorded.begin(base);
        recorded.lookup.resize(self.num_dims, narrow(order.len()));
        let mut numbers = vec![u32::MAX; base.num_ids().max(self.sites.len())];
        order.iter().zip(0..).for_each(|(cell, number)| numbers[cell.index()] = number);
        recorded.origins.reserve_exact(order.len() + 2 * num);
        recorded.origins.extend(order.iter().map(|cell| cell.number()));
        for killed in self.pairs.iter().rev() {
            for cell in [killed.low, killed.high] {
                numbers[cell.index()] = narrow(recorded.origins.len());
                recorded.origins.push(cell.number());
            }
        }
        recorded.arcs.reserve_exact(self.arcs.len());
        recorded.offsets.reserve_exact(num + 1);
        recorded.offsets.push(narrow(recorded.arcs.len()));
        let mut list = Vec::new();
        while let Some(killed) = self.pairs.pop() {
            recorded.shapes.push(killed.shape);
            recorded.errors.push(killed.error);
            recorded.sites.push(self.sites[killed.high.index()]);
            let [a, b, c, _] = killed.lengths;
            let splits = pack_splits([a, b, c].map(|length| length as usize));
            if splits.is_none() {
                recorded.arcs.extend([a, b, c]);
            }
            recorded.splits.push(splits.unwrap_or(long_splits()));
            // The lists from the end, for the incidences that are elsewhere.
            let lists = killed.lengths.map(|length| length as usize);
            let mut start = self.arcs.len() - lists.iter().sum::<usize>();
            let num_large = self.arcs[start..].iter().filter(|arc| arc.is_elsewhere()).count();
            let mut large = self.large.split_off(self.large.len() - num_large).into_iter();
            let first = start;
            for length in lists {
                list.clear();
                list.extend(self.arcs[start..start + length].iter().map(|arc| {
                    let elsewhere = || large.next().unwrap_or(Incidence::NONE);
                    Arc { cell: arc.cell(), incidence: arc.incidence().unwrap_or_else(elsewhere) }
                }));
                recorded.push_arcs(&mut list, &numbers);
                start += length;
            }
            self.arcs.truncate(first);
            recorded.offsets.push(narrow(recorded.arcs.len()));
        }
        recorded.order_errors();
        recorded
    }
}
