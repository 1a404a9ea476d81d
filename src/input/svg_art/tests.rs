use super::*;
use crate::input::{Extent, SvgOptions, read_svg};

fn read(body: &str) -> crate::input::Drawing {
    let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>"#);
    read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing")
}

fn art(body: &str) -> Art {
    let drawing = read(body);
    drawing.art.unwrap_or_else(|| panic!("not curves: {:?}", drawing.notes))
}

fn ids(art: &Art) -> Vec<&str> {
    art.elements
        .iter()
        .map(|element| element.id.as_deref().unwrap_or("-"))
        .collect()
}

const SQUARE: &str = r#"<rect id="s" x="10" y="10" width="50" height="50"/>"#;

#[test]
fn elements_are_named_by_themselves_or_their_group_and_only_once() {
    let art = art(
        r#"<rect width="9" height="9"/><g id="arm" transform="translate(20 0)"><rect width="9" height="9"/>
        <g><rect x="9" width="9" height="9"/></g><rect id="hand" width="4" height="5"/></g>
        <rect id="arm" y="50" width="60" height="40"/>"#,
    );
    assert_eq!(ids(&art), ["-", "arm", "arm/2", "hand", "arm/3"]);
    assert_eq!(art.elements[2].subpaths[0].start, Point::new(29.0, 0.0));
}

#[test]
fn lines_are_straight_cubics_and_closed_paths_end_where_they_start() {
    let art = art(
        r#"<path d="M10 10H40V40Z M50 50 L80 50 L80 90" fill="red"/><path d="M5 5H9V9" fill="none" stroke="red"/>"#,
    );
    let [filled, stroked] = &art.elements[..] else {
        panic!("two elements");
    };
    for subpath in &filled.subpaths {
        assert!(subpath.is_closed && subpath.cubics.len() == 3 && subpath.end() == subpath.start);
        let [a, b, c] = subpath.cubics[0];
        let third = (c - subpath.start) / 3.0;
        assert!((a - subpath.start - third).norm() < 1e-12 && (c - b - third).norm() < 1e-12);
    }
    assert!(!stroked.subpaths[0].is_closed && stroked.fill.is_none());
}

#[test]
fn styles_are_in_user_units_and_opacities_multiply() {
    let art = art(
        r#"<g opacity="0.5" transform="scale(2)"><path id="p" opacity="0.5" d="M10 10H40V40Z" fill="blue" fill-opacity="0.25"
        stroke="red" stroke-width="3" stroke-dasharray="4" stroke-linecap="round" stroke-dashoffset="1"/></g>
        <rect width="20" height="20" visibility="hidden" fill="red"/>"#,
    );
    assert_eq!(art.elements[0].opacity, 0.25);
    assert_eq!(art.elements[1].opacity, 0.0);
    let fill = art.elements[0].fill.as_ref().expect("filled");
    assert_eq!(fill.paint, Paint::Solid([0.0, 0.0, 1.0, 0.25]));
    let stroke = art.elements[0].stroke.as_ref().expect("stroked");
    assert_eq!((stroke.width, stroke.dash_offset), (6.0, 2.0));
    assert_eq!(
        (stroke.dashes.as_slice(), stroke.cap),
        (&[8.0, 8.0][..], LineCap::Round)
    );
}

#[test]
fn gradients_are_placed_in_user_units() {
    let art = art(
        r#"<linearGradient id="l"><stop stop-color="red"/><stop offset="1" stop-opacity="0.5"/></linearGradient>
        <radialGradient id="r" gradientUnits="userSpaceOnUse" cx="50" cy="60" r="10" fx="52" fy="60"><stop/><stop offset="1"/>
        </radialGradient><rect x="10" y="20" width="40" height="60" fill="url(#l)"/>
        <rect x="10" y="20" width="40" height="60" fill="url(#r)" transform="translate(5 0)"/>"#,
    );
    let gradient = |k: usize| match &art.elements[k].fill.as_ref().expect("filled").paint {
        Paint::Gradient(gradient) => gradient.clone(),
        Paint::Solid(_) => panic!("a gradient"),
    };
    let linear = gradient(0);
    assert!((linear.placement.origin - Point::new(10.0, 20.0)).norm() < 1e-4);
    assert!((linear.placement.along_x - Point::new(40.0, 0.0)).norm() < 1e-4);
    // Colours are even along the transform's y, which is the box's.
    assert!(linear.placement.along_y.x.abs() < 1e-4);
    assert_eq!(linear.stops[1].colour, [0.0, 0.0, 0.0, 0.5]);
    let radial = gradient(1);
    assert!((radial.placement.origin - Point::new(55.0, 60.0)).norm() < 1e-4);
    let GradientKind::Radial { focus } = radial.kind else {
        panic!("radial");
    };
    assert!((focus - Point::new(0.2, 0.0)).norm() < 1e-5);
}

#[test]
fn a_stroke_under_its_fill_and_a_squeezed_stroke_are_elements_of_their_own() {
    let under = art(r#"<path id="p" paint-order="stroke" d="M10 10H40V40Z" fill="blue" stroke="red"/>"#);
    assert_eq!(ids(&under), ["p", "p/2"]);
    assert!(under.elements[0].fill.is_none() && under.elements[1].stroke.is_none());
    let squeezed = art(r#"<path d="M10 10H40V40Z" fill="blue" stroke="red" stroke-width="4" transform="scale(1 2)"/>"#);
    assert_eq!(squeezed.elements.len(), 2);
    assert!(squeezed.elements[1].stroke.is_none());
    let (low, high) = point::bounding_box(squeezed.elements[1].subpaths[0].points()).expect("points");
    // The top edge, at y = 20, is 8 thick; the right edge, at x = 40, is 4 thick.
    assert!((low.y - 16.0).abs() < 0.1 && (high.x - 42.0).abs() < 0.1);
}

#[test]
fn what_curves_cannot_say_is_named_and_leaves_the_pixels() {
    let cases = [
        (format!(r#"<clipPath id="c"><circle cx="35" cy="35" r="20"/></clipPath><g id="g" clip-path="url(#c)">{SQUARE}</g>"#), "group 'g' is cut"),
        (format!(r#"<mask id="m"><circle cx="35" cy="35" r="20" fill="white"/></mask><g mask="url(#m)">{SQUARE}</g>"#), "a mask"),
        (format!(r#"<filter id="f"><feGaussianBlur stdDeviation="2"/></filter><g filter="url(#f)">{SQUARE}</g>"#), "a filter"),
        (format!(r#"<g style="mix-blend-mode:multiply">{SQUARE}</g>"#), "a blend mode"),
        (r#"<pattern id="p" width="4" height="4" patternUnits="userSpaceOnUse"><circle r="2"/></pattern><rect id="s" width="40" height="40" fill="url(#p)"/>"#.to_owned(), "element 's' is painted with a pattern"),
    ];
    for (body, reason) in cases {
        let drawing = read(&body);
        assert!(drawing.art.is_none() && drawing.picture.width > 1, "{body}");
        let said: Vec<String> = drawing.notes.iter().map(ToString::to_string).collect();
        assert!(said.iter().any(|note| note.contains(reason)), "{said:?}");
    }
}

#[test]
fn a_clip_around_the_whole_page_cuts_nothing() {
    let body =
        format!(r#"<clipPath id="c"><rect width="100" height="100"/></clipPath><g clip-path="url(#c)">{SQUARE}</g>"#);
    assert_eq!(ids(&art(&body)), ["s"]);
}

#[test]
fn overlapping_elements_of_a_translucent_group_are_noted() {
    let drawing = read(&format!(
        r#"<g opacity="0.5">{SQUARE}<rect width="30" height="30"/></g>"#
    ));
    assert!(drawing.notes.contains(&InputNote::TranslucentGroups { count: 1 }));
    let drawing = read(&format!(r#"<g opacity="0.5">{SQUARE}</g>"#));
    assert_eq!(drawing.notes, []);
}

#[test]
fn a_layer_is_its_element_alone() {
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><rect width="90" height="90" fill="red"/>
        <g id="arm"><rect x="20" y="20" width="30" height="30"/></g></svg>"#;
    let options = |extent| SvgOptions {
        element: Some("arm".to_owned()),
        extent,
        pixels_per_unit: Some(1.0),
        ..SvgOptions::default()
    };
    let layer = read_svg(text.as_bytes(), &options(Extent::Element)).expect("a drawing");
    assert_eq!(ids(layer.art.as_ref().expect("curves")), ["arm"]);
    assert_eq!(layer.picture.pixels[0], [0; 4]);
    let shape = read_svg(text.as_bytes(), &options(Extent::Everything)).expect("a drawing");
    assert_eq!(ids(shape.art.as_ref().expect("curves")), ["-", "arm"]);
    assert_eq!(shape.picture.pixels[0], [255, 0, 0, 255]);
    assert_eq!(layer.outline, shape.outline);
}
