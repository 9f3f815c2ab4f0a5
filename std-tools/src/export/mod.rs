//! Writers: the top simplices of a complex, or all, in the formats of other programs, one file a format.
//!
//! A writer refuses what its format cannot hold, before the first byte, and says what does; what it must leave out
//! though the simplices are all there (labels, coordinates) it reports as a [`Note`]. Orientations are those of the
//! input.

mod attributes;
mod chains;
mod gltf;
mod gudhi;
mod medit;
mod mesh;
mod mfem;
mod msh;
mod obj;
mod off;
mod ply;
mod simplex_list;
mod stl;
#[cfg(test)]
mod tests;
mod tetbin;
mod tetgen;
mod tops;
mod vtk;
mod vtp;
pub(crate) mod vtu;

use std::fmt;
use std::io::{self, Write};

use sig_core::format::SectionKind;
use sig_core::{Dim, Relations};

use crate::attribute::Attribute;
use attributes::Losses;
pub use chains::{NamedChain, check_chains, export_chains};
use mesh::Mesh;

/// A format that can be written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Format {
    /// Geomview OFF: triangles, edges as polygons of two corners, points of any dimension.
    Off,
    /// Wavefront OBJ: faces, lines, points.
    Obj,
    /// Stanford PLY in text: faces and edges.
    Ply,
    /// STL in binary: triangles.
    Stl,
    /// Gmsh's MSH 2.2 in text: simplices up to dimension 3.
    Msh,
    /// MEDIT's mesh format in text: simplices up to dimension 3.
    Medit,
    /// MFEM's mesh format: simplices of one dimension up to 3.
    Mfem,
    /// VTK's legacy format in text: simplices up to dimension 3.
    Vtk,
    /// One top simplex a line by its labels: any dimension.
    SimplexList,
    /// VTK's unstructured grid for ParaView: tetrahedra, triangles, lines, vertices, all in one grid.
    Vtu,
    /// VTK's poly data: triangles, lines, vertices.
    Vtp,
    /// TetGen's files of nodes, elements, faces and edges.
    Tetgen,
    /// Tetrahedra in binary behind `TETB`.
    Tetbin,
    /// glTF 2.0, for viewers: what is seen of a complex.
    Gltf,
    /// Points, and top simplices of any dimension, in text.
    Tops,
    /// GUDHI's simplex-tree text: all simplices with their filtration values.
    Gudhi,
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
        Self::Vtp,
        Self::Medit,
        Self::Mfem,
        Self::Tetgen,
        Self::Tetbin,
        Self::Gltf,
        Self::Tops,
        Self::SimplexList,
        Self::Gudhi,
    ];

    /// The name of the format on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Msh => "msh",
            Self::Vtk => "vtk",
            Self::Vtu => "vtu",
            Self::Vtp => "vtp",
            Self::Tetgen => "tetgen",
            Self::Tetbin => "tetbin",
            Self::Medit => "medit",
            Self::Mfem => "mfem",
            Self::Gltf => "gltf",
            Self::Tops => "tops",
            Self::SimplexList => "simplices",
            Self::Gudhi => "gudhi",
        }
    }

    /// The extensions of file names that stand for the format, in lower case, without the dot.
    #[must_use]
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Off => &["off"],
            Self::Obj => &["obj"],
            Self::Ply => &["ply"],
            Self::Stl => &["stl"],
            Self::Msh => &["msh"],
            Self::Vtk => &["vtk"],
            Self::Vtu => &["vtu"],
            Self::Vtp => &["vtp"],
            Self::Tetgen => tetgen::ALL,
            Self::Tetbin => &["tetbin"],
            Self::Medit => &["mesh"],
            Self::Mfem => &["mfem"],
            Self::Gltf => &["gltf"],
            Self::Tops => &["tops"],
            Self::SimplexList => &["simplices", "facets", "lst", "txt"],
            Self::Gudhi => &["gudhi"],
        }
    }

    /// One line on what the format holds.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::Off => "Geomview OFF: triangles and edges",
            Self::Obj => "Wavefront OBJ: triangles, lines and points",
            Self::Ply => "Stanford PLY in text: triangles and edges",
            Self::Stl => "STL in binary: triangles",
            Self::Msh => "Gmsh MSH 2.2 in text: tetrahedra, triangles, lines and points",
            Self::Vtk => "legacy VTK in text: tetrahedra, triangles, lines and vertices",
            Self::Vtu => "VTK unstructured grid, for ParaView: tetrahedra, triangles, lines and vertices",
            Self::Vtp => "VTK poly data, for ParaView: triangles, lines and vertices",
            Self::Tetgen => "TetGen .node, with .ele, .face, .edge beside it, numbered from 0",
            Self::Tetbin => "tetrahedra in binary, in single precision",
            Self::Medit => "MEDIT .mesh in text: tetrahedra, triangles and edges",
            Self::Mfem => "MFEM mesh v1.0: simplices of one dimension up to 3",
            Self::Gltf => "glTF 2.0 for viewers: triangles, lines, points, the surface of tetrahedra",
            Self::Tops => "points and lines k v1 … vk: any dimension",
            Self::SimplexList => "one top simplex a line by its vertex labels: any dimension, no coordinates",
            Self::Gudhi => "GUDHI's simplex-tree text: all simplices with their filtration values, no coordinates",
        }
    }

    /// What the format cannot hold, though all top simplices are there.
    #[must_use]
    pub const fn loses(self) -> &'static str {
        match self {
            Self::Off | Self::Obj | Self::Tops => "labels, attributes",
            Self::Tetgen => {
                "labels, attributes but one, in doubles, of nodes and largest cells, and the integer ref of others"
            }
            Self::Tetbin => "labels, attributes, precision beyond 32 bits",
            Self::Ply => "labels, 64-bit integers",
            Self::Vtk => "labels",
            Self::Medit => "labels, attributes but the integer ref",
            Self::Mfem => "labels, attributes but the integer ref of elements, from 1",
            Self::Stl => "labels, attributes, precision beyond 32 bits, vertices that share a place",
            Self::Msh => {
                "labels but integers from 1, types of attributes but that of ref of elements: others are doubles"
            }
            Self::Vtu | Self::Vtp => "labels but integers",
            Self::Gltf => "labels, attributes, precision beyond 32 bits, what lies inside of solids",
            Self::SimplexList => "coordinates, attributes",
            Self::Gudhi => "coordinates, attributes, labels but numbers",
        }
    }

    /// The format with this name or extension, upper and lower case being the same.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|format| format.name() == name || format.extensions().contains(&&*name))
    }

    /// The ends of the names of the files that a mesh in this format may have, if they are several: see
    /// [`export_file`].
    #[must_use]
    pub const fn files(self) -> &'static [&'static str] {
        match self {
            Self::Tetgen => tetgen::ALL,
            _ => &[],
        }
    }

    /// The greatest dimension of a simplex that the format holds.
    const fn max_dim(self) -> Dim {
        match self {
            Self::Off | Self::Obj | Self::Ply | Self::Stl | Self::Vtp => 2,
            Self::Msh | Self::Vtk | Self::Vtu | Self::Medit | Self::Mfem | Self::Tetgen | Self::Tetbin | Self::Gltf => {
                3
            }
            Self::Tops | Self::SimplexList | Self::Gudhi => sig_core::MAX_DIM,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Why a complex is not exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The format has no simplices of so many dimensions.
    #[error("the complex has dimension {dim}, but {format} holds simplices up to dimension {} only; {}",
        format.max_dim(), if *dim <= Format::Vtu.max_dim() { "use vtu or simplices" } else { "use simplices" })]
    Dimension {
        /// The format.
        format: Format,
        /// The dimension of the complex.
        dim: Dim,
    },
    /// The format holds simplices of one dimension alone, and there are top simplices of others.
    #[error(
        "{format} holds top simplices of dimension {dim} alone, and there are some of dimension {other}; use vtu or tops"
    )]
    Mixed {
        /// The format.
        format: Format,
        /// The dimension that it holds.
        dim: Dim,
        /// Another that is there.
        other: Dim,
    },
    /// The format needs coordinates, and the complex has none.
    #[error("the complex has no coordinates, without which {format} cannot be written; use simplices")]
    NoCoordinates {
        /// The format.
        format: Format,
    },
    /// The format does not hold points of so many coordinates.
    #[error("the vertices have {components} coordinates, which {format} does not hold; use {}",
        if *components <= 3 { "off or vtu" } else { "off (up to dimension 2) or simplices" })]
    Coordinates {
        /// The format.
        format: Format,
        /// Coordinates a vertex.
        components: usize,
    },
    /// The format has no chains.
    #[error("{format} holds no chains; use vtu or obj")]
    NoChains {
        /// The format.
        format: Format,
    },
    /// A mesh in the format is several files.
    #[error("{format} is several files, and here is room for one alone")]
    SeveralFiles {
        /// The format.
        format: Format,
    },
    /// A label that would be read back as something else.
    #[error("vertex label {label:?} cannot stand in a list of simplices: it has a separator or a bracket, or is empty")]
    Label {
        /// The label.
        label: String,
    },
    /// Writing failed.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// What an export leaves out or changes, all top simplices being there.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Note {
    /// The vertices are numbered anew, in the order of their labels, which the format cannot hold.
    LabelsLeftOut,
    /// There are coordinates, which the format does not have.
    CoordinatesLeftOut,
    /// Points of fewer than three coordinates were filled up with zeros.
    CoordinatesPadded,
    /// Coordinates are rounded to single precision.
    CoordinatesRounded,
    /// Of tetrahedra there is the surface alone.
    InsideLeftOut,
    /// The attributes with these names have no place in the format.
    AttributesLeftOut(Vec<String>),
    /// The attributes with these names have another type, more components or another name.
    AttributesConverted(Vec<String>),
    /// Values of these attributes are at simplices that are faces of others, which are not written.
    AttributesOfFacesLeftOut(Vec<String>),
    /// The vertices are called by their numbers in the file, as the format has no labels but numbers.
    VerticesNumbered,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AttributesLeftOut(names) => {
                return write!(
                    f,
                    "attributes are left out, for the format has no place for them: {}",
                    names.join(", ")
                );
            }
            Self::AttributesConverted(names) => {
                let names = names.join(", ");
                return write!(
                    f,
                    "attributes are converted to the types, widths and names that the format has: {names}"
                );
            }
            Self::AttributesOfFacesLeftOut(names) => {
                let names = names.join(", ");
                return write!(f, "attributes of simplices that are faces of others are left out with them: {names}");
            }
            Self::LabelsLeftOut => {
                "vertices are numbered anew in the order of their labels, which the format cannot hold"
            }
            Self::CoordinatesLeftOut => "coordinates are left out, for the format has none",
            Self::CoordinatesPadded => "points have fewer than three coordinates and are filled up with zeros",
            Self::CoordinatesRounded => "coordinates are rounded to single precision",
            Self::InsideLeftOut => "of tetrahedra the triangles that lie in one alone are written, not what is inside",
            Self::VerticesNumbered => "vertices are numbered, for the format has no other labels than numbers",
        })
    }
}

/// Checks whether `format` holds the complex: what [`export`] would refuse before its first byte.
///
/// # Errors
/// All of [`ExportError`] but [`ExportError::Io`].
pub fn check(complex: &impl Relations, format: Format) -> Result<(), ExportError> {
    if let Some(dim) = complex.dim().filter(|&dim| dim > format.max_dim()) {
        return Err(ExportError::Dimension { format, dim });
    }
    if format == Format::SimplexList {
        return simplex_list::check_labels(complex);
    }
    if format == Format::Gudhi {
        return Ok(());
    }
    let components = match complex.coordinates() {
        Some(section) => section.components as usize,
        // Nothing needs no coordinates.
        None if complex.num_vertices() == 0 => 3,
        None => return Err(ExportError::NoCoordinates { format }),
    };
    // Those of one dimension alone: STL of 2, MFEM of any.
    let alone = match format {
        Format::Stl => Some(2),
        Format::Tetbin => Some(3),
        Format::Mfem => complex.dim(),
        _ => None,
    };
    // An isolated vertex is there all the same, but in STL.
    let fits = |top: Dim, dim: Dim| top == dim || top == 0 && format != Format::Stl;
    if let Some(dim) = alone
        && let Some(top) = crate::tops::top_simplices(complex).find(|top| !fits(top.dim, dim))
    {
        return Err(ExportError::Mixed { format, dim, other: top.dim });
    }
    let holds = match format {
        Format::Obj | Format::Tetbin => components == 3,
        Format::Ply | Format::Medit | Format::Tetgen => (2..=3).contains(&components),
        Format::Stl | Format::Msh | Format::Vtk | Format::Vtu | Format::Vtp | Format::Mfem | Format::Gltf => {
            components <= 3
        }
        Format::Off | Format::Tops | Format::SimplexList | Format::Gudhi => true,
    };
    if holds { Ok(()) } else { Err(ExportError::Coordinates { format, components }) }
}

/// Writes the top simplices of a complex (to GUDHI's text all) to `out`, which should be buffered, and returns what had to be left out.
///
/// Cost: linear in the complex and the output; the vertices are sorted by label if they are not in that order, for GUDHI's
/// text the simplices by filtration value if there are any.
///
/// # Errors
/// [`ExportError`].
pub fn export(complex: &impl Relations, format: Format, out: &mut dyn Write) -> Result<Vec<Note>, ExportError> {
    check(complex, format)?;
    if !format.files().is_empty() {
        return Err(ExportError::SeveralFiles { format });
    }
    let mut notes = Vec::new();
    if format == Format::SimplexList {
        simplex_list::write(complex, out)?;
        notes.extend(complex.coordinates().map(|_| Note::CoordinatesLeftOut));
        notes.extend(without_attributes(complex));
        return Ok(notes);
    }
    if format == Format::Gudhi {
        gudhi::write(complex, out)?;
        notes.extend((!gudhi::keeps_labels(complex)).then_some(Note::VerticesNumbered));
        notes.extend(complex.coordinates().map(|_| Note::CoordinatesLeftOut));
        notes.extend(without_attributes(complex));
        return Ok(notes);
    }
    let mesh = Mesh::new(complex);
    let mut losses = None;
    let keeps_labels = match format {
        Format::Off => off::write(&mesh, out).map(|()| mesh.is_numbered_from(0)),
        Format::Obj => obj::write(&mesh, out).map(|()| mesh.is_numbered_from(1)),
        Format::Ply => ply::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| mesh.is_numbered_from(0)),
        Format::Stl => stl::write(&mesh, out).map(|()| false),
        Format::Msh => msh::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| msh::tags(&mesh).is_some()),
        Format::Vtk => vtk::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| mesh.is_numbered_from(0)),
        Format::Medit => medit::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| mesh.is_numbered_from(1)),
        Format::Mfem => mfem::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| mesh.is_numbered_from(0)),
        Format::Gltf => gltf::write(&mesh, out).map(|()| mesh.is_numbered_from(0)),
        Format::Tops => tops::write(&mesh, out).map(|()| mesh.is_numbered_from(0)),
        Format::Vtp => vtp::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| mesh.integer_labels().is_some()),
        Format::Tetbin => tetbin::write(&mesh, out).map(|()| mesh.is_numbered_from(0)),
        Format::Vtu | Format::Tetgen | Format::SimplexList | Format::Gudhi => {
            vtu::write(&mesh, out).map(|lost| losses = Some(lost)).map(|()| mesh.integer_labels().is_some())
        }
    }?;
    notes.extend((!keeps_labels).then_some(Note::LabelsLeftOut));
    let is_padded =
        matches!(format, Format::Stl | Format::Msh | Format::Vtk | Format::Vtu | Format::Vtp | Format::Gltf);
    notes.extend((is_padded && mesh.components() < 3).then_some(Note::CoordinatesPadded));
    let is_single = matches!(format, Format::Stl | Format::Tetbin | Format::Gltf);
    notes.extend((is_single && !mesh.is_single()).then_some(Note::CoordinatesRounded));
    notes.extend((format == Format::Gltf && complex.dim() == Some(3)).then_some(Note::InsideLeftOut));
    match losses {
        None => notes.extend(without_attributes(complex)),
        Some(losses) => notes.extend(of_attributes(complex, losses)),
    }
    Ok(notes)
}

/// The ends of the names of the files that the complex takes in a format of [several](Format::files): those without which
/// nothing is lost are not among them.
///
/// Cost: linear in the complex.
pub fn files(complex: &impl Relations, format: Format) -> Vec<&'static str> {
    if format.files().is_empty() { Vec::new() } else { tetgen::needed(&Mesh::new(complex)) }
}

/// Writes one of the [`files`] of a complex to `out`, which should be buffered, and returns what had to be left out of them
/// all. Costs as [`export`].
///
/// # Errors
/// [`ExportError`].
pub fn export_file(
    complex: &impl Relations,
    format: Format,
    file: &str,
    out: &mut dyn Write,
) -> Result<Vec<Note>, ExportError> {
    if format.files().is_empty() {
        return export(complex, format, out);
    }
    check(complex, format)?;
    let mesh = Mesh::new(complex);
    tetgen::write(&mesh, file, out)?;
    let labels = (!mesh.is_numbered_from(0)).then_some(Note::LabelsLeftOut);
    Ok(labels.into_iter().chain(of_attributes(complex, tetgen::losses(&mesh))).collect())
}

/// Names, each once, in order; `None` if there is none.
fn named(names: Vec<impl Into<String>>) -> Option<Vec<String>> {
    let mut names: Vec<String> = names.into_iter().map(Into::into).collect();
    names.sort_unstable();
    names.dedup();
    (!names.is_empty()).then_some(names)
}

/// What became of the attributes of a complex.
fn of_attributes(complex: &impl Relations, losses: Losses<'_>) -> impl Iterator<Item = Note> {
    let left_out = named(losses.left_out).map(Note::AttributesLeftOut);
    let converted = named(losses.converted).map(Note::AttributesConverted);
    let of_faces = named(of_faces(complex)).map(Note::AttributesOfFacesLeftOut);
    [left_out, converted, of_faces].into_iter().flatten()
}

/// That the attributes of a complex are not written.
fn without_attributes(complex: &impl Relations) -> Option<Note> {
    let sections = complex.container().sections().filter(|section| section.kind == SectionKind::Attribute);
    named(sections.map(|section| section.name).collect()).map(Note::AttributesLeftOut)
}

/// The attributes with values at simplices that are faces of others.
fn of_faces(complex: &impl Relations) -> Vec<String> {
    let is_below = |attribute: &Attribute| attribute.dim > 0 && complex.dim().is_some_and(|dim| attribute.dim < dim);
    let attributes = Attribute::all_of(complex).into_iter().filter(is_below);
    let has_faces = attributes.filter(|attribute| {
        let simplices = complex.simplices_of_dim(attribute.dim).enumerate();
        simplices.into_iter().any(|(row, simplex)| attribute.has_value(row) && !complex.is_top(simplex))
    });
    has_faces.map(|attribute| format!("{} (dimension {})", attribute.name, attribute.dim)).collect()
}
