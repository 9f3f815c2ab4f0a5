//! The files in the folder that `SIG_DATA` names, against the table in its README, which other programs established: the
//! number of simplices of each dimension of every mesh, and the number of points of every other file.
//!
//! The folder is too large for the repository, and not all of it may be handed on.

use std::path::{Path, PathBuf};

use super::super::space::{Space, SpaceOptions, read_space_path};
use super::super::{ReadOptions, read_path};
use crate::build::{Arrays, BuildOptions, Unused, build};

/// The folders of the data with the README, which lies in or above the folder that is named.
fn folders() -> Option<(String, Vec<PathBuf>)> {
    let named = PathBuf::from(std::env::var_os("SIG_DATA")?);
    let top =
        [named.clone(), named.parent()?.to_owned()].into_iter().find(|folder| folder.join("README.md").exists())?;
    let readme = std::fs::read_to_string(top.join("README.md")).ok()?;
    Some((readme, ["fixtures", "bench", "."].map(|folder| top.join(folder)).into()))
}

/// The numbers of a list in brackets.
fn numbers(text: &str) -> Option<Vec<usize>> {
    let list = text.trim().strip_prefix('[')?.strip_suffix(']')?;
    list.split(',').map(|number| number.trim().parse().ok()).collect()
}

/// The simplices of each dimension.
fn counts(path: &Path) -> Vec<usize> {
    let options = ReadOptions { drop_degenerate: true, ..Default::default() };
    let (soup, _) = read_path(path, &options).unwrap();
    let built = build(soup, &BuildOptions { unused: Unused::Drop, ..BuildOptions::default() }).unwrap();
    match &built.arrays {
        Arrays::Narrow(arrays) => (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect(),
        Arrays::Wide(arrays) => (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect(),
    }
}

fn num_points(path: &Path) -> usize {
    match read_space_path(path, &SpaceOptions::default()).unwrap().0 {
        Space::Points(points) => points.len(),
        Space::Distances(distances) => distances.len(),
        Space::Graph { labels, .. } => labels.len(),
    }
}

#[test]
fn counts_are_those_of_the_table() {
    let Some((readme, folders)) = folders() else {
        println!("SKIPPED: SIG_DATA names no folder of data with a README.md");
        return;
    };
    let (mut meshes, mut spaces) = (0, 0);
    for row in readme.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        let (Some(&name), Some(&size), Some(&euler)) = (cells.get(1), cells.get(2), cells.get(3)) else { continue };
        let Some(path) = folders.iter().map(|folder| folder.join(name)).find(|path| path.is_file()) else { continue };
        if let (Some(expected), Ok(euler)) = (numbers(size), euler.parse::<i64>()) {
            let found = counts(&path);
            assert_eq!(found, expected, "{name}");
            let signs = found.iter().zip([1, -1].into_iter().cycle());
            assert_eq!(signs.map(|(&count, sign)| sign * i64::try_from(count).unwrap()).sum::<i64>(), euler, "{name}");
            meshes += 1;
        } else if !name.ends_with(".raw") {
            // As in `n=13`, `OFF 1307 0 0`, `nOFF 5 10000 0 0`, `[8192, 9]`.
            let words: Vec<_> =
                size.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
            let at = match words[0] {
                "nOFF" => 2,
                "n" | "OFF" => 1,
                _ => 0,
            };
            assert_eq!(num_points(&path).to_string(), words[at], "{name}");
            spaces += 1;
        }
    }
    println!("{meshes} meshes and {spaces} other files are as the table says");
    assert!(meshes >= 20 && spaces >= 6, "{meshes} meshes and {spaces} other files");
}
