//! Real files: the counts are those of the table in `tests/data/README.md`, which other programs established.

use super::super::{Format, ReadOptions, ReadReport, read_path};
use super::f_vector;
use crate::soup::{Labels, Soup};

fn path(name: &str) -> String {
    format!("{}/../tests/data/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn fixture(name: &str) -> (Soup, ReadReport) {
    read_path(path(name), &ReadOptions::default()).unwrap()
}

#[track_caller]
fn check(name: &str, format: Format, counts: &[usize]) -> (Soup, ReadReport) {
    let (soup, report) = fixture(name);
    assert_eq!(report.format, format, "{name}");
    assert_eq!(f_vector(&soup), counts, "{name}");
    assert_eq!(report.vertices, soup.labels.len(), "{name}");
    assert_eq!(report.simplices.iter().sum::<usize>(), soup.num_listed(), "{name}");
    if let Some(coordinates) = &soup.coordinates {
        let scalars = match &coordinates.values {
            crate::soup::Scalars::F32(values) => values.len(),
            crate::soup::Scalars::F64(values) => values.len(),
        };
        assert_eq!(scalars, coordinates.dim * soup.labels.len(), "{name}");
    }
    (soup, report)
}

#[test]
fn obj_goat_head() {
    let (soup, report) = check("goathead.obj", Format::Obj, &[2763, 8283, 5522]);
    assert_eq!(soup.labels, Labels::Integers((1..=2763).collect()));
    assert_eq!(report.ignored.count, 0);
}

#[test]
fn obj_quadrangles_of_spot() {
    let (_, report) = check("spot_control_mesh.obj", Format::Obj, &[188, 558, 372]);
    // By awk: 4 faces of three vertices, 160 of four, 16 of five.
    assert_eq!(report.polygons, 160 + 16);
    assert_eq!(report.split_into, 2 * 160 + 3 * 16);
}

#[test]
fn msh_text_4_1() {
    check("torus.msh", Format::Msh, &[200, 891, 1182, 491]);
}

#[test]
fn msh_binary_4_1() {
    check("gmsh-3d-binary-64.msh", Format::Msh, &[131, 614, 848, 364]);
}

#[test]
fn msh_text_2_2_of_mixed_dimension() {
    let (_, report) = check("gmsh_mixed_bracket_h0.9.msh", Format::Msh, &[587, 2434, 3038, 1199]);
    assert_eq!(report.simplices[3], 1199);
}

#[test]
fn msh_of_prisms_and_tetrahedra() {
    let (_, report) = check("hybrid_3d_cube.msh", Format::Msh, &[91, 452, 659, 297]);
    // By awk: 82 triangles, 24 quadrangles, 117 tetrahedra, 60 prisms.
    assert_eq!(report.simplices, [0, 0, 82 + 2 * 24, 117 + 3 * 60]);
    assert_eq!((report.polygons, report.polyhedra, report.split_into), (24, 60, 2 * 24 + 3 * 60));
}

#[test]
fn stl_binary_that_begins_with_solid() {
    let (_, report) = check("trimesh_angle_block.STL", Format::Stl, &[398, 1139, 704]);
    assert_eq!(report.welded, 3 * 704 - 398);
}

#[test]
fn ply_binary() {
    check("trimesh_octagonal_pocket.ply", Format::Ply, &[1658, 4920, 3262]);
}

/// The f-vectors stand in the files' own headers.
#[test]
fn lists_of_the_library_of_triangulations() {
    check("bing", Format::SimplexList, &[480, 2511, 3586, 1554]);
    check("poincare", Format::SimplexList, &[16, 106, 180, 90]);
    check("two_optima", Format::SimplexList, &[106, 596, 1064, 573]);
    check("K3_16", Format::SimplexList, &[16, 120, 560, 720, 288]);
    check("RP5_24", Format::SimplexList, &[24, 273, 1174, 2277, 2028, 676]);
    check("dunce_hat", Format::SimplexList, &[8, 24, 17]);
    let (soup, _) = check("hyperbolic_dodecahedral_space", Format::SimplexList, &[21, 190, 338, 169]);
    assert!(matches!(soup.labels, Labels::Integers(_)));
    assert!(!soup.declared);
}

#[test]
fn errors_name_the_file() {
    let missing = path("no-such-file.off");
    let error = read_path(&missing, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{missing}: cannot read: ")), "{error}");
}
