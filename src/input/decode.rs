//! Bytes of an image file to pixels, with limits that are checked before anything large is allocated.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageError, ImageReader, Limits, RgbaImage};

use super::InputError;

/// The most columns or rows that are read: beyond any drawing, and far below what would exhaust memory.
pub(super) const LARGEST_SIDE: u32 = 16_384;
/// The most pixels that are read: 256 MiB of colour.
pub(super) const LARGEST_COUNT: u64 = 1 << 26;

/// The straight (not premultiplied) pixels of the first frame, turned upright.
pub(super) fn decode(bytes: &[u8]) -> Result<RgbaImage, InputError> {
    if bytes.is_empty() {
        return Err(InputError::EmptyFile);
    }
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| undecodable(&error))?;
    if reader.format().is_none() {
        return Err(InputError::NotAnImage);
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
    Ok(image.into_rgba8())
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
