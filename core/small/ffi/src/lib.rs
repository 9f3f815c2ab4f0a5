//! The core for C and WebAssembly: pointers, lengths and status codes, without a standard library or an allocator.
//!
//! All memory is the caller's: the bytes of the file, which are read where they lie, a [`Complex`] and a [`Scratch`] of
//! fixed sizes, the memory that queries need, and the room for answers. `include/sig.h` is made from this file.
//!
//! The only crate of the project whose functions are unsafe to call, beside the memory map: what a pointer leads to is
//! known to the caller alone. Each block says which promise of the header it relies on.
#![no_std]
#![allow(unsafe_code, reason = "the other side of a pointer is known to the caller alone")]

mod opened;
mod scratch;

use core::mem::MaybeUninit;

use ask::Relation;
use opened::{Opened, with_opened};
#[cfg(feature = "checks")]
use sig_core::format;
use sig_core::format::FormatError;
use sig_core::{SimplexId, VertexId};

pub use scratch::{SCRATCH_WORDS, Scratch};

/// How a call ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(i32)]
pub enum Status {
    /// It is done.
    Ok = 0,
    /// A pointer is null or not aligned, a length is more than memory can hold, or there is no relation of that number.
    Argument = 1,
    /// The bytes are no file, or not a whole one, or of another version.
    NotAFile = 2,
    /// The bytes are in the other byte order: sig_swap_byte_order turns them round.
    ByteOrder = 3,
    /// The file does not hold a complex of kind *sig*.
    Kind = 4,
    /// The file is damaged.
    Damaged = 5,
    /// The memory is too small; the count is how many bytes the query needs, at least.
    Memory = 6,
    /// There is not enough room for the answer; the count is how many entries it has.
    Room = 7,
    /// There is no such simplex.
    NoSimplex = 8,
    /// The library was built without indices of the file's width.
    Width = 9,
}

impl From<FormatError> for Status {
    fn from(error: FormatError) -> Self {
        match error {
            FormatError::Misaligned => Self::Argument,
            FormatError::ForeignByteOrder => Self::ByteOrder,
            FormatError::WrongKind { .. } => Self::Kind,
            FormatError::NotASigFile
            | FormatError::Truncated { .. }
            | FormatError::UnsupportedVersion { .. }
            | FormatError::TooLarge { .. }
            | FormatError::Length { .. } => Self::NotAFile,
            _ => Self::Damaged,
        }
    }
}

/// The words of 8 bytes in a sig_complex.
pub const COMPLEX_WORDS: usize = 210;

/// A complex that sig_open opened: copied at will, and of use as long as the bytes of the file are.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Complex {
    /// Nobody's business.
    words: [MaybeUninit<u64>; COMPLEX_WORDS],
}

const _: () = assert!(size_of::<Opened>() <= size_of::<Complex>());
const _: () = assert!(align_of::<Opened>() <= align_of::<Complex>());

/// The largest dimension that a complex may have.
pub const MAX_DIM: usize = 31;

const _: () = assert!(MAX_DIM == sig_core::MAX_DIM);

/// Opens the complex in a file of kind *sig*, which lies at an address that is a multiple of 8, in the host's byte order.
/// The bytes stay where they are and must not change as long as the complex is used. Takes constant time, and looks into no
/// array: on what it accepts every query ends; sig_validate says whether the answers are right.
///
/// # Safety
/// `bytes` leads to `length` bytes, `complex` to a sig_complex, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_open(bytes: *const u8, length: usize, complex: *mut Complex) -> Status {
    if !is_array(bytes, length) || !is_valid(complex) {
        return Status::Argument;
    }
    // SAFETY: the caller promises so many bytes, which do not change.
    let bytes: &'static [u8] = unsafe { core::slice::from_raw_parts(bytes, length) };
    match Opened::from_bytes(bytes) {
        // SAFETY: the caller promises room, which is aligned, and large enough by the assertions above.
        Ok(opened) => unsafe { complex.cast::<Opened>().write(opened) },
        Err(status) => return status,
    }
    Status::Ok
}

/// Checks the checksums of a file as it lies on disk, in little-endian order. Takes time linear in its length.
///
/// # Safety
/// `bytes` leads to `length` bytes, or is null.
#[cfg(feature = "checks")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_verify(bytes: *const u8, length: usize) -> Status {
    if !is_array(bytes, length) {
        return Status::Argument;
    }
    // SAFETY: the caller promises so many bytes.
    let bytes = unsafe { core::slice::from_raw_parts(bytes, length) };
    format::verify(bytes).map_or_else(Status::from, |()| Status::Ok)
}

/// Turns a file from one byte order into the other, in place: on a big-endian host a file must be turned round before it is
/// opened. Takes time linear in its length; of what is not a file it leaves the bytes as they are.
///
/// # Safety
/// `bytes` leads to `length` bytes that may be written and are not an open complex, or is null.
#[cfg(feature = "checks")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_swap_byte_order(bytes: *mut u8, length: usize) -> Status {
    if !is_array(bytes, length) {
        return Status::Argument;
    }
    // SAFETY: the caller promises so many bytes that nobody else reads.
    let bytes = unsafe { core::slice::from_raw_parts_mut(bytes, length) };
    format::swap_byte_order(bytes).map_or_else(Status::from, |()| Status::Ok)
}

/// Checks the arrays of a complex, which sig_open does not: after it, answers are right. Takes time linear in the file.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, or is null.
#[cfg(feature = "checks")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_validate(complex: *const Complex) -> Status {
    // SAFETY: the caller promises an open complex.
    let Some(opened) = (unsafe { opened(complex) }) else { return Status::Argument };
    with_opened!(opened, complex => complex.validate().map_or_else(Status::from, |()| Status::Ok))
}

/// The dimension of a complex; -1 if it is empty, or null.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, or is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_dim(complex: *const Complex) -> i32 {
    // SAFETY: the caller promises an open complex.
    let dim = unsafe { opened(complex) }.and_then(|any| with_opened!(any, complex => complex.dim()));
    dim.and_then(|dim| i32::try_from(dim).ok()).unwrap_or(-1)
}

/// The first simplex of a dimension: simplices are numbered by dimension, then by their vertices. The number of all
/// simplices past the dimension of the complex; 0 if it is null.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, or is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_first_of_dim(complex: *const Complex, dim: usize) -> usize {
    // SAFETY: the caller promises an open complex.
    let Some(any) = (unsafe { opened(complex) }) else { return 0 };
    with_opened!(any, complex => complex.simplices_of_dim(dim).bounds().0.index())
}

/// The simplex with the given vertices, which must increase.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, `vertices` to `length` vertices, `simplex` to room for one, or they
/// are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_find(
    complex: *const Complex,
    vertices: *const usize,
    length: usize,
    simplex: *mut usize,
) -> Status {
    // SAFETY: the caller promises an open complex.
    let any = unsafe { opened(complex) };
    let Some(any) = any.filter(|_| is_array(vertices, length) && is_valid(simplex)) else { return Status::Argument };
    // SAFETY: the caller promises so many vertices.
    let vertices = unsafe { core::slice::from_raw_parts(vertices, length) };
    let mut word = [VertexId::new(0); MAX_DIM + 1];
    let Some(word) = word.get_mut(..vertices.len()) else { return Status::NoSimplex };
    for (slot, &vertex) in word.iter_mut().zip(vertices) {
        *slot = VertexId::new(vertex);
    }
    let Some(found) = with_opened!(any, complex => complex.find(word)) else { return Status::NoSimplex };
    // SAFETY: the caller promises room for one.
    unsafe { simplex.write(found.index()) };
    Status::Ok
}

/// How many bytes sig_scratch_init needs for queries whose traversals and answers have up to `entries` simplices.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, or is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_memory_bytes(complex: *const Complex, entries: usize) -> usize {
    // SAFETY: the caller promises an open complex.
    unsafe { opened(complex) }.map_or(0, |any| scratch::memory_bytes(&any, entries))
}

/// Makes a scratch for the queries on a complex from memory at an address that is a multiple of 8: as many entries as fit.
/// It can be used again and again, by one thread at a time. Takes time linear in the memory.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, `memory` to `bytes` bytes that nobody else uses as long as the scratch
/// is used, `scratch` to a sig_scratch, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_scratch_init(
    complex: *const Complex,
    memory: *mut u8,
    bytes: usize,
    scratch: *mut Scratch,
) -> Status {
    // SAFETY: the caller promises an open complex.
    let any = unsafe { opened(complex) };
    let Some(any) = any.filter(|_| is_array(memory, bytes) && is_valid(scratch)) else { return Status::Argument };
    // SAFETY: the caller promises so many bytes, and that they are the scratch's alone.
    let memory: &'static mut [u8] = unsafe { core::slice::from_raw_parts_mut(memory, bytes) };
    memory.fill(0);
    match scratch::new(&any, memory) {
        // SAFETY: the caller promises room, which is aligned, and large enough by the assertions beside the type.
        Ok(made) => unsafe { scratch.cast::<scratch::AnyScratch>().write(made) },
        Err(status) => return status,
    }
    Status::Ok
}

/// Asks for a relation of a simplex: writes the simplices, or vertices, that it leads to, up to `capacity`, and how many they
/// are. What the relations are and what the argument is says sig_relation.
///
/// If the memory of the scratch is too small, the count is how many bytes the query needs at least, and nothing is written;
/// make a scratch of more. If only the room for the answer is, the count is how many entries it has. The scratch can be used
/// again in any case.
///
/// # Safety
/// `complex` leads to a complex that sig_open opened, `scratch` to a scratch that sig_scratch_init made for it, `found` to
/// room for `capacity` entries, `count` to room for one, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sig_ask(
    complex: *const Complex,
    scratch: *mut Scratch,
    relation: u32,
    simplex: usize,
    argument: usize,
    found: *mut usize,
    capacity: usize,
    count: *mut usize,
) -> Status {
    // SAFETY: the caller promises an open complex.
    let any = unsafe { opened(complex) };
    let question = Relation::from_code(relation).map(|relation| (relation, argument));
    let (Some(any), Some(question)) = (any, question) else { return Status::Argument };
    if !is_valid(scratch) || !is_array(found, capacity) || !is_valid(count) {
        return Status::Argument;
    }
    // SAFETY: the caller promises a scratch that was made, used by nobody else now.
    let scratch = unsafe { &mut *scratch.cast::<scratch::AnyScratch>() };
    // SAFETY: the caller promises room for so many entries; what it holds is not read.
    let found = unsafe { core::slice::from_raw_parts_mut(found.cast::<MaybeUninit<usize>>(), capacity) };
    let mut counted = 0;
    let mut each = |id| {
        if let Some(slot) = found.get_mut(counted) {
            slot.write(id);
        }
        counted += 1;
    };
    let asked = scratch::ask(&any, question, SimplexId::new(simplex), scratch, &mut each);
    let (status, counted) = match asked {
        Ok(()) if counted <= capacity => (Status::Ok, counted),
        Ok(()) => (Status::Room, counted),
        Err(Some(needed)) => (Status::Memory, needed),
        Err(None) => (Status::Argument, 0),
    };
    // SAFETY: the caller promises room for one.
    unsafe { count.write(counted) };
    status
}

/// A complex that the caller says is open.
///
/// # Safety
/// `complex` leads to a complex that [`sig_open`] opened, or is null.
unsafe fn opened(complex: *const Complex) -> Option<Opened> {
    // SAFETY: what `sig_open` wrote, where there is something.
    is_valid(complex).then(|| unsafe { *complex.cast::<Opened>() })
}

/// Whether a pointer is not null, and aligned.
fn is_valid<T>(pointer: *const T) -> bool {
    !pointer.is_null() && pointer.is_aligned()
}

/// Whether that, and so many elements are no more than memory can hold.
fn is_array<T>(pointer: *const T, length: usize) -> bool {
    is_valid(pointer) && length <= isize::MAX.unsigned_abs() / size_of::<T>()
}

/// Never called: nothing in the core panics.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
