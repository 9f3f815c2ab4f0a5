//! Draws a small planar complex beside the arrays of its file: the figure of the README.
//!
//! ```text
//! cargo run -- build tests/data/bow.off -o bow.sigc
//! cargo run --example arrays_figure -- bow.sigc > core/figure.svg
//! ```

use std::fmt::Write as _;

use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, Dim, SimplexId};

const CELL: usize = 34;
const LEFT: usize = 110;
const SHADES: [&str; 3] = ["#fff3d6", "#d9ecff", "#e2f4dc"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args_os().nth(1).ok_or("usage: arrays_figure FILE.sigc")?;
    let file = sig_tools::Mapped::open(&path)?;
    let complex = Complex::<u16>::from_bytes(file.bytes())?;
    let mut svg = String::new();
    draw_complex(&complex, &mut svg)?;
    let bottom = draw_arrays(&complex, &mut svg)?;
    println!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 780 {bottom}\" font-family=\"sans-serif\" \
         font-size=\"14\" text-anchor=\"middle\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{svg}</svg>"
    );
    Ok(())
}

/// The complex in the plane of its first two coordinates, each simplex with its id.
fn draw_complex(complex: &Complex<'_, u16>, svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let coordinates = complex.coordinates().ok_or("the complex has no coordinates")?;
    let components = coordinates.components as usize;
    let at = |vertex: usize| {
        let value = |axis| coordinates.column.number_at(vertex * components + axis).unwrap_or(0.0);
        (130.0 + 80.0 * value(0), 160.0 - 80.0 * value(1))
    };
    for dim in (0..=complex.dim().unwrap_or(0)).rev() {
        for simplex in complex.simplices_of_dim(dim) {
            let corners: Vec<_> = complex.vertices(simplex).map(|vertex| at(vertex.index())).collect();
            draw_simplex(dim, simplex, &corners, svg)?;
        }
    }
    Ok(())
}

fn draw_simplex(dim: Dim, simplex: SimplexId, corners: &[(f64, f64)], svg: &mut String) -> std::fmt::Result {
    let count = corners.len() as f64;
    let (x, y) = corners.iter().fold((0.0, 0.0), |(x, y), corner| (x + corner.0 / count, y + corner.1 / count));
    let points: String = corners.iter().map(|(x, y)| format!("{x:.0},{y:.0} ")).collect();
    let shade = SHADES[dim.min(2)];
    match dim {
        0 => writeln!(svg, "<circle cx=\"{x:.0}\" cy=\"{y:.0}\" r=\"13\" fill=\"{shade}\" stroke=\"#333\"/>")?,
        1 => {
            writeln!(svg, "<polyline points=\"{points}\" stroke=\"#2b6cb0\" stroke-width=\"3\"/>")?;
            writeln!(
                svg,
                "<rect x=\"{:.0}\" y=\"{:.0}\" width=\"22\" height=\"18\" rx=\"4\" fill=\"{shade}\"/>",
                x - 11.0,
                y - 9.0
            )?;
        }
        _ => writeln!(svg, "<polygon points=\"{points}\" fill=\"{shade}\"/>")?,
    }
    writeln!(svg, "<text x=\"{x:.0}\" y=\"{:.0}\">{}</text>", y + 5.0, simplex.index())
}

/// One row of cells an array; returns where the drawing ends.
fn draw_arrays(complex: &Complex<'_, u16>, svg: &mut String) -> Result<usize, Box<dyn std::error::Error>> {
    let column = |kind| complex.container().section(kind).map(|section| section.column);
    let number = |kind, row| column(kind).and_then(|column| column.index_at(row)).map(|value| value.to_string());
    let below = complex.simplices_of_dim(complex.dim().unwrap_or(0)).bounds().0.index();
    let mut rows: Vec<(&str, Vec<Cell>)> = Vec::new();

    let lookup = (0..=complex.dim().unwrap_or(0)).map(|dim| Cell {
        text: number(SectionKind::Lookup, dim).unwrap_or_default(),
        shade: SHADES[dim.min(2)],
        above: format!("n{dim}"),
    });
    rows.push(("lookup", lookup.collect()));
    let facets = complex.simplices().flat_map(|simplex| {
        complex.facets(simplex).enumerate().map(move |(position, facet)| Cell {
            text: facet.index().to_string(),
            shade: shade_of(complex, simplex),
            above: if position == 0 { format!("#{}", simplex.index()) } else { String::new() },
        })
    });
    rows.push(("boundary", facets.collect()));
    let simplices = || complex.simplices().take(below);
    let pointers = simplices().map(|simplex| Cell {
        text: number(SectionKind::Pointers, simplex.index()).unwrap_or_default(),
        shade: if complex.is_single_cluster(simplex) { SHADES[2] } else { "white" },
        above: format!("#{}", simplex.index()),
    });
    rows.push(("pointers", pointers.collect()));
    let flags = simplices().map(|simplex| Cell {
        text: u8::from(complex.is_single_cluster(simplex)).to_string(),
        shade: if complex.is_single_cluster(simplex) { SHADES[2] } else { "white" },
        above: String::new(),
    });
    rows.push(("flags", flags.collect()));
    let lists = simplices().filter(|&simplex| !complex.is_single_cluster(simplex)).flat_map(|simplex| {
        let stop = ("■".to_string(), "#ddd");
        let entries = complex.partial_coboundary(simplex).map(|top| (top.index().to_string(), shade_of(complex, top)));
        entries.chain([stop]).enumerate().map(move |(position, (text, shade))| Cell {
            text,
            shade,
            above: if position == 0 { format!("#{}", simplex.index()) } else { String::new() },
        })
    });
    rows.push(("lists", lists.collect()));
    if let Some(Column::Bits { len, .. }) = column(SectionKind::Flags) {
        assert_eq!(len, below, "one flag for each simplex below the top dimension");
    }

    let mut y = 215;
    for (name, cells) in rows {
        writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-weight=\"bold\">{name}</text>",
            LEFT - 12,
            y + 22
        )?;
        for (position, cell) in cells.iter().enumerate() {
            cell.draw(LEFT + position * CELL, y, svg)?;
        }
        y += 66;
    }
    Ok(y)
}

fn shade_of(complex: &Complex<'_, u16>, simplex: SimplexId) -> &'static str {
    SHADES[complex.dim_of(simplex).unwrap_or(0).min(2)]
}

struct Cell {
    text: String,
    shade: &'static str,
    above: String,
}

impl Cell {
    fn draw(&self, x: usize, y: usize, svg: &mut String) -> std::fmt::Result {
        let Self { text, shade, above } = self;
        let middle = x + CELL / 2;
        writeln!(
            svg,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{CELL}\" height=\"{CELL}\" fill=\"{shade}\" stroke=\"#555\"/>"
        )?;
        writeln!(svg, "<text x=\"{middle}\" y=\"{}\">{text}</text>", y + 22)?;
        writeln!(svg, "<text x=\"{middle}\" y=\"{}\" font-size=\"11\" fill=\"#666\">{above}</text>", y - 5)
    }
}
