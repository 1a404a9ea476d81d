//! Fills, strokes and gradients.

use super::text::{colour, numbers};
use super::{Element, SHARE_DECIMALS, SvgWriter, number};
use crate::export::keyed::{GradientTrack, PaintTrack, StrokeTrack};
use crate::math::Point;
use crate::math::point::{cross, perpendicular};
use crate::render::{LineCap, LineJoin, Placement, Spread};

/// Maps smaller than this fraction of a pixel have no direction.
const NO_LENGTH: f64 = 1e-9;
/// The miter limit where SVG is not told.
const DEFAULT_MITER_LIMIT: f64 = 4.0;

/// What of a shape is painted.
#[derive(Debug, Clone, Copy)]
pub(super) enum Part {
    Fill,
    Stroke,
}

impl Part {
    fn attribute(self) -> &'static str {
        match self {
            Self::Fill => "fill",
            Self::Stroke => "stroke",
        }
    }

    fn opacity(self) -> &'static str {
        match self {
            Self::Fill => "fill-opacity",
            Self::Stroke => "stroke-opacity",
        }
    }
}

impl SvgWriter<'_> {
    pub(super) fn paint(&mut self, element: &mut Element, part: Part, name: &str, paint: &PaintTrack, seen: &[bool]) {
        match paint {
            PaintTrack::Solid(colours) => {
                let samples: Vec<Vec<f64>> = colours.iter().map(|colour| colour.to_vec()).collect();
                self.colour(element, [part.attribute(), part.opacity()], &samples, seen);
            }
            PaintTrack::Gradient(gradient) => {
                let gradient_name = self.ids.take(&format!("{name}-{}", part.attribute()));
                let gradient = self.gradient(&gradient_name, gradient, seen);
                self.definitions.push(gradient);
                element.set(part.attribute(), format!("url(#{gradient_name})"));
            }
        }
    }

    pub(super) fn stroke(&mut self, element: &mut Element, name: &str, stroke: &StrokeTrack, seen: &[bool]) {
        self.paint(element, Part::Stroke, name, &stroke.paint, seen);
        self.length(element, "stroke-width", &stroke.width, seen);
        match stroke.cap {
            LineCap::Butt => {}
            LineCap::Round => element.set("stroke-linecap", "round"),
            LineCap::Square => element.set("stroke-linecap", "square"),
        }
        match stroke.join {
            LineJoin::Miter => {}
            LineJoin::Round => element.set("stroke-linejoin", "round"),
            LineJoin::Bevel => element.set("stroke-linejoin", "bevel"),
        }
        if stroke.join == LineJoin::Miter && stroke.miter_limit != DEFAULT_MITER_LIMIT {
            element.set("stroke-miterlimit", number(stroke.miter_limit, 3));
        }
        if stroke.dashes.iter().any(|dashes| !dashes.is_empty()) {
            let dashes = self.planner.settled(&stroke.dashes, seen);
            let keys = self.planner.lengths(&dashes);
            let decimals = self.decimals;
            self.clock
                .animate(element, "stroke-dasharray", &keys, |k| numbers(&dashes[k], decimals));
            self.length(element, "stroke-dashoffset", &stroke.dash_offset, seen);
        }
    }

    fn length(&mut self, element: &mut Element, name: &'static str, values: &[f64], seen: &[bool]) {
        let samples: Vec<Vec<f64>> = values.iter().map(|value| vec![*value]).collect();
        let samples = self.planner.settled(&samples, seen);
        let keys = self.planner.lengths(&samples);
        let decimals = self.decimals;
        self.clock
            .animate(element, name, &keys, |k| numbers(&samples[k], decimals));
    }

    /// Red, green, blue and alpha as a colour and an opacity.
    fn colour(&mut self, element: &mut Element, names: [&'static str; 2], rgba: &[Vec<f64>], seen: &[bool]) {
        let rgba = self.planner.settled(rgba, seen);
        let rgb: Vec<Vec<f64>> = rgba.iter().map(|c| c[..3].to_vec()).collect();
        let alpha: Vec<f64> = rgba.iter().map(|c| c[3]).collect();
        let keys = self.planner.steps(&rgb);
        self.clock.animate(element, names[0], &keys, |k| colour(&rgb[k]));
        self.share(element, names[1], &alpha);
    }

    fn gradient(&mut self, name: &str, gradient: &GradientTrack, seen: &[bool]) -> Element {
        let mut element = Element::new(if gradient.is_radial {
            "radialGradient"
        } else {
            "linearGradient"
        })
        .with("id", name)
        .with("gradientUnits", "userSpaceOnUse");
        match gradient.spread {
            Spread::Pad => {}
            Spread::Reflect => element.set("spreadMethod", "reflect"),
            Spread::Repeat => element.set("spreadMethod", "repeat"),
        }
        if gradient.is_radial {
            self.radial(&mut element, gradient, seen);
        } else {
            self.linear(&mut element, gradient, seen);
        }
        for k in 0..gradient.stops.first().map_or(0, Vec::len) {
            let mut stop = Element::new("stop");
            let offsets: Vec<Vec<f64>> = gradient.stops.iter().map(|stops| vec![stops[k][0]]).collect();
            let offsets = self.planner.settled(&offsets, seen);
            let keys = self.planner.steps(&offsets);
            self.clock
                .animate(&mut stop, "offset", &keys, |k| number(offsets[k][0], SHARE_DECIMALS));
            let colours: Vec<Vec<f64>> = gradient.stops.iter().map(|stops| stops[k][1..].to_vec()).collect();
            self.colour(&mut stop, ["stop-color", "stop-opacity"], &colours, seen);
            element.push(stop);
        }
        element
    }

    fn linear(&mut self, element: &mut Element, gradient: &GradientTrack, seen: &[bool]) {
        let ends: Vec<Vec<Point>> = gradient.placement.iter().map(|p| linear_ends(p).to_vec()).collect();
        let ends = self.planner.settled(&ends, seen);
        let keys = self.planner.pixels(&ends);
        let decimals = self.decimals;
        let mut set = |name, value: &dyn Fn(usize) -> f64| {
            self.clock.animate(element, name, &keys, |k| number(value(k), decimals));
        };
        set("x1", &|k| ends[k][0].x);
        set("y1", &|k| ends[k][0].y);
        set("x2", &|k| ends[k][1].x);
        set("y2", &|k| ends[k][1].y);
    }

    /// The unit circle, with the map that places it: as a matrix if it rests, else as the turn, shear and scale that it is
    /// made of, because SVG cannot animate a matrix.
    fn radial(&mut self, element: &mut Element, gradient: &GradientTrack, seen: &[bool]) {
        let reach = gradient
            .placement
            .iter()
            .map(|p| p.along_x.norm().max(p.along_y.norm()))
            .fold(0.0, f64::max);
        let focus: Vec<Vec<Point>> = gradient.focus.iter().map(|focus| vec![focus * reach]).collect();
        let focus = self.planner.settled(&focus, seen);
        let focus_keys = self.planner.pixels(&focus);
        for name in ["cx", "cy"] {
            element.set(name, "0");
        }
        element.set("r", "1");
        let share = |value: f64| number(if reach > 0.0 { value / reach } else { 0.0 }, 4);
        self.clock.animate(element, "fx", &focus_keys, |k| share(focus[k][0].x));
        self.clock.animate(element, "fy", &focus_keys, |k| share(focus[k][0].y));

        let mut turn = 0.0;
        let maps: Vec<Map> = gradient
            .placement
            .iter()
            .map(|placement| {
                let map = Map::of(placement, turn);
                turn = map.turn_rad;
                map
            })
            .collect();
        let points: Vec<Vec<Point>> = maps
            .iter()
            .map(|map| {
                vec![
                    map.origin,
                    map.scale,
                    Point::new(map.turn_rad * reach, 0.0),
                    Point::new(map.shear_rad * reach, 0.0),
                ]
            })
            .collect();
        let points = self.planner.settled(&points, seen);
        let keys = self.planner.pixels(&points);
        if keys.len() < 2 {
            let Placement {
                along_x,
                along_y,
                origin,
            } = gradient.placement[seen.iter().position(|seen| *seen).unwrap_or(0)];
            let matrix = [along_x.x, along_x.y, along_y.x, along_y.y, origin.x, origin.y];
            element.set("gradientTransform", format!("matrix({})", numbers(&matrix, 3)));
            return;
        }
        let degrees = |distance: f64| number((distance / reach).to_degrees(), 3);
        self.clock.transform(element, "translate", &keys, |k| {
            numbers(&[points[k][0].x, points[k][0].y], 3)
        });
        self.clock
            .transform(element, "rotate", &keys, |k| degrees(points[k][2].x));
        self.clock
            .transform(element, "skewX", &keys, |k| degrees(points[k][3].x));
        self.clock.transform(element, "scale", &keys, |k| {
            numbers(&[points[k][1].x, points[k][1].y], 3)
        });
    }
}

/// Where the first and the last colour of a linear gradient lie, on a line across which the colour does not change.
pub(in crate::export) fn linear_ends(placement: &Placement) -> [Point; 2] {
    let Placement {
        along_x,
        along_y,
        origin,
    } = *placement;
    let across = perpendicular(along_y);
    let length_squared = across.norm_squared();
    let along = if length_squared > NO_LENGTH * NO_LENGTH {
        across * (across.dot(&along_x) / length_squared)
    } else {
        along_x
    };
    [origin, origin + along]
}

/// An affine map as a scale, then a shear along x, then a turn, then a shift.
#[derive(Debug, Clone, Copy)]
struct Map {
    origin: Point,
    turn_rad: f64,
    shear_rad: f64,
    scale: Point,
}

impl Map {
    /// The turn is the one nearest to `turn_rad` of all that are equal.
    fn of(placement: &Placement, turn_rad: f64) -> Self {
        let Placement {
            along_x,
            along_y,
            origin,
        } = *placement;
        let width = along_x.norm();
        if width < NO_LENGTH {
            return Self {
                origin,
                turn_rad,
                shear_rad: 0.0,
                scale: Point::new(0.0, along_y.norm()),
            };
        }
        let turn = along_x.y.atan2(along_x.x);
        let full = std::f64::consts::TAU;
        let direction = along_x / width;
        let height = cross(direction, along_y);
        let shear_rad = if height.abs() < NO_LENGTH {
            0.0
        } else {
            (direction.dot(&along_y) / height).atan()
        };
        Self {
            origin,
            turn_rad: turn + full * ((turn_rad - turn) / full).round(),
            shear_rad,
            scale: Point::new(width, height),
        }
    }
}
