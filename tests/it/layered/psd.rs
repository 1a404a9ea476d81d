//! A writer of PSD and PSB files.

use std::io::Write as _;

use super::art::{Content, Node, Patch};

/// How a file is written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Options {
    /// 8 or 16.
    pub(crate) depth: u16,
    /// 0 as it is, 1 PackBits, 2 deflated, 3 deflated differences.
    pub(crate) compression: u16,
    /// Whether it is a PSB file.
    pub(crate) is_large: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            depth: 8,
            compression: 1,
            is_large: false,
        }
    }
}

/// A PSD file with these layers, from back to front.
pub(crate) fn write([width, height]: [u32; 2], nodes: &[Node], options: Options) -> Vec<u8> {
    let mut records = Vec::new();
    let mut channels = Vec::new();
    let mut count = 0_i16;
    for node in nodes {
        write_node(node, options, &mut records, &mut channels, &mut count);
    }
    let mut list = count.to_be_bytes().to_vec();
    list.append(&mut records);
    list.append(&mut channels);
    while !list.len().is_multiple_of(4) {
        list.push(0);
    }
    let mut section = Vec::new();
    if options.depth == 8 {
        put_length(&mut section, list.len(), options);
        section.append(&mut list);
    } else {
        put_length(&mut section, 0, options);
        section.extend(0_u32.to_be_bytes());
        section.extend(b"8BIMLr16");
        put_length(&mut section, list.len(), options);
        section.append(&mut list);
    }
    let mut file = b"8BPS".to_vec();
    file.extend(if options.is_large { 2_u16 } else { 1 }.to_be_bytes());
    file.extend([0; 6]);
    file.extend(3_u16.to_be_bytes());
    file.extend(height.to_be_bytes());
    file.extend(width.to_be_bytes());
    file.extend(options.depth.to_be_bytes());
    file.extend(3_u16.to_be_bytes());
    file.extend(0_u32.to_be_bytes());
    file.extend(0_u32.to_be_bytes());
    put_length(&mut file, section.len(), options);
    file.append(&mut section);
    // The picture of the whole: black.
    file.extend(0_u16.to_be_bytes());
    file.extend(vec![
        0;
        width as usize
            * height as usize
            * 3
            * usize::from(options.depth / 8)
    ]);
    file
}

/// A PSD file without layers, of one colour.
pub(crate) fn write_flat([width, height]: [u32; 2], colour: [u8; 3], compression: u16) -> Vec<u8> {
    let mut file = b"8BPS\0\x01\0\0\0\0\0\0\0\x03".to_vec();
    file.extend(height.to_be_bytes());
    file.extend(width.to_be_bytes());
    file.extend([0, 8, 0, 3]);
    file.extend([0; 12]);
    file.extend(compression.to_be_bytes());
    let rows: Vec<Vec<u8>> = colour.iter().map(|&value| vec![value; width as usize]).collect();
    let packed = |row: &[u8]| if compression == 1 { packed(row) } else { row.to_vec() };
    if compression == 1 {
        for row in &rows {
            for _ in 0..height {
                file.extend((packed(row).len() as u16).to_be_bytes());
            }
        }
    }
    for row in &rows {
        for _ in 0..height {
            file.extend(packed(row));
        }
    }
    file
}

fn put_length(bytes: &mut Vec<u8>, length: usize, options: Options) {
    if options.is_large {
        bytes.extend((length as u64).to_be_bytes());
    } else {
        bytes.extend((length as u32).to_be_bytes());
    }
}

fn write_node(node: &Node, options: Options, records: &mut Vec<u8>, channels: &mut Vec<u8>, count: &mut i16) {
    match &node.content {
        Content::Pixels(patch) => {
            let plane = |k: usize| patch.values.iter().map(|pixel| pixel[k]).collect::<Vec<u8>>();
            let mut own: Vec<(i16, Vec<u8>)> = vec![
                (-1, stored(&plane(3), patch.width, options)),
                (0, stored(&plane(0), patch.width, options)),
                (1, stored(&plane(1), patch.width, options)),
                (2, stored(&plane(2), patch.width, options)),
            ];
            own.extend(mask_channel(node, options));
            write_record(node, patch, own, &[], options, records, channels);
        }
        Content::Group(children) => {
            let nothing = Patch::new([0, 0], [0, 0], |_, _| [0; 4]);
            let empty = || (-1..3).map(|number| (number, vec![0, 0])).collect::<Vec<_>>();
            let divider = Node::layer("</Layer group>", nothing.clone());
            write_record(
                &divider,
                &nothing,
                empty(),
                &section(3, node),
                options,
                records,
                channels,
            );
            *count += 1;
            for child in children {
                write_node(child, options, records, channels, count);
            }
            let mut own = empty();
            own.extend(mask_channel(node, options));
            write_record(node, &nothing, own, &section(1, node), options, records, channels);
        }
    }
    *count += 1;
}

fn mask_channel(node: &Node, options: Options) -> Option<(i16, Vec<u8>)> {
    let mask = node.mask.as_ref()?;
    Some((-2, stored(&mask.values, mask.width, options)))
}

/// The block that makes a record the front or back of a group.
fn section(kind: u32, node: &Node) -> Vec<u8> {
    let mut block = b"8BIMlsct".to_vec();
    block.extend(12_u32.to_be_bytes());
    block.extend(kind.to_be_bytes());
    block.extend(b"8BIM");
    block.extend(match (node.passes_through, node.is_multiplied) {
        (true, _) => b"pass",
        (false, true) => b"mul ",
        (false, false) => b"norm",
    });
    block
}

fn write_record(
    node: &Node,
    patch: &Patch<[u8; 4]>,
    own: Vec<(i16, Vec<u8>)>,
    blocks: &[u8],
    options: Options,
    records: &mut Vec<u8>,
    channels: &mut Vec<u8>,
) {
    let rectangle = |left: i32, top: i32, width: u32, height: u32| {
        [top, left, top + height as i32, left + width as i32]
            .map(i32::to_be_bytes)
            .concat()
    };
    records.extend(rectangle(patch.left, patch.top, patch.width, patch.height));
    records.extend((own.len() as u16).to_be_bytes());
    for (number, bytes) in own {
        records.extend(number.to_be_bytes());
        put_length(records, bytes.len(), options);
        channels.extend(bytes);
    }
    records.extend(b"8BIM");
    records.extend(if node.is_multiplied { b"mul " } else { b"norm" });
    records.extend([
        node.opacity,
        node.is_clipped.into(),
        if node.is_visible { 0 } else { 2 },
        0,
    ]);
    let mut extra = Vec::new();
    match &node.mask {
        None => extra.extend(0_u32.to_be_bytes()),
        Some(mask) => {
            extra.extend(20_u32.to_be_bytes());
            extra.extend(rectangle(mask.left, mask.top, mask.width, mask.height));
            extra.extend([0, 0, 0, 0]);
        }
    }
    extra.extend(0_u32.to_be_bytes());
    // A short name in another encoding, then the whole one.
    extra.extend([3, b'?', b'?', b'?']);
    let units: Vec<u16> = node.name.encode_utf16().collect();
    extra.extend(b"8BIMluni");
    extra.extend((4 + 2 * units.len() as u32).to_be_bytes());
    extra.extend((units.len() as u32).to_be_bytes());
    extra.extend(units.iter().flat_map(|unit| unit.to_be_bytes()));
    extra.extend(blocks);
    records.extend((extra.len() as u32).to_be_bytes());
    records.append(&mut extra);
}

/// The bytes of a channel.
fn stored(values: &[u8], width: u32, options: Options) -> Vec<u8> {
    let mut bytes = options.compression.to_be_bytes().to_vec();
    let rows: Vec<Vec<u8>> = values
        .chunks(width.max(1) as usize)
        .map(|row| match options.depth {
            8 => row.to_vec(),
            _ => row.iter().flat_map(|&value| [value, value]).collect(),
        })
        .collect();
    match options.compression {
        0 => bytes.extend(rows.concat()),
        1 => {
            let rows: Vec<Vec<u8>> = rows.iter().map(|row| packed(row)).collect();
            for row in &rows {
                if options.is_large {
                    bytes.extend((row.len() as u32).to_be_bytes());
                } else {
                    bytes.extend((row.len() as u16).to_be_bytes());
                }
            }
            bytes.extend(rows.concat());
        }
        compression => {
            let mut encoder = flate2::write::ZlibEncoder::new(&mut bytes, flate2::Compression::fast());
            for row in rows {
                let row = if compression == 3 {
                    differences(&row, options.depth)
                } else {
                    row
                };
                encoder.write_all(&row).expect("deflated");
            }
            encoder.finish().expect("deflated");
        }
    }
    bytes
}

fn differences(row: &[u8], depth: u16) -> Vec<u8> {
    if depth == 8 {
        let before = std::iter::once(&0).chain(row);
        return row
            .iter()
            .zip(before)
            .map(|(value, before)| value.wrapping_sub(*before))
            .collect();
    }
    let values: Vec<u16> = row
        .chunks(2)
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
        .collect();
    let before = std::iter::once(&0).chain(&values);
    let steps = values
        .iter()
        .zip(before)
        .map(|(value, before)| value.wrapping_sub(*before));
    steps.flat_map(u16::to_be_bytes).collect()
}

/// PackBits, with runs where three values are equal.
fn packed(row: &[u8]) -> Vec<u8> {
    let mut packed = Vec::new();
    let mut at = 0;
    while at < row.len() {
        let run = row[at..]
            .iter()
            .take(128)
            .take_while(|&&value| value == row[at])
            .count();
        if run >= 3 {
            packed.extend([(257 - run) as u8, row[at]]);
            at += run;
            continue;
        }
        let is_run = |k: usize| row[k..].len() >= 3 && row[k] == row[k + 1] && row[k] == row[k + 2];
        let mut end = at + 1;
        while end < row.len() && end - at < 128 && !is_run(end) {
            end += 1;
        }
        packed.push((end - at - 1) as u8);
        packed.extend(&row[at..end]);
        at = end;
    }
    packed
}
