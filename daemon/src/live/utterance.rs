//! One utterance on the sound thread: what came of it so far, and where it stands on the timeline.

use mouthpiece_phonemes::Segment;
use mouthpiece_protocol::DaemonMessage;
use mouthpiece_rig::TICK_RATE;
use mouthpiece_speech::{Delivery, Listener};
use tokio::sync::mpsc;

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use super::time::seconds;

/// Answers of one connection that wait to be sent: progress is left out long before.
pub const ANSWERS_MAX: usize = 384;
/// Room that is kept for answers that must not be lost: the start and the end of each of the 100 utterances
/// that a client may have waiting.
const ANSWERS_KEPT: usize = 256;

/// Where an utterance's answers go.
pub type Answers = mpsc::Sender<DaemonMessage>;

/// A new utterance.
#[derive(Debug)]
pub struct Begin {
    /// The process's own number for it.
    pub key: u64,
    /// Whose it is.
    pub client: u64,
    /// The client's name for it.
    pub id: String,
    /// Whether it has sound; a silent one is as long as its labels.
    pub has_sound: bool,
    /// Who is told.
    pub answers: Answers,
    /// Where its first tick is written when it is known.
    pub start: Option<Arc<AtomicI64>>,
}

/// A start that is not known yet.
pub const NOT_STARTED: i64 = i64::MIN;

#[derive(Debug)]
pub(super) struct Utterance {
    pub(super) key: u64,
    pub(super) client: u64,
    /// What was heard when something of it came last.
    pub(super) fed: i64,
    begin: Begin,
    /// 48 kHz, one channel.
    audio: Vec<f32>,
    /// All labels so far.
    pub(super) segments: Vec<Segment>,
    listener: Listener,
    /// What was heard of it so far.
    pub(super) delivery: Delivery,
    labelled: i64,
    pub(super) ended: bool,
    /// Texts, and from which tick of its sound each is on the screen.
    pub(super) captions: Vec<(i64, Arc<str>)>,
    /// Its first tick on the timeline.
    pub(super) start: Option<i64>,
    told_start: bool,
    next_progress: i64,
    dropped: i64,
}

impl Utterance {
    /// `now` is the tick that is heard.
    pub(super) fn new(begin: Begin, now: i64) -> Self {
        Self {
            key: begin.key,
            client: begin.client,
            fed: now,
            begin,
            audio: Vec::new(),
            segments: Vec::new(),
            listener: Listener::default(),
            delivery: Delivery::default(),
            labelled: 0,
            ended: false,
            captions: Vec::new(),
            start: None,
            told_start: false,
            next_progress: 0,
            dropped: 0,
        }
    }

    /// Whether it can begin.
    /// `look_ahead` is how much of it must be there before that, ticks, while more is to come.
    pub(super) fn ready(&self, look_ahead: i64) -> bool {
        self.ended || self.covered() >= look_ahead.max(1)
    }

    /// How far everything that it consists of has come in.
    pub(super) fn covered(&self) -> i64 {
        if self.begin.has_sound {
            self.labelled.min(self.sound_ticks())
        } else {
            self.labelled
        }
    }

    fn length(&self) -> i64 {
        self.labelled.max(self.sound_ticks())
    }

    pub(super) fn sound_ticks(&self) -> i64 {
        i64::try_from(self.audio.len()).unwrap_or(i64::MAX)
    }

    /// The tick after its last, once both are known.
    pub(super) fn end(&self) -> Option<i64> {
        self.start
            .filter(|_| self.ended)
            .map(|start| start + self.length())
    }

    pub(super) fn begin_at(&mut self, start: i64) {
        self.start = Some(start);
        if let Some(known) = &self.begin.start {
            known.store(start, Ordering::Release);
        }
    }

    /// It was to begin but nothing of it was heard: it waits again.
    pub(super) fn take_back(&mut self) {
        self.start = None;
    }

    /// More sound; what should have been handed over before `written` is lost. Returns what it says of how
    /// the utterance is spoken.
    pub(super) fn add_sound(&mut self, mono: &[f32], written: i64) -> Delivery {
        if let Some(start) = self.start {
            let late = (written - start - self.sound_ticks()).max(0);
            self.dropped += late.min(i64::try_from(mono.len()).unwrap_or(0));
        }
        self.audio.extend_from_slice(mono);
        let mut news = Delivery::default();
        self.listener.hear(mono, &mut news);
        self.delivery.loudness.extend(&news.loudness);
        self.delivery.accents.extend(&news.accents);
        news
    }

    /// More labels; returns those that are still of use to a face that is at `audible`.
    pub(super) fn add_labels(&mut self, segments: Vec<Segment>, audible: i64) -> Vec<Segment> {
        let end = segments.last().map_or(0, |s| s.end);
        self.labelled = self.labelled.max(end);
        self.segments.extend_from_slice(&segments);
        let Some(start) = self.start else {
            return Vec::new();
        };
        let mut kept = segments;
        kept.retain(|s| {
            let late = start + s.end <= audible;
            if late {
                self.dropped += s.duration();
            }
            !late
        });
        kept
    }

    /// How much of it came too late for its place, ticks.
    pub(super) fn dropped(&self) -> i64 {
        self.dropped
    }

    /// Adds its sound of the ticks from `at` on to `block`.
    pub(super) fn mix(&self, at: i64, block: &mut [f32]) {
        let Some(start) = self.start else { return };
        let from = at - start;
        let skip = usize::try_from(-from).unwrap_or(0);
        let sound = self
            .audio
            .get(usize::try_from(from).unwrap_or(0)..)
            .unwrap_or(&[]);
        for (out, x) in block.iter_mut().skip(skip).zip(sound) {
            *out += x;
        }
    }

    /// Tells its client what has become audible.
    pub(super) fn tell_position(&mut self, audible: i64) {
        let Some(position) = self.start.map(|start| audible - start) else {
            return;
        };
        if position < 0 {
            return;
        }
        let id = self.begin.id.clone();
        if !std::mem::replace(&mut self.told_start, true) {
            self.tell(DaemonMessage::Started { id });
        } else if position >= self.next_progress && self.begin.answers.capacity() > ANSWERS_KEPT {
            let position_s = seconds(position.min(self.length()));
            self.tell(DaemonMessage::Progress { id, position_s });
        } else {
            return;
        }
        self.next_progress = position + TICK_RATE / 10;
    }

    /// Its own last word: it was heard.
    pub(super) fn tell_finished(&self) {
        self.tell(DaemonMessage::Finished {
            id: self.begin.id.clone(),
            position_s: seconds(self.length()),
            dropped_s: seconds(self.dropped),
        });
    }

    /// Its own last word: it was stopped at tick `at`.
    pub(super) fn tell_stopped(&self, at: i64) {
        let heard = self.start.map_or(0, |s| (at - s).clamp(0, self.length()));
        self.tell(DaemonMessage::Stopped {
            id: self.begin.id.clone(),
            position_s: seconds(heard),
        });
    }

    /// Its own last word: it cannot go on.
    pub(super) fn tell_failed(&self, code: mouthpiece_protocol::ErrorCode, message: String) {
        self.tell(DaemonMessage::Error {
            id: Some(self.begin.id.clone()),
            code,
            message,
            fatal: true,
        });
    }

    fn tell(&self, message: DaemonMessage) {
        // A client that is gone, or reads nothing any more, is not waited for.
        let _ = self.begin.answers.try_send(message);
    }
}
