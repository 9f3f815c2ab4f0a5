//! Every query on a view that may be anything: nothing is known but that it was opened.

use sig_core::format::{ENTRY_BYTES, HEADER_BYTES, crc32};
use sig_core::{Complex, Index, SimplexId, VertexId};

use crate::conformance::Memory;

/// Asks every query on up to `simplices` simplices, and past the end, and checks that each answer ends within the
/// number of simplices there are. Returns how many items came back.
///
/// # Panics
/// If an answer is longer than it can be.
pub fn ask_everything<I: Index>(complex: &Complex<'_, I>, simplices: usize) -> usize {
    let total = complex.num_simplices();
    // Marks are whole words, so a damaged complex may report that many ids.
    let mut memory = Memory::<I>::new(total.div_ceil(32), 2 * total.min(4096), 4 * total.min(4096));
    let mut items = 0;
    let mut ended = |count: usize, limit: usize| {
        assert!(count <= limit, "{count} items, {limit} possible");
        items += count;
    };
    let bytes = complex.container().bytes().len();
    let mut scratch = memory.scratch();
    for id in (0..total.min(simplices)).chain([total, total + 7, usize::MAX]).map(SimplexId::new) {
        ended(complex.vertices(id).count(), 32);
        ended(complex.facets(id).count(), 32);
        ended(complex.closure(id).count(), total);
        ended(complex.partial_coboundary(id).count(), bytes);
        ended(complex.children(id).count() + complex.siblings(id).count(), 2 * total);
        for cluster in complex.clusters(id) {
            let members = complex.cluster_members(id, cluster.representative, &mut scratch);
            ended(members.map_or(0, Iterator::count), total + 31);
        }
        for dim in 0..=complex.dim().unwrap_or(0) + 1 {
            ended(complex.boundary(id, dim).count(), total);
            ended(complex.coboundary(id, dim, &mut scratch).map_or(0, Iterator::count), total + 31);
            ended(complex.k_adjacency(id, dim, &mut scratch).map_or(0, Iterator::count), total + 31);
            ended(complex.partial_coboundary_of_dim(id, dim).count(), bytes);
        }
        ended(complex.star(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        ended(complex.restricted_star(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        ended(complex.link(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        ended(complex.adjacency(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        let word: Vec<VertexId> = complex.vertices(id).collect();
        ended(usize::from(complex.find(&word).is_some()), 1);
        ended(complex.with_prefix(&word).count(), total);
        let flags = [complex.is_top(id), complex.is_single_cluster(id), complex.parent(id).is_some()];
        ended(flags.into_iter().filter(|&flag| flag).count(), flags.len());
        ended(usize::from(complex.last_vertex(id).is_some()), 1);
        ended(usize::from(complex.labels().get(VertexId::new(id.index())).is_some()), 1);
    }
    ask_the_whole(complex);
    assert!(memory.marks.iter().all(|&word| word == 0), "a query left marks behind");
    items
}

/// What is asked of a complex, not of a simplex.
fn ask_the_whole<I: Index>(complex: &Complex<'_, I>) {
    let _ = (complex.euler_characteristic(), complex.paper_storage(), complex.file_storage(), complex.validate());
    let _ = (complex.coordinates(), complex.parity(), complex.filtration(), complex.provenance());
    for dim in 0..=complex.dim().unwrap_or(0) {
        let _ = (complex.cluster_counts(dim).total(), complex.attribute(dim, "weight"));
    }
}

/// Computes the header's checksum anew, so that what was changed in the header or the table gets past it.
pub fn reseal(bytes: &mut [u8]) {
    const CHECKSUM: std::ops::Range<usize> = 40..44;
    if bytes.len() < HEADER_BYTES {
        return;
    }
    let field = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]) as usize;
    let (sections, names) = (field(20), field(44));
    let end = sections.saturating_mul(ENTRY_BYTES).saturating_add(HEADER_BYTES + names).min(bytes.len());
    bytes[CHECKSUM].fill(0);
    let checksum = crc32(0, &bytes[..end]);
    bytes[CHECKSUM].copy_from_slice(&checksum.to_le_bytes());
}
