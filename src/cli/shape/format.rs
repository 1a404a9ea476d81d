//! The kind of output, from its name or from `--format`.

use std::path::Path;

/// Every kind of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// One form.
    Obj,
    /// A folder of forms.
    ObjSequence,
    /// The examples with their animation.
    Glb,
    /// The contact sheet.
    Sheet,
    /// One form as a picture.
    Picture,
    /// A folder of pictures.
    PictureSequence,
}

impl Format {
    /// The kind that `named`, or else the name `output`, asks for; `is_one` says whether one place or frame is meant.
    pub(super) fn of(output: &Path, named: Option<&str>, is_one: bool) -> Result<Self, String> {
        let is_folder = output.is_dir() || output.to_string_lossy().ends_with('/');
        let suffix = output.extension().map(|s| s.to_string_lossy().to_lowercase());
        let suffix = suffix.filter(|_| !is_folder);
        let folder_or = |single: Self, sequence: Self| match (&suffix, is_one) {
            (None, _) => Ok(sequence),
            (Some(_), true) => Ok(single),
            (Some(_), false) => Err(format!(
                "{}: that is one file, but the animation has many frames; choose a folder, or one form with --at",
                output.display()
            )),
        };
        match (named, suffix.as_deref()) {
            (Some("obj"), _) | (None, Some("obj") | None) => folder_or(Self::Obj, Self::ObjSequence),
            (Some("glb"), _) | (None, Some("glb")) => Ok(Self::Glb),
            (Some("sheet"), _) => Ok(Self::Sheet),
            (Some("png"), _) => folder_or(Self::Picture, Self::PictureSequence),
            (None, Some("png")) if is_one => Ok(Self::Picture),
            (None, Some("png")) => Ok(Self::Sheet),
            (Some(other), _) => Err(format!(
                "format '{other}' is not known; choose one of obj, glb, sheet, png"
            )),
            (None, Some(other)) => Err(format!(
                "{}: output ending in .{other} is not supported for shapes; choose a folder (OBJ files), or a file ending in \
                 .obj, .glb or .png",
                output.display()
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_says_it_unless_format_does() {
        let of = |output: &str, named: Option<&str>, is_one: bool| Format::of(Path::new(output), named, is_one);
        assert_eq!(of("forms", None, false), Ok(Format::ObjSequence));
        assert_eq!(of("forms.1/", None, true), Ok(Format::ObjSequence));
        assert_eq!(of("a.OBJ", None, true), Ok(Format::Obj));
        assert!(of("a.obj", None, false).is_err_and(|message| message.contains("--at")));
        assert_eq!(of("a.glb", None, false), Ok(Format::Glb));
        assert_eq!(of("a.png", None, false), Ok(Format::Sheet));
        assert_eq!(of("a.png", None, true), Ok(Format::Picture));
        assert_eq!(of("a.png", Some("sheet"), true), Ok(Format::Sheet));
        assert_eq!(of("frames", Some("png"), false), Ok(Format::PictureSequence));
        assert!(of("a.fbx", None, false).is_err_and(|message| message.contains(".glb")));
        assert!(of("a", Some("fbx"), false).is_err_and(|message| message.contains("sheet")));
    }
}
