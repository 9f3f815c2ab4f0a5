//! Triangulations of any size, one simplex after the other in memory that does not grow: [`Triangulation`].

use std::convert::Infallible;
use std::io::{self, Write};

use sig_core::{Dim, MAX_DIM};

use super::SplitMix64;
use super::induced::{self, Vertices};

/// The most sides of a grid: six have 720 simplices a cell.
pub(super) const MOST_SIDES: usize = 6;

/// A triangulation that is given by a rule: its top simplices can be listed without being kept.
///
/// ```
/// use sig_tools::generate::Triangulation;
///
/// let grid = Triangulation::grid(&[3, 3, 3])?;
/// assert_eq!(grid.counts(), Some(vec![27, 98, 120, 48]));
/// let mut list = Vec::new();
/// grid.write_list(&mut list).expect("room in memory");
/// assert_eq!(String::from_utf8_lossy(&list).lines().count(), 48);
/// # Ok::<(), sig_tools::generate::GenerateError>(())
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Triangulation {
    pub(super) rule: Rule,
    num_vertices: u32,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Rule {
    /// Vertices along each side, and whether the sides are closed.
    Grid {
        sides: Vec<u32>,
        closed: bool,
    },
    /// The part of a grid between some of its vertices.
    Induced {
        sides: Vec<u32>,
        kept: Vertices,
    },
    /// Edges along an edge of the octahedron.
    Sphere {
        steps: u32,
    },
    Random {
        dim: Dim,
        count: u64,
        seed: u64,
    },
}

/// Why there is no such triangulation.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// Too few sides, or too many.
    #[error("{0} sides; a grid has 1 to {MOST_SIDES}")]
    Sides(usize),
    /// A side is too short.
    #[error("a side of {side} vertices; it takes at least {least}")]
    Side {
        /// The vertices.
        side: u32,
        /// How many are needed.
        least: u32,
    },
    /// A simplex has more vertices than there are, or its dimension is too large.
    #[error(
        "simplices of dimension {dim} on {vertices} vertices: there are none, or the dimension is more than {MAX_DIM}"
    )]
    Dimension {
        /// The dimension.
        dim: Dim,
        /// The vertices there are.
        vertices: u32,
    },
    /// Parts are taken of grids.
    #[error("only a grid with ends has parts between some of its vertices")]
    NoGrid,
    /// There are more vertices than 32-bit numbers.
    #[error("more than 4294967294 vertices")]
    TooManyVertices,
}

/// A number of vertices, if 32-bit numbers are enough.
fn vertices(count: Option<u64>) -> Result<u32, GenerateError> {
    let count = count.and_then(|count| u32::try_from(count).ok()).filter(|&count| count < u32::MAX);
    count.ok_or(GenerateError::TooManyVertices)
}

impl Triangulation {
    /// Freudenthal's triangulation of a box of so many vertices along each side, at least two: every unit cube falls into
    /// D! simplices, one for each order in which its sides can be walked from its least corner to its greatest.
    ///
    /// The vertex (x, y, z, …) has the number x + k (y + l (z + …)) for sides of k, l, m, … vertices. Of the p-simplices
    /// there are Σ_s surj(s, p) e_s: surj(s, p) is the number of maps of s elements onto p, and e_s the sum over all sets
    /// S of s sides of the product of k − 1 over the sides in S and of k over the others. So 6 (k−1) (l−1) (m−1) tetrahedra.
    /// The simplices are oriented alike.
    ///
    /// # Errors
    /// [`GenerateError`]: no sides or more than six, a short one, too many vertices.
    pub fn grid(sides: &[u32]) -> Result<Self, GenerateError> {
        Self::grid_or_torus(sides, false)
    }

    /// The same of a box whose opposite sides are one, a torus; sides are of at least three vertices.
    ///
    /// Of the p-simplices there are k l m … Σ_s C(D, s) surj(s, p) for D sides: on three of them 7, 12 and 6 for each vertex.
    ///
    /// # Errors
    /// As [`grid`](Self::grid).
    pub fn torus(sides: &[u32]) -> Result<Self, GenerateError> {
        Self::grid_or_torus(sides, true)
    }

    fn grid_or_torus(sides: &[u32], closed: bool) -> Result<Self, GenerateError> {
        if sides.is_empty() || sides.len() > MOST_SIDES {
            return Err(GenerateError::Sides(sides.len()));
        }
        let least = if closed { 3 } else { 2 };
        if let Some(&side) = sides.iter().find(|&&side| side < least) {
            return Err(GenerateError::Side { side, least });
        }
        let count = sides.iter().try_fold(1_u64, |count, &side| count.checked_mul(side.into()));
        Ok(Self { rule: Rule::Grid { sides: sides.to_vec(), closed }, num_vertices: vertices(count)? })
    }

    /// The part of this grid whose simplices have all their vertices among `kept`: for the vertices where a field is at
    /// least (at most) some value, the superlevel (sublevel) set of its linear interpolation, up to homotopy.
    ///
    /// Its maximal simplices are listed, of all dimensions; those of the greatest are oriented alike.
    ///
    /// # Errors
    /// [`GenerateError::NoGrid`] of any other triangulation.
    pub fn induced(self, kept: Vertices) -> Result<Self, GenerateError> {
        match self.rule {
            Rule::Grid { sides, closed: false } => Ok(Self { rule: Rule::Induced { sides, kept }, ..self }),
            _ => Err(GenerateError::NoGrid),
        }
    }

    /// The 2-sphere as an octahedron with `steps` edges along each of its edges: 4n² + 2 vertices, 12n² edges and 8n²
    /// triangles for n = `steps` > 0, oriented alike. Vertices are numbered around the axis from pole to pole.
    ///
    /// # Errors
    /// [`GenerateError::Side`] if `steps` is 0, [`GenerateError::TooManyVertices`].
    pub fn sphere(steps: u32) -> Result<Self, GenerateError> {
        if steps == 0 {
            return Err(GenerateError::Side { side: 1, least: 2 });
        }
        let square = u64::from(steps) * u64::from(steps);
        let count = square.checked_mul(4).and_then(|count| count.checked_add(2));
        Ok(Self { rule: Rule::Sphere { steps }, num_vertices: vertices(count)? })
    }

    /// `count` simplices of dimension `dim`, each of different vertices out of `vertices`, all sets being equally likely:
    /// what [`SplitMix64`] draws from `seed`. Sets may repeat, and vertices may be in none.
    ///
    /// # Errors
    /// [`GenerateError::Dimension`] if there are fewer vertices than a simplex has, or `dim` is more than [`MAX_DIM`];
    /// [`GenerateError::TooManyVertices`].
    pub fn random(vertices: u32, dim: Dim, count: u64, seed: u64) -> Result<Self, GenerateError> {
        if dim > MAX_DIM || dim >= vertices as usize {
            return Err(GenerateError::Dimension { dim, vertices });
        }
        Ok(Self { rule: Rule::Random { dim, count, seed }, num_vertices: self::vertices(Some(vertices.into()))? })
    }

    /// The dimension of the simplices, or the greatest that they may have.
    #[must_use]
    pub fn dim(&self) -> Dim {
        match &self.rule {
            Rule::Grid { sides, .. } | Rule::Induced { sides, .. } => sides.len(),
            Rule::Sphere { .. } => 2,
            Rule::Random { dim, .. } => *dim,
        }
    }

    /// The number of vertices: the simplices name numbers below it.
    #[must_use]
    pub fn num_vertices(&self) -> u32 {
        self.num_vertices
    }

    /// The number of simplices that are listed; `None` if that is no 64-bit number.
    ///
    /// Cost: constant, but that of listing them for parts of grids.
    #[must_use]
    pub fn num_listed(&self) -> Option<u64> {
        match &self.rule {
            Rule::Random { count, .. } => Some(*count),
            Rule::Induced { .. } => {
                let mut count = 0;
                let Ok(()) = self.try_for_each(|_| {
                    count += 1;
                    Ok::<(), Infallible>(())
                });
                Some(count)
            }
            _ => self.counts()?.last().copied(),
        }
    }

    /// How many simplices of each dimension there are, by formula; `None` of random ones, and past 64 bits. Those of parts
    /// of grids are counted one by one, without those of the greatest dimensions if there are none.
    #[must_use]
    pub fn counts(&self) -> Option<Vec<u64>> {
        match &self.rule {
            Rule::Grid { sides, closed } => {
                // e_s for s = 0, 1, …; on a torus every side counts in full.
                let mut sums = vec![1_u64];
                for &side in sides {
                    let inner = u64::from(side) - u64::from(!closed);
                    sums.push(0);
                    for s in (0..sums.len()).rev() {
                        let below = if s > 0 { sums[s - 1].checked_mul(inner)? } else { 0 };
                        sums[s] = sums[s].checked_mul(side.into())?.checked_add(below)?;
                    }
                }
                let count = |p| {
                    (0..).zip(&sums).try_fold(0_u64, |count, (s, sum)| {
                        surjections(s, p).checked_mul(*sum).and_then(|more| count.checked_add(more))
                    })
                };
                (0..=sides.len()).map(count).collect()
            }
            Rule::Sphere { steps } => {
                let square = u64::from(*steps) * u64::from(*steps);
                Some(vec![4 * square + 2, 12 * square, 8 * square])
            }
            Rule::Induced { sides, kept } => Some(induced::counts(sides, kept)),
            Rule::Random { .. } => None,
        }
    }

    /// Calls `visit` with the vertices of every listed simplex, until it fails.
    ///
    /// # Errors
    /// That of `visit`.
    pub fn try_for_each<E>(&self, visit: impl FnMut(&[u32]) -> Result<(), E>) -> Result<(), E> {
        match &self.rule {
            Rule::Grid { sides, closed } => visit_grid(sides, *closed, visit),
            Rule::Induced { sides, kept } => induced::visit(sides, kept, visit),
            Rule::Sphere { steps } => visit_sphere(*steps, visit),
            Rule::Random { dim, count, seed } => visit_random(self.num_vertices, *dim, *count, *seed, visit),
        }
    }

    /// Writes one simplex a line, by its vertex numbers.
    ///
    /// # Errors
    /// That of the writer.
    pub fn write_list(&self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        let mut line = Vec::new();
        self.try_for_each(|simplex| {
            line.clear();
            for (place, vertex) in simplex.iter().enumerate() {
                write!(line, "{}{vertex}", if place > 0 { " " } else { "" })?;
            }
            line.push(b'\n');
            out.write_all(&line)
        })
    }

    /// Writes tetrahedra in binary: `TETB`, the numbers of vertices and of tetrahedra as u32, three f32 a vertex, four u32 a
    /// tetrahedron, all little-endian. For grids of three sides, whose vertices stand at whole numbers.
    ///
    /// # Errors
    /// That of the writer; [`io::ErrorKind::InvalidInput`] of any other triangulation, and of one with 2³² tetrahedra or more.
    pub fn write_tetbin(&self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        let invalid = |message| io::Error::new(io::ErrorKind::InvalidInput, message);
        if matches!(self.rule, Rule::Induced { .. }) {
            return Err(invalid(
                "a part of a grid has simplices of several dimensions, and tetbin tetrahedra alone; use vtu",
            ));
        }
        let Rule::Grid { sides, closed: false } = &self.rule else {
            return Err(invalid("only a grid of three sides has tetrahedra with coordinates"));
        };
        let &[k, l, m] = sides.as_slice() else {
            return Err(invalid("only a grid of three sides has tetrahedra with coordinates"));
        };
        let count = self.num_listed().and_then(|count| u32::try_from(count).ok());
        let count = count.ok_or_else(|| invalid("the format counts tetrahedra in 32 bits, and here are more"))?;
        out.write_all(b"TETB")?;
        out.write_all(&self.num_vertices.to_le_bytes())?;
        out.write_all(&count.to_le_bytes())?;
        for (z, y, x) in (0..m).flat_map(|z| (0..l).flat_map(move |y| (0..k).map(move |x| (z, y, x)))) {
            #[expect(clippy::cast_precision_loss, reason = "sides are short enough, or the file is of no use")]
            let point = [x as f32, y as f32, z as f32];
            point.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
        }
        self.try_for_each(|corners| corners.iter().try_for_each(|corner| out.write_all(&corner.to_le_bytes())))
    }
}

/// The number of maps of `from` elements onto `onto`: surj(s, p) = p (surj(s − 1, p) + surj(s − 1, p − 1)).
fn surjections(from: u64, onto: usize) -> u64 {
    if from == 0 || onto == 0 {
        return u64::from(from == 0 && onto == 0);
    }
    onto as u64 * (surjections(from - 1, onto) + surjections(from - 1, onto - 1))
}

/// All orders of the first `count` sides, each with whether it is odd.
fn orders(count: usize) -> Vec<(Vec<usize>, bool)> {
    let mut all = vec![(Vec::new(), false)];
    for side in 0..count {
        let longer = all.iter().flat_map(|(order, odd)| {
            (0..=side).map(move |place| {
                let mut order = order.clone();
                order.insert(place, side);
                (order, odd ^ ((side - place) % 2 == 1))
            })
        });
        all = longer.collect();
    }
    all
}

fn visit_grid<E>(sides: &[u32], closed: bool, mut visit: impl FnMut(&[u32]) -> Result<(), E>) -> Result<(), E> {
    let orders = orders(sides.len());
    let mut cell = vec![0_u32; sides.len()];
    let mut steps = vec![0_u32; sides.len()];
    let mut simplex = vec![0; sides.len() + 1];
    loop {
        // Where the cell's least corner is, and how far it is to the next along each side, around the corner if need be.
        let (mut corner, mut stride) = (0_u32, 1_u32);
        for ((step, &place), &side) in steps.iter_mut().zip(&cell).zip(sides) {
            corner += place * stride;
            *step = if place + 1 == side { stride.wrapping_mul(side - 1).wrapping_neg() } else { stride };
            stride = stride.wrapping_mul(side);
        }
        for (order, odd) in &orders {
            simplex[0] = corner;
            for (place, &side) in order.iter().enumerate() {
                simplex[place + 1] = simplex[place].wrapping_add(steps[side]);
            }
            if *odd {
                simplex.swap(sides.len() - 1, sides.len());
            }
            visit(&simplex)?;
        }
        let carried = cell.iter_mut().zip(sides).find_map(|(place, &side)| {
            *place += 1;
            if *place < side - u32::from(!closed) {
                return Some(());
            }
            *place = 0;
            None
        });
        if carried.is_none() {
            return Ok(());
        }
    }
}

fn visit_sphere<E>(steps: u32, mut visit: impl FnMut(&[u32]) -> Result<(), E>) -> Result<(), E> {
    let last = 4 * steps * steps + 1;
    // Vertex `place` of the ring that is `depth` steps from a pole.
    let north = |depth: u32, place: u32| if depth == 0 { 0 } else { 1 + 2 * depth * (depth - 1) + place % (4 * depth) };
    let south = |depth: u32, place: u32| match depth {
        0 => last,
        _ if depth == steps => north(depth, place),
        _ => last - 2 * depth * (depth + 1) + place % (4 * depth),
    };
    for is_south in [false, true] {
        let vertex = |depth, place| if is_south { south(depth, place) } else { north(depth, place) };
        let mut triangle = |a, b, c| if is_south { visit(&[a, c, b]) } else { visit(&[a, b, c]) };
        for depth in 0..steps {
            for quadrant in 0..4 {
                let (inner, outer) = (quadrant * depth, quadrant * (depth + 1));
                for place in 0..=depth {
                    let (a, b) = (vertex(depth, inner + place), vertex(depth + 1, outer + place));
                    let c = vertex(depth + 1, outer + place + 1);
                    triangle(a, b, c)?;
                    if place < depth {
                        triangle(a, c, vertex(depth, inner + place + 1))?;
                    }
                }
            }
        }
    }
    Ok(())
}

fn visit_random<E>(
    vertices: u32,
    dim: Dim,
    count: u64,
    seed: u64,
    mut visit: impl FnMut(&[u32]) -> Result<(), E>,
) -> Result<(), E> {
    let mut random = SplitMix64::new(seed);
    let mut simplex = Vec::with_capacity(dim + 1);
    for _ in 0..count {
        simplex.clear();
        while simplex.len() <= dim {
            let vertex = u32::try_from(random.next_below(vertices as usize)).unwrap_or(0);
            if !simplex.contains(&vertex) {
                simplex.push(vertex);
            }
        }
        visit(&simplex)?;
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    /// The simplices that a triangulation visits.
    pub(in crate::generate) fn listed(triangulation: &Triangulation) -> Vec<Vec<u32>> {
        let mut simplices = Vec::new();
        let Ok(()) = triangulation.try_for_each(|simplex| {
            simplices.push(simplex.to_vec());
            Ok::<(), Infallible>(())
        });
        simplices
    }

    /// The faces of all listed simplices, counted one by one.
    fn counted(triangulation: &Triangulation) -> Vec<u64> {
        let mut faces = vec![BTreeSet::new(); triangulation.dim() + 1];
        for mut simplex in listed(triangulation) {
            simplex.sort_unstable();
            for mask in 1_u32..1 << simplex.len() {
                let face: Vec<u32> = (0..).zip(&simplex).filter(|(k, _)| mask >> k & 1 == 1).map(|(_, &v)| v).collect();
                faces[face.len() - 1].insert(face);
            }
        }
        faces.iter().map(|faces| faces.len() as u64).collect()
    }

    /// How often each facet is met in each orientation.
    fn orientations(triangulation: &Triangulation) -> BTreeMap<Vec<u32>, [u32; 2]> {
        let mut facets = BTreeMap::new();
        for simplex in listed(triangulation) {
            for omitted in 0..simplex.len() {
                let mut facet: Vec<u32> = simplex.clone();
                facet.remove(omitted);
                let inversions = (0..facet.len()).flat_map(|k| (0..k).map(move |i| (i, k)));
                let odd = inversions.filter(|&(i, k)| facet[i] > facet[k]).count() + omitted;
                facet.sort_unstable();
                facets.entry(facet).or_insert([0; 2])[odd % 2] += 1;
            }
        }
        facets
    }

    fn all() -> Vec<Triangulation> {
        let grids: [&[u32]; 6] = [&[5], &[2, 2], &[4, 3], &[2, 2, 2], &[4, 2, 3], &[2, 3, 2, 3]];
        let tori: [&[u32]; 5] = [&[3], &[3, 3], &[5, 4], &[3, 4, 3], &[3, 3, 3, 3]];
        let grids = grids.iter().map(|sides| Triangulation::grid(sides).unwrap());
        let tori = tori.iter().map(|sides| Triangulation::torus(sides).unwrap());
        grids.chain(tori).chain((1..5).map(|steps| Triangulation::sphere(steps).unwrap())).collect()
    }

    #[test]
    fn formulas_equal_counts() {
        for triangulation in all() {
            assert_eq!(triangulation.counts(), Some(counted(&triangulation)), "{triangulation:?}");
            assert_eq!(triangulation.num_listed(), Some(listed(&triangulation).len() as u64));
        }
    }

    /// From the literature: Freudenthal's formula in space, the Euler characteristics, and a Kuhn grid counted elsewhere.
    #[test]
    fn known_counts() {
        let kuhn = Triangulation::grid(&[14, 14, 14]).unwrap().counts().unwrap();
        assert_eq!((kuhn.iter().sum::<u64>(), kuhn[3]), (60_243, 6 * 13 * 13 * 13));
        let billion = Triangulation::grid(&[340, 340, 340]).unwrap().counts().unwrap();
        assert!((1_000_000_000..1_100_000_000).contains(&billion.iter().sum::<u64>()), "{billion:?}");
        let euler = |triangulation: &Triangulation| {
            let counts = triangulation.counts().unwrap();
            counts
                .iter()
                .zip([1, -1].iter().cycle())
                .map(|(&count, sign)| sign * i64::try_from(count).unwrap())
                .sum::<i64>()
        };
        assert_eq!(euler(&Triangulation::grid(&[7, 5, 9, 3]).unwrap()), 1);
        assert_eq!(euler(&Triangulation::torus(&[7, 5, 9]).unwrap()), 0);
        assert_eq!(euler(&Triangulation::sphere(1000).unwrap()), 2);
        assert_eq!(Triangulation::torus(&[10, 10, 10]).unwrap().counts(), Some(vec![1000, 7000, 12_000, 6000]));
    }

    #[test]
    fn neighbours_are_oriented_alike() {
        for triangulation in all() {
            let closed = !matches!(&triangulation.rule, Rule::Grid { closed: false, .. });
            for (facet, [even, odd]) in orientations(&triangulation) {
                assert!(even <= 1 && odd <= 1, "{facet:?} of {triangulation:?}");
                assert!(!closed || even + odd == 2, "{facet:?} of {triangulation:?}");
            }
        }
    }

    #[test]
    fn random_simplices_are_those_of_their_seed() {
        let random = |seed| Triangulation::random(20, 3, 100, seed).unwrap();
        let simplices = listed(&random(1));
        assert_eq!(simplices, listed(&random(1)));
        assert_ne!(simplices, listed(&random(2)));
        assert_eq!(simplices.len(), 100);
        for simplex in simplices {
            assert_eq!(simplex.iter().collect::<BTreeSet<_>>().len(), 4);
            assert!(simplex.iter().all(|&vertex| vertex < 20));
        }
    }

    #[test]
    fn what_there_is_not_is_refused() {
        assert_eq!(Triangulation::grid(&[]), Err(GenerateError::Sides(0)));
        assert_eq!(Triangulation::grid(&[2; 7]), Err(GenerateError::Sides(7)));
        assert_eq!(Triangulation::grid(&[5, 1]), Err(GenerateError::Side { side: 1, least: 2 }));
        assert_eq!(Triangulation::torus(&[3, 2]), Err(GenerateError::Side { side: 2, least: 3 }));
        assert_eq!(Triangulation::grid(&[2_000_000, 3000]), Err(GenerateError::TooManyVertices));
        assert_eq!(Triangulation::sphere(0), Err(GenerateError::Side { side: 1, least: 2 }));
        assert_eq!(Triangulation::sphere(u32::MAX), Err(GenerateError::TooManyVertices));
        assert_eq!(Triangulation::random(3, 3, 1, 0), Err(GenerateError::Dimension { dim: 3, vertices: 3 }));
        assert_eq!(Triangulation::random(99, 32, 1, 0), Err(GenerateError::Dimension { dim: 32, vertices: 99 }));
        let mut out = Vec::new();
        assert!(Triangulation::torus(&[3, 3, 3]).unwrap().write_tetbin(&mut out).is_err());
        assert!(out.is_empty());
    }

    #[test]
    fn tetrahedra_in_binary_are_those_of_the_list() {
        let grid = Triangulation::grid(&[4, 3, 2]).unwrap();
        let (mut binary, mut text) = (Vec::new(), Vec::new());
        grid.write_tetbin(&mut binary).unwrap();
        grid.write_list(&mut text).unwrap();
        assert_eq!(binary[..4], *b"TETB");
        let words: Vec<u32> =
            binary[4..].chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        assert_eq!(words[..2], [24, 6 * 3 * 2]);
        let points: Vec<f32> = words[2..][..3 * 24].iter().map(|&bits| f32::from_bits(bits)).collect();
        assert_eq!(points[3 * 23..], [3.0, 2.0, 1.0]);
        let text = String::from_utf8(text).unwrap();
        let corners: Vec<u32> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
        assert_eq!(words[2 + 3 * 24..], corners);
    }
}
