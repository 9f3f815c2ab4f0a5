//! The relations by number.

use sig_core::{Complex, Index, Relations, Scratch, ScratchError, SimplexId, VertexId};

/// A relation of a simplex to others. The numbers are part of the interface for C and WebAssembly.
///
/// What the argument is for stands with each; the others ignore it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u32)]
pub enum Relation {
    /// The vertices, increasing.
    Vertices = 0,
    /// The facets, the one without the first vertex first.
    Facets = 1,
    /// The faces of one dimension, the argument, in the order of their ids.
    Boundary = 2,
    /// All faces and the simplex itself, in the order of their ids.
    Closure = 3,
    /// The cofaces of one dimension, the argument.
    Coboundary = 4,
    /// The simplex and all its cofaces.
    Star = 5,
    /// All proper cofaces.
    RestrictedStar = 6,
    /// The faces of the star that do not meet the simplex.
    Link = 7,
    /// The other simplices of the same dimension that share a facet; for a vertex, the other ends of its edges.
    Adjacency = 8,
    /// The other simplices of the same dimension that share a face of one dimension, the argument.
    KAdjacency = 9,
    /// The face without the last vertex; nothing for a vertex.
    Parent = 10,
    /// The simplices with one vertex more, after the last one.
    Children = 11,
    /// The children of the parent, the simplex among them.
    Siblings = 12,
    /// The simplices whose words start with the vertices of the simplex.
    Prefixed = 13,
    /// The least simplex of each cluster of top simplices around the simplex; nothing for a top simplex.
    Clusters = 14,
    /// The top simplices of the cluster to which one of them, the argument, belongs.
    Cluster = 15,
}

impl Relation {
    /// All, by number.
    #[must_use]
    pub const fn all() -> [Self; 16] {
        [
            Self::Vertices,
            Self::Facets,
            Self::Boundary,
            Self::Closure,
            Self::Coboundary,
            Self::Star,
            Self::RestrictedStar,
            Self::Link,
            Self::Adjacency,
            Self::KAdjacency,
            Self::Parent,
            Self::Children,
            Self::Siblings,
            Self::Prefixed,
            Self::Clusters,
            Self::Cluster,
        ]
    }

    /// The relation of a number.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        Self::all().get(usize::try_from(code).ok()?).copied()
    }

    /// What the lines of a survey call it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Vertices => "vertices",
            Self::Facets => "facets",
            Self::Boundary => "boundary",
            Self::Closure => "closure",
            Self::Coboundary => "coboundary",
            Self::Star => "star",
            Self::RestrictedStar => "restricted-star",
            Self::Link => "link",
            Self::Adjacency => "adjacency",
            Self::KAdjacency => "k-adjacency",
            Self::Parent => "parent",
            Self::Children => "children",
            Self::Siblings => "siblings",
            Self::Prefixed => "prefixed",
            Self::Clusters => "clusters",
            Self::Cluster => "cluster",
        }
    }

    /// Whether a file of kind *tree* does not know it.
    #[must_use]
    pub const fn needs_clusters(self) -> bool {
        matches!(self, Self::Clusters | Self::Cluster)
    }
}

/// Hands every simplex of a relation to `each`, clusters included.
///
/// # Errors
/// [`ScratchError`] if the scratch is too small; nothing was handed out then.
pub fn ask<I: Index>(
    complex: &Complex<'_, I>,
    (relation, argument): (Relation, usize),
    simplex: SimplexId,
    scratch: &mut Scratch<'_, I>,
    each: &mut impl FnMut(usize),
) -> Result<(), ScratchError> {
    match relation {
        Relation::Clusters => complex.partial_coboundary(simplex).map(SimplexId::index).for_each(each),
        Relation::Cluster => {
            complex.cluster_members(simplex, SimplexId::new(argument), scratch)?.map(SimplexId::index).for_each(each);
        }
        _ => return ask_view(complex, (relation, argument), simplex, scratch, each),
    }
    Ok(())
}

/// Hands every simplex of a relation of a complex or of a tree to `each`; nothing of clusters.
///
/// # Errors
/// [`ScratchError`] if the scratch is too small; nothing was handed out then.
pub fn ask_view<V: Relations>(
    view: &V,
    (relation, argument): (Relation, usize),
    simplex: SimplexId,
    scratch: &mut Scratch<'_, V::Index>,
    each: &mut impl FnMut(usize),
) -> Result<(), ScratchError> {
    let found = match relation {
        Relation::Coboundary => view.coboundary(simplex, argument, scratch)?,
        Relation::Star => view.star(simplex, scratch)?,
        Relation::RestrictedStar => view.restricted_star(simplex, scratch)?,
        Relation::Link => view.link(simplex, scratch)?,
        Relation::Adjacency => view.adjacency(simplex, scratch)?,
        Relation::KAdjacency => view.k_adjacency(simplex, argument, scratch)?,
        _ => {
            ask_without_scratch(view, (relation, argument), simplex, each);
            return Ok(());
        }
    };
    found.map(SimplexId::index).for_each(each);
    Ok(())
}

fn ask_without_scratch<V: Relations>(
    view: &V,
    (relation, argument): (Relation, usize),
    simplex: SimplexId,
    each: &mut impl FnMut(usize),
) {
    match relation {
        Relation::Vertices => view.vertices(simplex).map(VertexId::index).for_each(each),
        Relation::Facets => view.facets(simplex).map(SimplexId::index).for_each(each),
        Relation::Boundary => view.boundary(simplex, argument).map(SimplexId::index).for_each(each),
        Relation::Closure => view.closure(simplex).map(SimplexId::index).for_each(each),
        Relation::Parent => view.parent(simplex).into_iter().map(SimplexId::index).for_each(each),
        Relation::Children => view.children(simplex).map(SimplexId::index).for_each(each),
        Relation::Siblings => view.siblings(simplex).map(SimplexId::index).for_each(each),
        Relation::Prefixed => with_own_prefix(view, simplex, each),
        _ => {}
    }
}

fn with_own_prefix<V: Relations>(view: &V, simplex: SimplexId, each: &mut impl FnMut(usize)) {
    let mut word = [VertexId::new(0); sig_core::MAX_DIM + 1];
    let mut len = 0;
    for (slot, vertex) in word.iter_mut().zip(view.vertices(simplex)) {
        *slot = vertex;
        len += 1;
    }
    // Of an id past the end there is no word, and the empty prefix is that of all simplices.
    if let Some(prefix) = word.get(..len).filter(|prefix| !prefix.is_empty()) {
        view.with_prefix(prefix).map(SimplexId::index).for_each(each);
    }
}
