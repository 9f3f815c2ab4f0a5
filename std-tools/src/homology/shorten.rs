//! Shorter cycles of dimension 1 in the same class: pieces of closed paths are replaced by the shortest ones between the same ends
//! with the same values of the cochains of the Morse complex, found by Dijkstra's algorithm in the covering that these describe.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use hashbrown::HashMap;
use num_traits::ToPrimitive;

use super::Failure;
use super::chains::Level;
use super::cochains::Cochains;
use super::generators::Morse;
use super::ring::{Overflow, Ring, Sparse, add_multiple};

/// The edges of the first pieces of a path that are made shorter.
const LEAST_PIECE: usize = 8;
/// How often pieces of one size are tried all round.
const ROUNDS: usize = 4;
/// How many pieces are tried in one round.
const MOST_STEPS: usize = 1 << 12;
/// How many vertices in their classes one search looks at before it gives up.
const MOST_STATES: usize = 1 << 13;
/// The longest cycle that is tried, in edges.
const MOST_EDGES: i64 = 1 << 20;

/// An edge, and whether it is passed against its orientation.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Pass {
    edge: u32,
    is_backward: bool,
}

/// A cycle that is not longer and has the same values; the same one if nothing shorter is found.
pub(super) fn shorten<R: Ring>(
    morse: &Morse<'_, R>,
    (cochains, graph): (&Cochains<R::Element>, &Graph),
    cycle: &Sparse<R::Element>,
    lengths: &(dyn Fn(u32) -> f64 + Sync),
) -> Result<Sparse<R::Element>, Failure> {
    let ring = morse.ring;
    let edges = &morse.levels[1];
    let numbers: Option<Vec<(u32, i64)>> =
        cycle.iter().map(|(edge, value)| Some((*edge, ring.integer(value).to_i64()?))).collect();
    let Some(paths) = numbers.and_then(|numbers| closed_paths(edges, numbers)) else { return Ok(cycle.clone()) };
    let mut cover = Cover { morse, cochains, graph, lengths, classes: Classes::new() };
    let mut sum: BTreeMap<u32, i64> = BTreeMap::new();
    for path in paths {
        for Pass { edge, is_backward } in cover.shortened(path)? {
            *sum.entry(edge).or_default() += if is_backward { -1 } else { 1 };
        }
    }
    sum.retain(|_, value| *value != 0);
    Ok(sum.into_iter().map(|(edge, value)| (edge, ring.of(value))).collect())
}

/// The two ends of an edge, from and to; `None` if it is a loop.
fn ends(edges: &Level<'_>, edge: u32) -> Option<(u32, u32)> {
    let mut boundary = edges.boundary(edge as usize);
    match (boundary.next()?, boundary.next()?) {
        ((to, 1), (from, -1)) | ((from, -1), (to, 1)) => Some((from, to)),
        _ => None,
    }
}

/// A cycle as a sum of closed paths that meet no vertex twice; `None` if it is too long or has loops.
fn closed_paths(edges: &Level<'_>, cycle: Vec<(u32, i64)>) -> Option<Vec<Vec<Pass>>> {
    let total = cycle.iter().try_fold(0_i64, |sum, (_, value)| sum.checked_add(value.checked_abs()?))?;
    if total > MOST_EDGES {
        return None;
    }
    let mut leaving: BTreeMap<u32, Vec<(Pass, u32)>> = BTreeMap::new();
    for (edge, value) in cycle {
        let (from, to) = ends(edges, edge)?;
        let is_backward = value < 0;
        let (from, to) = if is_backward { (to, from) } else { (from, to) };
        let passes = (0..value.abs()).map(|_| (Pass { edge, is_backward }, to));
        leaving.entry(from).or_default().extend(passes);
    }
    let mut paths = Vec::new();
    while let Some((&start, _)) = leaving.iter().find(|(_, passes)| !passes.is_empty()) {
        let (mut at, mut path, mut place) = (start, Vec::new(), HashMap::new());
        place.insert(start, 0);
        while let Some((pass, to)) = leaving.get_mut(&at).and_then(Vec::pop) {
            path.push((pass, at));
            at = to;
            if let Some(&first) = place.get(&to) {
                // The path closes: what came before goes on from here.
                let closed: Vec<(Pass, u32)> = path.drain(first..).collect();
                closed.iter().skip(1).for_each(|(_, vertex)| _ = place.remove(vertex));
                paths.push(closed.into_iter().map(|(pass, _)| pass).collect());
            } else {
                place.insert(to, path.len());
            }
        }
        leaving.retain(|_, passes| !passes.is_empty());
    }
    Some(paths)
}

/// The edges at each vertex.
pub(super) struct Graph {
    starts: Vec<u32>,
    passes: Vec<(Pass, u32)>,
}

impl Graph {
    pub(super) fn new(num_vertices: usize, edges: &Level<'_>) -> Self {
        let numbers = || 0..u32::try_from(edges.num_cells()).unwrap_or(u32::MAX);
        let mut starts = vec![0; num_vertices + 1];
        for (from, to) in numbers().filter_map(|edge| ends(edges, edge)) {
            starts[from as usize] += 1;
            starts[to as usize] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let nothing = (Pass { edge: 0, is_backward: false }, 0);
        let mut passes = vec![nothing; sum as usize];
        for edge in numbers().rev() {
            let Some((from, to)) = ends(edges, edge) else { continue };
            for (at, other, is_backward) in [(from, to, false), (to, from, true)] {
                starts[at as usize] -= 1;
                passes[starts[at as usize] as usize] = (Pass { edge, is_backward }, other);
            }
        }
        Self { starts, passes }
    }

    fn at(&self, vertex: u32) -> &[(Pass, u32)] {
        &self.passes[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }
}

/// Sums of values of the cochains, by number; number 0 is zero.
struct Classes<E> {
    sums: Vec<Sparse<E>>,
    number: HashMap<Sparse<E>, u32>,
    /// What one edge makes of a sum.
    after: HashMap<(u32, u32, bool), u32>,
}

impl<E: Clone + Eq + std::hash::Hash> Classes<E> {
    fn new() -> Self {
        Self { sums: vec![Vec::new()], number: HashMap::from_iter([(Vec::new(), 0)]), after: HashMap::new() }
    }

    fn after<R: Ring<Element = E>>(
        &mut self,
        ring: &R,
        cochains: &Cochains<E>,
        class: u32,
        pass: Pass,
    ) -> Result<u32, Overflow> {
        let Some((vector, values)) = cochains.at(pass.edge) else { return Ok(class) };
        let key = (class, vector, pass.is_backward);
        if let Some(&after) = self.after.get(&key) {
            return Ok(after);
        }
        let mut sum = self.sums[class as usize].clone();
        add_multiple(ring, &mut sum, &ring.of(if pass.is_backward { -1 } else { 1 }), values)?;
        let next = u32::try_from(self.sums.len()).map_err(|_| Overflow)?;
        let after = *self.number.entry(sum).or_insert_with_key(|sum| {
            self.sums.push(sum.clone());
            next
        });
        self.after.insert(key, after);
        Ok(after)
    }
}

/// A length, ordered.
#[derive(Clone, Copy, PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// A vertex and the class of a path to it.
type State = (u32, u32);

/// The covering: vertices with the classes of paths to them.
struct Cover<'m, 'r, R: Ring> {
    morse: &'m Morse<'r, R>,
    cochains: &'m Cochains<R::Element>,
    graph: &'m Graph,
    lengths: &'m (dyn Fn(u32) -> f64 + Sync),
    classes: Classes<R::Element>,
}

impl<R: Ring> Cover<'_, '_, R> {
    /// The closed path, made shorter piece by piece, the pieces growing until they are all of it.
    fn shortened(&mut self, path: Vec<Pass>) -> Result<Vec<Pass>, Failure> {
        if self.class_of(&path)? == 0 {
            // It bounds.
            return Ok(Vec::new());
        }
        let mut path = path;
        let mut piece = LEAST_PIECE;
        while piece / 2 < path.len() {
            for _ in 0..ROUNDS {
                let (shorter, is_shorter) = self.shortened_by_pieces(path, piece)?;
                path = shorter;
                if !is_shorter {
                    break;
                }
            }
            piece *= 2;
        }
        Ok(path)
    }

    /// The closed path with shorter pieces of so many edges, or with another piece that is all of it; and whether it is shorter.
    fn shortened_by_pieces(&mut self, mut path: Vec<Pass>, piece: usize) -> Result<(Vec<Pass>, bool), Failure> {
        let mut is_shorter = false;
        let mut step = 0;
        // Round it, each piece overlapping half of the one before.
        while step * (piece / 2) < path.len() && step < MOST_STEPS {
            let len = piece.min(path.len());
            if let Some(other) = self.shorter(&path[..len])? {
                path.splice(..len, other);
                is_shorter = true;
            }
            let turn = (piece / 2).min(path.len());
            path.rotate_left(turn);
            step += 1;
        }
        Ok((path, is_shorter))
    }

    /// The sum of the values along a path.
    fn class_of(&mut self, path: &[Pass]) -> Result<u32, Overflow> {
        let pass = |class, &pass| self.classes.after(self.morse.ring, self.cochains, class, pass);
        path.iter().try_fold(0, pass)
    }

    /// A shorter path of the same class with the same ends.
    fn shorter(&mut self, path: &[Pass]) -> Result<Option<Vec<Pass>>, Failure> {
        let [first, .., last] = path else { return Ok(None) };
        let edges = &self.morse.levels[1];
        let start = |pass: Pass| ends(edges, pass.edge).map(|(from, to)| if pass.is_backward { to } else { from });
        let back = Pass { is_backward: !last.is_backward, ..*last };
        let Some((from, to)) = start(*first).zip(start(back)) else { return Ok(None) };
        let class = self.class_of(path)?;
        let length = self.length(path);
        // Not by a rounding.
        let bound = length * (1.0 - 1e-9);
        self.shortest(from, (to, class), bound)
    }

    fn length(&self, path: &[Pass]) -> f64 {
        path.iter().map(|pass| (self.lengths)(pass.edge)).sum()
    }

    /// The shortest path to another vertex that has a class, if it is shorter than `bound` and not too many are nearer.
    fn shortest(&mut self, start: u32, goal: State, bound: f64) -> Result<Option<Vec<Pass>>, Failure> {
        let mut known: HashMap<State, (f64, Option<(Pass, State)>)> = HashMap::new();
        let mut queue = BinaryHeap::new();
        known.insert((start, 0), (0.0, None));
        queue.push((Reverse(Length(0.0)), (start, 0)));
        let mut looks = 0_usize;
        while let Some((Reverse(Length(length)), state)) = queue.pop() {
            if state == goal {
                let (mut path, mut at) = (Vec::new(), goal);
                while let Some((pass, before)) = known.get(&at).and_then(|(_, step)| *step) {
                    path.push(pass);
                    at = before;
                }
                path.reverse();
                return Ok(Some(path));
            }
            if known.get(&state).is_some_and(|(known, _)| *known < length) {
                continue;
            }
            looks += 1;
            if looks.is_multiple_of(1024) {
                self.morse.watch.look(0)?;
            }
            if looks > MOST_STATES {
                return Ok(None);
            }
            for &(pass, to) in self.graph.at(state.0) {
                let next = length + (self.lengths)(pass.edge);
                if next >= bound {
                    continue;
                }
                let class = self.classes.after(self.morse.ring, self.cochains, state.1, pass)?;
                let entry = known.entry((to, class)).or_insert((f64::INFINITY, None));
                if next < entry.0 {
                    *entry = (next, Some((pass, state)));
                    queue.push((Reverse(Length(next)), (to, class)));
                }
            }
        }
        Ok(None)
    }
}
