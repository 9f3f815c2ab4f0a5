//! The page of `sig info --html`: one file that needs no other.

use std::fmt::Write as _;
use std::path::Path;

use sig_core::{Complex, Dim, Index, Relations};
use sig_tools::chart::{Bar, Bars, draw_bars};
use sig_tools::draw::complex::scene;
use sig_tools::draw::{Axis, Camera, PictureOptions, escaped, grouped};
use sig_tools::names::simplex_name;
use sig_tools::singularities::Singularities;

use super::draw::{AZIMUTH, ELEVATION, picture_points, title};

/// The bars of a histogram at most.
const BINS: usize = 24;
/// So many singular simplices of each dimension are named.
const NAMED: usize = 12;

/// A page under way.
pub(super) struct Page {
    body: String,
    title: String,
}

impl Page {
    pub(super) fn new(title: &str) -> Self {
        Self { body: format!("<h1>{}</h1>\n", escaped(title)), title: title.to_owned() }
    }

    /// The page as a file.
    pub(super) fn finish(self) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<style>\n{STYLE}</style>\n</head>\n<body>\n{}</body>\n\
             </html>\n",
            escaped(&self.title),
            self.body
        )
    }

    pub(super) fn heading(&mut self, text: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escaped(text));
    }

    pub(super) fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// Rows as a table; the first is its head if it is one.
    pub(super) fn table(&mut self, rows: &[Vec<String>], has_head: bool) {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        self.body.push_str("<table>\n");
        for (number, row) in rows.iter().enumerate() {
            let tag = if has_head && number == 0 { "th" } else { "td" };
            self.body.push_str("<tr>");
            for column in 0..columns {
                let cell = row.get(column).map_or("", String::as_str);
                let _ = write!(self.body, "<{tag}>{}</{tag}>", escaped(cell));
            }
            self.body.push_str("</tr>\n");
        }
        self.body.push_str("</table>\n");
    }

    /// A chart of bars of one colour in each panel, if there is anything in it.
    pub(super) fn chart(&mut self, title: &str, panels: Vec<(String, Vec<(String, usize)>)>) -> anyhow::Result<()> {
        let panels: Vec<Bars> = panels.into_iter().filter(|(_, bars)| !bars.is_empty()).map(bars).collect();
        if panels.is_empty() {
            return Ok(());
        }
        let svg = draw_bars(title, &panels).map_err(|error| anyhow::anyhow!(error))?;
        let _ = writeln!(self.body, "<figure>{svg}</figure>");
        Ok(())
    }

    /// What depends on the relations of a whole complex: its picture, the places where it is no manifold.
    pub(super) fn complex<I: Index>(&mut self, complex: &Complex<'_, I>, file: &Path) -> anyhow::Result<()> {
        let singularities = Singularities::new(complex);
        match picture_points(complex, &file.display().to_string(), false, 0) {
            Ok(places) => {
                let mut scene = scene(complex, places, singularities.as_ref(), &[]);
                scene.legend.title = title(complex, file);
                let camera = if scene.flat { Camera::default() } else { Camera::around(AZIMUTH, ELEVATION, Axis::Z) };
                let (svg, _) = scene.to_svg(&camera, &PictureOptions { size: 900, max_faces: 5000 })?;
                let _ = writeln!(self.body, "<figure class=\"picture\">{svg}</figure>");
            }
            Err(error) => self.paragraph(&format!("No picture: {error:#}.")),
        }
        self.heading("Singularities");
        let Some(singularities) = singularities else {
            self.paragraph("Of dimension 4 and more it is not told where a complex is no manifold.");
            return Ok(());
        };
        if singularities.is_empty() {
            self.paragraph("None: the link of every simplex is a sphere or a ball, of whatever dimension.");
            return Ok(());
        }
        self.paragraph(
            "Simplices whose link is neither a sphere nor a ball, the first of them by the labels of their vertices:",
        );
        let mut rows = vec![["dimension", "simplices", "first"].map(str::to_owned).to_vec()];
        for (dim, found) in singularities.by_dim.iter().enumerate().filter(|(_, found)| !found.is_empty()) {
            let mut names: Vec<String> =
                found.iter().take(NAMED).map(|&simplex| simplex_name(complex, simplex)).collect();
            if found.len() > NAMED {
                names.push("…".to_owned());
            }
            rows.push(vec![dim.to_string(), grouped(found.len()), names.join("  ")]);
        }
        self.table(&rows, true);
        Ok(())
    }
}

fn bars((title, bars): (String, Vec<(String, usize)>)) -> Bars {
    let bar = |(name, count): (String, usize)| -> (String, Vec<Bar>) {
        (name, vec![(count > 0).then(|| (count as f64, grouped(count)))])
    };
    Bars { title, log: false, series: vec![String::new()], groups: bars.into_iter().map(bar).collect() }
}

/// The vertices by the number of their edges.
pub(super) fn degrees(complex: &impl Relations) -> Vec<(String, usize)> {
    let mut degrees = vec![0_usize; complex.num_vertices()];
    for edge in complex.simplices_of_dim(1) {
        complex.vertices(edge).for_each(|vertex| degrees[vertex.index()] += 1);
    }
    histogram(degrees.into_iter())
}

/// For each dimension below the highest the simplices by the number of clusters around them.
pub(super) fn clusters<I: Index>(complex: &Complex<'_, I>) -> Vec<(String, Vec<(String, usize)>)> {
    let by_dim = |dim: Dim| {
        let counts = complex.simplices_of_dim(dim).map(|simplex| complex.partial_coboundary(simplex).count());
        (format!("simplices of dimension {dim}, by the number of clusters around them"), histogram(counts))
    };
    (0..complex.dim().unwrap_or(0)).map(by_dim).collect()
}

/// How many values are in each of some ranges that are equally wide, in each a whole number if there are few.
fn histogram(values: impl Iterator<Item = usize>) -> Vec<(String, usize)> {
    let values: Vec<usize> = values.collect();
    let (Some(&least), Some(&most)) = (values.iter().min(), values.iter().max()) else { return Vec::new() };
    let wide = (most - least) / BINS + 1;
    let mut counts = vec![0; (most - least) / wide + 1];
    values.into_iter().for_each(|value| counts[(value - least) / wide] += 1);
    let name = |bin: usize| {
        let first = least + bin * wide;
        if wide == 1 { first.to_string() } else { format!("{first}–{}", first + wide - 1) }
    };
    counts.into_iter().enumerate().map(|(bin, count)| (name(bin), count)).collect()
}

const STYLE: &str = "\
body { font: 15px/1.45 system-ui, sans-serif; color: #222; background: white; max-width: 1000px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; overflow-wrap: anywhere; }
h2 { font-size: 1.15em; margin-top: 2em; border-bottom: 2px solid #0072b2; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15em .9em .15em 0; text-align: right; vertical-align: top; }
th:first-child, td:first-child { text-align: left; }
th { border-bottom: 1px solid #aaa; }
td { overflow-wrap: anywhere; }
figure { margin: 1em 0; }
figure svg { width: 100%; height: auto; }
";

#[cfg(test)]
mod tests {
    use super::histogram;

    #[test]
    fn histograms_have_a_bar_for_each_value_or_for_ranges() {
        let names = |values: &[usize]| histogram(values.iter().copied());
        assert_eq!(names(&[]), []);
        assert_eq!(names(&[3, 5, 3]), [("3".to_owned(), 2), ("4".to_owned(), 0), ("5".to_owned(), 1)]);
        let wide = names(&(0..=99).collect::<Vec<_>>());
        assert_eq!((wide[0].clone(), wide.len()), (("0–4".to_owned(), 5), 20));
        assert_eq!(wide.iter().map(|(_, count)| count).sum::<usize>(), 100);
    }
}
