//! Multi-resolution complexes: homology at every front, any order, least closed sets, files.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};

use proptest::prelude::*;
use sig_core::mark_words;
use sig_core::mcc::Mcc;
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::mcc::{
    BadRefinement, Drawing, Extent, Field, Free, Front, Length, MccFile, MultiResolution, Precision, SimplifyOptions,
    Strategy as Order, Types, apply_in_order, members, simplify, write_mcc,
};
use sig_tools::soup::{Coordinates, Scalars};
use sig_tools::store::AlignedBytes;

use crate::betti::both;
use crate::model::Model;
use crate::operators::complex;
use crate::samples::{kuhn_grid, simplices, soup, soup_of, torus};

/// Points that are not in order.
pub(crate) fn coordinates(vertices: usize) -> Coordinates {
    let values = (0..3 * vertices).map(|at| ((at * 7919 + 13) % 101) as f64).collect();
    Coordinates { dim: 3, values: Scalars::F64(values) }
}

/// Simplifies by one of the four criteria, in one of the four precisions.
pub(crate) fn simplified(full: &CellComplex, which: usize, strategy: Order, types: Types) -> MultiResolution {
    let precision = [Precision::Two, Precision::Exact, Precision::Four, Precision::Sixteen][which / 4];
    let options = SimplifyOptions { strategy, types, precision, ..Default::default() };
    let coordinates = coordinates(full.counts().first().copied().unwrap_or(0));
    match which % 4 {
        0 => simplify(full.clone(), &mut Free, &options),
        1 => simplify(full.clone(), &mut Extent::new(full, &coordinates), &options),
        2 => simplify(full.clone(), &mut Length::new(full, &coordinates), &options),
        _ => simplify(full.clone(), &mut Field::of_coordinate(full, &coordinates, 1), &options),
    }
    .0
}

pub(crate) fn in_bytes(complex: &MultiResolution, coordinates: Option<&Coordinates>) -> AlignedBytes {
    let mut bytes = Vec::new();
    write_mcc(complex, coordinates, &mut bytes).unwrap();
    AlignedBytes::read(&mut &bytes[..], bytes.len()).unwrap()
}

/// The same Betti numbers, but for dimensions that are gone.
fn assert_same_homology(full: &[Vec<usize>; 2], front: &CellComplex) {
    let padded = both(front).map(|mut betti| {
        betti.resize(full[0].len(), 0);
        betti
    });
    assert_eq!(full, &padded);
}

/// The full complex, with the cells renamed as the front has them.
fn renamed(full: &CellComplex, mcc: &Mcc<'_>) -> Model {
    let model = Model::of(full);
    let mut names = vec![sig_core::CellId::new(0); full.num_ids()];
    for number in 0..mcc.num_cells() as u32 {
        let cell = sig_core::CellId::new(number);
        names[mcc.origin(cell).unwrap()] = cell;
    }
    let dims = model.dims.iter().map(|(cell, &dim)| (names[cell.index()], dim)).collect();
    let labels = model.labels.iter().map(|(&(a, b), &label)| ((names[a.index()], names[b.index()]), label)).collect();
    Model { dims, labels }
}

/// The definition: everything that can be reached along direct dependencies.
pub(crate) fn closure(mcc: &Mcc<'_>, wanted: &BTreeSet<usize>) -> BTreeSet<usize> {
    let mut closed = BTreeSet::new();
    let mut open: Vec<usize> = wanted.iter().copied().collect();
    while let Some(refinement) = open.pop() {
        if closed.insert(refinement) {
            open.extend(mcc.dependencies(refinement));
        }
    }
    closed
}

/// A linear extension that takes the refinement with the least of some random keys whenever several may come.
fn random_order(mcc: &Mcc<'_>, set: &BTreeSet<usize>, salt: u64) -> Vec<usize> {
    let key = |refinement: usize| (refinement as u64 ^ salt).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 20;
    let (mut left, mut order) = (set.clone(), Vec::new());
    while !left.is_empty() {
        let is_ready = |&&refinement: &&usize| mcc.dependencies(refinement).all(|before| !left.contains(&before));
        let next = *left.iter().filter(is_ready).min_by_key(|&&refinement| key(refinement)).unwrap();
        left.remove(&next);
        order.push(next);
    }
    order
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_front_is_a_complex_of_the_same_homology(
        simplices in simplices(),
        which in 0_usize..16,
        batch in any::<bool>(),
        first_type in any::<bool>(),
        sets in prop::collection::vec((any::<u64>(), 0_u32..6), 4),
    ) {
        let full = complex(soup(14, &simplices));
        prop_assume!(full.num_cells() > 0 && full.num_cells() < 500);
        let homology = both(&full);
        let strategy = if batch { Order::Batch } else { Order::Step };
        let types = if first_type { Types::First } else { Types::Both };
        let recorded = simplified(&full, which, strategy, types);
        let mcc = recorded.view();
        mcc.validate().unwrap();
        prop_assert_eq!(mcc.num_cells(), full.num_cells());

        // Nothing feasible is left.
        let mut front = Front::new(mcc);
        let base = front.complex().clone();
        assert_same_homology(&homology, &base);
        let left = Model::of(&base).feasible();
        prop_assert!(left.iter().all(|pair| first_type && !pair.2), "{:?}", left);

        for (salt, rarity) in sets {
            let is_wanted = |refinement: usize| (refinement as u64 ^ salt).wrapping_mul(0xD134_2543_DE82_EF95) >> 40 & ((1 << rarity) - 1) == 0;
            let wanted: BTreeSet<usize> = (0..mcc.num_refinements()).filter(|&refinement| is_wanted(refinement)).collect();
            let closed = closure(&mcc, &wanted);
            let mut marks = vec![0; mark_words(mcc.num_refinements())];
            mcc.select(&mut marks, is_wanted).unwrap();
            prop_assert_eq!(mcc.close(&mut marks), Some(closed.len()));
            // The least closed set: it is the one of the definition, of which none can be left out.
            prop_assert_eq!(members(&mcc, &marks), closed.iter().copied().collect::<Vec<_>>());
            let moved = front.move_to(&marks).unwrap();
            prop_assert!(moved.refined + moved.coarsened > 0 || front.num_applied() == closed.len());
            front.complex().check().unwrap();
            assert_same_homology(&homology, front.complex());
            // Any linear extension gives the same front.
            let other = apply_in_order(mcc, &random_order(&mcc, &closed, salt)).unwrap();
            prop_assert!(other.complex() == front.complex());
            prop_assert_eq!(front.complex().num_cells(), mcc.num_base_cells() + 2 * closed.len());
            // Each cell comes to be in one that is there.
            for (cell, survivor) in (0..).map(sig_core::CellId::new).zip(front.survivors()) {
                let is_there = front.complex().contains(cell);
                prop_assert_eq!(is_there, survivor == Some(cell));
                prop_assert!(survivor.is_none_or(|survivor| front.complex().contains(survivor)));
            }
            // Saved and loaded, it is the same; its cells are numbered anew, and know what they are.
            let saved = front.to_complex();
            let file = MccFile::from_file_bytes(in_bytes(&saved, None)).unwrap();
            file.view().validate().unwrap();
            let loaded = Front::new(file.view());
            prop_assert!(loaded.complex() == Front::new(saved.view()).complex());
            prop_assert_eq!(Model::of(loaded.complex()).labels.len(), Model::of(front.complex()).labels.len());
            prop_assert_eq!(renamed_to_origins(loaded.complex(), &file.view()), renamed_to_origins(front.complex(), &mcc));
        }
        front.select(|_| true).unwrap();
        prop_assert!(Model::of(front.complex()) == renamed(&full, &mcc));
        front.select(|_| false).unwrap();
        prop_assert!(front.complex() == &base);
        // A file holds it all.
        let bytes = in_bytes(&recorded, Some(&coordinates(full.counts()[0])));
        sig_core::format::verify(&bytes).unwrap();
        let file = MccFile::from_file_bytes(bytes).unwrap();
        let (a, b) = (file.view(), mcc);
        let (a, b) = (a.arrays(), b.arrays());
        prop_assert_eq!((a.arcs, a.large, a.origins, a.splits), (b.arcs, b.large, b.origins, b.splits));
        prop_assert_eq!((a.lookup, a.base_offsets, a.shapes, a.errors), (b.lookup, b.base_offsets, b.shapes, b.errors));
    }

    /// A threshold takes a closed set, whatever it is.
    #[test]
    fn errors_do_not_grow_along_dependencies(simplices in simplices(), which in 1_usize..4, threshold in 0.0_f32..200.0) {
        let full = complex(soup(14, &simplices));
        prop_assume!(full.num_cells() < 500);
        let recorded = simplified(&full, which, Order::Step, Types::Both);
        let mcc = recorded.view();
        let mut marks = vec![0; mark_words(mcc.num_refinements())];
        mcc.select(&mut marks, |refinement| mcc.error(refinement) > threshold).unwrap();
        let before = marks.clone();
        mcc.close(&mut marks).unwrap();
        prop_assert_eq!(before, marks);
    }
}

/// The labels of a complex by the cells of the full one.
fn renamed_to_origins(complex: &CellComplex, mcc: &Mcc<'_>) -> BTreeSet<(usize, usize, u32, i32)> {
    let origin = |cell| mcc.origin(cell).unwrap();
    let labels = Model::of(complex).labels;
    labels.into_iter().map(|((low, high), (times, sign))| (origin(low), origin(high), times, sign)).collect()
}

#[test]
fn bases_are_small() {
    // A sphere ends with four cells by the first type, as the paper's Eros and VaseLion, with two by both.
    let sphere = complex(soup_of(&["012", "013", "023", "124", "134", "234"]));
    for (types, cells) in [(Types::First, 4), (Types::Both, 2)] {
        for strategy in [Order::Step, Order::Batch] {
            assert_eq!(simplified(&sphere, 1, strategy, types).view().num_base_cells(), cells);
        }
    }
    let torus = complex(soup(7, &torus()));
    assert_eq!(simplified(&torus, 1, Order::Step, Types::First).view().num_base_cells(), 4);
    let ball = complex(kuhn_grid(4, 4, 4));
    // In three dimensions a greedy order may get stuck, as on a dunce hat; not often.
    assert!(simplified(&ball, 1, Order::Step, Types::Both).view().num_base_cells() <= 5);
}

#[test]
fn any_number_of_threads_gives_the_same() {
    let ball = complex(kuhn_grid(6, 6, 6));
    for strategy in [Order::Step, Order::Batch] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| simplified(&ball, 1, strategy, Types::Both))
        };
        assert!(on(1) == on(3));
    }
}

/// A scalar field, step by step and exactly: what is taken is the cheapest that is feasible, by the definition.
#[test]
fn the_cheapest_goes_first() {
    let full = complex(kuhn_grid(3, 3, 3));
    let values: Vec<f32> = (0..full.num_ids()).map(|cell| ((cell * 7919) % 1009) as f32).collect();
    let options = SimplifyOptions { precision: Precision::Exact, ..Default::default() };
    let (recorded, report) = simplify(full.clone(), &mut Field::of_cells(values.clone()), &options);
    let mcc = recorded.view();
    let cost = |low: sig_core::CellId, high: sig_core::CellId| (values[low.index()] - values[high.index()]).abs();
    let mut left = full;
    for number in (0..mcc.num_refinements()).rev() {
        let view = mcc.refinement(number).unwrap();
        let [low, high] = [view.low, view.high].map(|cell| sig_core::CellId::new(mcc.origin(cell).unwrap() as u32));
        let feasible = Model::of(&left).feasible();
        let least = feasible.iter().map(|pair| cost(pair.0, pair.1)).fold(f32::INFINITY, f32::min);
        assert!(cost(low, high) == least, "{number}: {} is not {least}", cost(low, high));
        left.kill(low, high).unwrap();
    }
    assert_eq!(left.counts(), report.base);
    let by_dimension: usize = report.by_dimension.iter().flatten().sum();
    assert_eq!(by_dimension, report.simplifications);
}

#[test]
fn targets_and_interrupts_stop_between_two_steps() {
    let ball = complex(kuhn_grid(4, 4, 4));
    let homology = both(&ball);
    for strategy in [Order::Step, Order::Batch] {
        let run = |options: &SimplifyOptions<'_>| {
            let vertices = coordinates(ball.counts()[0]);
            let (recorded, report) = simplify(ball.clone(), &mut Extent::new(&ball, &vertices), options);
            assert_eq!(ball.num_cells(), recorded.view().num_base_cells() + 2 * report.simplifications);
            assert_same_homology(&homology, Front::new(recorded.view()).complex());
            recorded
        };
        let to_target = run(&SimplifyOptions { strategy, target_cells: 100, ..Default::default() });
        assert!([100, 101].contains(&to_target.view().num_base_cells()));
        let cheap = run(&SimplifyOptions { strategy, max_error: Some(60.0), ..Default::default() });
        let errors = cheap.view().arrays().errors;
        assert!(!errors.is_empty() && errors.iter().all(|&error| error <= 60.0));
        let interrupt = AtomicBool::new(false);
        let told = AtomicBool::new(false);
        let progress = |_| {
            told.store(true, Ordering::Relaxed);
            interrupt.store(true, Ordering::Relaxed);
        };
        let options =
            SimplifyOptions { strategy, progress: Some(&progress), interrupt: Some(&interrupt), ..Default::default() };
        assert_eq!(run(&options).view().num_refinements(), 0);
        assert!(told.load(Ordering::Relaxed));
    }
}

#[test]
fn incidences_of_any_size_are_kept() {
    let chain = "cells 1 8 8\n".to_owned()
        + &"+0 -0\n".repeat(8)
        + &(0..7).map(|k| format!("+{k} 2*-{}\n", k + 1)).collect::<String>()
        + "+0 2*+7\n";
    let full = read_cells(chain.as_bytes(), "chain").unwrap();
    let recorded = simplified(&full, 0, Order::Step, Types::Both);
    let file = MccFile::from_file_bytes(in_bytes(&recorded, None)).unwrap();
    let mcc = file.view();
    mcc.validate().unwrap();
    assert!(!mcc.arrays().large.is_empty());
    assert_same_homology(&both(&full), Front::new(mcc).complex());
    let mut front = Front::new(mcc);
    front.select(|_| true).unwrap();
    assert!(Model::of(front.complex()) == renamed(&full, &mcc));
}

#[test]
fn long_lists_are_kept() {
    // A vertex with two thousand edges: more than the packed lengths of a refinement tell.
    let spokes: Vec<Vec<u32>> = (1..2001).map(|end| vec![0, end]).chain([vec![1, 2], vec![0, 1, 2]]).collect();
    let full = complex(soup(2001, &spokes));
    struct Hub;
    impl sig_tools::mcc::Criterion for Hub {
        fn cost(&self, _: &CellComplex, pair: sig_tools::mcc::Pair) -> f32 {
            if pair.low.index() == 0 { 0.0 } else { 1.0 }
        }
    }
    let (recorded, _) = simplify(full.clone(), &mut Hub, &SimplifyOptions::default());
    let mcc = recorded.view();
    mcc.validate().unwrap();
    assert!(mcc.arrays().splits.contains(&sig_core::mcc::long_splits()));
    let mut front = Front::new(mcc);
    front.select(|_| true).unwrap();
    assert!(Model::of(front.complex()) == renamed(&full, &mcc));
}

#[test]
fn an_order_that_is_not_feasible_is_refused() {
    let recorded = simplified(&complex(kuhn_grid(3, 3, 3)), 1, Order::Step, Types::Both);
    let mcc = recorded.view();
    let last = mcc.num_refinements() - 1;
    let Err(BadRefinement { refinement, .. }) = apply_in_order(mcc, &[last]) else { panic!("it depends on others") };
    assert_eq!(refinement, last);
}

#[test]
fn fronts_are_drawn() {
    let grid = complex(kuhn_grid(4, 4, 4));
    let values = (0..64).flat_map(|at| [at / 16, at / 4 % 4, at % 4]).map(f64::from).collect();
    let coordinates = Coordinates { dim: 3, values: Scalars::F64(values) };
    let (recorded, _) = simplify(grid.clone(), &mut Extent::new(&grid, &coordinates), &SimplifyOptions::default());
    let file = MccFile::from_file_bytes(in_bytes(&recorded, Some(&coordinates))).unwrap();
    let mut front = Front::new(file.view());
    front.select(|refinement| refinement < 100).unwrap();
    let drawing = Drawing::new(&front).unwrap();
    // The surface of the cube has 6 · 9 · 2 triangles, and the grid 6 · 27 tetrahedra.
    assert_eq!(drawing.scene().faces.len(), 108);
    let mut vtu = Vec::new();
    drawing.write_vtu(&mut vtu).unwrap();
    assert!(String::from_utf8(vtu).unwrap().contains(r#"NumberOfPoints="64" NumberOfCells="162""#));
    // Without coordinates there is nothing to draw.
    assert!(Drawing::new(&Front::new(recorded.view())).is_err());
}
