//! Bytes of an image file to pixels, with limits that are checked before anything large is allocated.

use std::io::Cursor;

use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::webp::WebPDecoder;
use image::metadata::Orientation;
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
    /// What of its layers is not kept.
    pub(super) layer_notes: Vec<InputNote>,
}

impl Decoded {
    /// Pixels that are exactly what was drawn.
    pub(super) fn exact(image: RgbaImage) -> Self {
        Self {
            image,
            fidelity: Fidelity::Exact,
            later_frames: 0,
            layer_notes: Vec::new(),
        }
    }

    /// What of the file is not used.
    pub(super) fn notes(&self) -> Vec<InputNote> {
        let left_out = (self.later_frames > 0).then_some(InputNote::FramesLeftOut {
            count: self.later_frames,
        });
        left_out.into_iter().chain(self.layer_notes.iter().cloned()).collect()
    }
}

/// How many columns and rows the picture that is meant in the bytes of an image file has when it stands upright.
pub(super) fn upright_size(bytes: &[u8], choice: PictureChoice) -> Result<[u32; 2], InputError> {
    let size = whole_size(bytes)?;
    let PictureChoice::Cell { at, of } = choice else {
        return Ok(size);
    };
    let [_, _, width, height] = cell_of(size, at, of)?;
    Ok([width, height])
}

fn whole_size(bytes: &[u8]) -> Result<[u32; 2], InputError> {
    #[cfg(feature = "layered")]
    if super::layered::LayeredKind::of(bytes).is_some() {
        return super::layered::canvas_size(bytes);
    }
    let (mut decoder, _) = decoder_of(bytes)?;
    let (width, height) = decoder.dimensions();
    let is_turned = matches!(
        decoder.orientation().map_err(refused)?,
        Orientation::Rotate90 | Orientation::Rotate270 | Orientation::Rotate90FlipH | Orientation::Rotate270FlipH
    );
    Ok(if is_turned { [height, width] } else { [width, height] })
}

/// Which picture of a file is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PictureChoice {
    /// The only one, or of an animated file the first.
    #[default]
    Only,
    /// A frame of an animated file, counted from 0.
    Frame(usize),
    /// A cell of a sheet that is divided evenly.
    Cell {
        /// Its column and row, counted from 0.
        at: [usize; 2],
        /// How many columns and rows there are.
        of: [usize; 2],
    },
}

/// The picture that is meant in the bytes of an image file, of a layered one that of the element of this path.
pub(super) fn decode_chosen(bytes: &[u8], choice: PictureChoice, element: Option<&str>) -> Result<Decoded, InputError> {
    match choice {
        PictureChoice::Only => decode_frame(bytes, None, element),
        PictureChoice::Frame(frame) => decode_frame(bytes, Some(frame), element),
        PictureChoice::Cell { at, of } => {
            let sheet = decode_frame(bytes, None, element)?;
            let [left, top, width, height] = cell_of([sheet.image.width(), sheet.image.height()], at, of)?;
            Ok(Decoded {
                image: image::imageops::crop_imm(&sheet.image, left, top, width, height).to_image(),
                later_frames: 0,
                ..sheet
            })
        }
    }
}

/// A frame, or the first picture, of a layered or other image file.
fn decode_frame(bytes: &[u8], frame: Option<usize>, element: Option<&str>) -> Result<Decoded, InputError> {
    #[cfg(feature = "layered")]
    if super::layered::LayeredKind::of(bytes).is_some() {
        return super::layered::decode(bytes, element, frame);
    }
    if let Some(element) = element {
        return Err(InputError::NoLayers {
            element: element.to_owned(),
        });
    }
    match frame {
        None => decode(bytes),
        Some(frame) => frame_of(bytes, frame),
    }
}

/// Left, top, width and height of a cell of a sheet of `size`.
fn cell_of(size: [u32; 2], at: [usize; 2], of: [usize; 2]) -> Result<[u32; 4], InputError> {
    let refusal = || InputError::NoSuchCell { at, of, size };
    let edge = |axis: usize, k: usize| -> Option<u32> {
        let place = u64::from(size[axis]) * u64::try_from(k).ok()? / u64::try_from(of[axis]).ok()?;
        u32::try_from(place).ok()
    };
    let side = |axis: usize| -> Option<(u32, u32)> {
        if at[axis] >= of[axis] {
            return None;
        }
        let (low, high) = (edge(axis, at[axis])?, edge(axis, at[axis] + 1)?);
        (high > low).then_some((low, high - low))
    };
    let (Some((left, width)), Some((top, height))) = (side(0), side(1)) else {
        return Err(refusal());
    };
    Ok([left, top, width, height])
}

/// How many pictures the bytes of an image file hold, as far as they are whole: one of anything that is not animated.
pub(super) fn count_frames(bytes: &[u8]) -> Result<usize, InputError> {
    #[cfg(feature = "layered")]
    if super::layered::LayeredKind::of(bytes).is_some() {
        return Ok(super::layered::LayeredFile::open(bytes)?.frame_count());
    }
    let (_, format) = decoder_of(bytes)?;
    Ok(1 + later_frames(bytes, format))
}

/// A frame of an animated file, as it is seen: composed with those before it.
fn frame_of(bytes: &[u8], frame: usize) -> Result<Decoded, InputError> {
    let (_, format) = decoder_of(bytes)?;
    let refusal = || InputError::NoSuchFrame {
        frame,
        count: 1 + later_frames(bytes, format),
    };
    let frames = match format {
        ImageFormat::Gif => GifDecoder::new(Cursor::new(bytes)).map_err(refused)?.into_frames(),
        ImageFormat::WebP => {
            let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(refused)?;
            if !decoder.has_animation() {
                return if frame == 0 { decode(bytes) } else { Err(refusal()) };
            }
            decoder.into_frames()
        }
        ImageFormat::Png => {
            let decoder = PngDecoder::new(Cursor::new(bytes)).map_err(refused)?;
            if !decoder.is_apng().map_err(refused)? {
                return if frame == 0 { decode(bytes) } else { Err(refusal()) };
            }
            decoder.apng().map_err(refused)?.into_frames()
        }
        _ => return if frame == 0 { decode(bytes) } else { Err(refusal()) },
    };
    let found = frames
        .take(MOST_COUNTED + 1)
        .nth(frame)
        .ok_or_else(refusal)?
        .map_err(refused)?;
    Ok(Decoded {
        fidelity: fidelity(bytes, format),
        ..Decoded::exact(found.into_buffer())
    })
}

/// The first picture in the bytes of an image file.
pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, InputError> {
    let (mut decoder, format) = decoder_of(bytes)?;
    let orientation = decoder.orientation().map_err(refused)?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(refused)?;
    image.apply_orientation(orientation);
    Ok(Decoded {
        fidelity: fidelity(bytes, format),
        later_frames: later_frames(bytes, format),
        ..Decoded::exact(image.into_rgba8())
    })
}

/// What decodes the bytes of an image file, whose header promises a picture that is not too large.
fn decoder_of(bytes: &[u8]) -> Result<(impl ImageDecoder + '_, ImageFormat), InputError> {
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
    let decoder = reader.into_decoder().map_err(refused)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    Ok((decoder, format))
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

pub(super) fn check_size(width: u32, height: u32) -> Result<(), InputError> {
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
