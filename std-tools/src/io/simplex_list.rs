//! Lists of simplices by the labels of their vertices.
//!
//! Two spellings: one simplex a line, labels separated by blanks or commas; and lists of lists in brackets over any
//! number of lines, `[[1,2,3],[2,3,4]]` or `facets:=[[1,2,3],[2,3,4]];`, as in the Library of Triangulations of
//! Benedetti and Lutz. Comments run from `#` to the end of the line, in any encoding; labels are UTF-8.

use super::error::{ErrorKind, Fault};
use super::intake::Intake;
use super::labels::{LabelTable, canonical};
use super::source::{Source, truncated};
use super::text::{Line, Word};
use super::{Format, ReadOptions, ReadReport};
use crate::soup::Soup;

const COMMENT: Option<u8> = Some(b'#');

/// Whether this line, the first that says something, opens a list in brackets: `[`, `name:=[` or `name=[`.
pub(super) fn opens_brackets(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    let name = line.iter().take_while(|byte| byte.is_ascii_alphanumeric() || **byte == b'_').count();
    let rest = line[name..].trim_ascii_start();
    let value = rest.strip_prefix(b":=").or_else(|| rest.strip_prefix(b"=")).unwrap_or(rest).trim_ascii_start();
    // `name:=` may be alone on its line, but never a bare name.
    let assigned = value.len() < rest.len() && name > 0;
    (name == 0 || assigned) && value.first().map_or(assigned, |&first| first == b'[')
}

fn is_comma(byte: u8) -> bool {
    byte == b','
}

/// A list as far as it is read.
struct List {
    labels: LabelTable,
    intake: Intake,
    /// The simplex at hand.
    simplex: Vec<u32>,
}

impl List {
    /// Adds a label to the simplex at hand.
    fn label(&mut self, word: Word<'_>, line: &Line<'_>) -> Result<(), Fault> {
        // In a row, a slip in a list of the other spelling; and never a label that could be written in a list again.
        let no_label = |&byte: &u8| byte.is_ascii_control() || matches!(byte, b'[' | b']' | b';');
        if word.bytes.iter().any(no_label) {
            return Err(line.unexpected(word, "a vertex label without brackets, semicolons and control characters"));
        }
        let vertex = match (canonical(word.bytes), std::str::from_utf8(word.bytes)) {
            (Some(integer), _) => self.labels.number_integer(integer),
            (None, Ok(label)) => self.labels.number(label),
            (None, Err(_)) => return Err(line.unexpected(word, "a vertex label in UTF-8")),
        };
        self.simplex.push(vertex.ok_or_else(|| line.fault(word.at, ErrorKind::TooManyVertices))?);
        Ok(())
    }

    /// Ends the simplex at hand, which begins at byte `at` of the line.
    fn end_simplex(&mut self, line: &Line<'_>, at: usize) -> Result<(), Fault> {
        let added = self.intake.simplex(&self.simplex);
        self.simplex.clear();
        added.map_err(|refusal| line.fault(at, refusal.kind(|vertex| self.labels.label(vertex))))
    }

    /// Reads one simplex from one line.
    fn line(&mut self, mut line: Line<'_>) -> Result<(), Fault> {
        let mut start = None;
        while let Some(word) = line.part(is_comma) {
            if word.bytes == b"," {
                // A comma separates like a blank, but not nothing from something.
                let separates = start.is_some() && line.clone().part(is_comma).is_none_or(|next| next.bytes != b",");
                if !separates {
                    return Err(line.unexpected(word, "a vertex label before the comma"));
                }
            } else {
                start.get_or_insert(word.at);
                self.label(word, &line)?;
            }
        }
        start.map_or(Ok(()), |at| self.end_simplex(&line, at))
    }
}

/// Where in a list in brackets the reader is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// Before the opening bracket: the name and `:=` may come.
    Before,
    /// After the opening bracket: a simplex or the end.
    Open,
    /// Inside a simplex, before a label.
    Label,
    /// Inside a simplex, after a label.
    AfterLabel,
    /// After a simplex.
    AfterSimplex,
    /// After a comma that follows a simplex.
    AfterComma,
    /// After the closing bracket.
    Closed,
    /// After the semicolon.
    Ended,
}

impl State {
    fn expected(self) -> &'static str {
        match self {
            Self::Before => "`[`, which opens the list",
            Self::Open => "`[`, which opens a simplex, or `]`, which ends the list",
            Self::Label => "a vertex label",
            Self::AfterLabel => "`,` and a vertex label, or `]`, which ends the simplex",
            Self::AfterSimplex => "`,` and a simplex, or `]`, which ends the list",
            Self::AfterComma => "`[`, which opens a simplex",
            Self::Closed | Self::Ended => "the end of the file",
        }
    }
}

/// Reads the lists in brackets of one line.
fn bracket_line(list: &mut List, state: &mut State, mut line: Line<'_>) -> Result<(), Fault> {
    while let Some(word) = line.part(|byte| matches!(byte, b'[' | b']' | b',' | b';')) {
        *state = match (*state, word.bytes) {
            (State::Before, b"[") => State::Open,
            (State::Open | State::AfterSimplex, b"]") => State::Closed,
            (State::Open | State::AfterComma, b"[") | (State::AfterLabel, b",") => State::Label,
            (State::AfterLabel, b"]") => {
                // The simplex may have begun on an earlier line; its end is where it is known to be wrong.
                list.end_simplex(&line, word.at)?;
                State::AfterSimplex
            }
            (State::AfterSimplex, b",") => State::AfterComma,
            (State::Closed, b";") => State::Ended,
            (State::Closed | State::Ended, _) => {
                line.seek(word.at);
                return Err(line.trailing("file after the list"));
            }
            (State::Label, label) if !matches!(label, b"[" | b"]" | b"," | b";") => {
                list.label(word, &line)?;
                State::AfterLabel
            }
            _ => return Err(line.unexpected(word, state.expected())),
        };
    }
    Ok(())
}

/// Reads a list of simplices.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let intake = Intake::new(Format::SimplexList, options);
    let mut list = List { labels: LabelTable::new(), intake, simplex: Vec::new() };
    let mut state = None;
    while let Some(mut line) = source.next_content(COMMENT)? {
        let first = state.is_none() && opens_brackets(line.rest());
        if first {
            // The name of the list; `opens_brackets` has looked at it.
            line.skip_while(|byte| byte != b'[');
        }
        let state = state.get_or_insert(first.then_some(State::Before));
        match state {
            Some(state) => bracket_line(&mut list, state, line)?,
            None => list.line(line)?,
        }
    }
    if let Some(Some(state)) = state
        && !matches!(state, State::Closed | State::Ended)
    {
        return Err(truncated(source.end_of_text(), state.expected()));
    }
    let List { labels, mut intake, .. } = list;
    let labels = if intake.report.degenerate_dropped > 0 {
        // Nothing declares a label that only dropped simplices used.
        let used = intake.used(labels.len());
        intake.renumber(&used);
        labels.into_labels_that(&used)
    } else {
        labels.into_labels()
    };
    Ok(intake.finish(labels, false, None))
}
