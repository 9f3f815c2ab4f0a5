//! Spaces whose homology is known.

use std::path::Path;

use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::homology::{Cells, Coefficients, Homology, HomologyError, HomologyOptions, homology, is_prime};
use sig_tools::io::{ReadOptions, read_bytes, read_path};
use sig_tools::soup::Soup;

pub(crate) fn of_soup(soup: Soup) -> CellComplex {
    CellComplex::from_built(&build(soup, &BuildOptions::default()).unwrap()).unwrap()
}

/// The complex of simplices, one a line.
pub(crate) fn of_text(text: &str) -> CellComplex {
    of_soup(read_bytes(text.as_bytes(), "test.simplices", &ReadOptions::default()).unwrap().0)
}

fn of_file(name: &str) -> CellComplex {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name);
    of_soup(read_path(path, &ReadOptions { drop_degenerate: true, ..ReadOptions::default() }).unwrap().0)
}

/// Words of one-digit vertices.
pub(crate) fn of_words(words: &str) -> CellComplex {
    let line = |word: &str| word.chars().map(|digit| digit.to_string()).collect::<Vec<_>>().join(" ");
    of_text(&words.split_whitespace().map(line).collect::<Vec<_>>().join("\n"))
}

fn of_cells(text: &str) -> CellComplex {
    read_cells(text.as_bytes(), "test.cells").unwrap()
}

pub(crate) fn over(complex: &CellComplex, over: Coefficients) -> Homology {
    homology(&Cells::new(complex), &HomologyOptions { over, ..Default::default() }).unwrap()
}

/// Checks Betti numbers and torsion, dimension by dimension, and over fields what follows by universal coefficients.
pub(crate) fn check(complex: &CellComplex, betti: &[usize], torsion: &[&[u32]]) {
    let found = over(complex, Coefficients::Integers);
    assert_eq!(found.betti, betti);
    let text = |factors: &[u32]| factors.iter().map(|&factor| factor.into()).collect::<Vec<_>>();
    assert_eq!(found.torsion, torsion.iter().map(|factors| text(factors)).collect::<Vec<_>>());
    assert_eq!(found.counts, complex.counts());
    assert_eq!(found.euler_characteristic(), complex.euler_characteristic());
    assert_eq!(over(complex, Coefficients::Rationals).betti, betti);
    crate::cycles::check(complex);
    for prime in [2, 3, 5, 4_294_967_291] {
        let divisible = |dim: usize| torsion[dim].iter().filter(|&&factor| factor % prime == 0).count();
        let expected: Vec<usize> =
            (0..betti.len()).map(|dim| betti[dim] + divisible(dim) + dim.checked_sub(1).map_or(0, divisible)).collect();
        let found = over(complex, Coefficients::Prime(prime));
        assert_eq!(found.betti, expected, "over Z/{prime}");
        assert!(found.torsion.iter().all(Vec::is_empty));
    }
}

pub(crate) fn without_torsion(complex: &CellComplex, betti: &[usize]) {
    check(complex, betti, &vec![&[][..]; betti.len()]);
}

#[test]
fn spheres() {
    without_torsion(&of_text("a\nb"), &[2]);
    for dim in 1..6 {
        let facet = |omitted: usize| {
            (0..dim + 2)
                .filter(|&vertex| vertex != omitted)
                .map(|vertex| vertex.to_string())
                .collect::<Vec<_>>()
                .join(" ")
        };
        let facets = (0..dim + 2).map(facet).collect::<Vec<_>>().join("\n");
        let mut betti = vec![0; dim + 1];
        (betti[0], betti[dim]) = (1, 1);
        without_torsion(&of_text(&facets), &betti);
    }
}

#[test]
fn small_and_empty() {
    without_torsion(&of_text(""), &[]);
    without_torsion(&of_text("a"), &[1]);
    without_torsion(&of_text("a b c\nd e\nf"), &[3, 0, 0]);
    // One vertex, two loops, one of them twice the boundary of a disk.
    check(&of_cells("cells 1 2 1\n+0 -0\n+0 -0\n2*+0\n"), &[1, 1, 0], &[&[], &[2], &[]]);
    // A sphere of one 2-cell, and one whose cell has a loop on either side.
    without_torsion(&of_cells("cells 1 0 1\n.\n"), &[1, 0, 1]);
    without_torsion(&of_cells("cells 1 1 1\n+0 -0\n+0 -0\n"), &[1, 1, 1]);
}

#[test]
fn surfaces() {
    let torus = "013 124 235 346 450 561 602 023 134 245 356 460 501 612";
    without_torsion(&of_words(torus), &[1, 2, 1]);
    check(&of_words("012 023 034 045 015 124 235 134 245 135"), &[1, 0, 0], &[&[], &[2], &[]]);
    check(&of_cells("cells 1 2 1\n+0 -0\n+0 -0\n+0 +1 +0 -1\n"), &[1, 1, 0], &[&[], &[2], &[]]);
    without_torsion(&of_file("goathead.obj"), &[1, 0, 1]);
    without_torsion(&of_file("trimesh_octagonal_pocket.ply"), &[2, 2, 0]);
}

/// The Betti numbers of `tests/data/README.md`, which another program established.
#[test]
fn meshes() {
    without_torsion(&of_file("torus.msh"), &[1, 1, 0, 0]);
    without_torsion(&of_file("gmsh_mixed_bracket_h0.9.msh"), &[1, 9, 0, 0]);
    without_torsion(&of_file("trimesh_angle_block.STL"), &[1, 38, 0]);
}

/// H_i(L(p,1)) = ℤ, ℤ_p, 0, ℤ.
#[test]
fn lens_spaces() {
    for p in [2_u32, 3, 5, 12] {
        let text = format!("cells 1 1 1 1\n+0 -0\n{p}*+0\n+0 -0\n");
        check(&of_cells(&text), &[1, 0, 0, 1], &[&[], &[p], &[], &[]]);
    }
}

/// The headers of the files in the Library of Triangulations.
#[test]
fn library_of_triangulations() {
    without_torsion(&of_file("poincare"), &[1, 0, 0, 1]);
    without_torsion(&of_file("bing"), &[1, 0, 0, 0]);
    without_torsion(&of_file("two_optima"), &[1, 0, 0, 0]);
    without_torsion(&of_file("dunce_hat"), &[1, 0, 0]);
    without_torsion(&of_file("K3_16"), &[1, 0, 22, 0, 1]);
    check(&of_file("RP5_24"), &[1, 0, 0, 0, 0, 1], &[&[], &[2], &[], &[2], &[], &[]]);
    check(&of_file("hyperbolic_dodecahedral_space"), &[1, 0, 0, 1], &[&[], &[5, 5, 5], &[], &[]]);
}

/// W. Kühnel and T. F. Banchoff, *The 9-vertex complex projective plane*, 1983.
#[test]
fn complex_projective_plane() {
    let facets = "12456 45789 78123 23564 56897 89231 31645 64978 97312 12459 45783 78126 \
                  23567 56891 89234 31648 64972 97315 23649 56973 89316 31457 64781 97124 \
                  12568 45892 78235 31569 64893 97236 12647 45971 78314 23458 56782 89125";
    without_torsion(&of_words(facets), &[1, 0, 1, 0, 1]);
}

/// J. Shareshian and M. L. Wachs, *Torsion in the matching complex and chessboard complex*, 2007.
#[test]
fn chessboard_and_matching_complexes() {
    // Five rooks that do not attack each other, on squares named by row and column.
    let mut facets = Vec::new();
    permutations(&mut vec![], &mut facets);
    let chessboard = of_text(&facets.join("\n"));
    let found = over(&chessboard, Coefficients::Integers);
    // f = (25, 200, 600, 600, 120), χ = −55; H_1 = 0, H_2 = ℤ_3.
    assert_eq!(found.betti[..3], [1, 0, 0]);
    assert_eq!(found.torsion[2], [3_u32.into()]);
    assert_eq!(found.euler_characteristic(), -55);
    crate::oracle::agrees(&chessboard);
    // Matchings of the complete graph on seven vertices.
    let edges: Vec<(u32, u32)> = (0..7).flat_map(|a| (a + 1..7).map(move |b| (a, b))).collect();
    let disjoint = |one: (u32, u32), other: (u32, u32)| {
        one.0 != other.0 && one.0 != other.1 && one.1 != other.0 && one.1 != other.1
    };
    let mut triples = Vec::new();
    for (at, &one) in edges.iter().enumerate() {
        for (next, &two) in edges.iter().enumerate().skip(at + 1).filter(|(_, two)| disjoint(one, **two)) {
            for &three in edges[next + 1..].iter().filter(|&&three| disjoint(one, three) && disjoint(two, three)) {
                triples.push([one, two, three].map(|(a, b)| format!("{a}{b}")).join(" "));
            }
        }
    }
    assert_eq!(triples.len(), 105);
    check(&of_text(&triples.join("\n")), &[1, 0, 20], &[&[], &[3], &[]]);
}

fn permutations(so_far: &mut Vec<usize>, facets: &mut Vec<String>) {
    if so_far.len() == 5 {
        facets.push(
            so_far.iter().enumerate().map(|(row, column)| format!("{row}{column}")).collect::<Vec<_>>().join(" "),
        );
    }
    for column in (0..5).filter(|column| !so_far.contains(column)).collect::<Vec<_>>() {
        so_far.push(column);
        permutations(so_far, facets);
        so_far.pop();
    }
}

/// Chains that wind round a million times, each round the one before: numbers beyond 64 bits on the way, and factors there.
#[test]
fn numbers_of_any_size() {
    let loops = 12;
    let mut text = format!("cells 1 {loops} {loops}\n");
    text += &"+0 -0\n".repeat(loops);
    for number in 0..loops {
        text += &match number {
            0 => "1000003*+0\n".to_owned(),
            _ => format!("1000003*+{number} -{}\n", number - 1),
        };
    }
    let found = over(&of_cells(&text), Coefficients::Integers);
    // The matrix has determinant 1000003^12 and a minor of 11 units.
    assert_eq!(found.betti, [1, 0, 0]);
    assert_eq!(found.torsion[1], [sig_tools::homology::BigInt::from(1_000_003).pow(12)]);
}

/// H_i(B, ∂B) of a ball is that of a sphere; of a disk relative to a boundary edge, nothing.
#[test]
fn relative() {
    let ball = of_text("0 1 2 3");
    let relative = |marks: &[Vec<bool>]| {
        homology(&Cells::new(&ball), &HomologyOptions { relative_to: Some(marks), ..Default::default() })
    };
    let mut marks = vec![vec![true; 4], vec![true; 6], vec![true; 4], vec![false]];
    assert_eq!(relative(&marks).unwrap().betti, [0, 0, 0, 1]);
    marks[2][3] = false;
    assert_eq!(relative(&marks).unwrap().betti, [0, 0, 0, 0]);
    marks[2] = vec![false; 4];
    assert_eq!(relative(&marks).unwrap().betti, [0, 0, 3, 0]);
    marks[0][0] = false;
    assert_eq!(relative(&marks), Err(HomologyError::NotClosed { dim: 1, cell: 0 }));
    assert_eq!(relative(&marks[..3]), Err(HomologyError::MalformedSubcomplex));
    // ℝP² relative to a projective line is a sphere relative to a point.
    let plane = of_cells("cells 1 1 1\n+0 -0\n2*+0\n");
    let line = [vec![true], vec![true], vec![false]];
    let options = HomologyOptions { relative_to: Some(&line), ..Default::default() };
    assert_eq!(homology(&Cells::new(&plane), &options).unwrap().betti, [0, 0, 1]);
}

#[test]
fn coefficients_must_be_a_field() {
    let point = of_text("a");
    for number in [0, 1, 4, 9, 4_294_967_295] {
        let options = HomologyOptions { over: Coefficients::Prime(number), ..Default::default() };
        assert_eq!(homology(&Cells::new(&point), &options), Err(HomologyError::NotPrime(number)));
    }
    assert!([2, 3, 65_537, 4_294_967_291].into_iter().all(is_prime));
}
