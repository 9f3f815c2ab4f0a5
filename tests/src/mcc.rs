//! Multi-resolution complexes for the tests: small files, and every query on a file that may be anything.

use std::ops::ControlFlow;

use sig_core::mcc::{AxisBox, Mcc};
use sig_core::{Arc, CellId, Scratch, mark_words};
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::mcc::{Drawing, Extent, Free, Front, SimplifyOptions, Strategy, simplify, verify, write_mcc};
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};
use sig_tools::store::AlignedBytes;

use crate::known;
use crate::oracle::Word;

/// The complex of some simplices on numbered vertices, simplified as far as can be, as a file of kind multi-resolution complex
/// with coordinates.
///
/// # Panics
/// If the complex cannot be built or written.
#[must_use]
pub fn file_of(words: &[Word], strategy: Strategy) -> AlignedBytes {
    let vertices = words.iter().flatten().max().map_or(0, |&last| last + 1);
    let mut soup = Soup::new(Labels::Numbered(vertices), false);
    for word in words {
        soup.push(&word.iter().map(|&vertex| u32::try_from(vertex).expect("a small number")).collect::<Vec<_>>());
    }
    let built = build(soup, &BuildOptions::default()).expect("a small complex");
    let full = CellComplex::from_built(&built).expect("a small complex");
    let place = |at: usize| (at * 37 % 11) as f32;
    let values = Scalars::F32((0..3 * full.counts().first().copied().unwrap_or(0)).map(place).collect());
    let coordinates = Coordinates { dim: 3, values };
    let mut extent = Extent::new(&full, &coordinates);
    let (recorded, _) = simplify(full, &mut extent, &SimplifyOptions { strategy, ..Default::default() });
    bytes_of(|out| write_mcc(&recorded, Some(&coordinates), out))
}

/// Small files: balls, surfaces and manifolds from the literature, simplified in either way, one with incidences that no packed
/// arc holds, and cell complexes without refinements.
///
/// # Panics
/// If a sample cannot be read.
#[must_use]
pub fn small_files() -> Vec<AlignedBytes> {
    let complexes = [
        known::words("0123 1234 45"),
        known::words("0123 0145 0156 027 078 09"),
        known::seven_vertex_torus(),
        known::six_vertex_projective_plane(),
        known::cross_polytope(3),
    ];
    let both = |words: &Vec<Word>| [Strategy::Step, Strategy::Batch].map(|strategy| file_of(words, strategy));
    let mut files: Vec<_> = complexes.iter().flat_map(both).collect();
    let lens = "cells 1 1 1 1\n+0 -0\n3*+0\n+0 -0\n".to_owned();
    let chain = "cells 1 5 5\n".to_owned()
        + &"+0 -0\n".repeat(5)
        + &(0..4).map(|k| format!("+{k} 2*-{}\n", k + 1)).collect::<String>()
        + "+0 2*+4\n";
    for text in [lens, chain] {
        let complex = read_cells(text.as_bytes(), "sample").expect("a sample");
        let (recorded, _) = simplify(complex, &mut Free, &SimplifyOptions::default());
        files.push(bytes_of(|out| write_mcc(&recorded, None, out)));
    }
    files
}

fn bytes_of(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> AlignedBytes {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("writing to memory");
    AlignedBytes::from(&bytes[..])
}

/// Asks everything, and makes fronts if the base is valid. Returns how many items came back.
///
/// # Panics
/// If an answer is longer than it can be, a closed set is none, or a front that can be made is no complex although the whole
/// file was found to be right.
pub fn ask_mcc(mcc: &Mcc<'_>) -> usize {
    let num = mcc.num_refinements();
    assert!(mcc.num_cells() <= mcc.arrays().origins.len());
    let mut items = 0;
    for number in (0..num).chain([num, usize::MAX]) {
        let arcs = mcc.refinement(number).map_or(0, |view| {
            let packed: Vec<_> = view.lists.clone().into_iter().flat_map(|list| list.packed()).collect();
            let arcs: Vec<Arc> = view.lists.into_iter().flatten().collect();
            assert!(packed.iter().map(|packed| packed.cell()).eq(arcs.iter().map(|arc| arc.cell)));
            arcs.len()
        });
        items += arcs + mcc.dependencies(number).inspect(|&before| assert!(before < number)).count();
        let _ = (mcc.error(number), mcc.site(number), mcc.is_in_box(number, &AxisBox::SPACE));
    }
    for cell in (0..u32::try_from(mcc.num_cells()).unwrap_or(0) + 2).map(CellId::new) {
        let _ = (mcc.dim_of(cell), mcc.creator(cell), mcc.origin(cell));
        items += mcc.base_boundary(cell).count();
    }
    items += ask_sets(mcc);
    let is_valid = mcc.validate().is_ok();
    if mcc.validate_base().is_ok() {
        let is_right = is_valid && verify(*mcc).is_ok();
        let mut front = Front::new(*mcc);
        for step in 1..4 {
            let moved = front.select(|number| (number * 7 + step) % 3 == 0);
            if is_right {
                moved.as_ref().expect("a refinement of a file that was verified");
                front.complex().check().expect("a front of a file that was verified");
            }
            items += front.survivors().len() + front.to_complex().view().num_cells();
        }
        let all = front.select(|_| true);
        items += all.map_or(0, |moved| moved.refined);
        let _ = (Drawing::new(&front).is_ok(), front.select(|_| false));
    }
    items
}

/// Closed sets by both ways, and boxes.
fn ask_sets(mcc: &Mcc<'_>) -> usize {
    let num = mcc.num_refinements();
    let (mut marks, mut queue, mut masks, mut found) =
        (vec![0; mark_words(num)], vec![0; num], vec![0; num], vec![0; num]);
    let unit = AxisBox { low: [0.0; 3], high: [5.0; 3] };
    let boxes = [(AxisBox::SPACE, AxisBox::EMPTY), (unit, AxisBox::EMPTY), (AxisBox::SPACE, unit)];
    let in_boxes: Vec<Vec<usize>> = boxes
        .iter()
        .filter_map(|&(inside, but_not)| Some(mcc.in_box(inside, but_not)?.take(num + 1).collect()))
        .collect();
    let mut items = 0;
    for wanted in in_boxes.into_iter().chain([vec![num / 2, num.saturating_sub(1), num, usize::MAX]]) {
        assert!(wanted.len() <= num.max(4), "more refinements in a box than there are");
        let listed: Vec<usize> = {
            let mut scratch = Scratch::new(&mut marks, &mut queue, &mut masks, &mut found);
            let set = mcc.closed_set(wanted.iter().copied(), &mut scratch).expect("there is room for all");
            set.iter().map(|&number| number as usize).collect()
        };
        assert!(marks.iter().all(|&word| word == 0), "marks are left behind");
        let is_wanted = |number: usize| wanted.contains(&number);
        mcc.select(&mut marks, is_wanted).expect("enough marks");
        assert_eq!(mcc.close(&mut marks), Some(listed.len()));
        let mut streamed = Vec::new();
        let ended = mcc.stream(&marks, |view| {
            streamed.push(view.number);
            ControlFlow::<()>::Continue(())
        });
        assert_eq!(ended, Some(ControlFlow::Continue(())));
        let mut sorted = listed.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, streamed, "the same set by both ways");
        items += listed.len();
        marks.fill(0);
    }
    items
}
