//! The container: what is encoded comes back, every damage is found, and no bytes make the opening panic.

use sig_core::complex::columns::{Label, Labels};
use sig_core::format::{
    self, Column, Container, ENTRY_BYTES, EncodeError, Encoder, FormatError, HEADER_BYTES, Kind, Section, SectionKind,
    TableError,
};
use sig_core::{AnyComplex, Complex, IndexWidth, VertexId, with_complex};
use sig_tests::encode::{Names, Options, encode, encode_tree};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tests::queries::reseal;
use sig_tools::Loaded;
use sig_tools::store::{AlignedBytes, verify};

fn example() -> Oracle {
    Oracle::new(&known::words("0123 014 25 6"))
}

fn everything() -> AlignedBytes {
    encode(&example(), &Options::everything(&example(), IndexWidth::Bits16))
}

#[test]
fn sections_come_back_as_they_went_in() {
    let weights = [1.5f32, -0.0, f32::INFINITY, 2.0, 3.0, 4.0];
    let bits = [0b1010_0101, 0b1];
    let sections = [
        Section::new(SectionKind::Lookup, Column::U64(&[0, 3])),
        Section::new(SectionKind::Flags, Column::Bits { bytes: &bits, len: 9 }),
        Section { components: 2, ..Section::new(SectionKind::Coordinates, Column::F32(&weights)) },
        Section { dim: Some(0), name: "a", ..Section::new(SectionKind::Attribute, Column::U16(&[1, 2, 3])) },
        Section { dim: Some(0), name: "b", ..Section::new(SectionKind::Attribute, Column::U8(&[])) },
        Section { dim: Some(1), name: "a", ..Section::new(SectionKind::Attribute, Column::U32(&[7])) },
        Section::new(SectionKind::Provenance, Column::U8("here".as_bytes())),
    ];
    for kind in [Kind::Sig, Kind::Tree, Kind::CellComplex, Kind::MultiResolution] {
        for width in IndexWidth::ALL {
            let encoder = Encoder::new(kind, width, 2, 5, &sections).unwrap().with_checksums().unwrap();
            let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
            assert_eq!(encoder.encode(&mut bytes), Ok(bytes.len()));
            let container = Container::from_bytes(&bytes).unwrap();
            let header = container.header();
            assert_eq!((header.kind, header.width, header.dims, header.num_simplices), (kind, width, 2, 5));
            assert_eq!(header.sections, 8);
            let found: Vec<Section<'_>> = container.sections().collect();
            assert_eq!(found[..7], sections);
            assert_eq!(found[7].kind, SectionKind::Checksums);
            assert!(container.spans().all(|(_, _, range)| range.start % 64 == 0));
            assert_eq!(format::verify(&bytes), Ok(()));
        }
    }
}

#[test]
fn everything_comes_back_from_a_complex() {
    let (oracle, bytes) = (example(), everything());
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    assert_eq!(complex.validate(), Ok(()));
    assert_eq!(format::verify(&bytes), Ok(()));
    let label = complex.labels().get(VertexId::new(6)).unwrap();
    assert_eq!((label, label.to_string()), (Label::Text("vertex 6 ä"), "vertex 6 ä".to_owned()));
    assert_eq!(complex.labels().get(VertexId::new(7)), None);
    let coordinates = complex.coordinates().unwrap();
    assert_eq!((coordinates.components, coordinates.column.number_at(20)), (3, Some(19.5)));
    assert_eq!(complex.filtration().unwrap().len(), oracle.len());
    let parity = complex.parity().unwrap();
    assert_eq!(parity.len(), oracle.tops().len());
    assert!(oracle.tops().iter().enumerate().all(|(row, top)| parity.bit_at(row) == Some(top % 3 == 0)));
    let weight = complex.attribute(2, "weight 2").unwrap();
    assert_eq!((weight.column.len(), weight.dim), (oracle.of_dim(2).len(), Some(2)));
    assert!(complex.attribute(2, "weight 1").is_none() && complex.attribute(1, "weight 2").is_none());
    assert_eq!(complex.provenance(), Some("made by hand"));
}

#[test]
fn integer_labels_and_none() {
    let labels: Vec<u64> = (0..7).map(|vertex| u64::MAX - vertex).collect();
    let bytes = encode(&example(), &Options { names: Names::Integers(labels), ..Options::bare(IndexWidth::Bits64) });
    let complex = Complex::<u64>::from_bytes(&bytes).unwrap();
    assert_eq!(complex.labels().get(VertexId::new(1)), Some(Label::Integer(u64::MAX - 1)));
    let bytes = encode(&example(), &Options::bare(IndexWidth::Bits64));
    let complex = Complex::<u64>::from_bytes(&bytes).unwrap();
    assert!(matches!(complex.labels(), Labels::Numbered));
    assert!(complex.coordinates().is_none() && complex.parity().is_none() && complex.filtration().is_none());
    assert!(complex.provenance().is_none() && complex.attribute(0, "weight 0").is_none());
}

#[test]
fn the_encoder_refuses_what_is_no_file() {
    let section = Section::new(SectionKind::Lookup, Column::U16(&[0]));
    let new = |sections: &[Section<'_>]| Encoder::new(Kind::Sig, IndexWidth::Bits16, 1, 1, sections).err();
    let provenance = Section::new(SectionKind::Provenance, Column::U8(&[]));
    assert_eq!(new(&[section]), None);
    assert_eq!(new(&[provenance, section]), Some(EncodeError::Order { section: SectionKind::Lookup }));
    assert_eq!(new(&[section, section]), Some(EncodeError::Order { section: SectionKind::Lookup }));
    let checksums = Section::new(SectionKind::Checksums, Column::U32(&[]));
    assert_eq!(new(&[checksums]), Some(EncodeError::Order { section: SectionKind::Checksums }));
    assert_eq!(new(&[Section { name: "x", ..section }]), Some(EncodeError::Name { section: SectionKind::Lookup }));
    let attribute = Section { dim: Some(0), ..Section::new(SectionKind::Attribute, Column::U16(&[0])) };
    for name in ["", "zero\0", &"n".repeat(65_536)] {
        assert_eq!(new(&[Section { name, ..attribute }]), Some(EncodeError::Name { section: SectionKind::Attribute }));
    }
    assert_eq!(new(&[Section { name: &"n".repeat(65_535), ..attribute }]), None);
    let shape = Some(EncodeError::Shape { section: SectionKind::Attribute });
    assert_eq!(new(&[Section { name: "a", dim: Some(1), ..attribute }]), shape);
    assert_eq!(new(&[Section { name: "a", components: 0, ..attribute }]), shape);
    assert_eq!(new(&[Section { name: "a", components: 2, ..attribute }]), shape);
    let ragged = Section::new(SectionKind::Flags, Column::Bits { bytes: &[0, 0], len: 8 });
    assert_eq!(new(&[ragged]), Some(EncodeError::Shape { section: SectionKind::Flags }));
    assert_eq!(Encoder::new(Kind::Sig, IndexWidth::Bits16, 33, 1, &[]).err(), Some(EncodeError::Dimension));
    let sections = [section];
    let encoder = Encoder::new(Kind::Sig, IndexWidth::Bits16, 1, 1, &sections).unwrap();
    let mut short = [7; 100];
    let needed = encoder.file_bytes();
    assert_eq!(encoder.encode(&mut short), Err(EncodeError::TooSmall { needed, available: 100 }));
    assert_eq!(short, [7; 100]);
}

/// The same complex as a tree.
fn everything_in_a_tree() -> AlignedBytes {
    let options = Options { parity: None, ..Options::everything(&example(), IndexWidth::Bits16) };
    encode_tree(&example(), &options)
}

/// Every flipped bit of a file is found, and located: in the header and table by their checksum or the field, in a
/// section by the checksum of its block, between sections as padding.
#[test]
fn every_flipped_bit_is_found_where_it_is() {
    for bytes in [everything(), everything_in_a_tree()] {
        assert_flipped_bits_are_found(&bytes, |damaged| format::verify(&damaged));
        // As `sig verify` goes about it: opening comes first, which damage of the lookup section does not survive.
        assert_flipped_bits_are_found(&bytes, |damaged| {
            let loaded = Loaded::from_file_bytes(damaged)?;
            verify::checksums(&loaded.file_bytes()).map(|_| ())
        });
    }
}

fn assert_flipped_bits_are_found(bytes: &AlignedBytes, verify: impl Fn(AlignedBytes) -> Result<(), FormatError>) {
    let spans: Vec<_> = Container::from_bytes(bytes).unwrap().spans().collect();
    let table_end = spans[0].2.start;
    for at in 0..bytes.len() {
        let section = spans.iter().find(|(_, _, range)| range.contains(&at));
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << bit;
            match (verify(damaged).unwrap_err(), section) {
                (FormatError::Checksum { section, dim, offset, length }, Some((kind, of_dim, range))) => {
                    assert_eq!((section, dim), (*kind, *of_dim));
                    let inside = offset..offset + length;
                    let total = *kind == SectionKind::Checksums && at + 4 >= range.end;
                    assert!(inside.contains(&(at as u64)) || total, "byte {at} is not in {inside:?}");
                }
                (FormatError::Padding { offset }, None) => assert_eq!(offset, at as u64),
                (error, section) => assert!(at < table_end && section.is_none(), "byte {at}: {error}"),
            }
        }
    }
}

#[test]
fn no_truncation_or_tail_is_opened() {
    let bytes = everything();
    for len in 0..bytes.len() {
        let cut = AlignedBytes::from(&bytes[..len]);
        let error = Container::from_bytes(&cut).unwrap_err();
        let expected = match len {
            0 => matches!(error, FormatError::NotASigFile),
            1..48 => matches!(error, FormatError::Truncated { .. }),
            _ => error == FormatError::Length { declared: bytes.len() as u64, found: len as u64 },
        };
        assert!(expected, "{len} bytes: {error}");
        assert!(format::verify(&cut).is_err());
    }
    let mut longer = AlignedBytes::zeroed(bytes.len() + 64);
    longer[..bytes.len()].copy_from_slice(&bytes);
    assert!(matches!(Container::from_bytes(&longer), Err(FormatError::Length { .. })));
    // The declared length made to fit: the bytes after the last section are still too many.
    longer[24..32].copy_from_slice(&(bytes.len() as u64 + 64).to_le_bytes());
    reseal(&mut longer);
    assert!(matches!(Container::from_bytes(&longer), Err(FormatError::Length { .. })));
}

/// No value of any byte of the header and the table makes an opening panic, the checksum holding or not; the other bytes
/// are tried with the values that are most unlike theirs.
#[test]
fn every_byte_may_be_anything() {
    for original in [everything(), encode(&example(), &Options::bare(IndexWidth::Bits64))] {
        let header_end = {
            let header = *Container::from_bytes(&original).unwrap().header();
            HEADER_BYTES + ENTRY_BYTES * header.sections as usize + header.name_bytes as usize
        };
        let mut bytes = original.clone();
        for at in header_end..original.len() {
            for value in [0, 255, original[at] ^ 1, original[at] ^ 128] {
                bytes[at] = value;
                let _ = AnyComplex::from_bytes(&bytes);
            }
            bytes[at] = original[at];
        }
        for at in 0..header_end {
            for value in (0..=255).filter(|&value| value != original[at]) {
                bytes[at] = value;
                assert!(AnyComplex::from_bytes(&bytes).is_err(), "byte {at} set to {value}");
                reseal(&mut bytes);
                let opened = AnyComplex::from_bytes(&bytes).is_ok();
                // A newer minor version is read; the checksum was just written; the table holds names.
                let free = (14..16).contains(&at) || (40..44).contains(&at) || at >= 48;
                assert!(free || !opened, "byte {at} set to {value}");
                bytes[..header_end].copy_from_slice(&original[..header_end]);
            }
        }
    }
}

#[test]
fn a_misaligned_buffer_is_refused() {
    let bytes = everything();
    let mut shifted = AlignedBytes::zeroed(bytes.len() + 8);
    for shift in 1..8 {
        shifted[shift..shift + bytes.len()].copy_from_slice(&bytes);
        let misaligned = &shifted[shift..shift + bytes.len()];
        assert_eq!(Container::from_bytes(misaligned).err(), Some(FormatError::Misaligned));
        assert_eq!(format::verify(misaligned), Ok(()), "the checks on bytes need no alignment");
    }
}

#[test]
fn the_other_byte_order() {
    for width in IndexWidth::ALL {
        let bytes = encode(&example(), &Options::everything(&example(), width));
        let mut swapped = bytes.clone();
        format::swap_byte_order(&mut swapped).unwrap();
        assert_ne!(swapped, bytes);
        assert_eq!(AnyComplex::from_bytes(&swapped).err(), Some(FormatError::ForeignByteOrder));
        assert_eq!(Container::from_bytes(&swapped[1..]).err(), Some(FormatError::NotASigFile));
        // The first boundary entries, read big-endian.
        let start = Container::from_bytes(&bytes).unwrap().spans().nth(1).unwrap().2.start;
        let there: Vec<u8> = bytes[start..start + width.bytes()].iter().rev().copied().collect();
        assert_eq!(swapped[start..start + width.bytes()], there);
        format::swap_byte_order(&mut swapped).unwrap();
        assert_eq!(swapped, bytes, "swapping twice is nothing");
    }
}

/// A section that overlaps the table, or another one, must not be swapped halfway.
#[test]
fn a_failed_swap_changes_nothing() {
    let bytes = everything();
    for entry in 0..12 {
        for offset in [0u64, 64, 128, 200, 1024] {
            let mut damaged = bytes.clone();
            let at = HEADER_BYTES + ENTRY_BYTES * entry + 8;
            damaged[at..at + 8].copy_from_slice(&offset.to_le_bytes());
            reseal(&mut damaged);
            let before = damaged.clone();
            if format::swap_byte_order(&mut damaged).is_err() {
                assert_eq!(damaged, before);
            }
        }
    }
}

/// The file with one more section of a kind that this version does not know, and the given version.
fn with_unknown_section(minor: u16, checksums: bool) -> AlignedBytes {
    let options = Options { checksums, lower: false, ..Options::everything(&example(), IndexWidth::Bits16) };
    let bytes = encode(&example(), &options);
    let count = u32::from_le_bytes(bytes[20..24].try_into().unwrap());
    let table_end = HEADER_BYTES + ENTRY_BYTES * count as usize;
    let names_end = table_end + u32::from_le_bytes(bytes[44..48].try_into().unwrap()) as usize;
    let old_start = names_end.next_multiple_of(64);
    let new_start = (names_end + ENTRY_BYTES).next_multiple_of(64);
    let moved = new_start - old_start;
    let mut longer = AlignedBytes::zeroed(bytes.len() + moved + 64);
    longer[..table_end].copy_from_slice(&bytes[..table_end]);
    longer[table_end + ENTRY_BYTES..names_end + ENTRY_BYTES].copy_from_slice(&bytes[table_end..names_end]);
    longer[new_start..bytes.len() + moved].copy_from_slice(&bytes[old_start..]);
    for entry in 0..count as usize {
        let at = HEADER_BYTES + ENTRY_BYTES * entry + 8;
        let offset = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) + moved as u64;
        longer[at..at + 8].copy_from_slice(&offset.to_le_bytes());
    }
    let at = table_end;
    longer[at..at + 2].copy_from_slice(&900u16.to_le_bytes());
    (longer[at + 2], longer[at + 3], longer[at + 4]) = (1, 0xFF, 1);
    longer[at + 8..at + 16].copy_from_slice(&((bytes.len() + moved) as u64).to_le_bytes());
    longer[at + 16] = 5;
    longer[bytes.len() + moved] = 1;
    longer[14..16].copy_from_slice(&minor.to_le_bytes());
    longer[20..24].copy_from_slice(&(count + 1).to_le_bytes());
    let len = longer.len() as u64;
    longer[24..32].copy_from_slice(&len.to_le_bytes());
    if checksums {
        add_checksum_of_the_last_section(&mut longer, count as usize - 1);
    }
    reseal(&mut longer);
    longer
}

/// The checksums, in entry `number`, cover the unknown section too: one more of them, and their own at the end.
fn add_checksum_of_the_last_section(bytes: &mut AlignedBytes, number: usize) {
    let at = HEADER_BYTES + ENTRY_BYTES * number;
    let offset = usize::try_from(u64::from_le_bytes(bytes[at + 8..at + 16].try_into().unwrap())).unwrap();
    let blocks = usize::from(bytes[at + 16]) - 1;
    let room = (4 * (blocks + 1)).next_multiple_of(64);
    assert!(bytes[at] == 16 && 4 * (blocks + 2) <= room, "the padding takes one more");
    bytes[at + 16] += 1;
    let unknown = bytes.len() - 64;
    let last = format::crc32(0, &bytes[unknown..unknown + 5]);
    bytes[offset + 4 * blocks..offset + 4 * blocks + 4].copy_from_slice(&last.to_le_bytes());
    let total = format::crc32(0, &bytes[offset..offset + 4 * blocks + 4]);
    bytes[offset + 4 * blocks + 4..offset + 4 * blocks + 8].copy_from_slice(&total.to_le_bytes());
}

#[test]
fn versions() {
    let sealed = with_unknown_section(1, true);
    assert_eq!(Complex::<u16>::from_bytes(&sealed).unwrap().validate(), Ok(()));
    assert_eq!(format::verify(&sealed), Ok(()));
    let newer = with_unknown_section(1, false);
    let complex = Complex::<u16>::from_bytes(&newer).unwrap();
    assert_eq!(complex.validate(), Ok(()));
    assert_eq!(complex.container().sections().count() + 1, complex.container().header().sections as usize);
    assert_eq!(complex.provenance(), Some("made by hand"));
    assert_eq!(format::verify(&newer), Err(FormatError::NoChecksums));
    let same = with_unknown_section(0, false);
    let entry = u32::from_le_bytes(same[20..24].try_into().unwrap()) - 1;
    let unknown = FormatError::Table { entry, error: TableError::UnknownKind(900) };
    assert_eq!(Container::from_bytes(&same).err(), Some(unknown));

    for (major, minor) in [(0, 9), (2, 0), (7, 3)] {
        let mut bytes = everything();
        (bytes[12], bytes[14]) = (major, minor);
        // Refused before the checksum: a later version may have another.
        let expected = FormatError::UnsupportedVersion { major: major.into(), minor: minor.into() };
        assert_eq!(Container::from_bytes(&bytes).err(), Some(expected));
        assert!(expected.to_string().contains("newer reader") || major == 0, "{expected}");
    }
}

#[test]
fn reserved_bytes_and_undefined_values() {
    for (at, value) in [(19, 1), (16, 0), (16, 5), (17, 1), (17, 3), (18, 33), (18, 255)] {
        let mut bytes = everything();
        bytes[at] = value;
        reseal(&mut bytes);
        assert_eq!(Container::from_bytes(&bytes).err(), Some(FormatError::Header { offset: at }), "{at}: {value}");
    }
    let mut bytes = everything();
    bytes[24..32].copy_from_slice(&u64::MAX.to_le_bytes());
    reseal(&mut bytes);
    assert_eq!(Container::from_bytes(&bytes).err(), Some(FormatError::TooLarge { length: u64::MAX }));
    let mut bytes = everything();
    bytes[20..24].copy_from_slice(&u32::MAX.to_le_bytes());
    reseal(&mut bytes);
    assert!(matches!(Container::from_bytes(&bytes), Err(FormatError::Truncated { .. })));
}

#[test]
fn the_width_asked_for_must_be_that_of_the_file() {
    for width in IndexWidth::ALL {
        let bytes = encode(&example(), &Options::bare(width));
        let found = [
            (IndexWidth::Bits16, Complex::<u16>::from_bytes(&bytes).err()),
            (IndexWidth::Bits32, Complex::<u32>::from_bytes(&bytes).err()),
            (IndexWidth::Bits64, Complex::<u64>::from_bytes(&bytes).err()),
        ];
        for (expected, error) in found {
            let wrong = FormatError::WrongWidth { found: width, expected };
            assert_eq!(error, (width != expected).then_some(wrong));
        }
        // A header that lies about the width of its sections.
        for lie in IndexWidth::ALL {
            let mut bytes = bytes.clone();
            bytes[17] = u8::try_from(lie.bytes()).unwrap();
            reseal(&mut bytes);
            assert_eq!(AnyComplex::from_bytes(&bytes).is_ok(), lie == width);
        }
    }
}

#[test]
fn other_kinds_of_file_are_not_complexes() {
    for kind in 2..=4 {
        let mut bytes = everything();
        bytes[16] = kind;
        reseal(&mut bytes);
        assert!(Container::from_bytes(&bytes).is_ok());
        assert!(matches!(Complex::<u16>::from_bytes(&bytes), Err(FormatError::WrongKind { .. })));
    }
}

#[test]
fn padding_is_zero() {
    let bytes = encode(&example(), &Options { checksums: true, ..Options::bare(IndexWidth::Bits16) });
    let spans: Vec<_> = Container::from_bytes(&bytes).unwrap().spans().collect();
    let mut padded = 0;
    for (_, _, range) in spans {
        for at in range.end..range.end.next_multiple_of(64) {
            let mut damaged = bytes.clone();
            damaged[at] = 1;
            assert!(Container::from_bytes(&damaged).is_ok(), "opening reads no padding");
            assert_eq!(format::verify(&damaged), Err(FormatError::Padding { offset: at as u64 }));
            padded += 1;
        }
    }
    assert!(padded > 100);
}

#[test]
fn blocks_of_checksums_cover_a_section_of_many_megabytes() {
    let text = vec![7; 2 * format::CHECKSUM_BLOCK_BYTES + 5];
    let sections = [
        Section::new(SectionKind::LabelText, Column::U8(&[])),
        Section::new(SectionKind::Provenance, Column::U8(&text)),
    ];
    let encoder = Encoder::new(Kind::CellComplex, IndexWidth::Bits16, 0, 0, &sections).unwrap();
    let encoder = encoder.with_checksums().unwrap();
    let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
    encoder.encode(&mut bytes).unwrap();
    let blocks: Vec<_> = format::Blocks::of_file(&bytes).unwrap().iter().collect();
    let lengths: Vec<usize> = blocks.iter().map(|block| block.bytes.len()).collect();
    assert_eq!(lengths, [format::CHECKSUM_BLOCK_BYTES, format::CHECKSUM_BLOCK_BYTES, 5]);
    assert!(blocks.iter().all(|block| block.check(format::crc32).is_ok()));
    let at = blocks[1].offset + 17;
    let length = format::CHECKSUM_BLOCK_BYTES as u64;
    let expected =
        FormatError::Checksum { section: SectionKind::Provenance, dim: None, offset: blocks[1].offset as u64, length };
    bytes[at] ^= 128;
    assert_eq!(format::verify(&bytes), Err(expected));
}

/// The check value that the catalogues of CRCs give for CRC-32/ISO-HDLC.
#[test]
fn the_crc_is_that_of_zlib() {
    assert_eq!(format::crc32(0, b"123456789"), 0xCBF4_3926);
    assert_eq!(format::crc32(format::crc32(0, b"1234"), b"56789"), 0xCBF4_3926);
    assert_eq!(format::crc32(0, b""), 0);
}

#[test]
fn degenerate_complexes() {
    for width in IndexWidth::ALL {
        for (words, dim, count) in [("", None, 0), ("0", Some(0), 1), ("0 1 2", Some(0), 3), ("01", Some(1), 3)] {
            let oracle = Oracle::new(&known::words(words));
            for options in [Options::bare(width), Options::everything(&oracle, width)] {
                let bytes = encode(&oracle, &options);
                let any = AnyComplex::from_bytes(&bytes).unwrap();
                with_complex!(any, complex => {
                    assert_eq!((complex.dim(), complex.num_simplices()), (dim, count));
                    assert_eq!(complex.validate(), Ok(()));
                });
                assert_eq!(format::verify(&bytes).is_ok(), options.checksums);
            }
        }
    }
}
