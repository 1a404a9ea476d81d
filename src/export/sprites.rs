//! A sprite sheet: all frames in one PNG file, and a JSON file that says where they are.
//!
//! 1. Each frame is cut to what is drawn; equal frames share one place.
//! 2. The places, highest first, are set on shelves, [`PADDING`] pixels apart. Of all widths that are a multiple of the
//!    widest frame the one is taken whose sheet has the shortest longer side.
//! 3. The JSON is the array form that TexturePacker and Aseprite write. Durations are whole milliseconds that add up.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::changes::cut;
use super::timing::Rate;
use super::{ExportError, PendingFile, box_of, png_bytes};
use crate::render::Frame;

/// Clear pixels around each frame, so that no neighbour is seen when a player scales it.
const PADDING: usize = 2;
/// The widest and highest sheet: what graphics cards take.
const LARGEST: usize = 16_384;

/// Frames that become one sheet.
#[derive(Debug)]
pub struct SpriteSheet {
    image: PendingFile,
    table: PendingFile,
    rate: Rate,
    name: String,
    sprites: Vec<Sprite>,
    /// Different pictures, cut to what is drawn.
    pictures: Vec<Frame>,
    /// Their pixels with padding, all together.
    area: usize,
}

#[derive(Debug)]
struct Sprite {
    number: usize,
    picture: usize,
    /// Where the picture was cut from.
    left: usize,
    top: usize,
    whole: [usize; 2],
}

impl SpriteSheet {
    /// A sheet `target`, a PNG file, with a JSON file of the same stem beside it, of an animation at `fps` frames a second.
    /// Frames are called `NAME.0001.png` in it.
    ///
    /// # Errors
    /// [`ExportError`] if one of the files cannot be written.
    pub fn new(target: &Path, name: &str, fps: f64) -> Result<Self, ExportError> {
        Ok(Self {
            image: PendingFile::create(target)?,
            table: PendingFile::create(&table_path(target))?,
            rate: Rate::of(fps),
            name: name.to_owned(),
            sprites: Vec::new(),
            pictures: Vec::new(),
            area: 0,
        })
    }

    /// Adds frame `number`, counted from 1.
    ///
    /// # Errors
    /// [`ExportError`] if the frames become too many for one sheet.
    pub fn add(&mut self, number: usize, frame: &Frame) -> Result<(), ExportError> {
        let drawn = box_of(frame.width, frame.height, |i| frame.pixels[i][3] > 0).unwrap_or([0, 0, 1, 1]);
        let picture = cut(frame, drawn);
        let same = self.pictures.iter().position(|known| *known == picture);
        let picture = same.unwrap_or_else(|| {
            self.area += (picture.width + PADDING) * (picture.height + PADDING);
            self.pictures.push(picture);
            self.pictures.len() - 1
        });
        self.sprites.push(Sprite {
            number,
            picture,
            left: drawn[0],
            top: drawn[1],
            whole: [frame.width, frame.height],
        });
        if self.area > LARGEST * LARGEST {
            return Err(self.too_large());
        }
        Ok(())
    }

    /// Writes both files.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses, or the frames do not fit one sheet; then neither file is there.
    pub fn finish(mut self) -> Result<(), ExportError> {
        let sizes: Vec<[usize; 2]> = self.pictures.iter().map(|p| [p.width, p.height]).collect();
        let Some(Packing { size, places }) = packed(&sizes) else {
            return Err(self.too_large());
        };
        let mut sheet = Frame::filled(size[0], size[1], [0; 4]);
        for (picture, [left, top]) in self.pictures.iter().zip(&places) {
            for (y, row) in picture.pixels.chunks(picture.width).enumerate() {
                sheet.pixels[(top + y) * size[0] + left..][..picture.width].copy_from_slice(row);
            }
        }
        let table = self.table_of(size, &places);
        let failed = |file: &PendingFile, reason: String| ExportError::cannot_write(file.target(), reason);
        let bytes = png_bytes(&sheet).map_err(|error| failed(&self.image, error.to_string()))?;
        let mut text = serde_json::to_vec_pretty(&table).map_err(|error| failed(&self.table, error.to_string()))?;
        text.push(b'\n');
        for (file, bytes) in [(&mut self.image, bytes), (&mut self.table, text)] {
            std::io::Write::write_all(file, &bytes).map_err(|error| failed(file, error.to_string()))?;
        }
        PendingFile::commit_all([self.image, self.table])
    }

    fn table_of(&self, size: [usize; 2], places: &[[usize; 2]]) -> Value {
        let frames: Vec<Value> = (0..)
            .zip(&self.sprites)
            .map(|(index, sprite)| {
                let picture = &self.pictures[sprite.picture];
                let ([x, y], [w, h]) = (places[sprite.picture], [picture.width, picture.height]);
                let is_trimmed = [w, h] != sprite.whole;
                json!({
                    "filename": format!("{}.{:04}.png", self.name, sprite.number),
                    "frame": { "x": x, "y": y, "w": w, "h": h },
                    "rotated": false,
                    "trimmed": is_trimmed,
                    "spriteSourceSize": { "x": sprite.left, "y": sprite.top, "w": w, "h": h },
                    "sourceSize": { "w": sprite.whole[0], "h": sprite.whole[1] },
                    "duration": self.rate.ticks_of(index, 1000),
                })
            })
            .collect();
        let image = self.image.target().file_name().map(|name| name.to_string_lossy());
        json!({
            "frames": frames,
            "meta": {
                "app": "inbetween",
                "version": env!("CARGO_PKG_VERSION"),
                "image": image,
                "format": "RGBA8888",
                "size": { "w": size[0], "h": size[1] },
                "scale": "1",
            },
        })
    }

    fn too_large(&self) -> ExportError {
        ExportError::Unsuitable {
            path: self.image.target().to_owned(),
            reason: format!(
                "{} frames do not fit a sheet of {LARGEST} x {LARGEST} pixels; choose a smaller --size, a lower --fps or \
                 part of the frames (--frames)",
                self.sprites.len()
            ),
        }
    }
}

/// The JSON file beside a sheet.
fn table_path(target: &Path) -> PathBuf {
    target.with_extension("json")
}

struct Packing {
    size: [usize; 2],
    /// Left and top of each picture.
    places: Vec<[usize; 2]>,
}

/// The best packing of pictures of these sizes; `None` if there is none.
fn packed(sizes: &[[usize; 2]]) -> Option<Packing> {
    let widest = sizes.iter().map(|size| size[0]).max()?;
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|k| std::cmp::Reverse(sizes[*k][1]));
    (1..=sizes.len())
        .map(|columns| columns * (widest + PADDING) + PADDING)
        .take_while(|width| *width <= LARGEST)
        .chain((widest + PADDING + PADDING > LARGEST).then_some(LARGEST))
        .map(|width| on_shelves(sizes, &order, width))
        .filter(|packing| packing.size.iter().all(|side| *side <= LARGEST))
        .min_by_key(|Packing { size, .. }| (size[0].max(size[1]), size[0] * size[1]))
}

fn on_shelves(sizes: &[[usize; 2]], order: &[usize], width: usize) -> Packing {
    let mut places = vec![[0; 2]; sizes.len()];
    let ([mut left, mut top], mut below, mut right) = ([PADDING; 2], PADDING, 0);
    for &k in order {
        let [w, h] = sizes[k];
        if left + w + PADDING > width && left > PADDING {
            (left, top) = (PADDING, below);
        }
        places[k] = [left, top];
        left += w + PADDING;
        right = right.max(left);
        below = below.max(top + h + PADDING);
    }
    Packing {
        size: [right, below],
        places,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn packed_pictures_are_inside_and_apart(
            sizes in prop::collection::vec([1..60usize, 1..60usize], 1..30),
        ) {
            let Packing { size, places } = packed(&sizes).expect("room");
            for (k, ([w, h], [x, y])) in sizes.iter().zip(&places).enumerate() {
                prop_assert!(*x >= PADDING && x + w + PADDING <= size[0] && *y >= PADDING && y + h + PADDING <= size[1]);
                for ([v, g], [a, b]) in sizes.iter().zip(&places).skip(k + 1) {
                    let apart = |from: usize, length: usize, other: usize, others: usize| {
                        from + length + PADDING <= other || other + others + PADDING <= from
                    };
                    prop_assert!(apart(*x, *w, *a, *v) || apart(*y, *h, *b, *g));
                }
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(packed(&[[LARGEST, 5]]).is_none());
        assert!(packed(&[[5000, 5000]; 10]).is_none());
        assert!(packed(&[[5000, 5000]; 9]).is_some());
    }

    #[test]
    fn frames_are_found_by_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("cat.png");
        let frames: Vec<Frame> = (0..4)
            .map(|k| {
                let mut frame = Frame::filled(10, 8, [0; 4]);
                for i in 0..k {
                    frame.pixels[10 * (i + 2) + 3 + i] = [10, 100, 50, 200];
                }
                frame
            })
            .collect();
        let mut sheet = SpriteSheet::new(&target, "cat", 24.0).expect("writable");
        for (number, frame) in [(1, 0), (2, 1), (3, 2), (4, 3), (7, 3)] {
            sheet.add(number, &frames[frame]).expect("room");
        }
        sheet.finish().expect("written");
        let table: Value =
            serde_json::from_slice(&std::fs::read(folder.path().join("cat.json")).expect("there")).expect("JSON");
        let image = image::open(&target).expect("a PNG").to_rgba8();
        let number = |value: &Value| value.as_u64().expect("a number") as u32;
        let listed = table["frames"].as_array().expect("an array");
        assert_eq!(listed.len(), 5);
        assert_eq!(listed[4]["filename"], "cat.0007.png");
        assert_eq!(listed[4]["frame"], listed[3]["frame"]);
        let total: u32 = listed.iter().map(|entry| number(&entry["duration"])).sum();
        assert_eq!(total, 208);
        for (entry, frame) in listed.iter().zip(&frames) {
            let (place, source) = (&entry["frame"], &entry["spriteSourceSize"]);
            let mut whole = image::RgbaImage::new(10, 8);
            for y in 0..number(&place["h"]) {
                for x in 0..number(&place["w"]) {
                    let pixel = image.get_pixel(number(&place["x"]) + x, number(&place["y"]) + y);
                    whole.put_pixel(number(&source["x"]) + x, number(&source["y"]) + y, *pixel);
                }
            }
            assert_eq!(whole.as_raw(), &frame.straight());
        }
    }
}
