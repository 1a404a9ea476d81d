//! A space of forms in one picture: two adjectives along the sides, a form for each pair of their values, as in figures 4, 5 and 9
//! of SBE.
//!
//! All forms are drawn at one scale and in one place of their cards, so that what differs is the shape. Examples are dark,
//! pseudo-examples grainy, blends lighter, and what lies beyond the examples lightest, on the bare sheet.

use tiny_skia::Color;

use super::light::{Look, Surface};
use super::sheet_layout::{CAPTION_PX, Layout};
use super::view::{View, Window};
use super::{Frame, ShadedForm, ShadedMesh, shade};
use crate::math::Point;
use crate::render::PictureError;
use crate::render::diagram::canvas::Canvas;
use rayon::prelude::*;

/// Heights of lines of text, in pixels.
const TITLE_PX: f64 = 21.0;
const AXIS_PX: f64 = 15.0;
const VALUE_PX: f64 = 14.0;
const CAPTION_TEXT_PX: f64 = 12.5;
/// The radius of a card's corners, in pixels.
const ROUND_PX: f64 = 7.0;
/// The radius of marks, in pixels.
const MARK_PX: f64 = 4.0;

/// What a form on the sheet is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CellKind {
    /// An example.
    Example,
    /// A blend that was placed here.
    PseudoExample,
    /// A blend among the examples.
    Between,
    /// A blend beyond the examples.
    Beyond,
}

impl CellKind {
    const ALL: [Self; 4] = [Self::Example, Self::PseudoExample, Self::Between, Self::Beyond];

    /// What a form of this kind is made of.
    #[must_use]
    pub(crate) fn look(self) -> Look {
        let (colour, surface) = match self {
            Self::Example => ([170, 92, 64], Surface::Even),
            Self::PseudoExample => ([194, 130, 100], Surface::Grainy),
            Self::Between => ([214, 170, 146], Surface::Even),
            Self::Beyond => ([206, 192, 182], Surface::Even),
        };
        Look { colour, surface }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Example => "EXAMPLE",
            Self::PseudoExample => "PSEUDO-EXAMPLE",
            Self::Between => "BETWEEN",
            Self::Beyond => "BEYOND",
        }
    }

    /// The colours of its card and of the card's edge.
    fn card(self) -> Option<(Color, Color)> {
        match self {
            Self::Example => Some((
                Color::from_rgba8(253, 252, 250, 255),
                Color::from_rgba8(158, 84, 58, 255),
            )),
            Self::PseudoExample => Some((
                Color::from_rgba8(250, 248, 245, 255),
                Color::from_rgba8(196, 150, 126, 255),
            )),
            Self::Between => Some((
                Color::from_rgba8(247, 245, 241, 255),
                Color::from_rgba8(228, 223, 215, 255),
            )),
            Self::Beyond => None,
        }
    }
}

/// A side of the sheet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SheetAxis {
    /// The adjective.
    pub name: String,
    /// Its values, from the left or from the bottom.
    pub values: Vec<f64>,
}

/// One form on the sheet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SheetCell<'a> {
    /// The form.
    pub form: ShadedForm<'a>,
    /// What it is.
    pub kind: CellKind,
    /// The words below it.
    pub caption: &'a str,
}

/// The whole sheet.
#[derive(Debug, Clone)]
pub(crate) struct Sheet<'a> {
    /// What it is of.
    pub title: &'a str,
    /// What holds for all forms.
    pub subtitle: &'a str,
    /// To the right.
    pub across: SheetAxis,
    /// Upwards, if there are rows.
    pub up: Option<SheetAxis>,
    /// What the forms share.
    pub mesh: ShadedMesh<'a>,
    /// The forms, row by row from the bottom, each from the left: #rows x #columns.
    pub cells: Vec<SheetCell<'a>>,
    /// From where they are looked at.
    pub view: View,
    /// Columns and rows of the picture, if it must have so many; it is not made smaller than what stands on it.
    pub size: Option<[u32; 2]>,
}

impl Sheet<'_> {
    /// Draws it.
    ///
    /// # Errors
    /// [`PictureError`] if there is not one form for each pair of values, or no picture is large enough.
    pub(crate) fn draw(&self) -> Result<Frame, PictureError> {
        let columns = self.across.values.len();
        let rows = self.up.as_ref().map_or(1, |up| up.values.len());
        if columns == 0 || rows == 0 || self.cells.len() != columns * rows {
            return Err(PictureError::FormCount {
                forms: self.cells.len(),
                columns,
                rows,
            });
        }
        let points = self.cells.iter().flat_map(|cell| cell.form.positions);
        let bounds = self.view.bounds(points).ok_or(PictureError::NotFinite)?;
        let extent = bounds[1] - bounds[0];
        let layout = Layout::new(columns, rows, self.up.is_some(), [extent.x, extent.y], self.size);
        let [width, height] = layout.size;
        let too_many = PictureError::TooManyForms {
            forms: self.cells.len(),
        };
        let mut canvas = Canvas::new(width, height).ok_or(too_many)?;
        canvas.fill(
            &rectangle(Point::zeros(), Point::new(width.into(), height.into()), 0.0),
            paper(),
        );
        self.write(&mut canvas, &layout);
        let window = Window::around(bounds, layout.picture);
        let pictures: Vec<Frame> = (self.cells.par_iter())
            .map(|cell| shade(&self.mesh, &cell.form, &self.view, &window, &cell.kind.look()))
            .collect();
        for (k, (cell, picture)) in self.cells.iter().zip(&pictures).enumerate() {
            let [low, high] = layout.card(k % columns, k / columns);
            if let Some((fill, edge)) = cell.kind.card() {
                canvas.fill(&rectangle(low, high, ROUND_PX), edge);
                let inner = Point::repeat(1.0);
                canvas.fill(&rectangle(low + inner, high - inner, ROUND_PX - 1.0), fill);
            }
            canvas.paste(picture, [low.x as usize, low.y as usize]);
            let middle = Point::new(0.5 * (low.x + high.x), high.y - 0.5 * CAPTION_PX - 1.0);
            let caption = fitting(&cell.caption.replace('_', " "), high.x - low.x - 16.0, CAPTION_TEXT_PX);
            canvas.words_around(&caption, middle, CAPTION_TEXT_PX, ink());
        }
        Ok(canvas.into_frame())
    }

    /// Everything but the cards.
    fn write(&self, canvas: &mut Canvas, layout: &Layout) {
        canvas.words(self.title, layout.title(), TITLE_PX, ink());
        canvas.words(self.subtitle, layout.subtitle(), VALUE_PX, faint_ink());
        self.write_legend(canvas, layout);
        for (column, value) in self.across.values.iter().enumerate() {
            canvas.words_around(&number(*value), layout.below(column), VALUE_PX, ink());
        }
        let [from, to] = layout.arrow_below();
        arrow(canvas, from, to, &self.across.name);
        let Some(up) = &self.up else { return };
        for (row, value) in up.values.iter().enumerate() {
            let words = number(*value);
            let right = layout.beside(row);
            let size = Canvas::text_size(&words, VALUE_PX);
            canvas.words(&words, [right.x - size.x, right.y - 0.5 * size.y], VALUE_PX, ink());
        }
        let [from, to] = layout.arrow_beside();
        arrow(canvas, from, to, &up.name);
    }

    fn write_legend(&self, canvas: &mut Canvas, layout: &Layout) {
        let mut right = layout.legend();
        for kind in CellKind::ALL.into_iter().rev() {
            if !self.cells.iter().any(|cell| cell.kind == kind) {
                continue;
            }
            let size = Canvas::text_size(kind.words(), CAPTION_TEXT_PX);
            canvas.words(
                kind.words(),
                [right.x - size.x, right.y - 0.5 * size.y],
                CAPTION_TEXT_PX,
                faint_ink(),
            );
            let [r, g, b] = kind.look().colour;
            let mark = Point::new(right.x - size.x - 12.0, right.y);
            canvas.dot(mark, MARK_PX + 0.5, Color::from_rgba8(r, g, b, 255));
            right.x -= size.x + 40.0;
        }
    }
}

/// An arrow with words in its middle, along it.
fn arrow(canvas: &mut Canvas, from: Point, to: Point, words: &str) {
    const HEAD_PX: f64 = 6.0;
    let length = (to - from).norm();
    let along = (to - from) / length;
    let across = Point::new(-along.y, along.x);
    let words = fitting(words, length - 60.0, AXIS_PX);
    let size = Canvas::text_size(&words, AXIS_PX);
    let middle = 0.5 * (from + to);
    let gap = if words.is_empty() { 0.0 } else { 0.5 * size.x + 14.0 };
    canvas.line(&[from, middle - along * gap], 1.2, rule());
    canvas.line(&[middle + along * gap, to], 1.2, rule());
    let back = to - along * HEAD_PX;
    canvas.line(
        &[back + across * (0.6 * HEAD_PX), to, back - across * (0.6 * HEAD_PX)],
        1.2,
        rule(),
    );
    canvas.words_along(&words, middle, along, AXIS_PX, ink());
}

/// Words that are cut where they would be wider than allowed.
fn fitting(words: &str, width: f64, height: f64) -> String {
    if Canvas::text_size(words, height).x <= width {
        return words.to_owned();
    }
    let mut letters: Vec<char> = words.chars().collect();
    while let Some(_last) = letters.pop() {
        let cut: String = letters.iter().collect::<String>().trim_end().to_owned() + "..";
        if Canvas::text_size(&cut, height).x <= width {
            return cut;
        }
    }
    String::new()
}

/// A number in as few digits as tell neighbouring values apart.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn rectangle(low: Point, high: Point, round: f64) -> Vec<Point> {
    const STEPS: usize = 6;
    let corners = [
        (Point::new(high.x - round, low.y + round), -0.25),
        (Point::new(high.x - round, high.y - round), 0.0),
        (Point::new(low.x + round, high.y - round), 0.25),
        (Point::new(low.x + round, low.y + round), 0.5),
    ];
    let corner = |(middle, turns): (Point, f64)| {
        (0..=STEPS).map(move |k| {
            let angle = std::f64::consts::TAU * (turns + 0.25 * k as f64 / STEPS as f64);
            let (sin, cos) = libm::sincos(angle);
            middle + Point::new(cos, sin) * round
        })
    };
    corners.into_iter().flat_map(corner).collect()
}

fn paper() -> Color {
    Color::from_rgba8(238, 235, 230, 255)
}

fn ink() -> Color {
    Color::from_rgba8(58, 52, 48, 255)
}

fn faint_ink() -> Color {
    Color::from_rgba8(122, 114, 107, 255)
}

fn rule() -> Color {
    Color::from_rgba8(168, 160, 151, 255)
}
