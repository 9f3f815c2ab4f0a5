//! Simplices as faces of top simplices, and every relation by way of the top simplices around one: what the structures
//! that do not number all simplices have in common.

use sig_core::storage::Storage;
use sig_core::{Dim, MAX_DIM, VertexId};

use super::{Structure, tops};

/// A simplex, named by a top simplex that has it as a face and the positions of its vertices there.
///
/// A simplex has one name for each of its top simplices.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Face {
    /// The number of the top simplex in its structure.
    pub(super) top: u32,
    /// The positions of the vertices, a bit each.
    pub(super) mask: u32,
}

impl Face {
    fn dim(self) -> Dim {
        (self.mask.count_ones() as usize).saturating_sub(1)
    }
}

/// A structure that stores top simplices, and finds those around a simplex.
pub trait TopSimplices {
    /// The dimension of the complex; `None` for the empty complex.
    fn dim(&self) -> Option<Dim>;

    /// The integers and bits that are stored.
    fn storage(&self) -> Storage;

    /// Bytes of the arrays.
    fn bytes(&self) -> usize;

    /// How many marks a query needs: the bits that the paper lists for entities.
    fn num_marks(&self) -> usize;

    /// The number of vertices of a top simplex.
    fn len(&self, top: u32) -> usize;

    /// The vertex at a position of a top simplex.
    fn vertex(&self, top: u32, position: usize) -> u32;

    /// A vertex as a face; `None` if there is no such vertex.
    fn vertex_face(&self, vertex: u32) -> Option<Face>;

    /// Adds the top simplices that contain a simplex, each with the positions of its vertices there. All marks are clear,
    /// before and after.
    fn incident(&self, face: Face, marks: &mut Marks, found: &mut Vec<Face>);
}

/// A bit for each of some numbers.
#[derive(Clone, Debug)]
pub struct Marks {
    words: Vec<u64>,
}

impl Marks {
    pub(crate) fn new(count: usize) -> Self {
        Self { words: vec![0; count.div_ceil(64)] }
    }

    /// Sets a mark; whether it was clear.
    pub(crate) fn set(&mut self, number: usize) -> bool {
        let (word, bit) = (&mut self.words[number / 64], 1 << (number % 64));
        let was_clear = *word & bit == 0;
        *word |= bit;
        was_clear
    }

    pub(crate) fn clear(&mut self, number: usize) {
        self.words[number / 64] &= !(1 << (number % 64));
    }
}

/// A coface of the simplex that is asked for.
#[derive(Clone, Copy, Debug)]
struct Coface {
    /// Its first four vertices beside those of the simplex, increasing, each plus one: most often they are all.
    key: u128,
    face: Face,
    /// The positions of the simplex.
    own: u32,
}

/// A structure of top simplices with the memory to ask it.
///
/// Cost of a relation: that of finding the top simplices around the simplex (around its facets, for A_p), which the
/// structure says, and a sort of the cofaces that these have in common.
#[derive(Clone, Debug)]
pub struct Session<'a, S> {
    structure: &'a S,
    marks: Marks,
    tops: Vec<Face>,
    cofaces: Vec<Coface>,
}

impl<'a, S: TopSimplices> Session<'a, S> {
    /// Memory to ask `structure`: its marks.
    #[must_use]
    pub fn new(structure: &'a S) -> Self {
        let marks = Marks::new(structure.num_marks());
        Self { structure, marks, tops: Vec::new(), cofaces: Vec::new() }
    }

    fn vertices_at(&self, top: u32, mask: u32) -> impl Iterator<Item = u32> + use<'_, 'a, S> {
        positions(mask).map(move |position| self.structure.vertex(top, position))
    }

    /// Finds the cofaces of a simplex that have from `least` to `most` vertices more than it.
    fn gather(&mut self, face: Face, least: usize, most: usize) {
        self.tops.clear();
        self.cofaces.clear();
        self.structure.incident(face, &mut self.marks, &mut self.tops);
        // Top simplices come once each: the others are sorted behind them.
        for &Face { top, mask: own } in &self.tops {
            let face = Face { top, mask: all(self.structure.len(top)) };
            if (least..=most).contains(&(face.mask ^ own).count_ones().try_into().unwrap_or(0)) {
                self.cofaces.push(Coface { key: 0, face, own });
            }
        }
        let others = self.cofaces.len();
        for number in 0..self.tops.len() {
            let Face { top, mask: own } = self.tops[number];
            let free = all(self.structure.len(top)) & !own;
            for more in least..=most.min((free.count_ones() as usize).saturating_sub(1)) {
                for added in subsets(free, more) {
                    let coface = Coface { key: self.key(top, added), face: Face { top, mask: own | added }, own };
                    self.cofaces.push(coface);
                }
            }
        }
        let Self { structure, cofaces, .. } = self;
        let order = |left: &Coface, right: &Coface| {
            let rest = |coface: &Coface| rest(*structure, coface.face.top, coface.face.mask & !coface.own);
            // Equal keys are equal words, but for those of more than four vertices.
            left.key.cmp(&right.key).then_with(|| rest(left).cmp(&rest(right)))
        };
        cofaces[others..].sort_unstable_by(order);
        let mut kept = others;
        for number in others..cofaces.len() {
            if number == others || order(&cofaces[kept - 1], &cofaces[number]).is_ne() {
                cofaces[kept] = cofaces[number];
                kept += 1;
            }
        }
        cofaces.truncate(kept);
    }

    /// The first four of some vertices, increasing, as one number.
    fn key(&self, top: u32, mask: u32) -> u128 {
        let (mut key, mut before) = ([0_u32; 4], 0);
        if mask.count_ones() > 4 {
            let (_, word) = sorted_word(self.structure, top, mask);
            key.copy_from_slice(&word[..4]);
        } else {
            // A handful, by insertion; empty places stay last as they are shifted out.
            for vertex in self.vertices_at(top, mask) {
                let at = key[..before].iter().position(|&other| other > vertex + 1).unwrap_or(before);
                key.copy_within(at..before, at + 1);
                key[at] = vertex + 1;
                before += 1;
            }
        }
        key.iter().fold(0, |packed, &vertex| packed << 32 | u128::from(vertex))
    }
}

/// Some vertices of a top simplex plus one, increasing, and how many they are.
fn sorted_word(structure: &impl TopSimplices, top: u32, mask: u32) -> (usize, [u32; MAX_DIM + 1]) {
    let mut word = [0; MAX_DIM + 1];
    let mut len = 0;
    for position in positions(mask) {
        word[len] = structure.vertex(top, position) + 1;
        len += 1;
    }
    word[..len].sort_unstable();
    (len, word)
}

/// The vertices behind the first four, for cofaces with more.
fn rest(structure: &impl TopSimplices, top: u32, mask: u32) -> Option<(usize, [u32; MAX_DIM + 1])> {
    (mask.count_ones() > 4).then(|| sorted_word(structure, top, mask))
}

impl<S: TopSimplices> Structure for Session<'_, S> {
    type Simplex = Face;

    fn dim(&self) -> Option<Dim> {
        self.structure.dim()
    }

    fn storage(&self) -> Storage {
        self.structure.storage()
    }

    fn bytes(&self) -> usize {
        self.structure.bytes()
    }

    fn find(&mut self, vertices: &[VertexId]) -> Option<Face> {
        let (first, others) = vertices.split_first()?;
        let first = self.structure.vertex_face(u32::try_from(first.index()).ok()?)?;
        if others.is_empty() {
            return Some(first);
        }
        self.tops.clear();
        self.structure.incident(first, &mut self.marks, &mut self.tops);
        self.tops.iter().find_map(|&Face { top, mask }| {
            let place = |vertex: &VertexId| {
                let is_it = |&position: &usize| self.structure.vertex(top, position) as usize == vertex.index();
                (0..self.structure.len(top)).find(is_it).map(|position| 1 << position)
            };
            let mask = others.iter().try_fold(mask, |mask, vertex| Some(mask | place(vertex)?))?;
            (mask.count_ones() as usize == vertices.len()).then_some(Face { top, mask })
        })
    }

    fn vertices(&self, simplex: Face, vertices: &mut Vec<VertexId>) {
        tops::sorted(self.vertices_at(simplex.top, simplex.mask), vertices);
    }

    fn boundary(&mut self, simplex: Face, dim: Dim, found: &mut Vec<Face>) {
        found.clear();
        if dim < simplex.dim() {
            found.extend(subsets(simplex.mask, dim + 1).map(|mask| Face { top: simplex.top, mask }));
        }
    }

    fn coboundary(&mut self, simplex: Face, dim: Dim, found: &mut Vec<Face>) {
        found.clear();
        let Some(more) = dim.checked_sub(simplex.dim()).filter(|&more| more > 0) else { return };
        self.gather(simplex, more, more);
        found.extend(self.cofaces.iter().map(|coface| coface.face));
    }

    fn star(&mut self, simplex: Face, found: &mut Vec<Face>) {
        found.clear();
        self.gather(simplex, 1, MAX_DIM);
        found.push(simplex);
        found.extend(self.cofaces.iter().map(|coface| coface.face));
    }

    fn link(&mut self, simplex: Face, found: &mut Vec<Face>) {
        found.clear();
        self.gather(simplex, 1, MAX_DIM);
        // What a coface has beside the simplex is a simplex of the link, another one for each.
        let opposite = |&Coface { face: Face { top, mask }, own, .. }: &Coface| Face { top, mask: mask & !own };
        found.extend(self.cofaces.iter().map(opposite));
    }

    fn adjacency(&mut self, simplex: Face, found: &mut Vec<Face>) {
        found.clear();
        if simplex.dim() == 0 {
            self.gather(simplex, 1, 1);
            found
                .extend(self.cofaces.iter().map(|coface| Face { mask: coface.face.mask & !coface.own, ..coface.face }));
            return;
        }
        // Two simplices of one dimension share one facet at most: only the simplex itself is found again.
        for position in positions(simplex.mask) {
            let facet = Face { mask: simplex.mask & !(1 << position), ..simplex };
            let opposite = self.structure.vertex(simplex.top, position);
            self.gather(facet, 1, 1);
            let other = |coface: &&Coface| {
                let Coface { face: Face { top, mask }, own, .. } = **coface;
                positions(mask & !own).any(|position| self.structure.vertex(top, position) != opposite)
            };
            found.extend(self.cofaces.iter().filter(other).map(|coface| coface.face));
        }
    }
}

/// The mask of the first `len` positions.
pub(super) fn all(len: usize) -> u32 {
    u32::MAX >> (u32::BITS as usize - len.clamp(1, 32))
}

/// The bits that are set in a mask.
pub(super) fn positions(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let position = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            position
        })
    })
}

/// The masks of `count` of the bits of `mask`, for `count` > 0.
fn subsets(mask: u32, count: usize) -> impl Iterator<Item = u32> {
    let free = u64::from(mask.count_ones());
    let mut chosen: u64 = if count as u64 <= free { (1 << count) - 1 } else { 1 << free };
    std::iter::from_fn(move || {
        (chosen < 1 << free).then(|| {
            let mut spread = 0;
            let (mut rest, mut left) = (mask, chosen);
            while left != 0 {
                spread |= (rest & rest.wrapping_neg()) * u32::from(left & 1 == 1);
                rest &= rest.wrapping_sub(1);
                left >>= 1;
            }
            // The next number with as many bits (Gosper).
            let low = chosen & chosen.wrapping_neg();
            let next = chosen + low;
            chosen = ((chosen ^ next) >> 2) / low | next;
            spread
        })
    })
}

#[cfg(test)]
mod tests {
    use super::subsets;

    #[test]
    fn subsets_are_those_with_so_many_bits() {
        for mask in [0b1_u32, 0b1011, 0b110_1001_0010, u32::MAX >> 20, 0x8000_0001] {
            for count in 1..=mask.count_ones() as usize + 1 {
                let of_count = |part: &u32| part & !mask == 0 && part.count_ones() as usize == count;
                let mut expected = Vec::new();
                let mut part = mask;
                while part != 0 {
                    expected.extend(Some(part).filter(of_count));
                    part = (part - 1) & mask;
                }
                let mut found: Vec<u32> = subsets(mask, count).collect();
                found.sort_unstable_by(|left, right| right.cmp(left));
                assert_eq!(found, expected);
            }
        }
    }
}
