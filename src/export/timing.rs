//! Frame rates as fractions, and times in whole ticks that add up.
//!
//! A format that counts hundredths or thousandths of a second cannot show every frame for `1 / fps`. Each frame then
//! starts at the tick nearest to its time, so that no frame is late by more than half a tick and the whole is as long as
//! it should be.

/// Frames a second as a fraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rate {
    pub(super) frames: u32,
    pub(super) seconds: u32,
}

/// How far from 24000/1001 and its kin a rate may be written: 23.976, 29.97, 59.94.
const WRITTEN_SHORT: f64 = 1e-3;
/// Rates are kept to this part of a frame a second.
const FINEST: f64 = 1e6;

impl Rate {
    /// The rate of `fps` frames a second, above 0 and at most 1000.
    pub(super) fn of(fps: f64) -> Self {
        let whole = fps.round();
        if whole >= 1.0 && (fps - whole).abs() < 1.0 / FINEST {
            return Self {
                frames: whole as u32,
                seconds: 1,
            };
        }
        let above = fps.ceil();
        if (fps - above * 1000.0 / 1001.0).abs() < WRITTEN_SHORT && above >= 24.0 {
            return Self {
                frames: above as u32 * 1000,
                seconds: 1001,
            };
        }
        let (frames, seconds) = ((fps * FINEST).round().max(1.0) as u32, FINEST as u32);
        let common = greatest_common_divisor(frames, seconds);
        Self {
            frames: frames / common,
            seconds: seconds / common,
        }
    }

    /// How many ticks frame `index` is shown, of which a second has `ticks`.
    pub(super) fn ticks_of(self, index: u64, ticks: u32) -> u64 {
        self.ticks_of_frames(index, 1, ticks)
    }

    /// How many ticks `frames` frames from `index` on are shown together, of which a second has `ticks`.
    pub(super) fn ticks_of_frames(self, index: u64, frames: u64, ticks: u32) -> u64 {
        self.start(index + frames, ticks) - self.start(index, ticks)
    }

    /// The tick nearest to the start of frame `index`.
    fn start(self, index: u64, ticks: u32) -> u64 {
        let (frames, scaled) = (
            u128::from(self.frames),
            u128::from(index) * u128::from(self.seconds) * u128::from(ticks),
        );
        ((2 * scaled + frames) / (2 * frames)) as u64
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_fractions_that_are_meant() {
        for (fps, frames, seconds) in [
            (24.0, 24, 1),
            (23.976, 24000, 1001),
            (24000.0 / 1001.0, 24000, 1001),
            (29.97, 30000, 1001),
            (59.94, 60000, 1001),
            (12.5, 25, 2),
            (0.5, 1, 2),
            (1000.0, 1000, 1),
            (1e-9, 1, 1_000_000),
        ] {
            assert_eq!(Rate::of(fps), Rate { frames, seconds }, "{fps}");
        }
    }

    #[test]
    fn ticks_add_up() {
        let total = |fps: f64, ticks: u32, count: u64| -> u64 {
            let rate = Rate::of(fps);
            (0..count).map(|k| rate.ticks_of(k, ticks)).sum()
        };
        assert_eq!(total(24.0, 100, 24), 100);
        assert_eq!(total(30.0, 100, 90), 300);
        assert_eq!(total(23.976, 1000, 24_000), 1_001_000);
        let shown: Vec<u64> = (0..3).map(|k| Rate::of(30.0).ticks_of(k, 100)).collect();
        assert_eq!(shown, [3, 4, 3]);
        assert_eq!(Rate::of(30.0).ticks_of_frames(1, 2, 100), 7);
    }
}
