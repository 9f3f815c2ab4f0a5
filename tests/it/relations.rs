//! Every relation equals its definition: random complexes, every simplex, every width, with and without the sections of
//! the simplex tree, on buffers that went through bytes.

use proptest::prelude::*;
use sig_core::{AnyComplex, AnyTree, IndexWidth, SimplexId, VertexId, with_complex, with_tree};
use sig_tests::conformance::{assert_agrees_with_the_paper, assert_conforms, assert_tree_conforms};
use sig_tests::encode::{Options, encode, encode_tree};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tests::strategies;
use sig_tools::build::{BuildOptions, build};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Loaded, OwnedScratch};

/// With lists at the (d−1)-simplices, and with pairs where these hold them.
fn check(oracle: &Oracle, width: IndexWidth, tree: bool) {
    for pairs in [false, true].into_iter().filter(|pairs| !pairs || oracle.is_thin()) {
        let bytes = encode(oracle, &Options { tree, lower: tree, pairs, ..Options::bare(width) });
        let any = AnyComplex::from_bytes(&bytes).unwrap();
        with_complex!(any, complex => {
            assert_eq!(complex.validate(), Ok(()));
            assert_eq!(complex.has_pairs(), pairs && oracle.dims() > 1);
            assert_conforms(&complex, oracle);
            assert_agrees_with_the_paper(&complex);
        });
    }
}

/// The same complex as a file of kind tree, with and without lower neighbours.
fn check_tree(oracle: &Oracle, width: IndexWidth, filtration: Option<&[f64]>) {
    for lower in [false, true] {
        let options = Options { lower, filtration: filtration.map(<[f64]>::to_vec), ..Options::bare(width) };
        let bytes = encode_tree(oracle, &options);
        let any = AnyTree::from_bytes(&bytes).unwrap();
        with_tree!(any, tree => {
            assert_eq!(tree.validate(), Ok(()));
            assert_eq!(tree.has_lower_neighbours(), lower);
            assert_tree_conforms(&tree, oracle);
        });
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn of_random_trees(simplices in strategies::simplices(), width in 0..3usize, salt: u32) {
        let oracle = Oracle::new(&simplices);
        // The greatest of some numbers of the vertices, so not less than those of faces, and often equal.
        let number = |&vertex: &usize| f64::from(u32::try_from(vertex).unwrap_or(0).wrapping_mul(salt | 1) % 5);
        let value = |word: &sig_tests::oracle::Word| word.iter().map(number).fold(0.0, f64::max);
        let values: Vec<f64> = oracle.words().iter().map(value).collect();
        check_tree(&oracle, IndexWidth::ALL[width], Some(&values));
    }

    #[test]
    fn of_random_complexes(simplices in strategies::simplices(), width in 0..3usize, tree: bool) {
        check(&Oracle::new(&simplices), IndexWidth::ALL[width], tree);
    }
}

#[test]
fn of_the_least_complexes_at_every_width() {
    let cases: [&[&[usize]]; 8] = [
        &[],
        &[&[0]],
        &[&[0], &[1], &[2]],
        &[&[0, 1]],
        &[&[0, 1], &[2]],
        &[&[0, 1, 2], &[2, 3], &[4]],
        &[&[0, 1, 2, 3], &[0, 1, 4], &[0, 2, 5]],
        &[&[0, 1, 2, 3, 4, 5, 6]],
    ];
    for simplices in cases {
        let oracle = Oracle::new(simplices);
        for width in IndexWidth::ALL {
            check(&oracle, width, false);
            check_tree(&oracle, width, None);
            check(&oracle, width, true);
        }
    }
}

/// A complex of vertices alone takes no byte a simplex: n is not bounded by the length of the file.
#[test]
fn of_many_isolated_vertices() {
    let oracle = Oracle::new(&(0..3000).map(|vertex| [vertex]).collect::<Vec<_>>());
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    assert!(bytes.len() < 1000);
    let complex = sig_core::Complex::<u16>::from_bytes(&bytes).unwrap();
    assert_eq!((complex.num_vertices(), complex.dim()), (3000, Some(0)));
    assert_eq!(complex.validate(), Ok(()));
    assert!(complex.simplices().all(|vertex| complex.is_top(vertex)));
}

/// Triangles on one edge: each query takes time linear in its answer. With n² steps this test would not end.
#[test]
fn of_a_book_of_many_pages() {
    const PAGES: u32 = 200_000;
    let mut soup = Soup::new(Labels::Numbered(PAGES as usize + 2), true);
    for page in 2..PAGES + 2 {
        soup.push(&[0, 1, page]);
    }
    let built = build(soup, &BuildOptions::default()).unwrap();
    let file = Loaded::from_file_bytes(Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap());
    let file = file.unwrap();
    let AnyComplex::Bits32(complex) = file.complex().unwrap() else { panic!("32 bits") };
    let pages = PAGES as usize;
    let mut memory = OwnedScratch::new(&complex);
    let mut scratch = memory.scratch();
    let (vertex, spine) = (SimplexId::new(0), complex.find(&[VertexId::new(0), VertexId::new(1)]).unwrap());
    assert_eq!(complex.coboundary(vertex, 2, &mut scratch).unwrap().len(), pages);
    assert_eq!(complex.coboundary(vertex, 1, &mut scratch).unwrap().len(), pages + 1);
    assert_eq!(complex.star(vertex, &mut scratch).unwrap().len(), 2 * pages + 2);
    assert_eq!(complex.link(vertex, &mut scratch).unwrap().len(), 2 * pages + 1);
    assert_eq!(complex.coboundary(spine, 2, &mut scratch).unwrap().len(), pages);
    assert_eq!(complex.link(spine, &mut scratch).unwrap().len(), pages);
    assert_eq!(complex.clusters(spine).count(), pages);
}

/// Facets with three and more top simplices, which gathering marks, in clusters of several dimensions at once.
#[test]
fn of_crowded_facets_below_other_clusters() {
    let books = "0123 0124 0125 0126 017 018 019 016 028 029 027 0178 0179";
    let oracle = Oracle::new(&known::words(books));
    for width in IndexWidth::ALL {
        check(&oracle, width, true);
    }
}
