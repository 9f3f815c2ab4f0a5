//! The builder, the incidence graph and the oracle give the same arrays.

use proptest::prelude::*;
use sig_tools::build::{Arrays, BuildOptions, Built, SigArrays, Unused, VertexOrder, build};
use sig_tools::incidence_graph::IncidenceGraph;
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};

use crate::oracle::Oracle;
use crate::samples::{self, simplices, soup};

pub(crate) fn built(soup: &Soup) -> Built {
    build(soup.clone(), &BuildOptions::default()).expect("a good soup")
}

pub(crate) fn arrays(soup: &Soup) -> SigArrays<u64> {
    built(soup).arrays.into_wide()
}

pub(crate) fn from_incidence_graph(soup: &Soup) -> SigArrays<u64> {
    IncidenceGraph::new(soup, &BuildOptions::default()).expect("a good soup").build_sig().into_wide()
}

/// All simplices that a soup lists, and all of its vertices.
pub(crate) fn listed(soup: &Soup) -> Vec<Vec<u32>> {
    let simplices = (0..32).flat_map(|dim| soup.of_dim(dim).map(<[u32]>::to_vec).collect::<Vec<_>>());
    simplices.chain((0..soup.labels.len() as u32).map(|vertex| vec![vertex])).collect()
}

pub(crate) fn check(soup: &Soup) -> SigArrays<u64> {
    let expected = Oracle::new(&listed(soup)).arrays();
    assert_eq!(from_incidence_graph(soup), expected);
    assert_eq!(arrays(soup), expected);
    expected
}

/// 1 where a top simplex is listed in an odd permutation, and only so; by inversions.
fn parity(soup: &Soup) -> Vec<u8> {
    let simplices = listed(soup);
    let odd = |simplex: &Vec<u32>| {
        let inversions = simplex.iter().enumerate().flat_map(|(k, a)| simplex[k..].iter().filter(move |b| *b < a));
        inversions.count() % 2 == 1
    };
    let oracle = Oracle::new(&simplices);
    let mut bytes = Vec::new();
    for (number, top) in oracle.tops().enumerate() {
        let same = |simplex: &&Vec<u32>| {
            let mut word = (*simplex).clone();
            word.sort_unstable();
            word == top
        };
        let listed_as: Vec<bool> = simplices.iter().filter(same).map(odd).collect();
        if number % 8 == 0 {
            bytes.push(0);
        }
        bytes[number / 8] |= u8::from(listed_as.iter().all(|&odd| odd)) << (number % 8);
    }
    bytes
}

proptest! {
    #[test]
    fn three_ways_agree(simplices in simplices()) {
        check(&soup(14, &simplices));
    }

    #[test]
    fn parity_is_that_of_the_listed_order(simplices in simplices()) {
        let soup = soup(14, &simplices);
        prop_assert_eq!(built(&soup).parity, Some(parity(&soup)));
    }

    #[test]
    fn the_order_of_the_input_does_not_matter(simplices in simplices(), seed in any::<u64>()) {
        let sorted = soup(14, &simplices);
        let mut shuffled = simplices;
        let mut state = seed;
        for end in (1..shuffled.len()).rev() {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            shuffled.swap(end, (state >> 33) as usize % (end + 1));
        }
        prop_assert_eq!(built(&soup(14, &shuffled)), built(&sorted));
    }
}

/// The same mesh under every order of its vertices, whatever its size, on any number of threads.
#[test]
fn the_number_of_threads_does_not_matter() {
    let mut soup = samples::kuhn_grid(14, 13, 12);
    let count = soup.labels.len();
    // Well-mixed vertices, so that tasks meet in many faces.
    for vertex in soup.simplices.iter_mut().flatten() {
        *vertex = (u64::from(*vertex) * 1009 % count as u64) as u32;
    }
    let values = (0..count).flat_map(|vertex| [vertex % 7, vertex % 11, vertex % 13]).map(|x| x as f32).collect();
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32(values) });
    for order in [VertexOrder::Input, VertexOrder::Hilbert, VertexOrder::Rcm] {
        let options = BuildOptions { order, ..BuildOptions::default() };
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| build(soup.clone(), &options)).unwrap()
        };
        let expected = with(1);
        assert_eq!(with(2), expected);
        assert_eq!(with(5), expected);
        let graph = IncidenceGraph::new(&soup, &options).unwrap();
        assert_eq!(graph.build_sig(), expected.arrays);
    }
}

/// A vertex with more neighbours than a mask has bits.
#[test]
fn vertices_of_high_degree() {
    let ring: Vec<Vec<u32>> = (0..70).map(|i| vec![i + 1, (i + 1) % 70 + 1]).collect();
    let fan: Vec<Vec<u32>> = ring.iter().map(|edge| vec![edge[1], 0, edge[0]]).collect();
    check(&soup(71, &fan));
    let mut mixed = samples::cone(&ring);
    mixed.extend((0..70).map(|i| vec![0, i + 1]));
    mixed.push(vec![0, 3, 2, 1]);
    mixed.push(vec![0, 50, 68, 70]);
    check(&soup(72, &mixed));
}

#[test]
fn unused_vertices_are_kept_or_dropped() {
    let mut soup = samples::soup_of(&["135", "57"]);
    let kept = built(&soup);
    assert_eq!(kept.report.unused_kept, 4);
    assert_eq!(kept.report.first_unused, ["0", "2", "4", "6"]);
    assert_eq!(kept.report.top_simplices, [4, 1, 1]);
    assert_eq!(kept.labels, Labels::Numbered(8));
    let dropping = BuildOptions { unused: Unused::Drop, ..BuildOptions::default() };
    let dropped = build(soup.clone(), &dropping).unwrap();
    assert_eq!(dropped.report.unused_dropped, 4);
    assert_eq!(dropped.labels, Labels::Integers(vec![1, 3, 5, 7]));
    assert_eq!(dropped.arrays, built(&samples::soup_of(&["012", "23"])).arrays);
    soup.declared = false;
    assert_eq!(built(&soup).arrays, dropped.arrays);
}

#[test]
fn what_the_input_repeats_is_merged_and_counted() {
    let built = built(&samples::soup_of(&["012", "210", "120", "01", "10", "2", "34", "34", "4", "435", "345"]));
    assert_eq!(built.arrays, self::built(&samples::soup_of(&["012", "345"])).arrays);
    assert_eq!(built.report.listed, 11);
    assert_eq!(built.report.repeated, 5);
    assert_eq!(built.report.non_maximal, 4);
    assert_eq!(built.report.conflicting, 2);
    assert_eq!(built.parity, Some(vec![0]));
}

#[test]
fn narrow_arrays_for_small_complexes() {
    assert!(matches!(built(&samples::soup_of(&["012"])).arrays, Arrays::Narrow(_)));
}
