//! MP4 with H.264 and Opus, written by this process alone: no ffmpeg, no system codec.
//!
//! | module | does |
//! |---|---|
//! | [`h264`] | frames to H.264 (openh264) |
//! | [`opus`] | sound to Opus (ropus) |
//! | [`mux`] | both into one file, in order of time |
//! | [`boxes`] | the file's table of contents |
//!
//! Picture and sound both start at 0: the encoder's priming samples are declared in an edit list
//! and in `dOps`, so that every reader drops them. One thread, no clock, no random number: the same
//! frames and sound give the same bytes. Opus, because its encoder is free and written in Rust.

mod boxes;
mod h264;
mod mux;
mod opus;

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use anyhow::{Context as _, bail};

use super::output::{Output, unwritable};
use super::{Clip, FrameSink};
use h264::Video;
use mux::{AudioPlan, Muxer, Plan};
use opus::Packets;

/// The longest sides that the encoder takes.
const SIDES_MAX: (u32, u32) = (3840, 2160);

/// Encodes and writes one MP4.
pub struct Mp4Sink {
    output: Output,
    muxer: Muxer<BufWriter<File>>,
    video: Video,
    sound: Option<Packets>,
    fps: (u32, u32),
    done: u64,
}

impl Mp4Sink {
    /// Prepares `target`.
    pub fn new(target: &Path, clip: &Clip) -> anyhow::Result<Self> {
        let (width, height) = (clip.width, clip.height);
        if width % 2 != 0 || height % 2 != 0 {
            let even = |side: u32| side.next_multiple_of(2);
            bail!(
                "H.264 needs even sides: use --size {}x{}",
                even(width),
                even(height)
            );
        }
        if width.max(height) > SIDES_MAX.0 || width.min(height) > SIDES_MAX.1 {
            bail!(
                "{width}x{height} is more than H.264 takes here ({}x{}); use a .png sequence or --via-ffmpeg",
                SIDES_MAX.0,
                SIDES_MAX.1
            );
        }
        let mut output = Output::create(target)?;
        let video = Video::new(clip)?;
        let sound = clip.sound.clone().map(Packets::new).transpose()?;
        let plan = Plan {
            width,
            height,
            fps: clip.fps,
            frames: clip.frames,
            audio: sound.as_ref().map(|packets| AudioPlan {
                length: packets.length(),
                pre_skip: packets.pre_skip(),
                packets: packets.count(),
            }),
        };
        let file = output.file().try_clone()?;
        let muxer = Muxer::new(BufWriter::new(file), plan).map_err(|e| unwritable(target, &e))?;
        Ok(Self {
            output,
            muxer,
            video,
            sound,
            fps: clip.fps,
            done: 0,
        })
    }

    /// Writes the sound that starts before `samples`.
    fn sound_until(&mut self, samples: u64) -> anyhow::Result<()> {
        let Some(packets) = &mut self.sound else {
            return Ok(());
        };
        while packets.next_start() < samples {
            let Some(packet) = packets.next()? else {
                break;
            };
            self.muxer
                .audio(packet)
                .map_err(|e| self.output.unwritable(&e))?;
        }
        Ok(())
    }
}

impl FrameSink for Mp4Sink {
    fn frame(&mut self, rgba: &[u8]) -> anyhow::Result<()> {
        let millis = self.done * 1000 * u64::from(self.fps.1) / u64::from(self.fps.0);
        let (sample, key) = self.video.encode(rgba, millis)?;
        self.muxer
            .video(sample, key)
            .map_err(|e| self.output.unwritable(&e))?;
        self.done += 1;
        let next = self.done * 48_000 * u64::from(self.fps.1) / u64::from(self.fps.0);
        self.sound_until(next)
    }

    fn finish(mut self: Box<Self>) -> anyhow::Result<()> {
        self.sound_until(u64::MAX)?;
        let config = self.video.config().context("there is no frame to write")?;
        self.muxer
            .finish(config)
            .map_err(|e| self.output.unwritable(&e))?;
        self.output.commit()
    }
}

#[cfg(test)]
mod tests;
