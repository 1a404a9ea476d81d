//! Layers and groups as they lie in one another, whatever the format.

use std::collections::{BTreeMap, BTreeSet};

use super::LayeredError;
use super::note::LayerNote;

/// The most layers and groups that are read of a file.
pub(super) const MOST_LAYERS: usize = 10_000;
/// The most bytes of all paths together: a long name of a group is in the paths of all that is in it.
const MOST_PATH_BYTES: usize = 16 << 20;
/// The most groups that lie in one another: composing follows them.
pub(super) const MOST_NESTED: usize = 64;

/// How a layer's colours meet what lies behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum BlendMode {
    /// They cover it.
    #[default]
    Normal,
    /// They are multiplied with it.
    Multiply,
}

/// What a layer is cut off by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Clipping {
    /// By nothing.
    #[default]
    None,
    /// By the next layer or group behind it that is not clipped itself, together with which it is drawn (clipping masks of PSD files).
    Base,
    /// By all that is behind it in its group (Krita's inherited alpha, `svg:src-atop` of OpenRaster), and in one that is not isolated by what is behind the group, too.
    Behind,
}

/// What a layer or group is.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum LayerContent {
    /// Pixels, by the number of the layer in its file; `None` for one without, such as an adjustment.
    Pixels(Option<usize>),
    /// Others, from back to front.
    Group {
        /// What is in it.
        children: Vec<Layer>,
        /// Whether they are first composed by themselves. Those of a group that is not isolated lie directly on what is behind the group.
        is_isolated: bool,
    },
}

/// A layer or group of a layered file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Layer {
    /// Its name, as it stands in the file.
    pub name: String,
    /// The names of the groups that it is in and its own, with `/` between them, as `element` of a pose names it. No two of a file are equal: where
    /// siblings have one name, the second from the back has `#2` after it, and so on.
    pub path: String,
    /// Where its own name begins in its path.
    name_start: usize,
    /// Whether its eye is open; the groups that it is in may be hidden.
    pub is_visible: bool,
    /// From 0 to 1.
    pub opacity: f64,
    /// How its colours meet what is behind it.
    pub blend: BlendMode,
    /// What it is cut off by.
    pub clipping: Clipping,
    /// Whether a mask cuts it off, by the number of the mask in its file.
    pub mask: Option<usize>,
    /// What is in it.
    pub content: LayerContent,
    /// What of it is not kept.
    pub notes: Vec<LayerNote>,
}

impl Layer {
    /// A layer that is visible, opaque and without pixels.
    pub(super) fn new(name: String) -> Self {
        Self {
            name,
            path: String::new(),
            name_start: 0,
            is_visible: true,
            opacity: 1.0,
            blend: BlendMode::Normal,
            clipping: Clipping::None,
            mask: None,
            content: LayerContent::Pixels(None),
            notes: Vec::new(),
        }
    }

    /// What is in it, from back to front; nothing in a layer of pixels.
    #[must_use]
    pub fn children(&self) -> &[Self] {
        match &self.content {
            LayerContent::Group { children, .. } => children,
            LayerContent::Pixels(_) => &[],
        }
    }

    /// Its name as its path has it: no two siblings have the same.
    #[must_use]
    pub fn name_among_siblings(&self) -> &str {
        &self.path[self.name_start..]
    }

    /// Whether it is a group.
    #[must_use]
    pub fn is_group(&self) -> bool {
        matches!(self.content, LayerContent::Group { .. })
    }
}

/// Gives every layer its path.
///
/// # Errors
/// If they are too long together.
fn name_paths(layers: &mut [Layer]) -> Result<(), LayeredError> {
    name_in(layers, "", &mut BTreeSet::new(), &mut 0)
}

fn name_in(
    layers: &mut [Layer],
    group: &str,
    taken: &mut BTreeSet<String>,
    length: &mut usize,
) -> Result<(), LayeredError> {
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    for layer in layers {
        *length += group.len() + layer.name.len();
        if *length > MOST_PATH_BYTES {
            return Err(LayeredError::TooMany {
                what: "letters in the names of its layers",
                found: *length,
                most: MOST_PATH_BYTES,
            });
        }
        let own = if group.is_empty() {
            layer.name.clone()
        } else {
            format!("{group}/{}", layer.name)
        };
        let times = times.entry(own.clone()).or_default();
        *times += 1;
        let mut path = if *times == 1 {
            own.clone()
        } else {
            format!("{own}#{times}")
        };
        // A name may itself look like a path, or like the second of its kind.
        while !taken.insert(path.clone()) {
            *times += 1;
            path = format!("{own}#{times}");
        }
        layer.name_start = if group.is_empty() { 0 } else { group.len() + 1 };
        layer.path = path;
        if let LayerContent::Group { children, .. } = &mut layer.content {
            name_in(children, &layer.path, taken, length)?;
        }
    }
    Ok(())
}

/// The way to the layer of this path: the places among their siblings of the groups that it is in, from the outermost, and its own.
pub(super) fn find_path(layers: &[Layer], path: &str) -> Option<Vec<usize>> {
    for (place, layer) in layers.iter().enumerate() {
        if layer.path == path {
            return Some(vec![place]);
        }
        if let Some(mut further) = find_path(layer.children(), path) {
            further.insert(0, place);
            return Some(further);
        }
    }
    None
}

/// All paths, each group before what is in it.
pub(super) fn all_paths(layers: &[Layer]) -> Vec<String> {
    let mut paths = Vec::new();
    for layer in layers {
        paths.push(layer.path.clone());
        paths.extend(all_paths(layer.children()));
    }
    paths
}

/// Groups being filled while a file lists what is in them.
#[derive(Debug, Default)]
pub(super) struct TreeBuilder {
    /// What is in the outermost groups that are finished, then the groups that are open.
    open: Vec<Vec<Layer>>,
    roots: Vec<Layer>,
    count: usize,
}

impl TreeBuilder {
    /// Begins a group, whose own entry comes when it is closed.
    ///
    /// # Errors
    /// If it lies too deep.
    pub(super) fn begin(&mut self) -> Result<(), LayeredError> {
        if self.open.len() == MOST_NESTED {
            return Err(LayeredError::TooMany {
                what: "groups in one another",
                found: MOST_NESTED + 1,
                most: MOST_NESTED,
            });
        }
        self.open.push(Vec::new());
        Ok(())
    }

    /// What is in the group that was begun last; nothing if none is open.
    pub(super) fn end(&mut self) -> Vec<Layer> {
        self.open.pop().unwrap_or_default()
    }

    /// One more, behind which all others of its group lie so far.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn push(&mut self, layer: Layer) -> Result<(), LayeredError> {
        self.count += 1;
        if self.count > MOST_LAYERS {
            return Err(LayeredError::TooMany {
                what: "layers",
                found: self.count,
                most: MOST_LAYERS,
            });
        }
        self.open.last_mut().unwrap_or(&mut self.roots).push(layer);
        Ok(())
    }

    /// All layers. What is in groups that were never closed lies where these began.
    ///
    /// # Errors
    /// If their names are too long together.
    pub(super) fn finish(mut self) -> Result<Vec<Layer>, LayeredError> {
        while !self.open.is_empty() {
            let children = self.end();
            self.open.last_mut().unwrap_or(&mut self.roots).extend(children);
        }
        name_paths(&mut self.roots)?;
        Ok(self.roots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_unique_and_found() -> Result<(), LayeredError> {
        let mut tree = TreeBuilder::default();
        tree.push(Layer::new("hat".to_owned()))?;
        tree.begin()?;
        tree.push(Layer::new("arm".to_owned()))?;
        tree.push(Layer::new("arm".to_owned()))?;
        let children = tree.end();
        let mut group = Layer::new("run".to_owned());
        group.content = LayerContent::Group {
            children,
            is_isolated: false,
        };
        tree.push(group)?;
        tree.push(Layer::new("hat".to_owned()))?;
        let layers = tree.finish()?;
        assert_eq!(all_paths(&layers), ["hat", "run", "run/arm", "run/arm#2", "hat#2"]);
        assert_eq!(find_path(&layers, "run/arm#2"), Some(vec![1, 1]));
        assert_eq!(find_path(&layers, "arm"), None);
        Ok(())
    }

    #[test]
    fn groups_that_are_not_closed_or_not_begun_are_taken_apart() -> Result<(), LayeredError> {
        let mut tree = TreeBuilder::default();
        assert!(tree.end().is_empty());
        tree.begin()?;
        tree.push(Layer::new("arm".to_owned()))?;
        assert_eq!(all_paths(&tree.finish()?), ["arm"]);
        let mut deep = TreeBuilder::default();
        assert!((0..=MOST_NESTED).any(|_| deep.begin().is_err()));
        Ok(())
    }

    #[test]
    fn long_names_of_groups_do_not_multiply() -> Result<(), LayeredError> {
        let mut tree = TreeBuilder::default();
        tree.begin()?;
        for _ in 0..1000 {
            tree.push(Layer::new("arm".to_owned()))?;
        }
        let mut group = Layer::new("x".repeat(1 << 16));
        group.content = LayerContent::Group {
            children: tree.end(),
            is_isolated: false,
        };
        tree.push(group)?;
        assert!(matches!(tree.finish(), Err(LayeredError::TooMany { .. })));
        Ok(())
    }
}
