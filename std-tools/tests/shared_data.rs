//! Every file in the folder that `SIG_DATA` names, against what other programs established: the table in its README (the
//! number of simplices of each dimension, the Euler characteristic, Betti numbers over Z/2, the number of points), the
//! headers of the Library of Triangulations, and of raw volumes the counts below. No file is passed over.
//!
//! SIG_DATA=… cargo test -p sig-tools --test shared_data -- --nocapture
//!
//! The folder is too large for the repository, and not all of it may be handed on.

use std::path::{Path, PathBuf};

use sig_tools::build::{Arrays, BuildOptions, Built, Unused, build};
use sig_tools::generate::Triangulation;
use sig_tools::homology::{Coefficients, Homology, HomologyOptions, Simplices, homology};
use sig_tools::io::space::{Space, SpaceOptions, read_space_path};
use sig_tools::io::{Endian, Format, ReadOptions, read_bytes, read_path, read_volume_path};
use sig_tools::soup::Soup;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::volume::Declaration;
use sig_tools::{Loaded, with_view};

/// The parts of raw volumes where samples are at least so much: simplices of each dimension and components, by NumPy and
/// SciPy; and cavities, which are the components of the rest that do not reach the border.
const VOLUMES: [(&str, f64, [usize; 4], usize, usize); 4] = [
    ("neghip_66x66x66_uint8.raw", 64.0, [22_822, 138_441, 221_282, 105_650], 16, 0),
    ("hydrogen_prob_64x64x64_float32.raw.xz", 0.01, [54_264, 354_284, 587_140, 287_162], 1, 0),
    ("ct_cranium_256x256x108_int16.raw.xz", 300.0, [441_114, 2_566_271, 3_986_228, 1_861_258], 80, 94),
    ("mni152_t1_197x233x189_uint8.raw.xz", 150.0, [1_537_150, 10_170_007, 16_942_243, 8_310_062], 15, 178),
];

/// The README of the data, and the folder that it lies in, which is the one that is named or that above.
fn data() -> Option<(String, PathBuf)> {
    let named = std::env::var_os("SIG_DATA").map(PathBuf::from);
    let folders = named.iter().flat_map(|named| [Some(named.as_path()), named.parent()]).flatten();
    let found = folders.into_iter().find_map(|folder| {
        let readme = std::fs::read_to_string(folder.join("README.md")).ok()?;
        Some((readme, folder.to_owned()))
    });
    if found.is_none() {
        println!("SKIPPED: SIG_DATA names no folder of data with a README.md");
    }
    found
}

fn built(soup: Soup) -> Built {
    build(soup, &BuildOptions { unused: Unused::Drop, ..BuildOptions::default() }).unwrap()
}

fn counts(built: &Built) -> Vec<usize> {
    match &built.arrays {
        Arrays::Narrow(arrays) => (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect(),
        Arrays::Wide(arrays) => (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect(),
    }
}

fn homology_of(built: &Built, over: Coefficients) -> Homology {
    let options = EncodeOptions { checksums: false, ..EncodeOptions::default() };
    let bytes = Encoding::new(built, &options).unwrap().to_bytes().unwrap();
    let loaded = Loaded::from_file_bytes(bytes).unwrap();
    let options = HomologyOptions { over, ..HomologyOptions::default() };
    with_view!(loaded.view(), complex => homology(&Simplices(&complex), &options).unwrap())
}

/// The numbers of a list in brackets.
fn numbers(text: &str) -> Option<Vec<usize>> {
    let list = text.trim().strip_prefix('[')?.strip_suffix(']')?;
    list.split(',').map(|number| number.trim().parse().ok()).collect()
}

fn mesh(path: &Path, expected: &[usize], euler: i64, betti: Option<&[usize]>) {
    let options = ReadOptions { drop_degenerate: true, ..ReadOptions::default() };
    let built = built(read_path(path, &options).unwrap().0);
    let found = counts(&built);
    assert_eq!(found, expected, "{}", path.display());
    let signs = found.iter().zip([1, -1].into_iter().cycle());
    assert_eq!(
        signs.map(|(&count, sign)| sign * i64::try_from(count).unwrap()).sum::<i64>(),
        euler,
        "{}",
        path.display()
    );
    if let Some(betti) = betti {
        assert_eq!(homology_of(&built, Coefficients::Prime(2)).betti, betti, "{}", path.display());
    }
}

fn num_points(path: &Path) -> usize {
    match read_space_path(path, &SpaceOptions::default()).unwrap().0 {
        Space::Points(points) => points.len(),
        Space::Distances(distances) => distances.len(),
        Space::Graph { labels, .. } => labels.len(),
    }
}

fn volume(path: &Path, name: &str) {
    let Declaration { sides: Some(sides), sample: Some(sample) } = Declaration::from_file_name(name) else {
        panic!("{name}: the name does not tell what is in it");
    };
    let &(_, least, expected, components, cavities) = VOLUMES.iter().find(|volume| volume.0 == name).unwrap();
    let grid = Triangulation::grid(&sides.0).unwrap();
    let cells: u64 = sides.0.iter().map(|&side| u64::from(side) - 1).product();
    assert_eq!(grid.num_listed(), Some(6 * cells), "{name}");
    let samples = read_volume_path(path, sides, sample, Endian::Little).unwrap();
    let part = grid.induced(samples.values().map(|value| value >= least).collect()).unwrap();
    let mut list = Vec::new();
    part.write_vtu(Some(&samples), &mut list).unwrap();
    let built = built(read_bytes(&list, "part.vtu", &ReadOptions::default()).unwrap().0);
    assert_eq!(counts(&built), expected, "{name}");
    let found = homology_of(&built, Coefficients::Prime(2));
    let euler: i64 = [1, -1, 1, -1].into_iter().zip(expected).map(|(sign, n)| sign * i64::try_from(n).unwrap()).sum();
    let tunnels = i64::try_from(components + cavities).unwrap() - euler;
    assert_eq!(found.betti, [components, usize::try_from(tunnels).unwrap(), cavities, 0], "{name}");
}

/// What stands between `before` and the next bracket that closes, blanks left out: `f=(8,24,17)`, `H_*=(Z,Z_5^3,0,Z)`.
fn header<'a>(text: &'a str, before: &str) -> Option<Vec<&'a str>> {
    let (_, rest) = text.split_once(before)?;
    let (list, _) = rest.split_once('(')?.1.split_once(')')?;
    Some(list.split(',').map(str::trim).collect())
}

/// Checks the f-vector and the homology over the integers that a text of the Library of Triangulations tells.
fn triangulation(name: &str, soup: Soup, properties: &str) {
    let built = built(soup);
    let f: Vec<usize> = header(properties, "f").unwrap().iter().map(|count| count.parse().unwrap()).collect();
    assert_eq!(counts(&built), f, "{name}");
    let groups = header(properties, "H_*=").unwrap();
    let found = homology_of(&built, Coefficients::Integers);
    let group = |dim: usize| {
        let torsion: Vec<_> = found.torsion[dim].iter().map(ToString::to_string).collect();
        match (found.betti[dim], torsion.as_slice()) {
            (0, []) => "0".to_owned(),
            (1, []) => "Z".to_owned(),
            (rank, []) => format!("Z^{rank}"),
            (0, [factor]) => format!("Z_{factor}"),
            (0, [factor, rest @ ..]) if rest.iter().all(|other| other == factor) => {
                format!("Z_{factor}^{}", rest.len() + 1)
            }
            (rank, factors) => format!("Z^{rank}+{factors:?}"),
        }
    };
    assert_eq!((0..f.len()).map(group).collect::<Vec<_>>(), groups, "{name}");
}

/// The complexes of a file with a JSON object on each line.
fn library(path: &Path) {
    let mut text = String::new();
    std::io::Read::read_to_string(&mut flate2::read::GzDecoder::new(std::fs::File::open(path).unwrap()), &mut text)
        .unwrap();
    for line in text.lines() {
        let entry: serde_json::Value = serde_json::from_str(line).unwrap();
        let options = ReadOptions { format: Some(Format::SimplexList), ..ReadOptions::default() };
        let name = entry["name"].as_str().unwrap();
        let (soup, _) = read_bytes(entry["facets"].to_string().as_bytes(), name, &options).unwrap();
        triangulation(name, soup, entry["properties"].as_str().unwrap());
    }
    assert_eq!(text.lines().count(), 41);
}

/// Checks a file, of which the table may have a row.
fn check(path: &Path, readme: &str) {
    let name = path.file_name().unwrap().to_str().unwrap();
    let rows = readme.lines().map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    let row = rows.into_iter().find(|cells| cells.len() > 8 && cells[1] == name);
    if name == "lot.jsonl.gz" {
        return library(path);
    }
    if name.contains(".raw") {
        return volume(path, name);
    }
    if let Some(row) = row {
        if let (Some(expected), Ok(euler)) = (numbers(row[2]), row[3].parse()) {
            return mesh(path, &expected, euler, numbers(row[8]).as_deref());
        }
        // As in `n=13`, `OFF 1307 0 0`, `nOFF 5 10000 0 0`, `[8192, 9]`.
        let words: Vec<_> =
            row[2].split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let at = match words[0] {
            "nOFF" => 2,
            "n" | "OFF" => 1,
            _ => 0,
        };
        return assert_eq!(num_points(path).to_string(), words[at], "{name}");
    }
    // The names of arrays tell their shapes.
    if let Some((_, shape)) = name.strip_suffix(".npy").and_then(|stem| stem.rsplit_once('_')) {
        return assert_eq!(num_points(path).to_string(), shape.split_once('x').unwrap().0, "{name}");
    }
    let (soup, report) = read_path(path, &ReadOptions::default()).unwrap();
    if report.format == Format::Tops {
        // The counts that such a file begins with.
        let head = std::fs::read_to_string(path).unwrap();
        let head = head.lines().next().unwrap().to_owned();
        return assert_eq!(head, format!("{} {}", soup.labels.len(), soup.num_listed()), "{name}");
    }
    triangulation(name, soup, &String::from_utf8_lossy(&std::fs::read(path).unwrap()));
}

#[test]
fn every_file_comes_out_as_other_programs_say() {
    let Some((readme, folder)) = data() else { return };
    let mut checked = 0;
    for folder in ["fixtures", "bench"].map(|name| folder.join(name)) {
        let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        for path in paths {
            let start = std::time::Instant::now();
            check(&path, &readme);
            println!("{:6.2} s  {}", start.elapsed().as_secs_f64(), path.display());
            checked += 1;
        }
    }
    println!("{checked} files are as other programs say");
    assert!(checked >= 50, "only {checked} files");
}
