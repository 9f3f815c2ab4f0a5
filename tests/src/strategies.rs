//! Random complexes of mixed dimension for property tests.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index as Pick, subsequence};

use crate::oracle::Word;

/// Vertices of a random complex: few, so that its simplices often meet.
pub const VERTICES: usize = 9;

/// The most vertices of a simplex: dimension 6.
const MAX_WORD: usize = 7;

/// Lists of simplices on at most [`VERTICES`] vertices, of dimension up to 6, faces of one another and repetitions among
/// them. They make wire edges, dangling triangles, isolated and pinched vertices, and simplices glued along any face.
///
/// Each simplex takes some vertices of one before it, and some of all. Shrinks to fewer and smaller simplices.
pub fn simplices() -> impl Strategy<Value = Vec<Word>> {
    let all: Vec<usize> = (0..VERTICES).collect();
    let own = prop_oneof![
        2 => subsequence(all.clone(), 1..=1),
        3 => subsequence(all.clone(), 2..=2),
        4 => subsequence(all.clone(), 3..=3),
        3 => subsequence(all.clone(), 4..=5),
        1 => subsequence(all, 6..=MAX_WORD),
    ];
    let glued = (any::<Pick>(), 0..=MAX_WORD, any::<bool>());
    vec((own, glued), 0..10).prop_map(|steps| {
        let mut words: Vec<Word> = Vec::new();
        for (mut word, (earlier, keep, from_end)) in steps {
            if let Some(earlier) = (!words.is_empty()).then(|| earlier.get(&words)) {
                let kept: Vec<usize> = if from_end {
                    earlier.iter().rev().take(keep).copied().collect()
                } else {
                    earlier.iter().take(keep).copied().collect()
                };
                word.extend(kept);
                word.sort_unstable();
                word.dedup();
                word.truncate(MAX_WORD);
            }
            words.push(word);
        }
        words
    })
}
