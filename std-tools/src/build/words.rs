//! Listed simplices as sorted words of vertex ids, with the parity that sorting takes away.

use sig_core::{Dim, MAX_DIM};

use crate::build::local::{EVEN, ODD, UNUSED};
use crate::build::order::Order;
use crate::build::{BuildError, Meter, Phase};

/// Rows that are sorted at a time.
const ROWS: usize = 1 << 10;

/// Ends a word that sorts the listed vertices by an even permutation. No vertex id is as large, see [`check`].
const EVEN_END: u32 = u32::MAX - 1;
/// Ends a word that sorts the listed vertices by an odd permutation.
const ODD_END: u32 = u32::MAX;

/// The listed simplices as words: increasing vertex ids, then [`EVEN_END`] or [`ODD_END`].
pub(super) struct Words {
    flat: Vec<u32>,
}

impl Words {
    /// The words.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.flat.split(|&letter| letter >= EVEN_END).filter(|word| !word.is_empty())
    }

    /// Every vertex with its place in the words, save those that stand last.
    pub(super) fn for_each_tail(&self, mut visit: impl FnMut(u32, usize)) {
        for (place, pair) in self.flat.windows(2).enumerate() {
            if pair[0].max(pair[1]) < EVEN_END {
                visit(pair[0], place);
            }
        }
    }

    /// What follows the vertex at `place` in its word; and how the word is listed if the vertex is its first, else 0.
    pub(super) fn tail(&self, place: usize) -> (&[u32], u8) {
        let rest = &self.flat[place + 1..];
        let len = rest.iter().position(|&letter| letter >= EVEN_END).unwrap_or(rest.len());
        let is_first = place.checked_sub(1).is_none_or(|before| self.flat[before] >= EVEN_END);
        let mark = match rest.get(len) {
            Some(&EVEN_END) if is_first => EVEN,
            Some(_) if is_first => ODD,
            _ => 0,
        };
        (&rest[..len], mark)
    }
}

/// Checks the shape of the soup and the range of its vertex numbers; tells which of `count` vertices are used.
pub(super) fn check(simplices: &[Vec<u32>], count: usize) -> Result<Vec<bool>, BuildError> {
    if u32::try_from(count).map_or(true, |count| count > EVEN_END) {
        return Err(BuildError::TooManyVertices(count));
    }
    let mut used = vec![false; count];
    for (dim, flat) in simplices.iter().enumerate() {
        if !flat.is_empty() && (dim > MAX_DIM || !flat.len().is_multiple_of(dim + 1)) {
            return Err(BuildError::MalformedSoup { dim, len: flat.len() });
        }
        for (position, &vertex) in flat.iter().enumerate() {
            match used.get_mut(vertex as usize) {
                Some(used) => *used = true,
                None => {
                    return Err(BuildError::VertexOutOfRange { dim, index: position / (dim + 1), vertex, count });
                }
            }
        }
    }
    Ok(used)
}

/// Rewrites every listed simplex as its word; words stand by first vertex, so that the simplices around a vertex are near
/// each other however the input orders them.
pub(super) fn sort(simplices: Vec<Vec<u32>>, order: &Order, meter: &Meter<'_>) -> Result<Words, BuildError> {
    let num_listed = simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1)).sum();
    let stage = meter.stage(Phase::Words, num_listed);
    // Where the words of each first vertex start. Shifted by one, so that filling in moves each start to where it belongs.
    let mut starts = vec![0_usize; order.num_vertices() + 2];
    for (dim, flat) in simplices.iter().enumerate() {
        for row in flat.chunks_exact(dim + 1) {
            let first = row.iter().map(|&vertex| order.id(vertex)).min().unwrap_or(0);
            starts[first as usize + 2] += dim + 2;
        }
    }
    for vertex in 2..starts.len() {
        starts[vertex] += starts[vertex - 1];
    }
    let mut flat = vec![0; starts[order.num_vertices() + 1]];
    let mut words = vec![0; (MAX_DIM + 2) * ROWS];
    for (dim, simplices) in simplices.into_iter().enumerate() {
        for (task, rows) in simplices.chunks((dim + 1) * ROWS).enumerate() {
            if let Some((row, id)) = sort_rows(&mut words, rows, dim, order) {
                let index = task * ROWS + row;
                return Err(BuildError::RepeatedVertex { dim, index, vertex: order.input(id) });
            }
            let count = rows.len() / (dim + 1);
            for word in words.chunks_exact(dim + 2).take(count) {
                let next = &mut starts[word[0] as usize + 1];
                flat[*next..*next + dim + 2].copy_from_slice(word);
                *next += dim + 2;
            }
            stage.add(count);
        }
    }
    Ok(Words { flat })
}

/// Sorts rows of vertex numbers of the input into words; the first row that repeats a vertex, and the vertex.
fn sort_rows(words: &mut [u32], rows: &[u32], dim: Dim, order: &Order) -> Option<(usize, u32)> {
    let mut repeated = None;
    for (number, (word, row)) in words.chunks_exact_mut(dim + 2).zip(rows.chunks_exact(dim + 1)).enumerate() {
        let mut swaps = 0;
        for (end, &vertex) in row.iter().enumerate() {
            let id = order.id(vertex);
            let mut place = end;
            while place > 0 && word[place - 1] > id {
                word[place] = word[place - 1];
                place -= 1;
            }
            word[place] = id;
            swaps += end - place;
            if place > 0 && word[place - 1] == id && repeated.is_none() {
                repeated = Some((number, id));
            }
        }
        word[dim + 1] = if swaps % 2 == 0 { EVEN_END } else { ODD_END };
    }
    repeated
}

/// How each vertex is listed; empty if none is, and none is kept though it is not `used`.
pub(super) fn listed_vertices(words: &Words, used: &[bool], order: &Order) -> Vec<u8> {
    let mut marks = vec![0; order.num_vertices()];
    for (mark, id) in marks.iter_mut().zip(0..) {
        if !used[order.input(id) as usize] {
            *mark = UNUSED;
        }
    }
    for word in words.iter() {
        if let [vertex] = word {
            marks[*vertex as usize] = EVEN;
        }
    }
    if marks.iter().all(|&mark| mark == 0) { Vec::new() } else { marks }
}
