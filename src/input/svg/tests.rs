use proptest::prelude::*;

use super::*;
use crate::input::HoleRule;
use crate::outline::OutlineError;

fn svg(body: &str) -> String {
    format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>"#)
}

fn read(text: &str) -> Drawing {
    read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing")
}

fn refuse(text: &str) -> InputError {
    read_svg(text.as_bytes(), &SvgOptions::default()).expect_err("no drawing")
}

fn element(text: &str, id: &str) -> Result<Drawing, InputError> {
    let options = SvgOptions {
        element: Some(id.to_owned()),
        ..SvgOptions::default()
    };
    read_svg(text.as_bytes(), &options)
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() < tolerance, "{found} instead of {expected}");
}

#[test]
fn a_square_is_its_four_corners_and_its_pixels() {
    let options = SvgOptions {
        pixels_per_unit: Some(2.0),
        ..SvgOptions::default()
    };
    let text = svg(r#"<rect x="10" y="20" width="30" height="40" fill="red"/>"#);
    let drawing = read_svg(text.as_bytes(), &options).expect("a drawing");
    let mut corners: Vec<[f64; 2]> = drawing.outline.outer().points().iter().map(|&p| p.into()).collect();
    corners.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    assert_eq!(corners, [[10.0, 20.0], [10.0, 60.0], [40.0, 20.0], [40.0, 60.0]]);
    assert!(drawing.outline.outer().signed_area() > 0.0);
    assert!(drawing.notes.is_empty());
    let picture = &drawing.picture;
    assert_eq!((picture.width, picture.height), (64, 84));
    assert_eq!(picture.origin, Point::new(9.0, 19.0));
    let pixel = |x: f64, y: f64| {
        let column = ((x - picture.origin.x) * picture.pixels_per_unit) as usize;
        let row = ((y - picture.origin.y) * picture.pixels_per_unit) as usize;
        picture.pixels[row * picture.width + column]
    };
    assert_eq!(pixel(10.25, 20.25), [255, 0, 0, 255]);
    assert_eq!(pixel(39.75, 59.75), [255, 0, 0, 255]);
    assert_eq!(pixel(9.75, 20.25), [0; 4]);
    assert_eq!(pixel(40.25, 59.75), [0; 4]);
}

#[test]
fn user_units_are_those_of_the_view_box() {
    let body = r#"<g transform="translate(10 0)"><rect id="r" x="10" y="20" width="30" height="40"/></g>"#;
    for size in [
        "",
        r#"width="300" height="500""#,
        r#"width="10cm" height="3cm" preserveAspectRatio="none""#,
    ] {
        let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-5 0 90 100" {size}>{body}</svg>"#);
        for drawing in [read(&text), element(&text, "r").expect("it is there")] {
            let (low, high) = point::bounding_box(drawing.outline.outer().points()).expect("points");
            close(low.x, 20.0, 1e-4);
            close(high.y, 60.0, 1e-4);
            // The picture has ink in the middle of the rectangle.
            let picture = &drawing.picture;
            let at = (Point::new(35.0, 40.0) - picture.origin) * picture.pixels_per_unit;
            assert_eq!(
                picture.pixels[at.y as usize * picture.width + at.x as usize],
                [0, 0, 0, 255]
            );
        }
    }
}

#[test]
fn fills_follow_their_rule_and_strokes_widen() {
    // Two squares, one in the other, run the same way round.
    let squares = "M0 0H40V40H0ZM10 10H30V30H10Z";
    let nonzero = read(&svg(&format!(r#"<path d="{squares}"/>"#)));
    assert_eq!((nonzero.outline.holes().len(), nonzero.outline.area()), (0, 1600.0));
    let even_odd = read(&svg(&format!(r#"<path fill-rule="evenodd" d="{squares}"/>"#)));
    assert_eq!((even_odd.outline.holes().len(), even_odd.outline.area()), (1, 1200.0));
    let filled = SvgOptions {
        holes: HoleRule::Fill,
        ..SvgOptions::default()
    };
    let text = svg(&format!(r#"<path fill-rule="evenodd" d="{squares}"/>"#));
    let filled = read_svg(text.as_bytes(), &filled).expect("a drawing");
    assert_eq!(filled.notes, [InputNote::HolesFilled { count: 1 }]);
    assert_eq!(filled.outline.area(), 1600.0);

    let stroked = read(&svg(
        r#"<rect x="20" y="20" width="40" height="40" stroke="black" stroke-width="4" stroke-linejoin="miter"/>"#,
    ));
    close(stroked.outline.area(), 44.0 * 44.0, 1e-6);
    let line = read(&svg(
        r#"<path d="M10 10H90" fill="none" stroke="black" stroke-width="6" stroke-linecap="round" transform="scale(1 2)"/>"#,
    ));
    close(
        line.outline.area(),
        2.0 * (80.0 * 6.0 + 9.0 * std::f64::consts::PI),
        0.5,
    );
}

#[test]
fn overlapping_pieces_are_united_and_loose_ones_reported() {
    let drawing = read(&svg(
        r#"<circle cx="30" cy="30" r="20"/><circle cx="50" cy="30" r="20"/><rect x="80" y="80" width="10" height="10"/>"#,
    ));
    // Two discs of radius r at distance r: the lens is (2 pi / 3 - sqrt(3) / 2) r^2.
    let lens = (2.0 * std::f64::consts::FRAC_PI_3 - 3.0_f64.sqrt() / 2.0) * 400.0;
    close(drawing.outline.area(), 800.0 * std::f64::consts::PI - lens, 2.0);
    assert!(
        matches!(drawing.notes[..], [InputNote::PartsLeftOut { count: 1, place, area }]
        if (place - Point::new(85.0, 85.0)).norm() < 1e-6 && (area - 100.0).abs() < 1e-6)
    );
}

#[test]
fn groups_clips_uses_and_styles_are_resolved() {
    let drawing = read(&svg(
        r##"<style>.ghost { fill: none }</style><defs><clipPath id="c"><rect x="0" y="0" width="50" height="100"/></clipPath>
        <rect id="r" width="60" height="60"/></defs>
        <g clip-path="url(#c)" transform="translate(5 5)"><use href="#r" x="10"/></g>
        <rect class="ghost" width="100" height="100"/><rect width="100" height="100" opacity="0"/>"##,
    ));
    close(drawing.outline.area(), 40.0 * 60.0, 1e-3);
    let (low, high) = point::bounding_box(drawing.outline.outer().points()).expect("points");
    close(low.x, 15.0, 1e-5);
    close(high.x, 55.0, 1e-5);
}

#[test]
fn an_element_gives_the_outline_and_everything_the_pixels() {
    let text = svg(r#"<rect width="100" height="100" fill="white"/><g id="body"><circle cx="50" cy="50" r="10"/></g>"#);
    let body = element(&text, "body").expect("it is there");
    close(body.outline.area(), 100.0 * std::f64::consts::PI, 0.5);
    assert_eq!(body.picture.pixels[0], [255; 4]);
    let error = element(&text, "bodyy").expect_err("it is not there");
    assert!(
        matches!(&error, InputError::NoSuchElement { id, known } if id == "bodyy" && known == &["body"]),
        "{error}"
    );
}

#[test]
fn crossings_are_resolved_and_touching_places_joined() {
    // A figure of eight through one point: two triangles that share a corner.
    let eight = read(&svg(r#"<path d="M10 10L50 50L90 10V90L50 50L10 90Z"/>"#));
    close(eight.outline.area(), 3200.0, 1.0);
    assert!(eight.outline.contains(Point::new(20.0, 50.0)) && eight.outline.contains(Point::new(80.0, 50.0)));
    let crossing = read(&svg(r#"<path d="M10 10L90 90L90 10L10 90Z"/>"#));
    close(crossing.outline.area(), 3200.0, 1.0);
    // A hole that touches the outer edge in a point.
    let pinched = read(&svg(
        r#"<path fill-rule="evenodd" d="M0 0H80V80H0ZM40 0L60 40L20 40Z"/>"#,
    ));
    close(pinched.outline.area(), 6400.0 - 800.0, 1.0);
    assert_eq!(pinched.outline.holes().len(), 1);
}

#[test]
fn bad_files_are_refused_by_name() {
    assert!(matches!(refuse(""), InputError::EmptyFile));
    assert!(matches!(refuse("<svg"), InputError::NotSvg { .. }));
    assert!(matches!(refuse("<html/>"), InputError::NotSvg { .. }));
    let zipped = read_svg(&[0x1f, 0x8b, 8, 0], &SvgOptions::default()).expect_err("zipped");
    assert!(zipped.to_string().contains("compressed"), "{zipped}");
    for body in ["", r#"<path d="M1 1L9 9"/>"#, r#"<path d="M1 1H9V9Z" fill="none"/>"#] {
        assert!(matches!(refuse(&svg(body)), InputError::NoClosedShape), "{body}");
    }
    // The cause, not the symptom.
    assert!(matches!(refuse(&svg("<text>a</text>")), InputError::OnlyText));
    assert!(matches!(
        refuse(&svg("<image href='a.png'/>")),
        InputError::OnlyPictures
    ));
    let utf16: Vec<u8> = "\u{feff}<svg/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let latin1 = [
        &br#"<?xml version="1.0" encoding="ISO-8859-1"?><svg><!--"#[..],
        &[0xe4],
        b"--></svg>",
    ]
    .concat();
    for (bytes, name) in [(utf16, "UTF-16"), (latin1, "ISO-8859-1"), (vec![b'<', 0xe4], "Latin-1")] {
        let refused = read_svg(&bytes, &SvgOptions::default())
            .expect_err("another encoding")
            .to_string();
        assert!(refused.contains(name) && refused.contains("UTF-8"), "{refused}");
    }
    for number in ["NaN", "1e9", "1e300", "1e999"] {
        let error = refuse(&svg(&format!("<g>\n<path id='p' d='M0 0L{number} 0L5 5Z'/></g>")));
        assert!(
            matches!(&error, InputError::BadNumber { element, line: 2, .. } if element == "path 'p'"),
            "{number}: {error}"
        );
    }
    // Small numbers can still add up.
    let far = refuse(&svg(r#"<g transform="scale(9e6)"><path d="M0 0H90V90Z"/></g>"#));
    assert!(matches!(far, InputError::NoClosedShape | InputError::Ring(_)), "{far}");
    let options = SvgOptions {
        pixels_per_unit: Some(f64::NAN),
        ..SvgOptions::default()
    };
    assert!(read_svg(b"<svg/>", &options).is_err());
}

#[test]
fn nothing_outside_the_file_is_read_and_resolution_is_capped() {
    let text = svg(r#"<image href="../secret.png" width="9" height="9"/><rect width="50" height="50"/>"#);
    let options = SvgOptions {
        pixels_per_unit: Some(1e9),
        ..SvgOptions::default()
    };
    let drawing = read_svg(text.as_bytes(), &options).expect("a drawing");
    assert_eq!(
        drawing.notes,
        [InputNote::NotDrawn {
            what: "embedded images",
            count: 1
        }]
    );
    assert!(drawing.picture.width.max(drawing.picture.height) <= 8192);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn any_closed_path_gives_an_outline_or_a_refusal(
        points in proptest::collection::vec((0_i32..12, 0_i32..12), 3..14),
        even_odd in proptest::bool::ANY,
    ) {
        // Points on a coarse grid meet and overlap in every way.
        let path: Vec<String> = points.iter().map(|(x, y)| format!("{} {}", 8 * x, 8 * y)).collect();
        let rule = if even_odd { "evenodd" } else { "nonzero" };
        let text = svg(&format!(r#"<path fill-rule="{rule}" d="M{}Z"/>"#, path.join("L")));
        match read_svg(text.as_bytes(), &SvgOptions { pixels_per_unit: Some(0.1), ..SvgOptions::default() }) {
            Ok(drawing) => prop_assert!(drawing.outline.area() > 0.0),
            Err(InputError::NoClosedShape) => {}
            Err(InputError::Outline(OutlineError::EdgesMeet { x, y, .. })) => prop_assert!(false, "meets at {x}, {y}"),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}

#[test]
fn a_background_is_left_out_whatever_it_is_drawn_with() {
    let blob = r##"<circle cx="50" cy="50" r="30" fill="#c60"/>"##;
    for background in [
        r##"<rect width="100" height="100" fill="#fff"/>"##,
        r#"<style>.paper{fill:#eee}</style><rect class="paper" width="100%" height="100%"/>"#,
        r#"<g id="layer1"><path d="M-1-1H101V101H-1Z" fill="beige"/></g>"#,
        r#"<rect width="100" height="60" fill="skyblue"/><rect y="60" width="100" height="40" fill="green"/>"#,
    ] {
        let drawing = read(&svg(&format!("{background}{blob}")));
        close(drawing.outline.area(), std::f64::consts::PI * 900.0, 2.0);
        assert_eq!(drawing.notes, [InputNote::BackgroundLeftOut], "{background}");
        // It is neither in the pixels nor among the curves.
        assert_eq!(drawing.picture.pixels[0], [0; 4]);
        assert_eq!(drawing.art.map(|art| art.elements.len()), Some(1));
    }
    // Alone it is the drawing, which is told.
    let whole = read(&svg(r#"<rect width="100" height="100"/>"#));
    assert_eq!(
        (whole.outline.area(), &whole.notes[..]),
        (1e4, &[InputNote::FillsCanvas][..])
    );
    // What does not cover the page is none, and neither is what an element is asked for on.
    assert!(
        read(&svg(&format!(r#"<rect width="100" height="90" fill="red"/>{blob}"#)))
            .notes
            .is_empty()
    );
}

#[test]
fn masks_cut_by_what_they_let_through() {
    let masked = |kind: &str, mask: &str| {
        read(&svg(&format!(
            r#"<mask id="m" style="mask-type:{kind}" maskUnits="userSpaceOnUse" x="0" y="0" width="100" height="100">{mask}</mask>
            <g mask="url(#m)"><rect width="100" height="100" fill="teal"/></g>"#
        )))
        .outline
    };
    let disc = r#"<circle cx="50" cy="50" r="30" fill="gray"/>"#;
    close(masked("alpha", disc).area(), std::f64::consts::PI * 900.0, 2.0);
    let light =
        r#"<circle cx="50" cy="50" r="30" fill="white"/><rect x="40" y="40" width="20" height="20" fill="black"/>"#;
    let cut = masked("luminance", light);
    assert_eq!(cut.holes().len(), 1);
    close(cut.area(), std::f64::consts::PI * 900.0 - 400.0, 2.0);
}

#[test]
fn variables_have_their_values() {
    let colour = |text: &str| {
        let picture = read(text).picture;
        picture.pixels[picture.width * (picture.height / 2) + picture.width / 2]
    };
    let square = |style: &str, fill: &str| {
        svg(&format!(
            r#"<style>{style}</style><path fill="{fill}" d="M9 9H90V90H9Z"/>"#
        ))
    };
    let red = [204, 51, 51, 255];
    assert_eq!(colour(&square(":root{--c:#c33}", "var(--c, #3a3)")), red);
    assert_eq!(colour(&square("", "var(--c, #c33)")), red);
    assert_eq!(colour(&square(":root{--a:var(--b);--b:#c33}", "var(--a)")), red);
    assert_eq!(
        colour(&square(":root{--c:#c33} .dark{--c:#000}", "var(--c, rgb(1, 2, 3))")),
        red
    );
    let text = svg(r#"<path fill="var(--x)" d="M9 9H90V90H9Z"/><path d="M9 9H40V40H9Z"/>"#);
    assert_eq!(
        read(&text).notes,
        [InputNote::VariablesUnknown {
            names: vec!["--x".to_owned()]
        }]
    );
}

#[test]
fn a_soft_shadow_is_said_to_be_cut_off_and_a_sharp_edge_is_not() {
    let with = |filter: &str| {
        let text = svg(&format!(
            r##"<filter id="f" x="-1" y="-1" width="3" height="3">{filter}</filter>
                <g filter="url(#f)"><circle cx="50" cy="50" r="20"/></g>"##
        ));
        read(&text).notes.contains(&InputNote::SoftEdgeCut)
    };
    assert!(with(r#"<feDropShadow dx="5" dy="9" stdDeviation="3"/>"#));
    assert!(with(r#"<feGaussianBlur stdDeviation="6"/>"#));
    assert!(!with(r#"<feColorMatrix type="saturate" values="0.5"/>"#));
    assert!(!with(r#"<feGaussianBlur stdDeviation="0.2"/>"#));
}
