//! `sig verify`: whether a file is whole and right.

use std::io;
use std::path::PathBuf;

use serde::Serialize;
use sig_core::format::FormatError;
use sig_core::{AnyComplex, with_complex};
use sig_tools::build::BuildOptions;
use sig_tools::store::{Access, verify};
use sig_tools::{View, with_view};

use super::input::How;
use super::{Silent, mcc_input, output, progress};

/// Check a file: header, structure, checksums, canonical order, and the relations
///
/// Of a multi-resolution complex all refinements are applied and taken back. The checks stop at the first thing that is wrong,
/// say what and where, and the exit code is 1.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig verify bunny.sigc
  sig verify bunny.mcc               also that all refinements can be applied
  sig verify bunny.sigc --rebuild    also compute the partial co-boundary relations again and compare")]
pub(super) struct Args {
    /// The file; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    /// Also build the complex again from its top simplices and compare all relations
    #[arg(long)]
    rebuild: bool,

    /// Print a JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    file: String,
    ok: bool,
    checks: Vec<Check>,
}

#[derive(Serialize)]
struct Check {
    name: &'static str,
    /// `ok`, `failed`, or `skipped`.
    status: &'static str,
    #[serde(skip_serializing_if = "String::is_empty")]
    message: String,
}

impl Check {
    fn new(name: &'static str, result: Result<String, String>) -> Self {
        let (status, message) = match result {
            Ok(message) => ("ok", message),
            Err(message) => ("failed", message),
        };
        Self { name, status, message }
    }
}

/// Told each check that was made.
type Tell<'t> = &'t mut dyn FnMut(Check) -> io::Result<()>;

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let mut report = Report { file: self.file.display().to_string(), ok: true, checks: Vec::new() };
        self.check(&mut |check| {
            report.ok &= check.status != "failed";
            if !self.json {
                print(&report.file, &check)?;
            }
            report.checks.push(check);
            Ok(())
        })?;
        if self.json {
            output::json(&report)?;
        }
        if report.ok { Ok(()) } else { Err(Silent.into()) }
    }

    /// Runs the checks up to the first that fails.
    fn check(&self, tell: Tell<'_>) -> io::Result<()> {
        if mcc_input::is_one(&self.file) {
            return self.check_mcc(tell);
        }
        let input = match self.how.open(&self.file, Access::Sequential) {
            Ok(input) => input,
            Err(error) => return tell(Check::new("structure", Err(error.kind.to_string()))),
        };
        tell(Check::new("structure", Ok("header, section table, lengths".to_owned())))?;
        if !check_bytes(&input.file_bytes(), tell)? {
            return Ok(());
        }
        let view = input.view();
        if let Err(error) = with_view!(view, complex => complex.validate()) {
            return tell(Check::new("arrays", Err(error.to_string())));
        }
        let arrays = match view {
            View::Complex(_) => "canonical order, boundary, partial co-boundary, labels",
            View::Tree(_) => "canonical order, facets of all simplices, lower neighbours, labels",
        };
        tell(Check::new("arrays", Ok(arrays.to_owned())))?;
        match view {
            View::Complex(complex) if self.rebuild => {
                let result = rebuild(complex).map_err(|error| error.to_string());
                tell(Check::new("rebuild", result.map(|()| "the same from the top simplices".to_owned())))
            }
            View::Tree(_) if self.rebuild => {
                // What validation checks is all there is.
                let message = "a tree stores nothing that could be computed again".to_owned();
                tell(Check { name: "rebuild", status: "skipped", message })
            }
            _ => Ok(()),
        }
    }

    /// The same for a multi-resolution complex, or a cell complex.
    fn check_mcc(&self, tell: Tell<'_>) -> io::Result<()> {
        let file = match self.how.open_mcc(&self.file) {
            Ok(file) => file,
            Err(error) => return tell(Check::new("structure", Err(error.kind.to_string()))),
        };
        tell(Check::new("structure", Ok("header, section table, lengths".to_owned())))?;
        if !check_bytes(&file.file_bytes(), tell)? {
            return Ok(());
        }
        let mcc = file.view();
        if let Err(error) = mcc.validate() {
            return tell(Check::new("arrays", Err(error.to_string())));
        }
        let arrays = "arcs, dependencies on earlier refinements only, errors, sites";
        tell(Check::new("arrays", Ok(arrays.to_owned())))?;
        let num = mcc.num_refinements();
        let made = sig_tools::mcc::verify(mcc).map(|euler| match num {
            0 => format!("boundaries of boundaries are zero, Euler characteristic {euler}"),
            _ => format!("all {} applied and taken back, Euler characteristic {euler}", output::grouped(num)),
        });
        tell(Check::new(if num == 0 { "complex" } else { "fronts" }, made.map_err(|error| error.to_string())))
    }
}

/// Whether the checksums are right, or there are none.
fn check_bytes(bytes: &[u8], tell: Tell<'_>) -> io::Result<bool> {
    match verify::checksums(bytes) {
        Ok(blocks) => tell(Check::new("checksums", Ok(format!("{blocks} blocks"))))?,
        Err(error @ FormatError::NoChecksums) => {
            tell(Check { name: "checksums", status: "skipped", message: error.to_string() })?;
        }
        Err(error) => {
            tell(Check::new("checksums", Err(error.to_string())))?;
            return Ok(false);
        }
    }
    Ok(true)
}

fn rebuild(complex: AnyComplex<'_>) -> Result<(), verify::RebuildError> {
    let bars = progress::Phases::new();
    let show = |phase, done, total| bars.show(phase, done, total);
    let progress = progress::is_watched().then_some(&show as sig_tools::build::Progress<'_>);
    let options = BuildOptions { progress, ..BuildOptions::default() };
    let result = with_complex!(complex, complex => verify::rebuild(&complex, &options));
    bars.clear();
    result
}

/// A check that passed is data, one that failed is also an error.
fn print(file: &str, check: &Check) -> io::Result<()> {
    output::stdout(|out| {
        let (name, status, message) = (check.name, check.status, &check.message);
        match status {
            "failed" => writeln!(out, "{name:<10}  {status}"),
            _ => writeln!(out, "{name:<10}  {status:<7}  {message}"),
        }
    })?;
    if check.status == "failed" {
        output::log(format_args!("sig: {file}: {}", check.message));
    }
    Ok(())
}
