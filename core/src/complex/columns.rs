//! What a complex carries beside its relations: labels, coordinates, orientations, filtration values, attributes.

use super::Complex;
use crate::format::{Column, Section, SectionKind};
use crate::id::{Dim, Index, VertexId};

/// What the caller's data call the vertices.
#[derive(Clone, Copy, Debug)]
pub enum Labels<'a> {
    /// Vertex `i` is called `i`.
    Numbered,
    /// Integers by vertex.
    Integers(&'a [u64]),
    /// Text by vertex: label `i` is `text[offsets[i]..offsets[i + 1]]`.
    Text {
        /// Where the labels start, and the length of them all at the end.
        offsets: &'a [u64],
        /// The labels, UTF-8, one after the other.
        text: &'a [u8],
    },
}

/// The label of one vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Label<'a> {
    /// An integer.
    Integer(u64),
    /// Text.
    Text(&'a str),
}

impl core::fmt::Display for Label<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Integer(label) => core::fmt::Display::fmt(label, f),
            Self::Text(label) => core::fmt::Display::fmt(label, f),
        }
    }
}

impl<'a> Labels<'a> {
    /// The label of a vertex; `None` past the end or if the text is not UTF-8.
    #[must_use]
    pub fn get(&self, vertex: VertexId) -> Option<Label<'a>> {
        let row = vertex.index();
        match self {
            Self::Numbered => Some(Label::Integer(row as u64)),
            Self::Integers(labels) => labels.get(row).copied().map(Label::Integer),
            Self::Text { offsets, text } => {
                let start = usize::try_from(*offsets.get(row)?).ok()?;
                let end = usize::try_from(*offsets.get(row.checked_add(1)?)?).ok()?;
                core::str::from_utf8(text.get(start..end)?).ok().map(Label::Text)
            }
        }
    }
}

impl<'a, I: Index> Complex<'a, I> {
    /// What the caller's data call the vertices.
    #[must_use]
    pub fn labels(&self) -> Labels<'a> {
        let column = |kind| self.container().section(kind).map(|section| section.column);
        match (column(SectionKind::IntegerLabels), column(SectionKind::LabelOffsets), column(SectionKind::LabelText)) {
            (Some(Column::U64(labels)), ..) => Labels::Integers(labels),
            (_, Some(Column::U64(offsets)), Some(Column::U8(text))) => Labels::Text { offsets, text },
            _ => Labels::Numbered,
        }
    }

    /// The coordinates of the vertices, row-major: as many components as the space has dimensions, single or double
    /// precision.
    #[must_use]
    pub fn coordinates(&self) -> Option<Section<'a>> {
        self.container().section(SectionKind::Coordinates)
    }

    /// The orientations: bit `i` is whether sorting the vertices of the `i`-th top simplex, in the order of the ids, was
    /// an odd permutation of the order in which the caller gave them.
    #[must_use]
    pub fn parity(&self) -> Option<Column<'a>> {
        self.container().section(SectionKind::Parity).map(|section| section.column)
    }

    /// The filtration value of each simplex.
    #[must_use]
    pub fn filtration(&self) -> Option<&'a [f64]> {
        match self.container().section(SectionKind::Filtration)?.column {
            Column::F64(values) => Some(values),
            _ => None,
        }
    }

    /// A named column over the simplices of one dimension.
    #[must_use]
    pub fn attribute(&self, dim: Dim, name: &str) -> Option<Section<'a>> {
        let attributes = self.container().sections().filter(|section| section.kind == SectionKind::Attribute);
        attributes.into_iter().find(|section| section.dim == Some(dim) && section.name == name)
    }

    /// Where the complex comes from, in its maker's words.
    #[must_use]
    pub fn provenance(&self) -> Option<&'a str> {
        match self.container().section(SectionKind::Provenance)?.column {
            Column::U8(text) => core::str::from_utf8(text).ok(),
            _ => None,
        }
    }
}
