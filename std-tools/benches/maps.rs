//! Section 8 of mcc-2012 on real meshes: combinatorial maps beside incidence graphs, and pyramids of 2-maps beside the same
//! simplifications kept as refinements of an incidence graph.
//!
//! ```text
//! SIG_DATA=… cargo bench --bench maps              the meshes of the data set that are found
//! cargo bench --bench maps -- bunny.off skull.msh  meshes in files; TetGen's as `.tetbin.xz`, which `xz` unpacks
//! ```
//!
//! A mesh of tetrahedra has a boundary, and no map: it is counted as it is, and measured with a cone over each component of
//! its boundary, which closes it.

use std::collections::HashMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{Timing, timed};
use sig_core::{CellId, Complex, Index, SimplexId, with_complex};
use sig_tools::Loaded;
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::CellComplex;
use sig_tools::combinatorial_map::{CombinatorialMap, Pyramid, darts_of_simplex, kernels, map_integers};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{EncodeOptions, Encoding};

mod common;

const ROUNDS: usize = 5;

/// Meshes of triangles, the last two of which have no map, and meshes of tetrahedra.
const MESHES: [&str; 10] = [
    "vaselion.off.gz",
    "lucy_50k.ply.gz",
    "turbineblade.ply.gz",
    "igea_from_strips.off.gz",
    "buddha_49950.obj.gz",
    "dragon_vrip.ply.gz",
    "gargoyle.msh.gz",
    "monkey.msh.gz",
    "armadillo_tet.tetbin.xz",
    "lucy_tet.tetbin.xz",
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut meshes: Vec<PathBuf> = common::arguments().into_iter().map(PathBuf::from).collect();
    if meshes.is_empty() {
        let data = std::env::var_os("SIG_DATA").ok_or("name meshes, or a folder of them in SIG_DATA")?;
        meshes = MESHES.iter().map(|mesh| Path::new(&data).join(mesh)).filter(|mesh| mesh.exists()).collect();
    }
    println!(
        "| mesh | n | cells | IG integers | flags B | B (2n+1) | IG / map | darts | integers | IG / map | bytes of map | ns a dart |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut pyramids = Vec::new();
    for mesh in &meshes {
        let soup = read(mesh)?;
        let name = mesh.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let file = filed(soup)?;
        with_complex!(file.complex()?, complex => {
            if let Some(map) = ratio(&name, &complex)?
                && map.dim() == 2
            {
                pyramids.push(pyramid(&name, &complex, map)?);
            }
        });
        let closed = with_complex!(file.complex()?, complex => closed(&complex));
        if let Some(soup) = closed {
            let file = filed(soup)?;
            with_complex!(file.complex()?, complex => ratio(&format!("{name}, closed"), &complex)?);
        }
    }
    println!(
        "\n| mesh | levels | darts | integers of all levels | of the base and a level a cell | base | refinements | sum | bits besides |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    pyramids.iter().for_each(|row| println!("{row}"));
    Ok(())
}

fn filed(soup: Soup) -> Result<Loaded, Box<dyn Error>> {
    let built = build(soup, &BuildOptions::default())?;
    Ok(Loaded::from_file_bytes(Encoding::new(&built, &EncodeOptions::default())?.to_bytes()?)?)
}

/// Prints the row of a complex, with the map if there is one, or why there is none; returns the map.
fn ratio<I: Index>(name: &str, complex: &Complex<'_, I>) -> Result<Option<CombinatorialMap>, Box<dyn Error>> {
    let n = complex.dim().ok_or("an empty complex")?;
    let counts: Vec<usize> = (0..=n).map(|dim| complex.num_simplices_of_dim(dim)).collect();
    let arcs: usize = (1..=n).map(|dim| (dim + 1) * counts[dim]).sum();
    // Two pointers an arc, and the nodes: section 8.
    let graph = 2 * arcs + complex.num_simplices();
    let darts = darts_of_simplex(n).ok_or("too many dimensions")? * counts[n];
    let [flags, own] = [2 * darts, darts].map(|darts| map_integers(n, darts));
    let percent = |map: usize| 100.0 * graph as f64 / map as f64;
    let counts = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
    print!("| {name} | {n} | {counts} | {graph} | {} | {flags} | {:.1} % | ", 2 * darts, percent(flags));
    let map = match CombinatorialMap::new(complex) {
        Ok(map) => map,
        Err(error) => {
            println!("{darts} | {own} | {:.1} % | {error} | |", percent(own));
            return Ok(None);
        }
    };
    assert_eq!((map.num_darts(), map.num_integers()), (darts, own));
    let seconds = (0..ROUNDS).map(|_| timed(|| CombinatorialMap::new(complex).map(drop)).0 / darts as f64).collect();
    let (bytes, time) = (map.bytes(), Timing::of(seconds).show(1e9, "ns"));
    println!("{darts} | {own} | {:.1} % | {bytes} | {time} |", percent(own));
    Ok(Some(map))
}

/// The same kernels as a pyramid and, pair by pair, as refinements of the incidence graph.
fn pyramid<I: Index>(name: &str, complex: &Complex<'_, I>, base: CombinatorialMap) -> Result<String, Box<dyn Error>> {
    let mut graph = CellComplex::from_complex(complex)?;
    let mut pairs: Vec<(SimplexId, SimplexId)> = Vec::new();
    let steps = std::cell::RefCell::new(&mut pairs);
    let pyramid = Pyramid::new(
        base,
        |map| {
            let kernel = kernels::contraction(map);
            steps.borrow_mut().extend(kernel.iter().map(|&(edge, vertex)| (vertex, edge)));
            kernel
        },
        |map| {
            let kernel = kernels::removal(map);
            steps.borrow_mut().extend(&kernel);
            kernel
        },
    )?;
    // Of a refinement: the pair, and the cells that each of them is joined to, with the incidences in the same integers.
    let mut refinements = 0;
    for (low, high) in pairs {
        let [low, high] = [low, high].map(|cell| u32::try_from(cell.index()).map(CellId::new));
        // The last edge of a component stays in the map, and is proposed again.
        if let Ok(refinement) = graph.kill(low?, high?) {
            refinements += 2 + refinement.arcs().len();
        }
    }
    let base = graph.cells().map(|cell| 1 + 2 * graph.num_boundary(cell)).sum::<usize>();
    let (levels, darts) = (pyramid.num_levels(), pyramid.num_darts()[0]);
    let (all, stored, edges) = (pyramid.integers_of_levels(), pyramid.num_integers(), darts / 2);
    let sum = base + refinements;
    Ok(format!("| {name} | {levels} | {darts} | {all} | {stored} | {base} | {refinements} | {sum} | {edges} |"))
}

/// The complex with a cone over each component of its boundary; `None` if it is not of tetrahedra.
fn closed<I: Index>(complex: &Complex<'_, I>) -> Option<Soup> {
    let n = complex.dim().filter(|&n| n == 3)?;
    let words = |dim| complex.simplices_of_dim(dim);
    let word = |simplex| complex.vertices(simplex).map(|vertex| narrow(vertex.index())).collect::<Vec<u32>>();
    let boundary: Vec<Vec<u32>> =
        words(n - 1).filter(|&facet| complex.partial_coboundary(facet).count() == 1).map(word).collect();
    // The component of a triangle by its edges: those of a boundary that touches itself in a vertex are apart.
    let mut at_edges: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (number, triangle) in boundary.iter().enumerate() {
        for [a, b] in [[0, 1], [0, 2], [1, 2]] {
            at_edges.entry([triangle[a], triangle[b]]).or_default().push(number);
        }
    }
    let mut component = vec![usize::MAX; boundary.len()];
    let mut apexes = complex.num_vertices();
    for start in 0..boundary.len() {
        let mut stack = vec![start];
        let next = apexes;
        while let Some(number) = stack.pop() {
            if component[number] != usize::MAX {
                continue;
            }
            component[number] = next;
            apexes = next + 1;
            let triangle = &boundary[number];
            for [a, b] in [[0, 1], [0, 2], [1, 2]] {
                stack.extend(
                    at_edges[&[triangle[a], triangle[b]]].iter().filter(|&&other| component[other] == usize::MAX),
                );
            }
        }
    }
    let mut soup = Soup::new(Labels::Numbered(apexes), false);
    words(n).map(word).for_each(|tetrahedron| soup.push(&tetrahedron));
    for (mut triangle, apex) in boundary.into_iter().zip(component) {
        triangle.push(narrow(apex));
        soup.push(&triangle);
    }
    Some(soup)
}

fn read(mesh: &Path) -> Result<Soup, Box<dyn Error>> {
    if !mesh.to_string_lossy().ends_with(".tetbin.xz") {
        return Ok(sig_tools::io::read_path(mesh, &sig_tools::io::ReadOptions::default())?.0);
    }
    // "TETB", the numbers of vertices and tetrahedra, coordinates, tetrahedra: 32-bit little-endian.
    let output = Command::new("xz").arg("-dc").arg(mesh).output()?;
    let words: Vec<u32> =
        output.stdout.chunks_exact(4).map(|word| word.try_into().map(u32::from_le_bytes)).collect::<Result<_, _>>()?;
    let [_, vertices, tetrahedra, rest @ ..] = words.as_slice() else { return Err("not a mesh of TetGen".into()) };
    let mut soup = Soup::new(Labels::Numbered(*vertices as usize), false);
    let cells = rest.get(3 * *vertices as usize..).ok_or("too short")?.chunks_exact(4);
    cells.take(*tetrahedra as usize).for_each(|tetrahedron| soup.push(tetrahedron));
    Ok(soup)
}

/// The number of a vertex; complexes here have far fewer than 2³².
fn narrow(vertex: usize) -> u32 {
    u32::try_from(vertex).expect("a number of 32 bits")
}
