//! Pixels of Aseprite's cels.

use std::io::Read;

use flate2::bufread::ZlibDecoder;

use crate::input::layered::LayeredError;
use crate::input::layered::raster::Area;

/// What pixels are made of.
#[derive(Debug)]
pub(super) enum Colours {
    /// Red, green, blue, alpha.
    Rgba,
    /// Grey, alpha.
    Grey,
    /// An index into the palette; one index is clear.
    Indexed { palette: Vec<[u8; 4]>, clear: u8 },
}

impl Colours {
    pub(super) fn of(bits: u16, palette: Vec<[u8; 4]>, clear: u8) -> Result<Self, LayeredError> {
        match bits {
            32 => Ok(Self::Rgba),
            16 => Ok(Self::Grey),
            8 => Ok(Self::Indexed { palette, clear }),
            other => Err(LayeredError::damaged(format!("its pixels have {other} bits"))),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Rgba => 4,
            Self::Grey => 2,
            Self::Indexed { .. } => 1,
        }
    }

    fn pixel(&self, bytes: &[u8], is_background: bool) -> [u8; 4] {
        match (self, bytes) {
            (Self::Rgba, &[red, green, blue, alpha]) => [red, green, blue, alpha],
            (Self::Grey, &[grey, alpha]) => [grey, grey, grey, alpha],
            (Self::Indexed { palette, clear }, &[index]) if index != *clear || is_background => {
                // An index without a colour is drawn as nothing, as the program does.
                palette.get(usize::from(index)).copied().unwrap_or_default()
            }
            _ => [0; 4],
        }
    }

    /// The pixels in `area` of a cel of `size` that lies at `at`.
    pub(super) fn read(
        &self,
        (bytes, is_deflated): (&[u8], bool),
        size: [usize; 2],
        at: [i64; 2],
        area: Area,
        is_background: bool,
    ) -> Result<Vec<[u8; 4]>, LayeredError> {
        const WHAT: &str = "a drawing";
        let mut stream: Box<dyn Read> = if is_deflated {
            Box::new(ZlibDecoder::new(bytes))
        } else {
            Box::new(bytes)
        };
        let offset = |place: usize, low: i64| usize::try_from(place as i64 - low).unwrap_or(0);
        let (first, start) = (offset(area.top, at[1]), offset(area.left, at[0]));
        let mut row = vec![0; size[0] * self.bytes()];
        let mut pixels = Vec::with_capacity(area.width() * area.height());
        for y in 0..first + area.height() {
            stream
                .read_exact(&mut row)
                .map_err(|_| LayeredError::CutOff { what: WHAT })?;
            if y >= first {
                let within = row.chunks_exact(self.bytes()).skip(start).take(area.width());
                pixels.extend(within.map(|bytes| self.pixel(bytes, is_background)));
            }
        }
        Ok(pixels)
    }
}
