//! The records of a PSD file's layers.

use super::channels::{Channel, Depth, Rectangle};
use crate::input::layered::tree::MOST_LAYERS;
use crate::input::layered::{Bytes, LayerNote, LayeredError};

/// The number of the channel of transparency.
pub(super) const ALPHA: i16 = -1;
/// The number of the channel of a layer's mask, a vector mask among it as pixels.
pub(super) const MASK: i16 = -2;
/// The most channels of a layer.
const MOST_CHANNELS: u16 = 64;

/// Records that change what is behind them or make pixels when the picture is shown, and what each is.
const WITHOUT_PIXELS: [(&[u8; 4], &str); 19] = [
    (b"SoCo", "a fill of one colour"),
    (b"GdFl", "a gradient fill"),
    (b"PtFl", "a pattern fill"),
    (b"brit", "an adjustment (brightness and contrast)"),
    (b"levl", "an adjustment (levels)"),
    (b"curv", "an adjustment (curves)"),
    (b"expA", "an adjustment (exposure)"),
    (b"vibA", "an adjustment (vibrance)"),
    (b"hue ", "an adjustment (hue and saturation)"),
    (b"hue2", "an adjustment (hue and saturation)"),
    (b"blnc", "an adjustment (colour balance)"),
    (b"blwh", "an adjustment (black and white)"),
    (b"phfl", "an adjustment (photo filter)"),
    (b"mixr", "an adjustment (channel mixer)"),
    (b"clrL", "an adjustment (colour look-up)"),
    (b"nvrt", "an adjustment (inversion)"),
    (b"post", "an adjustment (posterisation)"),
    (b"thrs", "an adjustment (threshold)"),
    (b"selc", "an adjustment (selective colour)"),
];
/// The same; a gradient map has a name that others begin with, too.
const GRADIENT_MAP: &[u8; 4] = b"grdm";

/// How long lengths are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    /// PSD: four bytes.
    Small,
    /// PSB: eight bytes, and four for the length of a row.
    Large,
}

impl Version {
    /// A length.
    pub(super) fn length(self, bytes: &mut Bytes<'_>) -> Result<usize, LayeredError> {
        let length = match self {
            Self::Small => u64::from(bytes.be_u32()?),
            Self::Large => bytes.be_u64()?,
        };
        // What is longer than memory is longer than the file.
        Ok(usize::try_from(length).unwrap_or(usize::MAX))
    }

    /// The length of a block with this key outside of layers' records.
    fn block_length(self, key: [u8; 4], bytes: &mut Bytes<'_>) -> Result<usize, LayeredError> {
        const LONG: [&[u8; 4]; 13] = [
            b"LMsk", b"Lr16", b"Lr32", b"Layr", b"Mt16", b"Mt32", b"Mtrn", b"Alph", b"FMsk", b"lnk2", b"FEid", b"FXid",
            b"PxSD",
        ];
        match self {
            Self::Large if LONG.contains(&&key) => self.length(bytes),
            _ => Ok(bytes.be_u32()? as usize),
        }
    }
}

/// What a record stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Layer,
    /// The front of a group.
    Group {
        passes_through: bool,
    },
    /// The back of a group.
    Divider,
}

/// Where a mask lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordMask {
    pub(super) rectangle: Rectangle,
    pub(super) outside: u8,
}

/// The record of a layer.
#[derive(Debug)]
pub(super) struct Record<'a> {
    pub(super) name: String,
    pub(super) rectangle: Rectangle,
    pub(super) role: Role,
    pub(super) blend: [u8; 4],
    pub(super) opacity: u8,
    /// The opacity of its pixels without its effects.
    pub(super) fill: u8,
    pub(super) is_visible: bool,
    pub(super) is_clipped: bool,
    /// `None` too for a mask that is switched off.
    pub(super) mask: Option<RecordMask>,
    pub(super) notes: Vec<LayerNote>,
    /// Their numbers and lengths, then their bytes.
    lengths: Vec<(i16, usize)>,
    channels: Vec<(i16, Channel<'a>)>,
}

impl<'a> Record<'a> {
    pub(super) fn channel(&self, number: i16) -> Option<Channel<'a>> {
        let found = self.channels.iter().find(|(own, _)| *own == number);
        found.map(|(_, channel)| *channel)
    }

    /// Why a layer has no pixels, if that is worth a word: an empty layer is just empty.
    pub(super) fn unpainted(&self) -> Option<LayerNote> {
        (!self.rectangle.is_empty()).then(|| LayerNote::NoPixels {
            what: "without channels of colour".to_owned(),
        })
    }
}

/// The records in the layer section of a file, from back to front, with their channels.
pub(super) fn read_records(
    mut section: Bytes<'_>,
    version: Version,
    depth: Depth,
) -> Result<Vec<Record<'_>>, LayeredError> {
    if section.is_empty() {
        return Ok(Vec::new());
    }
    let length = version.length(&mut section)?;
    let layers = section.part(length, "the list of layers")?;
    if !layers.is_empty() {
        return read_list(layers, version);
    }
    if depth == Depth::Eight || section.is_empty() {
        return Ok(Vec::new());
    }
    // The settings of the mask of all layers, then blocks.
    let settings = section.be_u32()?;
    section.take(settings as usize)?;
    while section.rest().len() >= 12 {
        let signature = section.tag()?;
        if signature != *b"8BIM" && signature != *b"8B64" {
            break;
        }
        let key = section.tag()?;
        let length = version.block_length(key, &mut section)?;
        let block = section.part(length, "the list of layers")?;
        if key == *b"Lr16" || key == *b"Layr" {
            return read_list(block, version);
        }
        let padding = (4 - length % 4) % 4;
        section.take(padding.min(section.rest().len()))?;
    }
    Ok(Vec::new())
}

fn read_list(mut list: Bytes<'_>, version: Version) -> Result<Vec<Record<'_>>, LayeredError> {
    // Negative where the whole picture has transparency.
    let count = usize::from(list.be_i16()?.unsigned_abs());
    if count > MOST_LAYERS {
        return Err(LayeredError::TooMany {
            what: "layers",
            found: count,
            most: MOST_LAYERS,
        });
    }
    let mut records = Vec::new();
    for _ in 0..count {
        records.push(read_record(&mut list, version)?);
    }
    for record in &mut records {
        for &(number, length) in &record.lengths {
            let bytes = list.take(length).map_err(|error| error.of_layer(&record.name))?;
            record.channels.push((number, Channel::new(bytes)));
        }
    }
    Ok(records)
}

fn read_record<'a>(list: &mut Bytes<'a>, version: Version) -> Result<Record<'a>, LayeredError> {
    let rectangle = Rectangle::read(list)?;
    let channel_count = list.be_u16()?;
    if channel_count > MOST_CHANNELS {
        return Err(LayeredError::damaged(format!("a layer has {channel_count} channels")));
    }
    let mut lengths = Vec::new();
    for _ in 0..channel_count {
        lengths.push((list.be_i16()?, version.length(list)?));
    }
    if list.tag()? != *b"8BIM" {
        return Err(LayeredError::damaged("the record of a layer has no blend mode"));
    }
    let mut record = Record {
        name: String::new(),
        rectangle,
        role: Role::Layer,
        blend: list.tag()?,
        opacity: list.byte()?,
        fill: u8::MAX,
        is_clipped: list.byte()? != 0,
        is_visible: list.byte()? & 0x02 == 0,
        mask: None,
        notes: Vec::new(),
        lengths,
        channels: Vec::new(),
    };
    list.byte()?;
    let length = list.be_u32()? as usize;
    let mut extra = list.part(length, "the record of a layer")?;
    let length = extra.be_u32()? as usize;
    let mask = extra.part(length, "the mask of a layer")?;
    read_mask(mask, &mut record)?;
    let ranges = extra.be_u32()? as usize;
    extra.take(ranges)?;
    let length = usize::from(extra.byte()?);
    record.name = short_name(extra.take(length)?);
    let padding = (4 - (1 + length) % 4) % 4;
    extra.take(padding.min(extra.rest().len()))?;
    read_blocks(extra, version, &mut record)?;
    Ok(record)
}

fn read_mask(mut mask: Bytes<'_>, record: &mut Record<'_>) -> Result<(), LayeredError> {
    const SWITCHED_OFF: u8 = 0x02;
    const SOFTENED: u8 = 0x10;
    if mask.is_empty() {
        return Ok(());
    }
    let rectangle = Rectangle::read(&mut mask)?;
    let outside = mask.byte()?;
    let flags = mask.byte()?;
    if flags & SWITCHED_OFF != 0 {
        return Ok(());
    }
    if flags & SOFTENED != 0 {
        record.notes.push(LayerNote::MaskSoftened);
    }
    record.mask = Some(RecordMask { rectangle, outside });
    Ok(())
}

/// What newer versions of the program added to a layer's record.
fn read_blocks(mut extra: Bytes<'_>, version: Version, record: &mut Record<'_>) -> Result<(), LayeredError> {
    let mut has_vector_mask = false;
    while extra.rest().len() >= 12 {
        let signature = extra.tag()?;
        if signature != *b"8BIM" && signature != *b"8B64" {
            break;
        }
        let key = extra.tag()?;
        let length = version.block_length(key, &mut extra)?;
        let mut block = extra.part(length, "a block in the record of a layer")?;
        extra.take((length % 2).min(extra.rest().len()))?;
        match &key {
            b"luni" => record.name = unicode(&mut block)?,
            b"iOpa" => record.fill = block.byte()?,
            b"lsct" | b"lsdk" => read_section(&mut block, record)?,
            b"vmsk" | b"vsms" => has_vector_mask = true,
            b"TySh" | b"tySh" => record.notes.push(LayerNote::LiveText),
            b"lfx2" | b"lmfx" | b"lrFX" if !record.notes.contains(&LayerNote::Effects) => {
                if key == *b"lmfx" || has_effects(&block, key) {
                    record.notes.push(LayerNote::Effects);
                }
            }
            GRADIENT_MAP => record.notes.push(LayerNote::NoPixels {
                what: "an adjustment (gradient map)".to_owned(),
            }),
            other => {
                if let Some((_, what)) = WITHOUT_PIXELS.iter().find(|(known, _)| *known == other) {
                    let is_painted = !record.rectangle.is_empty();
                    // Some programs keep the pixels of a fill.
                    if !(is_painted && matches!(other, b"SoCo" | b"GdFl" | b"PtFl")) {
                        record.notes.push(LayerNote::NoPixels {
                            what: (*what).to_owned(),
                        });
                    }
                }
            }
        }
    }
    if has_vector_mask && record.mask.is_none() {
        record.notes.push(LayerNote::VectorMask);
    }
    Ok(())
}

/// Whether a block of effects has one that is switched on: programs write the block with all of them off.
fn has_effects(block: &Bytes<'_>, key: [u8; 4]) -> bool {
    let holds = |mark: &[u8]| block.rest().windows(mark.len()).any(|part| part == mark);
    // A descriptor: the key `enab`, its type, and 1.
    key == *b"lfx2" && holds(b"enabbool\x01")
}

fn read_section(block: &mut Bytes<'_>, record: &mut Record<'_>) -> Result<(), LayeredError> {
    let kind = block.be_u32()?;
    record.role = match kind {
        1 | 2 => {
            if block.rest().len() >= 8 {
                block.tag()?;
                record.blend = block.tag()?;
            }
            Role::Group {
                passes_through: record.blend == *b"pass",
            }
        }
        3 => Role::Divider,
        _ => Role::Layer,
    };
    Ok(())
}

/// The letters of the Macintosh's encoding from 128 on.
const MAC_ROMAN: &str = "ÄÅÇÉÑÖÜáàâäãåçéèêëíìîïñóòôöõúùûü†°¢£§•¶ß®©™´¨≠ÆØ∞±≤≥¥µ∂∑∏π∫ªºΩæø¿¡¬√ƒ≈∆«»…\u{a0}ÀÃÕŒœ–—“”‘’÷◊ÿŸ⁄€‹›ﬁﬂ‡·‚„‰ÂÊÁËÈÍÎÏÌÓÔ\u{f8ff}ÒÚÛÙıˆ˜¯˘˙˚¸˝˛ˇ";

/// A name that old programs and other libraries write alone: in UTF-8 or, as the program began, in the Macintosh's encoding.
fn short_name(bytes: &[u8]) -> String {
    if let Ok(name) = std::str::from_utf8(bytes) {
        return name.to_owned();
    }
    let letter = |byte: &u8| match byte {
        0..128 => Some(char::from(*byte)),
        128.. => MAC_ROMAN.chars().nth(usize::from(*byte) - 128),
    };
    bytes.iter().filter_map(letter).collect()
}

/// A name of UTF-16 units after their number.
fn unicode(block: &mut Bytes<'_>) -> Result<String, LayeredError> {
    let count = block.be_u32()? as usize;
    let bytes = block.take(count.saturating_mul(2))?;
    let units: Vec<u16> = bytes
        .chunks_exact(2)
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
        .collect();
    // Some programs end it as C does.
    Ok(String::from_utf16_lossy(&units).trim_end_matches('\0').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_names_have_their_accents() {
        assert_eq!(MAC_ROMAN.chars().count(), 128);
        assert_eq!(short_name(b"\x8arm"), "ärm");
        assert_eq!(short_name("ärm".as_bytes()), "ärm");
        assert_eq!(short_name(&[0xff]), "ˇ");
    }
}
