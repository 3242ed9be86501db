//! `mouthpiece export`: labels and sound in, a finished video out.
//!
//! Three threads with bounded queues between them: the simulation makes key frames, this one draws
//! them, the encoder takes the pictures. Frame `k` shows tick `k * 48000 * den / num` to the tick,
//! whatever any thread is doing. Nothing appears under the final name before
//! all of it is there.

mod encoder;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant as Wall;

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressStyle};
use mouthpiece_render::{Batch, Gpu};

use crate::cli::{BackgroundArg, ExportArgs, Fps, LookArgs, Size, Usage};
use crate::input::Utterance;
use crate::interrupt;
use crate::media::ffmpeg::FfmpegSink;
use crate::media::frames::{PngSink, RawSink};
use crate::media::mp4::Mp4Sink;
use crate::media::{Clip, FrameSink};
use crate::pipeline::{Cast, Instants, Mood, Part};
use encoder::Encoder;

/// Everything that decides what an export looks like, apart from where it goes.
pub struct Job {
    pub cast: Cast,
    pub utterance: Utterance,
    pub size: Size,
    pub fps: Fps,
    pub look: LookArgs,
    pub mood: Mood,
    pub seed: u64,
    pub bitrate: Option<u32>,
}

/// Runs the command.
pub fn run(args: &ExportArgs) -> anyhow::Result<()> {
    opaque_or_kept(args)?;
    let job = Job {
        utterance: Utterance::load(&args.input)?,
        cast: Cast::load(&args.cast)?,
        size: args.size,
        fps: args.fps,
        look: args.look.clone(),
        mood: Mood::load(&args.mood)?,
        seed: args.seed,
        bitrate: args.bitrate,
    };
    let started = Wall::now();
    let clip = job.clip();
    let sink = sink(&args.output, &clip, args.via_ffmpeg)?;
    let bar = ProgressBar::new(clip.frames).with_style(
        ProgressStyle::with_template("{bar:40} {pos}/{len} frames, {eta} left {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let done = job.export(sink, &clip, &bar);
    bar.finish_and_clear();
    done?;
    tracing::info!(
        frames = clip.frames,
        seconds = started.elapsed().as_secs_f64(),
        "wrote {}",
        args.output.display()
    );
    Ok(())
}

impl Job {
    /// What the encoder has to know. The clip is a whole number of frames, and the sound as long.
    pub fn clip(&self) -> Clip {
        let frames = self.fps.frames(self.utterance.ticks);
        let length = usize::try_from(self.fps.ticks(frames)).unwrap_or(0);
        let sound = self.utterance.sound.as_deref().map(|sound| {
            let mut sound = sound.to_vec();
            sound.resize(length, 0.0);
            Arc::from(sound)
        });
        Clip {
            width: self.size.width,
            height: self.size.height,
            fps: (self.fps.num, self.fps.den),
            frames,
            sound,
            bitrate: self.bitrate,
        }
    }

    /// Draws all frames into `sink` and completes it.
    pub fn export(
        &self,
        sink: Box<dyn FrameSink>,
        clip: &Clip,
        bar: &ProgressBar,
    ) -> anyhow::Result<()> {
        let cast = &self.cast;
        let part = Part::new(cast, &self.utterance.segments, Some(self.seed))
            .hearing(self.utterance.sound.as_deref())
            .with_mood(self.mood.clone());
        let (fps, frames) = (self.fps, clip.frames);
        let times = (0..frames).map(move |k| fps.ticks(k));
        let instants = Instants::start(Arc::clone(&cast.head), part, times)?;
        let gpu = Gpu::headless()?;
        let size = (clip.width, clip.height);
        let mut batch = Batch::new(&gpu, &cast.head, size, self.look.tier.into())?;
        let view = self.look.view()?;
        let mut encoder = Encoder::start(sink)?;

        let mut next = Some(());
        let mut drawn = 0;
        while next.is_some() || !batch.is_empty() {
            interrupt::check()?;
            next = next
                .and_then(|()| instants.next())
                .map(|instant| {
                    let submitted = batch.submit(&instant.frame, &view);
                    instants.recycle(instant);
                    submitted
                })
                .transpose()?;
            // While the next pictures are drawn, the oldest is read back.
            if (next.is_none() || batch.is_full())
                && let Some(rgba) = batch.take()?
            {
                encoder.push(rgba)?;
                drawn += 1;
                bar.set_position(drawn);
            }
        }
        instants.finish()?;
        anyhow::ensure!(
            drawn == frames,
            "only {drawn} of {frames} frames were drawn"
        );
        let sink = encoder.finish()?;
        interrupt::check()?;
        sink.finish()
    }
}

/// What shows through must go where it can be kept.
fn opaque_or_kept(args: &ExportArgs) -> anyhow::Result<()> {
    let name = args.output.to_string_lossy();
    let kept = name == "-" || name.ends_with('/') || name.ends_with(".png") || args.output.is_dir();
    if args.look.scene.background == Some(BackgroundArg::Transparent) && (!kept || args.via_ffmpeg)
    {
        return Err(Usage(format!(
            "--background transparent: {name} would not keep it; write out-%05d.png, a folder/ or - (raw RGBA)"
        ))
        .into());
    }
    Ok(())
}

/// Where frames go, by the name of the output.
fn sink(output: &Path, clip: &Clip, via_ffmpeg: bool) -> anyhow::Result<Box<dyn FrameSink>> {
    let ending = output
        .extension()
        .and_then(|e| e.to_str())
        .map(str::to_ascii_lowercase);
    let folder = output.is_dir() || output.to_string_lossy().ends_with('/');
    Ok(match ending.as_deref() {
        _ if output == Path::new("-") => Box::new(RawSink::stdout()),
        _ if via_ffmpeg => Box::new(FfmpegSink::new(output, clip)?),
        _ if folder => Box::new(PngSink::new(output, clip)?),
        Some("mp4" | "m4v") => Box::new(Mp4Sink::new(output, clip)?),
        Some("png") => Box::new(PngSink::new(output, clip)?),
        _ => {
            return Err(Usage(format!(
                "what {} should be is not known; name it .mp4, out-%05d.png or a folder/, or give --via-ffmpeg for other kinds",
                output.display()
            )))
            .context("--output");
        }
    })
}
