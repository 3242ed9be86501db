//! One client: bytes to the protocol's session, its actions to the player, answers back.
//!
//! A client that reads nothing any more is let go after a while, one that dies in mid sentence
//! leaves a face that finishes what it has. A client that sends faster than is spoken waits.

mod face;

use std::collections::HashMap;
use std::path::PathBuf;
use std::time::Duration;

use mouthpiece_protocol::{Action, DaemonMessage, ErrorCode, Limits, Session, Sound};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::sync::mpsc;

use super::player::Handle;
use super::sound::resample::Resample;
use super::utterance::{ANSWERS_MAX, Begin};
use crate::media::wav;

/// Bytes read at once.
const READ_BYTES: usize = 64 * 1024;
/// A client that takes nothing for this long is gone.
const WRITE_PATIENCE: Duration = Duration::from_secs(5);
/// Samples of a file handed over at once, so that none waits long for the channel.
const FILE_PIECE: usize = 48_000;
/// The rate of everything behind the socket.
const RATE_HZ: u32 = 48_000;

/// Both halves of a client's connection.
pub type Stream = (
    Box<dyn AsyncRead + Send + Sync + Unpin>,
    Box<dyn AsyncWrite + Send + Sync + Unpin>,
);

/// Serves a client until it is gone and all it began has ended.
pub async fn serve((mut read, write): Stream, handle: Handle, limits: Limits) {
    let (answers, mut told) = mpsc::channel(ANSWERS_MAX);
    let mut client = Client {
        session: Session::new(limits),
        handle,
        answers,
        write,
        keys: HashMap::new(),
        streams: HashMap::new(),
    };
    let mut bytes = vec![0; READ_BYTES];
    let mut actions = Vec::new();
    let mut sending = true;
    let closing = client.handle.closing().clone();
    while sending || client.session.has_pending() {
        let alive = tokio::select! {
            got = read.read(&mut bytes), if sending => {
                match got {
                    Ok(0) | Err(_) => {
                        sending = false;
                        client.session.closed(&mut actions);
                    }
                    Ok(n) => client.session.receive(&bytes[..n], &mut actions),
                }
                client.act(&mut actions).await
            }
            Some(message) = told.recv() => client.answer(message).await,
            // What it began is being stopped: it hears of that, and no more of it is listened to.
            () = closing.cancelled(), if sending => {
                sending = false;
                client.session.closed(&mut actions);
                client.act(&mut actions).await
            }
        };
        if let Err(error) = alive {
            tracing::debug!(%error, "a client is gone");
            // What it began is finished without it.
            client.session.closed(&mut actions);
            actions.retain(|a| !matches!(a, Action::Reply(_)));
            let _ = client.act(&mut actions).await;
            return;
        }
    }
}

struct Client {
    session: Session,
    handle: Handle,
    answers: mpsc::Sender<DaemonMessage>,
    write: Box<dyn AsyncWrite + Send + Sync + Unpin>,
    /// The player's numbers of utterances that have not ended, by the client's ids.
    keys: HashMap<String, u64>,
    /// Resamplers of those whose sound is being sent.
    streams: HashMap<u64, Resample>,
}

impl Client {
    async fn act(&mut self, actions: &mut Vec<Action>) -> std::io::Result<()> {
        for action in actions.drain(..) {
            match action {
                Action::Reply(message) => self.send(&message).await?,
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
                    Err(error) => self.send(&refused(error.to_string())).await?,
                },
                Action::Look(look) => self.handle.show(face::look(&look)).await,
                Action::State(state) => self.handle.show(face::state(state)).await,
                Action::Caption { id, start, text } => self.caption(id, start, text).await,
                Action::Close => return Err(std::io::ErrorKind::ConnectionAborted.into()),
            }
        }
        Ok(())
    }

    async fn begin(&mut self, id: String, sound: Sound) {
        let key = self.handle.new_key();
        self.keys.insert(id.clone(), key);
        let begin = Begin {
            key,
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
        let read = tokio::task::spawn_blocking(move || wav::read(&path)).await;
        match read {
            Ok(Ok(sound)) => {
                for piece in sound.frames.chunks(FILE_PIECE) {
                    self.handle.sound(key, piece.to_vec()).await;
                }
            }
            Ok(Err(error)) => self.fail(key, error.to_string()).await,
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
            if let Some(key) = self.keys.remove(id) {
                self.streams.remove(&key);
            }
        }
        self.send(&message).await
    }

    async fn send(&mut self, message: &DaemonMessage) -> std::io::Result<()> {
        let line = message.line();
        tokio::time::timeout(WRITE_PATIENCE, self.write.write_all(line.as_bytes()))
            .await
            .map_err(|_| std::io::Error::from(std::io::ErrorKind::TimedOut))?
    }
}

/// What is answered when a face cannot be shown.
fn refused(message: String) -> DaemonMessage {
    DaemonMessage::Error {
        id: None,
        code: ErrorCode::Face,
        message,
        fatal: false,
    }
}
