//! Every relation equals its definition: random complexes, every simplex, every width, with and without the sections of
//! the simplex tree, on buffers that went through bytes.

use proptest::prelude::*;
use sig_core::{AnyComplex, IndexWidth, with_complex};
use sig_tests::conformance::{assert_agrees_with_the_paper, assert_conforms};
use sig_tests::encode::{Options, encode};
use sig_tests::oracle::Oracle;
use sig_tests::strategies;

fn check(oracle: &Oracle, width: IndexWidth, tree: bool) {
    let bytes = encode(oracle, &Options { tree, ..Options::bare(width) });
    let any = AnyComplex::from_bytes(&bytes).unwrap();
    with_complex!(any, complex => {
        assert_eq!(complex.validate(), Ok(()));
        assert_conforms(&complex, oracle);
        assert_agrees_with_the_paper(&complex);
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

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
