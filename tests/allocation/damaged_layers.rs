//! A thousand damaged files of each layered format: nothing panics, every refusal is of its kind, and memory stays within what the canvas and the file need.

use inbetween::input::InputError;
use inbetween::input::layered::{Layer, LayeredError, LayeredFile};

use crate::art::{Node, Patch, SIZE, ellipse, poses};
use crate::zip::{self, Packing};
use crate::{ase, kra, ora, psd};

/// How many damaged files of each format are read.
const COUNT: u64 = 1000;
/// The most bytes at once that a file of a few kilobytes may need, whatever it claims: the largest canvas on the sheets that are allowed for it.
const MOST_BYTES: u64 = 1 << 31;
/// The same of a file whose canvas is still as small as it was drawn.
const MOST_BYTES_OF_SMALL: u64 = 64 << 20;

/// Numbers that look random and are the same every time (xorshift).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % below.max(1) as u64) as usize
    }
}

/// A file with some bytes changed, cut out, doubled or cut off.
fn damaged(bytes: &[u8], numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=numbers.next(4) {
        let at = numbers.next(bytes.len());
        // What decides most stands at the beginning.
        let at = if numbers.next(2) == 0 {
            at
        } else {
            at % 400.min(bytes.len().max(1))
        };
        match numbers.next(7) {
            0 => bytes[at] = numbers.next(256) as u8,
            1 => bytes[at] ^= 1 << numbers.next(8),
            2 => {
                let value = [0, 1, 0x7f, 0x80, 0xff][numbers.next(5)];
                let end = (at + 1 + numbers.next(8)).min(bytes.len());
                bytes[at..end].fill(value);
            }
            3 => bytes.truncate(at.max(8)),
            4 => {
                let end = (at + numbers.next(40)).min(bytes.len());
                bytes.drain(at..end);
            }
            5 => {
                let end = (at + numbers.next(40)).min(bytes.len());
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            _ => {
                let other = numbers.next(bytes.len());
                bytes.swap(at, other);
            }
        }
        if bytes.len() < 16 {
            break;
        }
    }
    bytes
}

/// Everything that can be asked of a file.
fn read(bytes: &[u8]) -> Result<(), InputError> {
    let file = LayeredFile::open(bytes)?;
    let mut paths = Vec::new();
    let mut open: Vec<&Layer> = file.layers().iter().collect();
    while let Some(layer) = open.pop() {
        paths.push(layer.path.clone());
        open.extend(layer.children());
    }
    // Of what has become a large picture one look is enough.
    let elements = if file.size()[0] * file.size()[1] > 1 << 20 {
        0
    } else {
        12
    };
    let mut refusal = Ok(());
    for frame in 0..file.frame_count().min(4) {
        for element in std::iter::once(None).chain(paths.iter().take(elements).map(|path| Some(path.as_str()))) {
            match file.picture(element, frame) {
                Ok(picture) => assert_eq!(picture.rgba.len(), picture.size[0] * picture.size[1] * 4),
                // No damage: nothing is drawn there.
                Err(InputError::Layered(LayeredError::EmptyLayer { .. } | LayeredError::NothingVisible)) => {}
                Err(error) => refusal = refusal.and(Err(error)),
            }
        }
    }
    refusal
}

/// Reads files that `damage` makes of whole ones.
fn assert_bounded(format: &str, damage: impl Fn(u64, &mut Numbers) -> Vec<u8>) {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    let mut refused = 0;
    for k in 0..COUNT {
        let bytes = damage(k, &mut numbers);
        let is_small = LayeredFile::open(&bytes).is_ok_and(|file| file.size()[0] * file.size()[1] <= 1 << 16);
        let mut outcome = Ok(());
        let used = allocation_counter::measure(|| outcome = read(&bytes)).bytes_max;
        let most = if is_small { MOST_BYTES_OF_SMALL } else { MOST_BYTES };
        assert!(used < most, "{format} {k}: {used} bytes");
        if let Err(refusal) = outcome {
            refused += 1;
            assert!(!refusal.to_string().is_empty());
        }
    }
    // The damage is real.
    assert!(refused > COUNT / 10, "{format}: only {refused} refused");
}

/// Takes some files in turn.
fn assert_bounded_files(format: &str, whole: &[Vec<u8>]) {
    for bytes in whole {
        read(bytes).expect("a whole file");
    }
    assert_bounded(format, |k, numbers| damaged(&whole[k as usize % whole.len()], numbers));
}

/// Damages an archive, and in turns a file in one that is whole: checksums keep readers from seeing what is damaged in it otherwise.
fn assert_bounded_archive(format: &str, whole: &[u8], files: &[(String, Vec<u8>)]) {
    read(whole).expect("a whole file");
    assert_bounded(format, |k, numbers| {
        let packing = if k % 3 == 0 { Packing::Stored } else { Packing::Deflated };
        if k % 4 == 0 {
            return damaged(whole, numbers);
        }
        let mut files = files.to_vec();
        // The description of the tree as often as all others.
        let place = if numbers.next(2) == 0 {
            1
        } else {
            1 + numbers.next(files.len() - 1)
        };
        if !files[place].1.is_empty() {
            files[place].1 = damaged(&files[place].1, numbers);
        }
        zip::write(&files, packing)
    });
}

/// The poses, and a group with everything that a layer can have.
fn art() -> Vec<Node> {
    let mut nodes = poses();
    let mut shade = Node::layer("shade", ellipse([30.0, 30.0], [12.0, 9.0], [60, 60, 160]));
    (shade.is_multiplied, shade.opacity) = (true, 150);
    let mut spots = Node::layer("spots", ellipse([36.0, 30.0], [9.0, 9.0], [10, 60, 60]));
    spots.is_clipped = true;
    let mut masked = Node::group(
        "masked",
        vec![
            Node::layer("base", ellipse([30.0, 30.0], [20.0, 20.0], [250, 230, 160])),
            spots,
            shade,
        ],
    );
    masked.mask = Some(Patch::new([10, 10], [40, 30], |x, y| (x * 5 + y) as u8));
    nodes.push(masked);
    nodes
}

#[test]
fn damaged_psd_files_are_refused() {
    let mut files = Vec::new();
    for compression in 0..4 {
        for (depth, is_large) in [(8, false), (16, false), (8, true)] {
            let options = psd::Options {
                depth,
                compression,
                is_large,
            };
            files.push(psd::write(SIZE, &art(), options));
        }
    }
    files.push(psd::write_flat(SIZE, [200, 100, 50], 1));
    files.push(psd::write(SIZE, &art(), psd::Options::default()));
    assert_bounded_files("PSD", &files);
}

#[test]
fn damaged_openraster_files_are_refused() {
    let whole = ora::write(SIZE, &art(), Packing::Deflated);
    assert_bounded_archive("OpenRaster", &whole, &ora::files(SIZE, &art()));
}

#[test]
fn damaged_krita_files_are_refused() {
    for (depth, is_compressed) in [(8, true), (16, false)] {
        let options = kra::Options { depth, is_compressed };
        let whole = kra::write(SIZE, &art(), options);
        assert_bounded_archive("Krita", &whole, &kra::files(SIZE, &art(), options));
    }
}

#[test]
fn damaged_aseprite_files_are_refused() {
    let mut files = Vec::new();
    for bits in [32, 16, 8] {
        for is_deflated in [true, false] {
            files.push(ase::write(SIZE, &art(), ase::Options { bits, is_deflated }));
        }
    }
    let patch = ellipse([30.0, 30.0], [14.0, 9.0], [200, 90, 30]);
    let frames = vec![
        vec![ase::Drawn::Patch(patch), ase::Drawn::Nothing],
        vec![ase::Drawn::Linked(0), ase::Drawn::Linked(0)],
    ];
    files.push(ase::write_frames(SIZE, &["body", "arm"], &frames, &[("go", 0, 1)]));
    files.push(ase::write(SIZE, &art(), ase::Options::default()));
    assert_bounded_files("Aseprite", &files);
}
