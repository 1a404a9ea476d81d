//! CIELAB (CIE 1976, D65) of sRGB colours.

/// The white point D65 of the 2 degree observer, in XYZ.
const WHITE: [f32; 3] = [0.950_47, 1.0, 1.088_83];

/// Shares of the range of a component at which the transfer function is tabulated.
const TABLE: usize = 1024;

/// sRGB to CIELAB, with a table of the transfer function.
pub(super) struct Lab {
    linear: Vec<f32>,
}

impl Lab {
    pub(super) fn new() -> Self {
        Self {
            linear: (0..=TABLE + 1).map(|k| linear(k as f32 / TABLE as f32)).collect(),
        }
    }

    /// Lightness in 0..100 and the two colour axes of an sRGB colour whose components are in 0..1.
    pub(super) fn of(&self, colour: [f32; 3]) -> [f32; 3] {
        lab(colour.map(|c| {
            let place = c * TABLE as f32;
            let before = (place as usize).min(TABLE);
            let (a, b) = (self.linear[before], self.linear[before + 1]);
            a + (place - before as f32) * (b - a)
        }))
    }
}

/// Lightness and the colour axes of linear components.
fn lab([r, g, b]: [f32; 3]) -> [f32; 3] {
    let x = 0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b;
    let y = 0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b;
    let z = 0.019_333_9 * r + 0.119_192 * g + 0.950_304_1 * b;
    let [x, y, z] = [x / WHITE[0], y / WHITE[1], z / WHITE[2]].map(response);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The transfer function of sRGB, inverted.
fn linear(c: f32) -> f32 {
    if c <= 0.040_45 {
        c / 12.92
    } else {
        libm::powf((c + 0.055) / 1.055, 2.4)
    }
}

/// The cube root, with the straight piece near black that CIELAB has.
fn response(t: f32) -> f32 {
    const KNEE: f32 = 6.0 / 29.0;
    if t > KNEE * KNEE * KNEE {
        libm::cbrtf(t)
    } else {
        t / (3.0 * KNEE * KNEE) + 4.0 / 29.0
    }
}

#[cfg(test)]
mod tests {
    use super::Lab;

    #[test]
    fn white_black_and_red_have_their_published_coordinates() {
        let lab = |colour: [f32; 3]| Lab::new().of(colour);
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.1);
        assert!(near(lab([1.0; 3]), [100.0, 0.0, 0.0]), "{:?}", lab([1.0; 3]));
        assert!(near(lab([0.0; 3]), [0.0, 0.0, 0.0]));
        // Lindbloom's calculator gives (53.24, 80.09, 67.20) for sRGB red.
        assert!(
            near(lab([1.0, 0.0, 0.0]), [53.24, 80.09, 67.20]),
            "{:?}",
            lab([1.0, 0.0, 0.0])
        );
    }
}
