//! What `sig homology` reads: complexes in any of their forms, and subcomplexes.

use std::io::{BufRead, BufReader};
use std::path::Path;

use anyhow::{Context, bail};
use hashbrown::HashMap;
use sig_core::{Relations, SimplexId, VertexId};
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::homology::{Chains, Level};
use sig_tools::io::{Format, ReadOptions, read};
use sig_tools::mcc::MccFile;
use sig_tools::names::{simplex_labels, vertex_label};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Loaded, with_view};

use super::input::{How, Input};
use super::tree_input::{self, Opened};
use super::{UsageError, mcc_input, progress};

/// What was read.
pub(super) enum Source {
    Simplicial(Input),
    Cells(CellComplex),
    MultiResolution(MccFile),
}

/// Opens a complex in any of its forms.
pub(super) fn open(path: &Path, how: &How, format: Option<Format>) -> anyhow::Result<Source> {
    if mcc_input::is_one(path) {
        return Ok(Source::MultiResolution(mcc_input::open(path)?));
    }
    let (reader, length) = match tree_input::open(path, how)? {
        Opened::Ours(input) => return Ok(Source::Simplicial(input)),
        Opened::Other(reader, length) => (reader, length),
    };
    let name = tree_input::displayed(path);
    let mut reader = BufReader::with_capacity(1 << 16, reader);
    if format.is_none() && is_cells(reader.fill_buf().with_context(|| name.clone())?, &name) {
        return Ok(Source::Cells(progress::during("reading", || read_cells(reader, &name))?));
    }
    let (soup, _) = progress::reading_of(length, &name, |progress| {
        read(reader, &name, &ReadOptions { format, progress, ..ReadOptions::default() })
    })?;
    let built = progress::during("building", || build(soup, &BuildOptions::default()))?;
    let bytes = Encoding::new(&built, &EncodeOptions { checksums: false, ..EncodeOptions::default() })?.to_bytes()?;
    Ok(Source::Simplicial(Input::Loaded(Loaded::from_file_bytes(bytes)?)))
}

/// Whether a text is a cell complex: it says so, or, compressed, its name does.
fn is_cells(head: &[u8], name: &str) -> bool {
    let lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.into_iter().find(|line| !matches!(line, [] | [b'#', ..])).unwrap_or(&[]);
    first.split(u8::is_ascii_whitespace).next() == Some(b"cells") || name.ends_with(".cells.gz")
}

/// For each dimension and simplex of the complex whether it belongs to the one at `path`, by the labels of its vertices.
pub(super) fn marked<C: Relations>(
    complex: &C,
    path: &Path,
    how: &How,
    format: Option<Format>,
) -> anyhow::Result<Vec<Vec<bool>>> {
    let name = tree_input::displayed(path);
    let Source::Simplicial(input) = open(path, how, format)? else {
        return Err(UsageError(format!("{name}: --relative wants simplices, and these are cells")).into());
    };
    let dims = complex.dim().map_or(0, |dim| dim + 1);
    let mut marks: Vec<Vec<bool>> = (0..dims).map(|dim| vec![false; complex.num_simplices_of_dim(dim)]).collect();
    let vertices = (0..complex.num_vertices()).map(VertexId::new);
    let by_label: HashMap<String, VertexId> = vertices.map(|vertex| (vertex_label(complex, vertex), vertex)).collect();
    with_view!(input.view(), sub => {
        sub.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
        for simplex in sub.simplices() {
            let labels = simplex_labels(&sub, simplex);
            let missing = || format!("{name}: {} is no simplex of the complex", labels.join(","));
            let word: Option<Vec<VertexId>> = labels.iter().map(|label| by_label.get(label).copied()).collect();
            let mut word = word.with_context(missing)?;
            word.sort_unstable();
            let found: SimplexId = complex.find(&word).with_context(missing)?;
            let dim = word.len() - 1;
            marks[dim][found.index() - complex.simplices_of_dim(dim).bounds().0.index()] = true;
        }
    });
    Ok(marks)
}

/// For each dimension and cell whether it belongs to the subcomplex of which a text lists cells, a line each: the dimension, and the
/// number in the dimension. Their faces belong to it as well.
pub(super) fn marked_cells(chains: &impl Chains, path: &Path, how: &How) -> anyhow::Result<Vec<Vec<bool>>> {
    let name = tree_input::displayed(path);
    let Opened::Other(reader, _) = tree_input::open(path, how)? else {
        return Err(UsageError(format!("{name}: --relative wants cells, and these are simplices")).into());
    };
    let mut marks: Vec<Vec<bool>> = chains.counts().into_iter().map(|count| vec![false; count]).collect();
    for (number, line) in (1..).zip(BufReader::new(reader).lines()) {
        let line = line.with_context(|| name.clone())?;
        let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
        let numbers: Option<Vec<usize>> = words.iter().map(|word| word.parse().ok()).collect();
        match numbers.as_deref() {
            Some([]) => {}
            Some(&[dim, cell]) => match marks.get_mut(dim).and_then(|marks| marks.get_mut(cell)) {
                Some(mark) => *mark = true,
                None => bail!("{name}:{number}: the complex has no cell {cell} of dimension {dim}"),
            },
            _ => bail!("{name}:{number}: expected a dimension and the number of a cell in it, as in: 1 0"),
        }
    }
    close(chains, &mut marks);
    Ok(marks)
}

/// Marks the faces of the cells that are marked.
fn close(chains: &impl Chains, marks: &mut [Vec<bool>]) {
    let mut levels: Vec<Level<'_>> = Vec::new();
    for dim in 0..marks.len() {
        levels.push(chains.level(dim, levels.last()));
    }
    for dim in (1..marks.len()).rev() {
        let (lower, upper) = marks.split_at_mut(dim);
        for cell in (0..upper[0].len()).filter(|&cell| upper[0][cell]) {
            levels[dim].faces(cell).for_each(|face| lower[dim - 1][face as usize] = true);
        }
    }
}
