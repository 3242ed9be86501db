//! Sound and video files, in and out; knows nothing of labels, faces or the GPU.
//!
//! | module | does |
//! |---|---|
//! | [`wav`] | reads a user's sound file into 48 kHz mono |
//! | [`resample`] | another rate to 48 kHz, without a shift |
//! | [`output`] | files that appear whole or not at all |
//! | [`text`] | rows of text as they come |
//! | [`mp4`] | H.264 and Opus in MP4 |
//! | [`frames`] | one PNG a frame, or raw frames to standard output |
//! | [`ffmpeg`] | through the ffmpeg program of this machine |
//! | [`camera`] | which devices take pictures as a camera's |
//! | [`hidden`] | names of what is not finished yet |
//! | [`yuv`] | RGB to what video encoders take |

pub mod camera;
pub mod ffmpeg;
pub mod frames;
pub mod hidden;
pub mod mp4;
pub mod output;
pub mod resample;
pub mod text;
pub mod wav;
pub mod yuv;

/// What an encoder has to know before the first frame.
#[derive(Clone, Debug)]
pub struct Clip {
    pub width: u32,
    pub height: u32,
    /// Frames a second, as a fraction.
    pub fps: (u32, u32),
    /// How many frames there will be.
    pub frames: u64,
    /// Mono sound at 48 kHz that starts with the first frame; none writes a file without sound.
    pub sound: Option<std::sync::Arc<[f32]>>,
    /// Bits a second of the picture; none lets the encoder choose.
    pub bitrate: Option<u32>,
}

/// Where finished frames go. Dropped before `finish`, it leaves nothing behind.
pub trait FrameSink: Send {
    /// Takes the next frame: `width * height` RGBA pixels, rows from the top.
    fn frame(&mut self, rgba: &[u8]) -> anyhow::Result<()>;

    /// Completes the work: only now does anything appear under its final name.
    fn finish(self: Box<Self>) -> anyhow::Result<()>;
}
