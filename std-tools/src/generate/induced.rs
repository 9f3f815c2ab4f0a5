//! The part of Freudenthal's triangulation of a grid that some of its vertices span: all simplices between them.
//!
//! A simplex is its least vertex and a chain of sets of sides ∅ ⊂ S1 ⊂ … ⊂ Sp: vertex i is one step along each side in Si
//! from the least. So the corners of the unit cubes above and below a vertex, a bit each, tell which of its simplices
//! are there, and which of them are faces of larger ones: a chain grows by a set between two of its own, above its
//! last, or, below the least vertex, by steps back along sides that are not in its last.

use super::triangulation::MOST_SIDES;

/// Some of the vertices of a grid.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Vertices {
    /// A bit for each, least significant first.
    words: Vec<u64>,
    len: usize,
}

impl FromIterator<bool> for Vertices {
    /// For each vertex in the order of their numbers, whether it is one of them.
    fn from_iter<T: IntoIterator<Item = bool>>(kept: T) -> Self {
        let mut vertices = Self::default();
        for (number, kept) in kept.into_iter().enumerate() {
            if number % 64 == 0 {
                vertices.words.push(0);
            }
            vertices.words[number / 64] |= u64::from(kept) << (number % 64);
            vertices.len += usize::from(kept);
        }
        vertices
    }
}

impl Vertices {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Whether a vertex is one of them.
    #[must_use]
    pub fn contains(&self, vertex: u32) -> bool {
        self.words.get(vertex as usize / 64).is_some_and(|word| word >> (vertex % 64) & 1 == 1)
    }

    /// They, in increasing order.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        self.words.iter().zip((0_u32..).step_by(64)).flat_map(|(&word, first)| {
            let rest = |&word: &u64| Some(word & (word - 1)).filter(|&rest| rest != 0);
            std::iter::successors(Some(word).filter(|&word| word != 0), rest)
                .map(move |word| first + word.trailing_zeros())
        })
    }

    /// For each word, how many vertices come before it.
    pub(super) fn ranks(&self) -> Ranks<'_> {
        let mut before = 0;
        let starts = self.words.iter().map(|word| {
            let start = before;
            before += word.count_ones();
            start
        });
        Ranks { words: &self.words, starts: starts.collect() }
    }
}

/// The places of vertices among those that are kept.
pub(super) struct Ranks<'a> {
    words: &'a [u64],
    starts: Vec<u32>,
}

impl Ranks<'_> {
    /// How many of them come before this one of them.
    pub(super) fn of(&self, vertex: u32) -> u32 {
        let word = vertex as usize / 64;
        self.starts[word] + (self.words[word] & ((1 << (vertex % 64)) - 1)).count_ones()
    }
}

/// The chains of sets of sides, sets being bits; of the corners above and below, those that matter.
struct Chain {
    /// S1, …, Sp.
    sets: Vec<usize>,
    /// The corners above that are its vertices, a bit for each set.
    members: u64,
    /// The corners above that it grows by, and those below.
    above: u64,
    below: u64,
    /// Whether its last two vertices change places, so that simplices of the greatest dimension are oriented alike.
    is_odd: bool,
}

impl Chain {
    fn new(sets: &[usize], num_sides: usize) -> Self {
        let whole = (1_usize << num_sides) - 1;
        let last = sets.last().copied().unwrap_or(0);
        let holds = |set: usize, other: usize| other & !set == 0;
        let grows = |set: usize| sets.iter().all(|&other| set != other && (holds(set, other) || holds(other, set)));
        let bits = |of: &dyn Fn(usize) -> bool| (1..=whole).filter(|&set| of(set)).fold(0, |bits, set| bits | 1 << set);
        let order: Vec<_> = std::iter::once(&0).chain(sets).zip(sets).map(|(lower, upper)| lower ^ upper).collect();
        let inversions = (0..order.len()).flat_map(|k| (0..k).map(move |i| (i, k)));
        Self {
            sets: sets.to_vec(),
            members: bits(&|set| sets.contains(&set)),
            above: bits(&grows),
            below: bits(&|set| set & last == 0),
            is_odd: sets.len() == num_sides && inversions.filter(|&(i, k)| order[i] > order[k]).count() % 2 == 1,
        }
    }

    /// All chains, the empty one first.
    fn all(num_sides: usize) -> Vec<Self> {
        let mut sets: Vec<Vec<usize>> = vec![Vec::new()];
        let mut done = 0;
        while let Some(chain) = sets.get(done).cloned() {
            let last = chain.last().copied().unwrap_or(0);
            let larger = (last + 1..1 << num_sides).filter(|set| last & !set == 0);
            sets.extend(larger.map(|set| chain.iter().copied().chain([set]).collect()));
            done += 1;
        }
        sets.iter().map(|sets| Self::new(sets, num_sides)).collect()
    }
}

/// Calls `visit` with each kept vertex, and which of the corners of the cubes above and below it are kept, a bit for each
/// set of sides.
fn visit_corners<E>(
    sides: &[u32],
    kept: &Vertices,
    mut visit: impl FnMut(u32, u64, u64) -> Result<(), E>,
) -> Result<(), E> {
    debug_assert!(sides.len() <= MOST_SIDES);
    let steps = steps(sides);
    // For each set of sides, along which there is no step, the sets of sides along which there are steps.
    let free: Vec<u64> = (0..steps.len())
        .map(|ends| (0..steps.len()).filter(|set| set & ends == 0).fold(0, |bits, set| bits | 1 << set))
        .collect();
    for vertex in kept.iter() {
        let (mut first, mut last, mut rest) = (0, 0, vertex);
        for (number, side) in sides.iter().enumerate() {
            let place = rest % side;
            rest /= side;
            first |= usize::from(place == 0) << number;
            last |= usize::from(place + 1 == *side) << number;
        }
        let corners = |mut sets: u64, corner: &dyn Fn(u32) -> u32| {
            let mut found = 0;
            while sets != 0 {
                let set = sets.trailing_zeros();
                found |= u64::from(kept.contains(corner(steps[set as usize]))) << set;
                sets &= sets - 1;
            }
            found
        };
        visit(vertex, corners(free[last], &|step| vertex + step), corners(free[first], &|step| vertex - step))?;
    }
    Ok(())
}

/// How far the vertex one step along each side of a set is from a vertex, by set.
fn steps(sides: &[u32]) -> Vec<u32> {
    let mut steps = vec![0];
    let mut stride = 1_u32;
    for side in sides {
        // At most the number of the vertex (1, 1, …).
        steps.extend(steps.clone().iter().map(|step| step + stride));
        stride = stride.wrapping_mul(*side);
    }
    steps
}

/// The number of simplices of each dimension.
pub(super) fn counts(sides: &[u32], kept: &Vertices) -> Vec<u64> {
    let chains = Chain::all(sides.len());
    let mut counts = vec![0; sides.len() + 1];
    let Ok(()) = visit_corners(sides, kept, |_, above, _| {
        for chain in chains.iter().filter(|chain| above & chain.members == chain.members) {
            counts[chain.sets.len()] += 1;
        }
        Ok::<(), std::convert::Infallible>(())
    });
    counts.truncate(counts.iter().rposition(|&count| count > 0).map_or(0, |last| last + 1));
    counts
}

/// Calls `visit` with the vertices of every maximal simplex, until it fails.
pub(super) fn visit<E>(
    sides: &[u32],
    kept: &Vertices,
    mut visit: impl FnMut(&[u32]) -> Result<(), E>,
) -> Result<(), E> {
    let (chains, steps) = (Chain::all(sides.len()), steps(sides));
    let mut simplex = Vec::with_capacity(sides.len() + 1);
    visit_corners(sides, kept, |vertex, above, below| {
        for chain in &chains {
            if above & chain.members == chain.members && above & chain.above == 0 && below & chain.below == 0 {
                simplex.clear();
                simplex.push(vertex);
                simplex.extend(chain.sets.iter().map(|&set| vertex + steps[set]));
                if chain.is_odd {
                    simplex.swap(sides.len() - 1, sides.len());
                }
                visit(&simplex)?;
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::generate::Triangulation;
    use crate::generate::triangulation::tests::listed;

    /// The faces of simplices, they themselves among them, by increasing vertices.
    fn faces(simplices: &[Vec<u32>]) -> BTreeSet<Vec<u32>> {
        let mut faces = BTreeSet::new();
        for simplex in simplices {
            let mut simplex = simplex.clone();
            simplex.sort_unstable();
            for mask in 1_u32..1 << simplex.len() {
                faces.insert((0..).zip(&simplex).filter(|(k, _)| mask >> k & 1 == 1).map(|(_, &v)| v).collect());
            }
        }
        faces
    }

    /// A grid of one to four sides, and some of its vertices.
    fn grids() -> impl Strategy<Value = (Vec<u32>, Vec<bool>)> {
        let sides = prop_oneof![
            prop::collection::vec(2_u32..9, 1..3),
            prop::collection::vec(2_u32..5, 3),
            prop::collection::vec(2_u32..4, 4)
        ];
        let kept = |sides: &[u32], odds| {
            prop::collection::vec(prop::bool::weighted(odds), sides.iter().product::<u32>() as usize)
        };
        (sides, 0.1..1.0).prop_flat_map(move |(sides, odds)| (Just(sides.clone()), kept(&sides, odds)))
    }

    proptest! {
        /// By the definition: of the simplices of the grid those whose vertices are kept, and of them those that are
        /// faces of no other.
        #[test]
        fn parts_are_the_simplices_between_their_vertices((sides, kept) in grids()) {
            let grid = Triangulation::grid(&sides).unwrap();
            let is_kept = |simplex: &Vec<u32>| simplex.iter().all(|&vertex| kept[vertex as usize]);
            let all = listed(&grid);
            let within: BTreeSet<_> = faces(&all).into_iter().filter(is_kept).collect();
            let is_proper_face = |face: &[u32]| {
                within.iter().any(|other| other.len() > face.len() && face.iter().all(|vertex| other.contains(vertex)))
            };
            let maximal: Vec<_> = within.iter().filter(|simplex| !is_proper_face(simplex)).cloned().collect();

            let part = grid.induced(kept.iter().copied().collect()).unwrap();
            let found = listed(&part);
            prop_assert_eq!(part.num_listed(), Some(found.len() as u64));
            let mut sorted = found.clone();
            sorted.iter_mut().for_each(|simplex| simplex.sort_unstable());
            sorted.sort_unstable();
            prop_assert_eq!(sorted, maximal);
            // The simplices of the greatest dimension are oriented as those of the grid.
            prop_assert!(found.iter().filter(|simplex| simplex.len() > sides.len()).all(|simplex| all.contains(simplex)));
            let counts = part.counts().unwrap();
            let count = |dim: usize| within.iter().filter(|simplex| simplex.len() == dim + 1).count() as u64;
            prop_assert_eq!(counts, (0..=sides.len()).map(count).take_while(|&count| count > 0).collect::<Vec<_>>());
        }
    }

    #[test]
    fn vertices_have_places() {
        let kept: Vertices = (0..200).map(|number| number % 3 == 1).collect();
        assert_eq!(kept.len(), 67);
        assert!(kept.iter().eq((0..200).filter(|number| number % 3 == 1)));
        let ranks = kept.ranks();
        assert!(kept.iter().zip(0..).all(|(vertex, place)| ranks.of(vertex) == place));
        assert!(!kept.contains(0) && kept.contains(199) && !kept.contains(202) && !kept.is_empty());
    }

    #[test]
    fn only_grids_have_parts() {
        let torus = Triangulation::torus(&[3, 3]).unwrap();
        assert_eq!(torus.induced(Vertices::default()), Err(crate::generate::GenerateError::NoGrid));
        let none = Triangulation::grid(&[3, 3]).unwrap().induced(Vertices::default()).unwrap();
        assert_eq!((listed(&none).len(), none.counts()), (0, Some(Vec::new())));
    }
}
