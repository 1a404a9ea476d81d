//! The drawings of a scene, read from their files.

use std::path::Path;
use std::sync::Arc;

use super::SceneBuildError;
use super::settings::{DrawnSource, Holes, Scene};
use crate::input::{
    BitmapOptions, HoleRule, InputError, Picture, SvgOptions, bitmap_size, read_bitmap, read_chosen_picture, read_svg,
    read_svg_page, svg_page_px,
};
use crate::math::Point;
use crate::pipeline::{DrawnPose, SvgSource};

/// The drawing of one pose of a scene without layers, by its index: its own, or that of the pose that it is a copy of. `layer` is
/// what the scene is called where it is one of several.
///
/// # Errors
/// [`SceneBuildError`], naming pose and file, if it cannot be read.
pub(super) fn read_drawing(scene: &Scene, layer: Option<&str>, pose: usize) -> Result<DrawnPose, SceneBuildError> {
    let holes = match scene.input.holes {
        Holes::Match | Holes::Keep => HoleRule::Keep,
        Holes::Fill => HoleRule::Fill,
    };
    from_file(scene, layer, pose, |path, bytes, said| {
        let mut drawn = if is_svg(path) {
            let options = SvgOptions {
                element: said.element.clone(),
                pixels_per_unit: None,
                holes,
                extent: said.extent,
                parts: said.parts.clone(),
                around: None,
            };
            let mut drawn = DrawnPose::new(read_svg(bytes, &options)?);
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
                element: said.element.clone(),
            };
            DrawnPose::new(read_bitmap(bytes, &options)?)
        };
        drawn.facing = said.facing;
        Ok(drawn)
    })
}

/// How large the page of a pose's drawing is, in pixels.
///
/// # Errors
/// As [`read_drawing`].
pub(super) fn canvas_px(scene: &Scene, pose: usize) -> Result<Point, SceneBuildError> {
    from_file(scene, None, pose, |path, bytes, said| {
        if is_svg(path) {
            svg_page_px(bytes)
        } else {
            bitmap_size(bytes, said.picture)
        }
    })
}

/// All that is on the sheet of a pose's drawing; `layer` as in [`read_drawing`].
///
/// # Errors
/// As [`read_drawing`].
pub(super) fn read_sheet(scene: &Scene, layer: Option<&str>, pose: usize) -> Result<Picture, SceneBuildError> {
    from_file(scene, layer, pose, |path, bytes, said| {
        if is_svg(path) {
            read_svg_page(bytes)
        } else {
            read_chosen_picture(bytes, said.picture, said.element.as_deref())
        }
    })
}

/// What `read` makes of the bytes of a pose's drawing.
fn from_file<T>(
    scene: &Scene,
    layer: Option<&str>,
    pose: usize,
    read: impl FnOnce(&Path, &[u8], &DrawnSource) -> Result<T, InputError>,
) -> Result<T, SceneBuildError> {
    let path = scene.source_path(pose)?;
    let Some((root, said)) = scene.drawing_of(pose) else {
        return Err(scene.without_drawing(pose).into());
    };
    let bytes = std::fs::read(&path).map_err(|source| InputError::Unreadable {
        path: path.clone(),
        source,
    });
    let made = bytes.and_then(|bytes| read(&path, &bytes, said));
    made.map_err(|source| SceneBuildError::Drawing {
        file: scene.file.clone(),
        line: said.line,
        layer: layer.map(str::to_owned),
        pose: scene.poses[root].name.clone(),
        drawing: said.file.clone(),
        source: Box::new(source),
    })
}

fn is_svg(path: &Path) -> bool {
    path.extension()
        .is_some_and(|suffix| suffix.eq_ignore_ascii_case("svg"))
}
