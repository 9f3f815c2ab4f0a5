//! Files: damaged ones are opened, or refused, in the memory that they take themselves.

use std::path::Path;

use sig_core::{IndexWidth, with_complex, with_tree};
use sig_tests::encode::{Options, encode};
use sig_tests::known;
use sig_tests::mutants::{medium_files, mutant, small_files};
use sig_tests::oracle::Oracle;
use sig_tests::queries::reseal;
use sig_tools::store::AlignedBytes;
use sig_tools::store::verify::checksums;
use sig_tools::{Loaded, View, with_view};

use crate::{Alone, SLACK};

/// Opened from memory and from a pipe, checked, and validated: what is allocated is the bytes of the file, and while a
/// pipe is read, whose length is not known, three times as many.
#[test]
fn mutants_take_the_memory_of_their_bytes() {
    let alone = Alone::new();
    let files = [small_files(), medium_files()].concat();
    // A pool of threads is made once.
    let _ = checksums(&files[0]);
    let (mut opened, mut most) = (0, 0);
    for number in 0..4_000 {
        let (damage, bytes) = mutant(&files, number);
        for (expected, times) in [(bytes.len(), 1), (0, 3)] {
            let (peak, loaded) = alone.peak_of(|| Loaded::read(&bytes[..], Path::new("mutant"), expected));
            assert!(peak <= times * bytes.len() + SLACK, "{number}, {damage:?}: {peak} for {} bytes", bytes.len());
            most = most.max(peak.saturating_sub(bytes.len()));
            let Ok(loaded) = loaded else { continue };
            opened += 1;
            let validate = || match loaded.view() {
                View::Complex(any) => with_complex!(any, complex => complex.validate()),
                View::Tree(any) => with_tree!(any, tree => tree.validate()),
            };
            let (peak, _) = alone.peak_of(validate);
            assert!(peak <= SLACK, "{number}, {damage:?}: validation takes {peak}");
        }
        let (peak, _) = alone.peak_of(|| checksums(&bytes));
        assert!(peak <= bytes.len() + SLACK, "{number}, {damage:?}: {peak} to check {} bytes", bytes.len());
    }
    println!("{opened} times opened; at most {most} bytes beside those of the file");
    assert!(opened > 2_000);
}

/// A file that promises so many vertices, and nothing else.
fn of_vertices(vertices: u64) -> AlignedBytes {
    let mut bytes = encode(&Oracle::new(&known::words("0 1 2 3")), &Options::bare(IndexWidth::Bits64));
    bytes[32..40].copy_from_slice(&vertices.to_le_bytes());
    reseal(&mut bytes);
    bytes
}

/// Vertices take no bytes: more of them than anything can be done with are refused by the length of the file.
#[test]
fn vertices_without_end_are_refused() {
    let alone = Alone::new();
    for (vertices, is_opened) in [(4, true), (1 << 24, true), ((1 << 24) + 1, false), (1 << 36, false)] {
        let bytes = of_vertices(vertices);
        let (peak, loaded) = alone.peak_of(|| Loaded::read(&bytes[..], Path::new("vertices"), bytes.len()));
        assert!(peak <= bytes.len() + SLACK, "{vertices}: {peak}");
        match loaded {
            Ok(loaded) => {
                assert!(is_opened, "{vertices} in {} bytes", bytes.len());
                let found = with_view!(loaded.view(), complex => complex.num_simplices());
                assert_eq!(found as u64, vertices);
            }
            Err(error) => {
                let message = format!("vertices: {vertices} vertices and nothing else: more than can be worked with");
                assert_eq!((is_opened, error.to_string()), (false, message));
            }
        }
    }
}
