"""What `sig convert` writes, read by meshio: the same points and cells must come out, and the same values at them.

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


# Formats with values at points and cells: what meshio writes and `sig` reads, then what `sig` writes and meshio reads, with
# the names that the values have there, and the names of integers of which a format has one only.
VALUES = {
    "vtu": ("a.vtu", "vtu", {"binary": False}),
    "vtu, zlib": ("z.vtu", "vtu", {"binary": True, "compression": "zlib"}),
    "vtk": ("a.vtk", "vtk", {"binary": False}),
    "vtk, binary": ("b.vtk", "vtk", {"binary": True}),
    "ply": ("a.ply", "ply", {"binary": False}),
    "ply, binary": ("b.ply", "ply", {"binary": True}),
    # As text meshio writes values that are no numbers, and 4.1 not without entities.
    "msh 2.2, binary": ("b.msh", "gmsh22", {"binary": True}),
    "medit": ("a.mesh", "medit", {}),
}
# The names of the integer that some formats have for each cell.
REFERENCE = {"gmsh": "gmsh:physical", "gmsh22": "gmsh:physical", "medit": "medit:ref", "ply": None}


def a_mesh(kind):
    """Three triangles, and where the format has them tetrahedra on one of them, with values of some types: of few digits, for meshio writes
    no more as text."""
    points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.25], [0, 0, 1], [0, 1, 1.5]], dtype=float)
    cells = [("triangle", numpy.array([[1, 0, 2], [1, 2, 3], [3, 2, 5]]))]
    if kind != "ply":
        cells.append(("tetra", numpy.array([[0, 1, 2, 4], [5, 4, 0, 2]])))
    # Of each kind of cell two are written: meshio takes data at elements of MSH 2.2 two by two. Triangle 0, 1, 2 is a face: its values are in the complex, but no format has it.
    values = {
        "small": [numpy.array([7, 200, 9], dtype=numpy.uint8), numpy.array([1, 255], dtype=numpy.uint8)],
        "signed": [numpy.array([-5, 6, 7], dtype=numpy.int32), numpy.array([-(2**31), 2**31 - 1], dtype=numpy.int32)],
        "single": [numpy.array([0.125, -3, 8], dtype=numpy.float32), numpy.array([2**-20, 4], dtype=numpy.float32)],
        "double": [numpy.array([0.375, 2, -1]), numpy.array([7e300, -0.5])],
        "vector": [numpy.arange(9.0).reshape(3, 3) / 8, numpy.arange(6.0, 12).reshape(2, 3)],
    }
    if kind == "ply":
        del values["vector"]
    if kind in ("gmsh", "gmsh22"):
        values = {name: values[name] for name in ("double", "vector")}
    if kind == "medit":
        values = {}
    if REFERENCE.get(kind, "ref") is not None:
        values[REFERENCE.get(kind, "ref")] = [numpy.array([3, 4, 5], dtype=numpy.int32), numpy.array([11, 12], dtype=numpy.int32)]
    if kind in ("gmsh", "gmsh22"):
        values["gmsh:geometrical"] = values["gmsh:physical"]
    point_data = {name: numpy.concatenate(blocks * 2)[: len(points)] for name, blocks in values.items() if ":" not in name}
    if kind == "ply":
        point_data = {name: numpy.concatenate(blocks * 3)[: len(points)] for name, blocks in values.items()}
    if kind == "medit":
        point_data = {"medit:ref": numpy.arange(len(points)) * 5}
    cell_data = {name: blocks[: len(cells)] for name, blocks in values.items()}
    return meshio.Mesh(points, cells, point_data=point_data, cell_data=cell_data)


def values_of(mesh, names):
    """The values at points and cells by name and by place, without those that a format has of itself."""
    found = {}
    place = lambda row: tuple(mesh.points[row].tolist())
    for name, values in mesh.point_data.items():
        if name not in ("label", "gmsh:dim_tags"):
            for row, value in enumerate(values):
                found["point", names.get(name, name), place(row)] = numpy.ravel(value).tolist()
    for name, blocks in mesh.cell_data.items():
        if name in ("dimension", "gmsh:geometrical"):
            continue
        for block, values in zip(mesh.cells, blocks):
            for cell, value in zip(block.data, values):
                found["cell", names.get(name, name), frozenset(map(place, cell))] = numpy.ravel(value).tolist()
    return found


def check_values(sig, folder):
    for title, (name, kind, options) in VALUES.items():
        mesh = a_mesh(kind)
        source = folder / name
        meshio.write(source, mesh, file_format=kind, **options)
        expected = values_of(mesh, {REFERENCE.get(kind): "ref"})
        face = frozenset(tuple(mesh.points[row].tolist()) for row in (0, 1, 2))
        if kind == "ply":
            # meshio neither writes nor reads values at faces.
            expected = {key: value for key, value in expected.items() if key[0] == "point"}
        expected = {key: value for key, value in expected.items() if key[2] != face}
        for target, out in [("vtu", "o.vtu"), ("vtk", "o.vtk"), ("gmsh", "o.msh"), ("medit", "o.mesh"), ("ply", "o.ply")]:
            if target == "ply" and kind != "ply":
                continue
            complex_file, out = folder / "o.sigc", folder / out
            subprocess.run([sig, "build", source, "-o", complex_file, "--force"], check=True, capture_output=True)
            subprocess.run([sig, "export", complex_file, "-o", out, "--force"], check=True, capture_output=True)
            found = values_of(meshio.read(out, file_format=target), {REFERENCE.get(target): "ref"})
            held = expected
            if target == "medit":
                held = {key: value for key, value in expected.items() if key[1] == "ref"}
                found = {key: value for key, value in found.items() if key in held}
            if target == "gmsh":
                # Of cells the integer is in the group.
                found = {key: value for key, value in found.items() if key[:2] != ("cell", "ref") or key in held}
            assert found == held, f"{title} as {target}: {found} not {held}"
            print(f"{title} as {target}: {len(found)} values, the same")


def check_groups(sig, folder):
    """The physical groups of the elements of files that Gmsh wrote, of those that are simplices and no faces of others."""
    for name in ("gmsh-3d-binary-64.msh", "hybrid_3d_cube.msh"):
        out = folder / "o.vtu"
        subprocess.run([sig, "convert", DATA / name, out, "--force"], check=True, capture_output=True)
        expected = values_of(meshio.read(DATA / name), {"gmsh:physical": "ref"})
        found = values_of(meshio.read(out), {})
        both = [key for key in found if key in expected and key[:2] == ("cell", "ref")]
        assert len(both) > 50, f"{name}: {len(both)} elements with groups"
        assert all(found[key] == expected[key] for key in both), name
        print(f"{name}: {len(both)} elements with groups, the same")


def main(sig):
    with tempfile.TemporaryDirectory() as folder:
        check_groups(sig, pathlib.Path(folder))
        check_values(sig, pathlib.Path(folder))
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
