//! STL in binary: triangles by the coordinates of their corners, in single precision, with their normals.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let edge = |to: [f64; 3]| std::array::from_fn::<f64, 3, _>(|axis| to[axis] - a[axis]);
    let (u, v) = (edge(b), edge(c));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    // A triangle without area has none.
    if length > 0.0 && length.is_finite() { cross.map(|x| x / length) } else { [0.0; 3] }
}

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let mut header = [b' '; 80];
    let title = b"triangles of a simplicial complex";
    header[..title.len()].copy_from_slice(title);
    out.write_all(&header)?;
    let count =
        u32::try_from(mesh.num_cells()[2]).map_err(|_| io::Error::other("STL holds at most 2^32 - 1 triangles"))?;
    out.write_all(&count.to_le_bytes())?;
    let vertices: Vec<_> = mesh.vertices().collect();
    mesh.cells(2..=2, |cell| {
        let mut corners = [[0.0; 3]; 3];
        for (corner, &place) in corners.iter_mut().zip(cell) {
            *corner = mesh.padded(vertices[place]);
        }
        for value in normal(corners).iter().chain(corners.as_flattened()) {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "the format has single precision alone, which is noted"
            )]
            out.write_all(&(*value as f32).to_le_bytes())?;
        }
        out.write_all(&[0, 0])
    })
}
