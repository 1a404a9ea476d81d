use super::*;
use crate::export::Repetition;
use crate::export::keyed::tests::{animation, bar, everything, frame_of, shape, timing};
use crate::math::Point;
use proptest::prelude::*;

/// What resvg makes of a document, colours multiplied by alpha.
fn drawn(text: &str) -> Vec<u8> {
    let options = resvg::usvg::Options::default();
    let tree = resvg::usvg::Tree::from_str(text, &options).expect("an SVG document");
    let size = tree.size().to_int_size();
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height()).expect("a size");
    resvg::render(&tree, tiny_skia::Transform::identity(), &mut pixels.as_mut());
    pixels.data().to_vec()
}

#[test]
fn a_frame_is_drawn_as_our_own_rasteriser_draws_it() {
    for share in [0.0, 0.2, 0.75] {
        let mut frame = everything(share);
        // The reference is built without bitmaps.
        frame.nodes.remove(0);
        let theirs = drawn(&svg_text(&frame).expect("a frame"));
        let ours = frame.rasterise(1);
        let differences = ours
            .pixels
            .iter()
            .flatten()
            .zip(&theirs)
            .map(|(a, b)| f64::from(a.abs_diff(*b)));
        let mean = differences.sum::<f64>() / theirs.len() as f64;
        assert!(mean < 0.8, "mean difference {mean} at {share}");
    }
}

#[test]
fn a_document_says_no_more_than_it_must() {
    let mut frame = frame_of(vec![shape(bar("arm", 0.0))]);
    frame.background = None;
    let mut unseen = bar("unseen", 0.0);
    unseen.opacity = 0.0;
    frame.nodes.push(shape(unseen));
    let text = svg_text(&frame).expect("a frame");
    assert_eq!(
        text,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         viewBox=\"0 0 48 48\" width=\"48\" height=\"48\">\n \
         <path id=\"arm\" d=\"M20 17C25 17 30 17 35 17C39 17 39 23 35 23C30 23 25 23 20 23C16 23 16 17 20 17Z\" \
         fill=\"#e6801a\"/>\n\
         </svg>\n"
    );
}

/// The values of every animation of `attribute`, and their times.
fn animations(text: &str, attribute: &str) -> Vec<(Vec<f64>, Vec<String>)> {
    let mark = format!("attributeName=\"{attribute}\"");
    let of = |line: &str, name: &str| -> String {
        let rest = line.split(&format!(" {name}=\"")).nth(1).expect("the attribute");
        rest.split('"').next().expect("its end").to_owned()
    };
    text.lines()
        .filter(|line| line.contains(&mark))
        .map(|line| {
            let times = of(line, "keyTimes")
                .split(';')
                .map(|t| t.parse().expect("a time"))
                .collect();
            (times, of(line, "values").split(';').map(str::to_owned).collect())
        })
        .collect()
}

#[test]
fn keys_are_alike_and_loops_close() {
    for repetition in [Repetition::Once, Repetition::Forever] {
        let (text, report) = animation(repetition).to_smil(&KeyOptions::default()).expect("complete");
        let paths = animations(&text, "d");
        assert_eq!(paths.len(), 5, "disc, two arms, line and clip move");
        for (times, values) in &paths {
            assert_eq!(times.len(), values.len());
            assert_eq!((times[0], times[times.len() - 1]), (0.0, 1.0));
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
            let commands = |value: &str| -> String { value.chars().filter(char::is_ascii_alphabetic).collect() };
            assert!(values.iter().all(|value| commands(value) == commands(&values[0])));
            assert_eq!(
                values[0],
                values[values.len() - 1],
                "the animation ends where it starts"
            );
        }
        assert!(report.worst_px > 0.0 && report.worst_px <= 0.25, "{report:?}");
        assert!(report.worst_step > 0.0 && report.worst_step <= 1.0, "{report:?}");
        let ends = match repetition {
            Repetition::Once => "fill=\"freeze\"",
            Repetition::Forever => "repeatCount=\"indefinite\"",
        };
        let animated = text.lines().filter(|line| line.contains("<animate"));
        assert!(animated.clone().count() > 10 && animated.clone().all(|line| line.contains(ends)));
        assert_eq!(animations(&text, "display").len(), 2 + images(&text));
    }
}

fn images(text: &str) -> usize {
    text.matches("<image").count()
}

#[test]
fn fewer_errors_cost_more_keys() {
    let keyed = animation(Repetition::Forever);
    let keys = |max_error_px| {
        let options = KeyOptions {
            max_error_px,
            ..KeyOptions::default()
        };
        let (_, report) = keyed.to_smil(&options).expect("complete");
        assert!(report.worst_px <= max_error_px);
        report.keys
    };
    assert!(keys(0.1) > keys(0.5));
}

#[test]
fn what_rests_has_no_keys() {
    let once = timing(Repetition::Once);
    let frames = (0..once.sample_count()).map(|_| frame_of(vec![shape(bar("arm", 0.4))]));
    let keyed = KeyedVector::new(once, frames).expect("alike");
    let (text, report) = keyed.to_smil(&KeyOptions::default()).expect("complete");
    assert!(!text.contains("<animate"));
    assert_eq!(report, KeyReport::default());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Linear gradients need no map: the colour of every point is where it was.
    #[test]
    fn the_ends_of_a_linear_gradient_stand_for_its_map(
        values in proptest::array::uniform6(-5.0..5.0f64),
        share in (-2.0..2.0f64, -2.0..2.0f64),
    ) {
        let [a, b, c, d, e, f] = values;
        prop_assume!((a * d - b * c).abs() > 0.5);
        let placement = crate::render::Placement {
            along_x: Point::new(a, b),
            along_y: Point::new(c, d),
            origin: Point::new(e, f),
        };
        let [start, end] = linear_ends(&placement);
        let place = placement.origin + placement.along_x * share.0 + placement.along_y * share.1;
        let along = end - start;
        let offset = (place - start).dot(&along) / along.norm_squared();
        prop_assert!((offset - share.0).abs() < 1e-9, "{} {}", offset, share.0);
    }
}
