//! Where vertices start: distances along edges from pivots far apart, in the directions in which they vary most.

use std::collections::VecDeque;

use super::Graph;
use crate::generate::SplitMix64;

/// The pivots of a large graph; a small one has all its vertices.
const PIVOTS: usize = 64;
/// Rounds that find the directions.
const ROUNDS: usize = 60;

/// Places for a connected graph: the first coordinate varies most. Vertices with the same distances come to lie side by side,
/// by numbers drawn from the seed.
pub(super) fn places(graph: &Graph, dims: usize, seed: u64) -> Vec<[f64; 3]> {
    let columns = columns(graph);
    let directions = directions(&columns, dims, seed);
    let mut random = SplitMix64::new(seed);
    let mut places = vec![[0.0; 3]; graph.len()];
    for (vertex, place) in places.iter_mut().enumerate() {
        for (axis, direction) in directions.iter().enumerate() {
            let value: f64 = columns.iter().zip(direction).map(|(column, part)| column[vertex] * part).sum();
            place[axis] = value + 0.05 * next(&mut random);
        }
        for value in &mut place[directions.len()..dims] {
            *value = next(&mut random);
        }
    }
    scale(graph, &mut places);
    places
}

/// For each pivot the distances of all vertices, squared, less the means of rows and columns, as classical scaling wants them.
fn columns(graph: &Graph) -> Vec<Vec<f64>> {
    let count = PIVOTS.min(graph.len());
    let mut nearest = vec![u32::MAX; graph.len()];
    let (mut pivot, mut columns) = (0, Vec::with_capacity(count));
    for _ in 0..count {
        let distances = distances(graph, pivot);
        for (nearest, &distance) in nearest.iter_mut().zip(&distances) {
            *nearest = (*nearest).min(distance);
        }
        columns.push(distances.into_iter().map(|distance| f64::from(distance).powi(2)).collect::<Vec<_>>());
        // The farthest from all pivots; the first of them.
        let farthest = (0..graph.len()).max_by_key(|&vertex| (nearest[vertex], std::cmp::Reverse(vertex)));
        pivot = farthest.unwrap_or(0);
    }
    let means: Vec<f64> = columns.iter().map(|column| column.iter().sum::<f64>() / column.len() as f64).collect();
    let mean = means.iter().sum::<f64>() / means.len().max(1) as f64;
    for vertex in 0..graph.len() {
        let row = columns.iter().map(|column| column[vertex]).sum::<f64>() / columns.len() as f64;
        for (column, of_column) in columns.iter_mut().zip(&means) {
            column[vertex] = -0.5 * (column[vertex] - of_column - row + mean);
        }
    }
    columns
}

/// The distances of all vertices of a connected graph from one.
fn distances(graph: &Graph, from: usize) -> Vec<u32> {
    let mut distances = vec![u32::MAX; graph.len()];
    distances[from] = 0;
    let mut queue = VecDeque::from([from]);
    while let Some(vertex) = queue.pop_front() {
        let next = distances[vertex] + 1;
        for &other in graph.neighbours(vertex) {
            if distances[other as usize] == u32::MAX {
                distances[other as usize] = next;
                queue.push_back(other as usize);
            }
        }
    }
    distances
}

/// The eigenvectors of the products of columns with the largest eigenvalues, by powers; fewer if there are not so many.
fn directions(columns: &[Vec<f64>], dims: usize, seed: u64) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let products: Vec<Vec<f64>> =
        columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect::<Vec<_>>()).collect();
    let (mut random, mut found) = (SplitMix64::new(seed), Vec::<Vec<f64>>::new());
    let largest = products.iter().enumerate().map(|(row, products)| products[row]).fold(0.0, f64::max);
    for _ in 0..dims {
        let mut vector: Vec<f64> = columns.iter().map(|_| next(&mut random)).collect();
        let mut length = 0.0;
        for _ in 0..ROUNDS {
            vector = products.iter().map(|row| dot(row, &vector)).collect();
            for other in &found {
                let part = dot(&vector, other);
                vector.iter_mut().zip(other).for_each(|(value, other)| *value -= part * other);
            }
            length = dot(&vector, &vector).sqrt();
            if length <= 1e-9 * largest {
                break;
            }
            vector.iter_mut().for_each(|value| *value /= length);
        }
        if length <= 1e-9 * largest {
            break;
        }
        found.push(vector);
    }
    found
}

/// Makes edges as long as 1 in the mean.
fn scale(graph: &Graph, places: &mut [[f64; 3]]) {
    let (mut sum, mut count) = (0.0, 0_usize);
    for vertex in 0..graph.len() {
        for &other in graph.neighbours(vertex) {
            let (a, b) = (places[vertex], places[other as usize]);
            sum += (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
            count += 1;
        }
    }
    if sum > 0.0 {
        places.iter_mut().flatten().for_each(|value| *value *= count as f64 / sum);
    }
}

/// A number between −1 and 1.
fn next(random: &mut SplitMix64) -> f64 {
    2.0 * random.next_unit() - 1.0
}
