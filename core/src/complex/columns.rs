//! What the vertices are called: [`Labels`].

use crate::format::{Column, Container, SectionKind};
use crate::id::VertexId;

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
    /// The labels in a file.
    pub(crate) fn of(container: &Container<'a>) -> Self {
        let column = |kind| container.section(kind).map(|section| section.column);
        match (column(SectionKind::IntegerLabels), column(SectionKind::LabelOffsets), column(SectionKind::LabelText)) {
            (Some(Column::U64(labels)), ..) => Self::Integers(labels),
            (_, Some(Column::U64(offsets)), Some(Column::U8(text))) => Self::Text { offsets, text },
            _ => Self::Numbered,
        }
    }

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
