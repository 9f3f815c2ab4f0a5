//! PLY, the polygon format of Stanford, in text and both binary byte orders.
//!
//! Read are the elements `vertex` (x, y and perhaps z), `face` (a list of vertices of any length), `edge` (vertex1,
//! vertex2) and `tristrips`, in any order. Other numbers of vertices, faces and edges are attributes: each property one, but
//! `name_0`, `name_1`, … in a row and of one type are the components of the attribute `name`. Other elements and lists are
//! passed over and reported.

mod header;
mod rows;

use super::error::{ErrorKind, Fault, Position};
use super::intake::{Intake, Refusal};
use super::source::Source;
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};
use header::{Element, Encoding, Header, Role, header, role};
use rows::{Columns, Place, Row, binary_row, integer, text_row};

/// A PLY file as far as it is read.
struct Ply {
    vertices: u32,
    coordinates: Option<(usize, Scalars)>,
    intake: Intake,
    /// The faces, edges and strips before the row at hand.
    num_cells: usize,
    /// Vertex numbers of the cell at hand.
    word: Vec<u32>,
}

impl Ply {
    /// The number of an existing vertex.
    fn vertex(&mut self, index: i64, position: impl FnOnce() -> Position) -> Result<u32, Fault> {
        match u32::try_from(index) {
            Ok(vertex) if vertex < self.vertices => Ok(vertex),
            _ => {
                let kind = ErrorKind::OutOfRange { index, vertices: self.vertices.into(), first: 0 };
                self.intake.missing(Fault::new(position(), kind))
            }
        }
    }

    /// Takes in one row.
    fn row(&mut self, role: &Role, row: &Row, place: &Place<'_>) -> Result<(), Fault> {
        if matches!(role, Role::Edge { .. } | Role::Face | Role::Strips) {
            self.intake.attributes.begin_cell(self.num_cells);
            self.num_cells += 1;
        }
        match role {
            Role::Vertex { coordinates } => self.point(coordinates, row),
            Role::Edge { ends } => {
                let mut edge = [0; 2];
                for (vertex, &end) in edge.iter_mut().zip(ends) {
                    *vertex = self.vertex(integer(row.scalars[end]), || place.row())?;
                }
                self.intake.simplex(&edge).map_err(|refusal| refused(refusal, place))?;
            }
            Role::Face => {
                if row.list.is_empty() {
                    let kind = ErrorKind::Unsupported("a face without vertices".into());
                    return Err(Fault::new(place.row(), kind));
                }
                self.word.clear();
                for (at, &index) in row.list.iter().enumerate() {
                    let vertex = self.vertex(index, || place.item(at))?;
                    self.word.push(vertex);
                }
                self.intake.polygon(&self.word, u64::from).map_err(|refusal| refused(refusal, place))?;
            }
            Role::Strips => self.strips(&row.list, place)?,
            Role::PassedOver => {}
        }
        Ok(())
    }

    #[allow(clippy::cast_possible_truncation)]
    fn point(&mut self, properties: &[usize], row: &Row) {
        let values = properties.iter().map(|&property| row.scalars[property]);
        match &mut self.coordinates {
            Some((_, Scalars::F32(all))) => all.extend(values.map(|value| value as f32)),
            Some((_, Scalars::F64(all))) => all.extend(values),
            None => {}
        }
    }

    /// Takes in triangle strips, which −1 separates.
    fn strips(&mut self, list: &[i64], place: &Place<'_>) -> Result<(), Fault> {
        let mut first = 0;
        for strip in list.split(|&index| index == -1) {
            self.word.clear();
            for (at, &index) in strip.iter().enumerate() {
                let vertex = self.vertex(index, || place.item(first + at))?;
                self.word.push(vertex);
            }
            self.intake.strip(&self.word).map_err(|refusal| refused(refusal, place))?;
            first += strip.len() + 1;
        }
        Ok(())
    }
}

fn refused(refusal: Refusal, place: &Place<'_>) -> Fault {
    Fault::new(place.row(), refusal.kind(|vertex| vertex.to_string()))
}

/// Notes what the reader does not use, and prepares for the vertices.
fn prepare(ply: &mut Ply, element: &Element, role: &Role) -> Result<(), Fault> {
    if let Role::PassedOver = role {
        ply.intake.report.ignored.note(&element.name);
        return Ok(());
    }
    for property in element.properties.iter().filter(|property| !property.used && !property.is_attribute) {
        let name = [&element.name[..], b" ", &property.name[..]].concat();
        if property.length.is_none() {
            ply.intake.pass_over(&name);
        } else {
            ply.intake.report.ignored.note(&name);
        }
    }
    if let Role::Vertex { coordinates } = role {
        if ply.coordinates.is_some() {
            return Err(element.unsupported("a second element vertex"));
        }
        ply.vertices =
            u32::try_from(element.count).map_err(|_| Fault::new(element.position, ErrorKind::TooManyVertices))?;
        let single = coordinates.iter().all(|&property| element.properties[property].scalar.fits_single());
        let values = if single { Scalars::F32(Vec::new()) } else { Scalars::F64(Vec::new()) };
        ply.coordinates = Some((coordinates.len(), values));
    }
    Ok(())
}

/// Reads a PLY file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let Header { encoding, mut elements } = header(source)?;
    source.binary = encoding != Encoding::Text;
    let mut ply = Ply {
        vertices: 0,
        coordinates: None,
        intake: Intake::new(Format::Ply, options),
        num_cells: 0,
        word: Vec::new(),
    };
    let roles = elements.iter_mut().map(role).collect::<Result<Vec<_>, _>>()?;
    if ply.intake.attributes.are_kept() {
        for (element, _) in elements.iter_mut().zip(&roles).filter(|(_, role)| !matches!(role, Role::PassedOver)) {
            let rest = element.properties.iter_mut().filter(|property| !property.used && property.length.is_none());
            rest.for_each(|property| property.is_attribute = true);
        }
    }
    // All elements first: faces may come before the vertices whose number they need.
    for (element, role) in elements.iter().zip(&roles) {
        prepare(&mut ply, element, role)?;
    }
    let mut row = Row::default();
    // Rows without properties are no bytes at all, so their count bounds nothing.
    for (element, role) in elements.iter().zip(&roles).filter(|(element, _)| !element.properties.is_empty()) {
        row.scalars.clear();
        row.scalars.resize(element.properties.len(), 0.0);
        let (first, mut columns) = (ply.num_cells, Columns::new(element));
        for _ in 0..element.count {
            if encoding == Encoding::Text {
                let mut line = source.need_content(None, "as many rows of the element as the header says")?;
                let list = text_row(&mut line, element, &mut row)?;
                columns.push(&row.scalars);
                ply.row(role, &row, &Place::Text(line, list))?;
            } else {
                let place = binary_row(source, element, encoding, options.on_bad, &mut row)?;
                columns.push(&row.scalars);
                ply.row(role, &row, &place)?;
            }
        }
        for (name, components, values) in columns.columns {
            match role {
                Role::Vertex { .. } => ply.intake.vertex_attribute(&name, components.len(), values),
                _ => ply.intake.cell_attribute(&name, components.len(), values, first),
            }
        }
    }
    if encoding == Encoding::Text {
        source.need_end(None, "file after the last element")?;
    } else {
        source.need_end_of_bytes("file after the last element")?;
    }
    Ok(ply.intake.finish(Labels::Numbered(ply.vertices as usize), true, ply.coordinates))
}
