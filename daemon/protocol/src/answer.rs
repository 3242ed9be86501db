//! Every message that the daemon sends. One JSON object a line; `type` says which; later versions may
//! add fields and types, which a client leaves out.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the daemon sends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum DaemonMessage {
    /// The answer to `hello` and to a right `auth`.
    Hello {
        /// The protocol's version.
        version: u32,
        /// The daemon's name and its own version.
        daemon: String,
        /// What `begin` takes as `alphabet`.
        alphabets: Vec<String>,
    },
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
    /// Something was done otherwise than it was said; nothing was lost.
    Warning {
        /// Which utterance, where it is about one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<String>,
        /// One sentence.
        message: String,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
    /// An expression, a muscle or a point of gaze is wrong.
    Face,
    /// The token is missing or wrong.
    Auth,
    /// The client speaks a version of this protocol that the daemon does not know.
    Version,
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

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde's skip_serializing_if passes a reference"
)]
fn is_zero(seconds: &f64) -> bool {
    *seconds == 0.0
}
