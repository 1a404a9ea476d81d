//! Layers to one picture.
//!
//! A tree and a frame -> a [`Sheet`](super::raster::Sheet), from back to front. A layer is decoded when it is drawn and forgotten then. A group that is isolated, faded, masked or clips
//! others is composed on a sheet of its own; how many there may be at once is limited before they are allocated.

use super::raster::{Drawn, Placing, Sheet, opacity_of};
use super::tree::{all_paths, find_path};
use super::{
    BlendMode, Clipping, Layer, LayerContent, LayerNote, LayeredError, LayeredFile, LayeredPicture, MOST_SHEETS, Mask,
    Work,
};
use crate::input::decode::LARGEST_COUNT;

/// What is seen of an element, or of everything that is visible.
pub(super) fn compose(
    file: &LayeredFile<'_>,
    element: Option<&str>,
    frame: usize,
) -> Result<LayeredPicture, LayeredError> {
    let mut composer = Composer {
        file,
        frame,
        sheets: 0,
        work: Work::default(),
        notes: Vec::new(),
    };
    let sheet = match element {
        None => composer.own_sheet("", |composer, sheet| composer.siblings(&file.layers, sheet))?,
        Some(path) => composer.element(path)?,
    };
    let rgba = sheet.into_straight().ok_or_else(|| match element {
        None => LayeredError::NothingVisible,
        Some(path) => LayeredError::EmptyLayer {
            layer: path.to_owned(),
            frame: (file.frame_count > 1).then_some(frame),
        },
    })?;
    Ok(LayeredPicture {
        size: file.size(),
        rgba,
        notes: composer.notes,
    })
}

struct Composer<'f, 'a> {
    file: &'f LayeredFile<'a>,
    frame: usize,
    /// How many sheets there are now.
    sheets: u64,
    /// What may still be done for this picture.
    work: Work,
    notes: Vec<(String, LayerNote)>,
}

impl<'f> Composer<'f, '_> {
    /// The element of this path, as the file shows it if everything that it is in is shown.
    fn element(&mut self, path: &str) -> Result<Sheet, LayeredError> {
        let file = self.file;
        let Some(way) = find_path(&file.layers, path) else {
            return Err(LayeredError::no_such_layer(path, all_paths(&file.layers)));
        };
        // On each level, what lies there and which of it is meant.
        let mut levels: Vec<(&'f [Layer], usize)> = Vec::new();
        let mut siblings: &'f [Layer] = &file.layers;
        for place in way {
            levels.push((siblings, place));
            siblings = siblings[place].children();
        }
        let mut is_innermost = true;
        let mut sheet = self.own_sheet(path, |_, _| Ok(()))?;
        while let Some((siblings, place)) = levels.pop() {
            let layer = &siblings[place];
            if is_innermost {
                let clipped = match layer.clipping {
                    Clipping::Base => &[],
                    Clipping::None | Clipping::Behind => clipped_by(siblings, place),
                };
                self.with_clipped(layer, clipped, BlendMode::Normal, Placing::Over, &mut sheet)?;
                is_innermost = false;
            } else {
                sheet.fade(opacity_of(layer.opacity), self.mask_of(layer)?.as_ref());
            }
            match layer.clipping {
                Clipping::None => {}
                Clipping::Base => {
                    if let Some(base) = siblings[..place].iter().rfind(|other| other.clipping != Clipping::Base) {
                        let by = self.own_sheet(&layer.path, |composer, by| {
                            composer.layer(base, base.opacity, BlendMode::Normal, Placing::Over, by)
                        })?;
                        sheet.cut_by(&by);
                        self.sheets -= 1;
                    }
                }
                Clipping::Behind => {
                    let by = self.own_sheet(&layer.path, |composer, by| composer.siblings(&siblings[..place], by))?;
                    sheet.cut_by(&by);
                    self.sheets -= 1;
                }
            }
        }
        Ok(sheet)
    }

    /// Draws everything that is visible of some siblings.
    fn siblings(&mut self, layers: &[Layer], onto: &mut Sheet) -> Result<(), LayeredError> {
        let mut place = 0;
        while let Some(layer) = layers.get(place) {
            let clipped = clipped_by(layers, place);
            // What is clipped by a hidden layer is hidden with it.
            if layer.is_visible {
                let placing = match layer.clipping {
                    Clipping::Behind => Placing::Atop,
                    // One that is clipped and has nothing behind it.
                    Clipping::None | Clipping::Base => Placing::Over,
                };
                self.with_clipped(layer, clipped, layer.blend, placing, onto)?;
            }
            place += 1 + clipped.len();
        }
        Ok(())
    }

    /// Draws a layer and those that are clipped by it, which are one with it.
    fn with_clipped(
        &mut self,
        layer: &Layer,
        clipped: &[Layer],
        blend: BlendMode,
        placing: Placing,
        onto: &mut Sheet,
    ) -> Result<(), LayeredError> {
        if clipped.iter().all(|other| !other.is_visible) {
            return self.layer(layer, layer.opacity, blend, placing, onto);
        }
        let whole = self.own_sheet(&layer.path, |composer, sheet| {
            composer.layer(layer, 1.0, BlendMode::Normal, Placing::Over, sheet)?;
            for other in clipped.iter().filter(|other| other.is_visible) {
                composer.layer(other, other.opacity, other.blend, Placing::Atop, sheet)?;
            }
            Ok(())
        })?;
        onto.draw_sheet(
            &whole,
            Drawn {
                opacity: opacity_of(layer.opacity),
                mask: None,
                blend,
                placing,
            },
        );
        self.sheets -= 1;
        Ok(())
    }

    /// Draws a layer or group alone.
    fn layer(
        &mut self,
        layer: &Layer,
        opacity: f64,
        blend: BlendMode,
        placing: Placing,
        onto: &mut Sheet,
    ) -> Result<(), LayeredError> {
        for note in &layer.notes {
            let note = (layer.path.clone(), note.clone());
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
        // It would hide what it is to cut out.
        if layer.notes.iter().any(|note| matches!(note, LayerNote::CutsOut { .. })) {
            return Ok(());
        }
        let opacity = opacity_of(opacity);
        match &layer.content {
            LayerContent::Pixels(None) => Ok(()),
            LayerContent::Pixels(Some(number)) => {
                let read = self.file.pixels.tile(*number, self.frame, &mut self.work);
                let Some(tile) = read.map_err(|error| error.of_layer(&layer.path))? else {
                    return Ok(());
                };
                let mask = self.mask_of(layer)?;
                onto.draw_tile(
                    &tile,
                    Drawn {
                        opacity,
                        mask: mask.as_ref(),
                        blend,
                        placing,
                    },
                );
                Ok(())
            }
            LayerContent::Group {
                children,
                is_isolated: false,
            } if blend == BlendMode::Normal && placing == Placing::Over => {
                let mask = self.mask_of(layer)?;
                if opacity == u16::MAX && mask.is_none() {
                    return self.siblings(children, onto);
                }
                self.count_sheet(&layer.path)?;
                let before = onto.clone();
                self.siblings(children, onto)?;
                onto.mix_with(&before, opacity, mask.as_ref());
                self.sheets -= 1;
                Ok(())
            }
            LayerContent::Group { children, .. } => {
                let sheet = self.own_sheet(&layer.path, |composer, sheet| composer.siblings(children, sheet))?;
                let mask = self.mask_of(layer)?;
                onto.draw_sheet(
                    &sheet,
                    Drawn {
                        opacity,
                        mask: mask.as_ref(),
                        blend,
                        placing,
                    },
                );
                self.sheets -= 1;
                Ok(())
            }
        }
    }

    fn mask_of(&mut self, layer: &Layer) -> Result<Option<Mask>, LayeredError> {
        let Some(mask) = layer.mask else { return Ok(None) };
        let mask = self.file.pixels.mask(mask, &mut self.work);
        mask.map(Some).map_err(|error| error.of_layer(&layer.path))
    }

    /// A sheet on which something was drawn, and which is counted among those that there are.
    fn own_sheet(
        &mut self,
        path: &str,
        draw: impl FnOnce(&mut Self, &mut Sheet) -> Result<(), LayeredError>,
    ) -> Result<Sheet, LayeredError> {
        self.count_sheet(path)?;
        let mut sheet = Sheet::clear(self.file.canvas);
        draw(self, &mut sheet)?;
        Ok(sheet)
    }

    fn count_sheet(&mut self, path: &str) -> Result<(), LayeredError> {
        self.sheets += 1;
        if self.sheets * self.file.canvas.count() as u64 > MOST_SHEETS * LARGEST_COUNT {
            return Err(LayeredError::TooDeep { layer: path.to_owned() });
        }
        self.work.spend(self.file.canvas.count() as u64)
    }
}

/// Those that are clipped by the layer at `place`: the ones right in front of it.
fn clipped_by(layers: &[Layer], place: usize) -> &[Layer] {
    let after = layers.get(place + 1..).unwrap_or_default();
    let count = after
        .iter()
        .take_while(|other| other.clipping == Clipping::Base)
        .count();
    &after[..count]
}
