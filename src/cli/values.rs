//! Values as they are written on the command line.

use inbetween::animation::Background;
use inbetween::pipeline::CameraRule;

/// Numbers separated by commas: a place, or weights.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Numbers(pub(crate) Vec<f64>);

impl std::str::FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split(',')
            .map(|word| {
                word.trim()
                    .parse::<f64>()
                    .map_err(|_| format!("'{word}' is not a number; write numbers separated by commas"))
            })
            .collect::<Result<_, _>>()
            .map(Self)
    }
}

/// `COLUMNSxROWS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Grid(pub(crate) [usize; 2]);

impl std::str::FromStr for Grid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        /// The largest picture or grid.
        const MOST: usize = 16_384;
        let wrong = || format!("'{text}' is not COLUMNSxROWS with whole numbers from 1 to {MOST}, such as 1920x1080");
        let (columns, rows) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
        let side = |word: &str| {
            word.parse::<usize>()
                .ok()
                .filter(|n| (1..=MOST).contains(n))
                .ok_or_else(wrong)
        };
        Ok(Self([side(columns)?, side(rows)?]))
    }
}

/// Frame numbers from 1: `1-10,20`, or every third of some by `1-10:3`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FrameNumbers(Vec<Stretch>);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Stretch {
    first: usize,
    last: usize,
    step: usize,
}

impl std::str::FromStr for FrameNumbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is no list of frame numbers from 1, such as 1-10,20");
        let number = |word: &str| word.trim().parse::<usize>().ok().filter(|n| *n >= 1).ok_or_else(wrong);
        let stretch = |word: &str| -> Result<Stretch, String> {
            let (ends, step) = match word.split_once(':') {
                Some((ends, step)) => (ends, number(step)?),
                None => (word, 1),
            };
            let (first, last) = match ends.split_once('-') {
                Some((first, last)) => (number(first)?, number(last)?),
                None => (number(ends)?, number(ends)?),
            };
            if first > last {
                return Err(wrong());
            }
            Ok(Stretch { first, last, step })
        };
        text.split(',').map(stretch).collect::<Result<_, _>>().map(Self)
    }
}

impl FrameNumbers {
    /// The numbers in order, each once; an error if one is beyond `count`.
    pub(crate) fn within(&self, count: usize) -> Result<Vec<usize>, String> {
        if let Some(beyond) = self.0.iter().map(|stretch| stretch.last).find(|n| *n > count) {
            return Err(format!(
                "frame {beyond} does not exist: the animation has {count} frames"
            ));
        }
        let asked_for = |n: usize| {
            let within = |s: &Stretch| (s.first..=s.last).contains(&n) && (n - s.first).is_multiple_of(s.step);
            self.0.iter().any(within)
        };
        Ok((1..=count).filter(|n| asked_for(*n)).collect())
    }
}

/// What is behind the character.
pub(crate) fn background(text: &str) -> Result<Background, String> {
    text.parse()
        .map_err(|allowed| format!("'{text}' is no background; write {allowed}"))
}

/// What frames show.
pub(crate) fn camera(text: &str) -> Result<CameraRule, String> {
    let found = CameraRule::NAMED.into_iter().find(|(name, _)| *name == text);
    found
        .map(|(_, rule)| rule)
        .ok_or_else(|| format!("'{text}' is no camera; write fit or drawing"))
}

/// Frames a second.
pub(crate) fn frame_rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(fps) if fps > 0.0 && fps <= 1000.0 => Ok(fps),
        _ => Err(format!("'{text}' is no frame rate above 0 and at most 1000")),
    }
}

/// A distance in pixels.
pub(crate) fn pixels(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(distance) if (0.0..=1e6).contains(&distance) => Ok(distance),
        _ => Err(format!("'{text}' is no number of pixels; 0 is exact, 0.5 hardly seen")),
    }
}

/// Samples a pixel, in each direction.
pub(crate) fn supersample(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(samples) if (1..=4).contains(&samples) => Ok(samples),
        _ => Err(format!("'{text}' is no number of samples from 1 to 4")),
    }
}

/// A number of threads.
pub(crate) fn thread_count(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(threads) if (1..=1024).contains(&threads) => Ok(threads),
        _ => Err(format!("'{text}' is no number of threads from 1 to 1024")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_numbers_are_sorted_and_bounded() {
        let numbers: FrameNumbers = "20,3-5,4".parse().expect("numbers");
        assert_eq!(numbers.within(20), Ok(vec![3, 4, 5, 20]));
        assert!(numbers.within(19).is_err());
        let numbers: FrameNumbers = "1-9:3,2".parse().expect("numbers");
        assert_eq!(numbers.within(9), Ok(vec![1, 2, 4, 7]));
        for wrong in ["", "0", "5-3", "a", "1-", "1-5:0", "1-5:"] {
            assert!(wrong.parse::<FrameNumbers>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn grids_and_numbers() {
        assert_eq!("1920x1080".parse(), Ok(Grid([1920, 1080])));
        assert!("0x5".parse::<Grid>().is_err() && "99999x1".parse::<Grid>().is_err() && "5".parse::<Grid>().is_err());
        assert_eq!("-1,0.5".parse(), Ok(Numbers(vec![-1.0, 0.5])));
        assert!("1,,2".parse::<Numbers>().is_err());
    }
}
