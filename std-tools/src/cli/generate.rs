//! `sig generate`: triangulations of any size, as input for `sig build`.

use std::path::PathBuf;

use clap::ValueEnum;
use sig_core::Dim;
use sig_tools::generate::Triangulation;
use sig_tools::store::atomic::Existing;
use sig_tools::volume::Volume;

use super::{UsageError, output, volume};

/// Write a triangulation that is given by a rule: grids, tori, spheres, random simplices
///
/// Lists the simplices as they come, in memory that does not grow, so that a complex larger than memory can be built
/// from a pipe. The counts of simplices are known by formula and said on standard error. A grid may hold the samples of a
/// raw volume (`--raw`), and then be cut down to where they are at least or at most some value.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig generate grid 20 20 20 | sig build - -o grid.sigc
  sig generate grid 340 340 340 --format tetbin | sig build - --memory 2GiB -o grid.sigc   a billion simplices
  sig generate grid --raw neghip_66x66x66_uint8.raw --above 64 --format vtu | sig build - -o neghip.sigc
  sig generate torus 100 100 -o torus.txt
  sig generate random 1000 3 5000 --seed 7 | sig build - -o random.sigc")]
pub(super) struct Args {
    #[command(subcommand)]
    rule: Rule,
}

#[derive(clap::Subcommand)]
enum Rule {
    /// Freudenthal's triangulation of a box: 6 (K−1) (L−1) (M−1) tetrahedra on K L M vertices
    Grid {
        /// The vertices along each side, up to six; three make tetrahedra, two triangles
        #[arg(required_unless_present = "raw", value_name = "SIDE")]
        sides: Vec<u32>,
        #[command(flatten)]
        volume: volume::Args,
        #[command(flatten)]
        how: How,
    },
    /// The same with opposite sides glued: 6 K L M tetrahedra on K L M vertices, or 2 K L triangles on K L
    Torus {
        /// The vertices along each side, at least three
        #[arg(required = true, value_name = "SIDE")]
        sides: Vec<u32>,
        #[command(flatten)]
        how: How,
    },
    /// An octahedron with each edge divided: 8 N² triangles on 4 N² + 2 vertices
    Sphere {
        /// Edges along an edge of the octahedron
        #[arg(value_name = "N")]
        steps: u32,
        #[command(flatten)]
        how: How,
    },
    /// Random simplices: each is a set of different vertices, all sets being equally likely
    Random {
        /// The vertices to draw from
        vertices: u32,
        /// The dimension of the simplices
        dim: Dim,
        /// How many simplices
        count: u64,
        /// Where the random numbers start
        #[arg(long, value_name = "N", default_value_t = 1)]
        seed: u64,
        #[command(flatten)]
        how: How,
    },
}

#[derive(clap::Args)]
struct How {
    /// The file to write; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    output: PathBuf,

    /// Replace OUT if it exists
    #[arg(long)]
    force: bool,

    /// How the simplices are written; by default as the name of OUT says, `simplices` if it says nothing
    #[arg(short, long, value_enum)]
    format: Option<Format>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// One simplex a line, by vertex numbers
    Simplices,
    /// Tetrahedra and their corners in binary, for grids of three sides
    Tetbin,
    /// VTK's XML, for grids of up to three sides and their parts: coordinates, and samples as point data `value`
    Vtu,
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let how = self.rule.how();
        let format = how.format();
        let existing = if how.force { Existing::Replace } else { Existing::Refuse };
        output::check(&how.output, existing, &[])?;
        let (triangulation, volume) = self.rule.triangulation()?;
        if let Some(counts) = triangulation.counts() {
            output::log(format_args!("generated {}", output::counted(&counts)));
        }
        output::to_path(&how.output, existing, |out| match format {
            Format::Simplices => triangulation.write_list(out),
            Format::Tetbin => triangulation.write_tetbin(out),
            Format::Vtu => triangulation.write_vtu(volume.as_ref(), out),
        })
    }
}

impl How {
    fn format(&self) -> Format {
        let by_name = || match self.output.extension()?.to_str()? {
            "vtu" => Some(Format::Vtu),
            "tetbin" => Some(Format::Tetbin),
            _ => None,
        };
        self.format.or_else(by_name).unwrap_or(Format::Simplices)
    }
}

impl Rule {
    fn how(&self) -> &How {
        match self {
            Self::Grid { how, .. } | Self::Torus { how, .. } | Self::Sphere { how, .. } | Self::Random { how, .. } => {
                how
            }
        }
    }

    /// The triangulation, and the samples on its vertices if there are any.
    fn triangulation(&self) -> anyhow::Result<(Triangulation, Option<Volume>)> {
        if let Self::Grid { volume, sides, .. } = self
            && volume.is_given()
        {
            if !sides.is_empty() {
                let sides: Vec<_> = sides.iter().map(u32::to_string).collect();
                let message = format!("the sides of a volume are those of its samples; leave out {}", sides.join(" "));
                return Err(UsageError(message).into());
            }
            let (volume, triangulation) = volume.read()?;
            return Ok((triangulation, Some(volume)));
        }
        let triangulation = match self {
            Self::Grid { sides, .. } => Triangulation::grid(sides),
            Self::Torus { sides, .. } => Triangulation::torus(sides),
            Self::Sphere { steps, .. } => Triangulation::sphere(*steps),
            Self::Random { vertices, dim, count, seed, .. } => Triangulation::random(*vertices, *dim, *count, *seed),
        };
        Ok((triangulation.map_err(|error| UsageError(error.to_string()))?, None))
    }
}
