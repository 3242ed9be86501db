//! Every message of the wire. One JSON object a line; `type` says which; a field that is not listed
//! here is an error, so that a misspelt one is noticed.

use serde::{Deserialize, Serialize};

use crate::SampleFormat;

/// What a client sends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum ClientMessage {
    /// Opens an utterance; `phones`, `audio` and `end` that follow belong to it.
    Begin(Begin),
    /// Labels of the open utterance, in order of time.
    Phones {
        /// The labels; see [`Label`] for their unit.
        phones: Vec<Label>,
    },
    /// The next piece of the open utterance's sound, cut anywhere.
    Audio {
        /// Bytes in base64 (standard alphabet): interleaved samples, little-endian, as `begin` said.
        data: String,
    },
    /// Nothing more comes for the open utterance.
    End {},
    /// Barge-in: with an id, ends that utterance of this connection; without one, silences the
    /// face and forgets all that is queued, whoever sent it.
    Stop {
        /// Which utterance.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<String>,
    },
    /// Asks for a `pong`.
    Ping {
        /// Sent back as it is, 64 characters at most.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        token: Option<String>,
    },
}

/// Opens an utterance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Begin {
    /// The client's name for it, unique among this connection's utterances that have not ended.
    pub id: String,
    /// Its sound: none is a silent utterance, as long as its labels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub audio: Option<Audio>,
    /// What phones are written in: `timit`, the default, is the only one so far.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alphabet: Option<String>,
    /// Label times are whole samples at this rate; without it they are seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label_rate: Option<u32>,
}

/// Where an utterance's sound comes from: `file`, or `rate`, `channels` and `format` of what is sent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Audio {
    /// A WAV file on the daemon's machine, by its absolute path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Frames a second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<u32>,
    /// Samples in a frame; one unless told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channels: Option<u16>,
    /// What a sample is; `s16` unless told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<SampleFormat>,
}

/// One label. Times count from the first sample of the utterance's sound: seconds, or with
/// `label_rate` whole samples. They become ticks of 48 kHz, the nearest, before anything is done with
/// them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Label {
    /// When it begins.
    pub start: f64,
    /// When it is over: not part of it.
    pub end: f64,
    /// Its code in the utterance's alphabet.
    pub phone: String,
    /// Stress of its syllable as ARPAbet counts: 0 none, 1 primary, 2 secondary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<u8>,
}

/// What the daemon sends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum DaemonMessage {
    /// The utterance is queued; exactly one `finished`, `stopped` or `error` with its id ends it.
    Accepted {
        /// Which.
        id: String,
    },
    /// Its first sample can be heard now.
    Started {
        /// Which.
        id: String,
    },
    /// Where the listener is, about ten times a second.
    Progress {
        /// Which.
        id: String,
        /// Seconds from the start of its sound.
        position_s: f64,
    },
    /// It has been heard to its end.
    Finished {
        /// Which.
        id: String,
        /// Seconds from the start of its sound.
        position_s: f64,
        /// Sound and labels that came too late and were dropped, seconds.
        #[serde(default, skip_serializing_if = "is_zero")]
        dropped_s: f64,
    },
    /// It was stopped, by `stop` or before it began.
    Stopped {
        /// Which.
        id: String,
        /// Seconds of its sound that were heard.
        position_s: f64,
    },
    /// Something could not be done. With `fatal` the named utterance has ended; else it goes on
    /// without the message that failed.
    Error {
        /// Which utterance, where it is about one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<String>,
        /// What kind.
        code: ErrorCode,
        /// One sentence, with the mend.
        message: String,
        /// Whether it ends the utterance.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        fatal: bool,
    },
    /// The answer to `ping`.
    Pong {
        /// As it came.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        token: Option<String>,
        /// The protocol's version.
        version: u32,
    },
}

/// What kind of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorCode {
    /// The line is neither a known message nor a TIMIT label.
    Malformed,
    /// The message is not legal now.
    State,
    /// A bound was exceeded; see [`limits`](crate::limits).
    Limit,
    /// A label is wrong: unknown phone, ends before it starts, overlaps the one before.
    Label,
    /// The sound is wrong: format, encoding, or the file.
    Audio,
    /// The daemon cannot do it now.
    Busy,
}

impl DaemonMessage {
    /// The message as the line that is sent, newline included.
    #[must_use]
    pub fn line(&self) -> String {
        // Strings and finite numbers always have a JSON form; positions are finite by construction.
        let mut line = serde_json::to_string(self).unwrap_or_else(|_| {
            r#"{"type":"error","code":"busy","message":"this answer has no JSON form"}"#.to_owned()
        });
        line.push('\n');
        line
    }

    /// The utterance that this message ends, if it ends one.
    #[must_use]
    pub fn ends(&self) -> Option<&str> {
        match self {
            Self::Finished { id, .. } | Self::Stopped { id, .. } => Some(id),
            Self::Error {
                id, fatal: true, ..
            } => id.as_deref(),
            _ => None,
        }
    }
}

impl ClientMessage {
    /// The message as the line that is sent, newline included.
    ///
    /// # Errors
    /// When a label's time is no finite number.
    pub fn line(&self) -> Result<String, serde_json::Error> {
        let mut line = serde_json::to_string(self)?;
        line.push('\n');
        Ok(line)
    }
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde's skip_serializing_if passes a reference"
)]
fn is_zero(seconds: &f64) -> bool {
    *seconds == 0.0
}
