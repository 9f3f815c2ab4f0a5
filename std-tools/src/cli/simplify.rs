//! `sig simplify`: a multi-resolution complex by Euler operators.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::ValueEnum;
use serde::Serialize;
use sig_core::Relations;
use sig_tools::cells::{CellComplex, read_cells};
use sig_tools::mcc::{
    Criterion, Extent, Field, Free, Length, MultiResolution, Precision, SimplifyOptions, SimplifyReport, Strategy,
    Types, simplify, write_mcc,
};
use sig_tools::soup::Coordinates;
use sig_tools::with_view;

use super::input::How;
use super::output::{self, Content, Target, grouped};
use super::tree_input::{self, Opened};
use super::{Threads, UsageError, interrupt, progress};

/// Simplify a complex, keeping its homology, into a multi-resolution complex
///
/// Pairs of cells are killed, the cheapest first, until no operator is feasible or a target is met. The file holds the base
/// complex that is left and what makes each pair again: `sig extract` takes complexes of any resolution between out of it.
/// An interrupt ends the work early, and the file is written all the same; a second one ends the program.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig simplify bunny.sigc -o bunny.mcc                        by the extent of the cells that go
  sig simplify brain.sigc -o brain.mcc --strategy batch       in rounds of independent operators
  sig simplify grid.sigc -o grid.mcc --criterion filtration   by the difference of the filtration values
  sig simplify grid.sigc -o grid.mcc --precision exact        the cheapest pair first, and not one of like cost
  sig simplify lens.cells -o lens.mcc --criterion none        a cell complex in text")]
pub(super) struct Args {
    /// A complex in a file of this program, or a cell complex in text; `-` is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    target: Target,

    /// In which order pairs are killed
    #[arg(long, value_name = "STRATEGY", default_value = "step")]
    strategy: StrategyName,

    /// What a pair costs; by default `extent`, and `none` where there are no coordinates
    #[arg(long, value_name = "CRITERION")]
    criterion: Option<CriterionName>,

    /// Which operators are used
    #[arg(long, value_name = "TYPES", default_value = "both")]
    types: TypesName,

    /// How far costs are told apart; pairs of like cost go by number, which is faster
    #[arg(long, value_name = "PRECISION", default_value = "2")]
    precision: PrecisionName,

    /// Stop at so many cells
    #[arg(long, value_name = "N", default_value_t = 0)]
    target_cells: usize,

    /// Do nothing that costs more
    #[arg(long, value_name = "E")]
    max_error: Option<f32>,

    #[command(flatten)]
    threads: Threads,

    /// Print a JSON object on what was done
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum StrategyName {
    /// One at a time
    Step,
    /// In rounds: of all that are feasible, those that involve no cell that another one involves
    Batch,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum CriterionName {
    /// The diagonal of the bounding box of the two cells that go, with all that was merged with them before
    Extent,
    /// The distance between the middles of the cell that goes and the one with which it is merged: the length of an edge
    Length,
    /// The difference of the filtration values of the two cells that go
    Filtration,
    /// The difference of a coordinate
    X,
    /// The difference of a coordinate
    Y,
    /// The difference of a coordinate
    Z,
    /// Nothing: by number
    None,
}

#[derive(Clone, Copy, ValueEnum)]
enum TypesName {
    /// Those that merge a cell with another one
    First,
    /// Those too that make two cells vanish
    Both,
}

#[derive(Clone, Copy, ValueEnum)]
enum PrecisionName {
    /// As they are
    Exact,
    /// By the power of 2
    #[value(name = "2")]
    Two,
    /// By the power of 4
    #[value(name = "4")]
    Four,
    /// By the power of 16
    #[value(name = "16")]
    Sixteen,
}

#[derive(Serialize)]
struct Report {
    input_cells: Vec<usize>,
    simplifications: usize,
    by_dimension: Vec<Killed>,
    base_cells: usize,
    base_cells_by_dimension: Vec<usize>,
    rounds: usize,
    interrupted: bool,
    full_bytes: usize,
    multi_resolution_bytes: usize,
    output: String,
}

/// How many pairs of two dimensions were killed.
#[derive(Serialize)]
struct Killed {
    dimensions: [usize; 2],
    first_type: usize,
    second_type: usize,
}

/// A complex, and what criteria want to know.
struct Input {
    complex: CellComplex,
    coordinates: Option<Coordinates>,
    filtration: Option<Vec<f32>>,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        self.target.check(std::slice::from_ref(&self.input), self.json, Content::Binary)?;
        if self.max_error.is_some_and(f32::is_nan) {
            return Err(UsageError("--max-error wants a number".to_owned()).into());
        }
        self.threads.start()?;
        let input = progress::during("reading", || read(&self.input, &self.how))?;
        let input_cells = input.complex.counts().to_vec();
        let name = tree_input::displayed(&self.input);
        output::log(format_args!("read   {name}: {}", counted(&input_cells)));
        let full_bytes = input.complex.memory_bytes();
        let coordinates = input.coordinates.clone();
        interrupt::begin();
        let (recorded, report) = self.simplify(input)?;
        let interrupted = interrupt::end();
        let view = recorded.view();
        let end = if interrupted { ", then interrupted" } else { "" };
        output::log(format_args!("did    {} simplifications{end}", grouped(report.simplifications)));
        for killed in killed(&report) {
            let Killed { dimensions: [low, high], first_type, second_type } = killed;
            let [first, second] = [first_type, second_type].map(grouped);
            output::log(format_args!(
                "       {low}- and {high}-cells: {first} of the first type, {second} of the second"
            ));
        }
        output::log(format_args!("made   a base of {}", counted(&report.base)));
        output::to_path(&self.target.output, self.target.existing(), |out| {
            write_mcc(&recorded, coordinates.as_ref(), out)
        })?;
        if !output::is_stdout(&self.target.output) {
            output::log(format_args!("wrote  {}", self.target.output.display()));
        }
        if self.json {
            output::json(&Report {
                input_cells,
                simplifications: report.simplifications,
                by_dimension: killed(&report).collect(),
                base_cells: view.num_base_cells(),
                base_cells_by_dimension: report.base,
                rounds: report.rounds,
                interrupted,
                full_bytes,
                multi_resolution_bytes: recorded.storage_bytes(),
                output: self.target.output.display().to_string(),
            })?;
        }
        Ok(())
    }

    fn simplify(&self, input: Input) -> anyhow::Result<(MultiResolution, SimplifyReport)> {
        let Input { complex, coordinates, filtration } = input;
        let criterion = self.criterion.unwrap_or(match coordinates {
            Some(_) => CriterionName::Extent,
            None => CriterionName::None,
        });
        // Each pair is two cells.
        let most = complex.num_cells() as u64 / 2;
        let bars = progress::is_watched().then(progress::Phases::new);
        let tell = |done| {
            if let Some(bars) = &bars {
                bars.step("simplifying", done, most);
            }
        };
        let options = SimplifyOptions {
            strategy: match self.strategy {
                StrategyName::Step => Strategy::Step,
                StrategyName::Batch => Strategy::Batch,
            },
            types: match self.types {
                TypesName::First => Types::First,
                TypesName::Both => Types::Both,
            },
            precision: match self.precision {
                PrecisionName::Exact => Precision::Exact,
                PrecisionName::Two => Precision::Two,
                PrecisionName::Four => Precision::Four,
                PrecisionName::Sixteen => Precision::Sixteen,
            },
            target_cells: self.target_cells,
            max_error: self.max_error,
            progress: Some(&tell),
            interrupt: Some(interrupt::flag()),
        };
        let place = || coordinates.as_ref().context("this criterion needs coordinates, and the input has none");
        let mut criterion: Box<dyn Criterion> = match criterion {
            CriterionName::Extent => Box::new(Extent::new(&complex, place()?)),
            CriterionName::Length => Box::new(Length::new(&complex, place()?)),
            CriterionName::X => Box::new(Field::of_coordinate(&complex, place()?, 0)),
            CriterionName::Y => Box::new(Field::of_coordinate(&complex, place()?, 1)),
            CriterionName::Z => Box::new(Field::of_coordinate(&complex, place()?, 2)),
            CriterionName::Filtration => {
                let values = filtration.context("the input has no filtration values")?;
                Box::new(Field::of_cells(values))
            }
            CriterionName::None => Box::new(Free),
        };
        let simplified = simplify(complex, &mut *criterion, &options);
        bars.iter().for_each(progress::Phases::clear);
        Ok(simplified)
    }
}

fn read(path: &Path, how: &How) -> anyhow::Result<Input> {
    match tree_input::open(path, how)? {
        Opened::Ours(input) => with_view!(input.view(), complex => {
            complex.validate().with_context(|| format!("{}: damaged; see sig verify", path.display()))?;
            tree_input::say_without_attributes(&complex, &tree_input::displayed(path));
            #[expect(clippy::cast_possible_truncation, reason = "costs are single precision")]
            let filtration =
                Relations::filtration(&complex).map(|values| values.iter().map(|&value| value as f32).collect());
            Ok(Input {
                complex: CellComplex::from_complex(&complex)?,
                coordinates: Coordinates::of(&complex),
                filtration,
            })
        }),
        Opened::Other(reader, _) => {
            let complex = read_cells(reader, &tree_input::displayed(path))?;
            Ok(Input { complex, coordinates: None, filtration: None })
        }
    }
}

fn killed(report: &SimplifyReport) -> impl Iterator<Item = Killed> {
    let pairs = report.by_dimension.iter().enumerate();
    pairs.map(|(low, &[first_type, second_type])| Killed { dimensions: [low, low + 1], first_type, second_type })
}

/// How many cells there are, and of each dimension.
pub(super) fn counted(cells: &[usize]) -> String {
    output::counted(cells).replacen("simplices", "cells", 1)
}
