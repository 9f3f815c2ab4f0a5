//! `sig info`: what is in a file.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use sig_core::complex::columns::Labels;
use sig_core::format::{Column, SectionKind};
use sig_core::storage::{ClusterCounts, FileStorage, PaperStorage};
use sig_core::{Complex, Dim, Index, with_complex};
use sig_tools::analysis::Analysis;
use sig_tools::store::Access;

use super::input::Input;
use super::output::{self, grouped, table};

/// Show what is in a file: simplices, clusters, components, storage
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig info bunny.sigc
  sig info bunny.sigc --json | jq .euler_characteristic")]
pub(super) struct Args {
    /// The file; `-` is standard input
    file: PathBuf,

    /// Print a JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let input = Input::open(&self.file, Access::Sequential)?;
        let summary = with_complex!(input.complex(), complex => Summary::new(&complex));
        if self.json {
            output::json(&summary)?;
        } else {
            output::stdout(|out| summary.print(&self.file, out))?;
        }
        Ok(())
    }
}

/// What is in a file; as JSON, the names of the fields.
#[derive(Serialize)]
struct Summary {
    /// −1 for the empty complex.
    dimension: i64,
    simplices: Vec<usize>,
    top_simplices: Vec<usize>,
    euler_characteristic: i64,
    components: usize,
    h_components: Vec<usize>,
    regular: bool,
    pseudo_manifold: bool,
    /// The κ_p^g that are not zero.
    clusters: Vec<Clusters>,
    /// Simplices with the paper's manifold flag, for each dimension.
    single_cluster: Vec<usize>,
    index_bits: u32,
    file_bytes: usize,
    format_version: String,
    storage: Storage,
    labels: &'static str,
    coordinates: Option<Coordinates>,
    #[serde(skip_serializing_if = "Option::is_none")]
    provenance: Option<String>,
    sections: Vec<Section>,
}

#[derive(Serialize)]
struct Clusters {
    p: Dim,
    g: Dim,
    count: usize,
}

/// The paper's counts (4.2, 7.1) beside those of the file.
#[derive(Serialize)]
struct Storage {
    paper_integers: usize,
    paper_bits: usize,
    file_integers: usize,
    file_bits: usize,
    /// 4.2 if no simplex had the manifold flag.
    paper_general_integers: usize,
    /// 7.1: the incidence graph of the same complex.
    incidence_graph_integers: usize,
    tree_bytes: usize,
    checksum_bytes: usize,
    other_bytes: usize,
    overhead_bytes: usize,
}

#[derive(Serialize)]
struct Coordinates {
    components: u32,
    bits: u32,
}

#[derive(Serialize)]
struct Section {
    name: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    dimension: Option<Dim>,
    bytes: usize,
}

impl Storage {
    fn new(paper: &PaperStorage, file: &FileStorage) -> Self {
        Self {
            paper_integers: paper.sig().integers,
            paper_bits: paper.sig().bits,
            file_integers: file.sig().integers,
            file_bits: file.sig().bits,
            paper_general_integers: paper.sig_general().integers,
            incidence_graph_integers: paper.incidence_graph().integers,
            tree_bytes: file.tree_bytes,
            checksum_bytes: file.checksum_bytes,
            other_bytes: file.other_bytes,
            overhead_bytes: file.overhead_bytes,
        }
    }
}

impl Summary {
    fn new<I: Index>(complex: &Complex<'_, I>) -> Self {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        let analysis = Analysis::new(complex);
        let counts: Vec<ClusterCounts> = (0..dims).map(|dim| complex.cluster_counts(dim)).collect();
        let clusters = counts.iter().enumerate().flat_map(|(p, counts)| {
            let by_dim = counts.by_dim.iter().enumerate().filter(|(_, count)| **count > 0);
            by_dim.map(move |(g, &count)| Clusters { p, g, count })
        });
        let file = complex.file_storage();
        let (major, minor) = complex.container().header().version;
        Self {
            dimension: i64::try_from(dims).unwrap_or(i64::MAX) - 1,
            simplices: (0..dims).map(|dim| complex.num_simplices_of_dim(dim)).collect(),
            euler_characteristic: complex.euler_characteristic(),
            components: analysis.components(),
            h_components: analysis.h_components,
            regular: analysis.is_regular,
            pseudo_manifold: analysis.is_pseudo_manifold,
            top_simplices: analysis.top_simplices,
            clusters: clusters.collect(),
            single_cluster: counts.iter().map(|counts| counts.single_cluster).collect(),
            index_bits: I::WIDTH.bits(),
            file_bytes: file.file_bytes,
            format_version: format!("{major}.{minor}"),
            storage: Storage::new(&complex.paper_storage(), &file),
            labels: match complex.labels() {
                Labels::Numbered => "numbered",
                Labels::Integers(_) => "integers",
                Labels::Text { .. } => "text",
            },
            coordinates: complex.coordinates().map(|section| Coordinates {
                components: section.components,
                bits: if matches!(section.column, Column::F32(_)) { 32 } else { 64 },
            }),
            provenance: complex.provenance().map(str::to_owned),
            sections: complex
                .container()
                .sections()
                .map(|section| Section {
                    name: section.kind.name(),
                    dimension: section.dim,
                    bytes: section.column.as_bytes().len(),
                })
                .collect(),
        }
    }

    fn print(&self, file: &Path, out: &mut dyn Write) -> io::Result<()> {
        let bytes = grouped(self.file_bytes);
        writeln!(
            out,
            "{}: SIG {}, {bytes} bytes, {}-bit indices",
            file.display(),
            self.format_version,
            self.index_bits
        )?;
        writeln!(out)?;
        if self.dimension < 0 {
            return writeln!(out, "the empty complex, of dimension -1");
        }
        table(&self.simplex_rows(), out)?;
        writeln!(out)?;
        table(&self.fact_rows(), out)?;
        writeln!(out)?;
        table(&self.storage_rows(), out)?;
        writeln!(out)?;
        table(&self.byte_rows(), out)
    }

    /// A row for each dimension: how many simplices, top ones, κ_p^g, flagged ones.
    fn simplex_rows(&self) -> Vec<Vec<String>> {
        let gs: Vec<Dim> = (1..self.simplices.len()).filter(|g| self.clusters.iter().any(|c| c.g == *g)).collect();
        let mut head = vec!["dimension".to_owned(), "simplices".to_owned(), "top".to_owned()];
        head.extend(gs.iter().map(|g| format!("{g}-clusters")));
        head.push("single cluster".to_owned());
        let count = |p: Dim, g: Dim| self.clusters.iter().find(|c| (c.p, c.g) == (p, g)).map_or(0, |c| c.count);
        let row = |p: Dim| {
            let mut row = vec![p.to_string(), grouped(self.simplices[p]), grouped(self.top_simplices[p])];
            row.extend(gs.iter().map(|&g| if g > p { grouped(count(p, g)) } else { "-".to_owned() }));
            row.push(grouped(self.single_cluster[p]));
            row
        };
        let sum = |counts: &[usize]| grouped(counts.iter().sum::<usize>());
        let mut total = vec!["all".to_owned(), sum(&self.simplices), sum(&self.top_simplices)];
        let all = |g: Dim| self.clusters.iter().filter(|c| c.g == g).map(|c| c.count).sum::<usize>();
        total.extend(gs.iter().map(|&g| grouped(all(g))));
        total.push(sum(&self.single_cluster));
        std::iter::once(head).chain((0..self.simplices.len()).map(row)).chain([total]).collect()
    }

    fn fact_rows(&self) -> Vec<Vec<String>> {
        let yes_no = |fact: bool| if fact { "yes" } else { "no" }.to_owned();
        let mut rows = vec![
            vec!["Euler characteristic".to_owned(), grouped(self.euler_characteristic)],
            vec!["connected components".to_owned(), grouped(self.components)],
        ];
        for (h, &count) in self.h_components.iter().enumerate().skip(1) {
            rows.push(vec![format!("{h}-connected components"), grouped(count)]);
        }
        let coordinates = match &self.coordinates {
            Some(Coordinates { components, bits }) => format!("{components} of {bits} bits"),
            None => "none".to_owned(),
        };
        rows.push(vec!["regular".to_owned(), yes_no(self.regular)]);
        rows.push(vec!["pseudo-manifold".to_owned(), yes_no(self.pseudo_manifold)]);
        rows.push(vec!["vertex labels".to_owned(), self.labels.to_owned()]);
        rows.push(vec!["coordinates".to_owned(), coordinates]);
        if let Some(provenance) = &self.provenance {
            rows.push(vec!["provenance".to_owned(), provenance.clone()]);
        }
        rows
    }

    /// The integers and bits of the paper beside those of the file, as parts of the incidence graph's.
    fn storage_rows(&self) -> Vec<Vec<String>> {
        let storage = &self.storage;
        let row = |name: &str, integers: usize, bits: usize| {
            vec![name.to_owned(), grouped(integers), grouped(bits), percent(integers, storage.incidence_graph_integers)]
        };
        vec![
            vec!["storage".to_owned(), "integers".to_owned(), "bits".to_owned(), "of IG".to_owned()],
            row("this file", storage.file_integers, storage.file_bits),
            row("paper, 4.2", storage.paper_integers, storage.paper_bits),
            row("paper, 4.2, no flags", storage.paper_general_integers, storage.paper_bits),
            row("incidence graph, 7.1", storage.incidence_graph_integers, 0),
        ]
    }

    fn byte_rows(&self) -> Vec<Vec<String>> {
        let relations =
            [SectionKind::Lookup, SectionKind::Boundary, SectionKind::Pointers, SectionKind::Lists, SectionKind::Flags];
        let of_relations = |section: &&Section| relations.iter().any(|kind| kind.name() == section.name);
        let relation_bytes = self.sections.iter().filter(of_relations).map(|section| section.bytes).sum();
        let parts = [
            ("relations", relation_bytes),
            ("simplex tree", self.storage.tree_bytes),
            ("labels, coordinates, …", self.storage.other_bytes),
            ("checksums", self.storage.checksum_bytes),
            ("header and padding", self.storage.overhead_bytes),
            ("file", self.file_bytes),
        ];
        let row = |(name, bytes): (&str, usize)| vec![name.to_owned(), grouped(bytes), percent(bytes, self.file_bytes)];
        let head = vec!["bytes".to_owned(), String::new(), String::new()];
        std::iter::once(head).chain(parts.into_iter().map(row)).collect()
    }
}

/// A share in percent, with one decimal; `-` of nothing.
fn percent(part: usize, whole: usize) -> String {
    if whole == 0 {
        return "-".to_owned();
    }
    let tenths = (part as u128 * 1000 + whole as u128 / 2) / whole as u128;
    format!("{}.{} %", tenths / 10, tenths % 10)
}
