//! The formats of meshes and lists of simplices: names, and what each is.

use std::fmt;

/// A file format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Geomview's Object File Format and its variants, in text.
    Off,
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, in text and both binary byte orders.
    Ply,
    /// STL, in text and binary.
    Stl,
    /// Gmsh's MSH 2.2 and 4.1, in text and binary.
    Msh,
    /// VTK's legacy format, in text and binary.
    Vtk,
    /// VTK's XML formats for unstructured grids and poly data.
    Vtu,
    /// MEDIT's mesh format, in text.
    Medit,
    /// MFEM's mesh format.
    Mfem,
    /// TetGen's files of nodes, elements, faces and edges.
    Tetgen,
    /// Abaqus' input files.
    Abaqus,
    /// Nastran's bulk data.
    Nastran,
    /// Tetrahedra in binary behind `TETB`.
    Tetbin,
    /// Points, and simplices of any dimension, in text.
    Tops,
    /// One simplex a line, or lists of lists in brackets.
    SimplexList,
}

/// What there is to say about a format.
struct Facts {
    name: &'static str,
    extensions: &'static [&'static str],
    description: &'static str,
}

impl Format {
    /// All formats, in the order in which help texts list them.
    pub const ALL: &'static [Self] = &[
        Self::Off,
        Self::Obj,
        Self::Ply,
        Self::Stl,
        Self::Msh,
        Self::Vtk,
        Self::Vtu,
        Self::Medit,
        Self::Mfem,
        Self::Tetgen,
        Self::Abaqus,
        Self::Nastran,
        Self::Tetbin,
        Self::Tops,
        Self::SimplexList,
    ];

    const fn facts(self) -> Facts {
        match self {
            Self::Off => Facts {
                name: "off",
                extensions: &["off", "coff", "noff", "cnoff"],
                description: "Geomview OFF and its variants COFF, NOFF, 4OFF, nOFF, in text",
            },
            Self::Obj => {
                Facts { name: "obj", extensions: &["obj"], description: "Wavefront OBJ: faces, lines and points" }
            }
            Self::Ply => Facts {
                name: "ply",
                extensions: &["ply"],
                description: "Stanford PLY, in text or binary: faces, edges and triangle strips",
            },
            Self::Stl => Facts {
                name: "stl",
                extensions: &["stl", "stla", "stlb"],
                description: "STL, in text or binary; corners with equal coordinates are welded",
            },
            Self::Msh => Facts {
                name: "msh",
                extensions: &["msh", "msh2", "msh4", "gmsh"],
                description: "Gmsh MSH 2.2 and 4.1, in text or binary, cells of all dimensions",
            },
            Self::Vtk => Facts {
                name: "vtk",
                extensions: &["vtk"],
                description: "legacy VTK, in text or binary: unstructured grids and poly data",
            },
            Self::Vtu => Facts {
                name: "vtu",
                extensions: &["vtu", "vtp"],
                description: "VTK's XML: unstructured grids and poly data, inline or appended, plain or zlib",
            },
            Self::Medit => Facts {
                name: "medit",
                extensions: &["mesh"],
                description: "MEDIT .mesh in text, cells of all dimensions",
            },
            Self::Mfem => {
                Facts { name: "mfem", extensions: &["mfem"], description: "MFEM mesh v1.x, cells of all dimensions" }
            }
            Self::Tetgen => Facts {
                name: "tetgen",
                extensions: &["node", "ele", "face", "edge"],
                description: "TetGen .node, .ele, .face, .edge: one of them, with those beside it that it needs",
            },
            Self::Abaqus => {
                Facts { name: "abaqus", extensions: &["inp"], description: "Abaqus .inp: nodes, solids, shells, beams" }
            }
            Self::Nastran => Facts {
                name: "nastran",
                extensions: &["bdf", "nas"],
                description: "Nastran bulk data: nodes, solids, shells, beams, in free or fixed fields",
            },
            Self::Tetbin => Facts {
                name: "tetbin",
                extensions: &["tetbin"],
                description: "tetrahedra in binary: TETB, two 32-bit counts, floats, 32-bit numbers, little-endian",
            },
            Self::Tops => Facts {
                name: "tops",
                extensions: &["tops"],
                description: "the numbers of points and simplices, points, lines k v1 … vk numbered from 0",
            },
            Self::SimplexList => Facts {
                name: "simplices",
                extensions: &["simplices", "facets", "lst", "txt"],
                description: "one simplex a line by its vertex labels, or lists of lists like [[1,2,3],[2,3,4]]",
            },
        }
    }

    /// The name of the format on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// The extensions of file names that stand for the format, in lower case, without the dot.
    #[must_use]
    pub const fn extensions(self) -> &'static [&'static str] {
        self.facts().extensions
    }

    /// One line on what the format is.
    #[must_use]
    pub const fn description(self) -> &'static str {
        self.facts().description
    }

    /// The format with this name or extension, upper and lower case being the same.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|format| format.name() == name || format.extensions().contains(&&*name))
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
