//! The arguments of a raw volume, and what of its grid is kept.

use std::path::PathBuf;

use sig_tools::generate::{Triangulation, Vertices};
use sig_tools::io::{Endian, read_volume_path};
use sig_tools::volume::{Declaration, Sample, Sides, Volume};

use super::{UsageError, output};

#[derive(clap::Args)]
pub(super) struct Args {
    /// Samples on the grid, one after the other and nothing else, also compressed with gzip, xz or zstd; `-` is standard
    /// input. Sides and type are found in a name like neghip_66x66x66_uint8.raw, or given
    #[arg(long, value_name = "FILE")]
    raw: Option<PathBuf>,

    /// The samples along each side, the fastest side first
    #[arg(long, value_name = "KxLxM", requires = "raw")]
    shape: Option<Sides>,

    /// The type of the samples
    #[arg(long = "type", value_parser = super::named(Sample::ALL, Sample::name, Sample::description), requires = "raw")]
    sample: Option<Sample>,

    /// The order of the bytes of a sample
    #[arg(long, value_enum, default_value_t, requires = "raw")]
    endian: ByteOrder,

    /// Keep the simplices with all samples at least VALUE
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true, requires = "raw")]
    above: Option<f64>,

    /// Keep the simplices with all samples at most VALUE
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true, requires = "raw")]
    below: Option<f64>,
}

#[derive(Clone, Copy, Default, clap::ValueEnum)]
enum ByteOrder {
    /// The least significant byte first
    #[default]
    Little,
    /// The most significant byte first
    Big,
}

impl Args {
    /// Whether there is a volume.
    pub(super) fn is_given(&self) -> bool {
        self.raw.is_some()
    }

    /// Reads the volume, and tells the part of its grid that is to be kept.
    pub(super) fn read(&self) -> anyhow::Result<(Volume, Triangulation)> {
        let path = self.raw.as_deref().unwrap_or(std::path::Path::new("-"));
        let given = Declaration { sides: self.shape.clone(), sample: self.sample };
        let Declaration { sides, sample } = given.or(Declaration::from_file_name(&path.to_string_lossy()));
        let unknown = |what: &str| UsageError(format!("{}: the name does not tell {what}", path.display()));
        let sides = sides.ok_or_else(|| unknown("how many samples are along each side; --shape 66x66x66 does"))?;
        let sample = sample.ok_or_else(|| unknown("the type of the samples; --type uint8 does"))?;
        if [self.above, self.below].into_iter().flatten().any(f64::is_nan) {
            return Err(UsageError("--above and --below take numbers".to_owned()).into());
        }
        let grid = Triangulation::grid(&sides.0).map_err(|error| UsageError(error.to_string()))?;
        let endian = match self.endian {
            ByteOrder::Little => Endian::Little,
            ByteOrder::Big => Endian::Big,
        };
        let volume = read_volume_path(path, sides.clone(), sample, endian)?;
        let (least, greatest) = volume.range().unwrap_or((f64::NAN, f64::NAN));
        let name = if output::is_stdout(path) { "<stdin>".to_owned() } else { path.display().to_string() };
        output::log(format_args!("read      {name}: {sides} samples of {sample}, {least} to {greatest}"));
        if self.above.is_none() && self.below.is_none() {
            return Ok((volume, grid));
        }
        let (least, greatest) = (self.above.unwrap_or(f64::NEG_INFINITY), self.below.unwrap_or(f64::INFINITY));
        let kept: Vertices = volume.values().map(|value| least <= value && value <= greatest).collect();
        let (kept_samples, samples) = (output::grouped(kept.len()), output::grouped(volume.values().count()));
        output::log(format_args!("kept      {kept_samples} of {samples} samples"));
        Ok((volume, grid.induced(kept)?))
    }
}
