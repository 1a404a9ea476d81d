//! What of a layer is not kept.

/// Something of a layer that is left out or taken otherwise than in the program that it was drawn with.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayerNote {
    /// A layer that holds no pixels but changes those behind it, or makes them.
    NoPixels {
        /// What it is.
        what: String,
    },
    /// Text that can be edited: the pixels that the file keeps of it are taken.
    LiveText,
    /// Shadows, glows and strokes that are made when the picture is shown.
    Effects,
    /// A blend mode that is not read; the layer covers what is behind it.
    BlendMode {
        /// Its name in the file.
        mode: String,
    },
    /// A blend mode that takes away from what is behind it; the layer is not drawn.
    CutsOut {
        /// Its name in the file.
        mode: String,
    },
    /// A mask of curves without pixels.
    VectorMask,
    /// A mask whose edge is softened, or that is weakened, when the picture is shown.
    MaskSoftened,
    /// Masks of other kinds, such as filters.
    Mask {
        /// What they are.
        what: String,
    },
    /// An animated layer of a file of which one picture is read.
    Animated,
    /// A single drawing is moved in front of or behind others of its frame.
    DepthMoved,
}

impl std::fmt::Display for LayerNote {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoPixels { what } => write!(f, "it is {what}, which is not drawn; merge it into the layers that it changes, or turn it into pixels"),
            Self::LiveText => f.write_str("its text is taken as the pixels that the file keeps of it"),
            Self::Effects => f.write_str("its effects (shadows, glows, strokes) are not drawn; turn them into pixels if they are to be seen"),
            Self::BlendMode { mode } => write!(
                f,
                "its blend mode '{mode}' is not read, and it is drawn as a normal layer; merge it into what is behind it, or use 'normal' or 'multiply'"
            ),
            Self::CutsOut { mode } => write!(
                f,
                "it cuts out of what is behind it by its blend mode '{mode}', which is not read, and it is not drawn; turn it into a mask"
            ),
            Self::VectorMask => f.write_str("its vector mask does not cut it off; turn the mask into one of pixels"),
            Self::MaskSoftened => f.write_str("the feather and density of its mask do not count; apply the mask"),
            Self::Mask { what } => write!(f, "its {what} does not count; apply it, or turn it into a transparency mask"),
            Self::Animated => f.write_str("it is animated, and only its first picture is taken; save the frames as layers"),
            Self::DepthMoved => f.write_str("a drawing of it is moved in front of or behind other layers, which does not count; move it to a layer there"),
        }
    }
}
