//! What every reader of another format fills: labels as they stand in the file, which become
//! [`Labels`] by one set of rules.
//!
//! - Times are cut at 0; a label without any time is left out; labels are sorted by their start.
//! - Phones that overlap: each begins when it says so, and the one before it is cut short.
//! - Words may overlap, as they do in TIMIT. Silences and signs without a letter are no words.
//! - A label that holds several words shares its time among them by their letters.
//! - Where only words have times, phones come from their pronunciation.
//!
//! Each departure from the file is a note, told once with its count.

use std::borrow::Cow;

use super::text::wrong;
use super::time::Time;
use crate::alphabet::{self, Alphabet};
use crate::error::{Fault, LabelError};
use crate::limits::LABELS_MAX;
use crate::note::{Note, Notes};
use crate::pronounce::spread;
use crate::reader::{ReadOptions, Source};
use crate::{Labels, Phone, Segment, Stress, Word};

/// What a label says.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Said<'a> {
    /// A symbol of some alphabet, or a word.
    Text(Cow<'a, str>),
    /// A phone that the format itself means.
    Phone(Phone),
}

/// One label of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece<'a> {
    pub(super) said: Said<'a>,
    pub(super) start: i64,
    pub(super) end: i64,
    pub(super) line: u64,
    /// Stress that the format says beside the symbol.
    pub(super) stress: Option<Stress>,
}

impl<'a> Piece<'a> {
    /// A label that says `text` from `start` to `end`.
    pub(super) fn new(
        text: impl Into<Cow<'a, str>>,
        start: Time,
        end: Time,
        line: u64,
    ) -> Result<Self, Fault> {
        Self::saying(Said::Text(text.into()), start, end, line)
    }

    /// The same for anything that can be said.
    pub(super) fn saying(said: Said<'a>, start: Time, end: Time, line: u64) -> Result<Self, Fault> {
        if end < start {
            return Err(Fault::Backwards {
                start: start.to_string(),
                end: end.to_string(),
            });
        }
        Ok(Self {
            said,
            start: start.ticks(),
            end: end.ticks(),
            line,
            stress: None,
        })
    }

    /// The symbol or word; nothing for a phone.
    pub(super) fn text(&self) -> &str {
        match &self.said {
            Said::Text(text) => text,
            Said::Phone(_) => "",
        }
    }
}

impl From<Segment> for Piece<'_> {
    /// A segment that has no line of its own.
    fn from(segment: Segment) -> Self {
        Self {
            said: Said::Phone(segment.phone),
            start: segment.start,
            end: segment.end,
            line: 1,
            stress: segment.stress,
        }
    }
}

/// The labels of a file while they are gathered.
#[derive(Debug)]
pub(super) struct Sheet<'a> {
    source: Source<'a>,
    phones: Vec<Piece<'a>>,
    words: Vec<Piece<'a>>,
    pub(super) notes: Notes,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(source: &Source<'a>) -> Self {
        Self {
            source: *source,
            phones: Vec::new(),
            words: Vec::new(),
            notes: Notes::default(),
        }
    }

    /// Adds a phone.
    pub(super) fn phone(&mut self, piece: Piece<'a>) -> Result<(), LabelError> {
        self.room(self.phones.len(), piece.line)?;
        self.phones.push(piece);
        Ok(())
    }

    /// Adds a word.
    pub(super) fn word(&mut self, piece: Piece<'a>) -> Result<(), LabelError> {
        self.room(self.words.len(), piece.line)?;
        self.words.push(piece);
        Ok(())
    }

    fn room(&self, count: usize, line: u64) -> Result<(), LabelError> {
        if count < LABELS_MAX {
            return Ok(());
        }
        let file = self.source.name.to_owned();
        Err(LabelError::TooMany { file, line })
    }

    /// The error for `fault` in `line` of the file.
    pub(super) fn wrong(&self, line: u64, fault: Fault) -> LabelError {
        wrong(&self.source, line, fault)
    }

    /// For formats that hold phones or words alike: what was added as phones is words, unless
    /// most of it are symbols.
    pub(super) fn phones_or_words(&mut self, options: &ReadOptions) {
        if !are_phones(self.phones.iter().map(Piece::text), options.alphabet) {
            self.words.append(&mut self.phones);
        }
    }

    /// The labels. `usual` is the alphabet of formats that have one; without it the symbols tell.
    pub(super) fn finish(
        mut self,
        options: &ReadOptions,
        usual: Option<Alphabet>,
        example: &'static str,
    ) -> Result<Labels, LabelError> {
        let mut words = std::mem::take(&mut self.words);
        words.retain(|w| !is_silence(w.text()));
        tidy(&mut words, Kind::Word, &mut self.notes);
        let words = self.split(&words)?;
        let mut phones = std::mem::take(&mut self.phones);
        tidy(&mut phones, Kind::Phone, &mut self.notes);
        let segments = if phones.is_empty() && !words.is_empty() {
            self.notes.push(Note::new(
                "only words have times here; their phones are those of a pronunciation dictionary, \
                 placed by how long each usually lasts",
            ));
            match &options.pronouncer {
                Some(pronouncer) => pronouncer.spread(&words),
                None => spread(&words),
            }
        } else {
            self.segments(&phones, options.alphabet.or(usual))
        };
        if segments.is_empty() && words.is_empty() {
            let file = self.source.name.to_owned();
            return Err(LabelError::Empty { file, example });
        }
        Ok(Labels {
            segments,
            words,
            notes: self.notes.finish(),
        })
    }

    fn segments(&mut self, phones: &[Piece<'a>], alphabet: Option<Alphabet>) -> Vec<Segment> {
        let alphabet =
            alphabet.unwrap_or_else(|| Alphabet::guess(phones.iter().map(|p| symbol(p.text()))));
        let mut out = Vec::with_capacity(phones.len());
        for piece in phones {
            let first = out.len();
            let (start, end) = (piece.start, piece.end);
            match &piece.said {
                Said::Phone(phone) => out.push(Segment {
                    stress: piece.stress,
                    ..Segment::new(*phone, start, end)
                }),
                Said::Text(text) => {
                    let spoken = alphabet::segments(alphabet, symbol(text), start, end, &mut out);
                    let line = Some(piece.line);
                    self.notes.symbol(alphabet, symbol(text), spoken, line);
                }
            }
            for segment in out.iter_mut().skip(first) {
                segment.stress = segment.stress.or(piece.stress);
            }
        }
        out
    }

    /// Words, one each, of labels that may hold several.
    fn split(&mut self, pieces: &[Piece<'a>]) -> Result<Vec<Word>, LabelError> {
        let mut words = Vec::with_capacity(pieces.len());
        let mut shared: Option<(u64, usize)> = None;
        for piece in pieces {
            let parts = piece.text().split_whitespace();
            let total: i64 = parts.clone().map(weight).sum();
            if parts.clone().nth(1).is_some() {
                shared = Some(shared.map_or((piece.line, 1), |(line, n)| (line, n + 1)));
            }
            let (mut before, mut at) = (0, piece.start);
            for part in parts {
                before += weight(part);
                let end = piece.start + (piece.end - piece.start) * before / total.max(1);
                if end > at && part.contains(char::is_alphanumeric) {
                    self.room(words.len(), piece.line)?;
                    let text = part.to_owned();
                    words.push(Word {
                        text,
                        start: at,
                        end,
                    });
                }
                at = end;
            }
        }
        words.sort_by_key(|w| w.start);
        if let Some((line, count)) = shared {
            let text =
                format!("labels of several words ({count}): the words share the time by letters");
            self.notes.push(Note::at(line, text));
        }
        Ok(words)
    }
}

/// A word's share of its label's time: its letters, and the space after it.
fn weight(word: &str) -> i64 {
    1 + word.chars().count() as i64
}

/// Longest text that can be a symbol; more of a label tells no alphabet anything.
const SYMBOL_BYTES_MAX: usize = 64;

/// A label's text as an alphabet should see it.
fn symbol(text: &str) -> &str {
    let text = text.trim();
    &text[..text.floor_char_boundary(SYMBOL_BYTES_MAX)]
}

/// Marks of silence and noise in tiers of words.
pub(super) fn is_silence(text: &str) -> bool {
    const MARKS: [&str; 14] = [
        "sil", "sp", "pau", "h#", "spn", "<sil>", "<eps>", "<p:>", "<unk>", "<s>", "</s>", "brth",
        "<nib>", "ssil",
    ];
    let text = text.trim();
    text.is_empty() || MARKS.iter().any(|mark| text.eq_ignore_ascii_case(mark))
}

/// Labels that tell whether they are phones.
const LOOKED_AT: usize = 300;

/// Whether most of the labels are symbols of phones, in `alphabet` or in any.
pub(super) fn are_phones<'t>(
    texts: impl Iterator<Item = &'t str>,
    alphabet: Option<Alphabet>,
) -> bool {
    let (mut all, mut symbols) = (0, 0);
    for text in texts.filter(|t| !is_silence(t)).take(LOOKED_AT) {
        all += 1;
        let known = match alphabet {
            Some(alphabet) => is_symbol(alphabet, text),
            None => Alphabet::ALL.into_iter().any(|a| is_symbol(a, text)),
        };
        symbols += usize::from(known);
    }
    2 * symbols > all || all == 0
}

/// Whether `text` is one symbol. In alphabets of single letters many a word could be a row of
/// them, which is none.
fn is_symbol(alphabet: Alphabet, text: &str) -> bool {
    let text = text.trim();
    if text.len() > SYMBOL_BYTES_MAX || text.contains(char::is_whitespace) {
        return false;
    }
    let spoken = alphabet.spoken(text);
    spoken.exact && (spoken.phones.len() == 1 || text.chars().count() == 1)
}

/// Phones follow one another, words may overlap.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Phone,
    Word,
}

/// Counts one kind of change and remembers where the first was.
#[derive(Default)]
struct Count {
    count: usize,
    line: u64,
}

impl Count {
    fn add(&mut self, line: u64) {
        if self.count == 0 {
            self.line = line;
        }
        self.count += 1;
    }

    fn tell(&self, kind: Kind, what: &str, notes: &mut Notes) {
        if self.count > 0 {
            let one = if kind == Kind::Phone { "phone" } else { "word" };
            let many = if self.count == 1 { "" } else { "s" };
            let text = format!("{} {one}{many} {what}", self.count);
            notes.push(Note::at(self.line, text));
        }
    }
}

/// Puts the pieces in order, by the rules above.
fn tidy(pieces: &mut Vec<Piece<'_>>, kind: Kind, notes: &mut Notes) {
    let mut early = Count::default();
    let mut unsorted = Count::default();
    let mut overlapping = Count::default();
    let mut empty = Count::default();
    let mut latest = i64::MIN;
    for piece in pieces.iter_mut() {
        if piece.start < 0 {
            early.add(piece.line);
            piece.start = 0;
            piece.end = piece.end.max(0);
        }
        if piece.start < latest {
            unsorted.add(piece.line);
        }
        latest = latest.max(piece.start);
    }
    pieces.sort_by_key(|p| p.start);
    if kind == Kind::Phone {
        let mut next_start = i64::MAX;
        for piece in pieces.iter_mut().rev() {
            // One without time takes none from the one before it.
            if piece.end <= piece.start {
                continue;
            }
            if piece.end > next_start {
                overlapping.add(piece.line);
                piece.end = next_start;
            }
            next_start = piece.start;
        }
    }
    pieces.retain(|piece| {
        let sounds = piece.end > piece.start;
        if !sounds {
            empty.add(piece.line);
        }
        sounds
    });
    early.tell(kind, "began before 0; cut there", notes);
    unsorted.tell(kind, "stood after a later one; sorted by start", notes);
    overlapping.tell(kind, "ended after the start of the next; cut short", notes);
    empty.tell(kind, "lasted no time; left out", notes);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(text: &str, start: i64, end: i64) -> Piece<'_> {
        Piece {
            said: Said::Text(text.into()),
            start,
            end,
            line: 1,
            stress: None,
        }
    }

    fn sheet() -> Sheet<'static> {
        Sheet::new(&Source {
            name: "x",
            bytes: b"",
        })
    }

    #[test]
    fn phones_are_put_in_order_and_each_change_is_told() {
        let mut sheet = sheet();
        for one in [
            piece("aa", -10, 100),
            piece("s", 300, 400),
            piece("b", 90, 310),
            piece("t", 400, 400),
        ] {
            sheet.phone(one).unwrap();
        }
        let labels = sheet.finish(&ReadOptions::default(), None, "").unwrap();
        let spans: Vec<(i64, i64)> = labels.segments.iter().map(|s| (s.start, s.end)).collect();
        assert_eq!(spans, [(0, 90), (90, 300), (300, 400)]);
        let said: Vec<&str> = labels.notes.iter().map(|n| n.text.as_str()).collect();
        assert_eq!(
            said,
            [
                "1 phone began before 0; cut there",
                "1 phone stood after a later one; sorted by start",
                "2 phones ended after the start of the next; cut short",
                "1 phone lasted no time; left out",
            ]
        );
    }

    #[test]
    fn a_label_of_several_words_is_shared_and_silence_is_no_word() {
        let mut sheet = sheet();
        sheet.word(piece("sil", 0, 100)).unwrap();
        sheet.word(piece("oh my word !", 100, 1300)).unwrap();
        let labels = sheet.finish(&ReadOptions::default(), None, "").unwrap();
        let words: Vec<(&str, i64, i64)> = labels
            .words
            .iter()
            .map(|w| (w.text.as_str(), w.start, w.end))
            .collect();
        assert_eq!(
            words,
            [("oh", 100, 376), ("my", 376, 653), ("word", 653, 1115)]
        );
        assert!(!labels.segments.is_empty());
        assert!(labels.notes.iter().any(|n| n.text.contains("by letters")));
        assert!(labels.notes.iter().any(|n| n.text.contains("dictionary")));
    }

    #[test]
    fn words_are_told_from_symbols() {
        let told = |text: &str| are_phones(text.split(' '), None);
        assert!(told("h# sh iy hv ae dcl"));
        assert!(told("HH AH0 L OW1 sil"));
        assert!(told("m ɑ n tʲ ɹ i ɒ ɫ"));
        assert!(!told(
            "She had your dark suit in greasy wash water all year"
        ));
        assert!(!told("this is the acoustic corpus"));
        assert!(!told("MARY ROLLED THE BARREL"));
    }
}
