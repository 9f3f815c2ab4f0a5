//! What `core` has methods of slices for, in forms of which the compiler always sees that they cannot panic: so that a
//! program that links this crate links no way to panic.

/// Reverses the order of the items.
#[inline]
pub(crate) fn reverse<T>(items: &mut [T]) {
    let mut items = items.iter_mut();
    while let (Some(first), Some(last)) = (items.next(), items.next_back()) {
        core::mem::swap(first, last);
    }
}

/// Moves the items from place `from` on to the start.
#[inline]
pub(crate) fn move_down<T: Copy>(items: &mut [T], from: usize) {
    for to in 0..items.len().saturating_sub(from) {
        let Some(&item) = items.get(to + from) else { break };
        if let Some(slot) = items.get_mut(to) {
            *slot = item;
        }
    }
}
