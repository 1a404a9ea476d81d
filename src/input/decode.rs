//! Bytes of an image file to pixels, with limits that are checked before anything large is allocated.

use std::io::Cursor;

use image::codecs::gif::GifDecoder;
use image::codecs::webp::WebPDecoder;
use image::{AnimationDecoder, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, RgbaImage};

use super::edges::Fidelity;
use super::{InputError, InputNote};

/// The most columns or rows that are read: beyond any drawing, and far below what would exhaust memory.
pub(super) const LARGEST_SIDE: u32 = 16_384;
/// The most pixels that are read: 256 MiB of colour.
pub(super) const LARGEST_COUNT: u64 = 1 << 26;
/// The most frames of an animated file that are counted.
const MOST_COUNTED: usize = 99;

/// A picture as it is in its file.
#[derive(Debug)]
pub(super) struct Decoded {
    /// Straight (not premultiplied) pixels, turned upright.
    pub(super) image: RgbaImage,
    /// Whether they are exactly what was drawn.
    pub(super) fidelity: Fidelity,
    /// How many pictures come after it.
    pub(super) later_frames: usize,
}

impl Decoded {
    /// Pixels that are exactly what was drawn.
    pub(super) fn exact(image: RgbaImage) -> Self {
        Self {
            image,
            fidelity: Fidelity::Exact,
            later_frames: 0,
        }
    }

    /// What of the file is not used.
    pub(super) fn notes(&self) -> Vec<InputNote> {
        let left_out = (self.later_frames > 0).then_some(InputNote::FramesLeftOut {
            count: self.later_frames,
        });
        left_out.into_iter().collect()
    }
}

/// The first picture in the bytes of an image file.
pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, InputError> {
    if bytes.is_empty() {
        return Err(InputError::EmptyFile);
    }
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| undecodable(&error))?;
    let Some(format) = reader.format() else {
        return Err(InputError::NotAnImage);
    };
    if format == ImageFormat::Jpeg && !ends_as_jpeg(bytes) {
        return Err(InputError::CutOff);
    }
    let mut limits = Limits::no_limits();
    // Colours may be stored as four 16-bit channels, and a decoder keeps a copy while it works.
    limits.max_alloc = Some(LARGEST_COUNT * 16);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(refused)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    let orientation = decoder.orientation().map_err(refused)?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(refused)?;
    image.apply_orientation(orientation);
    Ok(Decoded {
        image: image.into_rgba8(),
        fidelity: fidelity(bytes, format),
        later_frames: later_frames(bytes, format),
    })
}

/// An image of `size` columns and rows from straight pixels in memory.
pub(super) fn image_of_pixels(size: [usize; 2], rgba: &[u8]) -> Result<RgbaImage, InputError> {
    let [width, height] = size.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    check_size(width, height)?;
    let refusal = InputError::PixelBytes {
        found: rgba.len(),
        width,
        height,
    };
    // The buffer may be longer than the image without this look.
    if rgba.len() != size[0] * size[1] * 4 {
        return Err(refusal);
    }
    RgbaImage::from_raw(width, height, rgba.to_vec()).ok_or(refusal)
}

fn check_size(width: u32, height: u32) -> Result<(), InputError> {
    if width == 0 || height == 0 {
        return Err(InputError::NoPixels { width, height });
    }
    if width.max(height) > LARGEST_SIDE || u64::from(width) * u64::from(height) > LARGEST_COUNT {
        return Err(InputError::TooManyPixels {
            width,
            height,
            largest_side: LARGEST_SIDE,
            largest_count: LARGEST_COUNT,
        });
    }
    Ok(())
}

/// Whether a JPEG file has its end: decoders make up what is missing in grey. Some cameras append data of their own, so the mark may
/// stand anywhere after the last scan begins.
fn ends_as_jpeg(bytes: &[u8]) -> bool {
    const END: [u8; 2] = [0xff, 0xd9];
    const SCAN: [u8; 2] = [0xff, 0xda];
    let scan = bytes.windows(2).rposition(|pair| pair == SCAN);
    scan.is_none_or(|scan| bytes[scan..].windows(2).any(|pair| pair == END))
}

fn fidelity(bytes: &[u8], format: ImageFormat) -> Fidelity {
    match format {
        ImageFormat::Jpeg => Fidelity::Lossy,
        // Lossless WebP has a chunk of its own.
        ImageFormat::WebP if !bytes.windows(4).take(1 << 16).any(|name| name == b"VP8L") => Fidelity::Lossy,
        _ => Fidelity::Exact,
    }
}

/// How many pictures follow the first, as far as can be told without decoding them all: at most [`MOST_COUNTED`].
fn later_frames(bytes: &[u8], format: ImageFormat) -> usize {
    let frames = |decoder: Option<image::Frames<'_>>| {
        decoder.map_or(0, |frames| {
            frames
                .take(MOST_COUNTED + 1)
                .take_while(Result::is_ok)
                .count()
                .saturating_sub(1)
        })
    };
    match format {
        ImageFormat::Gif => frames(
            GifDecoder::new(Cursor::new(bytes))
                .ok()
                .map(AnimationDecoder::into_frames),
        ),
        ImageFormat::WebP => WebPDecoder::new(Cursor::new(bytes))
            .ok()
            .filter(WebPDecoder::has_animation)
            .map_or(0, |decoder| frames(Some(decoder.into_frames()))),
        // The number of frames of an animated PNG stands in its control chunk.
        ImageFormat::Png => bytes
            .windows(4)
            .take(1 << 16)
            .position(|name| name == b"acTL")
            .map_or(0, |at| {
                let count = bytes
                    .get(at + 4..at + 8)
                    .and_then(|count| count.try_into().ok())
                    .map_or(0, u32::from_be_bytes);
                (count as usize).saturating_sub(1)
            }),
        _ => 0,
    }
}

fn refused(error: ImageError) -> InputError {
    match error {
        ImageError::Unsupported(_) => InputError::NotAnImage,
        other => undecodable(&other),
    }
}

fn undecodable(error: &dyn std::error::Error) -> InputError {
    InputError::Undecodable {
        reason: error.to_string(),
    }
}
