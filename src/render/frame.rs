//! A finished picture.

/// A premultiplied RGBA picture.
#[derive(Clone, PartialEq, Eq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row, red, green, blue, alpha, colours multiplied by alpha; #rows x #columns entries.
    pub pixels: Vec<[u8; 4]>,
}

impl Frame {
    /// A picture of one colour: red, green, blue, alpha, not premultiplied.
    #[must_use]
    pub fn filled(width: usize, height: usize, colour: [u8; 4]) -> Self {
        Self {
            width,
            height,
            pixels: vec![premultiplied(colour); width * height],
        }
    }

    /// The pixels with colours not multiplied by alpha, as most file formats store them.
    #[must_use]
    pub fn straight(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.pixels.len() * 4);
        for [r, g, b, a] in &self.pixels {
            let divided = |c: u8| match *a {
                0 => 0,
                255 => c,
                a => ((u32::from(c) * 255 + u32::from(a) / 2) / u32::from(a)).min(255) as u8,
            };
            bytes.extend([divided(*r), divided(*g), divided(*b), *a]);
        }
        bytes
    }

    /// Puts another picture of the same size in front of this one, seen to the part `opacity`, from 0 to 1.
    pub fn put_over(&mut self, front: &Self, opacity: f64) {
        let opacity = opacity.clamp(0.0, 1.0) as f32;
        for (below, above) in self.pixels.iter_mut().zip(&front.pixels) {
            if above[3] == 0 {
                continue;
            }
            let through = 1.0 - opacity * f32::from(above[3]) / 255.0;
            for (b, a) in below.iter_mut().zip(above) {
                *b = (f32::from(*a) * opacity + f32::from(*b) * through + 0.5).min(255.0) as u8;
            }
        }
    }

    /// Puts the picture in front of a colour: red, green, blue, alpha, not premultiplied.
    pub fn put_before(&mut self, colour: [u8; 4]) {
        let back = premultiplied(colour);
        for pixel in &mut self.pixels {
            let through = 255 - u32::from(pixel[3]);
            for (front, behind) in pixel.iter_mut().zip(back) {
                *front = (u32::from(*front) + (u32::from(behind) * through + 127) / 255).min(255) as u8;
            }
        }
    }
}

impl std::fmt::Debug for Frame {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Frame")
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let times = |c: u8| ((u32::from(c) * u32::from(a) + 127) / 255) as u8;
    [times(r), times(g), times(b), a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_undoes_premultiplied() {
        let frame = Frame::filled(1, 1, [200, 100, 0, 128]);
        assert_eq!(frame.pixels[0], [100, 50, 0, 128]);
        assert_eq!(frame.straight(), [199, 100, 0, 128]);
        assert_eq!(Frame::filled(1, 1, [9, 9, 9, 0]).straight(), [0, 0, 0, 0]);
    }

    #[test]
    fn a_half_clear_pixel_lets_half_through() {
        let mut frame = Frame::filled(1, 1, [255, 0, 0, 128]);
        frame.put_before([255, 255, 255, 255]);
        assert_eq!(frame.pixels[0], [255, 127, 127, 255]);
    }
}
