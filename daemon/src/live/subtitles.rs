//! Cuts a text that is spoken into captions, each with the tick from which on it is heard: what `say --text` shows.
//!
//! Engines say when phones are heard, not words. So a letter is taken to last as long as any other, silences apart,
//! and a caption that begins after a mark of punctuation begins where the nearest pause ends.

use mouthpiece_phonemes::Segment;
use mouthpiece_rig::TICK_RATE;

/// Most letters on the screen at once: two lines, as subtitles have them.
const CHARS_MAX: usize = 84;
/// The end of a sentence, and any other mark of punctuation, ends a caption that has so many letters already: nobody
/// reads faster, and "Dr." ends no sentence.
const SENTENCE_CHARS_MIN: usize = 12;
const CHARS_MIN: usize = 28;
/// A pause so near belongs to the punctuation.
const NEAR_TICKS: i64 = TICK_RATE * 7 / 10;

/// The captions of `text`, in order, spoken as `segments` say.
pub fn subtitles(text: &str, segments: &[Segment]) -> Vec<(i64, String)> {
    let texts = cut(text);
    let letters: usize = texts.iter().map(|t| weight(t)).sum();
    let spoken: i64 = sounding(segments).map(|s| s.end - s.start).sum();
    let mut before = 0;
    let mut captions: Vec<(i64, String)> = Vec::with_capacity(texts.len());
    for text in texts {
        let share = before as f64 / letters.max(1) as f64;
        before += weight(&text);
        let at = match captions.last() {
            None => 0,
            Some((last, words)) => {
                let guess = nth_tick(segments, (share * spoken as f64) as i64);
                let at = if words.ends_with(is_mark) {
                    after_pause(segments, guess)
                } else {
                    guess
                };
                at.max(*last)
            }
        };
        captions.push((at, text));
    }
    captions
}

/// Pieces of whole words that fit the screen, cut after punctuation where that leaves them not too short.
fn cut(text: &str) -> Vec<String> {
    let blank = |c: char| c.is_whitespace() || c.is_control();
    let length = |piece: &str| piece.chars().count();
    let (mut pieces, mut piece) = (Vec::new(), String::new());
    for word in text.split(blank).filter(|word| !word.is_empty()) {
        let word: Vec<char> = word.chars().collect();
        // A longer one is nobody's word: no line would hold it.
        for part in word.chunks(CHARS_MAX) {
            if !piece.is_empty() {
                if length(&piece) + 1 + part.len() > CHARS_MAX {
                    pieces.push(std::mem::take(&mut piece));
                } else {
                    piece.push(' ');
                }
            }
            piece.extend(part);
        }
        let least = if piece.ends_with(is_stop) {
            SENTENCE_CHARS_MIN
        } else {
            CHARS_MIN
        };
        if length(&piece) >= least && piece.ends_with(is_mark) {
            pieces.push(std::mem::take(&mut piece));
        }
    }
    pieces.extend((!piece.is_empty()).then_some(piece));
    pieces
}

/// What stands between sentences.
fn is_stop(c: char) -> bool {
    matches!(c, '.' | '!' | '?' | '…' | ';' | ':' | '·')
}

/// What a pause goes with.
fn is_mark(c: char) -> bool {
    is_stop(c) || matches!(c, ',' | '–' | '—' | '"' | '”' | '’' | '»' | ')')
}

/// For how much of the sound a text stands.
fn weight(text: &str) -> usize {
    text.chars().filter(|c| c.is_alphanumeric()).count().max(1)
}

fn sounding(segments: &[Segment]) -> impl Iterator<Item = &Segment> {
    segments.iter().filter(|s| !s.phone.is_silence())
}

/// The tick at which so many ticks have sounded.
fn nth_tick(segments: &[Segment], mut sounded: i64) -> i64 {
    let mut end = 0;
    for segment in sounding(segments) {
        let ticks = segment.end - segment.start;
        if sounded < ticks {
            return segment.start + sounded.max(0);
        }
        sounded -= ticks;
        end = segment.end;
    }
    end
}

/// Where the pause nearest to `guess` ends; `guess` itself where none is near.
fn after_pause(segments: &[Segment], guess: i64) -> i64 {
    let pauses = segments.iter().filter(|s| s.phone.is_silence());
    let distance = |pause: &Segment| (pause.start - guess).max(guess - pause.end).max(0);
    let nearest = pauses.min_by_key(|pause| distance(pause));
    nearest
        .filter(|pause| distance(pause) <= NEAR_TICKS)
        .map_or(guess, |pause| pause.end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::Phone;

    fn texts(text: &str) -> Vec<String> {
        subtitles(text, &[]).into_iter().map(|(_, t)| t).collect()
    }

    #[test]
    fn sentences_are_captions_and_long_ones_are_cut_between_words() {
        assert_eq!(
            texts(" Dr. One is here.\nTwo,\tthree "),
            ["Dr. One is here.", "Two, three"]
        );
        assert!(texts(" \n").is_empty());
        let long = "a word and ".repeat(40);
        let cut = texts(&long);
        assert!(cut.len() > 4, "{cut:?}");
        assert!(cut.iter().all(|t| t.chars().count() <= CHARS_MAX));
        assert_eq!(cut.join(" "), long.trim_end());
        let nonsense = "ä".repeat(3 * CHARS_MAX + 1);
        assert_eq!(
            texts(&format!("so {nonsense} it")).concat(),
            format!("so{nonsense} it")
        );
    }

    #[test]
    fn each_begins_with_its_own_words() {
        const S: i64 = TICK_RATE;
        // Ten letters in three seconds, a pause of one, ten letters in three.
        let segments = [
            Segment::new(Phone::Aa, 0, 3 * S),
            Segment::new(Phone::Pau, 3 * S, 4 * S),
            Segment::new(Phone::Aa, 4 * S, 7 * S),
        ];
        let found = subtitles("Abcde fghij. Klmno pqrst.", &segments);
        let wanted = [(0, "Abcde fghij.".into()), (4 * S, "Klmno pqrst.".into())];
        assert_eq!(found, wanted);
        // Off by less than a second of what the pause says.
        let found = subtitles("Ab cde fghi. Jklmn opqrst.", &segments);
        assert_eq!(found[1].0, 4 * S);
        // No pause is near: a third of the letters is a third of what sounds.
        let found = subtitles("Abcde fghij. Klmno pqrst uvwxy zabcd.", &segments);
        assert_eq!(found[1].0, 2 * S);
    }
}
