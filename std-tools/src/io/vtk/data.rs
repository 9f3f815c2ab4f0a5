//! The last part of a file in VTK's legacy format: data at points and cells, and fields of the whole.

use super::super::error::{ErrorKind, Fault};
use super::super::source::Source;
use super::super::text::Line;
use super::legacy::{File, Of, scalar_type};
use super::{Type, Values};

/// What a line says of an array that follows.
pub(super) struct Header {
    name: Box<str>,
    components: u64,
    tuples: u64,
    /// The type; `None` if it is one of bits.
    scalar: Option<Type>,
}

/// A name without the escapes of bytes that may not stand in it.
fn unescaped(name: &[u8]) -> Box<str> {
    let mut bytes = Vec::with_capacity(name.len());
    let mut rest = name;
    while let Some((&byte, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let escaped = digits.filter(|_| byte == b'%').and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(escaped.unwrap_or(byte));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into()
}

/// Reads the type of an array: of numbers, `Some(None)` of bits, `None` of anything else.
fn element(line: &mut Line<'_>) -> Result<Option<Option<Type>>, Fault> {
    let word = line.need_word("the type of the array")?;
    if word.bytes.eq_ignore_ascii_case(b"bit") {
        return Ok(Some(None));
    }
    match &*word.bytes.to_ascii_lowercase() {
        b"string" | b"utf8_string" | b"unicode_string" | b"variant" => Ok(None),
        _ => scalar_type(word.bytes)
            .map(|scalar| Some(Some(scalar)))
            .ok_or_else(|| line.unexpected(word, "the type of the array")),
    }
}

impl File {
    /// Begins the data at points or cells, of which the section has `count`.
    pub(super) fn begin_data(&mut self, of: Of, count: u64, there: u64) -> Result<(), ErrorKind> {
        if count != there {
            let what = if of == Of::Points { "points with data" } else { "cells with data" };
            return Err(ErrorKind::WrongCount { what, declared: count, found: there });
        }
        self.data = Some((of, count));
        Ok(())
    }

    /// Reads the arrays of a field: data at points or cells, or of the whole, which are passed over. Whether nothing after
    /// it can be read.
    pub(super) fn field(&mut self, source: &mut Source<'_>, arrays: u64) -> Result<bool, Fault> {
        let mut read = 0;
        while read < arrays {
            let mut line = source.need_content(None, "as many arrays as the field says")?;
            let word = line.need_word("the name of the array")?;
            if word.bytes == b"METADATA" {
                while source.next_line()?.is_some_and(|is_empty| !is_empty) {}
                continue;
            }
            let name = unescaped(word.bytes);
            let components = line.integer::<u32>("the number of components")?.into();
            let tuples = line.integer::<u32>("the number of tuples")?.into();
            let Some(scalar) = element(&mut line)? else { return Ok(self.end_at(&name)) };
            if let Some((_, declared)) = self.data.filter(|&(_, count)| count != tuples) {
                let kind = ErrorKind::WrongCount { what: "rows of the array", declared, found: tuples };
                return Err(line.fault(word.at, kind));
            }
            self.array(source, &Header { name, components, tuples, scalar })?;
            read += 1;
        }
        Ok(false)
    }

    /// Takes note of an array of strings, after which nothing can be read.
    fn end_at(&mut self, name: &str) -> bool {
        self.intake.pass_over(format!("{name}, which holds no numbers, and what follows it").as_bytes());
        true
    }

    /// Reads the array that a header tells of, and keeps it if it is one at points or cells; whether nothing after it can be
    /// read.
    pub(super) fn attribute(
        &mut self,
        source: &mut Source<'_>,
        keyword: &[u8],
        header: Result<Header, Box<str>>,
    ) -> Result<bool, Fault> {
        let header = match header {
            Ok(header) => header,
            Err(name) => return Ok(self.end_at(&name)),
        };
        if keyword == b"SCALARS" {
            // The name of a table of colours stands between.
            let blanks = source.peek(2)?.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            if source.peek(blanks + TABLE.len())?[blanks..].eq_ignore_ascii_case(TABLE) {
                source.need_content(None, "LOOKUP_TABLE")?;
            }
        }
        if keyword == TABLE {
            self.intake.pass_over(TABLE);
            self.skip_array(source, &header)?;
        } else {
            self.array(source, &header)?;
        }
        Ok(false)
    }

    fn skip_array(&self, source: &mut Source<'_>, header: &Header) -> Result<(), Fault> {
        let numbers = header.components.saturating_mul(header.tuples);
        match header.scalar {
            Some(scalar) => self.skip(source, scalar, numbers),
            None if self.binary => self.skip(source, Type::U8, numbers.div_ceil(8)),
            None => self.skip(source, Type::U8, numbers),
        }
    }

    /// Reads an array.
    fn array(&mut self, source: &mut Source<'_>, header: &Header) -> Result<(), Fault> {
        const EXPECTED: &str = "as many numbers as the array has";
        let Header { name, components, tuples, scalar } = header;
        let (Some((of, _)), Some(scalar)) = (self.data, *scalar) else {
            self.intake.pass_over(name.as_bytes());
            return self.skip_array(source, header);
        };
        let mut values = Values::Data(scalar.values());
        self.numbers(source, scalar, components.saturating_mul(*tuples), EXPECTED, &mut values)?;
        let components = usize::try_from(*components).unwrap_or(usize::MAX);
        if let Values::Data(values) = values {
            match of {
                Of::Points => self.intake.vertex_attribute(name, components, values),
                Of::Cells => self.intake.cell_attribute(name, components, values, 0),
            }
        }
        Ok(())
    }
}

const TABLE: &[u8] = b"LOOKUP_TABLE";

/// Whether a keyword announces an array among the data at points or cells.
pub(super) fn is_attribute(keyword: &[u8]) -> bool {
    const KEYWORDS: [&[u8]; 11] = [
        b"SCALARS",
        b"COLOR_SCALARS",
        TABLE,
        b"VECTORS",
        b"NORMALS",
        b"TENSORS",
        b"TENSORS6",
        b"TEXTURE_COORDINATES",
        b"GLOBAL_IDS",
        b"PEDIGREE_IDS",
        b"EDGE_FLAGS",
    ];
    KEYWORDS.contains(&keyword)
}

/// Reads the line of a keyword: the header of the array that follows, its name alone if it holds no numbers.
pub(super) fn header(
    line: &mut Line<'_>,
    keyword: &[u8],
    tuples: u64,
    binary: bool,
) -> Result<Result<Header, Box<str>>, Fault> {
    let name = unescaped(line.need_word("the name of the array")?.bytes);
    // These have numbers between 0 and 1 in text, bytes in binary.
    let colours = if binary { Type::U8 } else { Type::F32 };
    let (components, tuples, scalar) = match keyword {
        b"COLOR_SCALARS" => (line.integer::<u32>("the number of components")?, tuples, Some(colours)),
        TABLE => (4, line.integer::<u32>("the number of colours")?.into(), Some(colours)),
        _ => {
            let given = match keyword {
                b"TEXTURE_COORDINATES" => Some(line.integer::<u32>("the number of coordinates")?),
                _ => None,
            };
            let Some(scalar) = element(line)? else { return Ok(Err(name)) };
            let components = match keyword {
                b"VECTORS" | b"NORMALS" => 3,
                b"TENSORS" => 9,
                b"TENSORS6" => 6,
                b"SCALARS" if line.skip_blanks() => line.integer("the number of components")?,
                _ => given.unwrap_or(1),
            };
            (components, tuples, scalar)
        }
    };
    line.end()?;
    Ok(Ok(Header { name, components: components.into(), tuples, scalar }))
}
