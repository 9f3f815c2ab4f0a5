//! What the benchmarks share: timings of several rounds, and the peers' programs.
//!
//! Machines are noisy, so whatever is compared is measured in turn, several rounds, and the medians are printed with
//! their spread. Read the ratios.
#![allow(dead_code, reason = "each benchmark uses a part of it")]

use std::error::Error;
use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use sig_core::relations::Simplices;
use sig_core::{Index, ScratchError, SimplexId};
use sig_tools::points::Points;
use sig_tools::soup::{Labels, Soup};

/// The arguments of a benchmark: without the one that cargo adds.
pub(crate) fn arguments() -> Vec<String> {
    std::env::args().skip(1).filter(|argument| argument != "--bench").collect()
}

/// Median, least and most of some samples: seconds, as a rule.
#[derive(Clone, Copy)]
pub(crate) struct Timing {
    pub(crate) median: f64,
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl Timing {
    pub(crate) fn of(mut samples: Vec<f64>) -> Self {
        samples.sort_by(f64::total_cmp);
        let at = |index: usize| samples.get(index).copied().unwrap_or(f64::NAN);
        Self { median: at(samples.len() / 2), least: at(0), most: at(samples.len().saturating_sub(1)) }
    }

    /// The median with the spread, after multiplication by `factor`.
    pub(crate) fn show(&self, factor: f64, unit: &str) -> String {
        let Self { median, least, most } = self;
        format!("{:.1} {unit} ({:.1}, {:.1})", median * factor, least * factor, most * factor)
    }
}

/// The seconds that some work takes, and its result.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

/// Runs some work on one thread.
pub(crate) fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Box<dyn Error>> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(1).build()?.install(work))
}

/// The peer's program for complexes of points, if the environment names one: see README.md.
pub(crate) fn peer() -> Option<OsString> {
    std::env::var_os("GUDHI_BENCH")
}

/// What a peer's program prints.
pub(crate) fn run(program: &OsStr, arguments: &[&OsStr]) -> Result<String, Box<dyn Error>> {
    let output = Command::new(program).args(arguments).output()?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("{} failed: {message}", program.display()).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// The number that follows a key in what a peer prints: `figure("s=1.5 n=3", "n=")` is 3.
pub(crate) fn figure(text: &str, key: &str) -> Result<f64, Box<dyn Error>> {
    let rest = text.split(key).nth(1).ok_or_else(|| format!("no figure {key} of the peer in:\n{text}"))?;
    let end = rest.find(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c))).unwrap_or(rest.len());
    Ok(rest[..end].parse()?)
}

/// The numbers of simplices by dimension that a peer prints after `dims=`.
pub(crate) fn counts(text: &str) -> Result<Vec<usize>, Box<dyn Error>> {
    let numbers = text.split("dims=").nth(1).and_then(|rest| rest.lines().next()).ok_or("no counts of the peer")?;
    Ok(numbers.split_whitespace().map(str::parse).collect::<Result<_, _>>()?)
}

/// The Freudenthal triangulation of a grid of side³ vertices: six tetrahedra a cube, one for each order of the axes.
pub(crate) fn grid(side: u32) -> Soup {
    let mut soup = Soup::new(Labels::Numbered((side * side * side) as usize), true);
    let steps = [1, side, side * side];
    for corner in (0..side * side * side).filter(|v| steps.iter().all(|step| v / step % side < side - 1)) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let (one, two) = (corner + steps[a], corner + steps[a] + steps[b]);
            soup.push(&[corner, one, two, two + steps[c]]);
        }
    }
    soup
}

/// The largest resident set of this process so far, in bytes; `None` where the system does not tell.
pub(crate) fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches(" kB").parse::<f64>().ok()? * 1024.0)
}

/// Writes points as the peers' programs read them: "PTS1", the dimension, the number, the coordinates, little-endian.
pub(crate) fn write_points(points: &Points, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut bytes = b"PTS1".to_vec();
    bytes.extend(u32::try_from(points.dim())?.to_le_bytes());
    bytes.extend((points.len() as u64).to_le_bytes());
    bytes.extend(points.values().iter().flat_map(|value| value.to_le_bytes()));
    Ok(std::fs::write(path, bytes)?)
}

/// Writes the tetrahedra of a mesh as the peers' programs read them: four 32-bit numbers of vertices each.
pub(crate) fn write_tetrahedra(soup: &Soup, path: &Path) -> Result<(), Box<dyn Error>> {
    Ok(std::fs::write(path, bytemuck::cast_slice(soup.simplices.get(3).map_or(&[][..], Vec::as_slice)))?)
}

/// Numbers with spaces between.
pub(crate) fn listed(numbers: &[usize]) -> String {
    numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(" ")
}

/// The sum of the ids, so that every one of an answer is read; no query here lacks memory.
pub(crate) fn sum<I: Index>(answer: Result<Simplices<'_, I>, ScratchError>) -> usize {
    answer.map_or(0, |simplices| simplices.map(SimplexId::index).sum())
}
