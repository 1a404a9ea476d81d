//! One picture as PNG.

use std::fs::File;
use std::io::{Read, Seek as _, SeekFrom, Write};
use std::path::Path;

use super::WriteError;
use crate::render::Frame;

/// The word before a [`Label`] in a PNG file.
const KEYWORD: &str = "inbetween";
/// How much of a file is searched for a label: it stands right behind the header.
const SEARCHED: u64 = 4096;
/// The chunk that ends a PNG file.
const END: [u8; 12] = [0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82];

/// What a frame was made from, in as many letters as it takes to tell it from all others: a hash. Kept inside the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label(String);

impl Label {
    /// A label of letters, digits and spaces; other characters are left out.
    #[must_use]
    pub fn new(text: &str) -> Self {
        Self(
            text.chars()
                .filter(|c| c.is_ascii_alphanumeric() || *c == ' ')
                .collect(),
        )
    }

    /// The comment that ends an SVG file with this label.
    pub(super) fn comment(&self) -> String {
        format!("<!-- {KEYWORD} {} -->\n", self.0)
    }

    /// Whether there is a whole SVG file with this label at `path`.
    pub(super) fn is_on_svg(&self, path: &Path) -> bool {
        let wanted = format!("</svg>\n{}", self.comment());
        let read = || -> std::io::Result<bool> {
            let mut file = File::open(path)?;
            let mut end = vec![0; wanted.len()];
            file.seek(SeekFrom::End(-(end.len() as i64)))?;
            file.read_exact(&mut end)?;
            Ok(end == wanted.as_bytes())
        };
        read().unwrap_or(false)
    }

    /// Whether there is a whole PNG file with this label at `path`.
    #[must_use]
    pub fn is_on(&self, path: &Path) -> bool {
        let read = || -> std::io::Result<bool> {
            let mut file = File::open(path)?;
            let mut start = Vec::new();
            Read::by_ref(&mut file).take(SEARCHED).read_to_end(&mut start)?;
            let mut end = [0; END.len()];
            file.seek(SeekFrom::End(-(END.len() as i64)))?;
            file.read_exact(&mut end)?;
            let wanted = [KEYWORD.as_bytes(), b"\0", self.0.as_bytes()].concat();
            let chunk = [&(wanted.len() as u32).to_be_bytes(), b"tEXt".as_slice(), &wanted].concat();
            Ok(end == END && start.windows(chunk.len()).any(|bytes| bytes == chunk))
        };
        read().unwrap_or(false)
    }
}

/// The bytes of an 8-bit RGBA PNG file (sRGB colours, alpha not multiplied in).
///
/// # Errors
/// [`WriteError::Encoding`] for a picture without pixels.
pub fn png_bytes(frame: &Frame) -> Result<Vec<u8>, WriteError> {
    encoded(frame, None)
}

/// Writes a frame as an 8-bit RGBA PNG file (sRGB colours, alpha not multiplied in).
///
/// # Errors
/// [`WriteError`] for a picture without pixels, or if the bytes cannot be written.
pub fn write_png(frame: &Frame, writer: impl Write) -> Result<(), WriteError> {
    write_straight_png(writer, [frame.width, frame.height], &frame.straight(), None)
}

/// The same with a label inside.
///
/// # Errors
/// As [`png_bytes`].
pub fn png_bytes_with(frame: &Frame, label: &Label) -> Result<Vec<u8>, WriteError> {
    encoded(frame, Some(label))
}

fn encoded(frame: &Frame, label: Option<&Label>) -> Result<Vec<u8>, WriteError> {
    straight_png_bytes([frame.width, frame.height], &frame.straight(), label)
}

/// The bytes of a PNG file from those of its pixels, colours not multiplied by alpha.
pub(super) fn straight_png_bytes(
    size: [usize; 2],
    pixels: &[u8],
    label: Option<&Label>,
) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Vec::new();
    write_straight_png(&mut bytes, size, pixels, label)?;
    Ok(bytes)
}

fn write_straight_png(
    writer: impl Write,
    size: [usize; 2],
    pixels: &[u8],
    label: Option<&Label>,
) -> Result<(), WriteError> {
    let mut encoder = png::Encoder::new(writer, size[0] as u32, size[1] as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    if let Some(Label(text)) = label {
        encoder.add_text_chunk(KEYWORD.to_owned(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    Ok(writer.finish()?)
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

    #[test]
    fn a_label_is_found_on_whole_files_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let (label, other) = (Label::new("0123abcd"), Label::new("0123abce"));
        assert!(!label.is_on(&path));
        let bytes = png_bytes_with(&Frame::filled(30, 20, [1, 2, 3, 255]), &label).expect("a picture");
        std::fs::write(&path, &bytes).expect("written");
        assert!(label.is_on(&path) && !other.is_on(&path) && !Label::new("0123").is_on(&path));
        assert!(image::load_from_memory(&bytes).is_ok());
        for length in [bytes.len() - 1, bytes.len() / 2, 10, 0] {
            std::fs::write(&path, &bytes[..length]).expect("written");
            assert!(!label.is_on(&path), "{length}");
        }
    }
}
