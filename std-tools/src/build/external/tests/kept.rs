//! A build that was interrupted goes on to the same bytes, wherever it was; what is kept of another is refused.

use super::*;
use std::path::Path;

/// The files of a directory, as an interruption at some moment leaves them.
type Snapshot = Vec<(String, Vec<u8>)>;

/// The journal first: what the others hold beyond it is of no use to it.
fn snapshot(directory: &Path) -> Snapshot {
    let names = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort_by_key(|name| (!name.ends_with("journal"), name.clone()));
    names.into_iter().map(|name| (name.clone(), fs::read(directory.join(&name)).unwrap())).collect()
}

fn restore(snapshot: &Snapshot, directory: &Path) {
    let _ = fs::remove_dir_all(directory);
    fs::create_dir(directory).unwrap();
    snapshot.iter().for_each(|(name, bytes)| fs::write(directory.join(name), bytes).unwrap());
}

/// A build in a directory that is kept.
struct Build<'a> {
    soup: Soup,
    options: BuildOptions<'a>,
    encode: EncodeOptions<'a>,
    /// Where it is cut, and the end; nothing if that is to be found, to fit 2 MiB.
    starts: Vec<u32>,
    /// At which reports of progress it may be interrupted.
    is_end: fn(u64) -> bool,
    memory: u64,
    threads: usize,
}

/// The file, how many pieces were found counted and written, and what an interruption at each report of progress would
/// have left.
type Done = (Vec<u8>, [usize; 2], Vec<Snapshot>);

impl Build<'_> {
    fn new(triangulation: &Triangulation) -> Self {
        let end = triangulation.num_vertices();
        Self {
            soup: soup_of(triangulation, true),
            options: BuildOptions::default(),
            encode: EncodeOptions::default(),
            starts: vec![0, 40, 90, 91, 150, end],
            is_end: |_| true,
            memory: 1 << 20,
            threads: 2,
        }
    }

    fn run(&self, directory: &Path) -> Result<Done, Error> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build().unwrap();
        pool.install(|| {
            let kept = Kept::open(directory)?;
            let [_, counted, written] = kept.found().unwrap_or_default();
            let snapshots = Mutex::new(Vec::new());
            let progress = |_, done, _| {
                if (self.is_end)(done) {
                    let mut snapshots = snapshots.lock().unwrap();
                    snapshots.push(snapshot(directory));
                }
            };
            let options = BuildOptions { progress: Some(&progress), ..self.options };
            let spill = Spill::new_in(directory).unwrap();
            let resources = Resources { memory: self.memory, directory, kept: Some(&kept) };
            let cut = if self.starts.is_empty() { Cut::ToFit(2 << 20) } else { Cut::At(&self.starts) };
            build_in_pieces(self.soup.clone(), spill, &options, &self.encode, resources, &cut, kept.file())?;
            let bytes = fs::read(kept.path()).unwrap();
            kept.finish();
            Ok((bytes, [counted, written], snapshots.into_inner().unwrap()))
        })
    }
}

#[test]
fn an_interrupted_build_goes_on_to_the_same_bytes() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("kept");
    for triangulation in [Triangulation::grid(&[5, 6, 7]).unwrap(), Triangulation::random(300, 3, 200, 5).unwrap()] {
        let build = Build::new(&triangulation);
        let (expected, _) = in_memory(&build.soup, &build.options, &build.encode);
        let (bytes, found, snapshots) = build.run(&directory).expect("it fits");
        assert!(bytes == expected && found == [0, 0] && !directory.exists());
        let mut most = [0, 0];
        for snapshot in &snapshots {
            restore(snapshot, &directory);
            let (bytes, [counted, written], later) = build.run(&directory).expect("it goes on");
            assert!(bytes == expected, "with {counted} pieces counted and {written} written");
            assert!(!directory.exists(), "it was made for the first build");
            assert!(counted >= most[0] && written >= most[1]);
            most = [counted, written];
            restore(&later[later.len() / 2], &directory);
            assert!(build.run(&directory).expect("it goes on once more").0 == expected);
        }
        assert_eq!(most, [5, 5]);
    }
}

/// Edges, and between those that are looked at first a few simplices of dimension 12: the pieces are larger than it seemed,
/// and cut again. Interrupted at the start of every step.
#[test]
fn pieces_that_are_cut_again_are_forgotten() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("kept");
    let mut soup = Soup::new(Labels::Numbered(150_000), true);
    (1..150_000).for_each(|end| soup.push(&[end - 1, end]));
    (30..35).for_each(|large| soup.push(&(0..13).map(|vertex| 1000 * large + vertex).collect::<Vec<_>>()));
    let build =
        Build { soup, starts: Vec::new(), is_end: |done| done == 0, ..Build::new(&Triangulation::grid(&[2]).unwrap()) };
    let (expected, _) = in_memory(&build.soup, &build.options, &build.encode);
    let (bytes, _, snapshots) = build.run(&directory).expect("it fits");
    assert!(bytes == expected);
    // Two a time, and the writing.
    assert!(snapshots.len() > 4, "{}", snapshots.len());
    let mut counted_before = Vec::new();
    for snapshot in &snapshots {
        restore(snapshot, &directory);
        let (bytes, [counted, _], _) = build.run(&directory).expect("it goes on");
        assert!(bytes == expected, "with {counted} pieces counted");
        counted_before.push(counted);
    }
    let last = counted_before.pop();
    assert!(last > Some(10) && counted_before.iter().all(|&counted| counted == 0), "{counted_before:?}, {last:?}");
}

/// A build, its bytes, and what an interruption leaves after two of five pieces are written.
fn interrupted() -> (Build<'static>, Vec<u8>, Snapshot) {
    let build = Build { threads: 1, ..Build::new(&Triangulation::grid(&[5, 6, 7]).unwrap()) };
    let place = tempfile::tempdir().unwrap();
    let (bytes, _, mut snapshots) = build.run(place.path()).expect("it fits");
    assert_eq!(snapshot(place.path()), [], "the directory was there before, and is empty");
    (build, bytes, snapshots.swap_remove(snapshots.len() - 4))
}

/// Whatever the journal is, it is seen to be damaged, or tells less; the end of a journal is torn in every way.
#[test]
fn damage_is_an_error_or_more_work() {
    let (build, expected, left) = interrupted();
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("kept");
    let run = |snapshot: &Snapshot| {
        restore(snapshot, &directory);
        build.run(&directory).map(|(bytes, found, _)| (bytes == expected, found))
    };
    assert!(matches!(run(&left), Ok((true, [5, 2]))));
    let journal = &left[0].1;
    let [mut refused, mut shorter] = [0, 0];
    for place in (0..journal.len()).step_by(13) {
        let mut flipped = left.clone();
        flipped[0].1[place] ^= 1 << (place % 8);
        let mut torn = left.clone();
        torn[0].1.truncate(place);
        for damaged in [flipped, torn] {
            match run(&damaged) {
                Ok((is_right, found)) => {
                    assert!(is_right, "{found:?}, damaged at {place}");
                    shorter += usize::from(found < [5, 2]);
                }
                Err(error) => {
                    assert!(matches!(error, Error::Foreign { .. }), "{error}");
                    assert_eq!(snapshot(&directory), damaged, "nothing is removed");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 0 && shorter > 100, "{refused} refused, {shorter} with less");
    // The other files: of what the journal says is there.
    for (data, len) in [(1, 1), (1, 0), (3, 1), (3, 0)] {
        let mut damaged = left.clone();
        let bytes = &mut damaged[data].1;
        match len {
            0 => bytes.truncate(len),
            _ => bytes.iter_mut().for_each(|byte| *byte ^= 1),
        }
        assert!(matches!(run(&damaged), Err(Error::Io(error)) if error.kind() == io::ErrorKind::InvalidData));
        assert_eq!(snapshot(&directory), [], "it is of no use");
    }
    let mut gone = left.clone();
    assert_eq!(gone.remove(2).0, "sig-build.file");
    assert!(matches!(run(&gone), Ok((true, [5, 2]))), "the file is written anew");
}

#[test]
fn what_is_kept_of_another_build_is_refused() {
    let (build, expected, left) = interrupted();
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("kept");
    let Build { soup, options, encode, starts, memory, threads, .. } = &build;
    let other = || Build { soup: soup.clone(), starts: starts.clone(), ..build };
    let mut declared = soup.clone();
    declared.declared = false;
    let mut simplices = soup.clone();
    simplices.simplices[3].swap(0, 1);
    let mut more = soup.clone();
    more.push(&[0, 1]);
    let unused = BuildOptions { unused: Unused::Drop, ..*options };
    let order = BuildOptions { order: VertexOrder::Input, ..*options };
    let width = EncodeOptions { width: Some(IndexWidth::Bits64), ..*encode };
    let others = [
        (Build { soup: declared, ..other() }, "hash of its vertices"),
        (Build { soup: simplices, ..other() }, "hash of its simplices"),
        (Build { soup: more, ..other() }, "number of simplices"),
        (Build { options: unused, ..other() }, "unused vertices"),
        (Build { options: order, ..other() }, "vertex order"),
        (Build { encode: width, ..other() }, "width"),
        (Build { encode: EncodeOptions { tree: false, ..*encode }, ..other() }, "sections"),
        (Build { encode: EncodeOptions { checksums: false, ..*encode }, ..other() }, "sections"),
        (Build { encode: EncodeOptions { provenance: Some("here"), ..*encode }, ..other() }, "provenance"),
        (Build { memory: memory + 1, ..other() }, "memory"),
        (Build { threads: threads + 1, ..other() }, "threads"),
    ];
    restore(&left, &directory);
    for (other, name) in others {
        let error = other.run(&directory).map(drop).expect_err("another build");
        assert!(matches!(&error, Error::OfAnother { what, .. } if what.contains(name)), "{error}");
    }
    assert_eq!(snapshot(&directory), left, "it is as it was");
    let (bytes, found, _) = build.run(&directory).expect("it goes on");
    assert!(bytes == expected && found == [5, 2]);
}

#[test]
fn what_cannot_be_built_is_not_kept() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("kept");
    let build = Build::new(&Triangulation::grid(&[5, 6, 7]).unwrap());
    let few = BuildOptions { max_simplices: Some(100), ..build.options };
    let error = Build { options: few, ..build }.run(&directory).map(drop).expect_err("too many simplices");
    assert!(matches!(error, Error::Build(BuildError::TooLarge { limit: 100, .. })));
    assert!(!directory.exists());
}

#[test]
fn a_directory_is_for_one_build_and_its_own_files() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path();
    let kept = Kept::open(directory).unwrap();
    assert!(matches!(Kept::open(directory), Err(Error::InUse { .. })));
    drop(kept);
    assert_eq!(snapshot(directory), []);
    assert!(matches!(Kept::open(&directory.join("a/b")), Err(Error::Keep { .. })));
    for name in ["sig-build.journal", "sig-build.words", "sig-build.borders", "sig-build.file"] {
        let theirs = vec![(name.to_owned(), b"sig built this?".to_vec()), ("z".to_owned(), Vec::new())];
        let directory = directory.join("theirs");
        restore(&theirs, &directory);
        assert!(matches!(Kept::open(&directory), Err(Error::Foreign { path }) if path == directory.join(name)));
        assert_eq!(snapshot(&directory), theirs);
        fs::remove_file(directory.join(name)).unwrap();
        drop(Kept::open(&directory).unwrap());
        assert_eq!(snapshot(&directory), theirs[1..]);
    }
}
