//! `inbetween triangulate`.

use std::path::PathBuf;

use anyhow::Context as _;
use inbetween::compatible::RefineOptions;
use inbetween::pipeline::{Refinement, triangulate_polygons};
use inbetween::pose::Polygons;

use super::Failure;
use super::output::{Output, read_text};

/// Triangulate polygons whose vertices already correspond
///
/// Reads {"poses": [{"name", "outline": [[x, y], ...], "holes": [...]}]} with the same number of points in every pose.
/// Outlines have positive area (x y' - x' y summed), holes negative. The mesh covers exactly these polygons.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  inbetween triangulate polygons.json -o mapping.json --refine")]
pub(crate) struct Arguments {
    /// The polygons
    polygons: PathBuf,
    /// The mapping, or - for standard output
    #[arg(short, long, value_name = "MAPPING.json")]
    pub(super) output: PathBuf,
    /// Add vertices inside for better triangles
    #[arg(long)]
    refine: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let in_file = || arguments.polygons.display().to_string();
    let polygons = Polygons::from_json(&read_text(&arguments.polygons)?).with_context(in_file)?;
    let output = Output::open(&arguments.output)?;
    let refinement = if arguments.refine {
        Refinement::Refine(RefineOptions::default())
    } else {
        Refinement::Bare
    };
    let mapping = triangulate_polygons(&polygons, &refinement).with_context(in_file)?;
    Ok(output.write(mapping.to_json().as_bytes())?)
}
