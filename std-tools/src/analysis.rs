//! What can be said of a complex as a whole: its top simplices, connectedness, regularity (sig-2004, 2).

use sig_core::{Complex, Dim, Index, Relations};

/// Facts about a complex as a whole.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Analysis {
    /// Top simplices of each dimension.
    pub top_simplices: Vec<usize>,
    /// The number of h-connected components for h = 0, …, d − 1: classes of simplices that are joined by a path of
    /// simplices of which consecutive ones share an h-face. A top simplex of dimension h or less is one by itself. For
    /// d = 0 a single number, that of the vertices; none for the empty complex.
    pub h_components: Vec<usize>,
    /// Whether all top simplices have the dimension of the complex; so it is for the empty complex.
    pub is_regular: bool,
    /// Whether the complex is regular and (d−1)-connected, and each (d−1)-simplex is a face of one or two d-simplices:
    /// a combinatorial pseudo-manifold, perhaps with boundary. For d = 0 that is one vertex or two, the (−1)-simplex
    /// being a face of both; the empty complex is none.
    pub is_pseudo_manifold: bool,
}

/// The number of top simplices of each dimension of a complex in a file of either kind.
///
/// Cost: the facets of every simplex, for which a tree searches; a byte for each simplex of one dimension of memory.
#[must_use]
pub fn num_top_simplices(complex: &impl Relations) -> Vec<usize> {
    let dims = complex.dim().map_or(0, |dim| dim + 1);
    let tops = |dim: Dim| {
        let simplices = complex.simplices_of_dim(dim);
        let first = simplices.bounds().0.index();
        let mut is_facet = vec![false; simplices.len()];
        for facet in complex.simplices_of_dim(dim + 1).flat_map(|coface| complex.facets(coface)) {
            if let Some(is_facet) = facet.index().checked_sub(first).and_then(|at| is_facet.get_mut(at)) {
                *is_facet = true;
            }
        }
        is_facet.into_iter().filter(|is_facet| !is_facet).count()
    };
    (0..dims).map(tops).collect()
}

impl Analysis {
    /// The number of connected components; 0 for the empty complex.
    #[must_use]
    pub fn components(&self) -> usize {
        self.h_components.first().copied().unwrap_or(0)
    }

    /// Analyses a complex.
    ///
    /// Cost: one pass over pointers and lists, and one union-find over all simplices that takes each facet once; an
    /// index for each simplex of memory. On a buffer that is no complex the numbers mean nothing.
    #[must_use]
    pub fn new<I: Index>(complex: &Complex<'_, I>) -> Self {
        let Some(dim) = complex.dim() else {
            return Self {
                top_simplices: Vec::new(),
                h_components: Vec::new(),
                is_regular: true,
                is_pseudo_manifold: false,
            };
        };
        // The d-simplices need no look: all are top simplices.
        let tops = |p| complex.simplices_of_dim(p).filter(|&simplex| complex.is_top(simplex)).count();
        let top_simplices: Vec<usize> = (0..dim).map(tops).chain([complex.num_simplices_of_dim(dim)]).collect();
        let h_components = h_components(complex, &top_simplices);
        let is_regular = top_simplices[..dim].iter().all(|&count| count == 0);
        let is_pseudo_manifold = is_regular
            && match dim.checked_sub(1) {
                None => complex.num_vertices() <= 2,
                Some(below) => {
                    // The d-simplices at a (d−1)-simplex are clusters of one each: its list has them all.
                    let thin = |simplex| complex.partial_coboundary(simplex).take(3).count() <= 2;
                    h_components[below] == 1 && complex.simplices_of_dim(below).all(thin)
                }
            };
        Self { top_simplices, h_components, is_regular, is_pseudo_manifold }
    }
}

/// The number of h-connected components for h = 0, …, d − 1; of vertices, for d = 0.
///
/// From h = d − 1 down: the simplices of dimension h come in, each a class by itself, and each (h+1)-simplex joins its
/// facets. Simplices of dimension less than h are in no class yet; the top ones among them are components of their own.
fn h_components<I: Index>(complex: &Complex<'_, I>, top_simplices: &[usize]) -> Vec<usize> {
    let dim = top_simplices.len() - 1;
    if dim == 0 {
        return vec![complex.num_vertices()];
    }
    let mut classes = Classes::<I>::new(complex.num_simplices());
    let mut count = complex.num_simplices_of_dim(dim);
    let mut components = vec![0; dim];
    for h in (0..dim).rev() {
        count += complex.num_simplices_of_dim(h);
        for simplex in complex.simplices_of_dim(h + 1) {
            let joined = complex.facets(simplex).filter(|facet| classes.join(simplex.index(), facet.index())).count();
            // Where it would be less than nothing, the buffer is no complex.
            count = count.saturating_sub(joined);
        }
        components[h] = count + top_simplices[..h].iter().sum::<usize>();
    }
    components
}

/// Disjoint sets of numbers, each with its least as root.
pub(crate) struct Classes<I> {
    /// A number of the same class, less than this one unless it is the root.
    parents: Vec<I>,
}

impl<I: Index> Classes<I> {
    pub(crate) fn new(count: usize) -> Self {
        Self { parents: (0..count).map(|number| I::from_usize(number).unwrap_or(I::STOP)).collect() }
    }

    /// The root of a number that is there. Halves the path to it.
    pub(crate) fn root(&mut self, mut number: usize) -> usize {
        loop {
            let parent = self.parents[number];
            let grandparent = self.parents[parent.to_usize()];
            if parent == grandparent {
                return parent.to_usize();
            }
            self.parents[number] = grandparent;
            number = grandparent.to_usize();
        }
    }

    /// Joins the classes of two numbers; whether they were different. Numbers that are not there have no class.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> bool {
        if a.max(b) >= self.parents.len() {
            return false;
        }
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.parents[a.max(b)] = self.parents[a.min(b)];
        }
        a != b
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sig_core::Complex;

    use super::{Analysis, num_top_simplices};
    use crate::build::{BuildOptions, build};
    use crate::soup::{Labels, Soup};
    use crate::store::{EncodeOptions, Encoding};

    fn analysis(simplices: &[Vec<u32>]) -> Analysis {
        let mut soup = Soup::new(Labels::Numbered(10), false);
        simplices.iter().for_each(|simplex| soup.push(simplex));
        let built = build(soup, &BuildOptions::default()).unwrap();
        let file = Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap();
        let complex = Complex::<u16>::from_bytes(&file).unwrap();
        let analysis = Analysis::new(&complex);
        assert_eq!(num_top_simplices(&complex), analysis.top_simplices);
        analysis
    }

    fn digits(simplices: &str) -> Analysis {
        let word = |word: &str| word.bytes().map(|digit| u32::from(digit - b'0')).collect();
        analysis(&simplices.split_whitespace().map(word).collect::<Vec<_>>())
    }

    #[test]
    fn figures_of_the_paper() {
        let figure_1 = digits("012 023 045 056 07");
        assert_eq!(figure_1.top_simplices, [0, 1, 4]);
        // The fans 012 023 and 045 056 meet in a vertex, as does the edge.
        assert_eq!(figure_1.h_components, [1, 3]);
        assert!(!figure_1.is_regular && !figure_1.is_pseudo_manifold);
        let figure_2 = digits("0123 0145 0156 017 018");
        assert_eq!(figure_2.top_simplices, [0, 0, 2, 3]);
        // All share edge 01; the tetrahedra 0145 and 0156 share a triangle, no other two cells do.
        assert_eq!(figure_2.h_components, [1, 1, 4]);
    }

    #[test]
    fn pseudo_manifolds() {
        let cases = [
            ("012 013 023 123", true, "the boundary of a tetrahedron"),
            ("012", true, "a disk"),
            ("012 013 014", false, "a book of three pages"),
            ("012 345", false, "two disks"),
            ("012 034", false, "two triangles at a vertex: not 1-connected"),
            ("012 03", false, "a dangling edge"),
            ("01 12 02", true, "a circle"),
            ("01 02 03", false, "three edges at a vertex"),
            ("0", true, "a point"),
            ("0 1", true, "the 0-sphere"),
            ("0 1 2", false, "three points"),
            ("", false, "nothing"),
        ];
        for (simplices, expected, what) in cases {
            assert_eq!(digits(simplices).is_pseudo_manifold, expected, "{what}");
        }
    }

    #[test]
    fn small_dimensions() {
        assert_eq!(digits("").components(), 0);
        assert_eq!(digits("").h_components, [0; 0]);
        assert_eq!(digits("0 1 2").h_components, [3]);
        assert_eq!(digits("01 2 3").h_components, [3]);
    }

    /// From the definition, on the top simplices: two that share h + 1 vertices share an h-face.
    fn components_by_definition(simplices: &[Vec<u32>], h: usize) -> usize {
        let is_face = |a: &[u32], b: &[u32]| a.iter().all(|vertex| b.contains(vertex));
        let mut tops: Vec<Vec<u32>> = Vec::new();
        for simplex in simplices {
            if !simplices.iter().any(|other| other.len() > simplex.len() && is_face(simplex, other))
                && !tops.iter().any(|top| top.len() == simplex.len() && is_face(simplex, top))
            {
                tops.push(simplex.clone());
            }
        }
        let mut class: Vec<usize> = (0..tops.len()).collect();
        for i in 0..tops.len() {
            for j in 0..i {
                if tops[i].iter().filter(|vertex| tops[j].contains(vertex)).count() > h {
                    let (from, to) = (class[i], class[j]);
                    class.iter_mut().filter(|class| **class == from).for_each(|class| *class = to);
                }
            }
        }
        class.sort_unstable();
        class.dedup();
        class.len()
    }

    proptest! {
        #[test]
        fn components_agree_with_the_definition(
            simplices in prop::collection::vec(prop::collection::btree_set(0..10_u32, 1..6), 1..12)
        ) {
            let simplices: Vec<Vec<u32>> = simplices.into_iter().map(|set| set.into_iter().collect()).collect();
            let found = analysis(&simplices).h_components;
            let dims = simplices.iter().map(Vec::len).max().unwrap_or(0);
            prop_assert_eq!(found.len(), (dims - 1).max(1));
            for (h, &count) in found.iter().enumerate() {
                prop_assert_eq!(count, components_by_definition(&simplices, h), "h = {}", h);
            }
        }
    }
}
