//! Interrupts that end some work early, instead of the program.

use std::sync::atomic::{AtomicBool, Ordering};

/// Whether some work wants to end by itself.
static IS_AWAITED: AtomicBool = AtomicBool::new(false);
/// Whether it should.
static FLAG: AtomicBool = AtomicBool::new(false);

/// From now on an interrupt sets the flag.
pub(super) fn begin() {
    IS_AWAITED.store(true, Ordering::SeqCst);
}

/// From now on an interrupt ends the program again; whether there was one.
pub(super) fn end() -> bool {
    IS_AWAITED.store(false, Ordering::SeqCst);
    FLAG.load(Ordering::SeqCst)
}

/// What the work looks at.
pub(super) fn flag() -> &'static AtomicBool {
    &FLAG
}

/// Takes a signal; whether the program should go on.
pub(super) fn take() -> bool {
    IS_AWAITED.swap(false, Ordering::SeqCst) && {
        FLAG.store(true, Ordering::SeqCst);
        true
    }
}
