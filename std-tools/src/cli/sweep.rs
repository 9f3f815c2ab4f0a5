//! `sig sweep`: one relation of all simplices of a dimension.

use std::io::{self, Write};
use std::ops::Range;
use std::path::PathBuf;

use serde::Serialize;
use sig_core::{Complex, Dim, Index, Relations, SimplexId, with_complex, with_tree};
use sig_tools::names::{simplex_labels, simplex_name};
use sig_tools::store::Access;
use sig_tools::sweep::{Block, Sweep, in_order};
use sig_tools::{OwnedScratch, View};

use super::input::How;
use super::query::{OfDim, Relation};
use super::{Threads, UsageError, output};

/// Print a relation of all simplices of a dimension, a line each
///
/// A line for each simplex, in the order of the ids: the simplex, then each simplex of the answer, with a tab before
/// it. Simplices are labels separated by commas. With --json each line is an object, `simplex` an array of labels,
/// `found` an array of these. Lines come as they are found.
///
/// Stars, cofaces and adjacencies of a file of kind sig are found by passes over the file, all others by a query for
/// each simplex; on all threads.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig sweep bunny.sigc star 0                  everything around each vertex
  sig sweep bunny.sigc coboundary 0 --dim 2    the triangles at each vertex
  sig sweep bunny.sigc adjacent 2              the triangles next to each triangle
  sig sweep bunny.sigc vertices 1 --json       all edges")]
pub(super) struct Args {
    /// The file; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// The relation
    relation: Relation,

    /// The dimension of the simplices
    #[arg(value_name = "P")]
    simplices: Dim,

    #[command(flatten)]
    of: OfDim,

    #[command(flatten)]
    threads: Threads,

    /// Print a JSON object a line
    #[arg(long)]
    json: bool,
}

/// A simplex and what the relation gives for it, by their labels.
#[derive(Serialize)]
struct Line {
    simplex: Vec<String>,
    found: Vec<Vec<String>>,
}

/// Simplices that one thread asks about one after the other: the marks of its scratch are cleared at the start.
const CHUNK: usize = 1 << 12;

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        if self.relation == Relation::Clusters {
            return Err(UsageError("clusters are told of one simplex at a time, by sig query".to_owned()).into());
        }
        self.threads.start()?;
        let input = self.how.open(&self.file, Access::Normal)?;
        match input.view() {
            View::Complex(any) => with_complex!(any, complex => {
                self.check(&complex)?;
                output::stdout(|out| self.of_complex(&complex, out))?;
            }),
            View::Tree(any) => with_tree!(any, tree => {
                self.check(&tree)?;
                output::stdout(|out| self.one_by_one(&tree, out))?;
            }),
        }
        Ok(())
    }

    /// Refuses dimensions that are not there.
    fn check(&self, complex: &impl Relations) -> Result<(), UsageError> {
        if complex.dim().is_none_or(|top| self.simplices > top) {
            let dim = complex.dim().map_or("−1".to_owned(), |top| top.to_string());
            let message =
                format!("there are no simplices of dimension {} in a complex of dimension {dim}", self.simplices);
            return Err(UsageError(message));
        }
        self.relation.check_dim(complex, self.simplices, self.of)
    }

    /// By passes over the file, where there is such a way.
    fn of_complex<I: Index>(&self, complex: &Complex<'_, I>, out: &mut dyn Write) -> io::Result<()> {
        let (sweep, dim) = (Sweep::new(complex), self.simplices);
        let text = |block: &Block<'_, I>| {
            let mut text = Vec::new();
            for (simplex, found) in block.iter() {
                let mut found: Vec<SimplexId> = found.iter().map(|id| SimplexId::new(id.to_usize())).collect();
                // Adjacent ones come facet by facet.
                found.sort_unstable();
                self.push_line(complex, simplex, &found, &mut text);
            }
            text
        };
        let each = |text: Vec<u8>| out.write_all(&text);
        match (self.relation, self.of.dim) {
            (Relation::Star, _) => sweep.star(dim, text, each),
            (Relation::Coboundary, of) => sweep.coboundary(dim, of.unwrap_or(dim + 1), text, each),
            (Relation::Adjacent, None) => sweep.adjacency(dim, text, each),
            (Relation::Adjacent, Some(shared)) if shared + 1 == dim => sweep.adjacency(dim, text, each),
            _ => self.one_by_one(complex, out),
        }
    }

    /// By a query for each simplex.
    fn one_by_one<V: Relations + Sync>(&self, complex: &V, out: &mut dyn Write) -> io::Result<()> {
        let (first, end) = complex.simplices_of_dim(self.simplices).bounds();
        let starts = (first.index()..end.index()).step_by(CHUNK);
        let chunks = starts.map(|start| start..(start + CHUNK).min(end.index()));
        let init = || OwnedScratch::new(complex);
        let text = |memory: &mut OwnedScratch<V::Index>, ids: Range<usize>| self.ask(complex, ids, memory);
        in_order(chunks, init, text, |text: Vec<u8>| out.write_all(&text))
    }

    /// The lines of some simplices.
    fn ask<V: Relations>(&self, complex: &V, ids: Range<usize>, memory: &mut OwnedScratch<V::Index>) -> Vec<u8> {
        let (mut text, mut left) = (Vec::new(), ids.map(SimplexId::new));
        let mut next = left.next();
        loop {
            let mut scratch = memory.scratch();
            let lacking = loop {
                let Some(simplex) = next else { return text };
                match self.relation.of(complex, simplex, self.of, &mut scratch) {
                    Ok(found) => self.push_line(complex, simplex, &found, &mut text),
                    Err(lacking) => break lacking,
                }
                next = left.next();
            };
            memory.grow(lacking);
        }
    }

    fn push_line(&self, complex: &impl Relations, simplex: SimplexId, found: &[SimplexId], text: &mut Vec<u8>) {
        if self.json {
            let labels = |&simplex: &SimplexId| simplex_labels(complex, simplex);
            let line = Line { simplex: labels(&simplex), found: found.iter().map(labels).collect() };
            // Neither text nor a vector can fail to be written.
            let _ = serde_json::to_writer(&mut *text, &line);
        } else {
            text.extend(simplex_name(complex, simplex).bytes());
            for &simplex in found {
                text.push(b'\t');
                text.extend(simplex_name(complex, simplex).bytes());
            }
        }
        text.push(b'\n');
    }
}
