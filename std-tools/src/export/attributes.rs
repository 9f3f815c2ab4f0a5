//! The attributes of a complex as formats have them: columns at vertices, and columns at cells of all dimensions.

use std::io::{self, Write};

use sig_core::format::{Column, Section, SectionKind};
use sig_core::{Dim, Relations};

use crate::attribute::{Number, REFERENCE};

/// The dimensions that formats of cells have, from 0.
const DIMS: usize = 4;

/// A column at the vertices or at cells, whose rows are those of the simplices of each dimension, from the first.
#[derive(Clone, Copy)]
pub(super) struct Attribute<'v> {
    pub(super) name: &'v str,
    pub(super) components: usize,
    /// The numbers of each dimension that has some; all of one type.
    columns: [Option<Column<'v>>; DIMS],
}

impl<'v> Attribute<'v> {
    /// The attributes of a complex, at the vertices and at cells of dimension up to `max_dim`; and the names of those that
    /// have no place: of larger simplices, or of another type than those of the same name.
    pub(super) fn all(complex: &'v impl Relations, max_dim: Dim) -> (Vec<Self>, Vec<Self>, Vec<&'v str>) {
        let (mut vertices, mut cells, mut left_out) = (Vec::new(), Vec::<Self>::new(), Vec::new());
        let is_attribute = |section: &Section<'_>| section.kind == SectionKind::Attribute;
        for Section { name, dim, components, column, .. } in complex.container().sections().filter(is_attribute) {
            let (dim, components) = (dim.unwrap_or(usize::MAX), components as usize);
            let mut one = Self { name, components, columns: [None; DIMS] };
            let fits = dim <= max_dim && !matches!(column, Column::Bits { .. });
            let Some(place) = one.columns.get_mut(dim).filter(|_| fits) else {
                left_out.push(name);
                continue;
            };
            *place = Some(column);
            if dim == 0 {
                vertices.push(one);
                continue;
            }
            match cells.iter_mut().find(|other| other.name == name) {
                None => cells.push(one),
                Some(other) if other.is_like(&one) => other.columns[dim] = Some(column),
                Some(_) => left_out.push(name),
            }
        }
        // What is said of a vertex is said of a cell of dimension 0.
        for cell in &mut cells {
            if let Some(vertex) = vertices.iter().find(|vertex| vertex.name == cell.name && vertex.is_like(cell)) {
                cell.columns[0] = vertex.columns[0];
            }
        }
        (vertices, cells, left_out)
    }

    /// Whether two have the same type and as many components.
    fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(&self.column()) == std::mem::discriminant(&other.column())
            && self.components == other.components
    }

    /// Some of its numbers, for their type.
    pub(super) fn column(&self) -> Column<'v> {
        self.columns.iter().flatten().next().copied().unwrap_or(Column::U8(&[]))
    }

    /// Whether cells of a dimension have it.
    pub(super) fn is_of(&self, dim: Dim) -> bool {
        self.columns.get(dim).is_some_and(Option::is_some)
    }

    /// The number of a component of a simplex, by dimension and place in it; `None` where there is none.
    pub(super) fn number(&self, dim: Dim, row: usize, component: usize) -> Option<Number> {
        let at = row * self.components + component;
        let integer = |value: i128| Some(Number::Integer(value));
        match (*self.columns.get(dim)?)? {
            Column::U8(values) => integer((*values.get(at)?).into()),
            Column::U16(values) => integer((*values.get(at)?).into()),
            Column::U32(values) => integer((*values.get(at)?).into()),
            Column::U64(values) => integer((*values.get(at)?).into()),
            Column::I32(values) => integer((*values.get(at)?).into()),
            Column::I64(values) => integer((*values.get(at)?).into()),
            Column::F32(values) => Some(Number::Float((*values.get(at)?).into())),
            Column::F64(values) => Some(Number::Float(*values.get(at)?)),
            Column::Bits { .. } => None,
        }
    }

    /// The numbers of a simplex, in double precision; NaN where there are none.
    #[expect(clippy::cast_precision_loss, reason = "the caller says so")]
    pub(super) fn doubles(&self, dim: Dim, row: usize) -> impl Iterator<Item = f64> {
        (0..self.components).map(move |component| match self.number(dim, row, component) {
            Some(Number::Integer(integer)) => integer as f64,
            Some(Number::Float(float)) => float,
            None => f64::NAN,
        })
    }

    /// Writes the numbers of a simplex as text, each after a blank, with as many digits as it takes to read them back.
    pub(super) fn write_text(&self, dim: Dim, row: usize, out: &mut dyn Write) -> io::Result<()> {
        for component in 0..self.components {
            match (self.number(dim, row, component), self.column()) {
                (Some(Number::Integer(integer)), _) => write!(out, " {integer}")?,
                #[expect(clippy::cast_possible_truncation, reason = "it was single before")]
                (Some(Number::Float(float)), Column::F32(_)) if float.is_finite() => {
                    write!(out, " {:?}", float as f32)?;
                }
                (Some(Number::Float(float)), _) => write_double(float, out)?,
                (None, Column::F32(_) | Column::F64(_)) => write_double(f64::NAN, out)?,
                (None, _) => write!(out, " 0")?,
            }
        }
        Ok(())
    }

    /// Writes the numbers of a simplex in binary, little-endian.
    #[expect(clippy::cast_possible_truncation, reason = "the numbers are of the types")]
    pub(super) fn write_binary(&self, dim: Dim, row: usize, out: &mut dyn Write) -> io::Result<()> {
        for component in 0..self.components {
            let (integer, float) = match self.number(dim, row, component) {
                Some(Number::Integer(integer)) => (integer, 0.0),
                Some(Number::Float(float)) => (0, float),
                None => (0, f64::NAN),
            };
            match self.column() {
                Column::F32(_) => out.write_all(&(float as f32).to_le_bytes())?,
                Column::F64(_) => out.write_all(&float.to_le_bytes())?,
                column => out.write_all(&integer.to_le_bytes()[..width(&column)])?,
            }
        }
        Ok(())
    }

    /// Bytes of the numbers of a simplex.
    pub(super) fn row_bytes(&self) -> usize {
        self.components * width(&self.column())
    }

    /// Whether it is the integer that formats with one for each vertex or cell have.
    pub(super) fn is_reference(&self) -> bool {
        self.name == REFERENCE && self.components == 1 && !matches!(self.column(), Column::F32(_) | Column::F64(_))
    }
}

/// Writes a number after a blank, as C libraries read it.
pub(super) fn write_double(float: f64, out: &mut dyn Write) -> io::Result<()> {
    if float.is_nan() { write!(out, " nan") } else { write!(out, " {float:?}") }
}

/// The bytes of a number.
const fn width(column: &Column<'_>) -> usize {
    match column {
        Column::Bits { .. } | Column::U8(_) => 1,
        Column::U16(_) => 2,
        Column::U32(_) | Column::I32(_) | Column::F32(_) => 4,
        Column::U64(_) | Column::I64(_) | Column::F64(_) => 8,
    }
}

/// What became of the attributes in an export.
#[derive(Default)]
pub(super) struct Losses<'v> {
    /// The names of those that are not there.
    pub(super) left_out: Vec<&'v str>,
    /// Of those that are not there in their type, but as other numbers.
    pub(super) converted: Vec<&'v str>,
}
