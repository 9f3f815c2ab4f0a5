//! `sig query`: one relation of one simplex.

use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::ValueEnum;
use serde::Serialize;
use sig_core::format::{FormatError, SectionKind};
use sig_core::{Complex, Dim, Index, Relations, Scratch, ScratchError, SimplexId, with_complex};
use sig_tools::names::{FindError, find_simplex, simplex_labels, simplex_name};
use sig_tools::store::Access;
use sig_tools::{OwnedScratch, View, with_view};

use super::input::How;
use super::{UsageError, output};

/// Print a relation of a simplex: its boundary, star, link, …
///
/// Answers come in the order of the ids, one simplex a line as labels separated by commas; with --json an array of
/// arrays of labels; of clusters, an array of objects with dimension, representative and members.
///
/// A file of kind tree answers all but clusters: cofaces, star, link and adjacency by searching the neighbours that the
/// vertices of the simplex have in common. A file of kind sig has these relations stored; sig tree convert --kind sig
/// computes them.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig query bunny.sigc star 17                  everything around vertex 17
  sig query bunny.sigc coboundary 17 --dim 2    the triangles at vertex 17
  sig query bunny.sigc boundary 3,17,20         the edges of a triangle
  sig query bunny.sigc link 0,17 --json         the link of an edge, as JSON
  sig query bunny.sigc adjacent 3,17,20         the triangles that share an edge with a triangle
  sig query bunny.sigc adjacent 3,17,20 --dim 0 those that share a vertex with it
  sig sweep bunny.sigc star 0                   everything around each vertex")]
pub(super) struct Args {
    /// The file; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    question: Question,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// A relation of a simplex that is asked for.
#[derive(Clone, clap::Args)]
pub(super) struct Question {
    /// The relation
    relation: Relation,

    /// The simplex: the labels of its vertices, separated by commas, in any order
    #[arg(allow_hyphen_values = true)]
    simplex: String,

    #[command(flatten)]
    of: OfDim,
}

/// Which simplices of a relation are asked for.
#[derive(Clone, Copy, clap::Args)]
pub(super) struct OfDim {
    /// The dimension: of the faces or cofaces for `boundary` and `coboundary` (the next one by default), of the shared
    /// faces for `adjacent` (one less than that of the simplex by default)
    #[arg(long, value_name = "Q")]
    pub(super) dim: Option<Dim>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Relation {
    /// The vertices of the simplex
    Vertices,
    /// The faces of one dimension
    Boundary,
    /// The cofaces of one dimension
    Coboundary,
    /// The simplex and all its cofaces
    Star,
    /// The faces of its star that do not meet it
    Link,
    /// The simplex and all its faces
    Closure,
    /// The simplices of its dimension that share a facet with it; for a vertex, the other ends of its edges
    Adjacent,
    /// The clusters of top simplices around it
    Clusters,
    /// The simplex itself
    Find,
}

/// A cluster with its simplices, by their labels.
#[derive(Serialize)]
struct Cluster {
    dimension: Dim,
    representative: Vec<String>,
    members: Vec<Vec<String>>,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let question = &self.question;
        // Before the file is looked for.
        question.labels()?;
        let input = self.how.open(&self.file, Access::Random)?;
        match (input.view(), question.relation) {
            (View::Complex(any), Relation::Clusters) => with_complex!(any, complex => self.answer_clusters(&complex)),
            (View::Tree(_), Relation::Clusters) => {
                let file = self.file.display();
                Err(FormatError::MissingSection(SectionKind::Lists)).with_context(|| {
                    format!("{file}: a tree has no clusters; sig tree convert {file} -o OUT --kind sig computes them")
                })
            }
            (view, _) => with_view!(view, complex => self.answer(&complex)),
        }
    }

    fn answer_clusters<I: Index>(&self, complex: &Complex<'_, I>) -> anyhow::Result<()> {
        let simplex = self.question.simplex(complex, &self.file)?;
        let clusters = clusters(complex, simplex, &mut OwnedScratch::new(complex));
        Ok(if self.json { output::json(&clusters) } else { print_clusters(&clusters) }?)
    }

    fn answer<V: Relations>(&self, complex: &V) -> anyhow::Result<()> {
        let found = self.question.answer(complex, &self.file)?;
        if self.json {
            let found: Vec<_> = found.into_iter().map(|simplex| simplex_labels(complex, simplex)).collect();
            output::json(&found)?;
        } else {
            output::stdout(|out| {
                found.iter().try_for_each(|&simplex| writeln!(out, "{}", simplex_name(complex, simplex)))
            })?;
        }
        Ok(())
    }
}

impl Question {
    fn labels(&self) -> Result<Vec<&str>, UsageError> {
        let labels: Vec<&str> = self.simplex.split(',').map(str::trim).collect();
        if labels.contains(&"") {
            let message = format!("'{}' is no simplex: give the labels of its vertices, as in 0,17", self.simplex);
            return Err(UsageError(message));
        }
        Ok(labels)
    }

    /// The simplices that the relation has in a complex, that of a file, by increasing id.
    pub(super) fn answer<V: Relations>(&self, complex: &V, file: &Path) -> anyhow::Result<Vec<SimplexId>> {
        let simplex = self.simplex(complex, file)?;
        let mut memory = OwnedScratch::new(complex);
        Ok(memory.run(|scratch| self.relation.of(complex, simplex, self.of, scratch)))
    }

    fn simplex(&self, complex: &impl Relations, file: &Path) -> anyhow::Result<SimplexId> {
        let simplex = find_simplex(complex, &self.labels()?).map_err(|error| match error {
            FindError::RepeatedVertex { .. } => UsageError(error.to_string()).into(),
            error => anyhow::Error::new(error).context(file.display().to_string()),
        })?;
        self.relation.check_dim(complex, complex.dim_of(simplex).unwrap_or(0), self.of)?;
        Ok(simplex)
    }
}

impl Relation {
    /// Refuses a dimension where there is none to choose, or that the relation of simplices of dimension `own` cannot
    /// have.
    pub(super) fn check_dim(self, complex: &impl Relations, own: Dim, of: OfDim) -> Result<(), UsageError> {
        let Some(dim) = of.dim else { return Ok(()) };
        let top = complex.dim().unwrap_or(0);
        let (name, range) = match self {
            Self::Boundary => ("boundary", 0..own),
            Self::Adjacent => ("adjacent", 0..own),
            Self::Coboundary => ("coboundary", own + 1..top + 1),
            _ => return Err(UsageError("--dim is for boundary, coboundary and adjacent only".to_owned())),
        };
        if range.contains(&dim) {
            return Ok(());
        }
        let allowed = match range.clone().count() {
            0 => format!("no dimension can be chosen in a complex of dimension {top}"),
            1 => format!("only --dim {} is possible", range.start),
            _ => format!("--dim must be from {} to {}", range.start, range.end - 1),
        };
        Err(UsageError(format!("--dim {dim}: for {name} of a simplex of dimension {own} {allowed}")))
    }

    /// What it gives for a simplex, by increasing id; of the clusters, the simplex itself.
    pub(super) fn of<V: Relations>(
        self,
        complex: &V,
        simplex: SimplexId,
        of: OfDim,
        scratch: &mut Scratch<'_, V::Index>,
    ) -> Result<Vec<SimplexId>, ScratchError> {
        let own = complex.dim_of(simplex).unwrap_or(0);
        let mut found: Vec<SimplexId> = match self {
            Self::Vertices => complex.vertices(simplex).map(SimplexId::from).collect(),
            Self::Boundary => match of.dim {
                Some(dim) => complex.boundary(simplex, dim).collect(),
                None => complex.facets(simplex).collect(),
            },
            Self::Coboundary => complex.coboundary(simplex, of.dim.unwrap_or(own + 1), scratch)?.collect(),
            Self::Star => complex.star(simplex, scratch)?.collect(),
            Self::Link => complex.link(simplex, scratch)?.collect(),
            Self::Closure => complex.closure(simplex).collect(),
            Self::Adjacent => match of.dim {
                Some(dim) => complex.k_adjacency(simplex, dim, scratch)?.collect(),
                None => complex.adjacency(simplex, scratch)?.collect(),
            },
            Self::Clusters | Self::Find => vec![simplex],
        };
        found.sort_unstable();
        Ok(found)
    }
}

fn clusters<I: Index>(complex: &Complex<'_, I>, simplex: SimplexId, memory: &mut OwnedScratch<I>) -> Vec<Cluster> {
    let cluster = |cluster: sig_core::relations::Cluster| {
        let representative = cluster.representative;
        let mut members: Vec<SimplexId> =
            memory.run(|scratch| Ok(complex.cluster_members(simplex, representative, scratch)?.collect()));
        members.sort_unstable();
        Cluster {
            dimension: cluster.dim,
            representative: simplex_labels(complex, representative),
            members: members.into_iter().map(|member| simplex_labels(complex, member)).collect(),
        }
    };
    complex.clusters(simplex).map(cluster).collect()
}

/// Each cluster with its simplices, one a line and indented.
fn print_clusters(clusters: &[Cluster]) -> io::Result<()> {
    output::stdout(|out| {
        for Cluster { dimension, representative, members } in clusters {
            writeln!(out, "cluster of dimension {dimension}, representative {}", representative.join(","))?;
            members.iter().try_for_each(|member| writeln!(out, "  {}", member.join(",")))?;
        }
        Ok(())
    })
}
