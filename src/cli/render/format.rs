//! The kind of output, from its name or from `--format`.

use std::path::Path;

/// Every kind of output that a name or `--format` can ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// A folder of numbered PNG files.
    Png,
    Gif,
    Apng,
    WebP,
    /// One SVG file that moves.
    Svg,
    /// A folder of numbered SVG files.
    SvgSequence,
    Lottie,
    Glb,
    Spine,
    /// One PNG file with all frames, and a JSON file that says where they are.
    Sprites,
    /// The crate's own file for playing.
    Runtime,
    Mp4,
    WebM,
}

impl Format {
    const ALL: [Self; 13] = [
        Self::Png,
        Self::Gif,
        Self::Apng,
        Self::WebP,
        Self::Svg,
        Self::SvgSequence,
        Self::Lottie,
        Self::Glb,
        Self::Spine,
        Self::Sprites,
        Self::Runtime,
        Self::Mp4,
        Self::WebM,
    ];

    /// Its name for `--format`.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Gif => "gif",
            Self::Apng => "apng",
            Self::WebP => "webp",
            Self::Svg => "svg",
            Self::SvgSequence => "svg-sequence",
            Self::Lottie => "lottie",
            Self::Glb => "glb",
            Self::Spine => "spine",
            Self::Sprites => "sprites",
            Self::Runtime => "runtime",
            Self::Mp4 => "mp4",
            Self::WebM => "webm",
        }
    }

    /// The ending of a file name that stands for it by itself.
    fn suffix(self) -> Option<&'static str> {
        match self {
            Self::Lottie => Some("json"),
            Self::Runtime => Some("inb"),
            Self::Png | Self::SvgSequence | Self::Spine | Self::Sprites => None,
            named => Some(named.name()),
        }
    }

    /// Whether it is a folder of files, one a frame.
    pub(super) fn is_sequence(self) -> bool {
        matches!(self, Self::Png | Self::SvgSequence)
    }

    /// The kind that `named`, or else the name `output`, asks for.
    pub(super) fn of(output: &Path, named: Option<&str>) -> Result<Self, String> {
        if let Some(named) = named {
            let known = Self::ALL.into_iter().find(|format| format.name() == named);
            return known.ok_or_else(|| format!("format '{named}' is not known; choose one of {}", names()));
        }
        let is_folder = output.is_dir() || output.to_string_lossy().ends_with('/');
        let suffix = output.extension().map(|s| s.to_string_lossy().to_lowercase());
        let Some(suffix) = suffix.filter(|_| !is_folder) else {
            return Ok(Self::Png);
        };
        let known = Self::ALL.into_iter().find(|format| format.suffix() == Some(&suffix));
        known.ok_or_else(|| {
            format!(
                "{}: output ending in .{suffix} is not supported by render{}; choose a folder (PNG files), a file ending \
                 in {}, or say --format",
                output.display(),
                if suffix == "png" {
                    " (one picture: `inbetween frame`; all frames in one picture: --format sprites)"
                } else {
                    ""
                },
                suffixes()
            )
        })
    }
}

fn names() -> String {
    Format::ALL.map(Format::name).join(", ")
}

fn suffixes() -> String {
    let suffixes: Vec<String> = Format::ALL
        .into_iter()
        .filter_map(Format::suffix)
        .map(|suffix| format!(".{suffix}"))
        .collect();
    suffixes.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_says_it_unless_format_does() {
        let of = |output: &str, named: Option<&str>| Format::of(Path::new(output), named);
        assert_eq!(of("frames", None), Ok(Format::Png));
        assert_eq!(of("take.2/", None), Ok(Format::Png));
        assert_eq!(of("A.GIF", None), Ok(Format::Gif));
        assert_eq!(of("a.json", None), Ok(Format::Lottie));
        assert_eq!(of("a.json", Some("spine")), Ok(Format::Spine));
        assert_eq!(of("a.inb", None), Ok(Format::Runtime));
        assert_eq!(of("a.png", Some("sprites")), Ok(Format::Sprites));
        assert!(of("a.png", None).is_err_and(|message| message.contains("inbetween frame")));
        assert!(of("a.tiff", None).is_err_and(|message| message.contains(".webp")));
        assert!(of("a.gif", Some("tiff")).is_err_and(|message| message.contains("svg-sequence")));
        for format in Format::ALL {
            assert_eq!(of("a", Some(format.name())), Ok(format));
        }
    }
}
