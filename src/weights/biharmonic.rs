//! The smoothest weights on a plane: mesh-based biharmonic interpolation.
//!
//! Source: NWM 4.1, equations 1 and 2.
//!
//! 1. The layout is moved to the origin and scaled to diagonal 1, so that nothing depends on its units.
//! 2. A square that reaches 4 layout diagonals from the centre to each side is triangulated with the poses as
//!    vertices (spade), and cut open along the walls.
//! 3. The weights minimise an energy under the constraint to be 1 at their own pose and 0 at the others (eliminated);
//!    one sparse factorisation serves all poses.
//! 4. Between vertices they are evaluated by Clough-Tocher patches, with continuous gradients: motion does not kink at
//!    mesh edges.
//! 5. Beyond the square, the value at its nearest point holds.
//!
//! Differences from the paper: equation 1 takes triangles to be even, and on uneven ones its result depends on the mesh.
//! The default energy is the one that it stands for, `|second derivatives|^2 + w |gradient|^2` integrated over the
//! plane, on elements that converge to it ([`Energy::Hessian`]), and the mesh is graded. The paper's form is
//! [`Energy::JacobianDifferences`], on an even mesh.
//!
//! What `epsilon` means: in the paper it weighs gradients against gradient jumps between neighbouring triangles, so it
//! is a number per squared edge. Here the edge is fixed as 1/32 of the layout's diagonal: `w = 32^2 epsilon` in units
//! where the diagonal is 1. Weights level out over the distance `1 / sqrt(w)`: one diagonal for the default 1e-3.
//!
//! Walls: nothing is smooth across a wall, and influence goes around its ends. A place on a wall belongs to one of its sides,
//! always the same. A part that walls close off has weights of its own poses only; without a pose in it, it is a hole: the
//! weights there are those of the nearest place that is no hole.
//!
//! Editing: poses can be moved, inserted and removed with the factorisation kept (see `plate`). The mesh then stays, as long as
//! it is fine enough where the poses are, and so does the frame (the diagonal that lengths are measured in). A new
//! [`BiharmonicWeights`] of the same layout has another mesh, and another frame unless [`BiharmonicOptions::extent`] gives
//! it: its weights are those of the edited one up to the error of either mesh, some 1e-2 where weights change fast and
//! less elsewhere. What the weights are depends on the mesh and the places, not on the way there: back at the old
//! places they are the old ones.
//!
//! Cost: some 2,000 vertices for a handful of poses, under 100 ms to build, a few to edit, and microseconds to ask.

use super::bounded::{self, BoundedReport};
use super::layout::Layout;
use super::objective::{Objective, Target};
use super::rbf::PseudoPose;
use super::space::{Frame, Plan, Space, Wishes};
use super::tessellation::REACH;
use super::walls::Walls;
use super::{WeightError, WeightProvider, check_place, check_pose};
use crate::math::Point;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Energy {
    /// Squared second derivatives (thin-plate energy) and squared gradients, integrated over the plane. The result is a
    /// property of the layout, not of the mesh.
    #[default]
    Hessian,
    /// The paper's equation 1 as printed, on an even mesh.
    JacobianDifferences,
}

/// What values weights may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Range {
    /// Any: they overshoot a little between the poses, and extrapolate beyond them.
    #[default]
    Free,
    /// From 0 to 1 everywhere. Takes tens to hundreds of times as long to find.
    Unit,
}

/// What [`BiharmonicWeights`] can be told.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BiharmonicOptions {
    /// How strongly flat is preferred to straight. Default: 1e-3; the weights then level out about one diagonal away from
    /// the poses. Smaller values extrapolate further.
    pub epsilon: f64,
    /// Default: [`Energy::Hessian`].
    pub energy: Energy,
    /// Default: [`Range::Free`].
    pub range: Range,
    /// Polylines that influence may not cross, in the coordinates of the places. Default: none.
    pub walls: Vec<Vec<[f64; 2]>>,
    /// Further wishes. Default: none.
    pub objectives: Vec<Objective>,
    /// Places where the weights are exactly those found, without pulls and pseudo-poses, at another place. Default: none.
    pub pseudo_poses: Vec<PseudoPose>,
    /// Two opposite corners of the box whose diagonal is the unit of lengths and whose centre is that of the plane. Default:
    /// the box around the poses.
    pub extent: Option<[[f64; 2]; 2]>,
}

impl Default for BiharmonicOptions {
    fn default() -> Self {
        Self {
            epsilon: 1e-3,
            energy: Energy::default(),
            range: Range::default(),
            walls: Vec::new(),
            objectives: Vec::new(),
            pseudo_poses: Vec::new(),
            extent: None,
        }
    }
}

/// What an edit took.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edit {
    /// The factorisation was kept: a few milliseconds.
    Solved,
    /// The mesh did not suit the new layout, or the options do not allow less: all was built anew.
    Rebuilt,
}

/// Biharmonic weights over a plane of poses.
///
/// ```
/// use inbetween::weights::{BiharmonicOptions, BiharmonicWeights, WeightProvider};
///
/// # fn main() -> Result<(), inbetween::weights::WeightError> {
/// let places = [vec![0.0, 0.0], vec![1.0, 0.0], vec![2.0, 0.0]];
/// let mut provider = BiharmonicWeights::new(&places, &BiharmonicOptions::default())?;
/// let mut weights = Vec::new();
/// provider.weights(&[1.0, 0.0], &mut weights)?;
/// assert!((weights[1] - 1.0).abs() < 1e-9);
/// provider.move_pose(1, &[1.0, 0.5])?;
/// provider.weights(&[1.0, 0.5], &mut weights)?;
/// assert!((weights[1] - 1.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct BiharmonicWeights {
    options: BiharmonicOptions,
    places: Vec<Vec<f64>>,
    frame: Frame,
    walls: Walls,
    /// `None` for a single pose without walls: its weight is 1 everywhere.
    space: Option<Space>,
    /// The weights without pulls and pseudo-poses, if any of these asks for what is found somewhere.
    plain: Option<Box<Self>>,
}

impl BiharmonicWeights {
    /// Solves for weights of poses at `places` (#poses x 2).
    ///
    /// # Errors
    /// [`WeightError`] if there is no pose, places are not of two finite coordinates, two coincide, a wall has no length
    /// or touches a pose, or another option makes no sense.
    pub fn new(places: &[Vec<f64>], options: &BiharmonicOptions) -> Result<Self, WeightError> {
        let layout = checked(places, options)?;
        let frame = frame(&layout, options)?;
        let plain = asks_for_found_weights(options).then(|| {
            let plain = BiharmonicOptions {
                objectives: options
                    .objectives
                    .iter()
                    .filter(|wish| !wish.pulls())
                    .cloned()
                    .collect(),
                pseudo_poses: Vec::new(),
                ..options.clone()
            };
            Self::new(places, &plain).map(Box::new)
        });
        let mut weights = Self {
            options: options.clone(),
            places: places.to_vec(),
            frame,
            walls: Walls::default(),
            space: None,
            plain: plain.transpose()?,
        };
        let walls: Vec<Vec<Point>> = options
            .walls
            .iter()
            .map(|wall| wall.iter().map(|p| frame.to_frame(p)).collect())
            .collect();
        let poses = weights.poses();
        weights.walls = Walls::new(&walls, &poses, REACH)?;
        if poses.len() > 1 {
            weights.space = Some(weights.solved(&poses)?);
        }
        Ok(weights)
    }

    fn poses(&self) -> Vec<Point> {
        self.places.iter().map(|place| self.frame.to_frame(place)).collect()
    }

    fn solved(&self, poses: &[Point]) -> Result<Space, WeightError> {
        let mut flat = Vec::new();
        let mut pulled = Vec::new();
        // Pseudo-poses first, then soft ones.
        let mut held: Vec<(Point, f64)> = self
            .options
            .pseudo_poses
            .iter()
            .map(|pseudo| (self.frame.to_frame(&pseudo.at), 0.0))
            .collect();
        for wish in &self.options.objectives {
            match wish {
                Objective::Flatten { region, strength } => flat.push((region, *strength)),
                Objective::Pull { region, strength, .. } => pulled.push((region, *strength)),
                Objective::PullAt { at, strength, .. } => held.push((self.frame.to_frame(at), strength.recip())),
            }
        }
        let plan = Plan {
            poses,
            walls: &self.walls,
            energy: self.options.energy,
            epsilon: self.options.epsilon,
            range: self.options.range,
            flat,
            pulled,
            frame: self.frame,
            held,
        };
        Space::new(&plan, &self.wishes()?)
    }

    /// What is asked for, for the poses as they are.
    fn wishes(&self) -> Result<Wishes, WeightError> {
        let found = |place: &[f64]| {
            let mut weights = Vec::new();
            match &self.plain {
                Some(plain) => plain.weights(place, &mut weights)?,
                None => weights.resize(self.places.len(), 1.0 / self.places.len() as f64),
            }
            Ok::<_, WeightError>(weights)
        };
        let wanted = |target: &Target| match target {
            Target::Weights(weights) => Ok(weights.clone()),
            Target::FoundAt(place) => found(place),
        };
        let mut wishes = Wishes::default();
        for pseudo in &self.options.pseudo_poses {
            wishes.held.push(found(&pseudo.from)?);
        }
        for wish in &self.options.objectives {
            match wish {
                Objective::Pull { target, .. } => wishes.pulled.push(wanted(target)?),
                Objective::PullAt { target, .. } => wishes.held.push(wanted(target)?),
                Objective::Flatten { .. } => {}
            }
        }
        Ok(wishes)
    }

    /// Moves a pose. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`], and [`WeightError::NoSuchPose`].
    pub fn move_pose(&mut self, pose: usize, place: &[f64]) -> Result<Edit, WeightError> {
        check_pose(pose, self.places.len())?;
        let mut places = self.places.clone();
        places[pose] = place.to_vec();
        self.edit(
            places,
            self.options.clone(),
            |space, poses| space.hold(pose, poses[pose]),
            Some(pose),
        )
    }

    /// Adds a pose after the last one. [`Target::Weights`] do not ask for any of it. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn insert_pose(&mut self, place: &[f64]) -> Result<Edit, WeightError> {
        let mut places = self.places.clone();
        places.push(place.to_vec());
        let mut options = self.options.clone();
        for wish in &mut options.objectives {
            if let Some(Target::Weights(weights)) = wish.target_mut() {
                weights.push(0.0);
            }
        }
        let last = self.places.len();
        self.edit(
            places,
            options,
            |space, poses| space.hold(last, poses[last]),
            Some(last),
        )
    }

    /// Removes a pose; later ones move up by one. What [`Target::Weights`] ask of it is shared out in proportion among the
    /// others, evenly if they ask for nothing else. On an error nothing has changed.
    ///
    /// # Errors
    /// [`WeightError::NoSuchPose`], or [`WeightError::NoPose`] for the last one.
    pub fn remove_pose(&mut self, pose: usize) -> Result<Edit, WeightError> {
        check_pose(pose, self.places.len())?;
        let mut places = self.places.clone();
        places.remove(pose);
        let mut options = self.options.clone();
        for wish in &mut options.objectives {
            if let Some(Target::Weights(weights)) = wish.target_mut() {
                weights.remove(pose);
                let (sum, count) = (weights.iter().sum::<f64>(), weights.len());
                for weight in weights {
                    *weight = if sum == 0.0 { 1.0 / count as f64 } else { *weight / sum };
                }
            }
        }
        let release = |space: &mut Space, _: &[Point]| {
            space.release(pose);
            Ok(())
        };
        self.edit(places, options, release, None)
    }

    /// Takes the new places: on the present mesh if it suits the pose that is `moved`, or on a new one.
    fn edit(
        &mut self,
        places: Vec<Vec<f64>>,
        options: BiharmonicOptions,
        change: impl FnOnce(&mut Space, &[Point]) -> Result<(), WeightError>,
        moved: Option<usize>,
    ) -> Result<Edit, WeightError> {
        let layout = checked(&places, &options)?;
        let mut edited = Self {
            options,
            places,
            frame: self.frame,
            walls: Walls::default(),
            space: None,
            plain: None,
        };
        let poses = edited.poses();
        let size = if self.options.extent.is_some() || layout.len() == 1 {
            1.0
        } else {
            layout.diagonal() / self.frame.diagonal
        };
        let suited = |space: &&Space| {
            let fits = moved.is_none_or(|moved| space.suits(&poses, moved, &self.walls));
            // Weights without pulls have another matrix, which is edited by building it anew.
            fits && self.plain.is_none() && poses.len() > 1 && (SHRUNK..=GROWN).contains(&size)
        };
        if let Some(mut space) = self.space.as_ref().filter(suited).cloned() {
            // A part of the plane that no pose is left in has no weights on this mesh: then it becomes a hole of a new one.
            let solved = change(&mut space, &poses).and_then(|()| space.settle(&edited.wishes()?));
            if solved.is_ok() {
                edited.walls = std::mem::take(&mut self.walls);
                edited.space = Some(space);
                *self = edited;
                return Ok(Edit::Solved);
            }
        }
        *self = Self::new(&edited.places, &edited.options)?;
        Ok(Edit::Rebuilt)
    }

    /// The poses' places, #poses x 2.
    #[must_use]
    pub fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    /// The square that was solved on: lowest and highest corner. Beyond it weights are constant outwards.
    #[must_use]
    pub fn domain(&self) -> ([f64; 2], [f64; 2]) {
        let reach = Point::repeat(REACH * self.frame.diagonal);
        ((self.frame.centre - reach).into(), (self.frame.centre + reach).into())
    }

    /// Vertices of the mesh; 0 for a single pose.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        (self.space.as_ref()).map_or(0, |space| space.surface().mesh().positions.len())
    }

    /// How the search for bounded weights ended; `None` with [`Range::Free`] or a single pose.
    #[must_use]
    pub fn bounded_report(&self) -> Option<BoundedReport> {
        self.space.as_ref().and_then(Space::report)
    }
}

/// An edited layout smaller or larger than these shares of the one that the frame was made for gets a new frame.
const SHRUNK: f64 = 0.5;
const GROWN: f64 = 2.0;

impl WeightProvider for BiharmonicWeights {
    fn pose_count(&self) -> usize {
        self.places.len()
    }

    fn dimension(&self) -> usize {
        2
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_place(at, 2)?;
        match &self.space {
            Some(space) => {
                space.surface().values(self.frame.to_frame(at), weights);
                if self.options.range == Range::Unit {
                    bounded::bend(weights);
                }
            }
            None => {
                weights.clear();
                weights.push(1.0);
            }
        }
        Ok(())
    }
}

/// The layout, if it and the options make sense.
fn checked(places: &[Vec<f64>], options: &BiharmonicOptions) -> Result<Layout, WeightError> {
    let layout = Layout::new(places)?;
    if layout.dimension() != 2 {
        return Err(WeightError::WrongDimension {
            expected: 2,
            found: layout.dimension(),
        });
    }
    if !(options.epsilon > 0.0 && options.epsilon.is_finite()) {
        return Err(WeightError::BadOption {
            option: "epsilon",
            value: options.epsilon,
            must_be: "a positive number",
        });
    }
    for corner in options.walls.iter().flatten().chain(options.extent.iter().flatten()) {
        check_place(corner, 2)?;
    }
    for wish in &options.objectives {
        wish.check(layout.len())?;
    }
    // A pseudo-pose is an example like a pose: two at one place contradict one another.
    let mut examples = places.to_vec();
    for pseudo in &options.pseudo_poses {
        check_place(&pseudo.from, 2)?;
        examples.push(pseudo.at.clone());
    }
    Layout::new(&examples)?;
    Ok(layout)
}

fn frame(layout: &Layout, options: &BiharmonicOptions) -> Result<Frame, WeightError> {
    let (low, high) = match options.extent {
        Some([a, b]) => (Point::from(a), Point::from(b)),
        None => {
            let (low, high) = layout.bounds();
            (Point::new(low[0], low[1]), Point::new(high[0], high[1]))
        }
    };
    let diagonal = (high - low).norm();
    let centre = low + (high - low) * 0.5;
    if layout.len() == 1 && options.extent.is_none() {
        return Ok(Frame { centre, diagonal: 1.0 });
    }
    let outside = layout
        .places()
        .iter()
        .map(|place| (Point::new(place[0], place[1]) - centre).amax());
    let furthest = outside.fold(0.0, f64::max);
    if diagonal > 0.0 && furthest <= 0.5 * REACH * diagonal {
        Ok(Frame { centre, diagonal })
    } else {
        Err(WeightError::BadOption {
            option: "the diagonal of the extent",
            value: diagonal,
            must_be: "at least half of every pose's distance from its centre",
        })
    }
}

fn asks_for_found_weights(options: &BiharmonicOptions) -> bool {
    let found = |target: &Target| matches!(target, Target::FoundAt(_));
    !options.pseudo_poses.is_empty()
        || options.objectives.iter().any(|wish| match wish {
            Objective::Pull { target, .. } | Objective::PullAt { target, .. } => found(target),
            Objective::Flatten { .. } => false,
        })
}
