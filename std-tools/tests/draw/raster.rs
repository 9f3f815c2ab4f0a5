//! What is seen, against a rasteriser that asks every face about every sample; pixels where they can be told in advance.

use proptest::prelude::*;
use sig_tools::draw::colour::mixed;
use sig_tools::draw::{Camera, Dot, Face, Legend, Line, PictureOptions, Scene, Swatch};

/// Pixels along the side of the pictures, and around what is drawn: 8 of a picture of 1000, but not less than two fifths.
const SIZE: usize = 100;
const MARGIN: f64 = 3.2;
const ROOM: f64 = SIZE as f64 - 2.0 * MARGIN;
const FINE: usize = 2;

fn face(corners: [u32; 3]) -> Face {
    Face { corners, colour: [200, 100, 50], group: 0, is_mark: false }
}

/// Faces between points in a square that fills the picture: two faces without an area hold its corners.
fn scene(triangles: &[[[f64; 3]; 3]]) -> Scene {
    let mut points = vec![[0.0; 3], [ROOM, ROOM, 0.0]];
    let mut faces = vec![face([0, 0, 1]), face([1, 1, 0])];
    for (number, triangle) in (0..).zip(triangles) {
        points.extend(triangle);
        faces.push(face([0, 1, 2].map(|corner| 2 + 3 * number + corner)));
    }
    Scene { points, faces, ..Scene::default() }
}

/// How deep a sample is in a triangle (negative outside), and its depth there.
fn inside([a, b, c]: [[f64; 3]; 3], x: f64, y: f64) -> Option<(f64, f64)> {
    let cross = |p: [f64; 3], q: [f64; 3], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let area = cross(a, b, [c[0], c[1]]);
    let parts = [(b, c), (c, a), (a, b)].map(|(p, q)| cross(p, q, [x, y]) / area);
    let depth = parts[0] * a[2] + parts[1] * b[2] + parts[2] * c[2];
    (area.abs() > 1e-9).then(|| (parts.into_iter().fold(f64::INFINITY, f64::min), depth))
}

/// For each triangle whether a sample shows it beyond doubt, and whether one shows it perhaps.
fn by_brute_force(triangles: &[[[f64; 3]; 3]]) -> Vec<(bool, bool)> {
    const DOUBT: f64 = 1e-7;
    let mut seen = vec![(false, false); triangles.len()];
    for row in 0..SIZE * FINE {
        for column in 0..SIZE * FINE {
            let [x, y] = [column, row].map(|sample| (sample as f64 + 0.5) / FINE as f64 - MARGIN);
            let y = ROOM - y;
            let found: Vec<(usize, f64, f64)> = triangles
                .iter()
                .enumerate()
                .filter_map(|(number, &triangle)| inside(triangle, x, y).map(|(within, depth)| (number, within, depth)))
                .filter(|&(_, within, _)| within >= -DOUBT)
                .collect();
            for &(number, within, depth) in &found {
                let before = |slack: f64| {
                    found.iter().any(|&(other, within, other_depth)| {
                        other != number && within >= -slack && other_depth >= depth + slack
                    })
                };
                if within > DOUBT && !before(-DOUBT) {
                    seen[number].0 = true;
                }
                let is_hidden = found.iter().any(|&(other, within, other_depth)| {
                    other != number && within > DOUBT && other_depth > depth + DOUBT
                });
                seen[number].1 |= !is_hidden;
            }
        }
    }
    seen
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn what_is_seen_agrees_with_a_slow_rasteriser(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(0.0..ROOM)), 1..24)
    ) {
        let visible = scene(&triangles).visible(&Camera::default(), SIZE, FINE);
        prop_assert!(!visible[0] && !visible[1]);
        for (number, (surely, perhaps)) in by_brute_force(&triangles).into_iter().enumerate() {
            prop_assert!(visible[2 + number] >= surely, "{} is seen", number);
            prop_assert!(visible[2 + number] <= perhaps, "{} is hidden", number);
        }
    }
}

/// The pixels of a picture, and its sides.
fn pixels(scene: &Scene, size: usize) -> (Vec<u8>, usize, usize) {
    let mut file = Vec::new();
    let options = PictureOptions { size, ..PictureOptions::default() };
    scene.write_png(&Camera::default(), &options, &mut file).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (pixels, info.width as usize, info.height as usize)
}

/// A square of two faces in the plane, and a mark behind it.
fn square() -> Scene {
    Scene {
        points: vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.25, 0.5, -1.0],
            [0.75, 0.5, -1.0],
        ],
        faces: vec![face([0, 1, 2]), face([0, 2, 3])],
        flat: true,
        groups: true,
        ..Scene::default()
    }
}

#[test]
fn pixels_have_the_colours_of_what_is_nearest() {
    let (plain, width, height) = pixels(&square(), SIZE);
    assert_eq!((width, height), (SIZE, SIZE));
    let at = |pixels: &[u8], x: usize, y: usize| pixels[(y * SIZE + x) * 3..][..3].to_vec();
    assert_eq!(at(&plain, 0, 0), [255; 3], "the margin is white");
    // Both triangles and their common side, which belongs to one group.
    for place in [(30, 70), (70, 30), (50, 50), (20, 80)] {
        assert_eq!(at(&plain, place.0, place.1), [200, 100, 50], "{place:?}");
    }
    let mut marked = square();
    marked.lines.push(Line { ends: [4, 5], colour: [0, 0, 0], radius: 10.0, is_mark: true });
    let (marked, ..) = pixels(&marked, SIZE);
    // The mark is behind, and shines through.
    assert_eq!(at(&marked, 50, 50), mixed([0, 0, 0], [200, 100, 50], 0.45));
    assert_eq!(at(&marked, 50, 20), [200, 100, 50]);
    let mut on_top = square();
    on_top.faces.push(Face { colour: [10, 20, 30], is_mark: true, ..face([0, 1, 2]) });
    assert_eq!(at(&pixels(&on_top, SIZE).0, 70, 50), [10, 20, 30], "a mark on a face is seen");
    let mut hidden = square();
    hidden.dots.push(Dot { at: 4, colour: [0, 0, 0], radius: 10.0, is_mark: false });
    assert_eq!(pixels(&hidden, SIZE).0, plain, "what is no mark and hidden is not seen");
}

#[test]
fn groups_have_lines_between_them() {
    let mut scene = square();
    scene.faces[1].group = 1;
    let (pixels, ..) = pixels(&scene, 1000);
    // Of the samples along a diagonal three are dark, nine in the two pixels on it: one of these has four at least of its nine,
    // which are a quarter of 200.
    let dark = pixels.chunks_exact(3).filter(|pixel| pixel[0] <= 134).count();
    assert!((900..2000).contains(&dark), "{dark} pixels");
}

#[test]
fn legends_are_written_below() {
    let mut scene = square();
    scene.legend = Legend { title: "a square".to_owned(), entries: Vec::new() };
    scene.legend.push(Swatch::Face, [10, 200, 30], "2 triangles".to_owned());
    let (pixels, width, height) = pixels(&scene, 300);
    assert_eq!(width, 300);
    assert!(height > 300 + 40, "{height}");
    let below = &pixels[300 * width * 3..];
    let count = |colour: [u8; 3]| below.chunks_exact(3).filter(|pixel| *pixel == colour).count();
    assert!(count([10, 200, 30]) > 100, "a swatch");
    assert!(below.chunks_exact(3).filter(|pixel| pixel.iter().all(|&value| value < 100)).count() > 100, "letters");
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let triangles: Vec<[[f64; 3]; 3]> = (0..300_u32)
        .map(|number| {
            let value = |k: u32| f64::from((number * 9 + k) * 7919 % 9973) / 9973.0 * ROOM;
            [[value(0), value(1), value(2)], [value(3), value(4), value(5)], [value(6), value(7), value(8)]]
        })
        .collect();
    let scene = scene(&triangles);
    let draw = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let svg = pool.install(|| scene.to_svg(&Camera::default(), &PictureOptions::default()).unwrap());
        (pool.install(|| pixels(&scene, 400)), svg)
    };
    assert_eq!(draw(1), draw(5));
}

#[test]
fn pictures_of_nothing_and_of_a_point() {
    let (_, width, height) = pixels(&Scene::default(), 64);
    assert!(width > 0 && height > 0);
    let dots = vec![Dot { at: 0, colour: [0; 3], radius: 5.0, is_mark: false }];
    let point = Scene { points: vec![[7.0, 8.0, 9.0]], dots, ..Scene::default() };
    let (pixels, ..) = pixels(&point, 64);
    assert!(pixels.contains(&0));
    assert!(Scene::default().to_svg(&Camera::default(), &PictureOptions::default()).unwrap().0.contains("</svg>"));
}
