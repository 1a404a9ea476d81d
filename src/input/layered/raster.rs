//! Pixels of one layer, and of several composed.

/// The rectangle of pixels that is read: the canvas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CanvasSize {
    /// Columns.
    pub(super) width: usize,
    /// Rows.
    pub(super) height: usize,
}

/// A rectangle of the canvas: columns and rows from a first one to before an end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) right: usize,
    pub(super) bottom: usize,
}

impl Area {
    pub(super) fn width(&self) -> usize {
        self.right - self.left
    }

    pub(super) fn height(&self) -> usize {
        self.bottom - self.top
    }
}

impl CanvasSize {
    /// What of a rectangle, of which any part may lie outside, is on the canvas; `None` if nothing is.
    pub(super) fn area(self, left: i64, top: i64, width: usize, height: usize) -> Option<Area> {
        let on = |low: i64, length: usize, side: usize| -> Option<(usize, usize)> {
            let high = low.saturating_add(i64::try_from(length).ok()?);
            let first = usize::try_from(low.max(0)).ok()?;
            let end = usize::try_from(high.max(0)).ok()?.min(side);
            (first < end).then_some((first, end))
        };
        let ((left, right), (top, bottom)) = (on(left, width, self.width)?, on(top, height, self.height)?);
        Some(Area {
            left,
            top,
            right,
            bottom,
        })
    }

    pub(super) fn count(self) -> usize {
        self.width * self.height
    }
}

/// A layer's pixels, as far as they are on the canvas: straight red, green, blue and alpha, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) area: Area,
    pub(super) pixels: Vec<[u8; 4]>,
    /// From 0 to [`u16::MAX`].
    pub(super) opacity: u16,
}

/// How much of a layer a mask lets through, from 0 to 255, in an area of the canvas and everywhere else.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mask {
    pub(super) inside: Option<(Area, Vec<u8>)>,
    pub(super) outside: u8,
}

impl Mask {
    fn at(&self, x: usize, y: usize) -> u8 {
        match &self.inside {
            Some((area, values)) if (area.left..area.right).contains(&x) && (area.top..area.bottom).contains(&y) => {
                values[(y - area.top) * area.width() + x - area.left]
            }
            _ => self.outside,
        }
    }
}

/// Copies the part of a rectangle of pixels that is on the canvas. `left` and `top` say where the rectangle lies.
pub(super) fn cropped<T: Copy>(pixels: &[T], width: usize, [left, top]: [i64; 2], area: Area) -> Vec<T> {
    let offset = |place: usize, low: i64| usize::try_from(place as i64 - low).unwrap_or(0);
    let (x, y) = (offset(area.left, left), offset(area.top, top));
    let rows = pixels.chunks_exact(width.max(1)).skip(y).take(area.height());
    rows.flat_map(|row| row[x..x + area.width()].iter().copied()).collect()
}

/// What 1 is in composed pixels. Eight bits of colour times eight of alpha fit, so that pixels of one layer come out as they went in.
const ONE: u32 = u16::MAX as u32;

/// The product of two numbers of which [`ONE`] means 1, rounded.
fn times(a: u16, b: u16) -> u16 {
    ((u32::from(a) * u32::from(b) + ONE / 2) / ONE) as u16
}

fn from_byte(byte: u8) -> u16 {
    u16::from(byte) * 257
}

/// How what is drawn meets what is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Placing {
    /// Over it, and beside it.
    Over,
    /// Only where it is, as opaque as that.
    Atop,
}

/// How one picture is drawn onto another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn<'a> {
    /// From 0 to [`u16::MAX`].
    pub(super) opacity: u16,
    pub(super) mask: Option<&'a Mask>,
    pub(super) blend: super::BlendMode,
    pub(super) placing: Placing,
}

/// Composed pixels of the whole canvas: red, green, blue and alpha, colours multiplied by alpha.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    canvas: CanvasSize,
    pixels: Vec<[u16; 4]>,
}

impl Sheet {
    pub(super) fn clear(canvas: CanvasSize) -> Self {
        Self {
            canvas,
            pixels: vec![[0; 4]; canvas.count()],
        }
    }

    /// Draws a layer.
    pub(super) fn draw_tile(&mut self, tile: &Tile, how: Drawn<'_>) {
        let opacity = times(how.opacity, tile.opacity);
        let how = Drawn { opacity, ..how };
        let rows = tile.pixels.chunks_exact(tile.area.width().max(1));
        for (y, row) in (tile.area.top..tile.area.bottom).zip(rows) {
            for (x, &[red, green, blue, alpha]) in (tile.area.left..).zip(row) {
                if alpha == 0 {
                    continue;
                }
                let alpha = from_byte(alpha);
                let [red, green, blue] = [red, green, blue].map(|colour| times(from_byte(colour), alpha));
                self.draw_pixel(x, y, [red, green, blue, alpha], how);
            }
        }
    }

    /// Draws composed pixels.
    pub(super) fn draw_sheet(&mut self, sheet: &Self, how: Drawn<'_>) {
        for (y, row) in sheet.pixels.chunks_exact(sheet.canvas.width.max(1)).enumerate() {
            for (x, &pixel) in row.iter().enumerate() {
                if pixel[3] > 0 {
                    self.draw_pixel(x, y, pixel, how);
                }
            }
        }
    }

    /// Compositing and blending, level 1 (W3C), sections 5 and 9, of colours as they are stored.
    fn draw_pixel(&mut self, x: usize, y: usize, pixel: [u16; 4], how: Drawn<'_>) {
        let share = match how.mask {
            None => how.opacity,
            Some(mask) => times(how.opacity, from_byte(mask.at(x, y))),
        };
        let source = if share == u16::MAX {
            pixel
        } else {
            pixel.map(|part| times(part, share))
        };
        let behind = &mut self.pixels[y * self.canvas.width + x];
        let (source_alpha, behind_alpha) = (source[3], behind[3]);
        let left = u16::MAX - source_alpha;
        for k in 0..3 {
            let beside = match how.blend {
                super::BlendMode::Normal => 0,
                super::BlendMode::Multiply => times(source[k], u16::MAX - behind_alpha),
            };
            let on = match how.blend {
                super::BlendMode::Normal => source[k],
                super::BlendMode::Multiply => times(source[k], behind[k]),
            };
            let added = match (how.placing, how.blend) {
                (Placing::Over, _) => on.saturating_add(beside),
                (Placing::Atop, super::BlendMode::Normal) => times(on, behind_alpha),
                (Placing::Atop, super::BlendMode::Multiply) => on,
            };
            behind[k] = times(behind[k], left).saturating_add(added);
        }
        if how.placing == Placing::Over {
            behind[3] = times(behind_alpha, left).saturating_add(source_alpha);
        }
    }

    /// Weakens everything by an opacity and a mask.
    pub(super) fn fade(&mut self, opacity: u16, mask: Option<&Mask>) {
        if opacity == u16::MAX && mask.is_none() {
            return;
        }
        for (y, row) in self.pixels.chunks_exact_mut(self.canvas.width.max(1)).enumerate() {
            for (x, pixel) in row.iter_mut().enumerate() {
                let share = mask.map_or(opacity, |mask| times(opacity, from_byte(mask.at(x, y))));
                *pixel = pixel.map(|part| times(part, share));
            }
        }
    }

    /// Keeps as much of everything as `other` is opaque there.
    pub(super) fn cut_by(&mut self, other: &Self) {
        for (pixel, by) in self.pixels.iter_mut().zip(&other.pixels) {
            *pixel = pixel.map(|part| times(part, by[3]));
        }
    }

    /// Goes from `before` to itself by an opacity and a mask.
    pub(super) fn mix_with(&mut self, before: &Self, opacity: u16, mask: Option<&Mask>) {
        let rows = self.pixels.chunks_exact_mut(self.canvas.width.max(1));
        let before = before.pixels.chunks_exact(self.canvas.width.max(1));
        for (y, (row, before)) in rows.zip(before).enumerate() {
            for (x, (pixel, before)) in row.iter_mut().zip(before).enumerate() {
                let share = mask.map_or(opacity, |mask| times(opacity, from_byte(mask.at(x, y))));
                for (part, before) in pixel.iter_mut().zip(before) {
                    *part = times(*part, share).saturating_add(times(*before, u16::MAX - share));
                }
            }
        }
    }

    /// Straight pixels of eight bits, row by row, four bytes each; `None` if nothing is drawn.
    pub(super) fn into_straight(self) -> Option<Vec<u8>> {
        let mut is_drawn = false;
        let mut bytes = Vec::with_capacity(self.pixels.len() * 4);
        for [red, green, blue, alpha] in self.pixels {
            let byte_alpha = ((u32::from(alpha) + 128) / 257) as u8;
            is_drawn |= byte_alpha > 0;
            let straight = |colour: u16| match u32::from(alpha) {
                0 => 0,
                alpha => ((u32::from(colour) * 255 + alpha / 2) / alpha).min(255) as u8,
            };
            bytes.extend([straight(red), straight(green), straight(blue), byte_alpha]);
        }
        is_drawn.then_some(bytes)
    }
}

/// An opacity from 0 to 1 as composed pixels have it.
pub(super) fn opacity_of(opacity: f64) -> u16 {
    (opacity.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16
}

#[cfg(test)]
mod tests {
    use super::super::BlendMode;
    use super::*;

    const CANVAS: CanvasSize = CanvasSize { width: 3, height: 2 };
    const PLAIN: Drawn<'_> = Drawn {
        opacity: u16::MAX,
        mask: None,
        blend: BlendMode::Normal,
        placing: Placing::Over,
    };

    /// A layer of one colour on the whole canvas.
    fn plain(pixel: [u8; 4]) -> Tile {
        Tile {
            area: Area {
                left: 0,
                top: 0,
                right: 3,
                bottom: 2,
            },
            pixels: vec![pixel; 6],
            opacity: u16::MAX,
        }
    }

    fn first(sheet: Sheet) -> Option<[u8; 4]> {
        sheet.into_straight().and_then(|bytes| bytes.first_chunk().copied())
    }

    #[test]
    fn a_single_layer_comes_out_as_it_went_in() {
        for alpha in 1..=255 {
            for colour in 0..=255 {
                let mut sheet = Sheet::clear(CANVAS);
                let pixel = [colour, 255 - colour, colour / 2, alpha];
                sheet.draw_tile(&plain(pixel), PLAIN);
                assert_eq!(first(sheet), Some(pixel));
            }
        }
        assert_eq!(first(Sheet::clear(CANVAS)), None);
    }

    #[test]
    fn colours_meet_as_the_formulas_say() {
        let cases = [
            // Half of white over black.
            (PLAIN, [255, 255, 255, 128], [128, 128, 128, 255]),
            (
                Drawn {
                    blend: BlendMode::Multiply,
                    ..PLAIN
                },
                [128, 255, 0, 255],
                [0, 0, 0, 255],
            ),
        ];
        for (how, upper, expected) in cases {
            let mut sheet = Sheet::clear(CANVAS);
            sheet.draw_tile(&plain([0, 0, 0, 255]), PLAIN);
            sheet.draw_tile(&plain(upper), how);
            assert_eq!(first(sheet), Some(expected));
        }
        let multiplied = |behind: [u8; 4], upper: [u8; 4], placing| {
            let mut sheet = Sheet::clear(CANVAS);
            sheet.draw_tile(&plain(behind), PLAIN);
            let blend = BlendMode::Multiply;
            sheet.draw_tile(
                &plain(upper),
                Drawn {
                    blend,
                    placing,
                    ..PLAIN
                },
            );
            first(sheet)
        };
        let grey = [200, 100, 255, 255];
        assert_eq!(
            multiplied(grey, [128, 128, 128, 255], Placing::Over),
            Some([100, 50, 128, 255])
        );
        // Nothing behind it: its own colour.
        assert_eq!(
            multiplied([0; 4], [9, 99, 199, 255], Placing::Over),
            Some([9, 99, 199, 255])
        );
        assert_eq!(multiplied([0; 4], [9, 99, 199, 255], Placing::Atop), None);
    }

    #[test]
    fn what_is_cut_off_keeps_the_alpha_behind_it() {
        let mut sheet = Sheet::clear(CANVAS);
        sheet.draw_tile(&plain([0, 0, 0, 100]), PLAIN);
        let placing = Placing::Atop;
        sheet.draw_tile(&plain([255, 0, 0, 255]), Drawn { placing, ..PLAIN });
        assert_eq!(first(sheet), Some([255, 0, 0, 100]));
    }

    #[test]
    fn masks_hold_inside_and_outside_of_their_area() {
        let area = Area {
            left: 0,
            top: 0,
            right: 1,
            bottom: 1,
        };
        let mask = Mask {
            inside: Some((area, vec![51])),
            outside: 255,
        };
        let mut sheet = Sheet::clear(CANVAS);
        let mask = Some(&mask);
        sheet.draw_tile(&plain([7, 8, 9, 255]), Drawn { mask, ..PLAIN });
        let bytes = sheet.into_straight().unwrap_or_default();
        assert_eq!(bytes[..8], [7, 8, 9, 51, 7, 8, 9, 255]);
    }

    #[test]
    fn only_what_is_on_the_canvas_is_kept() {
        assert_eq!(CANVAS.area(-5, 0, 5, 1), None);
        assert_eq!(CANVAS.area(i64::MAX, 0, 5, 1), None);
        let area = CANVAS.area(-1, 1, 3, 9).unwrap_or(Area {
            left: 0,
            top: 0,
            right: 0,
            bottom: 0,
        });
        assert_eq!((area.left, area.right, area.top, area.bottom), (0, 2, 1, 2));
        let pixels: Vec<u8> = (0..27).collect();
        assert_eq!(cropped(&pixels, 3, [-1, 1], area), [1, 2]);
    }
}
