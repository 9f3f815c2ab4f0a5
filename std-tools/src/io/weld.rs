//! Welding: vertices at one place, or near each other, become one.

use std::fmt;
use std::str::FromStr;

use hashbrown::HashMap;

use super::attributes;
use super::error::{ErrorKind, Fault, Position};
use super::report::ReadReport;
use crate::attribute::Attribute;
use crate::soup::{Labels, Scalars, Soup};

/// Which vertices become one.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Weld {
    /// None, not even the corners of STL's triangles.
    None,
    /// Those with equal coordinates, −0 being +0.
    Exact,
    /// Those at most so far apart: in the order of the input each becomes the first before it that stayed and is as near, or
    /// stays. The distance is Euclidean, finite and not negative.
    Within(f64),
}

impl FromStr for Weld {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => Ok(Self::None),
            "exact" => Ok(Self::Exact),
            _ => match text.parse() {
                Ok(distance) if f64::is_finite(distance) && distance >= 0.0 => Ok(Self::Within(distance)),
                _ => Err("expected none, exact, or a distance".into()),
            },
        }
    }
}

impl fmt::Display for Weld {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Exact => f.write_str("exact"),
            Self::Within(distance) => write!(f, "{distance}"),
        }
    }
}

/// For each vertex the one that it becomes, which is no later one.
fn targets(coordinates: &[f64], dim: usize, weld: Weld) -> Vec<u32> {
    let distance = match weld {
        Weld::Within(distance) => distance,
        Weld::None | Weld::Exact => 0.0,
    };
    // Cells of a grid as wide as the distance, by the first coordinates: what is near lies in this one or the next.
    let axes = dim.min(3);
    let cell_of = |point: &[f64]| {
        let mut cell = [0_i64; 3];
        for (cell, value) in cell.iter_mut().zip(&point[..axes]) {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "saturates: then many share a cell, and all are compared"
            )]
            let number =
                if distance > 0.0 { (value / distance).floor() as i64 } else { (value + 0.0).to_bits() as i64 };
            *cell = number;
        }
        cell
    };
    let reach = if distance > 0.0 { -1..=1 } else { 0..=0 };
    let side = reach.clone().count();
    let mut grid: HashMap<[i64; 3], Vec<u32>> = HashMap::default();
    let mut targets = Vec::with_capacity(coordinates.len() / dim.max(1));
    for (number, point) in (0_u32..).zip(coordinates.chunks_exact(dim)) {
        let cell = cell_of(point);
        let is_near = |&other: &u32| {
            let other = &coordinates[other as usize * dim..][..dim];
            let square: f64 = point.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
            square <= distance * distance
        };
        let near = (0..side.pow(u32::try_from(axes).unwrap_or(0))).filter_map(|neighbour| {
            let mut other = cell;
            let mut rest = neighbour;
            for place in &mut other[..axes] {
                *place = place.saturating_add(i64::try_from(rest % side).unwrap_or(0) + reach.start());
                rest /= side;
            }
            grid.get(&other)?.iter().copied().find(is_near)
        });
        let target = near.min().unwrap_or(number);
        if target == number {
            grid.entry(cell).or_default().push(number);
        }
        targets.push(target);
    }
    targets
}

/// Welds the vertices of a soup with coordinates. The label of the vertex that stays stays; a simplex that then repeats a
/// vertex is dropped and counted if `drop_degenerate`, else a fault.
///
/// Time is linear in the input as long as few vertices are near each other.
pub(super) fn weld(soup: &mut Soup, report: &mut ReadReport, weld: Weld, drop_degenerate: bool) -> Result<(), Fault> {
    let Some(coordinates) = soup.coordinates.as_mut().filter(|coordinates| weld != Weld::None && coordinates.dim > 0)
    else {
        return Ok(());
    };
    let dim = coordinates.dim;
    let targets = match &coordinates.values {
        Scalars::F32(values) => targets(&values.iter().copied().map(f64::from).collect::<Vec<_>>(), dim, weld),
        Scalars::F64(values) => targets(values, dim, weld),
    };
    let stays: Vec<bool> = targets.iter().zip(0..).map(|(&target, number)| target == number).collect();
    let gone = stays.iter().filter(|&&stays| !stays).count();
    if gone == 0 {
        return Ok(());
    }
    report.welded += gone;
    let mut left = 0;
    let numbers: Vec<u32> = stays
        .iter()
        .map(|&stays| {
            left += u32::from(stays);
            left.wrapping_sub(1)
        })
        .collect();
    let of_vertices: Vec<&Attribute> = soup.attributes.iter().filter(|attribute| attribute.dim == 0).collect();
    let differs = |&(vertex, &target): &(usize, &u32)| {
        of_vertices.iter().any(|attribute| !attribute.is_same(vertex, target as usize))
    };
    report.welded_differing += targets.iter().enumerate().filter(differs).count();
    for (dim, flat) in soup.simplices.iter_mut().enumerate() {
        let mut kept = Vec::with_capacity(flat.len());
        let mut stays = Vec::new();
        for simplex in flat.chunks_exact(dim + 1) {
            let start = kept.len();
            kept.extend(simplex.iter().map(|&vertex| targets[vertex as usize]));
            if super::cone::repeated(&kept[start..]).is_some() {
                let names: Vec<_> = simplex.iter().map(|&vertex| soup.labels.name(vertex)).collect();
                if !drop_degenerate {
                    let message = format!(
                        "the simplex {} repeats a vertex once vertices are welded; --drop-degenerate drops such cells and \
                         counts them",
                        names.join(",")
                    );
                    return Err(Fault::new(Position::Whole, ErrorKind::Rule(message.into())));
                }
                let names = names.join(",");
                report.note_bad(format!(": the simplex {names} repeats a vertex once vertices are welded"));
                report.degenerate_dropped += 1;
                kept.truncate(start);
            }
            stays.push(kept.len() > start);
        }
        if dim > 0 {
            attributes::retain(&mut soup.attributes, dim, &stays);
        }
        kept.iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);
        *flat = kept;
    }
    let labels = std::mem::replace(&mut soup.labels, Labels::Numbered(0));
    attributes::retain(&mut soup.attributes, 0, &stays);
    let (labels, coordinates) = super::intake::retained(labels, soup.coordinates.take(), &stays);
    (soup.labels, soup.coordinates) = (labels, coordinates);
    report.vertices = soup.labels.len();
    report.simplices = soup.simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1)).collect();
    Ok(())
}
