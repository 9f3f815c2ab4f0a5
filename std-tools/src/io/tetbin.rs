//! TETB, tetrahedra in binary: `TETB`, the numbers of vertices and tetrahedra as 32-bit integers, three 32-bit floats a
//! vertex, four 32-bit vertex numbers from 0 a tetrahedron; all little-endian.

use super::error::{ErrorKind, Fault, Position, excerpt};
use super::intake::{Intake, reserve};
use super::source::Source;
use super::{Format, OnBad, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

/// The bytes that a file begins with.
pub(super) const MAGIC: &[u8] = b"TETB";

fn number(bytes: &[u8]) -> u32 {
    bytes.first_chunk().map_or(0, |&bytes| u32::from_le_bytes(bytes))
}

/// Reads a TETB file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    source.binary = true;
    let magic = source.take(4, "TETB")?;
    if magic != MAGIC {
        let kind = ErrorKind::Expected { expected: "TETB".into(), found: excerpt(magic) };
        return Err(Fault::new(Position::Byte(0), kind));
    }
    let vertices = number(source.take(4, "the number of vertices")?);
    let tetrahedra = number(source.take(4, "the number of tetrahedra")?);
    let mut values = Vec::with_capacity(reserve(3 * u64::from(vertices)));
    let scalars = 3 * u64::from(vertices);
    source.each_record(scalars, 4, "as many vertices as the header says", |position, bytes| {
        let value = f32::from_bits(number(bytes));
        if !value.is_finite() && options.on_bad == OnBad::Refuse {
            return Err(Fault::new(position, ErrorKind::NotFinite { found: value.to_string().into() }));
        }
        values.push(value);
        Ok(())
    })?;
    let mut intake = Intake::new(Format::Tetbin, options);
    source.each_record(tetrahedra.into(), 16, "as many tetrahedra as the header says", |position, bytes| {
        let mut corners = [0; 4];
        for (corner, bytes) in corners.iter_mut().zip(bytes.chunks_exact(4)) {
            *corner = number(bytes);
            if *corner >= vertices {
                let index = i64::from(*corner);
                let kind = ErrorKind::OutOfRange { index, vertices: vertices.into(), first: 0 };
                *corner = intake.missing(Fault::new(position, kind))?;
            }
        }
        intake.simplex(&corners).map_err(|refusal| Fault::new(position, refusal.kind(|vertex| vertex.to_string())))
    })?;
    source.need_end_of_bytes("file after the last tetrahedron")?;
    Ok(intake.finish(Labels::Numbered(vertices as usize), true, Some((3, Scalars::F32(values)))))
}
