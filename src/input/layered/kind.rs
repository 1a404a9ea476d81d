//! Which kind of layered file some bytes are.

/// The mark at the beginning of PSD and PSB files.
const PHOTOSHOP: &[u8] = b"8BPS";
/// The mark of Aseprite files, after their length.
const ASEPRITE: [u8; 2] = [0xe0, 0xa5];
/// Where the name of a ZIP archive's first entry begins; it is `mimetype`, stored as it is, in OpenRaster and Krita files.
const FIRST_NAME: usize = 30;
/// How far from there the kind of file is looked for.
const MIME_WITHIN: usize = 128;

/// A kind of layered file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayeredKind {
    /// PSD and PSB.
    Photoshop,
    /// ORA.
    OpenRaster,
    /// KRA.
    Krita,
    /// ASE and ASEPRITE.
    Aseprite,
}

impl LayeredKind {
    /// The suffixes of their files.
    pub const SUFFIXES: [&'static str; 6] = ["psd", "psb", "ora", "kra", "ase", "aseprite"];

    /// The kind of the file with these bytes; `None` if it is no layered file.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(PHOTOSHOP) {
            return Some(Self::Photoshop);
        }
        if bytes.get(4..6) == Some(&ASEPRITE) && bytes.len() >= 128 {
            return Some(Self::Aseprite);
        }
        if !bytes.starts_with(b"PK\x03\x04") {
            return None;
        }
        let after = bytes.get(FIRST_NAME..)?;
        let head = after.get(..MIME_WITHIN.min(after.len()))?;
        let has = |mark: &[u8]| head.windows(mark.len()).any(|part| part == mark);
        match () {
            () if has(b"image/openraster") => Some(Self::OpenRaster),
            () if has(b"application/x-krita") || has(b"application/x-kra") => Some(Self::Krita),
            () => None,
        }
    }
}
