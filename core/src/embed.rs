//! Embedding a file in a program.

/// Bytes at the alignment of a file's sections, 64 bytes: enough for every view.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Aligned<T: ?Sized>(pub T);

/// The bytes of a file, as [`include_bytes!`] takes them, at the alignment that a view needs: a `&'static [u8]` in the
/// program's read-only data, flash memory on a small machine.
///
/// ```ignore
/// static BUNNY: &[u8] = sig_core::include_aligned!("bunny.sigc");
/// let complex = sig_core::Complex::<u16>::from_bytes(BUNNY)?;
/// ```
#[macro_export]
macro_rules! include_aligned {
    ($path:expr $(,)?) => {{
        static ALIGNED: &$crate::Aligned<[u8]> = &$crate::Aligned(*include_bytes!($path));
        &ALIGNED.0
    }};
}
