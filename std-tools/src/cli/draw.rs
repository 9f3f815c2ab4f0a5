//! `sig draw`: a picture of a complex.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Parser, ValueEnum};
use sig_core::{Complex, Index, with_complex, with_tree};
use sig_tools::build::{BuildOptions, complete};
use sig_tools::draw::arrays::{MAX_SIMPLICES, TooManySimplices, arrays};
use sig_tools::draw::complex::{Highlight, points, scene};
use sig_tools::draw::layout::layout;
use sig_tools::draw::{Axis, Camera, PictureOptions, Scene, grouped, read_generators};
use sig_tools::frozen::FrozenTree;
use sig_tools::io::Format;
use sig_tools::mcc::{Drawing, Front};
use sig_tools::singularities::Singularities;
use sig_tools::store::atomic::Existing;
use sig_tools::store::{EncodeOptions, Encoding};
use sig_tools::{Loaded, View};

use super::homology_input::{self, Source};
use super::input::{How, Input};
use super::output::{self, Content, Target};
use super::query::Question;
use super::tree_input::displayed;
use super::{Threads, UsageError, mcc_input, progress};

/// Draw a complex: what is seen of it from outside, as SVG or PNG
///
/// The complex is a file of this program, of any kind, a mesh or a list of simplices. Colours tell the top simplices of each
/// dimension: tetrahedra by their outer triangles, triangles of no tetrahedron, wire edges of no triangle, isolated vertices.
/// Vertices and edges at which a complex of dimension 3 at most is no manifold are marked, also through what hides them; the
/// legend counts all of that. A complex without coordinates is laid out by its edges; of one with more than three coordinates
/// the first three are taken. A multi-resolution complex is drawn with its simplices in the colours of the cells of its base.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  sig draw bunny.sigc -o bunny.png                          the format goes by the name
  sig draw bracket.msh -o bracket.svg --azimuth 30 --elevation 20
  sig draw bunny.obj -o bunny.png --up y --size 2000        a mesh of which y points upwards
  sig draw bunny.sigc -o star.png --highlight 'star 12'     all simplices at vertex 12
  sig draw bunny.sigc -o edges.png --highlight 'coboundary 12 --dim 1' --highlight 'link 12'
  sig homology torus.off --generators --json > loops.json
  sig draw torus.off -o loops.png --generators loops.json   cycles that generate the homology
  sig draw K3_16 -o k3.svg --seed 7                         no coordinates: laid out
  sig draw bow.off -o arrays.svg --arrays                   the arrays of a tiny complex instead")]
pub(super) struct Args {
    /// The complex; `-` is standard input
    file: PathBuf,

    #[command(flatten)]
    how: How,

    #[command(flatten)]
    target: Target,

    /// What to write; by default what the name of OUT ends with
    #[arg(long = "as", value_name = "KIND")]
    kind: Option<Kind>,

    /// The format of a mesh or list of simplices; by default it is found by content, then by name
    #[arg(short, long, value_parser = super::named(Format::ALL, Format::name, Format::description))]
    format: Option<Format>,

    /// Look along an axis, from its large values, or with a minus sign from its small ones
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, conflicts_with_all = ["azimuth", "elevation", "up"])]
    view: Option<View3>,

    /// Look from a direction: degrees around the axis that points upwards
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = angle)]
    azimuth: Option<f64>,

    /// Look from a direction: degrees above the plane of the two other axes
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = angle)]
    elevation: Option<f64>,

    /// The axis that points upwards [default: z]
    #[arg(long, value_name = "AXIS")]
    up: Option<AxisName>,

    /// The longer side of the picture, in pixels, without the legend
    #[arg(long, value_name = "PIXELS", default_value_t = 1000, value_parser = clap::value_parser!(u16).range(16..=16000))]
    size: u16,

    /// Show the simplices of a relation of a simplex, as sig query spells it: `star 12`, `link 0,17`, `coboundary 3 --dim 2`.
    /// Can be given several times
    #[arg(long, value_name = "RELATION", value_parser = question)]
    highlight: Vec<Named>,

    /// Show the cycles in a file, as sig homology --generators --json prints them
    #[arg(long, value_name = "JSON")]
    generators: Option<PathBuf>,

    /// Lay the vertices out by the edges, even if they have coordinates
    #[arg(long)]
    layout: bool,

    /// The seed of the layout
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    /// The most faces that SVG has one by one; of more it has an image of pixels
    #[arg(long, value_name = "N", default_value_t = PictureOptions::default().max_faces)]
    max_faces: usize,

    /// Draw the arrays of a tiny complex, from the bytes of its file, below a sketch with the ids of the simplices: SVG only
    #[arg(long, conflicts_with_all = ["highlight", "generators", "size"])]
    arrays: bool,

    /// No legend
    #[arg(long)]
    no_legend: bool,

    #[command(flatten)]
    threads: Threads,
}

/// What is written.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Kind {
    /// Lines and areas, to be scaled at will
    Svg,
    /// Pixels
    Png,
}

#[derive(Clone, Copy, ValueEnum)]
enum AxisName {
    X,
    Y,
    Z,
}

/// An axis to look along, and whether from behind.
#[derive(Clone, Copy, ValueEnum)]
enum View3 {
    X,
    Y,
    Z,
    #[value(name = "-x")]
    MinusX,
    #[value(name = "-y")]
    MinusY,
    #[value(name = "-z")]
    MinusZ,
}

/// A question as it was written.
#[derive(Clone)]
struct Named {
    name: String,
    question: Question,
}

/// What stands in an argument of `--highlight`.
#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Words {
    #[command(flatten)]
    question: Question,
}

fn question(text: &str) -> Result<Named, String> {
    let words = Words::try_parse_from(text.split_whitespace()).map_err(|error| {
        let message = error.to_string();
        let first = message.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        format!("{first}; it is spelled as for sig query: 'star 12', 'coboundary 0,17 --dim 2'")
    })?;
    Ok(Named { name: text.split_whitespace().collect::<Vec<_>>().join(" "), question: words.question })
}

fn angle(text: &str) -> Result<f64, String> {
    let angle: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if angle.is_finite() { Ok(angle) } else { Err("not an angle".to_owned()) }
}

impl Args {
    pub(super) fn run(self) -> anyhow::Result<()> {
        let kind = self.kind()?;
        let content = if kind == Kind::Png { Content::Binary } else { Content::Text };
        let inputs: Vec<PathBuf> = std::iter::once(&self.file).chain(&self.generators).cloned().collect();
        self.target.check(&inputs, false, content)?;
        self.threads.start()?;
        if self.arrays {
            return self.draw_arrays(kind);
        }
        let mut scene = self.scene()?;
        if self.no_legend {
            scene.legend = sig_tools::draw::Legend::default();
        }
        let options = PictureOptions { size: self.size.into(), max_faces: self.max_faces };
        write(&scene, &self.camera(scene.flat), &options, kind, &self.target.output, self.target.existing())
    }

    fn kind(&self) -> Result<Kind, UsageError> {
        let extension = self.target.output.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        self.kind.or(Kind::from_str(extension, true).ok()).ok_or_else(|| {
            let name = self.target.output.display();
            UsageError(format!("{name}: the name does not tell what to write; use --as with one of: svg, png"))
        })
    }

    fn scene(&self) -> anyhow::Result<Scene> {
        if mcc_input::is_one(&self.file) {
            return self.front();
        }
        let name = displayed(&self.file);
        let Source::Simplicial(input) = homology_input::open(&self.file, &self.how, self.format)? else {
            anyhow::bail!("{name}: cells of any shape in text have no picture");
        };
        let input = whole(input, &name)?;
        let View::Complex(any) = input.view() else { anyhow::bail!("{name}: no complex with its relations") };
        with_complex!(any, complex => self.scene_of(&complex, &name))
    }

    fn draw_arrays(&self, kind: Kind) -> anyhow::Result<()> {
        let name = displayed(&self.file);
        if kind == Kind::Png {
            return Err(UsageError("--arrays are drawn as SVG only".to_owned()).into());
        }
        let is_simplicial = !mcc_input::is_one(&self.file);
        let source = is_simplicial.then(|| homology_input::open(&self.file, &self.how, self.format)).transpose()?;
        let Some(Source::Simplicial(input)) = source else {
            anyhow::bail!("{name}: --arrays are those of a simplicial complex");
        };
        let View::Complex(any) = input.view() else {
            anyhow::bail!(
                "{name}: a tree has other arrays; sig tree convert {name} -o OUT --kind sig makes those of a SIG"
            );
        };
        let svg = with_complex!(any, complex => {
            complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
            if complex.num_simplices() > MAX_SIMPLICES {
                return Err(TooManySimplices { simplices: complex.num_simplices() }).with_context(|| name.clone());
            }
            let places = picture_points(&complex, &name, self.layout, self.seed)?;
            let is_flat = places.iter().all(|place| place[2] == 0.0);
            arrays(&complex, &places, &self.camera(is_flat)).with_context(|| name.clone())?
        });
        output::to_path(&self.target.output, self.target.existing(), |out| out.write_all(svg.as_bytes()))
    }

    fn scene_of<I: Index>(&self, complex: &Complex<'_, I>, name: &str) -> anyhow::Result<Scene> {
        complex.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
        let mut highlights = self.highlights(complex)?;
        if let Some(path) = &self.generators {
            let text = std::fs::read(path).with_context(|| path.display().to_string())?;
            highlights.extend(read_generators(&text, complex).with_context(|| path.display().to_string())?);
        }
        let places = picture_points(complex, name, self.layout, self.seed)?;
        let singularities = Singularities::new(complex);
        let mut scene = progress::during("gathering", || scene(complex, places, singularities.as_ref(), &highlights));
        scene.legend.title = title(complex, &self.file);
        Ok(scene)
    }

    fn highlights<I: Index>(&self, complex: &Complex<'_, I>) -> anyhow::Result<Vec<Highlight>> {
        use sig_tools::draw::colour::{HIGHLIGHT, SERIES};
        let colours = std::iter::once(HIGHLIGHT).chain(SERIES.into_iter().cycle());
        let highlights = self.highlight.iter().zip(colours).map(|(Named { name, question }, colour)| {
            let simplices = question.answer(complex, &self.file)?;
            let count = grouped(simplices.len());
            Ok(Highlight { name: format!("{name}: {count} simplices"), simplices, colour })
        });
        highlights.collect()
    }

    /// A multi-resolution complex, coloured by the cells of its base.
    fn front(&self) -> anyhow::Result<Scene> {
        let name = displayed(&self.file);
        if !self.highlight.is_empty() || self.generators.is_some() || self.layout {
            let message = format!("{name}: --highlight, --generators and --layout are for simplicial complexes");
            return Err(UsageError(message).into());
        }
        let file = mcc_input::open(&self.file)?;
        let drawing = Drawing::new(&Front::new(file.view())).with_context(|| name.clone())?;
        let mut scene = drawing.scene();
        scene.legend.title = short_name(&self.file);
        Ok(scene)
    }

    fn camera(&self, is_flat: bool) -> Camera {
        let axis = |name| match name {
            AxisName::X => Axis::X,
            AxisName::Y => Axis::Y,
            AxisName::Z => Axis::Z,
        };
        let is_turned = self.azimuth.is_some() || self.elevation.is_some() || self.up.is_some();
        match self.view {
            Some(View3::X) => Camera::along(Axis::X, false),
            Some(View3::Y) => Camera::along(Axis::Y, false),
            Some(View3::Z) => Camera::along(Axis::Z, false),
            Some(View3::MinusX) => Camera::along(Axis::X, true),
            Some(View3::MinusY) => Camera::along(Axis::Y, true),
            Some(View3::MinusZ) => Camera::along(Axis::Z, true),
            None if is_flat && !is_turned => Camera::default(),
            None => {
                let up = self.up.map_or(Axis::Z, axis);
                Camera::around(self.azimuth.unwrap_or(AZIMUTH), self.elevation.unwrap_or(ELEVATION), up)
            }
        }
    }
}

/// From where complexes in space are looked at: degrees.
pub(super) const AZIMUTH: f64 = 30.0;
/// From where complexes in space are looked at: degrees.
pub(super) const ELEVATION: f64 = 25.0;

/// A complex with its relations: a tree gets them.
pub(super) fn whole(input: Input, name: &str) -> anyhow::Result<Input> {
    let View::Tree(any) = input.view() else { return Ok(input) };
    let frozen = with_tree!(any, tree => {
        tree.validate().with_context(|| format!("{name}: damaged; see sig verify"))?;
        FrozenTree::of(&tree).with_context(|| format!("{name}: too many simplices"))?
    });
    let built = progress::during("adding relations", || complete(frozen, &BuildOptions::default()))?;
    let bytes = Encoding::new(&built, &EncodeOptions { checksums: false, ..EncodeOptions::default() })?.to_bytes()?;
    Ok(Input::Loaded(Loaded::from_file_bytes(bytes)?))
}

/// Where the vertices are drawn: at their coordinates, or where their edges put them.
pub(super) fn picture_points<I: Index>(
    complex: &Complex<'_, I>,
    name: &str,
    is_laid_out: bool,
    seed: u64,
) -> anyhow::Result<Vec<[f64; 3]>> {
    let components = complex.coordinates().map_or(0, |section| section.components);
    if !is_laid_out && components > 0 {
        if components > 3 {
            output::log(format_args!("sig: note: of {components} coordinates the first three are drawn"));
        }
        return points(complex)
            .with_context(|| format!("{name}: there are coordinates that are no numbers; use --layout"));
    }
    let end = |vertex: sig_core::VertexId| u32::try_from(vertex.index()).unwrap_or(u32::MAX);
    let ends = |edge| {
        let mut vertices = complex.vertices(edge).map(end);
        [vertices.next().unwrap_or(0), vertices.next().unwrap_or(0)]
    };
    let edges: Vec<[u32; 2]> = complex.simplices_of_dim(1).map(ends).collect();
    let dims = if complex.dim().unwrap_or(0) < 2 { 2 } else { 3 };
    progress::during("laying out", || layout(complex.num_vertices(), &edges, dims, seed))
        .with_context(|| name.to_owned())
}

/// The name of a file without its folders.
fn short_name(file: &Path) -> String {
    file.file_name().map_or_else(|| displayed(file), |name| displayed(Path::new(name)))
}

/// The name of the file, and how many simplices there are of each dimension.
pub(super) fn title<I: Index>(complex: &Complex<'_, I>, file: &Path) -> String {
    let dims = complex.dim().map_or(0, |dim| dim + 1);
    let counts: Vec<usize> = (0..dims).map(|dim| complex.num_simplices_of_dim(dim)).collect();
    format!("{}, {}", short_name(file), output::counted(&counts))
}

/// Writes a picture to a path.
pub(super) fn write(
    scene: &Scene,
    camera: &Camera,
    options: &PictureOptions,
    kind: Kind,
    path: &Path,
    existing: Existing,
) -> anyhow::Result<()> {
    match kind {
        Kind::Png => {
            output::to_path(path, existing, |out| progress::during("drawing", || scene.write_png(camera, options, out)))
        }
        Kind::Svg => {
            let (svg, is_raster) = progress::during("drawing", || scene.to_svg(camera, options))?;
            if is_raster {
                output::log(format_args!(
                    "sig: note: more than {} faces are seen: they are in the SVG as an image; --max-faces changes that, and \
                     PNG is smaller",
                    grouped(options.max_faces)
                ));
            }
            output::to_path(path, existing, |out| out.write_all(svg.as_bytes()))
        }
    }
}
