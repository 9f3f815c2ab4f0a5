//! Colours: what each part of a picture has, and how light changes it.

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// Colours that differ for colour-blind readers too (Okabe and Ito).
pub const SERIES: [Rgb; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0]];

/// Top simplices by dimension: points, wire edges, triangles, tetrahedra; what is above has that of the last.
const TOPS: [Rgb; 5] = [[60, 60, 60], [0, 130, 90], [236, 184, 92], [140, 172, 206], [186, 160, 204]];

/// Where a complex is no manifold.
pub const SINGULAR: Rgb = [214, 0, 84];

/// What is highlighted.
pub const HIGHLIGHT: Rgb = [255, 214, 0];

/// What is around something that is highlighted.
pub const PALE: Rgb = [222, 222, 218];

/// Letters and frames.
pub const INK: Rgb = [40, 40, 40];

/// The colour of a top simplex.
#[must_use]
pub fn of_top(dim: usize) -> Rgb {
    TOPS[dim.min(TOPS.len() - 1)]
}

/// A colour for each number, those of near numbers far apart; grey for none.
#[must_use]
pub fn of_number(number: Option<u32>) -> Rgb {
    let hue = number.map(|number| f64::from(number) * 0.618_033_988_749_895 % 1.0 * 6.0);
    let channel = |offset: f64| {
        let value = hue.map_or(0.6, |hue| {
            let distance = ((hue + offset) % 6.0 - 3.0).abs() - 1.0;
            0.35 + 0.65 * distance.clamp(0.0, 1.0)
        });
        byte(value * 255.0)
    };
    [0.0, 4.0, 2.0].map(channel)
}

/// A colour in light of a strength from 0 to 1.
#[must_use]
pub fn lit(colour: Rgb, light: f64) -> Rgb {
    colour.map(|channel| byte(f64::from(channel) * light))
}

/// A part of one colour, the rest of another.
#[must_use]
pub fn mixed(colour: Rgb, other: Rgb, part: f64) -> Rgb {
    std::array::from_fn(|channel| byte(f64::from(colour[channel]) * part + f64::from(other[channel]) * (1.0 - part)))
}

/// A colour as CSS and SVG write it.
#[must_use]
pub fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn byte(value: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of a byte")]
    let byte = value.round().clamp(0.0, 255.0) as u8;
    byte
}
