//! The section of entities in version 4.1: which physical groups the parts of the geometry are in.

use hashbrown::HashMap;

use super::super::error::Fault;
use super::super::source::Source;
use super::super::words::Words;
use super::{Binary, Encoding};

/// The first physical group of each entity that is in one, by dimension and tag.
#[derive(Default)]
pub(super) struct Groups {
    first: HashMap<(i32, i32), i32>,
}

impl Groups {
    /// The group of the elements of an entity; 0 for none.
    pub(super) fn of(&self, dim: i32, entity: i32) -> i64 {
        self.first.get(&(dim, entity)).copied().unwrap_or(0).into()
    }
}

/// Numbers one after the other, in text or binary.
enum Numbers<'s, 'a> {
    Text(Words<'s, 'a>),
    Binary(&'s mut Source<'a>, Binary, usize),
}

impl Numbers<'_, '_> {
    fn count(&mut self, expected: &'static str) -> Result<u64, Fault> {
        match self {
            Self::Text(words) => words.integer(expected),
            Self::Binary(source, binary, size) => binary.size(source, *size, expected),
        }
    }

    fn int(&mut self, expected: &'static str) -> Result<i32, Fault> {
        match self {
            Self::Text(words) => words.integer(expected),
            Self::Binary(source, binary, _) => binary.int(source, expected),
        }
    }

    /// Passes over a coordinate.
    fn pass_float(&mut self, expected: &'static str) -> Result<(), Fault> {
        match self {
            Self::Text(words) => words.need(expected).map(|_| ()),
            Self::Binary(source, ..) => source.skip(8, expected),
        }
    }
}

/// Reads the entities, up to the line that ends the section.
pub(super) fn read(source: &mut Source<'_>, encoding: Encoding, size: usize) -> Result<Groups, Fault> {
    const EXPECTED: &str = "as many entities as the section says";
    let mut numbers = match encoding {
        Encoding::Text => Numbers::Text(Words::new(source, None)),
        Encoding::Binary { big_endian } => Numbers::Binary(source, Binary { big_endian }, size),
    };
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = numbers.count("the numbers of points, curves, surfaces and volumes")?;
    }
    let mut groups = Groups::default();
    for (dim, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = numbers.int(EXPECTED)?;
            // A point has a place, others a box.
            for _ in 0..if dim == 0 { 3 } else { 6 } {
                numbers.pass_float(EXPECTED)?;
            }
            for place in 0..numbers.count("the number of physical groups of the entity")? {
                let group = numbers.int("as many physical groups as the entity says")?;
                if place == 0 {
                    groups.first.insert((dim, tag), group);
                }
            }
            if dim > 0 {
                for _ in 0..numbers.count("the number of entities that bound the entity")? {
                    numbers.int("as many bounding entities as the entity says")?;
                }
            }
        }
    }
    Ok(groups)
}
