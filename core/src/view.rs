//! What the views of a file have in common: numbers of simplices, columns beside the relations, and [`Relations`], through
//! which code that works on any of them asks.

use core::cmp::Ordering;

use crate::complex::SimplexRange;
use crate::complex::columns::Labels;
use crate::format::{Column, Container, Section};
use crate::id::{Dim, Index, SimplexId, VertexId};
use crate::relations::Simplices;
use crate::scratch::{Scratch, ScratchError};
use crate::tree::DepthFirst;

/// The methods of a view over `container` and `levels`, fields of the type.
macro_rules! common_methods {
    ($view:ident) => {
        impl<'a, I: Index> $view<'a, I> {
            /// The dimension of the complex; `None` for the empty complex, whose dimension is −1.
            #[must_use]
            pub const fn dim(&self) -> Option<Dim> {
                self.levels.dims().checked_sub(1)
            }

            /// The number of simplices of all dimensions.
            #[must_use]
            pub const fn num_simplices(&self) -> usize {
                self.levels.total()
            }

            /// n_p: the number of p-simplices.
            #[must_use]
            pub fn num_simplices_of_dim(&self, dim: Dim) -> usize {
                self.levels.ids(dim).len()
            }

            /// n_0: the number of vertices.
            #[must_use]
            pub fn num_vertices(&self) -> usize {
                self.num_simplices_of_dim(0)
            }

            /// All simplices, in the order of their ids.
            #[must_use]
            pub fn simplices(&self) -> $crate::complex::SimplexRange {
                $crate::complex::SimplexRange::new(0..self.levels.total())
            }

            /// The p-simplices, in the order of their ids: lexicographically by their vertices.
            #[must_use]
            pub fn simplices_of_dim(&self, dim: Dim) -> $crate::complex::SimplexRange {
                $crate::complex::SimplexRange::new(self.levels.ids(dim))
            }

            /// The dimension of a simplex; `None` past the end. Cost: O(d), a look-up in a table of d + 1 numbers.
            #[must_use]
            #[inline]
            pub fn dim_of(&self, simplex: SimplexId) -> Option<Dim> {
                self.levels.dim_of(simplex.index())
            }

            /// χ = Σ (−1)^p n_p.
            #[must_use]
            pub fn euler_characteristic(&self) -> i64 {
                (0..self.levels.dims()).fold(0, |sum, dim| {
                    let count = i64::try_from(self.num_simplices_of_dim(dim)).unwrap_or(i64::MAX);
                    if dim % 2 == 0 { sum + count } else { sum - count }
                })
            }

            /// The file that the complex lies in.
            #[must_use]
            pub const fn container(&self) -> &$crate::format::Container<'a> {
                &self.container
            }

            /// What the caller's data call the vertices.
            #[must_use]
            pub fn labels(&self) -> $crate::complex::columns::Labels<'a> {
                $crate::complex::columns::Labels::of(&self.container)
            }

            /// The coordinates of the vertices, row-major: as many components as the space has dimensions, single or
            /// double precision.
            #[must_use]
            pub fn coordinates(&self) -> Option<$crate::format::Section<'a>> {
                self.container.section($crate::format::SectionKind::Coordinates)
            }

            /// The orientations, where they are stored: bit `i` is whether sorting the vertices of the `i`-th top simplex, in
            /// the order of the ids, was an odd permutation of the order in which the caller gave them.
            #[must_use]
            pub fn parity(&self) -> Option<$crate::format::Column<'a>> {
                self.container.section($crate::format::SectionKind::Parity).map(|section| section.column)
            }

            /// The filtration value of each simplex.
            #[must_use]
            pub fn filtration(&self) -> Option<&'a [f64]> {
                match self.container.section($crate::format::SectionKind::Filtration)?.column {
                    $crate::format::Column::F64(values) => Some(values),
                    _ => None,
                }
            }

            /// A named column over the simplices of one dimension.
            #[must_use]
            pub fn attribute(&self, dim: Dim, name: &str) -> Option<$crate::format::Section<'a>> {
                let attribute = $crate::format::SectionKind::Attribute;
                let mut sections = self.container.sections().filter(|section| section.kind == attribute);
                sections.find(|section| section.dim == Some(dim) && section.name == name)
            }

            /// Where the complex comes from, in its maker's words.
            #[must_use]
            pub fn provenance(&self) -> Option<&'a str> {
                match self.container.section($crate::format::SectionKind::Provenance)?.column {
                    $crate::format::Column::U8(text) => core::str::from_utf8(text).ok(),
                    _ => None,
                }
            }

            /// The children of the simplex's parent in the simplex tree, the simplex among them: the vertices, for a vertex.
            /// Cost: as [`parent`](Self::parent) and [`children`](Self::children).
            #[must_use]
            pub fn siblings(&self, simplex: SimplexId) -> $crate::complex::SimplexRange {
                match (self.dim_of(simplex), self.parent(simplex)) {
                    (_, Some(parent)) => self.children(parent),
                    (Some(_), None) => self.simplices_of_dim(0),
                    (None, None) => $crate::complex::SimplexRange::new(0..0),
                }
            }

            /// The simplices whose words start with the given vertices, which must increase strictly; none if there is no
            /// simplex of them. The empty prefix is that of all simplices.
            ///
            /// Cost: [`find`](Self::find), then [`children`](Self::children) twice a dimension.
            #[must_use]
            pub fn with_prefix(&self, prefix: &[$crate::VertexId]) -> $crate::tree::Descendants<'_, Self> {
                $crate::tree::Descendants::new(self, prefix)
            }

            /// A_p(σ): for p > 0 the other p-simplices that share a (p−1)-face with σ; for p = 0 the other ends of the edges
            /// at the vertex.
            ///
            /// Cost: that of C_{p−1,p} for each facet τ, so in a SIG O(Σ_τ Σ_{r≥p} λ_r(τ)), linear in the top simplices
            /// incident at the facets; for p = 0 that of C_{0,1}, in a tree of the lists of neighbours. Where p > 0 there must
            /// be a mark for each simplex, and the answer's part of the scratch needs room for σ once for each facet besides.
            /// Source: Algorithm 7 of sig-2004, which lists σ itself too.
            ///
            /// # Errors
            /// [`ScratchError`]($crate::ScratchError) if the scratch is too small; it can be used again.
            pub fn adjacency<'s>(
                &self,
                simplex: SimplexId,
                scratch: &'s mut $crate::Scratch<'_, I>,
            ) -> Result<$crate::relations::Simplices<'s, I>, $crate::ScratchError> {
                match self.dim_of(simplex) {
                    Some(0) => self.adjacent_vertices(simplex, scratch),
                    Some(dim) => self.k_adjacency(simplex, dim - 1, scratch),
                    None => self.k_adjacency(simplex, 0, scratch),
                }
            }
        }
    };
}
pub(crate) use common_methods;

/// The simplex with the given vertices, which must increase strictly, where `child(dim, node, vertex)` is the simplex of
/// dimension `dim` that ends with `vertex` below a node, or the vertex itself for `dim` 0.
pub(crate) fn find_word(
    vertices: &[VertexId],
    child: impl Fn(Dim, usize, usize) -> Option<usize>,
) -> Option<SimplexId> {
    let (first, rest) = vertices.split_first()?;
    let mut node = child(0, 0, first.index())?;
    let mut last = *first;
    for (dim, &vertex) in (1..).zip(rest) {
        if vertex <= last {
            return None;
        }
        node = child(dim, node, vertex.index())?;
        last = vertex;
    }
    Some(SimplexId::new(node))
}

/// A simplicial complex that answers for its relations, whatever it stores: [`Complex`](crate::Complex) or
/// [`Tree`](crate::Tree).
///
/// For code that works on either. The methods are those of the same names of the two types, which say what they cost.
pub trait Relations {
    /// The width of the ids in a [`Scratch`].
    type Index: Index;

    /// The dimension of the complex; `None` for the empty complex.
    fn dim(&self) -> Option<Dim>;

    /// The simplices of one dimension, in the order of their ids.
    fn simplices_of_dim(&self, dim: Dim) -> SimplexRange;

    /// All simplices, in the order of their ids.
    fn simplices(&self) -> SimplexRange;

    /// The number of simplices of all dimensions.
    fn num_simplices(&self) -> usize {
        self.simplices().len()
    }

    /// The number of simplices of one dimension.
    fn num_simplices_of_dim(&self, dim: Dim) -> usize {
        self.simplices_of_dim(dim).len()
    }

    /// The number of vertices.
    fn num_vertices(&self) -> usize {
        self.num_simplices_of_dim(0)
    }

    /// The dimension of a simplex; `None` past the end.
    fn dim_of(&self, simplex: SimplexId) -> Option<Dim>;

    /// χ = Σ (−1)^p n_p.
    fn euler_characteristic(&self) -> i64;

    /// The vertices of a simplex, increasing.
    fn vertices(&self, simplex: SimplexId) -> impl ExactSizeIterator<Item = VertexId> + Clone;

    /// The last vertex of a simplex.
    fn last_vertex(&self, simplex: SimplexId) -> Option<VertexId>;

    /// The facets of a simplex, the one without the first vertex first.
    fn facets(&self, simplex: SimplexId) -> impl ExactSizeIterator<Item = SimplexId> + DoubleEndedIterator;

    /// The faces of one dimension of a simplex, in the order of their ids.
    fn boundary(&self, simplex: SimplexId, dim: Dim) -> impl ExactSizeIterator<Item = SimplexId>;

    /// All faces of a simplex and itself, in the order of their ids.
    fn closure(&self, simplex: SimplexId) -> impl ExactSizeIterator<Item = SimplexId>;

    /// The parent in the simplex tree.
    fn parent(&self, simplex: SimplexId) -> Option<SimplexId>;

    /// The children in the simplex tree.
    fn children(&self, simplex: SimplexId) -> SimplexRange;

    /// The children of the parent.
    fn siblings(&self, simplex: SimplexId) -> SimplexRange;

    /// The simplex with the given vertices, which must increase.
    fn find(&self, vertices: &[VertexId]) -> Option<SimplexId>;

    /// The simplices whose words start with the given vertices.
    fn with_prefix(&self, prefix: &[VertexId]) -> impl Iterator<Item = SimplexId>;

    /// Whether the simplex is a face of no other.
    fn is_top(&self, simplex: SimplexId) -> bool;

    /// The cofaces of one dimension.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small.
    fn coboundary<'s>(
        &self,
        simplex: SimplexId,
        dim: Dim,
        scratch: &'s mut Scratch<'_, Self::Index>,
    ) -> Result<Simplices<'s, Self::Index>, ScratchError>;

    /// The simplex and all its cofaces.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small.
    fn star<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, Self::Index>,
    ) -> Result<Simplices<'s, Self::Index>, ScratchError>;

    /// All proper cofaces.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small.
    fn restricted_star<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, Self::Index>,
    ) -> Result<Simplices<'s, Self::Index>, ScratchError>;

    /// The faces of the star that do not meet the simplex.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small.
    fn link<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, Self::Index>,
    ) -> Result<Simplices<'s, Self::Index>, ScratchError>;

    /// The other simplices of the same dimension that share a facet; for a vertex, the other ends of its edges.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small.
    fn adjacency<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, Self::Index>,
    ) -> Result<Simplices<'s, Self::Index>, ScratchError>;

    /// The other simplices of the same dimension that share a k-face.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small.
    fn k_adjacency<'s>(
        &self,
        simplex: SimplexId,
        k: Dim,
        scratch: &'s mut Scratch<'_, Self::Index>,
    ) -> Result<Simplices<'s, Self::Index>, ScratchError>;

    /// What the caller's data call the vertices.
    fn labels(&self) -> Labels<'_>;

    /// The coordinates of the vertices.
    fn coordinates(&self) -> Option<Section<'_>>;

    /// The file that the complex lies in.
    fn container(&self) -> &Container<'_>;

    /// The orientations of the top simplices, where they are stored.
    fn parity(&self) -> Option<Column<'_>>;

    /// The filtration value of each simplex.
    fn filtration(&self) -> Option<&[f64]>;

    /// All simplices, each before its children in the simplex tree and these before its next sibling: the lexicographic
    /// order of the words.
    ///
    /// Cost: [`children`](Self::children) for each simplex, no memory but the way down. By dimension they come from
    /// [`simplices`](Self::simplices).
    fn depth_first(&self) -> DepthFirst<'_, Self>
    where
        Self: Sized,
    {
        DepthFirst::new(self)
    }

    /// All simplices by (filtration value, dimension, lexicographic order of the words), in `order`, which has room for
    /// them: each comes after its faces. By (dimension, word) where there are no filtration values.
    ///
    /// Cost: a sort in place.
    ///
    /// # Errors
    /// [`ScratchError::Found`] if `order` is shorter than the number of simplices.
    fn filtration_order<'o>(&self, order: &'o mut [Self::Index]) -> Result<Simplices<'o, Self::Index>, ScratchError> {
        let (available, at_least) = (order.len(), self.num_simplices());
        let order = order.get_mut(..at_least).ok_or(ScratchError::Found { at_least, available })?;
        for (slot, id) in order.iter_mut().zip(0..) {
            *slot = Self::Index::from_usize(id).unwrap_or(Self::Index::STOP);
        }
        if let Some(values) = self.filtration() {
            let value = |id: &Self::Index| values.get(id.to_usize());
            order.sort_unstable_by(|left, right| {
                let values = value(left).zip(value(right));
                values.map_or(Ordering::Equal, |(left, right)| left.total_cmp(right)).then(left.cmp(right))
            });
        }
        Ok(Simplices::new(order))
    }
}

/// Implements [`Relations`] by the type's own methods of the same names.
macro_rules! impl_relations {
    ($($view:ident),*) => {$(
        impl<I: Index> Relations for $crate::$view<'_, I> {
            type Index = I;

            impl_relations! { @plain $crate::$view<'_, I>:
                dim() -> Option<Dim>;
                simplices_of_dim(dim: Dim) -> SimplexRange;
                simplices() -> SimplexRange;
                dim_of(simplex: SimplexId) -> Option<Dim>;
                euler_characteristic() -> i64;
                vertices(simplex: SimplexId) -> impl ExactSizeIterator<Item = VertexId> + Clone;
                last_vertex(simplex: SimplexId) -> Option<VertexId>;
                facets(simplex: SimplexId) -> impl ExactSizeIterator<Item = SimplexId> + DoubleEndedIterator;
                boundary(simplex: SimplexId, dim: Dim) -> impl ExactSizeIterator<Item = SimplexId>;
                closure(simplex: SimplexId) -> impl ExactSizeIterator<Item = SimplexId>;
                parent(simplex: SimplexId) -> Option<SimplexId>;
                children(simplex: SimplexId) -> SimplexRange;
                siblings(simplex: SimplexId) -> SimplexRange;
                find(vertices: &[VertexId]) -> Option<SimplexId>;
                with_prefix(prefix: &[VertexId]) -> impl Iterator<Item = SimplexId>;
                is_top(simplex: SimplexId) -> bool;
                labels() -> Labels<'_>;
                coordinates() -> Option<Section<'_>>;
                container() -> &Container<'_>;
                parity() -> Option<Column<'_>>;
                filtration() -> Option<&[f64]>;
            }
            impl_relations! { @scratch $crate::$view<'_, I>:
                coboundary(simplex: SimplexId, dim: Dim);
                star(simplex: SimplexId);
                restricted_star(simplex: SimplexId);
                link(simplex: SimplexId);
                adjacency(simplex: SimplexId);
                k_adjacency(simplex: SimplexId, k: Dim);
            }
        }
    )*};
    (@plain $view:ty: $($method:ident($($argument:ident: $of:ty),*) -> $result:ty;)*) => {$(
        #[inline]
        fn $method(&self, $($argument: $of),*) -> $result {
            <$view>::$method(self, $($argument),*)
        }
    )*};
    (@scratch $view:ty: $($method:ident($($argument:ident: $of:ty),*);)*) => {$(
        #[inline]
        fn $method<'s>(
            &self,
            $($argument: $of,)*
            scratch: &'s mut Scratch<'_, I>,
        ) -> Result<Simplices<'s, I>, ScratchError> {
            <$view>::$method(self, $($argument,)* scratch)
        }
    )*};
}

impl_relations!(Complex, Tree);
