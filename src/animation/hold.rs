//! On ones, twos or threes.

/// For how many frames a drawing is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Hold {
    /// Every frame is a drawing of its own.
    #[default]
    Ones,
    /// Two frames a drawing.
    Twos,
    /// Three frames a drawing.
    Threes,
}

impl Hold {
    /// Every hold, the shortest first.
    pub const ALL: [Self; 3] = [Self::Ones, Self::Twos, Self::Threes];

    /// The number of frames.
    #[must_use]
    pub fn frames(self) -> usize {
        match self {
            Self::Ones => 1,
            Self::Twos => 2,
            Self::Threes => 3,
        }
    }

    /// The hold of so many frames: 1, 2 or 3.
    #[must_use]
    pub fn of_frames(frames: i64) -> Option<Self> {
        Self::ALL.into_iter().find(|hold| hold.frames() as i64 == frames)
    }
}
