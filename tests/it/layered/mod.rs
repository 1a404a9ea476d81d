//! Layered files. They are made byte by byte here, so that what is read is known.

mod art;
mod picture;
mod pixels;
mod psd;
mod scenes;

/// The same art in every format, by suffix.
fn in_all_formats(nodes: &[art::Node]) -> Vec<(&'static str, Vec<u8>)> {
    vec![("psd", psd::write(art::SIZE, nodes, psd::Options::default()))]
}
