//! The SIG beside the structures that the paper compares it with, on one complex: what each takes, by formula and measured,
//! and how long its relations take.
//!
//! [`STRUCTURES`] is the list of them; `measure` asks one, `chart` draws the result.

mod chart;
mod measure;

use std::time::Instant;

use serde::Serialize;
use sig_core::format::FormatError;
use sig_core::storage::Storage;
use sig_core::{AnyComplex, SimplexId, with_complex};

use crate::baselines::conjecture::{Violation, violations};
use crate::baselines::formulas::{Formula, Numbers};
use crate::baselines::{
    IndexedAdjacencies, NonManifoldIndexed, Refusal, Session, Sig, Structure, Tops, TriangleSegment,
};
use crate::build::{BuildError, BuildOptions, Built, build, narrow};
use crate::combinatorial_map::{CombinatorialMap, Darts};
use crate::incidence_graph::{IncidenceError, IncidenceGraph, Walk};
use crate::store::{EncodeError, EncodeOptions, Encoding};
use crate::{Loaded, OwnedScratch};

pub use measure::{Relation, Timing};
use measure::{Sample, Sampled};

/// How to compare.
#[derive(Clone, Copy, Debug)]
pub struct CompareOptions {
    /// The most simplices of each dimension whose relations are asked for; with none, no relation is timed.
    pub samples: usize,
    /// The seconds after which a structure has been asked enough for one relation.
    pub seconds: f64,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self { samples: 1000, seconds: 0.05 }
    }
}

/// Why there is nothing to compare.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The complex could not be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// It could not be laid out.
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// What was laid out could not be read. A defect of this crate.
    #[error("cannot read the complex that was built: {0}")]
    Format(#[from] FormatError),
    /// Two structures have answers of different lengths. A defect of this crate.
    #[error("{structure} and the SIG have different answers to {relation}")]
    Disagreement {
        /// The structure.
        structure: &'static str,
        /// The relation.
        relation: Relation,
    },
}

/// One structure that is compared.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What the paper calls it.
    pub name: &'static str,
    /// What it takes by the paper's formula.
    formula: fn(&Numbers) -> Formula,
    /// Builds and asks it.
    measure: fn(&mut Subject<'_>) -> Result<Measured, CompareError>,
}

/// The structures in the order of the table; all others are measured against the first.
pub const STRUCTURES: [Entry; 7] = [
    Entry { name: "SIG", formula: Numbers::sig, measure: sig },
    Entry { name: "SIG pairs", formula: Numbers::sig_pairs, measure: sig_pairs },
    Entry { name: "IG", formula: Numbers::incidence_graph, measure: incidence_graph },
    Entry { name: "IA", formula: Numbers::indexed, measure: indexed },
    Entry { name: "TS", formula: Numbers::triangle_segment, measure: triangle_segment },
    Entry { name: "NMIA", formula: Numbers::non_manifold_indexed, measure: non_manifold_indexed },
    Entry { name: "map", formula: Numbers::combinatorial_map, measure: combinatorial_map },
];

/// What is compared, and what is known of the answers so far.
struct Subject<'a> {
    tops: &'a Tops,
    sample: Sample,
    options: CompareOptions,
}

/// A structure, measured, or why there is none.
type Measured = Result<Measurement, Refusal>;

/// What was measured of a structure.
struct Measurement {
    storage: Storage,
    bytes: usize,
    index_bits: usize,
    build_seconds: f64,
    relations: Vec<Sampled>,
}

/// The comparison of all structures on one complex; as JSON, the names of the fields.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The number of simplices of each dimension.
    pub simplices: Vec<usize>,
    /// The number of top simplices of each dimension.
    pub top_simplices: Vec<usize>,
    /// c_1: the connected components of the restricted stars of all vertices.
    pub components_at_vertices: usize,
    /// Where the conjecture of 7.1 fails: for each (p, q), the first p-simplex with more q-clusters than (p+1)-cofaces.
    pub conjecture_violations: Vec<Violation>,
    /// The number of threads that built.
    pub threads: usize,
    /// A row for each structure.
    pub structures: Vec<Row>,
}

/// What is known of one structure.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What the paper calls it.
    pub name: &'static str,
    /// Why it cannot represent the complex, if it cannot.
    pub refused: Option<String>,
    /// The integers by the paper's formula; of a structure that does not apply, nothing.
    pub formula_integers: Option<usize>,
    /// The bits by the formula.
    pub formula_bits: Option<usize>,
    /// The formula of the integers, in the paper's symbols and with the numbers of the complex.
    pub formula: Option<[String; 2]>,
    /// The formula of the bits.
    pub formula_of_bits: Option<[String; 2]>,
    /// The integers that are stored.
    pub integers: Option<usize>,
    /// The bits that are stored.
    pub bits: Option<usize>,
    /// The width of the integers.
    pub index_bits: Option<usize>,
    /// The bytes of its arrays.
    pub bytes: Option<usize>,
    /// The bytes over those of the SIG.
    pub ratio: Option<f64>,
    /// The seconds that building it from the top simplices took.
    pub build_seconds: Option<f64>,
    /// How long the relations took.
    pub relations: Vec<Timing>,
}

impl Row {
    fn new(entry: &Entry, formula: &Formula, measured: Measured, sig_bytes: &mut Option<usize>) -> Self {
        let mut row = Self {
            name: entry.name,
            refused: None,
            formula_integers: None,
            formula_bits: None,
            formula: None,
            formula_of_bits: None,
            integers: None,
            bits: None,
            index_bits: None,
            bytes: None,
            ratio: None,
            build_seconds: None,
            relations: Vec::new(),
        };
        match measured {
            Err(refusal) => row.refused = Some(refusal.to_string()),
            Ok(measured) => {
                let Storage { integers, bits } = formula.storage();
                let both = |sum: &crate::baselines::formulas::Sum| Some([format!("{sum}"), format!("{sum:#}")]);
                let sig_bytes = *sig_bytes.get_or_insert(measured.bytes);
                row.formula_integers = Some(integers);
                row.formula_bits = Some(bits);
                row.formula = both(&formula.integers);
                row.formula_of_bits = both(&formula.bits);
                row.integers = Some(measured.storage.integers);
                row.bits = Some(measured.storage.bits);
                row.index_bits = Some(measured.index_bits);
                row.bytes = Some(measured.bytes);
                row.ratio = (sig_bytes > 0).then(|| measured.bytes as f64 / sig_bytes as f64);
                row.build_seconds = Some(measured.build_seconds);
                row.relations = measured.relations.iter().map(|sampled| sampled.timing).collect();
            }
        }
        row
    }
}

/// Builds every structure that can represent the complex of `tops`, and asks it.
///
/// The answers of the structures are compared in length as far as they were asked the same. Builds in rayon's current
/// pool; asks on one thread.
///
/// # Errors
/// [`CompareError`]: a complex that is too large to be built.
pub fn compare(tops: &Tops, options: CompareOptions) -> Result<Comparison, CompareError> {
    let file = encoded(tops, false)?;
    let numbers = with_complex!(complex(&file)?, complex => Numbers::of(&complex));
    let sample = with_complex!(complex(&file)?, complex => Sample::new(&complex, options.samples));
    let violations = with_complex!(complex(&file)?, complex => violations(&complex, tops));
    drop(file);
    let mut subject = Subject { tops, sample, options };
    let (mut rows, mut sig_bytes) = (Vec::new(), None);
    let mut expected: Vec<Sampled> = Vec::new();
    for entry in &STRUCTURES {
        let measured = (entry.measure)(&mut subject)?;
        if let Ok(measured) = &measured {
            if expected.is_empty() {
                expected.clone_from(&measured.relations);
            }
            if let Some((sampled, _)) =
                measured.relations.iter().zip(&expected).find(|(sampled, expected)| !sampled.agrees(expected))
            {
                let relation = sampled.timing.relation;
                return Err(CompareError::Disagreement { structure: entry.name, relation });
            }
        }
        rows.push(Row::new(entry, &(entry.formula)(&numbers), measured, &mut sig_bytes));
    }
    Ok(Comparison {
        simplices: numbers.simplices.clone(),
        top_simplices: numbers.clusters.iter().map(|counts| counts.tops).collect(),
        components_at_vertices: numbers.components,
        conjecture_violations: violations,
        threads: rayon::current_num_threads(),
        structures: rows,
    })
}

/// The SIG of the top simplices with the paper's arrays and nothing beside them.
fn encoded(tops: &Tops, pairs: bool) -> Result<Loaded, CompareError> {
    let built = build(tops.numbered(), &BuildOptions::default())?;
    let options = EncodeOptions { tree: false, checksums: false, pairs, ..EncodeOptions::default() };
    Ok(Loaded::from_file_bytes(Encoding::new(&built, &options)?.to_bytes()?)?)
}

fn complex(file: &Loaded) -> Result<AnyComplex<'_>, CompareError> {
    Ok(file.complex()?)
}

/// The seconds that some work takes, and its result.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

impl Subject<'_> {
    fn ask_if_built<T>(
        &mut self,
        built: Result<T, IncidenceError>,
        ask: impl FnOnce(&mut Self, &T) -> Measurement,
    ) -> Result<Measured, CompareError> {
        match built {
            Ok(built) => Ok(Ok(ask(self, &built))),
            Err(IncidenceError::Refused(refusal)) => Ok(Err(refusal)),
            Err(IncidenceError::Build(error)) => Err(error.into()),
        }
    }

    fn ask(&mut self, build_seconds: f64, index_bytes: usize, mut structure: impl Structure) -> Measurement {
        Measurement {
            storage: structure.storage(),
            bytes: structure.bytes(),
            index_bits: 8 * index_bytes,
            build_seconds,
            relations: measure::relations(&mut structure, &self.sample, self.options),
        }
    }
}

fn sig(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    sig_with(subject, false)
}

fn sig_pairs(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    sig_with(subject, true)
}

fn sig_with(subject: &mut Subject<'_>, pairs: bool) -> Result<Measured, CompareError> {
    let (seconds, file) = timed(|| encoded(subject.tops, pairs));
    let file = match file {
        Err(CompareError::Encode(EncodeError::Crowded { simplex, dim, cofaces })) => {
            let file = encoded(subject.tops, false)?;
            let simplex = with_complex!(complex(&file)?, complex => {
                let vertices = complex.vertices(SimplexId::new(simplex));
                subject.tops.name(&vertices.map(|vertex| narrow(vertex.index())).collect::<Vec<_>>())
            });
            return Ok(Err(Refusal::Crowded { simplex, dim, cofaces }));
        }
        other => other?,
    };
    Ok(Ok(with_complex!(complex(&file)?, complex => {
        let mut memory = OwnedScratch::new(&complex);
        subject.ask(seconds, complex.container().header().width.bytes(), Sig::new(complex, &mut memory))
    })))
}

/// Builds a structure from top simplices at the least of some widths that holds it, and asks it through its session.
macro_rules! at_least_width {
    ($subject:ident, $structure:ident, $new:ident, $session:ident, [$($width:ty),*], $widest:ty) => {{
        $(
            let (seconds, built) = timed(|| $structure::<$width>::$new($subject.tops).map_err(IncidenceError::from));
            match built {
                Err(IncidenceError::Refused(Refusal::TooNarrow { .. })) => {}
                other => return $subject.ask_if_built(other, |subject, built| {
                    subject.ask(seconds, size_of::<$width>(), $session::new(built))
                }),
            }
        )*
        let (seconds, built) = timed(|| $structure::<$widest>::$new($subject.tops).map_err(IncidenceError::from));
        $subject.ask_if_built(built, |subject, built| {
            subject.ask(seconds, size_of::<$widest>(), $session::new(built))
        })
    }};
}

fn incidence_graph(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    at_least_width!(subject, IncidenceGraph, of_tops, Walk, [u16, u32], u64)
}

fn indexed(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    at_least_width!(subject, IndexedAdjacencies, new, Session, [u16], u32)
}

fn triangle_segment(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    at_least_width!(subject, TriangleSegment, new, Session, [u16], u32)
}

fn non_manifold_indexed(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    at_least_width!(subject, NonManifoldIndexed, new, Session, [u16], u32)
}

/// A map is made of a SIG, which is built first.
fn combinatorial_map(subject: &mut Subject<'_>) -> Result<Measured, CompareError> {
    let (seconds, map) = timed(|| {
        let built = build(subject.tops.numbered(), &BuildOptions::default())?;
        // A refusal names a simplex by these.
        let built = Built { labels: subject.tops.soup().labels.clone(), ..built };
        let file = Loaded::from_file_bytes(Encoding::new(&built, &EncodeOptions::default())?.to_bytes()?)?;
        Ok::<_, CompareError>(with_complex!(complex(&file)?, complex => CombinatorialMap::new(&complex)))
    });
    Ok(map?.map(|map| subject.ask(seconds, size_of::<u32>(), Darts::new(&map))).map_err(Refusal::from))
}
