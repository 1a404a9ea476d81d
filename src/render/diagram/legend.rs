//! What the marks mean, and the worst of every pose in words.

use tiny_skia::Color;

use super::canvas::Canvas;
use super::{Diagram, INK, LEGEND_PX, MOST_COST, Sections, TEXT_PX, cost_colour, hue, pose_colour, worst_colour};
use crate::math::Point;

/// The height of a line of the legend, in pixels.
const LINE_PX: f64 = 24.0;
/// The size of the bar that shows the colours of costs, in pixels.
const BAR_PX: [f64; 2] = [360.0, 14.0];
/// Lines of explanation above the list of poses, bar and gaps counted in.
const LINES: usize = 9;
/// Letters of a pose's name in the list.
const NAME_LETTERS: usize = 18;

/// Poses in the list.
const LISTED: usize = 24;

/// How high the legend is for some number of poses.
pub(super) fn height(poses: usize) -> f64 {
    (LINES + poses.min(LISTED)) as f64 * LINE_PX
}

pub(super) fn draw(canvas: &mut Canvas, diagram: &Diagram, sections: &Sections, [left, top]: [f64; 2]) {
    let line = |k: f64| top + k * LINE_PX;
    let small = 0.9 * TEXT_PX;
    canvas.text(
        "HOW UNLIKE THE OUTLINES ARE BETWEEN TWO LINKS",
        [left, line(0.0)],
        small,
        INK,
    );
    let steps = BAR_PX[0] as usize / 2;
    for step in 0..steps {
        let x = left + 2.0 * step as f64;
        let colour = cost_colour(MOST_COST * step as f64 / steps as f64);
        let [y0, y1] = [line(1.0), line(1.0) + BAR_PX[1]];
        let corners = [[x, y0], [x + 2.0, y0], [x + 2.0, y1], [x, y1]].map(Point::from);
        canvas.fill(&corners, colour);
    }
    for (share, word) in [
        (0.0, "ALIKE"),
        (Sections::DOUBTFUL_COST / MOST_COST, "DOUBTFUL: A LANDMARK MAY HELP"),
    ] {
        let x = left + share * BAR_PX[0];
        canvas.line(
            &[Point::new(x, line(1.0)), Point::new(x, line(1.0) + BAR_PX[1] + 4.0)],
            1.2,
            INK,
        );
        canvas.text(word, [x, line(2.0) - 2.0], small, INK);
    }
    let marks = [
        "LINK: EQUAL NUMBERS CORRESPOND",
        "LANDMARK; (IN BRACKETS) WHERE THE PROGRAM PUT IT",
        "TIP OR NOTCH, THE LARGER THE MORE IT STANDS OUT",
        "TRIANGLES WITH THE SMALLEST ANGLES",
    ];
    for (k, words) in marks.into_iter().enumerate() {
        let place = Point::new(left + 9.0, line(3.5 + k as f64) + 5.0);
        match k {
            0 => canvas.dot(place, 3.6, hue(0.55, 0.5)),
            1 => canvas.square(place, 4.5, INK),
            2 => canvas.circle(place, 7.0, 1.1, Color::from_rgba8(90, 90, 90, 255)),
            _ => {
                let corners = [[-8.0, 4.0], [8.0, 4.0], [7.0, -5.0]].map(|d| place + Point::from(d));
                canvas.fill(&corners, worst_colour());
            }
        }
        canvas.text(words, [left + 26.0, line(3.5 + k as f64)], small, INK);
    }
    for (pose, said) in diagram.poses.iter().enumerate().take(LISTED) {
        let y = line(LINES as f64 - 0.75 + pose as f64);
        let name: String = said.name.chars().take(NAME_LETTERS).collect();
        canvas.text(&name, [left, y], small, pose_colour(pose, diagram.poses.len()));
        let words = if diagram.poses.len() > 1 {
            in_words(sections, pose)
        } else {
            String::new()
        };
        let width = Canvas::text_size(&words, small).x;
        canvas.text(&words, [left + LEGEND_PX - width, y], small, INK);
    }
}

/// The worst section of a pose.
fn in_words(sections: &Sections, pose: usize) -> String {
    if pose == sections.reference() {
        return "ALL OTHERS WERE MATCHED TO THIS".to_owned();
    }
    match sections.worst(pose) {
        Some(k) => {
            let (from, to) = sections.numbers(k);
            format!("LEAST ALIKE FROM {from} TO {to}: {:.1}", sections.costs(pose)[k])
        }
        None => String::new(),
    }
}
