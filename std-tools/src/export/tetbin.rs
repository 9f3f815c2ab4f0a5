//! TETB, tetrahedra in binary: `TETB`, the numbers of vertices and tetrahedra as 32-bit integers, three 32-bit floats a
//! vertex, four 32-bit vertex numbers from 0 a tetrahedron; all little-endian.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

/// A number that the format has 32 bits for.
fn narrow(number: usize) -> io::Result<[u8; 4]> {
    let number =
        u32::try_from(number).map_err(|_| io::Error::other("TETB counts vertices and tetrahedra in 32 bits"))?;
    Ok(number.to_le_bytes())
}

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"TETB")?;
    out.write_all(&narrow(mesh.num_vertices())?)?;
    out.write_all(&narrow(mesh.num_cells()[3])?)?;
    for vertex in mesh.vertices() {
        for value in mesh.padded(vertex) {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "the format has single precision alone, which is noted"
            )]
            out.write_all(&(value as f32).to_le_bytes())?;
        }
    }
    mesh.cells(3..=3, |cell| cell.iter().try_for_each(|&vertex| out.write_all(&narrow(vertex)?)))
}
