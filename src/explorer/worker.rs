//! What takes longer than a request may wait, and the look at the disk.

use std::path::PathBuf;
use std::time::Duration;

use inbetween::scene::{Scene, Workbench};

use super::problem::Problem;
use super::session::Session;
use super::stamp::{Stamp, stamp};

/// The time between two looks at the disk.
const BETWEEN_LOOKS: Duration = Duration::from_millis(400);

/// Computes what is wanted, the newest first, for as long as the process lives.
pub(crate) fn run(session: &Session) {
    loop {
        let (wanted, shown) = session.next_wanted();
        let make = || match &shown.bench {
            Some(bench) => bench.edited(&wanted.scene, wanted.files),
            None => Workbench::new(&wanted.scene),
        };
        let made = std::panic::catch_unwind(std::panic::AssertUnwindSafe(make));
        let made = match made {
            Ok(Ok(bench)) => Ok(bench),
            Ok(Err(error)) => Err(Problem::from(&error)),
            Err(_) => Err(Problem::new("this scene failed inside inbetween; undo the last edit")),
        };
        let camera_of = made.as_ref().ok().cloned();
        session.show(&wanted, made);
        // When the shapes can be seen already, and nobody waits for more.
        if let Some(bench) = camera_of
            && !wanted.is_dragged
            && !session.is_busy()
            && let Ok(filmed) = bench.filmed_anew()
            && filmed.camera() != bench.camera()
        {
            session.show(&wanted, Ok(filmed));
        }
    }
}

/// A file and its stamp.
type Stamped = (PathBuf, Option<Stamp>);

/// Looks at the scene file and the drawings again and again, for as long as the process lives.
pub(crate) fn watch(session: &Session) {
    let mut known: Vec<Stamped> = Vec::new();
    loop {
        std::thread::sleep(BETWEEN_LOOKS);
        session.look_at_file();
        session.temporary.refresh_copies();
        let Some(scene) = session.shown().scene.clone() else {
            continue;
        };
        let now = stamps(&scene);
        let has_changed = |stamp: &Stamped| known.iter().any(|old| old.0 == stamp.0 && old.1 != stamp.1);
        if now.iter().any(has_changed) {
            session.reread_drawings();
        }
        known = now;
    }
}

fn stamps(scene: &Scene) -> Vec<Stamped> {
    let folder = scene.file.parent().map(PathBuf::from).unwrap_or_default();
    let of = |scene: &Scene| -> Vec<Stamped> {
        let drawn = scene.drawn_poses().into_iter();
        let files = drawn.filter_map(|pose| Some(folder.join(&scene.drawing_of(pose)?.1.file)));
        files
            .map(|file| {
                let stamp = stamp(&file);
                (file, stamp)
            })
            .collect()
    };
    if scene.layers.is_empty() {
        of(scene)
    } else {
        scene.layers.iter().flat_map(|layer| of(&layer.scene)).collect()
    }
}
