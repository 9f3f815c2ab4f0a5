//! Work on many threads whose results are handed on in order.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// Does `work` on each of some jobs, on all threads, and hands the results to `each` in the order of the jobs, on this
/// thread: those of one batch of jobs while the next one is worked on. So no more results than of two batches wait, of
/// four jobs a thread each. A job works with a value that `init` makes, which others have used before.
///
/// # Errors
/// The first of `each`; no more work is begun then.
pub fn in_order<J: Send, S: Send, T: Send, E>(
    jobs: impl IntoIterator<Item = J>,
    init: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, J) -> T + Sync,
    mut each: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let spare = Mutex::new(Vec::new());
    let work = |job| {
        let spare = || spare.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = spare().pop();
        let mut own = kept.unwrap_or_else(&init);
        let result = work(&mut own, job);
        spare().push(own);
        result
    };
    let batch = 4 * rayon::current_num_threads();
    let mut jobs = jobs.into_iter();
    let mut ready: Vec<T> = Vec::new();
    loop {
        let next: Vec<J> = jobs.by_ref().take(batch).collect();
        let is_last = next.is_empty();
        let mut done = Vec::new();
        rayon::in_place_scope(|scope| {
            if !is_last {
                scope.spawn(|_| done = next.into_par_iter().with_max_len(1).map(work).collect());
            }
            ready.drain(..).try_for_each(&mut each)
        })?;
        if is_last {
            return Ok(());
        }
        ready = done;
    }
}
