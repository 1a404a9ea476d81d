//! Holes that poses do not share, through the real command: the mesh covers them, and the pictures open and close them.

use std::path::Path;

use crate::workshop::Workshop;
use inbetween::input::read_picture;
use inbetween::pose::Mapping;

/// A disc of ink, and the same with a hole off its middle, on nothing.
fn disc_and_ring() -> Workshop {
    let workshop = Workshop::new();
    let within = |x: u32, y: u32, at: (f64, f64), radius: f64| {
        (f64::from(x) + 0.5 - at.0).hypot(f64::from(y) + 0.5 - at.1) < radius
    };
    let ink = |drawn: bool| if drawn { [30, 60, 90, 255] } else { [0; 4] };
    workshop.picture("disc.png", move |x, y| ink(within(x, y, (20.0, 20.0), 17.0)));
    workshop.picture("ring.png", move |x, y| {
        ink(within(x, y, (20.0, 20.0), 17.0) && !within(x, y, (24.0, 20.0), 6.0))
    });
    workshop.scene(
        "[[pose]]\nname = \"disc\"\nsource = \"disc.png\"\nat = [0, 0]\n\
         [[pose]]\nname = \"ring\"\nsource = \"ring.png\"\nat = [1, 0]\n",
    );
    workshop
}

/// The smallest alpha in a file.
fn least_inside(file: &Path) -> u8 {
    let picture = read_picture(&std::fs::read(file).expect("a frame")).expect("a picture");
    // The hole lies within the middle third.
    let (width, height) = (picture.width, picture.height);
    let rows = height / 3..2 * height / 3;
    let inside = rows.flat_map(|y| (width / 3..2 * width / 3).map(move |x| y * width + x));
    inside.map(|at| picture.pixels[at][3]).min().unwrap_or(255)
}

#[test]
fn a_hole_that_one_pose_has_is_covered_by_the_mesh_and_written_as_seen() {
    let workshop = disc_and_ring();
    workshop.succeeds(&["map", "scene.toml", "-o", "mapping.json"]);
    let text = std::fs::read_to_string(workshop.path("mapping.json")).expect("a mapping");
    let mapping = Mapping::from_json(&text).expect("a mapping");
    mapping.check().expect("valid");
    assert_eq!(mapping.rings.len(), 1);
    let open: Vec<usize> = mapping
        .outlines
        .iter()
        .map(|outline| outline.openings().len())
        .collect();
    assert_eq!(open, [0, 1]);
    assert!(mapping.outlines.iter().all(|outline| outline.holes().is_empty()));
    // What was written is what is read, the opening among the holes.
    assert_eq!(mapping.to_json(), text);
}

#[test]
fn it_is_open_at_its_pose_closed_at_the_other_and_half_open_between() {
    let workshop = disc_and_ring();
    let alpha = |weights: &str| {
        workshop.succeeds(&[
            "frame",
            "scene.toml",
            "--weights",
            weights,
            "--size",
            "120x120",
            "-o",
            "frame.png",
        ]);
        least_inside(&workshop.path("frame.png"))
    };
    assert_eq!(alpha("1,0"), 255);
    assert_eq!(alpha("0,1"), 0);
    let half = alpha("0.5,0.5");
    assert!((64..192).contains(&half), "{half}");
}
