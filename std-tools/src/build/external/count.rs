//! Steps 1 and 2: the listed simplices are dealt out to the pieces, and every piece is counted.

use std::borrow::Cow;
use std::io;
use std::ops::Range;

use serde::{Deserialize, Serialize};
use sig_core::{Dim, MAX_DIM};

use super::kept::{Kept, Past, Record};
use super::piece::{Counted, Piece, unpack};
use super::plan::{Ranges, Survey};
use super::write::Needed;
use super::{Cut, Error, Listed, PEAK, Resources, for_each_piece};
use crate::build::{BuildError, Meter, Phase};
use crate::spool::{Rows, Run, Spool, changed};
use crate::store::crc32;

/// How the listed simplices were dealt out.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Dealt {
    /// Where each range of vertices starts, and the end.
    starts: Vec<u32>,
    /// The simplices that a piece may have.
    limit: u64,
    /// Where those of each piece and dimension are, and the bytes of all.
    rows: Vec<Vec<Rows>>,
    bytes: u64,
}

impl Dealt {
    /// In how many pieces the complex is built.
    pub(super) fn num_pieces(&self) -> usize {
        self.rows.len()
    }
}

/// The listed simplices of each piece, on disk.
pub(super) struct Words {
    spool: Spool,
    dealt: Dealt,
}

impl Words {
    /// Deals the listed simplices out to the ranges that have a vertex of them.
    fn new(
        listed: &Listed<'_>,
        (ranges, limit): (&Ranges, u64),
        resources: Resources<'_>,
        meter: &Meter<'_>,
    ) -> Result<Self, Error> {
        resources.kept.map_or(Ok(()), Kept::restart)?;
        let spool = resources.spool(|kept| kept.words(0))?;
        let stage = meter.stage(Phase::Distribution, listed.spill.counts().iter().sum());
        let dims = listed.spill.dim().map_or(0, |dim| dim + 1);
        let mut rows: Vec<Vec<Rows>> =
            (0..ranges.len()).map(|_| (0..dims).map(|_| Rows::default()).collect()).collect();
        // A sixteenth of the memory, in numbers, for all streams together.
        let most = resources.memory / 64 / (ranges.len() * dims).max(1) as u64;
        let most = usize::try_from(most.clamp(64, 1 << 16)).unwrap_or(1 << 16);
        let mut pieces = Vec::with_capacity(MAX_DIM + 1);
        let mut dealt = 0;
        listed.try_for_each(|dim, word| {
            pieces.clear();
            for &vertex in word {
                let piece = ranges.of(vertex);
                if !pieces.contains(&piece) {
                    pieces.push(piece);
                    rows[piece][dim].push(&spool, word, most)?;
                }
            }
            dealt += 1;
            if dealt % (1 << 16) == 0 {
                stage.add(1 << 16);
            }
            Ok(())
        })?;
        rows.iter_mut().flatten().try_for_each(|rows| rows.flush(&spool))?;
        let dealt = Dealt { starts: ranges.starts().to_vec(), limit, rows, bytes: spool.bytes() };
        resources.record(&Record::Dealt(Cow::Borrowed(&dealt)))?;
        Ok(Self { spool, dealt })
    }

    /// Those of one piece, by dimension.
    pub(super) fn of(&self, piece: usize) -> io::Result<Vec<Vec<u32>>> {
        self.dealt.rows[piece].iter().map(|rows| rows.read(&self.spool)).collect()
    }

    /// The bytes on disk.
    pub(super) fn bytes(&self) -> u64 {
        self.spool.bytes()
    }
}

/// A piece that was counted, and the numbers of its simplices that others need, which are on disk.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Tally {
    counted: Counted,
    numbers: Run,
    checksum: u32,
    /// Which piece needs them, and their dimension.
    needed: Vec<(usize, Dim, Range<usize>)>,
}

/// All pieces, counted.
pub(super) struct Pieces {
    pub(super) ranges: Ranges,
    pub(super) words: Words,
    pub(super) counted: Vec<Counted>,
    /// The numbers of simplices that pieces need of others, and where they are for each piece.
    pub(super) borders: Spool,
    pub(super) needed: Vec<Vec<Needed>>,
}

impl Tally {
    /// Counts a piece; its numbers are appended to `borders`.
    fn new(piece: &Piece, number: usize, ranges: &Ranges, borders: &Spool) -> io::Result<Self> {
        let shared = piece.shared(number, ranges);
        let numbers: Vec<u32> = shared.iter().map(|&key| unpack(key).2).collect();
        let mut needed = Vec::new();
        let mut start = 0;
        for run in shared.chunk_by(|&a, &b| a >> 32 == b >> 32) {
            let (user, dim, _) = unpack(run[0]);
            needed.push((user, dim, start..start + run.len()));
            start += run.len();
        }
        let checksum = crc32(0, bytemuck::cast_slice(&numbers));
        Ok(Self { counted: piece.count(), numbers: borders.append(&numbers)?, checksum, needed })
    }

    /// The same, of an earlier process, if the numbers are still there.
    fn again(&self, borders: &Spool) -> io::Result<Self> {
        let mut numbers = Vec::new();
        borders.read(self.numbers, &mut numbers)?;
        if crc32(0, bytemuck::cast_slice(&numbers)) == self.checksum { Ok(self.clone()) } else { Err(changed()) }
    }
}

impl Pieces {
    /// Cuts the complex into pieces that fit, and counts them, but for what was done in the past.
    pub(super) fn count(
        listed: &Listed<'_>,
        resources: Resources<'_>,
        cut: &Cut<'_>,
        past: &mut Past,
        meter: &Meter<'_>,
    ) -> Result<Self, Error> {
        let mut survey = None;
        loop {
            let words = match (past.dealt.take(), cut) {
                (Some(dealt), _) => Words { spool: resources.spool(|kept| kept.words(dealt.bytes))?, dealt },
                (None, Cut::At(starts)) => {
                    Words::new(listed, (&Ranges::new(starts.to_vec()), u64::from(u32::MAX)), resources, meter)?
                }
                (None, Cut::ToFit(bytes)) => {
                    let bytes = bytes / PEAK;
                    let survey = match &mut survey {
                        Some(survey) => survey,
                        none => none.insert(Survey::new(listed, bytes)?),
                    };
                    Words::new(listed, (&survey.cut(bytes / 4 * 3), survey.simplices(bytes)), resources, meter)?
                }
            };
            match Self::of_words(words, resources, past, meter) {
                Ok(pieces) => return Ok(pieces),
                // The samples promised less.
                Err((range, Error::Build(BuildError::TooLarge { .. }))) if range.len() > 1 => {
                    *past = Past::default();
                    survey.iter_mut().for_each(|survey: &mut Survey| survey.be_careful(2.0));
                }
                Err((range, Error::Build(BuildError::TooLarge { at_least, limit }))) => {
                    return Err(Error::Star { vertex: range.start, at_least, limit });
                }
                Err((_, error)) => return Err(error),
            }
        }
    }

    /// Counts the pieces; the error of a piece with its range.
    fn of_words(
        words: Words,
        resources: Resources<'_>,
        past: &Past,
        meter: &Meter<'_>,
    ) -> Result<Self, (Range<u32>, Error)> {
        let ranges = Ranges::new(words.dealt.starts.clone());
        let end = past.counted.values().map(|tally| tally.numbers.end()).max().unwrap_or(0);
        let borders = resources.spool(|kept| kept.borders(end)).map_err(|error| (0..0, error.into()))?;
        let stage = meter.stage(Phase::Count, ranges.starts().last().map_or(0, |&end| end as usize));
        let count = |number: usize| {
            let range = ranges.get(number);
            let tally = match past.counted.get(&number) {
                Some(tally) => tally.again(&borders)?,
                None => {
                    let piece = Piece::build(&range, words.of(number)?, words.dealt.limit)?;
                    let tally = Tally::new(&piece, number, &ranges, &borders)?;
                    resources.record(&Record::Counted(number, Cow::Borrowed(&tally)))?;
                    tally
                }
            };
            stage.add(range.len());
            Ok(tally)
        };
        let tallies =
            for_each_piece(ranges.len(), |number| count(number).map_err(|error| (ranges.get(number), error)))?;
        let mut needed = vec![Vec::new(); ranges.len()];
        for (number, tally) in tallies.iter().enumerate() {
            for (user, dim, places) in &tally.needed {
                needed[*user].push((number, *dim, tally.numbers.part(places.clone())));
            }
        }
        let counted = tallies.into_iter().map(|tally| tally.counted).collect();
        Ok(Self { ranges, words, counted, borders, needed })
    }
}
