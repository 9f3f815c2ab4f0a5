//! Where a complex is no manifold.

use sig_core::{Complex, Index, SimplexId};

/// The simplices of a complex of dimension 3 at most at which it is no manifold, with or without boundary, of any dimension:
/// those whose link is neither a sphere nor a ball. Simplices of different dimensions may be around different ones.
///
/// A top simplex has the empty link, which is the sphere of dimension −1. The faces of a singular simplex are singular.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Singularities {
    /// The singular simplices of dimensions 0, 1 and 2, by increasing id.
    pub by_dim: [Vec<SimplexId>; 3],
}

/// What is in the link of a vertex of tetrahedra.
#[derive(Clone, Copy, Default)]
struct Link {
    /// The Euler characteristic.
    euler: i32,
    /// Edges on one triangle.
    border: u32,
}

impl Singularities {
    /// Finds them by the clusters around each simplex, that is by what a SIG stores, and the Euler characteristics of the
    /// links of vertices; `None` for a complex of a higher dimension, where recognising spheres is another matter.
    ///
    /// Cost: one pass over pointers and lists, one over the boundary relations; 9 bytes a vertex and one an edge.
    #[must_use]
    pub fn new<I: Index>(complex: &Complex<'_, I>) -> Option<Self> {
        let Some(dim) = complex.dim() else { return Some(Self::default()) };
        if dim > 3 {
            return None;
        }
        let num_vertices = complex.num_vertices();
        let first_edge = complex.simplices_of_dim(1).bounds().0.index();
        let mut is_singular_vertex = vec![false; num_vertices];
        let mut is_singular_edge = vec![false; complex.num_simplices_of_dim(1)];
        let mut triangles = Vec::new();
        for triangle in complex.simplices_of_dim(2) {
            if complex.partial_coboundary(triangle).nth(2).is_some() {
                triangles.push(triangle);
                for edge in complex.facets(triangle) {
                    is_singular_edge[edge.index() - first_edge] = true;
                }
            }
        }
        for (edge, is_singular) in complex.simplices_of_dim(1).zip(&mut is_singular_edge) {
            // Two triangles at most, or tetrahedra around it in a row or a ring.
            *is_singular |= !matches!(clusters(complex, edge), [0, 0, 0..=2, 0] | [0, 0, 0, 1]);
            if *is_singular {
                complex.vertices(edge).for_each(|vertex| is_singular_vertex[vertex.index()] = true);
            }
        }
        let links = links(complex);
        for (vertex, is_singular) in complex.simplices_of_dim(0).zip(&mut is_singular_vertex) {
            *is_singular |= match clusters(complex, vertex) {
                [0, 0..=2, 0, 0] | [0, 0, 1, 0] => false,
                // The link is a surface in one piece: of these only the sphere has 2, and of those with a border the disk 1.
                [0, 0, 0, 1] => {
                    !matches!(links[vertex.index()], Link { euler: 2, .. } | Link { euler: 1, border: 1.. })
                }
                _ => true,
            };
        }
        let listed = |first: usize, marks: &[bool]| {
            let numbers = marks.iter().enumerate().filter(|&(_, &is_singular)| is_singular);
            numbers.map(|(number, _)| SimplexId::new(first + number)).collect()
        };
        Some(Self { by_dim: [listed(0, &is_singular_vertex), listed(first_edge, &is_singular_edge), triangles] })
    }

    /// Whether the complex is a manifold of mixed dimension.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.by_dim.iter().all(Vec::is_empty)
    }
}

/// The number of clusters of each dimension around a simplex.
fn clusters<I: Index>(complex: &Complex<'_, I>, simplex: SimplexId) -> [usize; 4] {
    let mut counts = [0; 4];
    for cluster in complex.clusters(simplex) {
        if let Some(count) = counts.get_mut(cluster.dim) {
            *count += 1;
        }
    }
    counts
}

/// The links of all vertices of a complex with tetrahedra.
fn links<I: Index>(complex: &Complex<'_, I>) -> Vec<Link> {
    let mut links = vec![Link::default(); complex.num_vertices()];
    for (dim, sign) in [(1, 1), (2, -1), (3, 1)] {
        if complex.dim() != Some(3) {
            break;
        }
        for simplex in complex.simplices_of_dim(dim) {
            let is_border = dim == 2 && complex.partial_coboundary(simplex).nth(1).is_none();
            for vertex in complex.vertices(simplex) {
                let link = &mut links[vertex.index()];
                link.euler += sign;
                link.border += u32::from(is_border);
            }
        }
    }
    links
}
