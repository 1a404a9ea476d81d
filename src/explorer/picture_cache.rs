//! Pictures that were asked for, as files.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde_json::Value;

use super::model::Shown;
use super::pictures::{self, Kind};
use super::problem::Refusal;

/// A picture's place and its file.
type EncodedPicture = (Value, Result<Arc<Vec<u8>>, Refusal>);

/// By layer, drawing and kind.
type EncodedPictures = BTreeMap<(usize, usize, Kind), EncodedPicture>;

/// Those of the newest revision that was asked for.
#[derive(Debug, Default)]
pub(super) struct PictureCache(Mutex<(u64, EncodedPictures)>);

impl PictureCache {
    /// The picture of a layer's drawing: where it lies, and its PNG file. Made once.
    pub(super) fn picture(&self, shown: &Shown, layer: usize, index: usize, kind: Kind) -> EncodedPicture {
        let revision = shown.revisions.pictures;
        let key = (layer, index, kind);
        {
            let mut kept = self.lock();
            if kept.0 < revision {
                *kept = (revision, BTreeMap::new());
            }
            if let Some(picture) = kept.1.get(&key).filter(|_| kept.0 == revision) {
                return picture.clone();
            }
        }
        let Some(bench) = &shown.bench else {
            return (Value::Null, Err(Refusal::failed("there is no drawing")));
        };
        let placed = pictures::picture(bench, layer, index, kind);
        let picture = (placed.place(), pictures::png(&placed.texture).map(Arc::new));
        let mut kept = self.lock();
        if kept.0 == revision {
            kept.1.insert(key, picture.clone());
        }
        picture
    }

    fn lock(&self) -> MutexGuard<'_, (u64, EncodedPictures)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
