//! What is computed of a scene: as much as can be.

use std::sync::{Arc, OnceLock};

use inbetween::blend::Stretch;
use inbetween::pipeline::{Character, EditableWeights};
use inbetween::scene::{DrawingFiles, Provider, Scene, Workbench};
use inbetween::texture::shared_texture_weights;
use inbetween::weights::WeightProvider;

use super::problem::{Problem, Refusal};

/// Numbers that change with what is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub(crate) struct Revisions {
    pub(crate) scene: u64,
    pub(crate) weights: u64,
    pub(crate) shape: u64,
    pub(crate) pictures: u64,
}

/// What is shown: it never changes, a newer one takes its place.
#[derive(Debug, Default)]
pub(crate) struct Shown {
    /// The newest scene that could be read, laid out if there is a mesh.
    pub(crate) scene: Option<Arc<Scene>>,
    /// The newest that could be mapped.
    pub(crate) bench: Option<Arc<Workbench>>,
    /// What is wrong with the newest.
    pub(crate) problems: Vec<Problem>,
    pub(crate) revisions: Revisions,
    /// Weights that are asked for by name: biharmonic, radial.
    providers: [OnceLock<Result<Arc<dyn WeightProvider>, Problem>>; 2],
    /// The same with stretches blended in another way: linear, limited, logarithmic.
    stretched: [OnceLock<Result<Arc<Workbench>, Problem>>; 3],
    /// With its art, for frames as they are rendered.
    character: Arc<OnceLock<Result<Arc<Character>, Problem>>>,
}

impl Shown {
    /// `before` is what it takes the place of.
    pub(crate) fn new(
        scene: Option<Arc<Scene>>,
        bench: Option<Arc<Workbench>>,
        problems: Vec<Problem>,
        revisions: Revisions,
        before: &Self,
    ) -> Self {
        let draws_alike = match (&bench, &before.bench) {
            (Some(bench), Some(old)) => bench.draws_like(old),
            _ => false,
        };
        Self {
            character: if draws_alike {
                Arc::clone(&before.character)
            } else {
                Arc::default()
            },
            scene,
            bench,
            problems,
            revisions,
            providers: Default::default(),
            stretched: Default::default(),
        }
    }

    /// The mesh and all that belongs to it.
    pub(crate) fn bench(&self) -> Result<&Arc<Workbench>, Refusal> {
        self.bench.as_ref().ok_or_else(|| {
            Refusal::conflict(match self.problems.first() {
                Some(problem) => problem.clone(),
                None => Problem::new("the drawings are still being mapped; ask again when the state says so"),
            })
        })
    }

    /// The same with another way to blend stretches.
    pub(crate) fn stretched(&self, stretch: Option<Stretch>) -> Result<Arc<Workbench>, Refusal> {
        let bench = self.bench()?;
        let Some(stretch) = stretch.filter(|stretch| *stretch != bench.scene().blend.stretch) else {
            return Ok(Arc::clone(bench));
        };
        let own = &self.stretched[match stretch {
            Stretch::Linear => 0,
            Stretch::Limited => 1,
            Stretch::Log => 2,
        }];
        let make = || {
            let mut scene = bench.scene().clone();
            scene.blend.stretch = stretch;
            for layer in &mut scene.layers {
                layer.scene.blend.stretch = stretch;
            }
            let made = bench.edited(&scene, DrawingFiles::Unchanged).map(Arc::new);
            made.map_err(|error| Problem::from(&error))
        };
        own.get_or_init(make).clone().map_err(Refusal::conflict)
    }

    /// The character, with its art.
    pub(crate) fn character(&self) -> Result<Arc<Character>, Refusal> {
        let bench = self.bench()?;
        let make = || {
            let made = bench.character().map(Arc::new);
            made.map_err(|error| Problem::from(&error))
        };
        self.character.get_or_init(make).clone().map_err(Refusal::conflict)
    }

    /// The scene that frames are made of.
    pub(crate) fn framed_scene(&self) -> Result<&Scene, Refusal> {
        match (&self.bench, &self.scene) {
            (Some(bench), _) => Ok(bench.scene()),
            (None, Some(scene)) => Ok(scene),
            (None, None) => Err(Refusal::conflict(self.problems.first().cloned().unwrap_or_default())),
        }
    }

    /// The weights: those of the scene, or of the provider asked for.
    pub(crate) fn provider(&self, asked: Option<Provider>) -> Result<Arc<dyn WeightProvider>, Refusal> {
        let scene = self.framed_scene()?;
        let wanted = asked.unwrap_or(scene.pose_space.provider);
        if let Some(bench) = &self.bench
            && wanted == scene.pose_space.provider
        {
            let own: Arc<dyn WeightProvider> = Arc::<EditableWeights>::clone(bench.weights());
            return Ok(own);
        }
        let own = &self.providers[usize::from(wanted == Provider::Rbf)];
        let made = || {
            let made = scene.weights(Some(wanted));
            let made = made.map(|weights| -> Arc<dyn WeightProvider> { Arc::new(weights) });
            made.map_err(|error| Problem::from(&error))
        };
        own.get_or_init(made).clone().map_err(Refusal::conflict)
    }

    /// How much of each pose's drawing is seen.
    pub(crate) fn texture_weights(&self, weights: &[f64], sharpness: Option<f64>) -> Result<Vec<f64>, Refusal> {
        let scene = self.framed_scene()?;
        let sharpness = sharpness.unwrap_or(scene.texture_sharpness);
        shared_texture_weights(weights, &scene.originals(), sharpness).map_err(Refusal::bad)
    }
}
