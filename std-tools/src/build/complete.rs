//! From a simplex tree to the arrays of the whole Simplified Incidence Graph: [`complete`].

use std::sync::atomic::AtomicBool;

use sig_core::Index;

use crate::build::{Arrays, BuildError, BuildOptions, BuildReport, Built, Limit, Meter, Phase, SigArrays};
use crate::build::{clusters, facets, index, narrow};
use crate::frozen::{FrozenTree, LastVertices};

/// Adds the boundary and the partial co-boundary relations to a simplex tree: what [`build`](crate::build::build) makes of
/// the same simplices, but for the parity of the top simplices, which a tree does not know.
///
/// Of the options, the limits and the progress count; the vertices keep their numbers. Time: a search in a short list for
/// each facet, and a union for each (simplex, facet, cluster). Memory peaks at about twice the result.
///
/// # Errors
/// [`BuildError::TooLarge`] if there is not enough room, [`BuildError::MalformedTree`] if the arrays are not a tree or the
/// simplices are not closed under taking faces.
pub fn complete(tree: FrozenTree, options: &BuildOptions<'_>) -> Result<Built, BuildError> {
    check(&tree)?;
    Limit::check(&tree.counts(), options)?;
    let meter = Meter::new(options.progress);
    let FrozenTree { first, num_simplices, child_offsets, last_vertices, filtration, labels, coordinates } = tree;
    let arrays = SigArrays::<u32> { first, num_simplices, child_offsets, ..SigArrays::default() };
    let (arrays, is_top) = match last_vertices {
        LastVertices::Bits16(last_vertices) => {
            let (mut arrays, is_top) = add_facets(arrays, &last_vertices, &meter)?;
            arrays.last_vertices = last_vertices.into_iter().map(u32::from).collect();
            (arrays, is_top)
        }
        LastVertices::Bits32(last_vertices) => {
            let (mut arrays, is_top) = add_facets(arrays, &last_vertices, &meter)?;
            arrays.last_vertices = last_vertices;
            (arrays, is_top)
        }
    };
    let top_simplices: Vec<usize> = is_top.iter().map(|tops| tops.iter().filter(|&&is_top| is_top).count()).collect();
    let report = BuildReport { listed: top_simplices.iter().sum(), top_simplices, ..BuildReport::default() };
    let arrays: Arrays = clusters::add(arrays, &is_top, &meter);
    Ok(Built { arrays, labels, coordinates, parity: None, filtration, attributes: Vec::new(), report })
}

/// Checks that the arrays have the shape of a tree in level order.
fn check(tree: &FrozenTree) -> Result<(), BuildError> {
    let Some(dim) = tree.dim() else {
        let is_empty = tree.num_simplices == 0 && tree.last_vertices.is_empty();
        return if is_empty { Ok(()) } else { Err(BuildError::MalformedTree(0)) };
    };
    let inner = tree.first[dim];
    if tree.first[0] != 0
        || !tree.first.is_sorted_by(|a, b| a < b)
        || inner >= tree.num_simplices
        || tree.last_vertices.len() != tree.num_simplices
        || tree.child_offsets.len() != inner + 1
        || u32::try_from(tree.num_simplices).map_or(true, |count| count == u32::MAX)
    {
        return Err(BuildError::MalformedTree(0));
    }
    // The children of a dimension are the next dimension.
    for p in 0..dim {
        let (ids, children) = (tree.ids(p), tree.ids(p + 1));
        let offsets = &tree.child_offsets[ids.start..=ids.end];
        let ends = (offsets[0] as usize, offsets[ids.len()] as usize);
        if ends != (children.start, children.end) {
            return Err(BuildError::MalformedTree(ids.start));
        }
        if let Some(id) = offsets.windows(2).position(|pair| pair[0] > pair[1]) {
            return Err(BuildError::MalformedTree(ids.start + id));
        }
    }
    let misnamed = tree.ids(0).find(|&vertex| tree.last_vertices.at(vertex) as usize != vertex);
    misnamed.map_or(Ok(()), |vertex| Err(BuildError::MalformedTree(vertex)))
}

/// Adds the facets, and tells which simplices of each dimension are top: nothing for a dimension of which none is.
fn add_facets<L: Index>(
    mut arrays: SigArrays<u32>,
    last_vertices: &[L],
    meter: &Meter<'_>,
) -> Result<(SigArrays<u32>, Vec<Vec<bool>>), BuildError> {
    let Some(dim) = arrays.dim() else { return Ok((arrays, Vec::new())) };
    let stage = meter.stage(Phase::Boundary, dim);
    arrays.boundary = vec![0; (1..=dim).map(|p| (p + 1) * arrays.ids(p).len()).sum()];
    let mut is_top = Vec::with_capacity(dim + 1);
    for p in 1..=dim {
        let has_coface: Vec<AtomicBool> = arrays.ids(p - 1).map(|_| AtomicBool::new(false)).collect();
        add_parents(&mut arrays, last_vertices, p, &has_coface)?;
        if p > 1 {
            facets::fill(&mut arrays, last_vertices, p, p, &has_coface).map_err(BuildError::MalformedTree)?;
        }
        is_top.push(has_coface.into_iter().map(|mark| !mark.into_inner()).collect());
        stage.add(1);
    }
    is_top.push(vec![true; arrays.ids(dim).len()]);
    for tops in &mut is_top {
        if !tops.contains(&true) {
            *tops = Vec::new();
        }
    }
    Ok((arrays, is_top))
}

/// Writes the last facet of every simplex of dimension `dim`, its parent; of an edge the first as well.
fn add_parents<L: Index>(
    arrays: &mut SigArrays<u32>,
    last_vertices: &[L],
    dim: usize,
    has_coface: &[AtomicBool],
) -> Result<(), BuildError> {
    let (parents, num_vertices) = (arrays.ids(dim - 1), arrays.ids(0).len());
    let below: usize = (1..dim).map(|p| arrays.ids(p).len() * (p + 1)).sum();
    let mut rows = arrays.boundary[below..].chunks_exact_mut(dim + 1);
    for parent in parents.clone() {
        let children = arrays.child_offsets[parent] as usize..arrays.child_offsets[parent + 1] as usize;
        if !children.is_empty() {
            facets::mark(&has_coface[parent - parents.start]);
        }
        let mut before = last_vertices[parent];
        for (child, row) in children.zip(&mut rows) {
            let label = last_vertices[child];
            // Siblings increase, and come after their parent.
            if label <= before || label.to_usize() >= num_vertices {
                return Err(BuildError::MalformedTree(child));
            }
            before = label;
            row[dim] = narrow(parent);
            if dim == 1 {
                row[0] = index(label.to_usize());
                facets::mark(&has_coface[label.to_usize()]);
            }
        }
    }
    Ok(())
}
