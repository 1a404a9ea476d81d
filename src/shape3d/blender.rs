//! Blending forms at run time.
//!
//! Source: SBE 3.4: "the Shape Runtime System takes this point and generates an interpolated form".
//!
//! Forms and weights -> the sum of the forms times their weights (equation 3), in single precision, into a buffer of the
//! caller. Each form is one row of numbers: all x, then all y, then all z, or vertex by vertex, as the buffer shall be
//! ([`FormLayout`]). A sum is built in blocks of eight registers, to which every form adds its part, so that each number of a
//! form is read once and each of the result written once: what remains is the bandwidth of the cache that the forms lie in.
//! Rows begin at different places of a page of memory: were they all to begin at the same, as large allocations do, the same few
//! lines of the first cache would have to hold all of them, and a third of the speed would be gone.
//!
//! Weights of exactly 0 cost nothing: their forms are not read. Nothing is allocated. A product is never fused with the
//! addition after it, and forms are added in their order, so the result is the same on every machine.
//!
//! Editing follows that of a [`Shape`]: one form is replaced, added or removed, and no other is copied.

use pulp::{Arch, Simd, WithSimd};

use super::shape::check_length;
use super::{Form, FormError, Shape, ShapeError};

/// Registers that a block of the sum takes: half of those that processors with AVX2 have.
const REGISTERS: usize = 8;

/// Rows are a multiple of this many numbers long: a block of the widest registers there are.
const PADDING: usize = 16 * REGISTERS;

/// Numbers in a page of memory, and in a line of a cache.
const PAGE: usize = 4096 / size_of::<f32>();
const LINE: usize = 64 / size_of::<f32>();

/// Lines from the place where a row begins in its page to where the next one does: blocks take four, and 64 is a page.
const STRIDE: usize = 5;

/// Forms that are added in one go; more take another.
const TOGETHER: usize = 32;

/// In which order the numbers of a form stand in a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FormLayout {
    /// A structure of arrays: x of all vertices, then y of all, then z of all.
    #[default]
    Planar,
    /// x, y, z of each vertex in turn, as graphics processors like it.
    Interleaved,
}

/// Forms made ready to be blended often.
///
/// ```
/// use inbetween::math::Point3;
/// use inbetween::shape3d::{Example, Form, FormBlender, FormLayout, FormTopology, Shape};
/// use inbetween::weights::{RbfOptions, WeightProvider};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let topology = FormTopology::from_triangles(3, vec![[0, 1, 2]])?;
/// # let form = |height: f64| Form::new(&topology, vec![Point3::zeros(), Point3::x(), Point3::new(0.0, height, 0.0)]);
/// # let examples = vec![
/// #     Example { form: form(1.0)?, at: vec![0.0] },
/// #     Example { form: form(3.0)?, at: vec![1.0] },
/// # ];
/// # let shape = Shape::new(topology.clone(), examples, &RbfOptions::default())?;
/// let blender = FormBlender::new(&shape, FormLayout::Interleaved);
/// // Made once, used for every frame.
/// let (mut weights, mut values) = (Vec::new(), vec![0.0; blender.value_count()]);
/// shape.weights().weights(&[0.5], &mut weights)?;
/// blender.blend(&weights, &mut values)?;
/// assert!((values[3 * 2 + 1] - 2.0).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct FormBlender {
    layout: FormLayout,
    vertex_count: usize,
    rows: Vec<Row>,
}

/// A form's numbers, filled up with zeros to a whole number of [`PADDING`].
#[derive(Debug, Clone)]
struct Row {
    numbers: Vec<f32>,
    /// How many numbers come before the first one.
    begin: usize,
}

impl FormBlender {
    /// The blender of a shape's forms.
    #[must_use]
    pub fn new(shape: &Shape, layout: FormLayout) -> Self {
        let vertex_count = shape.topology().vertex_count();
        let forms = shape.forms().iter();
        Self {
            layout,
            vertex_count,
            rows: forms.enumerate().map(|(k, form)| Row::of(form, layout, k)).collect(),
        }
    }

    /// How many forms there are.
    #[must_use]
    pub fn form_count(&self) -> usize {
        self.rows.len()
    }

    /// How many numbers a blend has: three a vertex.
    #[must_use]
    pub fn value_count(&self) -> usize {
        3 * self.vertex_count
    }

    /// In which order the numbers stand.
    #[must_use]
    pub fn layout(&self) -> FormLayout {
        self.layout
    }

    /// The sum of the forms times `weights` (#forms, `f32` or `f64`), into `values` ([`Self::value_count`]).
    ///
    /// # Errors
    /// [`ShapeError::WrongLength`].
    pub fn blend<W: Copy + Into<f64>>(&self, weights: &[W], values: &mut [f32]) -> Result<(), ShapeError> {
        check_length("weights", self.rows.len(), weights.len())?;
        check_length("values", self.value_count(), values.len())?;
        if self.rows.is_empty() {
            values.fill(0.0);
        }
        let arch = Arch::new();
        let mut terms: [(f32, &[f32]); TOGETHER] = [(0.0, &[]); TOGETHER];
        let groups = weights.chunks(TOGETHER).zip(self.rows.chunks(TOGETHER));
        for (group, (weights, rows)) in groups.enumerate() {
            let mut count = 0;
            for (weight, row) in weights.iter().zip(rows) {
                let weight = (*weight).into() as f32;
                if weight != 0.0 {
                    terms[count] = (weight, row.numbers());
                    count += 1;
                }
            }
            arch.dispatch(Sum {
                terms: &terms[..count],
                start: if group == 0 { Start::AtZero } else { Start::AtValues },
                values,
            });
        }
        Ok(())
    }

    /// Gives form `form` other positions.
    ///
    /// # Errors
    /// [`ShapeError::NoSuchExample`], [`ShapeError::Form`] if it has another number of vertices.
    pub fn replace_form(&mut self, form: usize, with: &Form) -> Result<(), ShapeError> {
        self.check(form)?;
        self.rows[form] = self.row(form, with)?;
        Ok(())
    }

    /// Adds a form after the last one.
    ///
    /// # Errors
    /// [`ShapeError::Form`] if it has another number of vertices.
    pub fn insert_form(&mut self, form: &Form) -> Result<(), ShapeError> {
        let row = self.row(self.rows.len(), form)?;
        self.rows.push(row);
        Ok(())
    }

    /// Takes a form out; later ones move up by one.
    ///
    /// # Errors
    /// [`ShapeError::NoSuchExample`].
    pub fn remove_form(&mut self, form: usize) -> Result<(), ShapeError> {
        self.check(form)?;
        self.rows.remove(form);
        Ok(())
    }

    fn check(&self, example: usize) -> Result<(), ShapeError> {
        let count = self.rows.len();
        if example < count {
            Ok(())
        } else {
            Err(ShapeError::NoSuchExample { example, count })
        }
    }

    fn row(&self, example: usize, form: &Form) -> Result<Row, ShapeError> {
        let (expected, found) = (self.vertex_count, form.positions().len());
        if expected == found {
            Ok(Row::of(form, self.layout, example))
        } else {
            let problem = FormError::OtherVertexCount { expected, found };
            Err(ShapeError::Form { example, problem })
        }
    }
}

impl Row {
    /// The row of the form that is number `k`.
    fn of(form: &Form, layout: FormLayout, k: usize) -> Self {
        let positions = form.positions();
        let length = (3 * positions.len()).next_multiple_of(PADDING);
        let mut numbers: Vec<f32> = Vec::with_capacity(PAGE + length);
        // Speed alone depends on the address, not the result.
        let first = numbers.as_ptr().addr() / size_of::<f32>() % PAGE;
        let begin = (PAGE + k * STRIDE * LINE % PAGE - first) % PAGE;
        numbers.resize(begin, 0.0);
        match layout {
            FormLayout::Planar => (0..3).for_each(|k| numbers.extend(positions.iter().map(|p| p[k] as f32))),
            FormLayout::Interleaved => {
                numbers.extend(positions.iter().flat_map(|p| [p.x as f32, p.y as f32, p.z as f32]));
            }
        }
        numbers.resize(begin + length, 0.0);
        Self { numbers, begin }
    }

    fn numbers(&self) -> &[f32] {
        &self.numbers[self.begin..]
    }
}

/// What a sum begins with.
#[derive(Clone, Copy)]
enum Start {
    AtZero,
    /// What the buffer holds.
    AtValues,
}

/// Weighted rows, and where their sum goes.
struct Sum<'a> {
    terms: &'a [(f32, &'a [f32])],
    start: Start,
    values: &'a mut [f32],
}

impl WithSimd for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let block = REGISTERS * S::F32_LANES;
        let whole = self.values.len() - self.values.len() % block;
        let (values, rest) = self.values.split_at_mut(whole);
        let (registers, _) = S::as_mut_simd_f32s(values);
        for (at, sum) in registers.as_chunks_mut::<REGISTERS>().0.iter_mut().enumerate() {
            *sum = sum_of(simd, self.terms, at, start(simd, self.start, sum));
        }
        if !rest.is_empty() {
            let mut last = [0.0; PADDING];
            last[..rest.len()].copy_from_slice(rest);
            let (registers, _) = S::as_mut_simd_f32s(&mut last);
            if let Some(sum) = registers.first_chunk_mut::<REGISTERS>() {
                *sum = sum_of(simd, self.terms, whole / block, start(simd, self.start, sum));
            }
            rest.copy_from_slice(&last[..rest.len()]);
        }
    }
}

#[inline(always)]
fn start<S: Simd>(simd: S, start: Start, values: &[S::f32s; REGISTERS]) -> [S::f32s; REGISTERS] {
    match start {
        Start::AtZero => [simd.splat_f32s(0.0); REGISTERS],
        Start::AtValues => *values,
    }
}

/// Block `at` of the sum.
#[inline(always)]
fn sum_of<S: Simd>(simd: S, terms: &[(f32, &[f32])], at: usize, mut sum: [S::f32s; REGISTERS]) -> [S::f32s; REGISTERS] {
    for (weight, row) in terms {
        let (row, _) = S::as_simd_f32s(row);
        let part = &row[at * REGISTERS..(at + 1) * REGISTERS];
        let weight = simd.splat_f32s(*weight);
        for k in 0..REGISTERS {
            sum[k] = simd.add_f32s(sum[k], simd.mul_f32s(weight, part[k]));
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point3;
    use crate::shape3d::{Example, FormTopology};
    use crate::weights::RbfOptions;
    use proptest::prelude::*;

    /// `count` forms of `vertices` vertices on a line of places.
    fn shape(count: usize, vertices: usize) -> Shape {
        let topology = FormTopology::from_triangles(vertices, vec![[0, 1, 2]]).expect("a triangle");
        let example = |k: usize| {
            let position = |v: usize| Point3::from_fn(|d, _| (1.3 * (v * 3 + d) as f64 + 0.7 * k as f64).sin());
            Example {
                form: Form::new(&topology, (0..vertices).map(position).collect()).expect("a form"),
                at: vec![k as f64],
            }
        };
        Shape::new(
            topology.clone(),
            (0..count).map(example).collect(),
            &RbfOptions::default(),
        )
        .expect("a shape")
    }

    /// The same sum, one number after the other.
    fn naive(blender: &FormBlender, weights: &[f64]) -> Vec<f32> {
        let sum = |at: usize| {
            let terms = blender.rows.iter().zip(weights);
            terms.fold(0.0_f32, |sum, (row, weight)| sum + *weight as f32 * row.numbers()[at])
        };
        (0..blender.value_count()).map(sum).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn blends_equal_the_naive_sum_to_the_last_bit(
            count in 1..70usize,
            vertices in 3..150usize,
            seed in 0.0..100.0f64,
        ) {
            let blender = FormBlender::new(&shape(count, vertices), FormLayout::Planar);
            // A third of the weights is 0.
            let weight = |k: usize| if k % 3 == 1 { 0.0 } else { (seed + 2.1 * k as f64).sin() };
            let weights: Vec<f64> = (0..count).map(weight).collect();
            let mut values = vec![f32::NAN; blender.value_count()];
            blender.blend(&weights, &mut values)?;
            prop_assert_eq!(&values, &naive(&blender, &weights));
            let single: Vec<f32> = weights.iter().map(|weight| *weight as f32).collect();
            let mut again = vec![f32::NAN; blender.value_count()];
            blender.blend(&single, &mut again)?;
            prop_assert_eq!(values, again);
        }
    }

    #[test]
    fn a_unit_weight_returns_that_form_in_either_layout() {
        let shape = shape(4, 37);
        for layout in [FormLayout::Planar, FormLayout::Interleaved] {
            let blender = FormBlender::new(&shape, layout);
            let mut values = vec![0.0; blender.value_count()];
            blender.blend(&[0.0, 0.0, 1.0, 0.0], &mut values).expect("lengths");
            for (v, position) in shape.forms()[2].positions().iter().enumerate() {
                for k in 0..3 {
                    let at = if layout == FormLayout::Planar {
                        k * 37 + v
                    } else {
                        3 * v + k
                    };
                    assert_eq!(values[at], position[k] as f32);
                }
            }
        }
    }

    #[test]
    fn forms_are_edited_without_touching_others_and_mistakes_change_nothing() {
        let shape = shape(3, 20);
        let mut blender = FormBlender::new(&shape, FormLayout::Planar);
        let kept = blender.rows[2].numbers().as_ptr();
        blender.insert_form(&shape.forms()[0]).expect("a form");
        blender.replace_form(1, &shape.forms()[0]).expect("a form");
        blender.remove_form(0).expect("a form");
        assert_eq!((blender.form_count(), blender.rows[1].numbers().as_ptr()), (3, kept));
        assert_eq!(blender.rows[0].numbers(), blender.rows[2].numbers());
        let other = super::tests::shape(1, 19);
        assert!(blender.insert_form(&other.forms()[0]).is_err());
        assert!(blender.replace_form(3, &shape.forms()[0]).is_err() && blender.remove_form(3).is_err());
        let mut values = vec![0.0; blender.value_count()];
        assert!(blender.blend(&[1.0; 2], &mut values).is_err());
        assert!(blender.blend(&[1.0; 3], &mut values[1..]).is_err());
        assert_eq!(blender.form_count(), 3);
    }
}
