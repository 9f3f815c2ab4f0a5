//! From where a picture is taken, and where each point comes to lie in it.

use super::scene::Scene;

/// An axis of space.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second one.
    Y,
    /// The third one.
    #[default]
    Z,
}

impl Axis {
    /// The axes x, y, z as they are called when this one is z, and they are turned into each other.
    fn cycle(self) -> [usize; 3] {
        match self {
            Self::X => [1, 2, 0],
            Self::Y => [2, 0, 1],
            Self::Z => [0, 1, 2],
        }
    }
}

/// A parallel projection: three directions at right angles, each of length 1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    /// What is to the right in the picture, up in it, and towards the viewer.
    rows: [[f64; 3]; 3],
}

impl Default for Camera {
    /// Along z.
    fn default() -> Self {
        Self::along(Axis::Z, false)
    }
}

impl Camera {
    /// Looks along an axis, from its large values to small ones, or from behind.
    #[must_use]
    pub fn along(axis: Axis, from_behind: bool) -> Self {
        let mut rows = [[0.0; 3]; 3];
        for (row, axis) in rows.iter_mut().zip(axis.cycle()) {
            row[axis] = 1.0;
        }
        if from_behind {
            rows[0] = rows[0].map(|value| -value);
            rows[2] = rows[2].map(|value| -value);
        }
        Self { rows }
    }

    /// Looks at the origin from a direction, in degrees: `azimuth` around the axis that is `up`, for z from x towards y;
    /// `elevation` above the plane of the two others.
    #[must_use]
    pub fn around(azimuth: f64, elevation: f64, up: Axis) -> Self {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
        let turned =
            [[-sin_a, cos_a, 0.0], [-sin_e * cos_a, -sin_e * sin_a, cos_e], [cos_e * cos_a, cos_e * sin_a, sin_e]];
        let mut rows = [[0.0; 3]; 3];
        for (row, values) in rows.iter_mut().zip(turned) {
            for (axis, value) in up.cycle().into_iter().zip(values) {
                row[axis] = value;
            }
        }
        Self { rows }
    }

    /// To the right, up, towards the viewer.
    pub(super) fn turn(&self, point: [f64; 3]) -> [f64; 3] {
        self.rows.map(|row| row[0] * point[0] + row[1] * point[1] + row[2] * point[2])
    }
}

/// A scene in the coordinates of a picture: x to the right, y down, z towards the viewer, in pixels.
#[derive(Clone, Debug)]
pub(super) struct Frame<'s> {
    pub(super) scene: &'s Scene,
    pub(super) points: Vec<[f64; 3]>,
    pub(super) width: usize,
    pub(super) height: usize,
    /// The thickness of thin lines, in pixels: grows with the picture.
    pub(super) unit: f64,
    /// Half the width of the lines around faces; 0 where faces are too small for lines.
    pub(super) outline: f64,
}

/// Around the picture, in units.
const MARGIN: f64 = 8.0;

impl<'s> Frame<'s> {
    /// The scene in a picture, of which the longer side has `size` pixels.
    pub(super) fn new(scene: &'s Scene, camera: &Camera, size: usize) -> Self {
        let size = size as f64;
        let unit = (size / 1000.0).max(0.4);
        let mut points: Vec<[f64; 3]> = scene.points.iter().map(|&point| camera.turn(point)).collect();
        // What is drawn is looked at; vertices of nothing that is drawn are not.
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        scene.corners(|corner| {
            for (axis, &value) in points[corner as usize].iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(value), high[axis].max(value));
            }
        });
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let room = (size - 2.0 * MARGIN * unit).max(1.0);
        let scale = if extent > 0.0 && extent.is_finite() { room / extent } else { 1.0 };
        let low = low.map(|value| if value.is_finite() { value } else { 0.0 });
        let high = high.map(|value| if value.is_finite() { value } else { 0.0 });
        let side = |axis: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most the size")]
            let side = ((high[axis] - low[axis]) * scale + 2.0 * MARGIN * unit).ceil() as usize;
            side.max(1)
        };
        for point in &mut points {
            let [x, y, z] = *point;
            *point = [x - low[0], high[1] - y, z - low[2]].map(|value| value * scale);
            point[0] += MARGIN * unit;
            point[1] += MARGIN * unit;
        }
        let mut frame = Self { scene, points, width: side(0), height: side(1), unit, outline: 0.0 };
        frame.outline = if scene.groups { 0.0 } else { frame.outline() };
        frame
    }

    /// Lines around faces are thinner where faces are small, and there are none where they would cover what is inside.
    fn outline(&self) -> f64 {
        const LEAST: f64 = 5.0;
        let faces = &self.scene.faces;
        // Some thousands of faces tell how large they are.
        let step = faces.len() / 4096 + 1;
        let mut sizes: Vec<f64> = faces
            .iter()
            .step_by(step)
            .map(|face| {
                let [a, b, c] = face.corners.map(|corner| self.points[corner as usize]);
                ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs().sqrt()
            })
            .collect();
        let middle = sizes.len() / 2;
        if sizes.is_empty() {
            return 0.0;
        }
        let (_, &mut typical, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        if typical < LEAST * self.unit { 0.0 } else { (0.02 * typical).clamp(0.25 * self.unit, 0.7 * self.unit) }
    }

    /// The corners of a face in the picture.
    pub(super) fn triangle(&self, corners: [u32; 3]) -> [[f64; 3]; 3] {
        corners.map(|corner| self.points[corner as usize])
    }

    /// How bright a face is: light from the upper left, behind the viewer, and from all sides.
    pub(super) fn light(&self, corners: [u32; 3]) -> f64 {
        const LIGHT: [f64; 3] = [-0.35, -0.45, 0.82];
        let [a, b, c] = self.triangle(corners);
        let [u, v]: [[f64; 3]; 2] = [b, c].map(|point| std::array::from_fn(|axis| point[axis] - a[axis]));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let length = normal.iter().map(|value| value * value).sum::<f64>().sqrt();
        if length == 0.0 || self.scene.flat {
            return 1.0;
        }
        // Of the two sides the one that is seen.
        let sign = if normal[2] < 0.0 { -1.0 } else { 1.0 };
        let cosine: f64 = normal.iter().zip(LIGHT).map(|(value, light)| value * light).sum::<f64>() * sign / length;
        0.42 + 0.58 * (0.25 + 0.75 * cosine).clamp(0.0, 1.0)
    }
}
