//! Why a picture could not be drawn, in a sentence a user can act on.

use mouthpiece_rig::SubdivisionError;
use thiserror::Error;

use crate::gpu::GpuError;
use crate::shader::ShaderError;

/// Why a picture could not be drawn.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The key frame is of another head.
    #[error(
        "the key frame has {got} skin vertices but the head has {wanted}: draw frames of the head that was loaded"
    )]
    WrongHead {
        /// Vertices of the head.
        wanted: usize,
        /// Vertices of the frame.
        got: usize,
    },
    /// The picture is larger than the adapter can draw, or empty.
    #[error(
        "a picture of {width} x {height} pixels cannot be drawn: this graphics adapter does 1 to {max} a side"
    )]
    Size {
        /// Wanted width.
        width: u32,
        /// Wanted height.
        height: u32,
        /// Longest side that can be had.
        max: u32,
    },
    /// A shader file is broken.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The head's skin cannot be drawn.
    #[error(transparent)]
    Skin(#[from] SubdivisionError),
    /// The driver does not take our shaders or buffers.
    #[error(
        "the graphics driver refused to draw this: {0}; update the driver or choose another adapter with WGPU_ADAPTER_NAME"
    )]
    Refused(String),
    /// The driver was reset or the card is gone.
    #[error("the graphics device was lost: open it again")]
    DeviceLost,
    /// There is no opening it again.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The picture could not be read back.
    #[error("the picture could not be read back from the graphics adapter: {0}")]
    Readback(String),
    /// More pictures were asked for than there are buffers.
    #[error("{0} pictures are in flight already: take one first")]
    Full(usize),
}
