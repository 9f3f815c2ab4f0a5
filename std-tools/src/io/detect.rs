//! The format of an input: by what its first bytes say for certain, then by its name, then by what they suggest.

use super::compression::without_suffix;
use super::error::{ErrorKind, Fault, Position};
use super::source::Source;
use super::{Format, abaqus, gudhi, medit, mfem, nastran, obj, off, simplex_list, stl, tetbin, vtk};

/// The format of an input called `name`.
pub(super) fn format(source: &mut Source<'_>, name: &str) -> Result<Format, Fault> {
    let length = source.whole_length()?;
    let head = source.head()?;
    refuse_complexes(head)?;
    // A list of simplices goes by many names, `.txt` among them, so content that looks like a mesh comes before it.
    let by_name = by_name(name);
    let format = certain(head, length)
        .or_else(|| if by_name == Some(Format::SimplexList) { suggested(head).or(by_name) } else { by_name })
        .or_else(|| suggested(head));
    // `.txt` says no more than that it is text.
    let may_be_gudhi = match format {
        Some(Format::SimplexList) => by_name.is_none() || without_suffix(&name.to_ascii_lowercase()).ends_with(".txt"),
        Some(_) => false,
        None => true,
    };
    if may_be_gudhi && gudhi::is_no_list(head, length == Some(head.len() as u64)) {
        let message = "this looks like GUDHI's simplex-tree text, of which `sig tree convert` makes a file; if it is a list of \
                       simplices, --format simplices";
        return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
    }
    if format == Some(Format::Tetgen) && !without_suffix(&name.to_ascii_lowercase()).ends_with(".node") {
        let message =
            "this is one of several files of a mesh; `sig convert` and `sig build` take it with those beside it";
        return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
    }
    format.ok_or_else(|| Fault::new(Position::Whole, ErrorKind::UnknownFormat))
}

/// Refuses files that hold a complex already, and says what reads them.
pub(super) fn refuse_complexes(head: &[u8]) -> Result<(), Fault> {
    if !head.starts_with(&sig_core::format::MAGIC) {
        return Ok(());
    }
    let message = "this is a complex already, in a file of this program: `sig info` tells what is in it, `sig expand` takes its \
                   graph, `sig tree convert` its simplices";
    Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())))
}

/// The format that the extension of a name stands for, that of a compressed file being the one before `.gz` and the like.
pub(super) fn by_name(name: &str) -> Option<Format> {
    let name = without_suffix(name);
    let (stem, extension) = name.rsplit_once('.')?;
    // A dot may also stand in a directory, or begin the name.
    if stem.is_empty() { None } else { Format::from_name(extension) }
}

/// The first line that is neither blank nor a comment.
fn first_line(head: &[u8]) -> &[u8] {
    head.split(|&byte| byte == b'\n')
        .map(<[u8]>::trim_ascii)
        .find(|line| !matches!(line, [] | [b'#', ..]))
        .unwrap_or(&[])
}

fn first_word(line: &[u8]) -> &[u8] {
    line.split(u8::is_ascii_whitespace).next().unwrap_or(&[])
}

/// The format of content that names it.
pub(super) fn certain(head: &[u8], length: Option<u64>) -> Option<Format> {
    let line = first_line(head);
    let word = first_word(line);
    if head.starts_with(tetbin::MAGIC) {
        Some(Format::Tetbin)
    } else if vtk::is_legacy(head) {
        Some(Format::Vtk)
    } else if vtk::is_xml(head) {
        Some(Format::Vtu)
    } else if head.starts_with(mfem::KEYWORD) {
        Some(Format::Mfem)
    } else if word.eq_ignore_ascii_case(medit::KEYWORD) {
        Some(Format::Medit)
    } else if abaqus::is_input(head) {
        Some(Format::Abaqus)
    } else if nastran::is_bulk_data(head) {
        Some(Format::Nastran)
    } else if word == b"ply" && line == word {
        Some(Format::Ply)
    } else if off::is_keyword(word) {
        Some(Format::Off)
    } else if line.starts_with(b"$") {
        Some(Format::Msh)
    } else if stl::is_binary(head, length) || stl::is_text(head) {
        Some(Format::Stl)
    } else {
        None
    }
}

/// The format of content that looks like it, but may be something else under another name.
fn suggested(head: &[u8]) -> Option<Format> {
    let line = first_line(head);
    if simplex_list::opens_brackets(line) {
        return Some(Format::SimplexList);
    }
    let lines =
        || head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).filter(|line| !matches!(line, [] | [b'#', ..]));
    let is_vertex = |line: &[u8]| {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        words.next() == Some(b"v") && words.clone().count() >= 3
    };
    if lines().any(is_vertex) && lines().take(16).all(|line| obj::is_keyword(first_word(line))) {
        return Some(Format::Obj);
    }
    // Words could be anything, but rows of nothing but whole numbers are a list of simplices.
    let is_row = |line: &[u8]| line.iter().all(|byte| byte.is_ascii_digit() || matches!(byte, b' ' | b'\t' | b','));
    let numbers = |line: &[u8]| is_row(line.split(|&byte| byte == b'#').next().unwrap_or(&[]));
    (!line.is_empty() && lines().all(numbers)).then_some(Format::SimplexList)
}
