//! A mapping and its pose space in one picture, for the artist who wants to know what happened and where a landmark would
//! help.
//!
//! 1. The outlines, coloured by how unlike they are to the reference's in each section between two numbered links; salient
//!    points as circles, the larger the more smoothing they survive; landmarks and lines with their names. Doubtful
//!    sections lie on a broad band and are labelled ([`Sections`]).
//! 2. The meshes: one triangulation, drawn on every pose; places that correspond have one colour, a chequered wheel about the reference's
//!    middle; the triangles with the smallest angles in a pose are marked.
//! 3. The pose space: each place has the mean of the poses' colours by their weights, with lines where another
//!    pose becomes the heaviest; dots are the poses, the line is the animation's path. Beside it the legend.

pub(super) mod canvas;
mod labels;
mod layout;
mod legend;
mod meshes;
mod outlines;
mod pose_space;
mod sections;
mod stroke_font;

#[cfg(test)]
mod tests;

use canvas::Canvas;
use layout::Layout;
use tiny_skia::Color;

pub use sections::{Link, Sections};

use super::{Frame, PictureError};
use crate::matching::MatchReport;
use crate::pose::{Mapping, PlacedLandmark};

/// The side of the pose space's square, in pixels.
const SPACE_PX: f64 = 520.0;
/// The width of the legend, in pixels.
const LEGEND_PX: f64 = 560.0;
/// The free border around everything, in pixels.
const BORDER_PX: f64 = 20.0;
/// The height of a line of text, in pixels.
const TEXT_PX: f64 = 15.0;
/// The mismatch of a section that has the last colour of the scale.
const MOST_COST: f64 = 3.0 * Sections::DOUBTFUL_COST;
/// The colour of words and marks.
const INK: Color = Color::BLACK;

/// What the picture says about a pose beside its mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramPose {
    /// Its name.
    pub name: String,
    /// Its place in the pose space; the first two coordinates are drawn.
    pub at: Vec<f64>,
}

/// What the picture shows.
#[derive(Debug, Clone, Copy)]
pub struct Diagram<'a> {
    /// The mapping.
    pub mapping: &'a Mapping,
    /// How its outer rings were matched.
    pub matching: &'a MatchReport,
    /// The landmarks, each with a place on every pose.
    pub landmarks: &'a [PlacedLandmark],
    /// One entry a pose.
    pub poses: &'a [DiagramPose],
    /// The animation's path through the pose space.
    pub path: &'a [Vec<f64>],
}

/// Draws the picture; `weights` gives the weights at a place of the pose space.
///
/// # Errors
/// [`PictureError`] if there is no pose, the parts do not fit one another, or there are so many poses that no picture holds
/// them.
pub fn draw(
    diagram: &Diagram,
    sections: &Sections,
    weights: impl Fn(&[f64]) -> Option<Vec<f64>>,
) -> Result<Frame, PictureError> {
    let count = diagram.mapping.poses.len();
    let fits = diagram.poses.len() == count
        && diagram.mapping.outlines.len() == count
        && sections.links().iter().all(|link| link.at.len() == count)
        && diagram.landmarks.iter().all(|landmark| landmark.at.len() == count);
    if count == 0 || !fits {
        return Err(PictureError::Mismatched { poses: count });
    }
    let layout = Layout::new(diagram.mapping, legend::height(count));
    let [width, height] = layout.size;
    let mut canvas = Canvas::new(width, height).ok_or(PictureError::TooManyPoses { poses: count })?;
    let headings = [
        "OUTLINES: EQUAL NUMBERS CORRESPOND",
        "INSIDE: EQUAL COLOURS CORRESPOND, ONE TRIANGULATION",
        "POSE SPACE: WHOSE WEIGHTS COUNT WHERE",
    ];
    for (words, corner) in headings.into_iter().zip(layout.headings) {
        canvas.text(words, corner, TEXT_PX, Color::from_rgba8(110, 110, 110, 255));
    }
    outlines::draw(&mut canvas, diagram, sections, &layout.outlines, layout.columns);
    meshes::draw(&mut canvas, diagram, &layout.meshes);
    for cells in [&layout.outlines, &layout.meshes] {
        for (pose, (said, cell)) in diagram.poses.iter().zip(cells).enumerate() {
            canvas.text(&said.name, cell.head(), TEXT_PX, pose_colour(pose, count));
        }
    }
    pose_space::draw(&mut canvas, diagram.poses, diagram.path, &weights, layout.space);
    legend::draw(&mut canvas, diagram, sections, layout.legend);
    Ok(canvas.into_frame())
}

/// The colour of a section by its mean mismatch: a calm blue where the outlines are alike, over orange to red.
fn cost_colour(cost: f64) -> Color {
    const STOPS: [[f64; 3]; 4] = [
        [0.35, 0.55, 0.78],
        [0.62, 0.66, 0.55],
        [0.95, 0.6, 0.1],
        [0.82, 0.0, 0.12],
    ];
    let along = (cost / MOST_COST).clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let stop = (along as usize).min(STOPS.len() - 2);
    let share = along - stop as f64;
    let channel = |k: usize| (STOPS[stop][k] + share * (STOPS[stop + 1][k] - STOPS[stop][k])) as f32;
    Color::from_rgba(channel(0), channel(1), channel(2), 1.0).unwrap_or(Color::BLACK)
}

/// Half the side of a landmark's square, in pixels: less if there are many.
fn mark_size(diagram: &Diagram) -> f64 {
    const MANY: usize = 40;
    if diagram.landmarks.len() > MANY { 2.0 } else { 4.0 }
}

/// The colour of triangles with small angles.
fn worst_colour() -> Color {
    Color::from_rgba8(215, 0, 40, 255)
}

fn faint(mut colour: Color) -> Color {
    colour.set_alpha(0.4);
    colour
}

/// A clear colour for a pose: hues spread evenly, dark ones and light ones in turn.
fn pose_colour(pose: usize, count: usize) -> Color {
    let light = if pose.is_multiple_of(2) { 0.48 } else { 0.60 };
    hue(pose as f64 / count.max(1) as f64, light)
}

/// A saturated colour of a hue in turns.
fn hue(turns: f64, lightness: f64) -> Color {
    let channel = |shift: f64| {
        let wave = 0.5 + 0.5 * (std::f64::consts::TAU * (turns - shift)).cos();
        (lightness * (0.35 + 1.15 * wave)).clamp(0.0, 1.0) as f32
    };
    Color::from_rgba(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0), 1.0).unwrap_or(Color::BLACK)
}
