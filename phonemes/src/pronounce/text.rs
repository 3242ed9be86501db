//! A token of text as words: numbers, signs, abbreviations, and letters said by name.
//!
//! English, as a newsreader would say it without the sentence around: "1990" is a year, "St." a
//! saint. What is not said (commas, brackets, marks such as `[noise]`) gives nothing.

use super::lexicon::common;
use super::numbers::{digits, number, ordinal};
use super::{Said, WORD_CHARS_MAX};
use crate::Alphabet;

/// What one token holds, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Spoken {
    /// A word in small letters.
    Word(String),
    /// A letter by its name.
    Letter(char),
}

/// Abbreviations, without their stop, and what is said.
const SHORT: [(&str, &str); 27] = [
    ("mr", "mister"),
    ("mrs", "missus"),
    ("ms", "miss"),
    ("dr", "doctor"),
    ("prof", "professor"),
    ("st", "saint"),
    ("mt", "mount"),
    ("jr", "junior"),
    ("sr", "senior"),
    ("vs", "versus"),
    ("etc", "et cetera"),
    ("approx", "approximately"),
    ("dept", "department"),
    ("gov", "governor"),
    ("gen", "general"),
    ("sen", "senator"),
    ("rep", "representative"),
    ("lt", "lieutenant"),
    ("col", "colonel"),
    ("capt", "captain"),
    ("sgt", "sergeant"),
    ("inc", "incorporated"),
    ("ltd", "limited"),
    ("corp", "corporation"),
    ("ave", "avenue"),
    ("blvd", "boulevard"),
    ("km", "kilometers"),
];

/// Those that stand for their words even without a stop.
const ALWAYS_SHORT: [&str; 9] = ["mr", "mrs", "dr", "st", "vs", "etc", "prof", "km", "ltd"];

/// Signs that are said.
const SIGNS: [(char, &str); 12] = [
    ('&', "and"),
    ('%', "percent"),
    ('+', "plus"),
    ('=', "equals"),
    ('@', "at"),
    ('°', "degrees"),
    ('#', "number"),
    ('€', "euros"),
    ('£', "pounds"),
    ('$', "dollars"),
    ('½', "half"),
    ('¼', "quarter"),
];

/// Money whose sign stands before the number: what is said after the whole and after the rest.
const MONEY: [(char, &str, &str); 3] = [
    ('$', "dollars", "cents"),
    ('€', "euros", "cents"),
    ('£', "pounds", "pence"),
];

/// What a token says.
pub(super) fn words(token: &str) -> Vec<Spoken> {
    let token = token.trim();
    let mut out = Vec::new();
    if is_mark(token) {
        return out;
    }
    let token: String = token
        .chars()
        .take(4 * WORD_CHARS_MAX)
        .map(|c| {
            if matches!(c, '’' | '‘' | 'ʼ' | '`') {
                '\''
            } else {
                c
            }
        })
        .collect();
    if let Some(letters) = dotted(&token) {
        out.extend(letters.map(Spoken::Letter));
        return out;
    }
    let mut rest = token.as_str();
    while let Some(c) = rest.chars().next() {
        let money = MONEY.iter().find(|row| row.0 == c);
        let run = if let Some(row) = money.filter(|_| begins_number(&rest[c.len_utf8()..])) {
            let sign = c.len_utf8();
            let length = number_length(&rest[sign..]);
            say_money(&rest[sign..sign + length], row.1, row.2, &mut out);
            sign + length
        } else if c.is_ascii_digit() {
            let length = number_length(rest);
            length + say_number(&rest[..length], &rest[length..], &mut out)
        } else if c.is_alphabetic() {
            let length = run_length(rest, |c| c.is_alphabetic() || c == '\'' || is_accent(c));
            let stop = rest[length..].starts_with('.');
            say_word(rest[..length].trim_end_matches('\''), stop, &mut out);
            length
        } else {
            if let Some((_, word)) = SIGNS.iter().find(|row| row.0 == c) {
                push(word, &mut out);
            }
            c.len_utf8()
        };
        rest = &rest[run..];
    }
    out
}

/// `[noise]`, `<unk>`: what a transcriber heard beside words.
fn is_mark(token: &str) -> bool {
    let within = |open: char, close: char| token.starts_with(open) && token.ends_with(close);
    within('[', ']') || within('<', '>')
}

/// The letters of "U.S." or "e.g."
fn dotted(token: &str) -> Option<impl Iterator<Item = char>> {
    let token = token.trim_matches(|c: char| !c.is_alphanumeric() && c != '.');
    let parts = || token.trim_end_matches('.').split('.');
    let single = |part: &str| part.len() == 1 && part.bytes().all(|b| b.is_ascii_alphabetic());
    let all = parts().count() >= 2 && parts().all(single);
    all.then(|| parts().flat_map(str::chars).map(|c| c.to_ascii_lowercase()))
}

fn run_length(text: &str, test: impl Fn(char) -> bool) -> usize {
    text.find(|c: char| !test(c)).unwrap_or(text.len())
}

/// An accent that stands apart from its letter.
fn is_accent(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}')
}

fn begins_number(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
}

/// Digits, and between digits the stops, commas and colons that belong to a number.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let mut at = 0;
    while digit(at) || (matches!(bytes.get(at), Some(b'.' | b',' | b':')) && digit(at + 1)) {
        at += 1;
    }
    at
}

fn push(words: &str, out: &mut Vec<Spoken>) {
    out.extend(words.split(' ').map(|word| Spoken::Word(word.to_owned())));
}

/// A number, with the letters after it where they make it an ordinal; how many bytes those are.
fn say_number(text: &str, after: &str, out: &mut Vec<Spoken>) -> usize {
    let mut say = |words: &[&str]| words.iter().for_each(|word| push(word, out));
    let letters = run_length(after, char::is_alphabetic);
    let ending = after[..letters].to_ascii_lowercase();
    if matches!(ending.as_str(), "st" | "nd" | "rd" | "th") {
        say(&ordinal(text));
        return letters;
    }
    if let Some((hours, minutes)) = text.split_once(':') {
        say(&number(hours));
        match minutes.strip_prefix('0') {
            Some("0") => {}
            Some(rest) => say(&[&["oh"][..], &number(rest)].concat()),
            None => say(&number(minutes)),
        }
    } else if let Some((whole, part)) = text.split_once('.') {
        say(&number(whole));
        // "1.2.3" is a version: each part a number.
        if part.contains('.') {
            for part in part.split('.') {
                say(&[&["point"][..], &number(part)].concat());
            }
        } else {
            say(&[&["point"][..], &digits(part)].concat());
        }
    } else {
        say(&number(text));
        // "1990s", "40s".
        if ending == "s" {
            if let Some(Spoken::Word(last)) = out.last_mut() {
                *last = match last.strip_suffix('y') {
                    Some(stem) => format!("{stem}ies"),
                    None => format!("{last}s"),
                };
            }
            return letters;
        }
    }
    0
}

fn say_money(text: &str, unit: &str, part: &str, out: &mut Vec<Spoken>) {
    let (whole, rest) = text.split_once('.').unwrap_or((text, ""));
    // A comma keeps a sum from being read as a year.
    let grouped = format!("{whole},");
    number(&grouped).iter().for_each(|word| push(word, out));
    push(
        if whole == "1" {
            &unit[..unit.len() - 1]
        } else {
            unit
        },
        out,
    );
    if rest.bytes().any(|b| b != b'0') {
        number(rest).iter().for_each(|word| push(word, out));
        push(part, out);
    }
}

/// A run of letters: a word, an abbreviation, or letters to be named.
fn say_word(text: &str, stop: bool, out: &mut Vec<Spoken>) {
    let word = text.to_lowercase();
    let short = SHORT.iter().find(|row| row.0 == word);
    if let Some((_, words)) = short.filter(|_| stop || ALWAYS_SHORT.contains(&word.as_str())) {
        push(words, out);
        return;
    }
    let ascii = word.bytes().all(|b| b.is_ascii_alphabetic());
    let capitals = !text.contains(char::is_lowercase);
    let vowels = word.contains(['a', 'e', 'i', 'o', 'u', 'y']);
    // "hmm" and "shh" are sounds, not letters.
    let hum = word
        .bytes()
        .all(|b| matches!(b, b'h' | b'm' | b's' | b'p' | b't' | b'r' | b'z'));
    let named = match word.len() {
        1 => true,
        2..=3 => capitals || (!vowels && !hum),
        4..=6 => !vowels && (capitals || !hum),
        _ => false,
    };
    if ascii && named && common(&word).is_none() {
        out.extend(word.chars().map(Spoken::Letter));
    } else if !word.is_empty() {
        out.push(Spoken::Word(word));
    }
}

/// The names of the letters.
const NAMES: [&str; 26] = [
    "EY1",
    "B IY1",
    "S IY1",
    "D IY1",
    "IY1",
    "EH1 F",
    "JH IY1",
    "EY1 CH",
    "AY1",
    "JH EY1",
    "K EY1",
    "EH1 L",
    "EH1 M",
    "EH1 N",
    "OW1",
    "P IY1",
    "K Y UW1",
    "AA1 R",
    "EH1 S",
    "T IY1",
    "Y UW1",
    "V IY1",
    "D AH1 B AH0 L Y UW0",
    "EH1 K S",
    "W AY1",
    "Z IY1",
];

/// A letter by its name; nothing for what is none of a to z.
pub(super) fn letter_name(letter: char) -> Vec<Said> {
    let place = u8::try_from(letter).ok().and_then(|l| l.checked_sub(b'a'));
    let name = place.and_then(|place| NAMES.get(usize::from(place)));
    let symbols = name.into_iter().flat_map(|name| name.split(' '));
    let spoken = symbols.map(|symbol| Alphabet::Arpabet.spoken(symbol));
    spoken
        .map(|spoken| (spoken.phones[0], spoken.stress))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(token: &str) -> String {
        let words = words(token).into_iter().map(|spoken| match spoken {
            Spoken::Word(word) => word,
            Spoken::Letter(letter) => letter.to_uppercase().to_string(),
        });
        words.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn tokens_become_what_a_reader_says() {
        for (token, words) in [
            ("Hello,", "hello"),
            ("“don’t”", "don't"),
            ("co-operate", "co operate"),
            ("dogs'", "dogs"),
            ("U.S.", "U S"),
            ("(e.g.)", "E G"),
            ("TTS", "T T S"),
            ("NASA", "nasa"),
            ("HELLO", "hello"),
            ("IT", "it"),
            ("hmm", "hmm"),
            ("x", "X"),
            ("I", "i"),
            ("Dr.", "doctor"),
            ("St.", "saint"),
            ("St", "saint"),
            ("AT&T", "at and t"),
            ("xz3", "X Z three"),
            ("7", "seven"),
            ("42", "forty two"),
            ("100%", "one hundred percent"),
            ("1990", "nineteen ninety"),
            ("1990s", "nineteen nineties"),
            ("1905", "nineteen oh five"),
            ("2024", "twenty twenty four"),
            ("2005", "two thousand five"),
            ("1,990", "one thousand nine hundred ninety"),
            ("1000000", "one million"),
            ("3.14", "three point one four"),
            ("0.5", "zero point five"),
            ("10:30", "ten thirty"),
            ("10:05", "ten oh five"),
            ("10:00", "ten"),
            ("3rd", "third"),
            ("21st", "twenty first"),
            ("$3.50", "three dollars fifty cents"),
            ("$1", "one dollar"),
            ("£2000", "two thousand pounds"),
            ("007", "zero zero seven"),
            ("v1.2.3", "v one point two point three"),
            ("...", ""),
            ("—", ""),
            ("[noise]", ""),
            ("<unk>", ""),
            ("", ""),
            ("☺", ""),
        ] {
            assert_eq!(said(token), words, "{token}");
        }
    }

    #[test]
    fn endless_numbers_are_said_digit_by_digit() {
        let long = "9".repeat(500);
        let words = words(&long);
        assert_eq!(words.len(), 4 * WORD_CHARS_MAX);
    }
}
