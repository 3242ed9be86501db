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
mod tests {
    use super::*;
    use mouthpiece_phonemes::{Phone, Segment};
    use mouthpiece_speech::Delivery;

    fn speech() -> Speech {
        Speech::with(|articulation| {
            let mut controls = Controls::default();
            controls[Control::Jaw] = articulation.jaw_rad;
            controls
        })
        .unwrap()
    }

    fn jaw(score: &Score, tick: i64) -> f32 {
        score.controls_at(tick)[Control::Jaw]
    }

    fn open_vowel() -> [Segment; 3] {
        [
            Segment::new(Phone::HSharp, 0, 9_600),
            Segment::new(Phone::Aa, 9_600, 57_600),
            Segment::new(Phone::HSharp, 57_600, 67_200),
        ]
    }

    #[test]
    fn an_utterance_is_felt_at_its_place_and_nowhere_else() {
        let speech = speech();
        let mut score = Score::new(&speech, Calibration::default(), Idle::new(1), State::Idle);
        let rest = jaw(&score, 0);
        let felt = score.take(
            Cue::Start {
                key: 1,
                start: 480_000,
                track: Box::new(speech.track(&open_vowel())),
            },
            0,
        );
        assert!(jaw(&score, 480_000 + 33_600) > rest + 0.05);
        for tick in (0..felt).step_by(4_800) {
            assert!((jaw(&score, tick) - rest).abs() < 1e-4, "at {tick}");
        }
        score.take(Cue::Done { key: 1 }, 0);
        score.forget_before(480_000 + 67_200 + 2 * 48_000);
        assert_eq!(jaw(&score, 480_000 + 33_600), rest, "forgotten");
    }

    #[test]
    fn a_stopped_mouth_goes_to_rest_without_a_jump() {
        let speech = speech();
        let mut score = Score::new(&speech, Calibration::default(), Idle::new(1), State::Idle);
        let rest = jaw(&score, 0);
        score.take(
            Cue::Start {
                key: 1,
                start: 0,
                track: Box::new(speech.track(&open_vowel())),
            },
            0,
        );
        let at = 33_600;
        let open = jaw(&score, at);
        assert_eq!(score.take(Cue::Stop { key: 1, at }, 0), at);
        let mut last = open;
        for tick in (at..at + RELAX_TICKS + 960).step_by(480) {
            let now = jaw(&score, tick);
            assert!(now <= last + 1e-6 && last - now < 0.02, "jumps at {tick}");
            last = now;
        }
        assert!((last - rest).abs() < 1e-4);
    }

    #[test]
    fn an_expression_over_speech_leaves_the_lips_to_speech_and_the_brows_to_itself() {
        let speech = speech();
        let mut score = Score::new(&speech, Calibration::default(), Idle::new(1), State::Idle);
        // The calibration of a mouth that no muscle opens: its lips always have to meet.
        let mut face = Controls::default();
        face[Control::LevatorLabiiSuperioris] = 0.8;
        face[Control::CorrugatorSupercilii] = 0.8;
        let show = Showing::Face {
            controls: Box::new(face),
            fade: 0,
        };
        score.take(Cue::Show(show), 0);
        let track = Box::new(speech.track(&open_vowel()));
        score.take(
            Cue::Start {
                key: 1,
                start: 96_000,
                track,
            },
            0,
        );
        let silent = score.controls_at(20_000);
        assert!(silent[Control::LevatorLabiiSuperioris] > 0.75);
        let talking = score.controls_at(96_000 + 33_600);
        assert!(talking[Control::LevatorLabiiSuperioris] < 0.05);
        assert!(talking[Control::CorrugatorSupercilii] > 0.75);
    }

    #[test]
    fn an_utterance_that_is_cut_off_leaves_the_mouth_at_rest() {
        let speech = speech();
        let mut score = Score::new(&speech, Calibration::default(), Idle::new(1), State::Idle);
        let rest = jaw(&score, 0);
        // Its client died in the middle of a vowel: no silence follows.
        let track = Box::new(speech.track(&open_vowel()[..2]));
        let start = 48_000;
        score.take(
            Cue::Start {
                key: 1,
                start,
                track,
            },
            0,
        );
        assert!(jaw(&score, start + 33_600) > rest + 0.05);
        for done in [false, true] {
            let later = jaw(&score, start + 57_600 + 24_000);
            assert!(
                (later - rest).abs() < 1e-3,
                "{later} against {rest}, {done}"
            );
            score.take(Cue::Done { key: 1 }, start + 57_600);
        }
    }

    fn begun(speech: &Speech) -> Score {
        let mut score = Score::new(speech, Calibration::default(), Idle::new(1), State::Idle);
        let track = Box::new(speech.track(&open_vowel()));
        let (key, start) = (1, 48_000);
        score.take(Cue::Start { key, start, track }, 0);
        score
    }

    #[test]
    fn what_is_heard_opens_a_loud_mouth_wider_and_lifts_brows_in_time_without_a_jump() {
        let speech = speech();
        let mut score = begun(&speech);
        let (said, audible) = (48_000 + 33_600, 48_000 + 20_000);
        let (open, shown) = (jaw(&score, said), jaw(&score, audible));
        let accent = mouthpiece_speech::Accent {
            at: 30_000,
            size: 1.0,
            rises: true,
        };
        let delivery = Delivery {
            loudness: vec![1.0; 140],
            accents: vec![accent],
        };
        let heard = |delivery: &Delivery, key| Cue::Heard {
            key,
            delivery: delivery.clone(),
        };
        let felt = score.take(heard(&delivery, 1), audible);
        assert_eq!(felt, 48_000 + accent.at - SEEN_BEFORE_TICKS);
        assert!((jaw(&score, audible) - shown).abs() < 1e-4, "it jumps");
        assert!(jaw(&score, said) > open * 1.05, "{open}");
        // Nothing is felt of who does not speak, or does not any more.
        assert_eq!(score.take(heard(&delivery, 2), audible), i64::MAX);
        score.take(Cue::Stop { key: 1, at: said }, audible);
        assert_eq!(score.take(heard(&delivery, 1), audible), i64::MAX);
    }

    #[test]
    fn who_is_done_listens_and_is_forgotten_after_the_end() {
        let speech = speech();
        let mut score = begun(&speech);
        let end = 48_000 + 67_200;
        let open = jaw(&score, 48_000 + 33_600);
        // Not done: labels may come yet, however late it is.
        score.forget_before(end + 10 * TICK_RATE);
        assert_eq!(jaw(&score, 48_000 + 33_600), open);
        assert_eq!(score.take(Cue::Done { key: 1 }, 0), end);
        let listens = |tick| score.states.at(tick).of(State::Listening);
        assert!(listens(end + LISTENING_TICKS / 2) > 0.99);
        assert!(listens(end + LISTENING_TICKS + 5 * TICK_RATE) < 0.01);
        score.forget_before(end + FELT_AFTER_TICKS);
        assert!(score.spoken.is_empty());
        assert_eq!(score.take(Cue::Done { key: 1 }, 0), i64::MAX);
    }

    #[test]
    fn labels_that_come_late_never_move_a_control_faster_than_a_correction_may() {
        let speech = speech();
        let mut score = begun(&speech);
        // All of a second ago, when the face was at rest behind its last label.
        let audible = 48_000 + 96_000;
        let late = Segment::new(Phone::Ae, 72_000, 120_000);
        let segments = vec![late];
        let mut last = jaw(&score, audible);
        score.take(Cue::Segments { key: 1, segments }, audible);
        let known = score.known_at(audible)[Control::Jaw];
        assert!(known > last + 0.03, "nothing came late: {known}, {last}");
        let step = 80;
        for tick in (audible..audible + 24_000).step_by(step) {
            let own = score.known_at(tick)[Control::Jaw];
            let own = (own - score.known_at(tick - step as i64)[Control::Jaw]).abs();
            let now = jaw(&score, tick);
            let most = own + Correction::speed(Control::Jaw) * step as f32 + 1e-5;
            assert!((now - last).abs() <= most, "jumps at {tick}");
            last = now;
        }
        assert_eq!(last, score.known_at(audible + 24_000 - 80)[Control::Jaw]);
    }
}
