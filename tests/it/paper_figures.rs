//! The complexes of Figures 1 and 2 of sig-2004, and others whose relations and sizes were worked out by hand.
//!
//! Words are written as digits, as the figures would be labelled. The numbers of integers are those of 4.2 without the
//! d + 1 of the lookup table, which the comparisons of section 7 leave out too.

use sig_core::{Complex, IndexWidth, SimplexId, VertexId};
use sig_tests::conformance::{Memory, assert_conforms};
use sig_tests::encode::{Options, encode};
use sig_tests::known::{seven_vertex_torus, words};
use sig_tests::oracle::Oracle;
use sig_tools::store::AlignedBytes;

fn file(simplices: &str) -> AlignedBytes {
    let oracle = Oracle::new(&words(simplices));
    let bytes = encode(&oracle, &Options { tree: true, ..Options::bare(IndexWidth::Bits16) });
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    assert_eq!(complex.validate(), Ok(()));
    assert_conforms(&complex, &oracle);
    bytes
}

fn id(complex: &Complex<'_, u16>, digits: &str) -> SimplexId {
    let vertices: Vec<VertexId> = words(digits).concat().into_iter().map(VertexId::new).collect();
    complex.find(&vertices).unwrap_or_else(|| panic!("no simplex {digits}"))
}

fn digits(complex: &Complex<'_, u16>, simplex: SimplexId) -> String {
    complex.vertices(simplex).map(|vertex| vertex.to_string()).collect()
}

/// C*_{p,g}(σ) for one g, as digits.
fn partial(complex: &Complex<'_, u16>, simplex: &str, g: usize) -> Vec<String> {
    let entries = complex.partial_coboundary_of_dim(id(complex, simplex), g);
    entries.map(|entry| digits(complex, entry)).collect()
}

/// Integers of the general formula and of the file, without the lookup table.
fn integers(complex: &Complex<'_, u16>) -> (usize, usize) {
    let paper = complex.paper_storage();
    assert_eq!(paper.sig(), complex.file_storage().sig());
    (paper.sig_general().integers - paper.lookup, paper.sig().integers - paper.lookup)
}

#[test]
fn figure_1_a() {
    let bytes = file("012 023 045 056 07");
    let complex = Complex::from_bytes(&bytes).unwrap();
    assert_eq!(partial(&complex, "0", 1), ["07"]);
    assert_eq!(partial(&complex, "0", 2), ["012", "045"]);
    assert_eq!(integers(&complex), (94, 82));
    assert_eq!(complex.paper_storage().incidence_graph().integers, 87);
    let tops: Vec<String> =
        complex.simplices().filter(|&top| complex.is_top(top)).map(|top| digits(&complex, top)).collect();
    assert_eq!(tops, ["07", "012", "023", "045", "056"]);
}

/// Figure 1(b): triangles f1 and f2 at an edge e. The caption's C*_{0,1}(e) is meant to be C*_{1,2}(e).
#[test]
fn figure_1_b() {
    let bytes = file("012 013");
    let complex = Complex::from_bytes(&bytes).unwrap();
    assert_eq!(partial(&complex, "01", 2), ["012", "013"]);
}

/// Figure 2(a): tetrahedra t1 apart, t2 and t3 on a common triangle at v, triangles df1 and df2 on a common edge at v, an
/// edge we.
#[test]
fn figure_2_a() {
    let bytes = file("0123 0145 0156 027 078 09");
    let complex = Complex::from_bytes(&bytes).unwrap();
    assert_eq!(partial(&complex, "0", 3), ["0123", "0145"]);
    assert_eq!(partial(&complex, "0", 2), ["027"]);
    assert_eq!(partial(&complex, "0", 1), ["09"]);

    // st(v): we; df1, df2 and their edges at v; t1, t2, t3 with their triangles and edges at v.
    let mut memory = Memory::<u16>::roomy(complex.num_simplices());
    let mut scratch = memory.scratch();
    let mut star: Vec<String> = complex
        .restricted_star(id(&complex, "0"), &mut scratch)
        .unwrap()
        .map(|coface| digits(&complex, coface))
        .collect();
    star.sort();
    let expected = "01 012 0123 013 014 0145 015 0156 016 02 023 027 03 04 045 05 056 06 07 078 08 09";
    assert_eq!(star.join(" "), expected);
}

/// Figure 2(b): the same kinds of simplices around an edge e; df1 and df2 are two clusters there, for they share only e.
#[test]
fn figure_2_b() {
    let bytes = file("0123 0145 0156 017 018");
    let complex = Complex::from_bytes(&bytes).unwrap();
    assert_eq!(partial(&complex, "01", 3), ["0123", "0145"]);
    assert_eq!(partial(&complex, "01", 2), ["017", "018"]);
    let ends: Vec<String> = complex.facets(id(&complex, "01")).map(|end| digits(&complex, end)).collect();
    assert_eq!(ends, ["1", "0"], "B(e) omits the first vertex first");
    // At the vertex 0 the two triangles share the edge 01, so they are one cluster.
    assert_eq!(partial(&complex, "0", 2), ["017"]);
    assert_eq!(integers(&complex), (213, 177));
}

/// A tetrahedron between two dangling triangles does not join them.
#[test]
fn a_tetrahedron_joins_no_triangles() {
    let bytes = file("0123 014 025");
    let complex = Complex::from_bytes(&bytes).unwrap();
    let all: Vec<String> = complex.partial_coboundary(id(&complex, "0")).map(|entry| digits(&complex, entry)).collect();
    assert_eq!(all, ["0123", "014", "025"]);
}

#[test]
fn two_tetrahedra_at_a_vertex() {
    let bytes = file("0123 0456");
    assert_eq!(integers(&Complex::from_bytes(&bytes).unwrap()), (138, 102));
}

/// The flag says one cluster of d-simplices, not that the complex is a manifold: the apex of a cone on a torus has it.
#[test]
fn cone_on_the_seven_vertex_torus() {
    let cone: Vec<Vec<usize>> = seven_vertex_torus().iter().map(|triangle| [&triangle[..], &[7]].concat()).collect();
    let oracle = Oracle::new(&cone);
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    assert_eq!(oracle.f_vector(), [8, 28, 35, 14]);
    assert_eq!(complex.simplices().filter(|&simplex| complex.is_single_cluster(simplex)).count(), 36);
    assert!(complex.is_single_cluster(SimplexId::new(7)), "the apex");
    assert_eq!(integers(&complex).1, 379);
}

/// The conjecture of section 7.1, that no more top q-simplices than (p + 1)-simplices are incident at a p-simplex, is
/// false for clusters too: 12 lines on 9 points.
#[test]
fn cone_on_the_affine_plane_of_order_three() {
    let lines = words("012 345 678 036 147 258 048 156 237 057 138 246");
    let cone: Vec<Vec<usize>> = lines.iter().map(|line| [&line[..], &[9]].concat()).collect();
    let bytes = encode(&Oracle::new(&cone), &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let apex = SimplexId::new(9);
    assert_eq!(complex.partial_coboundary_of_dim(apex, 3).count(), 12);
    let mut memory = Memory::<u16>::roomy(complex.num_simplices());
    assert_eq!(complex.coboundary(apex, 1, &mut memory.scratch()).unwrap().len(), 9);
}
