//! The drawings of a scene, read from their files.

use std::path::Path;
use std::sync::Arc;

use super::SceneBuildError;
use super::settings::{Holes, Scene};
use crate::input::{BitmapOptions, HoleRule, InputError, SvgOptions, bitmap_size, read_bitmap, read_svg, svg_page_px};
use crate::math::Point;
use crate::pipeline::{DrawnPose, SvgSource};

/// The drawing of one pose of a scene without layers, by its index: its own, or that of the pose that it is a copy of. `layer` is
/// what the scene is called where it is one of several.
///
/// # Errors
/// [`SceneBuildError`], naming pose and file, if it cannot be read.
pub(super) fn read_drawing(scene: &Scene, layer: Option<&str>, pose: usize) -> Result<DrawnPose, SceneBuildError> {
    let path = scene.source_path(pose)?;
    let Some((root, said)) = scene.drawing_of(pose) else {
        return Err(scene.without_drawing(pose).into());
    };
    let holes = match scene.input.holes {
        Holes::Match | Holes::Keep => HoleRule::Keep,
        Holes::Fill => HoleRule::Fill,
    };
    let read = || -> Result<DrawnPose, InputError> {
        let bytes = std::fs::read(&path).map_err(|source| InputError::Unreadable {
            path: path.clone(),
            source,
        })?;
        let mut drawn = if is_svg(&path) {
            let options = SvgOptions {
                element: said.element.clone(),
                pixels_per_unit: None,
                holes,
                extent: said.extent,
                parts: said.parts.clone(),
                around: None,
            };
            let drawing = read_svg(&bytes, &options)?;
            let mut drawn = DrawnPose::new(drawing);
            drawn.svg = Some(Arc::new(SvgSource {
                bytes: bytes.into(),
                options,
            }));
            drawn
        } else {
            let options = BitmapOptions {
                figure: said.reading.figure,
                gap: said.reading.gap,
                paper: said.reading.paper,
                threshold: said.reading.threshold,
                holes,
                parts: said.parts.clone(),
                picture: said.picture,
            };
            DrawnPose::new(read_bitmap(&bytes, &options)?)
        };
        drawn.facing = said.facing;
        Ok(drawn)
    };
    read().map_err(|source| SceneBuildError::Drawing {
        file: scene.file.clone(),
        line: said.line,
        layer: layer.map(str::to_owned),
        pose: scene.poses[root].name.clone(),
        drawing: said.file.clone(),
        source: Box::new(source),
    })
}

/// How large the page of a pose's drawing is, in pixels.
///
/// # Errors
/// As [`read_drawing`].
pub(super) fn canvas_px(scene: &Scene, pose: usize) -> Result<Point, SceneBuildError> {
    let path = scene.source_path(pose)?;
    let Some((root, said)) = scene.drawing_of(pose) else {
        return Err(scene.without_drawing(pose).into());
    };
    let read = || {
        let bytes = std::fs::read(&path).map_err(|source| InputError::Unreadable {
            path: path.clone(),
            source,
        })?;
        if is_svg(&path) {
            svg_page_px(&bytes)
        } else {
            bitmap_size(&bytes, said.picture)
        }
    };
    read().map_err(|source| SceneBuildError::Drawing {
        file: scene.file.clone(),
        line: said.line,
        layer: None,
        pose: scene.poses[root].name.clone(),
        drawing: said.file.clone(),
        source: Box::new(source),
    })
}

fn is_svg(path: &Path) -> bool {
    path.extension()
        .is_some_and(|suffix| suffix.eq_ignore_ascii_case("svg"))
}
