//! The relations over the darts against their definitions.

use std::collections::BTreeSet;

use proptest::prelude::*;
use sig_core::{Complex, SimplexId};
use sig_tools::combinatorial_map::{CombinatorialMap, Walk};

use crate::model::{Word, built, closed, faces, file, is_face};

/// The ids of some simplices; an answer that repeats one has another length.
fn ids(answer: &[SimplexId]) -> Vec<usize> {
    let mut ids: Vec<usize> = answer.iter().map(|cell| cell.index()).collect();
    ids.sort_unstable();
    ids
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn relations_of_simplices(words in closed(2..=4)) {
        let file = file(&built(&words));
        let complex = Complex::<u16>::from_bytes(&file).unwrap();
        let map = CombinatorialMap::new(&complex).unwrap();
        let faces = faces(&words);
        let mut walk = Walk::new();
        let those = |is_one: &dyn Fn(&Word) -> bool| -> Vec<usize> {
            (0..faces.len()).filter(|&id| is_one(&faces[id])).collect()
        };
        for (id, word) in faces.iter().enumerate() {
            let (cell, p) = (SimplexId::new(id), word.len() - 1);
            for q in 0..=map.dim() + 1 {
                let below = those(&|face| q < p && face.len() == q + 1 && is_face(face, word));
                prop_assert_eq!(ids(map.boundary(cell, q, &mut walk)), below, "{}-faces of {:?}", q, word);
                let above = those(&|face| q > p && face.len() == q + 1 && is_face(word, face));
                prop_assert_eq!(ids(map.coboundary(cell, q, &mut walk)), above, "{}-cofaces of {:?}", q, word);
            }
            let beside = those(&|other| {
                let shared: Word = other.iter().copied().filter(|vertex| word.contains(vertex)).collect();
                let union: BTreeSet<u32> = other.iter().chain(word).copied().collect();
                other != word
                    && other.len() == word.len()
                    && if p == 0 { faces.iter().any(|face| union.iter().eq(face)) } else { shared.len() == p }
            });
            prop_assert_eq!(ids(map.adjacency(cell, &mut walk)), beside, "beside {:?}", word);
        }
        for id in [faces.len(), usize::MAX] {
            let cell = SimplexId::new(id);
            prop_assert!(map.boundary(cell, 0, &mut walk).is_empty() && map.coboundary(cell, 1, &mut walk).is_empty());
            prop_assert!(map.adjacency(cell, &mut walk).is_empty() && map.dart_of(cell).is_none());
            prop_assert_eq!(map.darts_of(cell, &mut walk).len(), 0);
        }
    }
}
