//! Combinatorial maps in the conformance suite of the structures that are compared, on triangulations from the literature.

use sig_core::{Complex, Index, with_complex};
use sig_tests::conformance::assert_structure_conforms;
use sig_tests::known;
use sig_tests::oracle::{Oracle, Word};
use sig_tools::Loaded;
use sig_tools::baselines::Structure;
use sig_tools::build::{BuildOptions, VertexOrder, build};
use sig_tools::combinatorial_map::{CombinatorialMap, Darts, MapError, darts_of_simplex};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};

/// Every relation of the map, or why there is none.
fn conforms(words: &[Word]) -> Result<(), MapError> {
    let oracle = Oracle::new(words);
    let mut soup = Soup::new(Labels::Numbered(oracle.of_dim(0).len()), false);
    // The oracle numbers the vertices from 0.
    for top in oracle.tops() {
        soup.push(&oracle.word(top).iter().map(|&vertex| u32::try_from(vertex).unwrap()).collect::<Vec<_>>());
    }
    let built = build(soup, &BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() }).unwrap();
    let bytes = Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap();
    let file = Loaded::from_file_bytes(bytes).unwrap();
    with_complex!(file.complex().unwrap(), complex => relations(&complex, &oracle))
}

fn relations<I: Index>(complex: &Complex<'_, I>, oracle: &Oracle) -> Result<(), MapError> {
    let map = CombinatorialMap::new(complex)?;
    let mut darts = Darts::new(&map);
    assert_structure_conforms(&mut darts, oracle);
    let n = map.dim();
    let expected = complex.num_simplices_of_dim(n) * darts_of_simplex(n).unwrap() * (2 * n + 1);
    assert_eq!(darts.storage().integers, expected);
    assert_eq!(darts.bytes(), 4 * (expected + complex.num_simplices()));
    Ok(())
}

#[test]
fn of_known_triangulations() {
    conforms(&known::seven_vertex_torus()).unwrap();
    conforms(&known::nine_vertex_complex_projective_plane()).unwrap();
    for dim in 2..5 {
        conforms(&known::cross_polytope(dim)).unwrap();
    }
    let plane = conforms(&known::six_vertex_projective_plane());
    assert!(matches!(plane, Err(MapError::NotOrientable { of_dim: 2, .. })));
}
