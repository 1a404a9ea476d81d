//! `inbetween shape render`.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use inbetween::animation::Background;
use inbetween::export::{
    Label, ObjForm, ObjTexture, PendingFile, Sequence, SequenceKind, png_bytes, shape_gltf_bytes, write_obj,
};
use inbetween::render::Frame;
use inbetween::scene::ShapeScene;
use inbetween::scene::{ShapeForm, ShapeModel};
use rayon::prelude::*;

use super::check_place;
use super::format::Format;
use crate::cli::progress::{Progress, ProgressKind};
use crate::cli::values::{FrameNumbers, Grid, Numbers, background, frame_rate, thread_count};
use crate::cli::{Failure, Verbosity};

/// How far vertices may be from where they belong unless the command line says, as a share of the forms' diagonal.
const MAX_ERROR: f64 = 0.0005;
/// Columns and rows of a picture of one form unless the command line says.
const PICTURE: [usize; 2] = [800, 800];
/// Frames a thread makes before they are written.
const FRAMES_A_THREAD: usize = 4;
/// What is behind pictures unless the command line says.
const PAPER: Background = Background::Colour([238, 235, 230, 255]);

/// Render the forms of a shape: its animation, its space, or one place
///
/// The kind of output is taken from OUT's name: a folder gets numbered OBJ files NAME.0001.obj of the animation; a name ending in .glb
/// one glTF file with the examples as morph targets and their weights (and joints) as the animation; .png the contact sheet of the
/// space, or with --at the picture of one form; .obj with --at one form. Textures go along: beside OBJ files as .mtl and .png.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween shape render arm/scene.toml -o arm.glb
  inbetween shape render arm/scene.toml -o forms --frames 1-10
  inbetween shape render arm/scene.toml -o sheet.png
  inbetween shape render arm/scene.toml --at 0.2,0.4,0,1 -o form.obj")]
pub(super) struct Arguments {
    /// The shape's scene file
    scene: PathBuf,
    /// A folder, or a file whose ending says what it is
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,
    /// The kind of output, where the name does not say: obj, glb, sheet (the contact sheet) or png (shaded pictures)
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// One place instead of the animation: one value an adjective, in the scene's order
    #[arg(long, value_name = "A,B,...", allow_hyphen_values = true, conflicts_with_all = ["frames", "fps"])]
    at: Option<Numbers>,
    /// The place of the textures, with --at; the same otherwise
    #[arg(long, value_name = "A,B,...", allow_hyphen_values = true, requires = "at")]
    texture_at: Option<Numbers>,
    /// Only these frames of the animation, counted from 1, such as 1-10,20
    #[arg(long, value_name = "LIST")]
    frames: Option<FrameNumbers>,
    /// Frames a second; the scene's otherwise
    #[arg(long, value_parser = frame_rate)]
    fps: Option<f64>,
    /// Columns and rows of pictures, such as 1920x1080; 800x800 otherwise, and whatever the contact sheet needs
    #[arg(long, value_name = "WxH")]
    size: Option<Grid>,
    /// What is behind pictures of forms: transparent, white, black, #rrggbb or #rrggbbaa; a light grey otherwise
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    background: Option<Background>,
    /// How many threads; as many as there are cores otherwise
    #[arg(long, value_name = "N", value_parser = thread_count)]
    threads: Option<usize>,
    /// How progress is told
    #[arg(long, value_name = "KIND", default_value = "auto")]
    progress: ProgressKind,
    /// How far vertices of a .glb may be from where they belong between keys, as a share of the forms' diagonal
    #[arg(long, value_name = "SHARE", value_parser = share, default_value_t = MAX_ERROR)]
    max_error: f64,
}

/// A share of the forms' diagonal.
fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err(format!(
            "'{text}' is no share from 0 to 1; 0 is exact, 0.0005 hardly seen"
        )),
    }
}

pub(super) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let mut scene = ShapeScene::open(&arguments.scene)?;
    if let Some(fps) = arguments.fps {
        scene.animation.fps = fps;
        scene.texture_animation.fps = fps;
    }
    let count = scene.animation.frame_count();
    let numbers = match &arguments.frames {
        Some(frames) => frames.within(count).map_err(Failure::Usage)?,
        None => (1..=count).collect(),
    };
    let is_one = arguments.at.is_some() || (arguments.frames.is_some() && numbers.len() == 1);
    let format = Format::of(&arguments.output, arguments.format.as_deref(), is_one).map_err(Failure::Usage)?;
    let job = Job {
        arguments,
        verbosity,
        moments: moments(arguments, &scene, &numbers)?,
        scene: &scene,
    };
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = arguments.threads {
        pool = pool.num_threads(threads);
    }
    let pool = pool.build().context("cannot start the threads")?;
    pool.install(|| match format {
        Format::Obj => job.obj(),
        Format::ObjSequence => job.obj_sequence(),
        Format::Glb => job.glb(),
        Format::Sheet => job.sheet(),
        Format::Picture => job.picture(),
        Format::PictureSequence => job.picture_sequence(),
    })?;
    Ok(())
}

/// A place of the shape that is wanted.
struct Moment {
    /// From 1.
    number: usize,
    at: Vec<f64>,
    texture_at: Vec<f64>,
}

/// What is wanted: one place, or frames of the animation.
fn moments(arguments: &Arguments, scene: &ShapeScene, numbers: &[usize]) -> anyhow::Result<Vec<Moment>> {
    let Some(Numbers(at)) = &arguments.at else {
        let moment = |&number: &usize| {
            let time = scene.animation.time_of_frame(number - 1);
            Moment {
                number,
                at: scene.animation.at(time),
                texture_at: scene.texture_animation.at(time),
            }
        };
        return Ok(numbers.iter().map(moment).collect());
    };
    check_place(at, scene, "--at")?;
    let texture_at = match &arguments.texture_at {
        Some(Numbers(place)) => {
            check_place(place, scene, "--texture-at")?;
            place
        }
        None => at,
    };
    Ok(vec![Moment {
        number: 1,
        at: at.clone(),
        texture_at: texture_at.clone(),
    }])
}

/// A scene, what is wanted of it, and where it goes.
struct Job<'a> {
    arguments: &'a Arguments,
    scene: &'a ShapeScene,
    moments: Vec<Moment>,
    verbosity: Verbosity,
}

impl Job<'_> {
    fn output(&self) -> &Path {
        &self.arguments.output
    }

    fn model(&self) -> anyhow::Result<ShapeModel> {
        let model = ShapeModel::open(self.scene).with_context(|| self.scene.file.display().to_string())?;
        self.verbosity.notes(model.notes());
        Ok(model)
    }

    fn progress(&self) -> Progress {
        Progress::new(self.moments.len(), self.arguments.progress, self.verbosity)
    }

    fn obj(&self) -> anyhow::Result<()> {
        let file = PendingFile::create(self.output())?;
        let model = self.model()?;
        // Opened to see that it can be; it is opened again with what belongs beside it.
        drop(file);
        let stem = self
            .output()
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned());
        let moment = &self.moments[0];
        self.write_form(&model, moment, self.output(), &stem.unwrap_or_default(), Material::Own)
    }

    fn obj_sequence(&self) -> anyhow::Result<()> {
        let name = self.scene.short_name();
        let sequence = Sequence::create(self.output(), &name, SequenceKind::Obj)?;
        let model = self.model()?;
        // One picture for all, unless it changes.
        let places = || self.moments.iter().map(|moment| &moment.texture_at);
        let is_shared = self.scene.is_textured() && places().all(|place| Some(place) == places().next());
        if let Some((moment, true)) = self.moments.first().map(|moment| (moment, is_shared)) {
            let png = texture_png(&model, moment)?.unwrap_or_default();
            let texture = ObjTexture { stem: &name, png: &png };
            PendingFile::commit_all(texture.pending(self.output())?)?;
        }
        let progress = self.progress();
        self.moments.par_iter().try_for_each(|moment| -> anyhow::Result<()> {
            let path = sequence.path(moment.number);
            let stem = format!("{name}.{:04}", moment.number);
            let material = if is_shared {
                Material::Shared(&name)
            } else {
                Material::Own
            };
            self.write_form(&model, moment, &path, &stem, material)?;
            progress.advance();
            Ok(())
        })?;
        progress.finish();
        Ok(())
    }

    fn write_form(
        &self,
        model: &ShapeModel,
        moment: &Moment,
        path: &Path,
        stem: &str,
        material: Material<'_>,
    ) -> anyhow::Result<()> {
        let form = model.form_at(&moment.at)?;
        let png = match material {
            Material::Own => texture_png(model, moment)?,
            Material::Shared(_) => None,
        };
        let topology = model.topology();
        let written = ObjForm {
            name: stem,
            positions: &form.positions,
            // Of a form that is as it was modelled any program makes its own.
            normals: if self.scene.subdivision.steps > 0 {
                &form.normals
            } else {
                &[]
            },
            faces: topology.faces(),
            texture_coordinates: topology.texture_coordinates(),
            material: match material {
                Material::Shared(stem) => Some(stem),
                Material::Own => png.as_ref().map(|_| stem),
            },
        };
        let texture = png.as_ref().map(|png| ObjTexture { stem, png });
        Ok(write_obj(path, &written, texture.as_ref())?)
    }

    fn glb(&self) -> anyhow::Result<()> {
        let file = PendingFile::create(self.output())?;
        let model = self.model()?;
        let animation = &self.scene.animation;
        let mut places: Vec<Vec<f64>> = self.moments.iter().map(|moment| moment.at.clone()).collect();
        let first = self.moments.first().map_or(1, |moment| moment.number);
        let mut times: Vec<f64> = (self.moments.iter())
            .map(|moment| (moment.number - first) as f64 / animation.fps)
            .collect();
        // A loop comes back to where it began, a frame's time after its last frame.
        if animation.is_loop() && places.len() == animation.frame_count() && places.len() > 1 {
            places.push(places[0].clone());
            times.push(times.len() as f64 / animation.fps);
        }
        let texture_places = || self.moments.iter().map(|moment| &moment.texture_at);
        let texture = match self.moments.first() {
            Some(moment) => texture_png(&model, moment)?,
            None => None,
        };
        if texture.is_some() && texture_places().any(|place| Some(place) != texture_places().next()) {
            self.verbosity.note(
                "note: glTF blends no pictures, so the file has the texture of the first frame; OBJ files and pictures have all",
            );
        }
        let take = model.take(self.scene, times, &places, texture)?;
        let motion = take.motion(self.arguments.max_error);
        let (bytes, report) = shape_gltf_bytes(&motion)?;
        file.fill(&bytes)?;
        self.verbosity.note(&format!(
            "{} keys for {} frames; vertices are at most {:.1e} of the forms' diagonal from where they belong",
            report.keys,
            places.len(),
            report.worst / take.diagonal().max(f64::MIN_POSITIVE)
        ));
        if motion.rig.is_some() && !model.notes().is_empty() {
            self.verbosity
                .note("note: what is blended after the joints, as noted above, is left out of glTF, whose skins cannot hold it");
        }
        Ok(())
    }

    fn sheet(&self) -> anyhow::Result<()> {
        let file = PendingFile::create(self.output())?;
        let model = self.model()?;
        let size = self.arguments.size.map(|grid| grid.0.map(|side| side as u32));
        let sheet = model.sheet(self.scene, size)?;
        Ok(file.fill(&self.png(&sheet)?)?)
    }

    fn picture(&self) -> anyhow::Result<()> {
        let file = PendingFile::create(self.output())?;
        let model = self.model()?;
        let moment = &self.moments[0];
        let form = model.form_at(&moment.at)?;
        let picture = self.drawn(&model, moment, &form, &[])?;
        Ok(file.fill(&self.png(&picture)?)?)
    }

    fn picture_sequence(&self) -> anyhow::Result<()> {
        let sequence = Sequence::create(self.output(), &self.scene.short_name(), SequenceKind::Png)?;
        let model = self.model()?;
        let places: Vec<Vec<f64>> = self.moments.iter().map(|moment| moment.at.clone()).collect();
        let bounds = model.bounds(self.scene, &places)?;
        let progress = self.progress();
        for batch in self.moments.chunks(FRAMES_A_THREAD * rayon::current_num_threads()) {
            batch.par_iter().try_for_each(|moment| -> anyhow::Result<()> {
                let form = model.form_at(&moment.at)?;
                let picture = self.drawn(&model, moment, &form, bounds.as_slice())?;
                sequence.write(moment.number, &picture, &Label::new(""))?;
                progress.advance();
                Ok(())
            })?;
        }
        progress.finish();
        Ok(())
    }

    fn drawn(
        &self,
        model: &ShapeModel,
        moment: &Moment,
        form: &ShapeForm,
        bounds: &[[inbetween::math::Point3; 2]],
    ) -> anyhow::Result<Frame> {
        let texture = model.texture_at(&moment.texture_at)?;
        let size = self.arguments.size.map_or(PICTURE, |grid| grid.0);
        let mut picture = model.picture(self.scene, form, texture.as_ref(), size, bounds.first().copied());
        if let Background::Colour(colour) = self.arguments.background.unwrap_or(PAPER) {
            picture.put_before(colour);
        }
        Ok(picture)
    }

    fn png(&self, frame: &Frame) -> anyhow::Result<Vec<u8>> {
        png_bytes(frame).map_err(|reason| anyhow::anyhow!("{}: {reason}", self.output().display()))
    }
}

/// Which material a form refers to.
#[derive(Clone, Copy)]
enum Material<'a> {
    /// One beside it, if it has a texture.
    Own,
    /// One that is there, by its stem.
    Shared(&'a str),
}

fn texture_png(model: &ShapeModel, moment: &Moment) -> anyhow::Result<Option<Vec<u8>>> {
    let Some(texture) = model.texture_at(&moment.texture_at)? else {
        return Ok(None);
    };
    png_bytes(&texture).map(Some).map_err(anyhow::Error::msg)
}
