//! How much memory hostile bytes can make the library ask for: every allocation of this binary is counted.
//!
//! A module is about one kind of bytes. Every test is alone while it runs, for all share one counter.

use std::sync::{Mutex, MutexGuard, PoisonError};

use peak_alloc::PeakAlloc;

mod files;
mod inputs;

#[global_allocator]
static ALLOCATED: PeakAlloc = PeakAlloc;

/// What the harness may allocate beside a test, and what an error with its message takes.
const SLACK: usize = 64 << 10;

/// The test that runs.
struct Alone(#[expect(dead_code, reason = "held until the test ends")] MutexGuard<'static, ()>);

impl Alone {
    fn new() -> Self {
        static ONE: Mutex<()> = Mutex::new(());
        Self(ONE.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The most bytes that are allocated at a time by what is run, beside those that were before; and its result.
    fn peak_of<T>(&self, run: impl FnOnce() -> T) -> (usize, T) {
        ALLOCATED.reset_peak_usage();
        let before = ALLOCATED.current_usage();
        let result = run();
        (ALLOCATED.peak_usage().saturating_sub(before), result)
    }
}

#[test]
fn allocations_are_counted() {
    let alone = Alone::new();
    let (peak, _) = alone.peak_of(|| [1, 3, 2].map(|megabytes| vec![1_u8; megabytes << 20].len()));
    // What the harness frees meanwhile counts, too.
    assert!(peak.abs_diff(3 << 20) < SLACK, "{peak}");
}
