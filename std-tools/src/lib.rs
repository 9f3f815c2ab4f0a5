//! Build, write, map and query simplicial complexes in flat arrays, as Simplified Incidence Graphs or as simplex trees: the
//! library behind the command `sig`.
//!
//! Data flow one way: files are read into a [`soup`] of simplices or a space of points, distances or a graph; these become
//! arrays in canonical order; the arrays are encoded and written; and the file is mapped and queried through [`sig_core`].
//!
//! | step | module | main entry |
//! |---|---|---|
//! | read meshes and lists of simplices | [`io`] | [`io::read_path`], [`io::merge`](io::merge()) |
//! | read points, distances, graphs | [`io::space`] | [`io::space::read_space_path`] |
//! | simplices on numbered vertices | [`soup`] | [`soup::Soup`] |
//! | named columns at vertices and simplices | [`attribute`] | [`attribute::Attribute`] |
//! | simplices on disk | [`spool`] | [`spool::Spill`] |
//! | points and metrics | [`points`] | [`points::Points`], [`points::Metric`] |
//! | all distances of a finite space | [`distances`] | [`distances::Distances`] |
//! | samples on a grid | [`volume`] | [`volume::Volume`], [`io::read_volume_path`] |
//! | clouds that are the same anywhere | [`generate`] | [`generate::sphere4`] |
//! | a few of many points | [`subsample`] | [`subsample::farthest_points`] |
//! | pairs of near points | [`proximity`] | [`proximity::radius_graph`] |
//! | a weighted graph | [`graph`] | [`graph::Graph`] |
//! | simplices to arrays in canonical order | [`mod@build`] | [`build::build`] |
//! | the same of complexes larger than memory | [`build::external`] | [`build::external::build_to_file`] |
//! | the same by the paper's Algorithms 1 to 3 | [`incidence_graph`] | [`incidence_graph::IncidenceGraph`] |
//! | structures to compare the SIG with | [`baselines`] | [`baselines::Structure`] |
//! | the SIG beside them on one complex | [`mod@compare`] | [`compare::compare`] |
//! | pictures as SVG and PNG | [`draw`] | [`draw::Scene`], [`draw::complex::scene`] |
//! | charts as SVG | [`chart`] | [`chart::Chart`], [`chart::draw_bars`] |
//! | cliques of a graph to a simplex tree | [`mod@flag`] | [`flag::expand`], [`flag::estimate`] |
//! | landmarks and witnesses to a simplex tree | [`witness`] | [`witness::witness_complex`](witness::witness_complex()) |
//! | a simplex tree that changes | [`mod@simplex_tree`] | [`simplex_tree::SimplexTree`] |
//! | a simplex tree in level order | [`frozen`] | [`frozen::FrozenTree`] |
//! | a simplex tree to the whole arrays | [`mod@build`] | [`build::complete`] |
//! | contract edges of the whole arrays | [`mod@contract`] | [`contract::contract`] |
//! | closed manifolds by darts and permutations | [`combinatorial_map`] | [`combinatorial_map::CombinatorialMap`] |
//! | cell complexes that change | [`mod@cells`] | [`cells::CellComplex`] |
//! | multi-resolution cell complexes | [`mod@mcc`] | [`mcc::simplify`](mcc::simplify()), [`mcc::Front`] |
//! | Betti numbers and torsion | [`mod@homology`] | [`homology::homology`](homology::homology()) |
//! | encode, write, map, load, verify | [`store`] | [`Mapped`], [`Loaded`], [`store::Encoding`], [`store::atomic`] |
//! | a relation of all simplices at once | [`sweep`] | [`sweep::Sweep`] |
//! | facts about a complex as a whole | [`analysis`] | [`analysis::Analysis`] |
//! | where a complex is no manifold | [`singularities`] | [`singularities::Singularities`] |
//! | simplices by the input's labels | [`names`] | [`names::find_simplex`] |
//! | top simplices with orientations | [`tops`] | [`tops::top_simplices`] |
//! | write meshes, lists, GUDHI's text | [`export`] | [`export::export`](export::export()) |
//!
//! ```
//! # use sig_tools::{build, io, store, store::atomic, Mapped};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let (mesh, out) = (folder.path().join("a.off"), folder.path().join("a.sigc"));
//! # std::fs::write(&mesh, "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")?;
//! let (soup, report) = io::read_path(&mesh, &io::ReadOptions::default())?;
//! let built = build::build(soup, &build::BuildOptions::default())?;
//! let file = store::Encoding::new(&built, &store::EncodeOptions::default())?;
//! atomic::write(&out, atomic::Existing::Refuse, |out| file.write_to(out))?;
//! let map = Mapped::open(&out)?;
//! assert_eq!(sig_core::with_complex!(map.complex()?, complex => complex.num_simplices()), 7);
//! # assert_eq!(report.vertices, 3);
//! # Ok(())
//! # }
//! ```

pub mod analysis;
pub mod attribute;
pub mod baselines;
pub mod build;
pub mod cells;
pub mod chart;
pub mod combinatorial_map;
pub mod compare;
pub mod contract;
pub mod distances;
pub mod draw;
pub mod export;
pub mod flag;
pub mod frozen;
pub mod generate;
pub mod graph;
pub mod homology;
pub mod incidence_graph;
pub mod io;
pub mod mcc;
pub mod names;
pub mod points;
pub mod proximity;
pub mod simplex_tree;
pub mod singularities;
pub mod soup;
pub mod spool;
pub mod store;
pub mod subsample;
pub mod sweep;
pub mod tops;
pub mod volume;
pub mod witness;

pub use store::{Loaded, Mapped, OwnedScratch, View};

/// The examples of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
