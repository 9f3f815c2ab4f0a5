//! How deep the stack was.
#![expect(unsafe_code, reason = "the stack belongs to no variable")]

use cortex_m_rt::STACK_PAINT_VALUE;

unsafe extern "C" {
    /// The lowest address of the stack, by the linker script; only its address means anything.
    static _stack_end: u32;
    /// The address after the highest.
    static _stack_start: u32;
}

/// Bytes of the stack that were ever written since the runtime painted it at start-up, counted from its top down to the
/// lowest changed word.
pub(crate) fn deepest() -> usize {
    let (mut lowest, top) = (&raw const _stack_end, &raw const _stack_start);
    // SAFETY: from `_stack_end` to `_stack_start` there is RAM of the stack alone, aligned to words, which the runtime has
    // initialised; reading it races with nothing, for there are no interrupts.
    while lowest < top && unsafe { lowest.read_volatile() } == STACK_PAINT_VALUE {
        lowest = lowest.wrapping_add(1);
    }
    top.addr() - lowest.addr()
}
