//! How large a complex may become, and how far the work is.

use std::sync::atomic::{AtomicU64, Ordering};

use sig_core::Dim;

use crate::build::{BuildError, BuildOptions, Phase, Progress};
use crate::soup::Soup;

/// Simplices that a task takes from the limit at a time.
const SHARE: u64 = 1 << 14;

/// The room for simplices, and how much of it is taken.
pub(super) struct Limit {
    limit: u64,
    taken: AtomicU64,
}

impl Limit {
    /// The room that the options and the memory leave; refuses the soup if its largest simplex alone is larger.
    pub(super) fn new(soup: &Soup, options: &BuildOptions<'_>) -> Result<Self, BuildError> {
        let bytes = options.max_bytes.or_else(available_memory).unwrap_or(u64::MAX);
        let dim = soup.simplices.iter().rposition(|flat| !flat.is_empty()).unwrap_or(0);
        let at_least = faces(dim);
        let limit = options.max_simplices.unwrap_or(u64::MAX).min(bytes / bytes_per_face(dim, at_least));
        if at_least > limit && !soup.labels.is_empty() {
            return Err(BuildError::TooLarge { at_least, limit });
        }
        let limit = options.max_simplices.unwrap_or(u64::MAX).min(bytes / LEAST_BYTES);
        Ok(Self { limit, taken: AtomicU64::new(0) })
    }

    /// Refuses a complex with so many simplices of each dimension if the options or the memory leave less room.
    pub(super) fn check(counts: &[usize], options: &BuildOptions<'_>) -> Result<(), BuildError> {
        let at_least: u64 = counts.iter().map(|&count| count as u64).sum();
        let bytes: u64 = (0..).zip(counts).map(|(dim, &count)| count as u64 * 4 * (dim + 3)).sum();
        let room = options.max_bytes.or_else(available_memory).unwrap_or(u64::MAX);
        // At the same mean size.
        let fit = u128::from(at_least) * u128::from(room) / u128::from(bytes.max(1));
        let limit = options.max_simplices.unwrap_or(u64::MAX).min(u64::try_from(fit).unwrap_or(u64::MAX));
        if at_least > limit { Err(BuildError::TooLarge { at_least, limit }) } else { Ok(()) }
    }

    /// Takes room for `count` simplices.
    pub(super) fn reserve(&self, count: usize) -> Result<(), BuildError> {
        let at_least = self.taken.fetch_add(count as u64, Ordering::Relaxed).saturating_add(count as u64);
        if at_least > self.limit { Err(BuildError::TooLarge { at_least, limit: self.limit }) } else { Ok(()) }
    }

    /// An account from which one task takes room.
    pub(super) fn reservation(&self) -> Reservation<'_> {
        Reservation { limit: self, pending: 0 }
    }
}

/// What one task took, or is about to take, from the limit.
pub(super) struct Reservation<'a> {
    limit: &'a Limit,
    pending: usize,
}

impl Reservation<'_> {
    /// Takes room for `count` simplices, or will do so soon.
    pub(super) fn take(&mut self, count: usize) -> Result<(), BuildError> {
        self.pending += count;
        if self.pending as u64 >= SHARE { self.settle() } else { Ok(()) }
    }

    /// Takes what was put off.
    pub(super) fn settle(&mut self) -> Result<(), BuildError> {
        self.limit.reserve(std::mem::take(&mut self.pending))
    }

    /// The error that the faces of a range of vertices are too many for 32-bit numbers.
    pub(super) fn too_large(&self) -> BuildError {
        BuildError::TooLarge { at_least: self.limit.taken.load(Ordering::Relaxed), limit: u64::from(u32::MAX) }
    }
}

/// The number of faces of a simplex of dimension `dim`, itself included: 2^(dim+1) − 1.
fn faces(dim: Dim) -> u64 {
    u64::MAX.checked_shr(u32::try_from(63_usize.saturating_sub(dim)).unwrap_or(0)).unwrap_or(u64::MAX)
}

/// Bytes that any simplex of positive dimension takes in the arrays at 32 bits: two facets, last vertex, pointer or
/// child offset.
const LEAST_BYTES: u64 = 16;

/// Bytes that each of the `count` faces of a simplex of dimension `dim` takes on average: half of its vertices are in
/// a face, which has as many facets.
fn bytes_per_face(dim: Dim, count: u64) -> u64 {
    let width = if u32::try_from(count).is_ok_and(|count| count < u32::MAX - 1) { 4 } else { 8 };
    4 + width * (2 + (dim as u64).div_ceil(2))
}

/// The bytes of memory that the system says are available; `None` if it says nothing.
#[must_use]
pub fn available_memory() -> Option<u64> {
    let info = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Tells the caller how far the work is.
pub(super) struct Meter<'a> {
    progress: Option<Progress<'a>>,
}

impl<'a> Meter<'a> {
    pub(super) fn new(progress: Option<Progress<'a>>) -> Self {
        Self { progress }
    }

    /// Starts a phase of `total` steps.
    pub(super) fn stage(&self, phase: Phase, total: usize) -> Stage<'a> {
        Stage::new(self.progress, phase, total)
    }
}

/// A phase under way, of this or another construction.
pub(crate) struct Stage<'a, P = Phase> {
    progress: Option<&'a (dyn Fn(P, u64, u64) + Sync)>,
    phase: P,
    done: AtomicU64,
    total: u64,
}

impl<'a, P: Copy> Stage<'a, P> {
    /// Starts a phase of `total` steps.
    pub(crate) fn new(progress: Option<&'a (dyn Fn(P, u64, u64) + Sync)>, phase: P, total: usize) -> Self {
        let stage = Self { progress, phase, done: AtomicU64::new(0), total: total as u64 };
        stage.add(0);
        stage
    }

    /// `steps` more are done.
    pub(crate) fn add(&self, steps: usize) {
        if let Some(progress) = self.progress {
            let done = self.done.fetch_add(steps as u64, Ordering::Relaxed) + steps as u64;
            progress(self.phase, done, self.total);
        }
    }
}
