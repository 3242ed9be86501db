//! The head shop, offline: scans in, heads out (HEADSHOP 5 and 6); and the reference head itself.
//!
//! | module | does |
//! |---|---|
//! | `mesh` | reads scans (OBJ, PLY, STL, glTF) and makes them ready: unit, position, strays |
//! | `landmarks` | landmark files |
//! | `marking` | the model of the landmark window |
//! | `warp` | thin-plate warps (HEADSHOP 5.1) |
//! | `closest` | nearest points and rays on a surface |
//! | `fit` | a template's skin fitted to a scan (HEADSHOP 6) |
//! | `refit` | a whole head made of a fitted skin (HEADSHOP 5.2) |
//! | `bones`, `muscles` | skull and mandible under a skin, muscles painted on it |
//! | `colour`, `hair` | the skin's colour map, hair and lashes |
//! | `sculpt` | the reference head (HEADSHOP 3) |
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
