//! Cuts bytes that arrive in pieces of any size into lines, with a bound on how long a line may get.
//!
//! For files, pipes and sockets alike, so that all three see the same lines. Knows nothing of
//! what a line holds.

use crate::error::Fault;
use crate::limits::LINE_BYTES_MAX;

/// The piece of a line that has come so far. Holds at most [`LINE_BYTES_MAX`] bytes.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    partial: Vec<u8>,
    /// The line under way is too long and already reported: what is left of it is dropped.
    skipping: bool,
    /// Lines that have begun, so the number of the line under way.
    line: u64,
    /// Whether a line is under way.
    begun: bool,
}

impl Lines {
    /// Takes the next bytes and hands over each line that they complete, without its line break.
    pub(crate) fn push(
        &mut self,
        mut bytes: &[u8],
        mut each: impl FnMut(u64, Result<&str, Fault>),
    ) {
        while let Some(end) = bytes.iter().position(|b| *b == b'\n') {
            self.add(&bytes[..end], &mut each);
            self.complete(&mut each);
            bytes = &bytes[end + 1..];
        }
        if !bytes.is_empty() {
            self.add(bytes, &mut each);
        }
    }

    /// Hands over the last line, where it has no line break.
    pub(crate) fn finish(&mut self, mut each: impl FnMut(u64, Result<&str, Fault>)) {
        if self.begun {
            self.complete(&mut each);
        }
    }

    /// Whether bytes are waiting for their line break.
    pub(crate) fn is_within_line(&self) -> bool {
        self.begun
    }

    fn add(&mut self, bytes: &[u8], each: &mut impl FnMut(u64, Result<&str, Fault>)) {
        if !self.begun {
            self.begun = true;
            self.line += 1;
        }
        if self.skipping {
            return;
        }
        if self.partial.len() + bytes.len() > LINE_BYTES_MAX {
            self.skipping = true;
            self.partial.clear();
            each(self.line, Err(Fault::TooLong));
        } else {
            self.partial.extend_from_slice(bytes);
        }
    }

    fn complete(&mut self, each: &mut impl FnMut(u64, Result<&str, Fault>)) {
        if !self.skipping {
            each(self.line, text(&self.partial, self.line == 1));
        }
        self.partial.clear();
        self.skipping = false;
        self.begun = false;
    }
}

/// The line as text, without what editors add: a byte order mark, a carriage return.
fn text(bytes: &[u8], first: bool) -> Result<&str, Fault> {
    let line = std::str::from_utf8(bytes).map_err(|_| Fault::NotText)?;
    let line = line.strip_suffix('\r').unwrap_or(line);
    let bare = line.strip_prefix('\u{feff}').filter(|_| first);
    let line = bare.unwrap_or(line);
    // Blank is blank, whatever it is made of: line ends that were converted twice leave carriage returns.
    if line.trim_ascii().is_empty() {
        return Ok("");
    }
    if line.chars().any(|c| c.is_control() && c != '\t') {
        return Err(Fault::NotText);
    }
    Ok(line)
}
