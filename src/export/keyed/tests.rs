use super::*;
use crate::math::Point;
use crate::render::Frame;
use crate::render::{
    Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stop, Stroke, Subpath,
    VectorGroup, VectorNode, VectorPicture, VectorShape,
};

pub(in crate::export) fn timing(repetition: Repetition) -> SampleTiming {
    SampleTiming {
        fps: 8.0,
        frame_count: 9,
        samples_a_frame: 4,
        repetition,
    }
}

/// A bar with round ends of one piece, turned about its end at (20, 20).
pub(in crate::export) fn bar(id: &str, turn_rad: f64) -> VectorShape {
    let (sin, cos) = turn_rad.sin_cos();
    let place = |x: f64, y: f64| Point::new(20.0 + cos * x - sin * y, 20.0 + sin * x + cos * y);
    VectorShape {
        id: id.to_owned(),
        subpaths: vec![Subpath {
            start: place(0.0, -3.0),
            cubics: vec![
                [place(5.0, -3.0), place(10.0, -3.0), place(15.0, -3.0)],
                [place(19.0, -3.0), place(19.0, 3.0), place(15.0, 3.0)],
                [place(10.0, 3.0), place(5.0, 3.0), place(0.0, 3.0)],
                [place(-4.0, 3.0), place(-4.0, -3.0), place(0.0, -3.0)],
            ],
            is_closed: true,
        }],
        fill: Some(Fill {
            paint: Paint::Solid([0.9, 0.5, 0.1, 1.0]),
            rule: FillRule::NonZero,
        }),
        stroke: None,
        opacity: 1.0,
    }
}

pub(in crate::export) fn shape(shape: VectorShape) -> VectorNode {
    VectorNode::Shape(Box::new(shape))
}

pub(in crate::export) fn frame_of(nodes: Vec<VectorNode>) -> VectorFrame {
    VectorFrame {
        size: [48, 48],
        background: Some([250, 250, 255, 255]),
        nodes,
    }
}

/// Everything that a drawing can hold, at `share` of the animation.
pub(in crate::export) fn everything(share: f64) -> VectorFrame {
    let turn_rad = std::f64::consts::TAU * share;
    let swing = turn_rad.sin();
    let stops = |red: f64| {
        vec![
            Stop {
                offset: 0.0,
                colour: [red, 0.2, 0.3, 1.0],
            },
            Stop {
                offset: 1.0,
                colour: [0.1, 0.2, 0.8, 0.5],
            },
        ]
    };
    let placement = Placement {
        along_x: Point::new(12.0, swing * 4.0),
        along_y: Point::new(-swing * 4.0, 12.0),
        origin: Point::new(24.0 + swing, 24.0),
    };
    let gradient = |kind| {
        Paint::Gradient(Gradient {
            kind,
            placement,
            spread: Spread::Pad,
            stops: stops(0.5 + 0.4 * swing),
        })
    };
    let mut disc = bar("disc", 0.3 * swing);
    disc.fill = Some(Fill {
        paint: gradient(GradientKind::Radial {
            focus: Point::new(0.3, 0.1 * swing),
        }),
        rule: FillRule::EvenOdd,
    });
    disc.opacity = 0.7 + 0.2 * swing;
    let mut line = bar("line", turn_rad);
    line.subpaths.push(Subpath {
        start: Point::new(4.0, 40.0),
        cubics: vec![[
            Point::new(14.0, 30.0 + 5.0 * swing),
            Point::new(24.0, 46.0),
            Point::new(44.0, 40.0),
        ]],
        is_closed: false,
    });
    line.fill = Some(Fill {
        paint: gradient(GradientKind::Linear),
        rule: FillRule::NonZero,
    });
    line.stroke = Some(Stroke {
        paint: Paint::Solid([0.1 + 0.1 * swing, 0.1, 0.1, 0.9]),
        width: 2.0 + swing,
        cap: LineCap::Round,
        join: LineJoin::Round,
        miter_limit: 4.0,
        dashes: vec![4.0, 2.5],
        dash_offset: 5.0 * swing,
    });
    let mut picture = Frame::filled(48, 48, [0; 4]);
    let at = (20.0 + 10.0 * swing).round() as usize;
    for y in 2..8 {
        for x in at..at + 6 {
            picture.pixels[y * 48 + x] = [0, 120, 60, 200];
        }
    }
    let mut inner = vec![
        shape(bar("arm & 1", -0.5 * swing)),
        shape(VectorShape {
            fill: Some(Fill {
                paint: Paint::Solid([0.2, 0.7, 0.4, 0.8]),
                rule: FillRule::NonZero,
            }),
            ..bar("arm 2", 0.5 + 0.5 * swing)
        }),
    ];
    if swing < -0.5 {
        inner.reverse();
    }
    let ring = |r: f64, turn: f64| -> Vec<Point> {
        (0..24)
            .map(|k| {
                let angle_rad = turn * std::f64::consts::TAU * f64::from(k) / 24.0;
                Point::new(24.0 + swing + r * angle_rad.cos(), 24.0 + r * angle_rad.sin())
            })
            .collect()
    };
    frame_of(vec![
        VectorNode::Picture(VectorPicture {
            id: "sky".to_owned(),
            frame: picture,
            opacity: 0.8,
        }),
        shape(disc),
        VectorNode::Group(VectorGroup {
            id: "arms".to_owned(),
            opacity: 0.9 - 0.1 * swing,
            clip: Some(vec![ring(18.0, 1.0), ring(4.0, -1.0)]),
            nodes: inner,
        }),
        shape(line),
    ])
}

pub(in crate::export) fn animation(repetition: Repetition) -> KeyedVector {
    let timing = timing(repetition);
    let last = timing.sample_count() - 1;
    let frames = (0..=last).map(|k| everything((k % last) as f64 / last as f64));
    KeyedVector::new(timing, frames).expect("alike frames")
}

#[test]
fn samples_end_where_the_animation_does() {
    assert_eq!(timing(Repetition::Once).sample_count(), 33);
    assert_eq!(timing(Repetition::Forever).sample_count(), 37);
    let single = SampleTiming {
        frame_count: 1,
        ..timing(Repetition::Once)
    };
    assert_eq!(single.sample_count(), 1);
    assert_eq!(timing(Repetition::Once).frame_of(6), 1.5);
}

#[test]
fn frames_that_differ_in_kind_are_refused() {
    let once = timing(Repetition::Once);
    let refusal = |second: VectorFrame| {
        KeyedVector::new(once, [frame_of(vec![shape(bar("a", 0.0))]), second])
            .expect_err("it differs")
            .to_string()
    };
    let mut longer = bar("a", 0.0);
    longer.subpaths[0].cubics.pop();
    let mut unfilled = bar("a", 0.0);
    unfilled.fill = None;
    for (nodes, what) in [
        (vec![shape(longer)], "number of curves"),
        (vec![shape(unfilled)], "the fill"),
        (vec![shape(bar("b", 0.0))], "place in the tree"),
        (Vec::new(), "presence"),
    ] {
        let message = refusal(frame_of(nodes));
        assert!(message.contains("sample 1") && message.contains(what), "{message}");
    }
    let twins = frame_of(vec![shape(bar("a", 0.0)), shape(bar("a", 1.0))]);
    assert!(KeyedVector::new(once, [twins]).is_err());
    let short = KeyedVector::new(once, [everything(0.0)]).expect("one frame");
    assert_eq!(
        short.to_smil(&KeyOptions::default()).map(|_| ()),
        Err(KeyedError::Count { given: 1, wanted: 33 })
    );
}

#[test]
fn unseen_points_lie_between_seen_ones() {
    let samples: Vec<Vec<f64>> = [5.0, 0.0, 9.0, 9.0, 3.0, 7.0].map(|value| vec![value]).to_vec();
    let seen = [false, true, false, false, true, false];
    let (mut options, timing) = (KeyOptions::default(), timing(Repetition::Once));
    let planner = Planner::new(&timing, &options);
    assert_eq!(
        planner.settled(&samples, &seen).concat(),
        [0.0, 0.0, 1.0, 2.0, 3.0, 3.0]
    );
    assert_eq!(planner.settled(&samples, &[true; 6]), samples);
    options.interpolation = KeyInterpolation::Held;
    let planner = Planner::new(&timing, &options);
    assert_eq!(
        planner.settled(&samples, &seen).concat(),
        [0.0, 0.0, 0.0, 0.0, 3.0, 3.0]
    );
}

#[test]
fn held_keys_are_where_what_is_shown_changes() {
    let timing = SampleTiming {
        samples_a_frame: 1,
        ..timing(Repetition::Once)
    };
    let drawn = |sample: usize| frame_of(vec![shape(bar("a", 0.2 * (sample / 2) as f64))]);
    let keyed = KeyedVector::new(timing, (0..9).map(drawn)).expect("alike");
    let options = KeyOptions {
        interpolation: KeyInterpolation::Held,
        ..KeyOptions::default()
    };
    let (text, report) = keyed.to_lottie("bar", &options).expect("Lottie");
    assert_eq!((report.keys, report.worst_px), (5, 0.0));
    let lottie: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut keys = Vec::new();
    moments(&lottie, &mut keys);
    assert_eq!(keys, [(0.0, true), (2.0, true), (4.0, true), (6.0, true), (8.0, false)]);
    let (text, report) = keyed.to_smil(&options).expect("SVG");
    assert_eq!(report.keys, 5);
    assert!(text.contains("calcMode=\"discrete\""), "{text}");
    assert!(
        text.contains("keyTimes=\"0;0.249999;0.499999;0.749999;0.999999\""),
        "{text}"
    );
}

/// The times of all key frames, and whether they are held.
fn moments(value: &serde_json::Value, found: &mut Vec<(f64, bool)>) {
    if let (Some(time), Some(_)) = (value["t"].as_f64(), value.get("s")) {
        found.push((time, value["h"] == 1));
    }
    match value {
        serde_json::Value::Array(list) => list.iter().for_each(|value| moments(value, found)),
        serde_json::Value::Object(map) => map.values().for_each(|value| moments(value, found)),
        _ => {}
    }
}

#[test]
fn pictures_are_kept_once_and_cut() {
    let keyed = animation(Repetition::Forever);
    let files = &keyed.pictures.files;
    assert_eq!(files.len(), 9);
    assert_eq!(files[0].place, [20, 2, 6, 6]);
    let image = image::load_from_memory(&files[0].png).expect("a PNG");
    assert_eq!((image.width(), image.height()), (6, 6));

    let once = timing(Repetition::Once);
    let frames = (0..once.sample_count()).map(|sample| everything(if sample < 16 { 0.0 } else { 0.25 }));
    let keyed = KeyedVector::new(once, frames).expect("alike");
    assert_eq!(keyed.pictures.files.len(), 2);
}
