//! A character drawn as curves: the elements of its drawings, carried by the mesh and blended.
//!
//! Set up:
//! 1. Elements with the same id in several drawings become one node, if their styles can change gradually (module `style`);
//!    every other element is a node of its own.
//! 2. Subpaths of a node's elements are put in correspondence (module `correspondence`), bound to the meshes of their poses and
//!    divided where a triangle's edge would break them (module `strand`).
//! 3. One order of drawing for each drawing that may decide it (module `order`).
//!
//! A frame:
//! 1. Where a node is in some drawings only, those share the weights of the others ([`restricted_weights`]); its opacity is the sum
//!    of the texture weights of the drawings that have it.
//! 2. Its points are carried from each drawing to the frame's mesh and averaged with the weights; styles too. A gradient follows
//!    the affine map that carries the element's points best (least squares).
//!
//! Drawings that share no id at all are cross-faded as a whole: each a group, the k-th with opacity
//! `t_k / (t_0 + .. + t_k)`, so that where all are opaque the result is their mean by the texture weights `t`; all together are
//! cut by the blended silhouette, so that the edge stays crisp, and each is drawn beyond its own edge (module `edge`), so that it is of one colour.
//!
//! Limits: a part that is not within the mesh is carried by the affine map of the triangle nearest to it. The widths of lines follow
//! the weights, not the mesh.
//!
//! Cost of a frame: O(#points x #drawings).

use std::collections::{BTreeMap, BTreeSet};

use super::super::{Camera, ColourBlend, Silhouette};
use super::binding::PoseMesh;
use super::correspondence::corresponding;
use super::edge::{DrawnOutline, Edge, widened};
use super::order::{merged, most_seen};
use super::placing::Fit;
use super::strand::{Carriers, Strand};
use super::style::Styles;
use super::{VectorGroup, VectorNode, VectorShape};
use crate::input::{Art, ArtElement, Placement};
use crate::math::{Point, restricted_weights};
use crate::pose::Mapping;
use crate::render::painter::weights_of_drawings;

/// A drawing as curves, and the pose on which it was drawn.
#[derive(Debug, Clone)]
pub struct PoseArt {
    /// The curves.
    pub art: Art,
    /// The pose of whose positions they are.
    pub drawn_on: usize,
}

/// A character's vector drawings on its mesh: built once, asked for frames from any number of threads.
///
/// All frames have the same nodes with the same ids and equally many curves; only numbers change, and the order of nodes where the
/// drawings contradict one another about it.
#[derive(Debug, Clone)]
pub struct CarriedDrawing {
    nodes: Vec<Node>,
    composition: Composition,
    /// The drawing that each pose shows.
    drawing_of: Vec<usize>,
    drawing_count: usize,
    camera: Camera,
    blending: ColourBlend,
}

/// How nodes make a frame.
#[derive(Debug, Clone)]
enum Composition {
    /// Side by side; #drawings orders of the nodes, by the drawing that decides.
    Merged(Vec<Vec<usize>>),
    /// A group a drawing.
    Faded(Vec<FadedDrawing>, Silhouette),
}

/// A drawing that is cross-faded with others.
#[derive(Debug, Clone)]
struct FadedDrawing {
    id: String,
    nodes: Vec<usize>,
    /// Which of them, by their place in the list, lie on its outline.
    edges: Vec<(usize, Edge)>,
    /// How far it may fall short of the silhouette.
    shortfall_px: f64,
}

/// An element of one or more drawings.
#[derive(Debug, Clone)]
struct Node {
    id: String,
    /// The drawings that have it.
    drawings: Vec<usize>,
    /// For every drawing, whether it has it.
    is_in: Vec<bool>,
    strands: Vec<Strand>,
    styles: Styles,
    /// One a drawing that has it, if something has a gradient.
    fits: Vec<Fit>,
}

impl CarriedDrawing {
    /// The drawings `art` on the mesh of `mapping`, seen by `camera`; with the elements that correspond and are cross-faded all the same.
    ///
    /// `drawing_of` says for each pose which of `art` it shows: poses that show the same one (deformed copies) need no drawing of
    /// their own. An art whose pose is not in the mapping is left out, and so is a pose whose drawing does not exist.
    #[must_use]
    pub fn new(
        mapping: &Mapping,
        art: Vec<PoseArt>,
        drawing_of: Vec<usize>,
        silhouette: Silhouette,
        camera: Camera,
    ) -> (Self, Vec<CrossFade>) {
        let poses = mapping.poses.positions();
        let triangles = mapping.poses.topology().triangles();
        let drawing_count = art.len();
        let empty = Art::default();
        // Numbers of drawings stay as given: an unknown one is empty.
        let (art, drawn_on): (Vec<&Art>, Vec<usize>) = art
            .iter()
            .map(|of| match poses.get(of.drawn_on) {
                Some(_) => (&of.art, of.drawn_on),
                None => (&empty, 0),
            })
            .unzip();
        let meshes: Vec<PoseMesh> = drawn_on
            .iter()
            .filter_map(|&pose| poses.get(pose))
            .map(|positions| PoseMesh::new(triangles, positions))
            .collect();
        let names: Vec<&str> = drawn_on
            .iter()
            .map(|&pose| mapping.poses.names()[pose].as_str())
            .collect();
        let mut notes = Vec::new();
        let (matched, sequences) = match_elements(&art, &names, &mut notes);
        let nodes: Vec<Node> = matched
            .into_iter()
            .map(|matched| {
                let carriers = Carriers {
                    meshes: matched.drawings.iter().map(|&drawing| &meshes[drawing]).collect(),
                    poses,
                    scale: camera.scale(),
                };
                Node::new(matched, &carriers, drawing_count)
            })
            .collect();
        let members =
            |drawing: usize| -> Vec<usize> { (0..nodes.len()).filter(|&k| nodes[k].is_in[drawing]).collect() };
        let is_shared = nodes.iter().any(|node| node.drawings.len() > 1);
        let filled = (0..drawing_count)
            .filter(|&drawing| !members(drawing).is_empty())
            .count();
        let composition = if filled > 1 && !is_shared {
            let faded = |drawing: usize| {
                let (pose, members) = (drawn_on[drawing], members(drawing));
                let outline = DrawnOutline::new(&mapping.outlines[pose], silhouette.ring_count(), &camera);
                let alone: Vec<f64> = (0..drawing_count).map(|d| f64::from(u8::from(d == drawing))).collect();
                let on_outline = |(place, &k): (usize, &usize)| {
                    let drawn = nodes[k].at(&poses[pose], &alone, 1.0, &camera, ColourBlend::Plain);
                    Some((place, outline.edge(&drawn)?))
                };
                FadedDrawing {
                    id: format!("drawing {}", names[drawing]),
                    edges: members.iter().enumerate().filter_map(on_outline).collect(),
                    shortfall_px: silhouette.shortfall(pose, poses) * camera.scale(),
                    nodes: members,
                }
            };
            Composition::Faded((0..drawing_count).map(faded).collect(), silhouette)
        } else {
            Composition::Merged(
                (0..drawing_count)
                    .map(|deciding| merged(nodes.len(), &sequences, deciding))
                    .collect(),
            )
        };
        let this = Self {
            nodes,
            composition,
            drawing_of,
            drawing_count,
            camera,
            blending: ColourBlend::Plain,
        };
        (this, notes)
    }

    /// The same with the colours of elements that morph averaged in this light; plain otherwise. What is cross-faded, and colours
    /// between a gradient's stops, are the business of whoever draws the frame.
    #[must_use]
    pub fn with_blending(mut self, blending: ColourBlend) -> Self {
        self.blending = blending;
        self
    }

    /// The nodes of the frame whose mesh lies at `positions`, whose poses count with `weights` and whose drawings are seen with
    /// `texture_weights` (both one a pose), from back to front, in pixels of the frame.
    #[must_use]
    pub fn frame(&self, positions: &[Point], weights: &[f64], texture_weights: &[f64]) -> Vec<VectorNode> {
        let by_drawing =
            |weights: &[f64]| weights_of_drawings(self.drawing_count, self.drawing_of.iter().copied(), weights);
        let (shape, seen) = (by_drawing(weights), by_drawing(texture_weights));
        let draw = |k: usize, opacity: f64| {
            let node = &self.nodes[k];
            node.at(positions, &shape, opacity, &self.camera, self.blending)
        };
        let shown = |shape: VectorShape| VectorNode::Shape(Box::new(shape));
        match &self.composition {
            Composition::Merged(orders) => {
                let order = orders.get(most_seen(&seen)).map(Vec::as_slice).unwrap_or_default();
                (order.iter())
                    .map(|&k| shown(draw(k, self.nodes[k].share(&seen))))
                    .collect()
            }
            Composition::Faded(drawings, silhouette) => {
                let rings: Vec<Vec<Point>> = silhouette
                    .at(positions, weights)
                    .into_iter()
                    .map(|ring| ring.into_iter().map(|p| self.camera.to_pixels(p)).collect())
                    .collect();
                let mut so_far = 0.0;
                let drawn = (drawings.iter().zip(&seen)).map(|(drawing, seen)| {
                    so_far += seen.max(0.0);
                    let nodes: Vec<VectorShape> = drawing.nodes.iter().map(|&k| draw(k, 1.0)).collect();
                    let edges = drawing.edges.iter();
                    let edges = edges.filter_map(|(place, edge)| widened(&nodes[*place], edge, drawing.shortfall_px));
                    let edges: Vec<VectorShape> = edges.collect();
                    VectorNode::Group(VectorGroup {
                        id: drawing.id.clone(),
                        opacity: if so_far > 0.0 { seen.max(0.0) / so_far } else { 0.0 },
                        clip: None,
                        nodes: edges.into_iter().chain(nodes).map(shown).collect(),
                    })
                });
                vec![VectorNode::Group(VectorGroup {
                    id: "drawings".to_owned(),
                    opacity: 1.0,
                    nodes: drawn.collect(),
                    clip: Some(rings),
                })]
            }
        }
    }
}

/// Elements that become one node.
struct Matched<'a> {
    id: String,
    drawings: Vec<usize>,
    elements: Vec<&'a ArtElement>,
    styles: Styles,
}

impl Node {
    fn new(matched: Matched, carriers: &Carriers, drawing_count: usize) -> Self {
        let Matched {
            id,
            drawings,
            elements,
            styles,
        } = matched;
        let strands = corresponding(&elements, carriers);
        let fits = match styles.has_gradient() {
            false => Vec::new(),
            true => (0..drawings.len())
                .map(|d| {
                    let own = carriers.meshes[d].positions();
                    Fit::new(strands.iter().flat_map(|strand| strand.points_of(d, own)).collect())
                })
                .collect(),
        };
        Self {
            id,
            is_in: (0..drawing_count).map(|drawing| drawings.contains(&drawing)).collect(),
            drawings,
            strands,
            styles,
            fits,
        }
    }

    /// How much of it is seen, by the texture weights of the drawings.
    fn share(&self, seen: &[f64]) -> f64 {
        if self.drawings.len() == seen.len() {
            return 1.0;
        }
        self.drawings
            .iter()
            .map(|&drawing| seen[drawing])
            .sum::<f64>()
            .clamp(0.0, 1.0)
    }

    fn at(
        &self,
        positions: &[Point],
        shape: &[f64],
        opacity: f64,
        camera: &Camera,
        blending: ColourBlend,
    ) -> VectorShape {
        let restricted = restricted_weights(shape, &self.is_in);
        let weights: Vec<f64> = self.drawings.iter().map(|&drawing| restricted[drawing]).collect();
        let subpaths: Vec<_> = self
            .strands
            .iter()
            .map(|strand| strand.at(positions, &weights, |p| camera.to_pixels(p)))
            .collect();
        let carried: Vec<Placement> = self.fits.iter().map(|fit| fit.to(&subpaths)).collect();
        let (fill, stroke, own) = self.styles.at(&weights, &carried, camera.scale(), blending);
        VectorShape {
            id: self.id.clone(),
            subpaths,
            fill,
            stroke,
            opacity: own * opacity,
        }
    }
}

/// Elements that correspond and are cross-faded, since what they are painted with cannot be blended.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct CrossFade {
    /// What they are called.
    pub element: String,
    /// Why it cannot be blended.
    pub reason: &'static str,
}

impl std::fmt::Display for CrossFade {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { element, reason } = self;
        write!(
            f,
            "the elements '{element}' are cross-faded, not morphed, because {reason}"
        )
    }
}

/// Which elements become one node, in the order in which they are first met, and the nodes of each drawing from back to front.
fn match_elements<'a>(
    art: &[&'a Art],
    names: &[&str],
    notes: &mut Vec<CrossFade>,
) -> (Vec<Matched<'a>>, Vec<Vec<usize>>) {
    let groups = groups_by_id(art);
    let mut taken = BTreeSet::new();
    let mut unique = |wanted: String| {
        let mut id = wanted.clone();
        let mut count = 1;
        while !taken.insert(id.clone()) {
            count += 1;
            id = format!("{wanted}~{count}");
        }
        id
    };
    let mut matched: Vec<Matched> = Vec::new();
    // Which node each element of each drawing is.
    let mut node_of: Vec<Vec<usize>> = art.iter().map(|art| vec![0; art.elements.len()]).collect();
    let mut nameless = vec![0; art.len()];
    for group in groups {
        let elements: Vec<&ArtElement> = group.iter().map(|&(drawing, k)| &art[drawing].elements[k]).collect();
        let first = group[0].0;
        let id = elements[0].id.clone().unwrap_or_else(|| {
            nameless[first] += 1;
            format!("{}-{}", names[first], nameless[first])
        });
        let styles = Styles::new(&elements);
        if let Err(reason) = &styles {
            notes.push(CrossFade {
                element: id.clone(),
                reason,
            });
        }
        let mut add = |id: String, members: &[(usize, usize)], elements: Vec<&'a ArtElement>, styles: Styles| {
            for &(drawing, k) in members {
                node_of[drawing][k] = matched.len();
            }
            matched.push(Matched {
                id: unique(id),
                drawings: members.iter().map(|(drawing, _)| *drawing).collect(),
                elements,
                styles,
            });
        };
        match styles {
            Ok(styles) => add(id, &group, elements, styles),
            Err(_) => {
                for (&member, element) in group.iter().zip(elements) {
                    // One element agrees with itself.
                    if let Ok(styles) = Styles::new(&[element]) {
                        add(format!("{id}@{}", names[member.0]), &[member], vec![element], styles);
                    }
                }
            }
        }
    }
    (matched, node_of)
}

/// The elements that have an id in common, and every other by itself: which of which drawing.
fn groups_by_id(art: &[&Art]) -> Vec<Vec<(usize, usize)>> {
    let mut of_id: BTreeMap<&str, usize> = BTreeMap::new();
    let mut groups: Vec<Vec<(usize, usize)>> = Vec::new();
    for (drawing, art) in art.iter().enumerate() {
        for (k, element) in art.elements.iter().enumerate() {
            let known = element.id.as_deref().and_then(|id| of_id.get(id)).copied();
            // An id that a drawing has twice counts once.
            match known.filter(|&group| groups[group].iter().all(|(other, _)| *other != drawing)) {
                Some(group) => groups[group].push((drawing, k)),
                None => {
                    if let (Some(id), None) = (&element.id, known) {
                        of_id.insert(id, groups.len());
                    }
                    groups.push(vec![(drawing, k)]);
                }
            }
        }
    }
    groups
}
