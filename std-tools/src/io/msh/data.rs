//! Sections of data: values at nodes or elements, which are attributes.

use super::super::error::{ErrorKind, Fault, excerpt};
use super::super::source::Source;
use super::super::text::parse_number;
use super::{Binary, Encoding, Mesh};
use crate::attribute::{MOST_COMPONENTS, Values};

/// What the values of a section are at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    Nodes,
    Elements,
}

/// Reads a count, and calls `each` with as many words after it, which may stand on several lines.
fn tags(source: &mut Source<'_>, expected: &'static str, mut each: impl FnMut(&[u8])) -> Result<(), Fault> {
    let mut line = source.need_content(None, expected)?;
    let count: u64 = line.integer(expected)?;
    line.end()?;
    let mut read = 0;
    while read < count {
        let mut line = source.need_content(None, expected)?;
        while let Some(word) = line.word() {
            each(word.bytes);
            read += 1;
        }
    }
    Ok(())
}

/// Reads the names, and gives the first.
fn name(source: &mut Source<'_>) -> Result<String, Fault> {
    const EXPECTED: &str = "the number of names, and as many names, one a line";
    let mut line = source.need_content(None, EXPECTED)?;
    let count: u64 = line.integer(EXPECTED)?;
    line.end()?;
    let mut name = String::new();
    for place in 0..count {
        let line = source.need_content(None, EXPECTED)?;
        if place == 0 {
            name = String::from_utf8_lossy(line.rest()).trim().trim_matches('"').to_owned();
        }
    }
    Ok(name)
}

/// Reads what a section says of itself: the name, the number of components and that of rows.
fn header(source: &mut Source<'_>) -> Result<(String, usize, u64), Fault> {
    let name = name(source)?;
    tags(source, "the number of real tags, and as many numbers", |_| {})?;
    let end = source.end_of_text();
    let mut numbers: Vec<Option<u64>> = Vec::new();
    tags(source, "the number of integer tags, and as many integers", |word| {
        if numbers.len() < 3 {
            numbers.push(std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()));
        }
    })?;
    match *numbers {
        [_, Some(components), Some(rows), ..] => Ok((name, usize::try_from(components).unwrap_or(usize::MAX), rows)),
        _ => {
            let expected = "a time step, a number of components and a number of rows as integer tags".into();
            let found = excerpt(format!("{} numbers", numbers.len()).as_bytes());
            Err(Fault::new(end, ErrorKind::Expected { expected, found }))
        }
    }
}

/// Reads a section, up to the line that ends it.
pub(super) fn read(source: &mut Source<'_>, encoding: Encoding, of: Of, mesh: &mut Mesh) -> Result<(), Fault> {
    const EXPECTED: &str = "as many rows of values as the section says";
    let (name, components, rows) = header(source)?;
    let start = source.end_of_text();
    let tags = if of == Of::Nodes { &mut mesh.nodes } else { &mut mesh.elements };
    if of == Of::Elements && tags.index().is_err() {
        return Err(Fault::new(start, ErrorKind::Rule("values at elements, of which two have one tag".into())));
    }
    // More are passed over.
    let kept = if components <= MOST_COMPONENTS { components } else { 0 };
    let mut values = vec![f64::NAN; kept * tags.len()];
    let unknown = |tag: u64| {
        let what = if of == Of::Nodes { "node" } else { "element" };
        ErrorKind::Rule(format!("there is no {what} with tag {tag}").into())
    };
    for _ in 0..rows {
        match encoding {
            Encoding::Text => {
                let mut line = source.need_content(None, EXPECTED)?;
                let word = line.need_word("a tag")?;
                let tag = line.parse_integer::<i64>(word, "a tag")?.cast_unsigned();
                let row = tags.find(tag).ok_or_else(|| line.fault(word.at, unknown(tag)))? as usize;
                for at in 0..components {
                    let word = line.need_word("as many values as there are components")?;
                    let value = parse_number(word.bytes).ok_or_else(|| line.unexpected(word, "a number"))?;
                    if at < kept {
                        values[row * kept + at] = value;
                    }
                }
                line.end()?;
            }
            Encoding::Binary { big_endian } => {
                let (binary, position) = (Binary { big_endian }, source.byte());
                let tag = i64::from(binary.int(source, EXPECTED)?).cast_unsigned();
                let row = tags.find(tag).ok_or_else(|| Fault::new(position, unknown(tag)))? as usize;
                for at in 0..components {
                    let value = binary.float(source, EXPECTED)?;
                    if at < kept {
                        values[row * kept + at] = value;
                    }
                }
            }
        }
    }
    match of {
        Of::Nodes => mesh.intake.vertex_attribute(&name, components, Values::F64(values)),
        Of::Elements => mesh.intake.cell_attribute(&name, components, Values::F64(values), 0),
    }
    Ok(())
}
