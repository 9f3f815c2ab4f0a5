//! Grids and parts of them as VTU, VTK's XML format for unstructured grids: [`Triangulation::write_vtu`].

use std::convert::Infallible;
use std::io::{self, Write};

use super::Triangulation;
use super::triangulation::Rule;
use crate::export::vtu::{CELL_TYPES, array, head};
use crate::volume::{Sample, Volume};

impl Triangulation {
    /// Writes a grid of up to three sides, or part of one, as VTU: the simplices that are listed, on the vertices that are
    /// kept, which stand at whole numbers. The samples of `volume`, if it has one for each vertex of the grid, become
    /// point data called `value`.
    ///
    /// Lists the simplices four times, and keeps none.
    ///
    /// # Errors
    /// That of the writer; [`io::ErrorKind::InvalidInput`] of any other triangulation, and of a volume of other sides.
    pub fn write_vtu(&self, volume: Option<&Volume>, out: &mut dyn Write) -> io::Result<()> {
        let invalid = |message| io::Error::new(io::ErrorKind::InvalidInput, message);
        let (Rule::Grid { sides, closed: false } | Rule::Induced { sides, .. }) = &self.rule else {
            return Err(invalid("only the vertices of a grid have coordinates"));
        };
        if sides.len() > 3 {
            return Err(invalid("VTU has three coordinates, and the grid more sides"));
        }
        if volume.is_some_and(|volume| volume.sides() != sides) {
            return Err(invalid("the samples are not those of the grid"));
        }
        let kept = match &self.rule {
            Rule::Induced { kept, .. } => Some((kept, kept.ranks())),
            _ => None,
        };
        let is_kept = |vertex: u32| kept.as_ref().is_none_or(|(kept, _)| kept.contains(vertex));
        let num_points = kept.as_ref().map_or(self.num_vertices() as usize, |(kept, _)| kept.len());
        let (mut num_cells, mut num_corners) = (0, 0);
        let Ok(()) = self.try_for_each(|simplex| {
            num_cells += 1;
            num_corners += simplex.len();
            Ok::<(), Infallible>(())
        });
        head(out, num_points, num_cells)?;
        if let Some(volume) = volume {
            let size = volume.sample().size();
            writeln!(out, r#"<PointData Scalars="value">"#)?;
            let attributes = format!(r#"type="{}" Name="value""#, vtk_name(volume.sample()));
            array(out, &attributes, num_points * size, |data| {
                let samples = (0..).zip(volume.bytes().chunks_exact(size)).filter(|&(vertex, _)| is_kept(vertex));
                samples.into_iter().try_for_each(|(_, bytes)| data.write_all(bytes))
            })?;
            writeln!(out, "</PointData>")?;
        }
        writeln!(out, "<Points>")?;
        array(out, r#"type="Float32" NumberOfComponents="3""#, num_points * 12, |data| {
            (0..self.num_vertices()).filter(|&vertex| is_kept(vertex)).try_for_each(|vertex| {
                let mut rest = vertex;
                (0..3).try_for_each(|side| {
                    let side = sides.get(side).copied().unwrap_or(1);
                    #[expect(clippy::cast_precision_loss, reason = "sides are short enough, or the file is of no use")]
                    let place = (rest % side) as f32;
                    rest /= side;
                    data.write_all(&place.to_le_bytes())
                })
            })
        })?;
        writeln!(out, "</Points>\n<Cells>")?;
        array(out, r#"type="UInt32" Name="connectivity""#, num_corners * 4, |data| {
            self.try_for_each(|simplex| {
                simplex.iter().try_for_each(|&vertex| {
                    let point = kept.as_ref().map_or(vertex, |(_, ranks)| ranks.of(vertex));
                    data.write_all(&point.to_le_bytes())
                })
            })
        })?;
        array(out, r#"type="Int64" Name="offsets""#, num_cells * 8, |data| {
            let mut end = 0;
            self.try_for_each(|simplex| {
                end += simplex.len() as u64;
                data.write_all(&end.to_le_bytes())
            })
        })?;
        array(out, r#"type="UInt8" Name="types""#, num_cells, |data| {
            self.try_for_each(|simplex| data.write_all(&[CELL_TYPES[simplex.len() - 1]]))
        })?;
        writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
    }
}

/// What VTK calls a type.
fn vtk_name(sample: Sample) -> &'static str {
    match sample {
        Sample::U8 => "UInt8",
        Sample::I8 => "Int8",
        Sample::U16 => "UInt16",
        Sample::I16 => "Int16",
        Sample::U32 => "UInt32",
        Sample::I32 => "Int32",
        Sample::F32 => "Float32",
        Sample::F64 => "Float64",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{Format, ReadOptions, read_bytes};
    use crate::soup::Scalars;
    use crate::volume::Sides;

    fn written(triangulation: &Triangulation, volume: Option<&Volume>) -> Vec<u8> {
        let mut out = Vec::new();
        triangulation.write_vtu(volume, &mut out).unwrap();
        out
    }

    #[test]
    fn what_is_written_is_read_again() {
        let sides = [4, 3, 2];
        let samples: Vec<u8> = (0..24).map(|number| number * 7 % 10).collect();
        let volume = Volume::new(Sides(sides.to_vec()), Sample::U8, samples.clone()).unwrap();
        let grid = Triangulation::grid(&sides).unwrap();
        let part = grid.clone().induced(volume.values().map(|value| value >= 4.0).collect()).unwrap();
        let points = |kept: &dyn Fn(usize) -> bool| -> Vec<f32> {
            let kept = (0..24_u8).filter(|&vertex| kept(vertex.into()));
            kept.flat_map(|vertex| [vertex % 4, vertex / 4 % 3, vertex / 12].map(f32::from)).collect()
        };
        let is_above = |vertex: usize| samples[vertex] >= 4;
        let above: Vec<u32> = (0..24).filter(|&vertex| is_above(vertex as usize)).collect();
        let all: Vec<u32> = (0..24).collect();
        for (triangulation, vertices, expected) in [(grid, all, points(&|_| true)), (part, above, points(&is_above))] {
            let text = written(&triangulation, Some(&volume));
            let (soup, report) = read_bytes(&text, "a.vtu", &ReadOptions::default()).unwrap();
            assert_eq!(report.format, Format::Vtu);
            assert_eq!(soup.coordinates.unwrap().values, Scalars::F32(expected));
            let mut simplices = vec![Vec::new(); soup.simplices.len()];
            let Ok(()) = triangulation.try_for_each(|simplex| {
                let points = simplex.iter().map(|vertex| vertices.binary_search(vertex).unwrap());
                simplices[simplex.len() - 1].extend(points.map(|point| u32::try_from(point).unwrap()));
                Ok::<(), Infallible>(())
            });
            assert_eq!(soup.simplices, simplices);
        }
    }

    #[test]
    fn what_has_no_place_in_it_is_refused() {
        let refused = |triangulation: Triangulation, volume: Option<&Volume>| {
            let error = triangulation.write_vtu(volume, &mut Vec::new()).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        };
        refused(Triangulation::torus(&[3, 3]).unwrap(), None);
        refused(Triangulation::grid(&[2; 4]).unwrap(), None);
        let volume = Volume::new(Sides(vec![2, 3]), Sample::I8, vec![0; 6]).unwrap();
        refused(Triangulation::grid(&[3, 2]).unwrap(), Some(&volume));
    }
}
