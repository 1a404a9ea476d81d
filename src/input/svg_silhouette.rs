//! The silhouette of vector art: everything that is drawn, united.
//!
//! 1. Every fill is flattened and made a region by its own fill rule; every stroke is widened to a region first (joins,
//!    caps and dashes as drawn). Groups with a clip path or a mask are cut by it.
//! 2. All regions are united (i_overlay, on an integer grid of 2^-60 of the drawing, where decisions are exact).
//! 3. Where the boundary meets itself in a point (a figure of eight, a hole that reaches the edge), a patch joins the two
//!    sides, since an outline must not touch itself. Its half width is [`PATCH`].
//! 4. The largest part is the outline; module `loose` says what becomes of the others.
//!
//! Masks cut where they let through less than half; within a mask, what clips and masks groups of its own is taken as it is. Filters do
//! not change the outline. Opacity does only where it is 0.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::overlay::FloatOverlay;
use kurbo::{Affine, BezPath, PathEl};

use super::loose::{Chosen, Piece, choose, note_pieces};
use super::{HoleRule, InputError, InputNote, PartOptions};
use crate::math::Point;
use crate::outline::{ArcLength, Outline, Ring, RingError, simplicity};

/// How far a flattened curve may be from the curve, as a fraction of the drawing's diagonal.
const FLATNESS: f64 = 1e-4;

/// Half the width of the patch put where an outline touches itself, as a fraction of the diagonal: just visible to the
/// later stages, invisible to the eye.
const PATCH: f64 = 5e-4;

/// How many touching places are patched before the drawing is refused.
const MOST_PATCHES: usize = 64;

/// Holes and loose parts with less than this share of the outline's area are dirt.
const DIRT_SHARE: f64 = 1e-4;

/// How far from a part a place that names it may be, as a fraction of the drawing's diagonal.
const CLICK: f64 = 0.02;

/// The most dashes that a stroke is cut into; beyond, it counts as a full line.
const MOST_DASHES: f64 = 10_000.0;

/// Closed polygons, the inside to the left of each in the sense of positive area.
type Region = Vec<Vec<[f64; 2]>>;

/// The pieces of everything drawn in `nodes`, in user units.
pub(super) fn silhouette(
    nodes: &[&usvg::Node],
    to_user: Affine,
    hole_rule: HoleRule,
    options: &PartOptions,
) -> Result<Pieces, InputError> {
    let mut bounds: Option<kurbo::Rect> = None;
    for node in nodes {
        let bbox = node.abs_stroke_bounding_box();
        let rect = kurbo::Rect::new(
            f64::from(bbox.left()),
            f64::from(bbox.top()),
            f64::from(bbox.right()),
            f64::from(bbox.bottom()),
        );
        let rect = to_user.transform_rect_bbox(rect);
        bounds = Some(bounds.map_or(rect, |all| all.union(rect)));
    }
    let diagonal = bounds.map_or(0.0, |rect| rect.width().hypot(rect.height()));
    // Written so that NaN fails too.
    if !(diagonal > 0.0 && diagonal < 4.0 * Ring::LARGEST_COORDINATE) {
        return Err(InputError::NoClosedShape);
    }
    let mut drawn = Region::new();
    for node in nodes {
        add_node(node, to_user, FLATNESS * diagonal, &mut drawn)?;
    }
    let mut parts = unite(&drawn, FillRule::NonZero);
    for _ in 0..MOST_PATCHES {
        let rings: Vec<Ring> = parts
            .iter()
            .flatten()
            .filter_map(|polygon| ring(polygon).ok())
            .collect();
        let Some(meeting) = simplicity::first_meeting(&rings) else {
            break;
        };
        let (size, at) = (PATCH * diagonal, meeting.place);
        let mut patched: Region = parts.into_iter().flatten().collect();
        patched.push(vec![
            [at.x - size, at.y - size],
            [at.x + size, at.y - size],
            [at.x + size, at.y + size],
            [at.x - size, at.y + size],
        ]);
        parts = unite(&patched, FillRule::NonZero);
    }
    pieces(&parts, hole_rule, options)
}

fn ring(polygon: &[[f64; 2]]) -> Result<Ring, RingError> {
    Ring::new(polygon.iter().copied().map(Point::from))
}

/// The parts of the plane that `region` covers: per part its outer polygon, then its holes.
fn unite(region: &Region, rule: FillRule) -> Vec<Region> {
    FloatOverlay::<[f64; 2], i64>::from_subj(region).overlay(OverlayRule::Subject, rule)
}

fn area_and_centroid(polygon: &[[f64; 2]]) -> (f64, Point) {
    let Some(&first) = polygon.first() else {
        return (0.0, Point::zeros());
    };
    let origin = Point::from(first);
    let (mut area, mut moment) = (0.0, Point::zeros());
    for k in 0..polygon.len() {
        let a = Point::from(polygon[k]) - origin;
        let b = Point::from(polygon[(k + 1) % polygon.len()]) - origin;
        let part = 0.5 * crate::math::point::cross(a, b);
        area += part;
        moment += (a + b) * (part / 3.0);
    }
    let centroid = if area == 0.0 { origin } else { origin + moment / area };
    (area, centroid)
}

/// The pieces of what is drawn.
#[derive(Debug)]
pub(super) struct Pieces {
    /// The outline of every piece that has one, and which piece of `chosen` it is.
    pub(super) outlines: Vec<(usize, Outline)>,
    pub(super) chosen: Chosen,
    pub(super) notes: Vec<InputNote>,
}

impl Pieces {
    /// The outline of a piece.
    pub(super) fn outline(&self, piece: usize) -> Option<&Outline> {
        let found = self.outlines.iter().find(|(own, _)| *own == piece);
        found.map(|(_, outline)| outline)
    }
}

fn pieces(parts: &[Region], hole_rule: HoleRule, options: &PartOptions) -> Result<Pieces, InputError> {
    let measured: Vec<Piece> = parts
        .iter()
        .map(|part| {
            let (outer, centroid) = part.first().map_or((0.0, Point::zeros()), |p| area_and_centroid(p));
            let holes: f64 = part.iter().skip(1).map(|hole| area_and_centroid(hole).0.abs()).sum();
            Piece {
                area: outer.abs() - holes,
                centroid,
            }
        })
        .collect();
    let at = |place| named_piece(parts, place);
    let chosen =
        choose(&measured, &[], options, |largest| DIRT_SHARE * largest, at)?.ok_or(InputError::NoClosedShape)?;
    let dirt = DIRT_SHARE * measured[chosen.largest].area;
    let mut notes = Vec::new();
    note_pieces(&measured, &chosen, dirt, &mut notes);
    let mut outlines = vec![(
        chosen.largest,
        outline_of(&parts[chosen.largest], dirt, hole_rule, &mut notes)?,
    )];
    // Specks and what is dropped only say whose curves are whose, where that is asked.
    let is_divided = !chosen.loose.is_empty() || !chosen.dropped.is_empty();
    let others = (0..parts.len()).filter(|piece| is_divided && *piece != chosen.largest);
    outlines.extend(others.filter_map(|piece| {
        let outline = outline_of(&parts[piece], dirt, hole_rule, &mut Vec::new());
        Some((piece, outline.ok()?))
    }));
    Ok(Pieces {
        outlines,
        chosen,
        notes,
    })
}

/// The piece that a place means: the one around it, or the nearest not far away.
fn named_piece(parts: &[Region], place: Point) -> Option<usize> {
    let rings: Vec<Vec<Ring>> = (parts.iter())
        .map(|part| part.iter().filter_map(|polygon| ring(polygon).ok()).collect())
        .collect();
    let all = rings.iter().flatten().flat_map(Ring::points);
    let reach = CLICK * crate::math::point::diagonal(all);
    let distance = |rings: &Vec<Ring>| {
        let is_inside = rings.iter().fold(false, |inside, ring| inside != ring.contains(place));
        let nearest = rings.iter().map(|ring| ArcLength::new(ring).nearest(place).1);
        if is_inside {
            0.0
        } else {
            nearest.fold(f64::INFINITY, f64::min)
        }
    };
    let distances = rings.iter().map(distance).enumerate();
    let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (nearest.1 <= reach).then_some(nearest.0)
}

/// The outline of one part; its pin-holes are closed and told of.
fn outline_of(
    part: &Region,
    dirt: f64,
    hole_rule: HoleRule,
    notes: &mut Vec<InputNote>,
) -> Result<Outline, InputError> {
    let mut rings = part.iter().map(|polygon| {
        let area = area_and_centroid(polygon).0.abs();
        ring(polygon).map(|ring| (ring, area))
    });
    let (outer, _) = match rings.next() {
        Some(Ok(outer)) => outer,
        Some(Err(error)) => return Err(InputError::Ring(error)),
        None => return Err(InputError::NoClosedShape),
    };
    let mut holes = Vec::new();
    let (mut closed, mut closed_area) = (0, 0.0);
    for ring in rings {
        match ring {
            Ok((ring, area)) if area >= dirt => holes.push(ring),
            Ok((_, area)) => (closed, closed_area) = (closed + 1, closed_area + area),
            // Fewer than three points bound nothing.
            Err(_) => {}
        }
    }
    if closed > 0 {
        notes.push(InputNote::PinHolesClosed {
            count: closed,
            area: closed_area,
        });
    }
    if hole_rule == HoleRule::Fill && !holes.is_empty() {
        notes.push(InputNote::HolesFilled { count: holes.len() });
        holes.clear();
    }
    Ok(Outline::new(outer, holes)?)
}

fn add_node(node: &usvg::Node, to_user: Affine, tolerance: f64, drawn: &mut Region) -> Result<(), InputError> {
    match node {
        usvg::Node::Group(group) => add_group(group, to_user, tolerance, drawn),
        usvg::Node::Path(path) => add_path(path, to_user, tolerance, drawn),
        usvg::Node::Image(_) | usvg::Node::Text(_) => Ok(()),
    }
}

fn add_group(group: &usvg::Group, to_user: Affine, tolerance: f64, drawn: &mut Region) -> Result<(), InputError> {
    if group.opacity().get() == 0.0 {
        return Ok(());
    }
    let mut inside = Region::new();
    for child in group.children() {
        add_node(child, to_user, tolerance, &mut inside)?;
    }
    if let Some(clip) = group.clip_path() {
        let place = to_user * affine(group.abs_transform());
        inside = cut(&inside, &clip_region(clip, place, tolerance)?);
    }
    if let Some(mask) = group.mask() {
        let place = to_user * affine(group.abs_transform());
        inside = cut(&inside, &mask_region(mask, place, tolerance)?);
    }
    drawn.append(&mut inside);
    Ok(())
}

/// What a clip path lets through; `place` maps the coordinates of the clipped group to user units.
fn clip_region(clip: &usvg::ClipPath, place: Affine, tolerance: f64) -> Result<Region, InputError> {
    let mut region = Region::new();
    let place = place * affine(clip.transform());
    for child in clip.root().children() {
        // The clip's own tree starts at an identity, so its absolute transforms are relative to the clip.
        add_node(child, place, tolerance, &mut region)?;
    }
    match clip.clip_path() {
        Some(outer) => Ok(cut(&region, &clip_region(outer, place, tolerance)?)),
        None => Ok(region),
    }
}

/// What a mask lets through, at least by half; `place` maps the coordinates of the masked group to user units. What is drawn in it
/// later covers what was drawn before: paint that lets through is added, paint that does not is taken away.
fn mask_region(mask: &usvg::Mask, place: Affine, tolerance: f64) -> Result<Region, InputError> {
    let mut region = Region::new();
    add_to_mask(mask.root(), mask.kind(), place, tolerance, &mut region)?;
    let bounds = mask.rect();
    let corners = [
        (bounds.left(), bounds.top()),
        (bounds.right(), bounds.top()),
        (bounds.right(), bounds.bottom()),
        (bounds.left(), bounds.bottom()),
    ];
    let bounds = corners.map(|(x, y)| {
        let p = place * kurbo::Point::new(f64::from(x), f64::from(y));
        [p.x, p.y]
    });
    let region = cut(&region, &unite(&vec![bounds.to_vec()], FillRule::NonZero).concat());
    match mask.mask() {
        Some(outer) => Ok(cut(&region, &mask_region(outer, place, tolerance)?)),
        None => Ok(region),
    }
}

fn add_to_mask(
    group: &usvg::Group,
    kind: usvg::MaskType,
    place: Affine,
    tolerance: f64,
    region: &mut Region,
) -> Result<(), InputError> {
    for child in group.children() {
        match child {
            usvg::Node::Group(inner) if inner.clip_path().is_none() && inner.mask().is_none() => {
                add_to_mask(inner, kind, place, tolerance, region)?;
            }
            usvg::Node::Path(path) => {
                let mut own = Region::new();
                add_path(path, place, tolerance, &mut own)?;
                let paint = path.fill().map(|fill| (fill.paint(), fill.opacity().get()));
                let paint = paint.or_else(|| path.stroke().map(|stroke| (stroke.paint(), stroke.opacity().get())));
                let lets_through = paint.is_some_and(|(paint, opacity)| match kind {
                    usvg::MaskType::Alpha => opacity >= 0.5,
                    usvg::MaskType::Luminance => opacity * luminance(paint) >= 0.5,
                });
                if lets_through {
                    region.append(&mut own);
                } else if kind == usvg::MaskType::Luminance {
                    *region = FloatOverlay::<[f64; 2], i64>::from_subj_and_clip(&*region, &own)
                        .overlay(OverlayRule::Difference, FillRule::NonZero)
                        .into_iter()
                        .flatten()
                        .collect();
                }
            }
            other => add_node(other, place, tolerance, region)?,
        }
    }
    Ok(())
}

/// How light a paint is, from 0 to 1; of gradients the lightest colour counts.
fn luminance(paint: &usvg::Paint) -> f32 {
    let of = |colour: usvg::Color| {
        let [red, green, blue] = [colour.red, colour.green, colour.blue].map(|c| f32::from(c) / 255.0);
        0.2125 * red + 0.7154 * green + 0.0721 * blue
    };
    let lightest = |stops: &[usvg::Stop]| {
        let light = stops.iter().map(|stop| of(stop.color()) * stop.opacity().get());
        light.fold(0.0, f32::max)
    };
    match paint {
        usvg::Paint::Color(colour) => of(*colour),
        usvg::Paint::LinearGradient(gradient) => lightest(gradient.stops()),
        usvg::Paint::RadialGradient(gradient) => lightest(gradient.stops()),
        usvg::Paint::Pattern(_) => 1.0,
    }
}

fn cut(region: &Region, by: &Region) -> Region {
    FloatOverlay::<[f64; 2], i64>::from_subj_and_clip(region, by)
        .overlay(OverlayRule::Intersect, FillRule::NonZero)
        .into_iter()
        .flatten()
        .collect()
}

fn add_path(path: &usvg::Path, to_user: Affine, tolerance: f64, drawn: &mut Region) -> Result<(), InputError> {
    if !path.is_visible() {
        return Ok(());
    }
    let place = to_user * affine(path.abs_transform());
    let curve = bezier(path.data());
    if let Some(fill) = path.fill().filter(|fill| fill.opacity().get() > 0.0) {
        let rule = match fill.rule() {
            usvg::FillRule::NonZero => FillRule::NonZero,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        };
        add_region(&curve, place, tolerance, rule, drawn)?;
    }
    if let Some(stroke) = path.stroke().filter(|stroke| stroke.opacity().get() > 0.0) {
        // The stroke is widened before it is placed: a transform may squeeze it.
        let [a, b, c, d, ..] = place.as_coeffs();
        let scale = a.hypot(b).max(c.hypot(d));
        if scale > 0.0 {
            let local = tolerance / scale;
            let widened = kurbo::stroke(
                &curve,
                &style(stroke, &curve, local),
                &kurbo::StrokeOpts::default(),
                local,
            );
            add_region(&widened, place, tolerance, FillRule::NonZero, drawn)?;
        }
    }
    Ok(())
}

fn add_region(
    curve: &BezPath,
    place: Affine,
    tolerance: f64,
    rule: FillRule,
    drawn: &mut Region,
) -> Result<(), InputError> {
    let mut polygons = Region::new();
    kurbo::flatten(place * curve, tolerance, |element| match element {
        PathEl::MoveTo(p) => polygons.push(vec![[p.x, p.y]]),
        PathEl::LineTo(p) => {
            if let Some(polygon) = polygons.last_mut() {
                polygon.push([p.x, p.y]);
            }
        }
        _ => {}
    });
    for [x, y] in polygons.iter().flatten() {
        // Written so that NaN fails too.
        if !(x.abs() <= Ring::LARGEST_COORDINATE && y.abs() <= Ring::LARGEST_COORDINATE) {
            return Err(InputError::Ring(RingError::BadCoordinate { index: 0, x: *x, y: *y }));
        }
    }
    drawn.extend(unite(&polygons, rule).into_iter().flatten());
    Ok(())
}

pub(super) fn style(stroke: &usvg::Stroke, curve: &BezPath, tolerance: f64) -> kurbo::Stroke {
    let cap = match stroke.linecap() {
        usvg::LineCap::Butt => kurbo::Cap::Butt,
        usvg::LineCap::Round => kurbo::Cap::Round,
        usvg::LineCap::Square => kurbo::Cap::Square,
    };
    let join = match stroke.linejoin() {
        usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => kurbo::Join::Miter,
        usvg::LineJoin::Round => kurbo::Join::Round,
        usvg::LineJoin::Bevel => kurbo::Join::Bevel,
    };
    let style = kurbo::Stroke::new(f64::from(stroke.width().get()))
        .with_caps(cap)
        .with_join(join)
        .with_miter_limit(f64::from(stroke.miterlimit().get()));
    let Some(dashes) = stroke.dasharray() else {
        return style;
    };
    let dashes: Vec<f64> = dashes.iter().copied().map(f64::from).collect();
    let period: f64 = dashes.iter().sum();
    let length: f64 = curve
        .segments()
        .map(|segment| kurbo::ParamCurveArclen::arclen(&segment, tolerance))
        .sum();
    if length * dashes.len() as f64 <= MOST_DASHES * period {
        style.with_dashes(f64::from(stroke.dashoffset()), dashes)
    } else {
        style
    }
}

pub(super) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

pub(super) fn bezier(path: &usvg::tiny_skia_path::Path) -> BezPath {
    use usvg::tiny_skia_path::PathSegment;
    let p = |p: usvg::tiny_skia_path::Point| kurbo::Point::new(f64::from(p.x), f64::from(p.y));
    path.segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(a) => PathEl::MoveTo(p(a)),
            PathSegment::LineTo(a) => PathEl::LineTo(p(a)),
            PathSegment::QuadTo(a, b) => PathEl::QuadTo(p(a), p(b)),
            PathSegment::CubicTo(a, b, c) => PathEl::CurveTo(p(a), p(b), p(c)),
            PathSegment::Close => PathEl::ClosePath,
        })
        .collect()
}
