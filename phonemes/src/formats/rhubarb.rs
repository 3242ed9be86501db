//! Mouth shapes of Rhubarb Lip Sync, as JSON or as TSV: reader.
//!
//! JSON: `mouthCues`, each with `start` and `end` in seconds and the letter of a shape. TSV: lines
//! `start⇥shape`, starts only; a shape lasts until the next, and the last line, a closed
//! mouth, marks the end. Nine shapes, `A` to `H` and `X`, in steps of 10 ms: what comes out is a
//! cartoon's mouth, and neither stops nor sounds of the tongue can be told.

use std::borrow::Cow;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::sheet::Sheet;
use super::text::{decode, lines, peek, wrong};
use super::time::{Time, Unit};
use super::visemes::Visemes;
use crate::error::{Fault, LabelError};
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::{Labels, Phone};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Rhubarb;

const EXAMPLE: &str = r#"{"mouthCues": [{"start": 0, "end": 0.1, "value": "X"}]}"#;
const WANTED: &str = "`start⇥shape`";
const SET: &str = "Rhubarb's nine shapes";

#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow, rename = "mouthCues")]
    cues: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
struct Cue<'a> {
    #[serde(borrow)]
    start: &'a RawValue,
    #[serde(borrow)]
    end: &'a RawValue,
    #[serde(borrow)]
    value: Cow<'a, str>,
}

impl Reader for Rhubarb {
    fn name(&self) -> &'static str {
        "rhubarb"
    }

    fn about(&self) -> &'static str {
        "Rhubarb Lip Sync's mouth shapes, JSON or TSV, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        if let Some(keys) = Peek::at(source) {
            return match keys.has("mouthCues") {
                true => Match::Surely,
                false => Match::No,
            };
        }
        let text = peek(source);
        let mut cues = lines(&text).take(3).map(|(_, line)| cue(line));
        match cues.next() {
            Some(Ok((_, shape))) if phone(shape).is_some() && cues.all(|c| c.is_ok()) => {
                Match::Surely
            }
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let mut visemes = Visemes::new(SET);
        let mut end = None;
        if text.trim_start().starts_with('{') {
            let mut document = Document::new(source, &text, EXAMPLE);
            for raw in document.whole::<File<'_>>()?.cues {
                let (line, cue) = document.item::<Cue<'_>>(raw)?;
                let start = time(cue.start, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
                let stop = time(cue.end, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
                visemes.push(start, phone(&cue.value), &cue.value, line);
                end = end.max(Some(stop));
            }
        } else {
            for (number, line) in lines(&text) {
                let (start, shape) = cue(line).map_err(|fault| wrong(source, number, fault))?;
                visemes.push(start, phone(shape), shape, number);
            }
        }
        visemes.finish(end, &mut sheet)?;
        sheet.finish(options, None, EXAMPLE)
    }
}

/// A line of a TSV.
fn cue(line: &str) -> Result<(Time, &str), Fault> {
    let (start, shape) = line.split_once('\t').ok_or_else(|| Fault::Shape {
        found: line.to_owned(),
        wanted: WANTED,
    })?;
    Ok((Time::parse(start, Unit::Seconds)?, shape.trim()))
}

/// The phone that looks like a shape.
fn phone(shape: &str) -> Option<Phone> {
    Some(match shape {
        "A" => Phone::M,   // lips together: p b m
        "B" => Phone::S,   // teeth together: most consonants, iy
        "C" => Phone::Eh,  // open: eh, ae
        "D" => Phone::Aa,  // wide open
        "E" => Phone::Ao,  // somewhat rounded: ao, er
        "F" => Phone::Uw,  // puckered: uw, ow, w
        "G" => Phone::F,   // lip to teeth: f v
        "H" => Phone::L,   // tongue up: a long l
        "X" => Phone::Pau, // rest
        _ => return None,
    })
}
