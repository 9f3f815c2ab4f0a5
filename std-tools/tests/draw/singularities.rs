//! Singular simplices, against links by the definition, and against counts that other programs established.

use std::collections::BTreeSet;

use proptest::prelude::*;
use sig_core::{SimplexId, with_complex};
use sig_tools::Loaded;
use sig_tools::names::simplex_labels;
use sig_tools::singularities::Singularities;

use crate::{file, listed};

type Word = BTreeSet<u32>;

/// All faces of some simplices.
fn closure(simplices: &[Word]) -> BTreeSet<Word> {
    let mut all = BTreeSet::new();
    for simplex in simplices {
        let vertices: Vec<u32> = simplex.iter().copied().collect();
        for subset in 1..1_u32 << vertices.len() {
            let face = (0..vertices.len()).filter(|at| subset >> at & 1 == 1).map(|at| vertices[at]);
            all.insert(face.collect());
        }
    }
    all
}

fn link(all: &BTreeSet<Word>, of: &Word) -> BTreeSet<Word> {
    all.iter()
        .filter(|face| face.is_disjoint(of) && all.contains(&face.union(of).copied().collect::<Word>()))
        .cloned()
        .collect()
}

/// Whether a complex is a sphere or a ball, of dimension 2 at most: the definitions of path, ring and surface.
fn is_sphere_or_ball(all: &BTreeSet<Word>) -> bool {
    let of_dim = |dim: usize| all.iter().filter(|word| word.len() == dim + 1).collect::<Vec<_>>();
    let [points, edges, triangles] = [0, 1, 2].map(of_dim);
    if edges.is_empty() {
        return points.len() <= 2;
    }
    // In one piece?
    let mut reached: Word = points[0].clone();
    while let Some(edge) = edges.iter().find(|edge| edge.intersection(&reached).count() == 1) {
        reached.extend(edge.iter());
    }
    if reached.len() != points.len() {
        return false;
    }
    let cofaces = |face: &Word, of: &[&Word]| of.iter().filter(|word| word.is_superset(face)).count();
    if triangles.is_empty() {
        return points.iter().all(|point| cofaces(point, &edges) <= 2);
    }
    let is_surface = edges.iter().all(|edge| (1..=2).contains(&cofaces(edge, &triangles)))
        && points.iter().all(|point| is_sphere_or_ball(&link(all, point)));
    let has_border = edges.iter().any(|edge| cofaces(edge, &triangles) == 1);
    let count = |words: &[&Word]| i64::try_from(words.len()).unwrap();
    let euler = count(&points) - count(&edges) + count(&triangles);
    is_surface && euler == if has_border { 1 } else { 2 }
}

fn found(loaded: &Loaded) -> [BTreeSet<Word>; 3] {
    with_complex!(loaded.complex().unwrap(), complex => {
        let word = |simplex: &SimplexId| -> Word {
            simplex_labels(&complex, *simplex).iter().map(|label| label.parse::<u32>().unwrap()).collect()
        };
        assert!(complex.dim().unwrap() <= 3);
        let singularities = Singularities::new(&complex).unwrap();
        singularities.by_dim.map(|simplices| simplices.iter().map(word).collect())
    })
}

fn counts(loaded: &Loaded) -> [usize; 3] {
    found(loaded).map(|found| found.len())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn by_the_definition(simplices in prop::collection::vec(prop::collection::btree_set(0..8_u32, 1..5), 1..14)) {
        let all = closure(&simplices);
        let text: String = simplices.iter().map(|word| {
            word.iter().map(|vertex| format!("{vertex} ")).collect::<String>() + "\n"
        }).collect();
        let found = found(&listed(&text));
        for (dim, found) in found.into_iter().enumerate() {
            let expected: BTreeSet<Word> = all
                .iter()
                .filter(|word| word.len() == dim + 1 && !is_sphere_or_ball(&link(&all, word)))
                .cloned()
                .collect();
            prop_assert_eq!(found, expected, "dimension {}", dim);
        }
    }
}

/// The counts of the table in `tests/data/README.md` and of the scripts behind it: vertices whose link is no path or ring.
#[test]
fn real_files() {
    for (name, expected) in [
        ("goathead.obj", [0, 0, 0]),
        ("spot_control_mesh.obj", [0, 0, 0]),
        ("torus.msh", [0, 0, 0]),
        ("P1.msh", [0, 0, 0]),
        ("poincare", [0, 0, 0]),
        ("trimesh_angle_block.STL", [33, 0, 0]),
        ("trimesh_octagonal_pocket.ply", [3, 0, 0]),
    ] {
        assert_eq!(counts(&file(name)), expected, "{name}");
    }
}

/// The dunce hat has one triangle that is identified with itself along its three sides: an edge in three triangles.
#[test]
fn known_singularities() {
    let [vertices, edges, _] = counts(&file("dunce_hat"));
    // The ring of the three identified sides.
    assert_eq!((vertices, edges), (3, 3));
    // The cone over the torus on seven vertices, and over the projective plane on six: at the apex alone.
    let cone = |facets: Vec<String>| facets.into_iter().map(|facet| format!("{facet} 9\n")).collect::<String>();
    let torus = (0..7)
        .flat_map(|i| [[0, 1, 3], [0, 2, 3]].map(|steps| steps.map(|step| ((i + step) % 7).to_string()).join(" ")));
    assert_eq!(counts(&listed(&cone(torus.collect()))), [1, 0, 0]);
    let plane = "012 023 034 045 015 124 235 134 245 135"
        .split(' ')
        .map(|facet| facet.chars().map(String::from).collect::<Vec<_>>().join(" "));
    assert_eq!(counts(&listed(&cone(plane.collect()))), [1, 0, 0]);
}

#[test]
fn nothing_is_told_of_higher_dimensions() {
    with_complex!(file("K3_16").complex().unwrap(), complex => assert_eq!(Singularities::new(&complex), None));
}
