//! Counts from the literature, and by hand.

use sig_tools::combinatorial_map::{MapError, NotSimplicial, Walk, darts_of_simplex};

use crate::model::{assert_is_map, digits, map_of, projective_plane, sphere, suspension, torus, torus_3};

/// mcc-2012, section 8, for n = 2: one dart for each path from a 2-node to a 0-node would be 4 n_1; a 2-map has 2 n_1.
#[test]
fn darts() {
    for (words, n_1) in [(sphere(0, 4), 6), (torus(), 21), (digits("012 023 034 041 512 523 534 541"), 12)] {
        let map = map_of(&words).unwrap();
        assert_eq!(map.num_cells(1), n_1);
        assert_eq!(map.num_darts(), 2 * n_1);
        assert_eq!(map.num_integers(), 2 * n_1 * 5);
    }
    assert_eq!([1, 2, 3, 4, 5].map(darts_of_simplex), [1, 3, 12, 60, 360].map(Some));
    assert_eq!(darts_of_simplex(40), None);
}

#[test]
fn the_3_torus() {
    let map = map_of(&torus_3()).unwrap();
    // The counts of periodic-cube.mesh of MFEM.
    assert_eq!([0, 1, 2, 3].map(|dim| map.num_cells(dim)), [27, 189, 324, 162]);
    assert_eq!((map.num_darts(), map.num_integers()), (12 * 162, 12 * 162 * 7));
    assert_is_map(&map);
}

#[test]
fn refused() {
    assert!(matches!(map_of(&projective_plane()), Err(MapError::NotOrientable { of_dim: 2, .. })));
    // A quasi-manifold is no manifold: the suspension of a torus.
    assert!(map_of(&suspension(&torus())).is_ok());
    // Two tori at a vertex are pinched there; two spheres are two components.
    let shifted = torus().into_iter().map(|word| word.into_iter().map(|vertex| vertex + 6).collect());
    let pinched = [torus(), shifted.collect()].concat();
    assert_eq!(map_of(&pinched), Err(MapError::Pinched { simplex: "6".to_owned(), dim: 0, clusters: 2 }));
    assert!(map_of(&[sphere(0, 4), sphere(4, 4)].concat()).is_ok());
}

/// Two triangles on the same vertices: what is left of the tetrahedron's boundary when an edge is contracted.
#[test]
fn a_map_that_is_no_longer_simplicial() {
    let mut map = map_of(&sphere(0, 4)).unwrap();
    let mut walk = Walk::new();
    let edge = map.cells(1).next().unwrap();
    let vertex = map.boundary(edge, 0, &mut walk)[0];
    map.contract(edge, vertex, &mut walk).unwrap();
    assert_is_map(&map);
    assert_eq!([0, 1, 2].map(|dim| map.num_cells(dim)), [3, 5, 4]);
    assert!(matches!(map.to_soup(), Err(NotSimplicial::SameVertices { dim: 1, .. })));
    // Without the two faces of two edges, two triangles are left, on the same vertices.
    for _ in 0..2 {
        let face = map.cells(2).find(|&face| map.darts_of(face, &mut Walk::new()).len() == 2).unwrap();
        let edge = map.boundary(face, 1, &mut walk)[0];
        map.remove(edge, face, &mut walk).unwrap();
        assert_is_map(&map);
    }
    assert_eq!([0, 1, 2].map(|dim| map.num_cells(dim)), [3, 3, 2]);
    assert!(matches!(map.to_soup(), Err(NotSimplicial::SameVertices { dim: 2, .. })));
    // One face of three edges more, and there is one face of four, with three vertices.
    let face = map.cells(2).next().unwrap();
    let edge = map.boundary(face, 1, &mut walk)[0];
    map.remove(edge, face, &mut walk).unwrap();
    assert!(matches!(map.to_soup(), Err(NotSimplicial::Cell { dim: 2, vertices: 3, darts: 4, .. })));
}
