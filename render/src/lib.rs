//! Mouthpiece's renderer: draws a [`Head`](mouthpiece_rig::Head) in the pose of a
//! [`KeyFrame`](mouthpiece_rig::KeyFrame), to a window or an offscreen image, by the same code
//! (HEADSHOP 4.4 for the skin, HABER 4.1 for eyes, teeth and tongue).
//!
//! # The life of a picture
//! [`Gpu`] picks an adapter and says which. [`Renderer::new`] paints the maps of skin, eyes and hair
//! on the processor (`maps`), turns the head's meshes into buffers (`surface`, `geometry`) and its
//! shaders into pipelines (`recipes`, `pipelines`). For each picture the skin's positions and normals, the hairs that follow it (`brows`) and one uniform block
//! (`gpu_data::Frame`) go up: where the bodies are, the camera ([`View`], [`Extent`]), the lamps
//! (`studio`) and the room's light (`environment`, `harmonics`), and how far mouth and eyes are open (`openings`). Then two passes: depth as the key
//! lamp sees it, and the picture. Each shader ends in the film's curve, so the resolve of the
//! multisampled picture averages finished colours.
//!
//! [`Offscreen`] reads pictures back, two in flight, and a [`Batch`] keeps all cores at it; [`WindowTarget`] shows them, and
//! gives one back as a [`Shot`] when asked. None
//! knows of time: the caller says which key frame is now.

#![forbid(unsafe_code)]

mod batch;
mod bindings;
mod brows;
mod coarse;
mod environment;
mod error;
mod folds;
mod frame;
mod gaze;
mod geometry;
mod governor;
mod gpu;
mod gpu_data;
mod hairs;
mod harmonics;
mod layouts;
mod maps;
mod model;
mod offscreen;
mod openings;
mod passes;
mod picture;
mod pipelines;
mod placing;
mod recipes;
mod renderer;
mod shader;
mod shot;
#[cfg(test)]
mod steady_tests;
mod studio;
mod surface;
mod targets;
mod tier;
mod upload;
mod view;
mod warm_up;
mod window;
#[cfg(test)]
mod wrong_shader_tests;

pub use batch::Batch;
pub use environment::Environment;
pub use error::RenderError;
pub use governor::Governor;
pub use gpu::{Gpu, GpuError};
pub use model::{SkinModel, UnknownSkinModel};
pub use offscreen::{FRAMES_IN_FLIGHT, Offscreen};
pub use picture::{PICTURE_SIDE_MAX, Picture, PictureError};
pub use placing::Placing;
pub use renderer::Renderer;
pub use shader::ShaderError;
pub use shot::{Shot, SmallPicture};
pub use tier::{Tier, UnknownTier};
pub use view::{Background, Camera, Extent, Framing, Shown, UnknownCamera, View};
pub use window::{Outcome, Overlay, WindowError, WindowTarget};
