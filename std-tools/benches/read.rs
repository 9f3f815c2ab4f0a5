//! How fast meshes in text are read, on one core, beside meshio if Python has it.
//!
//! ```text
//! cargo bench --bench read                      a grid of triangles with a height, in five formats
//! cargo bench --bench read -- bunny.off a.vtu   files
//! ```
//!
//! Megabytes are those of the text, 10⁶ bytes. Files are read from the page cache.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{Timing, timed};
use sig_tools::io::{ReadOptions, read_path};

mod common;

const ROUNDS: usize = 5;

/// Vertices along a side of the grid.
const SIDE: usize = 600;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = common::arguments();
    println!("medians of {ROUNDS} rounds (least, most), MB/s");
    if !arguments.is_empty() {
        return arguments.iter().try_for_each(|file| measure(Path::new(file)));
    }
    let folder = tempfile::tempdir()?;
    written(folder.path())?.iter().try_for_each(|file| measure(file))
}

/// The grid in each format.
fn written(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for (x, y) in (0..SIDE * SIDE).map(|number| (number % SIDE, number / SIDE)) {
        #[expect(clippy::cast_precision_loss, reason = "sides are small")]
        let (x, y) = (x as f64, y as f64);
        points.push([0.0123 * x, 0.0321 * y, (x / 40.0).sin() * (y / 30.0).cos()]);
    }
    for corner in (0..SIDE * (SIDE - 1)).filter(|number| number % SIDE + 1 < SIDE) {
        triangles.push([corner, corner + 1, corner + SIDE]);
        triangles.push([corner + 1, corner + SIDE + 1, corner + SIDE]);
    }
    let (n, t) = (points.len(), triangles.len());
    // Rows of points and of triangles numbered from `first`, between what stands before and after on a line.
    let rows_of_points = |before: &str, after: &str| {
        points.iter().fold(String::new(), |mut text, [x, y, z]| {
            let _ = writeln!(text, "{before}{x:.6} {y:.6} {z:.6}{after}");
            text
        })
    };
    let rows_of_triangles = |before: &str, after: &str, first: usize| {
        triangles.iter().fold(String::new(), |mut text, [a, b, c]| {
            let _ = writeln!(text, "{before}{} {} {}{after}", a + first, b + first, c + first);
            text
        })
    };
    let numbers = |numbers: &mut dyn Iterator<Item = usize>| {
        numbers.fold(String::new(), |mut text, number| {
            let _ = write!(text, "{number} ");
            text
        })
    };
    let texts = [
        ("a.off", format!("OFF\n{n} {t} 0\n{}{}", rows_of_points("", ""), rows_of_triangles("3 ", "", 0))),
        ("a.obj", format!("{}{}", rows_of_points("v ", ""), rows_of_triangles("f ", "", 1))),
        (
            "a.mesh",
            format!(
                "MeshVersionFormatted 2\nDimension 3\nVertices\n{n}\n{}Triangles\n{t}\n{}End\n",
                rows_of_points("", " 0"),
                rows_of_triangles("", " 0", 1)
            ),
        ),
        (
            "a.vtk",
            format!(
                "# vtk DataFile Version 3.0\ngrid\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {n} double\n{}CELLS {t} {}\n\
                 {}CELL_TYPES {t}\n{}",
                rows_of_points("", ""),
                4 * t,
                rows_of_triangles("3 ", "", 0),
                "5\n".repeat(t)
            ),
        ),
        (
            "a.vtu",
            format!(
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
                 <UnstructuredGrid><Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{t}\"><Points>\n\
                 <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n{}</DataArray></Points><Cells>\n\
                 <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n{}</DataArray>\n\
                 <DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n{}</DataArray>\n\
                 <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n{}</DataArray>\n\
                 </Cells></Piece></UnstructuredGrid></VTKFile>\n",
                rows_of_points("", ""),
                rows_of_triangles("", "", 0),
                numbers(&mut (1..=t).map(|cell| 3 * cell)),
                "5 ".repeat(t)
            ),
        ),
    ];
    let mut files = Vec::new();
    for (name, text) in texts {
        files.push(folder.join(name));
        fs::write(folder.join(name), text)?;
    }
    Ok(files)
}

/// One file, by this project and by meshio in turn.
fn measure(file: &Path) -> Result<(), Box<dyn Error>> {
    #[expect(clippy::cast_precision_loss, reason = "files are small")]
    let megabytes = fs::metadata(file)?.len() as f64 / 1e6;
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let (seconds, read) = timed(|| read_path(file, &ReadOptions { drop_degenerate: true, ..Default::default() }));
        read?;
        ours.push(megabytes / seconds);
        theirs.extend(meshio(file).map(|seconds| megabytes / seconds));
    }
    let peer = if theirs.is_empty() { "not there".to_owned() } else { Timing::of(theirs).show(1.0, "") };
    println!("{}: {megabytes:.1} MB, {}, meshio {peer}", file.display(), Timing::of(ours).show(1.0, ""));
    Ok(())
}

/// The seconds that meshio takes, if it is there and reads the file.
fn meshio(file: &Path) -> Option<f64> {
    let program = "import sys, time, meshio\nstart = time.time()\nmeshio.read(sys.argv[1])\nprint(time.time() - start)";
    let output = Command::new("python3").args(["-c", program]).arg(file).output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().lines().last()?.parse().ok()
}
