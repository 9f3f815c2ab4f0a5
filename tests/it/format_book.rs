//! The worked example of `core/FORMAT.md` is the file that its complex has.

use std::fs;
use std::path::Path;

use sig_core::{Complex, IndexWidth};
use sig_tests::conformance::assert_conforms;
use sig_tests::encode::{Options, encode};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tools::store::AlignedBytes;

/// The bytes of the block marked `hex`: an offset, 16 bytes and a remark a row; rows of zeros are left out.
fn example(book: &str, len: usize) -> AlignedBytes {
    let block = book.split("```hex\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a block of hex");
    let mut bytes = AlignedBytes::zeroed(len);
    for row in block.lines() {
        let (offset, rest) = row.split_once("  ").expect("an offset and bytes");
        let offset = usize::from_str_radix(offset, 16).expect("an offset in hex");
        let row = rest.split("  ").next().expect("bytes").split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap());
        let row: Vec<u8> = row.collect();
        bytes[offset..offset + 16].copy_from_slice(&row);
    }
    bytes
}

#[test]
fn the_worked_example_is_a_file() {
    let book = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/FORMAT.md")).unwrap();
    let oracle = Oracle::new(&known::words("012 23"));
    let parity = Some(vec![false; oracle.tops().len()]);
    let expected = encode(&oracle, &Options { parity, ..Options::bare(IndexWidth::Bits16) });
    let bytes = example(&book, expected.len());
    assert!(bytes == expected, "the example differs from the definition");
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    assert_eq!(complex.validate(), Ok(()));
    assert_conforms(&complex, &oracle);
}
