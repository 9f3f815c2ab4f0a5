//! How much a complex takes: the formulas of sig-2004, 4.2 and 7.1, and what is in the buffer.
//!
//! The paper counts integers and bits. [`PaperStorage`] evaluates its formulas from n_p and κ_p^g; [`FileStorage`]
//! counts the elements of the sections. For a valid file the two agree.

use crate::complex::Complex;
use crate::format::{Column, SectionKind};
use crate::id::{Dim, Index, MAX_DIM};

/// κ_p^g for one p: the number of g-clusters summed over the restricted stars of all p-simplices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ClusterCounts {
    /// `by_dim[g]` is κ_p^g.
    pub by_dim: [usize; MAX_DIM + 1],
    /// The number of p-simplices that have the manifold flag.
    pub single_cluster: usize,
    /// The number of p-simplices that are top simplices.
    pub tops: usize,
}

impl ClusterCounts {
    /// Σ_g κ_p^g.
    #[must_use]
    pub fn total(&self) -> usize {
        self.by_dim.iter().sum()
    }
}

/// Integers and bits.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Storage {
    /// Integers, each as wide as an index.
    pub integers: usize,
    /// Bits.
    pub bits: usize,
}

/// The formulas of the paper for one complex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct PaperStorage {
    /// d + 1: the lookup table.
    pub lookup: usize,
    /// Σ_{0<p≤d} (p+1) n_p: the boundary relations.
    pub boundary: usize,
    /// Σ_{0≤p<d} n_p: the pointers, and as many flag bits.
    pub pointers: usize,
    /// Σ_{unflagged σ} (κ(σ) + 1): the lists of the simplices below dimension d that have no manifold flag.
    pub lists: usize,
    /// Σ_{0≤p<d} (κ_p + n_p): the lists if no simplex were flagged.
    pub general_lists: usize,
    /// 2 n_{d−1}: the pairs of the specialisation of 7.4, for complexes whose (d−1)-simplices have two d-simplices at most.
    pub pairs: usize,
    /// What the pairs stand for: pointers of simplices of dimension d − 1, of which each has a flag too, and their lists.
    pub in_pairs: Storage,
    /// Σ_{0≤p≤d} n_p: the visited bits, which are in the scratch, not in the file.
    pub visited_bits: usize,
}

impl PaperStorage {
    /// 4.2, its general and its manifold case mixed for each simplex by its flag: what a file holds.
    #[must_use]
    pub const fn sig(&self) -> Storage {
        Storage { integers: self.lookup + self.boundary + self.pointers + self.lists, bits: self.pointers }
    }

    /// 4.2, the general case for all simplices, with the lookup table: two integers more for each flagged simplex.
    #[must_use]
    pub const fn sig_general(&self) -> Storage {
        Storage { integers: self.lookup + self.boundary + self.pointers + self.general_lists, bits: self.pointers }
    }

    /// 7.4: as [`sig`](Self::sig), with two integers for each simplex of dimension d − 1 in place of pointer, list and flag:
    /// for d = 3, without the manifold flag and but for the lookup table, 2 n_0 + 4 n_1 + 5 n_2 + 4 n_3 + κ_0 + κ_1.
    #[must_use]
    pub const fn sig_pairs(&self) -> Storage {
        let Storage { integers, bits } = self.sig();
        Storage { integers: integers - self.in_pairs.integers + self.pairs, bits: bits - self.in_pairs.bits }
    }

    /// 7.1: the incidence graph, 2 Σ_{0<p≤d} (p+1) n_p + Σ_{0≤p<d} n_p.
    #[must_use]
    pub const fn incidence_graph(&self) -> Storage {
        Storage { integers: 2 * self.boundary + self.pointers, bits: 0 }
    }
}

/// What the sections of a SIG hold, counted in the buffer.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct FileStorage {
    /// Integers of the lookup table.
    pub lookup: usize,
    /// Integers of the boundary relations.
    pub boundary: usize,
    /// Pointers.
    pub pointers: usize,
    /// Integers of the lists, entries and stop codes.
    pub lists: usize,
    /// Integers of the pairs, where the file has them.
    pub pairs: usize,
    /// Flag bits.
    pub flags: usize,
    /// Bytes of the tree's sections.
    pub tree_bytes: usize,
    /// Bytes of the checksums.
    pub checksum_bytes: usize,
    /// Bytes of all other optional sections: labels, coordinates, orientations, attributes.
    pub other_bytes: usize,
    /// Bytes of the header, the section table and the padding.
    pub overhead_bytes: usize,
    /// Bytes of the file.
    pub file_bytes: usize,
}

impl FileStorage {
    /// Integers and bits of the paper's five arrays.
    #[must_use]
    pub const fn sig(&self) -> Storage {
        let lists = self.pointers + self.lists + self.pairs;
        Storage { integers: self.lookup + self.boundary + lists, bits: self.flags }
    }
}

impl<I: Index> Complex<'_, I> {
    /// κ_p^g for all g, and what else is counted over the p-simplices. Cost: one pass over their pointers and lists.
    #[must_use]
    pub fn cluster_counts(&self, dim: Dim) -> ClusterCounts {
        let mut counts = ClusterCounts { by_dim: [0; MAX_DIM + 1], single_cluster: 0, tops: 0 };
        if self.dim() == Some(dim) {
            // Nothing is stored for them; there may be more than the buffer has bytes.
            return ClusterCounts { tops: self.num_simplices_of_dim(dim), ..counts };
        }
        for simplex in self.simplices_of_dim(dim) {
            let mut any = false;
            for cluster in self.clusters(simplex) {
                any = true;
                if let Some(count) = counts.by_dim.get_mut(cluster.dim) {
                    *count += 1;
                }
            }
            counts.tops += usize::from(!any);
            counts.single_cluster += usize::from(self.is_single_cluster(simplex));
        }
        counts
    }

    /// The formulas of the paper, with this complex's n_p and κ. Cost: one pass over pointers and lists.
    #[must_use]
    pub fn paper_storage(&self) -> PaperStorage {
        let Some(top) = self.dim() else { return PaperStorage::default() };
        let mut storage = PaperStorage { lookup: top + 1, ..PaperStorage::default() };
        for dim in 0..=top {
            let count = self.num_simplices_of_dim(dim);
            storage.visited_bits += count;
            if dim > 0 {
                storage.boundary += (dim + 1) * count;
            }
            if dim < top {
                let clusters = self.cluster_counts(dim);
                storage.pointers += count;
                storage.general_lists += clusters.total() + count;
                // A flagged simplex has one cluster: its entry and stop code are not there. (In a buffer that is not a
                // complex it may have none.)
                let lists = (clusters.total() + count).saturating_sub(2 * clusters.single_cluster);
                storage.lists += lists;
                if dim + 1 == top {
                    storage.pairs = 2 * count;
                    storage.in_pairs = Storage { integers: count + lists, bits: count };
                }
            }
        }
        storage
    }

    /// What the sections of the buffer hold. Cost: O(number of sections).
    #[must_use]
    pub fn file_storage(&self) -> FileStorage {
        let mut storage = FileStorage { file_bytes: self.container().bytes().len(), ..FileStorage::default() };
        storage.overhead_bytes = storage.file_bytes;
        for section in self.container().sections() {
            let (len, bytes) = (section.column.len(), section.column.as_bytes().len());
            storage.overhead_bytes -= bytes;
            match section.kind {
                SectionKind::Lookup => storage.lookup = len,
                SectionKind::Boundary => storage.boundary = len,
                SectionKind::Pointers => storage.pointers = len,
                SectionKind::Lists => storage.lists = len,
                SectionKind::Pairs => storage.pairs = len,
                SectionKind::Flags => {
                    storage.flags = if matches!(section.column, Column::Bits { .. }) { len } else { 0 }
                }
                SectionKind::ChildOffsets
                | SectionKind::LastVertices
                | SectionKind::LowerOffsets
                | SectionKind::LowerNeighbours => storage.tree_bytes += bytes,
                SectionKind::Checksums => storage.checksum_bytes += bytes,
                _ => storage.other_bytes += bytes,
            }
        }
        storage
    }
}
