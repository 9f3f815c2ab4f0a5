//! What `sig homology` prints.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::str::FromStr;

use serde::{Serialize, Serializer};
use sig_core::Dim;
use sig_tools::homology::{BigInt, Chain, Coefficients, Generator, Homology, is_prime};

use super::output::{grouped, table};

/// Coefficients as they are written on the command line.
#[derive(Clone, Copy)]
pub(super) struct Ring(pub(super) Coefficients);

impl FromStr for Ring {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ring = match text {
            "Z" => Some(Coefficients::Integers),
            "Q" => Some(Coefficients::Rationals),
            _ => {
                let prime = text.strip_prefix('Z').map(|digits| digits.strip_prefix('/').unwrap_or(digits));
                prime.and_then(|digits| digits.parse().ok()).filter(|&p| is_prime(p)).map(Coefficients::Prime)
            }
        };
        ring.map(Self).ok_or_else(|| "it is neither Z, nor Q, nor Zp with a prime p, such as Z2".to_owned())
    }
}

impl Ring {
    /// The ring, raised to a power.
    pub(super) fn power(self, rank: usize) -> String {
        let ring = match self.0 {
            Coefficients::Integers => "Z".to_owned(),
            Coefficients::Rationals => "Q".to_owned(),
            Coefficients::Prime(p) if rank > 1 => format!("(Z/{p})"),
            Coefficients::Prime(p) => format!("Z/{p}"),
        };
        if rank > 1 { format!("{ring}^{rank}") } else { ring }
    }
}

/// The homology; as JSON, the names of the fields.
#[derive(Serialize)]
pub(super) struct Report {
    betti: Vec<usize>,
    torsion: Vec<Vec<Factor>>,
    over: String,
    euler_characteristic: i64,
    cells: Vec<usize>,
    critical: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    generators: Option<NamedGenerators>,
    /// Why groups of higher dimensions are not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    stopped: Option<String>,
}

/// The generators of each dimension, in names.
pub(super) type NamedGenerators = Vec<Vec<Named>>;

impl Report {
    pub(super) fn new(found: Homology, over: Ring, generators: Option<NamedGenerators>) -> Self {
        Self {
            euler_characteristic: found.euler_characteristic(),
            torsion: found.torsion.into_iter().map(|factors| factors.into_iter().map(Factor).collect()).collect(),
            betti: found.betti,
            over: over.power(1),
            cells: found.counts,
            critical: found.critical,
            generators,
            stopped: found.stopped.map(|stopped| stopped.to_string()),
        }
    }

    /// For people: `title` is what the homology is of.
    pub(super) fn print(&self, title: &str, over: Ring, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{title} over {}\n", self.over)?;
        if self.cells.is_empty() {
            return writeln!(out, "the empty complex has none");
        }
        let head = ["dimension", "cells", "critical", "Betti", "group"].map(str::to_owned).to_vec();
        let row = |dim: usize| {
            let (betti, torsion) = (self.betti[dim], &self.torsion[dim]);
            let numbers = [self.cells[dim], self.critical[dim], betti].map(grouped);
            [dim.to_string()].into_iter().chain(numbers).chain([group(over, betti, torsion)]).collect()
        };
        let rows: Vec<Vec<String>> = std::iter::once(head).chain((0..self.betti.len()).map(row)).collect();
        table(&rows, out)?;
        writeln!(out, "\nEuler characteristic {}", grouped(self.euler_characteristic))?;
        for (dim, all) in self.generators.iter().flatten().enumerate() {
            for Named { order, cycle, bounds, cocycle } in all {
                let order = order.as_ref().map_or(String::new(), |Factor(order)| format!(", of order {order}"));
                writeln!(out, "\ngenerator of dimension {dim}{order}: {}", chain(cycle))?;
                if let Some(bounds) = bounds {
                    writeln!(out, "so many times the cycle is the boundary of: {}", chain(bounds))?;
                }
                if let Some(cocycle) = cocycle {
                    writeln!(out, "dual to it, 1 on the cycle and 0 on the others: {}", chain(cocycle))?;
                }
            }
        }
        Ok(())
    }
}

/// A generator in names.
#[derive(Serialize)]
pub(super) struct Named {
    /// Of a class of finite order.
    order: Option<Factor>,
    cycle: Vec<Term>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<Vec<Term>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cocycle: Option<Vec<Term>>,
}

/// A coefficient, and what it stands before: the labels of a simplex, or the number of a cell.
#[derive(Serialize)]
pub(super) struct Term(Factor, Vec<String>);

impl Named {
    pub(super) fn new(dim: Dim, generator: Generator, name: &impl Fn(Dim, u32) -> Vec<String>) -> Self {
        let terms = |dim: Dim, chain: Chain| {
            let term = |(cell, coefficient)| Term(Factor(coefficient), name(dim, cell));
            chain.into_iter().map(term).collect()
        };
        Self {
            order: generator.order.map(Factor),
            cycle: terms(dim, generator.cycle),
            bounds: generator.bounds.map(|chain| terms(dim + 1, chain)),
            cocycle: generator.cocycle.map(|chain| terms(dim, chain)),
        }
    }
}

/// Writes a chain as cell complexes in text have it: `+a,b 2*-b,c`.
fn chain(terms: &[Term]) -> String {
    let term = |Term(Factor(coefficient), name): &Term| {
        let sign = if *coefficient < BigInt::from(0) { '-' } else { '+' };
        let times = coefficient.magnitude();
        let times = if *times == 1_u32.into() { String::new() } else { format!("{times}*") };
        format!("{times}{sign}{}", name.join(","))
    };
    terms.iter().map(term).collect::<Vec<_>>().join(" ")
}

/// A number of JSON where it is less than 2⁵³ off 0, so that every reader takes it as it is, else a string of digits.
pub(super) struct Factor(BigInt);

impl Serialize for Factor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match i64::try_from(&self.0) {
            Ok(number) if number.abs() < 1 << 53 => serializer.serialize_i64(number),
            _ => serializer.collect_str(&self.0),
        }
    }
}

/// A group as a sum of cyclic ones.
fn group(over: Ring, betti: usize, torsion: &[Factor]) -> String {
    let mut text = if betti > 0 { over.power(betti) } else { String::new() };
    for equal in torsion.chunk_by(|Factor(one), Factor(other)| one == other) {
        let plus = if text.is_empty() { "" } else { " + " };
        let _ = match equal {
            [Factor(factor)] => write!(text, "{plus}Z/{factor}"),
            _ => write!(text, "{plus}(Z/{})^{}", equal[0].0, equal.len()),
        };
    }
    if text.is_empty() { "0".to_owned() } else { text }
}
