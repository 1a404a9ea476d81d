//! Animated PNG: full colour and alpha.
//!
//! Every frame but the first is cut to what changed, and replaces it. A rate that does not fit the format's fractions
//! is shown in whole milliseconds that add up.

use std::io::Write;

use super::changes::Changes;
use super::timing::Rate;
use super::{Repetition, WriteError};
use crate::render::Frame;

/// Writes an APNG frame by frame. All frames have one size.
pub struct ApngWriter<W: Write> {
    writer: png::Writer<W>,
    size: [usize; 2],
    rate: Rate,
    count: u64,
    changes: Changes,
}

impl<W: Write> std::fmt::Debug for ApngWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ApngWriter")
            .field("size", &self.size)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

impl<W: Write> ApngWriter<W> {
    /// An APNG of `count` frames, each [added](Self::add) once, of `size` (columns, rows) at `fps` frames a second, whose bytes go to `writer`; give a `&mut` of
    /// what is wanted back.
    ///
    /// # Errors
    /// [`WriteError`] if the bytes cannot be written or the format cannot hold the size.
    pub fn new(
        writer: W,
        size: [usize; 2],
        fps: f64,
        count: usize,
        repetition: Repetition,
    ) -> Result<Self, WriteError> {
        let mut encoder = png::Encoder::new(writer, size[0] as u32, size[1] as u32);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        let plays = match repetition {
            Repetition::Once => 1,
            Repetition::Forever => 0,
        };
        encoder.set_animated(count as u32, plays)?;
        let rate = Rate::of(fps);
        let (numerator, denominator) = delay(rate, 0, 1);
        encoder.set_frame_delay(numerator, denominator)?;
        encoder.set_dispose_op(png::DisposeOp::None)?;
        encoder.set_blend_op(png::BlendOp::Source)?;
        let writer = encoder.write_header()?;
        Ok(Self {
            writer,
            size,
            rate,
            count: 0,
            changes: Changes::default(),
        })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// [`WriteError`] if the bytes cannot be written, the frame has another size, or there are too many.
    pub fn add(&mut self, frame: &Frame) -> Result<(), WriteError> {
        self.add_held(frame, 1)
    }

    /// Adds a frame that is shown for the time of `frames` frames, at least 1, as one picture with a longer delay.
    /// It counts as one of the file's frames.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn add_held(&mut self, frame: &Frame, frames: usize) -> Result<(), WriteError> {
        let frames = frames.max(1) as u64;
        if [frame.width, frame.height] != self.size {
            return Err(WriteError::unsuitable("all frames of an APNG have one size"));
        }
        let change = self.changes.next(frame, 1);
        let (numerator, denominator) = delay(self.rate, self.count, frames);
        self.count += frames;
        let buffer = change.part.straight();
        let writer = &mut self.writer;
        writer.reset_frame_position()?;
        writer.set_frame_dimension(change.part.width as u32, change.part.height as u32)?;
        writer.set_frame_position(change.left as u32, change.top as u32)?;
        writer.set_frame_delay(numerator, denominator)?;
        Ok(writer.write_image_data(&buffer)?)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`WriteError`] if the last bytes cannot be written, or frames are missing.
    pub fn finish(self) -> Result<(), WriteError> {
        Ok(self.writer.finish()?)
    }
}

/// The time `frames` frames from `index` on are shown together, as a fraction of seconds in 16 bits.
fn delay(rate: Rate, index: u64, frames: u64) -> (u16, u16) {
    /// Ticks a second where the rate's own fraction is too long.
    const TICKS: u16 = 1000;
    let seconds = u64::from(rate.seconds).saturating_mul(frames);
    match (u16::try_from(seconds), u16::try_from(rate.frames)) {
        (Ok(seconds), Ok(rate)) => (seconds, rate),
        _ => {
            let shown = rate.ticks_of_frames(index, frames, u32::from(TICKS));
            let shown = shown.min(u64::from(u16::MAX));
            (shown as u16, TICKS)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::AnimationDecoder as _;

    #[test]
    fn frames_read_back_exactly() {
        let frames: Vec<Frame> = (0..4)
            .map(|k| {
                let mut frame = Frame::filled(8, 6, [0; 4]);
                for y in 1..4 {
                    frame.pixels[y * 8 + k + 1] = [100, 20 * k as u8, 0, 128];
                }
                frame
            })
            .chain([Frame::filled(8, 6, [0; 4])])
            .collect();
        let mut bytes = Vec::new();
        let mut writer = ApngWriter::new(&mut bytes, [8, 6], 24.0, frames.len(), Repetition::Once).expect("an APNG");
        for frame in &frames {
            writer.add(frame).expect("added");
        }
        writer.finish().expect("written");
        let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(bytes)).expect("a PNG");
        let read = decoder
            .apng()
            .expect("an APNG")
            .into_frames()
            .collect_frames()
            .expect("frames");
        assert_eq!(read.len(), frames.len());
        for (frame, read) in frames.iter().zip(read) {
            assert_eq!(read.buffer().as_raw(), &frame.straight());
            assert_eq!(read.delay().numer_denom_ms(), (125, 3));
        }
    }

    #[test]
    fn delays_are_exact_where_they_can_be_and_add_up_where_not() {
        assert_eq!(delay(Rate::of(24.0), 7, 1), (1, 24));
        assert_eq!(delay(Rate::of(23.976), 7, 1), (1001, 24000));
        assert_eq!(delay(Rate::of(0.5), 0, 1), (2, 1));
        assert_eq!(delay(Rate::of(24.0), 6, 2), (2, 24));
        let odd = Rate::of(17.123_457);
        let total: u32 = (0..171).map(|k| u32::from(delay(odd, k, 1).0)).sum();
        assert_eq!(total, 9986);
    }
}
