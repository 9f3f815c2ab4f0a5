//! VTK's XML format for poly data: vertices, lines and triangles in lists of their own, arrays inline in base64, with
//! the data of points and cells that the format for unstructured grids has.

use std::io::{self, Write};

use sig_core::Relations;

use super::attributes::Losses;
use super::mesh::Mesh;
use super::vtu::{array, data, points, to_i64};

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let [verts, lines, polys, _] = mesh.num_cells();
    writeln!(out, r#"<?xml version="1.0"?>"#)?;
    writeln!(out, r#"<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#)?;
    writeln!(out, "<PolyData>")?;
    write!(out, r#"<Piece NumberOfPoints="{}" NumberOfVerts="{verts}" "#, mesh.num_vertices())?;
    writeln!(out, r#"NumberOfLines="{lines}" NumberOfStrips="0" NumberOfPolys="{polys}">"#)?;
    let losses = data(mesh, 2, out)?;
    writeln!(out, "<Points>")?;
    points(mesh, out)?;
    writeln!(out, "</Points>")?;
    for (dim, (name, count)) in [("Verts", verts), ("Lines", lines), ("Polys", polys)].into_iter().enumerate() {
        writeln!(out, "<{name}>")?;
        array(out, r#"type="Int64" Name="connectivity""#, count * (dim + 1) * 8, |data| {
            mesh.cells(dim..=dim, |cell| cell.iter().try_for_each(|&vertex| data.write_all(&to_i64(vertex))))
        })?;
        array(out, r#"type="Int64" Name="offsets""#, count * 8, |data| {
            (1..=count).try_for_each(|cell| data.write_all(&to_i64(cell * (dim + 1))))
        })?;
        writeln!(out, "</{name}>")?;
    }
    writeln!(out, "</Piece>\n</PolyData>\n</VTKFile>")?;
    Ok(losses)
}
