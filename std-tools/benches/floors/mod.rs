//! Queries against their floors: sweeps over all simplices beside a sequential pass over the same arrays, and random
//! single queries on a file larger than the cache beside the misses of the cache that they cannot do without.

mod packed;

use std::collections::BTreeMap;
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;

use rayon::prelude::*;
use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, Dim, Index, Relations, Scratch, SimplexId, VertexId, with_complex};
use sig_tools::build::{BuildOptions, build};
use sig_tools::generate::SplitMix64;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::sweep::{Block, Sweep};
use sig_tools::{Mapped, OwnedScratch};

use crate::common::{Timing, grid, on_one_thread, timed};

const ROUNDS: usize = 3;
/// Random simplices asked about.
const SAMPLE: usize = 20_000;
/// The same where a simulator counts.
const FEW: usize = 2_000;

/// Measures on the grid of so many vertices a side, or on the complex in a file: the sweeps, single queries, the packed
/// prototype, or all of them.
pub(crate) fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let argument = |number: usize, default| arguments.get(number).map_or(default, String::as_str);
    let (mesh, what) = (argument(0, "121"), argument(1, "all"));
    let wanted = |part| what == "all" || what == part;
    let folder = tempfile::tempdir()?;
    let built = folder.path().join("grid.sigc");
    let path = match mesh.parse() {
        Ok(side) => {
            let complex = build(grid(side), &BuildOptions::default())?;
            Encoding::new(&complex, &EncodeOptions::default())?.write_to(&mut std::fs::File::create(&built)?)?;
            built.as_path()
        }
        Err(_) => Path::new(mesh),
    };
    let map = Mapped::open(path)?;
    println!("{} bytes, {} threads, medians of {ROUNDS} rounds", map.bytes().len(), rayon::current_num_threads());
    with_complex!(map.complex()?, complex => {
        // All pages are mapped before anything is measured.
        pass(&[map.bytes()], &mut []);
        if wanted("sweeps") {
            sweeps(&complex)?;
        }
        if wanted("single") {
            random(&complex, path)?;
        }
        if wanted("packed") {
            packed::packed(&complex)?;
        }
        Ok(())
    })
}

/// One relation of some random simplices, for a simulator of caches to watch.
pub(crate) fn watched(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let [path, relation, dim, count] = arguments else { return Err("FILE RELATION DIM COUNT".into()) };
    let (dim, count): (Dim, usize) = (dim.parse()?, count.parse()?);
    let map = Mapped::open(path)?;
    with_complex!(map.complex()?, complex => {
        let (simplices, words) = sample(&complex, relation, dim, FEW);
        let mut memory = OwnedScratch::new(&complex);
        let mut scratch = memory.scratch();
        let asked = simplices.iter().zip(&words).take(count);
        black_box(asked.map(|(&simplex, word)| ask(&complex, relation, simplex, word, &mut scratch)).sum::<usize>());
    });
    Ok(())
}

/// A relation of all simplices of a dimension.
#[derive(Clone, Copy)]
enum Swept {
    Star(Dim),
    Cofaces(Dim, Dim),
    Adjacent(Dim),
}

impl Swept {
    fn name(self) -> String {
        match self {
            Self::Star(dim) => format!("star {dim}"),
            Self::Cofaces(dim, above) => format!("C_{dim},{above}"),
            Self::Adjacent(dim) => format!("A_{dim}"),
        }
    }

    /// Of which simplices, and up to which dimension from the next one the boundary rows are read.
    fn dims(self, top: Dim) -> (Dim, Dim) {
        match self {
            Self::Star(dim) => (dim, top),
            Self::Cofaces(dim, above) => (dim, above),
            Self::Adjacent(0) => (0, 1),
            Self::Adjacent(dim) => (dim, dim),
        }
    }

    /// How many answers there are, all of them made.
    fn sweep<I: Index>(self, sweep: &Sweep<'_, '_, I>) -> usize {
        let mut sum = 0;
        let count = |block: &Block<'_, I>| black_box(block).ids().len();
        let each = |found: usize| {
            sum += found;
            Ok::<_, std::convert::Infallible>(())
        };
        let Ok(()) = match self {
            Self::Star(dim) => sweep.star(dim, count, each),
            Self::Cofaces(dim, above) => sweep.coboundary(dim, above, count, each),
            Self::Adjacent(dim) => sweep.adjacency(dim, count, each),
        };
        sum
    }

    /// Seconds that the core takes for all simplices, one after the other: of a part of them in a row, times as many.
    fn one_by_one<I: Index>(self, complex: &Complex<'_, I>, scratch: &mut Scratch<'_, I>) -> f64 {
        const PART: usize = 32;
        let (first, end) = complex.simplices_of_dim(self.dims(0).0).bounds();
        let len = (end.index() - first.index()) / PART;
        let start = first.index() + len * PART / 2;
        let ask = |simplex: SimplexId| {
            let found = match self {
                Self::Star(_) => complex.star(simplex, scratch),
                Self::Cofaces(_, above) => complex.coboundary(simplex, above, scratch),
                Self::Adjacent(_) => complex.adjacency(simplex, scratch),
            };
            found.map_or(0, |found| found.map(black_box).count())
        };
        let (seconds, found) = timed(|| (start..start + len).map(SimplexId::new).map(ask).sum::<usize>());
        black_box(found);
        seconds * PART as f64
    }
}

/// The sweeps beside the pass, on all threads and on one, and beside the queries of the core.
fn sweeps<I: Index>(complex: &Complex<'_, I>) -> Result<(), Box<dyn Error>> {
    let top = complex.dim().ok_or("an empty complex")?;
    let mut memory = OwnedScratch::new(complex);
    let mut scratch = memory.scratch();
    let sweep = Sweep::new(complex);
    println!(
        "\nsweeps beside a pass that reads the arrays involved and writes the answers to memory, on as many threads"
    );
    println!(
        "                                                ----- all threads -----  ------ one thread -----  the core"
    );
    println!(
        "relation      answers   read, MB  answers, MB   pass, ms  sweep, ms  ratio  pass, ms  sweep, ms  ratio    ms"
    );
    let upward = (0..top).flat_map(|dim| {
        std::iter::once(Swept::Star(dim)).chain((dim + 1..=top).map(move |above| Swept::Cofaces(dim, above)))
    });
    for relation in upward.chain((0..=top).map(Swept::Adjacent)) {
        let (dim, last) = relation.dims(top);
        let bytes = match relation {
            // The lists of the file are the answers.
            Swept::Cofaces(..) if dim + 1 == top => arrays(complex, top + 1..=top, true),
            Swept::Adjacent(1..) => arrays(complex, dim..=last, dim == top),
            _ => arrays(complex, dim + 1..=last, false),
        };
        let answers = relation.sweep(&sweep);
        let mut written = vec![1_u8; answers * I::WIDTH.bytes()];
        let mut seconds = [(); 4].map(|()| Vec::new());
        for _ in 0..ROUNDS {
            seconds[0].push(timed(|| pass(&bytes, &mut written)).0);
            seconds[1].push(timed(|| relation.sweep(&sweep)).0);
            seconds[2].push(on_one_thread(|| timed(|| pass(&bytes, &mut written)).0)?);
            seconds[3].push(on_one_thread(|| timed(|| relation.sweep(&sweep)).0)?);
        }
        let [pass, swept, pass_1, swept_1] = seconds.map(|samples| Timing::of(samples).median * 1e3);
        let megabytes = [bytes.iter().map(|bytes| bytes.len()).sum(), written.len()].map(|bytes| bytes as f64 / 1e6);
        let (ratio, ratio_1) = (swept / pass, swept_1 / pass_1);
        let core = relation.one_by_one(complex, &mut scratch) * 1e3;
        println!(
            "{:<10} {answers:>10} {:10.1} {:12.1} {pass:10.1} {swept:10.1} {ratio:6.1} {pass_1:9.1} {swept_1:10.1} {ratio_1:6.1} \
             {core:9.0}",
            relation.name(),
            megabytes[0],
            megabytes[1],
        );
    }
    Ok(())
}

/// The bytes of the boundary rows of some dimensions, and of the pointers and lists.
fn arrays<'a, I: Index>(complex: &Complex<'a, I>, dims: std::ops::RangeInclusive<Dim>, lists: bool) -> Vec<&'a [u8]> {
    let section = |kind| complex.container().section(kind).map_or(&[][..], |section| section.column.as_bytes());
    let rows =
        |dims: std::ops::Range<Dim>| dims.map(|dim| complex.num_simplices_of_dim(dim) * (dim + 1)).sum::<usize>();
    let start = rows(1..*dims.start()) * I::WIDTH.bytes();
    let len = rows(*dims.start()..(dims.end() + 1).max(*dims.start())) * I::WIDTH.bytes();
    let mut arrays = vec![&section(SectionKind::Boundary)[start..start + len]];
    if lists {
        arrays.extend([SectionKind::Pointers, SectionKind::Lists, SectionKind::Pairs].map(section));
    }
    arrays
}

/// Reads some arrays from their starts to their ends, and writes another.
fn pass(read: &[&[u8]], written: &mut [u8]) {
    const PIECE: usize = 1 << 18;
    let word = |word: &[u8]| u64::from_ne_bytes(word.try_into().unwrap_or_default());
    for bytes in read {
        let sum = |piece: &[u8]| piece.chunks_exact(8).map(word).fold(0, u64::wrapping_add);
        black_box(bytes.par_chunks(PIECE).map(sum).reduce(|| 0, u64::wrapping_add));
    }
    written.par_chunks_mut(PIECE).for_each(|piece| piece.fill(2));
    black_box(written);
}

/// What is asked of single simplices, and of which dimension.
const QUESTIONS: [(&str, Dim); 11] = [
    ("facets", 3),
    ("vertices", 3),
    ("find", 3),
    ("is-top", 1),
    ("C_2,3", 2),
    ("C_1,3", 1),
    ("C_0,3", 0),
    ("star", 1),
    ("star", 0),
    ("A_3", 3),
    ("A_0", 0),
];

/// Single queries of random simplices, beside the time of a dependent read at a random place of the same bytes, and the
/// number of lines that a simulated cache had to fetch for them.
fn random<I: Index>(complex: &Complex<'_, I>, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut memory = OwnedScratch::new(complex);
    let mut scratch = memory.scratch();
    let mut times = BTreeMap::new();
    let mut latency = Vec::new();
    for _ in 0..ROUNDS {
        latency.push(dependent_read(complex));
        for question @ (relation, dim) in QUESTIONS {
            let (simplices, words) = sample(complex, relation, dim, SAMPLE);
            // Out of the cache with what the sample took into it.
            latency.push(dependent_read(complex));
            let asked = simplices.iter().zip(&words);
            let (seconds, found) = timed(|| {
                asked.map(|(&simplex, word)| ask(complex, relation, simplex, word, &mut scratch)).sum::<usize>()
            });
            let (samples, answers) = times.entry(question).or_insert((Vec::new(), 0));
            samples.push(seconds / SAMPLE as f64);
            *answers = found;
        }
    }
    let latency = Timing::of(latency);
    println!("\nrandom single queries; a dependent read at a random place: {}", latency.show(1e9, "ns"));
    println!("relation   dim   answers        ns   lines   ns / (lines × latency)");
    for ((relation, dim), (samples, answers)) in times {
        let time = Timing::of(samples).median;
        let answers = answers as f64 / SAMPLE as f64;
        let lines = lines(path, relation, dim).unwrap_or(f64::NAN);
        let ratio = time / (lines * latency.median);
        println!("{relation:<10} {dim:>3} {answers:9.1} {:9.0} {lines:7.1} {ratio:8.2}", time * 1e9);
    }
    Ok(())
}

/// Some simplices of a dimension, drawn with a seed, and where they are to be found by them, their vertices.
fn sample(complex: &impl Relations, relation: &str, dim: Dim, count: usize) -> (Vec<SimplexId>, Vec<Vec<VertexId>>) {
    let mut random = SplitMix64::new(11 + dim as u64);
    let (first, _) = complex.simplices_of_dim(dim).bounds();
    let among = complex.num_simplices_of_dim(dim);
    let simplices: Vec<SimplexId> =
        (0..count).map(|_| SimplexId::new(first.index() + random.next_below(among))).collect();
    let word = |&simplex: &SimplexId| match relation {
        "find" => complex.vertices(simplex).collect(),
        _ => Vec::new(),
    };
    let words = simplices.iter().map(word).collect();
    (simplices, words)
}

/// How many simplices a relation gives; each was looked at.
fn ask<I: Index>(
    complex: &Complex<'_, I>,
    relation: &str,
    simplex: SimplexId,
    word: &[VertexId],
    scratch: &mut Scratch<'_, I>,
) -> usize {
    let count = |found: &mut dyn Iterator<Item = SimplexId>| found.map(black_box).count();
    let up = |found: Result<sig_core::relations::Simplices<'_, I>, _>| found.map_or(0, |mut found| count(&mut found));
    match relation {
        "facets" => count(&mut complex.facets(simplex)),
        "vertices" => count(&mut complex.vertices(simplex).map(SimplexId::from)),
        "find" => count(&mut complex.find(word).into_iter()),
        "is-top" => usize::from(complex.is_top(simplex)),
        "star" => up(complex.star(simplex, scratch)),
        "A_0" | "A_3" => up(complex.adjacency(simplex, scratch)),
        _ => up(complex.coboundary(simplex, 3, scratch)),
    }
}

/// Seconds of a read whose place is known only when the one before it is done, at random places of the boundary, the
/// pointers and the lists.
fn dependent_read<I: Index>(complex: &Complex<'_, I>) -> f64 {
    const READS: usize = 1 << 20;
    let kinds = [SectionKind::Boundary, SectionKind::Pointers, SectionKind::Lists];
    let columns = kinds.map(|kind| complex.container().section(kind).map_or(Column::U8(&[]), |section| section.column));
    let sections: Vec<&[I]> =
        columns.iter().map(|column| bytemuck::try_cast_slice(column.as_bytes()).unwrap_or_default()).collect();
    let longest = sections.iter().max_by_key(|section| section.len()).copied().unwrap_or_default();
    let mut random = SplitMix64::new(5);
    let (seconds, last) = timed(|| {
        (0..READS).fold(0, |last, _| {
            // The value that was read decides, by an odd or even number, though not where to.
            let place = random.next_below(longest.len().max(1)) ^ (last & 1);
            longest.get(place).map_or(0, |value| value.to_usize())
        })
    });
    black_box(last);
    seconds / READS as f64
}

/// Lines of memory that a query fetches, by cachegrind with the caches of this machine; `None` without valgrind.
fn lines(path: &Path, relation: &str, dim: Dim) -> Option<f64> {
    let misses = |count: usize| {
        let output = Command::new("valgrind")
            .args(["--tool=cachegrind", "--cache-sim=yes", "--cachegrind-out-file=/dev/null"])
            .arg(std::env::current_exe().ok()?)
            .arg("watched")
            .arg(path)
            .args([relation, &dim.to_string(), &count.to_string()])
            .output()
            .ok()?;
        let text = String::from_utf8(output.stderr).ok()?;
        // ==1== LLd misses:  1,234  ( 1,200 rd + 34 wr)
        let line = text.lines().find_map(|line| line.split_once("LLd misses:"))?;
        let reads = line.1.split_once('(')?.1.split_whitespace().next()?.replace(',', "");
        reads.parse::<f64>().ok()
    };
    Some((misses(FEW)? - misses(0)?) / FEW as f64)
}
