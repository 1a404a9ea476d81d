//! What of a bitmap is the figure.
//!
//! [`FigureRule`] is what the artist asks for, [`FigureKind`] what was taken. By itself the choice goes by evidence:
//!
//! 1. *Cut-out*: alpha varies, and what is opaque is not a sheet. A sheet lies along most of all four borders, as a screenshot with
//!    round corners does, or a picture of which one pixel is not quite opaque.
//! 2. *Painted*: on a background that a smooth field explains (module `paper`).
//! 3. *Lines*: what is drawn, on paper or on nothing, is thin, and most of what it encloses is bare.
//!
//! A picture whose border no smooth field explains is refused: neither is it cut out, nor is its background plain.

/// How the figure is told from what it is drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FigureRule {
    /// By evidence.
    #[default]
    Auto,
    /// The alpha channel says it.
    Alpha,
    /// By the difference from a plain or slowly varying background.
    Background,
    /// All that lines enclose, seen from outside.
    Lines,
}

impl FigureRule {
    /// What each is called in scene files.
    pub const NAMED: [(&'static str, Self); 4] = [
        ("auto", Self::Auto),
        ("alpha", Self::Alpha),
        ("background", Self::Background),
        ("lines", Self::Lines),
    ];
}

/// What becomes of the paper inside a figure of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PaperRule {
    /// It belongs to the figure.
    #[default]
    Keep,
    /// It becomes transparent; the outline is the same.
    Clear,
}

impl PaperRule {
    /// What each is called in scene files.
    pub const NAMED: [(&'static str, Self); 2] = [("keep", Self::Keep), ("clear", Self::Clear)];
}

/// What was taken for the figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureKind {
    /// What is opaque.
    CutOut,
    /// What differs from its background.
    Painted,
    /// What lines enclose.
    Lines,
}

/// The widest that lines are on average, as a fraction of the figure's diagonal: beyond, they are areas of paint. Brush lines of
/// an inch on a letter page are below it, bold letters above.
const WIDEST_LINE: f64 = 0.05;
/// The least share of what lines enclose that is bare, in a line drawing.
const LEAST_BARE: f64 = 0.4;
/// Share of each border along which a sheet lies at least: corners may be round.
const SHEET_BORDER: f64 = 0.8;

/// Whether lines of a mean width that enclose an area, of which a share is bare, are a line drawing; lengths in one unit.
pub(super) fn is_line_drawing(line_width: f64, diagonal: f64, bare_share: f64) -> bool {
    line_width <= WIDEST_LINE * diagonal && bare_share >= LEAST_BARE
}

/// Along how many borders of a mask, #rows x `width`, the mask lies over at least the given share.
pub(super) fn borders_covered(mask: &[bool], width: usize, share: f64) -> usize {
    let height = mask.len() / width.max(1);
    if width == 0 || height == 0 {
        return 0;
    }
    let count = |indices: &mut dyn Iterator<Item = usize>| indices.filter(|&k| mask[k]).count() as f64;
    let rows = [0, height - 1].map(|row| count(&mut (row * width..(row + 1) * width)) / width as f64);
    let columns = [0, width - 1].map(|column| count(&mut (0..height).map(|row| row * width + column)) / height as f64);
    let least = share.max(f64::MIN_POSITIVE);
    rows.into_iter()
        .chain(columns)
        .filter(|covered| *covered >= least)
        .count()
}

/// Whether an opaque region is a sheet.
pub(super) fn is_sheet(mask: &[bool], width: usize) -> bool {
    borders_covered(mask, width, SHEET_BORDER) == 4
}
