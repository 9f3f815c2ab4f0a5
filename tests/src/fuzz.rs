//! The bodies of the fuzz targets. Each takes any bytes and panics on a bug; the tests replay the committed corpus.

use arbitrary::Unstructured;
use sig_core::format::{self, Container};
use sig_core::{AnyComplex, with_complex};

use crate::aligned::AlignedBytes;
use crate::conformance;
use crate::encode::{Options, encode};
use crate::oracle::{Oracle, Word};
use crate::queries::{ask_everything, reseal};

/// Simplices of which everything is asked.
const ASKED: usize = 64;

/// Opens the bytes as a file, and again with the header's checksum made to fit, and asks what was accepted everything.
pub fn open(bytes: &[u8]) {
    let mut buffer = AlignedBytes::from(bytes);
    open_one(&buffer);
    reseal(&mut buffer);
    open_one(&buffer);
}

fn open_one(bytes: &AlignedBytes) {
    let _ = format::verify(bytes);
    let mut swapped = bytes.clone();
    match format::swap_byte_order(&mut swapped) {
        Ok(()) => {
            format::swap_byte_order(&mut swapped).expect("what was swapped can be swapped back");
            assert_eq!(&swapped, bytes, "swapping twice is nothing");
        }
        Err(_) => assert_eq!(&swapped, bytes, "a failed swap changes nothing"),
    }
    if let Ok(container) = Container::from_bytes(bytes) {
        assert!(container.sections().count() <= container.header().sections as usize);
    }
    if let Ok(any) = AnyComplex::from_bytes(bytes) {
        // Vertices alone take no bytes: of them there may be any number.
        if with_complex!(any, complex => complex.num_simplices()) > 1 << 20 {
            return;
        }
        with_complex!(any, complex => { ask_everything(&complex, ASKED); });
    }
}

/// Reads the bytes as a list of simplices, encodes their complex and compares all relations with the oracle.
///
/// # Panics
/// Where they differ.
pub fn roundtrip(bytes: &[u8]) {
    let simplices = simplices(bytes).unwrap_or_default();
    let oracle = Oracle::new(&simplices);
    let options = Options { tree: bytes.len() % 2 == 0, checksums: true, ..Options::default() };
    let file = encode(&oracle, &options);
    format::verify(&file).expect("a file that was just written");
    let any = AnyComplex::from_bytes(&file).expect("a file that was just written");
    with_complex!(any, complex => {
        complex.validate().expect("a complex");
        conformance::assert_conforms(&complex, &oracle);
    });
}

/// Up to 12 simplices on up to 10 vertices, of dimension up to 4.
///
/// # Errors
/// When the bytes are spent.
pub fn simplices(bytes: &[u8]) -> arbitrary::Result<Vec<Word>> {
    let mut source = Unstructured::new(bytes);
    let mut simplices = Vec::new();
    while !source.is_empty() && simplices.len() < 12 {
        let size = source.int_in_range(1..=5)?;
        simplices.push((0..size).map(|_| source.int_in_range(0..=9)).collect::<arbitrary::Result<Word>>()?);
    }
    Ok(simplices)
}
