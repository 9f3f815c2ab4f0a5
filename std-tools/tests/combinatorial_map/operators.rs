//! Removal and contraction of edges of 2-maps.

use proptest::prelude::*;
use proptest::sample::Index as Pick;
use sig_core::{CellId, SimplexId};
use sig_tools::cells::{CellComplex, Infeasible};
use sig_tools::combinatorial_map::{CombinatorialMap, OperatorError, Walk};

use crate::model::{assert_is_map, closed, map_of, sphere, with_complex};

/// Checks that the cells of a map and their arcs are those of an incidence graph.
fn assert_same(map: &CombinatorialMap, graph: &CellComplex) {
    let id = |cell: CellId| SimplexId::new(cell.index());
    let mut arcs: Vec<(SimplexId, SimplexId, usize)> = Vec::new();
    for cell in graph.cells() {
        let above = graph.coboundary(cell);
        arcs.extend(above.map(|arc| (id(cell), id(arc.cell), arc.incidence.multiplicity as usize)));
    }
    assert_eq!(map.arcs().unwrap(), arcs);
    for dim in 0..=2 {
        assert!(map.cells(dim).eq(graph.cells().filter(|&cell| graph.dim_of(cell) == Some(dim)).map(id)));
    }
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever the order: removal is K1C2C and contraction is K0C1C on the incidence graph of the cells, with the same cells,
    /// arcs and multiplicities after, and the one is feasible where the other is. The one difference is the last edge of a
    /// component.
    #[test]
    fn operators_are_those_on_the_incidence_graph(words in closed(2..=2), steps in steps()) {
        let mut map = map_of(&words).unwrap();
        let mut graph = with_complex(&words, |complex| CellComplex::from_complex(complex)).unwrap();
        assert_same(&map, &graph);
        let mut walk = Walk::new();
        for Step { edge, at, is_removal } in steps {
            let edges: Vec<SimplexId> = map.cells(1).collect();
            let edge = edges[edge.index(edges.len())];
            let dart = map.dart_of(edge).unwrap();
            let dart = if at { dart } else { map.beta(2, dart).unwrap() };
            let cell = map.cell(dart, if is_removal { 2 } else { 0 }).unwrap();
            let unchanged = map.clone();
            let done =
                if is_removal { map.remove(edge, cell, &mut walk) } else { map.contract(edge, cell, &mut walk) };
            let [low, high] = if is_removal { [edge, cell] } else { [cell, edge] };
            let [low, high] = [low, high].map(|cell| CellId::new(cell.index() as u32));
            if done == Err(OperatorError::LastEdge(edge)) {
                // The component is a sphere of one edge, and on the graph one without.
                let ends = map.boundary(edge, 0, &mut walk).len();
                prop_assert_eq!(ends + map.coboundary(edge, 2, &mut walk).len(), 3);
                let (mut less, vacated) = (graph.clone(), edge.index());
                less.kill(low, high).unwrap();
                prop_assert!(!less.contains(CellId::new(vacated as u32)));
                prop_assert_eq!(&map, &unchanged);
                continue;
            }
            let killed = graph.kill(low, high);
            prop_assert_eq!(done.is_ok(), killed.is_ok(), "{:?} {:?}", done, killed);
            match done {
                Ok(()) => assert_is_map(&map),
                Err(error) => {
                    prop_assert_eq!(error, OperatorError::Twice { edge, cell });
                    let twice = Infeasible::Multiplicity { low, high, multiplicity: 2 };
                    prop_assert_eq!(killed.unwrap_err(), twice);
                    prop_assert_eq!(&map, &unchanged);
                }
            }
            assert_same(&map, &graph);
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
