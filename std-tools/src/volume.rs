//! Samples of a scalar field on a grid, as raw files hold them: [`Volume`], and [`Declaration`] for what they do not say.

use std::fmt;
use std::str::FromStr;

/// The type of a sample.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Sample {
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 32 bits.
    I32,
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl Sample {
    /// All types.
    pub const ALL: &'static [Self] =
        &[Self::U8, Self::I8, Self::U16, Self::I16, Self::U32, Self::I32, Self::F32, Self::F64];

    /// The name on a command line and in names of files: NumPy's.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::U8 => "uint8",
            Self::I8 => "int8",
            Self::U16 => "uint16",
            Self::I16 => "int16",
            Self::U32 => "uint32",
            Self::I32 => "int32",
            Self::F32 => "float32",
            Self::F64 => "float64",
        }
    }

    /// One line on what the type is.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::U8 | Self::U16 | Self::U32 => "unsigned integers",
            Self::I8 | Self::I16 | Self::I32 => "signed integers",
            Self::F32 => "single precision",
            Self::F64 => "double precision",
        }
    }

    /// The type with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|sample| sample.name().eq_ignore_ascii_case(name))
    }

    /// The bytes of a sample.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The samples along each side of a grid, the fastest side first: `66x66x66` in text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sides(pub Vec<u32>);

impl Sides {
    /// The number of samples, if 64 bits can count them.
    #[must_use]
    pub fn num_samples(&self) -> Option<u64> {
        self.0.iter().try_fold(1_u64, |count, &side| count.checked_mul(side.into()))
    }
}

impl FromStr for Sides {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split(['x', 'X']).map(str::parse).collect::<Result<_, _>>();
        sides.map(Self).map_err(|_| "samples along each side are numbers with x between, like 66x66x66".to_owned())
    }
}

impl fmt::Display for Sides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sides: Vec<_> = self.0.iter().map(u32::to_string).collect();
        f.write_str(&sides.join("x"))
    }
}

/// What a raw file does not say of itself, as far as it is known.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Declaration {
    /// The samples along each side.
    pub sides: Option<Sides>,
    /// Their type.
    pub sample: Option<Sample>,
}

impl Declaration {
    /// What a name tells, as that of `neghip_66x66x66_uint8.raw` does: of the parts between `_`, `-`, `.` and blanks,
    /// the last that is sides, and the last that is a type.
    #[must_use]
    pub fn from_file_name(name: &str) -> Self {
        let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let parts = || name.rsplit(['_', '-', '.', ' ']);
        let sides = parts().filter_map(|part| part.parse::<Sides>().ok()).find(|sides| sides.0.len() > 1);
        Self { sides, sample: parts().find_map(Sample::from_name) }
    }

    /// This, with what it lacks from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { sides: self.sides.or(other.sides), sample: self.sample.or(other.sample) }
    }
}

/// Samples on a grid: that at (x, y, z, …) has the number x + k (y + l (z + …)) for sides of k, l, m, … samples.
#[derive(Clone, PartialEq, Debug)]
pub struct Volume {
    sides: Sides,
    sample: Sample,
    /// Little-endian, one after the other.
    bytes: Vec<u8>,
}

impl Volume {
    /// A volume of the given samples, which are little-endian; `None` if the bytes are not as many as they should be.
    #[must_use]
    pub fn new(sides: Sides, sample: Sample, bytes: Vec<u8>) -> Option<Self> {
        let expected = sides.num_samples()?.checked_mul(sample.size() as u64)?;
        (bytes.len() as u64 == expected).then_some(Self { sides, sample, bytes })
    }

    /// The samples along each side.
    #[must_use]
    pub fn sides(&self) -> &[u32] {
        &self.sides.0
    }

    /// Their type.
    #[must_use]
    pub fn sample(&self) -> Sample {
        self.sample
    }

    /// The bytes of the samples, little-endian.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The samples in the order of their numbers; double precision holds each exactly.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let decode = |bytes: &[u8]| {
            let mut raw = [0; 8];
            raw[..bytes.len()].copy_from_slice(bytes);
            let [a, b, c, d, ..] = raw;
            match self.sample {
                Sample::U8 => a.into(),
                Sample::I8 => i8::from_le_bytes([a]).into(),
                Sample::U16 => u16::from_le_bytes([a, b]).into(),
                Sample::I16 => i16::from_le_bytes([a, b]).into(),
                Sample::U32 => u32::from_le_bytes([a, b, c, d]).into(),
                Sample::I32 => i32::from_le_bytes([a, b, c, d]).into(),
                Sample::F32 => f32::from_le_bytes([a, b, c, d]).into(),
                Sample::F64 => f64::from_le_bytes(raw),
            }
        };
        self.bytes.chunks_exact(self.sample.size()).map(decode)
    }

    /// The least and the greatest sample; `None` if there is none but NaN.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        self.values().filter(|value| !value.is_nan()).fold(None, |range, value| {
            let (least, greatest) = range.unwrap_or((value, value));
            Some((least.min(value), greatest.max(value)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_sides_and_types() {
        let declared = |name| {
            let Declaration { sides, sample } = Declaration::from_file_name(name);
            (sides.map(|sides| sides.0), sample)
        };
        assert_eq!(declared("neghip_66x66x66_uint8.raw"), (Some(vec![66, 66, 66]), Some(Sample::U8)));
        assert_eq!(declared("a/b 8x9-1x1_v2_256x256x108_INT16.raw.xz"), (Some(vec![256, 256, 108]), Some(Sample::I16)));
        assert_eq!(declared("slice.640x480.float32"), (Some(vec![640, 480]), Some(Sample::F32)));
        assert_eq!(declared("12_uint8/volume.raw"), (None, None));
        assert_eq!(declared("99999999999x2_uint64.raw"), (None, None));
    }

    #[test]
    fn values_are_those_of_the_bytes() {
        let values = |sample, bytes: &[u8]| {
            Volume::new(Sides(vec![2]), sample, bytes.to_vec()).unwrap().values().collect::<Vec<_>>()
        };
        assert_eq!(values(Sample::U8, &[1, 255]), [1.0, 255.0]);
        assert_eq!(values(Sample::I8, &[1, 255]), [1.0, -1.0]);
        assert_eq!(values(Sample::U16, &[1, 2, 255, 255]), [513.0, 65_535.0]);
        assert_eq!(values(Sample::I16, &[1, 2, 255, 255]), [513.0, -1.0]);
        assert_eq!(values(Sample::U32, &[1, 0, 0, 0, 255, 255, 255, 255]), [1.0, 4_294_967_295.0]);
        assert_eq!(values(Sample::I32, &[1, 0, 0, 0, 255, 255, 255, 255]), [1.0, -1.0]);
        let single: Vec<u8> = [0.1_f32, -2.5].iter().flat_map(|value| value.to_le_bytes()).collect();
        assert_eq!(values(Sample::F32, &single), [f64::from(0.1_f32), -2.5]);
        let double: Vec<u8> = [0.1_f64, f64::MAX].iter().flat_map(|value| value.to_le_bytes()).collect();
        assert_eq!(values(Sample::F64, &double), [0.1, f64::MAX]);
        assert_eq!(Volume::new(Sides(vec![2, 2]), Sample::I16, vec![0; 7]), None);
        assert_eq!(Volume::new(Sides(vec![u32::MAX; 3]), Sample::I16, vec![0; 7]), None);
    }
}
