//! Algorithms 4 to 7 of sig-2004 as printed: recursive, with visited marks.
//!
//! The paper never resets the marks between nested calls, so a second call finds everything visited; here each call from
//! outside gets marks of its own. Names and order of the steps are the paper's.

use std::collections::BTreeSet;

use sig_core::{Complex, Dim, Index, SimplexId};

/// A set of simplices, in the order of their ids.
pub type Set = BTreeSet<SimplexId>;

/// Algorithm 4: the q-simplices on the boundary of a p-simplex, q < p.
#[must_use]
pub fn boundary<I: Index>(complex: &Complex<'_, I>, q: Dim, simplex: SimplexId) -> Set {
    fn visit<I: Index>(complex: &Complex<'_, I>, q: Dim, simplex: SimplexId, visited: &mut Set, found: &mut Set) {
        let p = dim(complex, simplex);
        for face in complex.facets(simplex) {
            if visited.insert(face) {
                if p == q + 1 {
                    found.insert(face);
                } else {
                    visit(complex, q, face, visited, found);
                }
            }
        }
    }
    let mut found = Set::new();
    visit(complex, q, simplex, &mut Set::new(), &mut found);
    found
}

/// Algorithm 5: the g-simplices in the restricted star of a p-simplex, g > p.
#[must_use]
pub fn coboundary<I: Index>(complex: &Complex<'_, I>, g: Dim, simplex: SimplexId) -> Set {
    let p = dim(complex, simplex);
    let mut found = Set::new();
    for r in g..=complex.dim().unwrap_or(0) {
        for representative in complex.partial_coboundary_of_dim(simplex, r) {
            let cluster = retrieve_cluster(complex, simplex, representative);
            if r == g {
                found.extend(cluster);
                continue;
            }
            for top in cluster {
                found.extend(
                    boundary(complex, g, top).into_iter().filter(|&face| boundary(complex, p, face).contains(&simplex)),
                );
            }
        }
    }
    found
}

/// Algorithm 6: the simplices of the cluster of `start` around a simplex.
#[must_use]
pub fn retrieve_cluster<I: Index>(complex: &Complex<'_, I>, simplex: SimplexId, start: SimplexId) -> Set {
    fn visit<I: Index>(complex: &Complex<'_, I>, simplex: SimplexId, top: SimplexId, visited: &mut Set) {
        let (p, r) = (dim(complex, simplex), dim(complex, top));
        if !visited.insert(top) || r <= p + 1 {
            return;
        }
        for face in complex.facets(top) {
            if boundary(complex, p, face).contains(&simplex) {
                for other in complex.partial_coboundary_of_dim(face, r) {
                    visit(complex, simplex, other, visited);
                }
            }
        }
    }
    let mut visited = Set::new();
    visit(complex, simplex, start, &mut visited);
    visited
}

/// Algorithm 7: the simplices adjacent to a simplex. As printed it lists a p-simplex, p > 0, among its own neighbours,
/// where it has any coface relation to go through; the definition does not.
#[must_use]
pub fn adjacency<I: Index>(complex: &Complex<'_, I>, simplex: SimplexId) -> Set {
    let p = dim(complex, simplex);
    let mut found = Set::new();
    if p > 0 {
        for face in complex.facets(simplex) {
            found.extend(coboundary(complex, p, face));
        }
    } else {
        for edge in coboundary(complex, 1, simplex) {
            found.extend(complex.facets(edge).filter(|&end| end != simplex));
        }
    }
    found
}

fn dim<I: Index>(complex: &Complex<'_, I>, simplex: SimplexId) -> Dim {
    complex.dim_of(simplex).expect("a simplex of the complex")
}
