//! `sig compare`: the SIG beside the structures that the paper compares it with.

use std::io::{self, Write};
use std::path::PathBuf;

use anyhow::Context;
use sig_tools::baselines::Tops;
use sig_tools::build::{BuildOptions, build};
use sig_tools::compare::{CompareOptions, Comparison, Row, compare};
use sig_tools::io::{self as readers, Format, ReadOptions};
use sig_tools::store::atomic::Existing;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Loaded, with_view};

use super::input::{How, Input};
use super::output::{self, grouped, table};
use super::tree_input::{self, Opened, displayed};
use super::{Threads, UsageError, progress};

/// Compare the SIG with other structures on one complex: space, building, relations
///
/// Builds each structure that can represent the complex from its top simplices, at the least width of integers that holds
/// it: the SIG; the incidence graph (IG); the indexed structure with adjacencies (IA) for pseudo-manifolds; the
/// triangle-segment structure (TS) for dimension 2; the non-manifold one (NMIA) for dimension 3; the
/// combinatorial map (map) for closed orientable quasi-manifolds. Prints what each takes by
/// the paper's formula and measured, and how long each relation takes on simplices drawn at random: mean and, in
/// brackets, the slowest. Other programs on the machine show in the times.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig compare bunny.sigc
  sig compare bracket.msh.gz                a mesh is built first
  sig compare bunny.sigc --formulas         the paper's formulas with the numbers of this complex
  sig compare bunny.sigc --svg bunny.svg    a chart, too
  sig compare bunny.sigc --json | jq '.structures[] | {name, ratio}'")]
pub(super) struct Args {
    /// A file of this program, a mesh or a list of simplices; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// The format of a mesh or list; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,

    /// Print the formulas instead of the times, which are then not measured
    #[arg(long)]
    formulas: bool,

    /// The most simplices of each dimension to ask
    #[arg(long, value_name = "N", default_value_t = CompareOptions::default().samples)]
    samples: usize,

    /// Draw a chart into a file
    #[arg(long, value_name = "OUT")]
    svg: Option<PathBuf>,

    /// Replace the file of --svg if it exists
    #[arg(long, requires = "svg")]
    force: bool,

    #[command(flatten)]
    threads: Threads,

    /// Print a JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let existing = if self.force { Existing::Replace } else { Existing::Refuse };
        if let Some(path) = &self.svg {
            if self.json && output::is_stdout(path) {
                return Err(UsageError("--json and --svg - both want standard output".to_owned()).into());
            }
            output::check(path, existing, std::slice::from_ref(&self.file))?;
        }
        self.threads.start()?;
        let tops = self.read()?;
        let samples = if self.formulas { 0 } else { self.samples };
        let options = CompareOptions { samples, ..CompareOptions::default() };
        let comparison = progress::during("comparing", || compare(&tops, options));
        let comparison = comparison.with_context(|| displayed(&self.file))?;
        if let Some(path) = &self.svg {
            let chart = comparison.chart(&displayed(&self.file)).map_err(|error| anyhow::anyhow!(error))?;
            output::to_path(path, existing, |out| out.write_all(chart.as_bytes()))?;
        }
        if self.json {
            output::json(&comparison)?;
        } else if !self.svg.as_deref().is_some_and(output::is_stdout) {
            output::stdout(|out| print(&comparison, self.formulas, out))?;
        }
        Ok(())
    }

    /// The top simplices of the file.
    fn read(&self) -> anyhow::Result<Tops> {
        let name = displayed(&self.file);
        match tree_input::open(&self.file, &self.how)? {
            Opened::Ours(input) => progress::during("reading", || tops(&input, &name)),
            Opened::Other(reader, length) => {
                let soup = progress::reading_of(length, &name, |progress| {
                    let options = ReadOptions { format: self.format, progress, ..ReadOptions::default() };
                    readers::read(reader, &name, &options)
                });
                let bars = progress::Phases::new();
                let show = |phase, done, total| bars.show(phase, done, total);
                let progress = progress::is_watched().then_some(&show as sig_tools::build::Progress<'_>);
                let built = build(soup?.0, &BuildOptions { progress, ..BuildOptions::default() });
                bars.clear();
                let bytes = Encoding::new(&built?, &EncodeOptions::default())?.to_bytes()?;
                tops(&Input::Loaded(Loaded::from_file_bytes(bytes)?), &name)
            }
        }
    }
}

fn tops(input: &Input, name: &str) -> anyhow::Result<Tops> {
    with_view!(input.view(), complex => {
        complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
        Ok(Tops::of(&complex))
    })
}

fn print(comparison: &Comparison, formulas: bool, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}, {} threads", output::counted(&comparison.simplices), comparison.threads)?;
    writeln!(out)?;
    table(&space(comparison), out)?;
    let refused = comparison.structures.iter().filter_map(|row| Some((row.name, row.refused.as_ref()?)));
    let refused: Vec<_> = refused.collect();
    if !refused.is_empty() {
        writeln!(out)?;
    }
    refused.iter().try_for_each(|(name, why)| writeln!(out, "{name} does not apply: {why}"))?;
    for violation in &comparison.conjecture_violations {
        writeln!(
            out,
            "the conjecture of 7.1 fails: {} has {} {}-clusters and {} cofaces of dimension {}, the first of {} such",
            violation.simplex,
            violation.clusters,
            violation.q,
            violation.cofaces,
            violation.p + 1,
            violation.simplices
        )?;
    }
    if formulas {
        writeln!(out)?;
        return print_formulas(comparison, out);
    }
    let times = times(comparison);
    if times.len() > 1 {
        writeln!(out)?;
        table(&times, out)?;
    }
    Ok(())
}

fn space(comparison: &Comparison) -> Vec<Vec<String>> {
    let cell = |count: Option<usize>| count.map_or_else(|| "-".to_owned(), grouped);
    let row = |row: &Row| {
        vec![
            row.name.to_owned(),
            cell(row.formula_integers),
            cell(row.integers),
            cell(row.formula_bits),
            cell(row.bits),
            cell(row.index_bits),
            cell(row.bytes),
            row.ratio.map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.3}")),
            row.build_seconds.map_or_else(|| "-".to_owned(), time),
        ]
    };
    let head = ["structure", "integers", "measured", "bits", "measured", "width", "bytes", "of SIG", "built in"];
    std::iter::once(head.map(str::to_owned).to_vec()).chain(comparison.structures.iter().map(row)).collect()
}

fn print_formulas(comparison: &Comparison, out: &mut dyn Write) -> io::Result<()> {
    for row in &comparison.structures {
        let Some(([symbols, numbers], [bit_symbols, bit_numbers])) =
            row.formula.as_ref().zip(row.formula_of_bits.as_ref())
        else {
            continue;
        };
        writeln!(out, "{}", row.name)?;
        writeln!(out, "  integers  {symbols}")?;
        writeln!(out, "            {numbers}")?;
        writeln!(out, "  bits      {bit_symbols}")?;
        writeln!(out, "            {bit_numbers}")?;
    }
    Ok(())
}

/// A row for each relation, a column for each structure.
fn times(comparison: &Comparison) -> Vec<Vec<String>> {
    let rows: Vec<&Row> = comparison.structures.iter().filter(|row| row.refused.is_none()).collect();
    let names = rows.iter().map(|row| row.name.to_owned());
    let head = ["relation".to_owned(), "answers".to_owned()].into_iter().chain(names).collect();
    let relations = rows.first().map_or(&[][..], |row| &row.relations);
    let body = relations.iter().enumerate().map(|(number, timing)| {
        let cells = rows.iter().map(|row| {
            let timing = &row.relations[number];
            format!("{} ({})", time(timing.mean_seconds), time(timing.worst_seconds))
        });
        let first = [timing.relation.to_string(), format!("{:.1}", timing.found)];
        first.into_iter().chain(cells).collect()
    });
    std::iter::once(head).chain(body).collect()
}

/// A time in the unit that suits it.
fn time(seconds: f64) -> String {
    match seconds {
        1.0.. => format!("{seconds:.2} s"),
        1e-3.. => format!("{:.2} ms", seconds * 1e3),
        1e-6.. => format!("{:.2} µs", seconds * 1e6),
        _ => format!("{:.0} ns", seconds * 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::time;

    #[test]
    fn times_have_the_unit_that_suits_them() {
        let times = [(2.5, "2.50 s"), (0.0025, "2.50 ms"), (1.5e-6, "1.50 µs"), (5e-8, "50 ns"), (0.0, "0 ns")];
        for (seconds, text) in times {
            assert_eq!(time(seconds), text);
        }
    }
}
