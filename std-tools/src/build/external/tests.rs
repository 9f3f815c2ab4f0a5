//! The bytes are those of the builder in memory, however the complex is cut.

mod kept;

use std::fs;
use std::io::{Read, Seek};

use proptest::prelude::*;
use proptest::sample::Index;

use super::*;
use crate::build::build;
use crate::generate::Triangulation;
use crate::soup::Scalars;
use crate::store::Encoding;

/// The file and what is said about it, built in memory.
fn in_memory(soup: &Soup, options: &BuildOptions<'_>, encode: &EncodeOptions<'_>) -> (Vec<u8>, BuildReport) {
    let built = build(soup.clone(), options).expect("a good soup");
    let bytes = Encoding::new(&built, encode).and_then(|encoding| encoding.to_bytes()).expect("it fits the width");
    (bytes.to_vec(), built.report)
}

/// The same, built in pieces.
fn in_pieces(
    soup: &Soup,
    options: &BuildOptions<'_>,
    encode: &EncodeOptions<'_>,
    cut: &Cut<'_>,
) -> Result<(Vec<u8>, Outcome), Error> {
    let directory = tempfile::tempdir().unwrap();
    let resources = Resources { memory: 1 << 20, directory: directory.path(), kept: None };
    let mut file = tempfile::tempfile().unwrap();
    let spill = Spill::new_in(directory.path()).unwrap();
    let outcome = build_in_pieces(soup.clone(), spill, options, encode, resources, cut, &file)?;
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0, "temporary data have no name");
    file.rewind().unwrap();
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).unwrap();
    Ok((bytes, outcome))
}

/// Cuts the vertices of a complex before some of them.
fn starts(soup: &Soup, options: &BuildOptions<'_>, cuts: &[Index]) -> Vec<u32> {
    let count = match build(soup.clone(), options).expect("a good soup").labels {
        Labels::Numbered(count) => count,
        labels => labels.len(),
    };
    let end = u32::try_from(count).unwrap();
    let mut starts: Vec<u32> = cuts.iter().map(|cut| u32::try_from(cut.index(count.max(1))).unwrap()).collect();
    starts.extend([0, end]);
    starts.sort_unstable();
    starts.dedup();
    starts.retain(|&start| start < end || start > 0 || end == 0);
    starts
}

/// Simplices of up to seven vertices, many of them glued to a face of one before.
fn simplices() -> impl Strategy<Value = Vec<Vec<u32>>> {
    let part = (any::<Index>(), 0_u32..128, prop::collection::vec(0_u32..16, 1..=7));
    prop::collection::vec(part, 0..14).prop_map(|parts| {
        let mut simplices: Vec<Vec<u32>> = Vec::new();
        for (earlier, mask, fresh) in parts {
            let mut simplex = Vec::new();
            if let Some(earlier) = simplices.get(earlier.index(simplices.len().max(1))) {
                simplex.extend((0..).zip(earlier).filter(|(k, _)| mask >> k & 1 == 1).map(|(_, &vertex)| vertex));
            }
            for vertex in fresh {
                if simplex.len() < 7 && !simplex.contains(&vertex) {
                    simplex.push(vertex);
                }
            }
            simplices.push(simplex);
        }
        simplices
    })
}

fn soup() -> impl Strategy<Value = Soup> {
    let labels = prop_oneof![
        Just(Labels::Numbered(18)),
        Just(Labels::Integers((0..18).map(|label| label * 7 % 18 + 3).collect())),
        Just(Labels::Tokens((0..18).map(|label| format!("v{label}").into()).collect())),
    ];
    let coordinates = prop::option::of(prop::collection::vec(0_u8..10, 2 * 18));
    (simplices(), labels, any::<bool>(), coordinates).prop_map(|(simplices, labels, declared, coordinates)| {
        let mut soup = Soup::new(labels, declared);
        simplices.iter().for_each(|simplex| soup.push(simplex));
        let scalars = |values: Vec<u8>| Scalars::F32(values.into_iter().map(f32::from).collect());
        soup.coordinates = coordinates.map(|values| Coordinates { dim: 2, values: scalars(values) });
        soup
    })
}

fn encodings() -> impl Strategy<Value = EncodeOptions<'static>> {
    let width =
        prop::option::of(prop::sample::select(vec![IndexWidth::Bits16, IndexWidth::Bits32, IndexWidth::Bits64]));
    (width, any::<bool>(), prop::option::of(any::<bool>()), any::<bool>(), prop::option::of(Just("by chance")))
        .prop_map(|(width, tree, lower_neighbours, checksums, provenance)| EncodeOptions {
            width,
            tree,
            lower_neighbours,
            pairs: false,
            checksums,
            provenance,
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Mixed dimensions, not manifold, with unused and isolated vertices, at every width, with every option.
    #[test]
    fn the_bytes_do_not_depend_on_the_cuts(
        soup in soup(),
        encode in encodings(),
        order in prop::sample::select(vec![VertexOrder::Auto, VertexOrder::Input]),
        drop_unused in any::<bool>(),
        cuts in prop::collection::vec(any::<Index>(), 0..20),
    ) {
        let unused = if drop_unused { Unused::Drop } else { Unused::Keep };
        let options = BuildOptions { order, unused, ..BuildOptions::default() };
        let (expected, report) = in_memory(&soup, &options, &encode);
        let starts = starts(&soup, &options, &cuts);
        let (bytes, outcome) = in_pieces(&soup, &options, &encode, &Cut::At(&starts)).expect("it fits");
        prop_assert_eq!(outcome.report, report);
        prop_assert_eq!(outcome.file_bytes, expected.len() as u64);
        prop_assert!(bytes == expected, "cut at {:?}", starts);
    }
}

/// The soup of a triangulation, its vertices numbered by a permutation that scatters neighbours.
fn soup_of(triangulation: &Triangulation, scatter: bool) -> Soup {
    let count = triangulation.num_vertices();
    let mut soup = Soup::new(Labels::Numbered(count as usize), true);
    let step = if scatter { 7919 } else { 1 };
    let number = |vertex: u32| u32::try_from(u64::from(vertex) * step % u64::from(count)).unwrap();
    let Ok(()) = triangulation.try_for_each(|simplex| {
        soup.push(&simplex.iter().map(|&vertex| number(vertex)).collect::<Vec<_>>());
        Ok::<(), std::convert::Infallible>(())
    });
    soup
}

/// Larger ones, cut by the survey, in many pieces and in few, whose ids take 32 bits.
#[test]
fn pieces_that_fit_give_the_same_bytes() {
    let triangulations = [
        Triangulation::grid(&[12, 13, 14]).unwrap(),
        Triangulation::torus(&[60, 50]).unwrap(),
        Triangulation::grid(&[5, 4, 5, 4]).unwrap(),
        Triangulation::random(3000, 3, 2000, 5).unwrap(),
        Triangulation::random(60, 5, 300, 5).unwrap(),
    ];
    for (triangulation, scatter) in triangulations.iter().flat_map(|each| [(each, false), (each, true)]) {
        let soup = soup_of(triangulation, scatter);
        let (options, encode) = (BuildOptions::default(), EncodeOptions::default());
        let (expected, report) = in_memory(&soup, &options, &encode);
        for bytes in [2 << 20, 16 << 20] {
            let (bytes, outcome) = in_pieces(&soup, &options, &encode, &Cut::ToFit(bytes)).expect("it fits");
            assert!(bytes == expected, "{triangulation:?} in {} pieces", outcome.pieces);
            assert_eq!(outcome.report, report);
        }
    }
}

#[test]
fn bad_soups_are_refused_as_in_memory() {
    let (options, encode) = (BuildOptions::default(), EncodeOptions::default());
    let refused = |soup: &Soup, options: &BuildOptions<'_>| {
        in_pieces(soup, options, &encode, &Cut::ToFit(1 << 20)).map(drop).expect_err("a bad soup")
    };
    let mut soup = Soup::new(Labels::Numbered(4), true);
    soup.push(&[0, 1, 2]);
    soup.push(&[0, 3, 3]);
    let repeated = BuildError::RepeatedVertex { dim: 2, index: 1, vertex: 3 };
    assert!(matches!(refused(&soup, &options), Error::Build(error) if error == repeated));
    soup.simplices[2][4] = 4;
    let unknown = BuildError::VertexOutOfRange { dim: 2, index: 1, vertex: 4, count: 4 };
    assert!(matches!(refused(&soup, &options), Error::Build(error) if error == unknown));
    soup.simplices[2].truncate(3);
    let rcm = BuildOptions { order: VertexOrder::Rcm, ..options };
    assert!(matches!(refused(&soup, &rcm), Error::Rcm));
    let few = BuildOptions { max_simplices: Some(7), ..options };
    let too_large = BuildError::TooLarge { at_least: 8, limit: 7 };
    assert!(matches!(refused(&soup, &few), Error::Build(error) if error == too_large));
    let narrow = EncodeOptions { width: Some(IndexWidth::Bits16), ..encode };
    let soup = soup_of(&Triangulation::grid(&[16, 16, 16]).unwrap(), false);
    let error = in_pieces(&soup, &options, &narrow, &Cut::ToFit(4 << 20)).map(drop).expect_err("too large for 16 bits");
    assert!(matches!(error, Error::Encode(EncodeError::TooNarrow { .. })));
}

/// A cone: everything is around its apex, and so in one piece.
#[test]
fn a_star_that_does_not_fit_is_refused() {
    let mut soup = Soup::new(Labels::Numbered(101), true);
    (1..100).for_each(|vertex| soup.push(&[0, vertex, vertex + 1]));
    let error = in_pieces(&soup, &BuildOptions::default(), &EncodeOptions::default(), &Cut::ToFit(2000));
    assert!(matches!(error.map(drop).expect_err("it does not fit"), Error::Star { vertex: 0, .. }));
}

#[test]
fn memory_that_does_not_hold_the_vertices_is_too_little() {
    let directory = tempfile::tempdir().unwrap();
    let soup = Soup::new(Labels::Numbered(10_000_000), true);
    let resources = Resources { memory: 64 << 20, directory: directory.path(), kept: None };
    let (spill, file) = (Spill::new_in(directory.path()).unwrap(), tempfile::tempfile().unwrap());
    let error = build_to_file(soup, spill, &BuildOptions::default(), &EncodeOptions::default(), resources, &file);
    assert!(matches!(error.expect_err("too little"), Error::Vertices { vertices: 10_000_000, .. }));
}
