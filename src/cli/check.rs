//! `inbetween check`.

use std::path::PathBuf;

use anyhow::Context as _;
use inbetween::pose::{Mapping, MeshQuality};

use super::Failure;
use super::output::{Output, read_text};

/// Prove a mapping valid
///
/// Exits with 0 and one line if it is: one topology, every triangle positive in every pose, boundaries simple and equal
/// to the stated rings, every outline inside its mesh. The line ends with angles and stretches. Otherwise exits with 1 and says what is broken.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  inbetween check walker.json")]
pub(crate) struct Arguments {
    /// The mapping
    mapping: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let in_file = || arguments.mapping.display().to_string();
    let mapping = Mapping::from_json(&read_text(&arguments.mapping)?).with_context(in_file)?;
    mapping.check().with_context(in_file)?;
    let quality = MeshQuality::of(&mapping.poses);
    let line = format!(
        "{}: valid: {} poses, {} vertices, {} triangles, {} holes, {} Steiner points; smallest angle {:.1} degrees, 5th \
         percentile {:.1}; stretch between poses {:.2}, largest {:.1}\n",
        in_file(),
        mapping.poses.len(),
        mapping.poses.topology().vertex_count(),
        mapping.poses.topology().triangles().len(),
        mapping.rings.len().saturating_sub(1),
        mapping.steiner,
        quality.smallest_angle_deg,
        quality.low_angle_deg,
        quality.median_stretch,
        quality.largest_stretch
    );
    Ok(Output::Standard.write(line.as_bytes())?)
}
