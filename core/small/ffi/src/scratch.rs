//! The memory of queries: one block of the caller's, divided.

use core::mem::MaybeUninit;

use ask::Relation;
use sig_core::{Index, ScratchError, SimplexId, mark_words};

use crate::Status;
use crate::opened::{Opened, with_opened};

/// The words of 8 bytes in a sig_scratch.
pub const SCRATCH_WORDS: usize = 12;

/// The memory of queries that sig_scratch_init made, for one query at a time.
#[repr(C)]
pub struct Scratch {
    /// Nobody's business.
    words: [MaybeUninit<u64>; SCRATCH_WORDS],
}

const _: () = assert!(size_of::<AnyScratch>() <= size_of::<Scratch>());
const _: () = assert!(align_of::<AnyScratch>() <= align_of::<Scratch>());

/// A scratch of the width of a complex.
pub(crate) enum AnyScratch {
    #[cfg(feature = "bits-16")]
    Bits16(sig_core::Scratch<'static, u16>),
    #[cfg(feature = "bits-32")]
    Bits32(sig_core::Scratch<'static, u32>),
    #[cfg(feature = "bits-64")]
    Bits64(sig_core::Scratch<'static, u64>),
}

/// Bytes of the marks, and of an entry: an id to visit, its mask, and an id of an answer.
fn sizes(any: &Opened) -> (usize, usize) {
    fn entry<I: Index>(_: &sig_core::Complex<'_, I>) -> usize {
        2 * size_of::<I>() + size_of::<u32>()
    }
    with_opened!(any, complex => (mark_words(complex.num_simplices()) * size_of::<u32>(), entry(complex)))
}

/// The bytes of a memory of so many entries; `usize::MAX` if they are more than that.
pub(crate) fn memory_bytes(any: &Opened, entries: usize) -> usize {
    let (marks, entry) = sizes(any);
    entries.saturating_mul(entry).saturating_add(marks)
}

/// A scratch of as many entries as fit.
pub(crate) fn new(any: &Opened, memory: &'static mut [u8]) -> Result<AnyScratch, Status> {
    let (marks, entry) = sizes(any);
    let entries = memory.len().checked_sub(marks).ok_or(Status::Memory)? / entry;
    let made = match any {
        #[cfg(feature = "bits-16")]
        Opened::Bits16(_) => divide(memory, entries, marks).map(AnyScratch::Bits16),
        #[cfg(feature = "bits-32")]
        Opened::Bits32(_) => divide(memory, entries, marks).map(AnyScratch::Bits32),
        #[cfg(feature = "bits-64")]
        Opened::Bits64(_) => divide(memory, entries, marks).map(AnyScratch::Bits64),
    };
    made.ok_or(Status::Argument)
}

/// Ids first, which are aligned to the most; `None` if the memory is not aligned.
fn divide<I: Index>(memory: &'static mut [u8], entries: usize, marks: usize) -> Option<sig_core::Scratch<'static, I>> {
    let (found, rest) = memory.split_at_mut_checked(entries * size_of::<I>())?;
    let (queue, rest) = rest.split_at_mut_checked(entries * size_of::<I>())?;
    let (masks, rest) = rest.split_at_mut_checked(entries * size_of::<u32>())?;
    let marks = bytemuck::try_cast_slice_mut(rest.get_mut(..marks)?).ok()?;
    let queue = bytemuck::try_cast_slice_mut(queue).ok()?;
    let masks = bytemuck::try_cast_slice_mut(masks).ok()?;
    Some(sig_core::Scratch::new(marks, queue, masks, bytemuck::try_cast_slice_mut(found).ok()?))
}

/// Asks; the error is how many bytes are needed at least, or none where the scratch is of another width.
pub(crate) fn ask(
    any: &Opened,
    question: (Relation, usize),
    simplex: SimplexId,
    scratch: &mut AnyScratch,
    each: &mut impl FnMut(usize),
) -> Result<(), Option<usize>> {
    let asked = match (any, scratch) {
        #[cfg(feature = "bits-16")]
        (Opened::Bits16(complex), AnyScratch::Bits16(scratch)) => ask::ask(complex, question, simplex, scratch, each),
        #[cfg(feature = "bits-32")]
        (Opened::Bits32(complex), AnyScratch::Bits32(scratch)) => ask::ask(complex, question, simplex, scratch, each),
        #[cfg(feature = "bits-64")]
        (Opened::Bits64(complex), AnyScratch::Bits64(scratch)) => ask::ask(complex, question, simplex, scratch, each),
        #[allow(unreachable_patterns, reason = "reached where there are several widths")]
        _ => return Err(None),
    };
    asked.map_err(|error| match error {
        ScratchError::Queue { at_least, .. } | ScratchError::Found { at_least, .. } => {
            Some(memory_bytes(any, at_least))
        }
        // A scratch for a complex of fewer simplices.
        _ => None,
    })
}
