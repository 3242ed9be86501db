//! The head that is built in: made by the head shop (`rig/shop/src/sculpt`), carried as a file.

use crate::{Head, HeadError};

const HEAD: &[u8] = include_bytes!("../data/head.glb");

impl Head {
    /// The reference head.
    ///
    /// # Errors
    /// Only where the crate's own data is damaged: `cargo run --release -p mouthpiece-shop --example
    /// sculpt` makes it anew.
    pub fn reference() -> Result<Self, HeadError> {
        Self::read(HEAD)
    }
}
