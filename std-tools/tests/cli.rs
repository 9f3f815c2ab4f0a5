//! The command line: sessions in `tests/cli/*.md`, each run in a directory of its own, and the golden files made again by
//! the commands that made them. Here and not in `tests/`, because cargo builds the binary for the tests of its package.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn tests_dir() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests")
}

/// With `TRYCMD=overwrite` the sessions are written anew, to be reviewed.
#[test]
fn sessions() {
    trycmd::TestCases::new()
        .register_bin("sig", Path::new(env!("CARGO_BIN_EXE_sig")))
        .env("NO_COLOR", "1")
        .env("COLUMNS", "100")
        .case(tests_dir().join("cli/*.md"));
}

/// Runs `sig` in the directory of the golden files, with `input`.
fn sig(arguments: &[&str], input: &str) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_sig"))
        .args(arguments)
        .current_dir(tests_dir().join("data/golden"))
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "sig {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The commands of `tests/data/golden/README.md` give the golden files, byte for byte, with any number of threads.
#[test]
fn golden_files_are_built_again() {
    let directory = tempfile::tempdir().unwrap();
    let golden = tests_dir().join("data/golden");
    let tetrahedra = tests_dir().join("../core/tests/two-tetrahedra.sigc");
    let cases: [(PathBuf, &[&str], &str); 5] = [
        (golden.join("figure-16.sigc"), &["figure.simplices"], ""),
        (golden.join("figure-32.sigc"), &["figure.simplices", "--index-bits", "32"], ""),
        (golden.join("figure-64.sigc"), &["figure.simplices", "--index-bits", "64", "--threads", "1"], ""),
        (golden.join("empty-16.sigc"), &["-", "--format", "simplices"], ""),
        (tetrahedra, &["-", "--format", "simplices"], "0 1 2 3\n1 2 3 4\n4 5\n"),
    ];
    for name in ["figure", "empty"] {
        let (sig_file, tree) = (golden.join(format!("{name}-16.sigc")), golden.join(format!("{name}-tree-16.sigc")));
        let converted = directory.path().join(name);
        let arguments = ["tree", "convert", "--kind", "tree", sig_file.to_str().unwrap(), "-o"];
        sig(&[&arguments[..], &[converted.to_str().unwrap()]].concat(), "");
        assert!(fs::read(&converted).unwrap() == fs::read(&tree).unwrap(), "{}", tree.display());
    }
    for (number, (expected, arguments, input)) in cases.iter().enumerate() {
        let built = directory.path().join(format!("{number}.sigc"));
        sig(&[&["build", "-o", built.to_str().unwrap()], *arguments].concat(), input);
        assert!(fs::read(&built).unwrap() == fs::read(expected).unwrap(), "{}", expected.display());
    }
    let [built, simplified] = ["triangle.sigc", "triangle.mcc"].map(|name| directory.path().join(name));
    sig(&["build", "triangle.off", "-o", built.to_str().unwrap()], "");
    sig(&["simplify", built.to_str().unwrap(), "-o", simplified.to_str().unwrap()], "");
    assert!(fs::read(&simplified).unwrap() == fs::read(golden.join("triangle.mcc")).unwrap(), "triangle.mcc");
}

/// Text, JSON and files: whatever goes there.
#[cfg(target_os = "linux")]
#[test]
fn that_standard_output_is_full_is_told_by_its_name() {
    let golden = tests_dir().join("data/golden");
    for arguments in [
        &["tree", "words", "figure-16.sigc"][..],
        &["info", "figure-16.sigc", "--json"],
        &["expand", "figure-16.sigc", "--max-dim", "3", "-o", "-"],
    ] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_sig"));
        let output = command.args(arguments).current_dir(&golden).stdout(full).stderr(Stdio::piped()).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
        assert!(message.contains("standard output: cannot write: No space left"), "{arguments:?}: {message}");
    }
}
