//! Removal and contraction of edges of 2-maps.

use std::collections::BTreeMap;

use proptest::prelude::*;
use proptest::sample::Index as Pick;
use sig_core::SimplexId;
use sig_tools::combinatorial_map::{CombinatorialMap, OperatorError, Walk};

use crate::model::{assert_is_map, closed, map_of, sphere};

/// The arcs of the incidence graph with their multiplicities.
type Arcs = BTreeMap<(SimplexId, SimplexId), usize>;

fn arcs(map: &CombinatorialMap) -> Arcs {
    map.arcs().unwrap().into_iter().map(|(p, q, count)| ((p, q), count)).collect()
}

/// The other cell that is joined with a cell by an arc, if there are two in all, `deleted` once: the condition of mcc-2012,
/// 4.2.
fn other(mut joined: Vec<(SimplexId, usize)>, deleted: SimplexId) -> Option<SimplexId> {
    joined.sort_unstable_by_key(|&(cell, _)| cell != deleted);
    match joined.as_slice() {
        &[(cell, 1), (other, _)] if cell == deleted => Some(other),
        _ => None,
    }
}

/// K0C1C(p, q), the first instance of mcc-2012, 4.2, on the labelled graph; `None` if it is not feasible.
fn contracted(arcs: &Arcs, p: SimplexId, q: SimplexId) -> Option<Arcs> {
    let below = arcs.iter().filter(|((_, upper), _)| *upper == q).map(|(&(lower, _), &count)| (lower, count)).collect();
    let kept = other(below, p)?;
    let mut result: Arcs =
        arcs.iter().filter(|((a, b), _)| ![*a, *b].iter().any(|x| [p, q].contains(x))).map(|(k, v)| (*k, *v)).collect();
    for (&(_, r), &count) in arcs.iter().filter(|((lower, upper), _)| *lower == p && *upper != q) {
        *result.entry((kept, r)).or_default() += arcs[&(kept, q)] * count;
    }
    Some(result)
}

/// K1C2C(q, p), the second instance, its dual.
fn removed(arcs: &Arcs, q: SimplexId, p: SimplexId) -> Option<Arcs> {
    let turned = |arcs: &Arcs| arcs.iter().map(|(&(a, b), &count)| ((b, a), count)).collect::<Arcs>();
    contracted(&turned(arcs), p, q).map(|arcs| turned(&arcs))
}

#[derive(Clone, Copy, Debug)]
struct Step {
    edge: Pick,
    at: bool,
    is_removal: bool,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = (any::<Pick>(), any::<bool>(), any::<bool>());
    prop::collection::vec(step.prop_map(|(edge, at, is_removal)| Step { edge, at, is_removal }), 0..40)
}

fn euler(map: &CombinatorialMap) -> usize {
    map.num_cells(0) + map.num_cells(2) - map.num_cells(1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever the order, the map stays a map, and its cells and their arcs are those of the operators on the graph. The one
    /// difference is the last edge of a component.
    #[test]
    fn operators_are_those_on_the_incidence_graph(words in closed(2..=2), steps in steps()) {
        let mut map = map_of(&words).unwrap();
        let characteristic = euler(&map);
        let mut walk = Walk::new();
        for Step { edge, at, is_removal } in steps {
            let edges: Vec<SimplexId> = map.cells(1).collect();
            let edge = edges[edge.index(edges.len())];
            let dart = map.dart_of(edge).unwrap();
            let dart = if at { dart } else { map.beta(2, dart).unwrap() };
            let cell = map.cell(dart, if is_removal { 2 } else { 0 }).unwrap();
            let before = arcs(&map);
            let expected = if is_removal { removed(&before, edge, cell) } else { contracted(&before, cell, edge) };
            let unchanged = map.clone();
            let done =
                if is_removal { map.remove(edge, cell, &mut walk) } else { map.contract(edge, cell, &mut walk) };
            match done {
                Ok(()) => {
                    prop_assert_eq!(Some(arcs(&map)), expected);
                    prop_assert_eq!(euler(&map), characteristic);
                    prop_assert!(map.dart_of(edge).is_none() && map.dart_of(cell).is_none());
                    assert_is_map(&map);
                }
                Err(error) => {
                    prop_assert_eq!(&map, &unchanged);
                    if error == OperatorError::LastEdge(edge) {
                        // The component is a sphere of one edge.
                        let (around, beside) = (map.coboundary(edge, 2, &mut walk).len(), before.len());
                        prop_assert_eq!(around + map.boundary(edge, 0, &mut walk).len(), 3);
                        prop_assert!(expected.is_some() && beside >= 3);
                    } else {
                        prop_assert_eq!(error, OperatorError::Twice { edge, cell });
                        prop_assert_eq!(expected, None);
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_refused() {
    let mut walk = Walk::new();
    let mut map = map_of(&sphere(0, 4)).unwrap();
    let ids: Vec<SimplexId> = (0..14).map(SimplexId::new).collect();
    // Vertices 0 to 3, edges 01, 02, 03, 12, 13, 23, triangles 012, 013, 023, 123.
    let (edge, far_vertex, far_face) = (ids[4], ids[2], ids[12]);
    let not_incident = |cell| Err(OperatorError::NotIncident { edge, cell });
    assert_eq!(map.contract(edge, far_vertex, &mut walk), not_incident(far_vertex));
    assert_eq!(map.remove(edge, far_face, &mut walk), not_incident(far_face));
    assert_eq!(map.remove(ids[3], far_face, &mut walk), Err(OperatorError::NotAnEdge(ids[3])));
    let past = SimplexId::new(14);
    assert_eq!(map.contract(past, ids[0], &mut walk), Err(OperatorError::NotAnEdge(past)));
    map.contract(edge, ids[0], &mut walk).unwrap();
    assert_eq!(map.contract(edge, ids[1], &mut walk), Err(OperatorError::NotAnEdge(edge)));

    let mut map = map_of(&sphere(0, 5)).unwrap();
    assert_eq!(map.contract(ids[5], ids[0], &mut walk), Err(OperatorError::Dimension(3)));
    assert_eq!(map.arcs(), Err(OperatorError::Dimension(3)));
}

/// Either last edge of a sphere: with two ends in one face, or a loop between two faces.
#[test]
fn the_last_edge_stays() {
    let mut walk = Walk::new();
    let lasts = [(2, 1), (1, 2)].map(|(vertices, faces)| {
        let mut map = map_of(&sphere(0, 4)).unwrap();
        while map.num_cells(0) > vertices {
            let (edge, vertex) = between_two(&map, 0);
            map.contract(edge, vertex, &mut walk).unwrap();
        }
        while map.num_cells(2) > faces {
            let (edge, face) = between_two(&map, 2);
            map.remove(edge, face, &mut walk).unwrap();
        }
        assert_eq!([0, 1, 2].map(|dim| map.num_cells(dim)), [vertices, 1, faces]);
        assert_is_map(&map);
        map
    });
    let [mut open, mut closed] = lasts;
    let edge = open.cells(1).next().unwrap();
    let vertex = open.cells(0).next().unwrap();
    assert_eq!(open.contract(edge, vertex, &mut walk), Err(OperatorError::LastEdge(edge)));
    let edge = closed.cells(1).next().unwrap();
    let face = closed.cells(2).next().unwrap();
    assert_eq!(closed.remove(edge, face, &mut walk), Err(OperatorError::LastEdge(edge)));
}

/// An edge that is incident with two cells of dimension 0 or 2, and one of them.
fn between_two(map: &CombinatorialMap, dim: usize) -> (SimplexId, SimplexId) {
    let sides = |edge| {
        let dart = map.dart_of(edge).unwrap();
        [dart, map.beta(2, dart).unwrap()].map(|dart| map.cell(dart, dim).unwrap())
    };
    let edge = map.cells(1).find(|&edge| sides(edge)[0] != sides(edge)[1]).unwrap();
    (edge, sides(edge)[0])
}
