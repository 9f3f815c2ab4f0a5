//! `sig build --force` ended in every way there is: killed, out of room, forbidden to write. The old file is there, whole,
//! or the new one is; nothing half done has the name, and nothing else is left. And what becomes of those who read a file
//! meanwhile: of one that is replaced, and of one that another program truncates.
//!
//! The full disk and the read-only directory are mounts in a namespace of their own (`unshare`); where that is not
//! allowed, the test says SKIPPED.
#![cfg(target_os = "linux")]

use std::fs;
use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Instant;

use sig_tools::Mapped;

/// How often the build is ended in the ordinary test; `SIG_KILLS` sets another number.
const KILLS: u32 = 40;

/// A directory with two inputs and the files that they become.
struct Place {
    directory: tempfile::TempDir,
    files: [Vec<u8>; 2],
}

impl Place {
    /// A strip of so many triangles, and one more.
    fn new(triangles: usize) -> Self {
        let directory = tempfile::tempdir().unwrap();
        let files = [0, 1].map(|more| {
            let line = |start: usize| format!("{start} {} {}\n", start + 1, start + 2);
            let text: String = (0..triangles + more).map(line).collect();
            fs::write(directory.path().join(format!("{more}.simplices")), text).unwrap();
            let out = directory.path().join(format!("{more}.sigc"));
            let built = build(&directory.path().join(format!("{more}.simplices")), &out).output().unwrap();
            assert!(built.status.success(), "{}", message(&built));
            fs::read(out).unwrap()
        });
        fs::create_dir(directory.path().join("out")).unwrap();
        let place = Self { directory, files };
        fs::write(place.out(), &place.files[0]).unwrap();
        place
    }

    fn input(&self, number: usize) -> PathBuf {
        self.directory.path().join(format!("{number}.simplices"))
    }

    /// The file that is replaced, in a directory of its own.
    fn out(&self) -> PathBuf {
        self.directory.path().join("out/a.sigc")
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.directory.path().join("out")).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    /// Which of the two the file is.
    ///
    /// # Panics
    /// If it is neither.
    fn holds(&self) -> usize {
        let found = fs::read(self.out()).unwrap();
        self.files.iter().position(|file| *file == found).expect("the old file or the new one, whole")
    }
}

fn build(input: &Path, out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sig"));
    command.args(["build", "--threads", "1", "--force"]).arg(input).arg("-o").arg(out);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn end(child: &Child, signal: &str) {
    // The child may have ended by itself.
    let _ = Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status().unwrap();
}

/// Half of the times by `kill -9`, which no program can catch.
#[test]
fn killed_at_any_moment() {
    let place = Place::new(20_000);
    let start = Instant::now();
    assert!(build(&place.input(0), &place.out()).output().unwrap().status.success());
    let whole = start.elapsed();
    let kills = std::env::var("SIG_KILLS").map_or(KILLS, |text| text.parse().unwrap());
    let (mut ended, mut replaced, mut left) = (0, 0, 0);
    for kill in 0..kills {
        let next = 1 - place.holds();
        let mut child = build(&place.input(next), &place.out()).spawn().unwrap();
        // The fractional parts of the multiples of the golden ratio: spread evenly, however many there are.
        sleep(whole.mul_f64((f64::from(kill) * 0.618_033_988_749_895).fract() * 1.1));
        let by_force = kill % 2 == 0;
        end(&child, if by_force { "-KILL" } else { "-TERM" });
        ended += u32::from(!child.wait().unwrap().success());
        replaced += u32::from(place.holds() == next);
        for name in place.names() {
            if name != "a.sigc" {
                assert!(by_force && name.starts_with(".a.sigc.") && name.ends_with(".tmp"), "{name} is left");
                left += 1;
                fs::remove_file(place.out().with_file_name(name)).unwrap();
            }
        }
    }
    println!("{kills} kills: {ended} before the end, {replaced} files replaced, {left} temporaries left by kill -9");
    assert!(ended > 0 && ended + replaced >= kills);
}

/// What is mapped stays what it was.
#[test]
fn a_reader_keeps_the_file_that_it_mapped() {
    let place = Place::new(100);
    let mapped = Mapped::open(place.out()).unwrap();
    assert!(build(&place.input(1), &place.out()).output().unwrap().status.success());
    assert_eq!(place.holds(), 1);
    assert!(mapped.bytes() == place.files[0]);
    assert_eq!(sig_core::with_complex!(mapped.complex().unwrap(), complex => complex.validate()), Ok(()));
}

/// A write that would pass the limit is an error, not the end by a signal.
#[test]
fn a_limit_of_the_size_of_files() {
    let place = Place::new(20_000);
    let mut command = Command::new("sh");
    let limited = "ulimit -f 64; exec \"$0\" build --force \"$1\" -o \"$2\"";
    command.args(["-c", limited, env!("CARGO_BIN_EXE_sig")]).arg(place.input(1)).arg(place.out());
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", message(&output));
    assert!(message(&output).contains("a.sigc: cannot write: File too large"), "{}", message(&output));
    assert_eq!((place.holds(), place.names()), (0, vec!["a.sigc".to_owned()]));
}

/// Runs a shell script where it may mount; its arguments are the program, the input, the old file and a directory to
/// mount on. `None`, and a word about it, where that is not allowed.
fn where_mounts_are_private(place: &Place, script: &str) -> Option<Output> {
    let unshare = |script: &str| {
        let mut command = Command::new("unshare");
        command.args(["--user", "--map-root-user", "--mount", "sh", "-ec", script, env!("CARGO_BIN_EXE_sig")]);
        command.arg(place.input(1)).arg(place.out()).arg(place.directory.path().join("out")).output().ok()
    };
    if !unshare("mount -t tmpfs none \"$3\"").is_some_and(|output| output.status.success()) {
        println!("SKIPPED: no mount namespaces here, so no full disk and no read-only directory");
        return None;
    }
    unshare(script)
}

/// After the program: its exit code, what the directory holds, and whether the file is the old one.
const REPORT: &str = "; echo exit $?; ls -A \"$3\"; cmp \"$2\" /dev/fd/3 && echo old";

fn assert_nothing_changed(output: &Output, why: &str) {
    let report = String::from_utf8_lossy(&output.stdout);
    assert_eq!(report, "exit 1\na.sigc\nold\n", "{}", message(output));
    assert!(message(output).contains("a.sigc: cannot") && message(output).contains(why), "{}", message(output));
}

#[test]
fn a_full_disk() {
    let place = Place::new(20_000);
    assert!(place.files[0].len() > 1 << 20);
    let script = "exec 3<\"$2\" 4<\"$2\"; mount -t tmpfs -o size=$(($(wc -c <\"$2\") + 65536)) none \"$3\"
        cat <&4 >\"$2\"; set +e; \"$0\" build --force \"$1\" -o \"$2\""
        .to_owned()
        + REPORT;
    if let Some(output) = where_mounts_are_private(&place, &script) {
        assert_nothing_changed(&output, "No space left on device");
    }
    assert_eq!(place.holds(), 0);
}

#[test]
fn a_directory_that_is_read_only() {
    let place = Place::new(100);
    let script = "exec 3<\"$2\" 4<\"$2\"; mount -t tmpfs none \"$3\"; cat <&4 >\"$2\"
        mount -o remount,ro \"$3\"; set +e; \"$0\" build --force \"$1\" -o \"$2\""
        .to_owned()
        + REPORT;
    if let Some(output) = where_mounts_are_private(&place, &script) {
        assert_nothing_changed(&output, "Read-only file system");
    }
    assert_eq!(place.holds(), 0);
}

/// A program in the middle of reading a file: `sig export` has written its first byte, and waits, for the rest is more than
/// a pipe holds.
struct Reader {
    child: Child,
    first: u8,
}

impl Reader {
    fn of(place: &Place, flags: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sig"));
        command.arg("export").args(flags).arg(place.out()).args(["-o", "-", "--format", "simplices"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = [0];
        child.stdout.as_mut().unwrap().read_exact(&mut first).unwrap();
        Self { child, first: first[0] }
    }

    /// How it ended, and all that it wrote.
    fn rest(self) -> (Output, Vec<u8>) {
        let output = self.child.wait_with_output().unwrap();
        let text = [&[self.first][..], &output.stdout].concat();
        (output, text)
    }
}

/// What `sig export` writes of the old file when nothing disturbs it: more than a pipe holds.
fn undisturbed(place: &Place) -> Vec<u8> {
    let (output, text) = Reader::of(place, &[]).rest();
    assert!(output.status.success() && text.len() > 1 << 18, "{}", message(&output));
    text
}

/// Mapped or loaded, it is the old file that is read.
#[test]
fn a_file_that_is_replaced_is_read_to_the_end() {
    let place = Place::new(20_000);
    let whole = undisturbed(&place);
    for flags in [&[][..], &["--load"]] {
        fs::write(place.out(), &place.files[0]).unwrap();
        let reader = Reader::of(&place, flags);
        assert!(build(&place.input(1), &place.out()).output().unwrap().status.success());
        assert_eq!(place.holds(), 1);
        let (output, text) = reader.rest();
        assert!(output.status.success() && text == whole, "{flags:?}: {}", message(&output));
    }
}

/// The pages of a truncated file are gone, and the system ends the program that touches them: nothing that a program can
/// prevent, but by not mapping the file. `--load` is that.
#[test]
fn a_file_that_is_truncated_ends_the_program_that_mapped_it() {
    const SIGBUS: i32 = 7;
    let place = Place::new(20_000);
    let whole = undisturbed(&place);
    let truncate = || fs::OpenOptions::new().write(true).open(place.out()).unwrap().set_len(0).unwrap();

    let reader = Reader::of(&place, &[]);
    truncate();
    let (output, text) = reader.rest();
    assert_eq!(output.status.signal(), Some(SIGBUS), "{output:?}");
    assert!(whole.starts_with(&text) && text.len() < whole.len());

    fs::write(place.out(), &place.files[0]).unwrap();
    let reader = Reader::of(&place, &["--load"]);
    truncate();
    let (output, text) = reader.rest();
    assert!(output.status.success() && text == whole, "{}", message(&output));
}

/// The same of the library, in this process.
#[test]
fn a_loaded_file_may_be_truncated() {
    let place = Place::new(100);
    let loaded = sig_tools::Loaded::open(place.out()).unwrap();
    fs::write(place.out(), b"").unwrap();
    assert!(loaded.bytes() == place.files[0]);
    assert_eq!(sig_core::with_complex!(loaded.complex().unwrap(), complex => complex.validate()), Ok(()));
}
