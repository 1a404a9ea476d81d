//! A temporary folder with drawings and scenes, and the real command run in it.

use std::path::PathBuf;
use std::process::{Command, Output};

/// The side of the test drawings, in pixels.
const SIDE: u32 = 40;

/// A folder that vanishes at the end.
pub(crate) struct Workshop {
    folder: tempfile::TempDir,
}

#[allow(dead_code, reason = "each test program uses its own part")]
impl Workshop {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a folder"),
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).expect(name)
    }

    /// A scene file: the version, then `text` from line 2.
    pub(crate) fn scene(&self, text: &str) {
        self.file("scene.toml", format!("version = 1\n{text}").as_bytes());
    }

    /// A picture of 40 x 40 pixels.
    pub(crate) fn picture(&self, name: &str, pixel: impl Fn(u32, u32) -> [u8; 4]) {
        image::RgbaImage::from_fn(SIDE, SIDE, |x, y| image::Rgba(pixel(x, y)))
            .save(self.path(name))
            .expect("written");
    }

    /// A scene of a tall red and a wide blue box at two places, with `more` from line 10.
    pub(crate) fn two_poses(&self, tall_at: &str, wide_at: &str, more: &str) {
        let within = |v: u32, low: u32, high: u32| (low..high).contains(&v);
        self.picture("tall.png", |x, y| {
            if within(x, 12, 28) && within(y, 4, 36) {
                [220, 30, 20, 255]
            } else {
                [0; 4]
            }
        });
        self.picture("wide.png", |x, y| {
            if within(x, 4, 36) && within(y, 12, 28) {
                [20, 30, 220, 255]
            } else {
                [0; 4]
            }
        });
        self.scene(&format!(
            "[[pose]]\nname = \"tall\"\nsource = \"tall.png\"\nat = {tall_at}\n\
             [[pose]]\nname = \"wide\"\nsource = \"wide.png\"\nat = {wide_at}\n{more}"
        ));
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_inbetween"))
            .args(arguments)
            .current_dir(self.folder.path())
            .output()
            .expect("the command runs")
    }

    /// Standard output of a run that must succeed.
    pub(crate) fn succeeds(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {message}");
        String::from_utf8(output.stdout).expect("text")
    }

    /// Standard error of a run that must fail with this code.
    pub(crate) fn fails(&self, arguments: &[&str], code: i32) -> String {
        let output = self.run(arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?} printed to standard output");
        message
    }

    /// Every file in the folder.
    pub(crate) fn listing(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

/// A PNG file that ends where its pixels should start.
#[allow(dead_code, reason = "each test program uses its own part")]
pub(crate) fn png_that_claims(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().expect("a header");
    writer
        .write_chunk(png::chunk::IDAT, &[0x78, 0x9c])
        .expect("the start of the data");
    drop(writer);
    bytes
}
