//! The elements of a parsed SVG file as [`Art`].
//!
//! 1. Paths in drawing order, in user units; lines and quadratic curves become cubics, which is exact. A closing line that is not
//!    drawn out is, so that a closed path ends where it starts.
//! 2. A stroke keeps its width if its transform is a similarity; one that is squeezed is widened to a filled path of its own.
//!    A stroke that is painted before its fill becomes an element of its own too.
//! 3. Opacities of groups are multiplied into their elements. Where elements of a translucent group overlap this shows what is
//!    behind, which the file does not; the drawing's notes say so.
//!
//! What curves and plain styles cannot say (clip paths that cut, masks, filters, patterns, blend modes, a focal circle) is the
//! error: the drawing then has to be shown from its pixels.

use std::collections::BTreeMap;

use kurbo::{Affine, BezPath, PathEl, PathSeg};

use super::svg_silhouette::{affine, bezier, style};
use super::{
    Art, ArtElement, Fill, FillRule, Gradient, GradientKind, InputNote, LineCap, LineJoin, Paint, Placement, Spread,
    Stop, Stroke, Subpath,
};
use crate::math::{Point, point};

/// How much more a stroke may be widened in one direction than across it and still be drawn as a stroke of even width.
const EVEN_WIDTH: f64 = 1.005;

/// How exactly a squeezed stroke is widened, in stroke widths.
const WIDENING: f64 = 2e-3;

/// A clip path that leaves this much of its content's size uncovered cuts nothing: usvg computes boxes in single precision.
const CLIP_SLACK: f64 = 1e-4;

/// The elements drawn by `nodes`, in user units, or what in them cannot be carried as curves.
pub(super) fn read_art(nodes: &[&usvg::Node], to_user: Affine, notes: &mut Vec<InputNote>) -> Result<Art, String> {
    let mut reader = Reader {
        to_user,
        elements: Vec::new(),
        flattened: 0,
    };
    for node in nodes {
        reader.add_node(node, "", 1.0)?;
    }
    if reader.flattened > 0 {
        notes.push(InputNote::TranslucentGroups {
            count: reader.flattened,
        });
    }
    Ok(Art {
        elements: with_unique_ids(reader.elements),
    })
}

struct Reader {
    to_user: Affine,
    elements: Vec<ArtElement>,
    flattened: usize,
}

impl Reader {
    fn add_node(&mut self, node: &usvg::Node, name: &str, opacity: f64) -> Result<(), String> {
        match node {
            usvg::Node::Group(group) => self.add_group(group, name, opacity),
            usvg::Node::Path(path) => self.add_path(path, name, opacity),
            // Neither is drawn as pixels, which the drawing's notes say.
            usvg::Node::Image(_) | usvg::Node::Text(_) => Ok(()),
        }
    }

    fn add_group(&mut self, group: &usvg::Group, name: &str, opacity: f64) -> Result<(), String> {
        let name = if group.id().is_empty() { name } else { group.id() };
        let refuse = |what: &str| Err(format!("{} {what}", called(group, name)));
        if !group.filters().is_empty() {
            return refuse("has a filter");
        }
        if group.mask().is_some() {
            return refuse("has a mask");
        }
        if group.blend_mode() != usvg::BlendMode::Normal {
            return refuse("has a blend mode");
        }
        if group.clip_path().is_some_and(|clip| cuts(clip, group)) {
            return refuse("is cut by a clip path");
        }
        let own = f64::from(group.opacity().get());
        let first = self.elements.len();
        for child in group.children() {
            self.add_node(child, name, opacity * own)?;
        }
        if own < 1.0 && overlap(&self.elements[first..]) {
            self.flattened += 1;
        }
        Ok(())
    }

    fn add_path(&mut self, path: &usvg::Path, name: &str, opacity: f64) -> Result<(), String> {
        let name = if path.id().is_empty() { name } else { path.id() };
        let id = (!name.is_empty()).then(|| name.to_owned());
        let opacity = if path.is_visible() { opacity } else { 0.0 };
        let place = self.to_user * affine(path.abs_transform());
        let curve = bezier(path.data());
        let refuse = |what: String| format!("{} {what}", name_of("element", name));
        let fill = match path.fill() {
            Some(fill) => Some(Fill {
                paint: paint(fill.paint(), fill.opacity(), place).map_err(refuse)?,
                rule: match fill.rule() {
                    usvg::FillRule::NonZero => FillRule::NonZero,
                    usvg::FillRule::EvenOdd => FillRule::EvenOdd,
                },
            }),
            None => None,
        };
        let stroked = match path.stroke() {
            Some(stroke) => Some((stroke, paint(stroke.paint(), stroke.opacity(), place).map_err(refuse)?)),
            None => None,
        };
        let element = |subpaths: Vec<Subpath>, fill: Option<Fill>, stroke: Option<Stroke>| ArtElement {
            id: id.clone(),
            subpaths,
            fill,
            stroke,
            opacity,
        };
        let mut of_stroke = None;
        let mut of_both = None;
        if let Some((stroke, paint)) = stroked {
            let [a, b, c, d, ..] = place.as_coeffs();
            let (similar, reflected) = ((a + d).hypot(b - c), (a - d).hypot(b + c));
            let (most, least) = ((similar + reflected) / 2.0, (similar - reflected).abs() / 2.0);
            if most <= least * EVEN_WIDTH {
                let stroke = self::stroke(stroke, paint, (a * d - b * c).abs().sqrt());
                if path.paint_order() == usvg::PaintOrder::StrokeAndFill && fill.is_some() {
                    of_stroke = Some(element(subpaths(&curve, place, Ends::AsDrawn), None, Some(stroke)));
                } else {
                    of_both = Some(stroke);
                }
            } else {
                let tolerance = WIDENING * f64::from(stroke.width().get());
                let widened = kurbo::stroke(
                    &curve,
                    &style(stroke, &curve, tolerance),
                    &kurbo::StrokeOpts::default(),
                    tolerance,
                );
                let rule = FillRule::NonZero;
                let outline = subpaths(&widened, place, Ends::Joined);
                of_stroke = Some(element(outline, Some(Fill { paint, rule }), None));
            }
        }
        let ends = if of_both.is_some() { Ends::AsDrawn } else { Ends::Joined };
        let body = (fill.is_some() || of_both.is_some()).then(|| element(subpaths(&curve, place, ends), fill, of_both));
        let in_order = match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => [body, of_stroke],
            usvg::PaintOrder::StrokeAndFill => [of_stroke, body],
        };
        let drawn = in_order.into_iter().flatten();
        self.elements
            .extend(drawn.filter(|element| !element.subpaths.is_empty()));
        Ok(())
    }
}

fn called(group: &usvg::Group, name: &str) -> String {
    // A style on a path puts a group without a name around it.
    match group.children() {
        [usvg::Node::Path(path)] if group.id().is_empty() && !path.id().is_empty() => name_of("element", path.id()),
        _ => name_of("group", name),
    }
}

fn name_of(what: &str, name: &str) -> String {
    if name.is_empty() {
        format!("a nameless {what}")
    } else {
        format!("{what} '{name}'")
    }
}

/// Whether a clip path may take anything of its group away. One plain rectangle around everything does not: drawing programs
/// put it around whole pages.
fn cuts(clip: &usvg::ClipPath, group: &usvg::Group) -> bool {
    let [usvg::Node::Path(path)] = clip.root().children() else {
        return true;
    };
    if clip.clip_path().is_some() || path.fill().is_none() {
        return true;
    }
    let place = affine(group.abs_transform()) * affine(clip.transform()) * affine(path.abs_transform());
    let [_, b, c, ..] = place.as_coeffs();
    if b != 0.0 || c != 0.0 {
        return true;
    }
    let curve = place * bezier(path.data());
    let hull = kurbo::Shape::bounding_box(&curve);
    let on_hull = |p: kurbo::Point| (p.x == hull.x0 || p.x == hull.x1) && (p.y == hull.y0 || p.y == hull.y1);
    let is_rectangle = curve.elements().iter().all(|element| match element {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => on_hull(*p),
        PathEl::ClosePath => true,
        _ => false,
    }) && (kurbo::Shape::area(&curve).abs() - hull.area()).abs() <= CLIP_SLACK * hull.area();
    let inside = group.abs_stroke_bounding_box();
    let slack = CLIP_SLACK * f64::from(inside.width().max(inside.height()));
    let covers = f64::from(inside.left()) >= hull.x0 - slack
        && f64::from(inside.top()) >= hull.y0 - slack
        && f64::from(inside.right()) <= hull.x1 + slack
        && f64::from(inside.bottom()) <= hull.y1 + slack;
    !(is_rectangle && covers)
}

/// Whether the boxes of two elements meet.
fn overlap(elements: &[ArtElement]) -> bool {
    let boxes: Vec<(Point, Point)> = elements
        .iter()
        .filter_map(|element| point::bounding_box(element.subpaths.iter().flat_map(Subpath::points)))
        .collect();
    boxes.iter().enumerate().any(|(k, (low, high))| {
        let meets = |(other_low, other_high): &(Point, Point)| {
            let (a, b) = (low.sup(other_low), high.inf(other_high));
            a.x < b.x && a.y < b.y
        };
        boxes[k + 1..].iter().any(meets)
    })
}

fn with_unique_ids(mut elements: Vec<ArtElement>) -> Vec<ArtElement> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for element in &mut elements {
        if let Some(id) = &mut element.id {
            let count = seen.entry(id.clone()).or_default();
            *count += 1;
            if *count > 1 {
                *id = format!("{id}/{count}");
            }
        }
    }
    elements
}

/// What becomes of the ends of an open path.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    AsDrawn,
    /// A path that is only filled may as well be closed, so that its last side is carried too.
    Joined,
}

fn subpaths(curve: &BezPath, place: Affine, ends: Ends) -> Vec<Subpath> {
    let to_point = |p: kurbo::Point| {
        let p = place * p;
        Point::new(p.x, p.y)
    };
    let mut found: Vec<Subpath> = Vec::new();
    let close = |subpath: &mut Subpath, is_closed: bool| {
        subpath.is_closed = is_closed || ends == Ends::Joined;
        if subpath.is_closed && subpath.end() != subpath.start {
            let (from, to) = (subpath.end(), subpath.start);
            subpath.cubics.push(line(from, to));
        }
    };
    let mut current: Option<Subpath> = None;
    let starting = |p: kurbo::Point| Subpath {
        start: to_point(p),
        cubics: Vec::new(),
        is_closed: false,
    };
    let mut from = kurbo::Point::ZERO;
    let mut first = kurbo::Point::ZERO;
    let mut finish = |current: &mut Option<Subpath>, is_closed: bool| {
        if let Some(mut subpath) = current.take().filter(|subpath| !subpath.cubics.is_empty()) {
            close(&mut subpath, is_closed);
            found.push(subpath);
        }
    };
    for element in curve.elements() {
        let (segment, to) = match *element {
            PathEl::MoveTo(p) => {
                finish(&mut current, false);
                current = Some(starting(p));
                (from, first) = (p, p);
                continue;
            }
            PathEl::ClosePath => {
                finish(&mut current, true);
                // Whatever is drawn next starts there.
                current = Some(starting(first));
                from = first;
                continue;
            }
            PathEl::LineTo(p) => (PathSeg::Line(kurbo::Line::new(from, p)), p),
            PathEl::QuadTo(a, p) => (PathSeg::Quad(kurbo::QuadBez::new(from, a, p)), p),
            PathEl::CurveTo(a, b, p) => (PathSeg::Cubic(kurbo::CubicBez::new(from, a, b, p)), p),
        };
        let cubic = segment.to_cubic();
        if let (Some(subpath), false) = (&mut current, from == to && cubic.p1 == from && cubic.p2 == to) {
            let [a, b, c] = [cubic.p1, cubic.p2, cubic.p3].map(to_point);
            let next = match segment {
                PathSeg::Line(_) => line(subpath.end(), c),
                _ => [a, b, c],
            };
            subpath.cubics.push(next);
        }
        from = to;
    }
    finish(&mut current, false);
    found
}

/// A straight cubic.
fn line(from: Point, to: Point) -> [Point; 3] {
    [from + (to - from) / 3.0, from + (to - from) * (2.0 / 3.0), to]
}

fn stroke(stroke: &usvg::Stroke, paint: Paint, scale: f64) -> Stroke {
    let mut dashes: Vec<f64> = stroke
        .dasharray()
        .unwrap_or_default()
        .iter()
        .map(|dash| f64::from(*dash) * scale)
        .collect();
    // All zero is a whole line.
    if dashes.iter().all(|dash| *dash == 0.0) {
        dashes.clear();
    }
    if dashes.len() % 2 == 1 {
        dashes.extend_from_within(..);
    }
    Stroke {
        paint,
        width: f64::from(stroke.width().get()) * scale,
        cap: match stroke.linecap() {
            usvg::LineCap::Butt => LineCap::Butt,
            usvg::LineCap::Round => LineCap::Round,
            usvg::LineCap::Square => LineCap::Square,
        },
        join: match stroke.linejoin() {
            usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => LineJoin::Miter,
            usvg::LineJoin::Round => LineJoin::Round,
            usvg::LineJoin::Bevel => LineJoin::Bevel,
        },
        miter_limit: f64::from(stroke.miterlimit().get()),
        dashes,
        dash_offset: f64::from(stroke.dashoffset()) * scale,
    }
}

fn paint(paint: &usvg::Paint, opacity: usvg::Opacity, place: Affine) -> Result<Paint, String> {
    let opacity = f64::from(opacity.get());
    match paint {
        usvg::Paint::Color(colour) => Ok(Paint::Solid(straight(*colour, opacity))),
        usvg::Paint::LinearGradient(gradient) => {
            let [x1, y1, x2, y2] = [gradient.x1(), gradient.y1(), gradient.x2(), gradient.y2()].map(f64::from);
            let own = Affine::new([x2 - x1, y2 - y1, y1 - y2, x2 - x1, x1, y1]);
            Ok(self::gradient(gradient, GradientKind::Linear, place, own, opacity))
        }
        usvg::Paint::RadialGradient(gradient) => {
            if gradient.fr().get() > 0.0 {
                return Err("has a gradient with a focal circle".to_owned());
            }
            let [cx, cy, fx, fy] = [gradient.cx(), gradient.cy(), gradient.fx(), gradient.fy()].map(f64::from);
            let radius = f64::from(gradient.r().get());
            let own = Affine::new([radius, 0.0, 0.0, radius, cx, cy]);
            let focus = Point::new((fx - cx) / radius, (fy - cy) / radius);
            // On the circle or beyond it the gradient is a cone; SVG draws it from the circle's edge.
            let length = focus.norm();
            let focus = if !focus.iter().all(|c| c.is_finite()) {
                Point::zeros()
            } else if length > INNERMOST_EDGE {
                focus * (INNERMOST_EDGE / length)
            } else {
                focus
            };
            let kind = GradientKind::Radial { focus };
            Ok(self::gradient(gradient, kind, place, own, opacity))
        }
        usvg::Paint::Pattern(_) => Err("is painted with a pattern".to_owned()),
    }
}

/// How far out a focal point may lie, as a fraction of the radius: strictly inside, so that every place has one colour.
const INNERMOST_EDGE: f64 = 0.999;

fn gradient(base: &usvg::BaseGradient, kind: GradientKind, place: Affine, own: Affine, opacity: f64) -> Paint {
    let [a, b, c, d, e, f] = (place * affine(base.transform()) * own).as_coeffs();
    Paint::Gradient(Gradient {
        kind,
        placement: Placement {
            along_x: Point::new(a, b),
            along_y: Point::new(c, d),
            origin: Point::new(e, f),
        },
        spread: match base.spread_method() {
            usvg::SpreadMethod::Pad => Spread::Pad,
            usvg::SpreadMethod::Reflect => Spread::Reflect,
            usvg::SpreadMethod::Repeat => Spread::Repeat,
        },
        stops: base
            .stops()
            .iter()
            .map(|stop| Stop {
                offset: f64::from(stop.offset().get()),
                colour: straight(stop.color(), opacity * f64::from(stop.opacity().get())),
            })
            .collect(),
    })
}

fn straight(colour: usvg::Color, opacity: f64) -> [f64; 4] {
    let [red, green, blue] = [colour.red, colour.green, colour.blue].map(|c| f64::from(c) / 255.0);
    [red, green, blue, opacity]
}

#[cfg(test)]
mod tests;
