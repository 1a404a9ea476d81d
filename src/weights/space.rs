//! A pose space that is solved: mesh, factored energy, what holds the weights, and the weights as a surface.
//!
//! Everything is in units of the frame: its centre at the origin, its diagonal 1.

use std::sync::Arc;

use super::bounded::{self, BoundedReport};
use super::elements::Elements;
use super::objective::{Field, Region};
use super::plate::{Load, Plate, Support, Supports};
use super::surface::Surface;
use super::tessellation::{self, Tessellation};
use super::walls::Walls;
use super::{Energy, Range, WeightError};
use crate::math::Point;
use crate::mesh::geometry;

/// Edges to the diagonal in the meaning of `epsilon`; see the page of `biharmonic`.
const NOMINAL_EDGES: f64 = 32.0;

/// A pose that moves needs this many triangles between itself and any other pose or wall.
const TRIANGLES_APART: f64 = 1.5;

/// How far from the frame's centre poses may move, in its diagonals, before the mesh is too coarse for them.
const ROOM: f64 = 1.0;

/// A pose this near to a vertex that is a pin is held there, in diagonals: rounding of its coordinates.
const AT_PIN: f64 = 1e-12;

/// The unit and origin of everything that is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub(super) centre: Point,
    pub(super) diagonal: f64,
}

impl Frame {
    pub(super) fn to_frame(self, place: &[f64]) -> Point {
        (Point::new(place[0], place[1]) - self.centre) / self.diagonal
    }

    fn to_layout(self, p: Point) -> [f64; 2] {
        (p * self.diagonal + self.centre).into()
    }
}

/// What a space is made of, in the frame's units.
#[derive(Debug)]
pub(super) struct Plan<'a> {
    pub(super) poses: &'a [Point],
    pub(super) walls: &'a Walls,
    pub(super) energy: Energy,
    pub(super) epsilon: f64,
    pub(super) range: Range,
    /// Regions to flatten and to pull in, with strengths, in the layout's own coordinates.
    pub(super) flat: Vec<(&'a Region, f64)>,
    pub(super) pulled: Vec<(&'a Region, f64)>,
    pub(super) frame: Frame,
    /// Places that are held, each with how softly.
    pub(super) held: Vec<(Point, f64)>,
}

/// What keeps a pose's weight at 1.
#[derive(Debug, Clone)]
enum Hold {
    Pin(usize),
    Place(Arc<Load>),
}

/// What every wish asks for, one row a wish with a weight for every pose.
#[derive(Debug, Clone, Default)]
pub(super) struct Wishes {
    /// In the order of [`Plan::held`].
    pub(super) held: Vec<Vec<f64>>,
    /// In the order of [`Plan::pulled`].
    pub(super) pulled: Vec<Vec<f64>>,
}

#[derive(Debug, Clone)]
pub(super) struct Space {
    surface: Surface,
    elements: Elements,
    plate: Arc<Plate>,
    /// What pulls values towards the bounds, at each vertex; empty where there are none.
    penalties: Vec<f64>,
    /// Places of the pins: the poses that the mesh was made for.
    pins: Vec<Point>,
    holds: Vec<Hold>,
    held: Vec<(Arc<Load>, f64)>,
    pulled: Arc<Vec<Load>>,
    report: Option<BoundedReport>,
}

impl Space {
    pub(super) fn new(plan: &Plan<'_>, wishes: &Wishes) -> Result<Self, WeightError> {
        let (mesh, gradient_unit) = match plan.energy {
            Energy::Hessian => (
                tessellation::graded(plan.poses, plan.walls, 0)?,
                NOMINAL_EDGES * NOMINAL_EDGES,
            ),
            Energy::JacobianDifferences => (tessellation::even(plan.poses, plan.walls)?, 1.0),
        };
        Self::on_mesh(mesh, gradient_unit, plan, wishes)
    }

    /// As [`Self::new`], on a given mesh.
    pub(super) fn on_mesh(
        mesh: Tessellation,
        gradient_unit: f64,
        plan: &Plan<'_>,
        wishes: &Wishes,
    ) -> Result<Self, WeightError> {
        let elements = Elements::new(&mesh, plan.energy);
        let fields = |regions: &[(&Region, f64)], unit: f64| -> Vec<Box<dyn Fn(Point) -> f64 + '_>> {
            let field = |&(region, strength): &(&Region, f64)| {
                let region = region.clone();
                Box::new(move |p: Point| unit * strength * region.at(plan.frame.to_layout(p)))
                    as Box<dyn Fn(Point) -> f64>
            };
            regions.iter().map(field).collect()
        };
        let flat = fields(&plan.flat, gradient_unit);
        let flat: Vec<Field<'_>> = flat.iter().map(|field| &**field as Field<'_>).collect();
        let mut entries = elements.energy(&mesh, gradient_unit * plan.epsilon, &flat)?;
        let mut pulls = Vec::new();
        for field in fields(&plan.pulled, 1.0) {
            let (matrix, form) = elements.pull(&mesh, &*field);
            entries.extend(matrix);
            pulls.push(form);
        }
        let penalties = match plan.range {
            Range::Free => Vec::new(),
            Range::Unit => bounded::penalties(&mesh),
        };
        for (vertex, penalty) in penalties.iter().enumerate() {
            let unknown = elements.value_at(vertex);
            entries.push((unknown, unknown, *penalty));
        }
        let pins = (0..plan.poses.len()).map(|pose| elements.value_at(pose)).collect();
        let plate = Plate::new(elements.unknown_count(), &entries, pins)?;
        let pulled = plate.loads(pulls)?;
        let mut space = Self {
            surface: Surface::new(mesh),
            elements,
            plate: Arc::new(plate),
            penalties,
            pins: plan.poses.to_vec(),
            holds: (0..plan.poses.len()).map(Hold::Pin).collect(),
            held: Vec::new(),
            pulled: Arc::new(pulled),
            report: None,
        };
        let places: Vec<Point> = plan.held.iter().map(|(place, _)| *place).collect();
        let loads = space.loads(&places)?;
        space.held = loads
            .into_iter()
            .zip(plan.held.iter().map(|(_, softness)| *softness))
            .collect();
        space.settle(wishes)?;
        Ok(space)
    }

    pub(super) fn surface(&self) -> &Surface {
        &self.surface
    }

    pub(super) fn report(&self) -> Option<BoundedReport> {
        self.report
    }

    /// Whether the mesh is fine enough for these poses, at all of which but `moved` a pose is held already.
    pub(super) fn suits(&self, poses: &[Point], moved: usize, walls: &Walls) -> bool {
        let p = poses[moved];
        let Some(located) = self.surface.locate(p).filter(|_| p.amax() <= ROOM) else {
            return false;
        };
        let mesh = self.surface.mesh();
        let [a, b, c] = geometry::corners(&mesh.positions, mesh.triangles[located.triangle]);
        let apart = TRIANGLES_APART * (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let others = poses.iter().enumerate().filter(|(other, _)| *other != moved);
        walls.distance(p) > apart && others.map(|(_, q)| (p - q).norm()).all(|distance| distance > apart)
    }

    /// Holds pose `pose` at `p` instead of where it is, or a new last one.
    pub(super) fn hold(&mut self, pose: usize, p: Point) -> Result<(), WeightError> {
        let pin = self.pins.iter().position(|pin| (pin - p).norm() <= AT_PIN);
        let hold = match pin {
            Some(pin) => Hold::Pin(pin),
            None => Hold::Place(self.loads(&[p])?.swap_remove(0)),
        };
        match self.holds.get_mut(pose) {
            Some(known) => *known = hold,
            None => self.holds.push(hold),
        }
        Ok(())
    }

    /// Holds pose `pose` no longer.
    pub(super) fn release(&mut self, pose: usize) {
        self.holds.remove(pose);
    }

    /// The shapes of the plate under the value at each place.
    fn loads(&self, places: &[Point]) -> Result<Vec<Arc<Load>>, WeightError> {
        let form = |&p: &Point| {
            let located = self.surface.locate(p)?;
            Some(self.elements.value_form(self.surface.mesh(), &located))
        };
        let forms = places.iter().filter_map(form).collect();
        Ok(self.plate.loads(forms)?.into_iter().map(Arc::new).collect())
    }

    /// Finds the weights under all that is held and wished for.
    pub(super) fn settle(&mut self, wishes: &Wishes) -> Result<(), WeightError> {
        let count = self.holds.len();
        let unit = |pose: usize| (0..count).map(|k| f64::from(u8::from(k == pose))).collect::<Vec<_>>();
        let mut supports = Supports {
            count,
            pins: vec![None; self.pins.len()],
            points: Vec::new(),
            loads: self.pulled.iter().zip(wishes.pulled.iter().cloned()).collect(),
        };
        for (pose, hold) in self.holds.iter().enumerate() {
            match hold {
                Hold::Pin(pin) => supports.pins[*pin] = Some(unit(pose)),
                Hold::Place(load) => supports.points.push(Support {
                    load,
                    values: unit(pose),
                    softness: 0.0,
                }),
            }
        }
        for ((load, softness), values) in self.held.iter().zip(&wishes.held) {
            supports.points.push(Support {
                load,
                values: values.clone(),
                softness: *softness,
            });
        }
        let functions = if self.penalties.is_empty() {
            self.plate.settle(&supports)?
        } else {
            let values: Vec<usize> = (0..self.penalties.len()).map(|v| self.elements.value_at(v)).collect();
            let (functions, report) = bounded::settle(&self.plate, &supports, &values, &self.penalties)?;
            self.report = Some(report);
            functions
        };
        let jets = self.elements.jets(&functions, count);
        self.surface.set(jets, count);
        Ok(())
    }
}
