//! What `say` says, in pieces as they come: from files at once, labels on standard input line by line.

use std::io::Read as _;
use std::path::Path;

use anyhow::{Context as _, Result};
use mouthpiece_phonemes::formats::NdjsonStream;
use mouthpiece_phonemes::timit::TimitStream;
use mouthpiece_phonemes::{Alphabet, LineError, SampleRate, Segment};
use tokio::sync::mpsc;

use crate::cli::InputArgs;
use crate::input::{AUTO, Utterance};
use crate::media::wav;

/// Pieces that wait: a few seconds of sound.
const PIECES_MAX: usize = 16;
/// Samples in a piece of sound: half a second, well below the longest line of the wire.
const PIECE_SAMPLES: usize = 24_000;
/// Bytes read from standard input at once.
const READ_BYTES: usize = 4096;

/// A piece of an utterance.
#[derive(Debug)]
pub enum Piece {
    /// Labels, in order.
    Segments(Vec<Segment>),
    /// Sound, 48 kHz, one channel.
    Sound(Vec<f32>),
}

/// An utterance that comes in pieces; it is over when the channel closes.
pub struct Source {
    pub has_sound: bool,
    pub pieces: mpsc::Receiver<Piece>,
}

impl Source {
    /// Opens what `args` name. Files are read and checked before this returns.
    pub fn open(args: &InputArgs) -> Result<Self> {
        let streamed = Streamed::of(args)?;
        if let Some(streamed) = streamed.filter(|_| args.labels.as_deref() == Some(Path::new("-")))
        {
            let sound = args.audio.as_deref().map(wav::read).transpose()?;
            return Self::start(sound.map(|s| s.frames), move |send| {
                stdin_labels(streamed, send);
            });
        }
        let Utterance {
            segments, sound, ..
        } = Utterance::load(args)?;
        Self::of(segments, sound.map(|s| s.to_vec()))
    }

    /// An utterance that is there already.
    pub fn of(segments: Vec<Segment>, sound: Option<Vec<f32>>) -> Result<Self> {
        Self::start(sound, move |send| {
            // Nobody left to say it: nothing to do.
            let _ = send.blocking_send(Piece::Segments(segments));
        })
    }

    /// Sends sound and what `labels` sends, each from a thread of its own: labels must not wait
    /// until a long sound has been taken.
    fn start(
        sound: Option<Vec<f32>>,
        labels: impl FnOnce(&mpsc::Sender<Piece>) + Send + 'static,
    ) -> Result<Self> {
        let (send, pieces) = mpsc::channel(PIECES_MAX);
        let has_sound = sound.is_some();
        let sound_send = send.clone();
        spawn("labels", move || labels(&send))?;
        if let Some(sound) = sound {
            spawn("audio", move || {
                for piece in sound.chunks(PIECE_SAMPLES) {
                    if sound_send
                        .blocking_send(Piece::Sound(piece.to_vec()))
                        .is_err()
                    {
                        return;
                    }
                }
            })?;
        }
        Ok(Self { has_sound, pieces })
    }
}

/// The formats that can be spoken line by line.
enum Streamed {
    /// Nothing has come yet that tells: JSON begins with a brace, TIMIT with a number.
    Either(SampleRate, Option<Alphabet>),
    Timit(TimitStream),
    Ndjson(NdjsonStream),
}

impl Streamed {
    /// `None` where the user named a format that must be there to its end.
    fn of(args: &InputArgs) -> Result<Option<Self>> {
        let rate = SampleRate::new(args.label_rate)?;
        Ok(match args.from.as_deref() {
            None | Some(AUTO) => Some(Self::Either(rate, args.alphabet)),
            Some("timit") => Some(Self::Timit(TimitStream::new(rate))),
            Some("ndjson") => Some(Self::Ndjson(NdjsonStream::new(args.alphabet))),
            Some(_) => None,
        })
    }

    fn push(&mut self, bytes: &[u8], each: impl FnMut(Result<Segment, LineError>)) {
        if let Self::Either(rate, alphabet) = *self {
            match bytes.trim_ascii_start().first() {
                None => return,
                Some(b'{') => *self = Self::Ndjson(NdjsonStream::new(alphabet)),
                Some(_) => *self = Self::Timit(TimitStream::new(rate)),
            }
        }
        match self {
            Self::Timit(stream) => stream.push(bytes, each),
            Self::Ndjson(stream) => stream.push(bytes, each),
            Self::Either(..) => {}
        }
    }

    fn finish(&mut self, each: impl FnMut(Result<Segment, LineError>)) {
        match self {
            Self::Timit(stream) => stream.finish(each),
            Self::Ndjson(stream) => stream.finish(each),
            Self::Either(..) => {}
        }
    }
}

/// Reads labels from standard input as they come; a line that cannot be used is named and left out.
fn stdin_labels(mut stream: Streamed, send: &mpsc::Sender<Piece>) {
    let mut bytes = [0; READ_BYTES];
    let mut input = std::io::stdin().lock();
    loop {
        let mut segments = Vec::new();
        let mut each = |line: Result<Segment, LineError>| match line {
            Ok(segment) => segments.push(segment),
            Err(error) => tracing::warn!("<stdin>: {error}; the line is left out"),
        };
        let over = match input.read(&mut bytes) {
            Ok(0) => {
                stream.finish(&mut each);
                true
            }
            Ok(n) => {
                stream.push(&bytes[..n], &mut each);
                false
            }
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => false,
            Err(error) => {
                tracing::warn!("<stdin> cannot be read any more: {error}");
                true
            }
        };
        if !segments.is_empty() && send.blocking_send(Piece::Segments(segments)).is_err() {
            return;
        }
        if over {
            return;
        }
    }
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<()> {
    std::thread::Builder::new()
        .name(name.to_owned())
        .spawn(work)
        .with_context(|| format!("no thread for {name}"))?;
    Ok(())
}
