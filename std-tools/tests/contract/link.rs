//! The link condition by its definition, and what it promises.

use proptest::prelude::*;
use sig_core::{Complex, VertexId};
use sig_tools::OwnedScratch;
use sig_tools::build::{Arrays, Built};
use sig_tools::contract::{contract, link_condition};
use sig_tools::store::{EncodeOptions, Encoding, Loaded};

use crate::model::{Model, edge};
use crate::samples::{cone, simplices, torus, words};

/// Whether Lk(a) ∩ Lk(b) = Lk(ab), over all simplices of the model.
fn by_definition(model: &Model, a: u32, b: u32) -> bool {
    let in_link = |word: &[u32], of: &[u32]| {
        let union: Vec<u32> = [word, of].concat();
        !of.iter().any(|vertex| word.contains(vertex)) && model.values.contains_key(&crate::model::sorted(&union))
    };
    in_link(&[a], &[b])
        && model.values.keys().all(|word| (in_link(word, &[a]) && in_link(word, &[b])) == in_link(word, &[a, b]))
}

fn with_complex<T>(built: &Built, answer: impl FnOnce(&Complex<'_, u16>) -> T) -> T {
    let bytes = Encoding::new(built, &EncodeOptions::default()).expect("fits").to_bytes().expect("fits");
    let loaded = Loaded::from_file_bytes(bytes).expect("a good file");
    answer(&Complex::from_bytes(loaded.bytes()).expect("a good file"))
}

fn conditions(model: &Model) -> Vec<((u32, u32), bool)> {
    with_complex(&model.built(), |complex| {
        let mut memory = OwnedScratch::new(complex);
        let mut scratch = memory.scratch();
        let vertex = |vertex: u32| VertexId::new(vertex as usize);
        let mut answer = |a, b| link_condition(complex, vertex(a), vertex(b), &mut scratch).expect("enough memory");
        let count = model.labels.len() as u32 + 1;
        let pairs = (0..count).flat_map(|a| (0..count).map(move |b| (a, b)));
        pairs.map(|(a, b)| ((a, b), answer(a, b))).collect()
    })
}

fn euler_characteristic(built: &Built) -> i64 {
    let Arrays::Narrow(arrays) = &built.arrays else { panic!("a small complex") };
    let count = |dim| arrays.ids(dim).len() as i64;
    (0..arrays.first.len()).map(|dim| if dim % 2 == 0 { count(dim) } else { -count(dim) }).sum()
}

proptest! {
    #[test]
    fn the_condition_is_the_definition(simplices in simplices()) {
        let model = Model::new(14, &simplices, 0);
        let before = model.built();
        for ((a, b), holds) in conditions(&model) {
            prop_assert_eq!(holds, by_definition(&model, a, b), "{} {}", a, b);
            if holds {
                let mut built = before.clone();
                contract(&mut built, &[edge(a, b)]).expect("an edge");
                prop_assert_eq!(euler_characteristic(&built), euler_characteristic(&before));
            }
        }
    }
}

/// Every two vertices of the torus of Möbius and Császár are joined, and none can be contracted: it is least.
#[test]
fn the_least_torus_has_no_edge_to_contract() {
    let model = Model::new(7, &torus(), 0);
    assert!(conditions(&model).into_iter().all(|(_, holds)| !holds));
    // The cone over it is contracted to a point, edge by edge.
    let mut model = Model::new(8, &cone(&torus()), 0);
    let mut steps = 0;
    while let Some(((a, b), _)) = conditions(&model).into_iter().find(|&(_, holds)| holds) {
        model = model.contracted(a, b).cleaned();
        steps += 1;
    }
    assert_eq!((steps, model.tops), (7, vec![vec![0]]));
}

#[test]
fn a_hollow_triangle_may_not_be_closed() {
    let hollow = Model::new(3, &words(&["01", "02", "12"]), 0);
    assert!(conditions(&hollow).into_iter().all(|(_, holds)| !holds));
    let full = Model::new(3, &words(&["012"]), 0);
    assert!(conditions(&full).into_iter().all(|((a, b), holds)| holds == (a != b && a < 3 && b < 3)));
}
