//! The sound thread driven by hand, on a steady clock and made-up time.

use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_protocol::DaemonMessage;
use mouthpiece_rig::TICK_RATE;

use super::by_hand::ByHand;
use super::*;
use crate::config::Config;
use crate::live::utterance::ANSWERS_MAX;

/// How much of an utterance must be there: as `run` has it by default.
const LOOK_AHEAD: i64 = TICK_RATE * 3 / 10;

struct Stage {
    conductor: Conductor,
    commands: mpsc::Sender<Command>,
    cues: crossbeam::channel::Receiver<Cue>,
    answers: (mpsc::Sender<DaemonMessage>, mpsc::Receiver<DaemonMessage>),
    start_ns: i64,
    now_ns: i64,
}

fn stage() -> Stage {
    stage_with(|_| {})
}

/// One with other rules than the default.
fn stage_with(change: impl Fn(&mut Rules)) -> Stage {
    let mut rules = Rules::of(&Config::default());
    rules.look_ahead = LOOK_AHEAD;
    change(&mut rules);
    let ByHand {
        conductor,
        commands,
        cues,
        now_ns,
        ..
    } = ByHand::new(rules);
    Stage {
        conductor,
        commands,
        cues,
        answers: mpsc::channel(ANSWERS_MAX),
        start_ns: now_ns,
        now_ns,
    }
}

impl Stage {
    fn send(&self, command: Command) {
        self.commands.try_send(command).unwrap();
    }

    fn begin(&self, key: u64, has_sound: bool) {
        self.send(Command::Begin(Begin {
            key,
            client: key / 10,
            id: format!("u{key}"),
            has_sound,
            answers: self.answers.0.clone(),
            start: None,
        }));
    }

    /// Lets time pass, turn by turn.
    fn pass_ms(&mut self, ms: i64) {
        for _ in 0..ms / 10 {
            self.now_ns += 10_000_000;
            assert!(matches!(self.conductor.step(self.now_ns), Flow::Wait(_)));
        }
    }

    fn elapsed_s(&self) -> f64 {
        (self.now_ns - self.start_ns) as f64 * 1e-9
    }

    /// What was answered so far, progress left out.
    fn told(&mut self) -> Vec<String> {
        let mut told = Vec::new();
        while let Ok(message) = self.answers.1.try_recv() {
            match message {
                DaemonMessage::Started { id } => told.push(format!("started {id}")),
                DaemonMessage::Finished {
                    id,
                    position_s,
                    dropped_s,
                } => told.push(format!("finished {id} {position_s:.2} -{dropped_s:.2}")),
                DaemonMessage::Stopped { id, position_s } => {
                    told.push(format!("stopped {id} {position_s:.1}"));
                }
                DaemonMessage::Error { id, code, .. } => {
                    told.push(format!("error {} {code:?}", id.unwrap_or_default()));
                }
                _ => {}
            }
        }
        told
    }

    fn starts(&self) -> Vec<(u64, i64)> {
        self.cues
            .try_iter()
            .filter_map(|cue| match cue {
                Cue::Start { key, start, .. } => Some((key, start)),
                _ => None,
            })
            .collect()
    }
}

fn labels(from_ms: i64, to_ms: i64) -> Vec<Segment> {
    vec![Segment::new(Phone::Aa, from_ms * 48, to_ms * 48)]
}

#[test]
fn utterances_follow_one_another_to_the_tick() {
    let mut stage = stage();
    for key in [1, 2] {
        stage.begin(key, true);
        stage.send(Command::Segments(key, labels(0, 500)));
        stage.send(Command::Sound(key, vec![0.1; 48 * 600 + 7]));
        stage.send(Command::End(key));
    }
    stage.pass_ms(100);
    assert_eq!(stage.told(), ["started u1"]);
    stage.pass_ms(1300);
    assert_eq!(
        stage.told(),
        [
            "finished u1 0.60 -0.00",
            "started u2",
            "finished u2 0.60 -0.00"
        ]
    );
    let starts = stage.starts();
    assert_eq!(starts[1].1 - starts[0].1, 48 * 600 + 7, "{starts:?}");
    assert!(stage.elapsed_s() < 1.5);
}

#[test]
fn what_still_comes_in_starts_when_enough_is_there_and_waits_for_nobody() {
    let mut stage = stage();
    stage.begin(1, true);
    stage.send(Command::Sound(1, vec![0.1; 48 * 1000]));
    stage.pass_ms(300);
    assert!(stage.told().is_empty(), "no labels, no start");
    // Another that is whole goes first.
    stage.begin(2, false);
    stage.send(Command::Segments(2, labels(0, 100)));
    stage.send(Command::End(2));
    stage.pass_ms(300);
    assert_eq!(stage.told(), ["started u2", "finished u2 0.10 -0.00"]);
    stage.send(Command::Segments(1, labels(0, 400)));
    stage.pass_ms(200);
    assert_eq!(stage.told(), ["started u1"]);
    stage.send(Command::Segments(1, labels(400, 1000)));
    stage.send(Command::End(1));
    stage.pass_ms(1000);
    assert_eq!(stage.told(), ["finished u1 1.00 -0.00"]);
}

#[test]
fn what_comes_too_late_is_dropped_and_counted() {
    let mut stage = stage();
    stage.begin(1, true);
    stage.send(Command::Segments(1, labels(0, 400)));
    stage.send(Command::Sound(1, vec![0.1; 48 * 400]));
    stage.pass_ms(1000);
    // Mixing is 80 ms ahead: 600 ms of nothing have been handed over since.
    stage.send(Command::Segments(1, labels(400, 500)));
    stage.send(Command::Sound(1, vec![0.1; 48 * 700]));
    stage.send(Command::End(1));
    stage.pass_ms(500);
    let told = stage.told();
    assert_eq!(told.len(), 2, "{told:?}");
    let dropped: f64 = told[1].rsplit('-').next().unwrap().parse().unwrap();
    assert!((0.6..0.85).contains(&dropped), "{told:?}");
}

#[test]
fn stop_ends_what_is_heard_and_forgets_what_is_queued() {
    let mut stage = stage();
    for key in [1, 2] {
        stage.begin(key, true);
        stage.send(Command::Segments(key, labels(0, 5000)));
        stage.send(Command::Sound(key, vec![0.1; 48 * 5000]));
        stage.send(Command::End(key));
    }
    stage.pass_ms(1040);
    stage.send(Command::Stop(None));
    stage.pass_ms(20);
    assert_eq!(
        stage.told(),
        ["started u1", "stopped u1 1.0", "stopped u2 0.0"]
    );
    let stops: Vec<Cue> = stage.cues.try_iter().collect();
    assert!(matches!(stops[..], [Cue::Start { .. }, Cue::Stop { .. }]));
    stage.pass_ms(6000);
    assert!(stage.told().is_empty(), "an end is told once");
}

#[test]
fn one_that_was_next_in_line_is_not_lost_with_the_stopped_one() {
    let mut stage = stage();
    for key in [1, 2] {
        stage.begin(key, true);
        stage.send(Command::Segments(key, labels(0, 400)));
        stage.send(Command::Sound(key, vec![0.1; 48 * 400]));
        stage.send(Command::End(key));
    }
    // The second has its place behind the first already: mixing is ahead.
    stage.pass_ms(340);
    let before = stage.starts();
    assert_eq!(before.len(), 2);
    stage.send(Command::Stop(Some(1)));
    stage.pass_ms(700);
    assert_eq!(
        stage.told(),
        [
            "started u1",
            "stopped u1 0.3",
            "started u2",
            "finished u2 0.40 -0.00"
        ]
    );
    assert_eq!(stage.starts()[0].0, 2, "begins again");
}

#[test]
fn one_that_gets_nothing_more_is_ended_with_an_error() {
    let mut stage = stage();
    stage.begin(1, false);
    stage.send(Command::Segments(1, labels(0, 400)));
    stage.pass_ms(11_000);
    assert_eq!(stage.told(), ["started u1", "error u1 Busy"]);
}

#[test]
fn one_that_never_begins_is_ended_too_and_makes_room() {
    let mut stage = stage();
    stage.begin(1, true);
    stage.send(Command::Segments(1, labels(0, 400)));
    stage.pass_ms(29_000);
    assert!(stage.told().is_empty(), "its sound may still come");
    stage.pass_ms(2_000);
    assert_eq!(stage.told(), ["error u1 Busy"]);
}

/// Keys from 10 on are another client's.
#[test]
fn clients_take_turns_as_the_rules_say() {
    let speak = |stage: &mut Stage, key| {
        stage.begin(key, false);
        stage.send(Command::Segments(key, labels(0, 1000)));
        stage.send(Command::End(key));
        stage.pass_ms(200);
    };
    let mut stage = stage_with(|rules| rules.turns = Turns::Refuse);
    for key in [1, 10, 2] {
        speak(&mut stage, key);
    }
    assert_eq!(stage.told(), ["started u1", "error u10 Busy"]);
    stage.pass_ms(2500);
    speak(&mut stage, 10);
    assert_eq!(
        stage.told(),
        [
            "finished u1 1.00 -0.00",
            "started u2",
            "finished u2 1.00 -0.00",
            "started u10"
        ]
    );

    let mut stage = stage_with(|rules| rules.turns = Turns::Replace);
    for key in [1, 2, 10] {
        speak(&mut stage, key);
    }
    assert_eq!(
        stage.told(),
        [
            "started u1",
            "stopped u1 0.4",
            "stopped u2 0.0",
            "started u10"
        ]
    );
}

#[test]
fn changed_rules_hold_for_the_next_utterance() {
    let mut stage = stage();
    stage.begin(1, false);
    stage.pass_ms(10);
    let rules = Rules {
        turns: Turns::Refuse,
        ..Rules::of(&Config::default())
    };
    stage.send(Command::Rules(Box::new(rules)));
    stage.begin(10, false);
    stage.pass_ms(10);
    assert_eq!(stage.told(), ["error u10 Busy"]);
}

#[test]
fn sound_that_waits_is_bounded_for_each_client_and_for_all() {
    let mut stage = stage_with(|rules| {
        rules.client_ticks_max = 48_000;
        rules.sound_ticks_max = 72_000;
    });
    for key in [1, 2, 10, 11, 20] {
        stage.begin(key, true);
    }
    for (key, ticks) in [(1, 40_000), (2, 9_000), (10, 30_000), (20, 3_000)] {
        stage.send(Command::Sound(key, vec![0.1; ticks]));
    }
    stage.pass_ms(20);
    assert_eq!(stage.told(), ["error u2 Busy", "error u20 Busy"]);
}

#[test]
fn barge_in_is_cued_and_told_within_a_turn() {
    let mut stage = stage();
    stage.begin(1, true);
    stage.send(Command::Segments(1, labels(0, 5000)));
    stage.send(Command::Sound(1, vec![0.1; 48 * 5000]));
    stage.pass_ms(1000);
    stage.send(Command::Stop(None));
    stage.pass_ms(10);
    let start = stage.conductor.ends.cues.len();
    assert_eq!(start, 2);
    let cues: Vec<Cue> = stage.cues.try_iter().collect();
    let [Cue::Start { start, .. }, Cue::Stop { at, .. }] = cues[..] else {
        panic!("{cues:?}");
    };
    let heard = stage.conductor.output.audible(stage.now_ns);
    // Of what is heard, all after the turn is silent.
    assert!(
        at > start && heard - at <= 480,
        "{at} when {heard} is heard"
    );
}

#[test]
fn captions_come_with_their_sound_and_go_with_their_utterance() {
    let mut stage = stage();
    let captions = Arc::clone(&stage.conductor.ends.captions);
    let mut seen = 0;
    let mut shown = || captions.latest(&mut seen).map(|t| t.to_string());
    stage.begin(1, false);
    stage.send(Command::Caption(Some(1), 0, "one".into()));
    stage.send(Command::Caption(Some(1), 24_000, "two".into()));
    stage.pass_ms(100);
    assert_eq!(shown(), None, "nothing is heard yet");
    stage.send(Command::Segments(1, labels(0, 1000)));
    stage.send(Command::End(1));
    stage.pass_ms(300);
    assert_eq!(shown().as_deref(), Some("one"));
    stage.pass_ms(500);
    assert_eq!(shown().as_deref(), Some("two"));
    stage.pass_ms(500);
    assert_eq!(shown().as_deref(), Some(""));
    stage.send(Command::Caption(None, 0, "alone".into()));
    stage.pass_ms(500);
    assert_eq!(shown().as_deref(), Some("alone"));
}

#[test]
fn a_flood_of_faces_is_one_cue_a_turn() {
    let mut stage = stage();
    for n in 0..COMMANDS_MAX as i64 {
        let at = None;
        stage.send(Command::Show(Showing::Look { at, fade: n }));
    }
    stage.pass_ms(10);
    let cues: Vec<Cue> = stage.cues.try_iter().collect();
    assert!(
        matches!(cues[..], [Cue::Show(Showing::Look { fade: 63, .. })]),
        "{cues:?}"
    );
}

#[test]
fn the_queue_is_bounded() {
    let mut stage = stage();
    for key in 0..=64 {
        stage.begin(key, false);
        stage.pass_ms(10);
    }
    assert_eq!(stage.told(), ["error u64 Busy"]);
}

#[test]
fn time_goes_on_while_nobody_speaks() {
    let mut stage = stage();
    stage.pass_ms(2000);
    let written = stage.conductor.output.written();
    assert!(
        (95_000..=96_000 + 48 * 90 + 480).contains(&written),
        "{written}"
    );
}
