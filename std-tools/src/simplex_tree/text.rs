//! The text of GUDHI's `Simplex_tree`, in and out.

use std::io::{self, BufWriter, Read, Write};

use super::{InsertError, SimplexTree};
use crate::io::gudhi::{read_filtered, write_simplex};
use crate::io::{ErrorKind, Position, ReadError};

impl SimplexTree {
    /// Reads what GUDHI's `operator<<` writes for a `Simplex_tree`: one simplex a line, `dimension vertex … vertex value`, in
    /// any order. `name` is what errors call the input.
    ///
    /// The lines must be a complex with monotone values: each facet of a simplex stands in the input, with no larger value.
    /// Of a repeated simplex the least value counts. Decompresses gzip.
    ///
    /// Cost: O(p² `D_m` + d) for each line, and memory for the lines that come before their facets.
    ///
    /// # Errors
    /// [`ReadError`], with line and column: a line that is no simplex, a facet that is missing or has a larger value.
    pub fn read_text(
        reader: impl Read,
        name: &str,
        progress: Option<&(dyn Fn(u64) + Sync)>,
    ) -> Result<Self, ReadError> {
        let mut tree = Self::new();
        // Those that come before a facet, or before a smaller value of one.
        let mut early: Vec<(Vec<u32>, f64, Position)> = Vec::new();
        read_filtered(reader, name, progress, &mut |word, value, position| match tree.insert(word, value) {
            Ok(_) => Ok(()),
            Err(InsertError::MissingFacet { .. } | InsertError::BelowFacet { .. }) => {
                early.push((word.to_vec(), value, position));
                Ok(())
            }
            Err(error) => Err(error.to_string()),
        })?;
        // Facets first; the order is stable, so that of two faults of one dimension the first in the input is told.
        early.sort_by_key(|(word, ..)| word.len());
        for (word, value, position) in early {
            tree.insert(&word, value).map_err(|error| {
                let file = if name == "-" { "<stdin>" } else { name }.to_owned();
                ReadError { file, position, kind: ErrorKind::Rule(error.to_string().into()), line: None }
            })?;
        }
        Ok(tree)
    }

    /// Writes the text that GUDHI's `operator>>` reads into a `Simplex_tree`, by filtration value, then by dimension, then
    /// lexicographically. Values are written so that reading gives the same number; GUDHI cannot read infinite ones.
    ///
    /// Cost: a sort, and one line a simplex.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_text(&self, out: impl Write) -> io::Result<()> {
        let mut out = BufWriter::new(out);
        for simplex in self.by_filtration() {
            write_simplex(&mut out, &simplex.word(), simplex.value())?;
        }
        out.flush()
    }
}
