//! What a layer of a character is drawn with: textures of its drawings, or their curves.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::drawings::sharpen;
use super::layer::{LayerShape, Part, PosedLayer};
use super::note::{Note, NoteKind};
use super::spec::{ArtChoice, TextureSpec};
use crate::input::Drawing;
use crate::math::Point;
use crate::pose::TextureMesh;
use crate::render::drawing::{CarriedDrawing, PoseArt, VectorNode, VectorPicture};
use crate::render::puppet::{PuppetLayer, PuppetTexture};
use crate::render::{
    Camera, Frame, OverlapPainter, PaintOptions, Painter, PoseTexture, RegionPictures, Regions, Sampling, Texture,
};

/// The drawings of a layer, ready to be drawn on its mesh.
#[derive(Debug)]
pub(super) struct LayerArt {
    style: Style,
    /// The drawings, for whoever draws meshes himself.
    drawings: Vec<Arc<Drawing>>,
    /// The pose of each drawing.
    drawn_on: Vec<usize>,
    /// The drawing of each pose.
    drawing_of: Vec<usize>,
}

/// How the frames of a character see it.
#[derive(Clone, Copy)]
pub(super) struct View {
    pub(super) camera: Camera,
    /// Along a pixel's side.
    pub(super) samples: usize,
}

#[derive(Debug)]
enum Style {
    Pixels(Box<Painter>),
    /// Pixels of a figure that lies over itself.
    Overlapping(Box<OverlapPainter>),
    Curves(Box<CarriedDrawing>),
}

impl LayerArt {
    /// The art of one layer, of pixels on `mesh`; `notes` are added to.
    pub(super) fn new(
        part: &Part<'_>,
        shape: &LayerShape,
        texture: &TextureSpec,
        drawings: &[Arc<Drawing>],
        mesh: impl FnOnce() -> Option<Arc<TextureMesh>>,
        view: View,
        notes: &mut Vec<Note>,
    ) -> Result<Self, PipelineError> {
        let View { camera, samples } = view;
        let drawn_on = part.layer.drawn_poses();
        let drawing_of = part.layer.shown_drawings();
        let (mapping, silhouette) = (shape.mapping(), shape.silhouette.clone());
        let mut drawings = drawings.to_vec();
        let blending = texture.blending;
        let overlaps = !mapping.overlaps.is_empty();
        let style = match curves(texture.art, &drawings, &drawn_on).filter(|_| !overlaps) {
            Some(curves) => {
                let (carried, remarks) = CarriedDrawing::new(mapping, curves, drawing_of.clone(), silhouette, camera);
                let remark = |cross_fade| part.named(Note::on_all(NoteKind::CrossFaded(cross_fade)));
                notes.extend(remarks.into_iter().map(remark));
                Style::Curves(Box::new(carried.with_blending(blending)))
            }
            None => {
                let scale = camera.scale() * samples as f64;
                sharpen(part.layer, &mut drawings, scale).map_err(|error| part.refusal(error))?;
                let sampling = texture.sampling;
                let options = PaintOptions {
                    blending,
                    supersample: samples,
                    sampling,
                };
                let shown = drawing_of.clone();
                // Pixel art has no soft edges to be painted over one another.
                if overlaps && sampling == Sampling::Smooth {
                    let drawn: Vec<(&Drawing, usize)> = (drawings.iter().map(Arc::as_ref))
                        .zip(drawn_on.iter().copied())
                        .collect();
                    let painter = OverlapPainter::new(mapping, &drawn, &shown, silhouette, camera, options);
                    Style::Overlapping(Box::new(painter))
                } else {
                    let texture = |(drawing, &drawn_on): (&Arc<Drawing>, &usize)| PoseTexture {
                        texture: match sampling {
                            Sampling::Smooth => Texture::new(&drawing.picture, &drawing.outline, scale),
                            Sampling::Nearest => Texture::for_nearest(&drawing.picture, &drawing.outline),
                        },
                        drawn_on,
                    };
                    let textures = drawings.iter().zip(&drawn_on).map(texture).collect();
                    let painter = Painter::registered(mapping, mesh(), textures, shown, silhouette, camera, options);
                    Style::Pixels(Box::new(painter))
                }
            }
        };
        Ok(Self {
            style,
            drawings,
            drawn_on,
            drawing_of,
        })
    }

    /// Whether the layer is painted as pixels.
    pub(super) fn is_pixels(&self) -> bool {
        !matches!(self.style, Style::Curves(_))
    }

    /// The layer painted, if that is pixels.
    pub(super) fn paint(&self, posed: &PosedLayer) -> Option<Frame> {
        match &self.style {
            Style::Pixels(painter) => Some(painter.paint(&posed.positions, &posed.weights, &posed.texture_weights)),
            Style::Overlapping(painter) => {
                Some(painter.paint(&posed.positions, &posed.weights, &posed.texture_weights))
            }
            Style::Curves(_) => None,
        }
    }

    /// The layer in one frame, from back to front, in pixels of the frame.
    pub(super) fn draw(&self, posed: &PosedLayer) -> Vec<VectorNode> {
        match &self.style {
            Style::Curves(drawing) => drawing.frame(&posed.positions, &posed.weights, &posed.texture_weights),
            Style::Pixels(_) | Style::Overlapping(_) => (self.paint(posed).into_iter())
                .map(|frame| {
                    VectorNode::Picture(VectorPicture {
                        id: "picture".to_owned(),
                        frame,
                        opacity: 1.0,
                    })
                })
                .collect(),
        }
    }

    /// The layer as textured meshes: one, or of a figure that lies over itself one a region.
    pub(super) fn puppet(&self, shape: &LayerShape, camera: &Camera) -> Vec<PuppetLayer> {
        let (mapping, scale) = (shape.mapping(), camera.scale());
        let (names, positions) = (mapping.poses.names(), mapping.poses.positions());
        let Some(regions) = self.regions() else {
            let texture = |(drawing, &pose): (&Arc<Drawing>, &usize)| {
                PuppetTexture::new(
                    &names[pose],
                    &drawing.picture,
                    &drawing.outline,
                    &positions[pose],
                    scale,
                )
            };
            let textures = self.drawings.iter().zip(&self.drawn_on).map(texture).collect();
            return vec![PuppetLayer::new(
                shape.name(),
                mapping,
                textures,
                &self.drawing_of,
                camera,
            )];
        };
        let drawn: Vec<(&Drawing, usize)> = (self.drawings.iter().map(Arc::as_ref))
            .zip(self.drawn_on.iter().copied())
            .collect();
        let pictures = RegionPictures::new(mapping, regions, &drawn);
        let layer = |(region, name): (usize, &String)| {
            let mesh = regions.mesh(region);
            let texture = |(drawing, &pose): (usize, &usize)| {
                let places: Vec<Point> = mesh.vertices.iter().map(|v| positions[pose][*v]).collect();
                PuppetTexture::of_cut(&names[pose], &pictures.cut(region, drawing), &places, scale)
            };
            let textures = self.drawn_on.iter().enumerate().map(texture).collect();
            let name = format!("{}/{name}", shape.name());
            PuppetLayer::of_region(name, mapping, mesh, textures, &self.drawing_of, camera)
        };
        regions.names().par_iter().enumerate().map(layer).collect()
    }

    /// The drawing that each pose shows.
    #[cfg(feature = "export")]
    pub(super) fn shown_drawings(&self) -> &[usize] {
        &self.drawing_of
    }

    /// The regions that a figure that lies over itself is painted in.
    pub(super) fn regions(&self) -> Option<&Regions> {
        match &self.style {
            Style::Overlapping(painter) => Some(painter.regions()),
            Style::Pixels(_) | Style::Curves(_) => None,
        }
    }
}

/// The drawings as curves, if all are to be and can be drawn so.
fn curves(choice: ArtChoice, drawings: &[Arc<Drawing>], drawn_on: &[usize]) -> Option<Vec<PoseArt>> {
    if choice == ArtChoice::Pixels {
        return None;
    }
    let of = |(drawing, &drawn_on): (&Arc<Drawing>, &usize)| {
        let art = drawing.art.clone()?;
        Some(PoseArt { art, drawn_on })
    };
    drawings.iter().zip(drawn_on).map(of).collect()
}
