//! Attributes on their way from an input into the soup: values at vertices, and at cells, which may become several
//! simplices or none.

use sig_core::Dim;

use super::ReadOptions;
use super::report::Ignored;
use crate::attribute::{Attribute, MOST_COMPONENTS, REFERENCE, Values};

/// What becomes of the attributes of an input.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Treatment {
    Keep,
    PassOver,
    /// They are named in the report, for the input is refused.
    Refuse,
}

/// Values at cells that are numbered one after the other.
struct OfCells {
    name: Box<str>,
    components: usize,
    values: Values,
    /// The number of the first of the cells.
    first: usize,
    /// What the format has for want of a value: a dimension with nothing else has no attribute.
    absent: Option<i64>,
}

/// The attributes of an input as far as it is read.
pub(super) struct Attributes {
    treatment: Treatment,
    of_vertices: Vec<Attribute>,
    of_cells: Vec<OfCells>,
    /// Of each simplex, by dimension, the number of the cell that it is or is a part of, where cells were numbered.
    origins: Vec<Vec<u32>>,
    /// The cell at hand.
    cell: Option<u32>,
    /// The names of those that are neither kept nor passed over.
    pub(super) refused: Vec<String>,
}

impl Attributes {
    pub(super) fn new(options: &ReadOptions<'_>) -> Self {
        let treatment = match (options.drop_attributes, options.spill.is_some()) {
            (true, _) => Treatment::PassOver,
            (false, true) => Treatment::Refuse,
            (false, false) => Treatment::Keep,
        };
        Self {
            treatment,
            of_vertices: Vec::new(),
            of_cells: Vec::new(),
            origins: Vec::new(),
            cell: None,
            refused: Vec::new(),
        }
    }

    /// Whether the reader is to hand in values; else only [their names](Self::pass_over).
    pub(super) fn are_kept(&self) -> bool {
        self.treatment == Treatment::Keep
    }

    /// Takes note of an attribute that is not kept.
    pub(super) fn pass_over(&mut self, name: &[u8], ignored: &mut Ignored) {
        if self.treatment == Treatment::Refuse {
            self.refused.push(String::from_utf8_lossy(name).into_owned());
        } else {
            ignored.note(name);
        }
    }

    /// Says that the simplices to come are of this cell, where attributes are kept.
    pub(super) fn begin_cell(&mut self, number: usize) {
        if self.are_kept() {
            self.cell = u32::try_from(number).ok();
        }
    }

    /// Takes in a simplex of the cell at hand.
    pub(super) fn push(&mut self, dim: Dim) {
        if let Some(cell) = self.cell {
            if self.origins.len() <= dim {
                self.origins.resize_with(dim + 1, Vec::new);
            }
            self.origins[dim].push(cell);
        }
    }

    /// Leaves only the simplices of a dimension that stay.
    pub(super) fn retain_origins(&mut self, dim: Dim, stays: &[bool]) {
        if let Some(origins) = self.origins.get_mut(dim).filter(|origins| !origins.is_empty()) {
            let mut each = stays.iter();
            origins.retain(|_| each.next() == Some(&true));
        }
    }

    /// Whether an attribute can be kept under its name and with as many components; notes it if not.
    fn has_room(&self, name: &str, components: usize, ignored: &mut Ignored) -> bool {
        let is_name = !name.is_empty() && name.len() <= usize::from(u16::MAX) && !name.contains('\0');
        let fits = is_name && (1..=MOST_COMPONENTS).contains(&components);
        if !fits {
            ignored.note(if name.is_empty() { b"an attribute without a name" } else { name.as_bytes() });
        }
        fits
    }

    /// Adds values at the vertices, a row for each.
    pub(super) fn add_of_vertices(&mut self, name: &str, components: usize, values: Values, ignored: &mut Ignored) {
        if !self.has_room(name, components, ignored) {
            return;
        }
        if self.of_vertices.iter().any(|attribute| *attribute.name == *name) {
            return ignored.note(format!("{name}, the second of that name").as_bytes());
        }
        self.of_vertices.push(Attribute { name: name.into(), dim: 0, components, values });
    }

    /// Adds values at the cells from number `first` on, a row for each.
    pub(super) fn add_of_cells(
        &mut self,
        name: &str,
        components: usize,
        values: Values,
        first: usize,
        ignored: &mut Ignored,
    ) {
        if self.has_room(name, components, ignored) {
            self.of_cells.push(OfCells { name: name.into(), components, values, first, absent: None });
        }
    }

    /// Adds the references of the vertices.
    pub(super) fn add_references_of_vertices(&mut self, references: References, ignored: &mut Ignored) {
        match (self.are_kept(), references.into_values()) {
            (_, None) => {}
            (true, Some((values, _))) => self.add_of_vertices(REFERENCE, 1, values, ignored),
            (false, Some(_)) => self.pass_over(REFERENCE.as_bytes(), ignored),
        }
    }

    /// Adds the references of the cells, from the first on.
    pub(super) fn add_references_of_cells(&mut self, references: References, ignored: &mut Ignored) {
        match (self.are_kept(), references.into_values()) {
            (_, None) => {}
            (true, Some((values, absent))) => {
                let absent = Some(absent);
                self.of_cells.push(OfCells { name: REFERENCE.into(), components: 1, values, first: 0, absent });
            }
            (false, Some(_)) => self.pass_over(REFERENCE.as_bytes(), ignored),
        }
    }

    /// The attributes by dimension and name; `vertices` are those of the 0-simplices, `stays` tells which of all vertices
    /// are left.
    pub(super) fn finish(
        mut self,
        num_vertices: usize,
        vertices: &[u32],
        stays: Option<&[bool]>,
        ignored: &mut Ignored,
    ) -> Vec<Attribute> {
        let mut all = std::mem::take(&mut self.of_vertices);
        let mut empty = Vec::new();
        for column in &self.of_cells {
            for dim in 0..self.origins.len() {
                let Some((spread, rows)) = self.spread(column, dim, num_vertices, vertices) else { continue };
                if !(0..rows.len()).any(|row| spread.has_value(row)) {
                    empty.push(spread);
                    continue;
                }
                match all.iter_mut().find(|there| there.dim == dim && there.name == spread.name) {
                    None => all.push(spread),
                    Some(there) => {
                        if !there.add_rows(&spread, &rows) {
                            let name = format!("{} of cells of dimension {dim}, as there is another", spread.name);
                            ignored.note(name.as_bytes());
                        }
                    }
                }
            }
        }
        // Cells of one dimension have no value where a format has columns for all and only others have some.
        for spread in empty {
            if all.iter().all(|there| there.name != spread.name) {
                all.push(spread);
            }
        }
        if let Some(stays) = stays {
            retain(&mut all, 0, stays);
        }
        all.sort_by(|a, b| (a.dim, &a.name).cmp(&(b.dim, &b.name)));
        all
    }

    /// Gives values at cells to the simplices of one dimension that come from them, and tells the cell of each; `None` if
    /// there are no such simplices.
    fn spread(
        &self,
        column: &OfCells,
        dim: Dim,
        num_vertices: usize,
        vertices: &[u32],
    ) -> Option<(Attribute, Vec<Option<usize>>)> {
        let OfCells { name, components, values, first, absent } = column;
        let num_cells = values.len() / components;
        let row_of = |&cell: &u32| (cell as usize).checked_sub(*first).filter(|&row| row < num_cells);
        let of_origins: Vec<Option<usize>> = self.origins[dim].iter().map(row_of).collect();
        if of_origins.iter().all(Option::is_none) {
            return None;
        }
        let rows = if dim > 0 {
            of_origins
        } else {
            // The first cell of each vertex.
            let mut rows = vec![None; num_vertices];
            for (&vertex, row) in vertices.iter().zip(of_origins) {
                let of_vertex = &mut rows[vertex as usize];
                *of_vertex = of_vertex.or(row);
            }
            rows
        };
        let spread = values.rows(*components, rows.iter().copied());
        let spread = Attribute { name: name.clone(), dim, components: *components, values: spread };
        (!absent.is_some_and(|absent| spread.values.are_all(absent))).then_some((spread, rows))
    }
}

/// Leaves of the attributes of a dimension only the rows that stay.
pub(super) fn retain(attributes: &mut [Attribute], dim: Dim, stays: &[bool]) {
    for attribute in attributes.iter_mut().filter(|attribute| attribute.dim == dim) {
        attribute.values.retain(attribute.components, stays);
    }
}

/// The one integer that a format has for each vertex or cell; takes no memory as long as it is the same as for want of one.
pub(super) struct References {
    absent: i64,
    /// How many were absent before the others.
    before: usize,
    values: Vec<i64>,
    /// Whether values are wanted, or only whether there are any.
    are_kept: bool,
    any: bool,
}

impl References {
    /// None yet, in a format that has `absent` where there is none.
    pub(super) const fn new(absent: i64, attributes: &Attributes) -> Self {
        let are_kept = matches!(attributes.treatment, Treatment::Keep);
        Self { absent, before: 0, values: Vec::new(), are_kept, any: false }
    }

    pub(super) fn push(&mut self, reference: i64) {
        self.any |= reference != self.absent;
        if !self.any {
            self.before += 1;
        } else if self.are_kept {
            if self.values.is_empty() {
                self.values = vec![self.absent; self.before];
            }
            self.values.push(reference);
        }
    }

    /// The values, and what stands for none; `None` if there is no other.
    fn into_values(self) -> Option<(Values, i64)> {
        self.any.then(|| (Values::from_integers(self.values), self.absent))
    }
}
