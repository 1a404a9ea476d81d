//! What scenes say about the time of drawings is what files show.

use std::io::Cursor;

use image::AnimationDecoder as _;

use crate::workshop::Workshop;

/// Twelve frames of a loop, drawn as `animation` says.
fn scene(animation: &str) -> Workshop {
    let workshop = Workshop::new();
    let more = format!("[animation]\nfps = 6\nsize = [48, 36]\nbackground = \"transparent\"\n{animation}");
    workshop.two_poses("[0, 0]", "[1, 0]", &more);
    workshop
}

/// The files of a folder in order.
fn files(workshop: &Workshop, folder: &str) -> Vec<Vec<u8>> {
    let entries = std::fs::read_dir(workshop.path(folder)).expect("a folder");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("a file")).collect()
}

/// How long each picture of an animation is shown, in milliseconds.
fn delays(frames: image::Frames<'_>) -> Vec<u32> {
    let frames = frames.collect_frames().expect("frames");
    let delay = |frame: &image::Frame| {
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        numerator / denominator
    };
    frames.iter().map(delay).collect()
}

#[test]
fn on_twos_files_come_in_pairs_of_equal_bytes() {
    let workshop = scene("hold = 2\n");
    workshop.succeeds(&["render", "scene.toml", "-o", "twos"]);
    let twos = files(&workshop, "twos");
    assert_eq!(twos.len(), 12);
    for pair in twos.chunks(2) {
        assert_eq!(pair[0], pair[1]);
    }
    assert!(twos.chunks(2).zip(twos[2..].chunks(2)).all(|(a, b)| a[0] != b[0]));
    // A part of the frames is the same files, whichever of a pair are asked for.
    workshop.succeeds(&[
        "render",
        "scene.toml",
        "-o",
        "part",
        "--frames",
        "2,7-8",
        "--threads",
        "1",
    ]);
    assert_eq!(
        files(&workshop, "part"),
        [twos[1].clone(), twos[6].clone(), twos[7].clone()]
    );
    // What is there is known again.
    std::fs::remove_file(workshop.path("twos").join(last_of(&workshop))).expect("removed");
    let told = workshop.run(&["render", "scene.toml", "-o", "twos", "--resume"]);
    let told = String::from_utf8_lossy(&told.stderr).into_owned();
    assert!(told.contains("11 of 12 frames are already there"), "{told}");
    assert_eq!(files(&workshop, "twos"), twos);
}

/// The name of the last frame's file.
fn last_of(workshop: &Workshop) -> std::ffi::OsString {
    let entries = std::fs::read_dir(workshop.path("twos")).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    names.max().expect("a file")
}

#[test]
fn a_held_drawing_is_one_picture_with_a_longer_delay() {
    let held = scene("hold = 3\n");
    let ones = scene("");
    for kind in ["gif", "apng", "webp"] {
        let name = format!("out.{kind}");
        let [held, ones] = [&held, &ones].map(|workshop| {
            workshop.succeeds(&["render", "scene.toml", "-o", &name]);
            workshop.bytes(&name)
        });
        assert!(held.len() < ones.len(), "{kind}: {} of {}", held.len(), ones.len());
        let shown = match kind {
            "gif" => delays(
                image::codecs::gif::GifDecoder::new(Cursor::new(&held))
                    .expect("a GIF")
                    .into_frames(),
            ),
            "webp" => delays(
                image::codecs::webp::WebPDecoder::new(Cursor::new(&held))
                    .expect("a WebP")
                    .into_frames(),
            ),
            _ => {
                let decoder = image::codecs::png::PngDecoder::new(Cursor::new(&held)).expect("a PNG");
                delays(decoder.apng().expect("an APNG").into_frames())
            }
        };
        assert_eq!(shown, [500; 4], "{kind}");
    }
}

#[test]
fn a_key_has_a_hold_of_its_own() {
    let keys = "loop = false\nkeys = [ { time = 0, at = [0, 0] }, { time = 0.5, at = [0.4, 0], hold = 3 }, { time = 1.5, at = [1, 0] } ]\n";
    let workshop = scene(keys);
    workshop.succeeds(&["render", "scene.toml", "-o", "out"]);
    let frames = files(&workshop, "out");
    let repeats: Vec<bool> = frames.windows(2).map(|pair| pair[0] == pair[1]).collect();
    assert_eq!(repeats, [false, false, false, true, true, false, true, true, false]);
}

#[test]
fn without_a_hold_nothing_changes() {
    let (plain, ones) = (scene(""), scene("hold = 1\n"));
    for name in ["out.gif", "out.json"] {
        let [plain, ones] = [&plain, &ones].map(|workshop| {
            workshop.succeeds(&["render", "scene.toml", "-o", name]);
            workshop.bytes(name)
        });
        assert!(plain == ones, "{name}");
    }
}

#[test]
fn other_holds_are_refused_with_their_line() {
    for (text, line, what) in [
        ("hold = 4\n", 14, "[animation] hold is 4"),
        ("hold = 0\n", 14, "1, 2 or 3"),
        ("hold = \"twos\"\n", 14, "\"twos\""),
        (
            "\nkeys = [\n{ time = 0, at = [0, 0] },\n{ time = 1, at = [1, 0], hold = -1 } ]\n",
            17,
            "key 1",
        ),
    ] {
        let message = scene(text).fails(&["render", "scene.toml", "-o", "out"], 1);
        assert!(
            message.contains(&format!("scene.toml:{line}:")) && message.contains(what),
            "{message}"
        );
    }
}

#[test]
fn frames_before_a_key_lie_where_its_chart_says() {
    let keys = |spacing: &str| {
        format!(
            "fps = 5\nsize = [48, 36]\nkeys = [ {{ time = 0, at = [0, 0] }}, {{ time = 1, at = [1, 0]{spacing} }} ]\n"
        )
    };
    let rendered = |spacing: &str| {
        let workshop = Workshop::new();
        workshop.two_poses("[0, 0]", "[1, 0]", &format!("[animation]\n{}", keys(spacing)));
        workshop.succeeds(&["render", "scene.toml", "-o", "out.gif", "--certify"]);
        let lines = String::from_utf8(workshop.bytes("out.gif.certificates.jsonl")).expect("text");
        let place = |line: &str| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["at"][0].as_f64();
        lines.lines().filter_map(place).collect::<Vec<f64>>()
    };
    let near = |found: Vec<f64>, wanted: [f64; 6]| {
        assert_eq!(found.len(), wanted.len());
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
    };
    near(
        rendered(", spacing = [0.1, 0.3, 0.6, 0.85]"),
        [0.0, 0.1, 0.3, 0.6, 0.85, 1.0],
    );
    near(rendered(""), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
}

#[test]
fn charts_that_are_none_are_refused_with_their_line() {
    for (first, second, line, what) in [
        ("", "spacing = [0.2,\n1.5]", 17, "is 1.5"),
        ("", "spacing = [0.2, 0.5,\n0.4]", 17, "below the mark before, 0.5"),
        ("", "spacing = [-0.1]", 16, "between 0"),
        ("", "spacing = [nan]", 16, "between 0"),
        (", spacing = [0.5]", "hold = 2", 15, "no key before"),
        ("", "spacing = 0.5", 16, "0.5"),
    ] {
        let keys = format!("keys = [\n{{ time = 0, at = [0, 0]{first} }},\n{{ time = 1, at = [1, 0], {second} }} ]\n");
        let message = scene(&keys).fails(&["render", "scene.toml", "-o", "out"], 1);
        assert!(
            message.contains(&format!("scene.toml:{line}:")) && message.contains(what),
            "{message}"
        );
    }
}
