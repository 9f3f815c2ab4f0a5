//! Reading any complex as a simplex tree: a file of this program, or GUDHI's text.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;

use anyhow::Context;
use sig_core::Relations;
use sig_core::format::{MAGIC, SectionKind};
use sig_tools::simplex_tree::{SimplexTree, Vertices};
use sig_tools::store::Access;
use sig_tools::{Loaded, with_view};

use super::input::{How, Input};
use super::{output, progress};

/// An input, by what its first bytes say.
pub(super) enum Opened {
    /// A file of this program.
    Ours(Input),
    /// Something else, from its first byte on, and its length if that is known.
    Other(Box<dyn Read>, Option<u64>),
}

/// Opens a file, or standard input if the path is `-`.
pub(super) fn open(path: &Path, how: &How) -> anyhow::Result<Opened> {
    let name = || displayed(path);
    let is_file = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file()) && !output::is_stdout(path);
    let mut reader: Box<dyn Read> = if output::is_stdout(path) {
        Box::new(io::stdin().lock())
    } else {
        Box::new(File::open(path).with_context(name)?)
    };
    let head = head(&mut reader).with_context(name)?;
    let ours = is_ours(&head);
    let reader = Cursor::new(head).chain(reader);
    Ok(if ours && is_file {
        Opened::Ours(how.open(path, Access::Sequential)?)
    } else if ours {
        // What is no file cannot be read twice.
        Opened::Ours(Input::Loaded(Loaded::read(reader, Path::new(&name()), 0)?))
    } else {
        let length = std::fs::metadata(path).ok().filter(|_| is_file).map(|metadata| metadata.len());
        Opened::Other(Box::new(reader), length)
    })
}

/// What messages call an input.
pub(super) fn displayed(path: &Path) -> String {
    if output::is_stdout(path) { "<stdin>".to_owned() } else { path.display().to_string() }
}

/// Reads the complex at `path`, `-` being standard input, and what is known of its vertices.
pub(super) fn read(path: &Path, how: &How) -> anyhow::Result<(SimplexTree, Vertices)> {
    match open(path, how)? {
        Opened::Ours(input) => progress::during("thawing", || thaw(&input, &displayed(path))),
        Opened::Other(reader, length) => Ok((read_text(reader, path, length)?, Vertices::of_labels())),
    }
}

/// The first bytes, as many as tell a file of this program.
fn head(reader: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    reader.take(MAGIC.len() as u64).read_to_end(&mut head)?;
    Ok(head)
}

fn is_ours(head: &[u8]) -> bool {
    // A file that was cut short within its magic number is better told as such than as text.
    !head.is_empty() && MAGIC.starts_with(&head[..head.len().min(MAGIC.len())])
}

/// Says on standard error that the attributes of a complex are not in what will be written.
pub(super) fn say_without_attributes(complex: &impl Relations, name: &str) {
    let attributes = complex.container().sections().filter(|section| section.kind == SectionKind::Attribute);
    let names: BTreeSet<&str> = attributes.map(|section| section.name).collect();
    if !names.is_empty() {
        let names = names.into_iter().collect::<Vec<_>>().join(", ");
        output::log(format_args!("sig: note: {name}: attributes are left out: {names}"));
    }
}

fn thaw(input: &Input, name: &str) -> anyhow::Result<(SimplexTree, Vertices)> {
    with_view!(input.view(), complex => {
        complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
        say_without_attributes(&complex, name);
        SimplexTree::thaw_complex(&complex).with_context(|| name.to_owned())
    })
}

/// Reads GUDHI's text.
pub(super) fn read_text(reader: impl Read, path: &Path, length: Option<u64>) -> anyhow::Result<SimplexTree> {
    let name = displayed(path);
    Ok(progress::reading_of(length, &name, |progress| SimplexTree::read_text(reader, &name, progress))?)
}

/// The label in the tree of the vertex that the input calls so.
pub(super) fn vertex(tree: &SimplexTree, vertices: &Vertices, name: &str) -> anyhow::Result<u32> {
    let label = vertices.find(name).filter(|&label| tree.contains(&[label]));
    label.with_context(|| format!("there is no vertex '{name}'"))
}

/// Says on standard error what was read.
pub(super) fn log(path: &Path, tree: &SimplexTree) {
    let name = displayed(path);
    output::log(format_args!("read   {name}: {}", output::counted(tree.counts())));
}
