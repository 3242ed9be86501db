//! stub
pub mod articulation;
pub mod control;
pub mod head;
pub mod key_frame;
pub use articulation::*;
pub use control::*;
pub use head::*;
pub use key_frame::*;
/// stub
#[derive(Clone, Debug)]
pub struct Calibration;
