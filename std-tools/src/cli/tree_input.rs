//! Reading any complex as a simplex tree: a file of this program, or GUDHI's text.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;

use anyhow::Context;
use sig_core::format::MAGIC;
use sig_tools::simplex_tree::{SimplexTree, Vertices};
use sig_tools::store::Access;
use sig_tools::{Loaded, with_view};

use super::input::Input;
use super::{output, progress};

/// Reads the complex at `path`, `-` being standard input, and what is known of its vertices.
pub(super) fn read(path: &Path) -> anyhow::Result<(SimplexTree, Vertices)> {
    let name = path.display().to_string();
    if path.as_os_str() == "-" {
        return read_stream(io::stdin().lock());
    }
    let mut file = File::open(path).with_context(|| name.clone())?;
    let is_file = file.metadata().is_ok_and(|metadata| metadata.is_file());
    if !is_file {
        return read_stream(file);
    }
    if is_ours(&head(&mut file).with_context(|| name.clone())?) {
        return thaw(&Input::open(path, Access::Sequential)?, &name);
    }
    let file = File::open(path).with_context(|| name.clone())?;
    read_text(file, &name, std::fs::metadata(path).ok().map(|metadata| metadata.len()))
}

/// Reads what cannot be read twice.
fn read_stream(mut reader: impl Read) -> anyhow::Result<(SimplexTree, Vertices)> {
    let head = head(&mut reader).context("<stdin>")?;
    let ours = is_ours(&head);
    let reader = Cursor::new(head).chain(reader);
    if ours {
        return thaw(&Input::Loaded(Loaded::read(reader, Path::new("<stdin>"), 0)?), "<stdin>");
    }
    read_text(reader, "-", None)
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

fn thaw(input: &Input, name: &str) -> anyhow::Result<(SimplexTree, Vertices)> {
    with_view!(input.view(), complex => {
        complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
        SimplexTree::thaw_complex(&complex).with_context(|| name.to_owned())
    })
}

fn read_text(reader: impl Read, name: &str, length: Option<u64>) -> anyhow::Result<(SimplexTree, Vertices)> {
    let bar = progress::bytes(length, name);
    let show = |bytes| bar.set_position(bytes);
    let progress = progress::is_watched().then_some(&show as &(dyn Fn(u64) + Sync));
    let tree = SimplexTree::read_text(reader, name, progress);
    bar.finish_and_clear();
    Ok((tree?, Vertices::of_labels()))
}

/// The label in the tree of the vertex that the input calls so.
pub(super) fn vertex(tree: &SimplexTree, vertices: &Vertices, name: &str) -> anyhow::Result<u32> {
    let label = vertices.find(name).filter(|&label| tree.contains(&[label]));
    label.with_context(|| format!("there is no vertex '{name}'"))
}

/// Says on standard error what was read.
pub(super) fn log(path: &Path, tree: &SimplexTree) {
    let name = if output::is_stdout(path) { "<stdin>".to_owned() } else { path.display().to_string() };
    let counts: Vec<_> = tree.counts().iter().map(output::grouped).collect();
    let counts = if counts.is_empty() { String::new() } else { format!(": {}", counts.join(" + ")) };
    output::log(format_args!("read   {name}: {} simplices{counts}", output::grouped(tree.num_simplices())));
}
