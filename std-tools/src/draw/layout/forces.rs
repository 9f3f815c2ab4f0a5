//! Forces: edges pull, vertices push each other away, far ones by groups.

use rayon::prelude::*;

use super::Graph;

/// Up to so many vertices each one pushes each other one.
const DIRECT: usize = 1000;
/// How strongly vertices push.
const PUSH: f64 = 0.2;
/// A group counts as one vertex if it is smaller than this part of its distance.
const FAR: f64 = 0.9;
/// Groups are parted until they have so few vertices.
const LEAF: usize = 8;

/// Moves the vertices of a connected graph until steps are short, or for so many rounds that it takes a few seconds.
pub(super) fn relax(graph: &Graph, dims: usize, places: &mut [[f64; 3]]) {
    if graph.len() < 3 {
        return;
    }
    let rounds = (2_000_000 / graph.len()).clamp(12, 400);
    let (mut step, mut energy, mut improved) = (0.5, f64::INFINITY, 0);
    for _ in 0..rounds {
        let tree = (graph.len() > DIRECT).then(|| Tree::new(places, dims));
        let here = &*places;
        let forces: Vec<[f64; 3]> =
            (0..graph.len()).into_par_iter().map(|vertex| force(graph, here, tree.as_ref(), vertex)).collect();
        let before = energy;
        // In their order, so that the sum is the same each time.
        energy = forces.iter().flatten().map(|value| value * value).sum();
        for (place, force) in places.iter_mut().zip(&forces) {
            let length = force.iter().map(|value| value * value).sum::<f64>().sqrt();
            if length > 0.0 {
                let part = step * length.min(1.0) / length;
                place.iter_mut().zip(force).for_each(|(value, force)| *value += part * force);
            }
        }
        // Longer steps while all goes well, shorter ones if it does not.
        improved = if energy < before { improved + 1 } else { 0 };
        if improved == 0 {
            step *= 0.9;
        } else if improved >= 5 {
            (step, improved) = (step / 0.9, 0);
        }
        if step < 0.005 {
            break;
        }
    }
}

/// The force on a vertex: with the square of the distance towards neighbours, with its inverse away from all.
fn force(graph: &Graph, places: &[[f64; 3]], tree: Option<&Tree>, vertex: usize) -> [f64; 3] {
    let here = places[vertex];
    let mut force = [0.0; 3];
    for &other in graph.neighbours(vertex) {
        let (towards, distance) = between(here, places[other as usize]);
        force.iter_mut().zip(towards).for_each(|(force, value)| *force += value * distance);
    }
    match tree {
        Some(tree) => tree.push(0, here, places, &mut force),
        None => places.iter().for_each(|&other| push(here, other, 1.0, &mut force)),
    }
    force
}

fn between(from: [f64; 3], to: [f64; 3]) -> ([f64; 3], f64) {
    let towards: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
    (towards, towards.iter().map(|value| value * value).sum::<f64>().sqrt())
}

/// Adds the force away from a place where so many vertices are.
fn push(here: [f64; 3], from: [f64; 3], count: f64, force: &mut [f64; 3]) {
    let (towards, distance) = between(here, from);
    if distance > 0.0 {
        let strength = PUSH * count / (distance * distance).max(1e-4);
        force.iter_mut().zip(towards).for_each(|(force, value)| *force -= strength * value);
    }
}

/// Space in halves along each axis, until few vertices are in a part.
struct Tree {
    parts: Vec<Part>,
    /// The vertices, those of each part in a row.
    vertices: Vec<u32>,
}

struct Part {
    middle: [f64; 3],
    side: f64,
    /// Its vertices.
    first: usize,
    end: usize,
    /// The parts of it; none of a leaf.
    children: [u32; 2],
}

impl Tree {
    fn new(places: &[[f64; 3]], dims: usize) -> Self {
        let count = places.len();
        let mut tree =
            Self { parts: Vec::with_capacity(count / LEAF * 4 + 1), vertices: (0_u32..).take(count).collect() };
        tree.part(0, count, places, dims);
        tree
    }

    /// Adds a part with the vertices of a range, and the parts of it, at the middle of its longest side.
    fn part(&mut self, first: usize, end: usize, places: &[[f64; 3]], dims: usize) -> u32 {
        let number = self.parts.len();
        let (mut low, mut high, mut sum) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], [0.0; 3]);
        for &vertex in &self.vertices[first..end] {
            for (axis, &value) in places[vertex as usize].iter().enumerate() {
                (low[axis], high[axis], sum[axis]) = (low[axis].min(value), high[axis].max(value), sum[axis] + value);
            }
        }
        let longest = (0..dims).max_by(|&a, &b| (high[a] - low[a]).total_cmp(&(high[b] - low[b]))).unwrap_or(0);
        let side = high[longest] - low[longest];
        let middle = sum.map(|value| value / (end - first) as f64);
        self.parts.push(Part { middle, side, first, end, children: [0; 2] });
        if end - first > LEAF && side > 0.0 {
            let half = first + (end - first) / 2;
            let key = |&vertex: &u32| places[vertex as usize][longest];
            // Of equal values the lesser vertex comes first, whatever came before.
            self.vertices[first..end]
                .select_nth_unstable_by(half - first, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
            let children = [self.part(first, half, places, dims), self.part(half, end, places, dims)];
            self.parts[number].children = children;
        }
        crate::build::narrow(number)
    }

    fn push(&self, number: u32, here: [f64; 3], places: &[[f64; 3]], force: &mut [f64; 3]) {
        let part = &self.parts[number as usize];
        let (_, distance) = between(here, part.middle);
        if part.side < FAR * distance {
            push(here, part.middle, (part.end - part.first) as f64, force);
        } else if part.children == [0; 2] {
            for &vertex in &self.vertices[part.first..part.end] {
                push(here, places[vertex as usize], 1.0, force);
            }
        } else {
            part.children.iter().for_each(|&child| self.push(child, here, places, force));
        }
    }
}
