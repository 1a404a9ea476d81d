//! Files that are cut off or damaged: whatever a decoder makes of them, nothing panics.

use std::io::Cursor;

use image::codecs::gif::GifEncoder;
use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use inbetween::input::{BitmapOptions, PictureChoice, bitmap_size, find_cells, frame_count, read_bitmap, read_picture};
use proptest::prelude::*;

/// A ring with a dot in it, 24 x 20.
fn picture(shift: u32) -> RgbaImage {
    RgbaImage::from_fn(24, 20, |x, y| {
        let away = (f64::from(x) - 11.5).hypot(f64::from(y) - 9.5);
        let is_drawn = (5.0..8.0).contains(&away) || away < 2.0 + f64::from(shift);
        Rgba(if is_drawn {
            [180, 40, 60, 255]
        } else {
            [255, 255, 255, 0]
        })
    })
}

fn still(format: ImageFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    let whole = DynamicImage::ImageRgba8(picture(0));
    let image = match format {
        ImageFormat::Jpeg | ImageFormat::Bmp => DynamicImage::ImageRgb8(whole.into_rgb8()),
        _ => whole,
    };
    image.write_to(&mut Cursor::new(&mut bytes), format).expect("encoded");
    bytes
}

fn animated_gif() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = GifEncoder::new(&mut bytes);
    let frames = (0..2).map(|k| image::Frame::new(picture(k)));
    encoder.encode_frames(frames).expect("encoded");
    drop(encoder);
    bytes
}

fn animated_png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 24, 20);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_animated(2, 0).expect("two frames");
    let mut writer = encoder.write_header().expect("a header");
    for k in 0..2 {
        writer.write_image_data(&picture(k)).expect("a frame");
    }
    writer.finish().expect("an end");
    bytes
}

/// Everything that reads the bytes of an image file.
fn read(bytes: &[u8]) {
    let cell = PictureChoice::Cell { at: [1, 0], of: [2, 1] };
    for picture in [PictureChoice::Only, PictureChoice::Frame(1), cell] {
        let mut options = BitmapOptions::default();
        options.picture = picture;
        if let Ok(drawing) = read_bitmap(bytes, &options) {
            assert!(drawing.outline.area() > 0.0);
        }
        let _ = bitmap_size(bytes, picture);
    }
    let _ = (frame_count(bytes), find_cells(bytes), read_picture(bytes));
}

/// Files of every kind that is read.
fn files() -> Vec<Vec<u8>> {
    let formats = [
        ImageFormat::Png,
        ImageFormat::Jpeg,
        ImageFormat::WebP,
        ImageFormat::Gif,
        ImageFormat::Bmp,
        ImageFormat::Tiff,
    ];
    let stills = formats.map(still).into_iter();
    stills.chain([animated_gif(), animated_png()]).collect()
}

#[test]
fn whole_files_are_read() {
    for bytes in files() {
        read_bitmap(&bytes, &BitmapOptions::default()).expect("a drawing");
        read(&bytes);
    }
}

#[test]
fn files_that_are_cut_off_anywhere_are_read_or_refused() {
    for bytes in files() {
        for end in (0..bytes.len()).step_by(1 + bytes.len() / 97) {
            read(&bytes[..end]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn damaged_files_are_read_or_refused(
        damage in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>()), 1..12),
        end in proptest::option::of(any::<proptest::sample::Index>()),
    ) {
        for mut bytes in files() {
            for (at, byte) in &damage {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            if let Some(end) = end {
                let end = end.index(bytes.len());
                bytes.truncate(end);
            }
            read(&bytes);
        }
    }
}
