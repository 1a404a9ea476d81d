//! The outlines in correspondence: numbered links and landmarks on rims, salient points, landmarks, and where the match is doubtful.

use tiny_skia::Color;

use super::canvas::Canvas;
use super::labels::{Area, LEADER_PX, Labels, Need};
use super::layout::Cell;
use super::{Diagram, INK, Sections, TEXT_PX, cost_colour, faint, hue, mark_size};
use crate::math::{Point, point, wrapped};
use crate::outline::ArcLength;
use crate::pose::{LandmarkKind, PlacedLandmark};

/// Points of a whole outline that is drawn as lines.
const SAMPLES: f64 = 1500.0;
/// The height of a number's line, in pixels.
const NUMBER_PX: f64 = 13.0;
/// The room about words, in pixels.
const MARGIN_PX: [f64; 2] = [6.0, 4.0];
/// How many doubtful sections of a pose are labelled.
const LABELLED: usize = 3;
/// The widest smoothing that a salient point survives, in perimeters, and the radii at none and at that, in pixels.
const WIDEST_SCALE: f64 = 0.04;
/// Salient points that survive less are not drawn: there are too many, and each means little.
const LEAST_SCALE: f64 = 0.0095;
const SALIENT_RADII_PX: [f64; 2] = [2.0, 9.0];
/// A parameter this far to either side tells an outline's direction, in perimeters.
const ASIDE: f64 = 0.004;

/// One pose's outline on the sheet.
struct Placed<'a> {
    cell: &'a Cell,
    curve: ArcLength,
    holes: Vec<ArcLength>,
}

impl Placed<'_> {
    fn at(&self, t: f64) -> Point {
        self.cell.fit.place(self.curve.at(t))
    }

    /// The points from one parameter on to another, not a whole turn.
    fn between(&self, from: f64, to: f64) -> Vec<Point> {
        let length = wrapped(to - from);
        let steps = 2 + (length * SAMPLES) as usize;
        (0..=steps)
            .map(|k| self.at(from + length * k as f64 / steps as f64))
            .collect()
    }

    /// Away from the shape: outlines are positive, so the inside is a positive quarter turn from the way along.
    fn outward(&self, t: f64) -> Point {
        self.aside(&self.curve, t)
    }

    /// Away from the shape at the rim nearest to a place of the pose: into the hole, whose rim runs the other way round.
    fn holeward(&self, place: Point) -> Option<Point> {
        let nearest = self.holes.iter().map(|rim| (rim, rim.nearest(place)));
        let (rim, (t, _)) = nearest.min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        Some(self.aside(rim, t))
    }

    fn aside(&self, curve: &ArcLength, t: f64) -> Point {
        let [before, after] = [t - ASIDE, t + ASIDE].map(|t| self.cell.fit.place(curve.at(t)));
        -point::perpendicular(after - before)
    }
}

/// Draws every outline in its cell. `columns` cells stand in a row.
pub(super) fn draw(canvas: &mut Canvas, diagram: &Diagram, sections: &Sections, cells: &[Cell], columns: usize) {
    let placed: Vec<Placed> = diagram
        .mapping
        .outlines
        .iter()
        .zip(cells)
        .map(|(outline, cell)| Placed {
            cell,
            curve: ArcLength::new(outline.outer()),
            holes: outline.holes().iter().map(ArcLength::new).collect(),
        })
        .collect();
    let share = |k: usize| k as f64 / sections.links().len().max(1) as f64;
    let lies_over_itself = |pose: usize| diagram.mapping.overlaps.depth(pose).is_some();
    for (k, link) in sections.links().iter().enumerate() {
        let places: Vec<Option<Point>> = (placed.iter().zip(&link.at).enumerate())
            .map(|(pose, (on, t))| (!lies_over_itself(pose)).then(|| on.at(*t)))
            .collect();
        for row in places.chunks(columns.max(1)) {
            let row: Vec<Point> = row.iter().flatten().copied().collect();
            canvas.line(&row, 0.8, faint(hue(share(k), 0.62)));
        }
    }
    for landmark in on_rims(diagram) {
        let at = placed.iter().zip(&landmark.at);
        let places: Vec<Point> = at
            .filter_map(|(pose, at)| Some(pose.cell.fit.place(*at.first()?)))
            .collect();
        for row in places.chunks(columns.max(1)) {
            canvas.line(row, 0.8, faint(INK));
        }
    }
    for (pose, here) in placed.iter().enumerate() {
        draw_curves(canvas, diagram, sections, here, pose);
        let mut labels = Labels::within(here.cell.area);
        for k in 0..(SAMPLES / 4.0) as usize {
            labels.avoid(&[here.at(4.0 * k as f64 / SAMPLES)]);
        }
        draw_landmarks(canvas, diagram, here, pose, &mut labels);
        if lies_over_itself(pose) {
            let words = "PARTS LIE OVER ONE ANOTHER";
            canvas.text_around(words, here.cell.foot(), 0.9 * TEXT_PX, INK);
            draw_names(
                &mut Pen {
                    canvas,
                    labels: &mut labels,
                },
                diagram,
                here,
                pose,
            );
            continue;
        }
        for (k, link) in sections.links().iter().enumerate() {
            let place = here.at(link.at[pose]);
            if link.landmark.is_none() {
                canvas.dot(place, 3.6, hue(share(k), 0.5));
            }
            labels.keep_free(Area::around(place, Point::repeat(4.0)));
        }
        draw_labels(canvas, diagram, sections, here, pose, &mut labels);
    }
}

/// The landmarks on rims of holes, whose numbers follow those of the links.
fn on_rims<'a>(diagram: &'a Diagram) -> impl Iterator<Item = &'a PlacedLandmark> {
    diagram.landmarks.iter().filter(|l| l.kind == LandmarkKind::OnRim)
}

/// Holes, the outline in the colours of its sections, doubtful ones on a broad band, salient points, lines inside.
fn draw_curves(canvas: &mut Canvas, diagram: &Diagram, sections: &Sections, here: &Placed, pose: usize) {
    let fit = here.cell.fit;
    for hole in diagram.mapping.outlines[pose].holes() {
        let points: Vec<Point> = (0..=hole.len()).map(|k| fit.place(hole.point(k))).collect();
        canvas.line(&points, 1.2, Color::from_rgba8(120, 120, 120, 255));
    }
    let links = sections.links();
    let costs = sections.costs(pose);
    let of_section = |k: usize| here.between(links[k].at[pose], links[(k + 1) % links.len()].at[pose]);
    let banded = if pose == sections.reference() {
        Vec::new()
    } else {
        sections.doubtful(pose)
    };
    for k in banded {
        canvas.line(&of_section(k), 13.0, Color::from_rgba8(255, 214, 214, 255));
    }
    for (k, cost) in costs.iter().enumerate() {
        canvas.line(&of_section(k), 3.0, cost_colour(*cost));
    }
    for landmark in diagram.landmarks.iter().filter(|l| l.kind == LandmarkKind::Line) {
        let line: Vec<Point> = landmark.at[pose].iter().map(|p| fit.place(*p)).collect();
        canvas.line(&line, 1.6, INK);
    }
    let salient = diagram.matching.poses.get(pose).map_or(&[][..], |p| &p.salient);
    for mark in salient.iter().filter(|mark| mark.scale > LEAST_SCALE) {
        let share = (mark.scale / WIDEST_SCALE).clamp(0.0, 1.0);
        let radius = SALIENT_RADII_PX[0] + (SALIENT_RADII_PX[1] - SALIENT_RADII_PX[0]) * share;
        canvas.circle(here.at(mark.parameter), radius, 1.1, Color::from_rgba8(90, 90, 90, 255));
    }
}

/// The points of the landmarks; smaller ones if they are many.
fn draw_landmarks(canvas: &mut Canvas, diagram: &Diagram, here: &Placed, pose: usize, labels: &mut Labels) {
    let half = mark_size(diagram);
    for landmark in diagram.landmarks.iter().filter(|l| l.kind != LandmarkKind::Line) {
        for place in &landmark.at[pose] {
            let place = here.cell.fit.place(*place);
            canvas.square(place, half, INK);
            labels.keep_free(Area::around(place, Point::repeat(half)));
        }
    }
}

/// Numbers; the doubtful sections; names.
fn draw_labels(
    canvas: &mut Canvas,
    diagram: &Diagram,
    sections: &Sections,
    here: &Placed,
    pose: usize,
    labels: &mut Labels,
) {
    let mut pen = Pen { canvas, labels };
    let links = sections.links();
    for (k, link) in links.iter().enumerate() {
        let t = link.at[pose];
        pen.label(&(k + 1).to_string(), here.at(t), here.outward(t), INK, Need::Must);
    }
    for (k, landmark) in on_rims(diagram).enumerate() {
        if let Some(&place) = landmark.at[pose].first() {
            let number = (links.len() + k + 1).to_string();
            let wanted = here.holeward(place).unwrap_or_default();
            pen.label(&number, here.cell.fit.place(place), wanted, INK, Need::Must);
        }
    }
    let doubtful = if pose == sections.reference() {
        Vec::new()
    } else {
        sections.doubtful(pose)
    };
    for k in doubtful.into_iter().take(LABELLED) {
        let (from, to) = (links[k].at[pose], links[(k + 1) % links.len()].at[pose]);
        let middle = from + 0.5 * wrapped(to - from);
        let (first, second) = sections.numbers(k);
        let words = format!("{first} TO {second}: {:.1}", sections.costs(pose)[k]);
        let (place, outward) = (here.at(middle), here.outward(middle));
        pen.label(&words, place, outward, cost_colour(f64::INFINITY), Need::Must);
    }
    draw_names(&mut pen, diagram, here, pose);
}

/// The names of landmarks, where there is room.
fn draw_names(pen: &mut Pen<'_>, diagram: &Diagram, here: &Placed, pose: usize) {
    for landmark in diagram.landmarks {
        let places = &landmark.at[pose];
        let Some(middle) = places.get(places.len() / 2).map(|p| here.cell.fit.place(*p)) else {
            continue;
        };
        let wanted = match landmark.kind {
            LandmarkKind::OnOutline => here.outward(here.curve.nearest(places[0]).0),
            LandmarkKind::OnRim => here.holeward(places[0]).unwrap_or_default(),
            LandmarkKind::Inside | LandmarkKind::Line => Point::new(1.0, 0.0),
        };
        pen.label(&name_on(landmark, pose), middle, wanted, name_colour(), Need::IfFree);
    }
}

fn name_colour() -> Color {
    Color::from_rgba8(20, 60, 150, 255)
}

/// A landmark's name; in brackets where the program placed it.
fn name_on(landmark: &PlacedLandmark, pose: usize) -> String {
    if landmark.given.get(pose).copied().unwrap_or(false) {
        landmark.name.clone()
    } else {
        format!("({})", landmark.name)
    }
}

struct Pen<'a> {
    canvas: &'a mut Canvas,
    labels: &'a mut Labels,
}

impl Pen<'_> {
    fn label(&mut self, words: &str, place: Point, wanted: Point, colour: Color, need: Need) {
        let size = Canvas::text_size(words, NUMBER_PX) + Point::from(MARGIN_PX);
        let Some(placed) = self.labels.place(place, size, wanted, need) else {
            return;
        };
        if placed.distance > LEADER_PX {
            let nearest = place.sup(&placed.area.low).inf(&placed.area.high);
            let grey = Color::from_rgba8(130, 130, 130, 255);
            self.canvas.line(&[place, nearest], 0.8, grey);
        }
        self.canvas.text_around(words, placed.area.middle(), NUMBER_PX, colour);
    }
}
