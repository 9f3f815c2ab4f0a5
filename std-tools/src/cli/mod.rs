//! The command line: one thin file a subcommand. Each parses its arguments, calls the library and prints.
//!
//! Standard output is data, standard error what is said about the work. Exit codes: 0 done, 1 the data say no or cannot
//! be read or written, 2 the command line is wrong, 128 and its
//! number if a signal ends the work.

mod build;
mod collapse;
mod compare;
mod completions;
mod contract;
mod convert;
mod draw;
mod expand;
mod expansion;
mod export;
mod extract;
mod formats;
mod frozen_output;
mod generate;
mod homology;
mod homology_input;
mod homology_report;
mod info;
mod input;
mod interrupt;
mod man;
mod mcc_input;
mod output;
mod progress;
mod query;
mod report;
mod rips;
mod simplify;
mod sweep;
mod tree;
mod tree_input;
mod verify;
mod volume;
mod witness;

use std::io;
use std::process::ExitCode;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{CommandFactory, Parser, Subcommand};
use sig_tools::io::ReadError;
use sig_tools::store::atomic;

/// Simplicial complexes in flat arrays: build, inspect, query, check and export them.
#[derive(Parser)]
#[command(name = "sig", version, arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  sig build bunny.off -o bunny.sigc     a mesh becomes a complex with all its relations
  sig rips cloud.npy -r 0.3 -o c.sigc   the Rips complex of points
  sig witness c.npy --maxmin 300 -o w.sigc  the witness complex of 300 landmarks among them
  sig collapse c.sigc -o small.sigc     fewer simplices, the same homotopy type
  sig simplify bunny.sigc -o bunny.mcc  a multi-resolution complex of the same homology
  sig extract bunny.mcc -o b.vtu --count 500  a complex of it, as coarse as one likes
  sig info bunny.sigc                   what is in it
  sig query bunny.sigc star 0,17        the star of the edge between vertices 0 and 17
  sig draw bunny.sigc -o bunny.png      a picture of it
  sig compare bunny.sigc                beside other structures: space, building, relations
  sig homology bunny.sigc               components, tunnels, voids, torsion
  sig verify bunny.sigc                 whether it is whole and right
  sig export bunny.sigc -o bunny.vtu    for ParaView
  sig convert part.inp part.vtu         from one format to another; sig formats lists them

Exit codes: 0 done; 1 the data say no, or cannot be read or written; 2 wrong command line; 130
interrupted, and 128 and its number for other signals.";

#[derive(Subcommand)]
enum Command {
    Build(build::Args),
    Generate(generate::Args),
    Rips(rips::Args),
    Witness(witness::Args),
    Expand(expand::Args),
    Collapse(collapse::Args),
    Contract(contract::Args),
    Simplify(simplify::Args),
    Extract(extract::Args),
    Info(info::Args),
    Homology(homology::Args),
    Query(query::Args),
    Sweep(sweep::Args),
    Draw(draw::Args),
    Tree(tree::Args),
    Compare(compare::Args),
    Verify(verify::Args),
    Export(export::Args),
    Convert(convert::Args),
    Formats(formats::Args),
    Completions(completions::Args),
    Man(man::Args),
}

impl Command {
    fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Build(args) => args.run(),
            Self::Generate(args) => args.run(),
            Self::Rips(args) => args.run(),
            Self::Witness(args) => args.run(),
            Self::Expand(args) => args.run(),
            Self::Collapse(args) => args.run(),
            Self::Contract(args) => args.run(),
            Self::Simplify(args) => args.run(),
            Self::Extract(args) => args.run(),
            Self::Info(args) => args.run(),
            Self::Homology(args) => args.run(),
            Self::Query(args) => args.run(),
            Self::Sweep(args) => args.run(),
            Self::Draw(args) => args.run(),
            Self::Tree(args) => args.run(),
            Self::Compare(args) => args.run(),
            Self::Verify(args) => args.run(),
            Self::Export(args) => args.run(),
            Self::Convert(args) => args.run(),
            Self::Formats(args) => args.run(),
            Self::Completions(args) => args.run(),
            Self::Man(args) => args.run(),
        }
    }
}

/// How many threads work.
#[derive(clap::Args)]
struct Threads {
    /// The number of threads; by default one for each processor. The file is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl Threads {
    /// Begins them, if a number was asked for.
    fn start(&self) -> anyhow::Result<()> {
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
        }
        Ok(())
    }
}

/// The command line for generators of completions and manuals.
fn command() -> clap::Command {
    Cli::command()
}

/// A parser of the names of some things, with a description of each in the help.
fn named<T: Copy + Send + Sync>(
    all: &'static [T],
    name: fn(T) -> &'static str,
    description: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let value = |&item: &T| PossibleValue::new(name(item)).help(description(item));
    PossibleValuesParser::new(all.iter().map(value)).try_map(move |text| {
        let found = all.iter().copied().find(|&item| name(item) == text);
        found.ok_or_else(|| UsageError(format!("unknown name '{text}'")))
    })
}

/// What is wrong with a command line, where only the data can tell.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct UsageError(String);

/// That something was said already, and the data say no.
#[derive(Debug, thiserror::Error)]
#[error("the data say no")]
struct Silent;

pub(crate) fn main() -> ExitCode {
    let cli = Cli::parse();
    // Without a handler an interrupt ends the process all the same, and leaves the temporary of a file behind.
    if let Err(error) = handle_signals() {
        output::log(format_args!("sig: warning: cannot handle interrupts: {error}"));
    }
    match cli.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => explain(&error),
    }
}

/// Has the signals that end a process remove the temporary first; the exit code is 128 and the number of the signal. One
/// that is ignored, as `nohup` and shells arrange it, stays ignored.
fn handle_signals() -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXCPU};
    #[cfg(unix)]
    write_errors_instead_of_signals()?;
    let ignored = ignored_signals();
    let handled = [SIGHUP, SIGINT, SIGTERM, SIGXCPU].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = signal_hook::iterator::Signals::new(handled)?;
    std::thread::spawn(move || {
        for signal in signals.forever() {
            if signal != SIGINT || !interrupt::take() {
                atomic::abort(128 + signal);
            }
        }
    });
    Ok(())
}

/// Past the limit of a file's size (`ulimit -f`) a write is to fail with an error that can be told, not to end the process.
#[cfg(unix)]
fn write_errors_instead_of_signals() -> io::Result<()> {
    // A handler that does nothing of use: the signal is taken, and `write` says EFBIG.
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default()).map(|_| ())
}

/// The signals that this process was started to ignore, a bit each; none where the system does not tell.
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Prints an error with its causes, and tells the exit code.
fn explain(error: &anyhow::Error) -> ExitCode {
    let is_broken_pipe = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref::<io::Error>().is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    };
    if error.chain().any(is_broken_pipe) {
        // Whoever reads has read enough.
        return ExitCode::SUCCESS;
    }
    if error.is::<Silent>() {
        return ExitCode::from(1);
    }
    let mut message = error.to_string();
    for cause in error.chain().skip(1) {
        let cause = cause.to_string();
        // Errors of the library say their cause themselves.
        if !message.contains(&cause) {
            message.push_str(": ");
            message.push_str(&cause);
        }
    }
    output::log(format_args!("sig: {message}"));
    if let Some(line) = error.chain().find_map(|cause| cause.downcast_ref::<ReadError>()?.line.as_deref()) {
        output::log(format_args!("{line}"));
    }
    ExitCode::from(if error.is::<UsageError>() { 2 } else { 1 })
}
