//! Events of libespeak-ng, printed one a line: reader.
//!
//! Fields that tabs part: kind, milliseconds, sample, value; kinds are espeak-ng's own (`PHONEME`,
//! `WORD`, `END`, `MARK`, …; numbers as `TYPE5`). Events say starts only: a phone lasts until the next
//! event of a phone or the end of a sentence. Milliseconds are rounded down, so the sample is taken
//! where its rate can be told from both.
//!
//! espeak-ng stamps /p t k/ and `tS` at the burst, and leaves the 39 to 49 ms of silence before it,
//! in which lips or tongue are closed, to the phone before. Here that silence, 44 ms, is the stop's
//! own closure.

use super::sheet::{Piece, Sheet};
use super::text::{decode, lines, peek, wrong};
use super::time::{Time, Unit};
use crate::alphabet::Alphabet;
use crate::closure::close_before_bursts;
use crate::error::{Fault, LabelError};
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::{Labels, Phone, Segment};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Espeak;

const EXAMPLE: &str = "PHONEME\t11\t264\th";
const WANTED: &str = "`PHONEME milliseconds sample symbol`";

/// Silence before the burst of a voiceless stop; between 39 and 49 ms were measured.
const CLOSURE: Time = Time::milliseconds(44);

/// How long the last phone is taken to last where no event ends it.
const LAST: Time = Time::milliseconds(100);

/// Rates of espeak-ng's and MBROLA's voices.
const RATES: [u32; 6] = [22_050, 16_000, 8_000, 11_025, 44_100, 48_000];

impl Reader for Espeak {
    fn name(&self) -> &'static str {
        "espeak-events"
    }

    fn about(&self) -> &'static str {
        "libespeak-ng's events: lines `PHONEME milliseconds sample symbol`"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let text = peek(source);
        let mut events = lines(&text).take(20).map(|(_, line)| Event::parse(line));
        match events.any(|event| matches!(event, Ok(Some(event)) if event.is_phone())) {
            true => Match::Surely,
            false => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let mut events = Vec::new();
        for (number, line) in lines(&text) {
            let event = Event::parse(line).map_err(|fault| wrong(source, number, fault))?;
            events.extend(event.map(|event| (number, event)));
        }
        let rate = rate(&events);
        let mut starts: Vec<(u64, Time, &str)> = Vec::with_capacity(events.len());
        let mut over = Time::ZERO;
        for (number, event) in &events {
            let at = event
                .at(rate)
                .map_err(|fault| wrong(source, *number, fault))?;
            over = over.max(at);
            if event.is_phone() {
                starts.push((*number, at, event.value));
            }
        }
        for (index, (number, at, symbol)) in starts.iter().enumerate() {
            let refuse = |fault| wrong(source, *number, fault);
            let end = match starts.get(index + 1) {
                Some((_, next, _)) => *next,
                None if over > *at || symbol.starts_with('_') => over,
                None => at.plus(LAST).map_err(refuse)?,
            };
            // A sentence's end is a pause that lasts no time.
            if end != *at || !symbol.starts_with('_') {
                let piece = Piece::new((*symbol).to_owned(), *at, end, *number);
                sheet.phone(piece.map_err(refuse)?)?;
            }
        }
        let mut labels = sheet.finish(options, Some(Alphabet::Espeak), EXAMPLE)?;
        labels.segments = close_before_bursts(&labels.segments, silence);
        Ok(labels)
    }
}

/// The silence that usually stands before a phone's burst.
fn silence(segment: &Segment) -> i64 {
    match segment.phone {
        Phone::P | Phone::T | Phone::K | Phone::Ch => CLOSURE.ticks(),
        _ => 0,
    }
}

/// One event.
struct Event<'a> {
    kind: &'a str,
    ms: Time,
    sample: i64,
    value: &'a str,
}

impl<'a> Event<'a> {
    /// `None` for kinds that say nothing of time.
    fn parse(line: &'a str) -> Result<Option<Self>, Fault> {
        let shape = || Fault::Shape {
            found: line.to_owned(),
            wanted: WANTED,
        };
        let mut fields = line.split('\t');
        let kind = fields.next().unwrap_or_default();
        if kind.is_empty()
            || !kind
                .bytes()
                .all(|b| b.is_ascii_uppercase() || b.is_ascii_digit())
        {
            return Err(shape());
        }
        let ms = fields.next().ok_or_else(shape)?;
        let ms = Time::parse(ms, Unit::Milliseconds)?;
        let sample = fields.next().ok_or_else(shape)?;
        let sample = sample.parse::<i64>().map_err(|_| shape())?;
        let value = fields.next().unwrap_or_default().trim();
        let event = Self {
            kind,
            ms,
            sample,
            value,
        };
        // Rates are told before the first sound, and a mark may lie anywhere in it.
        let timed = !matches!(kind, "SAMPLERATE" | "TYPE8" | "MARK" | "TYPE3");
        Ok(timed.then_some(event))
    }

    fn is_phone(&self) -> bool {
        matches!(self.kind, "PHONEME" | "TYPE7")
    }

    /// When it is, by its sample where the rate is known.
    fn at(&self, rate: Option<u32>) -> Result<Time, Fault> {
        let exact = rate.map(|rate| Time::of_samples(self.sample, rate));
        match exact {
            Some(None) => Err(Fault::Beyond(self.sample.to_string())),
            Some(Some(time)) => Ok(time),
            None => Ok(self.ms),
        }
    }
}

/// The rate at which samples and milliseconds of all events agree.
fn rate(events: &[(u64, Event<'_>)]) -> Option<u32> {
    let millisecond = Time::milliseconds(1);
    let agree = |rate: u32| {
        events.iter().all(|(_, event)| {
            let Some(exact) = Time::of_samples(event.sample, rate) else {
                return false;
            };
            // Rounded down by some versions, to the nearest by others.
            exact.minus(event.ms).max(event.ms.minus(exact)) <= millisecond
        })
    };
    RATES.into_iter().find(|rate| agree(*rate))
}
