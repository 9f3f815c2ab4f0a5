//! Fronts that move, boxes, and closed sets in lists: against the definitions.

use std::collections::BTreeSet;

use proptest::prelude::*;
use sig_core::format::{Container, Encoder, SectionKind};
use sig_core::mcc::{AxisBox, Mcc};
use sig_core::{Scratch, ScratchError, mark_words};
use sig_tools::cells::CellComplex;
use sig_tools::mcc::{Front, MccFile, Moved, Strategy as Order, Types, apply_in_order};
use sig_tools::soup::{Coordinates, Scalars};
use sig_tools::store::AlignedBytes;

use crate::mcc::{closure, coordinates, in_bytes, simplified};
use crate::operators::complex;
use crate::samples::{kuhn_grid, simplices, soup};

/// A file of a complex that was simplified, with points that are not in order.
fn file_of(full: &CellComplex, which: usize, order: Order, values: &Coordinates) -> MccFile {
    let recorded = simplified(full, which, order, Types::Both);
    MccFile::from_file_bytes(in_bytes(&recorded, Some(values))).unwrap()
}

/// Points on a small lattice, many of them the same, some coordinates no numbers or −0.
fn awkward(vertices: usize, dim: usize, salt: u64) -> Coordinates {
    let value = |at: usize| match (at as u64 ^ salt).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 58 {
        0 => f32::NAN,
        1 => -0.0,
        value => (value % 7) as f32 - 2.0,
    };
    Coordinates { dim, values: Scalars::F32((0..dim * vertices).map(value).collect()) }
}

fn boxes() -> impl Strategy<Value = AxisBox> {
    prop::array::uniform3((-3_i32..6, 0_i32..5)).prop_map(|sides| AxisBox {
        low: sides.map(|(low, _)| f64::from(low)),
        high: sides.map(|(low, length)| f64::from(low + length)),
    })
}

/// The refinements whose sites are in one box and not in the other, one by one.
fn scanned(mcc: &Mcc<'_>, inside: &AxisBox, but_not: &AxisBox) -> Vec<usize> {
    let is_in = |refinement, corners| mcc.is_in_box(refinement, corners) == Some(true);
    (0..mcc.num_refinements()).filter(|&number| is_in(number, inside) && !is_in(number, but_not)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn boxes_are_searched_as_if_all_were_looked_at(
        simplices in simplices(), dim in 1_usize..5, salt in any::<u64>(), inside in boxes(), but_not in boxes(),
    ) {
        let full = complex(soup(14, &simplices));
        prop_assume!(full.num_cells() > 0 && full.num_cells() < 500);
        let file = file_of(&full, 0, Order::Step, &awkward(full.counts()[0], dim, salt));
        let mcc = file.view();
        mcc.validate().unwrap();
        prop_assume!(mcc.num_refinements() > 0);
        for but_not in [but_not, AxisBox::EMPTY, AxisBox::SPACE] {
            let mut found: Vec<usize> = mcc.in_box(inside, but_not).unwrap().collect();
            found.sort_unstable();
            prop_assert_eq!(found, scanned(&mcc, &inside, &but_not));
        }
        prop_assert_eq!(mcc.in_box(AxisBox::EMPTY, AxisBox::EMPTY).unwrap().count(), 0);
    }

    /// Each node of the tree is needed where it is, so that two cannot change places.
    #[test]
    fn a_tree_over_sites_in_another_order_is_refused(simplices in simplices(), a in any::<prop::sample::Index>(), b in any::<prop::sample::Index>()) {
        let full = complex(soup(14, &simplices));
        prop_assume!(full.num_cells() < 500);
        let recorded = simplified(&full, 0, Order::Step, Types::Both);
        prop_assume!(recorded.view().num_refinements() > 1);
        let mut bytes = in_bytes(&recorded, Some(&coordinates(full.counts()[0])));
        let container = Container::from_bytes(&bytes).unwrap();
        let (_, _, range) = container.spans().find(|(kind, ..)| *kind == SectionKind::SiteTree).unwrap();
        let (a, b) = (a.index(range.len() / 4), b.index(range.len() / 4));
        let (a, b) = (range.start + 4 * a, range.start + 4 * b);
        for byte in 0..4 {
            bytes.swap(a + byte, b + byte);
        }
        prop_assert_eq!(Mcc::from_bytes(&bytes).unwrap().validate().is_ok(), a == b);
        // One twice, another one not at all.
        bytes.copy_within(a..a + 4, b);
        prop_assert_eq!(Mcc::from_bytes(&bytes).unwrap().validate().is_ok(), a == b);
    }

    #[test]
    fn closed_sets_in_lists_are_those_of_the_definition(
        simplices in simplices(), batch in any::<bool>(), wanted in prop::collection::vec(0_usize..250, 0..6),
    ) {
        let full = complex(soup(14, &simplices));
        prop_assume!(full.num_cells() > 0 && full.num_cells() < 500);
        let recorded = simplified(&full, 0, if batch { Order::Batch } else { Order::Step }, Types::Both);
        let mcc = recorded.view();
        let num = mcc.num_refinements();
        let set = closure(&mcc, &wanted.iter().copied().filter(|&refinement| refinement < num).collect());
        let (mut marks, mut queue, mut masks, mut found) = (vec![0; mark_words(num)], vec![0; num], vec![0; num], vec![0; set.len()]);
        {
            let mut scratch = Scratch::new(&mut marks, &mut queue, &mut masks, &mut found);
            let list: Vec<usize> = mcc.closed_set(wanted.iter().copied(), &mut scratch).unwrap().iter().map(|&number| number as usize).collect();
            prop_assert_eq!(list.iter().copied().collect::<BTreeSet<_>>(), set.clone());
            prop_assert_eq!(list.len(), set.len());
            // It is a feasible order: the front takes it.
            let front = apply_in_order(mcc, &list).unwrap();
            prop_assert_eq!(front.num_applied(), set.len());
        }
        prop_assert!(marks.iter().all(|&word| word == 0));
        // With too little of anything it says so, and leaves no marks.
        for (queued, room) in [(num, set.len().saturating_sub(1)), (0, set.len())] {
            let mut scratch = Scratch::new(&mut marks, &mut queue[..queued], &mut masks, &mut found[..room]);
            let closed = mcc.closed_set(wanted.iter().copied(), &mut scratch).map(<[u32]>::len);
            let is_refused = matches!(closed, Err(ScratchError::Queue { .. } | ScratchError::Found { .. }));
            prop_assert_eq!(is_refused, !set.is_empty());
            prop_assert!(marks.iter().all(|&word| word == 0));
        }
    }

    /// However a front has come to a set, it is as if it were made from scratch; and nothing in it can be dropped.
    #[test]
    fn fronts_forget_where_they_were(
        simplices in simplices(),
        batch in any::<bool>(),
        changes in prop::collection::vec((prop::collection::vec(0_usize..200, 0..8), prop::collection::vec(0_usize..200, 0..8)), 1..6),
    ) {
        let full = complex(soup(14, &simplices));
        prop_assume!(full.num_cells() > 0 && full.num_cells() < 500);
        let recorded = simplified(&full, 1, if batch { Order::Batch } else { Order::Step }, Types::Both);
        let mcc = recorded.view();
        let mut front = Front::new(mcc);
        let mut wanted = BTreeSet::new();
        let mut before = BTreeSet::new();
        for (more, fewer) in changes {
            wanted.extend(more.iter().copied().filter(|&refinement| refinement < mcc.num_refinements()));
            wanted.retain(|refinement| !fewer.contains(refinement));
            let moved = front.change(more, fewer).unwrap();
            let set = closure(&mcc, &wanted);
            let applied: BTreeSet<usize> = (0..mcc.num_refinements()).filter(|&number| front.is_applied(number)).collect();
            prop_assert_eq!(&applied, &set);
            prop_assert_eq!((0..mcc.num_refinements()).filter(|&number| front.is_wanted(number)).collect::<BTreeSet<_>>(), wanted.clone());
            prop_assert!(moved.refined >= set.difference(&before).count() && moved.coarsened >= before.difference(&set).count());
            prop_assert_eq!(moved.refined as i64 - moved.coarsened as i64, set.len() as i64 - before.len() as i64);
            let mut new = Front::new(mcc);
            prop_assert_eq!(new.change(wanted.iter().copied(), []).unwrap(), Moved { refined: set.len(), coarsened: 0 });
            prop_assert!(new.complex() == front.complex());
            let is_needed = |&number: &usize| wanted.contains(&number) || set.iter().any(|&other| mcc.dependencies(other).any(|before| before == number));
            prop_assert!(set.iter().all(is_needed));
            before = set;
        }
        front.change([], wanted).unwrap();
        prop_assert!(front.complex() == Front::new(mcc).complex());
    }
}

#[test]
fn a_box_that_moves_changes_what_is_in_one_place_only() {
    let full = complex(kuhn_grid(5, 5, 5));
    let values = (0..125).flat_map(|at| [at / 25, at / 5 % 5, at % 5]).map(f64::from).collect();
    let values = Coordinates { dim: 3, values: Scalars::F64(values) };
    let file = file_of(&full, 1, Order::Batch, &values);
    let bare = without_tree(file.bytes());
    let bare = MccFile::from_file_bytes(bare).unwrap();
    assert!(bare.view().in_box(AxisBox::SPACE, AxisBox::EMPTY).is_none());
    for file in [&file, &bare] {
        let mcc = file.view();
        mcc.validate().unwrap();
        let mut front = Front::new(mcc);
        let mut from = AxisBox::EMPTY;
        for at in [0.0, 0.5, 1.0, 2.0, 4.0, 0.0] {
            let to = AxisBox { low: [at, 0.0, 0.0], high: [at + 1.0, 2.0, 2.0] };
            front.move_box(from, to).unwrap();
            let mut new = Front::new(mcc);
            new.select(|refinement| mcc.is_in_box(refinement, &to) == Some(true)).unwrap();
            assert!(front.complex() == new.complex());
            from = to;
        }
        assert_eq!(front.move_box(from, from).unwrap(), Moved::default());
        front.move_box(from, AxisBox::EMPTY).unwrap();
        assert_eq!(front.num_applied(), 0);
    }
}

/// The same file as a writer of before the tree over the sites wrote it.
fn without_tree(bytes: &[u8]) -> AlignedBytes {
    let aligned = AlignedBytes::from(bytes);
    let container = Container::from_bytes(&aligned).unwrap();
    let header = container.header();
    let kept = |kind: SectionKind| ![SectionKind::SiteTree, SectionKind::Checksums].contains(&kind);
    let sections: Vec<_> = container.sections().filter(|section| kept(section.kind)).collect();
    let encoder = Encoder::new(header.kind, header.width, header.dims, header.num_simplices, &sections).unwrap();
    let mut file = AlignedBytes::zeroed(encoder.file_bytes() as usize);
    encoder.encode(&mut file).unwrap();
    file
}

/// An infeasible refinement leaves the base complex, which can be used again.
#[test]
fn a_front_that_cannot_be_is_the_base() {
    let full = complex(kuhn_grid(3, 3, 3));
    let file = file_of(&full, 1, Order::Step, &coordinates(27));
    let mut bytes = AlignedBytes::from(file.bytes());
    let container = Container::from_bytes(&bytes).unwrap();
    let (_, _, range) = container.spans().find(|(kind, ..)| *kind == SectionKind::RefinementShapes).unwrap();
    // The dimension of a refinement in the middle is wrong.
    let middle = range.start + range.len() / 2;
    bytes[middle] ^= 1;
    let mcc = Mcc::from_bytes(&bytes).unwrap();
    assert!(mcc.validate().is_err());
    mcc.validate_base().unwrap();
    let mut front = Front::new(mcc);
    let error = front.select(|_| true).unwrap_err();
    assert_eq!(error.refinement, range.len() / 2);
    assert!(front.complex() == Front::new(mcc).complex());
    assert_eq!(front.num_applied(), 0);
    front.select(|refinement| refinement < error.refinement).unwrap();
    assert_eq!(front.num_applied(), error.refinement);
}
