//! What the face is to do at any tick: the tracks of utterances on the timeline, what clients have it
//! show over them, and idle life under them.
//!
//! On the simulation thread. A function of the tick alone between two cues, so that a rewind finds
//! what was there. Knows nothing of sound.

use mouthpiece_rig::{Calibration, Control, Controls, Mouth, TICK_RATE};
use mouthpiece_speech::{Correction, Idle, Manner, Speech, State, States, Track};

use super::conductor::Cue;
use super::showing::{Showing, Shown};

/// How long before its first sound a label can be felt: the reach of anticipation, and of the breath
/// before it.
const FELT_BEFORE_TICKS: i64 = TICK_RATE * 7 / 10;
/// How long before a sound is heard it can be seen: brows go up for what is stressed.
const SEEN_BEFORE_TICKS: i64 = TICK_RATE * 3 / 10;
/// Who has spoken waits for an answer for so long before the face is idle (judgement).
const LISTENING_TICKS: i64 = TICK_RATE * 10;
/// A stopped mouth goes to rest over this long; the tissue adds its own inertia.
const RELAX_TICKS: i64 = TICK_RATE / 5;
/// How long after its last label an utterance may still be felt.
const FELT_AFTER_TICKS: i64 = TICK_RATE;

/// An utterance on the timeline.
#[derive(Debug)]
struct Spoken {
    key: u64,
    start: i64,
    track: Track,
    /// Silent from here on.
    stop: Option<i64>,
    /// No more labels come.
    done: bool,
}

/// The face's part.
#[derive(Debug)]
pub struct Score {
    spoken: Vec<Spoken>,
    rest: Controls,
    /// How this mouth answers: expressions keep off lips that must close.
    calibration: Calibration,
    idle: Idle,
    /// What the face does while nobody speaks and nobody has just spoken.
    resting: State,
    states: States,
    shown: Shown,
    /// What was shown already and is not so any more.
    correction: Correction,
}

impl Score {
    pub fn new(speech: &Speech, calibration: Calibration, idle: Idle, resting: State) -> Self {
        Self {
            spoken: Vec::new(),
            rest: speech.track(&[]).controls_at(0),
            calibration,
            idle,
            resting,
            states: States::always(resting),
            shown: Shown::default(),
            correction: Correction::default(),
        }
    }

    /// Takes a cue in; returns the first tick at which it changes anything. What it changes of what is
    /// shown at `audible` already goes over without a jump.
    pub fn take(&mut self, cue: Cue, audible: i64) -> i64 {
        let told = self.controls_at(audible);
        let felt = self.change(cue, audible);
        let known = self.known_at(audible);
        self.correction = Correction::new(audible, &told, &known);
        felt
    }

    fn change(&mut self, cue: Cue, audible: i64) -> i64 {
        match cue {
            Cue::Show(showing) => {
                match showing {
                    Showing::Face { controls, fade } => self.shown.face(audible, *controls, fade),
                    Showing::Look { at, fade } => self.shown.look(audible, at, fade),
                    Showing::State(state) => self.states.change(audible, state),
                    Showing::Rest(state) => {
                        self.resting = state;
                        self.states.change(audible, state);
                    }
                }
                audible
            }
            Cue::Start { key, start, track } => {
                let felt = start + track.start() - FELT_BEFORE_TICKS;
                self.spoken.push(Spoken {
                    key,
                    start,
                    track: *track,
                    stop: None,
                    done: false,
                });
                felt
            }
            Cue::Segments { key, segments } => {
                let Some(spoken) = self.live(key) else {
                    return i64::MAX;
                };
                let first = segments.first().map_or(i64::MAX, |s| s.start);
                for segment in segments {
                    spoken.track.push(segment);
                }
                first.saturating_add(spoken.start - FELT_BEFORE_TICKS)
            }
            Cue::Heard { key, delivery } => {
                let Some(spoken) = self.live(key) else {
                    return i64::MAX;
                };
                spoken.track.hear(&delivery);
                let first = delivery.accents.first().map(|a| a.at);
                first.map_or(i64::MAX, |at| {
                    (spoken.start + at).saturating_sub(SEEN_BEFORE_TICKS)
                })
            }
            Cue::Stop { key, at } => {
                let Some(spoken) = self.live(key) else {
                    return i64::MAX;
                };
                (spoken.stop, spoken.done) = (Some(at), true);
                self.listen_from(at);
                at
            }
            Cue::Done { key } => {
                if let Some(spoken) = self.live(key) {
                    spoken.done = true;
                    let end = spoken.start + spoken.track.end();
                    self.listen_from(end);
                    return end;
                }
                i64::MAX
            }
        }
    }

    /// Who has had the word waits for an answer.
    fn listen_from(&mut self, tick: i64) {
        self.states.change(tick, State::Listening);
        self.states
            .change(tick.saturating_add(LISTENING_TICKS), self.resting);
    }

    /// What the head is told at `tick`.
    pub fn controls_at(&self, tick: i64) -> Controls {
        let mut controls = self.known_at(tick);
        self.correction.add(tick, &mut controls);
        controls
    }

    /// The same for someone who knew everything from the beginning.
    fn known_at(&self, tick: i64) -> Controls {
        let mut controls = self.rest;
        let mut speaking: f32 = 0.0;
        for spoken in &self.spoken {
            let share = spoken.share(tick);
            if share <= 0.0 {
                continue;
            }
            // A mouth that is stopped relaxes from where it was, not from where it would have been.
            let local = tick.min(spoken.stop.unwrap_or(i64::MAX)) - spoken.start;
            let told = spoken.track.controls_at(local);
            for &control in Control::ALL {
                controls[control] += (told[control] - self.rest[control]) * share;
            }
            speaking = speaking.max(spoken.track.speaking_at(local) * share);
        }
        let mut controls = controls.clamped();
        if let Some(face) = self.shown.face_at(tick) {
            let mouth = Mouth::of(&self.calibration, &controls, speaking);
            controls.express(&face, 1.0, mouth);
        }
        let manner: Manner = self.states.at(tick).towards(State::Speaking, speaking);
        self.idle.add(tick, &manner, &mut controls);
        self.shown.aim(tick, &mut controls);
        for spoken in &self.spoken {
            let local = tick - spoken.start;
            let share = spoken.share(tick);
            self.idle
                .accompany(&spoken.track, local, share, &mut controls);
        }
        controls
    }

    /// Lets go of what is not felt any more at `tick`.
    pub fn forget_before(&mut self, tick: i64) {
        self.shown.forget_before(tick);
        self.spoken.retain(|spoken| {
            let end = spoken.start + spoken.track.end();
            !spoken.done || spoken.stop.unwrap_or(i64::MAX).min(end) + FELT_AFTER_TICKS > tick
        });
    }

    fn live(&mut self, key: u64) -> Option<&mut Spoken> {
        // An utterance that had to begin again is there twice, the first time stopped.
        self.spoken
            .iter_mut()
            .find(|s| s.key == key && s.stop.is_none())
    }
}

impl Spoken {
    /// 1 until it is stopped, then gently to 0.
    fn share(&self, tick: i64) -> f32 {
        let Some(stop) = self.stop else { return 1.0 };
        let x = ((tick - stop) as f32 / RELAX_TICKS as f32).clamp(0.0, 1.0);
        1.0 - x * x * (3.0 - 2.0 * x)
    }
}

#[cfg(test)]
mod tests;
