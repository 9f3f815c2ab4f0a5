//! The bodies of the fuzz targets. Each takes any bytes and panics on a bug; the tests replay the committed corpus.

use arbitrary::Unstructured;
use sig_core::format::{self, Container};
use sig_core::mcc::Mcc;
use sig_core::{AnyComplex, AnyTree, with_complex, with_tree};
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{read_cells, write_cells};
use sig_tools::incidence_graph::IncidenceGraph;
pub use sig_tools::io::Format;
pub use sig_tools::io::space::SpaceFormat;
use sig_tools::io::space::{Space, SpaceOptions, read_space_bytes};
use sig_tools::io::{ReadOptions, read_bytes};
use sig_tools::mcc::Strategy;
use sig_tools::soup::{Labels, Scalars, Soup};

use crate::conformance;
use crate::encode::{Options, encode, encode_tree};
use crate::mcc::{ask_mcc, file_of};
use crate::oracle::{Oracle, Word};
use crate::queries::{ask_everything, ask_tree, reseal};
use sig_tools::store::AlignedBytes;
use sig_tools::{View, with_view};

/// Simplices of which everything is asked.
const ASKED: usize = 48;

/// Simplices of a complex that is built from an input; larger ones are refused by the builder.
const BUILT: u64 = 2_000;

/// Opens the bytes as a file, and again with the header's checksum made to fit, and asks what was accepted everything.
pub fn open(bytes: &[u8]) {
    let mut buffer = AlignedBytes::from(bytes);
    open_one(&buffer);
    reseal(&mut buffer);
    if *buffer != *bytes {
        open_one(&buffer);
    }
}

fn open_one(bytes: &AlignedBytes) {
    let _ = format::verify(bytes);
    swap_twice(bytes);
    if let Ok(container) = Container::from_bytes(bytes) {
        assert!(container.sections().count() <= container.header().sections as usize);
    }
    match View::from_bytes(bytes) {
        // Vertices alone take no bytes in a SIG: of them there may be any number.
        Ok(view) if with_view!(view, complex => complex.num_simplices()) > 1 << 16 => {}
        Ok(View::Complex(any)) => with_complex!(any, complex => { ask_everything(&complex, ASKED); }),
        Ok(View::Tree(any)) => with_tree!(any, tree => { ask_tree(&tree, ASKED); }),
        Err(_) => {}
    }
}

/// Reads the bytes as a list of simplices, encodes the tree of their complex with some of its arrays overwritten by the
/// last bytes, and asks it everything; a tree that validation accepts is the complex that its words say.
///
/// # Panics
/// Where it is not.
pub fn tree(bytes: &[u8]) {
    let (list, damage) = bytes.split_at(bytes.len() - bytes.len() / 4);
    let oracle = Oracle::new(&simplices(list).unwrap_or_default());
    let lower = !bytes.len().is_multiple_of(3);
    let mut file = encode_tree(&oracle, &Options { lower, ..Options::default() });
    overwrite(&mut file, damage);
    let Ok(any) = AnyTree::from_bytes(&file) else { return };
    with_tree!(any, tree => {
        ask_tree(&tree, ASKED);
        if tree.validate().is_ok() {
            let word = |simplex| tree.vertices(simplex).map(sig_core::VertexId::index).collect::<Word>();
            let words: Vec<Word> = tree.simplices().map(word).collect();
            conformance::assert_tree_conforms(&tree, &Oracle::new(&words));
        }
    });
}

/// Opens the bytes as a multi-resolution complex, and again with the header's checksum made to fit, and asks what was accepted
/// everything. Then reads them as a list of simplices, simplifies their complex, and does the same of the file with some of its
/// arrays overwritten by the last bytes.
///
/// # Panics
/// Where an answer is wrong.
pub fn mcc(bytes: &[u8]) {
    let ask = |file: &AlignedBytes| {
        if let Ok(mcc) = Mcc::from_bytes(file) {
            ask_mcc(&mcc);
        }
    };
    let mut buffer = AlignedBytes::from(bytes);
    ask(&buffer);
    reseal(&mut buffer);
    if *buffer != *bytes {
        ask(&buffer);
    }
    let (list, damage) = bytes.split_at(bytes.len() - bytes.len() / 4);
    let strategy = if bytes.len().is_multiple_of(2) { Strategy::Step } else { Strategy::Batch };
    let mut file = file_of(&simplices(list).unwrap_or_default(), strategy);
    overwrite(&mut file, damage);
    ask(&file);
}

/// Overwrites bytes behind the table: of three bytes of damage the first two say which, the third what it becomes.
fn overwrite(file: &mut AlignedBytes, damage: &[u8]) {
    let arrays = Container::from_bytes(file).expect("a file that was just written").spans().next();
    let start = arrays.map_or(file.len(), |(_, _, range)| range.start);
    for change in damage.chunks_exact(3) {
        let at = start + usize::from(u16::from_le_bytes([change[0], change[1]])) % (file.len() - start).max(1);
        if let Some(byte) = file.get_mut(at) {
            *byte = change[2];
        }
    }
}

fn swap_twice(bytes: &AlignedBytes) {
    let mut swapped = bytes.clone();
    match format::swap_byte_order(&mut swapped) {
        Ok(()) => {
            format::swap_byte_order(&mut swapped).expect("what was swapped can be swapped back");
            assert_eq!(&swapped, bytes, "swapping twice is nothing");
        }
        Err(_) => assert_eq!(&swapped, bytes, "a failed swap changes nothing"),
    }
}

/// Reads the bytes as a list of simplices, builds their complex in both ways, encodes it, and compares all relations with
/// the oracle.
///
/// # Panics
/// Where they differ.
pub fn roundtrip(bytes: &[u8]) {
    let simplices = simplices(bytes).unwrap_or_default();
    let oracle = Oracle::new(&simplices);
    let options = Options { tree: bytes.len().is_multiple_of(2), checksums: true, ..Options::default() };
    let file = encode(&oracle, &options);
    format::verify(&file).expect("a file that was just written");
    let any = AnyComplex::from_bytes(&file).expect("a file that was just written");
    with_complex!(any, complex => {
        complex.validate().expect("a complex");
        conformance::assert_conforms(&complex, &oracle);
    });

    let mut soup = Soup::new(Labels::Numbered(10), false);
    for simplex in &simplices {
        soup.push(&simplex.iter().map(|&vertex| u32::try_from(vertex).expect("a digit")).collect::<Vec<_>>());
    }
    build_in_both_ways(&soup);
}

/// Up to 12 simplices on up to 10 vertices, of dimension up to 4.
///
/// # Errors
/// When the bytes are spent.
pub fn simplices(bytes: &[u8]) -> arbitrary::Result<Vec<Word>> {
    let mut source = Unstructured::new(bytes);
    let mut simplices = Vec::new();
    while !source.is_empty() && simplices.len() < 12 {
        let size = source.int_in_range(1..=5)?;
        let mut word = (0..size).map(|_| source.int_in_range(0..=9)).collect::<arbitrary::Result<Word>>()?;
        word.sort_unstable();
        word.dedup();
        simplices.push(word);
    }
    Ok(simplices)
}

/// Reads the bytes as an input of the given format, or of the one that its content tells, and builds what they hold.
///
/// # Panics
/// If the soup is malformed, or the two ways of building it differ.
pub fn read(format: Option<Format>, bytes: &[u8]) {
    for drop_degenerate in [false, true] {
        let options = ReadOptions { format, drop_degenerate, ..ReadOptions::default() };
        match read_bytes(bytes, "input", &options) {
            Ok((soup, report)) => {
                assert_sound(&soup, bytes.len(), report.format, report.compression.is_some());
                build_in_both_ways(&soup);
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// The same, with the format named by the first line.
pub fn read_named(bytes: &[u8]) {
    if let Some(end) = bytes.iter().position(|&byte| byte == b'\n')
        && let Some(format) = std::str::from_utf8(&bytes[..end]).ok().and_then(Format::from_name)
    {
        read(Some(format), &bytes[end + 1..]);
    }
}

/// Vertex numbers inside the table of labels, whole simplices without repetitions, and no more of anything than the
/// bytes can have held.
fn assert_sound(soup: &Soup, bytes: usize, format: Format, is_compressed: bool) {
    let vertices = soup.labels.len();
    for (dim, flat) in soup.simplices.iter().enumerate() {
        assert!(flat.len().is_multiple_of(dim + 1), "a part of a {dim}-simplex");
        for word in flat.chunks_exact(dim + 1) {
            let mut sorted = word.to_vec();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), dim + 1, "{word:?} repeats a vertex");
            assert!(sorted.last().is_none_or(|&last| (last as usize) < vertices), "{word:?} of {vertices} vertices");
        }
    }
    if let Some(coordinates) = &soup.coordinates {
        let values = match &coordinates.values {
            Scalars::F32(values) => values.len(),
            Scalars::F64(values) => values.len(),
        };
        assert_eq!(values, vertices * coordinates.dim, "{} coordinates a vertex", coordinates.dim);
    }
    // A vertex takes a byte at least; gzip a thousandth, xz and zstd a ten thousandth of what they hold at best.
    // VTK's XML may compress its arrays by zlib.
    let most = match (is_compressed, format) {
        (true, _) => 40_000,
        (false, Format::Vtu) => 100,
        (false, _) => 1,
    };
    assert!(vertices <= most * (bytes + 1), "{vertices} vertices in {bytes} bytes");
}

/// Builds a soup, and by Algorithms 1 to 3 from an incidence graph: both the same, or both refused.
fn build_in_both_ways(soup: &Soup) {
    let options = BuildOptions { max_simplices: Some(BUILT), ..BuildOptions::default() };
    let built = build(soup.clone(), &options);
    if built.as_ref().is_ok_and(|built| match &built.arrays {
        sig_tools::build::Arrays::Narrow(arrays) => arrays.num_simplices > 300,
        sig_tools::build::Arrays::Wide(_) => true,
    }) {
        return;
    }
    match (built, IncidenceGraph::new(soup, &options)) {
        (Ok(built), Ok(graph)) => assert_eq!(built.arrays, graph.build_sig()),
        (Err(_), _) => {}
        (Ok(_), Err(error)) => panic!("built, but not as an incidence graph: {error}"),
    }
}

/// Reads the bytes as a cell complex in text, and what was read again from the text in which it is written.
///
/// # Panics
/// If what is read is no cell complex, or is another one when it is read again.
pub fn cells(bytes: &[u8]) {
    match read_cells(bytes, "input") {
        Ok(complex) => {
            complex.check().expect("what was read is a complex");
            // Vertices have no lines: of many, the text alone would be no larger than this, but all that is made of it.
            if complex.num_cells() > 1 << 16 {
                return;
            }
            let mut text = Vec::new();
            write_cells(&complex, &mut text).expect("writing into memory");
            let copy = read_cells(&text[..], "copy").expect("what was just written");
            assert!(copy == complex, "written as\n{}", String::from_utf8_lossy(&text));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Reads the bytes as points, distances or a graph of the given format, or of the one that their content tells, and
/// what was read again from the text in which it is written.
///
/// # Panics
/// If what is read is no space, or is another one when it is read again.
pub fn space(format: Option<SpaceFormat>, bytes: &[u8]) {
    for is_graph in [false, true] {
        let options = SpaceOptions { format, is_graph, ..SpaceOptions::default() };
        match read_space_bytes(bytes, "input", &options) {
            Ok((space, report)) => {
                assert_eq!(format.unwrap_or(report.format), report.format);
                assert_space(&space, bytes.len(), report.compression.is_some());
                // Names in these may have blanks, which lists of edges do not hold.
                if matches!(report.format, SpaceFormat::Dot | SpaceFormat::GraphMl) {
                    continue;
                }
                let (format, text) = written(&space, report.format);
                let options = SpaceOptions { format: Some(format), ..SpaceOptions::default() };
                let (copy, _) = read_space_bytes(text.as_bytes(), "copy", &options).expect("what was just written");
                // Text without rows does not say how many coordinates they would have.
                if !matches!(&space, Space::Points(points) if points.is_empty()) {
                    assert_eq!(copy, space, "written as {format}:\n{text}");
                }
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// The same, with the format chosen by the first byte.
pub fn space_of_each_format(bytes: &[u8]) {
    if let [first, rest @ ..] = bytes {
        space(Some(SpaceFormat::ALL[usize::from(*first) % SpaceFormat::ALL.len()]), rest);
    }
}

/// Finite numbers, distances and weights not negative, every vertex with a label, and no more points than the bytes can
/// have held.
fn assert_space(space: &Space, bytes: usize, is_compressed: bool) {
    let is_distance = |value: &f64| value.is_finite() && *value >= 0.0;
    let points = match space {
        Space::Points(points) => {
            assert!(points.values().iter().all(|value| value.is_finite()));
            assert_eq!(points.values().len(), points.len() * points.dim());
            points.len()
        }
        Space::Distances(distances) => {
            assert!((0..distances.len()).all(|point| distances.row(point).iter().all(is_distance)));
            distances.len()
        }
        Space::Graph { graph, labels } => {
            assert_eq!(labels.len(), graph.num_vertices(), "labels");
            for vertex in 0..graph.num_vertices() {
                let upper = graph.upper_neighbours(vertex);
                assert!(upper.is_sorted_by(|a, b| a < b), "the neighbours of {vertex}: {upper:?}");
                assert!(upper.first().is_none_or(|&first| first as usize > vertex));
                assert!(upper.last().is_none_or(|&last| (last as usize) < graph.num_vertices()));
            }
            // The entries of a sparse matrix name points by number, and none need be named but the last.
            graph.num_vertices().saturating_sub(1 << 22)
        }
    };
    // Gzip takes about a thousandth at best, xz and zstd a ten thousandth.
    let most = if is_compressed { 40_000 } else { 1 };
    assert!(points <= most * (bytes + 1), "{points} points in {bytes} bytes");
}

/// A space in a text format that says all of it; of a graph that was read as `read` the one that can.
fn written(space: &Space, read: SpaceFormat) -> (SpaceFormat, String) {
    let row = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ") + "\n";
    match space {
        Space::Points(points) => {
            (SpaceFormat::Points, (0..points.len()).map(|point| row(points.point(point))).collect())
        }
        Space::Distances(distances) => {
            (SpaceFormat::Lower, (0..distances.len()).map(|point| row(distances.row(point))).collect())
        }
        Space::Graph { graph, labels } => {
            let format = if read == SpaceFormat::Dipha { SpaceFormat::Sparse } else { read };
            let label = |vertex: usize| match labels {
                Labels::Numbered(_) => vertex.to_string(),
                Labels::Integers(labels) => labels[vertex].to_string(),
                // Quotes keep those that are part of the label.
                Labels::Tokens(labels) => format!("\"{}\"", labels[vertex]),
            };
            let mut text = String::new();
            for vertex in 0..graph.num_vertices() {
                text += &match format {
                    SpaceFormat::Gudhi => format!("0 {} {}\n", label(vertex), graph.vertex_weight(vertex)),
                    SpaceFormat::Sparse if vertex + 1 < graph.num_vertices() => String::new(),
                    SpaceFormat::Sparse => format!("{vertex} {vertex} 0\n"),
                    _ => label(vertex) + "\n",
                };
                for edge in graph.edges_of(vertex) {
                    let other = graph.upper_neighbours(vertex)[edge - graph.edges_of(vertex).start] as usize;
                    let weight = if graph.is_weighted() { graph.weight(edge).to_string() } else { String::new() };
                    let dim = if format == SpaceFormat::Gudhi { "1 " } else { "" };
                    text += &format!("{dim}{} {} {weight}\n", label(vertex), label(other));
                }
            }
            (format, text)
        }
    }
}
