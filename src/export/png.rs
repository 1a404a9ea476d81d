//! One picture as PNG.

use crate::render::Frame;

/// The bytes of an 8-bit RGBA PNG file (sRGB colours, alpha not multiplied in).
///
/// # Errors
/// The encoder's message, for a picture without pixels.
pub fn png_bytes(frame: &Frame) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width as u32, frame.height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
    writer
        .write_image_data(&frame.straight())
        .map_err(|error| error.to_string())?;
    writer.finish().map_err(|error| error.to_string())?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_back_with_straight_alpha() {
        let mut frame = Frame::filled(3, 2, [0; 4]);
        frame.pixels[4] = [100, 50, 0, 128];
        let bytes = png_bytes(&frame).expect("a picture");
        let image = image::load_from_memory(&bytes).expect("a PNG").to_rgba8();
        assert_eq!(image.dimensions(), (3, 2));
        assert_eq!(image.get_pixel(1, 1).0, [199, 100, 0, 128]);
        assert_eq!(image.get_pixel(0, 0).0, [0; 4]);
        assert!(png_bytes(&Frame::filled(0, 2, [0; 4])).is_err());
    }
}
