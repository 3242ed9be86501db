//! The state of one connection: which message is legal when, and what it means.
//!
//! | message | no utterance open | one open |
//! |---|---|---|
//! | `begin` | opens one | error `state`; ends it when it is a TIMIT stream's or was stopped |
//! | `phones`, `audio` | error `state` | taken; without a word ignored once it was stopped |
//! | `end` | error `state` | closes it |
//! | TIMIT line | opens one | taken by a TIMIT stream's, else error `state` |
//! | empty line | ignored | closes a TIMIT stream's |
//! | `stop`, `ping` | done | done |
//! | end of stream | | closes it |
//!
//! A message that is refused changes nothing. Utterances that are closed stay *pending* until the
//! daemon says that they ended; their ids and their number are kept here.

mod open;

use mouthpiece_phonemes::Segment;

use crate::lines::{Line, Lines};
use crate::message::{Begin, ClientMessage, DaemonMessage, ErrorCode};
use crate::{Limits, Pcm, VERSION, limits, raw};
use open::Open;

/// Where an utterance's sound comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sound {
    /// It has none.
    Silent,
    /// A WAV file.
    File(std::path::PathBuf),
    /// It is sent.
    Sent(Pcm),
}

/// What the daemon is to do. Ids are the connection's own.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Send this to the client.
    Reply(DaemonMessage),
    /// Queue an utterance; it was answered with `accepted`.
    Begin {
        /// Its id.
        id: String,
        /// Its sound.
        sound: Sound,
    },
    /// Labels of an utterance, in order of time, none overlapping, also across actions.
    Segments {
        /// Whose.
        id: String,
        /// The labels, in ticks from the start of its sound.
        segments: Vec<Segment>,
    },
    /// The next samples of an utterance's sound, one channel, at the rate of [`Sound::Sent`].
    Audio {
        /// Whose.
        id: String,
        /// The samples.
        mono: Vec<f32>,
    },
    /// Nothing more comes for an utterance.
    End {
        /// Which.
        id: String,
    },
    /// Stop one utterance, or with `None` everything that is heard or queued.
    Stop {
        /// Which.
        id: Option<String>,
    },
}

/// What an error answer says.
type Refusal = (ErrorCode, String);

/// One connection.
#[derive(Debug)]
pub struct Session {
    limits: Limits,
    lines: Lines,
    open: Option<Open>,
    /// Accepted and not ended, the open one included.
    pending: Vec<String>,
    raw_count: u64,
}

impl Session {
    /// A connection on which nothing was said yet.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            lines: Lines::new(limits.line_bytes),
            limits,
            open: None,
            pending: Vec::new(),
            raw_count: 0,
        }
    }

    /// Takes bytes as they came in, cut anywhere; what is to be done goes to `out`.
    pub fn receive(&mut self, mut bytes: &[u8], out: &mut Vec<Action>) {
        while !bytes.is_empty() {
            if let Some(line) = self.lines.next(&mut bytes) {
                self.take(&line, out);
            }
        }
    }

    /// The client sends no more: its last line, though cut off, counts, and the open utterance is closed.
    pub fn closed(&mut self, out: &mut Vec<Action>) {
        if let Some(line) = self.lines.last() {
            self.take(&line, out);
        }
        self.close(out);
    }

    /// Whether anything that was accepted has not ended.
    #[must_use]
    pub fn has_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// The daemon ended an utterance by itself: finished, stopped or failed. Says whether it was
    /// pending, so that its end is told once.
    pub fn ended(&mut self, id: &str) -> bool {
        let Some(at) = self.pending.iter().position(|p| p == id) else {
            return false;
        };
        self.pending.remove(at);
        if let Some(open) = &mut self.open
            && open.id == id
        {
            open.void = true;
        }
        true
    }

    fn take(&mut self, line: &Line, out: &mut Vec<Action>) {
        let done = match line {
            Line::TooLong => Err((
                ErrorCode::Limit,
                format!(
                    "a line has at most {} bytes; send longer sound in several messages",
                    self.limits.line_bytes
                ),
            )),
            Line::Whole => match std::str::from_utf8(self.lines.line()) {
                Ok(text) => {
                    let text = text.trim().to_owned();
                    self.line(&text, out)
                }
                Err(_) => Err((ErrorCode::Malformed, "a line is UTF-8 text".to_owned())),
            },
        };
        if let Err((code, message)) = done {
            out.push(Action::Reply(DaemonMessage::Error {
                id: self.open.as_ref().filter(|o| !o.void).map(|o| o.id.clone()),
                code,
                message,
                fatal: false,
            }));
        }
    }

    fn line(&mut self, text: &str, out: &mut Vec<Action>) -> Result<(), Refusal> {
        if text.is_empty() {
            if self.open.as_ref().is_some_and(|o| o.raw) {
                self.close(out);
            }
            return Ok(());
        }
        if !text.starts_with('{') {
            return self.raw_line(text, out);
        }
        let message: ClientMessage =
            serde_json::from_str(text).map_err(|e| (ErrorCode::Malformed, raw_reason(&e)))?;
        self.message(message, out)
    }

    fn message(&mut self, message: ClientMessage, out: &mut Vec<Action>) -> Result<(), Refusal> {
        match message {
            ClientMessage::Begin(begin) => self.begin(begin, out),
            ClientMessage::Phones { phones } => {
                let limits = self.limits.clone();
                let open = self.opened("phones")?;
                if open.void {
                    return Ok(());
                }
                let segments = open.labels(&phones, &limits)?;
                let id = open.id.clone();
                if !segments.is_empty() {
                    out.push(Action::Segments { id, segments });
                }
                Ok(())
            }
            ClientMessage::Audio { data } => {
                let limits = self.limits.clone();
                let open = self.opened("audio")?;
                if open.void {
                    return Ok(());
                }
                let mono = open.audio(&data, &limits)?;
                let id = open.id.clone();
                if !mono.is_empty() {
                    out.push(Action::Audio { id, mono });
                }
                Ok(())
            }
            ClientMessage::End {} => {
                self.opened("end")?;
                self.close(out);
                Ok(())
            }
            ClientMessage::Stop { id } => self.stop(id, out),
            ClientMessage::Ping { token } => {
                if token
                    .as_ref()
                    .is_some_and(|t| chars_beyond(t, limits::TOKEN_CHARS_MAX))
                {
                    return Err((
                        ErrorCode::Limit,
                        format!("a token has at most {} characters", limits::TOKEN_CHARS_MAX),
                    ));
                }
                let version = VERSION;
                out.push(Action::Reply(DaemonMessage::Pong { token, version }));
                Ok(())
            }
        }
    }

    fn begin(&mut self, begin: Begin, out: &mut Vec<Action>) -> Result<(), Refusal> {
        match &self.open {
            Some(open) if !open.raw && !open.void => {
                return Err((
                    ErrorCode::State,
                    format!("`{}` is still open; send `end` first", open.id),
                ));
            }
            Some(_) | None => {}
        }
        let (open, sound) = Open::new(begin, &self.limits)?;
        self.accept(open, sound, out)
    }

    /// Opens an utterance if there is room for it; closes a TIMIT stream's that was open.
    fn accept(&mut self, open: Open, sound: Sound, out: &mut Vec<Action>) -> Result<(), Refusal> {
        if self.pending.len() >= self.limits.pending {
            return Err((
                ErrorCode::Limit,
                format!(
                    "{} utterances of this connection wait already; begin when one has ended",
                    self.pending.len()
                ),
            ));
        }
        if self.pending.contains(&open.id) {
            return Err((
                ErrorCode::State,
                format!("`{}` has not ended; take another id", open.id),
            ));
        }
        self.close(out);
        let id = open.id.clone();
        self.pending.push(id.clone());
        self.open = Some(open);
        out.push(Action::Reply(DaemonMessage::Accepted { id: id.clone() }));
        out.push(Action::Begin { id, sound });
        Ok(())
    }

    fn raw_line(&mut self, text: &str, out: &mut Vec<Action>) -> Result<(), Refusal> {
        if let Some(open) = self.open.as_ref().filter(|o| !o.raw && !o.void) {
            return Err((
                ErrorCode::State,
                format!(
                    "`{}` is open and takes `phones`, not TIMIT lines; send `end` first",
                    open.id
                ),
            ));
        }
        let segment = raw::segment(text).map_err(|why| {
            let code = if text.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
                ErrorCode::Label
            } else {
                ErrorCode::Malformed
            };
            (code, why)
        })?;
        // Checked against a copy first: a refused line must not open an utterance.
        match &mut self.open {
            Some(open) if open.raw => {
                if open.void {
                    return Ok(());
                }
                open.check(segment, &self.limits)?;
            }
            _ => {
                let mut open = Open::raw(self.raw_id());
                open.check(segment, &self.limits)?;
                self.accept(open, Sound::Silent, out)?;
                self.raw_count += 1;
            }
        }
        if let Some(open) = &self.open {
            out.push(Action::Segments {
                id: open.id.clone(),
                segments: vec![segment],
            });
        }
        Ok(())
    }

    /// A name that no pending utterance has.
    fn raw_id(&self) -> String {
        (self.raw_count + 1..)
            .map(|n| format!("timit-{n}"))
            .find(|id| !self.pending.contains(id))
            .unwrap_or_default()
    }

    fn stop(&mut self, id: Option<String>, out: &mut Vec<Action>) -> Result<(), Refusal> {
        if let Some(id) = &id
            && !self.pending.contains(id)
        {
            return Err((
                ErrorCode::State,
                format!("`{}` is not waiting or speaking here", raw::clip(id)),
            ));
        }
        out.push(Action::Stop { id });
        Ok(())
    }

    fn opened(&mut self, what: &str) -> Result<&mut Open, Refusal> {
        self.open.as_mut().ok_or_else(|| {
            (
                ErrorCode::State,
                format!("`{what}` belongs to an utterance; send `begin` first"),
            )
        })
    }

    fn close(&mut self, out: &mut Vec<Action>) {
        if let Some(open) = self.open.take()
            && !open.void
        {
            out.push(Action::End { id: open.id });
        }
    }
}

fn chars_beyond(text: &str, max: usize) -> bool {
    text.chars().nth(max).is_some()
}

/// serde's words without the column, which means nothing to who generated the line.
fn raw_reason(error: &serde_json::Error) -> String {
    let words = error.to_string();
    let words = words.split(" at line ").next().unwrap_or(&words);
    format!("this is no message: {}", raw::clip_to(words, 200))
}

#[cfg(test)]
mod tests;
