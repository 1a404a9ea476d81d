//! Animated WebP: lossless, full colour and alpha.
//!
//! The pixels are compressed by the crate `image-webp`; the container around them (RIFF chunks `VP8X`, `ANIM` and one
//! `ANMF` a frame, after Google's "WebP Container Specification") is written here. Every frame but the first is cut to
//! what changed, and replaces it. Times are whole milliseconds that add up.

use std::io::{Seek, SeekFrom, Write};

use super::changes::Changes;
use super::timing::Rate;
use super::{Repetition, WriteError};
use crate::render::Frame;

/// The widest and highest picture of the format's lossless kind.
const LARGEST: usize = 16_384;
/// Ticks a second.
const TICKS: u32 = 1000;
/// The longest time a frame is shown, in ticks: 24 bits.
const LONGEST: u64 = (1 << 24) - 1;
/// The bytes of a frame's own header.
const FRAME_HEADER: usize = 16;
/// `ANMF`: what is there is replaced, not drawn over.
const REPLACE: u8 = 0b10;
/// `VP8X`: the file is an animation.
const HAS_ANIMATION: u8 = 0b10;
/// `VP8X`: some frame has clear pixels.
const HAS_ALPHA: u8 = 0b1_0000;
/// Where the flags of `VP8X` are in the file.
const FLAGS_AT: u64 = 20;

/// Writes a WebP frame by frame. All frames have one size.
#[derive(Debug)]
pub struct WebPWriter<W: Write + Seek> {
    writer: W,
    /// Where the file begins in it.
    start: u64,
    size: [usize; 2],
    rate: Rate,
    changes: Changes,
    count: u64,
    /// The bytes of the file so far.
    length: u64,
    has_alpha: bool,
}

impl<W: Write + Seek> WebPWriter<W> {
    /// A WebP of `size` (columns, rows) at `fps` frames a second, whose bytes go to `writer`; give a `&mut` of what is wanted back.
    ///
    /// # Errors
    /// [`WriteError`] if the bytes cannot be written or the format cannot hold the size.
    pub fn new(mut writer: W, size: [usize; 2], fps: f64, repetition: Repetition) -> Result<Self, WriteError> {
        if size.iter().any(|side| !(1..=LARGEST).contains(side)) {
            return Err(WriteError::unsuitable(format!(
                "a WebP is at most {LARGEST} pixels wide and high; choose a smaller size"
            )));
        }
        let mut writer = Self {
            start: writer.stream_position()?,
            writer,
            size,
            rate: Rate::of(fps),
            changes: Changes::default(),
            count: 0,
            length: 0,
            has_alpha: false,
        };
        // The length and the flags are known at the end.
        writer.write(b"RIFF\0\0\0\0WEBP")?;
        let mut canvas = vec![HAS_ANIMATION, 0, 0, 0];
        canvas.extend(three_bytes(size[0] - 1));
        canvas.extend(three_bytes(size[1] - 1));
        writer.write(&chunk(b"VP8X", &canvas))?;
        let plays: u16 = match repetition {
            Repetition::Once => 1,
            Repetition::Forever => 0,
        };
        let [low, high] = plays.to_le_bytes();
        writer.write(&chunk(b"ANIM", &[0, 0, 0, 0, low, high]))?;
        Ok(writer)
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// [`WriteError`] if the bytes cannot be written or the frame has another size.
    pub fn add(&mut self, frame: &Frame) -> Result<(), WriteError> {
        self.add_held(frame, 1)
    }

    /// Adds a frame that is shown for the time of `frames` frames, at least 1, as one picture with a longer delay.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn add_held(&mut self, frame: &Frame, frames: usize) -> Result<(), WriteError> {
        let frames = frames.max(1) as u64;
        if [frame.width, frame.height] != self.size {
            return Err(WriteError::unsuitable("all frames of a WebP have one size"));
        }
        self.has_alpha |= frame.pixels.iter().any(|pixel| pixel[3] < 255);
        // Places are stored halved.
        let change = self.changes.next(frame, 2);
        let pixels = lossless(&change.part)?;
        let shown = self.rate.ticks_of_frames(self.count, frames, TICKS).min(LONGEST);
        let mut data = Vec::with_capacity(FRAME_HEADER + pixels.len());
        for field in [
            change.left / 2,
            change.top / 2,
            change.part.width - 1,
            change.part.height - 1,
            shown as usize,
        ] {
            data.extend(three_bytes(field));
        }
        data.push(REPLACE);
        data.extend(pixels);
        self.count += frames;
        self.write(&chunk(b"ANMF", &data))
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`WriteError`] if the last bytes cannot be written, or the file became larger than the format can say.
    pub fn finish(mut self) -> Result<(), WriteError> {
        let Ok(length) = u32::try_from(self.length - 8) else {
            return Err(WriteError::unsuitable(
                "a WebP is at most 4 GiB long; choose a smaller size, fewer frames, or a folder of PNG files",
            ));
        };
        let flags = HAS_ANIMATION | if self.has_alpha { HAS_ALPHA } else { 0 };
        let (writer, start) = (&mut self.writer, self.start);
        writer.seek(SeekFrom::Start(start + 4))?;
        writer.write_all(&length.to_le_bytes())?;
        writer.seek(SeekFrom::Start(start + FLAGS_AT))?;
        writer.write_all(&[flags])?;
        writer.seek(SeekFrom::Start(start + self.length))?;
        Ok(writer.flush()?)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), WriteError> {
        self.length += bytes.len() as u64;
        Ok(self.writer.write_all(bytes)?)
    }
}

/// The `VP8L` chunk of a picture: what is inside a WebP file of that picture alone.
fn lossless(frame: &Frame) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Vec::new();
    image_webp::WebPEncoder::new(&mut bytes)
        .encode(
            &frame.straight(),
            frame.width as u32,
            frame.height as u32,
            image_webp::ColorType::Rgba8,
        )
        .map_err(|error| WriteError::Encoding(Box::new(error)))?;
    let inside = bytes.split_off(12.min(bytes.len()));
    if inside.starts_with(b"VP8L") {
        Ok(inside)
    } else {
        Err(WriteError::unsuitable("the WebP encoder wrote no lossless picture"))
    }
}

/// A RIFF chunk: name, length, data, and a byte more where the length is odd.
fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(9 + data.len());
    bytes.extend(name);
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    if data.len() % 2 == 1 {
        bytes.push(0);
    }
    bytes
}

fn three_bytes(number: usize) -> [u8; 3] {
    let [a, b, c, _] = (number as u32).to_le_bytes();
    [a, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    use image::AnimationDecoder as _;

    fn written(frames: &[Frame], fps: f64, repetition: Repetition) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let size = [frames[0].width, frames[0].height];
        let mut writer = WebPWriter::new(&mut bytes, size, fps, repetition).expect("a WebP");
        for frame in frames {
            writer.add(frame).expect("added");
        }
        writer.finish().expect("written");
        bytes.into_inner()
    }

    /// Boxes of half-clear colour that move over `back`; the last frame is repeated.
    fn frames(back: [u8; 4]) -> Vec<Frame> {
        let mut frames: Vec<Frame> = (0..5)
            .map(|k| {
                let mut frame = Frame::filled(17, 9, [0; 4]);
                for y in 1..4 {
                    frame.pixels[(y + k) * 17 + 2 * k + 1] = [100, 20 * k as u8, 0, 128];
                }
                frame.put_before(back);
                frame
            })
            .collect();
        frames.push(frames[4].clone());
        frames
    }

    #[test]
    fn frames_read_back_exactly() {
        for back in [[0; 4], [250, 240, 230, 255]] {
            let frames = frames(back);
            let bytes = written(&frames, 24.0, Repetition::Forever);
            assert_eq!(bytes[FLAGS_AT as usize] & HAS_ALPHA != 0, back[3] == 0);
            let decoder = image::codecs::webp::WebPDecoder::new(std::io::Cursor::new(bytes)).expect("a WebP");
            let read = decoder.into_frames().collect_frames().expect("frames");
            assert_eq!(read.len(), frames.len());
            let mut total = 0;
            for (frame, read) in frames.iter().zip(&read) {
                assert_eq!(read.buffer().as_raw(), &frame.straight());
                total += read.delay().numer_denom_ms().0;
            }
            assert_eq!(total, 250);
        }
    }

    #[test]
    fn how_often_it_plays_is_kept() {
        for (repetition, plays) in [
            (
                Repetition::Once,
                image_webp::LoopCount::Times(1.try_into().expect("one")),
            ),
            (Repetition::Forever, image_webp::LoopCount::Forever),
        ] {
            let bytes = written(&frames([0; 4]), 12.0, repetition);
            let decoder = image_webp::WebPDecoder::new(std::io::Cursor::new(bytes)).expect("a WebP");
            assert_eq!(decoder.loop_count(), plays);
            assert_eq!(decoder.num_frames(), 6);
        }
    }

    #[test]
    fn what_the_format_cannot_hold_is_refused() {
        let file = Cursor::new(Vec::new());
        let error = WebPWriter::new(file, [20_000, 10], 24.0, Repetition::Once).expect_err("too wide");
        assert!(error.to_string().contains("16384"), "{error}");
    }
}
