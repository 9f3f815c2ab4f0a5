//! How fast meshes in text are read, on one core, beside a crate for the format, and meshio if Python has it.
//!
//! ```text
//! cargo bench --bench read                      a grid of triangles with a height, in each format
//! cargo bench --bench read -- bunny.off a.vtu   files
//! ```
//!
//! Megabytes are those of the text, 10⁶ bytes. Files are read from the page cache. What the peers read: `tobj`, `ply-rs-bw`,
//! `stl_io` and `vtkio` (legacy and XML) take files, `mshio` bytes, of MSH 4.1 alone; the table says which refused.

use std::error::Error;
use std::fmt::Write;
use std::fs::{self, File};
use std::io::BufReader;
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
    println!("medians of {ROUNDS} rounds (least, most), MB/s\n");
    println!("| file | MB | sig | crate | meshio |\n|---|---|---|---|---|");
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
    for (name, text) in texts.into_iter().chain(more_texts(&points, &triangles)) {
        files.push(folder.join(name));
        fs::write(folder.join(name), text)?;
    }
    Ok(files)
}

/// The grid in formats whose rows are not just numbers.
fn more_texts(points: &[[f64; 3]], triangles: &[[usize; 3]]) -> [(&'static str, String); 4] {
    let (n, t) = (points.len(), triangles.len());
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {n}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {t}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut nodes = String::new();
    let (mut msh2, mut msh4) = (String::new(), String::new());
    for (number, [x, y, z]) in points.iter().enumerate() {
        let _ = writeln!(ply, "{x:.6} {y:.6} {z:.6}");
        let _ = writeln!(msh2, "{} {x:.6} {y:.6} {z:.6}", number + 1);
        let _ = writeln!(msh4, "{}", number + 1);
        let _ = writeln!(nodes, "{x:.6} {y:.6} {z:.6}");
    }
    let _ = write!(msh2, "$EndNodes\n$Elements\n{t}\n");
    let _ = write!(msh4, "{nodes}$EndNodes\n$Elements\n1 {t} 1 {t}\n2 1 2 {t}\n");
    let mut stl = "solid grid\n".to_owned();
    for (number, [a, b, c]) in triangles.iter().enumerate() {
        let _ = writeln!(ply, "3 {a} {b} {c}");
        let _ = writeln!(msh2, "{} 2 2 0 1 {} {} {}", number + 1, a + 1, b + 1, c + 1);
        let _ = writeln!(msh4, "{} {} {} {}", number + 1, a + 1, b + 1, c + 1);
        let _ = write!(stl, "facet normal 0 0 1\n outer loop\n");
        for [x, y, z] in [a, b, c].map(|&corner| points[corner]) {
            let _ = writeln!(stl, "  vertex {x:.6} {y:.6} {z:.6}");
        }
        let _ = write!(stl, " endloop\nendfacet\n");
    }
    let _ = writeln!(stl, "endsolid grid");
    let head = |version| format!("$MeshFormat\n{version} 0 8\n$EndMeshFormat\n");
    let msh2 = format!("{}$Nodes\n{n}\n{msh2}$EndElements\n", head("2.2"));
    let entities = "$Entities\n0 0 1 0\n1 0 0 -1 8 20 1 0 0\n$EndEntities\n";
    let msh4 = format!("{}{entities}$Nodes\n1 {n} 1 {n}\n2 1 0 {n}\n{msh4}$EndElements\n", head("4.1"));
    [("a.ply", ply), ("a.stl", stl), ("a2.msh", msh2), ("a4.msh", msh4)]
}

/// One file, by this project, by the crate for its format, and by meshio in turn.
fn measure(file: &Path) -> Result<(), Box<dyn Error>> {
    #[expect(clippy::cast_precision_loss, reason = "files are small")]
    let megabytes = fs::metadata(file)?.len() as f64 / 1e6;
    let (mut ours, mut crates, mut meshios) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let (seconds, read) = timed(|| read_path(file, &ReadOptions { drop_degenerate: true, ..Default::default() }));
        read?;
        ours.push(megabytes / seconds);
        let (seconds, read) = timed(|| by_crate(file));
        crates.extend(read.is_some().then_some(megabytes / seconds));
        meshios.extend(meshio(file).map(|seconds| megabytes / seconds));
    }
    let show = |rates: Vec<f64>| if rates.is_empty() { "–".to_owned() } else { Timing::of(rates).show(1.0, "") };
    let name = file.file_name().unwrap_or_default().display();
    println!("| {name} | {megabytes:.1} | {} | {} | {} |", show(ours), show(crates), show(meshios));
    Ok(())
}

/// Reads a file by the crate for its format; the number of its vertices or more, if there is such a crate and it reads the
/// file.
fn by_crate(file: &Path) -> Option<usize> {
    match file.extension()?.to_str()? {
        "obj" => {
            let (models, _) = tobj::load_obj(file, &tobj::LoadOptions::default()).ok()?;
            Some(models.iter().map(|model| model.mesh.positions.len()).sum())
        }
        "ply" => {
            let parser = ply_rs_bw::parser::Parser::<ply_rs_bw::ply::DefaultElement>::new();
            let ply = parser.read_ply(&mut BufReader::new(File::open(file).ok()?)).ok()?;
            ply.payload.get("vertex").map(Vec::len)
        }
        "stl" => stl_io::read_stl(&mut BufReader::new(File::open(file).ok()?)).ok().map(|mesh| mesh.vertices.len()),
        "vtk" | "vtu" | "vtp" => {
            let vtk = vtkio::Vtk::import(file).ok()?;
            // Pieces of XML are loaded when they are asked for.
            let vtkio::model::DataSet::UnstructuredGrid { pieces, .. } = vtk.data else { return None };
            pieces.into_iter().map(|piece| Some(piece.into_loaded_piece_data(None).ok()?.num_points())).sum()
        }
        "msh" => {
            let bytes = fs::read(file).ok()?;
            let msh = mshio::parse_msh_bytes(&bytes).ok()?;
            usize::try_from(msh.data.nodes.map_or(0, |nodes| nodes.num_nodes)).ok()
        }
        _ => None,
    }
}

/// The seconds that meshio takes, if it is there and reads the file.
fn meshio(file: &Path) -> Option<f64> {
    let program = "import sys, time, meshio\nstart = time.time()\nmeshio.read(sys.argv[1])\nprint(time.time() - start)";
    let output = Command::new("python3").args(["-c", program]).arg(file).output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().lines().last()?.parse().ok()
}
