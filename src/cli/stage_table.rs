//! What the stages of a mapping did and how long each took, as a table.

use std::time::{Duration, Instant};

use inbetween::pipeline::{LayerSpec, MappingReport, Stage};
use inbetween::pose::Mapping;

/// Landmarks named in a pose's line; the others are counted.
const NAMED: usize = 6;

/// What a line of the table is about.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Row {
    Input,
    Stage(Stage),
    Total,
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Input => f.write_str("input"),
            Self::Stage(stage) => stage.fmt(f),
            Self::Total => f.write_str("total"),
        }
    }
}

/// Looks at the clock whenever a stage begins.
pub(crate) struct StageClock {
    begun: Vec<(Row, Instant)>,
    end: Option<Instant>,
}

impl StageClock {
    /// Starts with the reading of the drawings.
    pub(crate) fn start() -> Self {
        Self {
            begun: vec![(Row::Input, Instant::now())],
            end: None,
        }
    }

    /// Another stage begins.
    pub(crate) fn begins(&mut self, stage: Stage) {
        self.begun.push((Row::Stage(stage), Instant::now()));
    }

    /// The last one is done.
    pub(crate) fn stop(&mut self) {
        self.end = Some(Instant::now());
    }

    /// Every stage with its time, and the total.
    fn times(&self) -> Vec<(Row, Duration)> {
        let end = self.end.unwrap_or_else(Instant::now);
        let ends = self.begun.iter().skip(1).map(|(_, at)| *at).chain([end]);
        let mut times: Vec<(Row, Duration)> = self
            .begun
            .iter()
            .zip(ends)
            .map(|((row, from), to)| (*row, to.duration_since(*from)))
            .collect();
        times.push((Row::Total, times.iter().map(|(_, time)| *time).sum()));
        times
    }
}

/// The table, one line an entry: stages with their times and numbers, then the match of every pose.
pub(crate) fn lines(layer: &LayerSpec, mapping: &Mapping, report: &MappingReport, clock: &StageClock) -> Vec<String> {
    let rows: Vec<[String; 3]> = clock
        .times()
        .into_iter()
        .map(|(row, time)| {
            let numbers = numbers_of(row, layer, mapping, report);
            [row.to_string(), format!("{:.1}", time.as_secs_f64() * 1e3), numbers]
        })
        .collect();
    let mut lines = aligned(["stage", "ms", "result"], &rows);
    let names = mapping.poses.names();
    let matches: Vec<[String; 4]> = names
        .iter()
        .enumerate()
        .map(|(pose, name)| {
            let matched = &report.matching.poses[pose];
            let cost = if pose == mapping.matching.reference {
                "-".to_owned()
            } else {
                format!("{:.2}", matched.cost)
            };
            let used = matched.landmarks.iter().filter_map(|k| report.landmarks.get(*k));
            let mut used: Vec<&str> = used.map(|landmark| landmark.name.as_str()).collect();
            let more = used.len().saturating_sub(NAMED);
            used.truncate(NAMED);
            let mut through = if used.is_empty() {
                "-".to_owned()
            } else {
                used.join(", ")
            };
            if more > 0 {
                through.push_str(&format!(" and {more} more"));
            }
            let found = report.explained.get(pose).copied().flatten();
            let found = found.map_or("-".to_owned(), |explained| format!("{:.0} %", 100.0 * explained.share));
            [name.clone(), cost, found, through]
        })
        .collect();
    lines.push(String::new());
    lines.extend(aligned(
        ["pose", "cost", "found", "matched through the landmarks"],
        &matches,
    ));
    lines
}

/// What a stage has to say.
fn numbers_of(row: Row, layer: &LayerSpec, mapping: &Mapping, report: &MappingReport) -> String {
    let largest = |values: &[f64]| 100.0 * values.iter().copied().fold(0.0, f64::max);
    match row {
        Row::Input => {
            let drawings: Vec<_> = layer.drawn().map(|drawn| &drawn.drawing).collect();
            let rings = drawings.iter().flat_map(|drawing| drawing.outline.rings());
            let points: usize = rings.map(|ring| ring.len()).sum();
            let holes = mapping.rings.len().saturating_sub(1);
            format!("{} drawings, {points} outline points, {holes} holes", drawings.len())
        }
        Row::Stage(Stage::Matching) => {
            let costs = report.matching.poses.iter().map(|pose| pose.cost);
            let reference = &mapping.poses.names()[mapping.matching.reference];
            let worst = costs.fold(0.0, f64::max);
            format!("to '{reference}', cost at most {worst:.2}")
        }
        Row::Stage(Stage::Simplification) => {
            let of = &report.simplification;
            format!(
                "{} to {} vertices, at most {:.2} % of the diagonal off, area at most {:.1} % larger",
                of.tuples,
                of.vertices,
                largest(&of.deviation),
                largest(&of.excess_area)
            )
        }
        Row::Stage(Stage::Triangulation) => {
            let of = &report.triangulation;
            format!(
                "{} Steiner points: {} on bridges, {} single, {} on link paths, {} from overlays, {} taken out",
                mapping.steiner, of.bridge, of.single, of.link, of.overlay, of.decimated
            )
        }
        Row::Stage(Stage::Refinement) => {
            let (of, quality) = (&report.refinement, &report.quality);
            format!(
                "{} splits, {} flips; smallest angle {:.1} degrees, 5th percentile {:.1}; stretch {:.2}, largest {:.1}",
                of.splits,
                of.flips,
                quality.smallest_angle_deg,
                quality.low_angle_deg,
                quality.median_stretch,
                quality.largest_stretch
            )
        }
        Row::Stage(_) => String::new(),
        Row::Total => {
            let topology = mapping.poses.topology();
            format!(
                "{} vertices, {} triangles",
                topology.vertex_count(),
                topology.triangles().len()
            )
        }
    }
}

/// Columns: words, numbers, words.
fn aligned<const N: usize>(head: [&str; N], rows: &[[String; N]]) -> Vec<String> {
    let width = |column: usize| {
        let widths = rows.iter().map(|row| row[column].chars().count());
        widths.fold(head[column].len(), usize::max)
    };
    let line = |entries: [&str; N]| {
        let entry = |(column, entry): (usize, &str)| match column {
            0 => format!("{entry:0$}", width(0)),
            last if last + 1 == N => entry.to_owned(),
            _ => format!("{entry:>0$}", width(column)),
        };
        let entries: Vec<String> = entries.into_iter().enumerate().map(entry).collect();
        entries.join("  ").trim_end().to_owned()
    };
    let rows = rows.iter().map(|row| row.each_ref().map(String::as_str));
    std::iter::once(head).chain(rows).map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_longest_entry() {
        let rows = [["a", "1.5", "x"], ["long name", "12.0", ""]].map(|row| row.map(str::to_owned));
        let expected = ["stage        ms  result", "a           1.5  x", "long name  12.0"];
        assert_eq!(aligned(["stage", "ms", "result"], &rows), expected);
    }

    #[test]
    fn times_are_between_beginnings_and_add_up() {
        let start = Instant::now();
        let at = |ms: u64| start + Duration::from_millis(ms);
        let clock = StageClock {
            begun: vec![(Row::Input, start), (Row::Stage(Stage::Matching), at(3))],
            end: Some(at(10)),
        };
        let times: Vec<u128> = clock.times().iter().map(|(_, time)| time.as_millis()).collect();
        assert_eq!(times, [3, 7, 10]);
    }
}
