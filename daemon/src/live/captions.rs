//! The text on the screen: a slot that holds the latest one, of bounded length since the wire bounds
//! it. The sound thread writes, since it knows what is heard; the window reads.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The slot. A lock guards a pointer for as long as it is copied; the reader takes it only when there is
/// something new.
#[derive(Debug)]
pub struct Captions {
    version: AtomicU64,
    text: Mutex<Arc<str>>,
}

impl Default for Captions {
    fn default() -> Self {
        Self {
            version: AtomicU64::new(0),
            text: Mutex::new(Arc::from("")),
        }
    }
}

impl Captions {
    /// Shows `text` from now on; an empty one clears the screen.
    pub fn set(&self, text: Arc<str>) {
        *self.text.lock().unwrap_or_else(PoisonError::into_inner) = text;
        self.version.fetch_add(1, Ordering::Release);
    }

    /// The text when it is another than the one whose number is in `seen`, which starts at 0 with no text.
    pub fn latest(&self, seen: &mut u64) -> Option<Arc<str>> {
        let version = self.version.load(Ordering::Acquire);
        if std::mem::replace(seen, version) == version {
            return None;
        }
        let text = self.text.lock().unwrap_or_else(PoisonError::into_inner);
        Some(Arc::clone(&text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_sees_the_latest_text_once() {
        let captions = Captions::default();
        let mut seen = 0;
        assert_eq!(captions.latest(&mut seen), None);
        captions.set("one".into());
        captions.set("two".into());
        assert_eq!(captions.latest(&mut seen).as_deref(), Some("two"));
        assert_eq!(captions.latest(&mut seen), None);
    }
}
