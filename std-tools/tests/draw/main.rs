//! Pictures: what is seen by a slow rasteriser, what is singular by the definition, counts from the literature, pages in a
//! browser.

mod files;
mod layout;
mod raster;
mod report;
mod singularities;

use std::path::{Path, PathBuf};

use sig_tools::Loaded;
use sig_tools::build::{BuildOptions, build};
use sig_tools::io::{ReadOptions, read_bytes, read_path};
use sig_tools::soup::Soup;
use sig_tools::store::{EncodeOptions, Encoding};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name)
}

fn built(soup: Soup) -> Loaded {
    let built = build(soup, &BuildOptions::default()).unwrap();
    let bytes = Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap();
    Loaded::from_file_bytes(bytes).unwrap()
}

/// A file of the test data, built.
fn file(name: &str) -> Loaded {
    built(read_path(data(name), &ReadOptions::default()).unwrap().0)
}

/// A list of simplices, built.
fn listed(text: &str) -> Loaded {
    built(read_bytes(text.as_bytes(), "list.simplices", &ReadOptions::default()).unwrap().0)
}
