//! The simulation thread: the head's motion, a bounded lead ahead of what is heard (HABER 5.3).
//!
//! Wanted: the picture is never late for the sound; whatever comes late (a label, `stop`) is felt
//! from the audible instant on all the same; never waits for the renderer; allocates nothing per
//! step; sleeps when it is far enough ahead.
//!
//! So it runs [`LEAD_TICKS`] ahead and keeps the key frames of the last second. What comes late
//! rewinds it: it takes up the kept frame at the audible instant (or later, where the change is
//! felt later) and simulates again from there under a new epoch.

use std::sync::Arc;
use std::time::Duration;

use crossbeam::channel::{Receiver, TryRecvError};
use mouthpiece_rig::{Controls, KeyFrame, STEP_TICKS, Simulation, TICK_RATE};

use super::clock::AudibleClock;
use super::conductor::Cue;
use super::frames::FrameWriter;
use super::motion::Motion;
use super::score::Score;
use super::time::{Flow, ns_from_ticks, seconds};
use super::vitals::Vitals;

/// How far the simulation runs ahead of what is heard: covers for a thread that is not let run.
pub const LEAD_TICKS: i64 = TICK_RATE / 4;
/// Ticks between key frames: 120 a second, of which linear interpolation shows nothing.
pub const FRAME_TICKS: i64 = 400;
const _: () = assert!(FRAME_TICKS % STEP_TICKS == 0);
/// Key frames that can be gone back to: more than a second, four times the lead.
const KEPT: usize = 144;
/// Further behind than this the past is skipped, not caught up with: nobody saw it.
const BEHIND_TICKS: i64 = TICK_RATE;
/// Naps while far enough ahead: half a key frame at least, so that naps do not add up to spinning.
const NAP_MIN: Duration = Duration::from_millis(4);
const NAP_MAX: Duration = Duration::from_millis(50);

/// What is simulated; a trait so that tests need no head.
pub trait Body {
    /// One fixed step of `STEP_TICKS`.
    fn step(&mut self, controls: &Controls);
    /// The tick it is at.
    fn time(&self) -> i64;
    /// Writes its whole state.
    fn save(&self, frame: &mut KeyFrame);
    /// Takes up a saved state, its time and epoch included.
    fn restore(&mut self, frame: &KeyFrame);
    /// The epoch of frames from now on.
    fn set_epoch(&mut self, epoch: u32);
}

impl Body for Simulation {
    fn step(&mut self, controls: &Controls) {
        self.step(controls);
    }
    fn time(&self) -> i64 {
        self.time()
    }
    fn save(&self, frame: &mut KeyFrame) {
        self.save(frame);
    }
    fn restore(&mut self, frame: &KeyFrame) {
        // Refused only for another head's frames, and there is one head.
        let _ = self.restore(frame);
    }
    fn set_epoch(&mut self, epoch: u32) {
        self.set_epoch(epoch);
    }
}

/// The simulation thread's state; [`Face::step`] is its body.
pub struct Face<B> {
    body: B,
    score: Score,
    clock: AudibleClock,
    cues: Receiver<Cue>,
    /// Each who looks at the head has a ring.
    frames: Vec<FrameWriter>,
    /// The last key frames, a ring.
    kept: Vec<KeyFrame>,
    kept_next: usize,
    epoch: u32,
    motion: Motion,
    vitals: Arc<Vitals>,
}

impl<B: Body> Face<B> {
    pub fn new(
        body: B,
        score: Score,
        clock: AudibleClock,
        cues: Receiver<Cue>,
        frames: Vec<FrameWriter>,
        vitals: Arc<Vitals>,
    ) -> Self {
        let mut face = Self {
            body,
            score,
            clock,
            cues,
            frames,
            kept: Vec::with_capacity(KEPT),
            kept_next: 0,
            epoch: 0,
            motion: Motion::default(),
            vitals,
        };
        face.publish(face.vitals.origin.now_ns());
        face
    }

    /// One turn: cues, then a key frame's worth of steps if the lead is not full.
    pub fn step(&mut self, now_ns: i64) -> Flow {
        let audible = self.clock.at(now_ns);
        let mut felt = i64::MAX;
        loop {
            match self.cues.try_recv() {
                Ok(cue) => felt = felt.min(self.score.take(cue, audible)),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return Flow::End,
            }
        }
        if felt < self.body.time() {
            self.rewind(felt.max(audible));
        }
        if self.body.time() < audible - BEHIND_TICKS {
            self.skip_to(audible);
        }
        let ahead = self.body.time() - audible;
        self.vitals.simulation.lead.set(ahead);
        if ahead >= LEAD_TICKS {
            let spare = ns_from_ticks(ahead - LEAD_TICKS + FRAME_TICKS);
            let nap = Duration::from_nanos(u64::try_from(spare).unwrap_or(0));
            return Flow::Wait(nap.clamp(NAP_MIN, NAP_MAX));
        }
        self.score.forget_before(audible - BEHIND_TICKS);
        for _ in 0..FRAME_TICKS / STEP_TICKS {
            // What is to be reached by the end of the step.
            let controls = self.score.controls_at(self.body.time() + STEP_TICKS);
            self.body.step(&controls);
        }
        self.publish(now_ns);
        Flow::Continue
    }

    /// Goes back to the last kept frame at or before `to`.
    fn rewind(&mut self, to: i64) {
        let kept = self.kept.iter().filter(|f| f.time <= to);
        let Some(frame) = kept.max_by_key(|f| f.time) else {
            return;
        };
        if frame.time >= self.body.time() {
            return;
        }
        self.vitals.simulation.rewinds.add(1);
        self.epoch = self.epoch.wrapping_add(1);
        self.body.restore(frame);
        self.body.set_epoch(self.epoch);
        // What was kept of the void future must not be gone back to.
        let time = frame.time;
        for frame in self.kept.iter_mut().filter(|f| f.time > time) {
            frame.time = i64::MAX;
        }
    }

    /// Takes the head as it is to another time: the process was suspended, or the machine too slow.
    fn skip_to(&mut self, time: i64) {
        self.vitals.simulation.skips.add(1);
        tracing::warn!(
            behind_s = seconds(time - self.body.time()),
            "the simulation was left behind and skips to what is heard now"
        );
        let mut frame = KeyFrame::default();
        self.body.save(&mut frame);
        frame.time = time.div_euclid(FRAME_TICKS) * FRAME_TICKS;
        self.body.restore(&frame);
        self.body.set_epoch(self.epoch);
    }

    /// Sends the present state to all who look at it, and keeps it.
    fn publish(&mut self, now_ns: i64) {
        let Self { body, frames, .. } = self;
        for ring in frames {
            ring.write(|frame| body.save(frame));
        }
        if self.kept.len() < KEPT {
            self.kept.push(KeyFrame::default());
        }
        let kept = &mut self.kept[self.kept_next];
        self.body.save(kept);
        self.vitals.simulation.key_frames.add(1);
        if self.motion.differs(kept) {
            self.vitals.simulation.moved_ns.set(now_ns);
        }
        self.kept_next = (self.kept_next + 1) % KEPT;
    }
}

#[cfg(test)]
mod tests;
