//! The channels of a PSD file's layers, decoded as far as they are on the canvas.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::records::Version;
use crate::input::layered::raster::Area;
use crate::input::layered::{Bytes, CanvasSize, LayeredError};

/// The longest side of a layer: what PSB files may have.
const LONGEST_SIDE: i64 = 300_000;

/// How many bits a value has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Depth {
    Eight,
    Sixteen,
}

impl Depth {
    fn bytes(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Sixteen => 2,
        }
    }
}

/// Where something lies; any part of it may be outside of the canvas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rectangle {
    left: i64,
    top: i64,
    width: usize,
    height: usize,
}

impl Rectangle {
    pub(super) fn whole(canvas: CanvasSize) -> Self {
        Self {
            left: 0,
            top: 0,
            width: canvas.width,
            height: canvas.height,
        }
    }

    /// Top, left, bottom and right.
    pub(super) fn read(bytes: &mut Bytes<'_>) -> Result<Self, LayeredError> {
        let (top, left) = (i64::from(bytes.be_i32()?), i64::from(bytes.be_i32()?));
        let (bottom, right) = (i64::from(bytes.be_i32()?), i64::from(bytes.be_i32()?));
        let side = |low: i64, high: i64| -> Result<usize, LayeredError> {
            let length = (high - low).max(0);
            if length > LONGEST_SIDE {
                return Err(LayeredError::damaged(format!(
                    "a layer or mask is {length} pixels long"
                )));
            }
            Ok(usize::try_from(length).unwrap_or(0))
        };
        Ok(Self {
            left,
            top,
            width: side(left, right)?,
            height: side(top, bottom)?,
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    pub(super) fn on(&self, canvas: CanvasSize) -> Option<Area> {
        canvas.area(self.left, self.top, self.width, self.height)
    }

    /// How many pixels are decoded for an area of it: whole rows, and with a compressed stream all above it.
    pub(super) fn cost(&self, area: Area) -> u64 {
        let last = usize::try_from(area.bottom as i64 - self.top).unwrap_or(self.height);
        self.width as u64 * last as u64
    }
}

/// The bytes of a channel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Channel<'a> {
    /// How its rows are stored; `None` where the first two bytes of `bytes` say it.
    compression: Option<u16>,
    /// Where its rows begin, and where the lengths of its rows are.
    bytes: &'a [u8],
    /// The lengths of rows, where they do not stand before them.
    row_lengths: Option<&'a [u8]>,
}

impl<'a> Channel<'a> {
    /// The channel of a layer.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            compression: None,
            bytes,
            row_lengths: None,
        }
    }

    /// Gives `take` the values, from 0 to 255, of each row of `area`, which lies in `rectangle`.
    ///
    /// # Errors
    /// If they are cut off, or are not stored in a known way.
    pub(super) fn rows(
        &self,
        rectangle: &Rectangle,
        area: Area,
        depth: Depth,
        version: Version,
        mut take: impl FnMut(&[u8]),
    ) -> Result<(), LayeredError> {
        const WHAT: &str = "a channel's rows";
        let mut bytes = Bytes::new(self.bytes, WHAT);
        let compression = match self.compression {
            Some(known) => known,
            None => bytes.be_u16()?,
        };
        let row_bytes = rectangle.width * depth.bytes();
        let offset = |place: usize, low: i64| usize::try_from(place as i64 - low).unwrap_or(0);
        let (first, count) = (offset(area.top, rectangle.top), area.height());
        let start = offset(area.left, rectangle.left);
        let mut values = Vec::with_capacity(area.width());
        let mut handed = |row: &[u8]| {
            values.clear();
            let within = row.chunks_exact(depth.bytes()).skip(start).take(area.width());
            values.extend(within.map(|value| match *value {
                [high, low] => rounded(u16::from_be_bytes([high, low])),
                [value, ..] => value,
                [] => 0,
            }));
            take(&values);
        };
        match compression {
            0 => {
                bytes.take(first.saturating_mul(row_bytes))?;
                for _ in 0..count {
                    handed(bytes.take(row_bytes)?);
                }
            }
            1 => {
                let length_bytes = length_bytes(version);
                let table = match self.row_lengths {
                    Some(table) => table,
                    None => bytes.take(rectangle.height * length_bytes)?,
                };
                let mut row = vec![0; row_bytes];
                for (k, length) in table.chunks_exact(length_bytes).take(first + count).enumerate() {
                    let length = length.iter().fold(0, |sum, byte| sum << 8 | usize::from(*byte));
                    let packed = bytes.take(length)?;
                    if k >= first {
                        unpack(packed, &mut row)?;
                        handed(&row);
                    }
                }
            }
            2 | 3 => {
                let mut stream = ZlibDecoder::new(bytes.rest());
                let mut row = vec![0; row_bytes];
                for k in 0..first + count {
                    stream
                        .read_exact(&mut row)
                        .map_err(|_| LayeredError::CutOff { what: WHAT })?;
                    if compression == 3 {
                        sum_up(&mut row, depth);
                    }
                    if k >= first {
                        handed(&row);
                    }
                }
            }
            other => {
                return Err(LayeredError::damaged(format!(
                    "a channel is compressed in an unknown way, {other}"
                )));
            }
        }
        Ok(())
    }
}

/// How many bytes the length of a row has.
fn length_bytes(version: Version) -> usize {
    match version {
        Version::Small => 2,
        Version::Large => 4,
    }
}

/// Sixteen bits to eight.
fn rounded(value: u16) -> u8 {
    ((u32::from(value) * 255 + 32_767) / 65_535) as u8
}

/// PackBits: a count and as many bytes, or a negative count and a byte that is repeated. What a row lacks stays from the row before it, which is refused.
fn unpack(packed: &[u8], row: &mut [u8]) -> Result<(), LayeredError> {
    let damaged = || LayeredError::damaged("a row of a channel does not have as many values as it should");
    let (mut at, mut filled) = (0, 0);
    while filled < row.len() {
        let count = packed.get(at).copied().ok_or_else(damaged)?;
        at += 1;
        match count {
            0..=127 => {
                let count = usize::from(count) + 1;
                let from = packed.get(at..at + count).ok_or_else(damaged)?;
                let to = row.get_mut(filled..filled + count).ok_or_else(damaged)?;
                to.copy_from_slice(from);
                (at, filled) = (at + count, filled + count);
            }
            // Nothing, by definition.
            128 => {}
            129..=255 => {
                let count = 257 - usize::from(count);
                let value = packed.get(at).copied().ok_or_else(damaged)?;
                row.get_mut(filled..filled + count).ok_or_else(damaged)?.fill(value);
                (at, filled) = (at + 1, filled + count);
            }
        }
    }
    Ok(())
}

/// Differences of neighbours to values.
fn sum_up(row: &mut [u8], depth: Depth) {
    match depth {
        Depth::Eight => {
            let mut sum = 0_u8;
            for value in row {
                sum = sum.wrapping_add(*value);
                *value = sum;
            }
        }
        Depth::Sixteen => {
            let mut sum = 0_u16;
            for pair in row.chunks_exact_mut(2) {
                sum = sum.wrapping_add(u16::from_be_bytes([pair[0], pair[1]]));
                pair.copy_from_slice(&sum.to_be_bytes());
            }
        }
    }
}

/// The channels of the picture that a file keeps of the whole: one behind the other.
pub(super) fn divide_merged<'a>(
    bytes: &'a [u8],
    compression: u16,
    rectangle: &Rectangle,
    (depth, version): (Depth, Version),
    count: usize,
) -> Result<Vec<Channel<'a>>, LayeredError> {
    const WHAT: &str = "the picture";
    let mut channels = Vec::new();
    let mut left = Bytes::new(bytes, WHAT);
    match compression {
        0 => {
            for _ in 0..count {
                channels.push(Channel {
                    compression: Some(0),
                    bytes: left.take(rectangle.width * rectangle.height * depth.bytes())?,
                    row_lengths: None,
                });
            }
        }
        1 => {
            let length_bytes = length_bytes(version);
            let mut tables = Vec::new();
            for _ in 0..count {
                tables.push(left.take(rectangle.height * length_bytes)?);
            }
            for table in tables {
                let length = table.chunks_exact(length_bytes).fold(0_usize, |sum, length| {
                    sum.saturating_add(length.iter().fold(0, |sum, byte| sum << 8 | usize::from(*byte)))
                });
                channels.push(Channel {
                    compression: Some(1),
                    bytes: left.take(length)?,
                    row_lengths: Some(table),
                });
            }
        }
        other => {
            return Err(LayeredError::damaged(format!(
                "the picture is compressed in an unknown way, {other}"
            )));
        }
    }
    Ok(channels)
}
