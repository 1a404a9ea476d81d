//! Layered files. They are made byte by byte here, so that what is read is known.

mod art;
mod ase;
mod kra;
mod ora;
mod picture;
mod pixels;
mod psd;
mod scenes;
mod zip;

/// The same art in every format, by suffix.
fn in_all_formats(nodes: &[art::Node]) -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("psd", psd::write(art::SIZE, nodes, psd::Options::default())),
        ("ora", ora::write(art::SIZE, nodes, zip::Packing::Deflated)),
        ("kra", kra::write(art::SIZE, nodes, kra::Options::default())),
        ("ase", ase::write(art::SIZE, nodes, ase::Options::default())),
    ]
}
