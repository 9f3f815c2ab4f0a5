//! Graphs in DOT, the language of Graphviz: nodes and edges of graphs and digraphs, whose directions do not count.
//!
//! The attribute `weight` of an edge is its weight, 1 where other edges have one; other attributes, ports and subgraphs are
//! passed over, but for the nodes and edges in them. Edges to and from subgraphs are not read.

use super::super::error::{ErrorKind, Fault, Position, excerpt};
use super::super::source::{Source, truncated};
use super::super::text::parse_float;
use super::Space;
use super::edges::LabelledEdges;

/// The longest name.
const MAX_NAME: usize = 1 << 20;

/// Whether a text that begins so is a graph in DOT.
pub(super) fn is_graph(head: &[u8]) -> bool {
    let mut text = head.trim_ascii_start();
    // Comments may come first.
    loop {
        let end = match text {
            [b'/', b'*', ..] => memchr::memmem::find(text, b"*/").map(|at| at + 2),
            [b'/', b'/', ..] | [b'#', ..] => memchr::memchr(b'\n', text),
            _ => break,
        };
        text = text[end.unwrap_or(text.len())..].trim_ascii_start();
    }
    let mut words = text.split(|&byte| byte.is_ascii_whitespace() || byte == b'{').filter(|word| !word.is_empty());
    let first = words.next().map(<[u8]>::to_ascii_lowercase).unwrap_or_default();
    let rest = &text[first.len().min(text.len())..];
    matches!(&*first, b"graph" | b"digraph" | b"strict") && rest.contains(&b'{')
}

#[derive(PartialEq, Eq)]
enum Token {
    Name(Box<[u8]>),
    Mark(u8),
    /// `--` or `->`.
    Edge,
}

struct Tokens<'s, 'a> {
    source: &'s mut Source<'a>,
    /// A token that was looked at.
    next: Option<(Token, Position)>,
}

impl Tokens<'_, '_> {
    fn next(&mut self) -> Result<Option<(Token, Position)>, Fault> {
        if let Some(next) = self.next.take() {
            return Ok(Some(next));
        }
        loop {
            let Some(first) = self.source.skip_blanks()? else { return Ok(None) };
            let position = self.source.end_of_text();
            let two = self.source.peek(2)?;
            match (first, two) {
                (b'#', _) | (_, b"//") => drop(self.source.skip_to(b'\n')?),
                (_, b"/*") => self.comment(position)?,
                (b'{' | b'}' | b'[' | b']' | b'=' | b',' | b';' | b':', _) => {
                    self.source.pass(1);
                    return Ok(Some((Token::Mark(first), position)));
                }
                (_, b"--" | b"->") => {
                    self.source.pass(2);
                    return Ok(Some((Token::Edge, position)));
                }
                (b'"', _) => return Ok(Some((Token::Name(self.quoted(position)?), position))),
                _ => return Ok(Some((Token::Name(self.name(position)?), position))),
            }
        }
    }

    fn comment(&mut self, begin: Position) -> Result<(), Fault> {
        self.source.pass(2);
        while self.source.skip_to(b'*')? {
            if self.source.peek(2)? == b"*/" {
                self.source.pass(2);
                return Ok(());
            }
            self.source.pass(1);
        }
        Err(truncated(begin, "`*/`, which ends the comment"))
    }

    /// The next bytes up to where `end` tells, in a buffer that grows.
    fn up_to(&mut self, begin: Position, end: impl Fn(&[u8]) -> Option<usize>) -> Result<Option<usize>, Fault> {
        let mut looked_at = 64;
        loop {
            let bytes = self.source.peek(looked_at)?;
            if let Some(length) = end(bytes) {
                return Ok(Some(length));
            }
            if bytes.len() < looked_at {
                return Ok(None);
            }
            if looked_at > MAX_NAME {
                return Err(Fault::new(begin, ErrorKind::Unsupported("a name of a megabyte".into())));
            }
            looked_at *= 4;
        }
    }

    fn quoted(&mut self, begin: Position) -> Result<Box<[u8]>, Fault> {
        let end = |bytes: &[u8]| {
            let mut at = 1;
            while at < bytes.len() {
                match bytes[at] {
                    b'"' => return Some(at + 1),
                    b'\\' => at += 2,
                    _ => at += 1,
                }
            }
            None
        };
        let length = self.up_to(begin, end)?.ok_or_else(|| truncated(begin, "`\"`, which ends the name"))?;
        let text = &self.source.peek(length)?[1..length - 1];
        // Only quotes are written otherwise; other backslashes are part of the name.
        let mut name = Vec::with_capacity(text.len());
        for (at, &byte) in text.iter().enumerate() {
            if byte != b'\\' || text.get(at + 1) != Some(&b'"') {
                name.push(byte);
            }
        }
        self.source.pass(length);
        Ok(name.into())
    }

    fn name(&mut self, begin: Position) -> Result<Box<[u8]>, Fault> {
        let part = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.') || byte >= 0x80;
        let end = |bytes: &[u8]| {
            let sign = usize::from(bytes.first() == Some(&b'-'));
            bytes[sign..].iter().position(|&byte| !part(byte)).map(|length| length + sign)
        };
        let length = match self.up_to(begin, end)? {
            Some(length) => length,
            None => self.source.peek(MAX_NAME)?.len(),
        };
        let name: Box<[u8]> = self.source.peek(length)?.into();
        if name.is_empty() || *name == *b"-" {
            let found = excerpt(self.source.peek(1)?);
            let expected = "a name, `{`, `}`, `[`, `]`, `=`, `;`, `--` or `->`".into();
            return Err(Fault::new(begin, ErrorKind::Expected { expected, found }));
        }
        self.source.pass(length);
        Ok(name)
    }

    fn need(&mut self, expected: &'static str) -> Result<(Token, Position), Fault> {
        match self.next()? {
            Some(next) => Ok(next),
            None => Err(truncated(self.source.end_of_text(), expected)),
        }
    }

    fn need_name(&mut self, expected: &'static str) -> Result<(Box<[u8]>, Position), Fault> {
        match self.need(expected)? {
            (Token::Name(name), position) => Ok((name, position)),
            (other, position) => Err(unexpected(&other, position, expected)),
        }
    }

    /// Whether the next token is this mark, which is then consumed.
    fn take(&mut self, mark: u8) -> Result<bool, Fault> {
        let next = self.next()?;
        let is_it = matches!(&next, Some((Token::Mark(found), _)) if *found == mark);
        if !is_it {
            self.next = next;
        }
        Ok(is_it)
    }

    /// Reads lists of attributes in brackets, if they follow; the weight, if it is among them.
    fn attributes(&mut self) -> Result<Option<f64>, Fault> {
        let mut weight = None;
        while self.take(b'[')? {
            while !self.take(b']')? {
                if self.take(b',')? || self.take(b';')? {
                    continue;
                }
                let (key, _) = self.need_name("the name of an attribute, or `]`")?;
                if !self.take(b'=')? {
                    continue;
                }
                let (value, position) = self.need_name("the value of the attribute")?;
                if *key == *b"weight" {
                    let number = parse_float::<f64>(&value).filter(|weight| weight.is_finite() && *weight >= 0.0);
                    weight = Some(number.ok_or_else(|| {
                        let kind =
                            ErrorKind::Expected { expected: super::row::A_DISTANCE.into(), found: excerpt(&value) };
                        Fault::new(position, kind)
                    })?);
                }
            }
        }
        Ok(weight)
    }
}

fn unexpected(token: &Token, position: Position, expected: &'static str) -> Fault {
    let found = match token {
        Token::Name(name) => excerpt(name),
        Token::Mark(mark) => excerpt(&[*mark]),
        Token::Edge => excerpt(b"--"),
    };
    Fault::new(position, ErrorKind::Expected { expected: expected.into(), found })
}

/// Reads up to and with the first brace.
fn header(tokens: &mut Tokens<'_, '_>) -> Result<(), Fault> {
    const EXPECTED: &str = "graph or digraph";
    let (mut word, mut position) = tokens.need_name(EXPECTED)?;
    if word.eq_ignore_ascii_case(b"strict") {
        (word, position) = tokens.need_name(EXPECTED)?;
    }
    if !word.eq_ignore_ascii_case(b"graph") && !word.eq_ignore_ascii_case(b"digraph") {
        return Err(unexpected(&Token::Name(word), position, EXPECTED));
    }
    if !tokens.take(b'{')? {
        tokens.need_name("the name of the graph, or `{`")?;
        if !tokens.take(b'{')? {
            let (found, position) = tokens.need("`{`")?;
            return Err(unexpected(&found, position, "`{`"));
        }
    }
    Ok(())
}

/// Reads a node with its port, after its name.
fn port(tokens: &mut Tokens<'_, '_>) -> Result<(), Fault> {
    while tokens.take(b':')? {
        tokens.need_name("the name of a port")?;
    }
    Ok(())
}

/// Reads a graph.
pub(super) fn read(source: &mut Source<'_>, repeated: &mut usize) -> Result<Space, Fault> {
    const STATEMENT: &str = "a node, an edge, or `}`, which ends the graph";
    let mut tokens = Tokens { source, next: None };
    header(&mut tokens)?;
    let mut graph = LabelledEdges::default();
    let mut depth = 1;
    while depth > 0 {
        let (token, position) = tokens.need(STATEMENT)?;
        let name = match token {
            Token::Mark(b'}') => {
                depth -= 1;
                continue;
            }
            Token::Mark(b'{') => {
                depth += 1;
                continue;
            }
            Token::Mark(b';') => continue,
            Token::Name(name) => name,
            Token::Edge => {
                let message = "edges to and from subgraphs are not read";
                return Err(Fault::new(position, ErrorKind::Unsupported(message.into())));
            }
            other @ Token::Mark(_) => return Err(unexpected(&other, position, STATEMENT)),
        };
        if name.eq_ignore_ascii_case(b"subgraph") {
            if !tokens.take(b'{')? {
                tokens.need_name("the name of the subgraph, or `{`")?;
                if !tokens.take(b'{')? {
                    continue;
                }
            }
            depth += 1;
            continue;
        }
        if tokens.take(b'=')? {
            tokens.need_name("a value")?;
            continue;
        }
        let is_default = [&b"graph"[..], b"node", b"edge"].iter().any(|word| name.eq_ignore_ascii_case(word));
        if is_default {
            tokens.attributes()?;
            continue;
        }
        port(&mut tokens)?;
        let mut path = vec![(graph.vertex(&name, position)?, position)];
        loop {
            let next = tokens.next()?;
            if !matches!(next, Some((Token::Edge, _))) {
                tokens.next = next;
                break;
            }
            let (name, position) = tokens.need_name("a node; edges to and from subgraphs are not read")?;
            port(&mut tokens)?;
            path.push((graph.vertex(&name, position)?, position));
        }
        let weight = tokens.attributes()?;
        for pair in path.windows(2) {
            graph.edge(pair[0].0, pair[1].0, weight, pair[1].1)?;
        }
    }
    // A file may hold several graphs; the first is read, and nothing may follow it in silence.
    if let Some((_, position)) = tokens.next()? {
        let kind = ErrorKind::Trailing { of: "file after the graph", found: "`…`".into() };
        return Err(Fault::new(position, kind));
    }
    graph.finish(1.0, repeated)
}
