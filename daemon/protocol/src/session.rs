//! The state of one connection: which message is legal when, and what it means.
//!
//! | message | no utterance open | one open |
//! |---|---|---|
//! | `begin` | opens one | error `state`; ends it when it is a TIMIT stream's or was stopped |
//! | `phones`, `audio` | error `state` | taken; without a word ignored once it was stopped |
//! | `end` | error `state` | closes it |
//! | TIMIT line | opens one | taken by a TIMIT stream's, else error `state` |
//! | empty line | ignored | closes a TIMIT stream's |
//! | `caption` | shown at once | shown with it; ignored once it was stopped |
//! | `stop`, `express`, `look`, `state`, `hello`, `ping` | done | done |
//! | end of stream | | closes it |
//!
//! Where a token is wanted, everything but `hello` is error `auth` until `auth` brought it, and a wrong one
//! ends the connection. A message that is refused changes nothing. Utterances that are closed stay *pending* until the
//! daemon says that they ended; their ids and their number are kept here.

mod face;
mod open;

use mouthpiece_phonemes::{Alphabet, Segment};

use crate::lines::{Line, Lines};
use crate::message::{Begin, Caption, ClientMessage, Express, FaceState, Look};
use crate::{DaemonMessage, ErrorCode, Limits, Pcm, Token, VERSION, limits, raw};
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
    /// Show a face; its numbers are within bounds, its names unknown here.
    Express(Express),
    /// Look at a point in front of the face.
    Look(Look),
    /// What the face does while it says nothing.
    State(FaceState),
    /// Show a text.
    Caption {
        /// With this utterance; at once where there is none.
        id: Option<String>,
        /// From this tick of the utterance's sound on.
        start: i64,
        /// One line without control characters; empty clears the screen.
        text: String,
    },
    /// Close the connection, once all that was said before is sent.
    Close,
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
    /// Wanted before anything else.
    token: Option<Token>,
    /// Nothing counts any more.
    closing: bool,
    taken: u64,
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
            token: None,
            closing: false,
            taken: 0,
        }
    }

    /// The same, of a client that has to bring `token` first.
    #[must_use]
    pub fn guarded(limits: Limits, token: Token) -> Self {
        let mut session = Self::new(limits);
        session.lines = Lines::new(limits::STRANGER_LINE_BYTES_MAX);
        session.token = Some(token);
        session
    }

    /// Whether the client may say more than its token.
    #[must_use]
    pub fn is_trusted(&self) -> bool {
        self.token.is_none()
    }

    /// Lines and frames that were taken so far, right or wrong: what a rate is counted in.
    #[must_use]
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// Takes bytes as they came in, cut anywhere; what is to be done goes to `out`.
    pub fn receive(&mut self, mut bytes: &[u8], out: &mut Vec<Action>) {
        while !bytes.is_empty() {
            if let Some(line) = self.lines.next(&mut bytes) {
                self.take(&line, out);
            }
        }
    }

    /// Takes a text frame of a WebSocket: one or more whole lines, the last with or without its end.
    pub fn receive_text(&mut self, text: &str, out: &mut Vec<Action>) {
        self.receive(text.as_bytes(), out);
        if !text.ends_with('\n') {
            self.receive(b"\n", out);
        }
    }

    /// Takes a binary frame of a WebSocket: sound of the open utterance, as the bytes of `audio` are.
    pub fn receive_sound(&mut self, bytes: &[u8], out: &mut Vec<Action>) {
        if self.closing {
            return;
        }
        self.taken += 1;
        let done = match &self.token {
            Some(_) => Err(stranger()),
            None => self.sound(bytes, out),
        };
        self.answer(done, out);
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
        if self.closing {
            return;
        }
        self.taken += 1;
        let done = match line {
            Line::TooLong if self.token.is_some() => Err(stranger()),
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
        self.answer(done, out);
    }

    fn answer(&self, done: Result<(), Refusal>, out: &mut Vec<Action>) {
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
            return match self.token {
                Some(_) => Err(stranger()),
                None => self.raw_line(text, out),
            };
        }
        let message: ClientMessage =
            serde_json::from_str(text).map_err(|e| (ErrorCode::Malformed, raw_reason(&e)))?;
        self.message(message, out)
    }

    fn message(&mut self, message: ClientMessage, out: &mut Vec<Action>) -> Result<(), Refusal> {
        match message {
            ClientMessage::Hello { version, client } => self.hello(version, client.as_deref(), out),
            ClientMessage::Auth { token } => self.auth(&token, out),
            _ if self.token.is_some() => Err(stranger()),
            ClientMessage::Begin(begin) => self.begin(begin, out),
            ClientMessage::Phones { phones } => {
                let limits = self.limits.clone();
                let open = self.opened("phones")?;
                if open.void {
                    return Ok(());
                }
                let (segments, warnings) = open.labels(&phones, &limits)?;
                let id = open.id.clone();
                for message in warnings {
                    let id = Some(id.clone());
                    out.push(Action::Reply(DaemonMessage::Warning { id, message }));
                }
                if !segments.is_empty() {
                    out.push(Action::Segments { id, segments });
                }
                Ok(())
            }
            ClientMessage::Audio { data } => {
                let open = self.opened("audio")?;
                if open.void {
                    return Ok(());
                }
                let bytes = open::sound_bytes(&data)?;
                self.sound(&bytes, out)
            }
            ClientMessage::End {} => {
                self.opened("end")?;
                self.close(out);
                Ok(())
            }
            ClientMessage::Stop { id } => self.stop(id, out),
            ClientMessage::Express(express) => {
                out.push(face::express(express)?);
                Ok(())
            }
            ClientMessage::Look(look) => {
                out.push(face::look(look)?);
                Ok(())
            }
            ClientMessage::State { state } => {
                out.push(Action::State(state));
                Ok(())
            }
            ClientMessage::Caption(caption) => self.caption(&caption, out),
            ClientMessage::Ping { token } => {
                within(token.as_deref(), limits::TOKEN_CHARS_MAX, "a token")?;
                let version = VERSION;
                out.push(Action::Reply(DaemonMessage::Pong { token, version }));
                Ok(())
            }
        }
    }

    fn hello(
        &mut self,
        version: Option<u32>,
        client: Option<&str>,
        out: &mut Vec<Action>,
    ) -> Result<(), Refusal> {
        within(client, limits::NAME_CHARS_MAX, "a client's name")?;
        if let Some(version) = version.filter(|v| !(1..=VERSION).contains(v)) {
            return Err((
                ErrorCode::Version,
                format!("version {version} of this protocol is not known; speak 1 to {VERSION}"),
            ));
        }
        out.push(hello());
        Ok(())
    }

    fn auth(&mut self, guess: &str, out: &mut Vec<Action>) -> Result<(), Refusal> {
        if let Some(token) = &self.token {
            if !token.is(guess) {
                self.closing = true;
                self.answer(Err((ErrorCode::Auth, "the token is wrong".to_owned())), out);
                out.push(Action::Close);
                return Ok(());
            }
            self.token = None;
            self.lines.set_max(self.limits.line_bytes);
        }
        out.push(hello());
        Ok(())
    }

    /// Sound of the open utterance.
    fn sound(&mut self, bytes: &[u8], out: &mut Vec<Action>) -> Result<(), Refusal> {
        let limits = self.limits.clone();
        let open = self.opened("audio")?;
        if open.void {
            return Ok(());
        }
        let mono = open.audio(bytes, &limits)?;
        let id = open.id.clone();
        if !mono.is_empty() {
            out.push(Action::Audio { id, mono });
        }
        Ok(())
    }

    fn caption(&mut self, caption: &Caption, out: &mut Vec<Action>) -> Result<(), Refusal> {
        let (start, text) = face::caption(caption)?;
        let id = match &mut self.open {
            Some(open) if open.void => return Ok(()),
            Some(open) => {
                open.caption(start)?;
                Some(open.id.clone())
            }
            None => None,
        };
        out.push(Action::Caption { id, start, text });
        Ok(())
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
        let (start, end) = (segment.start, segment.end);
        let check = |open: &mut Open| open.check(segment.phone.code(), start, end, &self.limits);
        // Checked against a copy first: a refused line must not open an utterance.
        match &mut self.open {
            Some(open) if open.raw => {
                if open.void {
                    return Ok(());
                }
                check(open)?;
            }
            _ => {
                let mut open = Open::raw(self.raw_id());
                check(&mut open)?;
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

/// What everything but a greeting is answered with before the token has come.
fn stranger() -> Refusal {
    let message = "this daemon wants its token first: {\"type\":\"auth\",\"token\":\"…\"}";
    (ErrorCode::Auth, message.to_owned())
}

fn hello() -> Action {
    Action::Reply(DaemonMessage::Hello {
        version: VERSION,
        daemon: concat!("mouthpiece ", env!("CARGO_PKG_VERSION")).to_owned(),
        alphabets: Alphabet::ALL.map(|a| a.name().to_owned()).to_vec(),
    })
}

/// Whether a text is no longer than it may be.
fn within(text: Option<&str>, chars_max: usize, what: &str) -> Result<(), Refusal> {
    if text.is_some_and(|t| chars_beyond(t, chars_max)) {
        return Err((
            ErrorCode::Limit,
            format!("{what} has at most {chars_max} characters"),
        ));
    }
    Ok(())
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
