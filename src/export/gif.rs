//! Animated GIF.
//!
//! In front of nothing each frame is cut to what is drawn and cleared before the next, so that no frame shows through;
//! in front of a colour only what changed is drawn over the last frame. Times are whole hundredths of a second that add
//! up; colours are those of one [`Palette`], dithered.

use std::io::Write;

use super::timing::Rate;
use super::{Palette, Repetition, WriteError, box_of};
use crate::render::Frame;

/// The shortest time a frame is shown, in hundredths of a second: players slow shorter ones down to ten.
const SHORTEST: u64 = 2;

/// What is behind the frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backdrop {
    /// Nothing, at least in places.
    Clear,
    /// Every pixel of every frame is opaque.
    Opaque,
}

/// Writes a GIF frame by frame. All frames have one size and share one palette.
pub struct GifWriter<W: Write> {
    encoder: gif::Encoder<W>,
    palette: Palette,
    backdrop: Backdrop,
    size: [u16; 2],
    rate: Rate,
    /// How many frames were added.
    count: u64,
    /// The last frame, in front of a colour.
    last: Option<Vec<u8>>,
}

impl<W: Write> std::fmt::Debug for GifWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GifWriter")
            .field("size", &self.size)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

/// Frames a second that players of GIFs still show at their pace; at a higher rate the animation takes longer.
pub const FASTEST_GIF: f64 = 100.0 / SHORTEST as f64;

impl<W: Write> GifWriter<W> {
    /// A GIF of `size` (columns, rows) at `fps` frames a second, whose bytes go to `writer`; give a `&mut` of what is wanted back.
    ///
    /// # Errors
    /// [`WriteError`] if the bytes cannot be written or the format cannot hold the size.
    pub fn new(
        writer: W,
        size: [usize; 2],
        fps: f64,
        palette: Palette,
        backdrop: Backdrop,
        repetition: Repetition,
    ) -> Result<Self, WriteError> {
        let [Ok(width), Ok(height)] = size.map(u16::try_from) else {
            return Err(WriteError::unsuitable(
                "a GIF is at most 65535 pixels wide and high; choose a smaller size",
            ));
        };
        let mut encoder = gif::Encoder::new(writer, width, height, &palette.bytes())?;
        if repetition == Repetition::Forever {
            encoder.set_repeat(gif::Repeat::Infinite)?;
        }
        Ok(Self {
            encoder,
            palette,
            backdrop,
            size: [width, height],
            rate: Rate::of(fps),
            count: 0,
            last: None,
        })
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
        let [width, height] = self.size.map(usize::from);
        if [frame.width, frame.height] != [width, height] {
            return Err(WriteError::unsuitable("all frames of a GIF have one size"));
        }
        let mut indices = self.palette.indices(frame);
        let drawn = match &self.last {
            Some(last) => box_of(width, height, |i| indices[i] != last[i]),
            None => box_of(width, height, |i| indices[i] != Palette::TRANSPARENT),
        };
        // A frame needs at least one pixel.
        let [left, top, columns, rows] = drawn.unwrap_or([0, 0, 1, 1]);
        let whole = indices.clone();
        if let Some(last) = &self.last {
            for (index, before) in indices.iter_mut().zip(last) {
                if index == before {
                    *index = Palette::TRANSPARENT;
                }
            }
        }
        if self.backdrop == Backdrop::Opaque {
            self.last = Some(whole);
        }
        let buffer: Vec<u8> = (top..top + rows)
            .flat_map(|y| indices[y * width + left..][..columns].iter().copied())
            .collect();
        let delay = hundredths(self.count, frames, self.rate);
        let frame = gif::Frame {
            delay,
            dispose: match self.backdrop {
                Backdrop::Clear => gif::DisposalMethod::Background,
                Backdrop::Opaque => gif::DisposalMethod::Keep,
            },
            transparent: Some(Palette::TRANSPARENT),
            left: left as u16,
            top: top as u16,
            width: columns as u16,
            height: rows as u16,
            buffer: buffer.into(),
            ..gif::Frame::default()
        };
        self.count += frames;
        Ok(self.encoder.write_frame(&frame)?)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`WriteError`] if the last bytes cannot be written.
    pub fn finish(self) -> Result<(), WriteError> {
        Ok(self.encoder.into_inner()?.flush()?)
    }
}

/// How long `frames` frames from `index` on are shown together.
fn hundredths(index: u64, frames: u64, rate: Rate) -> u16 {
    let ticks = rate.ticks_of_frames(index, frames, 100);
    ticks.clamp(SHORTEST, u64::from(u16::MAX)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::AnimationDecoder as _;

    fn frames() -> Vec<Frame> {
        (0..5)
            .map(|k| {
                let mut frame = Frame::filled(8, 6, [0; 4]);
                for y in 1..4 {
                    frame.pixels[y * 8 + k] = [200, 20 * k as u8, 0, 255];
                }
                frame
            })
            .collect()
    }

    fn written(frames: &[Frame], backdrop: Backdrop) -> Vec<image::Frame> {
        let mut bytes = Vec::new();
        let palette = Palette::for_frames(frames);
        let mut writer =
            GifWriter::new(&mut bytes, [8, 6], 24.0, palette, backdrop, Repetition::Forever).expect("a GIF");
        for frame in frames {
            writer.add(frame).expect("added");
        }
        writer.finish().expect("written");
        let decoder = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(bytes)).expect("a GIF");
        decoder.into_frames().collect_frames().expect("frames")
    }

    #[test]
    fn clear_frames_leave_nothing_behind() {
        let frames = frames();
        for (frame, read) in frames.iter().zip(written(&frames, Backdrop::Clear)) {
            for (pixel, expected) in read.buffer().pixels().zip(&frame.pixels) {
                assert_eq!(pixel.0[3], expected[3]);
                if expected[3] > 0 {
                    assert_eq!(&pixel.0, expected);
                }
            }
        }
    }

    #[test]
    fn opaque_frames_are_drawn_over_one_another() {
        let mut frames = frames();
        for frame in &mut frames {
            frame.put_before([255, 255, 255, 255]);
        }
        frames.push(frames[4].clone());
        let read = written(&frames, Backdrop::Opaque);
        assert_eq!(read.len(), 6);
        for (frame, read) in frames.iter().zip(read) {
            let pixels: Vec<[u8; 4]> = read.buffer().pixels().map(|p| p.0).collect();
            assert_eq!(pixels, frame.pixels);
        }
    }

    #[test]
    fn times_add_up() {
        let total: u64 = (0..24).map(|k| u64::from(hundredths(k, 1, Rate::of(24.0)))).sum();
        assert_eq!(total, 100);
        assert_eq!(hundredths(0, 1, Rate::of(1000.0)), 2);
        let twos: u64 = (0..12).map(|k| u64::from(hundredths(2 * k, 2, Rate::of(24.0)))).sum();
        assert_eq!(twos, 100);
    }
}
