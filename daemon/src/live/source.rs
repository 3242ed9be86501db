//! What `say` says, in pieces as they come: from files at once, labels on standard input line by line.

use std::io::Read as _;
use std::path::Path;

use anyhow::{Context as _, Result};
use mouthpiece_phonemes::{SampleRate, Segment, timit::TimitStream};
use tokio::sync::mpsc;

use crate::cli::InputArgs;
use crate::input::Utterance;
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
        let timit = args.from.as_deref().is_none_or(|f| f == "timit");
        if args.labels.as_deref() == Some(Path::new("-")) && timit {
            let rate = SampleRate::new(args.label_rate)?;
            let sound = args.audio.as_deref().map(wav::read).transpose()?;
            return Self::start(sound.map(|s| s.frames), move |send| {
                stdin_labels(rate, send);
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

/// Reads labels from standard input as they come; a line that cannot be used is named and left out.
fn stdin_labels(rate: SampleRate, send: &mpsc::Sender<Piece>) {
    let mut stream = TimitStream::new(rate);
    let mut bytes = [0; READ_BYTES];
    let mut input = std::io::stdin().lock();
    loop {
        let mut segments = Vec::new();
        let mut each = |line: Result<Segment, mouthpiece_phonemes::LineError>| match line {
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
