//! Every query on a view that may be anything: nothing is known but that it was opened.

use sig_core::format::{ENTRY_BYTES, HEADER_BYTES, crc32};
use sig_core::{Complex, Index, Relations, SimplexId, Tree, VertexId};

use crate::conformance::Memory;

/// Asks a complex every query on up to `simplices` simplices, and past the end, and checks that each answer ends within
/// the number of simplices there are; the same of its tree, if it has one. Returns how many items came back.
///
/// # Panics
/// If an answer is longer than it can be.
pub fn ask_everything<I: Index>(complex: &Complex<'_, I>, simplices: usize) -> usize {
    let (total, bytes) = (complex.num_simplices(), complex.container().bytes().len());
    let mut items = ask_relations(complex, simplices) + complex.as_tree().map_or(0, |tree| ask_tree(tree, simplices));
    let mut memory = memory(total);
    let mut scratch = memory.scratch();
    for id in ids(total, simplices) {
        items += ended(complex.partial_coboundary(id).count(), bytes) + usize::from(complex.is_single_cluster(id));
        for cluster in complex.clusters(id) {
            let members = complex.cluster_members(id, cluster.representative, &mut scratch);
            items += ended(members.map_or(0, Iterator::count), total + 31);
        }
        for dim in 0..=complex.dim().unwrap_or(0) + 1 {
            items += ended(complex.partial_coboundary_of_dim(id, dim).count(), bytes);
        }
    }
    let _ = (complex.paper_storage(), complex.file_storage(), complex.validate(), complex.provenance());
    for dim in 0..=complex.dim().unwrap_or(0) {
        let _ = (complex.cluster_counts(dim).total(), complex.attribute(dim, "weight"));
    }
    assert!(memory.marks.iter().all(|&word| word == 0), "a query left marks behind");
    items
}

/// The same of a tree.
///
/// # Panics
/// If an answer is longer than it can be.
pub fn ask_tree<I: Index>(tree: &Tree<'_, I>, simplices: usize) -> usize {
    let total = tree.num_simplices();
    let mut order = vec![I::ZERO; total.min(4096)];
    let ordered = tree.filtration_order(&mut order).map_or(0, Iterator::count);
    let _ = (tree.validate(), tree.provenance(), tree.attribute(0, "weight"), tree.has_lower_neighbours());
    ask_relations(tree, simplices) + ended(ordered, total) + ended(tree.depth_first().count(), total)
}

/// What complexes and trees are asked.
fn ask_relations<V: Relations>(view: &V, simplices: usize) -> usize {
    let total = view.num_simplices();
    let mut memory = memory(total);
    let mut items = 0;
    let mut ended = |count: usize, limit: usize| items += ended(count, limit);
    let mut scratch = memory.scratch();
    for id in ids(total, simplices) {
        ended(view.vertices(id).count(), 32);
        ended(view.facets(id).count() + view.facets(id).rev().count(), 64);
        ended(view.closure(id).count(), total);
        ended(view.children(id).count() + view.siblings(id).count(), 2 * total);
        for dim in 0..=view.dim().unwrap_or(0) + 1 {
            ended(view.boundary(id, dim).count(), total);
            ended(view.coboundary(id, dim, &mut scratch).map_or(0, Iterator::count), total + 31);
            ended(view.k_adjacency(id, dim, &mut scratch).map_or(0, Iterator::count), total + 31);
        }
        ended(view.star(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        ended(view.restricted_star(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        ended(view.link(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        ended(view.adjacency(id, &mut scratch).map_or(0, Iterator::count), total + 31);
        let word: Vec<VertexId> = view.vertices(id).collect();
        ended(usize::from(view.find(&word).is_some()), 1);
        ended(view.with_prefix(&word).count(), total);
        ended(usize::from(view.is_top(id)) + usize::from(view.parent(id).is_some()), 2);
        ended(usize::from(view.last_vertex(id).is_some()), 1);
        ended(usize::from(view.labels().get(VertexId::new(id.index())).is_some()), 1);
    }
    let _ = (view.euler_characteristic(), view.coordinates(), view.parity(), view.filtration());
    assert!(memory.marks.iter().all(|&word| word == 0), "a query left marks behind");
    items
}

/// Marks are whole words, so a damaged complex may report that many ids.
fn memory<I: Index>(total: usize) -> Memory<I> {
    Memory::new(total.div_ceil(32), 2 * total.min(4096), 4 * total.min(4096))
}

/// Up to so many simplices, spread over all dimensions, and some past the end.
fn ids(total: usize, simplices: usize) -> impl Iterator<Item = SimplexId> {
    (0..total)
        .step_by(total.div_ceil(simplices.max(1)).max(1))
        .chain([total, total + 7, usize::MAX])
        .map(SimplexId::new)
}

fn ended(count: usize, limit: usize) -> usize {
    assert!(count <= limit, "{count} items, {limit} possible");
    count
}

/// Computes the header's checksum anew, so that what was changed in the header or the table gets past it.
pub fn reseal(bytes: &mut [u8]) {
    const CHECKSUM: std::ops::Range<usize> = 40..44;
    if bytes.len() < HEADER_BYTES {
        return;
    }
    let field = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]) as usize;
    let (sections, names) = (field(20), field(44));
    let end = sections.saturating_mul(ENTRY_BYTES).saturating_add(names).saturating_add(HEADER_BYTES).min(bytes.len());
    bytes[CHECKSUM].fill(0);
    let checksum = crc32(0, &bytes[..end]);
    bytes[CHECKSUM].copy_from_slice(&checksum.to_le_bytes());
}
