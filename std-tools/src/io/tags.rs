//! The tags of an XML file, one after the other, as far as the formats here need them; text between tags is the caller's.

use super::error::{ErrorKind, Fault, Position};
use super::source::{Source, truncated};

/// The longest tag or comment.
const MAX_TAG: usize = 1 << 20;

/// A tag.
pub(super) struct Tag {
    pub(super) name: Box<str>,
    /// Whether it closes an element.
    pub(super) closing: bool,
    /// Whether the element has nothing in it.
    pub(super) empty: bool,
    attributes: Vec<(Box<str>, Box<str>)>,
    pub(super) position: Position,
}

impl Tag {
    /// The value of an attribute.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(key, _)| **key == *name).map(|(_, value)| &**value)
    }

    /// The value of an attribute that is a number; 0 if it is not there.
    pub(super) fn number(&self, name: &str) -> Result<u64, Fault> {
        let Some(value) = self.get(name) else { return Ok(0) };
        value.trim().parse().map_err(|_| {
            let found = super::error::excerpt(value.as_bytes());
            let expected = format!("a number as the value of {name}").into();
            Fault::new(self.position, ErrorKind::Expected { expected, found })
        })
    }

    /// A fault of what this tag says.
    pub(super) fn unsupported(&self, message: impl Into<String>) -> Fault {
        Fault::new(self.position, ErrorKind::Unsupported(message.into().into()))
    }
}

/// The number of bytes up to and with the end of the markup that `bytes` begin with, if it is there.
fn markup_length(bytes: &[u8]) -> Option<usize> {
    let ended_by = |end: &[u8]| memchr::memmem::find(bytes, end).map(|at| at + end.len());
    if bytes.starts_with(b"<!--") {
        return ended_by(b"-->");
    }
    if bytes.starts_with(b"<?") {
        return ended_by(b"?>");
    }
    let mut quote = None;
    for (at, &byte) in bytes.iter().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(at + 1),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

/// The attributes of a tag, of which this is the rest after its name.
fn attributes(mut rest: &str) -> Option<Vec<(Box<str>, Box<str>)>> {
    let mut attributes = Vec::new();
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return Some(attributes);
        }
        let (name, value) = rest.split_once('=')?;
        let value = value.trim_start();
        let quote = value.chars().next().filter(|quote| matches!(quote, '"' | '\''))?;
        let (value, after) = value[1..].split_once(quote)?;
        attributes.push((name.trim_end().into(), unescaped(value).into()));
        rest = after;
    }
}

/// A value without the names of characters that may not stand in it.
fn unescaped(value: &str) -> String {
    const NAMES: [(&str, char); 5] = [("lt;", '<'), ("gt;", '>'), ("quot;", '"'), ("apos;", '\''), ("amp;", '&')];
    let mut parts = value.split('&');
    let mut text = parts.next().unwrap_or("").to_owned();
    for part in parts {
        match NAMES.iter().find_map(|(name, c)| Some((*c, part.strip_prefix(name)?))) {
            Some((c, rest)) => {
                text.push(c);
                text.push_str(rest);
            }
            None => {
                text.push('&');
                text.push_str(part);
            }
        }
    }
    text
}

/// Reads the first tag, before which nothing but blanks, comments and declarations may stand; it must have this name.
pub(super) fn first(source: &mut Source<'_>, name: &'static str) -> Result<Tag, Fault> {
    let expected = || format!("the tag <{name}>");
    let begin = source.skip_blanks()?;
    if begin.is_some_and(|byte| byte != b'<') {
        let found = super::error::excerpt(source.peek(16)?);
        let kind = ErrorKind::Expected { expected: expected().into(), found };
        return Err(Fault::new(source.end_of_text(), kind));
    }
    match next(source)? {
        Some(tag) if *tag.name == *name && !tag.closing => Ok(tag),
        Some(tag) => {
            let kind = ErrorKind::Expected { expected: expected().into(), found: tag.name };
            Err(Fault::new(tag.position, kind))
        }
        None => Err(truncated(source.end_of_text(), expected())),
    }
}

/// Goes to the next tag and reads it; `None` at the end of the input.
pub(super) fn next(source: &mut Source<'_>) -> Result<Option<Tag>, Fault> {
    loop {
        if !source.skip_to(b'<')? {
            return Ok(None);
        }
        let position = source.end_of_text();
        let mut looked_at = 256;
        let length = loop {
            let bytes = source.peek(looked_at)?;
            if let Some(length) = markup_length(bytes) {
                break length;
            }
            if bytes.len() < looked_at {
                return Err(truncated(position, "`>`, which ends the tag"));
            }
            if looked_at >= MAX_TAG {
                return Err(Fault::new(position, ErrorKind::Unsupported("a tag or comment of a megabyte".into())));
            }
            looked_at *= 4;
        };
        let text = String::from_utf8_lossy(source.peek(length)?).into_owned();
        source.pass(length);
        if text.starts_with("<!") || text.starts_with("<?") {
            continue;
        }
        let inner = text.trim_start_matches('<').trim_end_matches('>');
        let (inner, closing) = inner.strip_prefix('/').map_or((inner, false), |inner| (inner, true));
        let (inner, empty) = inner.strip_suffix('/').map_or((inner, false), |inner| (inner, true));
        let end = inner.find(|c: char| c.is_ascii_whitespace()).unwrap_or(inner.len());
        let Some(attributes) = attributes(&inner[end..]) else {
            let found = super::error::excerpt(text.as_bytes());
            let kind = ErrorKind::Expected { expected: "attributes like name=\"value\"".into(), found };
            return Err(Fault::new(position, kind));
        };
        return Ok(Some(Tag { name: inner[..end].into(), closing, empty, attributes, position }));
    }
}
