use proptest::prelude::*;

use super::super::{Format, ReadOptions, Weld, read_bytes};
use super::stl;
use crate::soup::{Labels, Soup};

fn read(text: &str, weld: Weld, drop_degenerate: bool) -> Result<(Soup, usize), String> {
    let options = ReadOptions { weld: Some(weld), drop_degenerate, format: Some(Format::Off), ..Default::default() };
    let read = read_bytes(text.as_bytes(), "test", &options);
    read.map(|(soup, report)| (soup, report.welded)).map_err(|error| error.to_string())
}

const TWICE: &str = "OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n-0 0 0\n1 0 1e-9\n5 5 5\n3 0 1 2\n3 3 5 4\n";

#[test]
fn vertices_at_one_place_become_one_and_keep_the_first_label() {
    let (soup, welded) = read(TWICE, Weld::Exact, false).unwrap();
    assert_eq!((welded, &soup.labels), (1, &Labels::Integers(vec![0, 1, 2, 4, 5])));
    assert_eq!(soup.simplices[2], [0, 1, 2, 0, 4, 3]);
    let (soup, welded) = read(TWICE, Weld::Within(1e-9), false).unwrap();
    assert_eq!((welded, &soup.labels), (2, &Labels::Integers(vec![0, 1, 2, 5])));
    assert_eq!(soup.simplices[2], [0, 1, 2, 0, 3, 1]);
    assert_eq!(read(TWICE, Weld::None, false).unwrap().0.labels, Labels::Numbered(6));
}

#[test]
fn what_welding_makes_degenerate_is_refused_or_dropped() {
    let found = read(TWICE, Weld::Within(1.0), false).unwrap_err();
    assert!(found.starts_with("test: the simplex 0,1,2 repeats a vertex once vertices are welded"), "{found}");
    let (soup, _) = read(TWICE, Weld::Within(1.0), true).unwrap();
    assert_eq!(soup.num_listed(), 0);
}

#[test]
fn corners_of_stl_stay_apart_if_so_told() {
    let facet = [[0.; 3], [1., 0., 0.], [0., 1., 0.]];
    let bytes = stl::binary("solid", &[facet, facet]);
    for (weld, vertices) in [(None, 3), (Some(Weld::Exact), 3), (Some(Weld::None), 6), (Some(Weld::Within(1.0)), 1)] {
        let options = ReadOptions { weld, drop_degenerate: true, ..Default::default() };
        assert_eq!(read_bytes(&bytes, "-", &options).unwrap().0.labels.len(), vertices, "{weld:?}");
    }
}

#[test]
fn how_it_is_spelled() {
    for text in ["none", "exact", "0.5"] {
        assert_eq!(text.parse::<Weld>().unwrap().to_string(), text);
    }
    for text in ["", "some", "-1", "inf", "nan"] {
        assert!(text.parse::<Weld>().is_err());
    }
}

proptest! {
    /// Against the definition, by comparing all pairs.
    #[test]
    fn each_becomes_the_first_that_stayed_and_is_near(
        points in prop::collection::vec(prop::array::uniform2(-8_i8..8), 0..40),
        distance in prop::sample::select(vec![0.0, 0.5, 1.0, 1.5, 3.0]),
    ) {
        let mut text = format!("nOFF 2\n{} 0 0\n", points.len());
        for [x, y] in &points {
            text += &format!("{} {}\n", f64::from(*x) / 2.0, f64::from(*y) / 2.0);
        }
        let mut stayed: Vec<usize> = Vec::new();
        for (number, [x, y]) in points.iter().enumerate() {
            let is_near = |&other: &usize| {
                let (dx, dy) = (f64::from(*x - points[other][0]) / 2.0, f64::from(*y - points[other][1]) / 2.0);
                dx * dx + dy * dy <= distance * distance
            };
            if !stayed.iter().any(is_near) {
                stayed.push(number);
            }
        }
        let (soup, _) = read(&text, Weld::Within(distance), true).unwrap();
        prop_assert_eq!(soup.labels, Labels::from_integers(stayed.iter().map(|&number| number as u64).collect()));
    }
}
