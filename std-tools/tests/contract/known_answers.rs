//! Contractions worked out by hand.

use sig_tools::build::{Arrays, Built, SigArrays};
use sig_tools::contract::contract;
use sig_tools::soup::Labels;

use crate::model::{Model, edge};
use crate::samples::words;

fn contracted(names: &[&str], count: u32, kept: u32, removed: u32) -> (Built, SigArrays<u32>) {
    let mut built = Model::new(count, &words(names), 0).built();
    contract(&mut built, &[edge(kept, removed)]).expect("an edge");
    let Arrays::Narrow(arrays) = built.arrays.clone() else { panic!("a small complex") };
    (built, arrays)
}

/// Figure 1(a) of sig-2004: triangles 012 023 045 056 and the edge 07. Taking 3 to 2 leaves 012 045 056 and 07, with the
/// vertices 4 5 6 7 now called 3 4 5 6: C*(0) = {012, 034, 06}.
#[test]
fn figure_1a() {
    let (built, arrays) = contracted(&["012", "023", "045", "056", "07"], 8, 2, 3);
    // 7 vertices; edges 01 02 03 04 05 06 12 34 45; triangles 012 034 045.
    assert_eq!(arrays.first, [0, 7, 16]);
    assert_eq!(arrays.num_simplices, 19);
    let start = arrays.pointers[0] as usize;
    assert_eq!(arrays.lists[start..start + 4], [16, 17, 12, u32::MAX]);
    assert_eq!(built.labels, Labels::Integers(vec![0, 1, 2, 4, 5, 6, 7]));
    assert_eq!(built.report.top_simplices, [0, 1, 3]);
}

/// A tetrahedron becomes a triangle: the complex loses a dimension, and what was flagged is listed.
#[test]
fn the_dimension_may_drop() {
    let (_, arrays) = contracted(&["0123"], 4, 0, 3);
    assert_eq!(arrays.first, [0, 3, 6]);
    assert_eq!(arrays.flags, [0b111]);
    assert_eq!(arrays.pointers[..3], [6, 6, 6]);
    let (_, arrays) = contracted(&["01"], 2, 1, 0);
    assert_eq!((arrays.first, arrays.child_offsets, arrays.last_vertices), (vec![0], vec![1], vec![0]));
}

/// The octahedron without two opposite triangles, a ring: an edge between them makes two triangles one another's.
#[test]
fn simplices_may_appear_and_be_faces() {
    // 0 is joined to 3 by the triangle 034 already; taking 1 to 3 makes 013 an edge and 12 the edge 23, which is new.
    let (_, arrays) = contracted(&["12", "13", "034"], 5, 3, 1);
    // Vertices 0 2 3 4, called 0 1 2 3: edges 02 03 12 23, triangle 023.
    assert_eq!(arrays.first, [0, 4, 8]);
    assert_eq!(arrays.last_vertices, [0, 1, 2, 3, 2, 3, 2, 3, 3]);
    assert_eq!(arrays.pointers[1] as usize, arrays.lists.iter().position(|&entry| entry == 6).expect("edge 12"));
}
