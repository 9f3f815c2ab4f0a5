//! Complexes from the paper and the literature, with values that were computed independently.

use sig_tools::build::SigArrays;
use sig_tools::soup::{Labels, Soup};

use crate::agreement::{arrays, check};
use crate::oracle::Oracle;
use crate::samples::{affine_plane, cone, kuhn_grid, soup, soup_of, torus, words};

/// The words of C\*(σ).
fn partial_coboundary(names: &[&str], face: &str) -> Vec<String> {
    let simplices = words(names);
    let arrays = check(&soup_of(names));
    let oracle = Oracle::new(&simplices);
    let id = oracle.id(&words(&[face])[0]);
    let list = list(&arrays, id);
    list.iter()
        .map(|&top| names.iter().find(|name| oracle.id(&words(&[name])[0]) == top).unwrap().to_string())
        .collect()
}

fn is_flagged(arrays: &SigArrays<u64>, id: usize) -> bool {
    arrays.flags[id / 8] >> (id % 8) & 1 == 1
}

fn num_flagged(arrays: &SigArrays<u64>) -> usize {
    arrays.flags.iter().map(|byte| byte.count_ones() as usize).sum()
}

/// C\*(σ), by the definition of pointers, lists and flags.
fn list(arrays: &SigArrays<u64>, id: usize) -> Vec<usize> {
    let pointer = arrays.pointers[id] as usize;
    if is_flagged(arrays, id) {
        return vec![pointer];
    }
    arrays.lists[pointer..].iter().take_while(|&&entry| entry != u64::MAX).map(|&entry| entry as usize).collect()
}

fn f_vector(arrays: &SigArrays<u64>) -> Vec<usize> {
    (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect()
}

/// The integers for topological relations (sig-2004, 4.2: without the lookup table) by the general formula, which has two
/// more for each flag, and in the file.
fn integers(arrays: &SigArrays<u64>) -> (usize, usize) {
    let in_file = arrays.num_integers() - arrays.first.len();
    (in_file + 2 * num_flagged(arrays), in_file)
}

#[test]
fn figure_1a() {
    let names = ["012", "023", "045", "056", "07"];
    assert_eq!(partial_coboundary(&names, "0"), ["012", "045", "07"]);
    assert_eq!(integers(&arrays(&soup_of(&names))), (94, 82));
}

#[test]
fn figure_2b() {
    let names = ["0123", "0145", "0156", "017", "018"];
    assert_eq!(partial_coboundary(&names, "01"), ["0123", "0145", "017", "018"]);
    assert!(!partial_coboundary(&names, "0").contains(&"018".to_string()));
    assert_eq!(integers(&arrays(&soup_of(&names))), (213, 177));
}

/// A tetrahedron between two dangling triangles does not join them, nor they it.
#[test]
fn triangles_dangling_from_a_tetrahedron() {
    assert_eq!(partial_coboundary(&["0123", "014", "025"], "0"), ["0123", "014", "025"]);
}

#[test]
fn two_tetrahedra_at_a_vertex() {
    assert_eq!(integers(&check(&soup_of(&["0123", "0456"]))), (138, 102));
}

#[test]
fn cone_on_the_torus() {
    let simplices = cone(&torus());
    let arrays = check(&soup(8, &simplices));
    assert_eq!(f_vector(&arrays), [8, 28, 35, 14]);
    assert_eq!(num_flagged(&arrays), 36);
    assert_eq!(integers(&arrays).1, 379);
    assert!(is_flagged(&arrays, 7));
}

/// More clusters at the apex than edges: the conjecture of sig-2004, 7.1, is false.
#[test]
fn cone_on_the_affine_plane() {
    let arrays = check(&soup(10, &cone(&affine_plane())));
    assert_eq!(list(&arrays, 9).len(), 12);
}

/// A Kuhn grid of k × l × m vertices has an edge, a triangle, … for each chain of corners of each cube.
#[test]
fn kuhn_grids() {
    let arrays = arrays(&kuhn_grid(14, 14, 14));
    assert_eq!(arrays.num_simplices, 60_243);
    assert_eq!(arrays.lists.len(), 80_106);
    assert_eq!(f_vector(&arrays)[0], 14 * 14 * 14);
    assert_eq!(f_vector(&arrays)[3], 6 * 13 * 13 * 13);
    check(&kuhn_grid(3, 3, 4));
}

#[test]
fn degenerate_complexes() {
    assert_eq!(check(&Soup::new(Labels::Numbered(0), false)), SigArrays::default());
    let vertex = check(&soup_of(&["0"]));
    assert_eq!((vertex.first.as_slice(), vertex.num_simplices), (&[0][..], 1));
    assert_eq!((vertex.child_offsets.as_slice(), vertex.last_vertices.as_slice()), (&[1][..], &[0][..]));
    assert!(vertex.pointers.is_empty() && vertex.lists.is_empty() && vertex.flags.is_empty());
    assert_eq!(f_vector(&check(&soup(5, &[]))), [5]);
    assert_eq!(f_vector(&check(&soup_of(&["01", "12", "20", "34"]))), [5, 4]);
    let simplex = check(&soup_of(&["0123456789a"]));
    assert_eq!(f_vector(&simplex), [11, 55, 165, 330, 462, 462, 330, 165, 55, 11, 1]);
}
