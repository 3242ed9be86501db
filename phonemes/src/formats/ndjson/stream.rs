//! Our NDJSON as it arrives in pieces of any size, as pipes and sockets give it.
//!
//! As [`TimitStream`](crate::timit::TimitStream): a bad line is reported and left out, and the lines
//! after it are read as if it had not been there. What a file would sort or cut short, a stream
//! refuses, since what came before is spoken already. Words and all but labels are left out.

use super::object::{Object, Setting};
use crate::Segment;
use crate::alphabet::{self, Alphabet};
use crate::error::{Fault, LineError};
use crate::formats::time::seconds;
use crate::lines::Lines;

/// An incremental parser of our NDJSON. Memory stays below one line's limit.
#[derive(Debug)]
pub struct NdjsonStream {
    lines: Lines,
    state: State,
}

#[derive(Debug)]
struct State {
    /// What the user said of the alphabet, before any line does.
    asked: Option<Alphabet>,
    setting: Setting,
    last_end: i64,
    /// What one label gave, before it is handed over.
    given: Vec<Segment>,
}

impl NdjsonStream {
    /// A parser at the start of a stream. Without `alphabet`, and until a line names one, phones
    /// are TIMIT's.
    pub fn new(alphabet: Option<Alphabet>) -> Self {
        Self {
            lines: Lines::default(),
            state: State {
                asked: alphabet,
                setting: Setting::default(),
                last_end: 0,
                given: Vec::new(),
            },
        }
    }

    /// Takes the next bytes and hands over, in order, what each line that they complete gave.
    pub fn push(&mut self, bytes: &[u8], mut each: impl FnMut(Result<Segment, LineError>)) {
        let Self { lines, state } = self;
        lines.push(bytes, |line, text| state.line(line, text, &mut each));
    }

    /// The stream has ended: hands over the last line, where it has no line break.
    pub fn finish(&mut self, mut each: impl FnMut(Result<Segment, LineError>)) {
        let Self { lines, state } = self;
        lines.finish(|line, text| state.line(line, text, &mut each));
    }

    /// Whether part of a line has come that has no line break yet.
    pub fn is_within_line(&self) -> bool {
        self.lines.is_within_line()
    }

    /// A new utterance begins with the next line: its times may start over. Lines are counted on.
    pub fn restart(&mut self) {
        self.state.last_end = 0;
        self.state.setting = Setting::default();
    }
}

impl State {
    fn line(
        &mut self,
        line: u64,
        text: Result<&str, Fault>,
        each: &mut impl FnMut(Result<Segment, LineError>),
    ) {
        match text.and_then(|text| self.take(text)) {
            Ok(()) => self.given.drain(..).for_each(|segment| each(Ok(segment))),
            Err(fault) => each(Err(LineError { line, fault })),
        }
    }

    /// Reads one line, into `given`.
    fn take(&mut self, text: &str) -> Result<(), Fault> {
        if text.trim().is_empty() {
            return Ok(());
        }
        let object = Object::parse(text)?;
        self.setting.take(&object)?;
        let label = object.label(&self.setting)?;
        let Some(label) = label.filter(|label| !label.is_word) else {
            return Ok(());
        };
        if label.start < self.last_end || label.end == label.start {
            return Err(Fault::Backwards {
                start: seconds(self.last_end.max(label.start)).to_string(),
                end: seconds(label.start.min(label.end)).to_string(),
            });
        }
        let alphabet = self.asked.or(self.setting.alphabet);
        let alphabet = alphabet.unwrap_or(Alphabet::Timit);
        let (start, end) = (label.start, label.end);
        alphabet::segments(alphabet, &label.text, start, end, &mut self.given);
        for segment in &mut self.given {
            segment.stress = segment.stress.or(label.stress);
        }
        self.last_end = end;
        Ok(())
    }
}
