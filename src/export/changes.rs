//! What changed from one frame to the next, for formats that draw frames over one another.

use super::box_of;
use crate::render::Frame;

/// Remembers the last frame.
#[derive(Debug, Default)]
pub(super) struct Changes {
    last: Option<Vec<[u8; 4]>>,
}

/// The part of a frame that replaces the same part of the one before.
#[derive(Debug)]
pub(super) struct Change {
    pub(super) left: usize,
    pub(super) top: usize,
    /// At least one pixel, for no format knows an empty part.
    pub(super) part: Frame,
}

impl Changes {
    /// The part of `frame` that differs from the frame given before; the first time all of it. Its left and top are
    /// multiples of `grid`.
    pub(super) fn next(&mut self, frame: &Frame, grid: usize) -> Change {
        let [left, top, columns, rows] = match &self.last {
            None => [0, 0, frame.width, frame.height],
            Some(last) => {
                let differing = box_of(frame.width, frame.height, |i| frame.pixels[i] != last[i]);
                let [left, top, columns, rows] = differing.unwrap_or([0, 0, 1, 1]);
                let (x, y) = (left % grid, top % grid);
                [left - x, top - y, columns + x, rows + y]
            }
        };
        match &mut self.last {
            Some(last) => last.clone_from(&frame.pixels),
            last => *last = Some(frame.pixels.clone()),
        }
        Change {
            left,
            top,
            part: cut(frame, [left, top, columns, rows]),
        }
    }
}

/// The part of a frame inside a box of left, top, width and height.
pub(super) fn cut(frame: &Frame, [left, top, width, height]: [usize; 4]) -> Frame {
    let rows = frame.pixels[top * frame.width..].chunks(frame.width).take(height);
    Frame {
        width,
        height,
        pixels: rows.flat_map(|row| &row[left..left + width]).copied().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_differs_is_drawn() {
        let mut frame = Frame::filled(9, 7, [0; 4]);
        let mut changes = Changes::default();
        let first = changes.next(&frame, 2);
        assert_eq!((first.part.width, first.part.height), (9, 7));
        let same = changes.next(&frame, 2);
        assert_eq!((same.left, same.top, same.part.pixels.len()), (0, 0, 1));
        frame.pixels[3 * 9 + 5] = [1, 2, 3, 255];
        frame.pixels[5 * 9 + 7] = [4, 5, 6, 255];
        let next = changes.next(&frame, 2);
        assert_eq!((next.left, next.top, next.part.width, next.part.height), (4, 2, 4, 4));
        assert_eq!(next.part.pixels[4 + 1], [1, 2, 3, 255]);
        assert_eq!(next.part.pixels[3 * 4 + 3], [4, 5, 6, 255]);
    }
}
