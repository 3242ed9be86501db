//! `[wire]`: who may speak through the face, and how much.

use std::path::PathBuf;

use clap::ValueEnum;
use mouthpiece_protocol::{Limits, limits};

use super::section::section;
use super::value::{Whole, one_or_more};

section! {
    /// Who may speak through the face, and how much. What goes beyond a bound is answered with an error
    /// message that names it. A changed bound is felt by clients that connect from then on; `turns`, and how much
    /// of utterances and sound is held for how long, at once.
    pub struct Wire {
        /// Where to listen, one place or a list: "unix:PATH", "HOST:PORT", "ws://HOST:PORT". Empty:
        /// mouthpiece.sock in $XDG_RUNTIME_DIR. Hosts beyond this machine need a token.
        #[serde(deserialize_with = "one_or_more")]
        listen: Vec<String> = Vec::new() => at_start,
        /// A group whose members may open the Unix socket, too, by name or number. They cannot name sound
        /// files then, unless `files` is set.
        group: Option<String> = None => at_start,
        /// A file with a token of 16 characters or more that clients over TCP and WebSocket have to know.
        token_file: Option<PathBuf> = None => at_start,
        /// Pages that may open a WebSocket, as browsers name them: `https://kiosk.example`, or `null` for a file.
        /// Pages of the daemon's own host may always, programs that are no browsers too.
        origins: Vec<String> = Vec::new(),
        /// The folder below which clients may name sound files. Not set: any file of this user over the Unix
        /// socket, none over TCP and WebSocket.
        files: Option<PathBuf> = None => at_start,
        /// When several clients speak: "queue" one after the other, "replace" what another one says, or "refuse"
        /// while another one has the word.
        turns: Turns = Turns::Queue,
        /// Clients at a time.
        clients: Whole<1, 1024> = Whole::new(32),
        /// Utterances of one client that wait or speak.
        pending: Whole<1, 100> = Whole::new(limits::PENDING_MAX as i64),
        /// Utterances of all clients that wait or speak.
        queue: Whole<1, 1000> = Whole::new(64),
        /// Longest utterance, seconds.
        utterance_seconds: Whole<1, 3600> = Whole::new(i64::from(limits::UTTERANCE_SECONDS_MAX)),
        /// Sound of one client that waits or speaks, seconds, 0.19 MB each.
        client_sound_seconds: Whole<1, 36000> = Whole::new(600),
        /// The same of all clients.
        sound_seconds: Whole<1, 36000> = Whole::new(1200),
        /// Longest line, bytes.
        line_bytes: Whole<1024, 67_108_864> = Whole::new(limits::LINE_BYTES_MAX as i64),
        /// Lines of one client in a second; more are read as slowly as that.
        lines_per_second: Whole<1, 1_000_000> = Whole::new(i64::from(limits::LINES_PER_SECOND_MAX)),
        /// Bytes of one client in a second; more are read as slowly as that.
        bytes_per_second: Whole<1024, 1_000_000_000> = Whole::new(i64::from(limits::BYTES_PER_SECOND_MAX)),
        /// A client that says nothing for so long, seconds, and has nothing left to be spoken is let go; a
        /// `ping` is enough.
        silent_seconds: Whole<1, 604_800> = Whole::new(i64::from(limits::SILENT_SECONDS_MAX)),
        /// An utterance that is not whole and gets nothing more for so long, seconds, is over.
        starved_seconds: Whole<1, 3600> = Whole::new(10),
        /// A client that takes no answer for so long, seconds, is let go.
        write_seconds: Whole<1, 600> = Whole::new(5),
    }
}

/// Who speaks when several want to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Turns {
    /// One utterance after the other, in the order in which they came.
    #[default]
    Queue,
    /// A new one stops those of other clients.
    Replace,
    /// A new one fails while another client's wait or speak.
    Refuse,
}

impl Wire {
    /// The bounds of a connection; `files` is whether its client may name sound files.
    pub fn limits(&self, files: bool) -> Limits {
        let bound = |value: i64| u32::try_from(value).unwrap_or(u32::MAX);
        let size = |value: i64| usize::try_from(value).unwrap_or(usize::MAX);
        Limits {
            line_bytes: size(self.line_bytes.get()),
            utterance_seconds: bound(self.utterance_seconds.get()),
            pending: size(self.pending.get()),
            files,
            lines_per_second: bound(self.lines_per_second.get()),
            bytes_per_second: bound(self.bytes_per_second.get()),
            silent_seconds: bound(self.silent_seconds.get()),
            ..Limits::default()
        }
    }
}
