//! Elementary collapses (simplex-tree-2012, 2.2.2): removing a face with the only simplex that it is a proper face of.

use sig_core::Dim;

use super::iterate::{MISSING, facets};
use super::rebuild::{Growth, Member};
use super::{NotFree, Simplex, SimplexTree, SizeError};
use crate::build::narrow;
use crate::frozen::FrozenTree;

/// An elementary collapse: of a free face, and of its only proper coface.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Collapse {
    /// The free face.
    pub face: Vec<u32>,
    /// Its only proper coface, which has one vertex more.
    pub coface: Vec<u32>,
}

/// A sequence of elementary collapses, in the order in which they are done: see [`SimplexTree::collapse_all`].
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Collapses {
    /// The cofaces, one after the other.
    labels: Vec<u32>,
    /// Of each collapse: the number of vertices of the coface, and which of them the face lacks.
    shapes: Vec<(u8, u8)>,
}

impl Collapses {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shapes.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty()
    }

    /// The collapses, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Collapse> {
        let mut rest = self.labels.as_slice();
        self.shapes.iter().map(move |&(len, omitted)| {
            let (coface, after) = rest.split_at(len.into());
            rest = after;
            let mut face = coface.to_vec();
            face.remove(omitted.into());
            Collapse { face, coface: coface.to_vec() }
        })
    }

    fn push(&mut self, coface: impl Iterator<Item = u32>, omitted: usize) {
        let before = self.labels.len();
        self.labels.extend(coface);
        // At most MAX_DIM + 1 vertices.
        let shape = [self.labels.len() - before, omitted].map(|count| u8::try_from(count).unwrap_or(u8::MAX));
        self.shapes.push((shape[0], shape[1]));
    }
}

impl SimplexTree {
    /// The only proper coface of a simplex, with which it is a free pair; `None` if it has none or several, or is not
    /// there. Cost: that of finding two of its cofaces by [`star`](Self::star).
    #[must_use]
    pub fn free_coface(&self, face: &[u32]) -> Option<Simplex<'_>> {
        let mut proper = self.star(face).filter(|coface| coface.dim() >= face.len());
        let coface = proper.next()?;
        proper.next().is_none().then_some(coface)
    }

    /// Collapses a free pair, which keeps the homotopy type. Cost: that of [`free_coface`](Self::free_coface), and of taking two
    /// nodes out.
    ///
    /// # Errors
    /// [`NotFree`] if the second simplex is not the only proper coface of the first; nothing is done then.
    pub fn collapse(&mut self, face: &[u32], coface: &[u32]) -> Result<(), NotFree> {
        let not_free = || NotFree { face: face.to_vec(), coface: coface.to_vec() };
        let free = self.free_coface(face).filter(|free| free.word() == coface).is_some();
        // There is always room for the smaller sets, where they were.
        let removed = if free { self.remove(face).map_err(|_| not_free())? } else { 0 };
        if removed == 2 { Ok(()) } else { Err(not_free()) }
    }

    /// Collapses free pairs until none is left; the sequence in which that was done. Filtration values stay what they are.
    ///
    /// The pairs of the highest dimension come first, of these those whose face is last in lexicographic order, and then
    /// those that collapsing has set free, the last one first. What is left depends on such choices; there is none that is
    /// always best. After each dimension `progress` is told how many simplices are done with, of how many.
    ///
    /// Cost: O(p) for each simplex, and O(p `D_m`) for its facets; 4 (p + 1) + 9 bytes each while it runs, and the memory
    /// of the tree that is left.
    ///
    /// # Errors
    /// [`SizeError`], which cannot be where the tree has room itself.
    pub fn collapse_all(&mut self, progress: Option<&(dyn Fn(u64, u64) + Sync)>) -> Result<Collapses, SizeError> {
        let frozen = self.freeze();
        let vertices: Vec<u32> = self.tops.labels().collect();
        let mut run = Run::new(&frozen);
        for dim in (0..frozen.first.len().saturating_sub(1)).rev() {
            run.collapse_faces(dim, &vertices);
            if let Some(progress) = progress {
                progress((frozen.num_simplices - frozen.first[dim + 1]) as u64, frozen.num_simplices as u64);
            }
        }
        let Run { present, collapses, .. } = run;
        if !collapses.is_empty() {
            *self = self.survivors(&frozen, &vertices, &present)?;
        }
        Ok(collapses)
    }

    /// The subcomplex of the simplices that are still present.
    fn survivors(&self, frozen: &FrozenTree, vertices: &[u32], present: &[bool]) -> Result<Self, SizeError> {
        let mut left = Self::with_layout(self.has_filtration(), self.has_label_lists());
        let value = |id: usize| frozen.filtration.as_ref().map_or(0.0, |values| values[id]);
        let children = |id: usize, _: Dim, members: &mut Vec<Member<usize>>| {
            let children = frozen.children(id).filter(|&child| present[child]);
            members
                .extend(children.map(|child| (vertices[frozen.last_vertices.at(child) as usize], value(child), child)));
            Ok::<(), SizeError>(())
        };
        let mut growth = Growth { tree: &mut left, children, pool: Vec::new() };
        for (vertex, &label) in vertices.iter().enumerate().filter(|&(vertex, _)| present[vertex]) {
            growth.vertex(label, value(vertex), vertex)?;
        }
        Ok(left)
    }
}

/// What is left of a complex that is being collapsed.
struct Run<'a> {
    frozen: &'a FrozenTree,
    facets: Vec<Vec<u32>>,
    present: Vec<bool>,
    /// How many cofaces of one dimension more each simplex has, and the exclusive or of their ids: the id, if it is one.
    cofacets: Vec<(u32, u32)>,
    collapses: Collapses,
}

impl<'a> Run<'a> {
    fn new(frozen: &'a FrozenTree) -> Self {
        let facets = facets(frozen);
        let mut cofacets = vec![(0, 0); frozen.num_simplices];
        for dim in 1..frozen.first.len() {
            for (id, facets) in frozen.ids(dim).zip(facets[dim].chunks_exact(dim + 1)) {
                for &facet in facets.iter().filter(|&&facet| facet != MISSING) {
                    let (count, ids) = &mut cofacets[facet as usize];
                    (*count, *ids) = (*count + 1, *ids ^ narrow(id));
                }
            }
        }
        let present = vec![true; frozen.num_simplices];
        Self { frozen, facets, present, cofacets, collapses: Collapses::default() }
    }

    fn facets(&self, dim: Dim, id: usize) -> std::ops::Range<usize> {
        let row = id - self.frozen.first[dim];
        if dim == 0 { 0..0 } else { row * (dim + 1)..(row + 1) * (dim + 1) }
    }

    /// Collapses free faces of one dimension until none is left. A collapse sets free none of a higher one.
    fn collapse_faces(&mut self, dim: Dim, vertices: &[u32]) {
        let is_free = |cofacets: (u32, u32)| cofacets.0 == 1;
        let mut free: Vec<usize> = self.frozen.ids(dim).filter(|&id| is_free(self.cofacets[id])).collect();
        while let Some(face) = free.pop() {
            if !self.present[face] || !is_free(self.cofacets[face]) {
                continue;
            }
            let coface = self.cofacets[face].1 as usize;
            let omitted = self.remove(dim + 1, coface, face, Some(&mut free));
            self.remove(dim, face, face, None);
            let word = self.word(dim + 1, coface);
            self.collapses.push(word.into_iter().map(|vertex| vertices[vertex as usize]), omitted);
        }
    }

    /// Removes a simplex without cofaces, collects what becomes free thereby, and tells which of its facets `face` is.
    fn remove(&mut self, dim: Dim, id: usize, face: usize, mut free: Option<&mut Vec<usize>>) -> usize {
        self.present[id] = false;
        let mut position = 0;
        for (omitted, at) in self.facets(dim, id).enumerate() {
            let facet = self.facets[dim][at];
            if facet == MISSING {
                continue;
            }
            let (count, ids) = &mut self.cofacets[facet as usize];
            (*count, *ids) = (*count - 1, *ids ^ narrow(id));
            if facet as usize == face {
                position = omitted;
            } else if let (1, Some(free)) = (*count, free.as_deref_mut()) {
                free.push(facet as usize);
            }
        }
        position
    }

    /// The vertices of a simplex, by number.
    fn word(&self, dim: Dim, id: usize) -> Vec<u32> {
        let mut word = vec![0; dim + 1];
        let mut node = id;
        for depth in (0..=dim).rev() {
            word[depth] = self.frozen.last_vertices.at(node);
            let facets = self.facets(depth, node);
            if depth > 0 {
                // The last facet omits the last vertex: the parent, always there.
                node = self.facets[depth][facets.end - 1] as usize;
            }
        }
        word
    }
}
