//! What `say` says, in pieces as they come: from files at once, from pipes (`-`, `fd:3`) labels line by line and
//! sound block by block.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use anyhow::{Context as _, Result};
use mouthpiece_phonemes::formats::NdjsonStream;
use mouthpiece_phonemes::timit::TimitStream;
use mouthpiece_phonemes::{Alphabet, LineError, SampleRate, Segment};
use tokio::sync::mpsc;

use super::sound::resample::Resample;
use super::subtitles::subtitles;
use crate::cli::InputArgs;
use crate::input::{self, AUTO, Utterance};
use crate::media::wav;

/// Pieces that wait: a few seconds of sound.
const PIECES_MAX: usize = 16;
/// Samples in a piece of sound: half a second, well below the longest line of the wire.
const PIECE_SAMPLES: usize = 24_000;
/// Bytes of labels read at once.
const READ_BYTES: usize = 4096;
/// Bytes of sound read at once from a pipe: 43 ms at 48 kHz and 16 bits, so that little waits to be whole.
const PIPE_BYTES: usize = 4096;
/// The rate of everything that is spoken.
const RATE_HZ: u32 = 48_000;

/// A piece of an utterance.
#[derive(Debug)]
pub enum Piece {
    /// A text for the screen, and from which tick of the sound on.
    Caption(i64, String),
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
        input::one_use(args)?;
        let Some(path) = &args.labels else {
            return Self::whole(args);
        };
        let (labels, sound) = (input::pipe(path), args.audio.as_deref());
        let sound_pipe = sound.and_then(input::pipe);
        if labels.is_none() && sound_pipe.is_none() {
            return Self::whole(args);
        }
        let streamed = Streamed::of(args)?.filter(|_| labels.is_some());
        let labels = match (labels, streamed) {
            (Some(pipe), Some(streamed)) => {
                let file = input::open_pipe(&pipe)
                    .with_context(|| format!("{} cannot be read", path.display()))?;
                Labels::Coming(file, streamed)
            }
            // A format that must be there to its end.
            _ => {
                let options = input::options(args)?;
                let labels = input::read_labels(path, args.from.as_deref(), &options)?;
                Labels::There(labels.segments, Vec::new())
            }
        };
        let sound = match (sound, sound_pipe) {
            (Some(path), Some(pipe)) => Some(coming_sound(path, &pipe)?),
            (Some(path), None) => Some(SoundFrom::Frames(wav::read(path)?.frames)),
            (None, _) => None,
        };
        Self::start(sound, labels)
    }

    /// What is read and checked at once.
    fn whole(args: &InputArgs) -> Result<Self> {
        let Utterance {
            segments,
            sound,
            text,
            ..
        } = Utterance::load(args)?;
        let captions = subtitles(text.as_deref().unwrap_or_default(), &segments);
        let sound = sound.map(|s| SoundFrom::Frames(s.to_vec()));
        Self::start(sound, Labels::There(segments, captions))
    }

    /// An utterance that is there already.
    pub fn of(segments: Vec<Segment>, sound: Option<Vec<f32>>) -> Result<Self> {
        let labels = Labels::There(segments, Vec::new());
        Self::start(sound.map(SoundFrom::Frames), labels)
    }

    /// Sends sound and labels, each from a thread of its own: labels must not wait until a long sound
    /// has been taken.
    fn start(sound: Option<SoundFrom>, labels: Labels) -> Result<Self> {
        let (send, pieces) = mpsc::channel(PIECES_MAX);
        let has_sound = sound.is_some();
        let sound_send = send.clone();
        spawn("labels", move || match labels {
            Labels::There(segments, captions) => {
                let captions = captions
                    .into_iter()
                    .map(|(at, text)| Piece::Caption(at, text));
                for piece in captions.chain([Piece::Segments(segments)]) {
                    if send.blocking_send(piece).is_err() {
                        return; // nobody left to say it
                    }
                }
            }
            Labels::Coming(file, streamed) => labels_from(file, streamed, &send),
        })?;
        if let Some(sound) = sound {
            spawn("audio", move || match sound {
                SoundFrom::Frames(frames) => {
                    for piece in frames.chunks(PIECE_SAMPLES) {
                        let piece = Piece::Sound(piece.to_vec());
                        if sound_send.blocking_send(piece).is_err() {
                            return;
                        }
                    }
                }
                SoundFrom::Pipe(stream, resample) => sound_from(stream, resample, &sound_send),
            })?;
        }
        Ok(Self { has_sound, pieces })
    }
}

/// Labels that are there already, with the captions of their text, or come through a pipe.
enum Labels {
    There(Vec<Segment>, Vec<(i64, String)>),
    Coming(File, Streamed),
}

/// The same of sound.
enum SoundFrom {
    Frames(Vec<f32>),
    Pipe(wav::Stream<'static>, Box<Resample>),
}

/// Opens sound that comes through `pipe`, and waits for its header.
fn coming_sound(path: &Path, pipe: &Path) -> Result<SoundFrom> {
    let name = path.display().to_string();
    let file = input::open_pipe(pipe).with_context(|| format!("{name} cannot be read"))?;
    let stream = wav::Stream::open(file, &name, PIPE_BYTES)?;
    let resample = Resample::new(stream.rate(), RATE_HZ)?;
    Ok(SoundFrom::Pipe(stream, Box::new(resample)))
}

/// Sends sound as it comes, until it is over or nobody wants it.
fn sound_from(
    mut stream: wav::Stream<'_>,
    mut resample: Box<Resample>,
    send: &mpsc::Sender<Piece>,
) {
    let mut mono = Vec::new();
    loop {
        let mut ticks = Vec::new();
        let over = match stream.read(&mut mono) {
            Ok(true) => resample.push(&mono, &mut ticks).is_err(),
            Ok(false) => true,
            Err(error) => {
                tracing::warn!("{error}; what came before is spoken");
                true
            }
        };
        if over && let Err(error) = resample.finish(&mut ticks) {
            tracing::warn!("the end of the sound is lost: {error:#}");
        }
        if !ticks.is_empty() && send.blocking_send(Piece::Sound(ticks)).is_err() {
            return;
        }
        if over {
            return;
        }
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

/// Sends labels as they come; a line that cannot be used is named and left out.
fn labels_from(mut input: File, mut stream: Streamed, send: &mpsc::Sender<Piece>) {
    let mut bytes = [0; READ_BYTES];
    loop {
        let mut segments = Vec::new();
        let mut each = |line: Result<Segment, LineError>| match line {
            Ok(segment) => segments.push(segment),
            Err(error) => tracing::warn!("the labels: {error}; the line is left out"),
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
                tracing::warn!("the labels cannot be read any more: {error}");
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
