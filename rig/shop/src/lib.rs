//! The head shop, offline: scans in, heads out (HEADSHOP 5 and 6); and the reference head itself.
#![forbid(unsafe_code)]

pub mod bones;
pub mod closest;
pub mod colour;
pub mod fit;
pub mod hair;
pub mod landmarks;
pub mod marking;
pub mod mesh;
pub mod muscles;
pub mod refit;
pub mod sculpt;
pub mod warp;

mod lines;
mod noise;
mod occlusion;
