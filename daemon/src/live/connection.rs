//! One client: what it sends to the protocol's session, the session's actions to the player, answers back.
//!
//! Wanted: no client holds up another one, the sound or the picture; each is read at a bounded rate, and
//! waits when the sound thread has enough; one that takes no answers, says nothing, or keeps its token
//! to itself is let go, with a word where it still listens; one that dies in mid sentence leaves a face
//! that finishes what it has. Every utterance that was accepted is told its end once.

mod face;
pub mod files;
pub mod peer;
mod rate;
mod words;

use std::collections::HashMap;
use std::path::PathBuf;
use std::time::Duration;

use bytes::Bytes;
use mouthpiece_protocol::{Action, DaemonMessage, ErrorCode, Limits, Session, Sound, Token};
use tokio::sync::mpsc;
use tokio::time::Instant;

use super::player::Handle;
use super::sound::resample::Resample;
use super::utterance::{ANSWERS_MAX, Begin};
use crate::media::wav;
use files::Files;
use peer::{Heard, Peer};
use rate::Rate;
pub use words::refusal;
use words::{silence, slowness};

/// Bytes that are acted on before the rate is looked at again: 4096 lines at most.
const SLICE_BYTES: usize = 4096;
/// Samples of a file handed over at once, so that none waits long for the channel.
const FILE_PIECE: usize = 48_000;
/// The rate of everything behind the socket.
const RATE_HZ: u32 = 48_000;
/// A client is told that it is read slowly no more often than this.
const SLOWED_AGAIN: Duration = Duration::from_secs(10);

/// What holds for a connection.
#[derive(Clone, Debug)]
pub struct Terms {
    pub limits: Limits,
    /// Wanted first, where it is set.
    pub token: Option<Token>,
    pub files: Files,
    /// A client that takes no answer for so long is gone.
    pub write_patience: Duration,
}

/// Serves client number `number` until it is gone and all it began has ended.
pub async fn serve(peer: Peer, handle: Handle, terms: Terms, number: u64) {
    let (answers, told) = mpsc::channel(ANSWERS_MAX);
    let now = Instant::now();
    let session = match &terms.token {
        Some(token) => Session::guarded(terms.limits.clone(), token.clone()),
        None => Session::new(terms.limits.clone()),
    };
    let client = Client {
        number,
        session,
        handle,
        answers,
        peer,
        lines: Rate::new(terms.limits.lines_per_second, now),
        bytes: Rate::new(terms.limits.bytes_per_second, now),
        paused: now,
        slowed: None,
        rest: Bytes::new(),
        heard: now,
        keys: HashMap::new(),
        streams: HashMap::new(),
        terms,
    };
    client.run(told).await;
}

struct Client {
    number: u64,
    terms: Terms,
    session: Session,
    handle: Handle,
    answers: mpsc::Sender<DaemonMessage>,
    peer: Peer,
    lines: Rate,
    bytes: Rate,
    /// Nothing more is read until then.
    paused: Instant,
    /// When it was last told so.
    slowed: Option<Instant>,
    /// Read and not yet acted on.
    rest: Bytes,
    /// When its last whole message came, or its last utterance ended.
    heard: Instant,
    /// The player's numbers of utterances that have not ended, by the client's ids.
    keys: HashMap<String, u64>,
    /// Resamplers of those whose sound is being sent.
    streams: HashMap<u64, Resample>,
}

/// What happens next.
enum Event {
    Heard(Heard),
    Told(DaemonMessage),
    /// It has said nothing for too long.
    Silent,
    /// The process ends.
    Closing,
}

impl Client {
    async fn run(mut self, mut told: mpsc::Receiver<DaemonMessage>) {
        let began = Instant::now();
        let mut actions = Vec::new();
        let mut sending = true;
        let closing = self.handle.closing().clone();
        while sending || self.session.has_pending() {
            let silent = self.patience(began);
            let event = tokio::select! {
                Some(message) = told.recv() => Event::Told(message),
                heard = self.hear(), if sending => Event::Heard(heard),
                () = tokio::time::sleep_until(silent.unwrap_or(began)), if sending && silent.is_some() => Event::Silent,
                () = closing.cancelled(), if sending => Event::Closing,
            };
            let alive = match event {
                Event::Told(message) => self.answer(message).await,
                Event::Heard(Heard::Over { answers }) => {
                    sending = false;
                    self.session.closed(&mut actions);
                    let done = self.act(&mut actions).await;
                    if answers { done } else { Err(gone()) }
                }
                Event::Heard(heard) => self.take(heard, &mut actions).await,
                // What it began is being stopped: it hears of that, and no more of it is listened to.
                Event::Closing => {
                    sending = false;
                    self.session.closed(&mut actions);
                    self.act(&mut actions).await
                }
                Event::Silent => {
                    let message = silence(self.session.is_trusted(), &self.terms.limits);
                    // Whether it is taken or not, that was it.
                    let _ = self.send(&message).await;
                    Err(gone())
                }
            };
            if let Err(error) = alive {
                tracing::debug!(client = self.number, %error, "a client is gone");
                // What it began is finished without it.
                self.session.closed(&mut actions);
                actions.retain(|a| !matches!(a, Action::Reply(_) | Action::Close));
                let _ = self.act(&mut actions).await;
                break;
            }
        }
        self.peer.close(self.terms.write_patience).await;
    }

    /// When it has been silent for too long; never while something of its own is still to be heard.
    fn patience(&self, began: Instant) -> Option<Instant> {
        let limits = &self.terms.limits;
        let seconds = |n: u32| Duration::from_secs(u64::from(n));
        if !self.session.is_trusted() {
            return Some(began + seconds(limits.auth_seconds));
        }
        (!self.session.has_pending()).then(|| self.heard + seconds(limits.silent_seconds))
    }

    /// What is to be acted on next, once the rate allows it.
    async fn hear(&mut self) -> Heard {
        // A timer that is due already costs a millisecond all the same.
        if self.paused > Instant::now() {
            tokio::time::sleep_until(self.paused).await;
        }
        if self.rest.is_empty() {
            match self.peer.hear().await {
                Heard::Bytes(bytes) => self.rest = bytes,
                frame => return frame,
            }
        }
        let slice = self.rest.len().min(SLICE_BYTES);
        Heard::Bytes(self.rest.split_to(slice))
    }

    async fn take(&mut self, heard: Heard, actions: &mut Vec<Action>) -> std::io::Result<()> {
        let before = self.session.taken();
        let bytes = match heard {
            Heard::Bytes(bytes) => {
                self.session.receive(&bytes, actions);
                bytes.len()
            }
            Heard::Text(text) => {
                self.session.receive_text(&text, actions);
                text.len()
            }
            Heard::Sound(bytes) => {
                self.session.receive_sound(&bytes, actions);
                bytes.len()
            }
            Heard::Over { .. } => 0,
        };
        let lines = self.session.taken() - before;
        let now = Instant::now();
        if lines > 0 {
            self.heard = now;
        }
        let wait = self.lines.take(lines as f64, now);
        let wait = wait.max(self.bytes.take(bytes as f64, now));
        self.act(actions).await?;
        if wait > Duration::ZERO {
            self.paused = now + wait;
            if self.slowed.is_none_or(|at| now - at > SLOWED_AGAIN) {
                self.slowed = Some(now);
                let message = slowness(&self.terms.limits);
                self.send(&message).await?;
            }
        }
        Ok(())
    }

    /// Does all of it, though the client may be gone before its end: an answer that nobody takes must not
    /// cost an utterance its end.
    async fn act(&mut self, actions: &mut Vec<Action>) -> std::io::Result<()> {
        let mut alive = Ok(());
        for action in actions.drain(..) {
            let done = match self.perform(action).await {
                Ok(Some(message)) if alive.is_ok() => self.send(&message).await,
                Ok(_) => Ok(()),
                Err(error) => Err(error),
            };
            alive = alive.and(done);
        }
        alive
    }

    /// Has the player do what is asked for; returns what the client is told of it. An error ends the connection.
    async fn perform(&mut self, action: Action) -> std::io::Result<Option<DaemonMessage>> {
        match action {
            Action::Reply(message) => return Ok(Some(message)),
            Action::Begin { id, sound } => self.begin(id, sound).await,
            Action::Segments { id, segments } => {
                if let Some(&key) = self.keys.get(&id) {
                    self.handle.segments(key, segments).await;
                }
            }
            Action::Audio { id, mono } => self.sound(&id, &mono).await,
            Action::End { id } => self.end(&id).await,
            Action::Stop { id: None } => self.handle.stop(None).await,
            Action::Stop { id: Some(id) } => {
                if let Some(&key) = self.keys.get(&id) {
                    self.handle.stop(Some(key)).await;
                }
            }
            Action::Express(express) => match face::express(&express) {
                Ok(showing) => self.handle.show(showing).await,
                Err(error) => return Ok(Some(refusal(ErrorCode::Face, error.to_string()))),
            },
            Action::Look(look) => self.handle.show(face::look(&look)).await,
            Action::State(state) => self.handle.show(face::state(state)).await,
            Action::Caption { id, start, text } => self.caption(id, start, text).await,
            Action::Close => return Err(gone()),
        }
        Ok(None)
    }

    async fn begin(&mut self, id: String, sound: Sound) {
        let key = self.handle.new_key();
        self.keys.insert(id.clone(), key);
        let begin = Begin {
            key,
            client: self.number,
            id,
            has_sound: sound != Sound::Silent,
            answers: self.answers.clone(),
            start: None,
        };
        self.handle.begin(begin).await;
        match sound {
            Sound::Silent => {}
            Sound::File(path) => self.file(key, path).await,
            Sound::Sent(pcm) => match Resample::new(pcm.rate, RATE_HZ) {
                Ok(resample) => {
                    self.streams.insert(key, resample);
                }
                Err(error) => self.fail(key, format!("{error:#}")).await,
            },
        }
    }

    /// Reads a sound file; the client's further messages wait until it is read.
    async fn file(&self, key: u64, path: PathBuf) {
        let (files, seconds) = (
            self.terms.files.clone(),
            self.terms.limits.utterance_seconds,
        );
        let read = tokio::task::spawn_blocking(move || {
            let file = files.open(&path)?;
            let name = path.display().to_string();
            let file = std::io::BufReader::new(file);
            let sound = wav::decode_at_most(file, &name, seconds as usize);
            sound.map_err(|error| error.to_string())
        });
        match read.await {
            Ok(Ok(sound)) => {
                for piece in sound.frames.chunks(FILE_PIECE) {
                    self.handle.sound(key, piece.to_vec()).await;
                }
            }
            Ok(Err(why)) => self.fail(key, why).await,
            Err(error) => self.fail(key, error.to_string()).await,
        }
    }

    async fn sound(&mut self, id: &str, mono: &[f32]) {
        let Some(&key) = self.keys.get(id) else {
            return;
        };
        let Some(resample) = self.streams.get_mut(&key) else {
            return;
        };
        let mut ticks = Vec::new();
        match resample.push(mono, &mut ticks) {
            Ok(()) => self.handle.sound(key, ticks).await,
            Err(error) => self.fail(key, format!("{error:#}")).await,
        }
    }

    async fn end(&mut self, id: &str) {
        let Some(&key) = self.keys.get(id) else {
            return;
        };
        if let Some(mut resample) = self.streams.remove(&key) {
            let mut rest = Vec::new();
            match resample.finish(&mut rest) {
                Ok(()) => self.handle.sound(key, rest).await,
                Err(error) => self.fail(key, format!("{error:#}")).await,
            }
        }
        self.handle.end(key).await;
    }

    async fn caption(&self, id: Option<String>, start: i64, text: String) {
        let key = match id {
            None => None,
            Some(id) => match self.keys.get(&id) {
                Some(&key) => Some(key),
                None => return, // it has ended meanwhile
            },
        };
        self.handle.caption(key, start, text).await;
    }

    async fn fail(&self, key: u64, message: String) {
        self.handle.fail(key, ErrorCode::Audio, message).await;
    }

    /// Passes on what the player says of an utterance; its end only once.
    async fn answer(&mut self, message: DaemonMessage) -> std::io::Result<()> {
        if let Some(id) = message.ends() {
            if !self.session.ended(id) {
                return Ok(());
            }
            self.heard = Instant::now();
            if let Some(key) = self.keys.remove(id) {
                self.streams.remove(&key);
            }
        }
        self.send(&message).await
    }

    async fn send(&mut self, message: &DaemonMessage) -> std::io::Result<()> {
        let patience = self.terms.write_patience;
        self.peer.send(message.line(), patience).await
    }
}

fn gone() -> std::io::Error {
    std::io::ErrorKind::ConnectionAborted.into()
}

#[cfg(test)]
mod tests;
