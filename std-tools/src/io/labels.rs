//! Vertex labels as they come: each new spelling gets the next vertex number.

use std::collections::HashMap;

use foldhash::fast::RandomState;

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
    Integers { dense: Vec<u32>, sparse: HashMap<u64, u32, RandomState>, labels: Vec<u64> },
    Tokens { numbers: HashMap<Box<str>, u32, RandomState>, labels: Vec<Box<str>> },
}

/// The value of a decimal integer without sign and leading zeros.
fn canonical(label: &str) -> Option<u64> {
    match label.as_bytes() {
        [b'0'] => Some(0),
        [b'1'..=b'9', rest @ ..] if rest.iter().all(u8::is_ascii_digit) => label.parse().ok(),
        _ => None,
    }
}

impl LabelTable {
    pub(super) fn new() -> Self {
        Self::Integers { dense: Vec::new(), sparse: HashMap::default(), labels: Vec::new() }
    }

    /// The number of a label, the next one if it is new; `None` if there is no next one.
    pub(super) fn number(&mut self, label: &str) -> Option<u32> {
        match (canonical(label), &self) {
            (Some(integer), Self::Integers { .. }) => self.number_integer(integer),
            _ => self.number_token(label),
        }
    }

    /// The number of the label that spells this integer.
    pub(super) fn number_integer(&mut self, integer: u64) -> Option<u32> {
        let Self::Integers { dense, sparse, labels } = self else { return self.number_token(&integer.to_string()) };
        let slot = match usize::try_from(integer) {
            Ok(at) if integer < DENSE => {
                if at >= dense.len() {
                    dense.resize(at + 1, NONE);
                }
                &mut dense[at]
            }
            _ => sparse.entry(integer).or_insert(NONE),
        };
        if *slot == NONE {
            let next = u32::try_from(labels.len()).ok().filter(|&next| next < NONE)?;
            labels.push(integer);
            *slot = next;
        }
        Some(*slot)
    }

    fn number_token(&mut self, label: &str) -> Option<u32> {
        self.turn_into_tokens();
        let Self::Tokens { numbers, labels } = self else { return None };
        if let Some(&number) = numbers.get(label) {
            return Some(number);
        }
        let next = u32::try_from(labels.len()).ok().filter(|&next| next < NONE)?;
        labels.push(label.into());
        numbers.insert(label.into(), next);
        Some(next)
    }

    fn turn_into_tokens(&mut self) {
        if let Self::Integers { labels, .. } = self {
            let labels: Vec<Box<str>> = labels.iter().map(|label| label.to_string().into()).collect();
            let numbers = labels.iter().cloned().zip(0..).collect();
            *self = Self::Tokens { numbers, labels };
        }
    }

    /// The spelling of the label with a number.
    pub(super) fn label(&self, number: u32) -> String {
        match self {
            Self::Integers { labels, .. } => labels[number as usize].to_string(),
            Self::Tokens { labels, .. } => labels[number as usize].to_string(),
        }
    }

    pub(super) fn into_labels(self) -> Labels {
        match self {
            Self::Integers { labels, .. } => Labels::Integers(labels),
            Self::Tokens { labels, .. } => Labels::Tokens(labels),
        }
    }
}
