//! From complexes to maps and back, and the complexes that are refused.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use proptest::sample::Index as Pick;
use sig_core::{Complex, SimplexId};
use sig_tools::build::{BuildOptions, VertexOrder, build};
use sig_tools::combinatorial_map::{CombinatorialMap, DartId, MapError, map_integers};

use crate::model::{
    Word, assert_is_map, built, closed, digits, faces, file, is_face, map_of, projective_plane, sphere, suspension,
    word_of,
};

/// Flags as lists of simplices, and for each the one that differs from it in dimension i only.
struct Flags {
    all: BTreeSet<Vec<SimplexId>>,
}

impl Flags {
    fn new(complex: &Complex<'_, u16>) -> Self {
        let mut all: BTreeSet<Vec<SimplexId>> = complex.simplices_of_dim(0).map(|vertex| vec![vertex]).collect();
        for dim in 1..=complex.dim().unwrap() {
            let longer = |flag: &Vec<SimplexId>| {
                let top = *flag.last().unwrap();
                let above = complex.simplices_of_dim(dim).filter(move |&upper| complex.facets(upper).any(|f| f == top));
                above.map(|upper| [flag.as_slice(), &[upper]].concat()).collect::<Vec<_>>()
            };
            all = all.iter().flat_map(longer).collect();
        }
        Self { all }
    }

    fn alpha(&self, i: usize, flag: &[SimplexId]) -> Vec<SimplexId> {
        let differs = |other: &&Vec<SimplexId>| (0..flag.len()).all(|at| (other[at] == flag[at]) == (at != i));
        let mut others = self.all.iter().filter(differs);
        let other = others.next().expect("a closed complex").clone();
        assert!(others.next().is_none(), "a quasi-manifold has one neighbour of each kind");
        other
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// βi is α_i ∘ α_0 on one of the two orientations of the flags.
    #[test]
    fn darts_are_every_second_flag(words in closed(2..=3)) {
        let file = file(&built(&words));
        let complex = Complex::<u16>::from_bytes(&file).unwrap();
        let map = CombinatorialMap::new(&complex).unwrap();
        assert_is_map(&map);
        let flags = Flags::new(&complex);
        let n = map.dim();
        let flag = |dart: DartId| -> Vec<SimplexId> { (0..=n).map(|dim| map.cell(dart, dim).unwrap()).collect() };
        let darts: BTreeMap<Vec<SimplexId>, DartId> = map.darts().map(|dart| (flag(dart), dart)).collect();
        prop_assert_eq!(darts.len(), map.num_darts());
        prop_assert_eq!(2 * darts.len(), flags.all.len());
        for (flag, &dart) in &darts {
            prop_assert!(flags.all.contains(flag));
            // No two neighbouring flags are darts: one orientation.
            let turned = flags.alpha(0, flag);
            prop_assert!(!darts.contains_key(&turned));
            for i in 1..=n {
                prop_assert_eq!(map.beta(i, dart), darts.get(&flags.alpha(i, &turned)).copied(), "β{}", i);
            }
        }
        prop_assert_eq!(map.num_integers(), map_integers(n, flags.all.len() / 2));
        prop_assert_eq!(map.bytes(), 4 * (map.num_integers() + complex.num_simplices()));
    }

    /// Cells are the simplices, and the way back gives the same arrays.
    #[test]
    fn back_to_the_same_complex(words in closed(2..=4)) {
        let original = built(&words);
        let file = file(&original);
        let complex = Complex::<u16>::from_bytes(&file).unwrap();
        let map = CombinatorialMap::new(&complex).unwrap();
        for dim in 0..=map.dim() {
            prop_assert!(map.cells(dim).eq(complex.simplices_of_dim(dim)));
        }
        let options = BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() };
        let soup = map.to_soup().unwrap();
        let again = build(soup.clone(), &options).unwrap();
        prop_assert_eq!(&again.arrays, &original.arrays);
        prop_assert_eq!(&again.labels, &original.labels);
        // With orientations that agree, they come back too: every byte.
        let oriented = build(soup, &options).unwrap();
        let bytes = crate::model::file(&oriented);
        let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
        let third = build(CombinatorialMap::new(&complex).unwrap().to_soup().unwrap(), &options).unwrap();
        prop_assert!(crate::model::file(&third)[..] == bytes[..]);
    }

    /// A complex is refused for what the definition finds first.
    #[test]
    fn refusals_agree_with_the_definition(words in closed(2..=3), changes in prop::collection::vec(change(), 0..3)) {
        let words = changes.iter().fold(words, changed);
        prop_assert_eq!(refusal(&map_of(&words)), by_definition(&words));
    }

    #[test]
    fn refusals_of_any_complex(words in prop::collection::vec(prop::collection::btree_set(0_u32..7, 1..5), 0..8)) {
        let words: Vec<Word> = words.into_iter().map(|word| word.into_iter().collect()).collect();
        prop_assert_eq!(refusal(&map_of(&words)), by_definition(&words));
    }
}

#[derive(Clone, Debug)]
enum Change {
    Drop(Pick),
    Add(BTreeSet<u32>),
    Identify(Pick, Pick),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        any::<Pick>().prop_map(Change::Drop),
        prop::collection::btree_set(0_u32..9, 1..5).prop_map(Change::Add),
        (any::<Pick>(), any::<Pick>()).prop_map(|(one, other)| Change::Identify(one, other)),
    ]
}

fn changed(mut words: Vec<Word>, change: &Change) -> Vec<Word> {
    match change {
        Change::Drop(at) if words.len() > 1 => {
            words.remove(at.index(words.len()));
        }
        Change::Drop(_) => (),
        Change::Add(word) => words.push(word.iter().copied().collect()),
        Change::Identify(one, other) => {
            let vertices: Vec<u32> = words.iter().flatten().copied().collect::<BTreeSet<_>>().into_iter().collect();
            let [one, other] = [one, other].map(|pick| vertices[pick.index(vertices.len())]);
            for word in &mut words {
                word.iter_mut().filter(|vertex| **vertex == one).for_each(|vertex| *vertex = other);
                *word = word.iter().copied().collect::<BTreeSet<_>>().into_iter().collect();
            }
        }
    }
    words
}

/// What is refused, but for the facet of an orientation.
fn refusal(map: &Result<CombinatorialMap, MapError>) -> String {
    match map {
        Ok(_) => "none".to_owned(),
        Err(MapError::NotOrientable { .. }) => "not orientable".to_owned(),
        Err(error) => error.to_string(),
    }
}

fn by_definition(words: &[Word]) -> String {
    let faces = faces(words);
    let Some(n) = faces.last().map(|word| word.len() - 1).filter(|&n| n > 1) else {
        return MapError::Dimension.to_string();
    };
    let is_top = |word: &&Word| !faces.iter().any(|other| other.len() > word.len() && is_face(word, other));
    let tops: Vec<&Word> = faces.iter().filter(is_top).collect();
    // Labels are numbers of vertices, for those that are there.
    let name = |word: &Word| word.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
    for simplex in faces.iter().filter(|simplex| simplex.len() <= n) {
        let dim = simplex.len() - 1;
        let around: Vec<&Word> =
            tops.iter().copied().filter(|top| top.len() > simplex.len() && is_face(simplex, top)).collect();
        let error = if around.is_empty() {
            MapError::Dangling { simplex: name(simplex), dim, of_dim: n }
        } else if dim + 1 == n {
            match around.len() {
                1 => MapError::Boundary { simplex: name(simplex), of_dim: n },
                2 => continue,
                cofaces => MapError::Branching { simplex: name(simplex), cofaces, of_dim: n },
            }
        } else {
            match clusters(simplex, &around) {
                1 if around[0].len() == n + 1 => continue,
                1 => MapError::Dangling { simplex: name(around[0]), dim: around[0].len() - 1, of_dim: n },
                clusters => MapError::Pinched { simplex: name(simplex), dim, clusters },
            }
        };
        return error.to_string();
    }
    if is_orientable(&tops) { "none".to_owned() } else { "not orientable".to_owned() }
}

/// The classes of the top simplices around a simplex: two of one dimension belong together if they share a facet that
/// contains it, and is not it.
fn clusters(simplex: &[u32], around: &[&Word]) -> usize {
    let mut classes: Vec<usize> = (0..around.len()).collect();
    for i in 0..around.len() {
        for j in 0..i {
            let shared: Word = around[i].iter().copied().filter(|vertex| around[j].contains(vertex)).collect();
            let len = around[i].len();
            let is_shared = shared.len() > simplex.len() && is_face(simplex, &shared);
            if len == around[j].len() && shared.len() + 1 == len && is_shared {
                let (from, to) = (classes[i], classes[j]);
                classes.iter_mut().filter(|class| **class == from).for_each(|class| *class = to);
            }
        }
    }
    classes.into_iter().collect::<BTreeSet<_>>().len()
}

/// Whether signs of the n-simplices exist for which their boundaries cancel in every facet: tries signs from the first
/// simplex of each component on.
fn is_orientable(tops: &[&Word]) -> bool {
    let mut signs: BTreeMap<&Word, bool> = BTreeMap::new();
    let position = |top: &Word, other: &Word| top.iter().position(|vertex| !other.contains(vertex)).unwrap();
    let share = |one: &Word, other: &Word| one.iter().filter(|vertex| !other.contains(vertex)).count() == 1;
    while signs.len() < tops.len() {
        let known: Vec<&Word> = signs.keys().copied().collect();
        let neighbour = tops.iter().filter(|top| !signs.contains_key(**top)).find_map(|&top| {
            let beside = known.iter().copied().find(|known| share(known, top))?;
            Some((top, (position(top, beside) + position(beside, top)) % 2 == 1, beside))
        });
        match neighbour {
            Some((top, is_odd, beside)) => signs.insert(top, if is_odd { signs[beside] } else { !signs[beside] }),
            None => signs.insert(tops.iter().find(|top| !signs.contains_key(**top)).unwrap(), false),
        };
    }
    let cancels = |one: &Word, other: &Word| {
        (signs[one] == signs[other]) == ((position(one, other) + position(other, one)) % 2 == 1)
    };
    tops.iter().all(|one| tops.iter().filter(|other| share(one, other)).all(|other| cancels(one, other)))
}

#[test]
fn a_file_that_is_no_complex_is_refused() {
    let mut file = file(&built(&sphere(0, 4)));
    let container = sig_core::format::Container::from_bytes(&file).unwrap();
    let boundary = container.spans().find(|(kind, ..)| *kind == sig_core::format::SectionKind::Boundary);
    let last = boundary.unwrap().2.end;
    file[last - 2..last].copy_from_slice(&60_u16.to_le_bytes());
    let complex = Complex::<u16>::from_bytes(&file).unwrap();
    assert_eq!(CombinatorialMap::new(&complex), Err(MapError::NotAComplex(SimplexId::new(13))));
}

#[test]
fn the_simplex_that_is_named_has_its_labels() {
    let error = |words: &str| map_of(&digits(words)).unwrap_err().to_string();
    assert!(error("012 023 013 123 45").contains("the simplex 4,5 of dimension 1 is a face of no 2-simplex"));
    assert!(
        error("012 013 023 123 045 046 056 456").contains("around the simplex 0 of dimension 0 there are 2 clusters")
    );
    assert!(error("012 013 014").contains("around") || error("012 013 014").contains("share 0,1"));
    assert!(error("012").contains("not closed: 0,1"));
    assert!(error("01 12 02").contains("for dimension 2 and more"));
    let file = file(&built(&suspension(&projective_plane())));
    let complex = Complex::<u16>::from_bytes(&file).unwrap();
    match CombinatorialMap::new(&complex) {
        Err(MapError::NotOrientable { simplex, of_dim: 3 }) => {
            let named: Word = simplex.split(',').map(|label| label.parse().unwrap()).collect();
            assert!(complex.simplices_of_dim(2).any(|triangle| word_of(&complex, triangle) == named));
        }
        other => panic!("{other:?}"),
    }
}
