//! The map of a simplicial complex, if it is a closed orientable quasi-manifold.

use sig_core::{Complex, Dim, Index, SimplexId};

use super::words::Words;
use super::{CombinatorialMap, NONE, darts_of_simplex, map_integers};
use crate::build::{available_memory, narrow};
use crate::names::simplex_name;

/// Why a complex has no combinatorial map. Simplices are named by the labels of their vertices.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The complex has dimension 1 or less. One dart of two flags does not tell the two edges at a vertex of a circle.
    #[error("the cells of a combinatorial map are its orbits for dimension 2 and more, and the complex has less")]
    Dimension,
    /// A simplex of lower dimension is a face of no other.
    #[error("not a quasi-manifold: the simplex {simplex} of dimension {dim} is a face of no {of_dim}-simplex")]
    Dangling {
        /// Its labels.
        simplex: String,
        /// Its dimension.
        dim: Dim,
        /// The dimension of the complex.
        of_dim: Dim,
    },
    /// The simplices around a simplex are not joined through facets that contain it: several fans at a vertex of a surface.
    #[error("not a quasi-manifold: around the simplex {simplex} of dimension {dim} there are {clusters} clusters")]
    Pinched {
        /// Its labels.
        simplex: String,
        /// Its dimension.
        dim: Dim,
        /// The clusters of top simplices around it.
        clusters: usize,
    },
    /// Three or more n-simplices share a facet.
    #[error("not a quasi-manifold: {cofaces} simplices of dimension {of_dim} share {simplex}")]
    Branching {
        /// The labels of the facet.
        simplex: String,
        /// The n-simplices that share it.
        cofaces: usize,
        /// The dimension n of the complex.
        of_dim: Dim,
    },
    /// A facet belongs to one n-simplex only.
    #[error("not closed: {simplex} is a face of one simplex of dimension {of_dim} only")]
    Boundary {
        /// The labels of the facet.
        simplex: String,
        /// The dimension n of the complex.
        of_dim: Dim,
    },
    /// The n-simplices have no orientations that agree.
    #[error(
        "not orientable: no orientations of the simplices of dimension {of_dim} agree across {simplex} and elsewhere"
    )]
    NotOrientable {
        /// The labels of the first facet across which orientations disagree that agree on a tree of facets.
        simplex: String,
        /// The dimension n of the complex.
        of_dim: Dim,
    },
    /// The map needs more darts than 32 bits number, or more than memory holds.
    #[error("the map would have {darts} darts, and there is room for {limit}")]
    TooLarge {
        /// Its darts; `usize::MAX` if that is more than a `usize` holds.
        darts: usize,
        /// The most that are possible.
        limit: usize,
    },
    /// A facet of a simplex is not one: the buffer holds no complex.
    #[error("the facets of simplex {0} are out of range: the buffer is not a complex")]
    NotAComplex(SimplexId),
}

impl CombinatorialMap {
    /// The map of a complex that is a closed orientable quasi-manifold of dimension n ≥ 2, connected or not: every simplex is
    /// a face of an n-simplex; around a simplex of dimension n − 2 or less the n-simplices are one cluster, which the flags of
    /// a SIG say; each (n−1)-simplex is a face of exactly two n-simplices; and these can be oriented.
    ///
    /// The orientation of each component is that which the complex stores for its least n-simplex, where it stores any.
    ///
    /// Cost: O(n) for each of the n_n (n + 1)!/2 darts, and a look at every pointer. Memory: the map, and four integers for
    /// each n-simplex and each (n−1)-simplex.
    ///
    /// # Errors
    /// [`MapError`], naming the first simplex in the order of the ids that is no part of a closed quasi-manifold; else the
    /// first facet across which orientations disagree.
    pub fn new<I: Index>(complex: &Complex<'_, I>) -> Result<Self, MapError> {
        let dim = complex.dim().filter(|&dim| dim > 1).ok_or(MapError::Dimension)?;
        let num_top = complex.num_simplices_of_dim(dim);
        let each = darts_of_simplex(dim).filter(|each| each.checked_mul(num_top).is_some());
        let num_darts = each.map_or(usize::MAX, |each| each * num_top);
        let bytes = |darts: usize| map_integers(dim, darts).checked_mul(size_of::<u32>());
        let in_memory = available_memory().and_then(|bytes| usize::try_from(bytes).ok()).unwrap_or(usize::MAX);
        let limit = (in_memory / (bytes(1).unwrap_or(1))).min(NONE as usize - 1);
        let each = each.filter(|_| num_darts <= limit).ok_or(MapError::TooLarge { darts: num_darts, limit })?;
        let facets = Facets::new(complex, dim)?;
        facets.check(complex)?;
        let is_negative = facets.orient(complex)?;
        Ok(facets.map(complex, &is_negative, &Words::new(dim, each)))
    }
}

/// The n-simplices on both sides of each (n−1)-simplex.
struct Facets {
    dim: Dim,
    /// The first (n−1)-simplex, and the first n-simplex.
    starts: [usize; 2],
    /// For each (n−1)-simplex, twice the number of an n-simplex, from 0, and the position of the vertex that is left out;
    /// [`NONE`] where there is none.
    sides: Vec<[(u32, u8); 2]>,
    /// The n-simplices at each (n−1)-simplex.
    counts: Vec<u32>,
}

impl Facets {
    fn new<I: Index>(complex: &Complex<'_, I>, dim: Dim) -> Result<Self, MapError> {
        let starts = [dim - 1, dim].map(|dim| complex.simplices_of_dim(dim).bounds().0.index());
        let count = complex.num_simplices_of_dim(dim - 1);
        let mut found = Self { dim, starts, sides: vec![[(NONE, 0); 2]; count], counts: vec![0; count] };
        for (number, top) in (0..).zip(complex.simplices_of_dim(dim)) {
            let bad = || MapError::NotAComplex(top);
            if complex.facets(top).len() != dim + 1 {
                return Err(bad());
            }
            for (position, facet) in (0..).zip(complex.facets(top)) {
                let at = facet.index().checked_sub(starts[0]).filter(|&at| at < count).ok_or_else(bad)?;
                if let Some(side) = found.sides[at].get_mut(found.counts[at] as usize) {
                    *side = (number, position);
                }
                found.counts[at] += 1;
            }
        }
        Ok(found)
    }

    /// Whether the complex is a closed quasi-manifold.
    fn check<I: Index>(&self, complex: &Complex<'_, I>) -> Result<(), MapError> {
        let of_dim = self.dim;
        let is_bad = |&simplex: &SimplexId| !complex.is_single_cluster(simplex);
        if let Some(simplex) = (0..self.starts[0]).map(SimplexId::new).find(is_bad) {
            let name = simplex_name(complex, simplex);
            let dim = complex.dim_of(simplex).unwrap_or(0);
            let clusters = complex.partial_coboundary(simplex).count();
            return Err(match clusters {
                0 => MapError::Dangling { simplex: name, dim, of_dim },
                // One simplex, but of lower dimension: the first of its faces that is met.
                1 => self.dangling(complex, simplex),
                _ => MapError::Pinched { simplex: name, dim, clusters },
            });
        }
        let Some(at) = self.counts.iter().position(|&count| count != 2) else { return Ok(()) };
        let simplex = simplex_name(complex, SimplexId::new(self.starts[0] + at));
        Err(match self.counts[at] as usize {
            0 => MapError::Dangling { simplex, dim: of_dim - 1, of_dim },
            1 => MapError::Boundary { simplex, of_dim },
            cofaces => MapError::Branching { simplex, cofaces, of_dim },
        })
    }

    /// The error of a simplex whose only cluster is one of lower dimension.
    fn dangling<I: Index>(&self, complex: &Complex<'_, I>, simplex: SimplexId) -> MapError {
        let top = complex.partial_coboundary(simplex).next().unwrap_or(simplex);
        let dim = complex.dim_of(top).unwrap_or(0);
        MapError::Dangling { simplex: simplex_name(complex, top), dim, of_dim: self.dim }
    }

    /// The n-simplex on the other side of a facet, and the position of the vertex that it leaves out. Of two sides.
    fn across(&self, facet: usize, number: u32, position: u8) -> (u32, u8) {
        let [one, other] = self.sides[facet];
        if one == (number, position) { other } else { one }
    }

    /// Whether the orientation of each n-simplex is the opposite of that of increasing vertices, so that all agree.
    fn orient<I: Index>(&self, complex: &Complex<'_, I>) -> Result<Vec<bool>, MapError> {
        let count = complex.num_simplices_of_dim(self.dim);
        let parity = complex.parity();
        let mut is_negative: Vec<Option<bool>> = vec![None; count];
        let mut queue = Vec::with_capacity(count);
        for (number, least) in (0..count).zip(0..) {
            if is_negative[number].is_some() {
                continue;
            }
            // Of a regular complex the top simplices are the n-simplices.
            is_negative[number] = Some(parity.and_then(|parity| parity.bit_at(number)).unwrap_or(false));
            queue.push(least);
            let mut next = queue.len() - 1;
            while let Some(&simplex) = queue.get(next) {
                next += 1;
                for (position, facet) in (0..).zip(self.facets(complex, simplex)) {
                    let (other, other_position) = self.across(facet, simplex, position);
                    let sign = is_negative[simplex as usize].unwrap_or_default();
                    let needed = across_sign(sign, position, other_position);
                    is_negative[other as usize].get_or_insert_with(|| {
                        queue.push(other);
                        needed
                    });
                }
            }
        }
        let is_negative: Vec<bool> = is_negative.into_iter().map(Option::unwrap_or_default).collect();
        let disagree = |&[(one, at), (other, other_at)]: &[(u32, u8); 2]| {
            across_sign(is_negative[one as usize], at, other_at) != is_negative[other as usize]
        };
        match self.sides.iter().position(disagree) {
            None => Ok(is_negative),
            Some(at) => Err(MapError::NotOrientable {
                simplex: simplex_name(complex, SimplexId::new(self.starts[0] + at)),
                of_dim: self.dim,
            }),
        }
    }

    /// The facets of an n-simplex, numbered from 0.
    fn facets<I: Index>(&self, complex: &Complex<'_, I>, number: u32) -> impl Iterator<Item = usize> {
        let start = self.starts[0];
        complex.facets(SimplexId::new(self.starts[1] + number as usize)).map(move |facet| facet.index() - start)
    }

    fn map<I: Index>(&self, complex: &Complex<'_, I>, is_negative: &[bool], words: &Words) -> CombinatorialMap {
        let dim = self.dim;
        let first: Vec<usize> = (0..=dim + 1).map(|dim| complex.simplices_of_dim(dim).bounds().0.index()).collect();
        let num_darts = is_negative.len() * words.count;
        let mut darts = Vec::with_capacity(map_integers(dim, num_darts));
        let mut dart_of = vec![NONE; complex.num_simplices()];
        let mut faces = Faces::new(dim);
        for (number, &sign) in (0..).zip(is_negative) {
            faces.find(complex, SimplexId::new(self.starts[1] + number as usize));
            let base = narrow(number as usize * words.count);
            for dart in 0..words.count {
                darts.extend(words.within(sign, dart).iter().map(|&image| base + image));
                let (position, flag) = words.leaving(sign, dart);
                let facet = faces.without(position) - self.starts[0];
                // A position is below n + 1, which is 32 at most.
                let (other, arrival) = self.across(facet, number, position.try_into().unwrap_or(u8::MAX));
                darts.push(narrow(other as usize * words.count) + words.arriving(usize::from(arrival), flag));
                let mut mask = 0;
                for &position in words.order(sign, dart) {
                    mask |= 1 << position;
                    let face = faces.ids[mask];
                    darts.push(narrow(face));
                    if dart_of[face] == NONE {
                        dart_of[face] = base + narrow(dart);
                    }
                }
            }
        }
        let num_cells = (0..=dim).map(|dim| complex.num_simplices_of_dim(dim)).collect();
        CombinatorialMap { dim, first, darts, dart_of, num_darts, num_cells }
    }
}

/// The sign that agrees with another across a facet, by the positions that the two simplices leave out: the facet has
/// opposite orientations as a part of the two boundaries.
fn across_sign(is_negative: bool, position: u8, other_position: u8) -> bool {
    !(is_negative ^ ((position ^ other_position) & 1 == 1))
}

/// The faces of one n-simplex by the positions of their vertices.
struct Faces {
    dim: Dim,
    /// By the mask of positions.
    ids: Vec<usize>,
}

impl Faces {
    fn new(dim: Dim) -> Self {
        Self { dim, ids: vec![0; 1 << (dim + 1)] }
    }

    /// Finds the faces of a simplex. A face without its i-th vertex is the i-th facet.
    fn find<I: Index>(&mut self, complex: &Complex<'_, I>, simplex: SimplexId) {
        let whole = self.ids.len() - 1;
        self.ids[whole] = simplex.index();
        // From a mask to those with one bit less; each is reached from the one that adds the highest bit it lacks.
        for mask in (1..=whole).rev() {
            let highest_missing = (whole ^ mask).checked_ilog2();
            let lowest = highest_missing.map_or(0, |bit| bit as usize + 1);
            let before = (mask & ((1 << lowest) - 1)).count_ones() as usize;
            let facets = complex.facets(SimplexId::new(self.ids[mask])).skip(before);
            for (position, facet) in (lowest..=self.dim).zip(facets) {
                self.ids[mask ^ 1 << position] = facet.index();
            }
        }
    }

    /// The facet without the vertex at a position.
    fn without(&self, position: usize) -> usize {
        self.ids[(self.ids.len() - 1) ^ 1 << position]
    }
}
