//! Pictures of files: what is drawn, what legends count, SVG as XML, and the figure of the README.

use std::fs;
use std::process::Command;

use roxmltree::Document;
use sig_core::with_complex;
use sig_tools::draw::complex::{Highlight, points, scene};
use sig_tools::draw::{Axis, Camera, PictureOptions, Scene, read_generators};
use sig_tools::singularities::Singularities;

use crate::{data, file};

fn scene_of(name: &str) -> Scene {
    let loaded = file(name);
    with_complex!(loaded.complex().unwrap(), complex => {
        let singularities = Singularities::new(&complex);
        scene(&complex, points(&complex).unwrap(), singularities.as_ref(), &[])
    })
}

fn legend(scene: &Scene) -> Vec<&str> {
    scene.legend.entries.iter().map(|entry| entry.text.as_str()).collect()
}

/// The counts of the table in `tests/data/README.md`.
#[test]
fn legends_count_what_the_files_have() {
    let bracket = scene_of("gmsh_mixed_bracket_h0.9.msh");
    let texts = legend(&bracket);
    assert_eq!(texts[..3], ["1,199 tetrahedra", "189 dangling triangles", "49 wire edges"]);
    assert!(texts[3..].iter().all(|text| text.contains("non-manifold")), "{texts:?}");
    // All wire edges are drawn, and faces of which at least the dangling ones are some.
    assert!(bracket.lines.iter().filter(|line| !line.is_mark).count() == 49 && bracket.faces.len() > 189);
    assert_eq!(legend(&scene_of("trimesh_angle_block.STL")), ["704 triangles", "33 non-manifold vertices"]);
    assert_eq!(legend(&scene_of("trimesh_octagonal_pocket.ply")), ["3,262 triangles", "3 non-manifold vertices"]);
    assert_eq!(legend(&scene_of("goathead.obj")), ["5,522 triangles"]);
}

/// 4 n_3 = 2 (inner triangles) + (outer ones), and n_2 is the sum of both.
#[test]
fn of_a_solid_the_outer_triangles_are_drawn() {
    for (name, [.., triangles, tetrahedra]) in
        [("torus.msh", [200, 891, 1182, 491]), ("P1.msh", [1585, 8890, 13709, 6414])]
    {
        assert_eq!(scene_of(name).faces.len(), 2 * triangles - 4 * tetrahedra, "{name}");
    }
}

#[test]
fn svg_has_the_faces_that_are_seen() {
    let scene = scene_of("gmsh_mixed_bracket_h0.9.msh");
    let camera = Camera::around(30.0, 25.0, Axis::Z);
    let (svg, is_raster) = scene.to_svg(&camera, &PictureOptions::default()).unwrap();
    assert!(!is_raster);
    let document = Document::parse(&svg).unwrap();
    let paths =
        document.descendants().filter(|node| node.has_tag_name("path") && node.attribute("d").unwrap().ends_with('z'));
    let visible = scene.visible(&camera, 1000, 3);
    let faces = visible[..scene.faces.len()].iter().filter(|&&seen| seen).count();
    assert_eq!(paths.count(), faces);
    // Of a closed solid about half is seen.
    assert!(faces > 100 && faces < scene.faces.len() * 3 / 4, "{faces} of {}", scene.faces.len());
    let (raster, is_raster) =
        scene.to_svg(&camera, &PictureOptions { max_faces: 10, ..PictureOptions::default() }).unwrap();
    assert!(is_raster);
    let document = Document::parse(&raster).unwrap();
    let image = document.descendants().find(|node| node.has_tag_name("image")).unwrap();
    assert!(image.attribute("href").unwrap().starts_with("data:image/png;base64,"));
}

#[test]
fn what_xml_reserves_is_escaped() {
    let mut scene = scene_of("bow.off");
    let title = "<&>\" \u{1}\u{fffe}é.off";
    scene.legend.title = title.to_owned();
    let (svg, _) = scene.to_svg(&Camera::default(), &PictureOptions::default()).unwrap();
    let document = Document::parse(&svg).unwrap();
    let text = document.descendants().filter_map(|node| node.text()).find(|text| text.contains("off"));
    assert_eq!(text, Some("<&>\" \u{fffd}\u{fffd}é.off"));
}

#[test]
fn highlights_shine_through_a_pale_rest() {
    let loaded = file("torus.msh");
    with_complex!(loaded.complex().unwrap(), complex => {
        let vertex = complex.simplices_of_dim(0).next().unwrap();
        let highlight = Highlight::new("a vertex".to_owned(), vec![vertex]);
        let scene = scene(&complex, points(&complex).unwrap(), None, &[highlight]);
        assert_eq!(scene.dots.iter().filter(|dot| dot.is_mark).count(), 1);
        assert!(scene.faces.iter().all(|face| face.colour == sig_tools::draw::colour::PALE));
        assert_eq!(legend(&scene).last(), Some(&"a vertex"));
    });
}

#[test]
fn generators_are_read_and_refused() {
    let loaded = file("bow.off");
    with_complex!(loaded.complex().unwrap(), complex => {
        let text = br#"{"generators":[[{"order":null,"cycle":[[1,["0"]]]}],[{"order":"3","cycle":[[1,["0","1"]],[-1,["1","2"]]]}]]}"#;
        let found = read_generators(text, &complex).unwrap();
        let names: Vec<&str> = found.iter().map(|highlight| highlight.name.as_str()).collect();
        assert_eq!(names, ["H0: cycle, 1 vertex", "H1: cycle of order 3, 2 edges"]);
        for (text, message) in [
            (&b"{}"[..], "there are no generators"),
            (b"[", "not what sig homology"),
            (br#"{"generators":[[],[{"cycle":[[1,["0","4"]]]}]]}"#, "generator 1 of dimension 1: 0,4 is no simplex"),
            (br#"{"generators":[[],[{"cycle":[[1,["0"]]]}]]}"#, "generator 1 of dimension 1: 0 is no simplex"),
        ] {
            let error = read_generators(text, &complex).unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
    });
}

/// The figure of the README is what `sig draw --arrays` makes of `bow.off`, and its numbers are those of the definitions.
#[test]
fn the_figure_of_the_readme() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("figure.svg");
    let mut command = Command::new(env!("CARGO_BIN_EXE_sig"));
    let status = command.args(["draw", "--arrays", "-o"]).arg(&out).arg(data("bow.off")).status().unwrap();
    assert!(status.success());
    let svg = fs::read_to_string(&out).unwrap();
    let expected = fs::read_to_string(data("../../core/figure.svg")).unwrap();
    assert!(
        svg == expected,
        "core/figure.svg: make it anew with sig draw tests/data/bow.off --arrays -o core/figure.svg --force"
    );
    let document = Document::parse(&svg).unwrap();
    let texts: Vec<&str> =
        document.descendants().filter(|node| node.has_tag_name("text")).filter_map(|node| node.text()).collect();
    let row = |name: &str| -> Vec<&str> {
        let from = texts.iter().position(|&text| text == name).unwrap() + 1;
        let numbers =
            texts[from..].iter().copied().take_while(|text| !["boundary", "pointers", "flags", "lists"].contains(text));
        numbers.filter(|text| *text == "■" || text.parse::<usize>().is_ok()).collect()
    };
    assert_eq!(row("lookup"), ["0", "5", "11"]);
    assert_eq!(row("boundary").join(" "), "1 0 2 0 2 1 3 1 3 2 4 3 7 6 5 9 8 7");
    assert_eq!(row("pointers").join(" "), "11 11 11 0 3 5 7 9 12 14 16");
    assert_eq!(row("flags").join(" "), "1 1 1 0 0 0 0 0 0 0 0");
    // With the place below the first entry of each list.
    assert_eq!(row("lists").join(" "), "12 0 10 ■ 10 3 ■ 11 5 ■ 11 7 ■ 11 9 12 ■ 12 12 ■ 12 14 ■ ■ 16");
}
