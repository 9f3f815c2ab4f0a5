//! Complexes to make maps of, and what a map is by definition: slow and obvious.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use proptest::sample::Index as Pick;
use sig_core::{Complex, SimplexId, VertexId};
use sig_tools::build::{BuildOptions, Built, VertexOrder, build};
use sig_tools::combinatorial_map::{CombinatorialMap, DartId, MapError};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{AlignedBytes, EncodeOptions, Encoding};

pub(crate) type Word = Vec<u32>;

/// The complex of the faces of some words on the vertices 0, 1, …, in the order of their numbers.
pub(crate) fn built(words: &[Word]) -> Built {
    let count = words.iter().flatten().max().map_or(0, |&most| most as usize + 1);
    let mut soup = Soup::new(Labels::Numbered(count), false);
    words.iter().for_each(|word| soup.push(word));
    build(soup, &BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() }).unwrap()
}

pub(crate) fn file(built: &Built) -> AlignedBytes {
    Encoding::new(built, &EncodeOptions::default()).unwrap().to_bytes().unwrap()
}

/// Calls `check` with the complex of some words.
pub(crate) fn with_complex<T>(words: &[Word], check: impl FnOnce(&Complex<'_, u16>) -> T) -> T {
    check(&Complex::<u16>::from_bytes(&file(&built(words))).unwrap())
}

pub(crate) fn map_of(words: &[Word]) -> Result<CombinatorialMap, MapError> {
    with_complex(words, CombinatorialMap::new)
}

/// Words whose letters are the digits of `text`.
pub(crate) fn digits(text: &str) -> Vec<Word> {
    text.split_whitespace().map(|word| word.chars().map(|digit| digit.to_digit(36).unwrap()).collect()).collect()
}

/// The facets of the simplex on `count` vertices from `start` on.
pub(crate) fn sphere(start: u32, count: u32) -> Vec<Word> {
    (0..count)
        .map(|left_out| (0..count).filter(|&vertex| vertex != left_out).map(|vertex| start + vertex).collect())
        .collect()
}

/// The 7-vertex torus of Möbius and Császár.
pub(crate) fn torus() -> Vec<Word> {
    (0..7).flat_map(|i| [vec![i, (i + 1) % 7, (i + 3) % 7], vec![i, (i + 2) % 7, (i + 3) % 7]]).collect()
}

/// The 6-vertex projective plane.
pub(crate) fn projective_plane() -> Vec<Word> {
    digits("012 023 034 045 051 124 235 341 452 513")
}

/// The 3-torus: Kuhn's tetrahedra of a periodic grid of 3³ vertices.
pub(crate) fn torus_3() -> Vec<Word> {
    let vertex = |[x, y, z]: [u32; 3]| x % 3 + 3 * (y % 3) + 9 * (z % 3);
    let axes = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let corners = (0..27).map(|corner| [corner % 3, corner / 3 % 3, corner / 9]);
    let path = |mut corner: [u32; 3], axes: [usize; 3]| {
        let mut word = vec![vertex(corner)];
        for axis in axes {
            corner[axis] += 1;
            word.push(vertex(corner));
        }
        word
    };
    corners.flat_map(|corner| axes.map(|axes| path(corner, axes))).collect()
}

/// The suspension: two cones from new vertices.
pub(crate) fn suspension(words: &[Word]) -> Vec<Word> {
    let apex = words.iter().flatten().max().unwrap() + 1;
    words.iter().flat_map(|word| [apex, apex + 1].map(|apex| [word.as_slice(), &[apex]].concat())).collect()
}

/// Puts a new vertex into the face of a word at the positions that `mask` names, and into all simplices around it.
pub(crate) fn subdivide(words: &mut Vec<Word>, at: usize, mask: usize) {
    let apex = words.iter().flatten().max().unwrap() + 1;
    let face: Word = words[at].iter().enumerate().filter(|&(k, _)| mask >> k & 1 == 1).map(|(_, &v)| v).collect();
    if face.len() < 2 {
        return;
    }
    let is_around = |word: &Word| face.iter().all(|vertex| word.contains(vertex));
    let (around, mut rest): (Vec<Word>, Vec<Word>) = words.drain(..).partition(is_around);
    for word in around {
        for out in &face {
            rest.push(word.iter().map(|vertex| if vertex == out { apex } else { *vertex }).collect());
        }
    }
    *words = rest;
}

/// Closed orientable quasi-manifolds of dimensions 2 to 4, with numbers of vertices and orders of words that mean nothing.
pub(crate) fn closed(dims: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Vec<Word>> {
    let two_spheres = |dim: u32| [sphere(0, dim + 2), sphere(dim + 2, dim + 2)].concat();
    let all = [
        (2, sphere(0, 4)),
        (2, torus()),
        (2, [torus(), sphere(7, 4)].concat()),
        (2, two_spheres(2)),
        (3, sphere(0, 5)),
        (3, suspension(&torus())),
        (3, suspension(&suspension(&sphere(0, 3)))),
        (4, sphere(0, 6)),
        (4, suspension(&suspension(&torus()))),
    ];
    let some: Vec<Vec<Word>> = all.into_iter().filter(|(dim, _)| dims.contains(dim)).map(|(_, words)| words).collect();
    let steps = prop::collection::vec((any::<Pick>(), 0_usize..32), 0..6);
    (prop::sample::select(some), steps, any::<u64>()).prop_map(|(mut words, steps, seed)| {
        for (at, mask) in steps {
            let at = at.index(words.len());
            subdivide(&mut words, at, mask);
        }
        shuffle(&mut words, seed);
        words
    })
}

/// Renames the vertices and turns the words, by a seed.
fn shuffle(words: &mut [Word], mut seed: u64) {
    let mut below = |count: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % count
    };
    let vertices: BTreeSet<u32> = words.iter().flatten().copied().collect();
    let mut names: Vec<u32> = (0..vertices.len() as u32).collect();
    for at in (1..names.len()).rev() {
        names.swap(at, below(at + 1));
    }
    let names: BTreeMap<u32, u32> = vertices.into_iter().zip(names).collect();
    for word in words {
        word.iter_mut().for_each(|vertex| *vertex = names[vertex]);
        let len = word.len();
        word.rotate_left(below(len));
    }
}

/// All nonempty faces of some words by (dimension, word): the simplices in the order of their ids.
pub(crate) fn faces(words: &[Word]) -> Vec<Word> {
    let mut faces = BTreeSet::new();
    for word in words {
        let mut word = word.clone();
        word.sort_unstable();
        word.dedup();
        for subset in 1_usize..1 << word.len() {
            let face: Word = word.iter().enumerate().filter(|&(k, _)| subset >> k & 1 == 1).map(|(_, &v)| v).collect();
            faces.insert((face.len(), face));
        }
    }
    faces.into_iter().map(|(_, face)| face).collect()
}

pub(crate) fn is_face(face: &[u32], of: &[u32]) -> bool {
    face.iter().all(|vertex| of.contains(vertex))
}

/// Checks that a map is one, and that its cells are its orbits.
pub(crate) fn assert_is_map(map: &CombinatorialMap) {
    let n = map.dim();
    let darts: Vec<DartId> = map.darts().collect();
    assert_eq!(darts.len(), map.num_darts());
    let beta = |i: usize, dart: DartId| map.beta(i, dart).unwrap();
    for i in 1..=n {
        let images: BTreeSet<DartId> = darts.iter().map(|&dart| beta(i, dart)).collect();
        assert!(images.into_iter().eq(darts.iter().copied()), "β{i} is no permutation");
        for &dart in darts.iter().filter(|_| i > 1) {
            assert!(beta(i, beta(i, dart)) == dart && beta(i, dart) != dart, "β{i} at dart {dart}");
        }
        for j in i + 2..=n {
            let twice = |dart| beta(i, beta(j, dart));
            assert!(darts.iter().all(|&dart| twice(twice(dart)) == dart), "β{i} ∘ β{j} is no involution");
        }
    }
    for dim in 0..=n {
        let orbits = orbits(map, dim);
        let cells: BTreeMap<SimplexId, BTreeSet<DartId>> =
            darts.iter().fold(BTreeMap::new(), |mut cells: BTreeMap<_, BTreeSet<_>>, &dart| {
                cells.entry(map.cell(dart, dim).unwrap()).or_default().insert(dart);
                cells
            });
        assert_eq!(cells.values().cloned().collect::<BTreeSet<_>>(), orbits, "cells of dimension {dim}");
        assert!(map.cells(dim).eq(cells.keys().copied()), "cells of dimension {dim}");
        assert_eq!(map.num_cells(dim), cells.len());
        let mut walk = sig_tools::combinatorial_map::Walk::new();
        for (&cell, darts) in &cells {
            assert!(darts.contains(&map.dart_of(cell).unwrap()));
            assert_eq!(map.dim_of(cell), Some(dim));
            let found: Vec<DartId> = map.darts_of(cell, &mut walk).collect();
            assert_eq!(found.len(), darts.len());
            assert_eq!(&found.into_iter().collect::<BTreeSet<_>>(), darts);
        }
    }
}

/// The orbits of section 2 of mcc-2012, by joining a dart with its images until nothing changes.
fn orbits(map: &CombinatorialMap, dim: usize) -> BTreeSet<BTreeSet<DartId>> {
    let n = map.dim();
    let inverse: BTreeMap<DartId, DartId> = map.darts().map(|dart| (map.beta(1, dart).unwrap(), dart)).collect();
    let mut least: BTreeMap<DartId, DartId> = map.darts().map(|dart| (dart, dart)).collect();
    loop {
        let before = least.clone();
        for dart in map.darts() {
            let images: Vec<DartId> = if dim == 0 {
                (2..=n).map(|i| map.beta(i, inverse[&dart]).unwrap()).collect()
            } else {
                (1..=n).filter(|&i| i != dim).map(|i| map.beta(i, dart).unwrap()).collect()
            };
            for image in images {
                let both = least[&dart].min(least[&image]);
                least.insert(dart, both);
                least.insert(image, both);
            }
        }
        if least == before {
            break;
        }
    }
    let mut orbits: BTreeMap<DartId, BTreeSet<DartId>> = BTreeMap::new();
    for (dart, least) in least {
        orbits.entry(least).or_default().insert(dart);
    }
    orbits.into_values().collect()
}

/// The vertices of a simplex.
pub(crate) fn word_of(complex: &Complex<'_, u16>, simplex: SimplexId) -> Word {
    complex.vertices(simplex).map(|vertex: VertexId| vertex.index() as u32).collect()
}
