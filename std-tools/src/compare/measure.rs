//! How long the relations of a structure take on simplices drawn at random.

use std::fmt;
use std::hint::black_box;
use std::time::Instant;

use serde::{Serialize, Serializer};
use sig_core::{Complex, Dim, Index, VertexId};

use super::CompareOptions;
use crate::baselines::Structure;
use crate::generate::SplitMix64;

/// A relation of the simplices of one dimension.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Relation {
    /// B_{p,q}.
    Boundary(Dim, Dim),
    /// C_{p,g}.
    Coboundary(Dim, Dim),
    /// A_p.
    Adjacency(Dim),
    /// The star of a p-simplex.
    Star(Dim),
    /// The link of a p-simplex.
    Link(Dim),
}

impl Relation {
    /// The relations that are timed in a complex of dimension `top`. From dimension 4 on, of the boundary and co-boundary
    /// relations only those to the least and to the nearest, and to the nearest and to the largest dimension.
    #[must_use]
    pub fn all(top: Dim) -> Vec<Self> {
        let few = top > 3;
        let pairs = || (0..=top).flat_map(|p| (0..=top).map(move |q| (p, q)));
        let boundaries = pairs().filter(|&(p, q)| q < p && (!few || q == 0 || q + 1 == p));
        let coboundaries = pairs().filter(|&(p, g)| g > p && (!few || g == top || g == p + 1));
        let boundaries = boundaries.map(|(p, q)| Self::Boundary(p, q));
        let coboundaries = coboundaries.map(|(p, g)| Self::Coboundary(p, g));
        let others = [Self::Adjacency, Self::Star, Self::Link];
        let others = others.into_iter().flat_map(|relation| (0..=top).map(relation));
        boundaries.chain(coboundaries).chain(others).collect()
    }

    /// p: the dimension of the simplices that are asked.
    #[must_use]
    pub const fn dim(self) -> Dim {
        match self {
            Self::Boundary(p, _) | Self::Coboundary(p, _) | Self::Adjacency(p) | Self::Star(p) | Self::Link(p) => p,
        }
    }

    fn ask<S: Structure>(self, structure: &mut S, simplex: S::Simplex, found: &mut Vec<S::Simplex>) {
        match self {
            Self::Boundary(_, q) => structure.boundary(simplex, q, found),
            Self::Coboundary(_, g) => structure.coboundary(simplex, g, found),
            Self::Adjacency(_) => structure.adjacency(simplex, found),
            Self::Star(_) => structure.star(simplex, found),
            Self::Link(_) => structure.link(simplex, found),
        }
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Boundary(p, q) => write!(f, "B_{p},{q}"),
            Self::Coboundary(p, g) => write!(f, "C_{p},{g}"),
            Self::Adjacency(p) => write!(f, "A_{p}"),
            Self::Star(p) => write!(f, "star_{p}"),
            Self::Link(p) => write!(f, "link_{p}"),
        }
    }
}

impl Serialize for Relation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// How long a relation took.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Timing {
    /// The relation.
    pub relation: Relation,
    /// How many simplices were asked for it.
    pub asked: usize,
    /// How many simplices an answer had, on average.
    pub found: f64,
    /// The seconds an answer took, on average, in the fastest of a few passes over all of them; not more than the slowest.
    pub mean_seconds: f64,
    /// The seconds of the slowest answer, of each simplex the faster of two; a clock reading is in it.
    pub worst_seconds: f64,
}

/// A timing, and the lengths of the answers.
#[derive(Clone, Debug)]
pub(super) struct Sampled {
    pub(super) timing: Timing,
    lengths: Vec<usize>,
}

impl Sampled {
    /// Whether the answers that both have were of the same lengths.
    pub(super) fn agrees(&self, other: &Self) -> bool {
        self.timing.relation == other.timing.relation && self.lengths.iter().zip(&other.lengths).all(|(a, b)| a == b)
    }
}

/// Simplices of each dimension, by their vertices.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    by_dim: Vec<Vec<Vec<VertexId>>>,
}

impl Sample {
    /// Draws `count` simplices of each dimension, all of them in order where there are no more.
    pub(super) fn new<I: Index>(complex: &Complex<'_, I>, count: usize) -> Self {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        let mut random = SplitMix64::new(2004);
        let mut draw = |dim: Dim| {
            let (first, available) =
                (complex.simplices_of_dim(dim).bounds().0.index(), complex.num_simplices_of_dim(dim));
            let ids = (0..count.min(available))
                .map(|number| if available <= count { number } else { random.next_below(available) });
            ids.map(|id| complex.vertices(sig_core::SimplexId::new(first + id)).collect()).collect()
        };
        Self { by_dim: (0..dims).map(&mut draw).collect() }
    }
}

/// Asks a structure for every relation of the sample.
pub(super) fn relations<S: Structure>(structure: &mut S, sample: &Sample, options: CompareOptions) -> Vec<Sampled> {
    let Some(top) = structure.dim().filter(|_| options.samples > 0) else { return Vec::new() };
    let mut timings = Vec::new();
    let found: Vec<Vec<S::Simplex>> =
        sample.by_dim.iter().map(|words| find(structure, words, options.seconds)).collect();
    for relation in Relation::all(top) {
        timings.extend(time(structure, relation, &found[relation.dim()], options.seconds));
    }
    timings
}

/// The names that a structure has for some simplices, as many as it finds in time, and a few at least.
fn find<S: Structure>(structure: &mut S, words: &[Vec<VertexId>], seconds: f64) -> Vec<S::Simplex> {
    let start = Instant::now();
    let mut found = Vec::new();
    for word in words {
        if found.len() >= FEW && start.elapsed().as_secs_f64() > seconds {
            break;
        }
        found.extend(structure.find(word));
    }
    found
}

/// How often all are asked in a row; the fastest counts, as other programs only ever make one slower.
const PASSES: usize = 3;

/// Simplices that are asked at least.
const FEW: usize = 5;

/// Asks a relation of some simplices: one by one until the time is up, then all of these in a row.
fn time<S: Structure>(
    structure: &mut S,
    relation: Relation,
    simplices: &[S::Simplex],
    seconds: f64,
) -> Option<Sampled> {
    let (mut found, mut lengths, mut each): (_, _, Vec<f64>) = (Vec::new(), Vec::new(), Vec::new());
    let begin = Instant::now();
    for &simplex in simplices {
        if lengths.len() >= FEW && begin.elapsed().as_secs_f64() > seconds {
            break;
        }
        each.push(one(structure, relation, simplex, &mut found));
        lengths.push(found.len());
    }
    let asked = lengths.len();
    let mut all = f64::INFINITY;
    for _ in 0..PASSES {
        let start = Instant::now();
        for &simplex in &simplices[..asked] {
            relation.ask(structure, simplex, &mut found);
            black_box(&found);
        }
        all = all.min(start.elapsed().as_secs_f64());
    }
    // One by one a second time, so that neither the first allocation nor another program counts.
    let (mut sum, mut worst_seconds) = (0.0, 0.0_f64);
    for (before, &simplex) in each.iter().zip(simplices) {
        let faster = before.min(one(structure, relation, simplex, &mut found));
        sum += faster;
        worst_seconds = worst_seconds.max(faster);
    }
    let timing = Timing {
        relation,
        asked,
        found: lengths.iter().sum::<usize>() as f64 / asked as f64,
        mean_seconds: all.min(sum) / asked as f64,
        worst_seconds,
    };
    (asked > 0).then_some(Sampled { timing, lengths })
}

fn one<S: Structure>(structure: &mut S, relation: Relation, simplex: S::Simplex, found: &mut Vec<S::Simplex>) -> f64 {
    let start = Instant::now();
    relation.ask(structure, simplex, found);
    black_box(&*found);
    start.elapsed().as_secs_f64()
}
