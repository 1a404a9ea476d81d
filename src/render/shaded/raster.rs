//! Which triangle is nearest, at every sample.

use crate::math::Point3;

/// What a sample shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    pub(super) triangle: usize,
    /// How much of each corner, summing to 1.
    pub(super) shares: [f64; 3],
}

/// The nearest triangle a sample.
pub(super) struct DepthBuffer {
    width: usize,
    hits: Vec<Option<Hit>>,
}

impl DepthBuffer {
    pub(super) fn at(&self, x: usize, y: usize) -> Option<Hit> {
        self.hits[y * self.width + x]
    }
}

/// The nearest triangle at the middle of every sample; `places` are x and y in samples, z towards the eye.
pub(super) fn nearest(triangles: &[[usize; 3]], places: &[Point3], [width, height]: [usize; 2]) -> DepthBuffer {
    let mut hits = vec![None; width * height];
    let mut depths = vec![f64::NEG_INFINITY; width * height];
    for (triangle, corners) in triangles.iter().enumerate() {
        let found = corners.map(|v| places.get(v).filter(|p| p.iter().all(|x| x.is_finite())));
        let [Some(a), Some(b), Some(c)] = found else { continue };
        let area = cross(b - a, c - a);
        if area == 0.0 {
            continue;
        }
        // Middles of samples are at halves.
        let range = |values: [f64; 3], count: usize| {
            let low = values.into_iter().fold(f64::INFINITY, f64::min) - 0.5;
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max) - 0.5;
            (low.ceil().max(0.0) as usize)..((high.floor() + 1.0).clamp(0.0, count as f64) as usize)
        };
        for y in range([a.y, b.y, c.y], height) {
            for x in range([a.x, b.x, c.x], width) {
                let p = Point3::new(x as f64 + 0.5, y as f64 + 0.5, 0.0);
                let shares = [cross(b - p, c - p), cross(c - p, a - p), cross(a - p, b - p)].map(|part| part / area);
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let depth = shares[0] * a.z + shares[1] * b.z + shares[2] * c.z;
                let sample = y * width + x;
                if depth > depths[sample] {
                    depths[sample] = depth;
                    hits[sample] = Some(Hit { triangle, shares });
                }
            }
        }
    }
    DepthBuffer { width, hits }
}

fn cross(a: Point3, b: Point3) -> f64 {
    a.x * b.y - a.y * b.x
}
