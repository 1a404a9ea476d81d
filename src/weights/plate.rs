//! A plate with an energy, held at points: factored once, supports moved by small systems.
//!
//! The energy `f K f / 2` is factored with some unknowns, the *pins*, taken out. Two kinds of shapes are solved for with
//! that factor:
//! - of each pin: 1 at this pin, 0 at the others, of least energy elsewhere;
//! - of each *load*, a linear form `m`: 0 at the pins, and `K f = m` elsewhere.
//!
//! Every state of least energy under any supports is a sum of these shapes. Pins can be held at values or let go; a point
//! support anywhere is a load (the value there) of unknown size; a given load is one of known size. With `S` the
//! stiffness between pins, `B` the values of the pins' shapes under the supports and `C` those of the supports' shapes,
//! pin values `a` and support forces `l` solve
//!
//! ```text
//! S a - B l = given loads on the pins' shapes      at the pins let go
//! B' a + C l = wanted values - given loads' shapes   at the supports
//! ```
//!
//! a system as small as the numbers of pins let go and of supports. Moving a support costs one pair of triangular
//! solves for its shape, this system, and the sum.

use std::borrow::Borrow;

use super::WeightError;
use super::elements::Form;
use crate::math::vectorised;
use crate::solve::{DenseMatrix, Entry, SolvedDense, SparseCholesky, Triplets};

/// Right-hand sides solved together.
const LANES: usize = 4;

#[derive(Debug, Clone)]
pub(super) struct Plate {
    /// The unknowns that are pins.
    pins: Vec<usize>,
    /// The others, in order.
    free: Vec<usize>,
    factor: SparseCholesky,
    /// #pins x #unknowns.
    shapes: Vec<Vec<f64>>,
    /// #pins x #pins.
    stiffness: Vec<Vec<f64>>,
}

/// A linear form and the plate's shape under it.
#[derive(Debug, Clone)]
pub(super) struct Load {
    form: Form,
    shape: Vec<f64>,
}

impl Load {
    fn on(&self, shape: &[f64]) -> f64 {
        value(&self.form, shape)
    }
}

/// What holds several functions at once.
#[derive(Debug)]
pub(super) struct Supports<'a> {
    /// How many functions.
    pub(super) count: usize,
    /// For each pin the value of every function there, or `None` if it is let go.
    pub(super) pins: Vec<Option<Vec<f64>>>,
    /// Supports elsewhere.
    pub(super) points: Vec<Support<'a>>,
    /// Given loads, and the factor of each for every function.
    pub(super) loads: Vec<(&'a Load, Vec<f64>)>,
}

/// A point where functions are held.
#[derive(Debug)]
pub(super) struct Support<'a> {
    pub(super) load: &'a Load,
    /// The value of every function there.
    pub(super) values: Vec<f64>,
    /// 0: exactly; otherwise the function may deviate, and half of its squared deviation over this is added to the energy.
    pub(super) softness: f64,
}

impl<'a> Supports<'a> {
    /// The same with further loads, one for each function.
    pub(super) fn with<'b>(&self, further: &'b [Load]) -> Supports<'b>
    where
        'a: 'b,
    {
        let unit = |k: usize| (0..self.count).map(|l| f64::from(u8::from(k == l))).collect();
        let points = self.points.iter().map(|point| Support {
            load: point.load,
            values: point.values.clone(),
            softness: point.softness,
        });
        let given = self.loads.iter().map(|(load, factors)| (*load, factors.clone()));
        Supports {
            count: self.count,
            pins: self.pins.clone(),
            points: points.collect(),
            loads: given
                .chain(further.iter().enumerate().map(|(k, load)| (load, unit(k))))
                .collect(),
        }
    }
}

fn value(form: &Form, function: &[f64]) -> f64 {
    form.iter().map(|&(unknown, factor)| factor * function[unknown]).sum()
}

impl Plate {
    /// Factors the energy whose lower triangle is `entries`, with `pins` taken out.
    pub(super) fn new(unknown_count: usize, entries: &[Entry], pins: Vec<usize>) -> Result<Self, WeightError> {
        let mut place = vec![None; unknown_count];
        let mut is_pin = vec![None; unknown_count];
        for (k, &pin) in pins.iter().enumerate() {
            is_pin[pin] = Some(k);
        }
        let free: Vec<usize> = (0..unknown_count).filter(|&k| is_pin[k].is_none()).collect();
        for (k, &unknown) in free.iter().enumerate() {
            place[unknown] = Some(k);
        }
        let mut system = Triplets::new(free.len(), free.len());
        // Rows of the matrix at the pins, with all unknowns.
        let mut at_pins: Vec<Form> = vec![Form::new(); pins.len()];
        for &(row, column, value) in entries {
            if let (Some(row), Some(column)) = (place[row], place[column]) {
                system.add(row, column, value);
            }
            if let Some(pin) = is_pin[row] {
                at_pins[pin].push((column, value));
            }
            if let Some(pin) = is_pin[column].filter(|_| row != column) {
                at_pins[pin].push((row, value));
            }
        }
        let mut plate = Self {
            free,
            factor: SparseCholesky::new(&system.build())?,
            shapes: Vec::new(),
            stiffness: Vec::new(),
            pins,
        };
        let pulled = at_pins.iter().map(|form| {
            let negative = form.iter().map(|&(unknown, value)| (unknown, -value));
            negative.collect::<Form>()
        });
        plate.shapes = plate.solved(&pulled.collect::<Vec<_>>())?;
        for (shape, &pin) in plate.shapes.iter_mut().zip(&plate.pins) {
            shape[pin] = 1.0;
        }
        let row = |form| plate.shapes.iter().map(|shape| value(form, shape)).collect();
        plate.stiffness = at_pins.iter().map(row).collect();
        Ok(plate)
    }

    /// The shapes under several loads.
    pub(super) fn loads(&self, forms: Vec<Form>) -> Result<Vec<Load>, WeightError> {
        let shapes = self.solved(&forms)?;
        let pairs = forms.into_iter().zip(shapes);
        Ok(pairs.map(|(form, shape)| Load { form, shape }).collect())
    }

    /// For every form `m` the solution of `K f = m` with 0 at the pins.
    fn solved(&self, forms: &[Form]) -> Result<Vec<Vec<f64>>, WeightError> {
        let mut shapes = Vec::with_capacity(forms.len());
        for together in forms.chunks(LANES) {
            shapes.extend(match together.len() {
                1 => self.solve_lanes::<1>(together)?,
                _ => self.solve_lanes::<LANES>(together)?,
            });
        }
        Ok(shapes)
    }

    fn solve_lanes<const K: usize>(&self, forms: &[Form]) -> Result<Vec<Vec<f64>>, WeightError> {
        let unknown_count = self.free.len() + self.pins.len();
        let mut right = vec![[0.0; K]; unknown_count];
        for (lane, form) in forms.iter().enumerate() {
            for &(unknown, value) in form {
                right[unknown][lane] += value;
            }
        }
        let mut lanes: Vec<[f64; K]> = self.free.iter().map(|&unknown| right[unknown]).collect();
        self.factor.solve(&mut lanes, &mut Vec::new())?;
        let shape = |lane: usize| {
            let mut shape = vec![0.0; unknown_count];
            for (&unknown, solved) in self.free.iter().zip(&lanes) {
                shape[unknown] = solved[lane];
            }
            shape
        };
        Ok((0..forms.len()).map(shape).collect())
    }

    /// The functions of least energy: #unknowns x #functions.
    pub(super) fn settle(&self, supports: &Supports<'_>) -> Result<Vec<f64>, WeightError> {
        let count = supports.count;
        let let_go: Vec<usize> = (0..self.pins.len()).filter(|&k| supports.pins[k].is_none()).collect();
        let mut values: Vec<Vec<f64>> = supports
            .pins
            .iter()
            .map(|held| held.clone().unwrap_or_else(|| vec![0.0; count]))
            .collect();
        let mut forces: Vec<Vec<f64>> = vec![Vec::new(); supports.points.len()];
        let size = let_go.len() + supports.points.len();
        if size > 0 {
            // Rows and columns: pins let go, then points.
            let mut system = vec![vec![0.0; size]; size];
            let mut right = vec![vec![0.0; count]; size];
            let add = |row: &mut Vec<f64>, factor: f64, from: &[f64]| {
                for (entry, value) in row.iter_mut().zip(from) {
                    *entry += factor * value;
                }
            };
            for (row, &pin) in let_go.iter().enumerate() {
                for (column, &other) in let_go.iter().enumerate() {
                    system[row][column] = self.stiffness[pin][other];
                }
                for (other, held) in supports.pins.iter().enumerate() {
                    if let Some(held) = held {
                        add(&mut right[row], -self.stiffness[pin][other], held);
                    }
                }
                for (load, factors) in &supports.loads {
                    add(&mut right[row], load.on(&self.shapes[pin]), factors);
                }
            }
            for (k, point) in supports.points.iter().enumerate() {
                let row = let_go.len() + k;
                for (column, &pin) in let_go.iter().enumerate() {
                    let shape = point.load.on(&self.shapes[pin]);
                    system[row][column] = shape;
                    system[column][row] = -shape;
                }
                for (l, other) in supports.points.iter().enumerate() {
                    system[row][let_go.len() + l] = point.load.on(&other.load.shape);
                }
                system[row][row] += point.softness;
                right[row].copy_from_slice(&point.values);
                for (pin, held) in supports.pins.iter().enumerate() {
                    if let Some(held) = held {
                        add(&mut right[row], -point.load.on(&self.shapes[pin]), held);
                    }
                }
                for (load, factors) in &supports.loads {
                    add(&mut right[row], -point.load.on(&load.shape), factors);
                }
            }
            let system = DenseMatrix::from_fn(size, size, |row, column| system[row][column]);
            let right = DenseMatrix::from_fn(size, count, |row, column| right[row][column]);
            let solution = SolvedDense::new(&system)?.solve(&right)?;
            let row = |row: usize| (0..count).map(|column| solution.at(row, column)).collect();
            for (k, &pin) in let_go.iter().enumerate() {
                values[pin] = row(k);
            }
            for (k, force) in forces.iter_mut().enumerate() {
                *force = row(let_go.len() + k);
            }
        }
        let terms = (self.shapes.iter().map(Vec::as_slice).zip(values))
            .chain((supports.points.iter().map(|point| point.load.shape.as_slice())).zip(forces))
            .chain((supports.loads.iter()).map(|(load, factors)| (load.shape.as_slice(), factors.clone())))
            .filter(|(_, factors)| factors.iter().any(|factor| *factor != 0.0));
        Ok(self.sum(&terms.collect::<Vec<_>>(), count))
    }

    /// The sum of shapes, each with a factor for every function.
    fn sum<S: Borrow<[f64]>>(&self, terms: &[(S, Vec<f64>)], count: usize) -> Vec<f64> {
        let unknown_count = self.free.len() + self.pins.len();
        let mut functions = vec![0.0; unknown_count * count];
        vectorised(|| {
            for (unknown, row) in functions.chunks_exact_mut(count).enumerate() {
                for (shape, factors) in terms {
                    let height = shape.borrow()[unknown];
                    for (value, factor) in row.iter_mut().zip(factors) {
                        *value += height * factor;
                    }
                }
            }
        });
        functions
    }
}
