//! What the layers of files mean: which are poses, which are parts.
//!
//! Layered files -> the layers and poses of a new scene.
//!
//! 1. Which meaning holds is asked for, or found ([`guessed`]). A single group around everything is passed through.
//! 2. What is named by the meaning gives poses, each with its parts. What is a pose counts although it is hidden; parts that are hidden, empty or bare paper do not.
//!    Layers that are clipped by another are part of that one.
//! 3. Parts of the same name correspond. If no two poses have a part in common, each pose is its whole drawing; if there is but one part, it is the drawing.
//! 4. The layers' order is that of the first pose, into which those that only others have are put where these have them.

use std::path::Path;

use anyhow::{Context as _, bail};
use inbetween::input::layered::{Clipping, Layer, LayeredError, LayeredFile};
use inbetween::input::{InputError, PictureChoice};
use inbetween::scene::{NewElement, NewPose};

use super::part_names::{merged_order, own_order, unite_names};

/// What the layers of files mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum LayerMeaning {
    /// The outermost groups are poses, and what is in them are their parts
    PoseGroups,
    /// The outermost groups are parts, and what is in them are these parts in several poses
    PartGroups,
    /// Every file, or frame, is a pose, and its outermost layers and groups are its parts
    PartLayers,
    /// Every outermost layer or group is a pose without parts
    PoseLayers,
}

/// A layered file that is given.
pub(super) struct Source<'a> {
    /// As it is given.
    pub(super) path: &'a Path,
    /// As the scene names it.
    pub(super) source: String,
    pub(super) file: LayeredFile<'a>,
}

/// What a new scene has of layered files.
pub(super) struct Found {
    pub(super) layers: Vec<String>,
    pub(super) poses: Vec<NewPose>,
    /// What was taken for what.
    pub(super) notes: Vec<String>,
}

/// A pose before it is known which of its parts others have.
pub(super) struct Candidate {
    pub(super) name: String,
    pub(super) source: String,
    pub(super) picture: PictureChoice,
    /// What it is without parts.
    pub(super) whole: NewElement,
    /// Names and paths, from back to front.
    pub(super) parts: Vec<(String, String)>,
}

/// The layers and poses of a scene of these files.
pub(super) fn poses_of(sources: &[Source<'_>], asked: Option<LayerMeaning>) -> anyhow::Result<Found> {
    let mut notes = Vec::new();
    let mut outermost = Vec::new();
    for source in sources {
        outermost.push(drawn_layers(source, &mut notes)?);
    }
    let meaning = asked.unwrap_or_else(|| guessed(sources, &outermost));
    let mut candidates: Vec<Candidate> = Vec::new();
    for (source, layers) in sources.iter().zip(&outermost) {
        match meaning {
            LayerMeaning::PoseGroups => pose_groups(source, layers, &mut candidates, &mut notes)?,
            LayerMeaning::PartGroups => part_groups(source, layers, &mut candidates, &mut notes)?,
            LayerMeaning::PartLayers => part_layers(source, layers, &mut candidates, &mut notes)?,
            LayerMeaning::PoseLayers => pose_layers(source, layers, &mut candidates)?,
        }
    }
    if candidates.is_empty() {
        let files: Vec<String> = sources.iter().map(|source| source.path.display().to_string()).collect();
        bail!(
            "{}: no pose is found in its layers {}; say what they mean with --layers, or draw something in them",
            files.join(", "),
            meant(meaning)
        );
    }
    unite_names(&mut candidates);
    let all = merged_order(&candidates);
    let is_shared = |name: &String| {
        let having = candidates
            .iter()
            .filter(|pose| pose.parts.iter().any(|(own, _)| own == name));
        having.count() > 1
    };
    let has_parts = meaning == LayerMeaning::PartGroups || candidates.len() == 1 || all.iter().any(is_shared);
    let layers = if has_parts && all.len() > 1 { all } else { Vec::new() };
    notes.push(told(&candidates, &layers, meaning, sources));
    let is_single = has_parts && layers.is_empty();
    let poses = candidates.into_iter().map(|pose| {
        let order = own_order(&pose, &layers);
        let element = if layers.is_empty() {
            match pose.parts.into_iter().next() {
                Some((_, path)) if is_single => NewElement::One(path),
                _ => pose.whole,
            }
        } else {
            NewElement::Layers {
                elements: pose.parts,
                order,
            }
        };
        NewPose {
            name: pose.name,
            source: pose.source,
            picture: pose.picture,
            element,
            at: None,
        }
    });
    Ok(Found {
        poses: poses.collect(),
        layers,
        notes,
    })
}

/// The meaning of files of which nobody says it. Several files, or frames, are poses. In one picture with several groups, these are poses; if each of them shows exactly one
/// of several layers, as parts do of which one drawing is chosen at a time, they are parts. Otherwise every layer is a pose.
fn guessed(sources: &[Source<'_>], outermost: &[Vec<&Layer>]) -> LayerMeaning {
    let [layers] = outermost else {
        return LayerMeaning::PartLayers;
    };
    if sources.iter().any(|source| source.file.frame_count() > 1) {
        return LayerMeaning::PartLayers;
    }
    let groups: Vec<&Layer> = layers.iter().copied().filter(|layer| layer.is_group()).collect();
    let shows_one = |group: &&Layer| {
        let own = || group.children().iter().filter(|child| child.clipping != Clipping::Base);
        own().count() > 1 && own().filter(|child| child.is_visible).count() == 1
    };
    match groups.len() {
        0 | 1 => LayerMeaning::PoseLayers,
        _ if groups.iter().all(shows_one) => LayerMeaning::PartGroups,
        _ => LayerMeaning::PoseGroups,
    }
}

/// The meaning in words.
fn meant(meaning: LayerMeaning) -> &'static str {
    match meaning {
        LayerMeaning::PoseGroups => "(groups as poses)",
        LayerMeaning::PartGroups => "(groups as parts)",
        LayerMeaning::PartLayers => "(layers as parts)",
        LayerMeaning::PoseLayers => "(layers as poses)",
    }
}

/// What was taken for what, in words, and what else may be meant.
fn told(candidates: &[Candidate], layers: &[String], meaning: LayerMeaning, sources: &[Source<'_>]) -> String {
    let files = match sources {
        [one] => one.path.display().to_string(),
        several => format!("{} files", several.len()),
    };
    let frames = sources.iter().any(|source| source.file.frame_count() > 1);
    let (what, others) = match meaning {
        LayerMeaning::PoseGroups => ("outermost groups", "part-groups, part-layers or pose-layers"),
        LayerMeaning::PartGroups => (
            "layers of one name in the groups",
            "pose-groups, part-layers or pose-layers",
        ),
        LayerMeaning::PartLayers if frames => ("frames", "pose-groups, part-groups or pose-layers"),
        LayerMeaning::PartLayers => ("files", "pose-groups, part-groups or pose-layers"),
        LayerMeaning::PoseLayers => ("outermost layers", "pose-groups, part-groups or part-layers"),
    };
    let poses: Vec<&str> = candidates.iter().map(|pose| pose.name.as_str()).collect();
    let parts = if layers.is_empty() {
        "each is one drawing".to_owned()
    } else {
        format!("their parts, from back to front, are {}", layers.join(", "))
    };
    format!(
        "{files}: the {what} are the poses {}; {parts}; if it is meant otherwise, say so with --layers {others}",
        poses.join(", ")
    )
}

/// The outermost layers and groups of a file, without bare paper. A single group around everything is passed through.
fn drawn_layers<'s>(source: &'s Source<'_>, notes: &mut Vec<String>) -> anyhow::Result<Vec<&'s Layer>> {
    let mut layers: Vec<&Layer> = Vec::new();
    let mut siblings = source.file.layers();
    loop {
        layers.clear();
        for layer in siblings.iter().filter(|layer| layer.clipping != Clipping::Base) {
            if !layer.is_group() && is_paper(source, layer)? {
                notes.push(format!(
                    "{}: layer '{}' is bare paper and is left out",
                    source.path.display(),
                    layer.path
                ));
            } else {
                layers.push(layer);
            }
        }
        match layers.as_slice() {
            [group] if group.is_group() && !group.children().is_empty() => siblings = group.children(),
            _ => return Ok(layers),
        }
    }
}

/// Whether a layer covers the canvas with one colour.
fn is_paper(source: &Source<'_>, layer: &Layer) -> anyhow::Result<bool> {
    let Some(rgba) = picture(source, Some(&layer.path), 0)? else {
        return Ok(false);
    };
    let first = rgba.get(..4).unwrap_or_default();
    Ok(first.last() == Some(&u8::MAX) && rgba.chunks_exact(4).all(|pixel| pixel == first))
}

/// What an element shows in a frame; `None` if it is empty.
fn picture(source: &Source<'_>, element: Option<&str>, frame: usize) -> anyhow::Result<Option<Vec<u8>>> {
    match source.file.picture(element, frame) {
        Ok(picture) => Ok(Some(picture.rgba)),
        Err(InputError::Layered(LayeredError::EmptyLayer { .. } | LayeredError::NothingVisible)) => Ok(None),
        Err(error) => Err(error).with_context(|| format!("cannot use the drawing {}", source.path.display())),
    }
}

/// The parts among some siblings.
fn parts_in<'l>(
    source: &Source<'_>,
    siblings: impl Iterator<Item = &'l Layer>,
    frame: usize,
) -> anyhow::Result<Vec<(String, String)>> {
    let mut parts = Vec::new();
    for layer in siblings.filter(|layer| layer.clipping != Clipping::Base && layer.is_visible) {
        if picture(source, Some(&layer.path), frame)?.is_some() {
            parts.push((own_name(layer), layer.path.clone()));
        }
    }
    Ok(parts)
}

/// What a part or pose is called after its layer.
fn own_name(layer: &Layer) -> String {
    let name = layer.name_among_siblings().trim();
    if name.is_empty() {
        "layer".to_owned()
    } else {
        name.to_owned()
    }
}

fn pose_groups(
    source: &Source<'_>,
    layers: &[&Layer],
    candidates: &mut Vec<Candidate>,
    notes: &mut Vec<String>,
) -> anyhow::Result<()> {
    leave_out(source, layers, notes);
    for group in layers.iter().filter(|layer| layer.is_group()) {
        let parts = parts_in(source, group.children().iter(), 0)?;
        if !parts.is_empty() {
            candidates.push(Candidate {
                name: own_name(group),
                source: source.source.clone(),
                picture: PictureChoice::Only,
                whole: NewElement::One(group.path.clone()),
                parts,
            });
        }
    }
    Ok(())
}

fn part_groups(
    source: &Source<'_>,
    layers: &[&Layer],
    candidates: &mut Vec<Candidate>,
    notes: &mut Vec<String>,
) -> anyhow::Result<()> {
    leave_out(source, layers, notes);
    let first = candidates.len();
    for group in layers.iter().filter(|layer| layer.is_group()) {
        for layer in group.children().iter().filter(|layer| layer.clipping != Clipping::Base) {
            if picture(source, Some(&layer.path), 0)?.is_none() {
                continue;
            }
            let part = (own_name(group), layer.path.clone());
            let name = own_name(layer);
            match candidates[first..].iter_mut().find(|pose| pose.name == name) {
                Some(pose) => pose.parts.push(part),
                None => candidates.push(Candidate {
                    name,
                    source: source.source.clone(),
                    picture: PictureChoice::Only,
                    whole: NewElement::Whole,
                    parts: vec![part],
                }),
            }
        }
    }
    Ok(())
}

/// Tells of layers beside groups.
fn leave_out(source: &Source<'_>, layers: &[&Layer], notes: &mut Vec<String>) {
    let beside: Vec<&str> = layers
        .iter()
        .filter(|layer| !layer.is_group())
        .map(|layer| layer.path.as_str())
        .collect();
    if !beside.is_empty() {
        notes.push(format!(
            "{}: {} {} in no group and {} left out",
            source.path.display(),
            beside.join(", "),
            if beside.len() == 1 { "is" } else { "are" },
            if beside.len() == 1 { "is" } else { "are" },
        ));
    }
}

fn part_layers(
    source: &Source<'_>,
    layers: &[&Layer],
    candidates: &mut Vec<Candidate>,
    notes: &mut Vec<String>,
) -> anyhow::Result<()> {
    let count = source.file.frame_count();
    let mut seen: Vec<Vec<u8>> = Vec::new();
    let (mut empty, mut repeated) = (0, 0);
    for frame in 0..count {
        let Some(whole) = picture(source, None, frame)? else {
            empty += 1;
            continue;
        };
        if seen.contains(&whole) {
            repeated += 1;
            continue;
        }
        let parts = parts_in(source, layers.iter().copied(), frame)?;
        if parts.is_empty() {
            empty += 1;
            continue;
        }
        candidates.push(Candidate {
            name: frame_name(source, frame),
            source: source.source.clone(),
            picture: if count > 1 {
                PictureChoice::Frame(frame)
            } else {
                PictureChoice::Only
            },
            whole: NewElement::Whole,
            parts,
        });
        if count > 1 {
            seen.push(whole);
        }
    }
    if count > 1 && empty + repeated > 0 {
        notes.push(format!(
            "{}: {} of {count} frames are poses; {empty} are empty, {repeated} repeat an earlier one",
            source.path.display(),
            count - empty - repeated,
        ));
    }
    Ok(())
}

/// What the pose of a frame is called: after the tag that it is in, with its number there, or after the file.
fn frame_name(source: &Source<'_>, frame: usize) -> String {
    let stem = source.path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let stem = stem.unwrap_or_default();
    let tags = source.file.tags().iter();
    let within = tags.filter(|tag| (tag.first..=tag.last).contains(&frame) && !tag.name.is_empty());
    match within.min_by_key(|tag| tag.last - tag.first) {
        Some(tag) if tag.first == tag.last => tag.name.clone(),
        Some(tag) => format!("{}-{}", tag.name, frame - tag.first + 1),
        None if source.file.frame_count() == 1 => stem,
        None => format!("{stem}-{}", frame + 1),
    }
}

fn pose_layers(source: &Source<'_>, layers: &[&Layer], candidates: &mut Vec<Candidate>) -> anyhow::Result<()> {
    for layer in layers {
        if picture(source, Some(&layer.path), 0)?.is_some() {
            candidates.push(Candidate {
                name: own_name(layer),
                source: source.source.clone(),
                picture: PictureChoice::Only,
                whole: NewElement::One(layer.path.clone()),
                parts: Vec::new(),
            });
        }
    }
    Ok(())
}
