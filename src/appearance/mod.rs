//! What is drawn, as numbers that can be compared between drawings.
//!
//! [`Drawing`](crate::input::Drawing) -> [`Appearance`]: the figure resampled so that every pose has the same area, in channels whose
//! differences mean about as much to an eye: lightness and the two colour axes of CIELAB, ink (lines darker than what surrounds them), and
//! coverage. [`Appearance::blurred`] gives a level of its scale space as a [`ChannelImage`], [`Appearance::profiles`] what lies just inside a
//! closed curve.
//!
//! | term | meaning |
//! |---|---|
//! | figure unit | the side of the square with the figure's area, divided by 0.41 (`SIDE_PER_UNIT`): about the diagonal of a compact figure. It measures thin figures by their width, too, which the diagonal does not |
//! | working pixel | 600 of them (`PIXELS_PER_UNIT`) span a figure unit |
//! | ink | how much darker a place is than the closing (dilation, then erosion) of the lightness around it |
//!
//! Cost: linear in the working pixels, whose number does not depend on the resolution of the drawing.

mod blur;
mod bytes;
mod colour;
mod figure;
mod ink;
mod profile;

pub use blur::ChannelImage;
pub(crate) use blur::{CHANNELS, Pixel};
pub(crate) use bytes::{ByteImage, Bytes, STEPS_PER_UNIT};
pub use figure::Appearance;
pub(crate) use figure::PIXELS_PER_UNIT;
pub(crate) use profile::PROFILE_CHANNELS;
pub use profile::Profile;
