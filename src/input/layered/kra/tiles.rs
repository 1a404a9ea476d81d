//! Krita's tiled layers: lines of text about all tiles, then for each a line and its bytes.
//!
//! ```text
//! VERSION 2
//! TILEWIDTH 64
//! TILEHEIGHT 64
//! PIXELSIZE 4
//! DATA 1
//! -64,128,LZF,1023
//! ```
//!
//! Then a byte that says whether the tile is compressed, and the tile. A compressed one has the first bytes of all its pixels, then the second ones, and so on.
//! Integer colours are stored blue, green, red, alpha; those of 16 bits with their lower byte first.

use super::lzf;
use crate::input::layered::raster::Area;
use crate::input::layered::{CanvasSize, LayeredError, Work};

/// The name of masks' colours, which files do not have.
pub(super) const MASK: &str = "ALPHA";
/// Columns and rows of a tile.
const SIDE: usize = 64;
/// Pixels of a tile.
const COUNT: usize = SIDE * SIDE;

/// What pixels are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colours {
    Rgb8,
    Rgb16,
    Grey8,
    Grey16,
    /// Alpha alone.
    Mask,
}

impl Colours {
    pub(super) fn named(name: &str) -> Result<Self, LayeredError> {
        match name {
            "RGBA" => Ok(Self::Rgb8),
            "RGBA16" => Ok(Self::Rgb16),
            "GRAYA" => Ok(Self::Grey8),
            "GRAYA16" | "GRAYAU16" => Ok(Self::Grey16),
            MASK => Ok(Self::Mask),
            other => Err(LayeredError::Unsupported {
                what: format!("pixels of the colour space '{other}' are"),
                remedy: "convert the picture to RGB with 8 or 16 bits a channel",
            }),
        }
    }

    /// How many bytes a pixel has.
    fn bytes(self) -> usize {
        match self {
            Self::Rgb8 => 4,
            Self::Rgb16 => 8,
            Self::Grey8 => 2,
            Self::Grey16 => 4,
            Self::Mask => 1,
        }
    }

    /// Red, green, blue and alpha of the bytes of a pixel.
    fn pixel(self, bytes: &[u8]) -> [u8; 4] {
        let short = |k: usize| {
            let value = u32::from(bytes[2 * k]) | u32::from(bytes[2 * k + 1]) << 8;
            ((value * 255 + 32_767) / 65_535) as u8
        };
        match self {
            Self::Rgb8 => [bytes[2], bytes[1], bytes[0], bytes[3]],
            Self::Rgb16 => [short(2), short(1), short(0), short(3)],
            Self::Grey8 => [bytes[0], bytes[0], bytes[0], bytes[1]],
            Self::Grey16 => [short(0), short(0), short(0), short(1)],
            Self::Mask => [0, 0, 0, bytes[0]],
        }
    }
}

/// A layer as far as it is on the canvas.
#[derive(Debug)]
pub(super) struct TiledLayer {
    /// Around all its tiles.
    pub(super) area: Option<Area>,
    /// Those of the area, row by row.
    pub(super) pixels: Vec<[u8; 4]>,
    /// The pixel everywhere else.
    pub(super) usual: [u8; 4],
}

/// A tile before it is decoded.
struct Stored<'a> {
    at: [i64; 2],
    bytes: &'a [u8],
}

/// Reads a layer that lies at `at`; `usual` are the bytes of the pixel where it has no tile.
pub(super) fn read(
    bytes: &[u8],
    usual: &[u8],
    colours: Colours,
    at: [i64; 2],
    canvas: CanvasSize,
    work: &mut Work,
) -> Result<TiledLayer, LayeredError> {
    let size = colours.bytes();
    let usual = match usual.len() {
        0 => [0; 4],
        length if length == size => colours.pixel(usual),
        _ => {
            return Err(LayeredError::damaged(
                "its usual pixel is of another size than its pixels",
            ));
        }
    };
    let mut tiles = list(bytes, size)?;
    for tile in &mut tiles {
        tile.at = [tile.at[0] + at[0], tile.at[1] + at[1]];
    }
    let area_of = |tile: &Stored<'_>| canvas.area(tile.at[0], tile.at[1], SIDE, SIDE);
    let area = tiles.iter().filter_map(area_of).reduce(|all, one| Area {
        left: all.left.min(one.left),
        top: all.top.min(one.top),
        right: all.right.max(one.right),
        bottom: all.bottom.max(one.bottom),
    });
    let Some(area) = area else {
        let pixels = Vec::new();
        return Ok(TiledLayer { area, pixels, usual });
    };
    work.spend((area.width() * area.height()) as u64)?;
    let mut pixels = vec![usual; area.width() * area.height()];
    let (mut planes, mut tile_bytes) = (vec![0; COUNT * size], vec![0; COUNT * size]);
    for tile in &tiles {
        let Some(within) = area_of(tile) else { continue };
        work.spend(COUNT as u64)?;
        decode(tile.bytes, size, &mut planes, &mut tile_bytes)?;
        for y in within.top..within.bottom {
            for x in within.left..within.right {
                let column = usize::try_from(x as i64 - tile.at[0]).unwrap_or(0);
                let row = usize::try_from(y as i64 - tile.at[1]).unwrap_or(0);
                let from = (row * SIDE + column) * size;
                pixels[(y - area.top) * area.width() + x - area.left] = colours.pixel(&tile_bytes[from..from + size]);
            }
        }
    }
    Ok(TiledLayer {
        area: Some(area),
        pixels,
        usual,
    })
}

/// The tiles of a layer whose pixels have `size` bytes.
fn list(bytes: &[u8], size: usize) -> Result<Vec<Stored<'_>>, LayeredError> {
    let mut left = bytes;
    let mut header = |key: &str| -> Result<usize, LayeredError> {
        let line = line(&mut left)?;
        let value = line
            .strip_prefix(key)
            .map(str::trim)
            .and_then(|value| value.parse().ok());
        value.ok_or_else(|| {
            LayeredError::damaged(format!("its tiles begin with '{line}' instead of '{key}' and a number"))
        })
    };
    let (version, width, height) = (header("VERSION")?, header("TILEWIDTH")?, header("TILEHEIGHT")?);
    let (pixel, count) = (header("PIXELSIZE")?, header("DATA")?);
    if version != 2 || width != SIDE || height != SIDE {
        return Err(LayeredError::damaged(format!(
            "it has tiles of {width} x {height} in version {version}"
        )));
    }
    if pixel != size {
        return Err(LayeredError::damaged(format!(
            "its pixels have {pixel} bytes, but their colours {size}"
        )));
    }
    let mut tiles = Vec::new();
    for _ in 0..count {
        let line = line(&mut left)?;
        let words: Vec<&str> = line.split(',').collect();
        let &[x, y, "LZF", length] = words.as_slice() else {
            return Err(LayeredError::damaged(format!("a tile begins with '{line}'")));
        };
        let (x, y): (Result<i32, _>, Result<i32, _>) = (x.parse(), y.parse());
        let (Ok(x), Ok(y), Ok(length)) = (x, y, length.parse()) else {
            return Err(LayeredError::damaged(format!("a tile begins with '{line}'")));
        };
        let cut_off = LayeredError::CutOff { what: "a tile" };
        let (own, rest) = left.split_at_checked(length).ok_or(cut_off)?;
        tiles.push(Stored {
            at: [x.into(), y.into()],
            bytes: own,
        });
        left = rest;
    }
    Ok(tiles)
}

/// The next line, of which there are only short ones.
fn line<'a>(left: &mut &'a [u8]) -> Result<&'a str, LayeredError> {
    const LONGEST: usize = 100;
    let end = left.iter().take(LONGEST).position(|&byte| byte == b'\n');
    let end = end.ok_or(LayeredError::CutOff {
        what: "the list of tiles",
    })?;
    let line =
        std::str::from_utf8(&left[..end]).map_err(|_| LayeredError::damaged("the list of its tiles is no text"))?;
    *left = &left[end + 1..];
    Ok(line.trim())
}

/// The bytes of a tile, pixel by pixel, into `out`.
fn decode(stored: &[u8], size: usize, planes: &mut [u8], out: &mut [u8]) -> Result<(), LayeredError> {
    let damaged = || LayeredError::damaged("a tile of it does not have as many pixels as it should");
    match stored.split_first() {
        Some((0, bytes)) if bytes.len() == out.len() => out.copy_from_slice(bytes),
        Some((1, bytes)) => {
            lzf::inflate(bytes, planes).ok_or_else(damaged)?;
            for (k, plane) in planes.chunks_exact(COUNT).enumerate() {
                for (pixel, value) in out.chunks_exact_mut(size).zip(plane) {
                    pixel[k] = *value;
                }
            }
        }
        _ => return Err(damaged()),
    }
    Ok(())
}
