//! How long the work may take and how much memory, who is told how far it is, and who may end it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// What ends the work early.
#[derive(Clone, Copy, Default)]
pub struct Limits<'a> {
    /// When the time is over.
    pub until: Option<Instant>,
    /// The most bytes that the boundaries, their inverse, and what belongs to each cell may take: nearly all there is.
    pub max_bytes: Option<u64>,
    /// Set to end the work.
    pub interrupt: Option<&'a AtomicBool>,
    /// Told how many cells of how many are done.
    pub progress: Option<&'a (dyn Fn(u64, u64) + Sync)>,
}

/// Why the work ended early.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Stopped {
    /// The time was over.
    #[error("the time is over")]
    Time,
    /// More memory would have been needed than was allowed.
    #[error("the next dimension needs about {needed} bytes, and {allowed} are allowed")]
    Memory {
        /// About how many bytes.
        needed: u64,
        /// The most that were allowed.
        allowed: u64,
    },
    /// Somebody wanted it.
    #[error("interrupted")]
    Interrupted,
}

/// The limits of some work, and how far it is.
pub(super) struct Watch<'a> {
    limits: Limits<'a>,
    done: AtomicU64,
    total: u64,
}

impl<'a> Watch<'a> {
    /// Of work on so many cells.
    pub(super) fn new(limits: Limits<'a>, total: u64) -> Self {
        Self { limits, done: AtomicU64::new(0), total }
    }

    /// Tells that so many more cells are done, and looks whether the work should end.
    pub(super) fn look(&self, cells: usize) -> Result<(), Stopped> {
        if cells > 0 {
            let done = self.done.fetch_add(cells as u64, Ordering::Relaxed) + cells as u64;
            if let Some(progress) = self.limits.progress {
                progress(done.min(self.total), self.total);
            }
        }
        if self.limits.interrupt.is_some_and(|interrupt| interrupt.load(Ordering::Relaxed)) {
            return Err(Stopped::Interrupted);
        }
        match self.limits.until {
            Some(until) if Instant::now() >= until => Err(Stopped::Time),
            _ => Ok(()),
        }
    }

    /// Refuses work that needs more bytes than are allowed.
    pub(super) fn need(&self, needed: u64) -> Result<(), Stopped> {
        match self.limits.max_bytes {
            Some(allowed) if needed > allowed => Err(Stopped::Memory { needed, allowed }),
            _ => Ok(()),
        }
    }
}
