//! `sig build --memory`: the same bytes in the memory that is allowed, and nothing left behind however it ends.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

fn sig(directory: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sig"));
    command.args(arguments).current_dir(directory).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn done(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn names(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A number in a JSON object, by its key.
fn number(json: &str, key: &str) -> u64 {
    let (_, rest) = json.split_once(&format!("\"{key}\":")).unwrap();
    rest.chars().take_while(char::is_ascii_digit).collect::<String>().parse().unwrap()
}

/// 1.6 million simplices: 46 MB, which take 90 MB or more in memory.
#[test]
fn the_same_file_in_less_memory() {
    const MEMORY: u64 = 64 << 20;
    let directory = tempfile::tempdir().unwrap();
    let place = directory.path();
    done(
        &sig(place, &["generate", "grid", "40", "40", "40", "-o", "g.tetbin", "--format", "tetbin"]).output().unwrap(),
    );
    done(&sig(place, &["build", "g.tetbin", "-o", "whole.sigc"]).output().unwrap());
    let whole = fs::read(place.join("whole.sigc")).unwrap();
    let memory = MEMORY.to_string();
    let out_of_core = ["build", "g.tetbin", "-o", "pieces.sigc", "--threads", "2", "--json", "--memory", &memory];
    let json = done(&sig(place, &out_of_core).output().unwrap());
    assert!(fs::read(place.join("pieces.sigc")).unwrap() == whole);
    assert!(number(&json, "pieces") > 4, "{json}");
    assert!(number(&json, "temporary_bytes") <= 2 * whole.len() as u64, "{json}");
    if cfg!(target_os = "linux") {
        assert!(number(&json, "peak_bytes") <= MEMORY, "{json}");
    }
    // Through pipes, and with the temporary data elsewhere.
    fs::create_dir(place.join("elsewhere")).unwrap();
    let piped = ["build", "-", "-o", "-", "--memory", "256MiB", "--temp-dir", "elsewhere"];
    let input = fs::File::open(place.join("g.tetbin")).unwrap();
    let output = sig(place, &piped).stdin(input).output().unwrap();
    assert!(output.status.success() && output.stdout == whole);
    assert_eq!(names(place), ["elsewhere", "g.tetbin", "pieces.sigc", "whole.sigc"]);
    assert!(names(&place.join("elsewhere")).is_empty());
}

/// Ended at many points, by an interrupt as from a terminal and by force.
#[cfg(unix)]
#[test]
fn an_end_leaves_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let place = directory.path();
    done(&sig(place, &["generate", "grid", "30", "30", "30", "-o", "g.txt"]).output().unwrap());
    for (kill, signal) in (0..16).zip(["-INT", "-KILL"].iter().cycle()) {
        let mut child = sig(place, &["build", "g.txt", "-o", "g.sigc", "--memory", "64MiB"]).spawn().unwrap();
        sleep(Duration::from_millis(40 * kill));
        let _ = Command::new("kill").args([signal, child.id().to_string().as_str()]).stderr(Stdio::null()).status();
        let is_done = child.wait().unwrap().success();
        if is_done {
            fs::remove_file(place.join("g.sigc")).unwrap();
        }
        assert_eq!(names(place), ["g.txt"]);
    }
}

/// With `--resume`, interrupted and killed at many points until it is done.
#[cfg(unix)]
#[test]
fn an_interrupted_build_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let place = directory.path();
    done(&sig(place, &["generate", "grid", "30", "30", "30", "-o", "g.txt"]).output().unwrap());
    let build = |out| {
        let arguments = ["build", "g.txt", "-o", out, "--memory", "32MiB", "--threads", "2", "--resume", "work"];
        sig(place, &arguments)
    };
    let start = Instant::now();
    done(&build("whole.sigc").output().unwrap());
    let (time, whole) = (start.elapsed(), fs::read(place.join("whole.sigc")).unwrap());
    let (mut ended, mut resumed) = (0, 0);
    for (round, signal) in (0..8).zip(["-INT", "-KILL"].iter().cycle()) {
        // Spread evenly, and later each time, so that it ends.
        let mut after = time.mul_f64((f64::from(round) * 0.618_033_988_749_895).fract());
        loop {
            let child = build("g.sigc").spawn().unwrap();
            sleep(after);
            let _ = Command::new("kill").args([signal, child.id().to_string().as_str()]).stderr(Stdio::null()).status();
            let output = child.wait_with_output().unwrap();
            resumed += u32::from(String::from_utf8_lossy(&output.stderr).contains("resume work: "));
            if place.join("g.sigc").exists() {
                if !output.status.success() {
                    // Ended between the last step and the removal of what was kept.
                    let _ = fs::remove_dir_all(place.join("work"));
                }
                break;
            }
            ended += 1;
            after += time / 12;
        }
        assert!(fs::read(place.join("g.sigc")).unwrap() == whole);
        fs::remove_file(place.join("g.sigc")).unwrap();
        assert_eq!(names(place), ["g.txt", "whole.sigc"]);
    }
    println!("{ended} ended early, {resumed} found what was done");
    assert!(ended > 0 && resumed > 0);
}

#[test]
fn what_does_not_go_is_told() {
    let directory = tempfile::tempdir().unwrap();
    let place = directory.path();
    fs::write(place.join("a.txt"), "0 1 2\n2 3\n").unwrap();
    let message = |arguments: &[&str]| {
        let output = sig(place, arguments).output().unwrap();
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let two = message(&["build", "a.txt", "a.txt", "-o", "a.sigc", "--memory", "1GiB"]);
    assert!(two.contains("one input"), "{two}");
    let rcm = message(&["build", "a.txt", "-o", "a.sigc", "--memory", "1GiB", "--order", "rcm"]);
    assert!(rcm.contains("edges in memory"), "{rcm}");
    let little = message(&["build", "a.txt", "-o", "a.sigc", "--memory", "1MiB"]);
    assert!(little.contains("1048576"), "{little}");
    let nowhere = message(&["build", "a.txt", "-o", "a.sigc", "--memory", "1GiB", "--temp-dir", "nowhere"]);
    assert!(nowhere.contains("nowhere: cannot keep temporary data"), "{nowhere}");
    assert!(message(&["build", "a.txt", "-o", "a.sigc", "--memory", "1GiB", "--pairs"]).contains("--pairs"));
    assert_eq!(names(place), ["a.txt"]);
}
