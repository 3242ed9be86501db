//! Reads TIMIT phone lines that arrive in pieces of any size, as pipes and sockets give them.
//!
//! A bad line is reported and left out; the lines after it are read as if it had not been there,
//! since a face that stops for one bad label is worse than one that misses a phone. Files are read
//! by the same code, so a stream and a file of the same bytes give the same segments.

use super::line::{Order, parse};
use crate::error::{Fault, LineError};
use crate::lines::Lines;
use crate::tick::SampleRate;
use crate::{Phone, Segment};

/// An incremental parser of `start end phone` lines. Memory stays below one line's limit.
#[derive(Debug)]
pub struct TimitStream {
    rate: SampleRate,
    lines: Lines,
    order: Order,
}

impl TimitStream {
    /// A parser at the start of a stream whose numbers count samples at `rate`.
    pub fn new(rate: SampleRate) -> Self {
        Self {
            rate,
            lines: Lines::default(),
            order: Order::default(),
        }
    }

    /// Takes the next bytes and hands over, in order, what each line that they complete gave.
    pub fn push(&mut self, bytes: &[u8], mut each: impl FnMut(Result<Segment, LineError>)) {
        let Self { rate, lines, order } = self;
        lines.push(bytes, |line, text| {
            if let Some(result) = segment(line, text, *rate, order) {
                each(result);
            }
        });
    }

    /// The stream has ended: hands over the last line, where it has no line break.
    pub fn finish(&mut self, mut each: impl FnMut(Result<Segment, LineError>)) {
        let Self { rate, lines, order } = self;
        lines.finish(|line, text| {
            if let Some(result) = segment(line, text, *rate, order) {
                each(result);
            }
        });
    }

    /// Whether part of a line has come that has no line break yet.
    pub fn is_within_line(&self) -> bool {
        self.lines.is_within_line()
    }

    /// A new utterance begins with the next line: its times may start over. Lines are counted on.
    pub fn restart(&mut self) {
        self.order = Order::default();
    }
}

/// What a line gives: nothing where it is blank.
fn segment(
    line: u64,
    text: Result<&str, Fault>,
    rate: SampleRate,
    order: &mut Order,
) -> Option<Result<Segment, LineError>> {
    let result = text.and_then(|text| phone(text, rate, order));
    result
        .map_err(|fault| LineError { line, fault })
        .transpose()
}

/// The segment that a line holds, if it may follow the ones before it.
pub(super) fn phone(
    text: &str,
    rate: SampleRate,
    order: &mut Order,
) -> Result<Option<Segment>, Fault> {
    let Some(line) = parse(text, rate, "start end phone")? else {
        return Ok(None);
    };
    if let Some((_, extra)) = line.label.split_once(char::is_whitespace) {
        return Err(Fault::Extra(extra.trim_start().to_owned()));
    }
    let phone = Phone::from_code(line.label);
    let phone = phone.ok_or_else(|| Fault::UnknownPhone(line.label.to_owned()))?;
    order.follow(line.span, false)?;
    Ok(Some(Segment::new(phone, line.span.start, line.span.end)))
}
