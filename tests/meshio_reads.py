"""What `sig convert` writes, read by meshio: the same points and cells must come out.

    python3 tests/meshio_reads.py path/to/sig

Needs meshio (`pip install meshio`); without it, says SKIPPED and why.
"""

import pathlib
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy
except ImportError as error:
    print(f"SKIPPED: {error}; pip install meshio")
    sys.exit(0)

DATA = pathlib.Path(__file__).parent / "data"

# A file, and the formats of which meshio must read the same: name of the file, name in meshio, cells that it keeps.
ALL = {"vertex", "line", "triangle", "tetra"}
CASES = [
    ("gmsh_mixed_bracket_h0.9.msh", "a.vtu", "vtu", ALL),
    ("gmsh_mixed_bracket_h0.9.msh", "a.vtk", "vtk", ALL),
    ("gmsh_mixed_bracket_h0.9.msh", "a.msh", "gmsh", ALL),
    ("gmsh_mixed_bracket_h0.9.msh", "a.mesh", "medit", ALL),
    ("formats/mixed.mesh", "b.vtu", "vtu", ALL),
    ("formats/mixed.mesh", "b.vtk", "vtk", ALL),
    ("torus.msh", "c.mesh", "medit", ALL),
    ("torus.msh", "c.node", "tetgen", ALL),
    ("goathead.obj", "d.off", "off", ALL),
    ("goathead.obj", "d.ply", "ply", ALL),
    ("goathead.obj", "d.obj", "obj", ALL),
    ("trimesh_angle_block.STL", "e.stl", "stl", None),
]


def tops(sig, file):
    """The top simplices by dimension, by the list that `sig` writes, which its own tests check."""
    text = subprocess.run([sig, "convert", file, "-", "--to", "simplices"], check=True, capture_output=True, text=True)
    rows = [sorted(int(word) for word in line.split()) for line in text.stdout.splitlines()]
    labels = {label: at for at, label in enumerate(sorted({label for row in rows for label in row}))}
    return sorted(tuple(labels[label] for label in row) for row in rows)


def main(sig):
    with tempfile.TemporaryDirectory() as folder:
        for source, name, kind, kept in CASES:
            file, out = DATA / source, pathlib.Path(folder) / name
            subprocess.run([sig, "convert", file, out, "--force"], check=True, capture_output=True)
            mesh = meshio.read(out, file_format=kind)
            expected = tops(sig, file)
            if kept is None:
                # Corners are points of their own: the triangles are counted.
                found = sum(len(block.data) for block in mesh.cells)
                assert found == len(expected), f"{source} as {kind}: {found} triangles, not {len(expected)}"
                continue
            # Points without a cell are isolated vertices; meshio's own formats for them differ.
            cells = [row for block in mesh.cells if block.type in kept for row in block.data.tolist()]
            used = {vertex for row in cells for vertex in row}
            cells += [[vertex] for vertex in range(len(mesh.points)) if vertex not in used]
            found = sorted(tuple(sorted(row)) for row in cells)
            assert found == expected, f"{source} as {kind}: {len(found)} cells, not {len(expected)}, or others"
            assert numpy.isfinite(mesh.points).all()
            print(f"{source} as {kind}: {len(mesh.points)} points, {len(found)} cells, the same")


main(sys.argv[1])
