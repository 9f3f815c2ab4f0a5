//! The relations of all simplices at once are those of each by its definition, whatever the size of the blocks.

use std::convert::Infallible;

use proptest::prelude::*;
use sig_core::{AnyComplex, Complex, Index, IndexWidth, SimplexId, with_complex};
use sig_tests::encode::{Options, encode};
use sig_tests::oracle::Oracle;
use sig_tests::strategies;
use sig_tools::build::{BuildOptions, build};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::sweep::{Block, Sweep};
use sig_tools::{Loaded, OwnedScratch};

/// The simplices of blocks with their answers.
type Answers = Vec<(usize, Vec<usize>)>;

fn answers<I: Index>(block: &Block<'_, I>) -> Answers {
    assert_eq!(block.first().index(), block.iter().next().unwrap().0.index());
    assert_eq!(block.ids().len(), block.starts().last().unwrap() - block.starts()[0]);
    block.iter().map(|(simplex, ids)| (simplex.index(), ids.iter().map(|id| id.to_usize()).collect())).collect()
}

/// All answers of a sweep, in the order in which they come.
fn all(sweep: impl FnOnce(&mut dyn FnMut(Answers) -> Result<(), Infallible>) -> Result<(), Infallible>) -> Answers {
    let mut all = Vec::new();
    let Ok(()) = sweep(&mut |block| {
        all.extend(block);
        Ok(())
    });
    all
}

fn check_sweeps<I: Index>(complex: &Complex<'_, I>, oracle: &Oracle, block: usize) {
    let sweep = Sweep::new(complex).with_block(block);
    for dim in 0..oracle.dims() + 2 {
        let expect = |relation: &dyn Fn(usize) -> Vec<usize>| -> Answers {
            let simplices = if dim < oracle.dims() { oracle.of_dim(dim) } else { Vec::new() };
            simplices.into_iter().map(|simplex| (simplex, relation(simplex))).collect()
        };
        let stars = all(|each| sweep.star(dim, answers, each));
        assert_eq!(stars, expect(&|simplex| oracle.star(simplex)), "stars, dimension {dim}");
        for above in 0..oracle.dims() + 2 {
            let cofaces = all(|each| sweep.coboundary(dim, above, answers, each));
            let expected = expect(&|simplex| if above > dim { oracle.coboundary(simplex, above) } else { Vec::new() });
            assert_eq!(cofaces, expected, "C_{dim},{above}");
        }
        let mut adjacent = all(|each| sweep.adjacency(dim, answers, each));
        if dim > 0 {
            adjacent.iter_mut().for_each(|(_, found)| found.sort_unstable());
        }
        assert_eq!(adjacent, expect(&|simplex| oracle.adjacency(simplex)), "A_{dim}");
    }
}

fn check(oracle: &Oracle, width: IndexWidth, block: usize) {
    for pairs in [false, true].into_iter().filter(|pairs| !pairs || oracle.is_thin()) {
        for tree in [false, true] {
            let bytes = encode(oracle, &Options { tree, lower: tree, pairs, ..Options::bare(width) });
            with_complex!(AnyComplex::from_bytes(&bytes).unwrap(), complex => check_sweeps(&complex, oracle, block));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn of_random_complexes(simplices in strategies::simplices(), width in 0..3usize, block in 0..40usize) {
        check(&Oracle::new(&simplices), IndexWidth::ALL[width], block);
    }
}

#[test]
fn of_the_least_complexes() {
    let cases: [&[&[usize]]; 7] = [
        &[],
        &[&[0]],
        &[&[0], &[1], &[2]],
        &[&[0, 1], &[2]],
        &[&[0, 1, 2], &[2, 3], &[4]],
        &[&[0, 1, 2, 3, 4, 5]],
        &[&[0, 1, 2, 3, 4, 5, 6], &[1, 2, 3, 4, 5, 6, 7]],
    ];
    for simplices in cases {
        for block in [1, 7, 1 << 20] {
            check(&Oracle::new(simplices), IndexWidth::Bits16, block);
        }
    }
}

/// Books: pages that share an edge, fewer and more than are copied at once, on edges of every number.
#[test]
fn of_books() {
    for pages in [7, 8, 9, 10, 16, 17, 18, 40] {
        for [one, other] in [[0, 1], [0, pages + 1], [pages, pages + 1], [3, 5]] {
            let points = (0..pages + 2).filter(|point| ![one, other].contains(point));
            let book: Vec<[usize; 3]> = points.map(|point| [one, other, point]).collect();
            check(&Oracle::new(&book), IndexWidth::Bits32, 64);
        }
    }
}

/// Vertices in the order of a mesh, blocks of the usual size and of many kinds: the queries of the core are the oracle.
#[test]
fn of_a_grid_agree_with_the_core() {
    let side = 13_u32;
    let steps = [1, side, side * side];
    let mut soup = Soup::new(Labels::Numbered((side * side * side) as usize), true);
    for corner in (0..side * side * side).filter(|v| steps.iter().all(|step| v / step % side < side - 1)) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let (one, two) = (corner + steps[a], corner + steps[a] + steps[b]);
            soup.push(&[corner, one, two, two + steps[c]]);
        }
    }
    let built = build(soup, &BuildOptions::default()).unwrap();
    let file = Encoding::new(&built, &EncodeOptions::default()).unwrap();
    let file = Loaded::from_file_bytes(file.to_bytes().unwrap()).unwrap();
    with_complex!(file.complex().unwrap(), complex => {
        let mut memory = OwnedScratch::new(&complex);
        let mut scratch = memory.scratch();
        for block in [500, 20_000, 1 << 19] {
            let sweep = Sweep::new(&complex).with_block(block);
            for dim in 0..4 {
                let same = |simplex: usize, mut expected: Vec<SimplexId>, mut found: Vec<usize>| {
                    expected.sort_unstable();
                    found.sort_unstable();
                    assert_eq!(found, expected.iter().map(|id| id.index()).collect::<Vec<_>>(), "#{simplex}");
                };
                for (id, found) in all(|each| sweep.star(dim, answers, each)) {
                    same(id, complex.star(SimplexId::new(id), &mut scratch).unwrap().collect(), found);
                }
                for (id, found) in all(|each| sweep.adjacency(dim, answers, each)) {
                    same(id, complex.adjacency(SimplexId::new(id), &mut scratch).unwrap().collect(), found);
                }
            }
        }
    });
}

/// An error of the second function ends the sweep and comes out.
#[test]
fn errors_end_a_sweep() {
    let bytes = encode(&Oracle::new(&[[0, 1, 2], [1, 2, 3]]), &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let mut blocks = 0;
    let stopped = Sweep::new(&complex).with_block(1).star(0, answers, |_| {
        blocks += 1;
        if blocks == 2 { Err("enough") } else { Ok(()) }
    });
    assert_eq!((stopped, blocks), (Err("enough"), 2));
}
