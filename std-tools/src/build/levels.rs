//! Deals the listed words out to their vertices, and the vertices to tasks that find all faces ([`super::local`]).

use rayon::prelude::*;

use crate::build::local::{Level, Local};
use crate::build::words::Words;
use crate::build::{BuildError, Limit, Meter, Phase};

/// Tails that a task has at least, unless there are fewer.
const MIN_TASK: usize = 1 << 12;
/// Tasks for each thread.
const TASKS_PER_THREAD: usize = 64;

/// All faces but the vertices, as found by the tasks: consecutive ranges of least vertices.
pub(super) struct Chunks {
    pub(super) num_vertices: usize,
    /// How each vertex is listed; empty if none is.
    pub(super) listed_vertices: Vec<u8>,
    /// For each task the faces by dimension, from 0.
    pub(super) tasks: Vec<Vec<Level>>,
}

impl Chunks {
    /// The number of simplices of each dimension.
    pub(super) fn counts(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        if self.num_vertices > 0 {
            counts.push(self.num_vertices);
        }
        for dim in 1.. {
            let count = self.tasks.iter().filter_map(|levels| levels.get(dim)).map(|level| level.labels.len()).sum();
            if count == 0 {
                break;
            }
            counts.push(count);
        }
        counts
    }

    /// The number of simplices.
    pub(super) fn num_simplices(&self) -> usize {
        self.counts().iter().sum()
    }
}

/// Finds all faces of the listed words on `num_vertices` vertices.
pub(super) fn find(
    words: &Words,
    num_vertices: usize,
    listed_vertices: Vec<u8>,
    limit: &Limit,
    meter: &Meter<'_>,
) -> Result<Chunks, BuildError> {
    let tails = Tails::new(words, num_vertices);
    let stage = meter.stage(Phase::Levels, num_vertices);
    limit.reserve(num_vertices)?;
    let tasks: Result<Vec<_>, _> = tails
        .tasks()
        .into_par_iter()
        .map_init(Local::default, |local, vertices| {
            let mut levels = Vec::new();
            let mut reservation = limit.reservation();
            stage.add(vertices.len());
            for vertex in vertices {
                for &place in tails.of(vertex) {
                    let (tail, mark) = words.tail(place);
                    local.push_tail(tail, mark);
                }
                local.add_vertex(&mut levels, &mut reservation)?;
            }
            for level in &mut levels {
                level.finish();
            }
            reservation.settle()?;
            Ok(levels)
        })
        .collect();
    Ok(Chunks { num_vertices, listed_vertices, tasks: tasks? })
}

/// For each vertex the places in the listed words where it stands, but not as the last.
struct Tails {
    starts: Vec<usize>,
    places: Vec<usize>,
}

impl Tails {
    fn new(words: &Words, num_vertices: usize) -> Self {
        let mut starts = vec![0_usize; num_vertices + 2];
        words.for_each_tail(|vertex, _| starts[vertex as usize + 2] += 1);
        for vertex in 2..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Shifted by one, so that filling in moves each start to where it belongs.
        let mut places = vec![0; starts[num_vertices + 1]];
        words.for_each_tail(|vertex, place| {
            let next = &mut starts[vertex as usize + 1];
            places[*next] = place;
            *next += 1;
        });
        starts.pop();
        Self { starts, places }
    }

    fn of(&self, vertex: usize) -> &[usize] {
        &self.places[self.starts[vertex]..self.starts[vertex + 1]]
    }

    /// Ranges of vertices with about the same number of tails.
    fn tasks(&self) -> Vec<std::ops::Range<usize>> {
        let size = (self.places.len() / (TASKS_PER_THREAD * rayon::current_num_threads())).max(MIN_TASK);
        let mut tasks = Vec::new();
        let mut start = 0;
        for end in 1..self.starts.len() {
            // A vertex counts as a tail: isolated ones are work too.
            if self.starts[end] - self.starts[start] + (end - start) >= size || end + 1 == self.starts.len() {
                tasks.push(start..end);
                start = end;
            }
        }
        tasks
    }
}
