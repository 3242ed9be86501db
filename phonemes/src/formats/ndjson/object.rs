//! One object of our NDJSON: what it says, and how the lines after it are written.

use std::borrow::Cow;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::EXAMPLE;
use crate::Stress;
use crate::alphabet::Alphabet;
use crate::error::{Fault, clip};
use crate::formats::json::time;
use crate::formats::time::Unit;
use crate::tick::{SampleRate, TICKS_MAX};

/// A line.
#[derive(Debug, Deserialize)]
pub(super) struct Object<'a> {
    #[serde(borrow, default)]
    start: Option<&'a RawValue>,
    #[serde(borrow, default)]
    end: Option<&'a RawValue>,
    #[serde(borrow, default)]
    phone: Option<Cow<'a, str>>,
    #[serde(borrow, default)]
    word: Option<Cow<'a, str>>,
    #[serde(default)]
    stress: Option<u8>,
    #[serde(borrow, default)]
    alphabet: Option<Cow<'a, str>>,
    #[serde(default)]
    label_rate: Option<u32>,
    /// The labels of a message of the wire.
    #[serde(borrow, default)]
    pub(super) phones: Option<Vec<&'a RawValue>>,
}

/// How lines are written.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Setting {
    pub(super) alphabet: Option<Alphabet>,
    /// What times count; seconds without it.
    rate: Option<SampleRate>,
}

/// What a line says. Times are ticks.
#[derive(Debug)]
pub(super) struct Label<'a> {
    pub(super) text: Cow<'a, str>,
    pub(super) is_word: bool,
    pub(super) start: i64,
    pub(super) end: i64,
    pub(super) stress: Option<Stress>,
}

impl Setting {
    /// Takes over what `object` says of the lines after it.
    pub(super) fn take(&mut self, object: &Object<'_>) -> Result<(), Fault> {
        if let Some(name) = &object.alphabet {
            let alphabet = name.parse::<Alphabet>();
            self.alphabet = Some(alphabet.map_err(|_| json("no known alphabet"))?);
        }
        if let Some(hz) = object.label_rate {
            let rate = SampleRate::new(hz);
            self.rate = Some(rate.map_err(|_| json("no sample rate"))?);
        }
        Ok(())
    }
}

impl<'a> Object<'a> {
    pub(super) fn parse(line: &'a str) -> Result<Self, Fault> {
        serde_json::from_str(line).map_err(|error| {
            let said = error.to_string();
            json(&clip(said.split(" at line ").next().unwrap_or_default()))
        })
    }

    /// The label in it; none where it has neither phone nor word.
    pub(super) fn label(self, setting: &Setting) -> Result<Option<Label<'a>>, Fault> {
        let (text, is_word) = match (self.phone, self.word) {
            (Some(phone), _) => (phone, false),
            (None, Some(word)) => (word, true),
            (None, None) => return Ok(None),
        };
        let (Some(start), Some(end)) = (self.start, self.end) else {
            return Err(json("start or end is missing"));
        };
        let (from, to) = (ticks(start, setting)?, ticks(end, setting)?);
        if to < from {
            let (start, end) = (start.get().to_owned(), end.get().to_owned());
            return Err(Fault::Backwards { start, end });
        }
        let stress = match self.stress {
            None => None,
            Some(0) => Some(Stress::Unstressed),
            Some(1) => Some(Stress::Primary),
            Some(2) => Some(Stress::Secondary),
            Some(_) => return Err(json("stress is 0, 1 or 2")),
        };
        Ok(Some(Label {
            text,
            is_word,
            start: from,
            end: to,
            stress,
        }))
    }
}

fn ticks(raw: &RawValue, setting: &Setting) -> Result<i64, Fault> {
    let Some(rate) = setting.rate else {
        return Ok(time(raw, Unit::Seconds)?.ticks());
    };
    let sample = raw.get().parse::<i64>();
    let sample = sample.map_err(|_| Fault::NotWhole(raw.get().to_owned()))?;
    let ticks = rate.ticks(sample).filter(|t| t.abs() <= TICKS_MAX);
    ticks.ok_or_else(|| Fault::Beyond(sample.to_string()))
}

fn json(reason: &str) -> Fault {
    Fault::Json {
        reason: reason.to_owned(),
        wanted: EXAMPLE,
    }
}
