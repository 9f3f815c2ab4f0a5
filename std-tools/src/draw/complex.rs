//! A simplicial complex as a scene: what is seen of it from outside, by the dimension of its top simplices.

use sig_core::{Complex, Dim, Index, Relations, SimplexId};

use super::colour::{HIGHLIGHT, INK, PALE, Rgb, SINGULAR, of_top};
use super::scene::{Dot, Face, Line, Scene, Swatch, grouped};
use crate::build::narrow;
use crate::singularities::Singularities;

/// Dots and lines are drawn for all vertices and edges of complexes of few.
const FEW: usize = 200;

/// Edges of simplices of dimension 4 or more are drawn up to so many: their triangles hide one another.
const SOME: usize = 2000;

/// The coordinates of the vertices, filled up to three; of more than three the first ones. `None` if there are none, or one
/// is not finite.
#[must_use]
pub fn points(complex: &impl Relations) -> Option<Vec<[f64; 3]>> {
    let section = complex.coordinates()?;
    let components = section.components as usize;
    let point = |vertex: usize| {
        let mut point = [0.0; 3];
        for (axis, value) in point.iter_mut().enumerate().take(components) {
            *value = section.column.number_at(vertex * components + axis).filter(|value| value.is_finite())?;
        }
        Some(point)
    };
    (0..complex.num_vertices()).map(point).collect()
}

/// A set of simplices that is told from the rest.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Highlight {
    /// What the legend calls it.
    pub name: String,
    /// Its simplices, in any order.
    pub simplices: Vec<SimplexId>,
    /// Its colour.
    pub colour: Rgb,
}

impl Highlight {
    /// A set in the colour of highlights.
    #[must_use]
    pub fn new(name: String, simplices: Vec<SimplexId>) -> Self {
        Self { name, simplices, colour: HIGHLIGHT }
    }
}

/// The scene of a valid complex whose vertices lie at `points`.
///
/// Drawn are the triangles of tetrahedra that do not lie between two (all, if all do), the triangles and edges and vertices
/// that are top simplices, and the simplices of `singularities` and of `highlights`, which shine through what hides them;
/// beside highlights the rest is pale. Of simplices of dimension 4 or more all triangles are drawn, and the edges, if there
/// are not many, shine through them.
///
/// Cost: one pass over the triangles, edges and vertices.
#[must_use]
pub fn scene<I: Index>(
    complex: &Complex<'_, I>,
    points: Vec<[f64; 3]>,
    singularities: Option<&Singularities>,
    highlights: &[Highlight],
) -> Scene {
    let mut scene = Scene { points, ..Scene::default() };
    scene.flat = scene.points.iter().all(|point| point[2] == 0.0);
    let mut build = Build { complex, scene, is_pale: !highlights.is_empty() };
    build.triangles();
    build.edges();
    build.vertices();
    build.tops();
    if let Some(singularities) = singularities {
        build.singular(singularities);
    }
    highlights.iter().for_each(|highlight| build.highlight(highlight));
    build.scene
}

struct Build<'c, 'a, I> {
    complex: &'c Complex<'a, I>,
    scene: Scene,
    is_pale: bool,
}

impl<I: Index> Build<'_, '_, I> {
    fn colour(&self, top: Dim) -> Rgb {
        if self.is_pale { PALE } else { of_top(top) }
    }

    /// The dimension of the largest top simplex around one, itself if it is one; and how many representatives there are.
    fn top(&self, simplex: SimplexId, dim: Dim) -> (Dim, usize) {
        let mut around = self.complex.partial_coboundary(simplex);
        let first = around.next().and_then(|top| self.complex.dim_of(top));
        (first.unwrap_or(dim), usize::from(first.is_some()) + around.count())
    }

    /// The vertices of a simplex of so many.
    fn corners<const N: usize>(&self, simplex: SimplexId) -> Option<[u32; N]> {
        let mut vertices = self.complex.vertices(simplex);
        let mut corners = [0; N];
        for corner in &mut corners {
            *corner = narrow(vertices.next()?.index());
        }
        Some(corners)
    }

    fn face(&mut self, simplex: SimplexId, colour: Rgb, is_mark: bool) {
        if let Some(corners) = self.corners(simplex) {
            self.scene.faces.push(Face { corners, colour, group: 0, is_mark });
        }
    }

    fn line(&mut self, simplex: SimplexId, colour: Rgb, radius: f64, is_mark: bool) {
        if let Some(ends) = self.corners(simplex) {
            self.scene.lines.push(Line { ends, colour, radius, is_mark });
        }
    }

    fn dot(&mut self, simplex: SimplexId, colour: Rgb, radius: f64, is_mark: bool) {
        self.scene.dots.push(Dot { at: narrow(simplex.index()), colour, radius, is_mark });
    }

    fn triangles(&mut self) {
        let is_solid = self.complex.dim() == Some(3);
        for triangle in self.complex.simplices_of_dim(2) {
            let (top, around) = self.top(triangle, 2);
            // Between two tetrahedra nobody looks.
            if !is_solid || around != 2 {
                self.face(triangle, self.colour(top), false);
            }
        }
        if is_solid && self.scene.faces.is_empty() {
            // A closed manifold, which has no outside.
            for triangle in self.complex.simplices_of_dim(2) {
                self.face(triangle, self.colour(3), false);
            }
        }
    }

    fn edges(&mut self) {
        let (complex, count) = (self.complex, self.complex.num_simplices_of_dim(1));
        let is_graph = complex.dim() == Some(1);
        // Lines of large graphs are thin.
        let radius = if is_graph { (60.0 / (count as f64 + 1.0).sqrt()).clamp(0.5, 2.5) } else { 2.2 };
        for edge in complex.simplices_of_dim(1) {
            let (top, _) = self.top(edge, 1);
            if top == 1 {
                self.line(edge, self.colour(1), radius, false);
            } else if top > 3 && count <= SOME && !self.is_pale {
                self.line(edge, INK, if count <= FEW { 1.0 } else { 0.6 }, true);
            } else if count <= FEW && (self.scene.flat || top > 3) {
                self.line(edge, if self.is_pale { PALE } else { INK }, 1.0, false);
            }
        }
    }

    fn vertices(&mut self) {
        let (complex, count) = (self.complex, self.complex.num_vertices());
        let isolated = if complex.dim() == Some(0) { (90.0 / (count as f64).sqrt()).clamp(1.0, 5.0) } else { 4.0 };
        let is_drawn = count <= FEW && complex.num_simplices_of_dim(1) <= 4 * FEW;
        for vertex in complex.simplices_of_dim(0) {
            if complex.is_top(vertex) {
                self.dot(vertex, self.colour(0), isolated, false);
            } else if is_drawn {
                let is_inside = !self.is_pale && self.top(vertex, 0).0 > 3;
                self.dot(vertex, if self.is_pale { PALE } else { INK }, 3.0, is_inside);
            }
        }
    }

    /// The legend of the top simplices.
    fn tops(&mut self) {
        let (complex, dim) = (self.complex, self.complex.dim().unwrap_or(0));
        for top in (0..=dim).rev() {
            let count = complex.simplices_of_dim(top).filter(|&simplex| complex.is_top(simplex)).count();
            if count == 0 {
                continue;
            }
            let swatch = match top {
                0 => Swatch::Dot,
                1 => Swatch::Line,
                _ => Swatch::Face,
            };
            let text = format!("{} {}", grouped(count), top_name(top, dim, count));
            let colour = self.colour(top);
            self.scene.legend.push(swatch, colour, text);
        }
    }

    fn singular(&mut self, singularities: &Singularities) {
        let [vertices, edges, triangles] = &singularities.by_dim;
        // Where most edges are marked there would be nothing else to see.
        let is_crowded = edges.len() > SOME && 2 * edges.len() > self.complex.num_simplices_of_dim(1);
        let is_drawn = !self.is_pale && !is_crowded;
        // Many marks are small, or they would hide what they mark.
        let radius = |count: usize, least: f64, most: f64| (30.0 / (count as f64).sqrt()).clamp(least, most);
        if is_drawn {
            edges.iter().for_each(|&edge| self.line(edge, SINGULAR, radius(edges.len(), 1.2, 2.4), true));
            vertices.iter().for_each(|&vertex| self.dot(vertex, SINGULAR, radius(vertices.len(), 2.0, 5.0), true));
        }
        let named = [(vertices, "vertices", "vertex"), (edges, "edges", "edge"), (triangles, "triangles", "triangle")];
        for (swatch, (found, many, one)) in [Swatch::Dot, Swatch::Line, Swatch::Face].into_iter().zip(named) {
            if !found.is_empty() {
                let name = if found.len() == 1 { one } else { many };
                let text = format!("{} non-manifold {name}", grouped(found.len()));
                let (swatch, colour) = if is_drawn { (swatch, SINGULAR) } else { (Swatch::None, INK) };
                self.scene.legend.push(swatch, colour, text);
            }
        }
    }

    fn highlight(&mut self, highlight: &Highlight) {
        let complex = self.complex;
        let mut most = 0;
        for &simplex in &highlight.simplices {
            let dim = complex.dim_of(simplex).unwrap_or(0);
            most = most.max(dim.min(2));
            match dim {
                0 => self.dot(simplex, highlight.colour, 5.0, true),
                1 => self.line(simplex, highlight.colour, 2.4, true),
                2 => self.face(simplex, highlight.colour, true),
                _ => complex.boundary(simplex, 2).for_each(|face| self.face(face, highlight.colour, true)),
            }
        }
        self.scene.legend.push(
            [Swatch::Dot, Swatch::Line, Swatch::Face][most],
            highlight.colour,
            highlight.name.clone(),
        );
    }
}

/// What top simplices of a dimension are called in a complex.
fn top_name(top: Dim, dim: Dim, count: usize) -> String {
    let one_or_many = |one: &str, many: &str| if count == 1 { one.to_owned() } else { many.to_owned() };
    match top {
        0 if dim == 0 => one_or_many("vertex", "vertices"),
        0 => one_or_many("isolated vertex", "isolated vertices"),
        1 if dim == 1 => one_or_many("edge", "edges"),
        1 => one_or_many("wire edge", "wire edges"),
        2 if dim == 2 => one_or_many("triangle", "triangles"),
        2 => one_or_many("dangling triangle", "dangling triangles"),
        3 => one_or_many("tetrahedron", "tetrahedra"),
        _ => format!("top {top}-simpl{}", if count == 1 { "ex" } else { "ices" }),
    }
}
