//! What is promised of animations.

use super::*;
use proptest::prelude::*;

fn key(time: f64, x: f64, y: f64) -> Key {
    Key::new(time, vec![x, y])
}

#[test]
fn two_keys_are_a_straight_even_path() {
    let path = Animation::new(vec![key(1.0, 0.0, 0.0), key(3.0, 4.0, 2.0)], false).expect("keys");
    assert_eq!(path.at(1.5), vec![1.0, 0.5]);
    assert_eq!(path.at(0.0), vec![0.0, 0.0]);
    assert_eq!(path.at(9.0), vec![4.0, 2.0]);
    assert_eq!(path.frame_count(), 49);
    assert_eq!(path.time_of_frame(48), 3.0);
}

#[test]
fn a_hold_rests() {
    let keys = vec![
        key(0.0, 0.0, 0.0),
        key(1.0, 1.0, 0.0),
        key(2.0, 1.0, 0.0),
        key(3.0, 0.0, 1.0),
    ];
    let path = Animation::new(keys, false).expect("keys");
    for k in 0..=10 {
        assert_eq!(path.at(1.0 + f64::from(k) / 10.0), vec![1.0, 0.0]);
    }
}

#[test]
fn a_loop_that_repeats_its_first_key_ends_there() {
    let keys = vec![key(0.0, 0.0, 0.0), key(1.0, 1.0, 0.0), key(2.5, 0.0, 0.0)];
    let path = Animation::new(keys, true).expect("keys");
    assert_eq!(path.duration(), 2.5);
    assert_eq!(path.frame_count(), 60);
    assert_eq!(path.at(2.5), path.at(0.0));
    let given: Vec<Key> = path.given_keys().cloned().collect();
    assert_eq!((path.keys().len(), given.len()), (2, 3));
    assert_eq!(Animation::new(given, true).expect("keys"), path);
}

#[test]
fn one_key_is_one_frame() {
    let path = Animation::new(vec![key(0.0, 0.3, 0.4)], true).expect("keys");
    assert_eq!((path.frame_count(), path.time_of_frame(0)), (1, 0.0));
    assert_eq!(path.at(7.0), vec![0.3, 0.4]);
}

#[test]
fn keys_that_are_no_animation_are_refused() {
    let refused = |keys: Vec<Key>| Animation::new(keys, true).expect_err("no animation");
    assert_eq!(refused(vec![]), AnimationError::NoKey);
    assert_eq!(
        refused(vec![key(0.0, f64::NAN, 0.0)]),
        AnimationError::NotFinite { index: 0 }
    );
    let (time, before) = (1.0, 1.0);
    assert_eq!(
        refused(vec![key(1.0, 0.0, 0.0), key(1.0, 1.0, 0.0)]),
        AnimationError::KeyOrder { index: 1, time, before }
    );
    let line = Key::new(2.0, vec![0.5]);
    let (found, expected) = (1, 2);
    assert_eq!(
        refused(vec![key(1.0, 0.0, 0.0), line]),
        AnimationError::Dimension {
            index: 1,
            found,
            expected
        }
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn passes_through_its_keys_with_continuous_velocity(
        steps in prop::collection::vec((0.1..2.0f64, -3.0..3.0f64, -3.0..3.0f64), 2..7),
        looped: bool,
    ) {
        let mut time = 0.0;
        let keys: Vec<Key> = steps.iter().map(|(dt, x, y)| { time += dt; key(time, *x, *y) }).collect();
        let path = Animation::new(keys.clone(), looped).expect("keys");
        for k in &keys {
            for (a, b) in path.at(k.time).iter().zip(&k.at) {
                prop_assert!((a - b).abs() < 1e-9);
            }
        }
        // The velocity from both sides of each key, ends of an open path left out.
        let inner = if looped { 0..keys.len() } else { 1..keys.len() - 1 };
        for k in inner {
            let (h, t) = (1e-6, keys[k].time);
            let (before, here, after) = (path.at(t - h), path.at(t), path.at(t + h));
            for d in 0..2 {
                let jump = (after[d] - 2.0 * here[d] + before[d]).abs() / h;
                prop_assert!(jump < 0.05, "velocity jumps by {jump} at key {k}");
            }
        }
    }
}

/// The frames whose drawings are shown at the first `count` frames.
fn drawn(animation: &Animation, count: usize) -> Vec<usize> {
    (0..count).map(|index| animation.drawn_frame(index)).collect()
}

#[test]
fn on_twos_and_threes_frames_repeat() {
    let mut animation = Animation::new(vec![key(0.0, 0.0, 0.0), key(0.7, 7.0, 0.0)], false).expect("keys");
    animation.fps = 10.0;
    assert_eq!(drawn(&animation, 8), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert!(!animation.is_held());
    animation.hold = Hold::Twos;
    assert_eq!(drawn(&animation, 8), [0, 0, 2, 2, 4, 4, 6, 6]);
    assert_eq!(animation.place_of_frame(5), animation.at(0.4));
    animation.hold = Hold::Threes;
    assert_eq!(drawn(&animation, 8), [0, 0, 0, 3, 3, 3, 6, 6]);
    // At half the rate a hold is as many frames, and twice as long.
    animation.fps = 5.0;
    assert_eq!(drawn(&animation, 5), [0, 0, 0, 3, 3]);
    assert!(animation.is_held());
}

#[test]
fn a_hold_of_a_key_counts_from_the_key_to_the_next_one() {
    let mut keys = vec![
        key(0.0, 0.0, 0.0),
        key(0.3, 1.0, 0.0),
        key(0.7, 2.0, 0.0),
        key(1.2, 3.0, 0.0),
    ];
    keys[1].hold = Some(Hold::Threes);
    let mut animation = Animation::new(keys, false).expect("keys");
    animation.fps = 10.0;
    assert_eq!(drawn(&animation, 13), [0, 1, 2, 3, 3, 3, 6, 7, 8, 9, 10, 11, 12]);
    // The animation's own hold is counted anew where it is in force again.
    animation.hold = Hold::Twos;
    assert_eq!(drawn(&animation, 13), [0, 0, 2, 3, 3, 3, 6, 7, 7, 9, 9, 11, 11]);
}

#[test]
fn keys_without_a_hold_leave_the_count_alone() {
    let mut keys = vec![
        key(0.0, 0.0, 0.0),
        key(0.3, 1.0, 0.0),
        key(0.55, 2.0, 0.0),
        key(0.8, 3.0, 0.0),
    ];
    let mut animation = Animation::new(keys.clone(), false).expect("keys");
    (animation.fps, animation.hold) = (10.0, Hold::Twos);
    assert_eq!(drawn(&animation, 9), [0, 0, 2, 2, 4, 4, 6, 6, 8]);
    // A key between frames is at the next one; one with a hold is drawn.
    keys[2].hold = Some(Hold::Ones);
    let mut animation = Animation::new(keys, false).expect("keys");
    (animation.fps, animation.hold) = (10.0, Hold::Twos);
    assert_eq!(drawn(&animation, 9), [0, 0, 2, 2, 4, 4, 6, 7, 8]);
}

#[test]
fn loops_are_counted_anew_each_time_around() {
    let keys = vec![key(1.0, 0.0, 0.0), key(1.4, 1.0, 0.0), key(1.7, 0.0, 0.0)];
    let mut animation = Animation::new(keys, true).expect("keys");
    (animation.fps, animation.hold) = (10.0, Hold::Twos);
    assert_eq!(drawn(&animation, 10), [0, 0, 2, 2, 4, 4, 6, 7, 7, 9]);
    let poses = [[0.0, 0.0], [1.0, 0.0]];
    let mut visiting = Animation::visiting(poses.iter().map(|at| at.as_slice()), true).expect("places");
    visiting.hold = Hold::Twos;
    let moved = visiting.through([[2.0, 0.0].as_slice(), &[3.0, 0.0]]).expect("places");
    assert_eq!(moved.hold, Hold::Twos);
    assert_eq!(moved.place_of_frame(47), moved.place_of_frame(46));
}

#[test]
fn holds_have_numbers() {
    assert_eq!(Hold::ALL.map(Hold::frames), [1, 2, 3]);
    assert_eq!(
        Hold::ALL.map(|hold| Hold::of_frames(hold.frames() as i64)),
        Hold::ALL.map(Some)
    );
    assert_eq!([0, 4, -1].map(Hold::of_frames), [None; 3]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_drawing_is_shown_for_longer_than_the_longest_hold(
        steps in prop::collection::vec((0.01..0.5f64, 0..4i64), 1..8),
        fps in 1.0..60.0f64,
        hold in 1..4i64,
        looped: bool,
    ) {
        let mut time = 0.0;
        let keys: Vec<Key> = steps.iter().map(|(dt, hold)| {
            time += dt;
            Key { hold: Hold::of_frames(*hold), ..key(time, time, 1.0) }
        }).collect();
        let mut animation = Animation::new(keys, looped).expect("keys");
        animation.fps = fps;
        animation.hold = Hold::of_frames(hold).expect("a hold");
        let drawn = drawn(&animation, animation.frame_count());
        for (index, frame) in drawn.iter().enumerate() {
            prop_assert!(*frame <= index && index - frame < 3);
            // A frame that is drawn shows itself, and a drawing never comes back.
            prop_assert_eq!(drawn[*frame], *frame);
        }
        prop_assert!(drawn.is_sorted());
    }
}

#[test]
fn a_chart_is_met_at_its_steps_and_the_way_stays() {
    let marks = vec![0.1, 0.3, 0.6, 0.85];
    let mut keys = vec![key(1.0, 0.0, 0.0), key(2.0, 10.0, -20.0)];
    keys[1].spacing.clone_from(&marks);
    let mut path = Animation::new(keys.clone(), false).expect("keys");
    for (fps, frames_a_step) in [(5.0, 1), (10.0, 2), (60.0, 12)] {
        path.fps = fps;
        for (k, mark) in marks.iter().enumerate() {
            let place = path.place_of_frame((k + 1) * frames_a_step);
            for (a, b) in place.iter().zip([10.0 * mark, -20.0 * mark]) {
                assert!(
                    (a - b).abs() < 1e-9,
                    "{place:?} at mark {mark} with {fps} frames a second"
                );
            }
        }
    }
    // At half the rate every second mark is seen: frames are 0.4 s apart.
    path.fps = 2.5;
    assert!((path.place_of_frame(1)[0] - 3.0).abs() < 1e-9 && (path.place_of_frame(2)[0] - 8.5).abs() < 1e-9);
    assert_eq!((path.at(1.0), path.at(2.0)), (vec![0.0, 0.0], vec![10.0, -20.0]));
    // Once more through other keys: on a bent way the marks are the parameter's.
    keys.push(key(3.0, 0.0, 0.0));
    let charted = Animation::new(keys.clone(), false).expect("keys");
    keys[1].spacing.clear();
    let even = Animation::new(keys, false).expect("keys");
    for (k, mark) in marks.iter().enumerate() {
        let (a, b) = (charted.at(1.0 + 0.2 * (k + 1) as f64), even.at(1.0 + mark));
        assert!(
            a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9),
            "{a:?} is not {b:?}"
        );
    }
    assert_eq!(charted.at(2.5), even.at(2.5));
}

#[test]
fn the_last_key_of_a_loop_spaces_the_way_back() {
    let mut keys = vec![key(0.0, 0.0, 0.0), key(1.0, 4.0, 0.0), key(2.0, 0.0, 0.0)];
    keys[2].spacing = vec![1.0];
    let path = Animation::new(keys, true).expect("keys");
    for (time, x) in [(1.5, 0.0), (1.75, 0.0), (3.5, 0.0), (1.0, 4.0)] {
        assert!((path.at(time)[0] - x).abs() < 1e-9, "{:?} at {time}", path.at(time));
    }
    let given: Vec<Key> = path.given_keys().cloned().collect();
    assert_eq!(given[2].spacing, [1.0]);
    assert_eq!(Animation::new(given, true).expect("keys"), path);
}

#[test]
fn charts_that_are_none_are_refused() {
    let refused = |index: usize, spacing: &[f64]| {
        let mut keys = vec![key(0.0, 0.0, 0.0), key(1.0, 1.0, 0.0)];
        keys[index].spacing = spacing.to_vec();
        Animation::new(keys, false).expect_err("no chart")
    };
    assert_eq!(refused(0, &[0.5]), AnimationError::SpacingWithoutWay { index: 0 });
    let (index, value, before) = (1, 0.4, 0.5);
    assert_eq!(
        refused(1, &[0.5, 0.4]),
        AnimationError::SpacingOrder {
            index,
            mark: 1,
            value,
            before
        }
    );
    for value in [-0.1, 1.1, f64::INFINITY] {
        assert_eq!(
            refused(1, &[value]),
            AnimationError::SpacingRange { index, mark: 0, value }
        );
    }
    assert!(matches!(refused(1, &[f64::NAN]), AnimationError::SpacingRange { .. }));
}
