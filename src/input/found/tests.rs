use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgba, RgbaImage, codecs::png::PngEncoder};
use proptest::prelude::*;

use crate::input::{BitmapOptions, Drawing, FigureRule, InputError, InputNote, PaperRule, read_bitmap};
use crate::math::Point;

/// A figure of discs and limbs, by how far a point is inside of it (negative outside), in units of a picture 200 wide.
fn figure(p: Point) -> f64 {
    let limb = |a: [f64; 2], b: [f64; 2], radius: f64| {
        let (a, b) = (Point::from(a), Point::from(b));
        let along = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        radius - (p - a - (b - a) * along).norm()
    };
    [
        limb([100.0, 50.0], [100.0, 52.0], 26.0),
        limb([100.0, 70.0], [100.0, 120.0], 22.0),
        limb([95.0, 85.0], [40.0, 110.0], 9.0),
        limb([105.0, 85.0], [160.0, 110.0], 9.0),
        limb([95.0, 115.0], [75.0, 180.0], 10.0),
        limb([105.0, 115.0], [125.0, 180.0], 10.0),
    ]
    .into_iter()
    .fold(f64::NEG_INFINITY, f64::max)
}

/// What a drawing is drawn like, and on.
#[derive(Debug, Clone, Copy)]
struct Sheet {
    /// Pixels of a unit.
    scale: f64,
    /// Units of paper around the usual picture.
    margin: f64,
    /// Lightness of the paper at the left and at the right.
    light: [f64; 2],
    /// Largest deviation of the grain.
    grain: f64,
    /// Colour inside the line; `None` leaves the paper.
    fill: Option<[f64; 3]>,
    /// Whether the pen was lifted, over this many units of the head's outline.
    gap: f64,
    /// Radius of the blur of edges, in pixels.
    blur: f64,
}

const WHITE: Sheet = Sheet {
    scale: 2.0,
    margin: 0.0,
    light: [1.0, 1.0],
    grain: 0.0,
    fill: None,
    gap: 0.0,
    blur: 0.5,
};

const SCAN: Sheet = Sheet {
    light: [0.95, 0.6],
    grain: 0.02,
    blur: 1.2,
    ..WHITE
};

const PAINT: Option<[f64; 3]> = Some([0.9, 0.6, 0.25]);

impl Sheet {
    /// Half the width of the ink line, in units.
    const HALF_LINE: f64 = 1.6;

    fn place(&self, x: f64, y: f64) -> Point {
        Point::new(x / self.scale - self.margin, y / self.scale - self.margin)
    }

    fn draw(&self) -> RgbaImage {
        let side = ((200.0 + 2.0 * self.margin) * self.scale).round() as u32;
        let mut state = 7_u32;
        RgbaImage::from_fn(side, side, |x, y| {
            let p = self.place(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let inside = figure(p);
            let soft = |distance: f64| (0.5 + 0.5 * distance * self.scale / self.blur).clamp(0.0, 1.0);
            let in_gap = p.y < 50.0 && (p.x - 100.0).abs() < 0.5 * self.gap;
            let ink = if in_gap {
                0.0
            } else {
                soft(Self::HALF_LINE - inside.abs())
            };
            let right = ((p.x + self.margin) / (200.0 + 2.0 * self.margin)).clamp(0.0, 1.0);
            let light = self.light[0] + (self.light[1] - self.light[0]) * right * right;
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let grain = self.grain * (f64::from(state >> 8) / f64::from(1 << 24) - 0.5) * 2.0;
            let paint = self.fill.map_or(0.0, |_| soft(inside));
            let colour = |k: usize| {
                let paper = [1.0, 0.98, 0.92][k];
                let painted = paper * (1.0 - paint) + paint * self.fill.map_or(0.0, |fill| fill[k]);
                let drawn = painted * (1.0 - ink) + 0.1 * ink;
                (255.0 * (light * drawn + grain)).round().clamp(0.0, 255.0) as u8
            };
            Rgba([colour(0), colour(1), colour(2), 255])
        })
    }

    /// Share of a grid of points on which the outline and the figure with its ink agree, of those in either.
    fn overlap(&self, drawing: &Drawing) -> f64 {
        let (mut both, mut either) = (0, 0);
        for row in 0..100 {
            for column in 0..100 {
                let p = Point::new(2.0 * f64::from(column) + 0.3, 2.0 * f64::from(row) + 0.7);
                let is_inside = figure(p) > -Self::HALF_LINE;
                let is_found = drawing
                    .outline
                    .contains((p + Point::new(self.margin, self.margin)) * self.scale);
                both += u32::from(is_inside && is_found);
                either += u32::from(is_inside || is_found);
            }
        }
        f64::from(both) / f64::from(either)
    }

    /// The largest distance of the outline from the edge of the ink, in pixels.
    fn farthest(&self, drawing: &Drawing) -> f64 {
        let far = |p: &Point| self.scale * (figure(self.place(p.x, p.y)) + Self::HALF_LINE).abs();
        drawing.outline.outer().points().iter().map(far).fold(0.0, f64::max)
    }
}

fn png(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(image.as_raw(), image.width(), image.height(), ExtendedColorType::Rgba8)
        .expect("it encodes");
    bytes
}

fn jpeg(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    let opaque: Vec<u8> = image.pixels().flat_map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
    JpegEncoder::new_with_quality(&mut bytes, 80)
        .write_image(&opaque, image.width(), image.height(), ExtendedColorType::Rgb8)
        .expect("it encodes");
    bytes
}

fn read(bytes: &[u8]) -> Drawing {
    read_bitmap(bytes, &BitmapOptions::default()).expect("a figure")
}

fn pixel(drawing: &Drawing, sheet: &Sheet, x: f64, y: f64) -> [u8; 4] {
    let at = |c: f64| ((c + sheet.margin) * sheet.scale) as usize;
    drawing.picture.pixels[at(y) * drawing.picture.width + at(x)]
}

#[test]
fn lines_on_white_enclose_the_figure_and_its_paper() {
    let drawing = read(&png(&WHITE.draw()));
    assert_eq!(drawing.notes, [InputNote::FigureOfLines { bridged: 0 }]);
    assert!(drawing.outline.holes().is_empty());
    assert!(WHITE.farthest(&drawing) < 0.5, "{}", WHITE.farthest(&drawing));
    // The paper inside is kept as it is, that outside is gone.
    assert_eq!(pixel(&drawing, &WHITE, 100.0, 100.0), [255, 250, 235, 255]);
    assert_eq!(pixel(&drawing, &WHITE, 20.0, 20.0), [0; 4]);
}

#[test]
fn lines_on_scanned_paper_give_their_figure_within_half_a_pixel() {
    for bytes in [png(&SCAN.draw()), jpeg(&SCAN.draw())] {
        let drawing = read(&bytes);
        assert!(
            matches!(drawing.notes[..], [InputNote::FigureOfLines { bridged: 0 }]),
            "{:?}",
            drawing.notes
        );
        assert!(SCAN.farthest(&drawing) < 0.75, "{}", SCAN.farthest(&drawing));
        assert!(SCAN.overlap(&drawing) > 0.99);
    }
}

#[test]
fn a_painted_figure_on_scanned_paper_keeps_its_colours() {
    let sheet = Sheet { fill: PAINT, ..SCAN };
    let image = sheet.draw();
    let drawing = read(&png(&image));
    assert_eq!(drawing.notes, [InputNote::FigurePainted { enclosed: 0 }]);
    assert!(sheet.overlap(&drawing) > 0.99);
    let at = ((100.0 * sheet.scale) as u32, (100.0 * sheet.scale) as u32);
    assert_eq!(pixel(&drawing, &sheet, 100.0, 100.0), image.get_pixel(at.0, at.1).0);
}

#[test]
fn the_edge_keeps_no_fringe_of_paper() {
    let drawing = read(&png(&Sheet {
        fill: PAINT,
        blur: 1.0,
        ..WHITE
    }
    .draw()));
    // Wherever something of an edge pixel is kept, its colour is that of ink or paint, never lighter.
    let lightest = drawing
        .picture
        .pixels
        .iter()
        .filter(|p| (1..250).contains(&p[3]))
        .map(|p| f64::from(p[2]) / f64::from(p[3]))
        .fold(0.0, f64::max);
    assert!(lightest < 0.5, "{lightest}");
}

#[test]
fn rough_strokes_drawn_twice_are_one_outline() {
    // Two strokes around a disc that cross one another, each with an open end.
    let strokes = [(3.0, 0.0, 0.2..5.8), (4.0, 1.3, 2.4..8.0)];
    let image = RgbaImage::from_fn(240, 240, |column, row| {
        let (x, y) = (f64::from(column) + 0.5 - 120.0, f64::from(row) + 0.5 - 120.0);
        let angle = y.atan2(x).rem_euclid(std::f64::consts::TAU);
        let is_ink = strokes.iter().any(|(waves, phase, range)| {
            let radius = 80.0 + 5.0 * (waves * angle + phase).sin();
            let turns = [angle, angle + std::f64::consts::TAU];
            turns.iter().any(|angle| range.contains(angle)) && (x.hypot(y) - radius).abs() < 1.5
        });
        Rgba(if is_ink {
            [30, 30, 34, 255]
        } else {
            [244, 244, 240, 255]
        })
    });
    let drawing = read(&png(&image));
    assert!(drawing.outline.holes().is_empty() && drawing.parts.is_empty());
    assert_eq!(drawing.notes, [InputNote::FigureOfLines { bridged: 0 }]);
    // Seen from outside it is at least as large as either stroke's inside, and no larger than both and their width.
    let area = drawing.outline.area() / (std::f64::consts::PI * 80.0 * 80.0);
    assert!((1.0..1.13).contains(&area), "{area}");
}

#[test]
fn paper_inside_can_be_made_clear() {
    let options = BitmapOptions {
        paper: PaperRule::Clear,
        ..BitmapOptions::default()
    };
    let drawing = read_bitmap(&png(&WHITE.draw()), &options).expect("a figure");
    assert_eq!(drawing.outline, read(&png(&WHITE.draw())).outline);
    assert_eq!(pixel(&drawing, &WHITE, 100.0, 100.0), [0; 4]);
}

#[test]
fn a_gap_is_bridged_or_named() {
    let narrow = Sheet { gap: 2.0, ..WHITE };
    let drawing = read(&png(&narrow.draw()));
    assert_eq!(drawing.notes, [InputNote::FigureOfLines { bridged: 1 }]);
    assert!(WHITE.overlap(&drawing) > 0.99);

    let wide = Sheet { gap: 8.0, ..WHITE };
    let drawing = read(&png(&wide.draw()));
    let Some(InputNote::LineOpen { place, gap, .. }) = drawing.notes.get(1) else {
        panic!("the gap is named: {:?}", drawing.notes);
    };
    assert!((place - Point::new(200.0, 48.0)).norm() < 12.0, "{place}");
    // What the note says helps.
    let options = BitmapOptions {
        gap: gap * 1.1 + 0.001,
        ..BitmapOptions::default()
    };
    let drawing = read_bitmap(&png(&wide.draw()), &options).expect("a figure");
    assert!(WHITE.overlap(&drawing) > 0.98);
}

#[test]
fn nearly_opaque_alpha_and_round_corners_are_sheets() {
    let sheet = Sheet { fill: PAINT, ..WHITE };
    let plain = read(&png(&sheet.draw()));
    let mut nearly = sheet.draw();
    nearly.put_pixel(3, 3, Rgba([255, 250, 235, 254]));
    assert_eq!(read(&png(&nearly)).outline, plain.outline);
    let mut rounded = sheet.draw();
    let side = f64::from(rounded.width());
    for (x, y, pixel) in rounded.enumerate_pixels_mut() {
        let from_corner = |c: u32| (12.0 - f64::from(c).min(side - 1.0 - f64::from(c))).max(0.0);
        if from_corner(x).hypot(from_corner(y)) > 12.0 {
            *pixel = Rgba([0; 4]);
        }
    }
    assert!(sheet.overlap(&read(&png(&rounded))) > 0.99);
}

#[test]
fn a_page_on_a_table_is_a_sheet() {
    let sheet = Sheet { fill: PAINT, ..SCAN };
    let page = sheet.draw();
    let image = RgbaImage::from_fn(page.width() + 80, page.height() + 60, |x, y| {
        match (x.checked_sub(40), y.checked_sub(30)) {
            (Some(x), Some(y)) if x < page.width() && y < page.height() => *page.get_pixel(x, y),
            _ => Rgba([70, 50, 40, 255]),
        }
    });
    let mut drawing = read(&png(&image));
    assert_eq!(drawing.notes[0], InputNote::PageTaken);
    let outer = drawing
        .outline
        .outer()
        .map(|p| p - Point::new(40.0, 30.0))
        .expect("a ring");
    drawing.outline = crate::outline::Outline::new(outer, vec![]).expect("simple");
    assert!(sheet.overlap(&drawing) > 0.98, "{}", sheet.overlap(&drawing));
}

#[test]
fn a_background_that_is_not_plain_is_refused() {
    let figure_on = |background: &dyn Fn(u32, u32) -> Rgba<u8>| {
        let drawn = Sheet { fill: PAINT, ..WHITE }.draw();
        RgbaImage::from_fn(drawn.width(), drawn.height(), |x, y| {
            let p = WHITE.place(f64::from(x), f64::from(y));
            if figure(p) > -1.6 {
                *drawn.get_pixel(x, y)
            } else {
                background(x, y)
            }
        })
    };
    let squares = |x: u32, y: u32| match (x / 16 + y / 16) % 2 {
        0 => Rgba([255, 255, 255, 255]),
        _ => Rgba([204, 204, 204, 255]),
    };
    let blots = |x: u32, y: u32| {
        let wave = |k: f64| (127.0 + 120.0 * (f64::from(x) * 0.05 * k).sin() * (f64::from(y) * 0.06 / k).cos()) as u8;
        Rgba([wave(1.0), wave(1.7), wave(0.6), 255])
    };
    for image in [figure_on(&squares), figure_on(&blots)] {
        let refused = read_bitmap(&png(&image), &BitmapOptions::default()).expect_err("refused");
        assert!(matches!(refused, InputError::BackgroundNotPlain), "{refused}");
    }
}

#[test]
fn white_eyes_belong_to_the_figure_and_gaps_without_a_line_stay_open() {
    let mut image = Sheet { fill: PAINT, ..WHITE }.draw();
    let blank = Rgba([255, 250, 235, 255]);
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        let eye = (f64::from(x) - 182.0).hypot(f64::from(y) - 96.0);
        if eye < 11.0 {
            *pixel = if eye < 5.0 { Rgba([20, 20, 20, 255]) } else { blank };
        }
    }
    let drawing = read(&png(&image));
    assert_eq!(drawing.notes, [InputNote::FigurePainted { enclosed: 1 }]);
    assert!(drawing.outline.holes().is_empty());
    assert_eq!(
        drawing.picture.pixels[88 * drawing.picture.width + 182],
        [255, 250, 235, 255]
    );

    // A ring of paint, without a line: a letter O.
    let ring = RgbaImage::from_fn(120, 120, |x, y| {
        let radius = (f64::from(x) - 59.5).hypot(f64::from(y) - 59.5);
        if (25.0..45.0).contains(&radius) {
            Rgba([200, 30, 30, 255])
        } else {
            blank
        }
    });
    assert_eq!(read(&png(&ring)).outline.holes().len(), 1);
}

#[test]
fn lines_on_nothing_enclose_a_figure() {
    let drawn = WHITE.draw();
    let ink = RgbaImage::from_fn(drawn.width(), drawn.height(), |x, y| {
        Rgba([10, 10, 40, 255 - drawn.get_pixel(x, y).0[0]])
    });
    let drawing = read(&png(&ink));
    assert_eq!(drawing.notes, [InputNote::FigureOfLines { bridged: 0 }]);
    assert!(WHITE.overlap(&drawing) > 0.99);
    // As alpha has it, asked so.
    let options = BitmapOptions {
        figure: FigureRule::Alpha,
        ..BitmapOptions::default()
    };
    let as_alpha = read_bitmap(&png(&ink), &options).expect("a figure");
    assert_eq!(as_alpha.outline.holes().len(), 1);
}

#[test]
fn a_limb_cut_by_the_frame_is_closed_along_it() {
    let drawn = WHITE.draw();
    // Both legs run out of the picture.
    let cut = image::imageops::crop_imm(&drawn, 0, 0, drawn.width(), 320).to_image();
    let drawing = read(&png(&cut));
    assert!(
        matches!(drawing.notes[0], InputNote::FigureOfLines { .. }),
        "{:?}",
        drawing.notes
    );
    assert!(drawing.outline.contains(Point::new(164.0, 312.0)) && drawing.outline.contains(Point::new(236.0, 312.0)));
    assert!(!drawing.outline.contains(Point::new(200.0, 312.0)));
}

#[test]
fn a_jpeg_that_ends_early_is_refused_and_later_frames_are_told() {
    let whole = jpeg(&WHITE.draw());
    assert!(matches!(
        read_bitmap(&whole[..whole.len() * 2 / 3], &BitmapOptions::default()),
        Err(InputError::CutOff)
    ));
    let mut gif = Vec::new();
    let mut encoder = image::codecs::gif::GifEncoder::new(&mut gif);
    for _ in 0..3 {
        encoder
            .encode_frame(image::Frame::new(WHITE.draw()))
            .expect("it encodes");
    }
    drop(encoder);
    assert_eq!(read(&gif).notes[0], InputNote::FramesLeftOut { count: 2 });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn the_figure_does_not_depend_on_margin_light_scale_or_format(
        margin in 0.0..60.0_f64,
        light in (0.55..1.0_f64, 0.55..1.0_f64),
        scale in 1.0..4.0_f64,
        grain in 0.0..0.03_f64,
        painted in any::<bool>(),
        lossy in any::<bool>(),
    ) {
        let sheet = Sheet {
            margin,
            scale,
            light: [light.0, light.1],
            grain,
            fill: if painted { PAINT } else { None },
            ..SCAN
        };
        let image = sheet.draw();
        let drawing = read(&if lossy { jpeg(&image) } else { png(&image) });
        prop_assert!(sheet.overlap(&drawing) > 0.98, "overlap {} {:?}", sheet.overlap(&drawing), drawing.notes);
        prop_assert!(drawing.outline.holes().is_empty());
    }
}
