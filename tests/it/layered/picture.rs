//! A writer of single pictures.

use super::art::Patch;

/// A patch as a PNG file.
pub(crate) fn png(patch: &Patch<[u8; 4]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, patch.width, patch.height);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(patch.values.as_flattened()).expect("pixels");
    writer.finish().expect("an end");
    bytes
}
