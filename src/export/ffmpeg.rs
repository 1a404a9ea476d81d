//! MP4 and WebM, by the program `ffmpeg`.
//!
//! Frames are piped to it as raw pixels; it writes to the temporary name that [`PendingFile`] gives. Its own marks (versions,
//! times) are switched off and its number of threads is fixed, so that the same ffmpeg writes the same bytes.
//!
//! - **MP4** (H.264, 4:2:0, BT.709) plays everywhere, but has no transparency and needs even sides: frames are put before
//!   a colour, and padded by a column or a row of it. The index comes first, so that a browser can start at once.
//! - **WebM** (VP9, 4:2:0 with alpha) keeps transparency.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use super::timing::Rate;
use super::{ExportError, PendingFile};
use crate::render::Frame;

/// Of what ffmpeg says when it fails, the last lines are told.
const LINES_TOLD: usize = 4;
/// How far colours are carried into clear pixels, which compression mixes with their neighbours.
const MARGIN: usize = 3;

/// Which kind of video.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VideoKind {
    /// H.264 in MP4 before this colour: red, green, blue.
    Mp4 {
        /// What is behind the frames.
        background: [u8; 3],
    },
    /// VP9 in WebM, with transparency.
    WebM,
}

/// Writes a video frame by frame. All frames have one size.
#[derive(Debug)]
pub struct VideoWriter {
    file: PendingFile,
    program: Program,
    /// What ffmpeg says.
    messages: File,
    kind: VideoKind,
    size: [usize; 2],
}

/// ffmpeg, running until it is dropped at the latest.
#[derive(Debug)]
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        // Nothing happens if it has ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl VideoWriter {
    /// A video of `size` (columns, rows) at `fps` frames a second.
    ///
    /// # Errors
    /// [`ExportError`] if the file cannot be written or there is no ffmpeg.
    pub fn new(file: PendingFile, size: [usize; 2], fps: f64, kind: VideoKind) -> Result<Self, ExportError> {
        let target = file.target().to_owned();
        let messages = tempfile::tempfile().map_err(|error| ExportError::cannot_write(&target, error))?;
        let log = messages
            .try_clone()
            .map_err(|error| ExportError::cannot_write(&target, error))?;
        let program = Command::new("ffmpeg")
            .args(input_arguments(kind.padded(size), Rate::of(fps)))
            .args(kind.arguments())
            .arg(absolute(&file))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(log)
            .spawn()
            .map_err(|error| ExportError::Program {
                path: target,
                reason: if error.kind() == std::io::ErrorKind::NotFound {
                    "this needs the program ffmpeg, and there is none on the path; install ffmpeg (https://ffmpeg.org) or \
                     choose .webp, .apng, .gif or a folder of PNG files"
                        .to_owned()
                } else {
                    format!("ffmpeg does not start: {error}")
                },
            })?;
        Ok(Self {
            file,
            program: Program(program),
            messages,
            kind,
            size,
        })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// [`ExportError`] if ffmpeg gave up or the frame has another size.
    pub fn add(&mut self, frame: &Frame) -> Result<(), ExportError> {
        if [frame.width, frame.height] != self.size {
            return Err(ExportError::Unsuitable {
                path: self.file.target().to_owned(),
                reason: "all frames of a video have one size".to_owned(),
            });
        }
        let bytes = self.kind.pixels(frame);
        let written = match &mut self.program.0.stdin {
            Some(pipe) => pipe.write_all(&bytes),
            None => Err(std::io::Error::other("the pipe is closed")),
        };
        // A broken pipe is ffmpeg's end, and it says why.
        written.map_err(|_| self.failure())
    }

    /// Lets ffmpeg end the file and gives it its name.
    ///
    /// # Errors
    /// [`ExportError`] if ffmpeg or the system fails.
    pub fn finish(mut self) -> Result<(), ExportError> {
        drop(self.program.0.stdin.take());
        let is_success = self.program.0.wait().is_ok_and(|status| status.success());
        // Some versions call it a success when the disk is full at the very end, but say so.
        if !is_success || !self.last_lines().is_empty() {
            return Err(self.failure());
        }
        self.file.commit()
    }

    /// Why ffmpeg failed, in its own words.
    fn failure(&mut self) -> ExportError {
        // Until it has ended it may have more to say; without a pipe it ends.
        drop(self.program.0.stdin.take());
        let _ = self.program.0.wait();
        let lines = self.last_lines();
        ExportError::Program {
            path: self.file.target().to_owned(),
            reason: if lines.is_empty() {
                "ffmpeg ended before all frames were written".to_owned()
            } else {
                format!("ffmpeg failed: {lines}")
            },
        }
    }

    fn last_lines(&mut self) -> String {
        let mut bytes = Vec::new();
        let _ = self.messages.seek(SeekFrom::Start(0));
        let _ = self.messages.read_to_end(&mut bytes);
        let text = String::from_utf8_lossy(&bytes);
        let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        lines[lines.len().saturating_sub(LINES_TOLD)..].join("; ")
    }
}

impl VideoKind {
    /// The sides that the file has.
    #[must_use]
    pub fn padded(self, size: [usize; 2]) -> [usize; 2] {
        match self {
            Self::Mp4 { .. } => size.map(|side| side.next_multiple_of(2)),
            Self::WebM => size,
        }
    }

    /// How ffmpeg is to encode.
    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Mp4 { .. } => &[
                "-c:v",
                "libx264",
                "-preset",
                "medium",
                "-crf",
                "16",
                "-pix_fmt",
                "yuv420p",
                // Without the encoder's name, version and settings.
                "-bsf:v",
                "filter_units=remove_types=6",
                "-movflags",
                "+faststart",
                "-f",
                "mp4",
            ],
            Self::WebM => &[
                "-c:v",
                "libvpx-vp9",
                "-crf",
                "18",
                "-b:v",
                "0",
                "-cpu-used",
                "2",
                "-row-mt",
                "1",
                // Hidden frames and alpha exclude one another.
                "-auto-alt-ref",
                "0",
                "-pix_fmt",
                "yuva420p",
                "-f",
                "webm",
            ],
        }
    }

    /// A frame as it is piped: red, green, blue, alpha, not premultiplied.
    fn pixels(self, frame: &Frame) -> Vec<u8> {
        match self {
            Self::Mp4 { background: [r, g, b] } => {
                let mut frame = frame.clone();
                frame.put_before([r, g, b, 255]);
                let [width, height] = self.padded([frame.width, frame.height]);
                let mut bytes = Vec::with_capacity(width * height * 4);
                for row in frame.pixels.chunks(frame.width) {
                    bytes.extend(row.iter().flatten());
                    bytes.extend([r, g, b, 255].repeat(width - frame.width));
                }
                bytes.extend([r, g, b, 255].repeat((height - frame.height) * width));
                bytes
            }
            Self::WebM => with_margin(frame),
        }
    }
}

/// The pipe, and what ffmpeg is not to add of its own.
fn input_arguments([width, height]: [usize; 2], rate: Rate) -> Vec<String> {
    let size = format!("{width}x{height}");
    let rate = format!("{}/{}", rate.frames, rate.seconds);
    let words = [
        "-hide_banner -loglevel error -xerror -nostdin -y -f rawvideo -pixel_format rgba -video_size",
        &size,
        "-framerate",
        &rate,
        "-i pipe:0 -an -map_metadata -1 -fflags +bitexact -flags:v +bitexact -threads 4",
        "-sws_flags lanczos+accurate_rnd+full_chroma_int+bitexact",
        "-vf scale=out_color_matrix=bt709:out_range=tv -colorspace bt709 -color_primaries bt709 -color_trc bt709",
        "-color_range tv",
    ];
    words
        .iter()
        .flat_map(|words| words.split(' '))
        .map(str::to_owned)
        .collect()
}

/// The temporary path, which ffmpeg must not take for an option or a protocol.
fn absolute(file: &PendingFile) -> PathBuf {
    let path = file.temporary_path();
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Straight pixels whose clear ones near the drawing have the colour of their neighbours.
fn with_margin(frame: &Frame) -> Vec<u8> {
    let (width, height) = (frame.width, frame.height);
    let mut bytes = frame.straight();
    let mut has_colour: Vec<bool> = frame.pixels.iter().map(|pixel| pixel[3] > 0).collect();
    for _ in 0..MARGIN {
        let mut coloured = Vec::new();
        for y in 0..height {
            for x in 0..width {
                if has_colour[y * width + x] {
                    continue;
                }
                let (mut sum, mut count) = ([0u32; 3], 0);
                for j in y.saturating_sub(1)..(y + 2).min(height) {
                    for i in x.saturating_sub(1)..(x + 2).min(width) {
                        let near = j * width + i;
                        if has_colour[near] {
                            (0..3).for_each(|k| sum[k] += u32::from(bytes[near * 4 + k]));
                            count += 1;
                        }
                    }
                }
                if count > 0 {
                    coloured.push((y * width + x, sum.map(|s| (s / count) as u8)));
                }
            }
        }
        for (pixel, colour) in coloured {
            bytes[pixel * 4..][..3].copy_from_slice(&colour);
            has_colour[pixel] = true;
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_mp4_is_padded_with_its_background() {
        let kind = VideoKind::Mp4 { background: [1, 2, 3] };
        let mut frame = Frame::filled(3, 1, [0; 4]);
        frame.pixels[0] = [9, 8, 7, 255];
        let bytes = kind.pixels(&frame);
        assert_eq!(bytes.len(), 4 * 2 * 4);
        assert_eq!(bytes[..8], [9, 8, 7, 255, 1, 2, 3, 255]);
        assert!(bytes.chunks(4).skip(1).all(|pixel| pixel == [1, 2, 3, 255]));
    }

    #[test]
    fn clear_pixels_near_the_drawing_take_its_colour() {
        let mut frame = Frame::filled(9, 1, [0; 4]);
        frame.pixels[0] = [200, 100, 0, 255];
        let bytes = VideoKind::WebM.pixels(&frame);
        assert_eq!(bytes[12..16], [200, 100, 0, 0]);
        assert_eq!(bytes[16..20], [0; 4]);
    }
}
