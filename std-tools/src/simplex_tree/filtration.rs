//! Filtration values: monotone if no simplex has a smaller one than a face of it.

use super::{Simplex, SimplexTree};

impl SimplexTree {
    /// Gives a simplex another filtration value; the one it had, or `None` and nothing done if it is not there or the
    /// value is NaN. Values may be monotone no more then. Cost: O(p `D_m`).
    pub fn set_value(&mut self, word: &[u32], value: f64) -> Option<f64> {
        let place = self.locate(word).filter(|_| !value.is_nan())?;
        let before = self.value_at(place);
        self.set_value_at(place, value + 0.0);
        Some(before)
    }

    /// Whether every filtration value is at least those of the facets. Cost: O(p² `D_m`) for each simplex.
    #[must_use]
    pub fn is_monotone(&self) -> bool {
        !self.has_filtration() || self.iter().all(|simplex| largest_of_facets(simplex) <= simplex.value())
    }

    /// Raises every filtration value that is below that of a face to the largest of its faces', the least change that
    /// makes values monotone; how many were raised. Cost: O(p² `D_m`) for each simplex, and 8 bytes.
    pub fn make_monotone(&mut self) -> usize {
        let mut raised = 0;
        if !self.has_filtration() {
            return raised;
        }
        // By dimension, so that facets are right before their cofaces look at them.
        for place in self.places_by_dimension() {
            let simplex = Simplex::new(self, place);
            let least = largest_of_facets(simplex);
            if simplex.value() < least {
                self.set_value_at(place, least);
                raised += 1;
            }
        }
        raised
    }

    /// Whether all facets of all simplices are there, so that this is a complex: always, except between insertions by
    /// [`insert_with_prefixes`](Self::insert_with_prefixes). Cost: O(p² `D_m`) for each simplex.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.iter().all(|simplex| simplex.facets().all(|facet| facet.is_some()))
    }
}

/// The largest filtration value of a facet; −∞ for a vertex.
pub(super) fn largest_of_facets(simplex: Simplex<'_>) -> f64 {
    simplex.facets().flatten().fold(f64::NEG_INFINITY, |most, facet| most.max(facet.value()))
}
