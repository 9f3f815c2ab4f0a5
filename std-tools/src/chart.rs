//! Charts as SVG: lines over a variable, bars in groups.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use crate::draw::colour::SERIES;

/// One line of a chart.
#[derive(Clone, Debug)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// Variable and value, by increasing variable.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A line without points.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), points: Vec::new() }
    }
}

/// A chart of lines over one variable; values on a logarithmic scale.
#[derive(Clone, Copy, Debug)]
pub struct Chart<'a> {
    /// The line above it.
    pub title: &'a str,
    /// What the variable is.
    pub x: &'a str,
    /// What the values are.
    pub y: &'a str,
    /// Whether the variable is on a logarithmic scale too.
    pub log_x: bool,
    /// The lines.
    pub series: &'a [Series],
}

/// The colours of the series, over and over.
fn colours() -> impl Iterator<Item = RGBColor> {
    SERIES.into_iter().map(|[red, green, blue]| RGBColor(red, green, blue)).cycle()
}

impl Chart<'_> {
    /// Draws the chart into a file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), Box<dyn Error>> {
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
        for (series, colour) in self.series.iter().zip(colours()) {
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

/// Bars in groups: for each group one bar of each series that has a value there.
#[derive(Clone, Debug)]
pub struct Bars {
    /// The line above it.
    pub title: String,
    /// Whether values are on a logarithmic scale; else they start at zero.
    pub log: bool,
    /// The series, in the order of their colours.
    pub series: Vec<String>,
    /// The groups: what stands below each, and a bar for each series.
    pub groups: Vec<(String, Vec<Bar>)>,
}

/// A value and what stands above its bar; `None` where there is none.
pub type Bar = Option<(f64, String)>;

/// Draws panels of bars below one another, all with the same series.
///
/// # Errors
/// If the drawing library fails, as it does for an empty range.
pub fn draw_bars(title: &str, panels: &[Bars]) -> Result<String, Box<dyn Error + Send + Sync>> {
    const PANEL: u32 = 300;
    let rows = u32::try_from(panels.len())?;
    // A title and a legend, if there are any.
    let is_bare = title.is_empty() && panels.first().is_none_or(|panel| panel.series.len() < 2);
    let head = if is_bare { 8 } else { 64 };
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (1000, head + PANEL * rows)).into_drawing_area();
        root.fill(&WHITE).map_err(|error| error.to_string())?;
        root.draw(&Text::new(title.to_owned(), (16, 14), ("sans-serif", 20))).map_err(|error| error.to_string())?;
        if let Some(first) = panels.first().filter(|_| !is_bare) {
            let mut x = 16;
            for (name, colour) in first.series.iter().zip(colours()) {
                root.draw(&Rectangle::new([(x, 44), (x + 12, 56)], colour.filled()))
                    .map_err(|error| error.to_string())?;
                root.draw(&Text::new(name.clone(), (x + 18, 43), ("sans-serif", 14)))
                    .map_err(|error| error.to_string())?;
                x += 40 + 9 * i32::try_from(name.chars().count())?;
            }
        }
        let (_, below) = root.split_vertically(head);
        for (area, panel) in below.split_evenly((panels.len(), 1)).iter().zip(panels) {
            panel.draw(area)?;
        }
        root.present().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}

impl Bars {
    fn draw(
        &self,
        area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    ) -> Result<(), Box<dyn Error + Send + Sync>> {
        let values = || self.groups.iter().flat_map(|(_, values)| values.iter().flatten().map(|(value, _)| *value));
        let most = values().fold(f64::MIN_POSITIVE, f64::max);
        let least = values().fold(most, f64::min).max(f64::MIN_POSITIVE);
        let floor = if self.log { least / 3.0 } else { 0.0 };
        let mut builder = ChartBuilder::on(area);
        builder.caption(&self.title, ("sans-serif", 15)).margin(8).x_label_area_size(24).y_label_area_size(64);
        let columns = 0.0..self.groups.len() as f64;
        if self.log {
            let chart = builder.build_cartesian_2d(columns, (floor..most * 3.0).log_scale());
            self.draw_bars(&mut chart.map_err(|error| error.to_string())?, floor)
        } else {
            let chart = builder.build_cartesian_2d(columns, 0.0..most * 1.15);
            self.draw_bars(&mut chart.map_err(|error| error.to_string())?, floor)
        }
    }

    fn draw_bars<'b, X, Y>(
        &self,
        chart: &mut ChartContext<'_, SVGBackend<'b>, Cartesian2d<X, Y>>,
        floor: f64,
    ) -> Result<(), Box<dyn Error + Send + Sync>>
    where
        X: Ranged<ValueType = f64> + plotters::coord::ranged1d::ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + plotters::coord::ranged1d::ValueFormatter<f64>,
    {
        let mut mesh = chart.configure_mesh();
        mesh.disable_x_mesh().x_labels(0).y_labels(6).y_label_formatter(&si);
        mesh.draw().map_err(|error| error.to_string())?;
        let area = chart.plotting_area().strip_coord_spec();
        let (left, top) = area.get_base_pixel();
        let place = |x: f64, y: f64| {
            let (x, y) = chart.backend_coord(&(x, y));
            (x - left, y - top)
        };
        let width = 0.86 / self.series.len().max(1) as f64;
        for (group, (name, values)) in self.groups.iter().enumerate() {
            let (mut x, middle) = (group as f64 + 0.07, group as f64 + 0.5);
            for (value, colour) in values.iter().zip(colours()) {
                if let Some((value, label)) = value {
                    let (low, high) = (place(x + width * 0.05, floor), place(x + width * 0.95, value.max(floor)));
                    area.draw(&Rectangle::new([low, high], colour.filled())).map_err(|error| error.to_string())?;
                    let text = Text::new(label.clone(), ((low.0 + high.0) / 2, high.1 - 13), centred(11));
                    area.draw(&text).map_err(|error| error.to_string())?;
                }
                x += width;
            }
            let (at, bottom) = place(middle, floor);
            area.draw(&Text::new(name.clone(), (at, bottom + 9), centred(13))).map_err(|error| error.to_string())?;
        }
        Ok(())
    }
}

fn centred(size: u32) -> TextStyle<'static> {
    use plotters::style::text_anchor::{HPos, Pos, VPos};
    ("sans-serif", size).into_font().into_text_style(&(1000, 1000)).pos(Pos::new(HPos::Center, VPos::Top))
}
