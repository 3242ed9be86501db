//! One video: what it looks like, and the loop that makes it.
//!
//! Three threads with bounded queues between them: the simulation makes key frames, this one draws
//! them, the encoder takes the pictures. Frame `k` shows tick `k * 48000 * den / num` to the tick,
//! whatever any thread is doing. Nothing appears under the final name before
//! all of it is there.

use std::sync::Arc;

use super::encoder::Encoder;
use super::stage::Stage;
use crate::cli::{ExportArgs, Fps, LookArgs, Size};
use crate::input::Utterance;
use crate::interrupt;
use crate::media::{Clip, FrameSink};
use crate::pipeline::{Cast, Instants, Mood, Part};

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

impl Job {
    /// What `args` name, spoken by `cast`.
    pub fn load(args: &ExportArgs, cast: Cast) -> anyhow::Result<Self> {
        Ok(Self {
            utterance: Utterance::load(&args.input)?,
            cast,
            size: args.size,
            fps: args.fps,
            look: args.look.clone(),
            mood: Mood::load(&args.mood)?,
            seed: args.seed,
            bitrate: args.bitrate,
        })
    }

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

    /// Draws all frames into `sink` and completes it; says how many are drawn.
    pub fn export(
        &self,
        stage: &mut Stage,
        sink: Box<dyn FrameSink>,
        clip: &Clip,
        tell: &dyn Fn(u64),
    ) -> anyhow::Result<()> {
        let done = self.draw(stage, sink, clip, tell);
        // Ctrl-C reaches ffmpeg, too: that it has stopped is no news then.
        done.map_err(|error| interrupt::check().err().map_or(error, Into::into))
    }

    fn draw(
        &self,
        stage: &mut Stage,
        sink: Box<dyn FrameSink>,
        clip: &Clip,
        tell: &dyn Fn(u64),
    ) -> anyhow::Result<()> {
        let cast = &self.cast;
        let part = Part::new(cast, &self.utterance.segments, Some(self.seed))
            .hearing(self.utterance.sound.as_deref())
            .with_mood(self.mood.clone());
        let (fps, frames) = (self.fps, clip.frames);
        let times = (0..frames).map(move |k| fps.ticks(k));
        let instants = Instants::start(Arc::clone(&cast.head), part, times)?;
        let view = self.look.view()?;
        let batch = stage.batch();
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
                tell(drawn);
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
