//! An interrupt in the middle of `sig simplify`: the file is written all the same, whole, with what was done until then.
#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Instant;

use sig_tools::mcc::MccFile;

fn sig(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sig"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn succeeded(output: &Output) -> bool {
    assert!(output.status.code() != Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    output.status.success()
}

/// Whether who started the tests has interrupts ignored; `sig` keeps to that.
fn are_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & 1 << 1 != 0
}

#[test]
fn what_was_done_is_written() {
    if are_ignored() {
        println!("SKIPPED: interrupts are ignored");
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (input, built, out) = (path("strip.simplices"), path("strip.sigc"), path("strip.mcc"));
    let line = |start: usize| format!("{start} {} {}\n", start + 1, start + 2);
    std::fs::write(&input, (0..150_000).map(line).collect::<String>()).unwrap();
    assert!(succeeded(&sig(&["build", &input, "-o", &built]).output().unwrap()));
    let simplify = ["simplify", &built, "-o", &out, "--force", "--json"];
    let start = Instant::now();
    assert!(succeeded(&sig(&simplify).output().unwrap()));
    let whole = start.elapsed();
    let mut interrupted = 0;
    for at in 1..20 {
        let _ = std::fs::remove_file(&out);
        let child = sig(&simplify).spawn().unwrap();
        sleep(whole * at / 20);
        // It may have ended by itself.
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status().unwrap();
        let output = child.wait_with_output().unwrap();
        // While it reads, and when all is written, an interrupt ends the program.
        if !succeeded(&output) {
            continue;
        }
        let file = MccFile::open(Path::new(&out)).unwrap();
        let mcc = file.view();
        mcc.validate().unwrap();
        assert_eq!(mcc.num_cells(), 150_002 + 300_001 + 150_000);
        let json = String::from_utf8(output.stdout).unwrap();
        assert!(json.contains(&format!("\"simplifications\":{},", mcc.num_refinements())), "{json}");
        interrupted += usize::from(json.contains("\"interrupted\":true") && mcc.num_base_cells() > 1);
    }
    println!("{interrupted} of 19 were interrupted while they simplified");
    assert!(interrupted > 0);
}
