//! SVG: the outline of what is drawn, and its pixels.
//!
//! Bytes of an SVG file -> [`Drawing`].
//!
//! 1. Refuse what is compressed, too long, in another encoding than UTF-8 (module `svg_text`, which also replaces CSS variables), or
//!    holds numbers beyond any drawing (module `svg_numbers`).
//! 2. Parse with usvg: groups, transforms, `use`, CSS, shapes and strokes come out as paths. Nothing outside the file is
//!    ever opened, whatever it refers to; embedded images and text are not drawn and are reported.
//! 3. Unite what is drawn, in the element that is asked for or in all (module `svg_silhouette`).
//! 4. Rasterise around that outline with resvg: the whole drawing, since an element names a shape, not what is painted on it,
//!    or the element alone where the options say so ([`Extent`]).
//! 5. Read the same elements as curves (module `svg_art`).
//! 6. If the outline covers the page, what is drawn first is a background, whatever kind of element it is: elements are left out from
//!    the back until the outline no longer covers the page. If nothing is left, the drawing is taken as it is. Both are told.
//!
//! Coordinates are the user units of the file's `viewBox`, at usvg's single precision (1e-7 of their size).

use std::path::Path;

use kurbo::Affine;
use resvg::tiny_skia::{Pixmap, Transform};
use usvg::roxmltree;

use super::art_parts::DividedArt;
use super::svg_art::read_art;
use super::svg_effects::are_cut;
use super::svg_numbers::check_numbers;
use super::svg_silhouette::{Pieces, affine, silhouette};
use super::{Art, Canvas, Drawing, Extent, InputError, InputNote, LoosePart, Picture, SvgOptions, svg_text};
use crate::math::{Point, point};
use crate::outline::Outline;

/// How far a sheet may be from the borders of the page, as a fraction of its width and height together.
const PAGE_SLACK: f64 = 0.002;

/// Share of the page that a sheet covers at least: its corners may be round.
const LEAST_SHEET: f64 = 0.97;

/// The most elements that a background is made of.
const MOST_BACKGROUND: usize = 8;

/// The longest file that is read, in bytes.
const LONGEST_FILE: usize = 64 << 20;

/// The longer side of the picture, in pixels, when no resolution is asked for.
const USUAL_SIDE: f64 = 1024.0;

/// The longest side of the picture, in pixels: a finer resolution is made coarser.
const LARGEST_SIDE: f64 = 8192.0;

/// Pixels around the outline.
const MARGIN_PX: f64 = 2.0;

/// Reads the drawing in the file at `path`; see [`read_svg`].
///
/// # Errors
/// [`InputError::Unreadable`] with the path if it cannot be read, else as [`read_svg`].
pub fn open_svg(path: &Path, options: &SvgOptions) -> Result<Drawing, InputError> {
    let bytes = std::fs::read(path).map_err(|source| InputError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    read_svg(&bytes, options)
}

/// The drawing in the bytes of an SVG file: the outline of its largest part, and its pixels.
///
/// # Errors
/// [`InputError`] if the bytes are no SVG, hold numbers that are not finite or too large, have no element with the id
/// asked for, or draw no closed shape.
pub fn read_svg(bytes: &[u8], options: &SvgOptions) -> Result<Drawing, InputError> {
    if bytes.is_empty() {
        return Err(InputError::EmptyFile);
    }
    if let Some(pixels_per_unit) = options.pixels_per_unit.filter(|&ppu| !(ppu > 0.0 && ppu.is_finite())) {
        return Err(InputError::BadResolution { pixels_per_unit });
    }
    // A few kilobytes of gzip can hold gigabytes.
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(not_svg("it is compressed; save it as plain SVG"));
    }
    if bytes.len() > LONGEST_FILE {
        return Err(not_svg("it is longer than 64 MiB"));
    }
    let text = svg_text::decode(bytes).map_err(|reason| not_svg(&reason))?;
    let (text, missing) = svg_text::with_variables(text);
    let mut drawing = Source::new(&text)?.read(options)?;
    if options.element.is_none() && page_use(&drawing) == PageUse::Whole {
        drawing.drawing.notes.push(InputNote::FillsCanvas);
        if let Some(figure) = without_background(&text, options)? {
            drawing = figure;
        }
    }
    let mut drawing = drawing.drawing;
    if !missing.is_empty() {
        drawing.notes.push(InputNote::VariablesUnknown { names: missing });
    }
    Ok(drawing)
}

/// How large the page of the SVG file in `bytes` is, in pixels: width and height as a browser shows it.
///
/// # Errors
/// [`InputError`] if the bytes are no SVG.
pub fn svg_page_px(bytes: &[u8]) -> Result<Point, InputError> {
    let text = svg_text::decode(bytes).map_err(|reason| not_svg(&reason))?;
    let (text, _) = svg_text::with_variables(text);
    let size = Source::new(&text)?.tree.size();
    Ok(Point::new(f64::from(size.width()), f64::from(size.height())))
}

/// All that is drawn on the page of the SVG file in `bytes`, as large as the pictures of drawings are; nothing is taken out.
///
/// # Errors
/// [`InputError`] if the bytes are no SVG.
pub fn read_svg_page(bytes: &[u8]) -> Result<Picture, InputError> {
    let text = svg_text::decode(bytes).map_err(|reason| not_svg(&reason))?;
    let (text, _) = svg_text::with_variables(text);
    let Source { document, tree } = Source::new(&text)?;
    let to_user = user_units(&document, &tree);
    let (width, height) = (f64::from(tree.size().width()), f64::from(tree.size().height()));
    let page = to_user.transform_rect_bbox(kurbo::Rect::new(0.0, 0.0, width, height));
    let corners = (Point::new(page.x0, page.y0), Point::new(page.x1, page.y1));
    let drawn: Vec<&usvg::Node> = tree.root().children().iter().collect();
    rasterise(&drawn, to_user, Some(corners), None)
}

/// A drawing with the page that it is on.
struct OnPage {
    drawing: Drawing,
    /// The page, in user units.
    page: kurbo::Rect,
}

/// How much of the page an outline takes up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum PageUse {
    /// It does not reach from one border to the opposite one.
    Within,
    /// It does, as ground and sky do.
    Across,
    /// It covers the page, as a sheet does.
    Whole,
}

fn page_use(on_page: &OnPage) -> PageUse {
    let page = on_page.page;
    let slack = PAGE_SLACK * (page.width() + page.height());
    let Some((low, high)) = point::bounding_box(on_page.drawing.outline.outer().points()) else {
        return PageUse::Within;
    };
    let is_wide = low.x <= page.x0 + slack && high.x >= page.x1 - slack;
    let is_high = low.y <= page.y0 + slack && high.y >= page.y1 - slack;
    if is_wide && is_high && on_page.drawing.outline.area() >= LEAST_SHEET * page.area() {
        PageUse::Whole
    } else if is_wide || is_high {
        PageUse::Across
    } else {
        PageUse::Within
    }
}

/// The drawing without what is drawn first, as far as that covers the page; `None` if nothing smaller than the page is left. If what is
/// left then reaches from border to border, more is left out as far as something is left that does not: sky, then ground.
fn without_background(text: &str, options: &SvgOptions) -> Result<Option<OnPage>, InputError> {
    let mut text = text.to_owned();
    let mut best: Option<(PageUse, OnPage)> = None;
    for _ in 0..MOST_BACKGROUND {
        let Some(first) = svg_text::first_drawn(&parse(&text)?) else {
            break;
        };
        text = svg_text::blanked(&text, first);
        let Ok(mut figure) = Source::new(&text)?.read(options) else {
            // Nothing but background.
            break;
        };
        let usage = page_use(&figure);
        if usage < best.as_ref().map_or(PageUse::Whole, |(least, _)| *least) {
            figure.drawing.notes.push(InputNote::BackgroundLeftOut);
            best = Some((usage, figure));
        }
        if usage == PageUse::Within {
            break;
        }
    }
    Ok(best.map(|(_, figure)| figure))
}

fn parse(text: &str) -> Result<roxmltree::Document<'_>, InputError> {
    let parsing = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..roxmltree::ParsingOptions::default()
    };
    roxmltree::Document::parse_with_options(text, parsing).map_err(|error| not_svg(&error))
}

/// A file that is parsed.
struct Source<'a> {
    document: roxmltree::Document<'a>,
    tree: usvg::Tree,
}

impl<'a> Source<'a> {
    fn new(text: &'a str) -> Result<Self, InputError> {
        let document = parse(text)?;
        if document.root_element().tag_name().name() != "svg" {
            return Err(not_svg("its root element is not 'svg'"));
        }
        check_numbers(&document)?;
        let tree = usvg::Tree::from_xmltree(&document, &closed_options()).map_err(|error| not_svg(&error))?;
        Ok(Self { document, tree })
    }

    fn read(&self, options: &SvgOptions) -> Result<OnPage, InputError> {
        let Self { document, tree } = self;
        let to_user = user_units(document, tree);
        let nodes: Vec<&usvg::Node> = match &options.element {
            Some(id) => vec![find(tree.root(), id).ok_or_else(|| missing(id, document))?],
            None => tree.root().children().iter().collect(),
        };
        let pieces = silhouette(&nodes, to_user, options.holes, &options.parts).map_err(|error| match error {
            InputError::NoClosedShape => nothing_but(document).unwrap_or(InputError::NoClosedShape),
            other => other,
        })?;
        let outline = pieces
            .outline(pieces.chosen.largest)
            .ok_or(InputError::NoClosedShape)?
            .clone();
        let mut notes = pieces.notes.clone();
        note_undrawn(document, &mut notes);
        // The element says whose outline is meant; the drawing is everything in the file, unless it is one layer of it.
        let drawn: Vec<&usvg::Node> = match options.extent {
            Extent::Everything => tree.root().children().iter().collect(),
            Extent::Element => nodes,
        };
        let bounds = match options.around {
            Some(bounds) => Some((bounds[0], bounds[1])),
            None => point::bounding_box(outline.outer().points()),
        };
        let picture = rasterise(&drawn, to_user, bounds, options.pixels_per_unit)?;
        let outlines: Vec<&Outline> = pieces.outlines.iter().map(|(_, outline)| outline).collect();
        if are_cut(&drawn, to_user, &outlines)? {
            notes.push(InputNote::SoftEdgeCut);
        }
        let art = read_art(&drawn, to_user, &mut notes)
            .map_err(|reason| notes.push(InputNote::NotCurves { reason }))
            .ok();
        let pixels_per_unit = picture.pixels_per_unit;
        let picture_of = |outline: &Outline| {
            let bounds = point::bounding_box(outline.outer().points());
            rasterise(&drawn, to_user, bounds, Some(pixels_per_unit))
        };
        let (art, parts) = divided(&pieces, art, picture_of, &mut notes)?;
        let size = tree.size();
        let page = kurbo::Rect::new(0.0, 0.0, f64::from(size.width()), f64::from(size.height()));
        let page = to_user.transform_rect_bbox(page);
        let [a, b, c, d, ..] = to_user.as_coeffs();
        Ok(OnPage {
            drawing: Drawing {
                outline,
                picture,
                art,
                notes,
                unit_px: (a * d - b * c).abs().sqrt().recip(),
                canvas: Canvas::of_page(page),
                parts,
            },
            page,
        })
    }
}

/// Why a file without closed shapes shows something nevertheless.
fn nothing_but(document: &roxmltree::Document) -> Option<InputError> {
    let has = |tag: &str| document.descendants().any(|node| node.tag_name().name() == tag);
    if has("text") {
        Some(InputError::OnlyText)
    } else if has("image") {
        Some(InputError::OnlyPictures)
    } else {
        None
    }
}

fn not_svg(reason: &(impl std::fmt::Display + ?Sized)) -> InputError {
    InputError::NotSvg {
        reason: reason.to_string(),
    }
}

/// Options under which nothing but the bytes given is ever read.
fn closed_options() -> usvg::Options<'static> {
    usvg::Options {
        resources_dir: None,
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..usvg::Options::default()
    }
}

fn find<'a>(group: &'a usvg::Group, id: &str) -> Option<&'a usvg::Node> {
    group.children().iter().find_map(|node| {
        if node.id() == id {
            return Some(node);
        }
        let usvg::Node::Group(inner) = node else {
            return None;
        };
        // The style of a path puts a group without a name around it.
        match inner.children() {
            [usvg::Node::Path(path)] if inner.id().is_empty() && path.id() == id => Some(node),
            _ => find(inner, id),
        }
    })
}

/// Tells an id that is nowhere from one of something that is not drawn.
fn missing(id: &str, document: &roxmltree::Document) -> InputError {
    let ids: Vec<&str> = document.descendants().filter_map(|node| node.attribute("id")).collect();
    if ids.contains(&id) {
        return InputError::NoClosedShape;
    }
    InputError::NoSuchElement {
        id: id.to_owned(),
        known: ids.into_iter().take(12).map(str::to_owned).collect(),
    }
}

fn note_undrawn(document: &roxmltree::Document, notes: &mut Vec<InputNote>) {
    for (tag, what) in [("text", "text"), ("image", "embedded images")] {
        let count = document
            .descendants()
            .filter(|node| node.tag_name().name() == tag)
            .count();
        if count > 0 {
            notes.push(InputNote::NotDrawn { what, count });
        }
    }
}

/// From usvg's absolute coordinates, which are pixels of the viewport, back to the units of the `viewBox`.
fn user_units(document: &roxmltree::Document, tree: &usvg::Tree) -> Affine {
    let root = document.root_element();
    let numbers: Vec<f64> = root
        .attribute("viewBox")
        .unwrap_or_default()
        .split(|c: char| c == ',' || c.is_whitespace())
        .filter(|part| !part.is_empty())
        .map_while(|part| part.parse().ok())
        .collect();
    let [x, y, width, height] = numbers[..] else {
        return Affine::IDENTITY;
    };
    if !(width > 0.0 && height > 0.0) {
        return Affine::IDENTITY;
    }
    let size = (f64::from(tree.size().width()), f64::from(tree.size().height()));
    let aspect = root.attribute("preserveAspectRatio").unwrap_or("xMidYMid meet");
    let (mut scale_x, mut scale_y) = (size.0 / width, size.1 / height);
    if !aspect.contains("none") {
        let uniform = if aspect.contains("slice") {
            scale_x.max(scale_y)
        } else {
            scale_x.min(scale_y)
        };
        (scale_x, scale_y) = (uniform, uniform);
    }
    let place = |room: f64, low: &str, high: &str| {
        if aspect.contains("none") || aspect.contains(low) {
            0.0
        } else if aspect.contains(high) {
            room
        } else {
            0.5 * room
        }
    };
    let left = place(size.0 - width * scale_x, "xMin", "xMax");
    let top = place(size.1 - height * scale_y, "YMin", "YMax");
    Affine::new([scale_x, 0.0, 0.0, scale_y, left - x * scale_x, top - y * scale_y]).inverse()
}

/// The drawing's curves without what is dropped of it, and its pieces with their curves and pixels, if there are several.
fn divided(
    pieces: &Pieces,
    art: Option<Art>,
    picture_of: impl Fn(&Outline) -> Result<Picture, InputError>,
    notes: &mut Vec<InputNote>,
) -> Result<(Option<Art>, Vec<LoosePart>), InputError> {
    let chosen = &pieces.chosen;
    if chosen.loose.is_empty() && chosen.dropped.is_empty() {
        return Ok((art, Vec::new()));
    }
    let outlines: Vec<Outline> = pieces.outlines.iter().map(|(_, outline)| outline.clone()).collect();
    let divided = match art.as_ref().map(|art| DividedArt::new(art, &outlines)) {
        Some(Ok(divided)) => Some(divided),
        Some(Err(reason)) => {
            notes.push(InputNote::NotCurves { reason });
            None
        }
        None => None,
    };
    let is_left = |place: usize| !chosen.dropped.contains(&pieces.outlines[place].0);
    let whole = divided.as_ref().map(|divided| divided.only(is_left));
    let wanted = |piece: usize| match piece == chosen.largest {
        true => Some(false),
        false => chosen
            .loose
            .iter()
            .find(|(own, _)| *own == piece)
            .map(|(_, is_kept)| *is_kept),
    };
    let mut parts: Vec<(usize, LoosePart)> = Vec::new();
    for (place, (piece, outline)) in pieces.outlines.iter().enumerate() {
        let Some(is_kept) = wanted(*piece).filter(|_| !chosen.loose.is_empty()) else {
            continue;
        };
        let order = divided.as_ref().map_or(0, |divided| divided.first_of(place));
        let picture = match *piece == chosen.largest {
            true => None,
            false => Some(picture_of(outline)?),
        };
        let part = LoosePart {
            outline: outline.clone(),
            area: outline.area(),
            picture,
            art: divided.as_ref().map(|divided| divided.only(|own| own == place)),
            is_kept,
        };
        parts.push((order, part));
    }
    // In the order in which they are painted; where that is not known, what is small over what is large.
    parts.sort_by(|(a, part), (b, other)| a.cmp(b).then(other.outline.area().total_cmp(&part.outline.area())));
    Ok((whole, parts.into_iter().map(|(_, part)| part).collect()))
}

/// The pixels of `nodes` between two corners.
pub(super) fn rasterise(
    nodes: &[&usvg::Node],
    to_user: Affine,
    bounds: Option<(Point, Point)>,
    asked: Option<f64>,
) -> Result<Picture, InputError> {
    let (low, high) = bounds.ok_or(InputError::NoClosedShape)?;
    let longer = (high - low).max();
    let finest = (LARGEST_SIDE - 2.0 * MARGIN_PX - 1.0) / longer;
    let pixels_per_unit = asked.unwrap_or(USUAL_SIDE / longer).min(finest);
    // Pixels keep to a grid through the origin, so that the same art gets the same pixels in every file.
    let first = (low * pixels_per_unit).map(|c| (c - MARGIN_PX).floor());
    let last = (high * pixels_per_unit).map(|c| (c + MARGIN_PX).ceil());
    let (width, height) = ((last.x - first.x) as u32, (last.y - first.y) as u32);
    let mut pixmap = Pixmap::new(width.max(1), height.max(1)).ok_or(InputError::NoClosedShape)?;
    let to_pixels = Affine::translate((-first.x, -first.y)) * Affine::scale(pixels_per_unit) * to_user;
    for node in nodes {
        let Some(bbox) = node.abs_layer_bounding_box() else {
            continue;
        };
        let parent = match node {
            usvg::Node::Group(group) => affine(group.abs_transform()) * affine(group.transform()).inverse(),
            other => affine(other.abs_transform()),
        };
        // The renderer first moves the node's box to the origin.
        let undo = Affine::translate((f64::from(bbox.x()), f64::from(bbox.y())));
        let [sx, ky, kx, sy, tx, ty] = (to_pixels * parent * undo).as_coeffs().map(|c| c as f32);
        let transform = Transform::from_row(sx, ky, kx, sy, tx, ty);
        // Nothing is drawn of a node without size.
        let _ = resvg::render_node(node, transform, &mut pixmap.as_mut());
    }
    let pixels = pixmap
        .data()
        .chunks_exact(4)
        .map(|p| [p[0], p[1], p[2], p[3]])
        .collect();
    Ok(Picture {
        width: pixmap.width() as usize,
        height: pixmap.height() as usize,
        pixels,
        origin: Point::new(first.x, first.y) / pixels_per_unit,
        pixels_per_unit,
    })
}

#[cfg(test)]
mod tests;
