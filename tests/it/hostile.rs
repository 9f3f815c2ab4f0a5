//! Damaged files that get past the header: each is refused, or answers every query on every simplex, within bounds and
//! without a panic.
//!
//! The bounds are two. An answer has no more items than there are simplices, however the arrays are damaged; that is counted.
//! And what goes on between two items ends: relations mark what they visit, so their work is bounded by what the arrays hold,
//! here some kilobytes. A loop without an end is told by a watch: a mutant that is at work for a thousand times as long as
//! the slowest needs ends the tests, with its number.
//!
//! The damage is drawn from SplitMix64 with the seeds below, so that a failure can be had again from its number.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use sig_core::IndexWidth;
use sig_core::format::{Container, SectionKind};
use sig_tests::mutants::{Damage, Fate, Random, fate, medium_files, mutant, small_files};
use sig_tests::queries::reseal;
use sig_tools::View;
use sig_tools::store::AlignedBytes;

/// The seed of the first mutant; mutant k has this plus k.
const SEED: u64 = 2004;

/// Simplices of a mutant that are asked everything.
const ASKED: usize = 24;

/// The longest that a mutant may take: a thousand times what the slowest does, and little beside an endless loop.
const PATIENCE: Duration = Duration::from_secs(20);

/// Runs `work`, which tells the number of each mutant before it turns to it, and ends the process if there is none for too
/// long: a thread in an endless loop can be ended in no other way.
fn watched<T>(work: impl FnOnce(&dyn Fn(u64)) -> T) -> T {
    let (started, starts) = channel();
    thread::scope(|scope| {
        scope.spawn(move || {
            let mut at_work = None;
            loop {
                match starts.recv_timeout(PATIENCE) {
                    Ok(number) => at_work = Some(number),
                    Err(RecvTimeoutError::Disconnected) => return,
                    Err(RecvTimeoutError::Timeout) => {
                        eprintln!("mutant {at_work:?} is still at work after {PATIENCE:?}");
                        std::process::exit(101);
                    }
                }
            }
        });
        // Moved, so that its end ends the watch, whether in a panic or not.
        let started = started;
        work(&|number| started.send(number).expect("the watch runs as long as this"))
    })
}

/// Each of so many mutants is refused, or answers every query within bounds. Returns how many of each kind of damage
/// were refused and how many answered.
fn try_mutants(mutants: u64) -> [(Damage, usize, usize); 6] {
    watched(|started| try_each(mutants, started))
}

fn try_each(mutants: u64, started: &dyn Fn(u64)) -> [(Damage, usize, usize); 6] {
    let files = [small_files(), medium_files()].concat();
    let mut fates = Damage::ALL.map(|damage| (damage, 0, 0));
    let mut slowest = (Duration::ZERO, 0);
    for number in SEED..SEED + mutants {
        started(number);
        let (damage, bytes) = mutant(&files, number);
        let start = Instant::now();
        let (_, refused, answered) = &mut fates[damage as usize];
        match fate(&bytes, ASKED) {
            Fate::Refused => *refused += 1,
            Fate::Answered(_) => *answered += 1,
        }
        slowest = slowest.max((start.elapsed(), number));
    }
    println!("{mutants} mutants of {} files; the slowest, {}, took {:?}", files.len(), slowest.1, slowest.0);
    for (damage, refused, answered) in fates {
        println!("{damage:?}: {refused} refused, {answered} answered everything");
    }
    fates
}

fn assert_all_were_tried(fates: [(Damage, usize, usize); 6]) {
    for (damage, refused, answered) in fates {
        let tried = match damage {
            Damage::Element | Damage::StopCode | Damage::Section => answered > refused,
            Damage::Shape | Damage::Field => refused > 0 && answered > 0,
            // No file is whole at another length.
            Damage::Length => refused > 0 && answered == 0,
        };
        assert!(tried, "{damage:?}: {refused} refused, {answered} answered");
    }
}

#[test]
fn mutants() {
    assert_all_were_tried(try_mutants(3_000));
}

/// `.ci/run --mutants`; with `-- --ignored --nocapture` it tells the figures.
#[test]
#[ignore = "a minute"]
fn a_hundred_thousand_mutants() {
    assert_all_were_tried(try_mutants(120_000));
}

#[test]
fn damaged_arrays() {
    let originals = small_files();
    let (mut opened, mut mutants) = (0, 0);
    for seed in SEED..SEED + 4000 {
        let mut random = Random::new(seed);
        let mut bytes = originals[random.below(originals.len())].clone();
        for _ in 0..=random.below(4) {
            bytes = Damage::Element.applied(&bytes, &mut random);
        }
        opened += usize::from(fate(&bytes, usize::MAX) != Fate::Refused);
        mutants += 1;
    }
    assert!(opened > mutants / 2, "only {opened} of {mutants} got past the opening");
}

/// All elements of one section the same: the lists without an end, all pointers to one place, all facets one.
#[test]
fn arrays_of_one_value() {
    for original in small_files() {
        let container = Container::from_bytes(&original).unwrap();
        let total = container.header().num_simplices;
        let sections: Vec<_> = container
            .sections()
            .zip(container.spans())
            .map(|(section, (.., range))| (range.len() / section.column.len().max(1), range))
            .collect();
        for (size, range) in sections {
            for value in [0, 1, total / 2, total.saturating_sub(1), total, u64::MAX - 1, u64::MAX] {
                let mut bytes = original.clone();
                for element in bytes[range.clone()].chunks_exact_mut(size.max(1)) {
                    element.copy_from_slice(&value.to_le_bytes()[..size.max(1)]);
                }
                let _ = fate(&bytes, usize::MAX);
            }
        }
    }
}

/// Fields of header and table, the checksum of both made to fit.
#[test]
fn damaged_headers_and_tables() {
    let originals = small_files();
    let mut opened = 0;
    for seed in SEED..SEED + 6000 {
        let mut random = Random::new(seed);
        let mut bytes = originals[random.below(originals.len())].clone();
        for _ in 0..=random.below(2) {
            bytes = Damage::Field.applied(&bytes, &mut random);
        }
        reseal(&mut bytes);
        sig_tests::fuzz::open(&bytes);
        opened += usize::from(View::from_bytes(&bytes).is_ok());
    }
    assert!(opened > 20, "only {opened} got past the opening");
}

/// A handful of bytes that promise one simplex of dimension 31, and so 2^32 faces, are not opened.
#[test]
fn few_bytes_cannot_promise_many_faces() {
    use sig_core::format::{Column, Encoder, FormatError, Kind, Rule, Section};
    let lookup: Vec<u16> = (0..32).collect();
    let boundary: Vec<u16> = vec![0; (2..=32).sum()];
    let zeros = [0; 31];
    let sections = [
        Section::new(SectionKind::Lookup, Column::U16(&lookup)),
        Section::new(SectionKind::Boundary, Column::U16(&boundary)),
        Section::new(SectionKind::Pointers, Column::U16(&zeros)),
        Section::new(SectionKind::Lists, Column::U16(&[31])),
        Section::new(SectionKind::Flags, Column::Bits { bytes: &[0; 4], len: 31 }),
    ];
    let encoder = Encoder::new(Kind::Sig, IndexWidth::Bits16, 32, 32, &sections).unwrap();
    let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
    encoder.encode(&mut bytes).unwrap();
    let expected = FormatError::Invalid { section: SectionKind::Lookup, element: 0, rule: Rule::FirstIds };
    assert_eq!(sig_core::Complex::<u16>::from_bytes(&bytes).err(), Some(expected));
}
