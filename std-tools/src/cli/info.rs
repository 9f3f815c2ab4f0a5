//! `sig info`: what is in a file.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::Serialize;
use sig_core::complex::columns::Labels;
use sig_core::format::{self, Column, Container, SectionKind};
use sig_core::storage::{ClusterCounts, FileStorage, PaperStorage};
use sig_core::{Complex, Dim, Index, Relations, with_complex, with_tree};
use sig_tools::analysis::{Analysis, num_top_simplices};
use sig_tools::store::Access;
use sig_tools::store::atomic::Existing;
use sig_tools::{View, with_view};

use super::build::Attribute;
use super::draw::whole;
use super::input::{How, Input};
use super::output::{self, grouped, table};
use super::report::{self, Page};
use super::tree_input::displayed;
use super::{UsageError, extract, mcc_input, progress};

/// Show what is in a file: simplices, clusters, components, storage
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig info bunny.sigc
  sig info bunny.mcc                   base complex, refinements, dependencies
  sig info rips.sigc --tops            the top simplices of a tree, too
  sig info bunny.sigc --html bunny.html    a page with charts and a picture
  sig info bunny.sigc --json | jq .euler_characteristic")]
pub(super) struct Args {
    /// The file; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// Count the top simplices of a tree, by a search for each facet; of a SIG they are always counted
    #[arg(long)]
    tops: bool,

    /// Write a page to a file, too: counts, histograms of clusters and degrees, storage, singularities, and a picture
    #[arg(long, value_name = "OUT")]
    html: Option<PathBuf>,

    /// Replace the file of --html if it exists
    #[arg(long, requires = "html")]
    force: bool,

    /// Print a JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let existing = if self.force { Existing::Replace } else { Existing::Refuse };
        if let Some(page) = &self.html {
            if output::is_stdout(page) {
                return Err(UsageError("--html wants a file, for standard output has the summary".to_owned()).into());
            }
            output::check(page, existing, std::slice::from_ref(&self.file))?;
        }
        if mcc_input::is_one(&self.file) {
            if self.html.is_some() {
                let message = format!("{}: --html is for simplicial complexes", self.file.display());
                return Err(UsageError(message).into());
            }
            return extract::info(&self.file, self.json);
        }
        let input = self.how.open(&self.file, Access::Sequential)?;
        let summary = match input.view() {
            View::Complex(any) => with_complex!(any, complex => Summary::of_complex(&complex)),
            View::Tree(any) => with_tree!(any, tree => Summary {
                top_simplices: self.tops.then(|| progress::during("counting top simplices", || num_top_simplices(&tree))),
                ..Summary::new(&tree, tree.container())
            }),
        };
        if self.json {
            output::json(&summary)?;
        } else {
            output::stdout(|out| summary.print(&self.file, out))?;
        }
        if let Some(path) = &self.html {
            let page = progress::during("drawing", || summary.page(input, &self.file))?;
            output::to_path(path, existing, |out| out.write_all(page.as_bytes()))?;
        }
        Ok(())
    }
}

/// What is in a file; as JSON, the names of the fields.
#[derive(Serialize)]
struct Summary {
    /// Told of trees only.
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<&'static str>,
    /// −1 for the empty complex.
    dimension: i64,
    simplices: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    top_simplices: Option<Vec<usize>>,
    euler_characteristic: i64,
    #[serde(flatten)]
    facts: Option<Facts>,
    index_bits: u32,
    file_bytes: usize,
    format_version: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    storage: Option<Storage>,
    labels: &'static str,
    coordinates: Option<Coordinates>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    attributes: Vec<Attribute>,
    /// The least and the largest filtration value.
    filtration: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    provenance: Option<String>,
    sections: Vec<Section>,
}

/// What a SIG tells at once, for it stores the relations.
#[derive(Serialize)]
struct Facts {
    components: usize,
    h_components: Vec<usize>,
    regular: bool,
    pseudo_manifold: bool,
    /// The κ_p^g that are not zero.
    clusters: Vec<Clusters>,
    /// Simplices with the paper's manifold flag, for each dimension.
    single_cluster: Vec<usize>,
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
    /// Whether the file is that of 7.4.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pairs: bool,
    paper_integers: usize,
    paper_bits: usize,
    file_integers: usize,
    file_bits: usize,
    /// 4.2 if no simplex had the manifold flag.
    paper_general_integers: usize,
    #[serde(skip)]
    paper_general_bits: usize,
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
    fn new(paper: &PaperStorage, file: &FileStorage, pairs: bool) -> Self {
        let expected = if pairs { paper.sig_pairs() } else { paper.sig() };
        Self {
            pairs,
            paper_integers: expected.integers,
            paper_bits: expected.bits,
            file_integers: file.sig().integers,
            file_bits: file.sig().bits,
            paper_general_integers: paper.sig_general().integers,
            paper_general_bits: paper.sig_general().bits,
            incidence_graph_integers: paper.incidence_graph().integers,
            tree_bytes: file.tree_bytes,
            checksum_bytes: file.checksum_bytes,
            other_bytes: file.other_bytes,
            overhead_bytes: file.overhead_bytes,
        }
    }

    /// The integers of the file and of the formulas, by their names.
    fn bars(&self) -> Vec<(String, usize)> {
        let formula = if self.pairs { "paper, 7.4" } else { "paper, 4.2" };
        let bars = [
            ("this file", self.file_integers),
            (formula, self.paper_integers),
            ("4.2, no flags", self.paper_general_integers),
            ("incidence graph", self.incidence_graph_integers),
        ];
        bars.map(|(name, count)| (name.to_owned(), count)).to_vec()
    }

    /// The integers and bits of the paper beside those of the file, as parts of the incidence graph's.
    fn rows(&self) -> Vec<Vec<String>> {
        let row = |name: &str, integers: usize, bits: usize| {
            vec![name.to_owned(), grouped(integers), grouped(bits), percent(integers, self.incidence_graph_integers)]
        };
        vec![
            vec!["storage".to_owned(), "integers".to_owned(), "bits".to_owned(), "of IG".to_owned()],
            row("this file", self.file_integers, self.file_bits),
            row(if self.pairs { "paper, 7.4, pairs" } else { "paper, 4.2" }, self.paper_integers, self.paper_bits),
            row("paper, 4.2, no flags", self.paper_general_integers, self.paper_general_bits),
            row("incidence graph, 7.1", self.incidence_graph_integers, 0),
        ]
    }
}

impl Summary {
    fn of_complex<I: Index>(complex: &Complex<'_, I>) -> Self {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        let analysis = Analysis::new(complex);
        let counts: Vec<ClusterCounts> = (0..dims).map(|dim| complex.cluster_counts(dim)).collect();
        let clusters = counts.iter().enumerate().flat_map(|(p, counts)| {
            let by_dim = counts.by_dim.iter().enumerate().filter(|(_, count)| **count > 0);
            by_dim.map(move |(g, &count)| Clusters { p, g, count })
        });
        let facts = Facts {
            components: analysis.components(),
            h_components: analysis.h_components,
            regular: analysis.is_regular,
            pseudo_manifold: analysis.is_pseudo_manifold,
            clusters: clusters.collect(),
            single_cluster: counts.iter().map(|counts| counts.single_cluster).collect(),
        };
        Self {
            kind: None,
            top_simplices: Some(analysis.top_simplices),
            facts: Some(facts),
            storage: Some(Storage::new(&complex.paper_storage(), &complex.file_storage(), complex.has_pairs())),
            ..Self::new(complex, complex.container())
        }
    }

    /// What every file tells by its header and table.
    fn new(complex: &impl Relations, container: &Container<'_>) -> Self {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        let (major, minor) = container.header().version;
        let sections = container.sections().map(|section| Section {
            name: section.kind.name(),
            dimension: section.dim,
            bytes: section.column.as_bytes().len(),
        });
        Self {
            kind: Some("tree"),
            dimension: i64::try_from(dims).unwrap_or(i64::MAX) - 1,
            simplices: (0..dims).map(|dim| complex.num_simplices_of_dim(dim)).collect(),
            top_simplices: None,
            euler_characteristic: complex.euler_characteristic(),
            facts: None,
            index_bits: container.header().width.bits(),
            file_bytes: container.bytes().len(),
            format_version: format!("{major}.{minor}"),
            storage: None,
            labels: match complex.labels() {
                Labels::Numbered => "numbered",
                Labels::Integers(_) => "integers",
                Labels::Text { .. } => "text",
            },
            coordinates: complex.coordinates().map(|section| Coordinates {
                components: section.components,
                bits: if matches!(section.column, Column::F32(_)) { 32 } else { 64 },
            }),
            attributes: container
                .sections()
                .filter(|section| section.kind == SectionKind::Attribute)
                .filter_map(|format::Section { name, dim, components, column, .. }| {
                    Some(Attribute::new(name, dim?, components as usize, &column))
                })
                .collect(),
            filtration: complex.filtration().filter(|values| !values.is_empty()).map(range),
            provenance: container
                .section(SectionKind::Provenance)
                .and_then(|section| std::str::from_utf8(section.column.as_bytes()).ok().map(str::to_owned)),
            sections: sections.collect(),
        }
    }

    fn print(&self, file: &Path, out: &mut dyn Write) -> io::Result<()> {
        let bytes = grouped(self.file_bytes);
        writeln!(
            out,
            "{}: {} {}, {bytes} bytes, {}-bit indices",
            file.display(),
            if self.kind.is_some() { "simplex tree" } else { "SIG" },
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
        if let Some(storage) = &self.storage {
            table(&storage.rows(), out)?;
            writeln!(out)?;
        }
        table(&self.byte_rows(), out)
    }

    /// The summary with charts and a picture as a page.
    fn page(&self, input: Input, file: &Path) -> anyhow::Result<String> {
        let name = displayed(file);
        with_view!(input.view(), complex => complex.validate())
            .with_context(|| format!("{name}: damaged; see sig verify"))?;
        let mut page = Page::new(&name);
        let kind = if self.kind.is_some() { "simplex tree" } else { "Simplified Incidence Graph" };
        page.paragraph(&format!("{kind}, {} bytes, {}-bit indices", grouped(self.file_bytes), self.index_bits));
        if self.dimension < 0 {
            page.paragraph("The empty complex, of dimension −1.");
            return Ok(page.finish());
        }
        let degrees = with_view!(input.view(), complex => report::degrees(&complex));
        let clusters = match input.view() {
            View::Complex(any) => with_complex!(any, complex => report::clusters(&complex)),
            View::Tree(_) => Vec::new(),
        };
        page.table(&self.simplex_rows(), true);
        if let View::Complex(any) = whole(input, &name)?.view() {
            with_complex!(any, complex => page.complex(&complex, file))?;
        }
        page.heading("Facts");
        page.table(&self.fact_rows(), false);
        page.heading("Storage");
        if let Some(storage) = &self.storage {
            page.table(&storage.rows(), true);
            page.chart("", vec![("integers".to_owned(), storage.bars())])?;
        }
        page.table(&self.byte_rows(), true);
        page.heading("Clusters and degrees");
        let simplices = self.simplices.iter().enumerate().map(|(dim, &count)| (dim.to_string(), count)).collect();
        let mut panels = vec![
            ("simplices, by dimension".to_owned(), simplices),
            ("vertices, by the number of their edges".to_owned(), degrees),
        ];
        panels.extend(clusters);
        page.chart("", panels)?;
        Ok(page.finish())
    }

    /// A row for each dimension: how many simplices; of a SIG, top ones, κ_p^g, flagged ones.
    fn simplex_rows(&self) -> Vec<Vec<String>> {
        let sum = |counts: &[usize]| grouped(counts.iter().sum::<usize>());
        let first = |name: &str, simplices: String| vec![name.to_owned(), simplices];
        let head = first("dimension", "simplices".to_owned());
        let rows = self.simplices.iter().enumerate().map(|(dim, &count)| first(&dim.to_string(), grouped(count)));
        let mut rows: Vec<_> = std::iter::once(head).chain(rows).chain([first("all", sum(&self.simplices))]).collect();
        let Some(tops) = &self.top_simplices else { return rows };
        let mut add = |head: String, cells: &dyn Fn(Dim) -> String, total: String| {
            let cells = (0..self.simplices.len()).map(cells);
            let column = std::iter::once(head).chain(cells).chain([total]);
            rows.iter_mut().zip(column).for_each(|(row, cell)| row.push(cell));
        };
        add("top".to_owned(), &|p| grouped(tops[p]), sum(tops));
        let Some(facts) = &self.facts else { return rows };
        let clusters = &facts.clusters;
        for g in (1..self.simplices.len()).filter(|g| clusters.iter().any(|c| c.g == *g)) {
            let count = |p: Dim| clusters.iter().find(|c| (c.p, c.g) == (p, g)).map_or(0, |c| c.count);
            let all = clusters.iter().filter(|c| c.g == g).map(|c| c.count).sum::<usize>();
            let cell = |p: Dim| if g > p { grouped(count(p)) } else { "-".to_owned() };
            add(format!("{g}-clusters"), &cell, grouped(all));
        }
        let single = &facts.single_cluster;
        add("single cluster".to_owned(), &|p| grouped(single[p]), sum(single));
        rows
    }

    fn fact_rows(&self) -> Vec<Vec<String>> {
        let yes_no = |fact: bool| if fact { "yes" } else { "no" }.to_owned();
        let mut rows = vec![vec!["Euler characteristic".to_owned(), grouped(self.euler_characteristic)]];
        if let Some(facts) = &self.facts {
            rows.push(vec!["connected components".to_owned(), grouped(facts.components)]);
            for (h, &count) in facts.h_components.iter().enumerate().skip(1) {
                rows.push(vec![format!("{h}-connected components"), grouped(count)]);
            }
        }
        let coordinates = match &self.coordinates {
            Some(Coordinates { components, bits }) => format!("{components} of {bits} bits"),
            None => "none".to_owned(),
        };
        if let Some(facts) = &self.facts {
            rows.push(vec!["regular".to_owned(), yes_no(facts.regular)]);
            rows.push(vec!["pseudo-manifold".to_owned(), yes_no(facts.pseudo_manifold)]);
        }
        rows.push(vec!["vertex labels".to_owned(), self.labels.to_owned()]);
        rows.push(vec!["coordinates".to_owned(), coordinates]);
        rows.extend(Attribute::list(&self.attributes).map(|(title, names)| vec![title, names]));
        let filtration = self.filtration.map(|[least, most]| format!("{least} to {most}"));
        rows.push(vec!["filtration values".to_owned(), filtration.unwrap_or("none".to_owned())]);
        if let Some(provenance) = &self.provenance {
            rows.push(vec!["provenance".to_owned(), provenance.clone()]);
        }
        rows
    }

    fn byte_rows(&self) -> Vec<Vec<String>> {
        let bytes_of = |of: &[SectionKind]| {
            let sections = self.sections.iter().filter(|section| of.iter().any(|kind| kind.name() == section.name));
            sections.map(|section| section.bytes).sum::<usize>()
        };
        let relations = bytes_of(&[
            SectionKind::Lookup,
            SectionKind::Boundary,
            SectionKind::Pointers,
            SectionKind::Lists,
            SectionKind::Flags,
            SectionKind::Pairs,
        ]);
        let tree = bytes_of(&[
            SectionKind::ChildOffsets,
            SectionKind::LastVertices,
            SectionKind::LowerOffsets,
            SectionKind::LowerNeighbours,
        ]);
        let checksums = bytes_of(&[SectionKind::Checksums]);
        let all = self.sections.iter().map(|section| section.bytes).sum::<usize>();
        let parts = [
            (if self.kind.is_some() { "lookup" } else { "relations" }, relations),
            ("simplex tree", tree),
            ("labels, coordinates, …", all - relations - tree - checksums),
            ("checksums", checksums),
            ("header and padding", self.file_bytes - all),
            ("file", self.file_bytes),
        ];
        let simplices = self.simplices.iter().sum::<usize>() as f64;
        let row = |(name, bytes): (&str, usize)| {
            let each = format!("{:.2}", bytes as f64 / simplices);
            vec![name.to_owned(), grouped(bytes), percent(bytes, self.file_bytes), each]
        };
        let head = ["bytes", "", "", "a simplex"].map(str::to_owned).to_vec();
        std::iter::once(head).chain(parts.into_iter().map(row)).collect()
    }
}

/// The least and the largest of some values.
fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], &value| [least.min(value), most.max(value)])
}

/// A share in percent, with one decimal; `-` of nothing.
fn percent(part: usize, whole: usize) -> String {
    if whole == 0 {
        return "-".to_owned();
    }
    let tenths = (part as u128 * 1000 + whole as u128 / 2) / whole as u128;
    format!("{}.{} %", tenths / 10, tenths % 10)
}
