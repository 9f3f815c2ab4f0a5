//! Attributes go out and come back: the same bytes must come out of the complex that is read again.

use proptest::prelude::*;

use super::*;
use crate::attribute::{NAMELESS, REFERENCE, Values};

/// The shape that a name has wherever it is: a type by number, and components.
type Shape = (&'static str, u8, usize);

/// Different simplices, none a face of another, on vertices of which some may be in none.
fn tops(max_dim: usize) -> impl Strategy<Value = (usize, Vec<Vec<u32>>)> {
    let simplex = proptest::collection::btree_set(0_u32..9, 2..=max_dim + 1);
    proptest::collection::vec(simplex, 1..12).prop_map(|mut simplices| {
        simplices.sort_by_key(|simplex| std::cmp::Reverse(simplex.len()));
        let mut tops: Vec<std::collections::BTreeSet<u32>> = Vec::new();
        for simplex in simplices {
            if !tops.iter().any(|top| simplex.is_subset(top)) {
                tops.push(simplex);
            }
        }
        (9, tops.into_iter().map(|top| top.into_iter().collect()).collect())
    })
}

/// So many numbers that are not 0, of the type with a number; some are NaN, but not the first, for a column without any
/// value does not come back.
#[expect(clippy::cast_possible_truncation, reason = "any numbers will do")]
fn values(number: u8, count: usize, seed: u64) -> Values {
    let mut state = seed | 1;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 20 & 0xfff_ffff) as i64 - 0x800_0000
    };
    let float = |at: usize, value: i64| if at > 0 && value % 7 == 0 { f64::NAN } else { value as f64 / 3.0 };
    match number {
        0 => Values::U8((0..count).map(|_| (next().unsigned_abs() % 255) as u8 + 1).collect()),
        1 => Values::U16((0..count).map(|_| (next().unsigned_abs() % 65_535) as u16 + 1).collect()),
        2 => Values::U32((0..count).map(|_| u32::MAX - next().unsigned_abs() as u32).collect()),
        3 => Values::U64((0..count).map(|_| u64::MAX - next().unsigned_abs()).collect()),
        4 => Values::I32((0..count).map(|_| next() as i32 * 2 + 1).collect()),
        5 => Values::I64((0..count).map(|_| next() * (1 << 35) + 1).collect()),
        6 => Values::F32((0..count).map(|at| float(at, next()) as f32).collect()),
        _ => Values::F64((0..count).map(|at| float(at, next())).collect()),
    }
}

/// A soup of simplices with the attributes of these names at the vertices and at the simplices of each dimension, but for
/// those that `left_out` has a bit for.
fn soup((count, tops): &(usize, Vec<Vec<u32>>), first: u64, shapes: &[Shape], seed: u64, left_out: u64) -> Soup {
    let labels = if first == 0 { Labels::Numbered(*count) } else { Labels::Integers((first..).take(*count).collect()) };
    let mut soup = Soup::new(labels, true);
    let coordinates = (0..3 * *count).map(|at| (at * at) as f64 / 7.0).collect();
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F64(coordinates) });
    tops.iter().for_each(|top| soup.push(top));
    let mut bit = 0;
    for dim in 0..soup.simplices.len() {
        let rows = if dim == 0 { *count } else { soup.of_dim(dim).len() };
        for &(name, number, components) in shapes {
            bit += 1;
            if rows > 0 && left_out >> bit & 1 == 0 {
                let values = values(number, rows * components, seed ^ bit << 32);
                let name = name.into();
                soup.attributes.push(crate::attribute::Attribute { name, dim, components, values });
            }
        }
    }
    soup
}

/// The same file must come out of what is read again; nothing may be reported as lost.
fn comes_back(soup: Soup, format: Format) -> Result<(), TestCaseError> {
    let original = file(soup, VertexOrder::Hilbert);
    let (text, notes) = export_of(&original, format).unwrap();
    prop_assert_eq!(notes, []);
    let (soup, report) = read_bytes(&text, format.name(), &ReadOptions::default()).unwrap();
    prop_assert_eq!(report.ignored.names, Vec::<String>::new());
    let again = file(soup, VertexOrder::Hilbert);
    prop_assert!(again == original, "{}", String::from_utf8_lossy(&text));
    Ok(())
}

proptest! {
    #[test]
    fn vtu_and_vtk_give_all_types(tops in tops(3), seed: u64, number in 0_u8..8, components in 1..4_usize, left_out: u64) {
        let shapes = [("a", number, components), ("b & \"<c>\" %41", (number + 3) % 8, 1), (REFERENCE, 4, 1)];
        comes_back(soup(&tops, 0, &shapes, seed, left_out), Format::Vtu)?;
        comes_back(soup(&tops, 17, &shapes, seed, left_out), Format::Vtu)?;
        comes_back(soup(&tops, 0, &shapes, seed, left_out), Format::Vtk)?;
    }

    #[test]
    fn vtp_gives_all_types(tops in tops(2), seed: u64, number in 0_u8..8, components in 1..4_usize, left_out: u64) {
        let shapes = [("a", number, components), ("b & \"<c>\" %41", (number + 3) % 8, 1), (REFERENCE, 4, 1)];
        comes_back(soup(&tops, 0, &shapes, seed, left_out), Format::Vtp)?;
        comes_back(soup(&tops, 17, &shapes, seed, left_out), Format::Vtp)?;
    }

    #[test]
    fn ply_gives_all_types_but_64_bit_integers(tops in tops(2), seed: u64, number in 0_u8..6, components in 1..4_usize) {
        let numbers = [0, 1, 2, 4, 6, 7];
        let (one, other) = (numbers[usize::from(number)], numbers[usize::from(number + 3) % 6]);
        comes_back(soup(&tops, 0, &[("quality", one, components), ("nx", other, 1)], seed, 0), Format::Ply)?;
    }

    #[test]
    fn tetgen_gives_one_attribute_and_markers(tops in tops(3), seed: u64, components in 1..4_usize, left_out: u64) {
        let mut soup = soup(&tops, 0, &[(NAMELESS, 7, components), (REFERENCE, 4, 1)], seed, left_out);
        soup.attributes.retain(|attribute| match &*attribute.name {
            REFERENCE => attribute.dim < 3,
            _ => attribute.dim % 3 == 0,
        });
        let original = file(soup, VertexOrder::Hilbert);
        prop_assert!(file(through_files(&original).0, VertexOrder::Hilbert) == original);
    }

    #[test]
    fn msh_gives_doubles_and_physical_groups(tops in tops(3), seed: u64, width in 0..3_usize, left_out: u64) {
        // Nodes have no physical group.
        let mut soup = soup(&tops, 1, &[("a", 7, [1, 3, 9][width]), (REFERENCE, 4, 1)], seed, left_out);
        soup.attributes.retain(|attribute| attribute.dim > 0 || *attribute.name != *REFERENCE);
        comes_back(soup, Format::Msh)?;
    }

    #[test]
    fn medit_gives_references(tops in tops(3), seed: u64, left_out: u64) {
        comes_back(soup(&tops, 1, &[(REFERENCE, 4, 1)], seed, left_out), Format::Medit)?;
    }

    #[test]
    fn mfem_gives_positive_references(tops in tops(3), seed: u64) {
        let dim = tops.1.iter().map(Vec::len).max().unwrap_or(0);
        let pure = (tops.0, tops.1.into_iter().filter(|top| top.len() == dim).collect());
        let mut soup = soup(&pure, 0, &[(REFERENCE, 4, 1)], seed, 0);
        soup.attributes.retain(|attribute| attribute.dim > 0);
        for attribute in &mut soup.attributes {
            if let Values::I32(values) = &mut attribute.values {
                values.iter_mut().for_each(|value| *value = value.saturating_abs() | 2);
            }
        }
        comes_back(soup, Format::Mfem)?;
    }
}

/// Two triangles, one of them with an edge that has values of its own, and a wire.
fn mixed() -> Soup {
    let mut soup = Soup::new(Labels::Numbered(5), true);
    [&[0, 1, 2][..], &[1, 2, 3], &[0, 1], &[3, 4]].into_iter().for_each(|simplex| soup.push(simplex));
    soup.coordinates = Some(Coordinates { dim: 3, values: Scalars::F64(vec![0.5; 15]) });
    let attribute = |name: &str, dim, components, values| crate::attribute::Attribute {
        name: name.into(),
        dim,
        components,
        values,
    };
    soup.attributes = vec![
        attribute("label", 0, 1, Values::U8(vec![1, 2, 3, 4, 5])),
        attribute(REFERENCE, 1, 1, Values::I64(vec![-7, 1 << 40])),
        attribute("uv", 2, 2, Values::F32(vec![1.0, 2.0, 3.0, 4.0])),
    ];
    soup
}

#[test]
fn what_a_format_cannot_hold_is_named() {
    let original = file(mixed(), VertexOrder::Input);
    let of = |format| export_of(&original, format).unwrap();
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let faces = Note::AttributesOfFacesLeftOut(names(&["ref (dimension 1)"]));
    assert_eq!(of(Format::Vtu).1, [Note::AttributesLeftOut(names(&["label"])), faces.clone()]);
    assert_eq!(of(Format::Vtk).1, std::slice::from_ref(&faces));
    assert_eq!(of(Format::Ply).1, [Note::AttributesConverted(names(&["ref"])), faces.clone()]);
    let converted = Note::AttributesConverted(names(&["label", "uv"]));
    assert_eq!(of(Format::Msh).1, [Note::LabelsLeftOut, converted, faces.clone()]);
    let left_out = Note::AttributesLeftOut(names(&["label", "uv"]));
    assert_eq!(of(Format::Medit).1, [Note::LabelsLeftOut, left_out, faces]);
    with_complex!(AnyComplex::from_bytes(&original).unwrap(), complex => {
        let notes = export_file(&complex, Format::Tetgen, "node", &mut Vec::new()).unwrap();
        let left_out = Note::AttributesLeftOut(names(&["label", "uv"]));
        let faces = Note::AttributesOfFacesLeftOut(names(&["ref (dimension 1)"]));
        assert_eq!(notes, [left_out, faces]);
    });
    let all = Note::AttributesLeftOut(names(&["label", "ref", "uv"]));
    assert_eq!(of(Format::Off).1, std::slice::from_ref(&all));
    assert_eq!(of(Format::SimplexList).1, [Note::CoordinatesLeftOut, all]);
}

#[test]
fn values_stand_where_they_belong() {
    let original = file(mixed(), VertexOrder::Input);
    let vtk = String::from_utf8(export_of(&original, Format::Vtk).unwrap().0).unwrap();
    let data = vtk.split_once("POINT_DATA").unwrap().1;
    // Cells are the wire, then the triangles.
    let expected = " 5\nFIELD FieldData 1\nlabel 1 5 unsigned_char\n 1\n 2\n 3\n 4\n 5\nCELL_DATA 3\nFIELD FieldData 2\n\
                    ref 1 3 long\n 1099511627776\n 0\n 0\nuv 2 3 float\n nan nan\n 1.0 2.0\n 3.0 4.0\n";
    assert_eq!(data, expected);
    let medit = String::from_utf8(export_of(&original, Format::Medit).unwrap().0).unwrap();
    assert!(medit.contains("Edges\n1\n4 5 1099511627776\n\nTriangles\n2\n1 2 3 0\n2 3 4 0\n"), "{medit}");
}
