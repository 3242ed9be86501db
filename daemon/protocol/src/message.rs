//! Every message that a client sends. One JSON object a line; `type` says which; a field that is not
//! listed here is an error, so that a misspelt one is noticed.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::SampleFormat;

/// What a client sends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum ClientMessage {
    /// Who calls and which version of this protocol it speaks; answered with `hello`. May be left out.
    Hello {
        /// The client's version; without one any will do.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        version: Option<u32>,
        /// The client's name, for the daemon's log, 64 characters at most.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        client: Option<String>,
    },
    /// The daemon's token, where it wants one: before anything but `hello`. Answered with `hello`; a
    /// wrong one ends the connection.
    Auth {
        /// As it stands in the daemon's token file.
        token: String,
    },
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
    /// What the face shows, over speech or without, until the next `express`.
    Express(Express),
    /// Where the eyes look, until the next `look`.
    Look(Look),
    /// What the face does while it says nothing, until it has spoken again.
    State {
        /// What.
        state: FaceState,
    },
    /// A text for the screen.
    Caption(Caption),
    /// Asks for a `pong`.
    Ping {
        /// Sent back as it is, 64 characters at most.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        token: Option<String>,
    },
}

/// Opens an utterance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Begin {
    /// The client's name for it, unique among this connection's utterances that have not ended.
    pub id: String,
    /// Its sound: none is a silent utterance, as long as its labels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub audio: Option<Audio>,
    /// What phones are written in: `timit`, the default, `arpabet`, `radio`, `ipa`, `x-sampa`, `espeak`.
    /// A symbol that is not known there becomes the nearest phone, with a `warning`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alphabet: Option<String>,
    /// Label times are whole samples at this rate; without it they are seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label_rate: Option<u32>,
}

/// Where an utterance's sound comes from: `file`, or `rate`, `channels` and `format` of what is sent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// A face: an expression by name or muscles by name; with neither, none of them any more. Where it
/// and speech want different things of the lips, speech wins: they still close in /p b m/.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Express {
    /// A name of the library: `happiness`, `smile`, `wink_left`; an unknown one is answered with all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expression: Option<String>,
    /// Values of muscles and other controls, by the names of `mouthpiece curves`; a muscle's with `_l`
    /// or `_r` behind it is the subject's left or right one alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub muscles: Option<BTreeMap<String, f32>>,
    /// How much of it, 0 to 1; all unless told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f32>,
    /// How long the face takes there, seconds; 0.3 unless told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fade_s: Option<f32>,
}

/// A point to look at; without one the eyes follow their own life again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Look {
    /// Millimetres from the middle between the eyes: to the face's own left, up, and towards the
    /// viewer, which must be at least 1. `[0, 0, 1000]` is a viewer a metre away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f32; 3]>,
    /// How long the head takes to follow the eyes, seconds; 0.5 unless told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fade_s: Option<f32>,
}

/// What a face does while it says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FaceState {
    /// Nobody is there.
    Idle,
    /// Somebody speaks to it.
    Listening,
    /// It looks for words.
    Thinking,
}

/// A text for the screen. While an utterance is open it belongs to it: it is shown from `start` of its
/// sound until the utterance's next caption or its end. Else it is shown at once, until the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Caption {
    /// The text, 500 characters at most; an empty one clears the screen.
    pub text: String,
    /// When it is shown, seconds from the start of the open utterance's sound; 0 unless told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
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
