//! Vertex labels as they come: each new spelling gets the next vertex number.

use std::hash::BuildHasher;

use hashbrown::{DefaultHashBuilder, HashMap, HashTable};

use crate::soup::Labels;

/// Labels below this are looked up in a table, others by hash.
const DENSE: u64 = 1 << 20;

/// The table's mark of a label that has not come yet; vertex numbers stay below it.
const NONE: u32 = u32::MAX;

/// The vertex numbers of the labels seen so far.
///
/// As long as all labels are integers in canonical spelling they are kept as integers. The first other label turns
/// all of them into text, which loses nothing as the spelling was canonical.
pub(super) enum LabelTable {
    Integers(Integers),
    Tokens(Tokens),
}

/// Integers and their numbers.
#[derive(Default)]
pub(super) struct Integers {
    labels: Vec<u64>,
    /// The number by label, for small labels.
    dense: Vec<u32>,
    /// The numbers of the other labels.
    sparse: HashMap<u64, u32>,
}

/// Text labels and their numbers.
#[derive(Default)]
pub(super) struct Tokens {
    labels: Vec<Box<str>>,
    /// The numbers, by the hashes of their labels.
    numbers: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

/// The next vertex number after `count` others, if there is one.
fn next(count: usize) -> Option<u32> {
    u32::try_from(count).ok().filter(|&next| next < NONE)
}

/// The value of a decimal integer without sign and leading zeros.
pub(super) fn canonical(label: &[u8]) -> Option<u64> {
    let (first, rest) = label.split_first()?;
    if !matches!(first, b'1'..=b'9') {
        return (label == b"0").then_some(0);
    }
    rest.iter().try_fold(u64::from(first - b'0'), |value, byte| {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 { None } else { value.checked_mul(10)?.checked_add(digit.into()) }
    })
}

impl Integers {
    fn number(&mut self, label: u64) -> Option<u32> {
        let slot = match usize::try_from(label) {
            Ok(at) if label < DENSE => {
                if at >= self.dense.len() {
                    self.dense.resize(at + 1, NONE);
                }
                &mut self.dense[at]
            }
            _ => self.sparse.entry(label).or_insert(NONE),
        };
        if *slot == NONE {
            *slot = next(self.labels.len())?;
            self.labels.push(label);
        }
        Some(*slot)
    }
}

impl Tokens {
    fn number(&mut self, label: &str) -> Option<u32> {
        let Self { labels, numbers, hasher } = self;
        let same = |&number: &u32| &*labels[number as usize] == label;
        if let Some(&number) = numbers.find(hasher.hash_one(label), same) {
            return Some(number);
        }
        let number = next(labels.len())?;
        labels.push(label.into());
        numbers.insert_unique(hasher.hash_one(label), number, |&number| hasher.hash_one(&*labels[number as usize]));
        Some(number)
    }
}

impl LabelTable {
    pub(super) fn new() -> Self {
        Self::Integers(Integers::default())
    }

    /// The number of a label, the next one if it is new; `None` if there is no next one.
    pub(super) fn number(&mut self, label: &str) -> Option<u32> {
        match (canonical(label.as_bytes()), self) {
            (Some(integer), Self::Integers(integers)) => integers.number(integer),
            (_, table) => table.tokens()?.number(label),
        }
    }

    /// The number of the label that spells this integer.
    pub(super) fn number_integer(&mut self, integer: u64) -> Option<u32> {
        match self {
            Self::Integers(integers) => integers.number(integer),
            Self::Tokens(tokens) => tokens.number(&integer.to_string()),
        }
    }

    /// The table as one of text; `None` if there are more labels than numbers, which cannot be.
    fn tokens(&mut self) -> Option<&mut Tokens> {
        if let Self::Integers(integers) = self {
            let mut tokens = Tokens::default();
            for label in &integers.labels {
                tokens.number(&label.to_string())?;
            }
            *self = Self::Tokens(tokens);
        }
        match self {
            Self::Tokens(tokens) => Some(tokens),
            Self::Integers(_) => None,
        }
    }

    /// The spelling of the label with a number.
    pub(super) fn label(&self, number: u32) -> String {
        match self {
            Self::Integers(integers) => integers.labels[number as usize].to_string(),
            Self::Tokens(tokens) => tokens.labels[number as usize].to_string(),
        }
    }

    /// How many labels there are.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Integers(integers) => integers.labels.len(),
            Self::Tokens(tokens) => tokens.labels.len(),
        }
    }

    /// The labels that stay, by their numbers.
    pub(super) fn into_labels_that(self, stays: &[bool]) -> Labels {
        let mut each = stays.iter();
        let mut stays = || each.next() == Some(&true);
        match self {
            Self::Integers(Integers { mut labels, .. }) => {
                labels.retain(|_| stays());
                Labels::Integers(labels)
            }
            Self::Tokens(Tokens { mut labels, .. }) => {
                labels.retain(|_| stays());
                Labels::Tokens(labels)
            }
        }
    }

    /// All labels, by their numbers.
    pub(super) fn into_labels(self) -> Labels {
        match self {
            Self::Integers(integers) => Labels::Integers(integers.labels),
            Self::Tokens(tokens) => Labels::Tokens(tokens.labels),
        }
    }
}
