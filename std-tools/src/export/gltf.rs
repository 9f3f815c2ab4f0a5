//! glTF 2.0 for viewers, in one file: the triangles, edges and points that are seen, in single precision.
//!
//! Of tetrahedra the triangles that lie in one alone are written.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;
use sig_core::Relations;

use super::mesh::Mesh;

/// The faces of a tetrahedron, oriented outwards if it is positive.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

fn number(place: usize) -> io::Result<u32> {
    u32::try_from(place).map_err(|_| io::Error::other("glTF numbers at most 2^32 vertices"))
}

/// The triangles to be seen: top ones, and those of tetrahedra that lie in one alone.
fn triangles<V: Relations>(mesh: &Mesh<'_, V>) -> io::Result<Vec<[u32; 3]>> {
    let mut triangles = Vec::new();
    mesh.cells(2..=2, |cell| {
        if let &[a, b, c] = cell {
            triangles.push([number(a)?, number(b)?, number(c)?]);
        }
        Ok(())
    })?;
    let mut faces: Vec<([u32; 3], [u32; 3])> = Vec::new();
    mesh.cells(3..=3, |cell| {
        for face in FACES {
            let mut face = [number(cell[face[0]])?, number(cell[face[1]])?, number(cell[face[2]])?];
            let oriented = face;
            face.sort_unstable();
            faces.push((face, oriented));
        }
        Ok(())
    })?;
    faces.sort_unstable();
    let alone = faces.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1);
    triangles.extend(alone.map(|same| same[0].1));
    Ok(triangles)
}

fn indices<V: Relations>(mesh: &Mesh<'_, V>, dim: usize) -> io::Result<Vec<u32>> {
    let mut indices = Vec::new();
    mesh.cells(dim..=dim, |cell| {
        for &place in cell {
            indices.push(number(place)?);
        }
        Ok(())
    })?;
    Ok(indices)
}

#[expect(clippy::cast_possible_truncation, reason = "the format has single precision alone, which is noted")]
pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let points: Vec<[f32; 3]> = mesh.vertices().map(|vertex| mesh.padded(vertex).map(|x| x as f32)).collect();
    let extreme = |better: fn(f32, f32) -> f32, start: f32| {
        points.iter().fold([start; 3], |all, point| std::array::from_fn(|axis| better(all[axis], point[axis])))
    };
    let mut buffer: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let mut views = vec![json!({"buffer": 0, "byteOffset": 0, "byteLength": buffer.len(), "target": 34962})];
    let mut accessors = vec![json!({
        "bufferView": 0, "componentType": 5126, "count": points.len(), "type": "VEC3",
        "min": extreme(f32::min, f32::INFINITY), "max": extreme(f32::max, f32::NEG_INFINITY),
    })];
    let mut primitives = Vec::new();
    // The modes of glTF: triangles, lines, points.
    for (mode, indices) in [(4, triangles(mesh)?.into_flattened()), (1, indices(mesh, 1)?), (0, indices(mesh, 0)?)] {
        if indices.is_empty() {
            continue;
        }
        let start = buffer.len();
        buffer.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        let view = views.len();
        views.push(json!({
            "buffer": 0, "byteOffset": start, "byteLength": buffer.len() - start, "target": 34963,
        }));
        accessors.push(json!({"bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR"}));
        primitives.push(json!({
            "attributes": {"POSITION": 0}, "indices": view, "mode": mode, "material": 0,
        }));
    }
    let mut document = json!({
        "asset": {"version": "2.0", "generator": "sig"},
        "scene": 0, "scenes": [{}],
    });
    // Nothing is no mesh: the format has no empty lists.
    if !primitives.is_empty() {
        document["scenes"] = json!([{"nodes": [0]}]);
        document["nodes"] = json!([{"mesh": 0}]);
        document["meshes"] = json!([{"primitives": primitives}]);
        document["materials"] = json!([{"doubleSided": true}]);
        document["accessors"] = json!(accessors);
        document["bufferViews"] = json!(views);
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&buffer));
        document["buffers"] = json!([{"byteLength": buffer.len(), "uri": uri}]);
    }
    serde_json::to_writer(&mut *out, &document)?;
    writeln!(out)
}
