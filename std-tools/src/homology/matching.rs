//! Coreductions: pairs of a cell and a coface of which it is the last face left (M. Mrozek and B. Batko, *Coreduction homology
//! algorithm*, 2009). In the order in which they are found they are an acyclic matching of discrete Morse theory.

use std::collections::VecDeque;

use super::chains::Level;
use crate::build::narrow;

/// What happens to a cell: it goes together with a coface, or, without one, stays as a critical cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) cell: u32,
    /// [`NONE`] if the cell is critical.
    pub(super) coface: u32,
}

/// No cell.
pub(super) const NONE: u32 = u32::MAX;

/// Steps for all cells of one dimension that are not gone.
pub(super) struct Matching {
    /// Every face of a coface other than its own cell comes before it, or is gone from the start.
    pub(super) steps: Vec<Step>,
    /// The critical cells, in the order of the steps.
    pub(super) critical: Vec<u32>,
}

/// Pairs the cells of a dimension that are not `gone` with those of `above` that are not; these go, too.
///
/// Where no coreduction is left, the first cell that is left becomes critical. Cost: a pass over the faces to invert them,
/// and one over the cofaces of each cell.
pub(super) fn pair(gone: &[bool], above: &Level, gone_above: &mut [bool]) -> Matching {
    let cofaces = Cofaces::new(gone, above);
    let mut left: Vec<u32> = (0..above.num_cells())
        .map(|coface| narrow(above.faces(coface).iter().filter(|&&face| !gone[face as usize]).count()))
        .collect();
    let mut queue: VecDeque<u32> = (0_u32..)
        .zip(&left)
        .filter(|&(coface, &left)| left == 1 && !gone_above[coface as usize])
        .map(|(c, _)| c)
        .collect();
    let mut is_left: Vec<bool> = gone.iter().map(|gone| !gone).collect();
    let mut matching = Matching { steps: Vec::new(), critical: Vec::new() };
    let mut first = 0;
    loop {
        let step = match queue.pop_front() {
            Some(coface) => match last_face(above, coface, &is_left) {
                Some(cell) => Step { cell, coface },
                None => continue,
            },
            None => match is_left[first..].iter().position(|&is_left| is_left) {
                Some(next) => {
                    first += next;
                    matching.critical.push(narrow(first));
                    Step { cell: narrow(first), coface: NONE }
                }
                None => break,
            },
        };
        matching.steps.push(step);
        is_left[step.cell as usize] = false;
        if let Some(gone) = gone_above.get_mut(step.coface as usize) {
            *gone = true;
        }
        for &coface in cofaces.of(step.cell) {
            let left = &mut left[coface as usize];
            *left -= 1;
            if *left == 1 && !gone_above[coface as usize] {
                queue.push_back(coface);
            }
        }
    }
    matching
}

/// The only face that is left of a cell, if its incidence number is ±1.
fn last_face(above: &Level, coface: u32, is_left: &[bool]) -> Option<u32> {
    let (face, coefficient) = above.boundary(coface as usize).find(|&(face, _)| is_left[face as usize])?;
    (coefficient.abs() == 1).then_some(face)
}

/// The cofaces of cells.
struct Cofaces {
    starts: Vec<usize>,
    cofaces: Vec<u32>,
}

impl Cofaces {
    /// Of the cells that are not gone.
    fn new(gone: &[bool], above: &Level) -> Self {
        let mut starts = vec![0; gone.len() + 1];
        for &face in above.all_faces() {
            if !gone[face as usize] {
                starts[face as usize] += 1;
            }
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut cofaces = vec![0; sum];
        for coface in (0..above.num_cells()).rev() {
            for &face in above.faces(coface) {
                if !gone[face as usize] {
                    starts[face as usize] -= 1;
                    cofaces[starts[face as usize]] = narrow(coface);
                }
            }
        }
        Self { starts, cofaces }
    }

    #[inline]
    fn of(&self, cell: u32) -> &[u32] {
        &self.cofaces[self.starts[cell as usize]..self.starts[cell as usize + 1]]
    }
}
