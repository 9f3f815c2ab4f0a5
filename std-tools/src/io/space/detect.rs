//! The format of an input: by what its first bytes say for certain, then by its name, then by the shape of its rows.

use super::super::Format;
use super::super::compression::without_suffix;
use super::super::detect as mesh;
use super::super::error::{ErrorKind, Fault, Position};
use super::super::gudhi;
use super::super::source::Source;
use super::super::text::{Line, Origin, parse_float};
use super::row::{COMMENT, fields};
use super::{SpaceFormat, binary, dot, graphml, npy};

/// The format of an input called `name`, which may be known to be a graph.
pub(super) fn format(source: &mut Source<'_>, name: &str, is_graph: bool) -> Result<SpaceFormat, Fault> {
    let length = source.whole_length()?;
    let head = source.head()?;
    mesh::refuse_complexes(head)?;
    let format = certain(head, length).or_else(|| by_name(name)).or_else(|| by_shape(head, length, is_graph));
    let format = format.ok_or_else(|| Fault::new(Position::Whole, ErrorKind::UnknownSpace))?;
    if !is_graph
        || matches!(
            format,
            SpaceFormat::Edges
                | SpaceFormat::Sparse
                | SpaceFormat::Dot
                | SpaceFormat::GraphMl
                | SpaceFormat::Gudhi
                | SpaceFormat::Dipha
        )
    {
        return Ok(format);
    }
    let message = format!(
        "this looks like `{format}`, and a graph is needed: `sig rips` makes a complex of points or distances, `sig build` of \
         simplices; --format says what else it is"
    );
    Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())))
}

/// The format of content that names it.
fn certain(head: &[u8], length: Option<u64>) -> Option<SpaceFormat> {
    if head.starts_with(npy::MAGIC) {
        Some(SpaceFormat::Npy)
    } else if head.starts_with(binary::PTS_MAGIC) {
        Some(SpaceFormat::Pts)
    } else if head.starts_with(&binary::DIPHA_MAGIC.to_le_bytes()) {
        Some(SpaceFormat::Dipha)
    } else if graphml::is_graphml(head) {
        Some(SpaceFormat::GraphMl)
    } else if dot::is_graph(head) {
        Some(SpaceFormat::Dot)
    } else {
        mesh::certain(head, length).map(|_| SpaceFormat::Mesh)
    }
}

/// The format that a name stands for; `.csv` and `.txt` stand for any text.
fn by_name(name: &str) -> Option<SpaceFormat> {
    const NAMES: [(&str, SpaceFormat); 15] = [
        ("lower_distance_matrix", SpaceFormat::Lower),
        ("upper_distance_matrix", SpaceFormat::Upper),
        ("sparse_distance_matrix", SpaceFormat::Sparse),
        ("distance_matrix", SpaceFormat::Full),
        ("sparse", SpaceFormat::Sparse),
        ("coo", SpaceFormat::Sparse),
        ("edges", SpaceFormat::Edges),
        ("edgelist", SpaceFormat::Edges),
        ("dot", SpaceFormat::Dot),
        ("gv", SpaceFormat::Dot),
        ("graphml", SpaceFormat::GraphMl),
        ("xyz", SpaceFormat::Points),
        ("npy", SpaceFormat::Npy),
        ("dipha", SpaceFormat::Dipha),
        ("pts", SpaceFormat::Points),
    ];
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name).to_ascii_lowercase();
    let file = without_suffix(&file);
    let mut extensions = file.split('.').skip(1);
    let found = |extension| NAMES.iter().find(|(name, _)| *name == extension).map(|&(_, format)| format);
    let by_mesh = || mesh::by_name(file).filter(|&format| format != Format::SimplexList).map(|_| SpaceFormat::Mesh);
    // As in `x.lower_distance_matrix.csv`.
    extensions.find_map(found).or_else(by_mesh)
}

/// The format that the first rows of a text look like.
fn by_shape(head: &[u8], length: Option<u64>, is_graph: bool) -> Option<SpaceFormat> {
    /// Rows that are looked at.
    const ROWS: usize = 64;
    let whole = length == Some(head.len() as u64);
    // Rows of vertices alone could as well be points.
    let is_gudhi = |dims: Vec<usize>| dims.contains(&0) && (is_graph || dims.iter().any(|&dim| dim > 0));
    if gudhi::dimensions(head, whole).is_some_and(is_gudhi) {
        return Some(SpaceFormat::Gudhi);
    }
    let begins_empty = head.starts_with(b"\n") || head.starts_with(b"\r\n");
    let mut lines: Vec<&[u8]> = head.split(|&byte| byte == b'\n').collect();
    if !whole && lines.len() > 1 {
        // The last is cut off.
        lines.pop();
    }
    let has_content = |line: &&[u8]| !matches!(line.trim_ascii_start(), [] | [b'#', ..]);
    let rows: Option<Vec<Vec<Option<f64>>>> = lines.into_iter().filter(has_content).take(ROWS).map(row).collect();
    let mut rows = rows?;
    let is_number = |row: &Vec<Option<f64>>| row.iter().all(Option::is_some);
    if rows.len() > 1 && !is_number(&rows[0]) && rows[1..].iter().all(is_number) && rows[0].len() == rows[1].len() {
        // Names of columns, which only tables of points have.
        return Some(SpaceFormat::Points);
    }
    // Any word may be a label, but hardly a fraction.
    let is_label = |field: &Option<f64>| field.is_none_or(|label| label >= 0.0 && label.fract() == 0.0);
    if !rows.iter().all(is_number) {
        let is_edge = |row: &Vec<Option<f64>>| match row[..] {
            [a, b] | [a, b, Some(_)] => is_label(&a) && is_label(&b),
            _ => false,
        };
        if rows.iter().all(is_edge) {
            return Some(SpaceFormat::Edges);
        }
        // A slip among numbers: the reader will name its place.
        let format = if is_graph { SpaceFormat::Edges } else { SpaceFormat::Points };
        return rows.iter().any(|row| !row.is_empty() && is_number(row)).then_some(format);
    }
    rows.retain(|row| !row.is_empty());
    if is_graph && rows.iter().all(|row| matches!(row.len(), 2 | 3) && row[..2].iter().all(is_label)) {
        return Some(SpaceFormat::Edges);
    }
    let first = rows.first()?.len();
    let lengths = || rows.iter().map(Vec::len);
    // Two rows of a triangle could as well be a slip in a table of points.
    if (rows.len() > 2 || begins_empty) && lengths().eq(1..=rows.len()) {
        Some(SpaceFormat::Lower)
    } else if rows.len() > 2 && rows.len() <= first && lengths().eq((0..rows.len()).map(|row| first - row)) {
        Some(SpaceFormat::Upper)
    } else if is_matrix(&rows) {
        Some(SpaceFormat::Full)
    } else {
        Some(SpaceFormat::Points)
    }
}

/// The fields of a line, those that are numbers with their values; `None` for a line that cannot be text.
fn row(line: &[u8]) -> Option<Vec<Option<f64>>> {
    if line.contains(&0) {
        return None;
    }
    let mut row = Vec::new();
    let line = Line::new(line, Origin::Text { line: 1, column: 0 });
    let line = COMMENT.map_or(line.clone(), |mark| line.without_comment(mark));
    let read = fields(line, |_, word| {
        row.push(parse_float(word.bytes));
        Ok(())
    });
    // What is wrong with the line, the reader of the format will say.
    read.map_or(Some(Vec::new()), |_| Some(row))
}

/// Whether these are the first rows of a square matrix with nothing on its diagonal that is symmetric, or whose other
/// entries are all positive: then the reader will tell where it is not. Points could look so too, but three of them
/// hardly will.
fn is_matrix(rows: &[Vec<Option<f64>>]) -> bool {
    let at = |i: usize, j: usize| rows[i].get(j).copied().flatten();
    let columns = rows[0].len();
    let mirrored = |i: usize| (0..i).all(|j| at(i, j) == at(j, i));
    let positive = |i: usize| (0..columns).all(|j| i == j || at(i, j) > Some(0.0));
    columns >= 3
        && (rows.len() == columns || rows.len() < columns && rows.len() >= 2)
        && rows.iter().all(|row| row.len() == columns)
        && (0..rows.len()).all(|i| at(i, i) == Some(0.0))
        && ((0..rows.len()).all(mirrored) || rows.len() == columns && (0..columns).all(positive))
}
