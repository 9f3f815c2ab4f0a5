//! From an oracle to the bytes of a file, element by element as `FORMAT.md` defines it: a second implementation with
//! which the builder is compared byte for byte.

use sig_core::format::{Column, Encoder, Kind, Section, SectionKind, swap_byte_order};
use sig_core::{Dim, IndexWidth};

use crate::oracle::Oracle;
use sig_tools::store::AlignedBytes;

/// Integers of one of the three widths.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Integers {
    /// 16 bits.
    U16(Vec<u16>),
    /// 32 bits.
    U32(Vec<u32>),
    /// 64 bits.
    U64(Vec<u64>),
}

impl Integers {
    /// The values at a width; `None` stands for the stop code.
    ///
    /// # Panics
    /// If a value is the stop code of the width or more.
    #[must_use]
    pub fn new(width: IndexWidth, values: &[Option<usize>]) -> Self {
        let code = |value: Option<usize>| match value {
            None => width.max_value() + 1,
            Some(value) => {
                assert!(value as u64 <= width.max_value(), "{value} does not fit");
                value as u64
            }
        };
        let codes = values.iter().map(|&value| code(value));
        match width {
            IndexWidth::Bits16 => Self::U16(codes.map(|code| u16::try_from(code).unwrap()).collect()),
            IndexWidth::Bits32 => Self::U32(codes.map(|code| u32::try_from(code).unwrap()).collect()),
            IndexWidth::Bits64 => Self::U64(codes.collect()),
        }
    }

    /// The integers as a column.
    #[must_use]
    pub fn column(&self) -> Column<'_> {
        match self {
            Self::U16(values) => Column::U16(values),
            Self::U32(values) => Column::U32(values),
            Self::U64(values) => Column::U64(values),
        }
    }
}

/// Bits, least significant first.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Bits {
    bytes: Vec<u8>,
    len: usize,
}

impl Bits {
    /// The bits as a column.
    #[must_use]
    pub fn column(&self) -> Column<'_> {
        Column::Bits { bytes: &self.bytes, len: self.len }
    }
}

impl FromIterator<bool> for Bits {
    fn from_iter<T: IntoIterator<Item = bool>>(bits: T) -> Self {
        let mut collected = Self::default();
        for bit in bits {
            if collected.len % 8 == 0 {
                collected.bytes.push(0);
            }
            collected.bytes[collected.len / 8] |= u8::from(bit) << (collected.len % 8);
            collected.len += 1;
        }
        collected
    }
}

/// What the input calls the vertices.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub enum Names {
    /// Their numbers.
    #[default]
    Numbered,
    /// Integers.
    Integers(Vec<u64>),
    /// Text.
    Text(Vec<String>),
}

/// What a file holds beside the five arrays.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Options {
    /// The index width; the least that fits if `None`.
    pub width: Option<IndexWidth>,
    /// Child offsets and last vertices; a file of kind tree has them in any case.
    pub tree: bool,
    /// The lower neighbours of the vertices.
    pub lower: bool,
    /// The pairs of 7.4 in place of the lists at the (d−1)-simplices, in dimension 1 and more.
    pub pairs: bool,
    /// Block checksums.
    pub checksums: bool,
    /// Labels of the vertices.
    pub names: Names,
    /// Components a vertex, and coordinates.
    pub coordinates: Option<(u32, Vec<f64>)>,
    /// Orientation of each top simplex.
    pub parity: Option<Vec<bool>>,
    /// Filtration value of each simplex.
    pub filtration: Option<Vec<f64>>,
    /// Columns, each with dimension, name and one value a simplex, in the order of (dimension, name).
    pub attributes: Vec<(Dim, String, Vec<f64>)>,
    /// Where the complex comes from.
    pub provenance: Option<String>,
}

impl Options {
    /// Only the paper's arrays, at the given width.
    #[must_use]
    pub fn bare(width: IndexWidth) -> Self {
        Self { width: Some(width), ..Self::default() }
    }

    /// Every optional section of a SIG, filled with something that is easy to tell apart.
    ///
    /// # Panics
    /// If the complex has more than 2^32 simplices.
    #[must_use]
    pub fn everything(oracle: &Oracle, width: IndexWidth) -> Self {
        let number = |simplex: usize| f64::from(u32::try_from(simplex).unwrap());
        let vertices = oracle.of_dim(0).len();
        let attribute = |dim: Dim| oracle.of_dim(dim).iter().map(|&simplex| number(simplex) / 2.0).collect();
        Self {
            width: Some(width),
            tree: true,
            lower: true,
            pairs: false,
            checksums: true,
            names: Names::Text((0..vertices).map(|vertex| format!("vertex {vertex} ä")).collect()),
            coordinates: Some((3, (0..3 * vertices).map(|at| number(at) - 0.5).collect())),
            parity: Some(oracle.tops().iter().map(|top| top % 3 == 0).collect()),
            filtration: Some((0..oracle.len()).map(|simplex| number(oracle.dim(simplex))).collect()),
            attributes: (0..oracle.dims()).map(|dim| (dim, format!("weight {dim}"), attribute(dim))).collect(),
            provenance: Some("made by hand".to_owned()),
        }
    }
}

/// The least width for every id, list offset and vertex of the complex.
///
/// # Panics
/// Never: no complex in memory needs more than 64 bits.
#[must_use]
pub fn least_width(oracle: &Oracle) -> IndexWidth {
    least_width_of(&Arrays::new(oracle, false), oracle)
}

fn least_width_of(arrays: &Arrays, oracle: &Oracle) -> IndexWidth {
    let largest_offset = arrays.pointers.iter().flatten().copied().max().unwrap_or(0);
    let largest_id = oracle.len().saturating_sub(1);
    IndexWidth::least_for(largest_id.max(largest_offset) as u64).expect("64 bits are enough")
}

/// The five arrays of sig-2004, 4.2, and the optional ones of the simplex tree; `None` is the stop code.
struct Arrays {
    lookup: Vec<Option<usize>>,
    boundary: Vec<Option<usize>>,
    pointers: Vec<Option<usize>>,
    lists: Vec<Option<usize>>,
    pairs: Vec<Option<usize>>,
    flags: Vec<bool>,
    child_offsets: Vec<Option<usize>>,
    last_vertices: Vec<Option<usize>>,
    lower_offsets: Vec<Option<usize>>,
    lower_neighbours: Vec<Option<usize>>,
}

impl Arrays {
    fn new(oracle: &Oracle, in_pairs: bool) -> Self {
        let top_dim = oracle.dims().saturating_sub(1);
        let below_top = || (0..oracle.len()).filter(|&simplex| oracle.dim(simplex) < top_dim);
        let lookup = (0..oracle.dims()).map(|dim| oracle.of_dim(dim).first().copied()).collect();
        let mut boundary = Vec::new();
        for simplex in (0..oracle.len()).filter(|&simplex| oracle.dim(simplex) > 0) {
            boundary.extend((0..=oracle.dim(simplex)).map(|position| Some(oracle.facet(simplex, position))));
        }
        let (mut pointers, mut lists, mut pairs, mut flags) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for simplex in below_top() {
            let entries = oracle.partial_coboundary(simplex);
            if in_pairs && oracle.dim(simplex) + 1 == top_dim {
                assert!(entries.len() <= 2, "no room in a pair");
                pairs.extend([entries.first().copied(), entries.get(1).copied()]);
                continue;
            }
            let flag = oracle.is_single_cluster(simplex);
            flags.push(flag);
            if flag {
                pointers.push(Some(entries[0]));
            } else {
                pointers.push(Some(lists.len()));
                lists.extend(entries.into_iter().map(Some));
                lists.push(None);
            }
        }
        // The children come in the order of their parents, so those of all simplices before one come before its own.
        let children_of = |simplex: usize| oracle.children(simplex).len();
        let mut child = oracle.of_dim(0).len();
        let mut child_offsets = Vec::new();
        for simplex in below_top() {
            child_offsets.push(Some(child));
            child += children_of(simplex);
        }
        if !oracle.is_empty() {
            child_offsets.push(Some(oracle.len()));
        }
        let last_vertices = oracle.words().iter().map(|word| word.last().copied()).collect();
        let (mut lower_offsets, mut lower_neighbours) = (vec![Some(0)], Vec::new());
        for vertex in oracle.of_dim(0) {
            let lower = oracle.adjacency(vertex).into_iter().filter(|&other| other < vertex);
            lower_neighbours.extend(lower.map(Some));
            lower_offsets.push(Some(lower_neighbours.len()));
        }
        Self {
            lookup,
            boundary,
            pointers,
            lists,
            pairs,
            flags,
            child_offsets,
            last_vertices,
            lower_offsets,
            lower_neighbours,
        }
    }
}

/// A complex as a SIG, in the byte order of the host.
///
/// # Panics
/// If the complex does not fit in the width, or the options do not fit the complex.
#[must_use]
pub fn encode(oracle: &Oracle, options: &Options) -> AlignedBytes {
    in_host_order(encode_file(oracle, options))
}

/// The file of a complex, a SIG.
///
/// # Panics
/// If the complex does not fit in the width, or the options do not fit the complex.
#[must_use]
pub fn encode_file(oracle: &Oracle, options: &Options) -> AlignedBytes {
    encode_kind(
        Kind::Sig,
        oracle,
        options.width.unwrap_or_else(|| least_width_of(&Arrays::new(oracle, options.pairs), oracle)),
        options,
    )
}

/// A complex as a simplex tree, in the byte order of the host.
///
/// # Panics
/// If the complex does not fit in the width, or the options do not fit the complex.
#[must_use]
pub fn encode_tree(oracle: &Oracle, options: &Options) -> AlignedBytes {
    in_host_order(encode_tree_file(oracle, options))
}

/// A file in the byte order of the host.
///
/// # Panics
/// If it is none.
#[must_use]
pub fn in_host_order(mut file: AlignedBytes) -> AlignedBytes {
    if cfg!(target_endian = "big") {
        swap_byte_order(&mut file).unwrap();
    }
    file
}

/// The file of a complex, a simplex tree.
///
/// # Panics
/// If the complex does not fit in the width, or the options do not fit the complex.
#[must_use]
pub fn encode_tree_file(oracle: &Oracle, options: &Options) -> AlignedBytes {
    let largest = oracle.len().saturating_sub(1) as u64;
    let least = IndexWidth::least_for(largest).expect("64 bits are enough");
    encode_kind(Kind::Tree, oracle, options.width.unwrap_or(least), options)
}

fn encode_kind(kind: Kind, oracle: &Oracle, width: IndexWidth, options: &Options) -> AlignedBytes {
    let arrays = Arrays::new(oracle, options.pairs);
    let vertices = oracle.of_dim(0).len();
    let index = |values: &[Option<usize>]| Integers::new(width, values);
    let (lookup, boundary) = (index(&arrays.lookup), index(&arrays.boundary));
    let (pointers, lists) = (index(&arrays.pointers), index(&arrays.lists));
    let flags: Bits = arrays.flags.iter().copied().collect();
    let mut sections = vec![Section::new(SectionKind::Lookup, lookup.column())];
    if kind == Kind::Sig {
        sections.push(Section::new(SectionKind::Boundary, boundary.column()));
        sections.push(Section::new(SectionKind::Pointers, pointers.column()));
        sections.push(Section::new(SectionKind::Lists, lists.column()));
        sections.push(Section::new(SectionKind::Flags, flags.column()));
    }

    let label_width = IndexWidth::least_for(vertices as u64).unwrap();
    let offsets = index(&arrays.child_offsets);
    let last = Integers::new(label_width, &arrays.last_vertices);
    if options.tree || kind == Kind::Tree {
        sections.push(Section::new(SectionKind::ChildOffsets, offsets.column()));
        sections.push(Section::new(SectionKind::LastVertices, last.column()));
    }

    let (mut label_offsets, mut label_text) = (vec![0], String::new());
    match &options.names {
        Names::Numbered => {}
        Names::Integers(labels) => sections.push(Section::new(SectionKind::IntegerLabels, Column::U64(labels))),
        Names::Text(labels) => {
            for label in labels {
                label_text += label;
                label_offsets.push(label_text.len() as u64);
            }
            sections.push(Section::new(SectionKind::LabelOffsets, Column::U64(&label_offsets)));
            sections.push(Section::new(SectionKind::LabelText, Column::U8(label_text.as_bytes())));
        }
    }
    if let Some((components, values)) = &options.coordinates {
        let column = Column::F64(values);
        sections.push(Section { components: *components, ..Section::new(SectionKind::Coordinates, column) });
    }
    let parity: Option<Bits> = options.parity.as_ref().map(|bits| bits.iter().copied().collect());
    if let Some(parity) = &parity {
        sections.push(Section::new(SectionKind::Parity, parity.column()));
    }
    if let Some(values) = &options.filtration {
        sections.push(Section::new(SectionKind::Filtration, Column::F64(values)));
    }
    for (dim, name, values) in &options.attributes {
        let section = Section::new(SectionKind::Attribute, Column::F64(values));
        sections.push(Section { dim: Some(*dim), name, ..section });
    }
    if let Some(text) = &options.provenance {
        sections.push(Section::new(SectionKind::Provenance, Column::U8(text.as_bytes())));
    }
    let lower_offsets = index(&arrays.lower_offsets);
    let lower_neighbours = Integers::new(label_width, &arrays.lower_neighbours);
    if options.lower {
        sections.push(Section::new(SectionKind::LowerOffsets, lower_offsets.column()));
        sections.push(Section::new(SectionKind::LowerNeighbours, lower_neighbours.column()));
    }
    let pairs = index(&arrays.pairs);
    if options.pairs && oracle.dims() > 1 {
        sections.push(Section::new(SectionKind::Pairs, pairs.column()));
    }
    let encoder = Encoder::new(kind, width, oracle.dims(), oracle.len() as u64, &sections).unwrap();
    let encoder = if options.checksums { encoder.with_checksums().unwrap() } else { encoder };
    let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
    let written = encoder.encode(&mut bytes).unwrap();
    assert_eq!(written, bytes.len());
    bytes
}
