//! `[wire]`: who may speak through the face, and how much.

use super::section::section;

section! {
    /// Who may speak through the face, and how much.
    pub struct Wire {
        /// Where to listen: unix:PATH or HOST:PORT on loopback. Not set: mouthpiece.sock in
        /// $XDG_RUNTIME_DIR.
        listen: Option<String> = None => at_start,
    }
}
