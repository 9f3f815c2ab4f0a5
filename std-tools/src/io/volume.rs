//! Raw volumes: nothing but the samples of a scalar field on a grid, whose sides and type one must know.

use std::io::Read;
use std::path::Path;

use super::compression::Compression;
use super::error::{ErrorKind, Fault, Position, ReadError};
use crate::volume::{Sample, Sides, Volume};

/// The order of the bytes of a sample.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Endian {
    /// The least significant byte comes first.
    #[default]
    Little,
    /// The most significant byte comes first.
    Big,
}

/// Reads the samples in the file at `path`, or in standard input if `path` is `-`, decompressed if it begins like a
/// compressed file and is not of just the length that the samples have.
///
/// Takes time and memory linear in the samples that the file holds, whatever `sides` say.
///
/// # Errors
/// If the file cannot be read, or holds more or fewer samples than the sides say.
pub fn read_volume_path(
    path: impl AsRef<Path>,
    sides: Sides,
    sample: Sample,
    endian: Endian,
) -> Result<Volume, ReadError> {
    let path = path.as_ref();
    super::with_path(path, |mut reader, length, name| {
        read(&mut reader, length, sides, sample, endian).map_err(|fault| fault.in_file(super::displayed(name)))
    })
}

fn read(
    reader: &mut dyn Read,
    length: Option<u64>,
    sides: Sides,
    sample: Sample,
    endian: Endian,
) -> Result<Volume, Fault> {
    let size = sides.num_samples().and_then(|count| count.checked_mul(sample.size() as u64));
    let Some(size) = size.filter(|&size| usize::try_from(size).is_ok_and(|size| size < usize::MAX)) else {
        let message = format!("{sides} samples of {sample} are more than this machine can address");
        return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
    };
    let failed = |error| Fault::new(Position::Whole, ErrorKind::Io(error));
    let mut head = Vec::new();
    reader.take(Compression::MAGIC as u64).read_to_end(&mut head).map_err(failed)?;
    let compression = if length == Some(size) { None } else { Compression::of(&head) };
    let all = std::io::Cursor::new(head).chain(reader);
    let all: Box<dyn Read> = match compression {
        Some(compression) => compression.decoder(all),
        None => Box::new(all),
    };
    // One byte more tells that there are too many.
    let mut bytes = Vec::new();
    all.take(size + 1).read_to_end(&mut bytes).map_err(failed)?;
    if endian == Endian::Big {
        bytes.chunks_exact_mut(sample.size()).for_each(<[u8]>::reverse);
    }
    let (found, expected) = (bytes.len() as u64, format!("{sides} samples of {sample} take {size} bytes"));
    Volume::new(sides, sample, bytes).ok_or_else(|| {
        let holds = match length.filter(|_| compression.is_none()) {
            Some(length) => format!("{length} bytes"),
            None if found > size => format!("more than {size} bytes"),
            None => format!("{found} bytes"),
        };
        Fault::new(Position::Whole, ErrorKind::Rule(format!("{expected}, and here are {holds}").into()))
    })
}
