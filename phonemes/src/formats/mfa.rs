//! Tiers as JSON, as Montreal's aligner (`--output_format json`) and praatIO write them: reader.
//!
//! `tiers`, by name or as a list, each with `entries` `[start, end, label]` in seconds; otherwise as
//! in a TextGrid. The aligner writes words and phones one after the other without gaps, with
//! empty labels or `sil` for silence, and rounds to 10 ms frames.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::sheet::{Piece, Sheet};
use super::text::decode;
use super::tiers::{Tier, choose};
use super::time::Unit;
use crate::Labels;
use crate::error::LabelError;
use crate::limits::LABELS_MAX;
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct TiersJson;

const EXAMPLE: &str = r#"{"tiers": {"phones": {"entries": [[0, 0.1, "sil"]]}}}"#;

#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow)]
    tiers: &'a RawValue,
}

#[derive(Deserialize)]
struct Row<'a> {
    #[serde(borrow, default)]
    name: Cow<'a, str>,
    #[serde(borrow)]
    entries: Vec<&'a RawValue>,
}

impl Reader for TiersJson {
    fn name(&self) -> &'static str {
        "mfa-json"
    }

    fn about(&self) -> &'static str {
        "JSON of Montreal's aligner and praatIO: tiers of entries, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        match Peek::at(source) {
            Some(k) if k.opening == b'{' && k.has_all(&["tiers", "entries"]) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut document = Document::new(source, &text, EXAMPLE);
        let file = document.whole::<File<'_>>()?;
        let mut tiers = Vec::new();
        let mut labels = 0;
        for (name, raw) in rows(&mut document, file.tiers)? {
            let (line, row) = document.item::<Row<'_>>(raw)?;
            let name = name.unwrap_or_else(|| row.name.into_owned());
            let mut tier = Tier {
                name: name.into(),
                line,
                labels: Vec::new(),
            };
            for raw in row.entries {
                labels += 1;
                let line = document.line_of(raw);
                if labels > LABELS_MAX {
                    let file = source.name.to_owned();
                    return Err(LabelError::TooMany { file, line });
                }
                tier.labels.extend(entry(&mut document, raw)?);
            }
            tiers.push(tier);
        }
        let mut sheet = Sheet::new(source);
        choose(source, tiers, options, &mut sheet)?;
        sheet.finish(options, None, EXAMPLE)
    }
}

/// The tiers as they stand in the file, with their names where those stand before them.
fn rows<'a>(
    document: &mut Document<'a>,
    tiers: &'a RawValue,
) -> Result<Vec<(Option<String>, &'a RawValue)>, LabelError> {
    if tiers.get().starts_with('[') {
        let (_, list) = document.item::<Vec<&RawValue>>(tiers)?;
        return Ok(list.into_iter().map(|raw| (None, raw)).collect());
    }
    let (_, map) = document.item::<BTreeMap<String, &RawValue>>(tiers)?;
    let mut rows: Vec<_> = map.into_iter().map(|(n, raw)| (Some(n), raw)).collect();
    rows.sort_by_key(|(_, raw)| raw.get().as_ptr() as usize);
    Ok(rows)
}

/// A label; nothing for a point, `[time, label]`.
fn entry<'a, 'p>(
    document: &mut Document<'a>,
    raw: &'a RawValue,
) -> Result<Option<Piece<'p>>, LabelError> {
    let (line, fields) = document.item::<Vec<&RawValue>>(raw)?;
    let (start, end, label) = match fields[..] {
        [start, end, label] => (start, end, label),
        [_, _] => return Ok(None),
        _ => return Err(document.refused(line, "an entry without start, end and label")),
    };
    let (_, label) = document.item::<Cow<'_, str>>(label)?;
    let start = time(start, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
    let end = time(end, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
    let piece = Piece::new(label.into_owned(), start, end, line);
    piece.map(Some).map_err(|f| document.wrong(line, f))
}
