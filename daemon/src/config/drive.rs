//! `[drive]`: other avatars that move with our speech.

use serde::de::Error as _;
use serde::{Deserialize as _, Deserializer};

use super::section::section;
use super::value::Whole;
use crate::cli::DriveArg;

section! {
    /// Other avatars that move with our speech, over UDP.
    pub struct Drive {
        /// Each as "KIND:HOST" or "KIND:HOST:PORT". KIND is "vmc" (VRM 1.0), "vmc0" (VRM 0.x),
        /// "vmc-arkit" (ARKit's shapes), "livelink" (Unreal Engine) or "osc".
        #[serde(deserialize_with = "bounded")]
        to: Vec<DriveArg> = Vec::new() => at_start,
        /// How often a second they are told.
        rate_hz: Whole<1, 240> = Whole::new(60) => at_start,
    }
}

/// As many as there may be.
fn bounded<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<DriveArg>, D::Error> {
    let all = Vec::<DriveArg>::deserialize(from)?;
    DriveArg::check(&all).map_err(D::Error::custom)?;
    Ok(all)
}
