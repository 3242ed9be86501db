//! One line of a TIMIT file: `start end label`, and the order of lines.

use crate::error::Fault;
use crate::tick::{SampleRate, TICKS_MAX};

/// A line's three fields, times both as written and in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Line<'a> {
    pub(super) span: Span,
    /// The rest of the line, without the space around it.
    pub(super) label: &'a str,
}

/// When a label sounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    first_sample: i64,
    end_sample: i64,
    pub(super) start: i64,
    pub(super) end: i64,
}

/// The line's fields; `None` for a blank line.
pub(super) fn parse<'a>(
    text: &'a str,
    rate: SampleRate,
    wanted: &'static str,
) -> Result<Option<Line<'a>>, Fault> {
    let (first, rest) = field(text);
    let (second, label) = field(rest);
    if first.is_empty() {
        return Ok(None);
    }
    if label.is_empty() {
        let found = 1 + usize::from(!second.is_empty());
        return Err(Fault::Missing { found, wanted });
    }
    let (first_sample, start) = time(first, rate)?;
    let (end_sample, end) = time(second, rate)?;
    // Beyond 48 kHz a label can be shorter than a tick: nobody speaks so fast, and later stages
    // divide by its length.
    if end_sample <= first_sample || end <= start {
        let (start, end) = (first_sample, end_sample);
        return Err(Fault::EndsEarly { start, end });
    }
    let span = Span {
        first_sample,
        end_sample,
        start,
        end,
    };
    Ok(Some(Line { span, label }))
}

/// The text up to the first white space, and the rest without the white space around it.
fn field(text: &str) -> (&str, &str) {
    let text = text.trim();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    let (first, rest) = text.split_at(end);
    (first, rest.trim_start())
}

/// A time as written and in ticks.
fn time(text: &str, rate: SampleRate) -> Result<(i64, i64), Fault> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return Err(Fault::NotWhole(text.to_owned()));
    }
    let too_late = || Fault::TooLate(text.to_owned());
    // All digits, so that only its size can keep it from being a number.
    let sample: i64 = text.parse().map_err(|_| too_late())?;
    if sample < 0 {
        return Err(Fault::Negative(sample));
    }
    let tick = rate.ticks(sample).filter(|t| *t <= TICKS_MAX);
    Ok((sample, tick.ok_or_else(too_late)?))
}

/// Remembers the last label, to tell whether the next one may follow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Order {
    last: Option<Span>,
}

impl Order {
    /// Accepts `span` if it starts no earlier than the last one ends (or, for words that may
    /// `overlap`, starts). One that is refused leaves no trace.
    pub(super) fn follow(&mut self, span: Span, overlap: bool) -> Result<(), Fault> {
        if let Some(last) = self.last {
            let start = span.first_sample;
            if start < last.first_sample {
                let previous = last.first_sample;
                return Err(Fault::Unsorted { start, previous });
            }
            if !overlap && start < last.end_sample {
                let previous = last.end_sample;
                return Err(Fault::Overlaps { start, previous });
            }
        }
        self.last = Some(span);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> Fault {
        parse(text, SampleRate::TIMIT, "start end phone").unwrap_err()
    }

    #[test]
    fn fields_may_be_parted_by_any_space() {
        let line = parse(" \t0\t 16000   a b \t", SampleRate::TIMIT, "").unwrap();
        let line = line.unwrap();
        assert_eq!((line.span.start, line.span.end), (0, 48_000));
        assert_eq!(line.label, "a b");
        assert_eq!(parse(" \t ", SampleRate::TIMIT, ""), Ok(None));
    }

    #[test]
    fn each_bad_number_has_its_own_fault() {
        assert_eq!(fault("0.0 0.5 aa"), Fault::NotWhole("0.0".into()));
        assert_eq!(fault("0 - aa"), Fault::NotWhole("-".into()));
        assert_eq!(fault("0 1e5 aa"), Fault::NotWhole("1e5".into()));
        assert_eq!(fault("-3 5 aa"), Fault::Negative(-3));
        let huge = "9".repeat(300);
        assert_eq!(fault(&format!("0 {huge} aa")), Fault::TooLate(huge));
        let day = 24 * 3600 * 16_000;
        assert!(parse(&format!("0 {day} aa"), SampleRate::TIMIT, "").is_ok());
        let late = (day + 1).to_string();
        assert_eq!(fault(&format!("0 {late} aa")), Fault::TooLate(late));
        assert_eq!(fault("7 7 aa"), Fault::EndsEarly { start: 7, end: 7 });
        assert_eq!(fault("8 7 aa"), Fault::EndsEarly { start: 8, end: 7 });
    }
}
