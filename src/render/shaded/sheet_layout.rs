//! Where everything stands on a contact sheet.

use crate::math::Point;

/// The free border around everything, in pixels.
const BORDER_PX: f64 = 30.0;
/// The height of title and legend together, in pixels.
const HEAD_PX: f64 = 66.0;
/// The room for what is written beside the rows and below the columns, in pixels.
const BESIDE_PX: f64 = 84.0;
const BELOW_PX: f64 = 70.0;
/// The space between two cards, in pixels.
const GAP_PX: f64 = 10.0;
/// The room in a card below its form for words, in pixels.
pub(super) const CAPTION_PX: f64 = 26.0;
/// The side of a square card's picture, in pixels, as long as all of them together stay within [`ALL_PX`].
const CARD_PX: f64 = 216.0;
const ALL_PX: f64 = 3000.0;
/// The least side of a picture, in pixels.
const LEAST_PX: f64 = 24.0;
/// How much wider or higher than square a card may be.
const SLIMMEST: f64 = 1.9;

/// The places of all parts, in pixels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    pub(super) size: [u32; 2],
    /// Columns and rows of a card's picture.
    pub(super) picture: [usize; 2],
    columns: usize,
    rows: usize,
    beside: f64,
}

impl Layout {
    /// Cards for forms whose box in the view is `extent` wide and high. `has_rows` tells whether something is written beside the
    /// rows; `within` is a size that the sheet should fill.
    pub(super) fn new(columns: usize, rows: usize, has_rows: bool, extent: [f64; 2], within: Option<[u32; 2]>) -> Self {
        let ratio = (extent[0] / extent[1]).clamp(1.0 / SLIMMEST, SLIMMEST);
        let ratio = if ratio.is_finite() { ratio } else { 1.0 };
        let beside = if has_rows { BESIDE_PX } else { 0.0 };
        let mut layout = Self {
            size: [0, 0],
            picture: [0, 0],
            columns,
            rows,
            beside,
        };
        let side = CARD_PX.min(ALL_PX / columns.max(rows) as f64);
        let (mut width, mut height) = (side * ratio.sqrt(), side / ratio.sqrt());
        if let Some([wide, high]) = within {
            let spaces = layout.without_pictures();
            let room = |all: u32, spaces: f64, count: usize| (f64::from(all) - spaces) / count as f64;
            width = room(wide, spaces[0], columns);
            height = room(high, spaces[1], rows);
        }
        layout.picture = [width, height].map(|side| side.floor().max(LEAST_PX) as usize);
        let spaces = layout.without_pictures();
        let least = [
            spaces[0] + (columns * layout.picture[0]) as f64,
            spaces[1] + (rows * layout.picture[1]) as f64,
        ];
        layout.size = [0, 1].map(|k| (least[k] as u32).max(within.map_or(0, |size| size[k])));
        layout
    }

    fn without_pictures(&self) -> [f64; 2] {
        [
            2.0 * BORDER_PX + self.beside + GAP_PX * (self.columns - 1) as f64,
            2.0 * BORDER_PX + HEAD_PX + BELOW_PX + GAP_PX * (self.rows - 1) as f64 + CAPTION_PX * self.rows as f64,
        ]
    }

    /// The upper left and lower right corner of a card; row 0 is at the bottom.
    pub(super) fn card(&self, column: usize, row: usize) -> [Point; 2] {
        let (width, height) = (self.picture[0] as f64, self.picture[1] as f64 + CAPTION_PX);
        let from_top = self.rows - 1 - row;
        let corner = Point::new(
            BORDER_PX + self.beside + column as f64 * (width + GAP_PX),
            BORDER_PX + HEAD_PX + from_top as f64 * (height + GAP_PX),
        );
        [corner, corner + Point::new(width, height)]
    }

    /// The upper left corner of the title.
    pub(super) fn title(&self) -> [f64; 2] {
        [BORDER_PX, BORDER_PX - 2.0]
    }

    /// The upper left corner of the line below the title.
    pub(super) fn subtitle(&self) -> [f64; 2] {
        [BORDER_PX, BORDER_PX + 28.0]
    }

    /// The right end and the middle of the legend's line.
    pub(super) fn legend(&self) -> Point {
        Point::new(self.card(self.columns - 1, 0)[1].x, BORDER_PX + 8.0)
    }

    /// The middle of the words below a column.
    pub(super) fn below(&self, column: usize) -> Point {
        let [low, high] = self.card(column, 0);
        Point::new(0.5 * (low.x + high.x), high.y + 18.0)
    }

    /// The right end of the words beside a row.
    pub(super) fn beside(&self, row: usize) -> Point {
        let [low, high] = self.card(0, row);
        Point::new(low.x - 14.0, 0.5 * (low.y + high.y))
    }

    /// Both ends of the arrow below the columns.
    pub(super) fn arrow_below(&self) -> [Point; 2] {
        let ([low, _], [_, high]) = (self.card(0, 0), self.card(self.columns - 1, 0));
        [Point::new(low.x, high.y + 50.0), Point::new(high.x, high.y + 50.0)]
    }

    /// Both ends of the arrow beside the rows.
    pub(super) fn arrow_beside(&self) -> [Point; 2] {
        let ([_, low], [high, _]) = (self.card(0, 0), self.card(0, self.rows - 1));
        [Point::new(BORDER_PX + 8.0, low.y), Point::new(BORDER_PX + 8.0, high.y)]
    }
}
