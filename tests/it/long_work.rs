//! Work that is long can be killed, resumed and run out of room.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::workshop::Workshop;

/// Enough frames that a run can be killed in the middle.
const ANIMATION: &str = "[animation]\nfps = 60\nsize = [160, 120]\nbackground = \"white\"\n";

fn two() -> Workshop {
    let workshop = Workshop::new();
    workshop.two_poses("[0, 0]", "[1, 0]", ANIMATION);
    workshop
}

/// The files of a folder with their bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return BTreeMap::new();
    };
    entries
        .map(|entry| entry.expect("an entry"))
        .map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, std::fs::read(entry.path()).expect("a file"))
        })
        .collect()
}

/// The command in the workshop's folder, saying nothing.
fn command(workshop: &Workshop, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_inbetween"));
    command
        .args(arguments)
        .current_dir(workshop.path(""))
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// Numbers that are the same every time (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % end
    }
}

#[test]
fn a_killed_run_is_resumed_to_the_same_bytes() {
    let workshop = two();
    let start = Instant::now();
    workshop.succeeds(&["render", "scene.toml", "-o", "whole", "--quiet"]);
    let duration = start.elapsed();
    let whole = files(&workshop.path("whole"));
    assert_eq!(whole.len(), 120);
    let mut numbers = Numbers(7);
    let mut interrupted = 0;
    for _ in 0..6 {
        let mut run = command(&workshop, &["render", "scene.toml", "-o", "part", "--resume"])
            .spawn()
            .expect("the command runs");
        std::thread::sleep(duration.mul_f64(numbers.below(900) as f64 / 1000.0));
        run.kill().expect("killed");
        run.wait().expect("ended");
        let part = files(&workshop.path("part"));
        for (name, bytes) in &part {
            // Only what has its name counts, and it is whole.
            assert!(
                name.ends_with(".part") || whole.get(name) == Some(bytes),
                "{name} is torn"
            );
        }
        interrupted += usize::from((1..120).contains(&part.len()));
        if part.len() >= 110 {
            for name in part.keys().skip(20) {
                std::fs::remove_file(workshop.path("part").join(name)).expect("removed");
            }
        }
    }
    assert!(
        interrupted > 0,
        "no run was killed between its first and its last frame"
    );
    std::fs::write(workshop.path("part/.inbetween-left.part"), b"half a frame").expect("written");
    workshop.succeeds(&["render", "scene.toml", "-o", "part", "--resume"]);
    assert!(files(&workshop.path("part")) == whole);
}

#[test]
fn a_killed_run_leaves_no_torn_file_of_any_kind() {
    let workshop = two();
    let before = workshop.listing();
    let mut numbers = Numbers(11);
    for output in ["a.gif", "a.apng", "a.webp"] {
        let start = Instant::now();
        workshop.succeeds(&["render", "scene.toml", "-o", output, "--quiet"]);
        let duration = start.elapsed();
        let whole = std::fs::read(workshop.path(output)).expect("there");
        std::fs::remove_file(workshop.path(output)).expect("removed");
        for _ in 0..3 {
            let mut run = command(&workshop, &["render", "scene.toml", "-o", output])
                .spawn()
                .expect("the command runs");
            std::thread::sleep(duration.mul_f64(0.3 + numbers.below(600) as f64 / 1000.0));
            run.kill().expect("killed");
            run.wait().expect("ended");
            if let Ok(bytes) = std::fs::read(workshop.path(output)) {
                assert!(bytes == whole, "{output} is torn");
            }
        }
        workshop.succeeds(&["render", "scene.toml", "-o", output, "--quiet"]);
        assert!(std::fs::read(workshop.path(output)).expect("there") == whole);
        std::fs::remove_file(workshop.path(output)).expect("removed");
    }
    assert_eq!(workshop.listing(), before, "what killed runs left was cleaned up");
}

#[test]
fn frames_of_another_scene_or_other_settings_are_rendered_again() {
    let workshop = two();
    let render = |more: &[&str]| {
        let arguments = [&["render", "scene.toml", "-o", "f", "--frames", "1-4"], more].concat();
        let output = workshop.run(&arguments);
        assert!(output.status.success());
        String::from_utf8(output.stderr).expect("text")
    };
    let resumed = |more: &[&str]| {
        let told = render(&[&["--resume"], more].concat());
        let line = told
            .lines()
            .find(|line| line.contains("already there"))
            .expect("told")
            .to_owned();
        line.split(' ')
            .next()
            .expect("a number")
            .parse::<usize>()
            .expect("a number")
    };
    render(&[]);
    let first = files(&workshop.path("f"));
    assert_eq!(resumed(&[]), 4);
    assert!(files(&workshop.path("f")) == first);
    // A frame that is not whole, and one that is another frame's.
    let names: Vec<&String> = first.keys().collect();
    let path = |k: usize| workshop.path("f").join(names[k]);
    std::fs::write(path(0), &first[names[0]][..100]).expect("written");
    std::fs::copy(path(2), path(1)).expect("copied");
    assert_eq!(resumed(&[]), 2);
    assert!(files(&workshop.path("f")) == first);
    // Other settings, another drawing, another scene file.
    for other in [
        ["--size", "80x60"],
        ["--fps", "30"],
        ["--background", "black"],
        ["--supersample", "2"],
    ] {
        assert_eq!(resumed(&other), 0, "{other:?}");
        assert_eq!(resumed(&other), 4, "{other:?}");
        assert_eq!(resumed(&[]), 0, "{other:?}");
    }
    std::fs::copy(workshop.path("tall.png"), workshop.path("kept.png")).expect("copied");
    workshop.picture("tall.png", |x, y| {
        [0, 90, 0, if x > 14 && x < 26 && y > 4 && y < 36 { 255 } else { 0 }]
    });
    assert_eq!(resumed(&[]), 0);
    std::fs::copy(workshop.path("kept.png"), workshop.path("tall.png")).expect("copied");
    render(&[]);
    workshop.two_poses("[0, 0]", "[1, 0]", &format!("{ANIMATION}[texture]\nsharpness = 0.1\n"));
    assert_eq!(resumed(&[]), 0);
    // Any file of another kind is written whole.
    let message = workshop.fails(&["render", "scene.toml", "-o", "a.webp", "--resume"], 2);
    assert!(message.contains("written whole"), "{message}");
}

/// Runs the command in a shell after `before`, and gives its code and what it says.
#[cfg(unix)]
fn in_shell(workshop: &Workshop, before: &str, arguments: &str) -> (Option<i32>, String) {
    let script = format!("{before}; exec '{}' {arguments}", env!("CARGO_BIN_EXE_inbetween"));
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(workshop.path(""))
        .output()
        .expect("bash runs");
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    )
}

/// As on a full disk: every file may have 4 KiB.
#[cfg(unix)]
#[test]
fn a_file_that_finds_no_room_is_not_there() {
    let workshop = two();
    let before = workshop.listing();
    for output in [
        "a.gif",
        "a.apng",
        "a.webp",
        "frames --size 900x700",
        "a.png --format sprites --size 900x700",
    ] {
        let (code, message) = in_shell(
            &workshop,
            "ulimit -f 4",
            &format!("render scene.toml --frames 1-20 -o {output}"),
        );
        assert_eq!(code, Some(1), "{output}: {message}");
        assert!(message.contains("cannot write"), "{output}: {message}");
        assert_eq!(workshop.listing(), before, "{output}");
    }
}

#[cfg(target_os = "linux")]
#[test]
#[expect(clippy::print_stderr, reason = "a test that is left out says so")]
fn a_full_disk_is_an_error_and_leaves_nothing() {
    let workshop = two();
    std::fs::create_dir(workshop.path("disk")).expect("a folder");
    // In a mount namespace of its own, so that nothing is left mounted.
    let script = format!(
        "mount -t tmpfs -o size=12k tmpfs disk || exit 77; \
         for output in frames a.gif a.webp $(command -v ffmpeg > /dev/null && echo a.mp4 a.webm); do \
             '{}' render scene.toml -o disk/$output --size 901x701 --frames 1-20 --background '#abc123'; \
             echo $output $? $(ls -A disk); rm -rf disk/* disk/.inb*; \
         done",
        env!("CARGO_BIN_EXE_inbetween")
    );
    let output = Command::new("unshare")
        .args(["-rm", "bash", "-c", &script])
        .current_dir(workshop.path(""))
        .output();
    let output = match output {
        Ok(output) if output.status.code() == Some(0) => output,
        other => {
            // Namespaces are not permitted everywhere.
            eprintln!("SKIPPED: no small disk can be mounted here: {other:?}");
            return;
        }
    };
    let (said, errors) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    let lines: Vec<&str> = said.lines().collect();
    // Whole frames of the sequence may be there, nothing else.
    assert_eq!(lines[0], "frames 1 frames", "{errors}");
    for (line, output) in lines[1..].iter().zip(["a.gif", "a.webp", "a.mp4", "a.webm"]) {
        assert_eq!(*line, format!("{output} 1"), "{errors}");
    }
    assert!(lines.len() >= 3 && errors.contains("No space left"), "{said}{errors}");
}

#[cfg(unix)]
#[test]
fn a_video_without_ffmpeg_is_refused_with_a_remedy() {
    let workshop = two();
    let before = workshop.listing();
    for output in ["a.mp4", "a.webm"] {
        let (code, message) = in_shell(&workshop, "PATH=/nowhere", &format!("render scene.toml -o {output}"));
        assert_eq!(code, Some(1), "{message}");
        assert!(
            message.contains("install ffmpeg") && message.contains(".webp"),
            "{message}"
        );
        assert_eq!(workshop.listing(), before);
    }
}

/// An ffmpeg of our own: one that fails with a message, and one that never ends by itself.
#[cfg(unix)]
#[test]
fn an_ffmpeg_that_fails_is_heard_and_one_that_hangs_is_ended() {
    use std::os::unix::fs::PermissionsExt as _;
    let workshop = two();
    std::fs::create_dir(workshop.path("bin")).expect("a folder");
    let ffmpeg = |script: &str| {
        let path = workshop.path("bin/ffmpeg");
        std::fs::write(&path, format!("#!/bin/bash\n{script}\n")).expect("written");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("executable");
    };
    let run = || {
        in_shell(
            &workshop,
            "PATH=$PWD/bin:$PATH",
            "render scene.toml -o a.mp4 --size 300x200",
        )
    };
    ffmpeg("head -c 1000 > /dev/null; echo 'Unknown encoder' >&2; exit 1");
    let before = workshop.listing();
    let (code, message) = run();
    assert_eq!(code, Some(1), "{message}");
    assert!(
        message.contains("Unknown encoder") && message.contains("a.mp4"),
        "{message}"
    );
    assert_eq!(workshop.listing(), before);
    // It never reads: the command is killed while it waits for it, and the drawing is bad besides.
    ffmpeg("echo $$ > pid; exec sleep 60");
    std::fs::write(workshop.path("tall.png"), b"no picture").expect("written");
    let start = Instant::now();
    let (code, _) = run();
    assert_eq!(code, Some(1));
    assert!(start.elapsed() < Duration::from_secs(30), "ffmpeg was waited for");
    let text = std::fs::read_to_string(workshop.path("pid")).unwrap_or_default();
    assert!(
        text.is_empty() || !Path::new("/proc").join(text.trim()).exists(),
        "ffmpeg still runs"
    );
}
