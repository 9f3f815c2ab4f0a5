use std::io::Write;
use std::sync::atomic::{AtomicU64, Ordering};

use flate2::Compression as Level;
use flate2::write::GzEncoder;

use super::super::{Compression, Format, ReadOptions, read, read_bytes};
use super::tops::tetbin;
use super::{msh, ply, stl};

fn detected(name: &str, bytes: impl AsRef<[u8]>) -> Option<Format> {
    let found = read_bytes(bytes.as_ref(), name, &ReadOptions::default());
    found
        .map(|(_, report)| report.format)
        .map_err(|error| assert!(error.to_string().contains("tells the format"), "{error}"))
        .ok()
}

#[test]
fn content_that_is_certain_beats_the_name() {
    for name in ["-", "x", "x.off", "x.obj", "x.txt", "dir.ply/x"] {
        assert_eq!(detected(name, "# c\n\nOFF 0 0 0\n"), Some(Format::Off));
        assert_eq!(detected(name, "nOFF 2 0 0 0\n"), Some(Format::Off));
        assert_eq!(detected(name, ply::TEXT), Some(Format::Ply));
        assert_eq!(detected(name, ply::binary(true)), Some(Format::Ply));
        assert_eq!(detected(name, tetbin(&[[0., 0., 0.]], &[])), Some(Format::Tetbin));
        assert_eq!(detected(name, msh::TEXT_2), Some(Format::Msh));
        assert_eq!(detected(name, msh::binary_4(8, false)), Some(Format::Msh));
        assert_eq!(detected(name, stl::TEXT), Some(Format::Stl));
        assert_eq!(detected(name, stl::binary("solid", &[])), Some(Format::Stl));
        assert_eq!(detected(name, stl::binary("\u{1}", &[[[0.; 3], [1.; 3], [2.; 3]]])), Some(Format::Stl));
    }
}

#[test]
fn the_name_beats_content_that_only_suggests() {
    let vertices = "v 1 2 3\nv 4 5 6\nv 7 8 9\n";
    assert_eq!(detected("-", vertices), Some(Format::Obj));
    assert_eq!(detected("x.OBJ", vertices), Some(Format::Obj));
    assert_eq!(detected("x.txt", vertices), Some(Format::Obj));
    assert_eq!(detected("-", "# list\nfacets:=[[1,2],[2,3]];\n"), Some(Format::SimplexList));
    assert_eq!(detected("x.off", "1 0 0\n0 0 0\n"), Some(Format::Off));
    assert_eq!(detected("x.tops", "1 0\n0 0\n"), Some(Format::Tops));
    assert_eq!(detected("a.b/x.simplices", "1 0 0x\n"), Some(Format::SimplexList));
}

#[test]
fn rows_of_whole_numbers_are_a_list_of_simplices() {
    assert_eq!(detected("-", "1 2 3\n"), Some(Format::SimplexList));
    assert_eq!(detected("x.docx", "# list\n1,2\t3 # here\n\n4\n"), Some(Format::SimplexList));
    assert_eq!(detected("-", "1 2 3\n4 -5\n"), None);
}

#[test]
fn an_unknown_format_is_refused_with_the_list_of_formats() {
    assert_eq!(detected("-", "a b c\n"), None);
    assert_eq!(detected("x.docx", "1 2 3.5\n"), None);
    assert_eq!(detected(".obj", "a b c\n"), None);
    let error = read_bytes(b"a b c\n", "-", &ReadOptions::default()).unwrap_err().to_string();
    let expected = "<stdin>: neither the content nor the name tells the format; name it (--format), one of: \
                    off, obj, ply, stl, msh, vtk, vtu, medit, mfem, tetgen, abaqus, nastran, tetbin, tops, simplices";
    assert_eq!(error, expected);
}

#[test]
fn names_of_formats() {
    for &format in Format::ALL {
        assert_eq!(Format::from_name(format.name()), Some(format));
        assert_eq!(Format::from_name(&format.to_string().to_uppercase()), Some(format));
        assert!(!format.description().is_empty());
        for extension in format.extensions() {
            assert_eq!(Format::from_name(extension), Some(format));
        }
    }
    assert_eq!(Format::from_name("doc"), None);
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Level::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn gzip_is_decompressed_and_its_name_looked_through() {
    // Two members one after the other are one file.
    let text = b"1 0 0\n0 0 0\n";
    let bytes = [gzip(&text[..5]), gzip(&text[5..])].concat();
    let (soup, report) = read_bytes(&bytes, "x.off.GZ", &ReadOptions::default()).unwrap();
    assert_eq!(report.compression, Some(Compression::Gzip));
    assert_eq!((soup.labels.len(), report.format), (1, Format::Off));
    let binary = gzip(&stl::binary("solid", &[[[0.; 3], [1.; 3], [2.; 3]]]));
    assert_eq!(read_bytes(&binary, "-", &ReadOptions::default()).unwrap().1.format, Format::Stl);
    let error = read_bytes(&bytes[..bytes.len() - 12], "x.off.gz", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("x.off.gz: byte ") && error.contains(": cannot read: "), "{error}");
}

/// Bytes written in hexadecimal.
fn hexadecimal(text: &str) -> Vec<u8> {
    (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).unwrap()).collect()
}

/// As `xz -9` and `zstd -19` wrote a point in OFF without its keyword.
const XZ: &str = "fd377a585a000004e6d6b446020021011c00000010cf58cc01000b31203020300a30203020300a00f5b4612d2f3c49a90001240ca618d8d8\
                  1fb6f37d010000000004595a";
const ZSTD: &str = "28b52ffd046861000031203020300a30203020300a5d930f2b";

#[test]
fn xz_and_zstd_are_decompressed_and_their_names_looked_through() {
    let frame = hexadecimal(ZSTD);
    // A frame that decoders pass over, after the first; the two lines in two frames.
    let skipped = [&[0x53, 0x2a, 0x4d, 0x18, 3, 0, 0, 0][..], b"any"].concat();
    let parts = hexadecimal("28b52ffd200631000031203020300a28b52ffd200631000030203020300a");
    for (bytes, name, compression) in [
        (hexadecimal(XZ), "x.off.xz", Compression::Xz),
        (frame.clone(), "x.off.ZST", Compression::Zstd),
        ([&frame[..], &skipped].concat(), "x.off.zstd", Compression::Zstd),
        (parts, "x.off.zst", Compression::Zstd),
    ] {
        let (soup, report) = read_bytes(&bytes, name, &ReadOptions::default()).unwrap();
        assert_eq!((soup.labels.len(), report.format, report.compression), (1, Format::Off, Some(compression)));
        for end in 6..bytes.len() {
            let error = read_bytes(&bytes[..end], name, &ReadOptions::default()).err();
            assert!(error.is_none_or(|error| error.to_string().starts_with(name)));
        }
    }
}

/// A frame of 11 bytes that asks for a window of 2 GiB.
#[test]
fn a_window_beyond_the_limit_is_refused() {
    let bytes = hexadecimal("28b52ffd00a8310000310a");
    let error = read_bytes(&bytes, "x.zst", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("x.zst: cannot read: ") && error.contains("indow"), "{error}");
}

#[test]
fn progress_counts_the_bytes_of_the_compressed_input() {
    let text = "1 2\n".repeat(100_000);
    let bytes = gzip(text.as_bytes());
    let (last, calls) = (AtomicU64::new(0), AtomicU64::new(0));
    let progress = |read: u64| {
        assert!(last.swap(read, Ordering::Relaxed) <= read);
        calls.fetch_add(1, Ordering::Relaxed);
    };
    let options = ReadOptions { format: Some(Format::SimplexList), progress: Some(&progress), ..Default::default() };
    assert_eq!(read(&bytes[..], "-", &options).unwrap().1.simplices, [0, 100_000]);
    assert_eq!(last.into_inner(), bytes.len() as u64);
    assert!(calls.into_inner() > 0);
}

#[test]
fn a_byte_order_mark_does_not_stick_to_the_first_word() {
    assert_eq!(detected("-", "\u{feff}OFF 0 0 0\n"), Some(Format::Off));
    let (soup, _) = read_bytes("\u{feff}1 2\n".as_bytes(), "x.txt", &ReadOptions::default()).unwrap();
    assert_eq!(soup.labels, crate::soup::Labels::Integers(vec![1, 2]));
}

#[test]
fn what_other_commands_read_is_refused_with_their_names() {
    let refusal = |name: &str, bytes: &[u8]| {
        read_bytes(bytes, name, &ReadOptions::default())
            .map(|(_, report)| report.format)
            .map_err(|error| error.to_string())
    };
    let text = b"0 0 0\n0 1 0\n1 0 1 0.5\n";
    for name in ["-", "x.txt", "x"] {
        assert!(refusal(name, text).unwrap_err().contains("sig tree convert"), "{name}");
    }
    assert_eq!(refusal("x.txt", b"0 1 2\n1 2 3 4\n"), Ok(Format::SimplexList));
    assert!(refusal("x.facets", text).unwrap_err().starts_with("x.facets:1:1: the simplex repeats vertex 0"));
    assert!(refusal("x", &sig_core::format::MAGIC).unwrap_err().starts_with("x: this is a complex already"));
}
