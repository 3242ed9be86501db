//! The utterance that is being sent: its labels and sound are checked here as they come.

use std::path::PathBuf;

use base64::Engine as _;
use mouthpiece_phonemes::{
    Alphabet, Notes, SampleRate, Segment, Stress, TICK_RATE, UnknownAlphabet, alphabet,
};

use super::{Refusal, Sound, chars_beyond};
use crate::message::{Audio, Begin, Label};
use crate::pcm::Decoder;
use crate::raw::clip;
use crate::{ErrorCode, Limits, Pcm, limits};

#[derive(Debug)]
pub(super) struct Open {
    pub(super) id: String,
    /// Made of TIMIT lines.
    pub(super) raw: bool,
    /// It was stopped or failed: what still comes for it is ignored.
    pub(super) void: bool,
    alphabet: Alphabet,
    /// Symbols that were warned of.
    warned: Vec<String>,
    /// Samples that label times count in; none for seconds.
    label_rate: Option<SampleRate>,
    labels: usize,
    captions: usize,
    /// When the last caption is shown, ticks.
    captioned: i64,
    /// Where the last label ended, ticks.
    labelled: i64,
    decoder: Option<Decoder>,
    pcm: Option<Pcm>,
    frames: u64,
}

impl Open {
    pub(super) fn raw(id: String) -> Self {
        Self {
            id,
            raw: true,
            void: false,
            alphabet: Alphabet::Timit,
            warned: Vec::new(),
            label_rate: Some(SampleRate::TIMIT),
            labels: 0,
            captions: 0,
            captioned: 0,
            labelled: 0,
            decoder: None,
            pcm: None,
            frames: 0,
        }
    }

    pub(super) fn new(begin: Begin, limits: &Limits) -> Result<(Self, Sound), Refusal> {
        check_id(&begin.id)?;
        let alphabet = match &begin.alphabet {
            None => Alphabet::Timit,
            Some(name) => clip(name)
                .parse()
                .map_err(|e: UnknownAlphabet| (ErrorCode::Label, e.to_string()))?,
        };
        let label_rate = match begin.label_rate {
            None => None,
            Some(hz) => Some(SampleRate::new(hz).map_err(|e| (ErrorCode::Label, e.to_string()))?),
        };
        let sound = match begin.audio {
            None => Sound::Silent,
            Some(audio) => sound(audio, limits)?,
        };
        let pcm = match sound {
            Sound::Sent(pcm) => Some(pcm),
            Sound::Silent | Sound::File(_) => None,
        };
        let open = Self {
            raw: false,
            alphabet,
            label_rate,
            decoder: pcm.map(Decoder::new),
            pcm,
            ..Self::raw(begin.id)
        };
        Ok((open, sound))
    }

    /// The segments of a message's labels, all of them or none, and what had to be guessed.
    pub(super) fn labels(
        &mut self,
        labels: &[Label],
        limits: &Limits,
    ) -> Result<(Vec<Segment>, Vec<String>), Refusal> {
        if labels.len() > limits.phones_per_message {
            return Err((
                ErrorCode::Limit,
                format!(
                    "a message has at most {} labels; send several",
                    limits.phones_per_message
                ),
            ));
        }
        let before = (self.labels, self.labelled);
        let mut segments = Vec::with_capacity(labels.len());
        let mut notes = Notes::default();
        let mut new = Vec::new();
        for label in labels {
            if let Err(refusal) = self.label(label, limits, &mut segments, &mut notes, &mut new) {
                (self.labels, self.labelled) = before;
                return Err(refusal);
            }
        }
        self.warned.append(&mut new);
        let warnings = notes.finish().into_iter().map(|note| note.text);
        Ok((segments, warnings.collect()))
    }

    /// One label; symbols that are unknown for the first time go to `notes` and `new`.
    fn label(
        &mut self,
        label: &Label,
        limits: &Limits,
        segments: &mut Vec<Segment>,
        notes: &mut Notes,
        new: &mut Vec<String>,
    ) -> Result<(), Refusal> {
        if chars_beyond(&label.phone, limits::SYMBOL_CHARS_MAX) {
            return Err((
                ErrorCode::Limit,
                format!(
                    "a phone has at most {} characters",
                    limits::SYMBOL_CHARS_MAX
                ),
            ));
        }
        let stress = match label.stress {
            None => None,
            Some(0) => Some(Stress::Unstressed),
            Some(1) => Some(Stress::Primary),
            Some(2) => Some(Stress::Secondary),
            Some(n) => {
                return Err((ErrorCode::Label, format!("stress is 0, 1 or 2, not {n}")));
            }
        };
        let (start, end) = (self.ticks(label.start)?, self.ticks(label.end)?);
        self.check(&label.phone, start, end, limits)?;
        let first = segments.len();
        let spoken = alphabet::segments(self.alphabet, &label.phone, start, end, segments);
        if stress.is_some() {
            segments[first..].iter_mut().for_each(|s| s.stress = stress);
        }
        let warned = self.warned.len() + new.len();
        if !spoken.exact
            && warned < limits::WARNINGS_PER_UTTERANCE_MAX
            && !self.warned.iter().chain(&*new).any(|w| *w == label.phone)
        {
            notes.symbol(self.alphabet, &label.phone, spoken, None);
            new.push(label.phone.clone());
        }
        Ok(())
    }

    /// Whether a label can follow those before it; if so it is counted.
    pub(super) fn check(
        &mut self,
        symbol: &str,
        start: i64,
        end: i64,
        limits: &Limits,
    ) -> Result<(), Refusal> {
        let seconds = |ticks: i64| ticks as f64 / TICK_RATE as f64;
        let wrong = if end <= start {
            Some("ends before it starts".to_owned())
        } else if start < self.labelled {
            Some(format!(
                "starts before {:.3} s, where the one before it ends",
                seconds(self.labelled)
            ))
        } else {
            None
        };
        if let Some(wrong) = wrong {
            return Err((
                ErrorCode::Label,
                format!(
                    "the label `{}` at {:.3} s {wrong}",
                    clip(symbol),
                    seconds(start)
                ),
            ));
        }
        if end > i64::from(limits.utterance_seconds) * TICK_RATE {
            return Err(too_long(limits));
        }
        if self.labels >= limits.phones_per_utterance {
            return Err((
                ErrorCode::Limit,
                format!(
                    "an utterance has at most {} labels; begin another",
                    limits.phones_per_utterance
                ),
            ));
        }
        self.labels += 1;
        self.labelled = end;
        Ok(())
    }

    /// Whether a caption from tick `start` on can follow those before it; if so it is counted.
    pub(super) fn caption(&mut self, start: i64) -> Result<(), Refusal> {
        if self.captions >= limits::CAPTIONS_PER_UTTERANCE_MAX {
            return Err((
                ErrorCode::Limit,
                format!(
                    "an utterance has at most {} captions",
                    limits::CAPTIONS_PER_UTTERANCE_MAX
                ),
            ));
        }
        if start < self.captioned {
            return Err((
                ErrorCode::Label,
                "a caption starts before the one before it; send captions in order".to_owned(),
            ));
        }
        self.captions += 1;
        self.captioned = start;
        Ok(())
    }

    /// The samples of a message.
    pub(super) fn audio(&mut self, bytes: &[u8], limits: &Limits) -> Result<Vec<f32>, Refusal> {
        let (Some(decoder), Some(pcm)) = (&mut self.decoder, self.pcm) else {
            return Err((
                ErrorCode::State,
                format!(
                    "`{}` was begun without sound that is sent; give `audio` its rate in `begin`",
                    self.id
                ),
            ));
        };
        let frames_max = u64::from(limits.utterance_seconds) * u64::from(pcm.rate);
        if self.frames + (bytes.len() / pcm.frame_bytes()) as u64 > frames_max {
            return Err(too_long(limits));
        }
        let mono = decoder.decode(bytes);
        self.frames += mono.len() as u64;
        Ok(mono)
    }

    fn ticks(&self, time: f64) -> Result<i64, Refusal> {
        let ticks = match self.label_rate {
            // A day of ticks is far below 2^53, so that the product is exact to a tick.
            None if (0.0..86_400.0).contains(&time) => {
                Some((time * TICK_RATE as f64).round() as i64)
            }
            Some(rate) if time >= 0.0 && time.fract() == 0.0 && time < 1e15 => {
                rate.ticks(time as i64)
            }
            _ => None,
        };
        ticks.ok_or_else(|| {
            let unit = match self.label_rate {
                None => "a time in seconds from 0".to_owned(),
                Some(rate) => format!("a whole sample number at {} Hz", rate.hz()),
            };
            (ErrorCode::Label, format!("{time} is not {unit}"))
        })
    }
}

/// The bytes of an `audio` message.
pub(super) fn sound_bytes(data: &str) -> Result<Vec<u8>, Refusal> {
    base64::engine::general_purpose::STANDARD
        .decode(data)
        .map_err(|e| (ErrorCode::Audio, format!("the sound is no base64: {e}")))
}

fn check_id(id: &str) -> Result<(), Refusal> {
    if id.is_empty() || chars_beyond(id, limits::ID_CHARS_MAX) || id.chars().any(char::is_control) {
        return Err((
            ErrorCode::Limit,
            format!(
                "an id has 1 to {} characters, none of them control characters",
                limits::ID_CHARS_MAX
            ),
        ));
    }
    Ok(())
}

fn sound(audio: Audio, limits: &Limits) -> Result<Sound, Refusal> {
    let wrong = |message: String| Err((ErrorCode::Audio, message));
    if let Some(file) = audio.file {
        if audio.rate.is_some() || audio.channels.is_some() || audio.format.is_some() {
            return wrong("`audio` has either `file` or `rate`, `channels`, `format`".to_owned());
        }
        if !limits.files {
            return wrong(
                "files are not read for clients of this address; send the sound".to_owned(),
            );
        }
        if chars_beyond(&file, limits::PATH_CHARS_MAX) || !file.starts_with('/') {
            return wrong(
                "`file` is an absolute path, since the daemon has a folder of its own".to_owned(),
            );
        }
        return Ok(Sound::File(PathBuf::from(file)));
    }
    let Some(rate) = audio.rate else {
        return wrong("`audio` needs `rate` (sound is sent) or `file`".to_owned());
    };
    let rates = limits::AUDIO_RATE_HZ;
    if !rates.contains(&rate) {
        return wrong(format!(
            "sound at {rate} Hz is not taken; send {} to {} Hz",
            rates.start(),
            rates.end()
        ));
    }
    let channels = audio.channels.unwrap_or(1);
    if !(1..=limits::CHANNELS_MAX).contains(&channels) {
        return wrong(format!(
            "sound with {channels} channels is not taken; send 1 to {}",
            limits::CHANNELS_MAX
        ));
    }
    Ok(Sound::Sent(Pcm {
        rate,
        channels,
        format: audio.format.unwrap_or_default(),
    }))
}

fn too_long(limits: &Limits) -> Refusal {
    (
        ErrorCode::Limit,
        format!(
            "an utterance lasts at most {} s; begin another",
            limits.utterance_seconds
        ),
    )
}
