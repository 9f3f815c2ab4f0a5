//! Random complexes: Betti numbers by ranks modulo primes, torsion by minors.

use proptest::prelude::*;
use sig_core::{Dim, with_complex};
use sig_tools::Loaded;
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::homology::{BigInt, Coefficients, HomologyOptions, Simplices, homology};
use sig_tools::io::{ReadOptions, read_bytes};
use sig_tools::store::{EncodeOptions, Encoding};

use crate::betti::betti;
use crate::known::over;

/// Some simplices on few vertices, which gives holes, torsion now and then, and mixed dimensions.
fn simplices() -> impl Strategy<Value = Vec<Vec<u8>>> {
    let word = prop::collection::btree_set(0..9_u8, 1..5).prop_map(|word| word.into_iter().collect());
    prop::collection::vec(word, 1..40)
}

fn text(simplices: &[Vec<u8>]) -> String {
    let line = |word: &Vec<u8>| word.iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    simplices.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// β_i over ℤ/p is β_i and the factors of H_i and of H_{i−1} that p divides.
fn universal(betti: &[usize], torsion: &[Vec<BigInt>], prime: u32) -> Vec<usize> {
    let zero = BigInt::from(0);
    let divisible = |dim: Dim| torsion[dim].iter().filter(|&factor| factor % prime == zero).count();
    (0..betti.len()).map(|dim| betti[dim] + divisible(dim) + dim.checked_sub(1).map_or(0, divisible)).collect()
}

/// Checks the homology against ranks.
pub(crate) fn agrees(complex: &CellComplex) {
    let integers = over(complex, Coefficients::Integers);
    crate::cycles::check(complex);
    for prime in [2_u32, 3, 5] {
        let expected = betti(complex, prime.into());
        assert_eq!(over(complex, Coefficients::Prime(prime)).betti, expected, "over Z/{prime}");
        assert_eq!(universal(&integers.betti, &integers.torsion, prime), expected, "from Z to Z/{prime}");
    }
}

proptest! {
    #[test]
    fn simplicial_complexes(simplices in simplices()) {
        let text = text(&simplices);
        let built = || build(read_bytes(text.as_bytes(), "a.simplices", &ReadOptions::default()).unwrap().0, &BuildOptions::default()).unwrap();
        let complex = CellComplex::from_built(&built()).unwrap();
        agrees(&complex);
        // The same from a file.
        let bytes = Encoding::new(&built(), &EncodeOptions::default()).unwrap().to_bytes().unwrap();
        let file = Loaded::from_file_bytes(bytes).unwrap();
        let of_file = with_complex!(file.complex().unwrap(), complex => {
            homology(&Simplices(&complex), &HomologyOptions::default()).unwrap()
        });
        prop_assert_eq!(of_file, over(&complex, Coefficients::Integers));
    }

    /// Relative to a subcomplex, homology is the reduced homology of the complex with a cone on the subcomplex.
    #[test]
    fn relative_is_the_homology_of_the_cone(simplices in simplices(), part in 1..20_usize) {
        let sub = &simplices[..part.min(simplices.len())];
        let whole = text(&simplices);
        let coned: Vec<Vec<u8>> = sub.iter().map(|word| [&word[..], &[99]].concat()).collect();
        let coned = format!("{whole}\n{}", text(&coned));
        let complex = |text: &str| {
            let soup = read_bytes(text.as_bytes(), "a.simplices", &ReadOptions::default()).unwrap().0;
            CellComplex::from_built(&build(soup, &BuildOptions::default()).unwrap()).unwrap()
        };
        let soup = read_bytes(whole.as_bytes(), "a.simplices", &ReadOptions::default()).unwrap().0;
        let built = build(soup, &BuildOptions::default()).unwrap();
        let file = Loaded::from_file_bytes(Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap()).unwrap();
        let relative = with_complex!(file.complex().unwrap(), complex => {
            let mut marks: Vec<Vec<bool>> =
                (0..=complex.dim().unwrap()).map(|dim| vec![false; complex.num_simplices_of_dim(dim)]).collect();
            for word in sub {
                let labels: Vec<String> = word.iter().map(u8::to_string).collect();
                let labels: Vec<&str> = labels.iter().map(String::as_str).collect();
                for face in complex.closure(sig_tools::names::find_simplex(&complex, &labels).unwrap()) {
                    let dim = complex.dim_of(face).unwrap();
                    marks[dim][face.index() - complex.simplices_of_dim(dim).bounds().0.index()] = true;
                }
            }
            homology(&Simplices(&complex), &HomologyOptions { relative_to: Some(&marks), ..Default::default() }).unwrap()
        });
        let mut of_cone = over(&complex(&coned), Coefficients::Integers);
        // Reduced homology has a component less.
        of_cone.betti[0] -= 1;
        let dims = relative.betti.len();
        prop_assert_eq!(&of_cone.betti[..dims], &relative.betti[..]);
        prop_assert_eq!(&of_cone.torsion[..dims], &relative.torsion[..]);
        prop_assert!(of_cone.betti[dims..].iter().all(|&betti| betti == 0));
    }

    /// A bouquet of circles with disks on it: H_1 is the cokernel of any matrix. Its invariant factors are quotients of the
    /// greatest common divisors of the minors of each size.
    #[test]
    fn torsion_is_that_of_minors(matrix in prop::collection::vec(prop::collection::vec(-6..7_i64, 3), 3)) {
        let mut text = "cells 1 3 3\n+0 -0\n+0 -0\n+0 -0\n".to_owned();
        for row in &matrix {
            let sign = |entry: i64| if entry < 0 { '-' } else { '+' };
            let entries = row.iter().enumerate().filter(|(_, entry)| **entry != 0);
            let words: Vec<_> = entries.map(|(at, &entry)| format!("{}*{}{at}", entry.abs(), sign(entry))).collect();
            text += &if words.is_empty() { ".\n".to_owned() } else { words.join(" ") + "\n" };
        }
        let complex = read_cells(text.as_bytes(), "a.cells").unwrap();
        agrees(&complex);
        let divisors = minors(&matrix);
        let rank = divisors.iter().take_while(|&&divisor| divisor != 0).count();
        let factors = (0..rank).map(|at| divisors[at] / at.checked_sub(1).map_or(1, |before| divisors[before]));
        let expected: Vec<BigInt> = factors.filter(|&factor| factor != 1).map(BigInt::from).collect();
        let found = over(&complex, Coefficients::Integers);
        prop_assert_eq!(&found.torsion[1], &expected);
        prop_assert_eq!(&found.betti, &[1, 3 - rank, 3 - rank]);
    }
}

/// The greatest common divisor of the minors of size 1, 2 and 3.
fn minors(m: &[Vec<i64>]) -> [i64; 3] {
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let two = |(a, b): (usize, usize), (c, d): (usize, usize)| m[a][c] * m[b][d] - m[a][d] * m[b][c];
    let three = (0..3).map(|at| {
        let others = [(1, 2), (0, 2), (0, 1)][at];
        [1, -1, 1][at] * m[0][at] * two((1, 2), others)
    });
    let gcd = |a: i64, b: i64| {
        let (mut a, mut b) = (a.abs(), b.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    [
        m.iter().flatten().fold(0, |sum, &entry| gcd(sum, entry)),
        pairs.iter().flat_map(|&rows| pairs.map(|columns| two(rows, columns))).fold(0, gcd),
        three.sum::<i64>().abs(),
    ]
}
