//! The utterance that is being sent: its labels and sound are checked here as they come.

use std::path::PathBuf;

use base64::Engine as _;
use mouthpiece_phonemes::{Phone, SampleRate, Segment, Stress, TICK_RATE, UnknownCode};

use super::{Refusal, Sound, chars_beyond};
use crate::message::{Audio, Begin, ErrorCode, Label};
use crate::pcm::Decoder;
use crate::raw::clip;
use crate::{Limits, Pcm, limits};

#[derive(Debug)]
pub(super) struct Open {
    pub(super) id: String,
    /// Made of TIMIT lines.
    pub(super) raw: bool,
    /// It was stopped or failed: what still comes for it is ignored.
    pub(super) void: bool,
    /// Samples that label times count in; none for seconds.
    label_rate: Option<SampleRate>,
    labels: usize,
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
            label_rate: Some(SampleRate::TIMIT),
            labels: 0,
            labelled: 0,
            decoder: None,
            pcm: None,
            frames: 0,
        }
    }

    pub(super) fn new(begin: Begin, limits: &Limits) -> Result<(Self, Sound), Refusal> {
        check_id(&begin.id)?;
        if let Some(alphabet) = begin.alphabet.as_deref().filter(|a| *a != "timit") {
            return Err((
                ErrorCode::Label,
                format!(
                    "the alphabet `{}` is not known; use `timit`",
                    clip(alphabet)
                ),
            ));
        }
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
            label_rate,
            decoder: pcm.map(Decoder::new),
            pcm,
            ..Self::raw(begin.id)
        };
        Ok((open, sound))
    }

    /// The labels of a message, all of them or none.
    pub(super) fn labels(
        &mut self,
        labels: &[Label],
        limits: &Limits,
    ) -> Result<Vec<Segment>, Refusal> {
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
        let segments: Result<Vec<Segment>, Refusal> = labels
            .iter()
            .map(|label| {
                let segment = self.segment(label)?;
                self.check(segment, limits)?;
                Ok(segment)
            })
            .collect();
        if segments.is_err() {
            (self.labels, self.labelled) = before;
        }
        segments
    }

    /// Whether a label can follow those before it; if so it is counted.
    pub(super) fn check(&mut self, segment: Segment, limits: &Limits) -> Result<(), Refusal> {
        let Segment { start, end, .. } = segment;
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
                    segment.phone,
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

    /// The samples of a message.
    pub(super) fn audio(&mut self, data: &str, limits: &Limits) -> Result<Vec<f32>, Refusal> {
        let (Some(decoder), Some(pcm)) = (&mut self.decoder, self.pcm) else {
            return Err((
                ErrorCode::State,
                format!(
                    "`{}` was begun without sound that is sent; give `audio` its rate in `begin`",
                    self.id
                ),
            ));
        };
        let bytes = base64::engine::general_purpose::STANDARD
            .decode(data)
            .map_err(|e| (ErrorCode::Audio, format!("the sound is no base64: {e}")))?;
        let frames_max = u64::from(limits.utterance_seconds) * u64::from(pcm.rate);
        if self.frames + (bytes.len() / pcm.frame_bytes()) as u64 > frames_max {
            return Err(too_long(limits));
        }
        let mono = decoder.decode(&bytes);
        self.frames += mono.len() as u64;
        Ok(mono)
    }

    fn segment(&self, label: &Label) -> Result<Segment, Refusal> {
        let phone = Phone::from_code(&label.phone).ok_or_else(|| {
            (
                ErrorCode::Label,
                UnknownCode(clip(&label.phone)).to_string(),
            )
        })?;
        let stress = match label.stress {
            None => None,
            Some(0) => Some(Stress::Unstressed),
            Some(1) => Some(Stress::Primary),
            Some(2) => Some(Stress::Secondary),
            Some(n) => {
                return Err((ErrorCode::Label, format!("stress is 0, 1 or 2, not {n}")));
            }
        };
        Ok(Segment {
            phone,
            start: self.ticks(label.start)?,
            end: self.ticks(label.end)?,
            stress,
        })
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
