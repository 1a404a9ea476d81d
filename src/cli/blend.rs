//! `inbetween blend`.

use std::path::PathBuf;

use anyhow::Context as _;
use inbetween::blend::{BlendOptions, Certifier, FrameGuard, Reference, RigidBlend, Stretch};
use inbetween::pipeline::checked_weights;
use inbetween::pose::{Overlaps, PoseSet};
use serde::Serialize;

use super::certificate::{CertificateText, defect};
use super::output::{Output, read_text};
use super::values::Numbers;
use super::{Failure, Verbosity};

/// Blend the poses of a mapping
///
/// Writes {"vertices": [[x, y], ...], "weights": [...], "flipped": count} for one set of weights.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  inbetween blend walker.json --weights 0.5,0.5,0,0,0 -o half.json
  inbetween blend walker.json --weights 0.5,0.5,0,0,0 --certify -o half.json   and what can be proven of it")]
pub(crate) struct Arguments {
    /// The mapping
    mapping: PathBuf,
    /// Weights, one a pose, that sum to 1
    #[arg(long, value_name = "W0,W1,...", allow_hyphen_values = true)]
    weights: Numbers,
    /// What transformations are measured from: canonical (no pose is special), or a pose's name (the paper's form)
    #[arg(long, value_name = "canonical|POSE", default_value = "canonical")]
    reference: String,
    /// How stretches are blended
    #[arg(long, default_value = "linear", value_parser = Stretch::NAMED.map(|(name, _)| name))]
    stretch: String,
    /// What happens to triangles that come out inverted
    #[arg(long, default_value = "off", value_parser = ["off", "repair"])]
    frame_guard: String,
    /// Add what can be said of the frame for certain: "certificate": {"positive", "simple", "overlaps", "largest_distortion", "largest_area", "of_poses": {"distortion", "area"}}
    #[arg(long)]
    certify: bool,
    /// The blended frame, or - for standard output
    #[arg(short, long, value_name = "FRAME.json")]
    pub(super) output: PathBuf,
}

#[derive(Serialize)]
struct FrameText {
    vertices: Vec<[f64; 2]>,
    weights: Vec<f64>,
    flipped: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<CertificateText>,
}

pub(crate) fn run(arguments: &Arguments, verbosity: Verbosity) -> Result<(), Failure> {
    let in_file = || arguments.mapping.display().to_string();
    let text = read_text(&arguments.mapping)?;
    let poses = PoseSet::from_mapping_json(&text).with_context(in_file)?;
    let weights = checked_weights(&arguments.weights.0, poses.names()).context("--weights")?;
    let reference = match arguments.reference.as_str() {
        "canonical" => Reference::Canonical,
        name => Reference::Pose(poses.index_of(name).with_context(|| {
            format!(
                "--reference: {} has no pose '{name}'; its poses are {}",
                in_file(),
                poses.names().join(", ")
            )
        })?),
    };
    let stretch = Stretch::named(&arguments.stretch).unwrap_or_default();
    let output = Output::open(&arguments.output)?;
    let mut options = BlendOptions::default();
    options.reference = reference;
    options.stretch = stretch;
    options.guard = match arguments.frame_guard.as_str() {
        "repair" => FrameGuard::Repair,
        _ => FrameGuard::Off,
    };
    let blend = RigidBlend::new(&poses, &options).with_context(in_file)?;
    let mut vertices = Vec::new();
    let report = blend
        .blend(&weights, &mut blend.scratch(), &mut vertices)
        .with_context(in_file)?;
    if report.repaired {
        verbosity.note("note: some triangles would have been inverted at these weights; the frame was repaired");
    }
    // A certificate says it with the place.
    if report.flipped > 0 && !arguments.certify {
        verbosity.note(&format!(
            "note: {} triangles are inverted at these weights",
            report.flipped
        ));
    }
    let certificate = if arguments.certify {
        let overlaps = Overlaps::from_mapping_json(&text).with_context(in_file)?;
        let certifier = Certifier::new(&poses, &overlaps, &options).with_context(in_file)?;
        let certificate = certifier.certify(&weights, &vertices).with_context(in_file)?;
        let triangles = poses.topology().triangles();
        let repair = (options.guard == FrameGuard::Off).then_some("--frame-guard repair");
        if let Some(defect) = defect(&certificate, triangles, &vertices, repair) {
            verbosity.note(&format!("note: {defect}"));
        }
        Some(CertificateText::worst_of(std::iter::once(&certificate)))
    } else {
        None
    };
    let mut text = serde_json::to_string(&FrameText {
        vertices: vertices.iter().map(|p| [p.x, p.y]).collect(),
        weights,
        flipped: report.flipped,
        certificate,
    })?;
    text.push('\n');
    Ok(output.write(text.as_bytes())?)
}
