//! A texture, halved as often as the form's size in the picture asks for.

use super::ShadedMesh;
use super::light::linear;
use crate::math::Point3;
use crate::render::Frame;

/// Texels that one sample may skip: beyond, the texture is halved.
const TEXELS_A_SAMPLE: f64 = 1.5;

/// Colours in linear light, each channel from 0 to 1.
pub(super) struct Mip {
    width: usize,
    height: usize,
    texels: Vec<[f64; 3]>,
}

impl Mip {
    /// The texture for a form whose vertices lie at `places`, in samples. `None` if it has no pixels.
    pub(super) fn new(texture: &Frame, mesh: &ShadedMesh<'_>, places: &[Point3]) -> Option<Self> {
        if texture.pixels.is_empty() || texture.width == 0 {
            return None;
        }
        let straight = texture.straight();
        let texels = straight.as_chunks::<4>().0.iter();
        let mut mip = Self {
            width: texture.width,
            height: texture.height,
            texels: texels.map(|&[r, g, b, _]| [r, g, b].map(linear)).collect(),
        };
        let mut density = mip.texels_a_sample(mesh, places);
        while density > TEXELS_A_SAMPLE && mip.width.min(mip.height) > 1 {
            mip = mip.halved();
            density /= 2.0;
        }
        Some(mip)
    }

    /// How many texels lie along a sample's side, in the mean over the form.
    fn texels_a_sample(&self, mesh: &ShadedMesh<'_>, places: &[Point3]) -> f64 {
        let (mut texels, mut samples) = (0.0, 0.0);
        for (corners, on_texture) in mesh.triangles.iter().zip(mesh.texture_triangles) {
            let [Some(a), Some(b), Some(c)] = corners.map(|v| places.get(v)) else {
                continue;
            };
            let [Some(d), Some(e), Some(f)] = on_texture.map(|k| mesh.texture_places.get(k)) else {
                continue;
            };
            samples += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).abs();
            let area = ((e[0] - d[0]) * (f[1] - d[1]) - (e[1] - d[1]) * (f[0] - d[0])).abs();
            texels += area * (self.width * self.height) as f64;
        }
        let density = (texels / samples).sqrt();
        if density.is_finite() { density } else { 1.0 }
    }

    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let texel = |k: usize| {
            let (x, y) = (2 * (k % width), 2 * (k / width));
            let (right, below) = ((x + 1).min(self.width - 1), (y + 1).min(self.height - 1));
            let four = [(x, y), (right, y), (x, below), (right, below)].map(|(x, y)| self.texels[y * self.width + x]);
            std::array::from_fn(|channel| four.iter().map(|texel| texel[channel]).sum::<f64>() / 4.0)
        };
        Self {
            width,
            height,
            texels: (0..width * height).map(texel).collect(),
        }
    }

    /// The colour at a point of a triangle, between the middles of the four texels around it. The texture repeats.
    pub(super) fn light_at(&self, mesh: &ShadedMesh<'_>, triangle: usize, shares: [f64; 3]) -> [f64; 3] {
        let corners = mesh.texture_triangles[triangle];
        let place = |axis: usize| -> f64 {
            let corner = |k: usize| mesh.texture_places.get(corners[k]).map_or(0.0, |place| place[axis]);
            (0..3).map(|k| corner(k) * shares[k]).sum()
        };
        // Texture places are counted from the bottom, rows from the top.
        let (left, x) = whole_and_part(place(0) * self.width as f64 - 0.5, self.width);
        let (top, y) = whole_and_part((1.0 - place(1)) * self.height as f64 - 0.5, self.height);
        let (right, below) = ((left + 1) % self.width, (top + 1) % self.height);
        let [a, b, c, d] =
            [(left, top), (right, top), (left, below), (right, below)].map(|(x, y)| self.texels[y * self.width + x]);
        std::array::from_fn(|k| (a[k] * (1.0 - x) + b[k] * x) * (1.0 - y) + (c[k] * (1.0 - x) + d[k] * x) * y)
    }
}

/// The texel before a place, and how far behind it the place is.
fn whole_and_part(at: f64, count: usize) -> (usize, f64) {
    let whole = at.floor();
    ((whole.rem_euclid(count as f64) as usize).min(count - 1), at - whole)
}
