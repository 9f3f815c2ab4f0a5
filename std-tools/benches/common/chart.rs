//! Line charts as SVG files.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

/// One line of a chart.
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

impl Series {
    pub(crate) fn new(name: &str) -> Self {
        Self { name: name.to_owned(), points: Vec::new() }
    }
}

/// A chart of lines over one variable; values on a logarithmic scale.
pub(crate) struct Chart<'a> {
    pub(crate) title: &'a str,
    pub(crate) x: &'a str,
    pub(crate) y: &'a str,
    /// Whether the variable is on a logarithmic scale too.
    pub(crate) log_x: bool,
    pub(crate) series: &'a [Series],
}

/// Colours that differ for colour-blind readers too (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

impl Chart<'_> {
    /// Draws the chart into a file.
    pub(crate) fn draw(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, 0.0_f64), |(least, most), value| (least.min(value), most.max(value)))
        };
        let (x_least, x_most) = range(&mut points().map(|&(x, _)| x));
        let (y_least, y_most) = range(&mut points().map(|&(_, y)| y).filter(|&y| y > 0.0));
        let root = SVGBackend::new(path, (760, 480)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut builder = ChartBuilder::on(&root);
        builder
            .caption(self.title, ("sans-serif", 20))
            .margin(12)
            .margin_right(24)
            .x_label_area_size(42)
            .y_label_area_size(76);
        let y = (y_least / 1.3..y_most * 1.3).log_scale();
        if self.log_x {
            let mut chart = builder.build_cartesian_2d((x_least..x_most).log_scale(), y)?;
            chart.configure_mesh().x_desc(self.x).y_desc(self.y).y_label_formatter(&si).draw()?;
            self.draw_lines(&mut chart)?;
        } else {
            let mut chart = builder.build_cartesian_2d(x_least..x_most, y)?;
            chart.configure_mesh().x_desc(self.x).y_desc(self.y).y_label_formatter(&si).draw()?;
            self.draw_lines(&mut chart)?;
        }
        root.present()?;
        Ok(())
    }

    fn draw_lines<'b, X, Y>(
        &self,
        chart: &mut ChartContext<'b, SVGBackend<'b>, Cartesian2d<X, Y>>,
    ) -> Result<(), Box<dyn Error>>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        for (series, colour) in self.series.iter().zip(COLOURS.iter().cycle()) {
            let style = colour.stroke_width(2);
            chart
                .draw_series(LineSeries::new(series.points.iter().copied(), style))?
                .label(&series.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
            chart.draw_series(series.points.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 14))
            .draw()?;
        Ok(())
    }
}

/// A number as one reads it on an axis: 2.5M, 30k, 0.01.
fn si(value: &f64) -> String {
    let (scaled, unit) = match value.abs() {
        1e9.. => (value / 1e9, "G"),
        1e6.. => (value / 1e6, "M"),
        1e3.. => (value / 1e3, "k"),
        _ => (*value, ""),
    };
    let text = format!("{scaled:.6}");
    format!("{}{unit}", text.trim_end_matches('0').trim_end_matches('.'))
}
