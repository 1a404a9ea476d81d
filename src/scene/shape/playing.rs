//! The animation: two paths through the space with the same times, one for the geometry and one for the textures.

use super::file::AnimationTable;
use super::settings::ShapeExample;
use crate::animation::{Animation, Key};
use crate::scene::convert::{Checked, Reader};

impl Reader<'_> {
    /// The paths of the geometry and of the textures.
    pub(super) fn shape_animation(
        &self,
        table: &AnimationTable,
        adjectives: &[String],
        examples: &[ShapeExample],
    ) -> Checked<(Animation, Animation)> {
        let fps = self.frame_rate(&table.fps)?;
        let (geometry, textures) = match &table.keys {
            Some(written) if !written.is_empty() => {
                let (mut geometry, mut textures): (Vec<Key>, Vec<Key>) = (Vec::new(), Vec::new());
                for (index, key) in written.iter().enumerate() {
                    let table = key.get_ref();
                    let before = geometry.last().map(|key| key.time);
                    let time = self.key_time(index, table.time, before, key.span().start)?;
                    let at = self.named_place(&table.at, &format!("`at` of animation key {index}"), adjectives)?;
                    let texture_at = match &table.texture_at {
                        Some(place) => {
                            self.named_place(place, &format!("`texture_at` of animation key {index}"), adjectives)?
                        }
                        None => at.clone(),
                    };
                    geometry.push(Key::new(time, at));
                    textures.push(Key::new(time, texture_at));
                }
                let is_loop = table.looped.unwrap_or(false);
                closed_alike(&mut geometry, &mut textures, is_loop);
                (Animation::new(geometry, is_loop), Animation::new(textures, is_loop))
            }
            _ => {
                let places = |of: fn(&ShapeExample) -> &[f64]| {
                    Animation::visiting(examples.iter().map(of), table.looped.unwrap_or(true))
                };
                (places(|example| &example.at), places(|example| &example.texture_at))
            }
        };
        let (mut geometry, mut textures) = (self.checked(geometry)?, self.checked(textures)?);
        for path in [&mut geometry, &mut textures] {
            path.fps = fps;
        }
        Ok((geometry, textures))
    }
}

/// A loop whose last key repeats the first ends there. If only one of the paths does, neither may end there: both have the same
/// times.
fn closed_alike(geometry: &mut Vec<Key>, textures: &mut Vec<Key>, is_loop: bool) {
    let repeats = |keys: &[Key]| keys.len() > 1 && keys.first().map(|k| &k.at) == keys.last().map(|k| &k.at);
    let (a, b) = (repeats(geometry), repeats(textures));
    if !is_loop || a == b || geometry.len() < 2 {
        return;
    }
    // What `Animation` does for a path that does not repeat its first key: it takes the mean time to return.
    let count = geometry.len();
    let period = (geometry[count - 1].time - geometry[0].time) * count as f64 / (count - 1) as f64;
    for keys in [geometry, textures] {
        keys.push(Key::new(keys[0].time + period, keys[0].at.clone()));
    }
}
