//! Fills, strokes and gradients.

use serde_json::{Map, Value, json};

use super::LottieWriter;
use super::property::{pair, rounded};
use crate::export::keyed::{Approximation, GradientTrack, PaintTrack, StrokeTrack};
use crate::export::svg::linear_ends;
use crate::math::Point;
use crate::math::point::cross;
use crate::render::{FillRule, LineCap, LineJoin, Placement, Spread};

/// Decimals of colours, offsets and opacities from 0 to 1.
const SHARE_DECIMALS: i32 = 4;
/// A radial gradient is round if its axes differ, or lean, by less than this fraction.
const ROUND: f64 = 0.01;

impl LottieWriter<'_> {
    pub(super) fn fill(&mut self, paint: &PaintTrack, rule: FillRule, seen: &[bool]) -> Value {
        let mut item = match paint {
            PaintTrack::Solid(colours) => self.solid("fl", colours, seen),
            PaintTrack::Gradient(gradient) => self.gradient("gf", gradient, seen),
        };
        let rule = match rule {
            FillRule::NonZero => 1,
            FillRule::EvenOdd => 2,
        };
        item.insert("r".to_owned(), json!(rule));
        Value::Object(item)
    }

    pub(super) fn stroke(&mut self, stroke: &StrokeTrack, seen: &[bool]) -> Value {
        let mut item = match &stroke.paint {
            PaintTrack::Solid(colours) => self.solid("st", colours, seen),
            PaintTrack::Gradient(gradient) => self.gradient("gs", gradient, seen),
        };
        let cap = match stroke.cap {
            LineCap::Butt => 1,
            LineCap::Round => 2,
            LineCap::Square => 3,
        };
        let join = match stroke.join {
            LineJoin::Miter => 1,
            LineJoin::Round => 2,
            LineJoin::Bevel => 3,
        };
        item.insert("lc".to_owned(), json!(cap));
        item.insert("lj".to_owned(), json!(join));
        if stroke.join == LineJoin::Miter {
            item.insert("ml".to_owned(), rounded(stroke.miter_limit, 3));
        }
        item.insert("w".to_owned(), self.length(&stroke.width, seen));
        let count = stroke.dashes.first().map_or(0, Vec::len);
        if count > 0 {
            let mut dashes: Vec<Value> = (0..count)
                .map(|k| {
                    let lengths: Vec<f64> = stroke.dashes.iter().map(|dashes| dashes[k]).collect();
                    let kind = if k % 2 == 0 { "d" } else { "g" };
                    json!({"n": kind, "nm": format!("dash {}", k + 1), "v": self.length(&lengths, seen)})
                })
                .collect();
            // Players tell the lengths apart by their names and refuse equal ones.
            dashes.push(json!({"n": "o", "nm": "offset", "v": self.length(&stroke.dash_offset, seen)}));
            item.insert("d".to_owned(), Value::Array(dashes));
        }
        Value::Object(item)
    }

    fn solid(&mut self, kind: &str, colours: &[[f64; 4]], seen: &[bool]) -> Map<String, Value> {
        let rgba: Vec<Vec<f64>> = colours.iter().map(|colour| colour.to_vec()).collect();
        let rgba = self.planner.settled(&rgba, seen);
        let rgb: Vec<Vec<f64>> = rgba.iter().map(|c| c[..3].to_vec()).collect();
        let alpha: Vec<f64> = rgba.iter().map(|c| c[3]).collect();
        let keys = self.planner.steps(&rgb);
        let colour = self.timeline.list(&keys, |k| shares(&rgb[k]));
        let opacity = self.percent(&alpha);
        Map::from_iter([
            ("ty".to_owned(), json!(kind)),
            ("c".to_owned(), colour),
            ("o".to_owned(), opacity),
        ])
    }

    fn length(&mut self, values: &[f64], seen: &[bool]) -> Value {
        let samples: Vec<Vec<f64>> = values.iter().map(|value| vec![*value]).collect();
        let samples = self.planner.settled(&samples, seen);
        let keys = self.planner.lengths(&samples);
        self.timeline.scalar(&keys, |k| rounded(samples[k][0], 3))
    }

    fn gradient(&mut self, kind: &str, gradient: &GradientTrack, seen: &[bool]) -> Map<String, Value> {
        if gradient.spread != Spread::Pad {
            self.planner.approximated(Approximation::RepeatedGradient);
        }
        let is_round = |placement: &Placement| {
            let size = placement.along_x.norm().max(placement.along_y.norm());
            let lean = placement.along_x.dot(&placement.along_y).abs();
            let difference = (placement.along_x.norm() - placement.along_y.norm()).abs();
            difference <= ROUND * size && lean <= ROUND * size * size
        };
        if gradient.is_radial && !gradient.placement.iter().all(is_round) {
            self.planner.approximated(Approximation::EllipticGradient);
        }
        let ends: Vec<Vec<Point>> = gradient
            .placement
            .iter()
            .map(|placement| {
                if gradient.is_radial {
                    round_ends(placement).to_vec()
                } else {
                    linear_ends(placement).to_vec()
                }
            })
            .collect();
        let ends = self.planner.settled(&ends, seen);
        let keys = self.planner.pixels(&ends);
        let mut item = Map::from_iter([
            ("ty".to_owned(), json!(kind)),
            ("t".to_owned(), json!(if gradient.is_radial { 2 } else { 1 })),
            ("s".to_owned(), self.timeline.list(&keys, |k| pair(ends[k][0]))),
            ("e".to_owned(), self.timeline.list(&keys, |k| pair(ends[k][1]))),
            ("o".to_owned(), json!({"a": 0, "k": 100})),
            ("g".to_owned(), self.stops(gradient, seen)),
        ]);
        if gradient.is_radial {
            let (length, angle) = self.highlight(gradient);
            item.insert("h".to_owned(), length);
            item.insert("a".to_owned(), angle);
        }
        item
    }

    /// Colours first, then alphas if any of them is seen through.
    fn stops(&mut self, gradient: &GradientTrack, seen: &[bool]) -> Value {
        let is_opaque = gradient.stops.iter().flatten().all(|stop| stop[4] >= 1.0);
        let flat: Vec<Vec<f64>> = gradient
            .stops
            .iter()
            .map(|stops| {
                let mut values: Vec<f64> = stops.iter().flat_map(|stop| stop[..4].to_vec()).collect();
                if !is_opaque {
                    values.extend(stops.iter().flat_map(|stop| [stop[0], stop[4]]));
                }
                values
            })
            .collect();
        let flat = self.planner.settled(&flat, seen);
        let keys = self.planner.steps(&flat);
        let count = gradient.stops.first().map_or(0, Vec::len);
        json!({"p": count, "k": self.timeline.list(&keys, |k| shares(&flat[k]))})
    }

    /// How far the focus is from the centre, in percent of the radius, and in which direction from the gradient's own.
    fn highlight(&mut self, gradient: &GradientTrack) -> (Value, Value) {
        let mut turn_rad = 0.0;
        let polar: Vec<[f64; 2]> = gradient
            .focus
            .iter()
            .zip(&gradient.placement)
            .map(|(focus, placement)| {
                let side = cross(placement.along_x, placement.along_y).signum();
                let angle_rad = (focus.y * side).atan2(focus.x);
                let full = std::f64::consts::TAU;
                turn_rad = angle_rad + full * ((turn_rad - angle_rad) / full).round();
                [focus.norm(), turn_rad]
            })
            .collect();
        let lengths: Vec<Vec<f64>> = polar.iter().map(|[length, _]| vec![*length]).collect();
        let keys = self.planner.steps(&lengths);
        let length = self.timeline.scalar(&keys, |k| rounded(polar[k][0] * 100.0, 2));
        let angles: Vec<Vec<f64>> = polar
            .iter()
            .map(|[length, angle]| vec![angle * length.min(1.0)])
            .collect();
        let keys = self.planner.steps(&angles);
        let angle = self.timeline.scalar(&keys, |k| rounded(polar[k][1].to_degrees(), 2));
        (length, angle)
    }
}

fn shares(values: &[f64]) -> Value {
    Value::Array(
        values
            .iter()
            .map(|value| rounded(value.clamp(0.0, 1.0), SHARE_DECIMALS))
            .collect(),
    )
}

/// The centre and a point of the circle that has the area of the placed unit circle.
fn round_ends(placement: &Placement) -> [Point; 2] {
    let radius = cross(placement.along_x, placement.along_y).abs().sqrt();
    let length = placement.along_x.norm();
    let direction = if length > 0.0 {
        placement.along_x / length
    } else {
        Point::new(1.0, 0.0)
    };
    [placement.origin, placement.origin + direction * radius]
}
