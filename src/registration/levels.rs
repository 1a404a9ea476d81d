//! The levels of the search, coarse to fine.

/// One level of the search. Lengths are in figure units but for the blur, which is in working pixels.
pub(super) struct Level {
    pub(super) deviation_px: f32,
    pub(super) patch_radius: f64,
    pub(super) reach: f64,
    pub(super) step: f64,
    pub(super) stiffness: f64,
    pub(super) temperature: f32,
    pub(super) iterations: usize,
}

/// From coarse to fine.
pub(super) const LEVELS: [Level; 5] = [
    level(5.0, 0.060, 0.060, 0.0100, 300.0, 0.030, 4),
    level(3.5, 0.045, 0.036, 0.0060, 150.0, 0.027, 4),
    level(2.2, 0.034, 0.020, 0.0034, 75.0, 0.0225, 3),
    level(1.3, 0.026, 0.010, 0.0018, 37.5, 0.018, 3),
    level(0.9, 0.020, 0.005, 0.0011, 22.5, 0.015, 2),
];

const fn level(
    deviation_px: f32,
    patch_radius: f64,
    reach: f64,
    step: f64,
    stiffness: f64,
    temperature: f32,
    iterations: usize,
) -> Level {
    Level {
        deviation_px,
        patch_radius,
        reach,
        step,
        stiffness,
        temperature,
        iterations,
    }
}
