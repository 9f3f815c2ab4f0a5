//! VTK's XML format for poly data: vertices, lines and triangles in lists of their own, arrays inline in base64.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;
use super::vtu::{array, labels, points, to_i64};

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let [verts, lines, polys, _] = mesh.num_cells();
    writeln!(out, r#"<?xml version="1.0"?>"#)?;
    writeln!(out, r#"<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#)?;
    writeln!(out, "<PolyData>")?;
    write!(out, r#"<Piece NumberOfPoints="{}" NumberOfVerts="{verts}" "#, mesh.num_vertices())?;
    writeln!(out, r#"NumberOfLines="{lines}" NumberOfStrips="0" NumberOfPolys="{polys}">"#)?;
    labels(mesh, out)?;
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
    writeln!(out, "</Piece>\n</PolyData>\n</VTKFile>")
}
