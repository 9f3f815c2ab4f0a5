//! One landmark more in a strict witness complex, without building it anew (simplex-tree-2012, 3.2, landmark insertion).
//!
//! Beside the simplices stands for each the number of witnesses that witness it. Only witnesses that see the new landmark
//! x among their nearest ones change what they witness, and only in the dimensions j ≥ i, where i landmarks are as near
//! as x or nearer. Dimension by dimension, such a witness leaves the simplices that it witnessed and x makes it leave; a
//! simplex goes when its counter reaches zero, or one of its facets goes; and what the witness now witnesses with x
//! comes, if all of its facets are there. A simplex without x gains no witness, so nothing that went comes back.
//!
//! Ties are as in the definition: a witness with several landmarks at the distance of the last one counts for every
//! choice among them. Without ties that is one simplex a dimension, as the paper has it.

use hashbrown::HashMap;
use rayon::prelude::*;
use sig_core::Dim;

use crate::build::narrow;
use crate::points::Points;
use crate::witness::levels::Levels;
use crate::witness::table::{Near, Scale, Search};
use crate::witness::{Landmarks, Relaxation, WitnessComplex, WitnessError, WitnessOptions, refuse_crowd};

/// A strict witness complex to which landmarks can be added.
///
/// It holds the nearest landmarks of every witness, and the simplices with the numbers of their witnesses.
#[derive(Clone, Debug)]
pub struct GrowingWitnessComplex {
    witnesses: Points,
    landmarks: Landmarks,
    options: WitnessOptions,
    /// For each witness its `max_dim` + 1 nearest landmarks, and those as far as the last of them.
    rows: Vec<Vec<Near>>,
    /// For each dimension the simplices by their landmarks, increasing, with the number of their witnesses.
    levels: Vec<HashMap<Box<[u32]>, u32>>,
    /// For each landmark the other ends of its edges, also of those that are gone.
    neighbours: Vec<Vec<u32>>,
}

/// A witness that sees the new landmark.
struct Affected {
    witness: usize,
    /// Its distance from the new landmark.
    distance: f64,
    /// What it saw before.
    before: Vec<Near>,
    /// Whether it may still witness simplices of the next dimension that it leaves, and with the new landmark.
    leaves: bool,
    enters: bool,
}

impl GrowingWitnessComplex {
    /// Builds the strict complex with its counters. Of the options the metric, the dimension and the limit count.
    ///
    /// Time: as [`witness_complex`](super::witness_complex()), with a table of `max_dim` + 1 landmarks for every witness and a
    /// hash look-up for every facet; a smaller `max_dim` is faster.
    ///
    /// # Errors
    /// [`WitnessError`], as of [`witness_complex`](super::witness_complex()).
    pub fn new(witnesses: Points, landmarks: Landmarks, options: &WitnessOptions) -> Result<Self, WitnessError> {
        let options = WitnessOptions { relaxation: Relaxation::STRICT, filtration: false, ..*options };
        options.check(&witnesses, landmarks.points())?;
        let scale = Scale { metric: options.metric, relaxation: options.relaxation };
        let all: Vec<u32> = (0..narrow(witnesses.len())).collect();
        let table = Search::new(landmarks.points(), scale).nearest(&witnesses, &all, options.max_dim + 1);
        let rows = (0..witnesses.len()).map(|witness| table.row(witness).iter().collect()).collect();
        let neighbours = vec![Vec::new(); landmarks.points().len()];
        let mut complex = Self { witnesses, landmarks, options, rows, levels: Vec::new(), neighbours };
        let limit = options.limit();
        complex.rows.iter().try_for_each(|row| refuse_crowd(crowd(row), options.max_dim, limit))?;
        complex.count_all(limit)?;
        Ok(complex)
    }

    /// Fills the levels, one after the other: what is witnessed and has all facets in the level before.
    fn count_all(&mut self, limit: u64) -> Result<(), WitnessError> {
        let mut active: Vec<usize> = (0..self.rows.len()).collect();
        let rows = std::mem::take(&mut self.rows);
        for dim in 0..=self.options.max_dim {
            self.levels.push(HashMap::new());
            active.retain(|&witness| {
                let mut any = false;
                each_witnessed(&rows[witness], dim, &mut |simplex| any |= self.enter(simplex));
                any
            });
            let at_least = self.levels.iter().map(|level| level.len() as u64).sum();
            if at_least > limit {
                return Err(WitnessError::TooLarge { at_least, limit });
            }
            if active.is_empty() {
                break;
            }
        }
        self.rows = rows;
        Ok(())
    }

    /// Adds a landmark; its number, one more than the largest so far. Afterwards [`complex`](Self::complex) is what
    /// [`witness_complex`](super::witness_complex()) builds with it.
    ///
    /// Time: a distance for every witness, and for those W^x that see the landmark among their `max_dim` + 1 nearest
    /// ones, O(k²) look-ups each, and as many for each simplex that comes or goes.
    ///
    /// # Errors
    /// [`WitnessError`], and the complex is as before: a point of another space or with a coordinate that is not finite,
    /// or more landmarks at the place of one than subsets of them are allowed.
    pub fn insert(&mut self, point: &[f64]) -> Result<u64, WitnessError> {
        let (dim, landmark) = (self.landmarks.points().dim(), self.landmarks.points().len());
        if point.len() != dim {
            return Err(WitnessError::Dimensions { witnesses: dim, landmarks: point.len() });
        }
        if landmark >= u32::MAX as usize - 1 {
            return Err(WitnessError::TooManyPoints(landmark + 1));
        }
        let landmarks = self.landmarks.with(point)?;
        let near = |distance| Near { distance, landmark: narrow(landmark) };
        let (mut affected, rows) = self.affected(point, near)?;
        self.landmarks = landmarks;
        self.neighbours.push(Vec::new());
        for (affected, row) in affected.iter_mut().zip(rows) {
            affected.before = std::mem::replace(&mut self.rows[affected.witness], row);
        }
        let mut gone = Vec::new();
        for dim in 0..=self.options.max_dim {
            if self.levels.len() == dim {
                self.levels.push(HashMap::new());
            }
            gone = self.leave_all(dim, &mut affected, &gone);
            self.enter_all(dim, &mut affected, narrow(landmark));
            if self.levels[dim].is_empty() && gone.is_empty() {
                break;
            }
        }
        while self.levels.last().is_some_and(HashMap::is_empty) {
            self.levels.pop();
        }
        Ok(self.landmarks.numbers()[landmark])
    }

    /// The witnesses that see a new landmark, W^x, and what they see with it.
    fn affected(
        &self,
        point: &[f64],
        near: impl Fn(f64) -> Near + Sync,
    ) -> Result<(Vec<Affected>, Vec<Vec<Near>>), WitnessError> {
        let last = self.options.max_dim;
        let see = |witness: usize| {
            let distance = self.options.metric.distance(self.witnesses.point(witness), point).min(f64::MAX);
            let row = &self.rows[witness];
            if row.get(last).is_some_and(|farthest| distance > farthest.distance) {
                return None;
            }
            let mut row = row.clone();
            row.insert(row.partition_point(|near| near.distance <= distance), near(distance));
            if let Some(&Near { distance: farthest, .. }) = row.get(last) {
                row.truncate(row.partition_point(|near| near.distance <= farthest));
            }
            let affected = Affected { witness, distance, before: Vec::new(), leaves: true, enters: true };
            Some((affected, row))
        };
        let found: Vec<(Affected, Vec<Near>)> =
            (0..self.rows.len()).into_par_iter().with_min_len(256).filter_map(see).collect();
        let limit = self.options.limit();
        found.iter().try_for_each(|(_, row)| refuse_crowd(crowd(row), last, limit))?;
        Ok(found.into_iter().unzip())
    }

    /// Has the witnesses leave what they witness no longer of dimension `dim`, and removes that which has no witness or
    /// a facet in `gone`. What is removed is returned.
    fn leave_all(&mut self, dim: Dim, affected: &mut [Affected], gone: &[Box<[u32]>]) -> Vec<Box<[u32]>> {
        let (level, neighbours) = (&mut self.levels[dim], &self.neighbours);
        let mut removed = Vec::new();
        for facet in gone {
            for &other in facet.first().map_or(&[][..], |&first| &neighbours[first as usize]) {
                let Err(position) = facet.binary_search(&other) else { continue };
                let simplex = [&facet[..position], &[other], &facet[position..]].concat();
                removed.extend(level.remove_entry(simplex.as_slice()).map(|(simplex, _)| simplex));
            }
        }
        for affected in affected.iter_mut().filter(|affected| affected.leaves) {
            // A simplex stays witnessed if none of its vertices is farther than the new landmark.
            if affected.before.get(dim).is_some_and(|farthest| farthest.distance <= affected.distance) {
                continue;
            }
            affected.leaves = false;
            each_witnessed(&affected.before, dim, &mut |simplex| {
                let Some(witnesses) = level.get_mut(simplex) else { return };
                affected.leaves = true;
                *witnesses -= 1;
                if *witnesses == 0 {
                    removed.extend(level.remove_entry(simplex).map(|(simplex, _)| simplex));
                }
            });
        }
        removed
    }

    /// Counts what the witnesses witness with the new landmark, as far as its facets are there.
    fn enter_all(&mut self, dim: Dim, affected: &mut [Affected], landmark: u32) {
        for affected in affected.iter_mut().filter(|affected| affected.enters) {
            let row = std::mem::take(&mut self.rows[affected.witness]);
            // Before, all simplices that it witnesses are without the landmark.
            if row.get(dim).is_none_or(|farthest| farthest.distance >= affected.distance) {
                affected.enters = false;
                each_witnessed(&row, dim, &mut |simplex| {
                    // It has the largest number.
                    if simplex.last() == Some(&landmark) {
                        affected.enters |= self.enter(simplex);
                    }
                });
            }
            self.rows[affected.witness] = row;
        }
    }

    /// Counts one more witness of a simplex, which comes if it is not there and all of its facets are; whether it is
    /// there now.
    fn enter(&mut self, simplex: &[u32]) -> bool {
        let dim = simplex.len() - 1;
        if let Some(witnesses) = self.levels[dim].get_mut(simplex) {
            *witnesses += 1;
            return true;
        }
        let mut facet = simplex[..dim].to_vec();
        for omitted in (0..=dim).rev() {
            // From the facet without the last vertex on, each time the vertex before takes the place of the next.
            if omitted < dim {
                facet[omitted] = simplex[omitted + 1];
            }
            if dim > 0 && !self.levels[dim - 1].contains_key(facet.as_slice()) {
                return false;
            }
        }
        if let &[a, b] = simplex {
            self.neighbours[a as usize].push(b);
            self.neighbours[b as usize].push(a);
        }
        self.levels[dim].insert(simplex.into(), 1);
        true
    }

    /// The landmarks so far.
    #[must_use]
    pub fn landmarks(&self) -> &Landmarks {
        &self.landmarks
    }

    /// The number of witnesses of the simplex with the given landmarks, by their position among the landmarks,
    /// increasing; `None` if it is not in the complex.
    #[must_use]
    pub fn num_witnesses(&self, simplex: &[u32]) -> Option<u32> {
        self.levels.get(simplex.len().checked_sub(1)?)?.get(simplex).copied()
    }

    /// The complex as it is now. Time: a sort of its simplices.
    #[must_use]
    pub fn complex(&self) -> WitnessComplex {
        let sorted = |level: &HashMap<Box<[u32]>, u32>| {
            let mut words: Vec<Box<[u32]>> = level.keys().cloned().collect();
            words.par_sort_unstable();
            words
        };
        let mut vertices = vec![u32::MAX; self.landmarks.points().len()];
        let mut words = self.levels.first().map_or_else(Vec::new, sorted);
        for (vertex, word) in (0..).zip(&words) {
            vertices[word[0] as usize] = vertex;
        }
        let mut levels = Levels::new(words.len(), Vec::new());
        for level in self.levels.iter().skip(1).take_while(|level| !level.is_empty()) {
            let next = sorted(level);
            let mut prefix = 0;
            let simplices: Vec<(u32, u32)> = next
                .iter()
                .filter_map(|word| {
                    let (&last, others) = word.split_last()?;
                    prefix += words[prefix..].iter().position(|word| **word == *others)?;
                    Some((narrow(prefix), vertices[last as usize]))
                })
                .collect();
            levels.push_known(&simplices);
            words = next;
        }
        WitnessComplex::new(levels, &self.landmarks, &vertices)
    }
}

/// How many landmarks are as near as the nearest.
fn crowd(row: &[Near]) -> usize {
    row.first().map_or(0, |nearest| row.partition_point(|near| near.distance <= nearest.distance))
}

/// Calls `visit` with each simplex of dimension `dim` that the witness with this row witnesses: the landmarks nearer than
/// the one of rank `dim`, and any choice among those that are as far as it.
fn each_witnessed(row: &[Near], dim: Dim, visit: &mut impl FnMut(&[u32])) {
    let Some(farthest) = row.get(dim).map(|near| near.distance) else { return };
    let nearer = row.partition_point(|near| near.distance < farthest);
    let ties = &row[nearer..row.partition_point(|near| near.distance <= farthest)];
    // The positions of the chosen ones, the first choice in lexicographic order.
    let mut chosen: Vec<usize> = (0..=dim - nearer).collect();
    let mut simplex = Vec::with_capacity(dim + 1);
    loop {
        simplex.clear();
        simplex.extend(row[..nearer].iter().chain(chosen.iter().map(|&tie| &ties[tie])).map(|near| near.landmark));
        simplex.sort_unstable();
        visit(&simplex);
        // The next choice: the last position that can move moves, and those behind it follow.
        let movable = |&position: &usize| chosen[position] + chosen.len() - position < ties.len();
        let Some(position) = (0..chosen.len()).rev().find(movable) else { return };
        let start = chosen[position] + 1;
        for (offset, tie) in chosen[position..].iter_mut().enumerate() {
            *tie = start + offset;
        }
    }
}
