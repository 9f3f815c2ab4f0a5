//! The structures that the SIG is compared with: every relation equals its definition, what is stored equals the paper's
//! formula, what cannot be stored is refused by name, and what is stored gives the same file again.

use std::path::Path;

use proptest::prelude::*;
use sig_core::storage::Storage;
use sig_core::{AnyComplex, VertexId, with_complex};
use sig_tests::conformance::assert_structure_conforms;
use sig_tests::known;
use sig_tests::oracle::{Oracle, Word};
use sig_tests::strategies;
use sig_tools::baselines::conjecture::{Violation, violations};
use sig_tools::baselines::formulas::Numbers;
use sig_tools::baselines::{
    IndexedAdjacencies, NonManifoldIndexed, Refusal, Session, Sig, Structure, Tops, TriangleSegment,
};
use sig_tools::build::{BuildOptions, Built, VertexOrder, build};
use sig_tools::compare::{CompareOptions, compare};
use sig_tools::incidence_graph::{IncidenceGraph, Walk};
use sig_tools::io::{ReadOptions, read_path};
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};
use sig_tools::store::verify::rebuild;
use sig_tools::store::{EncodeError, EncodeOptions, Encoding};
use sig_tools::{Loaded, OwnedScratch};

/// A complex in a file, with the number of every structure that holds it.
struct Case {
    built: Built,
    file: Loaded,
    tops: Tops,
    numbers: Numbers,
}

impl Case {
    fn of_soup(soup: Soup) -> Self {
        let built = build(soup, &BuildOptions::default()).unwrap();
        let bytes = Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap();
        let file = Loaded::from_file_bytes(bytes).unwrap();
        let (tops, numbers) = with_complex!(file.complex().unwrap(), complex => {
            (Tops::of(&complex), Numbers::of(&complex))
        });
        Self { built, file, tops, numbers }
    }

    fn of_words(simplices: &[Word]) -> Self {
        let mut soup = Soup::new(Labels::Numbered(1 + simplices.iter().flatten().max().copied().unwrap_or(0)), false);
        for word in simplices {
            soup.push(&word.iter().map(|&vertex| u32::try_from(vertex).unwrap()).collect::<Vec<_>>());
        }
        Self::of_soup(soup)
    }

    fn of_file(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name);
        let options = ReadOptions { drop_degenerate: true, ..ReadOptions::default() };
        Self::of_soup(read_path(path, &options).unwrap().0)
    }

    fn oracle(&self) -> Oracle {
        with_complex!(self.file.complex().unwrap(), complex => {
            let words: Vec<Word> =
                complex.simplices().map(|id| complex.vertices(id).map(VertexId::index).collect()).collect();
            Oracle::new(&words)
        })
    }

    /// Checks that a list of top simplices gives the same file, but for labels and coordinates, which no structure holds,
    /// and for orientations where `oriented` is false.
    fn assert_restored(&self, soup: Soup, oriented: bool) {
        let options = BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() };
        let again = build(soup, &options).unwrap();
        let (labels, coordinates) = (self.built.labels.clone(), self.built.coordinates.clone());
        let parity = if oriented { again.parity } else { self.built.parity.clone() };
        let again = Built { labels, coordinates, parity, ..again };
        let bytes = Encoding::new(&again, &EncodeOptions::default()).unwrap().to_bytes().unwrap();
        assert_eq!(*bytes, *self.file.file_bytes());
    }

    /// What each structure holds equals the formula; it gives the file back; its relations are right if there is an
    /// oracle. Returns the names of those that hold the complex.
    fn check(&self, oracle: Option<&Oracle>) -> Vec<&'static str> {
        let mut holding = vec!["SIG", "IG"];
        with_complex!(self.file.complex().unwrap(), complex => {
            let mut memory = OwnedScratch::new(&complex);
            let sig = Sig::new(complex, &mut memory);
            assert_eq!(self.numbers.sig().storage(), sig.storage());
            check(sig, self.numbers.sig().storage(), oracle);
        });
        match Encoding::new(&self.built, &EncodeOptions { pairs: true, ..EncodeOptions::default() }) {
            Ok(encoding) => {
                let file = Loaded::from_file_bytes(encoding.to_bytes().unwrap()).unwrap();
                with_complex!(file.complex().unwrap(), complex => {
                    assert_eq!(complex.validate(), Ok(()));
                    assert_eq!(rebuild(&complex, &BuildOptions::default()), Ok(()));
                    let mut memory = OwnedScratch::new(&complex);
                    check(Sig::new(complex, &mut memory), self.numbers.sig_pairs().storage(), oracle);
                });
                holding.insert(1, "pairs");
            }
            Err(error) => assert!(matches!(error, EncodeError::Crowded { .. }), "{error}"),
        }
        let graph = IncidenceGraph::<u32>::of_tops(&self.tops).unwrap();
        check(Walk::new(&graph), self.numbers.incidence_graph().storage(), oracle);
        self.assert_restored(graph.to_soup(), false);
        if let Ok(indexed) = IndexedAdjacencies::<u32>::new(&self.tops) {
            check(Session::new(&indexed), self.numbers.indexed().storage(), oracle);
            self.assert_restored(indexed.to_soup(), true);
            holding.push("IA");
        }
        if let Ok(triangles) = TriangleSegment::<u32>::new(&self.tops) {
            check(Session::new(&triangles), self.numbers.triangle_segment().storage(), oracle);
            self.assert_restored(triangles.to_soup(), self.tops.count(1) == 0);
            holding.push("TS");
        }
        if let Ok(indexed) = NonManifoldIndexed::<u32>::new(&self.tops) {
            check(Session::new(&indexed), self.numbers.non_manifold_indexed().storage(), oracle);
            self.assert_restored(indexed.to_soup(), true);
            holding.push("NMIA");
        }
        holding
    }
}

fn check<S: Structure>(mut structure: S, formula: Storage, oracle: Option<&Oracle>) {
    assert_eq!(structure.storage(), formula);
    if let Some(oracle) = oracle {
        assert_structure_conforms(&mut structure, oracle);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn of_random_complexes(simplices in strategies::simplices()) {
        let case = Case::of_words(&simplices);
        let oracle = case.oracle();
        let holding = case.check(Some(&oracle));
        let dims = oracle.dims();
        prop_assert_eq!(holding.contains(&"TS"), dims <= 3);
        prop_assert_eq!(holding.contains(&"NMIA"), dims <= 4);
        let regular = oracle.tops().iter().all(|&top| oracle.dim(top) + 1 == dims);
        prop_assert_eq!(holding.contains(&"pairs"), oracle.is_thin());
        let thin = if dims == 1 { oracle.len() <= 2 } else { oracle.is_thin() };
        prop_assert_eq!(holding.contains(&"IA"), regular && thin);
    }

    /// Pseudo-manifolds of any dimension, for IA: parts of the boundary of a cross-polytope, glued where they meet.
    #[test]
    fn of_random_pseudo_manifolds(dim in 1..6_usize, kept: u64) {
        let all = known::cross_polytope(dim);
        let some: Vec<Word> = all.into_iter().enumerate().filter(|(at, _)| kept >> at & 1 == 1).map(|(_, word)| word).collect();
        let case = Case::of_words(&some);
        let holding = case.check(Some(&case.oracle()));
        prop_assert!(holding.contains(&"IA"));
    }
}

/// Six triangles on one edge, and tetrahedra on another, with coordinates in no order around it.
fn fan(angles: &[f64], tetrahedra: bool) -> Soup {
    let mut soup = Soup::new(Labels::Numbered(angles.len() + 2), true);
    let mut values = vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    for (vertex, angle) in (2..).zip(angles) {
        values.extend([angle.cos(), angle.sin(), 0.5]);
        if tetrahedra && vertex % 2 == 1 {
            soup.push(&[0, 1, vertex - 1, vertex]);
        } else if !tetrahedra {
            soup.push(&[0, 1, vertex]);
        }
    }
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F64(values) });
    soup
}

/// Around an edge, the next one is next in angle.
#[test]
fn neighbours_around_an_edge_are_in_the_order_of_the_angles() {
    let angles = [5.0, 1.0, 3.0, 0.5, 4.0, 2.0];
    let built =
        build(fan(&angles, false), &BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() }).unwrap();
    let bytes = Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap();
    let file = Loaded::from_file_bytes(bytes).unwrap();
    let AnyComplex::Bits16(complex) = file.complex().unwrap() else { panic!("a small complex") };
    let triangles = TriangleSegment::<u16>::new(&Tops::of(&complex)).unwrap();
    // The triangles at the spine, from that of the first vertex on, by the vertex opposite to it.
    let mut session = Session::new(&triangles);
    let spine = session.find(&[VertexId::new(0), VertexId::new(1)]).unwrap();
    let (mut around, mut word) = (Vec::new(), Vec::new());
    session.coboundary(spine, 2, &mut around);
    let mut order: Vec<usize> = around
        .iter()
        .map(|&triangle| {
            session.vertices(triangle, &mut word);
            word[2].index() - 2
        })
        .collect();
    let first = order.iter().position(|&vertex| vertex == 3).unwrap();
    order.rotate_left(first);
    // By increasing angle: 0.5, 1, 2, 3, 4, 5.
    assert_eq!(order, [3, 1, 5, 2, 4, 0]);
    for tetrahedra in [false, true] {
        let case = Case::of_soup(fan(&angles, tetrahedra));
        case.check(Some(&case.oracle()));
    }
}

#[test]
fn of_the_least_complexes_and_known_ones() {
    let cases: [(Vec<Word>, &[&str]); 12] = [
        (vec![], &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        (known::words("0"), &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        (known::words("0 1"), &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        (known::words("0 1 2"), &["SIG", "pairs", "IG", "TS", "NMIA"]),
        (known::words("01"), &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        (known::words("01 02 03"), &["SIG", "IG", "TS", "NMIA"]),
        (known::words("012 013 014 25 26 127"), &["SIG", "IG", "TS", "NMIA"]),
        (known::words("0123 0145 0156 017 018"), &["SIG", "pairs", "IG", "NMIA"]),
        (known::words("0123 0124 0125 06"), &["SIG", "IG", "NMIA"]),
        (known::seven_vertex_torus(), &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        (known::six_vertex_projective_plane(), &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        (known::nine_vertex_complex_projective_plane(), &["SIG", "pairs", "IG", "IA"]),
    ];
    for (simplices, expected) in cases {
        let case = Case::of_words(&simplices);
        assert_eq!(case.check(Some(&case.oracle())), expected, "{simplices:?}");
    }
}

/// Pinched vertices, wire edges and dangling faces beside tetrahedra, whole manifolds: formulas and restored files; which
/// structures hold them follows from the kinds in `tests/data/README.md`.
#[test]
fn of_real_files() {
    let cases: [(&str, &[&str]); 10] = [
        ("bow.off", &["SIG", "pairs", "IG", "TS", "NMIA"]),
        ("trimesh_angle_block.STL", &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        ("trimesh_octagonal_pocket.ply", &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        ("dunce_hat", &["SIG", "IG", "TS", "NMIA"]),
        ("goathead.obj", &["SIG", "pairs", "IG", "IA", "TS", "NMIA"]),
        ("gmsh_mixed_bracket_h0.9.msh", &["SIG", "pairs", "IG", "NMIA"]),
        ("bing", &["SIG", "pairs", "IG", "IA", "NMIA"]),
        ("torus.msh", &["SIG", "pairs", "IG", "IA", "NMIA"]),
        ("K3_16", &["SIG", "pairs", "IG", "IA"]),
        ("RP5_24", &["SIG", "pairs", "IG", "IA"]),
    ];
    for (name, expected) in cases {
        let case = Case::of_file(name);
        assert_eq!(case.check(None), expected, "{name}");
        // The oracle looks at all simplices for each; instead, all answers are as long as those of the SIG.
        let options = CompareOptions { samples: 400, seconds: 60.0 };
        let comparison = compare(&case.tops, options).unwrap();
        let holding: Vec<&str> =
            comparison.structures.iter().filter(|row| row.refused.is_none()).map(|row| row.name).collect();
        // Of the ten, these are closed orientable manifolds; `combinatorial_map` tests what their maps answer.
        let map = ["goathead.obj", "K3_16", "RP5_24"].contains(&name).then_some("map");
        let expected = expected.iter().map(|&name| if name == "pairs" { "SIG pairs" } else { name }).chain(map);
        assert_eq!(holding, expected.collect::<Vec<_>>(), "{name}");
        for row in comparison.structures.iter().filter(|row| row.refused.is_none()) {
            assert_eq!((row.integers, row.bits), (row.formula_integers, row.formula_bits), "{name}: {}", row.name);
            assert!(!row.relations.is_empty());
        }
    }
}

/// The known answers of the paper's figures, and of the cases that tell components from clusters.
#[test]
fn of_the_papers_figures() {
    let figure = Case::of_words(&known::words("012 023 045 056 07"));
    assert_eq!(figure.numbers.incidence_graph().storage().integers, 87);
    // 82 of the relations, and the lookup table.
    assert_eq!(figure.numbers.sig().storage().integers, 82 + 3);
    // n_0 = 8, n_2 = 4; vertex 0 has one wire edge and two clusters, 7 the edge, the six others a cluster each.
    assert_eq!(figure.numbers.triangle_segment().storage(), Storage { integers: 8 + 36 + 2 + 8, bits: 12 });
    // 7.4: without the list of each edge, pointer and stop code, and with two integers in place of it.
    let edges = 12 + 2 * 11;
    assert_eq!(figure.numbers.sig_pairs().storage().integers, 85 - edges + 2 * 11);
    let mixed = Case::of_words(&known::words("0123 014 025"));
    // Three clusters at 0, in one component, which the edges 01 and 02 hold together.
    assert_eq!(mixed.numbers.components, 6);
    assert_eq!(mixed.numbers.non_manifold_indexed().storage().integers, 6 + 2 * 9 + 16 + 6);
    let two = Case::of_words(&known::words("0123 0456"));
    assert_eq!(two.numbers.components, 8);
    assert_eq!(two.numbers.non_manifold_indexed().storage().integers, 7 + 2 * 16 + 8);
}

/// The cone over the affine plane of order 3: its apex has twelve clusters and nine edges.
#[test]
fn the_conjecture_of_the_paper_fails_at_the_cone_over_the_affine_plane() {
    let lines: Vec<Word> = known::words("012 345 678 036 147 258 048 156 237 057 138 246");
    let cone: Vec<Word> = lines.iter().map(|line| [&line[..], &[9]].concat()).collect();
    let case = Case::of_words(&cone);
    let found = with_complex!(case.file.complex().unwrap(), complex => violations(&complex, &case.tops));
    let apex = Violation { p: 0, q: 3, simplex: "9".to_owned(), clusters: 12, cofaces: 9, simplices: 1 };
    assert_eq!(found, [apex]);
    let torus = Case::of_words(&known::seven_vertex_torus());
    let found = with_complex!(torus.file.complex().unwrap(), complex => violations(&complex, &torus.tops));
    assert_eq!(found, []);
}

/// What a structure has no room for is named by the labels of the file, the first in canonical order.
#[test]
fn refusals_name_the_first_simplex() {
    let named = |simplices: &str| {
        let mut soup =
            Soup::new(Labels::Tokens("abcdefgh".chars().map(|label| label.to_string().into()).collect()), false);
        for word in known::words(simplices) {
            soup.push(&word.iter().map(|&vertex| u32::try_from(vertex).unwrap()).collect::<Vec<_>>());
        }
        Case::of_soup(soup).tops
    };
    let solid = named("123 4567 0245 06");
    let refusal = TriangleSegment::<u32>::new(&solid).unwrap_err();
    assert_eq!(refusal, Refusal::Dimension { simplex: "a,c,e,f".to_owned(), dim: 3, most: 2 });
    let refusal = IndexedAdjacencies::<u32>::new(&solid).unwrap_err();
    assert_eq!(refusal, Refusal::NotRegular { simplex: "a,g".to_owned(), dim: 1, of: 3 });
    let refusal = NonManifoldIndexed::<u32>::new(&named("01234 123567")).unwrap_err();
    assert_eq!(refusal, Refusal::Dimension { simplex: "a,b,c,d,e".to_owned(), dim: 4, most: 3 });
    let refusal = IndexedAdjacencies::<u32>::new(&named("124 125 126 123 034")).unwrap_err();
    assert_eq!(refusal, Refusal::Crowded { simplex: "b,c".to_owned(), dim: 2, cofaces: 4 });
    let refusal = IndexedAdjacencies::<u32>::new(&named("0 1 2")).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "simplex ∅ is a face of 3 simplices of dimension 0, and the structure has room for two"
    );
}
