//! HTK and HTS label files, `.lab`: reader.
//!
//! A line a label: `start end name`, in units of 100 ns, the end exclusive. The name is a phone, a
//! word, or HTS's full context, `p^p-PHONE+p=p…`, whose field `/B:` says whether the syllable is
//! stressed. Names that end in `[2]` … are states of a model: one phone lasts from its first
//! state to its last. What follows the name (scores, auxiliary names) is left out. Labels may end
//! some 20 ms before their sound does.

use super::sheet::{Piece, Sheet};
use super::text::{decode, lines, peek, wrong};
use super::time::{Time, Unit};
use crate::error::{Fault, LabelError};
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::{Labels, Stress};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Hts;

const EXAMPLE: &str = "0 2200000 pau";
const WANTED: &str = "`start end name`";

/// Labels that tell the unit.
const LINES_LOOKED_AT: usize = 50;

/// Half of a file's labels are longer than this, where they count 100 ns: 25 ms. Counted in samples of
/// the fastest sound, no phone is.
const LENGTH_USUAL: i64 = 250_000;

impl Reader for Hts {
    fn name(&self) -> &'static str {
        "hts"
    }

    fn about(&self) -> &'static str {
        "HTK and HTS .lab, full context or not: lines `start end name`, in 100 ns"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let text = peek(source);
        let labels = lines(&text).take(LINES_LOOKED_AT);
        let labels: Vec<Line<'_>> = labels
            .map_while(|(_, line)| Line::parse(line).ok())
            .collect();
        if labels.is_empty() || lines(&text).next().is_some_and(|(n, _)| n > 1) {
            return Match::No;
        }
        if labels.iter().any(|l| l.context.is_some()) {
            return Match::Surely;
        }
        match (source.has_extension("lab"), counts_100ns(source)) {
            (true, true) => Match::Surely,
            (false, true) => Match::Likely,
            (_, false) => Match::Perhaps,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let mut open: Option<(Line<'_>, u64)> = None;
        for (number, text) in lines(&text) {
            let line = Line::parse(text).map_err(|fault| wrong(source, number, fault))?;
            match &mut open {
                Some((last, _)) if line.goes_on(last) => {
                    last.end = last.end.max(line.end);
                    last.state = line.state;
                }
                _ => {
                    if let Some((done, at)) = open.replace((line, number)) {
                        add(&mut sheet, &done, at)?;
                    }
                }
            }
        }
        if let Some((done, at)) = open {
            add(&mut sheet, &done, at)?;
        }
        sheet.phones_or_words(options);
        sheet.finish(options, None, EXAMPLE)
    }
}

/// Whether lines of two whole numbers and a name count 100 ns rather than samples.
pub(crate) fn counts_100ns(source: &Source<'_>) -> bool {
    let text = peek(source);
    let numbers = lines(&text).take(LINES_LOOKED_AT).map_while(|(_, line)| {
        let mut fields = line.split_whitespace();
        let start = fields.next()?.parse::<i64>().ok()?;
        let end = fields.next()?.parse::<i64>().ok()?;
        Some(end.saturating_sub(start))
    });
    let mut lengths: Vec<i64> = numbers.collect();
    lengths.sort_unstable();
    let median = lengths.get(lengths.len() / 2);
    median.is_some_and(|median| *median >= LENGTH_USUAL)
}

fn add<'a>(sheet: &mut Sheet<'a>, line: &Line<'_>, number: u64) -> Result<(), LabelError> {
    let piece = Piece::new(line.phone.to_owned(), line.start, line.end, number);
    let mut piece = piece.map_err(|fault| sheet.wrong(number, fault))?;
    piece.stress = line.stress();
    sheet.phone(piece)
}

/// A line, taken apart.
struct Line<'a> {
    start: Time,
    end: Time,
    phone: &'a str,
    /// What stands around the phone.
    context: Option<&'a str>,
    /// Which state of the phone's model.
    state: Option<u8>,
}

impl<'a> Line<'a> {
    fn parse(line: &'a str) -> Result<Self, Fault> {
        let mut fields = line.split_whitespace();
        let (Some(start), Some(end)) = (fields.next(), fields.next()) else {
            return Err(Fault::Shape {
                found: line.to_owned(),
                wanted: WANTED,
            });
        };
        let start = Time::parse(start, Unit::HundredNanoseconds)?;
        let end = Time::parse(end, Unit::HundredNanoseconds)?;
        let name = fields.next().ok_or_else(|| Fault::Shape {
            found: line.to_owned(),
            wanted: WANTED,
        })?;
        let (name, state) = state(name);
        let (phone, context) = match centre(name) {
            Some(phone) => (phone, Some(name)),
            None => (name, None),
        };
        Ok(Self {
            start,
            end,
            phone,
            context,
            state,
        })
    }

    /// Whether this is the next state of the phone that `last` is a state of.
    fn goes_on(&self, last: &Self) -> bool {
        let rises = matches!((last.state, self.state), (Some(a), Some(b)) if b > a);
        rises && (self.phone, self.context) == (last.phone, last.context)
    }

    /// Whether the phone's syllable is stressed, from the first number of `/B:`.
    fn stress(&self) -> Option<Stress> {
        let (_, rest) = self.context?.split_once("/B:")?;
        match rest.split(['-', '@']).next()? {
            "0" => Some(Stress::Unstressed),
            "1" => Some(Stress::Primary),
            _ => None,
        }
    }
}

/// The phone of a full context: between the first `-` after a `^` and the next `+`.
fn centre(name: &str) -> Option<&str> {
    let (_, after) = name.split_once('^')?;
    let (_, after) = after.split_once('-')?;
    let (phone, after) = after.split_once('+')?;
    (!phone.is_empty() && after.contains('=')).then_some(phone)
}

/// A name without the number of its state.
fn state(name: &str) -> (&str, Option<u8>) {
    let parts = name.strip_suffix(']').and_then(|n| n.rsplit_once('['));
    match parts.map(|(bare, state)| (bare, state.parse::<u8>())) {
        Some((bare, Ok(state))) if !bare.is_empty() => (bare, Some(state)),
        _ => (name, None),
    }
}
