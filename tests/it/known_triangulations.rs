//! Real files and triangulations from the literature: f-vectors, Euler characteristics and what is known of their kind.
//!
//! The numbers are those of the files' own headers (Library of Triangulations), of the publications that [`known`]
//! names, and of the table in `tests/data/README.md`, which other programs established.

use std::path::Path;

use sig_core::AnyComplex;
use sig_core::format::SectionKind;
use sig_core::{Complex, SimplexId, with_complex};
use sig_tests::conformance::{Memory, assert_conforms, sorted};
use sig_tests::encode::{Options, encode};
use sig_tests::known;
use sig_tests::oracle::{Oracle, Word};
use sig_tools::build::{BuildOptions, SigArrays, build};
use sig_tools::io::{ReadOptions, read_path};

fn fixture(name: &str) -> SigArrays<u64> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name);
    let options = ReadOptions { drop_degenerate: true, ..ReadOptions::default() };
    let (soup, _) = read_path(path, &options).unwrap();
    build(soup, &BuildOptions::default()).unwrap().arrays.into_wide()
}

fn f_vector(arrays: &SigArrays<u64>) -> Vec<usize> {
    (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect()
}

#[test]
fn of_the_fixtures() {
    let table: [(&str, &[usize], i64); 15] = [
        ("goathead.obj", &[2763, 8283, 5522], 2),
        ("spot_control_mesh.obj", &[188, 558, 372], 2),
        ("torus.msh", &[200, 891, 1182, 491], 0),
        ("gmsh-3d-binary-64.msh", &[131, 614, 848, 364], 1),
        ("gmsh_mixed_bracket_h0.9.msh", &[587, 2434, 3038, 1199], -8),
        ("hybrid_3d_cube.msh", &[91, 452, 659, 297], 1),
        ("trimesh_angle_block.STL", &[398, 1139, 704], -37),
        ("trimesh_octagonal_pocket.ply", &[1658, 4920, 3262], 0),
        ("bing", &[480, 2511, 3586, 1554], 1),
        ("poincare", &[16, 106, 180, 90], 0),
        ("two_optima", &[106, 596, 1064, 573], 1),
        ("K3_16", &[16, 120, 560, 720, 288], 24),
        ("RP5_24", &[24, 273, 1174, 2277, 2028, 676], 0),
        ("dunce_hat", &[8, 24, 17], 1),
        ("hyperbolic_dodecahedral_space", &[21, 190, 338, 169], 0),
    ];
    for (name, f, euler) in table {
        let arrays = fixture(name);
        assert_eq!(f_vector(&arrays), f, "{name}");
        let alternating: i64 =
            f.iter().enumerate().map(|(dim, &count)| if dim % 2 == 0 { count as i64 } else { -(count as i64) }).sum();
        assert_eq!(alternating, euler, "{name}");
    }
}

/// Closed manifolds: no simplex has more than one cluster, each (d−1)-simplex two cofacets, and nothing dangles.
#[test]
fn of_manifolds_every_simplex_is_flagged() {
    for name in ["poincare", "K3_16", "RP5_24", "hyperbolic_dodecahedral_space"] {
        let arrays = fixture(name);
        let f = f_vector(&arrays);
        let d = f.len() - 1;
        let flagged: u32 = arrays.flags.iter().map(|byte| byte.count_ones()).sum();
        assert_eq!(flagged as usize, f[..d - 1].iter().sum::<usize>(), "{name}");
        // κ_{d−1}^d = (d + 1) n_d, and twice n_{d−1} in a closed pseudo-manifold; and a stop code each.
        assert_eq!(arrays.lists.len(), (d + 1) * f[d] + f[d - 1], "{name}");
        assert_eq!((d + 1) * f[d], 2 * f[d - 1], "{name}");
    }
}

/// Maximal simplices of each dimension of the mixed mesh: 49 edges, 189 triangles, 1199 tetrahedra.
#[test]
fn of_the_mixed_mesh_the_maximal_simplices() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join("gmsh_mixed_bracket_h0.9.msh");
    let (soup, _) = read_path(path, &ReadOptions::default()).unwrap();
    let built = build(soup, &BuildOptions::default()).unwrap();
    assert_eq!(built.report.top_simplices, [0, 49, 189, 1199]);
}

fn check(simplices: &[Word], f: &[usize], euler: i64) -> Oracle {
    let oracle = Oracle::new(simplices);
    assert_eq!(oracle.f_vector(), f);
    assert_eq!(oracle.euler_characteristic(), euler);
    let bytes = encode(&oracle, &Options { tree: true, checksums: true, ..Options::default() });
    let any = AnyComplex::from_bytes(&bytes).unwrap();
    with_complex!(any, complex => {
        assert_eq!(complex.validate(), Ok(()));
        assert_conforms(&complex, &oracle);
        assert!(complex.container().section(SectionKind::Checksums).is_some());
    });
    oracle
}

#[test]
fn spheres() {
    // The boundary of the (d + 1)-simplex has all proper faces of it, the cross-polytope one vertex of each antipodal pair.
    check(&known::sphere(0), &[2], 2);
    check(&known::sphere(1), &[3, 3], 0);
    check(&known::sphere(2), &[4, 6, 4], 2);
    check(&known::sphere(4), &[6, 15, 20, 15, 6], 2);
    check(&known::cross_polytope(2), &[6, 12, 8], 2);
    check(&known::cross_polytope(3), &[8, 24, 32, 16], 0);
    check(&known::cross_polytope(4), &[10, 40, 80, 80, 32], 2);
}

#[test]
fn surfaces() {
    let torus = check(&known::seven_vertex_torus(), &[7, 21, 14], 0);
    let plane = check(&known::six_vertex_projective_plane(), &[6, 15, 10], 1);
    for (oracle, neighbours) in [(torus, 6), (plane, 5)] {
        // Both are neighbourly: every two vertices are adjacent, and the link of a vertex is a circle of all others.
        let bytes = encode(&oracle, &Options::bare(sig_core::IndexWidth::Bits16));
        let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
        let mut memory = Memory::<u16>::roomy(oracle.len());
        for vertex in complex.simplices_of_dim(0) {
            assert_eq!(complex.adjacency(vertex, &mut memory.scratch()).unwrap().len(), neighbours);
            let link: Vec<SimplexId> = complex.link(vertex, &mut memory.scratch()).unwrap().collect();
            let edges = link.iter().filter(|&&face| complex.dim_of(face) == Some(1)).count();
            assert_eq!((link.len() - edges, edges), (neighbours, neighbours));
        }
    }
}

#[test]
fn complex_projective_plane() {
    let oracle = check(&known::nine_vertex_complex_projective_plane(), &[9, 36, 84, 90, 36], 3);
    // Three-neighbourly: every three vertices span a triangle; the link of a vertex is a 3-sphere on the eight others.
    let bytes = encode(&oracle, &Options::bare(sig_core::IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let mut memory = Memory::<u16>::roomy(oracle.len());
    for vertex in complex.simplices_of_dim(0) {
        let link = sorted(complex.link(vertex, &mut memory.scratch()).unwrap());
        let count = |dim| link.iter().filter(|&&face| oracle.dim(face) == dim).count();
        assert_eq!([count(0), count(1), count(2), count(3)], [8, 28, 40, 20]);
    }
}
