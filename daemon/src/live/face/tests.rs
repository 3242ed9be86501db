//! The simulation thread driven by hand: a body whose one vertex shows what it was told.

use glam::Vec3;
use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_rig::{Calibration, Control};
use mouthpiece_speech::{Idle, Speech};

use super::*;
use crate::live::clock::{ClockCell, Stamp};
use crate::live::frames::{FrameReader, key_frames};
use crate::live::showing::Showing;
use crate::live::time::{Origin, ticks_from_ns};

/// Follows the jaw it is told with some inertia; its state is that one number.
struct Lump {
    time: i64,
    epoch: u32,
    jaw: f32,
    steps: usize,
}

impl Body for Lump {
    fn step(&mut self, controls: &Controls) {
        self.jaw += (controls[Control::Jaw] - self.jaw) * 0.05;
        self.time += STEP_TICKS;
        self.steps += 1;
    }
    fn time(&self) -> i64 {
        self.time
    }
    fn save(&self, frame: &mut KeyFrame) {
        (frame.time, frame.epoch) = (self.time, self.epoch);
        frame.skin.clear();
        frame.skin.push(Vec3::new(self.jaw, 0.0, 0.0));
    }
    fn restore(&mut self, frame: &KeyFrame) {
        (self.time, self.epoch) = (frame.time, frame.epoch);
        self.jaw = frame.skin[0].x;
    }
    fn set_epoch(&mut self, epoch: u32) {
        self.epoch = epoch;
    }
}

struct Stage {
    face: Face<Lump>,
    cell: Arc<ClockCell>,
    cues: crossbeam::channel::Sender<Cue>,
    reader: FrameReader,
    speech: Speech,
    shown: KeyFrame,
}

fn stage() -> Stage {
    let speech = Speech::with(|a| {
        let mut controls = Controls::default();
        controls[Control::Jaw] = a.jaw_rad;
        controls
    })
    .unwrap();
    let cell = Arc::new(ClockCell::default());
    let (cues, inbox) = crossbeam::channel::bounded(64);
    let (writer, reader) = key_frames();
    let lump = Lump {
        time: 0,
        epoch: 0,
        jaw: 0.0,
        steps: 0,
    };
    let score = Score::new(
        &speech,
        Calibration::default(),
        Idle::new(7),
        mouthpiece_speech::State::Idle,
    );
    let clock = AudibleClock::new(Arc::clone(&cell));
    Stage {
        face: Face::new(
            lump,
            score,
            clock,
            inbox,
            vec![writer],
            Arc::new(Vitals::new(Origin::new())),
        ),
        cell,
        cues,
        reader,
        speech,
        shown: KeyFrame::default(),
    }
}

const MS: i64 = 1_000_000;

impl Stage {
    /// Steps until the lead is full, with `now_ns` both real and audible time.
    fn settle(&mut self, now_ns: i64) {
        let heard = ticks_from_ns(now_ns);
        self.cell.publish(Stamp {
            first: heard,
            end: heard + 48_000,
            playback_ns: now_ns,
        });
        for _ in 0..1000 {
            if let Flow::Wait(nap) = self.face.step(now_ns) {
                assert!(nap >= NAP_MIN, "never spins");
                return;
            }
        }
        panic!("never far enough ahead");
    }

    fn shown(&mut self, tick: i64) -> f32 {
        assert!(self.reader.sample(tick, &mut self.shown));
        self.shown.skin[0].x
    }

    fn speak(&self, key: u64, start: i64, segments: &[Segment]) {
        let track = Box::new(self.speech.track(segments));
        self.cues.send(Cue::Start { key, start, track }).unwrap();
    }
}

#[test]
fn it_runs_a_bounded_lead_ahead() {
    let mut stage = stage();
    for now in 0..200 {
        stage.settle(now * 10 * MS);
        let ahead = stage.face.body.time - ticks_from_ns(now * 10 * MS);
        assert!((LEAD_TICKS..LEAD_TICKS + FRAME_TICKS).contains(&ahead));
    }
    let most = (ticks_from_ns(2000 * MS) + LEAD_TICKS + FRAME_TICKS) / STEP_TICKS;
    assert!(stage.face.body.steps as i64 <= most, "no work twice");
}

#[test]
fn a_late_utterance_and_its_stop_are_felt_from_the_audible_instant() {
    let mut stage = stage();
    stage.settle(1000 * MS);
    let rest = stage.shown(48_000);
    // It begins within the lead that was simulated as silence already.
    let start = 48_000 + 4_800;
    stage.speak(1, start, &[Segment::new(Phone::Aa, 0, 96_000)]);
    stage.settle(1000 * MS);
    assert_eq!(stage.face.epoch, 1);
    let open = stage.shown(start + 4_800);
    assert!(open > rest + 0.05, "{open} against {rest}");

    stage.settle(1500 * MS);
    let heard = stage.shown(72_000);
    stage.cues.send(Cue::Stop { key: 1, at: 72_480 }).unwrap();
    stage.settle(1500 * MS);
    assert_eq!(stage.face.epoch, 2);
    assert_eq!(stage.shown(72_000), heard, "the past stands");
    stage.settle(2500 * MS);
    let relaxed = stage.shown(120_000);
    assert!((relaxed - rest).abs() < 0.01, "{relaxed} against {rest}");
}

#[test]
fn what_a_client_shows_is_felt_from_the_audible_instant_and_fades_away() {
    let mut stage = stage();
    stage.settle(1000 * MS);
    let rest = stage.shown(48_000);
    let mut controls = Controls::default();
    controls[Control::Jaw] = 0.2;
    for controls in [controls, Controls::default()] {
        let face = Showing::Face {
            controls: Box::new(controls),
            fade: 9_600,
        };
        stage.cues.send(Cue::Show(face)).unwrap();
        stage.settle(
            if controls == Controls::default() {
                2000
            } else {
                1000
            } * MS,
        );
        if controls != Controls::default() {
            assert_eq!(stage.face.epoch, 1, "what was simulated ahead is void");
            assert_eq!(stage.shown(48_000), rest, "no jump");
            assert!(stage.shown(48_000 + 11_900) > rest + 0.1);
        }
    }
    stage.settle(3000 * MS);
    let after = stage.shown(144_000);
    assert!((after - rest).abs() < 0.01, "{after} against {rest}");
}

#[test]
fn labels_that_come_in_pieces_give_what_they_give_at_once() {
    let segments = [
        Segment::new(Phone::HSharp, 0, 9_600),
        Segment::new(Phone::Aa, 9_600, 24_000),
        Segment::new(Phone::M, 24_000, 33_600),
        Segment::new(Phone::Ow, 33_600, 52_800),
    ];
    let mut whole = stage();
    let mut pieces = stage();
    for stage in [&mut whole, &mut pieces] {
        stage.settle(1000 * MS);
    }
    let start = 48_000 + 24_000;
    whole.speak(1, start, &segments);
    pieces.speak(1, start, &segments[..1]);
    for (n, &segment) in segments[1..].iter().enumerate() {
        for stage in [&mut whole, &mut pieces] {
            stage.settle((1010 + 10 * n as i64) * MS);
        }
        let segments = vec![segment];
        pieces
            .cues
            .send(Cue::Segments { key: 1, segments })
            .unwrap();
    }
    for ms in 1050..2500 {
        for stage in [&mut whole, &mut pieces] {
            stage.settle(ms * MS);
        }
        let (a, b) = (whole.shown(ms * 48), pieces.shown(ms * 48));
        assert!((a - b).abs() < 1e-4, "{a} {b} at {ms} ms");
    }
}

#[test]
fn a_suspended_process_skips_what_nobody_saw() {
    let mut stage = stage();
    stage.settle(100 * MS);
    let before = stage.face.body.steps;
    stage.settle(60_000 * MS);
    assert!(stage.face.body.steps - before < 1000);
    stage.shown(60_000 * 48);
    assert!(stage.shown.time >= 60_000 * 48);
}
