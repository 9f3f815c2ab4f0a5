//! Inserting: a simplex, a simplex with the prefixes of its word, a simplex with all its faces.

use sig_core::{Dim, MAX_DIM};

use super::arena::NONE;
use super::node::Place;
use super::{InsertError, SimplexTree, SizeError, check_word};
use crate::build::narrow;

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
                Err(_) if set == NONE => {
                    Place::within(self.add_set(place, above + 1, std::iter::once((*label, value)))?, 0)
                }
                Err(index) => Place::within(self.insert_sibling(place, set, index, (*label, value), above + 1)?, index),
            };
        }
        if !made && value < self.value_at(place) {
            self.set_value_at(place, value);
        }
        Ok(made)
    }

    /// Inserts one label at its index among the children of a node, which have dimension `dim`. Returns the set.
    fn insert_sibling(
        &mut self,
        parent: Place,
        set: u32,
        index: usize,
        (label, value): (u32, f64),
        dim: Dim,
    ) -> Result<u32, SizeError> {
        let moved = self.arena.open(set, index)?;
        self.arena.write(moved, index, label, value);
        self.counts[dim] += 1;
        if moved != set {
            self.set_child_at(parent, moved);
            self.list_moved(moved, dim);
        }
        self.list_new(moved, dim);
        Ok(moved)
    }

    /// Inserts a simplex and all its faces; how many of them are new. Those that are there already get the lower one of
    /// the two filtration values, so that values stay monotone.
    ///
    /// Cost: O(2^p `D_m`), the paper's (2.2.1): one merge for each of the 2^p sets of siblings that the faces are in,
    /// each O(d) if something is new in it. 12 bytes for each of the sets of two dimensions, which the tree keeps for the next.
    ///
    /// # Errors
    /// [`InsertError`]: if the vertices do not increase, or the value is not a number. Nothing is inserted then.
    pub fn insert_with_faces(&mut self, word: &[u32], value: f64) -> Result<usize, InsertError> {
        check(word, value)?;
        let value = value + 0.0;
        let before = self.num_simplices();
        let [mut nodes, mut next] = std::mem::take(&mut self.faces);
        nodes.clear();
        for (position, &label) in word.iter().enumerate() {
            self.insert_top(label, value, true);
            nodes.push((Place::top(label), narrow(position + 1)));
        }
        nodes.pop();
        // By dimension rather than depth-first: then the sets of one dimension are known together, and the processor can
        // wait for all of them at a time, which in a large tree are nowhere near.
        for dim in 1..word.len() {
            self.touch_children(&nodes);
            next.clear();
            for &(node, position) in &nodes {
                self.insert_faces(node, word, position as usize, (value, dim), &mut next)?;
            }
            std::mem::swap(&mut nodes, &mut next);
        }
        self.faces = [nodes, next];
        Ok(self.num_simplices() - before)
    }

    /// Reads a word or two of the sets of the children of some nodes, so that they are on their way together.
    fn touch_children(&self, nodes: &[(Place, u32)]) {
        let touch = |&(node, _): &(Place, u32)| self.arena.touch(self.child_at(node));
        std::hint::black_box(nodes.iter().map(touch).fold(0, |all, word| all ^ word));
    }

    /// Inserts the labels of a word from a position on among the children of a node, and adds those that are to have
    /// children themselves to the nodes of the next dimension, each with the position after its own.
    fn insert_faces(
        &mut self,
        parent: Place,
        word: &[u32],
        position: usize,
        (value, dim): (f64, Dim),
        next: &mut Vec<(Place, u32)>,
    ) -> Result<(), SizeError> {
        let labels = &word[position..];
        let mut indices = [0; MAX_DIM + 1];
        let set = self.child_at(parent);
        let set = if set == NONE {
            (0..).zip(&mut indices).for_each(|(position, index)| *index = position);
            self.add_set(parent, dim, labels.iter().map(|&label| (label, value)))?
        } else {
            self.merge_children(parent, set, labels, (value, dim), &mut indices)?
        };
        let inner = &indices[..labels.len() - 1];
        next.extend((position + 1..).zip(inner).map(|(after, &index)| (Place::within(set, index), narrow(after))));
        Ok(())
    }

    /// Inserts labels, increasing, into the set of the children of a node, which have dimension `dim`; those that are there
    /// get the lower one of the two values. Tells where they are then, and returns the set.
    fn merge_children(
        &mut self,
        parent: Place,
        set: u32,
        labels: &[u32],
        (value, dim): (f64, Dim),
        indices: &mut [usize; MAX_DIM + 1],
    ) -> Result<u32, SizeError> {
        let missing = self.arena.find_all(set, labels, indices);
        if missing == 0 {
            for &index in &indices[..labels.len()] {
                if value < self.arena.value(set, index) {
                    self.arena.set_value(set, index, value);
                }
            }
            return Ok(set);
        }
        let moved = self.arena.extend(set, self.arena.len(set) + missing)?;
        if moved != set {
            self.set_child_at(parent, moved);
        }
        self.counts[dim] += missing;
        self.arena.merge(moved, labels, missing, value);
        if moved != set {
            self.list_moved(moved, dim);
        }
        self.list_new(moved, dim);
        Ok(moved)
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
}

/// Checks a word and a filtration value.
fn check(word: &[u32], value: f64) -> Result<(), InsertError> {
    check_word(word)?;
    if value.is_nan() { Err(InsertError::NotANumber) } else { Ok(()) }
}
