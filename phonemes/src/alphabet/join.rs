//! Segments of labels: one label at a time, or a stream in which letters, stress, length and word
//! gaps each have a time of their own, as Piper's alignments have.

use super::{Alphabet, Spoken};
use crate::{Notes, Phone, Segment, Stress};

/// Adds the segments of one label from `start` to `end`, whose time its phones share, and says
/// what was made of the symbol. A label too short to share goes to its first phones; one without
/// any time adds nothing.
pub fn segments(
    alphabet: Alphabet,
    symbol: &str,
    start: i64,
    end: i64,
    out: &mut Vec<Segment>,
) -> Spoken {
    let spoken = alphabet.spoken(symbol);
    let ticks = end.saturating_sub(start).max(0);
    let count = spoken.phones.len() as i64;
    let mut at = start;
    for (done, phone) in (1..).zip(spoken.phones.iter()) {
        let until = start + ticks * done / count;
        if until > at {
            out.push(Segment {
                phone: *phone,
                start: at,
                end: until,
                stress: spoken.stress,
            });
            at = until;
        }
    }
    spoken
}

/// A symbol and when it sounds, in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timed<'a> {
    /// As the voice spells it; a blank is a gap between words.
    pub symbol: &'a str,
    /// First tick.
    pub start: i64,
    /// The tick after the last.
    pub end: i64,
}

/// A label made of one or more symbols.
#[derive(Debug)]
struct Label {
    text: String,
    start: i64,
    end: i64,
    stress: Option<Stress>,
    /// What follows belongs to another word or syllable.
    closed: bool,
}

/// Adds the segments of a stream of letters. Marks without a sound give their time away: stress to
/// the vowel's syllable that follows, length and diacritics to the sound before, a gap between words
/// half to each side (people do not fall silent there). Letters that are one phone (`a ɪ`, `t ʃ`)
/// become one segment.
pub fn join(alphabet: Alphabet, symbols: &[Timed<'_>], out: &mut Vec<Segment>, notes: &mut Notes) {
    let mut done: Option<Label> = None;
    // Time that waits for the next sound, and its stress.
    let mut waiting: Option<i64> = None;
    let mut stress = None;
    for timed in symbols {
        let gap = !timed.symbol.is_empty() && timed.symbol.trim().is_empty();
        if gap {
            let middle = timed.start + (timed.end - timed.start).max(0) / 2;
            if let Some(label) = &mut done {
                label.end = label.end.max(middle);
                label.closed = true;
            }
            waiting.get_or_insert(middle);
            continue;
        }
        let spoken = alphabet.spoken(timed.symbol);
        let mark = spoken.exact && *spoken.phones == [Phone::Epi];
        if mark && spoken.stress.is_some() {
            stress = spoken.stress;
            waiting.get_or_insert(timed.start);
            if let Some(label) = &mut done {
                label.closed = true;
            }
            continue;
        }
        if let Some(label) = &mut done
            && let Some(text) = longer(alphabet, label, timed.symbol, mark)
        {
            label.text = text;
            label.end = label.end.max(timed.end);
            continue;
        }
        let start = waiting.take().unwrap_or(timed.start);
        let next = Label {
            text: timed.symbol.to_owned(),
            start,
            end: timed.end,
            stress: spoken.stress.or(stress),
            closed: spoken.phones.iter().any(|p| p.is_silence()),
        };
        // A mark of stress stands before the syllable: it holds until its vowel.
        if spoken.phones.iter().any(|p| p.is_vowel() || p.is_silence()) {
            stress = None;
        }
        if let Some(label) = done.replace(next) {
            finish(alphabet, &label, out, notes);
        }
    }
    if let Some(label) = done {
        finish(alphabet, &label, out, notes);
    }
}

/// The label's text with `symbol` added, where the two are one phone or it is only a mark.
fn longer(alphabet: Alphabet, label: &Label, symbol: &str, mark: bool) -> Option<String> {
    let text = format!("{}{symbol}", label.text);
    if mark {
        return Some(text);
    }
    if label.closed || alphabet.spoken(symbol).phones[0].is_silence() {
        return None;
    }
    let spoken = alphabet.spoken(&text);
    let one = spoken.exact && spoken.phones.len() == 1;
    one.then_some(text)
}

fn finish(alphabet: Alphabet, label: &Label, out: &mut Vec<Segment>, notes: &mut Notes) {
    let start = out
        .last()
        .map_or(label.start, |last| label.start.max(last.end));
    let first = out.len();
    let spoken = segments(alphabet, &label.text, start, label.end, out);
    notes.symbol(alphabet, &label.text, spoken, None);
    for segment in out.iter_mut().skip(first) {
        segment.stress = label.stress.filter(|_| !segment.phone.is_silence());
    }
}
