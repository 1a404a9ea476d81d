//! Fills, strokes and opacities of one element in several drawings, blended.
//!
//! - Colours and opacities count with the weights' positive parts, scaled to sum 1, and colours with their alpha: what is clear
//!   tints nothing. Widths and dashes count with the weights themselves and are never negative.
//! - Where a drawing has no fill (or stroke) it is the others' with alpha 0. A plain colour is a gradient with that colour everywhere.
//! - Gradients with equally many stops are blended stop by stop; others have the stops of all, each with the colour that its
//!   gradient has there. Placements are blended after the mesh has carried them.
//!
//! What cannot change gradually has to agree: the fill rule, ends and corners of lines, the number of dashes, linear or radial, and
//! what is beyond a gradient's ends.

use super::super::ColourBlend;
use crate::input::{
    ArtElement, Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stop, Stroke,
};
use crate::math::{Point, restricted_weights};

/// The styles of one element in the drawings that have it.
#[derive(Debug, Clone)]
pub(super) struct Styles {
    fill: Option<(Paints, FillRule)>,
    stroke: Option<Lines>,
    opacities: Vec<f64>,
}

#[derive(Debug, Clone)]
enum Paints {
    /// One a drawing.
    Solid(Vec<[f64; 4]>),
    Gradient {
        spread: Spread,
        /// `None` for a drawing with a plain colour.
        kinds: Vec<Option<GradientKind>>,
        placements: Vec<Option<Placement>>,
        /// #drawings x #stops.
        stops: Vec<Vec<Stop>>,
    },
}

#[derive(Debug, Clone)]
struct Lines {
    paints: Paints,
    cap: LineCap,
    join: LineJoin,
    widths: Vec<f64>,
    miter_limits: Vec<f64>,
    /// #drawings x #dashes.
    dashes: Vec<Vec<f64>>,
    dash_offsets: Vec<f64>,
}

impl Styles {
    /// The styles of `elements`, one a drawing.
    ///
    /// # Errors
    /// What of them cannot change gradually.
    pub(super) fn new(elements: &[&ArtElement]) -> Result<Self, &'static str> {
        let fills: Vec<Option<&Fill>> = elements.iter().map(|element| element.fill.as_ref()).collect();
        let strokes: Vec<Option<&Stroke>> = elements.iter().map(|element| element.stroke.as_ref()).collect();
        let fill = match agreed(fills.iter().flatten().map(|fill| fill.rule)) {
            None => None,
            Some(None) => return Err("their fill rules differ"),
            Some(Some(rule)) => {
                let paints: Vec<Option<&Paint>> = fills.iter().map(|fill| fill.map(|fill| &fill.paint)).collect();
                Some((Paints::new(&paints)?, rule))
            }
        };
        Ok(Self {
            fill,
            stroke: Lines::new(&strokes)?,
            opacities: elements.iter().map(|element| element.opacity).collect(),
        })
    }

    /// Whether a gradient has to be placed.
    pub(super) fn has_gradient(&self) -> bool {
        let paints = self.fill.iter().map(|(paints, _)| paints);
        let mut paints = paints.chain(self.stroke.iter().map(|lines| &lines.paints));
        paints.any(|paints| matches!(paints, Paints::Gradient { .. }))
    }

    /// Fill, stroke and opacity where the drawings count with `weights`. `carried` maps places of drawing d to the frame; lengths
    /// grow by `scale`.
    pub(super) fn at(
        &self,
        weights: &[f64],
        carried: &[Placement],
        scale: f64,
        blending: ColourBlend,
    ) -> (Option<Fill>, Option<Stroke>, f64) {
        let shares = &Shares {
            parts: positive_shares(weights),
            blending,
        };
        let fill = self.fill.as_ref().map(|(paints, rule)| Fill {
            paint: paints.at(weights, shares, carried),
            rule: *rule,
        });
        let stroke = self
            .stroke
            .as_ref()
            .map(|lines| lines.at(weights, shares, carried, scale));
        (fill, stroke, mean(&shares.parts, &self.opacities).clamp(0.0, 1.0))
    }
}

impl Paints {
    fn new(paints: &[Option<&Paint>]) -> Result<Self, &'static str> {
        let gradients: Vec<Option<&Gradient>> = paints
            .iter()
            .map(|paint| match paint {
                Some(Paint::Gradient(gradient)) => Some(gradient),
                _ => None,
            })
            .collect();
        let drawn = || gradients.iter().flatten();
        let Some(first) = drawn().next() else {
            let present = paints.iter().flatten().find_map(|paint| match paint {
                Paint::Solid(colour) => Some(*colour),
                Paint::Gradient(_) => None,
            });
            let clear = faded(present.unwrap_or_default());
            let colour = |paint: &Option<&Paint>| match paint {
                Some(Paint::Solid(colour)) => *colour,
                _ => clear,
            };
            return Ok(Self::Solid(paints.iter().map(colour).collect()));
        };
        let Some(Some(spread)) = agreed(drawn().map(|gradient| gradient.spread)) else {
            return Err("their gradients go on differently beyond their ends");
        };
        let is_linear = |kind: GradientKind| kind == GradientKind::Linear;
        if agreed(drawn().map(|gradient| is_linear(gradient.kind))) == Some(None) {
            return Err("a linear gradient cannot become a radial one");
        }
        let offsets = Offsets::of(&drawn().map(|gradient| gradient.stops.as_slice()).collect::<Vec<_>>());
        let stops = |paint: &Option<&Paint>| match paint {
            Some(Paint::Gradient(gradient)) => offsets.stops(&gradient.stops),
            Some(Paint::Solid(colour)) => offsets.plain(&first.stops, *colour),
            None => {
                let mut stops = offsets.stops(&first.stops);
                for stop in &mut stops {
                    stop.colour = faded(stop.colour);
                }
                stops
            }
        };
        Ok(Self::Gradient {
            spread,
            kinds: gradients.iter().map(|gradient| gradient.map(|g| g.kind)).collect(),
            placements: gradients.iter().map(|gradient| gradient.map(|g| g.placement)).collect(),
            stops: paints.iter().map(stops).collect(),
        })
    }

    fn at(&self, weights: &[f64], shares: &Shares, carried: &[Placement]) -> Paint {
        match self {
            Self::Solid(colours) => Paint::Solid(shares.mean_colour(colours.iter().copied())),
            Self::Gradient {
                spread,
                kinds,
                placements,
                stops,
            } => {
                // Where a gradient lies is said by the drawings that have one.
                let present: Vec<bool> = placements.iter().map(Option::is_some).collect();
                let placing = restricted_weights(weights, &present);
                let mut placement = Placement {
                    along_x: Point::zeros(),
                    along_y: Point::zeros(),
                    origin: Point::zeros(),
                };
                let mut focus = Point::zeros();
                for (((own, kind), map), weight) in placements.iter().zip(kinds).zip(carried).zip(&placing) {
                    if let Some(own) = own {
                        let own = map.after(own);
                        placement.along_x += own.along_x * *weight;
                        placement.along_y += own.along_y * *weight;
                        placement.origin += own.origin * *weight;
                    }
                    if let Some(GradientKind::Radial { focus: own }) = kind {
                        focus += own * *weight;
                    }
                }
                let is_linear = kinds.iter().flatten().all(|kind| *kind == GradientKind::Linear);
                let count = stops.first().map_or(0, Vec::len);
                Paint::Gradient(Gradient {
                    kind: if is_linear {
                        GradientKind::Linear
                    } else {
                        // Extrapolated, it may leave the circle.
                        const FURTHEST_FOCUS: f64 = 0.999;
                        let length = focus.norm();
                        GradientKind::Radial {
                            focus: if length > FURTHEST_FOCUS {
                                focus * (FURTHEST_FOCUS / length)
                            } else {
                                focus
                            },
                        }
                    },
                    placement,
                    spread: *spread,
                    stops: (0..count)
                        .map(|k| Stop {
                            offset: stops
                                .iter()
                                .zip(&shares.parts)
                                .map(|(of, share)| of[k].offset * share)
                                .sum(),
                            colour: shares.mean_colour(stops.iter().map(|of| of[k].colour)),
                        })
                        .collect(),
                })
            }
        }
    }
}

impl Lines {
    fn new(strokes: &[Option<&Stroke>]) -> Result<Option<Self>, &'static str> {
        let drawn = || strokes.iter().flatten();
        let Some(first) = drawn().next() else {
            return Ok(None);
        };
        let (Some(Some(cap)), Some(Some(join))) = (agreed(drawn().map(|s| s.cap)), agreed(drawn().map(|s| s.join)))
        else {
            return Err("their lines end or turn differently");
        };
        if agreed(drawn().map(|stroke| stroke.dashes.len())) == Some(None) {
            return Err("their lines have different numbers of dashes");
        }
        let paints: Vec<Option<&Paint>> = strokes.iter().map(|s| s.map(|stroke| &stroke.paint)).collect();
        let each = |value: fn(&Stroke) -> f64| strokes.iter().map(|stroke| value(stroke.unwrap_or(first))).collect();
        Ok(Some(Self {
            paints: Paints::new(&paints)?,
            cap,
            join,
            widths: each(|stroke| stroke.width),
            miter_limits: each(|stroke| stroke.miter_limit),
            dashes: strokes
                .iter()
                .map(|stroke| stroke.unwrap_or(first).dashes.clone())
                .collect(),
            dash_offsets: each(|stroke| stroke.dash_offset),
        }))
    }

    fn at(&self, weights: &[f64], shares: &Shares, carried: &[Placement], scale: f64) -> Stroke {
        let count = self.dashes.first().map_or(0, Vec::len);
        let dash = |k: usize| -> f64 { self.dashes.iter().zip(weights).map(|(of, weight)| of[k] * weight).sum() };
        Stroke {
            paint: self.paints.at(weights, shares, carried),
            width: (mean(weights, &self.widths) * scale).max(0.0),
            cap: self.cap,
            join: self.join,
            miter_limit: mean(weights, &self.miter_limits).max(1.0),
            dashes: (0..count).map(|k| (dash(k) * scale).max(0.0)).collect(),
            dash_offset: mean(weights, &self.dash_offsets) * scale,
        }
    }
}

/// The offsets at which several gradients have stops.
enum Offsets {
    /// All have as many: stop k corresponds to stop k.
    Alike,
    /// Every offset of any, twice where a colour changes abruptly.
    United(Vec<(f64, Side)>),
}

/// On which side of an offset a colour is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Before,
    After,
}

impl Offsets {
    fn of(gradients: &[&[Stop]]) -> Self {
        if let Some(Some(_)) = agreed(gradients.iter().map(|stops| stops.len())) {
            return Self::Alike;
        }
        let mut all: Vec<f64> = gradients
            .iter()
            .flat_map(|stops| stops.iter().map(|stop| stop.offset))
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        let is_abrupt = |offset: f64| {
            gradients
                .iter()
                .any(|stops| stops.iter().filter(|stop| stop.offset == offset).count() > 1)
        };
        let united = all.into_iter().flat_map(|offset| {
            let before = is_abrupt(offset).then_some((offset, Side::Before));
            before.into_iter().chain([(offset, Side::After)])
        });
        Self::United(united.collect())
    }

    fn stops(&self, own: &[Stop]) -> Vec<Stop> {
        match self {
            Self::Alike => own.to_vec(),
            Self::United(offsets) => offsets
                .iter()
                .map(|&(offset, side)| Stop {
                    offset,
                    colour: colour_at(own, offset, side),
                })
                .collect(),
        }
    }

    fn plain(&self, like: &[Stop], colour: [f64; 4]) -> Vec<Stop> {
        let offsets: Vec<f64> = match self {
            Self::Alike => like.iter().map(|stop| stop.offset).collect(),
            Self::United(offsets) => offsets.iter().map(|(offset, _)| *offset).collect(),
        };
        offsets.into_iter().map(|offset| Stop { offset, colour }).collect()
    }
}

fn colour_at(stops: &[Stop], offset: f64, side: Side) -> [f64; 4] {
    let is_before = |stop: &&Stop| match side {
        Side::Before => stop.offset < offset,
        Side::After => stop.offset <= offset,
    };
    let before = stops.iter().rev().find(is_before);
    let after = stops.iter().find(|stop| !is_before(stop));
    match (before, after) {
        (Some(before), Some(after)) => {
            let part = (offset - before.offset) / (after.offset - before.offset);
            std::array::from_fn(|c| before.colour[c] + (after.colour[c] - before.colour[c]) * part)
        }
        (Some(only), None) | (None, Some(only)) => only.colour,
        (None, None) => [0.0; 4],
    }
}

/// The one value of all; `Some(None)` if there are several, `None` if there is none.
fn agreed<T: PartialEq>(mut values: impl Iterator<Item = T>) -> Option<Option<T>> {
    let first = values.next()?;
    Some(values.all(|value| value == first).then_some(first))
}

fn faded([red, green, blue, _]: [f64; 4]) -> [f64; 4] {
    [red, green, blue, 0.0]
}

/// The weights' positive parts, scaled to sum 1.
fn positive_shares(weights: &[f64]) -> Vec<f64> {
    let sum: f64 = weights.iter().map(|weight| weight.max(0.0)).sum();
    weights
        .iter()
        .map(|weight| weight.max(0.0) / sum.max(f64::MIN_POSITIVE))
        .collect()
}

fn mean(weights: &[f64], values: &[f64]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

/// How much each drawing's colour counts, and in which light they are averaged.
struct Shares {
    parts: Vec<f64>,
    blending: ColourBlend,
}

impl Shares {
    /// The mean of colours that are not premultiplied.
    fn mean_colour(&self, colours: impl Iterator<Item = [f64; 4]> + Clone) -> [f64; 4] {
        let alpha: f64 = (self.parts.iter().zip(colours.clone()))
            .map(|(share, colour)| share * colour[3])
            .sum();
        let mut mean = [0.0, 0.0, 0.0, alpha];
        for (share, colour) in self.parts.iter().zip(colours) {
            // All clear: then each counts by its share alone.
            let part = if alpha > 0.0 { share * colour[3] / alpha } else { *share };
            for (mean, c) in mean.iter_mut().zip(&colour[..3]) {
                *mean += part * self.blending.light_of(*c);
            }
        }
        let [red, green, blue] = [0, 1, 2].map(|k| self.blending.value_of(mean[k]));
        [red, green, blue, alpha].map(|c| c.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: [f64; 4] = [1.0, 0.0, 0.0, 1.0];
    const BLUE: [f64; 4] = [0.0, 0.0, 1.0, 1.0];

    fn filled(paint: Option<Paint>) -> ArtElement {
        ArtElement {
            id: None,
            subpaths: Vec::new(),
            fill: paint.map(|paint| Fill {
                paint,
                rule: FillRule::NonZero,
            }),
            stroke: None,
            opacity: 1.0,
        }
    }

    fn gradient(x: f64, stops: &[(f64, [f64; 4])]) -> Paint {
        Paint::Gradient(Gradient {
            kind: GradientKind::Linear,
            placement: Placement {
                along_x: Point::new(x, 0.0),
                along_y: Point::new(0.0, 1.0),
                origin: Point::zeros(),
            },
            spread: Spread::Pad,
            stops: stops.iter().map(|&(offset, colour)| Stop { offset, colour }).collect(),
        })
    }

    /// The blended fill, where nothing is carried anywhere.
    fn blended(paints: [Option<Paint>; 2], weights: [f64; 2]) -> Paint {
        let elements = paints.map(filled);
        let styles = Styles::new(&elements.iter().collect::<Vec<_>>()).expect("styles that agree");
        let (fill, _, _) = styles.at(&weights, &[Placement::IDENTITY; 2], 1.0, ColourBlend::Plain);
        fill.expect("a fill").paint
    }

    fn stops(paint: Paint) -> Vec<(f64, [f64; 4])> {
        match paint {
            Paint::Gradient(gradient) => gradient.stops.iter().map(|stop| (stop.offset, stop.colour)).collect(),
            Paint::Solid(_) => panic!("a gradient"),
        }
    }

    #[test]
    fn colours_count_with_their_alpha_and_without_negative_weights() {
        let clear_blue = [0.0, 0.0, 1.0, 0.0];
        let solid = |colour| Some(Paint::Solid(colour));
        assert_eq!(
            blended([solid(RED), solid(clear_blue)], [0.5, 0.5]),
            Paint::Solid([1.0, 0.0, 0.0, 0.5])
        );
        assert_eq!(
            blended([solid(RED), None], [0.25, 0.75]),
            Paint::Solid([1.0, 0.0, 0.0, 0.25])
        );
        assert_eq!(blended([solid(RED), solid(BLUE)], [1.5, -0.5]), Paint::Solid(RED));
    }

    #[test]
    fn equally_many_stops_move_and_others_are_united() {
        let a = gradient(1.0, &[(0.0, RED), (0.4, BLUE)]);
        let b = gradient(3.0, &[(0.2, RED), (1.0, RED)]);
        let half = stops(blended([Some(a.clone()), Some(b)], [0.5, 0.5]));
        assert_eq!(half, [(0.1, RED), (0.7, [0.5, 0.0, 0.5, 1.0])]);
        // An abrupt change at 0.5, and stops at 0 and 0.4.
        let abrupt = gradient(3.0, &[(0.5, RED), (0.5, BLUE), (1.0, BLUE)]);
        let united = stops(blended([Some(a.clone()), Some(abrupt.clone())], [0.0, 1.0]));
        assert_eq!(united, [(0.0, RED), (0.4, RED), (0.5, RED), (0.5, BLUE), (1.0, BLUE)]);
        let other_end = stops(blended([Some(a), Some(abrupt)], [1.0, 0.0]));
        assert_eq!(
            other_end,
            [(0.0, RED), (0.4, BLUE), (0.5, BLUE), (0.5, BLUE), (1.0, BLUE)]
        );
    }

    #[test]
    fn a_plain_colour_becomes_a_gradient_where_the_gradient_lies() {
        let a = gradient(2.0, &[(0.0, RED), (1.0, BLUE)]);
        let blend = blended([Some(a), Some(Paint::Solid(BLUE))], [0.5, 0.5]);
        let Paint::Gradient(gradient) = &blend else {
            panic!("a gradient");
        };
        assert_eq!(gradient.placement.along_x, Point::new(2.0, 0.0));
        assert_eq!(stops(blend), [(0.0, [0.5, 0.0, 0.5, 1.0]), (1.0, BLUE)]);
    }

    #[test]
    fn what_cannot_change_gradually_is_refused() {
        let mut even_odd = filled(Some(Paint::Solid(RED)));
        if let Some(fill) = &mut even_odd.fill {
            fill.rule = FillRule::EvenOdd;
        }
        assert!(Styles::new(&[&filled(Some(Paint::Solid(RED))), &even_odd]).is_err());
    }

    #[test]
    fn half_the_light_is_brighter_than_half_the_value() {
        let elements = [filled(Some(Paint::Solid(RED))), filled(Some(Paint::Solid(BLUE)))];
        let styles = Styles::new(&[&elements[0], &elements[1]]).expect("styles");
        let colour = |blending| {
            let (fill, _, _) = styles.at(&[0.5, 0.5], &[Placement::IDENTITY; 2], 1.0, blending);
            match fill.map(|fill| fill.paint) {
                Some(Paint::Solid(colour)) => colour,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(colour(ColourBlend::Plain), [0.5, 0.0, 0.5, 1.0]);
        // The sRGB value of half the light, 188 of 255.
        let [red, green, blue, alpha] = colour(ColourBlend::Linear);
        assert!((red - 0.735_357).abs() < 1e-5 && red == blue, "{red} {blue}");
        assert_eq!((green, alpha), (0.0, 1.0));
    }
}
