//! Praat's TextGrid: reader of both text forms, writer of the long one.
//!
//! Times are decimal seconds; an interval lasts from its own start to its own end, exclusive. An
//! interval without text in a tier of phones is silence, in a tier of words nothing. `-0` is 0.
//! Intervals may leave gaps or overlap (other programs write such); [`Sheet`] says what becomes of
//! that. Points are left out: they last no time. UTF-8 and UTF-16, all line ends, doubled
//! quotation marks, labels of several lines. The binary form is not read: Praat saves it as text.

mod token;
mod write;

use super::sheet::{Piece, Sheet};
use super::text::{decode, peek, wrong};
use super::tiers::{Tier, choose};
use super::time::{Time, Unit};
use crate::Labels;
use crate::error::{Fault, LabelError};
use crate::limits::LABELS_MAX;
use crate::reader::{Match, ReadOptions, Reader, Source};
use token::{Kind, Tokens};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct TextGrid;

const EXAMPLE: &str = "an interval with the text \"pau\"";

impl Reader for TextGrid {
    fn name(&self) -> &'static str {
        "textgrid"
    }

    fn about(&self) -> &'static str {
        "Praat's TextGrid, long or short: tiers of intervals, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let text = peek(source);
        let head = text
            .get(..text.floor_char_boundary(200))
            .unwrap_or_default();
        let says_so = head.contains("ooTextFile") && head.contains("TextGrid");
        match says_so || source.has_extension("textgrid") {
            true => Match::Surely,
            false => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        if source.bytes.starts_with(b"ooBinaryFile") {
            let wanted = "text (Praat: Save as text file)";
            let found = "ooBinaryFile".to_owned();
            return Err(wrong(source, 1, Fault::Shape { found, wanted }));
        }
        let text = decode(source)?;
        let mut tokens = Tokens::new(&text);
        let tiers = tiers(&mut tokens);
        let tiers = tiers.map_err(|bad| match bad {
            Bad::Fault(fault) => wrong(source, tokens.at_line(), fault),
            Bad::TooMany => LabelError::TooMany {
                file: source.name.to_owned(),
                line: tokens.at_line(),
            },
        })?;
        let mut sheet = Sheet::new(source);
        choose(source, tiers, options, &mut sheet)?;
        sheet.finish(options, None, EXAMPLE)
    }
}

/// What is wrong at the token under way.
enum Bad {
    Fault(Fault),
    TooMany,
}

impl From<Fault> for Bad {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

/// All tiers of intervals.
fn tiers<'a>(tokens: &mut Tokens<'_>) -> Result<Vec<Tier<'a>>, Bad> {
    // Some programs leave out one of the two, so what they say is not held against the file.
    let mut head = 0;
    while tokens.peek_is_text() && head < 2 {
        tokens.text("the file's type")?;
        head += 1;
    }
    tokens.number("the start of the grid")?;
    tokens.number("the end of the grid")?;
    if !tokens.flag()? {
        return Ok(Vec::new());
    }
    let count = tokens.count("the number of tiers")?;
    let mut tiers = Vec::new();
    let mut labels = 0;
    for _ in 0..count {
        let class = tokens.text("\"IntervalTier\" or \"TextTier\"")?;
        let is_interval = match &*class {
            "IntervalTier" => true,
            "TextTier" => false,
            _ => {
                let wanted = "\"IntervalTier\" or \"TextTier\"";
                let found = class.into_owned();
                return Err(Fault::Shape { found, wanted }.into());
            }
        };
        let name = tokens.text("the name of a tier")?.into_owned();
        let mut tier = Tier {
            name: name.into(),
            line: tokens.at_line(),
            labels: Vec::new(),
        };
        tokens.number("the start of a tier")?;
        tokens.number("the end of a tier")?;
        for _ in 0..tokens.count("the number of intervals")? {
            labels += 1;
            if labels > LABELS_MAX {
                return Err(Bad::TooMany);
            }
            let start = time(tokens, "the start of an interval")?;
            if !is_interval {
                tokens.text("the text of a point")?;
                continue;
            }
            let end = time(tokens, "the end of an interval")?;
            let line = tokens.at_line();
            let text = tokens.text("the text of an interval")?.into_owned();
            tier.labels.push(Piece::new(text, start, end, line)?);
        }
        if is_interval {
            tiers.push(tier);
        }
    }
    Ok(tiers)
}

fn time(tokens: &mut Tokens<'_>, what: &'static str) -> Result<Time, Bad> {
    Ok(Time::parse(tokens.number(what)?, Unit::Seconds)?)
}

/// The token that stands where `wanted` should.
fn shape(found: &Kind<'_>, wanted: &'static str) -> Fault {
    let found = match found {
        Kind::Text(text) => format!("\"{text}\""),
        Kind::Number(number) => (*number).to_owned(),
        Kind::Flag(flag) => format!("<{flag}>"),
    };
    Fault::Shape { found, wanted }
}
