//! Pictures with a palette.

use std::error::Error;

use inbetween::export::Palette;
use inbetween::render::Frame;

/// A PNG file with a palette, which takes a third of the bytes.
pub(crate) fn png_with_palette(frame: &Frame) -> Result<Vec<u8>, Box<dyn Error>> {
    let palette = Palette::for_frames(std::slice::from_ref(frame));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width as u32, frame.height as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.bytes());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&palette.indices(frame))?;
    writer.finish()?;
    Ok(bytes)
}
