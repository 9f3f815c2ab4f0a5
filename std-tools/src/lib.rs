//! Build, write, map and query Simplified Incidence Graphs: the library behind the command `sig`.
//!
//! Data flow one way: files are read into a [`soup`], the soup is built into arrays in canonical order, the arrays are
//! encoded and written, and the file is mapped and queried through [`sig_core`].
//!
//! | step | module | main entry |
//! |---|---|---|
//! | read meshes and lists of simplices | [`io`] | [`io::read_path`], [`io::merge`](io::merge()) |
//! | simplices on numbered vertices | [`soup`] | [`soup::Soup`] |
//! | arrays in canonical order | [`mod@build`] | [`build::build`] |
//! | cliques of a graph as a simplex tree | [`graph`], [`mod@flag`], [`frozen`] | [`flag::expand`] |
//! | a simplex tree to the same arrays | [`mod@build`] | [`build::complete`] |
//! | read points, distances, graphs | [`io::space`] | [`io::space::read_space_path`] |
//! | pairs of near points | [`proximity`] | [`proximity::radius_graph`] |
//! | witness complexes of points | [`witness`] | [`witness::witness_complex`](witness::witness_complex()) |
//! | a few of many points | [`subsample`] | [`subsample::farthest_points`] |
//! | the same by the paper's Algorithms 1 to 3 | [`incidence_graph`] | [`incidence_graph::IncidenceGraph`] |
//! | contract edges of what is built | [`mod@contract`] | [`contract::contract`] |
//! | encode, write, map, load, verify | [`store`] | [`Mapped`], [`Loaded`], [`store::Encoding`], [`store::atomic`] |
//! | what `sig info` says of a complex | [`analysis`] | [`analysis::Analysis`] |
//! | insert, remove, collapse, contract, expand | [`mod@simplex_tree`] | [`simplex_tree::SimplexTree`] |
//! | simplices by the input's labels | [`names`], [`tops`] | [`names::find_simplex`] |
//! | write meshes and lists | [`export`] | [`export::export`](export::export()) |
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
pub mod build;
pub mod contract;
pub mod distances;
pub mod export;
pub mod flag;
pub mod frozen;
pub mod generate;
pub mod graph;
pub mod incidence_graph;
pub mod io;
pub mod names;
pub mod points;
pub mod proximity;
pub mod simplex_tree;
pub mod soup;
pub mod store;
pub mod subsample;
pub mod tops;
pub mod witness;

pub use store::{Loaded, Mapped, OwnedScratch, View};

/// The examples of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
