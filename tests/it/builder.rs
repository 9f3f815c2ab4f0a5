//! The builder, and Algorithms 1 to 3 from an incidence graph, against the oracle: the same arrays and the same bytes,
//! for any order of the input and any number of threads.

use proptest::prelude::*;
use sig_core::format::{Column, Container, SectionKind};
use sig_core::{AnyComplex, IndexWidth, VertexId, with_complex};
use sig_tests::encode::{Names, Options, encode, encode_file, in_host_order};
use sig_tests::known;
use sig_tests::oracle::{Oracle, Word};
use sig_tests::strategies;
use sig_tools::build::{Arrays, BuildOptions, Built, SigArrays, build};
use sig_tools::incidence_graph::IncidenceGraph;
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeError, EncodeOptions, Encoding};

/// The simplices as a reader would hand them on: vertex numbers by first appearance, labels in a table.
fn soup(simplices: &[Word]) -> Soup {
    let mut labels: Vec<u64> = Vec::new();
    let mut rows: Vec<Vec<u32>> = Vec::new();
    for simplex in simplices {
        let mut row = Vec::new();
        for &vertex in simplex {
            let number = labels.iter().position(|&label| label == vertex as u64).unwrap_or_else(|| {
                labels.push(vertex as u64);
                labels.len() - 1
            });
            row.push(u32::try_from(number).unwrap());
        }
        rows.push(row);
    }
    let mut soup = Soup::new(Labels::Integers(labels), false);
    rows.iter().for_each(|row| soup.push(row));
    soup
}

fn built(simplices: &[Word]) -> Built {
    build(soup(simplices), &BuildOptions::default()).unwrap()
}

/// Compares the builder's arrays with the sections of the oracle's file.
fn assert_arrays(arrays: &SigArrays<u64>, oracle: &Oracle) {
    let bytes = encode(oracle, &Options { tree: true, ..Options::bare(IndexWidth::Bits64) });
    let container = Container::from_bytes(&bytes).unwrap();
    let column = |kind| container.section(kind).unwrap().column;
    let lookup: Vec<u64> = arrays.first.iter().map(|&first| first as u64).collect();
    assert_eq!(Column::U64(&lookup), column(SectionKind::Lookup));
    assert_eq!(arrays.num_simplices, oracle.len());
    assert_eq!(Column::U64(&arrays.boundary), column(SectionKind::Boundary), "boundary");
    assert_eq!(Column::U64(&arrays.pointers), column(SectionKind::Pointers), "pointers");
    assert_eq!(Column::U64(&arrays.lists), column(SectionKind::Lists), "lists");
    assert_eq!(&arrays.flags[..], column(SectionKind::Flags).as_bytes(), "flags");
    assert_eq!(Column::U64(&arrays.child_offsets), column(SectionKind::ChildOffsets), "child offsets");
    let last: Vec<usize> = arrays.last_vertices.iter().map(|&last| last as usize).collect();
    let expected: Vec<usize> = oracle.words().iter().map(|word| *word.last().unwrap()).collect();
    assert_eq!(last, expected, "last vertices");
}

/// The whole file, at every width and the least one, is the oracle's byte for byte.
fn assert_file(built: &Built, oracle: &Oracle) {
    let labels: Vec<u64> = oracle.labels().iter().map(|&label| label as u64).collect();
    let numbered = labels.iter().copied().eq(0..labels.len() as u64);
    let names = if numbered { Names::Numbered } else { Names::Integers(labels) };
    let odd = built.parity.as_deref().expect("a mesh has orientations");
    let bit = |row: usize| odd[row / 8] >> (row % 8) & 1 == 1;
    let parity = oracle.tops().iter().any(|&top| oracle.dim(top) > 0);
    let parity = parity.then(|| (0..oracle.tops().len()).map(bit).collect());
    for width in [Some(IndexWidth::Bits16), Some(IndexWidth::Bits32), Some(IndexWidth::Bits64), None] {
        let extras = width != Some(IndexWidth::Bits32);
        let encode_options = EncodeOptions { width, tree: extras, checksums: extras, ..EncodeOptions::default() };
        let file = Encoding::new(built, &encode_options).unwrap().to_bytes().unwrap();
        let (names, parity) = (names.clone(), parity.clone());
        // From dimension 4 on.
        let lower = extras && oracle.dims() > 4;
        let options = Options { width, tree: extras, lower, checksums: extras, names, parity, ..Options::default() };
        assert!(file[..] == encode_file(oracle, &options)[..], "the file at width {width:?}");
        let file = Encoding::new(built, &EncodeOptions { pairs: true, ..encode_options });
        match file {
            Ok(file) => {
                let file = file.to_bytes().unwrap();
                assert!(
                    file[..] == encode_file(oracle, &Options { pairs: true, ..options })[..],
                    "pairs, width {width:?}"
                );
            }
            Err(EncodeError::Crowded { simplex, dim, cofaces }) => {
                assert_eq!((oracle.dim(simplex) + 1, oracle.coboundary(simplex, dim).len()), (dim, cofaces));
                let before = oracle.of_dim(dim - 1).into_iter().take_while(|&other| other < simplex);
                assert!(cofaces > 2 && before.into_iter().all(|other| oracle.coboundary(other, dim).len() <= 2));
            }
            Err(other) => panic!("{other}"),
        }
    }
}

fn assert_built(simplices: &[Word]) {
    let oracle = Oracle::new(simplices);
    let built = built(simplices);
    assert_arrays(&built.arrays.clone().into_wide(), &oracle);
    match &built.labels {
        Labels::Numbered(count) => assert!(oracle.labels().iter().copied().eq(0..*count)),
        Labels::Integers(labels) => {
            assert!(oracle.labels().iter().copied().eq(labels.iter().map(|&label| usize::try_from(label).unwrap())));
        }
        Labels::Tokens(_) => panic!("labels of integers became tokens"),
    }
    assert_eq!(built.report.listed, simplices.len());
    assert_eq!(built.report.top_simplices.iter().sum::<usize>(), oracle.tops().len());
    assert_parity(simplices, &oracle, built.parity.as_deref().expect("a soup orients its simplices"));
    assert_file(&built, &oracle);
    let graph = IncidenceGraph::new(&soup(simplices), &BuildOptions::default()).unwrap();
    assert_arrays(&graph.build_sig().into_wide(), &oracle);
}

/// 1 where the input lists the vertices of a top simplex in an odd permutation, counted by its inversions.
fn assert_parity(simplices: &[Word], oracle: &Oracle, parity: &[u8]) {
    for (row, top) in oracle.tops().into_iter().enumerate() {
        let own: Word = oracle.word(top).iter().map(|&vertex| oracle.labels()[vertex]).collect();
        let listed: Vec<bool> = simplices
            .iter()
            .filter(|simplex| {
                let mut sorted = simplex.to_vec();
                sorted.sort_unstable();
                sorted == own
            })
            .map(|simplex| {
                let pairs = (0..simplex.len()).flat_map(|right| (0..right).map(move |left| (left, right)));
                pairs.filter(|&(left, right)| simplex[left] > simplex[right]).count() % 2 == 1
            })
            .collect();
        let agreed = listed.iter().all(|&odd| odd == listed[0]) && listed[0];
        assert_eq!(parity[row / 8] >> (row % 8) & 1 == 1, agreed, "orientation of {own:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(160))]

    #[test]
    fn equals_the_oracle(simplices in strategies::simplices()) {
        assert_built(&simplices);
    }

    /// The same simplices in another order, each with its vertices in another even order: the same result, all of it.
    #[test]
    fn the_order_of_the_input_does_not_matter(
        simplices in strategies::simplices().prop_map(|mut words| { words.sort(); words.dedup(); words }),
        seed: u64,
    ) {
        let mut shuffled = simplices.clone();
        let mut state = seed | 1;
        for at in (1..shuffled.len()).rev() {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let other = usize::try_from(state >> 33).unwrap() % (at + 1);
            shuffled.swap(at, other);
        }
        for word in &mut shuffled {
            if word.len() > 2 {
                word[..3].rotate_left(1);
            }
        }
        let (one, other) = (built(&simplices), built(&shuffled));
        prop_assert_eq!(one, other);
    }
}

#[test]
fn known_triangulations() {
    for simplices in [
        known::sphere(4),
        known::cross_polytope(4),
        known::seven_vertex_torus(),
        known::six_vertex_projective_plane(),
        known::nine_vertex_complex_projective_plane(),
        vec![],
        vec![vec![5]],
        known::words("5 3 1 53"),
    ] {
        assert_built(&simplices);
    }
}

/// One, two and five threads give one result.
#[test]
fn the_number_of_threads_does_not_matter() {
    let simplices: Vec<Word> = known::nine_vertex_complex_projective_plane()
        .into_iter()
        .flat_map(|word| (0..6).map(move |shift| word.iter().map(|vertex| (vertex * 37 + shift * 5) % 41).collect()))
        .map(|mut word: Word| {
            word.sort_unstable();
            word.dedup();
            word
        })
        .collect();
    let with_threads = |count| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| built(&simplices))
    };
    let one = with_threads(1);
    assert_eq!(one, with_threads(2));
    assert_eq!(one, with_threads(5));
    assert_arrays(&one.arrays.into_wide(), &Oracle::new(&simplices));
}

/// The three largest ids that 16 bits hold, and one more.
#[test]
fn at_the_edge_of_sixteen_bits() {
    for count in [65_534u32, 65_535, 65_536] {
        let mut soup = Soup::new(Labels::Numbered(count as usize), true);
        (0..count).for_each(|vertex| soup.push(&[vertex]));
        let built = build(soup, &BuildOptions::default()).unwrap();
        let Arrays::Narrow(arrays) = &built.arrays else { panic!("32 bits are enough") };
        assert_eq!(arrays.num_simplices, count as usize);
        assert_eq!(arrays.child_offsets, [count]);
        let bytes = in_host_order(Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap());
        let any = AnyComplex::from_bytes(&bytes).unwrap();
        // 65,535 vertices have ids up to 65,534, which is all that 16 bits hold beside the stop code.
        assert_eq!(matches!(any, AnyComplex::Bits16(_)), count <= 65_535);
        with_complex!(any, complex => {
            assert_eq!(complex.num_vertices(), count as usize);
            assert_eq!(complex.validate(), Ok(()));
            let last = VertexId::new(count as usize - 1);
            assert_eq!(complex.find(&[last]), Some(last.into()));
            assert_eq!(complex.children(last.into()).len(), 0);
        });
    }
}
