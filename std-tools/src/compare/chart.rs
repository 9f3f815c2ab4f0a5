//! A comparison to be read at a glance: bytes, and times of the relations that are asked most.

use std::error::Error;

use super::{Comparison, Relation, Row};
use crate::chart::{Bars, draw_bars};

impl Comparison {
    /// The comparison as a chart in SVG: the bytes of each structure over those of the SIG, and the mean times of relations
    /// on a logarithmic scale.
    ///
    /// # Errors
    /// If the drawing library fails.
    pub fn chart(&self, name: &str) -> Result<String, Box<dyn Error + Send + Sync>> {
        let rows: Vec<&Row> = self.structures.iter().filter(|row| row.refused.is_none()).collect();
        let series: Vec<String> = rows.iter().map(|row| row.name.to_owned()).collect();
        let bar = |row: &&Row| row.ratio.map(|ratio| (ratio, format!("{ratio:.2}")));
        let space = Bars {
            title: "bytes, over those of the SIG".to_owned(),
            log: false,
            series: series.clone(),
            groups: vec![(String::new(), rows.iter().map(bar).collect())],
        };
        let top = self.simplices.len().saturating_sub(1);
        let relations = [
            Relation::Boundary(top, 0),
            Relation::Coboundary(0, 1),
            Relation::Coboundary(0, top),
            Relation::Adjacency(top),
            Relation::Adjacency(0),
            Relation::Star(0),
            Relation::Link(0),
        ];
        let groups = relations.into_iter().map(|relation| {
            let seconds = |row: &&Row| {
                let timing = row.relations.iter().find(|timing| timing.relation == relation)?;
                Some((timing.mean_seconds * 1e6, short(timing.mean_seconds * 1e6)))
            };
            (relation.to_string(), rows.iter().map(seconds).collect::<Vec<_>>())
        });
        let groups: Vec<_> = groups.filter(|(_, values)| values.iter().any(Option::is_some)).collect();
        let times = Bars { title: "mean time of a relation, µs, logarithmic".to_owned(), log: true, series, groups };
        let panels = if times.groups.is_empty() { vec![space] } else { vec![space, times] };
        draw_bars(name, &panels)
    }
}

/// Three digits that matter.
fn short(value: f64) -> String {
    match value {
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        1.0.. => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}
