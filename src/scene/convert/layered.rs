//! Layers: which poses have them, from which drawings, what they hang on, in which order they are drawn.

use toml::{Spanned, Value};

use super::{Checked, Reader};
use crate::input::{Extent, PlaceRule};
use crate::pipeline::DeformedCopy;
use crate::scene::error::SceneProblem;
use crate::scene::file::{LayerTable, PoseTable, SceneFile};
use crate::scene::layers::{LayerAnchor, SceneLayer};
use crate::scene::settings::{DeformedSource, DrawnSource, PoseSource, Scene};

impl Reader<'_> {
    /// The layers' names, in drawing order from back to front; none in a scene without.
    pub(super) fn layer_names(&self, tables: &[Spanned<LayerTable>]) -> Checked<Vec<String>> {
        let mut names: Vec<String> = Vec::new();
        for table in tables {
            let written = &table.get_ref().name;
            let name = written.get_ref().clone();
            if name.is_empty() || names.contains(&name) {
                return Err(self.fail(written.span().start, SceneProblem::BadName { kind: "layer", name }));
            }
            names.push(name);
        }
        Ok(names)
    }

    /// Refuses words about layers in a scene that has none.
    pub(super) fn check_layer_words(&self, written: &SceneFile, layers: &[String]) -> Checked<()> {
        if !layers.is_empty() {
            return Ok(());
        }
        for pose in written.pose.iter().map(Spanned::get_ref) {
            for handle in pose.handles.as_ref().map(Spanned::get_ref).into_iter().flatten() {
                if let Some(name) = &handle.layer {
                    self.layer_index(name, &format!("a handle of pose '{}'", pose.name.get_ref()), layers)?;
                }
            }
        }
        Ok(())
    }

    /// The layer that a key names.
    pub(super) fn layer_index(&self, name: &Spanned<String>, used_by: &str, layers: &[String]) -> Checked<usize> {
        let found = layers.iter().position(|layer| layer == name.get_ref());
        found.ok_or_else(|| self.unknown_layer(name.span().start, name.get_ref(), used_by, layers))
    }

    fn unknown_layer(&self, at: usize, name: &str, used_by: &str, layers: &[String]) -> crate::scene::SceneError {
        let known = if layers.is_empty() {
            "the scene has no [[layer]]".to_owned()
        } else {
            let quoted: Vec<String> = layers.iter().map(|layer| format!("'{layer}'")).collect();
            format!("the layers are {}", quoted.join(", "))
        };
        self.fail(
            at,
            SceneProblem::Format(format!(
                "{used_by} names layer '{name}', but {known}; correct the name or remove it"
            )),
        )
    }

    /// The layers of `scene`, which has everything else.
    pub(super) fn layers(&self, written: &SceneFile, scene: &Scene, names: &[String]) -> Checked<Vec<SceneLayer>> {
        let mut layers: Vec<SceneLayer> = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let mut poses = Vec::new();
            let mut sources = Vec::new();
            for (pose, table) in written.pose.iter().enumerate() {
                if let Some(source) = self.source_in(written, table.get_ref(), scene, name, names)? {
                    poses.push(pose);
                    sources.push(source);
                }
            }
            if poses.is_empty() {
                return Err(self.fail(
                    written.layer[index].span().start,
                    SceneProblem::Format(format!(
                        "no pose has layer '{name}'; give one `source = {{ {name} = \"FILE\" }}`, or remove the layer"
                    )),
                ));
            }
            let mut whole = scene.with_landmarks_of(index);
            for (pose, source) in poses.iter().zip(sources) {
                whole.poses[*pose].source = source;
            }
            layers.push(SceneLayer {
                name: name.clone(),
                scene: whole.with_poses(&poses),
                poses,
                anchor: None,
            });
        }
        for pose in 0..scene.poses.len() {
            if !layers.iter().any(|layer| layer.poses.contains(&pose)) {
                let name = &written.pose[pose].get_ref().name;
                return Err(self.fail(
                    name.span().start,
                    SceneProblem::Format(format!(
                        "pose '{}' has no layer; give it a source for one",
                        name.get_ref()
                    )),
                ));
            }
        }
        for (index, table) in written.layer.iter().enumerate() {
            layers[index].anchor = self.layer_anchor(table.get_ref(), index, names, &layers)?;
        }
        self.check_anchors(written, &layers)?;
        Ok(layers)
    }

    /// Where a pose's drawing of layer `layer` comes from; `None` if it lacks the layer.
    fn source_in(
        &self,
        file: &SceneFile,
        written: &PoseTable,
        scene: &Scene,
        layer: &str,
        layers: &[String],
    ) -> Checked<Option<PoseSource>> {
        let name = written.name.get_ref();
        if let Some(of) = &written.deform_of {
            let names: Vec<String> = scene.names();
            let copy = self.deformed(written, of, &names)?;
            // Whether the original has the layer: copies of copies are no longer than there are poses.
            let mut original = copy.copy.of;
            for _ in 0..names.len() {
                let Some(next) = &file.pose[original].get_ref().deform_of else {
                    break;
                };
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                original = self.pose_index(next, "`deform_of`", &names)?;
            }
            let root = file.pose[original].get_ref();
            if root.deform_of.is_some() || self.source_in(file, root, scene, layer, layers)?.is_none() {
                return Ok(None);
            }
            return Ok(Some(PoseSource::Deformed(
                self.handles_of(written, copy, layer, layers)?,
            )));
        }
        let Some(source) = &written.source else {
            return Err(self.fail(
                written.name.span().start,
                SceneProblem::Format(format!(
                    "pose '{name}' has no source; add `source = {{ {layer} = \"FILE\" }}`, or one SVG file and an `element` a layer"
                )),
            ));
        };
        let key = format!("pose '{name}': source");
        let path = self.word_in(source, &key, layer, layers)?;
        let element = match &written.element {
            Some(element) => self.word_in(element, &format!("pose '{name}': element"), layer, layers)?,
            None => None,
        };
        let path = match (path, &element, source.get_ref()) {
            // One file for all layers: those with an element are there.
            (Some(_), None, Value::String(_)) => {
                if written.element.is_some() {
                    return Ok(None);
                }
                return Err(self.fail(
                    source.span().start,
                    SceneProblem::Format(format!(
                        "pose '{name}' has one drawing for all layers; say which part is which, `element = {{ {layer} = \"ID\" }}`, or \
                         give a drawing a layer, `source = {{ {layer} = \"FILE\" }}`"
                    )),
                ));
            }
            (Some(path), _, _) => path,
            (None, _, _) => return Ok(None),
        };
        Ok(Some(PoseSource::Drawn(DrawnSource {
            file: self.inside_folder(path, name, source.span().start)?,
            line: self.line(source.span().start),
            extent: if element.is_some() {
                Extent::Element
            } else {
                Extent::Everything
            },
            element,
            reading: self.reading_of(written, &scene.input.reading)?,
            parts: self.parts_of(written, scene.input.parts, PlaceRule::SeveralDrawings)?,
            picture: self.picture_of(written, &scene.input)?,
            facing: self.facing_of(written)?,
        })))
    }

    /// The handles of a copy that are meant for one layer.
    fn handles_of(
        &self,
        written: &PoseTable,
        copy: DeformedSource,
        layer: &str,
        layers: &[String],
    ) -> Checked<DeformedSource> {
        let tables = written.handles.as_ref().map(Spanned::get_ref).into_iter().flatten();
        let mut handles = Vec::new();
        for (table, handle) in tables.zip(&copy.copy.handles) {
            let Some(of) = &table.layer else {
                return Err(self.fail(
                    written.handles.as_ref().map_or(0, |list| list.span().start),
                    SceneProblem::Format(format!(
                        "a handle of pose '{}' names no layer; add `layer = \"{layer}\"`",
                        written.name.get_ref()
                    )),
                ));
            };
            self.layer_index(of, &format!("a handle of pose '{}'", written.name.get_ref()), layers)?;
            if of.get_ref() == layer {
                handles.push(*handle);
            }
        }
        Ok(DeformedSource {
            line: copy.line,
            copy: DeformedCopy {
                of: copy.copy.of,
                handles,
            },
        })
    }

    /// The string that `value` has for a layer: the same for all, or one a layer in a table.
    fn word_in(&self, value: &Spanned<Value>, key: &str, layer: &str, layers: &[String]) -> Checked<Option<String>> {
        let at = value.span().start;
        match value.get_ref() {
            Value::String(word) => Ok(Some(word.clone())),
            Value::Table(table) => {
                if let Some(unknown) = table.keys().find(|name| !layers.contains(name)) {
                    return Err(self.unknown_layer(at, unknown, key, layers));
                }
                match table.get(layer) {
                    None => Ok(None),
                    Some(Value::String(word)) => Ok(Some(word.clone())),
                    Some(other) => Err(self.fail(
                        at,
                        SceneProblem::Format(format!(
                            "{key} of layer '{layer}' is {other}, but must be a string in quotes"
                        )),
                    )),
                }
            }
            other => Err(self.fail(
                at,
                SceneProblem::Format(format!(
                    "{key} is {other}, but must be a string, or a table with one a layer"
                )),
            )),
        }
    }

    fn layer_anchor(
        &self,
        table: &LayerTable,
        index: usize,
        names: &[String],
        layers: &[SceneLayer],
    ) -> Checked<Option<LayerAnchor>> {
        let Some(written) = &table.anchor else { return Ok(None) };
        let used_by = format!("`anchor` of layer '{}'", names[index]);
        let anchor = written.get_ref();
        let to = self.layer_index(&anchor.layer, &used_by, names)?;
        let own = &layers[index];
        let place = anchor.at.span().start;
        let fail = |problem: String| self.fail(place, SceneProblem::Format(problem));
        let landmark = anchor.at.get_ref();
        let Some(found) = own.scene.landmarks.iter().find(|l| &l.name == landmark) else {
            return Err(fail(format!(
                "{used_by} names landmark '{landmark}', but layer '{}' has no such [[landmark]]; add one with `layer = \"{}\"`",
                names[index], names[index]
            )));
        };
        for (k, &pose) in own.poses.iter().enumerate() {
            let name = &own.scene.poses[k].name;
            if !layers[to].poses.contains(&pose) {
                return Err(fail(format!(
                    "layer '{}' hangs on layer '{}', which pose '{name}' lacks; draw it there, or anchor to another layer",
                    names[index], names[to]
                )));
            }
            if found.at[k].is_none() && matches!(own.scene.poses[k].source, PoseSource::Drawn(_)) {
                return Err(fail(format!(
                    "{used_by} needs landmark '{landmark}' on pose '{name}'; add its place there"
                )));
            }
        }
        Ok(Some(LayerAnchor {
            to,
            landmark: landmark.clone(),
            at: found.at.clone(),
        }))
    }

    /// Refuses layers that hang on one another.
    fn check_anchors(&self, written: &SceneFile, layers: &[SceneLayer]) -> Checked<()> {
        for (index, table) in written.layer.iter().enumerate() {
            let mut at = index;
            for _ in 0..=layers.len() {
                match &layers[at].anchor {
                    Some(anchor) => at = anchor.to,
                    None => break,
                }
            }
            if layers[at].anchor.is_some() {
                return Err(self.fail(
                    table.span().start,
                    SceneProblem::Format(format!(
                        "layer '{}' hangs on itself, by way of `anchor`; leave one of the layers without",
                        layers[index].name
                    )),
                ));
            }
        }
        Ok(())
    }

    /// The drawing order of all layers in each pose, from back to front.
    ///
    /// A pose's own list permutes the layers that it has among their places in the scene's order; layers that it lacks stay
    /// where they are.
    pub(super) fn draw_orders(
        &self,
        written: &SceneFile,
        layers: &[SceneLayer],
        names: &[String],
    ) -> Checked<Vec<Vec<usize>>> {
        let mut orders = Vec::new();
        for (pose, table) in written.pose.iter().enumerate() {
            let mut order: Vec<usize> = (0..layers.len()).collect();
            if let Some(listed) = &table.get_ref().order {
                let here: Vec<usize> = (0..layers.len())
                    .filter(|&layer| layers[layer].poses.contains(&pose))
                    .collect();
                let used_by = format!("`order` of pose '{}'", table.get_ref().name.get_ref());
                let mut own = Vec::new();
                for name in listed.get_ref() {
                    own.push(self.layer_index(name, &used_by, names)?);
                }
                let mut sorted = own.clone();
                sorted.sort_unstable();
                if sorted != here {
                    let expected: Vec<String> = here.iter().map(|&layer| format!("\"{}\"", names[layer])).collect();
                    return Err(self.fail(
                        listed.span().start,
                        SceneProblem::Format(format!(
                            "{used_by} must name each layer of the pose once, from back to front: {}",
                            expected.join(", ")
                        )),
                    ));
                }
                for (place, layer) in here.iter().zip(own) {
                    order[*place] = layer;
                }
            }
            orders.push(order);
        }
        Ok(orders)
    }
}
