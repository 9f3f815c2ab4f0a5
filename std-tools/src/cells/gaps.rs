//! Long lists: sorted, with gaps, so that an arc comes and goes without a move of all that follow.
//!
//! A slot is a gap if the one before it names the same cell: so a search needs no other rule, and the arc of a cell is
//! the first of its run. A list that is [`spread`] has a gap after every second arc, and what is inserted takes the nearest one.

use sig_core::{CellId, PackedArc};

use super::lists::lower_bound;

/// How far a gap is looked for. If there is none, a part of the list is spread anew: some four times as long, or eight times
/// longer, and again, until it has gaps enough, longer parts more than short ones (a packed-memory array: Bender, Demaine and
/// Farach-Colton, *Cache-oblivious B-trees*, 2000).
const NEAR: usize = 64;

/// The slots to give so many arcs, if there is room.
pub(super) const fn slots_for(arcs: usize) -> usize {
    arcs + arcs / 2
}

/// The arcs of a list, without the gaps.
pub(super) fn arcs(slots: &[PackedArc]) -> impl Iterator<Item = PackedArc> {
    let mut before = None;
    slots.iter().copied().filter(move |arc| before.replace(arc.cell()) != Some(arc.cell()))
}

/// Lays arcs out over slots, of which there are no fewer, the gaps evenly between.
pub(super) fn spread(arcs: &[PackedArc], slots: &mut [PackedArc]) {
    let num_slots = slots.len();
    let (mut at, mut step) = (0, 0);
    for slot in slots {
        *slot = arcs[at];
        step += arcs.len();
        if step >= num_slots {
            step -= num_slots;
            at += 1;
        }
    }
}

/// Lays arcs out over slots, the gaps at the end: where one comes last others will, as refinements do in the order of a file.
fn pack(arcs: &[PackedArc], slots: &mut [PackedArc]) {
    let (packed, gaps) = slots.split_at_mut(arcs.len());
    packed.copy_from_slice(arcs);
    gaps.fill(arcs[arcs.len() - 1]);
}

/// Makes a gap of the arc to a cell that is in the list, which has others. Cost: a search, and the gaps after it.
pub(super) fn remove(slots: &mut [PackedArc], cell: CellId) {
    let start = lower_bound(slots, cell);
    let end = start + slots[start..].iter().take_while(|arc| arc.cell() == cell).count();
    debug_assert!(start < end);
    // Both neighbours take a part, so that gaps do not gather where arcs go in order.
    let before = start.checked_sub(1).map(|at| slots[at]);
    let after = slots.get(end).copied();
    let middle = match (before, after) {
        (None, _) => start,
        (_, None) => end,
        _ => usize::midpoint(start, end),
    };
    if let Some(before) = before {
        slots[start..middle].fill(before);
    }
    if let Some(after) = after {
        slots[middle..end].fill(after);
    }
}

/// Adds an arc to a cell that is not in the list; false if there is hardly any gap.
pub(super) fn insert(slots: &mut [PackedArc], arc: PackedArc) -> bool {
    let (mut part, mut rarity) = (4 * NEAR, 16);
    while !insert_near(slots, arc) {
        if part >= 2 * slots.len() {
            return false;
        }
        let place = lower_bound(slots, arc.cell());
        let is_last = place == slots.len();
        let range = place.saturating_sub(part)..slots.len().min(place + part);
        let before = range.start.checked_sub(1).map(|at| slots[at].cell());
        let slots = &mut slots[range];
        let arcs: Vec<PackedArc> = arcs(slots).skip_while(|arc| Some(arc.cell()) == before).collect();
        if arcs.len() + slots.len() / rarity < slots.len() {
            if is_last {
                pack(&arcs, slots);
            } else {
                spread(&arcs, slots);
            }
        }
        (part, rarity) = (part * 8, (rarity * 3 / 4).max(6));
    }
    true
}

/// Adds an arc to a cell that is not in the list; false if there is no gap near its place.
fn insert_near(slots: &mut [PackedArc], arc: PackedArc) -> bool {
    let place = lower_bound(slots, arc.cell());
    let is_gap = |at: usize| at > 0 && slots[at].cell() == slots[at - 1].cell();
    let below = || (place.saturating_sub(NEAR)..place).rev().find(|&at| is_gap(at));
    // The first slot from the place on is no gap: it names a later cell than the one before.
    let above = || (place + 1..slots.len().min(place + NEAR)).find(|&at| is_gap(at));
    if let Some(gap) = below() {
        slots.copy_within(gap + 1..place, gap);
        slots[place - 1] = arc;
    } else if let Some(gap) = above() {
        slots.copy_within(place..gap, place + 1);
        slots[place] = arc;
    } else {
        return false;
    }
    true
}
