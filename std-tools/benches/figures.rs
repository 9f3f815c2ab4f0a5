//! scratch
mod common;
use common::chart::{Chart, Series};
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut a = Series::new("simplices");
    let mut b = Series::new("GUDHI");
    for i in 1..10 {
        a.points.push((i as f64 / 10.0, (i as f64 * 2.0).exp()));
        b.points.push((i as f64 / 10.0, 0.01 * (i as f64).exp()));
    }
    Chart {
        title: "Figure 9: Rips complexes of 10,000 points of S4",
        x: "r",
        y: "simplices",
        log_x: false,
        series: &[a, b],
    }
    .draw(std::path::Path::new("/tmp/c.svg"))
}
