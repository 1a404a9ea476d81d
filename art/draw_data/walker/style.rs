//! Line widths and colours of the figure.

use crate::canvas::Rgb;

/// Thickness of the ink line around the figure.
pub(super) const LINE: f64 = 5.5;
/// Thickness of ink lines inside the figure.
pub(super) const FINE: f64 = 3.6;

pub(super) const INK: Rgb = [0x2b, 0x1f, 0x33];
pub(super) const SKIN: Rgb = [0xff, 0xd2, 0xae];
pub(super) const CHEEK: Rgb = [0xf7, 0x9a, 0x86];
pub(super) const HAIR: Rgb = [0x8a, 0x4b, 0x2d];
pub(super) const HAT: Rgb = [0xe2, 0x4b, 0x3b];
pub(super) const CREAM: Rgb = [0xff, 0xf3, 0xdc];
pub(super) const RIB: Rgb = [0xe6, 0xcd, 0xac];
pub(super) const SWEATER: Rgb = [0xf6, 0xb5, 0x3c];
pub(super) const SCARF: Rgb = [0x2f, 0xa7, 0x9b];
pub(super) const TROUSERS: Rgb = [0x3d, 0x5f, 0x97];
pub(super) const TURN_UP: Rgb = [0x8f, 0xae, 0xd6];
pub(super) const SHOE: Rgb = [0x8c, 0x51, 0x38];
pub(super) const TONGUE: Rgb = [0xf0, 0x6f, 0x6a];
pub(super) const MOUTH: Rgb = [0x7c, 0x23, 0x35];
