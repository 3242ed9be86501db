//! Files of several tiers, as Praat and Montreal's aligner write them: which tier holds phones and
//! which words.
//!
//! A tier that the user names, by its name or its number from 1, is read alone. Otherwise names
//! tell (`phones`, `phone`, `MAU` …, `words`, `word`, `ORT-MAU` …, also after a speaker's name and
//! a dash), then content: a tier most of whose labels are symbols holds phones. Of several tiers of
//! one kind, or of one name, the first is read and a note says so.

use std::borrow::Cow;

use super::sheet::{Piece, Sheet, are_phones};
use crate::error::LabelError;
use crate::note::Note;
use crate::reader::{ReadOptions, Source};

/// A row of labels.
#[derive(Debug)]
pub(super) struct Tier<'a> {
    pub(super) name: Cow<'a, str>,
    pub(super) line: u64,
    pub(super) labels: Vec<Piece<'a>>,
}

/// What phone tiers are called, in small letters.
const PHONES: [&str; 14] = [
    "phones",
    "phone",
    "phons",
    "phon",
    "phoneme",
    "phonemes",
    "phonetic",
    "segments",
    "segment",
    "segs",
    "seg",
    "mau",
    "allophones",
    "phn",
];

/// What word tiers are called.
const WORDS: [&str; 8] = [
    "words",
    "word",
    "ort-mau",
    "ort",
    "orthography",
    "wrd",
    "wort",
    "text",
];

impl Tier<'_> {
    /// Whether its name, or what follows a speaker's name in it, is one of `names`.
    fn is_called(&self, names: &[&str]) -> bool {
        let name = self.name.trim().to_lowercase();
        let last = name.rsplit(" - ").next().unwrap_or_default().trim();
        names.contains(&name.as_str()) || names.contains(&last)
    }

    fn holds_phones(&self, options: &ReadOptions) -> bool {
        let texts = self.labels.iter().map(Piece::text);
        match (self.is_called(&PHONES), self.is_called(&WORDS)) {
            (true, _) => true,
            (_, true) => false,
            _ => are_phones(texts, options.alphabet),
        }
    }
}

fn holds_any(tier: &Tier<'_>) -> bool {
    tier.labels.iter().any(|l| !l.text().trim().is_empty())
}

/// Moves the labels of the right tiers to `sheet`.
pub(super) fn choose<'a>(
    source: &Source<'_>,
    mut tiers: Vec<Tier<'a>>,
    options: &ReadOptions,
    sheet: &mut Sheet<'a>,
) -> Result<(), LabelError> {
    if let Some(asked) = &options.tier {
        let index = named(&tiers, asked, sheet).ok_or_else(|| LabelError::NoTier {
            file: source.name.to_owned(),
            tier: asked.clone(),
            known: known(&tiers),
        })?;
        let tier = tiers.swap_remove(index);
        return match tier.holds_phones(options) {
            true => move_to(sheet, tier, Sheet::phone),
            false => move_to(sheet, tier, Sheet::word),
        };
    }
    let phones = first(&tiers, "phones", sheet, |t| t.is_called(&PHONES));
    let words = first(&tiers, "words", sheet, |t| t.is_called(&WORDS));
    let (phones, words) = match (phones, words) {
        (None, None) => {
            // By content, the first that has any; an utterance a label is words too.
            let told = first(&tiers, "phones", sheet, |t| {
                holds_any(t) && t.holds_phones(options)
            });
            let words = match told {
                Some(_) => None,
                None => first(&tiers, "words", sheet, holds_any),
            };
            (told, words)
        }
        both => both,
    };
    // The later first, so that the other's place stays.
    let mut moves = [(phones, true), (words, false)];
    moves.sort_by_key(|(index, _)| std::cmp::Reverse(*index));
    for (index, are_phones) in moves {
        let Some(index) = index.filter(|i| *i < tiers.len()) else {
            continue;
        };
        let tier = tiers.swap_remove(index);
        match are_phones {
            true => move_to(sheet, tier, Sheet::phone)?,
            false => move_to(sheet, tier, Sheet::word)?,
        }
    }
    Ok(())
}

fn move_to<'a>(
    sheet: &mut Sheet<'a>,
    tier: Tier<'a>,
    add: impl Fn(&mut Sheet<'a>, Piece<'a>) -> Result<(), LabelError>,
) -> Result<(), LabelError> {
    tier.labels
        .into_iter()
        .try_for_each(|piece| add(sheet, piece))
}

/// The first tier that `is` says, with a note where there are more.
fn first(
    tiers: &[Tier<'_>],
    kind: &str,
    sheet: &mut Sheet<'_>,
    is: impl Fn(&Tier<'_>) -> bool,
) -> Option<usize> {
    let mut found = (0..).zip(tiers).filter(|(_, t)| is(t));
    let (index, tier) = found.next()?;
    let more = found.count();
    if more > 0 {
        let text = format!(
            "{} tiers hold {kind}; the first, number {}, is read; choose another with --label-tier",
            more + 1,
            index + 1,
        );
        sheet.notes.push(Note::at(tier.line, text));
    }
    Some(index)
}

/// The tier that the user asked for: by its exact name, by its name in any case, by its number.
fn named(tiers: &[Tier<'_>], asked: &str, sheet: &mut Sheet<'_>) -> Option<usize> {
    let exact: Vec<usize> = places(tiers, |name| name == asked);
    let same = match exact.is_empty() {
        true => places(tiers, |name| name.to_lowercase() == asked.to_lowercase()),
        false => exact,
    };
    if let Some(index) = same.first() {
        if same.len() > 1 {
            let numbers: Vec<String> = same.iter().map(|i| (i + 1).to_string()).collect();
            let text = format!(
                "{} tiers have this name; the first is read; the others have the numbers {}",
                same.len(),
                numbers[1..].join(", "),
            );
            sheet.notes.push(Note::at(tiers[*index].line, text));
        }
        return Some(*index);
    }
    let number = asked.parse::<usize>().ok()?;
    number.checked_sub(1).filter(|index| *index < tiers.len())
}

fn places(tiers: &[Tier<'_>], is: impl Fn(&str) -> bool) -> Vec<usize> {
    let all = (0..).zip(tiers);
    all.filter(|(_, t)| is(&t.name)).map(|(i, _)| i).collect()
}

/// Names that a message lists; more would be a table.
const LISTED: usize = 6;

fn known(tiers: &[Tier<'_>]) -> String {
    let names = tiers.iter().take(LISTED);
    let names: Vec<String> = names
        .map(|tier| format!("`{}`", crate::error::clip(&tier.name)))
        .collect();
    match tiers.len() {
        0 => "another file: this one has none".to_owned(),
        all if all > LISTED => format!("{} … or a number up to {all}", names.join(", ")),
        _ => names.join(", "),
    }
}
