//! Two drawings in memory become an animated GIF in memory: no file is read, no scene is written.

use inbetween::export::{Backdrop, Palette, Repetition};
use inbetween::input::InputError;
use inbetween::{
    Animation, BitmapOptions, Character, CharacterSpec, Drawing, GifWriter, LayerSpec, PoseSpec, read_pixels,
};

/// Columns and rows of drawings and frames.
const SIZE: [usize; 2] = [128, 128];

/// A leaf, thicker below, along a parabola that reaches `bend` pixels aside.
fn leaf(bend: f64, [red, green, blue]: [u8; 3]) -> Result<Drawing, InputError> {
    let pixel = |k: usize| {
        let (x, y) = ((k % SIZE[0]) as f64 - 63.5, ((k / SIZE[0]) as f64 - 63.5) / 50.0);
        let depth = 16.0 * (1.0 - y * y).max(0.0) * (1.0 + 0.7 * y) - (x - bend * (y * y - 0.5)).abs();
        [red, green, blue, (255.0 * (depth + 0.5).clamp(0.0, 1.0)) as u8]
    };
    let pixels: Vec<u8> = (0..SIZE[0] * SIZE[1]).flat_map(pixel).collect();
    read_pixels(SIZE, &pixels, &BitmapOptions::default())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let poses = vec![
        PoseSpec::drawn("left", leaf(-40.0, [40, 140, 90])?),
        PoseSpec::drawn("right", leaf(40.0, [220, 130, 40])?),
    ];
    let places = vec![vec![0.0, 0.0], vec![1.0, 0.0]];
    let animation = Animation::visiting(places.iter().map(Vec::as_slice), true)?;
    let spec = CharacterSpec::new(vec![LayerSpec::new("leaf", poses)]).with_places(places);
    let character = Character::new(&spec, &animation, SIZE)?;
    let frame = |k: usize| character.frame(&animation, k);
    let frames: Vec<_> = (0..animation.frame_count()).map(frame).collect::<Result<_, _>>()?;
    let (mut gif, colours) = (Vec::new(), Palette::for_frames(&frames));
    let mut writer = GifWriter::new(&mut gif, SIZE, 24.0, colours, Backdrop::Clear, Repetition::Forever)?;
    frames.iter().try_for_each(|frame| writer.add(frame))?;
    writer.finish()?;
    let file = std::env::args().nth(1).ok_or("usage: two_drawings FILE.gif")?;
    Ok(std::fs::write(file, gif)?)
}
