//! What the head is told, tick by tick: utterances at their places, and never a jump.

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
