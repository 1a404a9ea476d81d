//! A writer of ZIP archives.

use std::io::Write as _;

/// How the files of an archive are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Packing {
    Stored,
    Deflated,
}

/// An archive of these files; the first one is stored as it is, as the kind of file has to be.
pub(crate) fn write(files: &[(String, Vec<u8>)], packing: Packing) -> Vec<u8> {
    let mut archive = Vec::new();
    let mut directory = Vec::new();
    for (place, (name, bytes)) in files.iter().enumerate() {
        let is_deflated = place > 0 && packing == Packing::Deflated;
        let stored = if is_deflated {
            let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(bytes).expect("deflated");
            encoder.finish().expect("deflated")
        } else {
            bytes.clone()
        };
        let mut checksum = flate2::Crc::new();
        checksum.update(bytes);
        let mut head = Vec::new();
        head.extend(20_u16.to_le_bytes());
        head.extend([0; 2]);
        head.extend(if is_deflated { 8_u16 } else { 0 }.to_le_bytes());
        head.extend([0; 4]);
        head.extend(checksum.sum().to_le_bytes());
        head.extend((stored.len() as u32).to_le_bytes());
        head.extend((bytes.len() as u32).to_le_bytes());
        head.extend((name.len() as u16).to_le_bytes());
        head.extend([0; 2]);
        directory.extend(b"PK\x01\x02\x14\0");
        directory.extend(&head);
        directory.extend([0; 10]);
        directory.extend((archive.len() as u32).to_le_bytes());
        directory.extend(name.as_bytes());
        archive.extend(b"PK\x03\x04");
        archive.extend(&head);
        archive.extend(name.as_bytes());
        archive.extend(&stored);
    }
    let count = (files.len() as u16).to_le_bytes();
    let (start, length) = (archive.len() as u32, directory.len() as u32);
    archive.append(&mut directory);
    archive.extend(b"PK\x05\x06\0\0\0\0");
    archive.extend(count);
    archive.extend(count);
    archive.extend(length.to_le_bytes());
    archive.extend(start.to_le_bytes());
    archive.extend([0; 2]);
    archive
}

/// Text as the value of an attribute.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
