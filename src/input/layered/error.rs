//! Why a layered file is no drawing.

/// The most paths that a refusal lists.
const MOST_LISTED: usize = 12;

/// Why a layered file, or a layer of it, cannot be used. Whoever opens the file adds its name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LayeredError {
    /// The file ends before something that it promises.
    #[error("the file is cut off or damaged: {what} does not fit into it; save or copy it again")]
    CutOff {
        /// What was being read.
        what: &'static str,
    },
    /// Something in the file contradicts the format.
    #[error("the file is damaged: {what}; save it again in the program that it was drawn with")]
    Damaged {
        /// What is wrong.
        what: String,
    },
    /// The pixels of one layer cannot be read.
    #[error("layer '{layer}' is damaged: {what}; save the file again in the program that it was drawn with")]
    DamagedLayer {
        /// The path of the layer.
        layer: String,
        /// What is wrong.
        what: String,
    },
    /// A kind of file, or of colours, that is not read.
    #[error("{what} not read; {remedy}")]
    Unsupported {
        /// What, with its verb: "32-bit channels are".
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A layer has colours of a kind that is not read.
    #[error("layer '{layer}': {what} not read; {remedy}")]
    UnsupportedLayer {
        /// The path of the layer.
        layer: String,
        /// What, with its verb.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The file has more of something than is read.
    #[error("the file has {found} {what}, but at most {most} are read; remove some or merge them")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        found: usize,
        /// How many are read.
        most: usize,
    },
    /// Groups that are clipped, masked or blended lie so deep in one another that composing them needs too much memory.
    #[error(
        "group '{layer}' cannot be composed: with the groups around it and a canvas of this size it needs too much memory; merge it, or scale the \
         picture down"
    )]
    TooDeep {
        /// The path of the group.
        layer: String,
    },
    /// The layers of one picture are more than is composed.
    #[error("its layers and groups have more pixels together than are composed; merge some, or scale the picture down")]
    TooMuchWork,
    /// No layer or group is where `element` says.
    #[error(
        "there is no layer or group '{path}'; {}",
        if known.is_empty() { "the file has none".to_owned() } else { format!("there are: {}{}", known.join(", "), if *more > 0 { ", ..." } else { "" }) }
    )]
    NoSuchLayer {
        /// The path that was asked for.
        path: String,
        /// The first paths of the file.
        known: Vec<String>,
        /// How many further ones there are.
        more: usize,
    },
    /// The file has no layers at all, or its picture none that is visible.
    #[error("nothing is visible in the picture: no layer is shown; show some, or name one with `element`")]
    NothingVisible,
    /// A layer or group has no pixels on the canvas.
    #[error("nothing is drawn in '{layer}' on the canvas{}; draw it, or name another layer", frame.map(|frame| format!(" in frame {frame}")).unwrap_or_default())]
    EmptyLayer {
        /// Its path.
        layer: String,
        /// The frame, of a file with several.
        frame: Option<usize>,
    },
}

impl LayeredError {
    pub(super) fn damaged(what: impl Into<String>) -> Self {
        Self::Damaged { what: what.into() }
    }

    pub(super) fn no_such_layer(path: &str, known: Vec<String>) -> Self {
        let more = known.len().saturating_sub(MOST_LISTED);
        Self::NoSuchLayer {
            path: path.to_owned(),
            known: known.into_iter().take(MOST_LISTED).collect(),
            more,
        }
    }

    /// The same of one layer of the file.
    pub(super) fn of_layer(self, layer: &str) -> Self {
        let layer = layer.to_owned();
        match self {
            Self::CutOff { what } => Self::DamagedLayer {
                layer,
                what: format!("{what} does not fit into the file"),
            },
            Self::Damaged { what } => Self::DamagedLayer { layer, what },
            Self::Unsupported { what, remedy } => Self::UnsupportedLayer { layer, what, remedy },
            other => other,
        }
    }
}
