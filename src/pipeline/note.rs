//! What the artist should know, as values: a caller can count, group and translate them; shown, each is a sentence.

use crate::input::InputNote;
use crate::math::Point;
use crate::registration::Explained;
use crate::render::CrossFade;

/// The most loose parts that a sentence names.
const MOST_NAMED: usize = 6;

/// A remark on a character, which is made all the same.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Note {
    /// The layer that it is about; `None` where a character has only one, or it is about no layer in particular.
    pub layer: Option<String>,
    /// The pose that it is about, if it is one.
    pub pose: Option<String>,
    /// What there is to know.
    pub kind: NoteKind,
}

/// What there is to know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum NoteKind {
    /// How the pose's drawing was read.
    Drawing(InputNote),
    /// A unit of the pose's drawing is larger on the page than one of another pose's, and coordinates are taken as they are.
    UnitsDiffer {
        /// The pose whose units are smallest.
        smallest: String,
        /// How many times as large.
        times: f64,
    },
    /// The pose would match better if it were reflected.
    LooksReflected,
    /// Little of what the reference shows is found on the pose.
    Unlike {
        /// The name of the reference.
        reference: String,
        /// How much is found, and where least.
        explained: Explained,
    },
    /// The pose lacks a line of landmarks from outline to outline, which follows the outline there.
    LineMissing {
        /// The name of the line.
        landmark: String,
    },
    /// The pose lacks a landmark inside the figure, which was given a place there.
    LandmarkPlaced {
        /// Its name.
        landmark: String,
        /// Its place, in the drawing's coordinates.
        at: Point,
    },
    /// Some poses are turned by half a turn against one another: either way round is as good.
    TurnsAmbiguous,
    /// Elements of vector drawings that correspond are cross-faded.
    CrossFaded(CrossFade),
    /// The drawings have loose parts, each of which is a layer of its own.
    LooseParts {
        /// Their names, from back to front.
        parts: Vec<LoosePartName>,
    },
    /// In the pose, a part lies in front of itself by way of others, so that no order shows all of it.
    DepthCycle {
        /// A part that lies in front of the other there, and is drawn behind it.
        front: String,
        /// The other.
        behind: String,
    },
    /// A part that lies over others joins several of them, and hangs on one.
    JointsLeft {
        /// Its name.
        region: String,
        /// What it hangs on.
        to: String,
        /// What else it joins.
        left: Vec<String>,
    },
    /// A part that lies over others joins none of them, and hangs on nothing.
    NoJoint {
        /// Its name.
        region: String,
    },
    /// Parts that lie over one another were not sought where the drawings were separated.
    OverlapsNotSought {
        /// Why they could not be.
        why: String,
    },
    /// A line of landmarks lies on several parts that lie over one another, and was left out.
    LineDivided {
        /// The name of the line.
        landmark: String,
    },
    /// The parts of vector drawings were written as pixels.
    CurvesAsPixels {
        /// The poses that they are of.
        poses: Vec<String>,
        /// Pixels a unit of the drawings.
        pixels_per_unit: f64,
    },
}

/// A loose part by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoosePartName {
    /// What its layer is called.
    pub name: String,
    /// The poses that lack it.
    pub lacking: Vec<String>,
}

impl Note {
    /// A remark on the whole of a character.
    pub(super) fn on_all(kind: NoteKind) -> Self {
        Self {
            layer: None,
            pose: None,
            kind,
        }
    }

    /// A remark on the parts that drawings were separated into.
    #[cfg(feature = "scene")]
    pub(crate) fn of_separation(kind: NoteKind) -> Self {
        Self::on_all(kind)
    }

    /// A remark on a pose.
    pub(super) fn on_pose(pose: &str, kind: NoteKind) -> Self {
        Self {
            layer: None,
            pose: Some(pose.to_owned()),
            kind,
        }
    }
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(layer) = &self.layer {
            write!(f, "layer '{layer}': ")?;
        }
        let pose = self.pose.as_deref().unwrap_or_default();
        match &self.kind {
            NoteKind::Drawing(note) => write!(f, "pose '{pose}': {note}"),
            NoteKind::UnitsDiffer { smallest, times } => write!(
                f,
                "a unit of pose '{pose}' is {times:.2} times as large on the page as one of pose '{smallest}', and coordinates are taken as \
                 they are; save both with the same units and viewBox if one looks too small"
            ),
            NoteKind::LooksReflected => write!(
                f,
                "pose '{pose}' would match better reflected; set `mirror = true` if it faces the other way"
            ),
            NoteKind::Unlike { reference, explained } => {
                let Explained { share, least: [from, to] } = explained;
                write!(
                    f,
                    "only {:.0} % of what pose '{reference}' shows is found on pose '{pose}', least of all near ({:.0}, {:.0}), so that their \
                     forms alone are matched; if it is the same character, a landmark there, on '{reference}' near ({:.0}, {:.0}), would help \
                     most",
                    100.0 * share,
                    to.x,
                    to.y,
                    from.x,
                    from.y
                )
            }
            NoteKind::LineMissing { landmark } => write!(
                f,
                "landmark '{landmark}' has no line in pose '{pose}': it follows the outline there; give it one if that is wrong"
            ),
            NoteKind::LandmarkPlaced { landmark, at } => write!(
                f,
                "landmark '{landmark}' has no place in pose '{pose}': it was put at ({:.1}, {:.1}); give it one if that is wrong",
                at.x, at.y
            ),
            NoteKind::TurnsAmbiguous => f.write_str(
                "some poses are turned by half a turn against one another, so either way round is as good; set `turns` on a pose to \
                 choose",
            ),
            NoteKind::CrossFaded(cross_fade) => cross_fade.fmt(f),
            NoteKind::DepthCycle { front, behind } => write!(
                f,
                "pose '{pose}': '{front}' lies in front of '{behind}', and behind it by way of other parts; it is drawn behind, as frames are; divide \
                 one of them if that is wrong"
            ),
            NoteKind::JointsLeft { region, to, left } => write!(
                f,
                "'{region}' joins several parts, and hangs on '{to}' alone; beside it, it may come apart from {}",
                quoted(left)
            ),
            NoteKind::NoJoint { region } => {
                write!(
                    f,
                    "'{region}' joins no other part, and hangs on none; give it an anchor if it should"
                )
            }
            NoteKind::OverlapsNotSought { why } => {
                write!(f, "parts that lie over one another were not sought: {why}")
            }
            NoteKind::LineDivided { landmark } => write!(
                f,
                "landmark '{landmark}' is a line over several parts that lie over one another, and was left out; draw it anew on each of them"
            ),
            NoteKind::CurvesAsPixels { poses, pixels_per_unit } => write!(
                f,
                "what one part hides of another cannot be filled in curves: the parts of {} were written as pixels, {pixels_per_unit:.2} a unit",
                quoted(poses)
            ),
            NoteKind::LooseParts { parts } => {
                let mut listed: Vec<String> = parts.iter().take(MOST_NAMED).map(ToString::to_string).collect();
                if parts.len() > MOST_NAMED {
                    listed.push(format!("{} more", parts.len() - MOST_NAMED));
                }
                write!(
                    f,
                    "the drawings have {} loose parts, each a layer of its own, from back to front: {}",
                    parts.len(),
                    listed.join(", ")
                )
            }
        }
    }
}

/// Names as a sentence lists them.
fn quoted(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().take(MOST_NAMED).map(|name| format!("'{name}'")).collect();
    match names.len().checked_sub(MOST_NAMED) {
        None | Some(0) => quoted.join(", "),
        Some(more) => format!("{} and {more} more", quoted.join(", ")),
    }
}

impl std::fmt::Display for LoosePartName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "'{}'", self.name)?;
        match self.lacking.as_slice() {
            [] => Ok(()),
            [one] => write!(f, " (not in '{one}')"),
            several => write!(f, " (not in {} poses)", several.len()),
        }
    }
}
