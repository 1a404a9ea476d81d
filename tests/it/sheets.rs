//! Several pictures in one file are several poses: frames of animated files, cells of sheets; and one more drawing is one more pose.

use crate::workshop::Workshop;
use inbetween::scene::Scene;

fn names(workshop: &Workshop, scene: &str) -> Vec<String> {
    Scene::open(&workshop.path(scene)).expect("a scene").names()
}

fn two() -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses(
        "[0, 0]",
        "[1, 0]",
        "[animation]\nfps = 3\nloop = false\nsize = [48, 36]\n",
    );
    workshop
}

#[test]
fn frames_of_animated_files_are_poses() {
    let workshop = two();
    for kind in ["gif", "apng", "webp"] {
        let file = format!("clip.{kind}");
        workshop.succeeds(&["render", "scene.toml", "-o", &file]);
        workshop.succeeds(&["new", kind, &file]);
        let scene = format!("{kind}/scene.toml");
        assert_eq!(names(&workshop, &scene), ["clip-1", "clip-2", "clip-3", "clip-4"]);
        // The last frame is the wide box.
        let out = format!("{kind}.png");
        workshop.succeeds(&["frame", &scene, "--weights", "0,0,0,1", "--size", "48x36", "-o", &out]);
        let frame = image::open(workshop.path(&out)).expect("a picture").into_rgba8();
        let columns: Vec<u32> = (0..48)
            .filter(|&x| (0..36).any(|y| frame.get_pixel(x, y).0[3] > 200))
            .collect();
        let rows: Vec<u32> = (0..36)
            .filter(|&y| (0..48).any(|x| frame.get_pixel(x, y).0[3] > 200))
            .collect();
        assert!(
            columns.len() > 3 * rows.len() / 2,
            "{kind}: {} x {}",
            columns.len(),
            rows.len()
        );
    }
    let text = std::fs::read_to_string(workshop.path("gif/scene.toml")).expect("text");
    workshop.file("gif/scene.toml", text.replace("frame = 3", "frame = 7").as_bytes());
    let refusal = workshop.fails(&["map", "gif/scene.toml", "-o", "-"], 1);
    assert!(
        refusal.contains("clip-4") && refusal.contains("no frame 7") && refusal.contains("has 4"),
        "{refusal}"
    );
}

#[test]
fn cells_of_a_sheet_are_poses_but_for_empty_ones() {
    let workshop = Workshop::new();
    // Two columns and two rows of 20 x 20; a box that grows, and nothing in the last cell.
    workshop.picture("sheet.png", |x, y| {
        let (cell, x, y) = (x / 20 + 2 * (y / 20), x % 20, y % 20);
        let reach = 4 + cell;
        let is_box = cell < 3 && x.abs_diff(10) < reach && y.abs_diff(10) < 5;
        if is_box { [200, 40, 40, 255] } else { [0; 4] }
    });
    let output = workshop.run(&["new", "s", "sheet.png", "--cells", "2x2"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("3 of 4 cells") && said.contains("1 are empty"), "{said}");
    assert_eq!(names(&workshop, "s/scene.toml"), ["sheet-1", "sheet-2", "sheet-3"]);
    let camera = ["--camera", "drawing", "--size", "20x20"];
    let frame = |weights: &str| {
        let arguments = [
            &["frame", "s/scene.toml", "--weights", weights, "-o", "f.png"][..],
            &camera,
        ]
        .concat();
        workshop.succeeds(&arguments);
        let frame = image::open(workshop.path("f.png")).expect("a picture").into_rgba8();
        (0..20).filter(|&x| frame.get_pixel(x, 10).0[3] > 200).count()
    };
    assert_eq!([frame("1,0,0"), frame("0,1,0"), frame("0,0,1")], [7, 9, 11]);
    let text = std::fs::read_to_string(workshop.path("s/scene.toml")).expect("text");
    workshop.file("s/scene.toml", text.replace("cells = [2, 2]", "").as_bytes());
    let refusal = workshop.fails(&["frame", "s/scene.toml", "--weights", "1,0,0", "-o", "f.png"], 1);
    assert!(refusal.contains("cells = [COLUMNS, ROWS]"), "{refusal}");
}

#[test]
fn one_more_drawing_is_one_more_pose_with_its_landmarks_and_place() {
    let workshop = two();
    let landmark = "\n# A corner.\n[[landmark]]\nname = \"corner\"\nat = { tall = [12.0, 4.0], wide = [4.0, 12.0] }\n";
    let text = std::fs::read_to_string(workshop.path("scene.toml")).expect("text");
    workshop.file("scene.toml", (text + landmark).as_bytes());
    let other = Workshop::new();
    let elsewhere = |name: &str| other.path(name).to_string_lossy().into_owned();
    other.picture("square.png", |x, y| {
        if (10..30).contains(&x) && (11..31).contains(&y) {
            [120, 30, 120, 255]
        } else {
            [0; 4]
        }
    });
    workshop.succeeds(&["add", "scene.toml", &elsewhere("square.png")]);
    let scene = Scene::open(&workshop.path("scene.toml")).expect("a scene");
    assert_eq!(scene.names(), ["tall", "wide", "square"]);
    let place = scene.landmarks[0].at[2].expect("carried");
    assert!(
        (place - inbetween::math::Point::new(10.0, 11.0)).norm() < 1.0,
        "{place}"
    );
    // Half-way from the one to the other in shape, it lies between them in the pose space.
    assert!((0.25..0.75).contains(&scene.poses[2].at[0]), "{:?}", scene.poses[2].at);
    let text = std::fs::read_to_string(workshop.path("scene.toml")).expect("text");
    assert!(
        text.contains("# A corner.") && workshop.path("square.png").exists(),
        "{text}"
    );
    // A second one is another pose where it is told to be; a drawing that cannot be used leaves everything as it was.
    std::fs::copy(other.path("square.png"), workshop.path("box.png")).expect("copied");
    workshop.succeeds(&["add", "scene.toml", "box.png", "--at", "2,-1"]);
    assert_eq!(
        Scene::open(&workshop.path("scene.toml")).expect("a scene").poses[3].at,
        [2.0, -1.0]
    );
    let (before, listing) = (
        std::fs::read(workshop.path("scene.toml")).expect("bytes"),
        workshop.listing(),
    );
    other.file("broken.png", b"no picture");
    let refusal = workshop.fails(&["add", "scene.toml", &elsewhere("broken.png")], 1);
    assert!(refusal.contains("broken"), "{refusal}");
    assert_eq!(std::fs::read(workshop.path("scene.toml")).expect("bytes"), before);
    assert_eq!(workshop.listing(), listing);
}

/// A picture with boxes: left, top, width, height.
fn boxes(workshop: &Workshop, name: &str, size: [u32; 2], boxes: &[[u32; 4]]) {
    let picture = image::RgbaImage::from_fn(size[0], size[1], |x, y| {
        let is_inside = |[left, top, width, height]: &[u32; 4]| {
            (*left..left + width).contains(&x) && (*top..top + height).contains(&y)
        };
        image::Rgba(if boxes.iter().any(is_inside) {
            [200, 40, 30, 255]
        } else {
            [0; 4]
        })
    });
    picture.save(workshop.path(name)).expect("written");
}

#[test]
fn a_sheet_is_found_where_each_cell_has_a_figure() {
    let workshop = Workshop::new();
    let figures: Vec<[u32; 4]> = (0..6)
        .map(|k| [30 * (k % 3) + 8, 40 * (k / 3) + 6 + k, 12 + k, 26 - k])
        .collect();
    boxes(&workshop, "walk.png", [90, 80], &figures);
    let output = workshop.run(&["new", "w", "walk.png"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("sheet of 3 x 2 figures"), "{said}");
    assert_eq!(names(&workshop, "w/scene.toml").len(), 6, "{said}");
    // Whoever knows better says so.
    workshop.succeeds(&["new", "one", "walk.png", "--cells", "1x1"]);
    assert_eq!(names(&workshop, "one/scene.toml").len(), 1);
}

#[test]
fn one_figure_with_loose_parts_is_no_sheet() {
    let workshop = Workshop::new();
    let parts = [
        [25, 30, 34, 46],
        [30, 8, 24, 14],
        [66, 12, 6, 6],
        [74, 20, 5, 5],
        [10, 10, 6, 6],
    ];
    boxes(&workshop, "one.png", [90, 80], &parts);
    let output = workshop.run(&["new", "w", "one.png"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!said.contains("sheet"), "{said}");
    assert_eq!(names(&workshop, "w/scene.toml"), ["one"]);
}
