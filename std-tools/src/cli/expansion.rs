//! From a graph to the file of its flag complex: what `sig rips` and `sig expand` have in common.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use clap::Arg;
use clap::builder::ArgPredicate;
use serde::Serialize;
use sig_core::{Dim, MAX_DIM};
use sig_tools::build::available_memory;
use sig_tools::flag::{self, Accuracy, Estimate, FlagError, FlagOptions};
use sig_tools::frozen::FrozenTree;
use sig_tools::graph::Graph;
use sig_tools::soup::{Coordinates, Labels};

use super::frozen_output::{self, FrozenTarget, Written};
use super::output::{self, grouped};
use super::{Threads, progress};

/// How far a graph is expanded, and where to.
#[derive(clap::Args)]
pub(super) struct Expansion {
    #[command(flatten)]
    target: FrozenTarget,

    /// The largest dimension of a simplex
    #[arg(short = 'k', long, value_name = "K", value_parser = clap::value_parser!(u8).range(0..=MAX_DIM as i64))]
    max_dim: u8,

    /// Print how many simplices there would be and how large the file, and write nothing
    #[arg(long)]
    dry_run: bool,

    /// Stop before the complex takes more memory than this, like 4GiB; by default, more than is free
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    memory: Option<u64>,

    #[command(flatten)]
    threads: Threads,

    /// Print a JSON object on what was read and made
    #[arg(long)]
    json: bool,
}

/// Flag complexes are large, so that relations are computed only when they are asked for.
pub(super) fn tree_by_default(kind: Arg) -> Arg {
    kind.default_value("tree")
}

/// A dry run needs no name for its output.
pub(super) fn none_if_dry_run(output: Arg) -> Arg {
    output.required(false).required_unless_present("dry_run").default_value_if("dry_run", ArgPredicate::IsPresent, "-")
}

/// A number of bytes, like 500000, 4GiB, 4Gi or 4GB.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    const EXPECTED: &str = "not a number of bytes like 500000, 4GiB or 4GB";
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    let (number, unit) = text.split_at(digits);
    let (power, base) = match unit.trim_start().to_ascii_lowercase().as_str() {
        "" | "b" => (0, 1),
        "ki" | "kib" => (1, 1024),
        "mi" | "mib" => (2, 1024),
        "gi" | "gib" => (3, 1024),
        "ti" | "tib" => (4, 1024),
        "kb" => (1, 1000),
        "mb" => (2, 1000),
        "gb" => (3, 1000),
        "tb" => (4, 1000),
        _ => return Err(EXPECTED.to_owned()),
    };
    let number: u64 = number.parse().map_err(|_| EXPECTED.to_owned())?;
    number.checked_mul(u64::pow(base, power)).ok_or_else(|| "more bytes than 64 bits can count".to_owned())
}

/// What the complex is expanded from, and what its vertices are called.
pub(super) struct Skeleton {
    pub(super) graph: Graph,
    pub(super) labels: Labels,
    pub(super) coordinates: Option<Coordinates>,
}

impl Expansion {
    /// Checks, before the input is read, that [`write`](Self::write) will not be refused; begins the threads.
    pub(super) fn check(&self, input: &PathBuf) -> anyhow::Result<()> {
        if !self.dry_run {
            self.target.check(std::slice::from_ref(input), self.json)?;
        }
        self.threads.start()?;
        Ok(())
    }

    /// The most edges that fit the memory that was allowed: while they are sorted each takes twelve bytes.
    pub(super) fn most_edges(&self) -> Option<usize> {
        self.memory.map(|bytes| usize::try_from(bytes / 12).unwrap_or(usize::MAX))
    }

    /// Expands the graph of an input and writes the file, or tells its size in a dry run; `report` is the part of the JSON
    /// object on the input.
    pub(super) fn write(
        &self,
        input: &Path,
        skeleton: Skeleton,
        report: impl Serialize,
        start: Instant,
    ) -> anyhow::Result<()> {
        if self.dry_run {
            let max_dim = self.max_dim.into();
            let estimate = progress::during("counting simplices", || flag::estimate(&skeleton.graph, max_dim, 1));
            return Ok(DryRun::new(report, &estimate, start).print(self.json)?);
        }
        let tree = self.expand(input, skeleton)?;
        let written = frozen_output::write(tree, &self.target, self.memory)?;
        written.log();
        let seconds = start.elapsed().as_secs_f64();
        output::log(format_args!("took   {seconds:.2} s"));
        if self.json {
            output::json(&Made { report, written, seconds })?;
        }
        Ok(())
    }

    /// Expands, unless the tree takes more than there is of memory, or of disk: its file is not smaller.
    fn expand(&self, input: &Path, skeleton: Skeleton) -> anyhow::Result<FrozenTree> {
        let bars = progress::Phases::new();
        let show = |phase, done, total| {
            let what = match phase {
                flag::Phase::Counting => "counting simplices",
                flag::Phase::Values => "filtration values",
                _ => "writing simplices",
            };
            bars.step(what, done, total);
        };
        let memory = self.memory.or_else(available_memory).unwrap_or(u64::MAX);
        let disk = self.target.free_bytes().filter(|&disk| disk < memory);
        let options = FlagOptions {
            max_dim: Dim::from(self.max_dim),
            max_bytes: Some(disk.unwrap_or(memory)),
            progress: progress::is_watched().then_some(&show),
            ..FlagOptions::default()
        };
        let expanded = flag::expand(&skeleton.graph, &options);
        bars.clear();
        let tree = match (expanded, disk) {
            (Err(FlagError::TooManyBytes { bytes, .. }), Some(disk)) => {
                let message = self.target.full_disk(&format!("{} bytes or more", grouped(bytes)), disk);
                anyhow::bail!("{message}; --dry-run tells the size");
            }
            (expanded, _) => expanded.with_context(|| format!("{} (--dry-run tells the size)", input.display()))?,
        };
        Ok(FrozenTree { labels: skeleton.labels, coordinates: skeleton.coordinates, ..tree })
    }
}

/// The JSON object of a complex that was made.
#[derive(Serialize)]
struct Made<R> {
    #[serde(flatten)]
    report: R,
    #[serde(flatten)]
    written: Written,
    seconds: f64,
}

/// What `--dry-run` prints; as JSON, the names of the fields.
#[derive(Serialize)]
struct DryRun<R> {
    #[serde(flatten)]
    report: R,
    simplices: Vec<u64>,
    /// Bytes of a file of kind *tree*, but for its header, coordinates, labels and checksums.
    file_bytes: u64,
    /// `exact`, `estimated`, or `at-least`.
    accuracy: &'static str,
    /// The standard error of the number of simplices, if that is estimated.
    standard_error: Option<f64>,
    seconds: f64,
}

impl<R: Serialize> DryRun<R> {
    fn new(report: R, estimate: &Estimate, start: Instant) -> Self {
        let (accuracy, standard_error) = match estimate.accuracy {
            Accuracy::Exact => ("exact", None),
            Accuracy::Sampled { standard_error, .. } => ("estimated", Some(standard_error)),
            _ => ("at-least", None),
        };
        Self {
            report,
            simplices: estimate.counts.clone(),
            file_bytes: estimate.file_bytes,
            accuracy,
            standard_error,
            seconds: start.elapsed().as_secs_f64(),
        }
    }

    fn print(&self, json: bool) -> std::io::Result<()> {
        if json {
            return output::json(self);
        }
        let all: u64 = self.simplices.iter().fold(0, |sum, &count| sum.saturating_add(count));
        let row = |name: String, count: u64| vec![name, grouped(count)];
        let heading = match self.accuracy {
            "exact" => "simplices",
            "estimated" => "simplices, about",
            _ => "simplices, at least",
        };
        let mut rows = vec![vec!["dimension".to_owned(), heading.to_owned()]];
        rows.extend(self.simplices.iter().enumerate().map(|(dim, &count)| row(dim.to_string(), count)));
        rows.push(row("all".to_owned(), all));
        rows.extend(self.standard_error.map(|error| vec!["standard error".to_owned(), grouped(error.ceil())]));
        rows.push(row("bytes of the tree".to_owned(), self.file_bytes));
        output::stdout(|out| output::table(&rows, out))
    }
}

#[cfg(test)]
mod tests {
    use super::bytes;

    #[test]
    fn sizes_are_read_in_powers_of_ten_and_of_two() {
        let sizes = [("0", 0), ("17", 17), ("4GiB", 4 << 30), ("4 Gi", 4 << 30), ("3kb", 3000), ("2TiB", 2 << 40)];
        for (text, size) in sizes {
            assert_eq!(bytes(text), Ok(size), "{text}");
        }
        for text in ["", "GiB", "4G", "-1", "1.5GiB", "20000000TiB"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }
}
