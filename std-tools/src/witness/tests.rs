//! The definition as oracle: every subset of the landmarks is looked at, for every witness.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;

use super::insertion::GrowingWitnessComplex;
use super::*;
use crate::soup::Labels;

/// The distance, or its square, of the definition; infinity counts as the largest number.
fn distance(options: &WitnessOptions, witness: &[f64], landmark: &[f64]) -> f64 {
    let distance = options.metric.distance(witness, landmark);
    let scaled = match (options.relaxation, options.metric) {
        (Relaxation::Distance(_), _) => distance,
        (Relaxation::Squared(_), Metric::Euclidean) => crate::points::squared_distance(witness, landmark),
        (Relaxation::Squared(_), _) => distance * distance,
    };
    scaled.min(f64::MAX)
}

/// The least relaxation at which some witness witnesses a set of landmarks: Definition 2, read literally.
fn least_relaxation(distances: &[Vec<f64>], simplex: u32) -> f64 {
    let witnessed = |distances: &Vec<f64>| {
        let mut least = 0.0_f64;
        for (x, inside) in distances.iter().enumerate().filter(|(x, _)| simplex >> x & 1 == 1) {
            for (y, outside) in distances.iter().enumerate().filter(|(y, _)| simplex >> y & 1 == 0) {
                assert_ne!(x, y);
                least = least.max(inside - outside);
            }
        }
        least
    };
    distances.iter().map(witnessed).fold(f64::INFINITY, f64::min)
}

/// The simplices of the complex with their values, as sets of landmarks.
fn by_definition(witnesses: &Points, landmarks: &Points, options: &WitnessOptions) -> BTreeMap<Vec<u32>, f64> {
    let row =
        |w: usize| (0..landmarks.len()).map(|l| distance(options, witnesses.point(w), landmarks.point(l))).collect();
    let distances: Vec<Vec<f64>> = (0..witnesses.len()).map(row).collect();
    let values: Vec<f64> = (0..1_u32 << landmarks.len()).map(|set| least_relaxation(&distances, set)).collect();
    let mut complex = BTreeMap::new();
    for set in (1..1_u32 << landmarks.len()).filter(|set| set.count_ones() as usize <= options.max_dim + 1) {
        // All faces: all subsets but the empty one.
        let faces = (1..=set).filter(|face| face & !set == 0);
        let value = faces.map(|face| values[face as usize]).fold(0.0, f64::max);
        if value <= options.relaxation.amount() {
            complex.insert((0..32).filter(|vertex| set >> vertex & 1 == 1).collect(), value);
        }
    }
    complex
}

/// The simplices of a tree by the labels of their vertices, with their values.
fn simplices(tree: &FrozenTree) -> BTreeMap<Vec<u32>, f64> {
    let label = |vertex: u32| match &tree.labels {
        Labels::Integers(labels) => u32::try_from(labels[vertex as usize]).expect("few landmarks"),
        _ => vertex,
    };
    let mut words: Vec<Vec<u32>> = vec![Vec::new(); tree.num_simplices];
    for vertex in tree.ids(0) {
        words[vertex] = vec![narrow(vertex)];
    }
    for node in 0..tree.num_simplices {
        for child in tree.children(node) {
            words[child] = [words[node].as_slice(), &[tree.last_vertices.at(child)]].concat();
        }
    }
    let values = tree.filtration.clone().unwrap_or_else(|| vec![0.0; words.len()]);
    assert!(words.is_sorted_by_key(|word| (word.len(), word.clone())), "not in canonical order");
    let labelled = words.iter().map(|word| word.iter().map(|&vertex| label(vertex)).collect());
    labelled.zip(values).collect()
}

const METRICS: [Metric; 4] = [Metric::Euclidean, Metric::Maximum, Metric::Manhattan, Metric::Cosine];

/// Small whole coordinates give many ties and repeated points; others, sums that round.
fn points(dim: usize, count: std::ops::Range<usize>) -> impl Strategy<Value = Points> {
    let value = prop_oneof![4 => (-3_i8..4).prop_map(f64::from), 1 => 0.0..3.0_f64];
    proptest::collection::vec(proptest::collection::vec(value, dim), count)
        .prop_map(move |rows| Points::new(dim, rows.concat()).unwrap())
}

fn relaxation() -> impl Strategy<Value = Relaxation> {
    let amount = prop_oneof![Just(0.0), Just(1.0), 0.0..2.0_f64];
    (amount, any::<bool>()).prop_map(
        |(amount, squared)| {
            if squared { Relaxation::Squared(amount) } else { Relaxation::Distance(amount) }
        },
    )
}

fn instance() -> impl Strategy<Value = (Points, Points, WitnessOptions)> {
    (1_usize..4).prop_flat_map(|dim| {
        let options = (relaxation(), 0..4_usize, prop_oneof![0..4_usize, Just(MAX_DIM)], any::<bool>());
        (points(dim, 0..14), points(dim, 1..8), options).prop_map(|(witnesses, landmarks, options)| {
            let (relaxation, metric, max_dim, filtration) = options;
            let metric = METRICS[metric];
            (witnesses, landmarks, WitnessOptions { metric, relaxation, max_dim, filtration, max_simplices: None })
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_complex_is_that_of_the_definition((witnesses, landmarks, options) in instance()) {
        let complex = witness_complex(&witnesses, &Landmarks::all(landmarks.clone()), &options).unwrap();
        let mut expected = by_definition(&witnesses, &landmarks, &options);
        if !options.filtration {
            expected.values_mut().for_each(|value| *value = 0.0);
        }
        prop_assert_eq!(complex.tree.filtration.is_some(), options.filtration && !expected.is_empty());
        let absent: Vec<u64> =
            (0..narrow(landmarks.len())).filter(|&l| !expected.contains_key(&vec![l])).map(u64::from).collect();
        prop_assert_eq!(complex.absent, absent);
        prop_assert_eq!(simplices(&complex.tree), expected);
    }

    /// The simplices up to a value of the filtration are the complex of that relaxation.
    #[test]
    fn the_filtration_cut_at_a_value_is_the_complex_of_that_value((witnesses, landmarks, options) in instance()) {
        let options = WitnessOptions { filtration: true, ..options };
        let landmarks = Landmarks::all(landmarks);
        let whole = simplices(&witness_complex(&witnesses, &landmarks, &options).unwrap().tree);
        let values: BTreeSet<u64> = whole.values().map(|value| value.to_bits()).collect();
        for value in values.into_iter().map(f64::from_bits) {
            let relaxation = match options.relaxation {
                Relaxation::Distance(_) => Relaxation::Distance(value),
                Relaxation::Squared(_) => Relaxation::Squared(value),
            };
            let cut = witness_complex(&witnesses, &landmarks, &WitnessOptions { relaxation, ..options }).unwrap();
            let mut expected = whole.clone();
            expected.retain(|_, simplex| *simplex <= value);
            prop_assert_eq!(simplices(&cut.tree), expected);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Adding landmarks one by one is building with all of them; and the counters are the numbers of witnesses.
    #[test]
    fn inserting_landmarks_is_building_anew((witnesses, landmarks, options) in instance(), start in 1..8_usize) {
        let options = WitnessOptions { relaxation: Relaxation::STRICT, filtration: false, ..options };
        let prefix = |count| landmarks.select(&(0..count).collect::<Vec<_>>());
        let start = start.min(landmarks.len());
        let mut growing =
            GrowingWitnessComplex::new(witnesses.clone(), Landmarks::all(prefix(start)), &options).unwrap();
        for count in start..=landmarks.len() {
            if count > start {
                prop_assert_eq!(growing.insert(landmarks.point(count - 1)), Ok(count as u64 - 1));
            }
            let complex = growing.complex();
            prop_assert_eq!(&complex, &witness_complex(&witnesses, &Landmarks::all(prefix(count)), &options).unwrap());
            for simplex in simplices(&complex.tree).keys() {
                let is_witness = |w: &usize| {
                    let distances: Vec<f64> =
                        (0..count).map(|l| distance(&options, witnesses.point(*w), landmarks.point(l))).collect();
                    least_relaxation(&[distances], simplex.iter().map(|vertex| 1 << vertex).sum()) == 0.0
                };
                let expected = (0..witnesses.len()).filter(is_witness).count();
                prop_assert_eq!(growing.num_witnesses(simplex), Some(narrow(expected)));
            }
        }
    }
}

fn counts(witnesses: &Points, landmarks: &[usize], options: &WitnessOptions) -> Vec<usize> {
    let landmarks = Landmarks::chosen(witnesses, landmarks).unwrap();
    witness_complex(witnesses, &landmarks, options).unwrap().tree.counts()
}

fn first(count: usize) -> Vec<usize> {
    (0..count).collect()
}

/// One witness in the middle of three landmarks witnesses all of their faces; the counts follow from the definition.
#[test]
fn a_witness_at_one_distance_of_three_landmarks_witnesses_all_faces() {
    let landmarks = Points::new(2, vec![1.0, 0.0, -1.0, 0.0, 0.0, 1.0]).unwrap();
    let witness = Points::new(2, vec![0.0, 0.0]).unwrap();
    let complex = witness_complex(&witness, &Landmarks::all(landmarks), &WitnessOptions::default()).unwrap();
    assert_eq!(complex.tree.counts(), [3, 3, 1]);
}

/// The counts are GUDHI's, of its witness complex of the same points.
#[test]
fn strict_complexes_in_25_dimensions_have_the_counts_of_another_program() {
    let options = WitnessOptions::default();
    let cube = crate::generate::cube(15_000, 25, 4);
    assert_eq!(counts(&cube, &first(3000), &options), [3000, 13_388, 164]);
    let veronese = crate::generate::veronese(15_000, 5);
    assert_eq!(counts(&veronese, &first(3000), &options), [3000, 8176, 1155, 1]);
}

/// The counts are GUDHI's.
#[test]
fn a_relaxed_complex_has_the_counts_of_another_program() {
    let sphere = crate::generate::sphere4(20_000, 3);
    let options = WitnessOptions { relaxation: Relaxation::Squared(0.05), max_dim: 5, ..WitnessOptions::default() };
    let expected = [2000, 34_582, 108_048, 141_823, 117_810, 81_251];
    assert_eq!(counts(&sphere, &first(2000), &options), expected);
    assert_eq!(counts(&sphere, &first(2000), &WitnessOptions { filtration: true, ..options }), expected);
}

/// Enough points that tasks, tiles and the growing table matter, in the plane where complexes are small.
#[test]
fn many_landmarks_are_inserted_as_if_they_had_been_there() {
    let (witnesses, landmarks) = (crate::generate::cube(3000, 2, 1), crate::generate::cube(150, 2, 2));
    let options = WitnessOptions { max_dim: 4, ..WitnessOptions::default() };
    let start = landmarks.select(&(0..100).collect::<Vec<_>>());
    let mut growing = GrowingWitnessComplex::new(witnesses.clone(), Landmarks::all(start), &options).unwrap();
    for landmark in 100..150 {
        growing.insert(landmarks.point(landmark)).unwrap();
    }
    assert_eq!(growing.complex(), witness_complex(&witnesses, &Landmarks::all(landmarks), &options).unwrap());
}

/// Landmarks at one place are all as near: every set of them is a simplex, as many as their number allows.
#[test]
fn landmarks_at_one_place_make_a_full_simplex_or_too_many() {
    let witness = Points::new(1, vec![1.0]).unwrap();
    let at_origin = |count| Landmarks::all(Points::new(1, vec![0.0; count]).unwrap());
    let options = WitnessOptions::default();
    let complex = witness_complex(&witness, &at_origin(10), &options).unwrap();
    assert_eq!(complex.tree.counts(), [10, 45, 120, 210, 252, 210, 120, 45, 10, 1]);
    let error = witness_complex(&witness, &at_origin(200), &WitnessOptions { max_simplices: Some(1000), ..options });
    assert_eq!(error, Err(WitnessError::TooLarge { at_least: u64::MAX, limit: 1000 }));
    assert!(matches!(witness_complex(&witness, &at_origin(200), &options), Err(WitnessError::TooLarge { .. })));
    let edges = witness_complex(&witness, &at_origin(200), &WitnessOptions { max_dim: 1, ..options }).unwrap();
    assert_eq!(edges.tree.counts(), [200, 19_900]);
}

#[test]
fn what_is_no_witness_complex_is_refused() {
    let line = Points::new(1, vec![0.0, 1.0, 2.0]).unwrap();
    let plane = Points::new(2, vec![0.0, 1.0]).unwrap();
    let build = |landmarks: &Points, relaxation, max_dim| {
        let options = WitnessOptions { relaxation, max_dim, ..WitnessOptions::default() };
        witness_complex(&line, &Landmarks::all(landmarks.clone()), &options).map(|complex| complex.tree.counts())
    };
    let strict = Relaxation::STRICT;
    assert_eq!(build(&Points::default(), strict, 1), Err(WitnessError::NoLandmarks));
    assert_eq!(build(&plane, strict, 1), Err(WitnessError::Dimensions { witnesses: 1, landmarks: 2 }));
    assert_eq!(build(&line, Relaxation::Distance(-1.0), 1), Err(WitnessError::Relaxation(-1.0)));
    assert!(matches!(build(&line, Relaxation::Squared(f64::NAN), 1), Err(WitnessError::Relaxation(_))));
    assert_eq!(build(&line, strict, 32), Err(WitnessError::MaxDim(32)));
    assert_eq!(build(&line, Relaxation::Distance(f64::INFINITY), 31), Ok(vec![3, 3, 1]));
    let choose = |count| Landmarks::random(&line, count, 1).map(|landmarks| landmarks.numbers().len());
    assert_eq!((choose(0), choose(3)), (Err(WitnessError::NoLandmarks), Ok(3)));
    assert_eq!(choose(4), Err(WitnessError::TooManyLandmarks { asked: 4, points: 3 }));
    assert_eq!(Landmarks::chosen(&line, &[3]), Err(WitnessError::NoSuchPoint { number: 3, points: 3 }));
    let none = witness_complex(&Points::default(), &Landmarks::all(line), &WitnessOptions::default()).unwrap();
    assert_eq!((none.tree, none.absent), (FrozenTree::default(), vec![0, 1, 2]));
}

/// Maxmin on a line: the first point, the farthest from it, the one in the middle of the largest gap.
#[test]
fn landmarks_stand_by_number_however_they_are_chosen() {
    let line = Points::new(1, vec![1.0, 0.0, 9.0, 6.0, 2.0]).unwrap();
    assert_eq!(Landmarks::maxmin(&line, Metric::Euclidean, 3).unwrap().numbers(), [0, 2, 3]);
    assert_eq!(Landmarks::chosen(&line, &[4, 1, 4]).unwrap().points().values(), [0.0, 2.0]);
    let random = |seed| Landmarks::random(&line, 3, seed).unwrap().numbers().to_vec();
    assert_eq!(random(1), random(1));
    assert!((0..20).any(|seed| random(seed) != random(1)) && random(1).is_sorted());
}
