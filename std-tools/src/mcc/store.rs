//! Files of multi-resolution complexes, and of cell complexes: writing, and loading.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;

use memmap2::Mmap;
use sig_core::IndexWidth;
use sig_core::format::{Column, Encoder, FormatError, Kind, Section, SectionKind};
use sig_core::mcc::Mcc;

use super::record::MultiResolution;
use super::site_tree::site_tree;
use crate::soup::{Coordinates, Scalars};
use crate::store::{AlignedBytes, OpenError, OpenErrorKind, crc32, map_file};

/// Writes a multi-resolution complex, or, without refinements, a cell complex, with the coordinates of the vertices of the full
/// complex, and checksums. The same complex gives the same bytes.
///
/// # Errors
/// Those of the writer.
pub fn write_mcc(
    complex: &MultiResolution,
    coordinates: Option<&Coordinates>,
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    let site_tree = coordinates.map_or_else(Vec::new, |coordinates| site_tree(&complex.sites, coordinates));
    let coordinates = coordinates.map(|coordinates| {
        let column = match &coordinates.values {
            Scalars::F32(values) => Column::F32(values),
            Scalars::F64(values) => Column::F64(values),
        };
        let components = u32::try_from(coordinates.dim).unwrap_or(u32::MAX);
        Section { components, ..Section::new(SectionKind::Coordinates, column) }
    });
    let words = |kind, words| Section::new(kind, Column::U32(words));
    let mut sections = vec![words(SectionKind::Lookup, &complex.lookup)];
    sections.extend(coordinates);
    sections
        .extend([words(SectionKind::BaseOffsets, &complex.base_offsets), words(SectionKind::CellArcs, &complex.arcs)]);
    if !complex.large.is_empty() {
        let large = words(SectionKind::LargeIncidences, &complex.large);
        sections.push(Section { components: 3, ..large });
    }
    sections.push(words(SectionKind::Origins, &complex.origins));
    let kind = if complex.shapes.is_empty() { Kind::CellComplex } else { Kind::MultiResolution };
    if kind == Kind::MultiResolution {
        sections.extend([
            words(SectionKind::RefinementOffsets, &complex.offsets),
            Section::new(SectionKind::RefinementShapes, Column::U8(&complex.shapes)),
            words(SectionKind::RefinementSplits, &complex.splits),
            Section::new(SectionKind::RefinementErrors, Column::F32(&complex.errors)),
            words(SectionKind::RefinementSites, &complex.sites),
        ]);
        if !site_tree.is_empty() {
            sections.push(words(SectionKind::SiteTree, &site_tree));
        }
    }
    let (dims, cells) = (complex.lookup.len(), complex.origins.len() as u64);
    let invalid = |error| io::Error::new(io::ErrorKind::InvalidInput, error);
    let encoder = Encoder::new(kind, IndexWidth::Bits32, dims, cells, &sections).map_err(invalid)?;
    encoder.with_checksums().map_err(invalid)?.write_with(crc32, |piece| out.write_all(piece))
}

/// A file of a multi-resolution complex or a cell complex: mapped where it lies, or in memory.
///
/// Nobody may change a file while it is mapped: see [`Mapped`](crate::Mapped).
#[derive(Debug)]
pub struct MccFile {
    bytes: Bytes,
}

#[derive(Debug)]
enum Bytes {
    Mapped(Mmap),
    Loaded(AlignedBytes),
}

impl MccFile {
    /// Maps the file at `path`; on a big-endian host it is loaded. Cost: O(number of sections).
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let wrong = |kind| OpenError::new(path, kind);
        if cfg!(target_endian = "big") {
            return Self::load(path);
        }
        let map = map_file(path)?;
        Mcc::from_bytes(&map).map_err(|error| wrong(OpenErrorKind::Format(error)))?;
        Ok(Self { bytes: Bytes::Mapped(map) })
    }

    /// Loads the file at `path` into memory, for one that another program may write into while it is used. Cost: reading it.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let wrong = |kind| OpenError::new(path, kind);
        let mut file = File::open(path).map_err(|error| wrong(OpenErrorKind::Io(error)))?;
        Self::read(&mut file, path)
    }

    /// Reads a file from a stream that is called `path` in errors.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn read(reader: &mut impl Read, path: &Path) -> Result<Self, OpenError> {
        let wrong = |kind| OpenError::new(path, kind);
        let bytes = AlignedBytes::read(reader, 0).map_err(|error| wrong(OpenErrorKind::Io(error)))?;
        Self::from_file_bytes(bytes).map_err(|error| wrong(OpenErrorKind::Format(error)))
    }

    /// The complex in the bytes of a file as it lies on disk.
    ///
    /// # Errors
    /// [`FormatError`], as [`Mcc::from_container`].
    pub fn from_file_bytes(mut bytes: AlignedBytes) -> Result<Self, FormatError> {
        if cfg!(target_endian = "big") {
            sig_core::format::swap_byte_order(&mut bytes)?;
        }
        Mcc::from_bytes(&bytes)?;
        Ok(Self { bytes: Bytes::Loaded(bytes) })
    }

    /// The complex. Cost: O(number of sections).
    ///
    /// # Panics
    /// If another program has written into the header since the file was opened.
    #[must_use]
    pub fn view(&self) -> Mcc<'_> {
        Mcc::from_bytes(self.bytes()).expect("a mapped file was changed by another program")
    }

    /// The bytes as they lie on disk.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "bytes that were opened can be swapped back")]
    pub fn file_bytes(&self) -> Cow<'_, [u8]> {
        if cfg!(target_endian = "big") {
            let mut bytes = AlignedBytes::from(self.bytes());
            sig_core::format::swap_byte_order(&mut bytes).expect("bytes that were swapped once");
            return Cow::Owned(bytes.to_vec());
        }
        Cow::Borrowed(self.bytes())
    }

    /// The bytes in memory, in the host's byte order.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        match &self.bytes {
            Bytes::Mapped(map) => map,
            Bytes::Loaded(bytes) => bytes,
        }
    }
}
