//! Inserting: a simplex, a simplex with the prefixes of its word, a simplex with all its faces.

use sig_core::Dim;

use super::arena::NONE;
use super::node::Place;
use super::{InsertError, SimplexTree, SizeError, check_word};

impl SimplexTree {
    /// Inserts a simplex whose facets are there; whether it is new. If it is there already, it gets the lower one of the
    /// two filtration values. The complex stays one, and its values monotone if they were.
    ///
    /// Cost: O(p² `D_m`) to look at the facets, O(d) to make room among the siblings.
    ///
    /// # Errors
    /// [`InsertError`]: if the vertices do not increase, a facet is missing, or has a larger value. Nothing is inserted
    /// then.
    pub fn insert(&mut self, word: &[u32], value: f64) -> Result<bool, InsertError> {
        check(word, value)?;
        self.check_facets(word, value)?;
        Ok(self.insert_path(word, value + 0.0)?)
    }

    fn check_facets(&self, word: &[u32], value: f64) -> Result<(), InsertError> {
        if word.len() == 1 {
            return Ok(());
        }
        // The node of the prefix that ends before the omitted vertex.
        let mut above = None;
        for omitted in 0..word.len() {
            let facet = if omitted > 0 {
                let prefix = self.descend(above, &word[omitted - 1..omitted]);
                above = prefix;
                prefix.and_then(|prefix| self.descend(Some(prefix), &word[omitted + 1..]))
            } else {
                self.descend(None, &word[1..])
            };
            let name = || word.iter().enumerate().filter(|&(at, _)| at != omitted).map(|(_, &label)| label).collect();
            let facet_value = match facet {
                Some(facet) => self.value_at(facet),
                None => return Err(InsertError::MissingFacet { facet: name() }),
            };
            if value < facet_value && self.has_filtration() {
                return Err(InsertError::BelowFacet { value, facet: name(), facet_value });
            }
        }
        Ok(())
    }

    /// Inserts a simplex as the paper does (2.2.1): whatever prefixes of its word are missing are inserted with it, with
    /// the same filtration value; its other faces are not. Whether it is new. If it is there already, it gets the lower
    /// one of the two values.
    ///
    /// For simplices that come in any order, all of which will have come in the end: until then this is no complex, of
    /// which [`is_closed`](Self::is_closed) tells. All operations work all the same on what is there.
    ///
    /// Cost: O(p `D_m`) down the tree, O(d) for each new node.
    ///
    /// # Errors
    /// [`InsertError`]: if the vertices do not increase, or the value is not a number. Nothing is inserted then.
    pub fn insert_with_prefixes(&mut self, word: &[u32], value: f64) -> Result<bool, InsertError> {
        check(word, value)?;
        Ok(self.insert_path(word, value + 0.0)?)
    }

    /// Inserts a checked word.
    pub(super) fn insert_path(&mut self, word: &[u32], value: f64) -> Result<bool, SizeError> {
        let [first, rest @ ..] = word else { return Ok(false) };
        let mut made = self.insert_top(*first, value, rest.is_empty());
        let mut place = Place::top(*first);
        for (above, label) in rest.iter().enumerate() {
            let set = self.child_at(place);
            let found = if set == NONE { Err(0) } else { self.arena.search(set, *label) };
            made = found.is_err();
            place = match found {
                Ok(index) => Place::within(set, index),
                Err(index) => {
                    let set = self.insert_children(place, &[*label], value, above + 1)?;
                    Place::within(set, index)
                }
            };
        }
        if !made && value < self.value_at(place) {
            self.set_value_at(place, value);
        }
        Ok(made)
    }

    /// Inserts a simplex and all its faces; how many of them are new. Those that are there already get the lower one of
    /// the two filtration values, so that values stay monotone.
    ///
    /// Cost: O(2^p `D_m`), the paper's (2.2.1): one merge for each of the 2^p sets of siblings that the faces are in,
    /// each O(d) if something is new in it.
    ///
    /// # Errors
    /// [`InsertError`]: if the vertices do not increase, or the value is not a number. Nothing is inserted then.
    pub fn insert_with_faces(&mut self, word: &[u32], value: f64) -> Result<usize, InsertError> {
        check(word, value)?;
        let before = self.num_simplices();
        for (position, &label) in word.iter().enumerate() {
            self.insert_top(label, value + 0.0, true);
            self.insert_faces(Place::top(label), &word[position + 1..], value + 0.0, 1)?;
        }
        Ok(self.num_simplices() - before)
    }

    /// Inserts all words on the labels below a node.
    fn insert_faces(&mut self, parent: Place, labels: &[u32], value: f64, dim: Dim) -> Result<(), SizeError> {
        if labels.is_empty() {
            return Ok(());
        }
        let set = self.insert_children(parent, labels, value, dim)?;
        let mut index = 0;
        for (position, label) in labels[..labels.len() - 1].iter().enumerate() {
            index += self.arena.labels(set)[index..].iter().take_while(|&other| other < label).count();
            self.insert_faces(Place::within(set, index), &labels[position + 1..], value, dim + 1)?;
        }
        Ok(())
    }

    /// Inserts a vertex, or lowers its value to the given one if it is there; whether it is new.
    pub(super) fn insert_top(&mut self, label: u32, value: f64, lower: bool) -> bool {
        let value = if self.has_filtration() { value } else { 0.0 };
        let (top, made) = self.tops.entry(label, value);
        if lower && value < top.value {
            top.value = value;
        }
        self.counts[0] += usize::from(made);
        made
    }

    /// Inserts labels, increasing, among the children of a node, which have dimension `dim`; those that are there get the
    /// lower one of the two values. Returns the set.
    pub(super) fn insert_children(
        &mut self,
        parent: Place,
        labels: &[u32],
        value: f64,
        dim: Dim,
    ) -> Result<u32, SizeError> {
        let set = self.child_at(parent);
        if set == NONE {
            return self.add_set(parent, dim, labels.iter().map(|&label| (label, value)));
        }
        let missing = labels.len() - self.num_common(set, labels);
        let mut set = set;
        if missing > 0 {
            set = self.resize_set(parent, set, self.arena.len(set) + missing)?;
            self.counts[dim] += missing;
        }
        self.arena.merge(set, labels, missing, value);
        if missing > 0 {
            self.list_new(set, dim);
        }
        Ok(set)
    }

    /// How many of the labels, increasing, are in a set.
    fn num_common(&self, set: u32, labels: &[u32]) -> usize {
        let siblings = self.arena.labels(set);
        let [label] = labels else {
            let mut rest = siblings;
            return labels
                .iter()
                .filter(|&label| {
                    let skipped = rest.iter().take_while(|&other| other < label).count();
                    rest = &rest[skipped..];
                    rest.first() == Some(label)
                })
                .count();
        };
        usize::from(self.arena.search(set, *label).is_ok())
    }

    /// Gives the set of the children of a node another length, see [`Arena::resize`](super::arena::Arena::resize).
    fn resize_set(&mut self, parent: Place, set: u32, len: usize) -> Result<u32, SizeError> {
        let kept = self.arena.len(set);
        let moved = self.arena.resize(set, len)?;
        if moved != set {
            self.set_child_at(parent, moved);
            self.list_moved(moved, kept);
        }
        Ok(moved)
    }
}

/// Checks a word and a filtration value.
fn check(word: &[u32], value: f64) -> Result<(), InsertError> {
    check_word(word)?;
    if value.is_nan() { Err(InsertError::NotANumber) } else { Ok(()) }
}
