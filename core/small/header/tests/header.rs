//! The header for C is what the code says.

use std::path::Path;

/// With `SIG_BLESS` in the environment the header is written instead.
#[test]
fn the_header_is_that_of_the_code() {
    let ffi = Path::new(env!("CARGO_MANIFEST_DIR")).join("../ffi");
    let mut made = Vec::new();
    cbindgen::generate(&ffi).unwrap().write(&mut made);
    let made = String::from_utf8(made).unwrap();
    let path = ffi.join("include/sig.h");
    if std::env::var_os("SIG_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &made).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == made, "{} is not what the code says; SIG_BLESS=1 cargo test -p header writes it", path.display());
}
