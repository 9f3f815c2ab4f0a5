use super::super::{Format, MergeError, merge};
use super::{doubles, listed, read_as};
use crate::soup::{Coordinates, Labels, Scalars, Soup};

fn list(text: &str) -> Soup {
    read_as(Format::SimplexList, text).unwrap().0
}

fn off(points: usize) -> Soup {
    let rows = "0 0 0\n".repeat(points);
    read_as(Format::Off, format!("OFF {points} 1 0\n{rows}2 0 {}\n", points - 1)).unwrap().0
}

fn obj(points: usize) -> Soup {
    let rows = "v 1 1 1\n".repeat(points);
    read_as(Format::Obj, format!("{rows}l 1 -1\n")).unwrap().0
}

#[test]
fn lists_merge_by_label() {
    let (soup, report) = merge(vec![list("1 2 3\n"), list("3 1\n5\n"), list("2 5\n")]).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![1, 2, 3, 5]));
    assert_eq!(listed(&soup, 0), [[3]]);
    assert_eq!(listed(&soup, 1), [[2, 0], [1, 3]]);
    assert_eq!(listed(&soup, 2), [[0, 1, 2]]);
    assert!(!soup.declared && report.renumbered.is_empty());
    let (soup, _) = merge(vec![list("1 2\n"), list("x 2\n"), list("1 x\n")]).unwrap();
    assert_eq!(soup.labels, Labels::Tokens(["1", "2", "x"].map(Into::into).to_vec()));
    assert_eq!(listed(&soup, 1), [[0, 1], [2, 1], [0, 2]]);
}

#[test]
fn meshes_are_put_beside_each_other() {
    let (soup, report) = merge(vec![off(3), off(2), off(4)]).unwrap();
    assert_eq!(soup.labels, Labels::Numbered(9));
    assert_eq!(listed(&soup, 1), [[0, 2], [3, 4], [5, 8]]);
    assert_eq!(doubles(&soup).len(), 27);
    let shifts: Vec<_> = report.renumbered.iter().map(|r| (r.input, r.from, r.to)).collect();
    assert_eq!(shifts, [(1, 0, 3), (2, 0, 5)]);

    let (soup, report) = merge(vec![obj(2), obj(3), off(2)]).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![1, 2, 3, 4, 5, 6, 7]));
    assert_eq!(listed(&soup, 1), [[0, 1], [2, 4], [5, 6]]);
    let shifts: Vec<_> = report.renumbered.iter().map(|r| (r.input, r.from, r.to)).collect();
    assert_eq!(shifts, [(1, 1, 3), (2, 0, 6)]);
}

#[test]
fn precisions_mix_to_the_greater() {
    let single = || Soup {
        coordinates: Some(Coordinates { dim: 3, values: Scalars::F32(vec![0.1, 0., 0.]) }),
        ..Soup::new(Labels::Numbered(1), true)
    };
    let tenth = f64::from(0.1f32);
    let (soup, _) = merge(vec![single(), obj(1 + 1)]).unwrap();
    assert_eq!(doubles(&soup), [tenth, 0., 0., 1., 1., 1., 1., 1., 1.]);
    let (soup, _) = merge(vec![obj(2), single()]).unwrap();
    assert_eq!(doubles(&soup), [1., 1., 1., 1., 1., 1., tenth, 0., 0.]);
    let (soup, _) = merge(vec![single(), single()]).unwrap();
    assert_eq!(soup.coordinates.unwrap().values, Scalars::F32(vec![0.1, 0., 0., 0.1, 0., 0.]));
}

#[test]
fn what_does_not_fit_is_refused() {
    assert_eq!(merge(vec![]).unwrap_err(), MergeError::Empty);
    assert_eq!(merge(vec![off(2), list("1 2\n")]).unwrap_err(), MergeError::MixedKinds { input: 2 });
    assert_eq!(merge(vec![list("1 2\n"), list("1\n"), off(2)]).unwrap_err(), MergeError::MixedKinds { input: 3 });
    let planar = read_as(Format::Off, "nOFF 2\n1 0 0\n0 0\n").unwrap().0;
    let expected = MergeError::MixedCoordinates { input: 2, first: 3, other: 2 };
    assert_eq!(merge(vec![off(2), planar]).unwrap_err(), expected);
    let bare = Soup::new(Labels::Numbered(1), true);
    let expected = MergeError::MixedCoordinates { input: 2, first: 3, other: 0 };
    assert_eq!(merge(vec![off(2), bare.clone()]).unwrap_err(), expected);
    let last = Soup::new(Labels::Integers(vec![u64::MAX]), true);
    assert_eq!(merge(vec![last, bare.clone()]).unwrap_err(), MergeError::TooMany { input: 2 });
    let named = Soup::new(Labels::Tokens(vec!["a".into()]), true);
    assert_eq!(merge(vec![bare, named]).unwrap_err(), MergeError::TextLabels { input: 2 });
    let placed = Soup { declared: false, ..off(2) };
    assert_eq!(merge(vec![list("1\n"), placed]).unwrap_err(), MergeError::ListWithCoordinates { input: 2 });
}

#[test]
fn a_single_input_is_handed_back() {
    let soup = off(3);
    assert_eq!(merge(vec![soup.clone()]).unwrap().0, soup);
}
