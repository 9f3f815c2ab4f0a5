//! What is exported is read and built again: the same complex must come out.

mod attributes;

use sig_core::{AnyComplex, with_complex};

use super::*;
use crate::build::{BuildOptions, VertexOrder, build};
use crate::io::{ReadOptions, read_bytes};
use crate::soup::{Coordinates, Labels, Scalars, Soup};
use crate::store::{AlignedBytes, EncodeOptions, Encoding};

fn file(soup: Soup, order: VertexOrder) -> AlignedBytes {
    let built = build(soup, &BuildOptions { order, ..BuildOptions::default() }).unwrap();
    Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap()
}

fn export_of(file: &[u8], format: Format) -> Result<(Vec<u8>, Vec<Note>), ExportError> {
    let mut out = Vec::new();
    let any = AnyComplex::from_bytes(file).unwrap();
    let notes = with_complex!(any, complex => export(&complex, format, &mut out))?;
    Ok((out, notes))
}

fn read(text: &[u8], name: &str) -> Soup {
    read_bytes(text, name, &ReadOptions::default()).unwrap().0
}

/// A surface with a dangling edge and an isolated vertex, both orientations among the triangles.
const SURFACE: &[u8] = b"OFF
7 5 0
0 0 0
1 0 0.1
0 1 1e-30
1 1 -2.5
0.3333333333333333 2 7e300
4 4 4
9 9 9
3 0 1 2
3 1 2 3
3 4 3 2
3 4 0 2
2 5 4
";

#[test]
fn off_and_ply_give_the_same_bytes() {
    let original = file(read(SURFACE, "a.off"), VertexOrder::Input);
    for format in [Format::Off, Format::Ply] {
        let (text, notes) = export_of(&original, format).unwrap();
        assert!(notes.is_empty());
        let again = file(read(&text, format.name()), VertexOrder::Input);
        assert!(again == original, "{format}: {}", String::from_utf8_lossy(&text));
    }
}

#[test]
fn obj_gives_the_same_bytes_but_for_its_own_numbers() {
    let original = file(read(SURFACE, "a.off"), VertexOrder::Input);
    let (text, notes) = export_of(&original, Format::Obj).unwrap();
    assert_eq!(notes, [Note::LabelsLeftOut]);
    let numbered_from_one = file(read(&text, "a.obj"), VertexOrder::Input);
    let (text, notes) = export_of(&numbered_from_one, Format::Obj).unwrap();
    assert!(notes.is_empty());
    assert!(file(read(&text, "a.obj"), VertexOrder::Input) == numbered_from_one);
}

#[test]
fn poly_data_gives_the_same_bytes() {
    let original = file(read(SURFACE, "a.off"), VertexOrder::Input);
    for format in [Format::Vtp, Format::Vtu] {
        let (text, notes) = export_of(&original, format).unwrap();
        assert!(notes.is_empty());
        assert!(file(read(&text, "a"), VertexOrder::Input) == original, "{format}");
    }
    let solid = file(solid(), VertexOrder::Input);
    assert!(matches!(export_of(&solid, Format::Vtp), Err(ExportError::Dimension { dim: 3, .. })));
}

/// Two tetrahedra of both orientations, a dangling triangle and edge, and an isolated vertex.
fn solid() -> Soup {
    let mut soup = Soup::new(Labels::Numbered(9), true);
    for simplex in [&[0, 1, 2, 3][..], &[4, 1, 2, 3], &[5, 4, 1], &[7, 6]] {
        soup.push(simplex);
    }
    let values = (0..27_u8).map(|value| f64::from(value * 5 % 7) / 3.0).collect();
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F64(values) });
    soup
}

/// Writes the files of a mesh in a directory, and reads it by the name of one of them.
fn through_files(original: &[u8]) -> (Soup, Vec<&'static str>) {
    let directory = tempfile::tempdir().unwrap();
    let path = |end: &str| directory.path().join("mesh").with_extension(end);
    let any = AnyComplex::from_bytes(original).unwrap();
    let ends = with_complex!(any, complex => {
        let ends = files(&complex, Format::Tetgen);
        for end in &ends {
            let mut out = std::fs::File::create(path(end)).unwrap();
            assert_eq!(export_file(&complex, Format::Tetgen, end, &mut out).unwrap(), []);
        }
        ends
    });
    (crate::io::read_path(path("node"), &ReadOptions::default()).unwrap().0, ends)
}

#[test]
fn files_of_tetgen_give_the_same_bytes() {
    let check = |soup: Soup, expected: &[&str]| {
        let original = file(soup, VertexOrder::Input);
        let (soup, ends) = through_files(&original);
        assert_eq!(ends, expected);
        assert!(file(soup, VertexOrder::Input) == original);
        assert!(matches!(export_of(&original, Format::Tetgen), Err(ExportError::SeveralFiles { .. })));
    };
    check(solid(), &["node", "ele", "face", "edge"]);
    check(read(SURFACE, "a.off"), &["node", "face", "edge"]);
    let mut plane = read(SURFACE, "a.off");
    plane.coordinates = Some(Coordinates { dim: 2, values: Scalars::F64((0..14).map(f64::from).collect()) });
    check(plane, &["node", "ele", "edge"]);
}

#[test]
fn tetrahedra_in_binary_give_the_same_bytes() {
    let mut soup = solid();
    let mixed = file(soup.clone(), VertexOrder::Input);
    assert!(matches!(export_of(&mixed, Format::Tetbin), Err(ExportError::Mixed { dim: 3, .. })));
    soup.simplices.iter_mut().take(3).for_each(Vec::clear);
    let double = file(soup.clone(), VertexOrder::Input);
    assert_eq!(export_of(&double, Format::Tetbin).unwrap().1, [Note::CoordinatesRounded]);
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32((0..27_u8).map(f32::from).collect()) });
    let original = file(soup, VertexOrder::Input);
    let (bytes, notes) = export_of(&original, Format::Tetbin).unwrap();
    assert!(notes.is_empty());
    assert!(file(read(&bytes, "a"), VertexOrder::Input) == original);
}

/// nOFF: any number of coordinates.
#[test]
fn points_in_five_dimensions() {
    let mut soup = read(SURFACE, "a.off");
    soup.coordinates =
        Some(Coordinates { dim: 5, values: Scalars::F64((0..35).map(|x| f64::from(x) / 9.0).collect()) });
    let original = file(soup, VertexOrder::Input);
    for format in [Format::Off, Format::Tops] {
        let (text, notes) = export_of(&original, format).unwrap();
        assert!(notes.is_empty());
        assert!(file(read(&text, &format!("a.{format}")), VertexOrder::Input) == original, "{format}");
    }
}

/// The vertices go out in the order in which they came in, whatever their order in the file.
#[test]
fn the_order_in_the_file_does_not_show() {
    let by_input = file(read(SURFACE, "a.off"), VertexOrder::Input);
    for order in [VertexOrder::Hilbert, VertexOrder::Rcm] {
        let ordered = file(read(SURFACE, "a.off"), order);
        assert!(ordered != by_input);
        let (text, notes) = export_of(&ordered, Format::Off).unwrap();
        assert!(notes.is_empty());
        assert!(file(read(&text, "a.off"), VertexOrder::Input) == by_input);
    }
}

#[test]
fn single_precision_stays_single() {
    let mut soup = read(SURFACE, "a.off");
    let values = (0..21_u8).map(|value| f32::from(value) / 7.0).collect();
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32(values) });
    let original = file(soup, VertexOrder::Input);
    let (text, _) = export_of(&original, Format::Ply).unwrap();
    assert!(file(read(&text, "a.ply"), VertexOrder::Input) == original);
}

#[test]
fn points_in_the_plane() {
    let mut soup = read(SURFACE, "a.off");
    soup.coordinates = Some(Coordinates { dim: 2, values: Scalars::F64((0..14).map(f64::from).collect()) });
    let original = file(soup, VertexOrder::Input);
    for format in [Format::Off, Format::Ply] {
        let (text, _) = export_of(&original, format).unwrap();
        assert!(file(read(&text, format.name()), VertexOrder::Input) == original, "{format}");
    }
    assert!(matches!(export_of(&original, Format::Obj), Err(ExportError::Coordinates { components: 2, .. })));
    assert_eq!(export_of(&original, Format::Vtu).unwrap().1, [Note::CoordinatesPadded]);
}

#[test]
fn a_list_of_simplices_holds_every_complex() {
    for list in ["3 1 2\n2 1 3 4 0\n7\n5 6\n", "a b c\nc,d\nb c x y z w\n\u{e4}\n", "7 9 100\n100 9 8\n", ""] {
        for order in [VertexOrder::Input, VertexOrder::Rcm] {
            let original = file(read(list.as_bytes(), "a.txt"), order);
            let (text, notes) = export_of(&original, Format::SimplexList).unwrap();
            assert!(notes.is_empty());
            assert!(file(read(&text, "a.txt"), order) == original, "{list}");
        }
    }
    let mesh = file(read(SURFACE, "a.off"), VertexOrder::Input);
    assert_eq!(export_of(&mesh, Format::SimplexList).unwrap().1, [Note::CoordinatesLeftOut]);
}

#[test]
fn what_a_format_cannot_hold_is_refused_before_the_first_byte() {
    let list = file(read(b"0 1 2 3\n", "a.txt"), VertexOrder::Input);
    for format in [Format::Off, Format::Obj, Format::Ply] {
        assert!(matches!(export_of(&list, format), Err(ExportError::Dimension { dim: 3, .. })), "{format}");
    }
    assert!(matches!(export_of(&list, Format::Vtu), Err(ExportError::NoCoordinates { .. })));
    let labels = Labels::Tokens(vec!["a b".into(), "c".into()]);
    let mut soup = Soup::new(labels, false);
    soup.push(&[0, 1]);
    assert!(matches!(export_of(&file(soup, VertexOrder::Input), Format::SimplexList), Err(ExportError::Label { .. })));
}

/// Base64 of a header of eight bytes with the length, then the data, as VTK has them: decoded by hand.
#[test]
fn vtu_of_two_cells() {
    let mut soup = Soup::new(Labels::Numbered(4), true);
    soup.push(&[1, 0, 2]);
    soup.push(&[2, 3]);
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F32(vec![0.0; 12]) });
    let (text, notes) = export_of(&file(soup, VertexOrder::Input), Format::Vtu).unwrap();
    assert!(notes.is_empty());
    let text = String::from_utf8(text).unwrap();
    let array = |name: &str| {
        use base64::Engine;
        let start = text.find(&format!("Name=\"{name}\"")).unwrap();
        let data = &text[start + text[start..].find('>').unwrap() + 1..];
        let bytes = base64::engine::general_purpose::STANDARD.decode(&data[..data.find('<').unwrap()]).unwrap();
        let (length, bytes) = bytes.split_at(8);
        assert_eq!(length, (bytes.len() as u64).to_le_bytes());
        bytes.to_vec()
    };
    assert_eq!(array("types"), [3, 5]);
    assert_eq!(array("dimension"), [1, 2]);
    let integers = |name| array(name).chunks(8).map(|bytes| bytes[0]).collect::<Vec<_>>();
    assert_eq!(integers("offsets"), [2, 5]);
    // The triangle was given as 102, an odd permutation.
    assert_eq!(integers("connectivity"), [2, 3, 0, 2, 1]);
    assert_eq!(integers("label"), [0, 1, 2, 3]);
}
