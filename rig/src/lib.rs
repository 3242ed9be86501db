//! stub
pub mod articulation;
pub mod control;
pub mod head;
pub mod key_frame;
pub mod muscle;
mod occlusion;
pub mod reference;
pub use articulation::*;
pub use control::*;
pub use head::*;
pub use key_frame::*;
