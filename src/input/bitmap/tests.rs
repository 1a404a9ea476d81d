use image::{ExtendedColorType, ImageEncoder, Rgba, RgbaImage, codecs::png::PngEncoder};
use proptest::prelude::*;

use super::*;

fn png(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(image.as_raw(), image.width(), image.height(), ExtendedColorType::Rgba8)
        .expect("it encodes");
    bytes
}

/// An image whose alpha, or ink on white paper, is the share of a pixel that `inside` covers.
fn painted(width: u32, height: u32, on_paper: bool, inside: impl Fn(f64, f64) -> bool) -> RgbaImage {
    const SUB: u32 = 16;
    RgbaImage::from_fn(width, height, |x, y| {
        let mut hits = 0;
        for k in 0..SUB * SUB {
            let sub = |k: u32| (f64::from(k) + 0.5) / f64::from(SUB);
            hits += u32::from(inside(f64::from(x) + sub(k % SUB), f64::from(y) + sub(k / SUB)));
        }
        let share = f64::from(hits) / f64::from(SUB * SUB);
        let level = (255.0 * share).round() as u8;
        if on_paper {
            Rgba([255 - level, 255 - level, 255, 255])
        } else {
            Rgba([0, 0, 200, level])
        }
    })
}

fn disc(x: f64, y: f64, radius: f64) -> impl Fn(f64, f64) -> bool {
    move |px, py| (px - x).hypot(py - y) < radius
}

fn read(image: &RgbaImage) -> Drawing {
    read_bitmap(&png(image), &BitmapOptions::default()).expect("a drawing")
}

#[test]
fn disc_outline_is_sub_pixel_by_alpha_and_by_colour() {
    for on_paper in [false, true] {
        let drawing = read(&painted(40, 36, on_paper, disc(19.3, 17.6, 12.25)));
        for p in drawing.outline.outer().points() {
            let radius = (p - Point::new(19.3, 17.6)).norm();
            assert!((radius - 12.25).abs() < 0.1, "radius {radius} at {p}");
        }
        assert!(drawing.outline.outer().signed_area() > 0.0);
        let taken = on_paper.then_some(InputNote::FigurePainted { enclosed: 0 });
        assert_eq!(drawing.notes, Vec::from_iter(taken));
        let picture = &drawing.picture;
        assert_eq!(picture.pixels[0], [0; 4]);
        assert_eq!(picture.pixels[18 * 40 + 19][3], 255);
    }
}

#[test]
fn binary_disc_is_smoothed_within_its_pixels() {
    let centre = Point::new(20.2, 19.9);
    let image = RgbaImage::from_fn(40, 40, |x, y| {
        let inside = disc(20.2, 19.9, 14.0)(f64::from(x) + 0.5, f64::from(y) + 0.5);
        Rgba([255, 255, 255, if inside { 255 } else { 0 }])
    });
    let outline = read(&image).outline;
    let worst = outline
        .outer()
        .points()
        .iter()
        .map(|p| ((p - centre).norm() - 14.0).abs())
        .fold(0.0, f64::max);
    assert!(worst < 0.5, "{worst}");
    for (x, y, pixel) in image.enumerate_pixels() {
        let centre = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        assert_eq!(outline.contains(centre), pixel.0[3] == 255);
    }
}

#[test]
fn drawing_cut_by_the_border_is_closed() {
    let drawing = read(&painted(30, 30, false, disc(0.0, 15.0, 10.0)));
    let outer = drawing.outline.outer();
    assert!(outer.points().iter().all(|p| p.x > -0.51));
    assert!((outer.signed_area() - 0.5 * std::f64::consts::PI * 100.0).abs() < 12.0);
}

#[test]
fn holes_are_kept_pin_holes_and_loose_parts_are_told() {
    let shape = |x: f64, y: f64| {
        let body = disc(30.0, 30.0, 25.0)(x, y) && !disc(22.0, 30.0, 6.0)(x, y) && !disc(40.5, 30.5, 0.9)(x, y);
        body || disc(70.0, 10.0, 5.0)(x, y) || disc(70.5, 50.5, 0.9)(x, y)
    };
    let image = painted(80, 60, true, shape);
    let drawing = read(&image);
    assert_eq!(drawing.outline.holes().len(), 1);
    assert_eq!(drawing.notes.len(), 3);
    assert_eq!(drawing.notes[0], InputNote::FigurePainted { enclosed: 0 });
    assert!(
        matches!(drawing.notes[1], InputNote::PartsLeftOut { count: 1, place, area } if
        (place - Point::new(70.0, 10.0)).norm() < 0.1 && (area - 78.5).abs() < 4.0)
    );
    assert!(matches!(drawing.notes[2], InputNote::SpecksLeftOut { count: 1, .. }));
    assert_eq!(drawing.picture.pixels[30 * 80 + 22], [0; 4]);

    let fill = BitmapOptions {
        holes: HoleRule::Fill,
        ..BitmapOptions::default()
    };
    let filled = read_bitmap(&png(&image), &fill).expect("a drawing");
    assert!(filled.outline.holes().is_empty());
    assert_eq!(filled.picture.pixels[30 * 80 + 22], [255; 4]);
}

#[test]
fn pale_body_with_ink_line_is_one_shape() {
    // White paper, black line of 2 px, skin-coloured inside: the skin differs from white by a quarter of the ink.
    let image = RgbaImage::from_fn(40, 40, |x, y| {
        let radius = (f64::from(x) + 0.5 - 20.0).hypot(f64::from(y) + 0.5 - 20.0);
        let grey = |share: f64| (255.0 * share).round() as u8;
        if radius < 13.0 {
            Rgba([255, 220, 190, 255])
        } else {
            let level = grey((radius - 15.5).clamp(0.0, 1.0));
            Rgba([level, level, level, 255])
        }
    });
    let drawing = read(&image);
    assert!(drawing.outline.holes().is_empty());
    let area = drawing.outline.area();
    assert!((area - std::f64::consts::PI * 256.0).abs() < 15.0, "{area}");
    assert_eq!(drawing.picture.pixels[20 * 40 + 20], [255, 220, 190, 255]);
}

#[test]
fn refusals_name_their_cause() {
    let refuse = |bytes: &[u8]| read_bitmap(bytes, &BitmapOptions::default()).expect_err("refused");
    assert!(matches!(refuse(&[]), InputError::EmptyFile));
    assert!(matches!(
        refuse(b"once upon a time there was no image"),
        InputError::NotAnImage
    ));
    let whole = png(&painted(40, 40, false, disc(20.0, 20.0, 9.0)));
    assert!(matches!(
        refuse(&whole[..whole.len() / 2]),
        InputError::Undecodable { .. }
    ));
    let blank = RgbaImage::from_pixel(9, 7, Rgba([255, 255, 255, 255]));
    assert!(matches!(
        refuse(&png(&blank)),
        InputError::NothingDrawn {
            width: 9,
            height: 7,
            by_alpha: false
        }
    ));
    let clear = RgbaImage::from_pixel(9, 7, Rgba([1, 2, 3, 0]));
    assert!(matches!(
        refuse(&png(&clear)),
        InputError::NothingDrawn { by_alpha: true, .. }
    ));
    let dot = painted(9, 9, false, disc(4.0, 4.0, 0.8));
    assert!(matches!(refuse(&png(&dot)), InputError::TooSmall { .. }));
    let options = BitmapOptions {
        threshold: f64::NAN,
        ..BitmapOptions::default()
    };
    assert!(matches!(
        read_bitmap(&whole, &options),
        Err(InputError::BadThreshold { .. })
    ));
    let missing = open_bitmap(Path::new("no/such/drawing.png"), &BitmapOptions::default()).expect_err("missing");
    assert!(missing.to_string().contains("no/such/drawing.png"));
}

#[test]
fn a_scan_as_tiff_is_read_and_one_that_is_cut_off_is_refused() {
    let image = painted(48, 48, true, disc(24.0, 24.0, 15.0));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Tiff).expect("a TIFF");
    let bytes = bytes.into_inner();
    let options = BitmapOptions::default();
    let drawing = read_bitmap(&bytes, &options).expect("a drawing");
    assert_eq!(drawing.outline, read(&image).outline);
    assert!(read_bitmap(&bytes[..bytes.len() / 2], &options).is_err());
}

#[test]
fn a_claim_of_enormous_size_is_refused_from_the_header() {
    let mut bytes = png(&painted(8, 8, false, disc(4.0, 4.0, 3.0)));
    bytes[16..20].copy_from_slice(&60_000_u32.to_be_bytes());
    bytes[20..24].copy_from_slice(&60_000_u32.to_be_bytes());
    let checksum = !bytes[12..29].iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1)))
    });
    bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
    let refused = read_bitmap(&bytes, &BitmapOptions::default()).expect_err("refused");
    assert!(
        matches!(refused, InputError::TooManyPixels { width: 60_000, .. }),
        "{refused}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_image_gives_a_valid_outline_or_a_refusal(
        width in 1..14_u32,
        levels in proptest::collection::vec(prop_oneof![Just(0_u8), Just(255), Just(127), Just(128), any::<u8>()], 14 * 12),
        opaque in any::<bool>(),
    ) {
        let image = RgbaImage::from_fn(width, 12, |x, y| {
            let level = levels[(y * 14 + x) as usize];
            if opaque { Rgba([level, level, 255, 255]) } else { Rgba([9, 8, 7, level]) }
        });
        match read_bitmap(&png(&image), &BitmapOptions::default()) {
            Ok(drawing) => {
                // Every pixel of the picture that counts as drawn is told of: in the outline or in a note.
                prop_assert!(drawing.outline.area() > 0.0);
                prop_assert_eq!(drawing.picture.pixels.len(), (width * 12) as usize);
            }
            Err(error) => prop_assert!(
                matches!(
                    error,
                    InputError::NothingDrawn { .. } | InputError::TooSmall { .. } | InputError::BackgroundNotPlain
                ),
                "{}", error
            ),
        }
    }
}
