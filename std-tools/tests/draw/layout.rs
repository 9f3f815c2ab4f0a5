//! Layouts: what can be said of any, and of a few whose shape is known.

use std::f64::consts::TAU;

use proptest::prelude::*;
use sig_tools::draw::layout::{MAX_VERTICES, TooLarge, layout};

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

fn ring(count: u32, first: u32) -> Vec<[u32; 2]> {
    (0..count).map(|vertex| [first + vertex, first + (vertex + 1) % count]).collect()
}

#[test]
fn a_ring_is_round() {
    let places = layout(48, &ring(48, 0), 2, 1).unwrap();
    let middle: [f64; 3] = std::array::from_fn(|axis| places.iter().map(|place| place[axis]).sum::<f64>() / 48.0);
    let radii: Vec<f64> = places.iter().map(|&place| distance(place, middle)).collect();
    let mean = radii.iter().sum::<f64>() / 48.0;
    assert!(radii.iter().all(|radius| (radius / mean - 1.0).abs() < 0.1), "{radii:?}");
    // Once around, in the order of the ring.
    let angle = |place: [f64; 3]| (place[1] - middle[1]).atan2(place[0] - middle[0]);
    let turned: f64 = (0..48)
        .map(|vertex| {
            let step = angle(places[(vertex + 1) % 48]) - angle(places[vertex]);
            (step + 1.5 * TAU) % TAU - TAU / 2.0
        })
        .sum();
    assert!((turned.abs() - TAU).abs() < 1e-6, "{turned}");
}

#[test]
fn neighbours_are_nearer_than_others() {
    // A grid in space, too large to push each vertex by each other one.
    let side = 40_u32;
    let vertex = |x: u32, y: u32| x * side + y;
    let mut edges = Vec::new();
    for x in 0..side {
        for y in 0..side {
            if x + 1 < side {
                edges.push([vertex(x, y), vertex(x + 1, y)]);
            }
            if y + 1 < side {
                edges.push([vertex(x, y), vertex(x, y + 1)]);
            }
        }
    }
    let places = layout(1600, &edges, 3, 0).unwrap();
    let lengths: Vec<f64> =
        edges.iter().map(|ends| distance(places[ends[0] as usize], places[ends[1] as usize])).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    let corners = distance(places[vertex(0, 0) as usize], places[vertex(side - 1, side - 1) as usize]);
    assert!(corners > 20.0 * mean, "{corners} {mean}");
    assert!(lengths.iter().all(|&length| length > 0.1 * mean && length < 4.0 * mean));
}

#[test]
fn components_lie_beside_each_other() {
    let edges = [ring(10, 0), ring(7, 10), ring(5, 17)].concat();
    // And two vertices by themselves.
    let places = layout(24, &edges, 2, 3).unwrap();
    let pieces = [0..10, 10..17, 17..22, 22..23, 23..24];
    let boxes: Vec<[[f64; 2]; 2]> = pieces
        .into_iter()
        .map(|piece| {
            [0, 1].map(|axis| {
                let values = places[piece.clone()].iter().map(|place| place[axis]);
                [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)]
            })
        })
        .collect();
    for (number, a) in boxes.iter().enumerate() {
        for b in &boxes[..number] {
            assert!((0..2).any(|axis| a[axis][1] < b[axis][0] || b[axis][1] < a[axis][0]), "{a:?} {b:?}");
        }
    }
}

#[test]
fn too_many_vertices_are_told() {
    assert_eq!(layout(MAX_VERTICES + 1, &[], 2, 0), Err(TooLarge { vertices: MAX_VERTICES + 1 }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_graph_has_a_layout_that_is_the_same_again(
        edges in prop::collection::btree_set((0..30_u32, 0..30_u32), 0..80), dims in 2..4_usize, seed: u64
    ) {
        let edges: Vec<[u32; 2]> = edges.into_iter().filter(|(a, b)| a < b).map(|(a, b)| [a, b]).collect();
        let places = layout(30, &edges, dims, seed).unwrap();
        prop_assert!(places.iter().flatten().all(|value| value.is_finite()));
        prop_assert!(dims == 3 || places.iter().all(|place| place[2] == 0.0));
        for (vertex, &place) in places.iter().enumerate() {
            prop_assert!(places[..vertex].iter().all(|&other| distance(place, other) > 1e-6), "two at one place");
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        prop_assert_eq!(pool.install(|| layout(30, &edges, dims, seed).unwrap()), places);
    }
}
