//! Pictures of a shape: the contact sheet of its space, and single forms.

use rayon::prelude::*;

use super::{ShapeForm, ShapeModel, ShapeModelError};
use crate::math::Point3;
use crate::render::Frame;
use crate::render::shaded::{CellKind, ShadedForm, ShadedMesh, Sheet, SheetAxis, SheetCell, View, Window, shade};
use crate::scene::{AxisSettings, ShapeScene};

/// Places closer than this are the same, as a share of the space between the examples: decimal fractions are rounded.
const SAME_PLACE: f64 = 1e-9;

impl ShapeModel {
    /// The contact sheet that the scene asks for, `size` columns and rows large if it is given.
    ///
    /// # Errors
    /// [`ShapeModelError`] if a form cannot be made, or the forms do not fit a picture.
    pub fn sheet(&self, scene: &ShapeScene, size: Option<[u32; 2]>) -> Result<Frame, ShapeModelError> {
        let settings = &scene.sheet;
        let rows = settings.up.map_or(1, |up| up.count);
        let mut places = Vec::new();
        for row in 0..rows {
            for column in 0..settings.across.count {
                let mut place = settings.fixed.clone();
                place[settings.across.adjective] = settings.across.value(column);
                if let Some(up) = &settings.up {
                    place[up.adjective] = up.value(row);
                }
                places.push(place);
            }
        }
        let forms = self.forms_at(&places)?;
        let textures = (places.iter())
            .map(|place| self.texture_at(place))
            .collect::<Result<Vec<_>, _>>()?;
        let extents = Extents::of(scene);
        let cells = places
            .iter()
            .zip(&forms)
            .zip(&textures)
            .map(|((place, form), texture)| {
                let (kind, caption) = extents.kind(scene, place);
                SheetCell {
                    form: shaded(form, texture.as_ref()),
                    kind,
                    caption,
                }
            });
        let axis = |axis: &AxisSettings| SheetAxis {
            name: scene.adjectives[axis.adjective].clone(),
            values: (0..axis.count).map(|k| axis.value(k)).collect(),
        };
        Sheet {
            title: &scene.short_name(),
            subtitle: &subtitle(scene),
            across: axis(&settings.across),
            up: settings.up.as_ref().map(axis),
            mesh: self.mesh(),
            cells: cells.collect(),
            view: view_of(scene),
            size,
        }
        .draw()
        .map_err(ShapeModelError::Sheet)
    }

    /// The box, as the scene looks at it, of the forms at some places; `None` if there is none.
    ///
    /// # Errors
    /// [`ShapeModelError`] if a form cannot be made.
    pub fn bounds(&self, scene: &ShapeScene, places: &[Vec<f64>]) -> Result<Option<[Point3; 2]>, ShapeModelError> {
        let view = view_of(scene);
        let of_one = |place: &Vec<f64>| Ok(view.bounds(&self.form_at(place)?.positions));
        let boxes: Vec<Option<[Point3; 2]>> = places.par_iter().map(of_one).collect::<Result<_, ShapeModelError>>()?;
        let both = |[a, b]: [Point3; 2], [c, d]: [Point3; 2]| [a.inf(&c), b.sup(&d)];
        Ok(boxes.into_iter().flatten().reduce(both))
    }

    /// A form by itself on a clear background, as large as `size` allows: it, or what it is one of, whose box is `bounds`.
    #[must_use]
    pub fn picture(
        &self,
        scene: &ShapeScene,
        form: &ShapeForm,
        texture: Option<&Frame>,
        size: [usize; 2],
        bounds: Option<[Point3; 2]>,
    ) -> Frame {
        let view = view_of(scene);
        let Some(bounds) = bounds.or_else(|| view.bounds(&form.positions)) else {
            return Frame::filled(size[0], size[1], [0; 4]);
        };
        let window = Window::around(bounds, size);
        let form = shaded(form, texture);
        shade(&self.mesh(), &form, &view, &window, &CellKind::Example.look())
    }

    fn mesh(&self) -> ShadedMesh<'_> {
        ShadedMesh {
            triangles: self.topology().triangles(),
            texture_places: self.topology().texture_coordinates(),
            texture_triangles: self.topology().texture_triangles(),
        }
    }
}

fn shaded<'a>(form: &'a ShapeForm, texture: Option<&'a Frame>) -> ShadedForm<'a> {
    ShadedForm {
        positions: &form.positions,
        normals: &form.normals,
        texture,
    }
}

fn view_of(scene: &ShapeScene) -> View {
    View::new(scene.sheet.yaw_degrees, scene.sheet.pitch_degrees)
}

/// What holds for all forms of the sheet.
fn subtitle(scene: &ShapeScene) -> String {
    let sheet = &scene.sheet;
    let on_axis = |k: usize| k == sheet.across.adjective || sheet.up.is_some_and(|up| k == up.adjective);
    let fixed: Vec<String> = (scene.adjectives.iter().enumerate())
        .filter(|(k, _)| !on_axis(*k))
        .map(|(k, name)| format!("{name} = {}", (1000.0 * sheet.fixed[k]).round() / 1000.0))
        .collect();
    if fixed.is_empty() {
        let count = scene.examples.len();
        return format!("{count} example{}", if count == 1 { "" } else { "s" });
    }
    fixed.join(", ")
}

/// From where to where the examples reach.
struct Extents(Vec<[f64; 2]>);

impl Extents {
    fn of(scene: &ShapeScene) -> Self {
        let values = |k: usize| scene.examples.iter().map(move |example| example.at[k]);
        let extent = |k: usize| {
            [
                values(k).fold(f64::INFINITY, f64::min),
                values(k).fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        Self((0..scene.dimension()).map(extent).collect())
    }

    /// What is at a place, and what it is called.
    fn kind<'a>(&self, scene: &'a ShapeScene, place: &[f64]) -> (CellKind, &'a str) {
        let slack = |k: usize| SAME_PLACE * (self.0[k][1] - self.0[k][0]).max(f64::MIN_POSITIVE);
        let same = |at: &[f64]| (0..at.len()).all(|k| (at[k] - place[k]).abs() <= slack(k));
        if let Some(example) = scene.examples.iter().find(|example| same(&example.at)) {
            return (CellKind::Example, &example.name);
        }
        let mut pseudo = scene.pseudo_examples.iter().filter(|pseudo| pseudo.of.is_geometry());
        if pseudo.any(|pseudo| same(&pseudo.at)) {
            return (CellKind::PseudoExample, "");
        }
        let within = (place.iter().zip(&self.0).enumerate())
            .all(|(k, (value, [low, high]))| *value >= low - slack(k) && *value <= high + slack(k));
        (if within { CellKind::Between } else { CellKind::Beyond }, "")
    }
}
