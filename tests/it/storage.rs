//! The formulas of sig-2004, 4.2 and 7.1 equal what is in the bytes, section by section, integers and bits.
//!
//! The bytes are counted here from the section table as `FORMAT.md` lays it out, not by the crate; κ and n_p come from
//! the oracle.

use proptest::prelude::*;
use sig_core::storage::Storage;
use sig_core::{AnyComplex, IndexWidth, with_complex};
use sig_tests::encode::{Options, encode, encode_file};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tests::strategies;

/// Counts of the section table by kind number, and bytes of the sections.
fn sections(bytes: &[u8]) -> Vec<(u16, usize, usize)> {
    let field = |at: usize, len: usize| {
        bytes[at..at + len].iter().rev().fold(0usize, |value, &byte| value << 8 | usize::from(byte))
    };
    (0..field(20, 4))
        .map(|entry| {
            let at = 48 + 24 * entry;
            let (element, count) = (bytes[at + 2], field(at + 16, 8));
            let bytes = match element {
                0 => count.div_ceil(8),
                1 => count,
                2 => 2 * count,
                3 | 5 => 4 * count,
                _ => 8 * count,
            };
            (u16::try_from(field(at, 2)).unwrap(), count, bytes)
        })
        .collect()
}

/// With lists at the (d−1)-simplices, and with pairs where these hold them.
fn check(oracle: &Oracle, options: &Options) {
    check_lists(oracle, options);
    if oracle.is_thin() && oracle.dims() > 1 {
        check_pairs(oracle, &Options { pairs: true, ..options.clone() });
    }
}

/// 7.4: two integers at each (d−1)-simplex, and 4.2 below.
fn check_pairs(oracle: &Oracle, options: &Options) {
    let bytes = encode(oracle, options);
    let table = sections(&bytes);
    let count =
        |kind: u16| table.iter().filter(|(other, ..)| *other == kind).map(|(_, count, _)| *count).sum::<usize>();
    let facets = oracle.of_dim(oracle.dims() - 2).len();
    let below: Vec<usize> = (0..oracle.len()).filter(|&simplex| oracle.dim(simplex) + 2 < oracle.dims()).collect();
    let clusters: usize = below.iter().map(|&simplex| oracle.clusters(simplex).len()).sum();
    let flagged = below.iter().filter(|&&simplex| oracle.is_single_cluster(simplex)).count();
    let lists = clusters + below.len() - 2 * flagged;
    assert_eq!((count(3), count(4), count(5), count(19)), (below.len(), lists, below.len(), 2 * facets));
    let integers = count(1) + count(2) + below.len() + lists + 2 * facets;
    with_complex!(AnyComplex::from_bytes(&bytes).unwrap(), complex => {
        let expected = Storage { integers, bits: below.len() };
        assert_eq!((complex.file_storage().sig(), complex.paper_storage().sig_pairs()), (expected, expected));
        assert_eq!(complex.file_storage().pairs, 2 * facets);
    });
}

fn check_lists(oracle: &Oracle, options: &Options) {
    let bytes = encode(oracle, options);
    let table = sections(&encode_file(oracle, options));
    let count =
        |kind: u16| table.iter().filter(|(other, ..)| *other == kind).map(|(_, count, _)| *count).sum::<usize>();
    let section_bytes =
        |kinds: &[u16]| table.iter().filter(|(kind, ..)| kinds.contains(kind)).map(|(.., bytes)| *bytes).sum::<usize>();

    // 4.2, term by term.
    let dims = oracle.dims();
    let below_top: Vec<usize> = (0..oracle.len()).filter(|&simplex| oracle.dim(simplex) + 1 < dims).collect();
    let faces: usize =
        (0..oracle.len()).map(|simplex| oracle.dim(simplex)).map(|dim| if dim > 0 { dim + 1 } else { 0 }).sum();
    let clusters: usize = below_top.iter().map(|&simplex| oracle.clusters(simplex).len()).sum();
    let flagged = below_top.iter().filter(|&&simplex| oracle.is_single_cluster(simplex)).count();
    let lists = clusters + below_top.len() - 2 * flagged;
    assert_eq!(count(1), dims, "lookup");
    assert_eq!(count(2), faces, "boundary");
    assert_eq!(count(3), below_top.len(), "pointers");
    assert_eq!(count(4), lists, "lists");
    assert_eq!(count(5), below_top.len(), "flags");

    let any = AnyComplex::from_bytes(&bytes).unwrap();
    with_complex!(any, complex => {
        let (paper, file) = (complex.paper_storage(), complex.file_storage());
        assert_eq!((file.lookup, file.boundary, file.pointers), (count(1), count(2), count(3)));
        assert_eq!((file.lists, file.flags), (count(4), count(5)));
        assert_eq!((paper.lookup, paper.boundary, paper.pointers, paper.lists), (dims, faces, below_top.len(), lists));
        assert_eq!(paper.visited_bits, oracle.len());
        assert_eq!(paper.sig(), file.sig());
        let general = dims + clusters + 2 * below_top.len() + faces;
        assert_eq!(paper.sig_general(), Storage { integers: general, bits: below_top.len() });
        assert_eq!(paper.incidence_graph(), Storage { integers: 2 * faces + below_top.len(), bits: 0 });

        assert_eq!(file.tree_bytes, section_bytes(&[6, 7, 17, 18]));
        assert_eq!(file.checksum_bytes, section_bytes(&[16]));
        assert_eq!(file.other_bytes, section_bytes(&(8..16).collect::<Vec<_>>()));
        assert_eq!(file.file_bytes, bytes.len());
        let all: usize = table.iter().map(|(.., bytes)| bytes).sum();
        assert_eq!(file.overhead_bytes, bytes.len() - all);

        for dim in 0..dims {
            let counts = complex.cluster_counts(dim);
            let around: Vec<_> = oracle.of_dim(dim).into_iter().flat_map(|simplex| oracle.clusters(simplex)).collect();
            for (g, &found) in counts.by_dim.iter().enumerate() {
                assert_eq!(found, around.iter().filter(|cluster| cluster.dim == g).count(), "κ({dim},{g})");
            }
            assert_eq!(counts.total(), around.len());
            let flags = oracle.of_dim(dim).into_iter().filter(|&simplex| oracle.is_single_cluster(simplex)).count();
            assert_eq!(counts.single_cluster, flags);
            assert_eq!(counts.tops, oracle.of_dim(dim).into_iter().filter(|&simplex| oracle.is_top(simplex)).count());
        }
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn of_random_complexes(simplices in strategies::simplices(), width in 0..3usize, everything: bool) {
        let (oracle, width) = (Oracle::new(&simplices), IndexWidth::ALL[width]);
        let options = if everything { Options::everything(&oracle, width) } else { Options::bare(width) };
        check(&oracle, &options);
    }
}

#[test]
fn of_the_empty_complex() {
    for width in IndexWidth::ALL {
        check(&Oracle::new::<[usize; 0]>(&[]), &Options::bare(width));
    }
}

/// The manifold case of 4.2: Σ_{p<d} n_p + κ + n_{d−1} integers for C*, κ = (d + 1) n_d, and no list below d − 1.
#[test]
fn of_manifolds() {
    for (simplices, dim) in [
        (known::sphere(2), 2),
        (known::sphere(3), 3),
        (known::cross_polytope(3), 3),
        (known::seven_vertex_torus(), 2),
        (known::six_vertex_projective_plane(), 2),
        (known::nine_vertex_complex_projective_plane(), 4),
    ] {
        let oracle = Oracle::new(&simplices);
        check(&oracle, &Options::bare(IndexWidth::Bits32));
        let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits32));
        let complex = sig_core::Complex::<u32>::from_bytes(&bytes).unwrap();
        let f = oracle.f_vector();
        let below: usize = f[..dim].iter().sum();
        let boundary: usize = (1..=dim).map(|p| (p + 1) * f[p]).sum();
        let manifold = below + (dim + 1) * f[dim] + f[dim - 1];
        assert_eq!(complex.paper_storage().sig(), Storage { integers: dim + 1 + boundary + manifold, bits: below });
    }
}

/// Header, table and padding of the paper's five arrays.
#[test]
fn at_most_a_kilobyte_of_header_and_padding() {
    for simplices in [vec![], vec![vec![0]], known::seven_vertex_torus(), known::nine_vertex_complex_projective_plane()]
    {
        for width in IndexWidth::ALL {
            let bytes = encode_file(&Oracle::new(&simplices), &Options::bare(width));
            let sections: usize = sections(&bytes).iter().map(|(.., bytes)| bytes).sum();
            assert!(bytes.len() - sections <= 1024, "{} bytes of header and padding", bytes.len() - sections);
        }
    }
}
