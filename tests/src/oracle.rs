//! A simplicial complex as a plain list of vertex words, and every relation by its definition (sig-2004, 2).
//!
//! Nothing here is clever: a relation looks at all simplices and keeps those that the definition names.

use std::collections::BTreeSet;

/// The vertices of a simplex, increasing.
pub type Word = Vec<usize>;

/// A cluster around a simplex: see [`Oracle::clusters`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cluster {
    /// The dimension of its top simplices.
    pub dim: usize,
    /// Their ids, increasing: the first is the representative.
    pub members: Vec<usize>,
}

/// A complex. A simplex is named by its id, its place in canonical order: by dimension, then lexicographically.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Oracle {
    words: Vec<Word>,
    labels: Vec<usize>,
}

impl Oracle {
    /// The complex of all faces of the given simplices, whose vertices may stand in any order.
    ///
    /// The vertices that occur are numbered by increasing label.
    ///
    /// # Panics
    /// Never.
    #[must_use]
    pub fn new<W: AsRef<[usize]>>(simplices: &[W]) -> Self {
        let labels: BTreeSet<usize> = simplices.iter().flat_map(|word| word.as_ref().iter().copied()).collect();
        let labels: Vec<usize> = labels.into_iter().collect();
        let number = |label: &usize| labels.iter().position(|other| other == label).expect("labels holds all");
        let mut words = BTreeSet::new();
        for simplex in simplices {
            let vertices: BTreeSet<usize> = simplex.as_ref().iter().map(number).collect();
            let vertices: Vec<usize> = vertices.into_iter().collect();
            for subset in 1..1u64 << vertices.len() {
                let face: Word =
                    (0..vertices.len()).filter(|position| subset >> position & 1 == 1).map(|at| vertices[at]).collect();
                words.insert((face.len(), face));
            }
        }
        Self { words: words.into_iter().map(|(_, word)| word).collect(), labels }
    }

    /// What the input calls the vertices.
    #[must_use]
    pub fn labels(&self) -> &[usize] {
        &self.labels
    }

    /// The number of simplices.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Whether there is no simplex.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// The number of dimensions: the dimension + 1, and 0 for the empty complex.
    #[must_use]
    pub fn dims(&self) -> usize {
        self.words.last().map_or(0, Vec::len)
    }

    /// The vertices of a simplex.
    #[must_use]
    pub fn word(&self, simplex: usize) -> &[usize] {
        &self.words[simplex]
    }

    /// All words, in canonical order.
    #[must_use]
    pub fn words(&self) -> &[Word] {
        &self.words
    }

    /// The dimension of a simplex.
    #[must_use]
    pub fn dim(&self, simplex: usize) -> usize {
        self.words[simplex].len() - 1
    }

    /// The ids of all simplices that satisfy a condition on their words.
    fn which(&self, condition: impl Fn(&[usize]) -> bool) -> Vec<usize> {
        (0..self.len()).filter(|&simplex| condition(&self.words[simplex])).collect()
    }

    /// The p-simplices.
    #[must_use]
    pub fn of_dim(&self, dim: usize) -> Vec<usize> {
        self.which(|word| word.len() == dim + 1)
    }

    /// n_p for every p.
    #[must_use]
    pub fn f_vector(&self) -> Vec<usize> {
        (0..self.dims()).map(|dim| self.of_dim(dim).len()).collect()
    }

    /// The simplex with exactly these vertices.
    #[must_use]
    pub fn find(&self, word: &[usize]) -> Option<usize> {
        self.words.iter().position(|other| other == word)
    }

    /// The simplices whose words start with these vertices.
    #[must_use]
    pub fn with_prefix(&self, prefix: &[usize]) -> Vec<usize> {
        self.which(|word| word.starts_with(prefix))
    }

    /// The face without the last vertex.
    #[must_use]
    pub fn parent(&self, simplex: usize) -> Option<usize> {
        let (_, parent) = self.words[simplex].split_last()?;
        self.find(parent)
    }

    /// The simplices of which this one is the parent.
    #[must_use]
    pub fn children(&self, simplex: usize) -> Vec<usize> {
        let parent = self.word(simplex);
        self.which(|word| word.len() == parent.len() + 1 && word.starts_with(parent))
    }

    /// B_{p,q}: the q-faces, q < p.
    #[must_use]
    pub fn boundary(&self, simplex: usize, dim: usize) -> Vec<usize> {
        let own = self.word(simplex);
        if dim + 1 >= own.len() {
            return Vec::new();
        }
        self.which(|word| word.len() == dim + 1 && is_subset(word, own))
    }

    /// F\[σ\]\[i\]: the facet that omits the i-th vertex of a simplex that is not a vertex.
    ///
    /// # Panics
    /// If there is no such vertex, or no other.
    #[must_use]
    pub fn facet(&self, simplex: usize, position: usize) -> usize {
        let mut word = self.word(simplex).to_vec();
        word.remove(position);
        self.find(&word).expect("a complex holds the faces of its simplices")
    }

    /// All faces, and the simplex itself.
    #[must_use]
    pub fn closure(&self, simplex: usize) -> Vec<usize> {
        self.which(|word| is_subset(word, self.word(simplex)))
    }

    /// The simplex and all that contain it.
    #[must_use]
    pub fn star(&self, simplex: usize) -> Vec<usize> {
        self.which(|word| is_subset(self.word(simplex), word))
    }

    /// All simplices that contain the simplex properly.
    #[must_use]
    pub fn restricted_star(&self, simplex: usize) -> Vec<usize> {
        self.which(|word| word != self.word(simplex) && is_subset(self.word(simplex), word))
    }

    /// C_{p,g}: the g-simplices in the restricted star.
    #[must_use]
    pub fn coboundary(&self, simplex: usize, dim: usize) -> Vec<usize> {
        self.restricted_star(simplex).into_iter().filter(|&coface| self.dim(coface) == dim).collect()
    }

    /// The simplices that do not meet the simplex but are, together with it, the vertices of one.
    #[must_use]
    pub fn link(&self, simplex: usize) -> Vec<usize> {
        let own = self.word(simplex);
        self.which(|word| {
            let mut joined: Vec<usize> = [own, word].concat();
            joined.sort_unstable();
            word.iter().all(|vertex| !own.contains(vertex)) && self.words.contains(&joined)
        })
    }

    /// The other p-simplices that have a k-face in common with a p-simplex.
    #[must_use]
    pub fn k_adjacency(&self, simplex: usize, k: usize) -> Vec<usize> {
        let own = self.word(simplex);
        if k + 1 >= own.len() {
            return Vec::new();
        }
        self.which(|word| word.len() == own.len() && word != own && common(word, own).len() > k)
    }

    /// A_p: the other p-simplices that share a (p−1)-face; for a vertex the other ends of its edges.
    #[must_use]
    pub fn adjacency(&self, simplex: usize) -> Vec<usize> {
        match (self.dim(simplex), self.word(simplex)) {
            (0, &[vertex]) => self.which(|word| {
                let edge = vec![word[0].min(vertex), word[0].max(vertex)];
                word.len() == 1 && word[0] != vertex && self.words.contains(&edge)
            }),
            (dim, _) => self.k_adjacency(simplex, dim - 1),
        }
    }

    /// Whether the simplex is a face of no other.
    #[must_use]
    pub fn is_top(&self, simplex: usize) -> bool {
        self.restricted_star(simplex).is_empty()
    }

    /// Whether no simplex one dimension below the largest has more than two cofaces of that: the pairs of 7.4 hold them.
    #[must_use]
    pub fn is_thin(&self) -> bool {
        let Some(below) = self.dims().checked_sub(2) else { return true };
        self.of_dim(below).into_iter().all(|facet| self.coboundary(facet, below + 1).len() <= 2)
    }

    /// The top simplices, by id.
    #[must_use]
    pub fn tops(&self) -> Vec<usize> {
        (0..self.len()).filter(|&simplex| self.is_top(simplex)).collect()
    }

    /// The clusters in the restricted star of a simplex, by decreasing dimension, then increasing representative.
    ///
    /// Two top g-simplices there are joined when they share a (g−1)-simplex that is in the restricted star too; a
    /// cluster is a class of the transitive closure of that. For g = p + 1 no two are joined: what they share is the
    /// simplex itself, which is not in its restricted star.
    #[must_use]
    pub fn clusters(&self, simplex: usize) -> Vec<Cluster> {
        let own = self.word(simplex);
        let mut tops: Vec<usize> = self.restricted_star(simplex);
        tops.retain(|&coface| self.is_top(coface));
        let joined = |left: usize, right: usize| {
            let shared = common(self.word(left), self.word(right));
            self.dim(left) == self.dim(right)
                && shared.len() == self.dim(left)
                && shared != own
                && is_subset(own, &shared)
        };
        let mut clusters = Vec::new();
        while !tops.is_empty() {
            let mut members = vec![tops.remove(0)];
            let mut next = 0;
            while next < members.len() {
                let (near, far): (Vec<usize>, Vec<usize>) = tops.iter().partition(|&&top| joined(members[next], top));
                members.extend(near);
                tops = far;
                next += 1;
            }
            members.sort_unstable();
            clusters.push(Cluster { dim: self.dim(members[0]), members });
        }
        clusters.sort_by_key(|cluster| (usize::MAX - cluster.dim, cluster.members[0]));
        clusters
    }

    /// C*: the least simplex of each cluster, by decreasing dimension, then increasing id.
    #[must_use]
    pub fn partial_coboundary(&self, simplex: usize) -> Vec<usize> {
        self.clusters(simplex).iter().map(|cluster| cluster.members[0]).collect()
    }

    /// The paper's manifold flag: C* is one simplex of the dimension d of the complex, and p < d − 1.
    #[must_use]
    pub fn is_single_cluster(&self, simplex: usize) -> bool {
        let top_dim = self.dims() - 1;
        match self.partial_coboundary(simplex)[..] {
            [only] => self.dim(only) == top_dim && self.dim(simplex) + 1 < top_dim,
            _ => false,
        }
    }

    /// χ = Σ (−1)^p n_p.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        self.words.iter().map(|word| if word.len() % 2 == 1 { 1 } else { -1 }).sum()
    }
}

fn is_subset(part: &[usize], whole: &[usize]) -> bool {
    part.iter().all(|vertex| whole.contains(vertex))
}

fn common(left: &[usize], right: &[usize]) -> Word {
    left.iter().copied().filter(|vertex| right.contains(vertex)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The oracle itself against sets written down by hand: two triangles at an edge, one edge, one vertex.
    #[test]
    fn a_complex_by_hand() {
        let oracle = Oracle::new(&[vec![3, 1, 2], vec![2, 3, 4], vec![4, 5], vec![9]]);
        assert_eq!(oracle.labels(), [1, 2, 3, 4, 5, 9]);
        assert_eq!(oracle.f_vector(), [6, 6, 2]);
        assert_eq!(oracle.word(6), [0, 1]);
        assert_eq!(oracle.tops(), [5, 11, 12, 13]);
        assert_eq!(oracle.euler_characteristic(), 2);
        let vertex = oracle.find(&[3]).unwrap();
        let clusters = oracle.clusters(vertex);
        assert_eq!(clusters.iter().map(|cluster| cluster.dim).collect::<Vec<_>>(), [2, 1]);
        let edge = oracle.find(&[1, 2]).unwrap();
        assert_eq!(oracle.clusters(edge).len(), 2, "two dangling triangles at an edge are two clusters");
        assert_eq!(oracle.clusters(1).len(), 1, "and one at a vertex of it");
    }
}
