//! What a client is told of itself: errors that are about no utterance.

use mouthpiece_protocol::{DaemonMessage, ErrorCode, Limits};

/// An error that is about no utterance.
pub fn refusal(code: ErrorCode, message: String) -> DaemonMessage {
    DaemonMessage::Error {
        id: None,
        code,
        message,
        fatal: false,
    }
}

/// The last word to a client that has none.
pub(super) fn silence(trusted: bool, limits: &Limits) -> DaemonMessage {
    if trusted {
        let message = format!(
            "nothing came for {} s, so the connection is closed; send a `ping` now and then",
            limits.silent_seconds
        );
        refusal(ErrorCode::Limit, message)
    } else {
        let message = format!("no token came within {} s", limits.auth_seconds);
        refusal(ErrorCode::Auth, message)
    }
}

/// What a client is told that sends faster than it is read.
pub(super) fn slowness(limits: &Limits) -> DaemonMessage {
    let message = format!(
        "more than {} lines or {} bytes came in a second; the rest is read as slowly as that",
        limits.lines_per_second, limits.bytes_per_second
    );
    refusal(ErrorCode::Limit, message)
}
