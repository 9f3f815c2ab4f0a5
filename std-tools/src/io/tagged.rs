//! Meshes of finite elements whose nodes go by any tags: nodes and elements may come in any order.

use hashbrown::HashMap;

use super::error::{ErrorKind, Fault, Position};
use super::intake::Intake;
use super::labels::LabelTable;
use super::report::ReadReport;
use super::shape::Shape;
use super::{Format, ReadOptions};
use crate::soup::{Scalars, Soup};

/// A mesh as far as it is read.
pub(super) struct TaggedMesh {
    tags: LabelTable,
    values: Vec<f64>,
    declared: Vec<bool>,
    /// The nodes that were used before they were declared, and where first.
    ahead: HashMap<u32, Position>,
    pub(super) intake: Intake,
    /// The vertices of the element at hand.
    word: Vec<u32>,
}

impl TaggedMesh {
    pub(super) fn new(format: Format, options: &ReadOptions<'_>) -> Self {
        Self {
            tags: LabelTable::new(),
            values: Vec::new(),
            declared: Vec::new(),
            ahead: HashMap::default(),
            intake: Intake::new(format, options),
            word: Vec::new(),
        }
    }

    /// The vertex number of a tag.
    fn number(&mut self, tag: u64, position: Position) -> Result<u32, Fault> {
        let number = self.tags.number_integer(tag).ok_or_else(|| Fault::new(position, ErrorKind::TooManyVertices))?;
        let count = self.tags.len();
        self.declared.resize(count, false);
        self.values.resize(3 * count, 0.0);
        Ok(number)
    }

    /// Declares a node.
    pub(super) fn node(&mut self, tag: u64, point: [f64; 3], position: Position) -> Result<(), Fault> {
        let number = self.number(tag, position)?;
        if std::mem::replace(&mut self.declared[number as usize], true) {
            return Err(Fault::new(position, ErrorKind::DuplicateNode { tag }));
        }
        self.values[3 * number as usize..][..3].copy_from_slice(&point);
        if !self.ahead.is_empty() {
            self.ahead.remove(&number);
        }
        Ok(())
    }

    /// Adds an element, which is at `position`, by its nodes, given by tag and place.
    pub(super) fn element(&mut self, shape: Shape, nodes: &[(u64, Position)], position: Position) -> Result<(), Fault> {
        self.word.clear();
        for &(tag, position) in nodes {
            let number = self.number(tag, position)?;
            if !self.declared[number as usize] {
                self.ahead.entry(number).or_insert(position);
            }
            self.word.push(number);
        }
        let tag_of = |number: u32| {
            let at = self.word.iter().position(|&vertex| vertex == number);
            at.and_then(|at| nodes.get(at)).map_or(0, |&(tag, _)| tag)
        };
        let added = self.intake.element(shape, &self.word, tag_of);
        added.map_err(|refusal| Fault::new(position, refusal.kind(|number| tag_of(number).to_string())))
    }

    /// The soup, now that all nodes must be there.
    pub(super) fn finish(mut self) -> Result<(Soup, ReadReport), Fault> {
        let drops = self.intake.drops_bad();
        for (values, declared) in self.values.chunks_exact_mut(3).zip(&self.declared).filter(|_| drops) {
            if !declared {
                // Nowhere, like a node without finite coordinates.
                values.fill(f64::NAN);
            }
        }
        let first = self.ahead.iter().filter(|_| !drops).min_by_key(|(number, _)| **number);
        if let Some((&number, &position)) = first {
            let nodes = self.declared.iter().filter(|&&declared| declared).count() as u64;
            let tag = self.tags.label(number).parse().unwrap_or(0);
            return Err(Fault::new(position, ErrorKind::UnknownNode { tag, nodes }));
        }
        Ok(self.intake.finish(self.tags.into_labels(), true, Some((3, Scalars::F64(self.values)))))
    }
}
