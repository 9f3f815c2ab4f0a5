//! `sig homology`: Betti numbers and torsion coefficients.

use std::fmt::Write as _;
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::Context;
use hashbrown::HashMap;
use serde::{Serialize, Serializer};
use sig_core::{Dim, Relations, SimplexId, VertexId};
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::homology::{
    BigInt, Cells, Chain, Chains, Coefficients, Generator, Homology, HomologyError, HomologyOptions, Simplices,
    generators, homology, is_prime,
};
use sig_tools::io::{Format, ReadOptions, read};
use sig_tools::mcc::Front;
use sig_tools::names::{simplex_labels, vertex_label};
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Loaded, with_view};

use super::input::{How, Input};
use super::output::{self, grouped, table};
use super::tree_input::{self, Opened};
use super::{Threads, UsageError, mcc_input, progress};

/// Compute homology: how many components, tunnels and voids there are, and which torsion
///
/// The complex is a file of this program, of any kind, a mesh, a list of simplices, or a cell complex in text. Betti numbers are
/// told for each dimension up to that of the complex, torsion as invariant factors. `critical` are the cells that the reduction
/// left.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig homology bunny.sigc                               over the integers
  sig homology rips.sigc --over Z2 --json               {\"betti\":[1,0,1],\"torsion\":[[],[],[]],…}
  sig homology klein.off --over Q                       of a mesh, without a file
  sig homology ball.sigc --relative sphere.simplices    relative to a subcomplex, by its vertex labels
  sig homology torus.off --generators                   with cycles, by the labels of the vertices
  sig homology lens.cells                               of a cell complex in text
  sig homology bunny.mcc                                of a multi-resolution complex: that of every front")]
pub(super) struct Args {
    /// The complex; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// The coefficients: `Z`, `Q`, or `Zp` for a prime p, as in `Z2`
    #[arg(long, value_name = "RING", default_value = "Z")]
    over: Ring,

    /// Relative to a subcomplex: a file of simplices that must be in the complex, faces of theirs being meant, too
    #[arg(long, value_name = "SUB")]
    relative: Option<PathBuf>,

    /// Tell cycles that generate the groups, as sums of simplices with their orientations, or of cells by their numbers in their
    /// dimension; of torsion also a chain, the boundary of which is the cycle times its order
    #[arg(long)]
    generators: bool,

    /// The format of meshes and lists of simplices; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,

    #[command(flatten)]
    threads: Threads,

    /// Print a JSON object
    #[arg(long)]
    json: bool,
}

/// Coefficients as they are written on the command line.
#[derive(Clone, Copy)]
struct Ring(Coefficients);

impl FromStr for Ring {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ring = match text {
            "Z" => Some(Coefficients::Integers),
            "Q" => Some(Coefficients::Rationals),
            _ => {
                let prime = text.strip_prefix('Z').map(|digits| digits.strip_prefix('/').unwrap_or(digits));
                prime.and_then(|digits| digits.parse().ok()).filter(|&p| is_prime(p)).map(Coefficients::Prime)
            }
        };
        ring.map(Self).ok_or_else(|| "it is neither Z, nor Q, nor Zp with a prime p, such as Z2".to_owned())
    }
}

impl Ring {
    /// The ring, raised to a power.
    fn power(self, rank: usize) -> String {
        let ring = match self.0 {
            Coefficients::Integers => "Z".to_owned(),
            Coefficients::Rationals => "Q".to_owned(),
            Coefficients::Prime(p) if rank > 1 => format!("(Z/{p})"),
            Coefficients::Prime(p) => format!("Z/{p}"),
        };
        if rank > 1 { format!("{ring}^{rank}") } else { ring }
    }
}

/// The homology; as JSON, the names of the fields.
#[derive(Serialize)]
struct Report {
    betti: Vec<usize>,
    torsion: Vec<Vec<Factor>>,
    over: String,
    euler_characteristic: i64,
    cells: Vec<usize>,
    critical: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    generators: Option<Vec<Vec<Named>>>,
}

/// A generator in names.
#[derive(Serialize)]
struct Named {
    /// Of a class of finite order.
    order: Option<Factor>,
    cycle: Vec<Term>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<Vec<Term>>,
}

/// A coefficient, and what it stands before: the labels of a simplex, or the number of a cell.
#[derive(Serialize)]
struct Term(Factor, Vec<String>);

impl Named {
    fn new(dim: Dim, generator: Generator, name: &impl Fn(Dim, u32) -> Vec<String>) -> Self {
        let terms = |dim: Dim, chain: Chain| {
            let term = |(cell, coefficient)| Term(Factor(coefficient), name(dim, cell));
            chain.into_iter().map(term).collect()
        };
        Self {
            order: generator.order.map(Factor),
            cycle: terms(dim, generator.cycle),
            bounds: generator.bounds.map(|chain| terms(dim + 1, chain)),
        }
    }
}

/// Writes a chain as cell complexes in text have it: `+a,b 2*-b,c`.
fn chain(terms: &[Term]) -> String {
    let term = |Term(Factor(coefficient), name): &Term| {
        let sign = if *coefficient < BigInt::from(0) { '-' } else { '+' };
        let times = coefficient.magnitude();
        let times = if *times == 1_u32.into() { String::new() } else { format!("{times}*") };
        format!("{times}{sign}{}", name.join(","))
    };
    terms.iter().map(term).collect::<Vec<_>>().join(" ")
}

/// A number of JSON where it is less than 2⁵³ off 0, so that every reader takes it as it is, else a string of digits.
struct Factor(BigInt);

impl Serialize for Factor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match i64::try_from(&self.0) {
            Ok(number) if number.abs() < 1 << 53 => serializer.serialize_i64(number),
            _ => serializer.collect_str(&self.0),
        }
    }
}

/// What was read.
pub(super) enum Source {
    Simplicial(Input),
    Cells(CellComplex),
}

/// The generators of each dimension, in names.
type NamedGenerators = Vec<Vec<Named>>;

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        self.threads.start()?;
        let options = HomologyOptions { over: self.over.0, ..HomologyOptions::default() };
        let (found, generators) = match open(&self.file, &self.how, self.format)? {
            Source::Cells(_) if self.relative.is_some() => {
                let message = "--relative wants a simplicial complex, and this is a cell complex".to_owned();
                return Err(UsageError(message).into());
            }
            Source::Cells(complex) => {
                let name = |_: Dim, cell: u32| vec![cell.to_string()];
                self.compute(&Cells::new(&complex), &options, &name)?
            }
            Source::Simplicial(input) => with_view!(input.view(), complex => {
                let name = tree_input::displayed(&self.file);
                complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
                let marks = self.relative.as_deref().map(|path| marked(&complex, path, &self.how, self.format)).transpose()?;
                let name = |dim: Dim, cell: u32| {
                    let first = complex.simplices_of_dim(dim).bounds().0.index();
                    simplex_labels(&complex, SimplexId::new(first + cell as usize))
                };
                let options = HomologyOptions { relative_to: marks.as_deref(), ..options };
                self.compute(&Simplices(&complex), &options, &name)?
            }),
        };
        if self.json {
            output::json(&Report {
                euler_characteristic: found.euler_characteristic(),
                torsion: found.torsion.into_iter().map(|factors| factors.into_iter().map(Factor).collect()).collect(),
                betti: found.betti,
                over: Self::ring_name(self.over),
                cells: found.counts,
                critical: found.critical,
                generators,
            })?;
        } else {
            output::stdout(|out| self.print(&found, generators.as_deref(), out))?;
        }
        Ok(())
    }

    /// The homology, and generators in names if they are asked for.
    fn compute(
        &self,
        chains: &impl Chains,
        options: &HomologyOptions<'_>,
        name: &impl Fn(Dim, u32) -> Vec<String>,
    ) -> Result<(Homology, Option<NamedGenerators>), HomologyError> {
        let found = progress::during("computing homology", || homology(chains, options))?;
        if !self.generators {
            return Ok((found, None));
        }
        let generators = progress::during("finding generators", || generators(chains, options))?;
        let named = |(dim, all): (Dim, Vec<Generator>)| {
            all.into_iter().map(|generator| Named::new(dim, generator, name)).collect()
        };
        Ok((found, Some(generators.into_iter().enumerate().map(named).collect())))
    }

    fn ring_name(ring: Ring) -> String {
        ring.power(1)
    }

    fn print(&self, found: &Homology, generators: Option<&[Vec<Named>]>, out: &mut dyn Write) -> io::Result<()> {
        let relative =
            self.relative.as_deref().map_or(String::new(), |path| format!(" relative to {}", path.display()));
        let (name, ring) = (tree_input::displayed(&self.file), Self::ring_name(self.over));
        writeln!(out, "{name}: homology{relative} over {ring}\n")?;
        if found.betti.is_empty() {
            return writeln!(out, "the empty complex has none");
        }
        let head = ["dimension", "cells", "critical", "Betti", "group"].map(str::to_owned).to_vec();
        let row = |dim: usize| {
            let (betti, torsion) = (found.betti[dim], &found.torsion[dim]);
            let numbers = [found.counts[dim], found.critical[dim], betti].map(grouped);
            [dim.to_string()].into_iter().chain(numbers).chain([group(self.over, betti, torsion)]).collect()
        };
        let rows: Vec<Vec<String>> = std::iter::once(head).chain((0..found.betti.len()).map(row)).collect();
        table(&rows, out)?;
        writeln!(out, "\nEuler characteristic {}", grouped(found.euler_characteristic()))?;
        for (dim, all) in generators.into_iter().flatten().enumerate() {
            for Named { order, cycle, bounds } in all {
                let order = order.as_ref().map_or(String::new(), |Factor(order)| format!(", of order {order}"));
                writeln!(out, "\ngenerator of dimension {dim}{order}: {}", chain(cycle))?;
                if let Some(bounds) = bounds {
                    writeln!(out, "so many times the cycle is the boundary of: {}", chain(bounds))?;
                }
            }
        }
        Ok(())
    }
}

/// A group as a sum of cyclic ones.
fn group(over: Ring, betti: usize, torsion: &[BigInt]) -> String {
    let mut text = if betti > 0 { over.power(betti) } else { String::new() };
    for equal in torsion.chunk_by(|one, other| one == other) {
        let plus = if text.is_empty() { "" } else { " + " };
        let _ = match equal {
            [factor] => write!(text, "{plus}Z/{factor}"),
            _ => write!(text, "{plus}(Z/{})^{}", equal[0], equal.len()),
        };
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// Opens a complex in any of its forms.
pub(super) fn open(path: &Path, how: &How, format: Option<Format>) -> anyhow::Result<Source> {
    if mcc_input::is_one(path) {
        let file = mcc_input::open(path)?;
        // Every front has the same homology, and the base complex is the smallest.
        return Ok(Source::Cells(Front::new(file.view()).complex().clone()));
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
fn marked<C: Relations>(complex: &C, path: &Path, how: &How, format: Option<Format>) -> anyhow::Result<Vec<Vec<bool>>> {
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
