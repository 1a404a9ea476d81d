//! The certificates of rendered frames: a file beside the output, one JSON object a line and frame.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use inbetween::animation::Animation;
use inbetween::blend::{Certificate, Certifier, FrameGuard};
use inbetween::export::PendingFile;
use inbetween::pipeline::Character;
use rayon::prelude::*;
use serde::Serialize;

use crate::cli::certificate::{CertificateText, defect};

/// What the name of the output is followed by.
const SUFFIX: &str = ".certificates.jsonl";

/// Which frames are certified, and where that is written.
pub(super) struct Certification {
    target: PathBuf,
    numbers: Vec<usize>,
    /// Opened before any work is done, unless its folder is one that the frames will make.
    file: Mutex<Option<PendingFile>>,
}

/// A line of the file. Frames count from 1, as `--frames` and the names of files do.
#[derive(Serialize)]
struct FrameText<'a> {
    frame: usize,
    at: &'a [f64],
    weights: &'a [f64],
    #[serde(flatten)]
    certificate: CertificateText,
    /// In scenes of several layers, those that are seen in the frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    layers: Option<Vec<LayerText<'a>>>,
}

#[derive(Serialize)]
struct LayerText<'a> {
    layer: &'a str,
    weights: &'a [f64],
    #[serde(flatten)]
    certificate: CertificateText,
}

/// A frame's line, and what is broken in it.
struct Certified {
    line: String,
    defect: Option<String>,
}

impl Certification {
    /// For the frames of these numbers of an output.
    ///
    /// # Errors
    /// What is wrong with a name that nothing can be written beside.
    pub(super) fn beside(output: &Path, numbers: &[usize]) -> Result<Self, String> {
        let refused = |why: &str| {
            format!(
                "--certify: {} {why}; certificates are written beside the output, so give -o a file or a folder",
                output.display()
            )
        };
        if output.as_os_str() == "-" {
            return Err(refused("is standard output"));
        }
        if std::fs::metadata(output).is_ok_and(|there| !there.is_file() && !there.is_dir()) {
            return Err(refused("is a device or a pipe"));
        }
        // The folder `.` has a name, too.
        let whole = output.canonicalize();
        let named = match (output.file_name(), &whole) {
            (None, Ok(whole)) => whole.as_path(),
            _ => output,
        };
        let mut name = named.file_name().ok_or_else(|| refused("has no name"))?.to_owned();
        name.push(SUFFIX);
        Ok(Self {
            target: named.with_file_name(name),
            numbers: numbers.to_vec(),
            file: Mutex::new(None),
        })
    }

    /// Opens the file, so that what cannot be written is known before any work is done.
    pub(super) fn open(&self) -> anyhow::Result<()> {
        let has_folder = self
            .target
            .parent()
            .is_none_or(|folder| folder.as_os_str().is_empty() || folder.is_dir());
        if has_folder {
            let file = PendingFile::create(&self.target)?;
            self.file
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner)
                .replace(file);
        }
        Ok(())
    }

    /// Certifies the frames and writes the file.
    ///
    /// # Errors
    /// If the file cannot be written, or if a certificate does not hold.
    pub(super) fn write(&self, character: &Character, animation: &Animation) -> anyhow::Result<()> {
        let certifiers = character.certifiers()?;
        let certified = |number: &usize| certified(character, &certifiers, animation, *number);
        let frames: Vec<Certified> = self.numbers.par_iter().map(certified).collect::<anyhow::Result<_>>()?;
        let opened = self
            .file
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .take();
        let file = opened.map_or_else(|| PendingFile::create(&self.target), Ok)?;
        let text: String = frames.iter().map(|frame| frame.line.as_str()).collect();
        file.fill(text.as_bytes())?;
        let mut broken = frames.iter().filter_map(|frame| frame.defect.as_ref());
        let Some(first) = broken.next() else { return Ok(()) };
        let others = match broken.count() {
            0 => String::new(),
            count => format!("; {count} more of {} frames do not hold either", self.numbers.len()),
        };
        anyhow::bail!("{first}{others} ({})", self.target.display())
    }
}

fn certified(
    character: &Character,
    certifiers: &[Certifier],
    animation: &Animation,
    number: usize,
) -> anyhow::Result<Certified> {
    let place = animation.place_of_frame(number - 1);
    let weights = character.weights_at(&place)?;
    let posed = character.posed_of(&weights)?;
    let shapes = character.layers();
    let is_one_of_several = shapes.len() > 1;
    let (mut seen, mut defects): (Vec<(usize, Certificate)>, Vec<String>) = (Vec::new(), Vec::new());
    for (k, (layer, certifier)) in posed.layers.iter().zip(certifiers).enumerate() {
        if layer.opacity <= 0.0 {
            continue;
        }
        let certificate = certifier.certify(&layer.weights, &layer.positions)?;
        let triangles = shapes[k].mapping().poses.topology().triangles();
        let is_off = shapes[k].options().guard == FrameGuard::Off;
        let repair = is_off.then_some("`guard = \"repair\"` under [blend]");
        if let Some(defect) = defect(&certificate, triangles, &layer.positions, repair) {
            defects.push(if is_one_of_several {
                format!("layer '{}': {defect}", shapes[k].name())
            } else {
                defect
            });
        }
        seen.push((k, certificate));
    }
    let of_layer = |(k, certificate): &(usize, Certificate)| LayerText {
        layer: shapes[*k].name(),
        weights: &posed.layers[*k].weights,
        certificate: CertificateText::worst_of(std::iter::once(certificate)),
    };
    let mut line = serde_json::to_string(&FrameText {
        frame: number,
        at: &place,
        weights: &weights,
        certificate: CertificateText::worst_of(seen.iter().map(|(_, certificate)| certificate)),
        layers: is_one_of_several.then(|| seen.iter().map(of_layer).collect()),
    })?;
    line.push('\n');
    let at: Vec<String> = place.iter().map(|x| format!("{x:.3}")).collect();
    Ok(Certified {
        line,
        defect: (!defects.is_empty()).then(|| format!("frame {number} at ({}): {}", at.join(", "), defects.join("; "))),
    })
}
