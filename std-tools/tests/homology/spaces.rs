//! Spaces of any size: tori, Klein bottles, surfaces with handles.

use std::collections::BTreeMap;

use sig_core::with_complex;
use sig_tools::Loaded;
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::CellComplex;
use sig_tools::homology::{Homology, HomologyOptions, Simplices, homology};
use sig_tools::io::{ReadOptions, read_bytes};
use sig_tools::store::{EncodeOptions, Encoding};

use crate::known::{check, of_text, without_torsion};

/// All orders of the axes.
fn orders(dim: usize) -> Vec<Vec<usize>> {
    let mut orders = vec![Vec::new()];
    for axis in 0..dim {
        let insert = |order: Vec<usize>| (0..=axis).map(move |at| [&order[..at], &[axis], &order[at..]].concat());
        orders = orders.into_iter().flat_map(insert).collect();
    }
    orders
}

/// The corners of the simplices of the Freudenthal triangulation of a cube.
fn cube(corner: &[usize]) -> Vec<Vec<Vec<usize>>> {
    let path = |order: Vec<usize>| {
        let mut at = corner.to_vec();
        let mut path = vec![at.clone()];
        for axis in order {
            at[axis] += 1;
            path.push(at.clone());
        }
        path
    };
    orders(corner.len()).into_iter().map(path).collect()
}

/// All points of a grid.
fn grid(sides: &[usize]) -> Vec<Vec<usize>> {
    sides.iter().fold(vec![Vec::new()], |points, &side| {
        points.into_iter().flat_map(|point| (0..side).map(move |x| [&point[..], &[x]].concat())).collect()
    })
}

fn text(simplices: impl Iterator<Item = Vec<String>>) -> String {
    simplices.map(|words| words.join(" ")).collect::<Vec<_>>().join("\n")
}

fn name(point: &[usize]) -> String {
    point.iter().map(usize::to_string).collect::<Vec<_>>().join("_")
}

/// The torus of `side`^`dim` cubes, each made of simplices; `side` is 3 or more.
pub(crate) fn torus(dim: usize, side: usize) -> CellComplex {
    let point = |point: &Vec<usize>| name(&point.iter().map(|x| x % side).collect::<Vec<_>>());
    let simplices = grid(&vec![side; dim]).into_iter().flat_map(|corner| cube(&corner));
    of_text(&text(simplices.map(|path| path.iter().map(point).collect())))
}

/// β_i of a torus is a binomial coefficient.
#[test]
fn tori() {
    without_torsion(&torus(1, 5), &[1, 1]);
    without_torsion(&torus(2, 4), &[1, 2, 1]);
    without_torsion(&torus(3, 3), &[1, 3, 3, 1]);
    let four = crate::known::over(&torus(4, 3), sig_tools::homology::Coefficients::Integers);
    assert_eq!(four.betti, [1, 4, 6, 4, 1]);
    assert!(four.torsion.iter().all(Vec::is_empty));
}

/// H_1 of the Klein bottle is ℤ + ℤ/2.
#[test]
fn klein_bottle() {
    let side = 5;
    let point = |point: &Vec<usize>| {
        let (x, y) = (point[0], point[1]);
        // At the seam the circle turns round.
        if x < side { name(&[x, y % side]) } else { name(&[0, (side - y % side) % side]) }
    };
    let simplices = grid(&[side, side]).into_iter().flat_map(|corner| cube(&corner));
    let bottle = of_text(&text(simplices.map(|path| path.iter().map(point).collect())));
    check(&bottle, &[1, 1, 0], &[&[], &[2], &[]]);
}

/// The homology of a file with its simplices, on so many threads.
fn of_file(text: &str, threads: usize) -> Homology {
    let soup = read_bytes(text.as_bytes(), "a.simplices", &ReadOptions::default()).unwrap().0;
    let built = build(soup, &BuildOptions::default()).unwrap();
    let file =
        Loaded::from_file_bytes(Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap()).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        with_complex!(file.complex().unwrap(), complex => {
            homology(&Simplices(&complex), &HomologyOptions::default()).unwrap()
        })
    })
}

/// A plate with g holes, and its boundary, the closed surface of genus g; the same on any number of threads.
#[test]
fn plates_with_holes() {
    let (genus, scale) = (12, 4);
    let sides = [(2 * genus + 1) * scale, 3 * scale, scale];
    let is_solid = |corner: &Vec<usize>| !(corner[1] / scale == 1 && corner[0] / scale % 2 == 1);
    let tetrahedra: Vec<Vec<Vec<usize>>> =
        grid(&sides).into_iter().filter(is_solid).flat_map(|corner| cube(&corner)).collect();
    let plate = text(tetrahedra.iter().map(|path| path.iter().map(|point| name(point)).collect()));
    let found = of_file(&plate, 1);
    assert_eq!(found.betti, [1, genus, 0, 0]);
    assert_eq!(found, of_file(&plate, 3));
    let mut triangles: BTreeMap<Vec<String>, usize> = BTreeMap::new();
    for path in &tetrahedra {
        for omitted in 0..4 {
            let kept = (0..4).filter(|&at| at != omitted).map(|at| name(&path[at]));
            *triangles.entry(kept.collect()).or_default() += 1;
        }
    }
    let surface = text(triangles.into_iter().filter(|(_, count)| *count == 1).map(|(triangle, _)| triangle));
    let found = of_file(&surface, 2);
    assert_eq!(found.betti, [1, 2 * genus, 1]);
    assert!(found.torsion.iter().all(Vec::is_empty));
    assert_eq!(found, of_file(&surface, 1));
}
