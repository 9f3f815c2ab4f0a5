//! Progress bars on standard error, if that is a terminal.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use sig_tools::build::Phase;

/// Whether anybody is there to look at a bar.
pub(super) fn is_watched() -> bool {
    std::io::stderr().is_terminal()
}

fn bar(length: Option<u64>, template: &str, message: String) -> ProgressBar {
    let bar = length.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
    // The templates are constants of this file; if one were wrong, the default style would do.
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.with_message(message)
}

/// A bar for the bytes of an input, which are known for a file.
pub(super) fn bytes(length: Option<u64>, name: &str) -> ProgressBar {
    let template = if length.is_some() {
        "{msg:28!} [{bar:30}] {bytes}/{total_bytes} {bytes_per_sec}"
    } else {
        "{msg:28!} {bytes} {bytes_per_sec}"
    };
    bar(length, template, format!("reading {name}"))
}

/// Reads a file, which may be standard input, with a bar for what the reader is to be called with.
pub(super) fn reading<T>(path: &Path, read: impl FnOnce(Option<&(dyn Fn(u64) + Sync)>) -> T) -> T {
    let length = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file).map(|file| file.len());
    reading_of(length, &path.display().to_string(), read)
}

/// The same of an input that is open.
pub(super) fn reading_of<T>(
    length: Option<u64>,
    name: &str,
    read: impl FnOnce(Option<&(dyn Fn(u64) + Sync)>) -> T,
) -> T {
    if !is_watched() {
        return read(None);
    }
    let bar = bytes(length, name);
    let result = read(Some(&|bytes| bar.set_position(bytes)));
    bar.finish_and_clear();
    result
}

/// Does some work of which nobody knows how far it is, and shows meanwhile that it goes on.
pub(super) fn during<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    if !is_watched() {
        return work();
    }
    let bar = bar(None, "{msg:28!} {spinner} {elapsed}", what.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    let result = work();
    bar.finish_and_clear();
    result
}

/// Does some work that tells how much of how much is done, from any thread.
pub(super) fn part_of<T>(what: &'static str, work: impl FnOnce(Option<&(dyn Fn(u64, u64) + Sync)>) -> T) -> T {
    if !is_watched() {
        return work(None);
    }
    let bars = Phases::new();
    let result = work(Some(&|done, total| bars.step(what, done, total)));
    bars.clear();
    result
}

/// Bars for the phases of building, one after the other.
pub(super) struct Phases {
    current: Mutex<Option<(&'static str, ProgressBar)>>,
}

impl Phases {
    pub(super) fn new() -> Self {
        Self { current: Mutex::new(None) }
    }

    /// Shows how far a phase of the builder is.
    pub(super) fn show(&self, phase: Phase, done: u64, total: u64) {
        let what = match phase {
            Phase::Words => "sorting simplices",
            Phase::Levels => "finding faces",
            Phase::Boundary => "boundary relations",
            Phase::Coboundary => "partial co-boundaries",
            Phase::Distribution => "dealing out simplices",
            Phase::Count => "counting pieces",
            Phase::Write => "writing pieces",
            _ => "building",
        };
        self.step(what, done, total);
    }

    /// Shows how far the work is that is called `what`.
    pub(super) fn step(&self, what: &'static str, done: u64, total: u64) {
        let Ok(mut current) = self.current.lock() else { return };
        match &*current {
            Some((shown, bar)) if *shown == what => bar.set_position(done),
            _ => {
                if let Some((_, before)) = current.take() {
                    before.finish_and_clear();
                }
                *current = Some((what, bar(Some(total), "{msg:28!} [{bar:30}] {percent:>3}% {eta}", what.to_owned())));
            }
        }
    }

    pub(super) fn clear(&self) {
        let Ok(mut current) = self.current.lock() else { return };
        if let Some((_, bar)) = current.take() {
            bar.finish_and_clear();
        }
    }
}
