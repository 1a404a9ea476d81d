//! Which kind of layered file some bytes are.

/// The mark at the beginning of PSD and PSB files.
const PHOTOSHOP: &[u8] = b"8BPS";

/// A kind of layered file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayeredKind {
    /// PSD and PSB.
    Photoshop,
}

impl LayeredKind {
    /// The suffixes of their files.
    pub const SUFFIXES: [&'static str; 2] = ["psd", "psb"];

    /// The kind of the file with these bytes; `None` if it is no layered file.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        bytes.starts_with(PHOTOSHOP).then_some(Self::Photoshop)
    }
}
