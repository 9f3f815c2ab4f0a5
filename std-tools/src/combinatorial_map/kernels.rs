//! Which edges of a 2-map to contract and to remove, so that a pyramid has few levels.

use sig_core::SimplexId;

use super::pyramid::root;
use super::{CombinatorialMap, Walk};

/// Edges, each with the cell that is deleted with it: a vertex in a contraction kernel, a face in a removal kernel.
pub type Kernel = Vec<(SimplexId, SimplexId)>;

/// A contraction kernel after which each component has half the vertices at most: the edges of a maximal matching, first
/// come by number, and for each vertex that it leaves alone an edge to one that it does not. The trees have two levels.
///
/// Empty if the map is not a 2-map. Cost: two passes over the edges.
#[must_use]
pub fn contraction(map: &CombinatorialMap) -> Kernel {
    let mut kernel = Kernel::new();
    if map.dim() != 2 {
        return kernel;
    }
    let mut is_taken = vec![false; map.first[1]];
    for (edge, [one, other]) in ends(map) {
        if one != other && !is_taken[one.index()] && !is_taken[other.index()] {
            is_taken[one.index()] = true;
            is_taken[other.index()] = true;
            kernel.push((edge, one.max(other)));
        }
    }
    let matched = is_taken.clone();
    for (edge, [one, other]) in ends(map) {
        for (alone, beside) in [(one, other), (other, one)] {
            if !is_taken[alone.index()] && matched[beside.index()] {
                is_taken[alone.index()] = true;
                kernel.push((edge, alone));
            }
        }
    }
    kernel
}

/// A removal kernel of the boundaries that contraction leaves behind: from each face of one or two edges, and from each of
/// which all edges lead from a vertex to itself, an edge to another face, as long as they form a forest of the dual graph.
///
/// Empty if the map is not a 2-map. Cost: a walk around every face.
#[must_use]
pub fn removal(map: &CombinatorialMap) -> Kernel {
    let mut kernel = Kernel::new();
    if map.dim() != 2 {
        return kernel;
    }
    let mut walk = Walk::new();
    let mut classes: Vec<u32> = (0..).take(map.first[3]).collect();
    for face in map.cells(2) {
        let Some(dart) = map.dart_of(face) else { continue };
        map.walk_cell(dart.0, 2, &mut walk);
        let is_loop = |dart: &u32| map.c(0, *dart) == map.c(0, map.b(1, *dart));
        if walk.orbit.len() > 2 && !walk.orbit.iter().all(is_loop) {
            continue;
        }
        for &dart in &walk.orbit {
            let [one, other] = [dart, map.b(2, dart)].map(|dart| root(&mut classes, map.c(2, dart)));
            if one != other {
                classes[one as usize] = other;
                kernel.push((SimplexId::new(map.c(1, dart) as usize), face));
                break;
            }
        }
    }
    kernel
}

/// The edges, each with its two ends.
fn ends(map: &CombinatorialMap) -> impl Iterator<Item = (SimplexId, [SimplexId; 2])> + '_ {
    map.cells(1).filter_map(|edge| {
        let dart = map.dart_of(edge)?.0;
        Some((edge, [dart, map.b(2, dart)].map(|dart| SimplexId::new(map.c(0, dart) as usize))))
    })
}
