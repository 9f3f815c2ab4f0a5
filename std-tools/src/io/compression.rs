//! Compressed inputs: told by their first bytes, decompressed on the way, in memory that a limit bounds.

use std::fmt;
use std::io::{self, BufReader, Cursor, Read};

use flate2::read::MultiGzDecoder;
use lzma_rust2::XzReader;
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};

/// How an input is compressed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Compression {
    /// Gzip, of one member or several.
    Gzip,
    /// XZ, of one stream or several.
    Xz,
    /// Zstandard, of one frame or several.
    Zstd,
}

/// The most memory that a decompressor may keep of what it gave: a file can ask for gigabytes.
const WINDOW: u32 = 256 << 20;

impl Compression {
    const ALL: [Self; 3] = [Self::Gzip, Self::Xz, Self::Zstd];

    /// The name, as reports have it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gzip => "gzip",
            Self::Xz => "xz",
            Self::Zstd => "zstd",
        }
    }

    const fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Gzip => &[".gz"],
            Self::Xz => &[".xz"],
            Self::Zstd => &[".zst", ".zstd"],
        }
    }

    /// The bytes that [`Self::of`] looks at.
    pub(super) const MAGIC: usize = 6;

    /// The compression of an input that begins with these bytes.
    pub(super) fn of(head: &[u8]) -> Option<Self> {
        match head {
            [0x1f, 0x8b, ..] => Some(Self::Gzip),
            [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => Some(Self::Xz),
            [0x28, 0xb5, 0x2f, 0xfd, ..] => Some(Self::Zstd),
            _ => None,
        }
    }

    /// The bytes that `reader` gives, decompressed.
    pub(super) fn decoder<'a>(self, reader: impl Read + 'a) -> Box<dyn Read + 'a> {
        // The decoders of XZ and Zstandard ask for a few bytes at a time.
        match self {
            Self::Gzip => Box::new(MultiGzDecoder::new(reader)),
            Self::Xz => Box::new(XzReader::new_mem_limit(BufReader::new(reader), true, WINDOW >> 10)),
            Self::Zstd => Box::new(Frames { state: State::Between(BufReader::new(reader)) }),
        }
    }
}

impl fmt::Display for Compression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The name of an input without what says that it is compressed.
pub(super) fn without_suffix(name: &str) -> &str {
    let suffixes = Compression::ALL.into_iter().flat_map(Compression::suffixes);
    let mut stems = suffixes.filter_map(|suffix| {
        let (stem, end) = name.split_at_checked(name.len().checked_sub(suffix.len())?)?;
        (end.eq_ignore_ascii_case(suffix) && !stem.is_empty()).then_some(stem)
    });
    stems.next().unwrap_or(name)
}

/// The frames of a Zstandard file, one after the other.
struct Frames<R: Read> {
    state: State<R>,
}

type Frame<R> = StreamingDecoder<io::Chain<Cursor<[u8; 4]>, R>, FrameDecoder>;

enum State<R: Read> {
    Between(R),
    Within(Box<Frame<R>>),
    Ended,
}

/// The next frame that holds data, `None` at the end.
fn next_frame<R: Read>(mut reader: R) -> io::Result<Option<Frame<R>>> {
    loop {
        let mut magic = [0; 4];
        let mut read = 0;
        while read < magic.len() {
            match reader.read(&mut magic[read..]) {
                Ok(0) if read == 0 => return Ok(None),
                Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(more) => read += more,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        // Frames of data of others, which are to be passed over.
        if magic[0] & 0xf0 == 0x50 && magic[1..] == [0x2a, 0x4d, 0x18] {
            let mut length = [0; 4];
            reader.read_exact(&mut length)?;
            let length = u64::from(u32::from_le_bytes(length));
            if io::copy(&mut reader.by_ref().take(length), &mut io::sink())? < length {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            continue;
        }
        let whole = Cursor::new(magic).chain(reader);
        let frame = StreamingDecoder::new_with_max_window_size(whole, WINDOW.into()).map_err(io::Error::other)?;
        return Ok(Some(frame));
    }
}

impl<R: Read> Read for Frames<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        loop {
            // After an error nothing more is read.
            match std::mem::replace(&mut self.state, State::Ended) {
                State::Ended => return Ok(0),
                State::Between(reader) => {
                    self.state = next_frame(reader)?.map_or(State::Ended, |frame| State::Within(Box::new(frame)));
                }
                State::Within(mut frame) => {
                    let read = frame.read(buffer)?;
                    if read > 0 {
                        self.state = State::Within(frame);
                        return Ok(read);
                    }
                    self.state = State::Between(frame.into_parts().0.into_inner().1);
                }
            }
        }
    }
}
