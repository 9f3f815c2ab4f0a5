//! The header of a PLY file: which elements there are, what rows of them hold, and what becomes of them.

use crate::attribute::Values;
use crate::io::error::{ErrorKind, Fault, Position};
use crate::io::source::Source;
use crate::io::text::Line;

/// How the data after the header are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a scalar.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// An empty column for values of the type; small integers with sign become wider.
    pub(super) const fn values(self) -> Values {
        match self {
            Self::U8 => Values::U8(Vec::new()),
            Self::U16 => Values::U16(Vec::new()),
            Self::U32 => Values::U32(Vec::new()),
            Self::I8 | Self::I16 | Self::I32 => Values::I32(Vec::new()),
            Self::F32 => Values::F32(Vec::new()),
            Self::F64 => Values::F64(Vec::new()),
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Whether an integer is one of the type, of integers.
    pub(super) fn holds(self, value: i64) -> bool {
        match self {
            Self::I8 => i8::try_from(value).is_ok(),
            Self::U8 => u8::try_from(value).is_ok(),
            Self::I16 => i16::try_from(value).is_ok(),
            Self::U16 => u16::try_from(value).is_ok(),
            Self::I32 => i32::try_from(value).is_ok(),
            Self::U32 => u32::try_from(value).is_ok(),
            Self::F32 | Self::F64 => false,
        }
    }

    /// Whether every value is one of single precision.
    pub(super) fn fits_single(self) -> bool {
        !matches!(self, Self::I32 | Self::U32 | Self::F64)
    }

    /// The value in the first [`Self::size`] bytes, NaN if there are fewer; every type fits double precision.
    pub(super) fn decode(self, bytes: &[u8], encoding: Encoding) -> f64 {
        match self {
            Self::I8 => number(bytes, encoding, i8::from_le_bytes),
            Self::U8 => number(bytes, encoding, u8::from_le_bytes),
            Self::I16 => number(bytes, encoding, i16::from_le_bytes),
            Self::U16 => number(bytes, encoding, u16::from_le_bytes),
            Self::I32 => number(bytes, encoding, i32::from_le_bytes),
            Self::U32 => number(bytes, encoding, u32::from_le_bytes),
            Self::F32 => number(bytes, encoding, f32::from_le_bytes),
            Self::F64 => number(bytes, encoding, f64::from_le_bytes),
        }
    }
}

/// The number in the first `N` bytes, `from_le_bytes` being its reading in little-endian order.
fn number<const N: usize, T: Into<f64>>(bytes: &[u8], encoding: Encoding, from_le_bytes: fn([u8; N]) -> T) -> f64 {
    let Some(&(mut bytes)) = bytes.first_chunk::<N>() else { return f64::NAN };
    if encoding == Encoding::BigEndian {
        bytes.reverse();
    }
    from_le_bytes(bytes).into()
}

pub(super) struct Property {
    pub(super) name: Box<[u8]>,
    /// The type of the length, if this is a list.
    pub(super) length: Option<Type>,
    pub(super) scalar: Type,
    /// Whether the reader looks at the values.
    pub(super) used: bool,
    /// Whether it is, or is a component of, an attribute that is kept.
    pub(super) is_attribute: bool,
}

pub(super) struct Element {
    pub(super) name: Box<[u8]>,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// Where the header declares it.
    pub(super) position: Position,
}

impl Element {
    /// The place of the property with one of these names, from now on used.
    fn find(&mut self, names: &[&[u8]], list: IsList) -> Option<usize> {
        let fits = |p: &Property| names.contains(&&*p.name) && p.length.is_some() == (list == IsList::Yes);
        let found = self.properties.iter().position(fits)?;
        self.properties[found].used = true;
        Some(found)
    }

    pub(super) fn unsupported(&self, message: &'static str) -> Fault {
        Fault::new(self.position, ErrorKind::Unsupported(message.into()))
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum IsList {
    Yes,
    No,
}

/// What the rows of an element become; the numbers are those of its properties.
pub(super) enum Role {
    Vertex { coordinates: Vec<usize> },
    Face,
    Edge { ends: [usize; 2] },
    Strips,
    PassedOver,
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

/// Reads the header up to and with `end_header`.
pub(super) fn header(source: &mut Source<'_>) -> Result<Header, Fault> {
    let mut line = source.need_content(None, "ply")?;
    let magic = line.need_word("ply")?;
    if magic.bytes != b"ply" {
        return Err(line.unexpected(magic, "ply"));
    }
    line.end()?;
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let mut line = source.need_content(None, "end_header")?;
        let keyword = line.need_word("a keyword")?;
        match keyword.bytes {
            b"comment" | b"obj_info" => continue,
            b"format" if encoding.is_none() => encoding = Some(format(&mut line)?),
            b"element" if encoding.is_some() => elements.push(Element {
                name: line.need_word("the name of the element")?.bytes.into(),
                count: line.integer("the number of elements")?,
                properties: Vec::new(),
                position: line.position(keyword.at),
            }),
            b"property" if !elements.is_empty() => {
                let property = property(&mut line)?;
                if let Some(element) = elements.last_mut() {
                    element.properties.push(property);
                }
            }
            b"end_header" => {
                line.end()?;
                let at = line.position(keyword.at);
                let missing = || Fault::new(at, ErrorKind::Unsupported("the header lacks a line `format`".into()));
                return Ok(Header { encoding: encoding.ok_or_else(missing)?, elements });
            }
            _ => return Err(line.unexpected(keyword, "format, element, property, comment or end_header, in order")),
        }
        line.end()?;
    }
}

/// Reads what follows `format`.
fn format(line: &mut Line<'_>) -> Result<Encoding, Fault> {
    const EXPECTED: &str = "ascii, binary_little_endian or binary_big_endian";
    let word = line.need_word(EXPECTED)?;
    let encoding = match word.bytes {
        b"ascii" => Encoding::Text,
        b"binary_little_endian" => Encoding::LittleEndian,
        b"binary_big_endian" => Encoding::BigEndian,
        _ => return Err(line.unexpected(word, EXPECTED)),
    };
    let version = line.need_word("version 1.0")?;
    if version.bytes == b"1.0" { Ok(encoding) } else { Err(line.unexpected(version, "version 1.0")) }
}

/// Reads what follows `property`.
fn property(line: &mut Line<'_>) -> Result<Property, Fault> {
    const EXPECTED: &str = "a type: char, uchar, short, ushort, int, uint, float, double, or list";
    let mut word = line.need_word(EXPECTED)?;
    let mut length = None;
    if word.bytes == b"list" {
        const EXPECTED: &str = "an integer type for the length of the list";
        let of_length = line.need_word(EXPECTED)?;
        length = Type::from_name(of_length.bytes).filter(|of_length| of_length.is_integer());
        if length.is_none() {
            return Err(line.unexpected(of_length, EXPECTED));
        }
        word = line.need_word(EXPECTED)?;
    }
    let scalar = Type::from_name(word.bytes).ok_or_else(|| line.unexpected(word, EXPECTED))?;
    let name = line.need_word("the name of the property")?.bytes.into();
    Ok(Property { name, length, scalar, used: false, is_attribute: false })
}

/// What becomes of an element, by its name and properties.
pub(super) fn role(element: &mut Element) -> Result<Role, Fault> {
    let role = match &*element.name {
        b"vertex" => {
            let coordinates: Vec<_> =
                [b"x", b"y", b"z"].iter().filter_map(|name| element.find(&[*name], IsList::No)).collect();
            let planar =
                [&b"x"[..], b"y"].iter().all(|name| element.properties.iter().any(|p| p.used && *p.name == **name));
            if !planar {
                return Err(element.unsupported("the element vertex lacks a property x or y"));
            }
            Role::Vertex { coordinates }
        }
        b"face" | b"tristrips" => {
            let list = element.find(&[b"vertex_indices", b"vertex_index"], IsList::Yes);
            match list {
                Some(list) if element.properties[list].scalar.is_integer() => {}
                _ => return Err(element.unsupported("this element lacks a list vertex_indices of integers")),
            }
            if *element.name == *b"face" { Role::Face } else { Role::Strips }
        }
        b"edge" => {
            let ends = [&b"vertex1"[..], b"vertex2"].map(|name| element.find(&[name], IsList::No));
            let integer = |at: usize| element.properties[at].scalar.is_integer();
            match ends {
                [Some(a), Some(b)] if integer(a) && integer(b) => Role::Edge { ends: [a, b] },
                _ => return Err(element.unsupported("the element edge lacks integers vertex1 and vertex2")),
            }
        }
        _ => Role::PassedOver,
    };
    Ok(role)
}
