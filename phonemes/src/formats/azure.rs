//! Viseme events of Azure's voices, saved as JSON: reader.
//!
//! A list of objects, alone or under any key, or one object a line: `audioOffset` (also
//! `audio_offset`, `offset`) in ticks of 100 ns, `visemeId` (`viseme_id`) from 0 to 21. Starts
//! only: a shape lasts until the next, the last 100 ms.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::sheet::Sheet;
use super::text::decode;
use super::time::Unit;
use super::visemes::Visemes;
use crate::error::LabelError;
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::{Labels, Phone};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Azure;

const EXAMPLE: &str = r#"[{"audioOffset": 500000, "visemeId": 0}]"#;

/// What each viseme of Azure's documentation stands for here; behind it, what it may be.
const PHONES: [Phone; 22] = [
    Phone::Pau, // silence
    Phone::Ah,  // æ ə ʌ
    Phone::Aa,  // ɑ
    Phone::Ao,  // ɔ
    Phone::Eh,  // ɛ ʊ
    Phone::Er,  // ɝ
    Phone::Iy,  // j i ɪ
    Phone::Uw,  // w u
    Phone::Ow,  // o
    Phone::Aw,  // aʊ
    Phone::Oy,  // ɔɪ
    Phone::Ay,  // aɪ
    Phone::Hh,  // h
    Phone::R,   // ɹ
    Phone::L,   // l
    Phone::S,   // s z
    Phone::Sh,  // ʃ tʃ dʒ ʒ
    Phone::Dh,  // ð
    Phone::F,   // f v
    Phone::N,   // d t n θ
    Phone::Ng,  // k g ŋ
    Phone::M,   // p b m
];

#[derive(Deserialize)]
struct Event<'a> {
    #[serde(
        borrow,
        alias = "audio_offset",
        alias = "AudioOffset",
        alias = "offset",
        alias = "Offset",
        rename = "audioOffset"
    )]
    offset: &'a RawValue,
    #[serde(borrow, alias = "viseme_id", alias = "VisemeId", rename = "visemeId")]
    id: &'a RawValue,
}

impl Reader for Azure {
    fn name(&self) -> &'static str {
        "azure"
    }

    fn about(&self) -> &'static str {
        "Azure's viseme events as JSON: `audioOffset` in 100 ns, `visemeId`"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        match Peek::at(source) {
            Some(keys) if keys.has_any(&["visemeId", "viseme_id", "VisemeId"]) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut document = Document::new(source, &text, EXAMPLE);
        let mut visemes = Visemes::new("Azure's 22 visemes");
        let values: Vec<&RawValue> = document.values().collect::<Result<_, _>>()?;
        for value in values {
            for raw in events(&mut document, value)? {
                let (line, event) = document.item::<Event<'_>>(raw)?;
                let start = time(event.offset, Unit::HundredNanoseconds);
                let start = start.map_err(|fault| document.wrong(line, fault))?;
                let id = event.id.get().trim_matches('"');
                let phone = id.parse::<usize>().ok().and_then(|id| PHONES.get(id));
                visemes.push(start, phone.copied(), id, line);
            }
        }
        let mut sheet = Sheet::new(source);
        visemes.finish(None, &mut sheet)?;
        sheet.finish(options, None, EXAMPLE)
    }
}

/// The events in a value: itself, its items, or those of the list in it.
fn events<'a>(
    document: &mut Document<'a>,
    value: &'a RawValue,
) -> Result<Vec<&'a RawValue>, LabelError> {
    if value.get().starts_with('[') {
        return Ok(document.item::<Vec<&RawValue>>(value)?.1);
    }
    let (_, fields) = document.item::<BTreeMap<Cow<'_, str>, &RawValue>>(value)?;
    let list = fields.values().find(|v| v.get().starts_with('['));
    match list {
        Some(list) if !fields.keys().any(|k| k.to_lowercase().ends_with("offset")) => {
            Ok(document.item::<Vec<&RawValue>>(list)?.1)
        }
        _ => Ok(vec![value]),
    }
}
