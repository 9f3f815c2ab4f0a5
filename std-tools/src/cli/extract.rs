//! `sig extract`: a complex of some resolution out of a multi-resolution complex.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::ValueEnum;
use serde::Serialize;
use sig_core::mcc::{AxisBox, Mcc};
use sig_tools::cells::write_cells;
use sig_tools::draw::{Axis, Camera, PictureOptions};
use sig_tools::mcc::{Drawing, Front, write_mcc};
use sig_tools::soup::{Coordinates, Scalars};

use super::draw::{self, Kind};
use super::output::{self, Content, Target, grouped};
use super::{UsageError, mcc_input, simplify};

/// Extract a complex of some resolution from a multi-resolution complex
///
/// The least complex that has what is asked for: with the first refinements, with those of an error above a bound, or with all
/// those in a box. Asked for several, the complex has what each of them wants; asked for nothing, it is the base complex.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig extract bunny.mcc -o coarse.mcc --count 5000                 the first 5000 refinements
  sig extract bunny.mcc -o coarse.vtu --error 0.1                  for ParaView: the cell in which each simplex is
  sig extract bunny.mcc -o ear.vtu --box -0.1,0.1,-1,0,0.2,1       all cells in a box, from x,y,z to x,y,z
  sig extract bunny.mcc -o ear.cells --box -0.1,0.1,-1,0,0.2,1 --error 0.2 --png ear.png")]
pub(super) struct Args {
    /// A multi-resolution complex
    #[arg(value_name = "IN")]
    input: PathBuf,

    #[command(flatten)]
    target: Target,

    /// The format; by the name of OUT if it is not given
    #[arg(long, value_name = "FORMAT")]
    format: Option<FormatName>,

    /// The refinements without which the error would be above E
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    error: Option<f32>,

    /// The first N refinements
    #[arg(long, value_name = "N")]
    count: Option<usize>,

    /// The refinements in a box, given by two corners
    #[arg(long = "box", value_name = "X,Y,Z,X,Y,Z", allow_hyphen_values = true, value_parser = corners)]
    corners: Option<AxisBox>,

    /// Also write a picture: SVG
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,

    /// Also write a picture: PNG
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,

    /// The axis along which pictures look
    #[arg(long, value_name = "AXIS", default_value = "z")]
    view: AxisName,

    /// The longer side of a picture, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1000, value_parser = clap::value_parser!(u16).range(16..=16000))]
    size: u16,

    /// Print a JSON object on what was done
    #[arg(long)]
    json: bool,
}

/// Six numbers: two corners, in any order along each axis.
fn corners(text: &str) -> Result<AxisBox, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(&[a, b, c, d, e, f]) if !numbers.iter().flatten().any(|number| number.is_nan()) => {
            Ok(AxisBox { low: [a.min(d), b.min(e), c.min(f)], high: [a.max(d), b.max(e), c.max(f)] })
        }
        _ => Err("six numbers with commas between are wanted: x,y,z of one corner, x,y,z of the other".to_owned()),
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FormatName {
    /// The front as a cell complex of this program
    Mcc,
    /// The front as text, a boundary a line
    Cells,
    /// The original simplices, each with the cell of the front in which it is
    Vtu,
}

#[derive(Clone, Copy, ValueEnum)]
enum AxisName {
    X,
    Y,
    Z,
}

#[derive(Serialize)]
struct Report {
    cells: Vec<usize>,
    refinements: usize,
    wanted: usize,
    output: String,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let format = self.format()?;
        let content = if format == FormatName::Mcc { Content::Binary } else { Content::Text };
        self.target.check(std::slice::from_ref(&self.input), self.json, content)?;
        for picture in [&self.svg, &self.png].into_iter().flatten() {
            output::check(picture, self.target.existing(), std::slice::from_ref(&self.input))?;
        }
        let file = mcc_input::open(&self.input)?;
        let mcc = file.view();
        let wanted = self.wanted(&mcc).with_context(|| self.input.display().to_string())?;
        let mut front = Front::new(mcc);
        front.change(wanted.iter().copied(), []).with_context(|| self.input.display().to_string())?;
        let wanted = wanted.len();
        let refinements = front.num_applied();
        output::log(format_args!(
            "took   {} of {} refinements, {} of them asked for",
            grouped(refinements),
            grouped(mcc.num_refinements()),
            grouped(wanted)
        ));
        output::log(format_args!("made   {}", simplify::counted(front.complex().counts())));
        self.write(&front, format)?;
        if self.json {
            let cells = front.complex().counts().to_vec();
            output::json(&Report { cells, refinements, wanted, output: self.target.output.display().to_string() })?;
        }
        Ok(())
    }

    fn format(&self) -> Result<FormatName, UsageError> {
        let extension = self.target.output.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        let by_name = FormatName::from_str(extension, true).ok();
        self.format.or(by_name).ok_or_else(|| {
            let name = self.target.output.display();
            UsageError(format!("{name}: the name does not tell the format; use --format with one of: mcc, cells, vtu"))
        })
    }

    /// The refinements that are asked for, each once.
    fn wanted(&self, mcc: &Mcc<'_>) -> anyhow::Result<Vec<usize>> {
        let all = 0..mcc.num_refinements();
        let mut wanted: Vec<usize> = all.clone().take(self.count.unwrap_or(0)).collect();
        if let Some(error) = self.error {
            wanted.extend(all.clone().filter(|&refinement| mcc.error(refinement) > error));
        }
        if let Some(corners) = self.corners {
            mcc.coordinates().context("the file has no coordinates: --box cannot be asked of it")?;
            match mcc.in_box(corners, AxisBox::EMPTY) {
                Some(inside) => wanted.extend(inside),
                None => wanted.extend(all.filter(|&refinement| mcc.is_in_box(refinement, &corners) == Some(true))),
            }
        }
        wanted.sort_unstable();
        wanted.dedup();
        Ok(wanted)
    }

    fn write(&self, front: &Front<'_>, format: FormatName) -> anyhow::Result<()> {
        let (path, existing) = (&self.target.output, self.target.existing());
        let is_drawn = format == FormatName::Vtu || self.svg.is_some() || self.png.is_some();
        let drawing = is_drawn.then(|| Drawing::new(front)).transpose();
        let drawing = drawing.with_context(|| self.input.display().to_string())?;
        output::to_path(path, existing, |out| match (format, &drawing) {
            (FormatName::Vtu, Some(drawing)) => drawing.write_vtu(out),
            (FormatName::Cells, _) => write_cells(front.complex(), out),
            _ => write_mcc(&front.to_complex(), coordinates(front.mcc()).as_ref(), out),
        })?;
        if !output::is_stdout(path) {
            output::log(format_args!("wrote  {}", path.display()));
        }
        let Some(drawing) = drawing.filter(|_| self.svg.is_some() || self.png.is_some()) else { return Ok(()) };
        let axis = match self.view {
            AxisName::X => Axis::X,
            AxisName::Y => Axis::Y,
            AxisName::Z => Axis::Z,
        };
        let (scene, camera) = (drawing.scene(), Camera::along(axis, false));
        let options = PictureOptions { size: self.size.into(), ..PictureOptions::default() };
        if let Some(path) = &self.svg {
            draw::write(&scene, &camera, &options, Kind::Svg, path, existing)?;
        }
        if let Some(path) = &self.png {
            draw::write(&scene, &camera, &options, Kind::Png, path, existing)?;
        }
        Ok(())
    }
}

/// The coordinates in a file, for another one.
fn coordinates(mcc: &Mcc<'_>) -> Option<Coordinates> {
    let section = mcc.coordinates()?;
    let values = match section.column {
        sig_core::format::Column::F32(values) => Scalars::F32(values.to_vec()),
        sig_core::format::Column::F64(values) => Scalars::F64(values.to_vec()),
        _ => return None,
    };
    Some(Coordinates { dim: section.components as usize, values })
}

/// What `sig info` says of a file.
pub(super) fn info(path: &Path, json: bool) -> anyhow::Result<()> {
    let file = mcc_input::open(path)?;
    let mcc = file.view();
    let summary = Summary::new(&mcc);
    if json {
        return Ok(output::json(&summary)?);
    }
    output::stdout(|out| {
        writeln!(out, "{}: {}, {} bytes", path.display(), summary.kind, grouped(summary.file_bytes))?;
        writeln!(out, "base         {}", simplify::counted(&summary.base_cells))?;
        if summary.refinements > 0 {
            writeln!(out, "full         {} cells", grouped(summary.cells))?;
            let by_dim: Vec<String> = summary.refinements_by_dimension.iter().map(grouped).collect();
            writeln!(out, "refinements  {}: {}", grouped(summary.refinements), by_dim.join(" + "))?;
            writeln!(out, "dependencies {}", grouped(summary.dependencies))?;
            let [least, most] = summary.errors;
            writeln!(out, "errors       {least} to {most}")?;
        }
        Ok(())
    })?;
    Ok(())
}

/// What is in a file; as JSON, the names of the fields.
#[derive(Serialize)]
struct Summary {
    kind: String,
    base_cells: Vec<usize>,
    /// Of the full complex.
    cells: usize,
    refinements: usize,
    /// By the dimension of the lower cell.
    refinements_by_dimension: Vec<usize>,
    /// Arcs from refinements to cells that other refinements create.
    dependencies: usize,
    /// The least and the largest.
    errors: [f32; 2],
    file_bytes: usize,
}

impl Summary {
    fn new(mcc: &Mcc<'_>) -> Self {
        let mut refinements_by_dimension = vec![0; mcc.num_dims().saturating_sub(1)];
        let refinements = 0..mcc.num_refinements();
        for refinement in refinements.clone().filter_map(|number| mcc.refinement(number)) {
            if let Some(count) = refinements_by_dimension.get_mut(refinement.dim) {
                *count += 1;
            }
        }
        let errors = mcc.arrays().errors;
        Self {
            kind: mcc.container().map_or_else(String::new, |container| container.header().kind.to_string()),
            base_cells: Front::new(*mcc).complex().counts().to_vec(),
            cells: mcc.num_cells(),
            refinements: mcc.num_refinements(),
            refinements_by_dimension,
            dependencies: refinements.map(|number| mcc.dependencies(number).count()).sum(),
            errors: [errors.iter().copied().fold(f32::INFINITY, f32::min), errors.iter().copied().fold(0.0, f32::max)],
            file_bytes: mcc.container().map_or(0, |container| container.bytes().len()),
        }
    }
}
