//! Complexes to test on.

use proptest::prelude::*;
use sig_tools::soup::{Labels, Soup};

/// The simplices on `count` declared vertices.
pub(crate) fn soup(count: usize, simplices: &[Vec<u32>]) -> Soup {
    let mut soup = Soup::new(Labels::Numbered(count), true);
    for simplex in simplices {
        soup.push(simplex);
    }
    soup
}

/// Simplices whose vertices are the digits (and letters) of the words.
pub(crate) fn words(words: &[&str]) -> Vec<Vec<u32>> {
    words.iter().map(|word| word.chars().map(|digit| digit.to_digit(36).unwrap()).collect()).collect()
}

/// The soup of the given words on as many vertices as they name.
pub(crate) fn soup_of(names: &[&str]) -> Soup {
    let simplices = words(names);
    soup(simplices.iter().flatten().max().map_or(0, |&most| most as usize + 1), &simplices)
}

/// The cone from a new vertex over simplices.
pub(crate) fn cone(base: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let apex = base.iter().flatten().max().unwrap() + 1;
    base.iter().map(|simplex| [simplex.as_slice(), &[apex]].concat()).collect()
}

/// The 7-vertex torus of Möbius and Császár: triangles {i, i+1, i+3} and {i, i+2, i+3} modulo 7.
pub(crate) fn torus() -> Vec<Vec<u32>> {
    (0..7).flat_map(|i| [vec![i, (i + 1) % 7, (i + 3) % 7], vec![i, (i + 2) % 7, (i + 3) % 7]]).collect()
}

/// The 12 lines of the affine plane over the field of three elements, on its 9 points.
pub(crate) fn affine_plane() -> Vec<Vec<u32>> {
    let point = |x: u32, y: u32| 3 * (x % 3) + y % 3;
    let mut lines: Vec<Vec<u32>> = (0..3).map(|x| (0..3).map(|y| point(x, y)).collect()).collect();
    for slope in 0..3 {
        lines.extend((0..3).map(|start| (0..3).map(|x| point(x, slope * x + start)).collect()));
    }
    lines
}

/// The Kuhn (Freudenthal) tetrahedra of a grid of k × l × m vertices.
pub(crate) fn kuhn_grid(k: u32, l: u32, m: u32) -> Soup {
    let mut soup = Soup::new(Labels::Numbered((k * l * m) as usize), true);
    let steps = [l * m, m, 1];
    for x in 0..k - 1 {
        for y in 0..l - 1 {
            for z in 0..m - 1 {
                let corner = x * steps[0] + y * steps[1] + z;
                for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let (one, two) = (corner + steps[a], corner + steps[a] + steps[b]);
                    soup.push(&[corner, one, two, two + steps[c]]);
                }
            }
        }
    }
    soup
}

/// Random mixed-dimensional simplices on few vertices, so that they meet in faces of every dimension: sets of up to
/// seven vertices, some glued to a random face of one before by new or old vertices.
pub(crate) fn simplices() -> impl Strategy<Value = Vec<Vec<u32>>> {
    let part = (any::<prop::sample::Index>(), 0_u32..128, prop::collection::btree_set(0_u32..14, 1..=7));
    prop::collection::vec(part, 0..12).prop_map(|parts| {
        let mut simplices: Vec<Vec<u32>> = Vec::new();
        for (earlier, mask, fresh) in parts {
            let mut simplex = Vec::new();
            if let Some(earlier) = simplices.get(earlier.index(simplices.len().max(1))) {
                let shared = earlier.iter().enumerate().filter(|&(k, _)| mask >> k & 1 == 1);
                simplex.extend(shared.map(|(_, &vertex)| vertex));
            }
            for vertex in fresh {
                if simplex.len() < 7 && !simplex.contains(&vertex) {
                    simplex.push(vertex);
                }
            }
            simplices.push(simplex);
        }
        simplices
    })
}
