//! Chains of simplices for other programs to show: the loops, surfaces and bodies that generate homology.

use std::io::{self, Write};

use sig_core::{Dim, Relations, SimplexId, VertexId};

use super::mesh::Mesh;
use super::vtu::{CELL_TYPES, array, head, to_i64};
use super::{ExportError, Format};

/// A chain to be shown.
#[derive(Clone, PartialEq, Debug)]
pub struct NamedChain {
    /// What it is called: in OBJ the name of the group.
    pub name: String,
    /// The number by which it is told from the other ones.
    pub id: i64,
    /// A number of its own: of a cycle the order of its class, 0 if that is infinite.
    pub order: f64,
    /// Its simplices, all of one dimension, and their coefficients.
    pub terms: Vec<(SimplexId, f64)>,
}

/// Writes chains with the vertices that they have: as VTU, with the data `chain`, `order`, `coefficient` and `dimension` of
/// each simplex and the `vertex` of each point, its number in the complex; as OBJ, a group for each chain, simplices with negative
/// coefficients being turned round.
///
/// Cost: linear in the chains and in the number of vertices.
///
/// # Errors
/// [`ExportError`]: OBJ holds no tetrahedra, either format at most three coordinates, no others hold chains.
pub fn export_chains(
    complex: &impl Relations,
    format: Format,
    chains: &[NamedChain],
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    check_chains(complex, format, chains)?;
    let mesh = Mesh::new(complex);
    let vertices_of = |simplex: SimplexId| complex.vertices(simplex);
    // The vertices by number, and the place of each.
    let mut is_used = vec![false; complex.num_vertices()];
    for &(simplex, _) in chains.iter().flat_map(|chain| &chain.terms) {
        vertices_of(simplex).for_each(|vertex| is_used[vertex.index()] = true);
    }
    let used: Vec<usize> = (0..is_used.len()).filter(|&vertex| is_used[vertex]).collect();
    let mut places = vec![0; is_used.len()];
    used.iter().enumerate().for_each(|(place, &vertex)| places[vertex] = place);
    let cells = chains.iter().flat_map(|chain| {
        chain.terms.iter().map(|&(simplex, coefficient)| {
            let corners: Vec<usize> = vertices_of(simplex).map(|vertex| places[vertex.index()]).collect();
            Cell { chain, coefficient, corners }
        })
    });
    match format {
        Format::Obj => write_obj(&mesh, &used, chains, cells, out)?,
        _ => write_vtu(&mesh, &used, &cells.collect::<Vec<_>>(), out)?,
    }
    Ok(())
}

/// Checks what [`export_chains`] would refuse.
///
/// # Errors
/// All of [`ExportError`] but [`ExportError::Io`].
pub fn check_chains(complex: &impl Relations, format: Format, chains: &[NamedChain]) -> Result<(), ExportError> {
    if !matches!(format, Format::Obj | Format::Vtu) {
        return Err(ExportError::NoChains { format });
    }
    let dims = chains.iter().flat_map(|chain| &chain.terms).filter_map(|(simplex, _)| complex.dim_of(*simplex));
    if let Some(dim) = dims.max().filter(|&dim| dim > format.max_dim()) {
        return Err(ExportError::Dimension { format, dim });
    }
    let components = complex.coordinates().ok_or(ExportError::NoCoordinates { format })?.components as usize;
    if components > 3 { Err(ExportError::Coordinates { format, components }) } else { Ok(()) }
}

/// A simplex of a chain.
struct Cell<'c> {
    chain: &'c NamedChain,
    coefficient: f64,
    /// Its vertices, by their places in the output.
    corners: Vec<usize>,
}

impl Cell<'_> {
    fn dim(&self) -> Dim {
        self.corners.len() - 1
    }
}

/// The coordinates of a vertex, filled up to three.
fn point<V: Relations>(mesh: &Mesh<'_, V>, vertex: usize) -> [f64; 3] {
    let mut point = [0.0; 3];
    point.iter_mut().zip(mesh.row(VertexId::new(vertex))).for_each(|(value, row)| *value = mesh.value(row));
    point
}

fn write_obj<'c, V: Relations>(
    mesh: &Mesh<'_, V>,
    used: &[usize],
    chains: &[NamedChain],
    cells: impl Iterator<Item = Cell<'c>>,
    out: &mut dyn Write,
) -> io::Result<()> {
    for &vertex in used {
        let [x, y, z] = point(mesh, vertex);
        writeln!(out, "v {x:?} {y:?} {z:?}")?;
    }
    let mut cells = cells;
    for chain in chains {
        writeln!(out, "g {}", chain.name)?;
        for Cell { coefficient, mut corners, .. } in cells.by_ref().take(chain.terms.len()) {
            if coefficient < 0.0 {
                corners.reverse();
            }
            out.write_all(match corners.len() {
                1 => b"p",
                2 => b"l",
                _ => b"f",
            })?;
            corners.iter().try_for_each(|corner| write!(out, " {}", corner + 1))?;
            writeln!(out)?;
        }
    }
    Ok(())
}

fn write_vtu<V: Relations>(
    mesh: &Mesh<'_, V>,
    used: &[usize],
    cells: &[Cell<'_>],
    out: &mut dyn Write,
) -> io::Result<()> {
    let corners: usize = cells.iter().map(|cell| cell.corners.len()).sum();
    head(out, used.len(), cells.len())?;
    writeln!(out, r#"<PointData Scalars="vertex">"#)?;
    array(out, r#"type="Int64" Name="vertex""#, used.len() * 8, |data| {
        used.iter().try_for_each(|&vertex| data.write_all(&to_i64(vertex)))
    })?;
    writeln!(out, "</PointData>\n<CellData Scalars=\"chain\">")?;
    let mut column = |attributes: &str, value: fn(&Cell<'_>) -> [u8; 8]| {
        array(out, attributes, cells.len() * 8, |data| cells.iter().try_for_each(|cell| data.write_all(&value(cell))))
    };
    column(r#"type="Int64" Name="chain""#, |cell| cell.chain.id.to_le_bytes())?;
    column(r#"type="Float64" Name="coefficient""#, |cell| cell.coefficient.to_le_bytes())?;
    column(r#"type="Float64" Name="order""#, |cell| cell.chain.order.to_le_bytes())?;
    column(r#"type="Int64" Name="dimension""#, |cell| to_i64(cell.dim()))?;
    writeln!(out, "</CellData>\n<Points>")?;
    array(out, r#"type="Float64" NumberOfComponents="3""#, used.len() * 24, |data| {
        let values = used.iter().flat_map(|&vertex| point(mesh, vertex));
        values.into_iter().try_for_each(|value| data.write_all(&value.to_le_bytes()))
    })?;
    writeln!(out, "</Points>\n<Cells>")?;
    array(out, r#"type="Int64" Name="connectivity""#, corners * 8, |data| {
        cells.iter().flat_map(|cell| &cell.corners).try_for_each(|&corner| data.write_all(&to_i64(corner)))
    })?;
    array(out, r#"type="Int64" Name="offsets""#, cells.len() * 8, |data| {
        let mut end = 0;
        cells.iter().try_for_each(|cell| {
            end += cell.corners.len();
            data.write_all(&to_i64(end))
        })
    })?;
    array(out, r#"type="UInt8" Name="types""#, cells.len(), |data| {
        cells.iter().try_for_each(|cell| data.write_all(&[CELL_TYPES[cell.dim()]]))
    })?;
    writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}
