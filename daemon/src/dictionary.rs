//! A user's pronunciations, for labels that hold words alone.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context as _, bail};
use mouthpiece_phonemes::pronounce::Pronouncer;

/// Largest dictionary: the CMU's has 4 MB, those of aligners for all languages less than 64.
const FILE_BYTES_MAX: u64 = 64 << 20;

/// Reads the dictionary that the user names, and says on stderr what of it could not be used.
pub fn read(path: Option<&Path>) -> anyhow::Result<Option<Arc<Pronouncer>>> {
    let Some(path) = path else {
        return Ok(None);
    };
    let name = path.display();
    let about =
        || format!("{name}: cannot be read; give a dictionary with lines `WORD PHONE PHONE …`");
    let bytes = std::fs::metadata(path).with_context(about)?.len();
    if bytes > FILE_BYTES_MAX {
        bail!(
            "{name}: is larger than {} MiB; give a dictionary",
            FILE_BYTES_MAX >> 20
        );
    }
    let text = std::fs::read_to_string(path).with_context(about)?;
    let mut pronouncer = Pronouncer::new();
    for note in pronouncer.add_dictionary(&text) {
        tracing::warn!("{name}: {note}");
    }
    Ok(Some(Arc::new(pronouncer)))
}
