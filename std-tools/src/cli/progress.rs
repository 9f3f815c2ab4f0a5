//! Progress bars on standard error, if that is a terminal.

use std::io::IsTerminal;
use std::sync::Mutex;

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
                *current = Some((what, bar(Some(total), "{msg:28!} [{bar:30}] {percent}%", what.to_owned())));
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
