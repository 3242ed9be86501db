//! The sound thread: utterances in turn, from what clients send to the output's ring and the face's cues.
//!
//! Everything that is heard or seen has a place on one timeline of ticks, and this thread alone
//! decides it: an utterance begins at the next tick that is not mixed yet, the next one right
//! behind it. Silence is mixed while nobody speaks, so that the clock never stops. What comes too
//! late for its place is dropped, never raced through. `stop` silences what was handed over
//! already, and the face is cued to relax from the tick that silence begins at.
//!
//! `messages` holds what comes in and what goes to the face, `news` what is told once a turn.

mod messages;
mod news;

use std::sync::Arc;
use std::thread::Thread;
use std::time::Duration;

use mouthpiece_protocol::ErrorCode;
use mouthpiece_speech::Speech;
use tokio::sync::mpsc;

use super::captions::Captions;
use super::rules::Rules;
use super::showing::Showing;
use super::sound::Output;
use super::sync::{Listening, Onsets};
use super::time::Flow;
use super::utterance::{Begin, Utterance};
use super::vitals::Vitals;
use crate::config::Turns;
pub use messages::{Command, Cue};

/// Commands that wait for the sound thread; who sends more waits.
pub const COMMANDS_MAX: usize = 64;
/// Cues that wait for the simulation thread: many times what a client may queue at once.
pub const CUES_MAX: usize = 1024;
/// How often the thread looks after the ring, which holds several times as much.
const TURN: Duration = Duration::from_millis(10);

/// What leads to and from the sound thread.
pub struct Ends {
    pub commands: mpsc::Receiver<Command>,
    pub cues: crossbeam::channel::Sender<Cue>,
    /// The thread that takes the cues: it naps while it is far enough ahead.
    pub face: Option<Thread>,
    pub captions: Arc<Captions>,
}

/// The sound thread's state; [`Conductor::step`] is its body.
pub struct Conductor {
    output: Output,
    ends: Ends,
    /// The caption that was shown last of those that go with an utterance: whose, and which.
    captioned: Option<(u64, usize)>,
    /// What is on the screen goes with no utterance.
    captioned_alone: bool,
    speech: Speech,
    /// In the order of their `begin`; those that speak have a start.
    utterances: Vec<Utterance>,
    rules: Rules,
    /// What the face is to show from this turn on: the latest of each kind, since each takes the
    /// simulation back to what is heard.
    showing: Vec<Showing>,
    block: Vec<f32>,
    quit: bool,
    listening: Option<Listening>,
    vitals: Arc<Vitals>,
}

impl Conductor {
    pub fn new(
        output: Output,
        ends: Ends,
        speech: Speech,
        rules: Rules,
        vitals: Arc<Vitals>,
    ) -> Self {
        Self {
            output,
            ends,
            captioned: None,
            captioned_alone: false,
            speech,
            utterances: Vec::new(),
            rules,
            showing: Vec::new(),
            block: vec![0.0; super::sound::BLOCK_TICKS],
            quit: false,
            listening: None,
            vitals,
        }
    }

    /// Clicks in what is said make the picture flash.
    pub fn listen(&mut self, onsets: Arc<Onsets>) {
        self.listening = Some(Listening::new(onsets));
    }

    /// One turn: commands, clock, sound, news.
    pub fn step(&mut self, now_ns: i64) -> Flow {
        self.output.poll(now_ns);
        // Bounded by what fits into the channel, so that no sender keeps sound from being mixed.
        for _ in 0..COMMANDS_MAX {
            match self.ends.commands.try_recv() {
                Ok(command) => self.obey(command, now_ns),
                Err(mpsc::error::TryRecvError::Empty) => break,
                Err(mpsc::error::TryRecvError::Disconnected) => {
                    self.quit = true;
                    break;
                }
            }
        }
        for showing in std::mem::take(&mut self.showing) {
            self.cue(Cue::Show(showing));
        }
        if self.quit {
            return Flow::End;
        }
        let mut wanted = self.output.wanted(now_ns);
        while wanted > 0 {
            self.mix_block();
            wanted = wanted.saturating_sub(self.block.len());
        }
        self.tell(now_ns);
        Flow::Wait(TURN)
    }

    fn obey(&mut self, command: Command, now_ns: i64) {
        match command {
            Command::Begin(begin) => self.begin(begin, now_ns),
            Command::Segments(key, segments) => {
                let audible = self.output.audible(now_ns);
                if let Some(utterance) = self.find(key) {
                    utterance.fed = audible;
                    let (sent, before) = (segments.len(), utterance.dropped());
                    let begun = utterance.start.is_some();
                    let segments = utterance.add_labels(segments, audible);
                    let dropped = utterance.dropped() - before;
                    let late = if begun { sent - segments.len() } else { 0 };
                    self.vitals.sound.dropped_labels.add(late as u64);
                    self.vitals.sound.dropped.add(dropped.unsigned_abs());
                    if !segments.is_empty() {
                        self.cue(Cue::Segments { key, segments });
                    }
                }
            }
            Command::Sound(key, mono) => self.sound(key, &mono, now_ns),
            Command::End(key) => {
                if let Some(utterance) = self.find(key) {
                    utterance.ended = true;
                }
            }
            Command::Fail(key, code, message) => {
                if let Some(utterance) = self.remove(key) {
                    utterance.tell_failed(code, message);
                    self.vitals.sound.failed.add(1);
                    self.silence(vec![utterance], now_ns, |_, _| {});
                }
            }
            Command::Stop(Some(key)) => {
                let one = self.remove(key).into_iter().collect();
                self.stop(one, now_ns);
            }
            Command::Stop(None) => {
                let all = std::mem::take(&mut self.utterances);
                self.stop(all, now_ns);
            }
            Command::Show(showing) => {
                let kind = std::mem::discriminant(&showing);
                self.showing.retain(|s| std::mem::discriminant(s) != kind);
                self.showing.push(showing);
            }
            Command::Caption(None, _, text) => {
                self.captioned_alone = true;
                self.ends.captions.set(text);
            }
            Command::Caption(Some(key), start, text) => {
                if let Some(utterance) = self.find(key) {
                    utterance.captions.push((start, text));
                }
            }
            Command::Rules(rules) => self.rules = *rules,
            Command::Quit => self.quit = true,
        }
    }

    fn begin(&mut self, begin: Begin, now_ns: i64) {
        let client = begin.client;
        let utterance = Utterance::new(begin, self.output.audible(now_ns));
        self.vitals.sound.begun.add(1);
        let others = self.utterances.iter().any(|u| u.client != client);
        if others && self.rules.turns == Turns::Replace {
            let all = std::mem::take(&mut self.utterances);
            let (kept, ended) = all.into_iter().partition(|u| u.client == client);
            self.utterances = kept;
            self.stop(ended, now_ns);
        }
        let most = self.rules.utterances_max;
        let refused = if others && self.rules.turns == Turns::Refuse {
            Some("another client has the word; begin when it has finished".to_owned())
        } else if self.utterances.len() >= most {
            Some(format!(
                "{most} utterances wait already; begin when one has ended"
            ))
        } else {
            None
        };
        match refused {
            Some(why) => {
                utterance.tell_failed(ErrorCode::Busy, why);
                self.vitals.sound.failed.add(1);
            }
            None => self.utterances.push(utterance),
        }
    }

    fn stop(&mut self, ended: Vec<Utterance>, now_ns: i64) {
        self.vitals.sound.stopped.add(ended.len() as u64);
        self.silence(ended, now_ns, Utterance::tell_stopped);
    }

    fn sound(&mut self, key: u64, mono: &[f32], now_ns: i64) {
        let Some(client) = self.find(key).map(|u| u.client) else {
            return;
        };
        let more = i64::try_from(mono.len()).unwrap_or(i64::MAX);
        let held = |of: &dyn Fn(&&Utterance) -> bool| -> i64 {
            let held = self.utterances.iter().filter(|u| of(u));
            held.map(Utterance::sound_ticks).sum::<i64>() + more
        };
        let too_much = held(&|_| true) > self.rules.sound_ticks_max
            || held(&|u| u.client == client) > self.rules.client_ticks_max;
        let written = self.output.written();
        let audible = self.output.audible(now_ns);
        if too_much {
            self.obey(
                Command::Fail(
                    key,
                    ErrorCode::Busy,
                    "too much sound waits already; send this when less does".to_owned(),
                ),
                now_ns,
            );
        } else if let Some(utterance) = self.find(key) {
            utterance.fed = audible;
            let before = utterance.dropped();
            let delivery = utterance.add_sound(mono, written);
            let (begun, dropped) = (utterance.start.is_some(), utterance.dropped() - before);
            self.vitals.sound.dropped.add(dropped.unsigned_abs());
            if begun {
                self.cue(Cue::Heard { key, delivery });
            }
        }
    }

    /// Ends utterances that were taken out of the queue, at the first tick that is not heard yet.
    fn silence(&mut self, ended: Vec<Utterance>, now_ns: i64, tell: impl Fn(&Utterance, i64)) {
        if !ended.iter().any(|u| u.start.is_some()) {
            ended.iter().for_each(|u| tell(u, 0));
            return;
        }
        let at = self.output.silence(now_ns);
        for utterance in ended {
            tell(&utterance, at);
            if utterance.start.is_some() {
                let key = utterance.key;
                self.cue(Cue::Stop { key, at });
            }
        }
        // Whoever was next in line was silenced with it and begins again.
        let silenced: Vec<u64> = self
            .utterances
            .iter_mut()
            .filter(|u| u.start.is_some_and(|start| start >= at))
            .map(|u| {
                u.take_back();
                u.key
            })
            .collect();
        for key in silenced {
            self.cue(Cue::Stop { key, at });
        }
    }

    /// Mixes the next block, beginning whoever's turn it is.
    fn mix_block(&mut self) {
        self.block.fill(0.0);
        let at = self.output.written();
        let until = at + i64::try_from(self.block.len()).unwrap_or(0);
        // The tick from which nobody speaks.
        let mut free = at;
        for utterance in self.utterances.iter().filter(|u| u.start.is_some()) {
            utterance.mix(at, &mut self.block);
            free = free.max(utterance.end().unwrap_or(i64::MAX));
        }
        while free < until {
            let Some(next) = self
                .utterances
                .iter()
                .position(|u| u.start.is_none() && u.ready(self.rules.look_ahead))
            else {
                break;
            };
            self.start(next, free);
            self.utterances[next].mix(at, &mut self.block);
            free = self.utterances[next].end().unwrap_or(i64::MAX);
        }
        for sample in &mut self.block {
            *sample = sample.clamp(-1.0, 1.0);
        }
        if let Some(listening) = &mut self.listening {
            listening.hear(at, &self.block);
        }
        self.output.push(&self.block);
    }

    fn start(&mut self, index: usize, start: i64) {
        let utterance = &mut self.utterances[index];
        utterance.begin_at(start);
        let key = utterance.key;
        let mut track = Box::new(self.speech.track(&utterance.segments));
        track.hear(&utterance.delivery);
        self.cue(Cue::Start { key, start, track });
    }

    fn find(&mut self, key: u64) -> Option<&mut Utterance> {
        self.utterances.iter_mut().find(|u| u.key == key)
    }

    fn remove(&mut self, key: u64) -> Option<Utterance> {
        let at = self.utterances.iter().position(|u| u.key == key)?;
        Some(self.utterances.remove(at))
    }

    /// The simulation thread empties its cues before every step, so a full channel empties at once;
    /// without that thread there is nothing to go on for.
    fn cue(&mut self, cue: Cue) {
        self.quit |= self.ends.cues.send(cue).is_err();
        if let Some(face) = &self.ends.face {
            face.unpark();
        }
    }
}

#[cfg(test)]
pub(super) mod by_hand;
#[cfg(test)]
mod tests;
