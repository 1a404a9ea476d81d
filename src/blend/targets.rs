//! What every triangle wants to be at given weights: `A(w) = R(sum w_i alpha_i) S(w)`, block by block.
//!
//! The poses' angles and stretches are kept in the order in which a frame reads them, [`LANES`] triangles of one pose
//! after the other, so that memory is read once and in a straight line, and each step is one instruction for several
//! triangles. 32 bytes a triangle and pose.

use super::Stretch;
use super::maps::TriangleMaps;
use super::stretch::{self, StretchRange};
use crate::math::sine::{LANES, Lanes, sines_and_cosines};

/// What the triangles of a block want: the four entries of a 2 x 2 matrix each, by rows.
pub(super) type BlockMaps = [Lanes; 4];

/// Which triangle is where: block `k` holds triangles `k`, `k + #blocks`, `k + 2 #blocks` and so on. Triangles that follow
/// one another in a mesh share vertices; in a block they would wait for one another's sums.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blocks {
    count: usize,
}

impl Blocks {
    /// For this many triangles.
    pub(super) fn of(triangle_count: usize) -> Self {
        Self {
            count: triangle_count.div_ceil(LANES),
        }
    }

    /// How many blocks.
    pub(super) fn count(self) -> usize {
        self.count
    }

    /// The block and the lane of a triangle.
    pub(super) fn place(self, triangle: usize) -> (usize, usize) {
        (triangle % self.count, triangle / self.count)
    }
}

/// What the poses say about all triangles.
#[derive(Debug, Clone)]
pub(super) struct Targets {
    pose_count: usize,
    layout: Blocks,
    stretch: Stretch,
    /// #blocks x #poses: angle, and the three entries of the stretch or of its logarithm.
    blocks: Vec<[Lanes; 4]>,
    /// By block and lane, if anything is limited.
    ranges: Vec<StretchRange>,
}

impl Targets {
    /// Sorts `maps` into blocks. `limits` by triangle, infinite where there is none.
    pub(super) fn new(maps: &TriangleMaps, stretch: Stretch, limits: &[f64]) -> Self {
        let pose_count = maps.poses.len();
        let triangle_count = limits.len();
        let layout = Blocks::of(triangle_count);
        let mut blocks = vec![[[0.0; LANES]; 4]; layout.count() * pose_count];
        for triangle in 0..triangle_count {
            let (block, lane) = layout.place(triangle);
            for (pose, of_pose) in maps.poses.iter().enumerate() {
                let [angle_rad, a, b, c] = &mut blocks[block * pose_count + pose];
                angle_rad[lane] = of_pose.angles_rad[triangle];
                [a[lane], b[lane], c[lane]] = maps.blendable(pose, triangle, stretch);
            }
        }
        let mut ranges = Vec::new();
        if limits.iter().any(|limit| limit.is_finite()) {
            ranges = vec![StretchRange::ALL; layout.count() * LANES];
            for (triangle, &limit) in limits.iter().enumerate() {
                let (block, lane) = layout.place(triangle);
                ranges[block * LANES + lane] =
                    StretchRange::around(maps.poses.iter().map(|pose| pose.stretches[triangle]), limit);
            }
        }
        Self {
            pose_count,
            layout,
            stretch,
            blocks,
            ranges,
        }
    }

    /// The rotation of `triangle` in `pose`.
    pub(super) fn angle_rad(&self, triangle: usize, pose: usize) -> f64 {
        let (block, lane) = self.layout.place(triangle);
        self.blocks[block * self.pose_count + pose][0][lane]
    }

    /// What the triangles of `block` want. Triangles past the last get something finite.
    #[inline(always)]
    pub(super) fn block(&self, block: usize, weights: &[f64], stretch_weights: &[f64], maps: &mut BlockMaps) {
        let poses = &self.blocks[block * self.pose_count..(block + 1) * self.pose_count];
        let [angle_rad, a, b, c] = &mut combination(poses, weights, stretch_weights);
        if self.stretch == Stretch::Log {
            each(a, b, c, stretch::exponential);
        }
        if let Some(ranges) = self.ranges.get(block * LANES..(block + 1) * LANES) {
            let mut ranges = ranges.iter();
            each(a, b, c, |entries| {
                ranges.next().map_or(entries, |range| range.clamp(entries))
            });
        }
        let (mut sine, mut cosine) = ([0.0; LANES], [0.0; LANES]);
        sines_and_cosines(angle_rad, &mut sine, &mut cosine);
        let [m11, m12, m21, m22] = maps;
        for lane in 0..LANES {
            let (s, c_angle) = (sine[lane], cosine[lane]);
            m11[lane] = c_angle * a[lane] - s * b[lane];
            m12[lane] = c_angle * b[lane] - s * c[lane];
            m21[lane] = s * a[lane] + c_angle * b[lane];
            m22[lane] = s * b[lane] + c_angle * c[lane];
        }
    }
}

/// The weighted sums of angles and stretches over the poses. Poses are taken two at a time: half as often are sums read
/// and written.
#[inline(always)]
fn combination(poses: &[[Lanes; 4]], weights: &[f64], stretch_weights: &[f64]) -> [Lanes; 4] {
    let mut sums = [[0.0; LANES]; 4];
    let mut pairs = poses.chunks_exact(2);
    let mut pose = 0;
    for pair in &mut pairs {
        for (part, sum) in sums.iter_mut().enumerate() {
            let of_part = if part == 0 { weights } else { stretch_weights };
            let (first, second) = (of_part[pose], of_part[pose + 1]);
            for ((sum, a), b) in sum.iter_mut().zip(&pair[0][part]).zip(&pair[1][part]) {
                *sum += first * a + second * b;
            }
        }
        pose += 2;
    }
    for last in pairs.remainder() {
        for (part, sum) in sums.iter_mut().enumerate() {
            let weight = if part == 0 {
                weights[pose]
            } else {
                stretch_weights[pose]
            };
            for (sum, value) in sum.iter_mut().zip(&last[part]) {
                *sum += weight * value;
            }
        }
    }
    sums
}

/// Replaces the symmetric matrix of every lane.
#[inline(always)]
fn each(a: &mut Lanes, b: &mut Lanes, c: &mut Lanes, mut change: impl FnMut(stretch::Symmetric) -> stretch::Symmetric) {
    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
        [*a, *b, *c] = change([*a, *b, *c]);
    }
}
