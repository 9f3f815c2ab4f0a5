//! What a reader has to say about an input that it accepted.

use super::{Compression, Format};

/// What was found in an input, and what became of it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadReport {
    /// The format in which the input was read.
    pub format: Format,
    /// How the input was compressed, if it was.
    pub compression: Option<Compression>,
    /// The number of vertices.
    pub vertices: usize,
    /// The number of simplices in the soup by dimension, repeated ones included.
    pub simplices: Vec<usize>,
    /// Polygons of more than three vertices, split into triangles.
    pub polygons: usize,
    /// Polyhedra other than tetrahedra, split into tetrahedra.
    pub polyhedra: usize,
    /// Triangles and tetrahedra that polygons and polyhedra were split into.
    pub split_into: usize,
    /// Simplices dropped because they repeat a vertex.
    pub degenerate_dropped: usize,
    /// Cells dropped because they name a vertex that is not there, and simplices at vertices that were dropped.
    pub bad_cells_dropped: usize,
    /// Vertices dropped because they have no finite coordinates.
    pub bad_vertices_dropped: usize,
    /// The first few things that were dropped, each with its place or name, and why: what follows the name of the input.
    pub bad: Vec<String>,
    /// Facet corners (STL), and vertices if so told, that were welded to an earlier one.
    pub welded: usize,
    /// Vertices with other attributes than the one that they were welded to, whose attributes stay.
    pub welded_differing: usize,
    /// Nodes left out because they lie inside edges, faces or volumes of higher-order elements, whose corners alone
    /// are vertices (MSH).
    pub inner_nodes_dropped: usize,
    /// The names of the attributes that are not kept, for the simplices are not in memory.
    pub(super) refused_attributes: Vec<String>,
    /// Parts of the input that the reader does not know or does not use.
    pub ignored: Ignored,
}

impl ReadReport {
    pub(super) fn new(format: Format) -> Self {
        Self {
            format,
            compression: None,
            vertices: 0,
            simplices: Vec::new(),
            polygons: 0,
            polyhedra: 0,
            split_into: 0,
            degenerate_dropped: 0,
            bad_cells_dropped: 0,
            bad_vertices_dropped: 0,
            bad: Vec::new(),
            welded: 0,
            welded_differing: 0,
            inner_nodes_dropped: 0,
            refused_attributes: Vec::new(),
            ignored: Ignored::default(),
        }
    }
}

impl ReadReport {
    /// How many of the things that were dropped are named.
    pub(super) const MOST_NAMED: usize = 8;

    /// Names something that was dropped.
    pub(super) fn note_bad(&mut self, what: String) {
        if self.bad.len() < Self::MOST_NAMED {
            self.bad.push(what);
        }
    }
}

/// Parts of an input that were passed over: keywords, elements, properties, sections.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Ignored {
    /// How many times something was passed over.
    pub count: u64,
    /// The names of the first few, each once, in the order of the input.
    pub names: Vec<String>,
}

impl Ignored {
    /// How many names are kept, and how much of each.
    const MOST: usize = 8;
    const LONGEST: usize = 64;

    pub(super) fn note(&mut self, name: &[u8]) {
        self.count += 1;
        if self.names.len() < Self::MOST {
            let name = name[..name.len().min(Self::LONGEST)].escape_ascii().to_string();
            if !self.names.contains(&name) {
                self.names.push(name);
            }
        }
    }
}
