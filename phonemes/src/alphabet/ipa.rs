//! Reads symbols of the International Phonetic Alphabet: letters, diacritics, ties, length, stress.
//!
//! Composed or decomposed Unicode, as Montreal's aligner (`tʲ`, `aj`), Piper and espeak-ng (`ɑːɹ`,
//! `ᵻ`) or a textbook (`t͡ʃ`, `ɜ˞`) write it. A diacritic changes the phone where English tells
//! the two apart (`b̚` is `bcl`, `l̩` is `el`, `ɾ̃` is `nx`); elsewhere it is an allophone's. X-SAMPA
//! and espeak-ng's mnemonics come here as the letters that they stand for.

use unicode_normalization::UnicodeNormalization;

use super::letters::{Letter, letter};
use super::{PhoneList, Spoken};
use crate::{Phone, Stress};

/// Longest symbol that is looked at whole; the rest of a longer one is no symbol.
const CHARS_MAX: usize = 64;

/// Letters that look like others of the chart, or were in older ones, and ligatures.
const LOOKALIKES: [(char, &str); 34] = [
    ('g', "ɡ"),
    (':', "ː"),
    ('ε', "ɛ"),
    ('ɩ', "ɪ"),
    ('ı', "ɪ"),
    ('ɷ', "ʊ"),
    ('ǝ', "ə"),
    ('α', "ɑ"),
    ('ɼ', "r"),
    ('ɿ', "ɪ"),
    ('ʅ', "ɪ"),
    ('ʆ', "ɕ"),
    ('ʓ', "ʑ"),
    ('φ', "ɸ"),
    ('λ', "ʎ"),
    ('γ', "ɣ"),
    ('ꭓ', "χ"),
    ('ß', "β"),
    ('∫', "ʃ"),
    ('ʤ', "dʒ"),
    ('ʧ', "tʃ"),
    ('ʦ', "ts"),
    ('ʣ', "dz"),
    ('ʨ', "tɕ"),
    ('ʥ', "dʑ"),
    ('ᴀ', "a"),
    ('ǰ', "dʒ"),
    ('š', "ʃ"),
    ('ž', "ʒ"),
    ('č', "tʃ"),
    ('đ', "ð"),
    ('ł', "ɫ"),
    ('ᵊ', "ə"),
    ('’', "ʼ"),
];

/// Pairs of letters that are one phone.
const PAIRS: [(char, &str, Phone); 20] = [
    ('a', "ɪije", Phone::Ay),
    ('ɑ', "ɪij", Phone::Ay),
    ('ʌ', "ɪj", Phone::Ay),
    ('æ', "ɪj", Phone::Ay),
    ('a', "ʊuw", Phone::Aw),
    ('ɑ', "ʊuw", Phone::Aw),
    ('æ', "ʊuwɔ", Phone::Aw),
    ('e', "ɪij", Phone::Ey),
    ('ɛ', "ɪij", Phone::Ey),
    ('o', "ʊuw", Phone::Ow),
    ('ə', "ʊuw", Phone::Ow),
    ('ɵ', "ʊuw", Phone::Ow),
    ('ɔ', "ɪij", Phone::Oy),
    ('o', "ɪij", Phone::Oy),
    ('ɔ', "ʏy", Phone::Oy),
    ('t', "ʃʂɕ", Phone::Ch),
    ('d', "ʒʐʑ", Phone::Jh),
    ('ɜ', "ɹ", Phone::Er),
    ('ə', "ɹ", Phone::Axr),
    ('ɝ', "ɹ", Phone::Er),
];

/// Signs that end sentences and their parts.
const SIGNS: &str = ",.;:!?…—–\"“”«»¿¡()";

/// A letter with what its diacritics say.
#[derive(Clone, Copy, Debug, Default)]
struct Unit {
    letter: char,
    long: bool,
    syllabic: bool,
    unreleased: bool,
    voiceless: bool,
    nasal: bool,
    rhotic: bool,
}

/// What a symbol says; `None` where it has neither a letter nor a mark of the alphabet.
pub(super) fn ipa(symbol: &str) -> Option<Spoken> {
    // Voices that time the signs of a sentence pause there.
    if !symbol.is_empty() && symbol.chars().all(|c| SIGNS.contains(c)) {
        return Some(Spoken::exactly(Phone::Pau));
    }
    let mut text = Text::default();
    for c in symbol.nfc().take(CHARS_MAX) {
        match LOOKALIKES.iter().find(|row| row.0 == c) {
            Some((_, letters)) => letters.chars().for_each(|c| text.add(c)),
            // `ç` is a letter, `ẽ` a letter with a diacritic.
            None if letter(c).is_some() => text.add(c),
            None => std::iter::once(c).nfd().for_each(|c| text.add(c)),
        }
    }
    text.spoken()
}

/// A symbol taken apart.
#[derive(Debug, Default)]
struct Text {
    units: Vec<Unit>,
    stress: Option<Stress>,
    /// It holds something that the alphabet does not have.
    strange: bool,
    /// It holds a mark of the alphabet.
    marked: bool,
}

impl Text {
    fn add(&mut self, c: char) {
        if letter(c).is_some() {
            let letter = c;
            self.units.push(Unit {
                letter,
                ..Unit::default()
            });
            return;
        }
        self.marked |= self.mark(c);
    }

    /// Takes anything that is no letter of the chart; whether it belongs to the alphabet.
    fn mark(&mut self, c: char) -> bool {
        let last = self.units.last_mut();
        match (c, last) {
            ('ˈ' | '\'' | 'ʹ' | '′', _) => self.stress = Some(Stress::Primary),
            ('ˌ' | ',', _) if self.stress.is_none() => self.stress = Some(Stress::Secondary),
            ('ː' | 'ˑ', Some(unit)) => unit.long = true,
            ('\u{329}' | '\u{30d}', Some(unit)) => unit.syllabic = true,
            ('\u{31a}', Some(unit)) => unit.unreleased = true,
            ('\u{325}' | '\u{30a}', Some(unit)) => unit.voiceless = true,
            ('\u{303}', Some(unit)) => unit.nasal = true,
            ('˞' | 'ʴ', Some(unit)) => unit.rhotic = true,
            _ if is_silent_mark(c) => {}
            _ => {
                self.strange = true;
                // Capitals and letters of other scripts sound; the rest (signs, digits) does not.
                if c.is_alphabetic() {
                    let lower = c.to_lowercase().next().filter(|c| letter(*c).is_some());
                    let letter = lower.unwrap_or('ə');
                    self.units.push(Unit {
                        letter,
                        ..Unit::default()
                    });
                }
                return false;
            }
        }
        true
    }

    fn spoken(self) -> Option<Spoken> {
        let mut phones: Vec<Phone> = Vec::new();
        let mut exact = !self.strange;
        let mut rest = self.units.as_slice();
        while let Some((first, after)) = rest.split_first() {
            let paired = after.first().and_then(|second| pair(*first, *second));
            if let Some(phone) = paired {
                add(&mut phones, phone);
                rest = &after[1..];
                continue;
            }
            let (phone, known) = first.phone();
            add(&mut phones, phone);
            if first.rhotic && !matches!(phone, Phone::Er | Phone::Axr) {
                add(&mut phones, Phone::R);
            }
            exact &= known;
            rest = after;
        }
        if phones.is_empty() && !self.marked {
            return None;
        }
        // A mark alone, as Piper times them, is part of its neighbours.
        let list = PhoneList::of(&phones).unwrap_or(PhoneList::one(Phone::Epi));
        exact &= list.len() >= phones.len();
        Some(Spoken {
            phones: list,
            stress: self.stress,
            exact,
        })
    }
}

/// A doubled letter is one sound.
fn add(phones: &mut Vec<Phone>, phone: Phone) {
    if phones.last() != Some(&phone) {
        phones.push(phone);
    }
}

fn pair(first: Unit, second: Unit) -> Option<Phone> {
    let apart = first.long || first.unreleased || second.syllabic || second.rhotic;
    let mut rows = PAIRS.iter();
    let row = rows.find(|(one, others, _)| *one == first.letter && others.contains(second.letter));
    row.filter(|_| !apart).map(|(_, _, phone)| *phone)
}

impl Unit {
    fn phone(self) -> (Phone, bool) {
        let exact = match self.letter {
            'b' if self.unreleased => Phone::Bcl,
            'd' if self.unreleased => Phone::Dcl,
            'ɡ' if self.unreleased => Phone::Gcl,
            'p' if self.unreleased => Phone::Pcl,
            't' if self.unreleased => Phone::Tcl,
            'k' if self.unreleased => Phone::Kcl,
            'l' | 'ɫ' if self.syllabic => Phone::El,
            'm' if self.syllabic => Phone::Em,
            'n' if self.syllabic => Phone::En,
            'ŋ' if self.syllabic => Phone::Eng,
            'ɹ' | 'r' if self.syllabic => Phone::Axr,
            'ɾ' if self.nasal => Phone::Nx,
            'ə' if self.voiceless => Phone::AxH,
            'ə' | 'ɐ' if self.rhotic => Phone::Axr,
            'ɜ' if self.rhotic => Phone::Er,
            // Long and open, as in British "bath" or German "Bahn".
            'a' if self.long => Phone::Aa,
            'e' if self.long => Phone::Ey,
            other => return letter(other).map_or((Phone::Ax, false), Letter::phone),
        };
        (exact, true)
    }
}

/// Marks that leave the phone what it is: ties, breaks, tones, and diacritics of allophones.
fn is_silent_mark(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}' | '\u{1dc4}'..='\u{1dff}' | 'ʰ'..='ʸ' | 'ˀ' | 'ˁ' | 'ˠ'..='ˤ'
        | '˥'..='˩' | '¹' | '²' | '³' | '⁰' | '⁴'..='⁹' | 'ᵝ' | 'ᶿ' | 'ʼ' | 'ʻ'
        | 'ː' | 'ˑ' | 'ˌ' | ',' | '.' | '-' | '|' | '‖' | '‿' | '/' | '[' | ']' | '(' | ')'
        | '↗' | '↘' | 'ꜛ' | 'ꜜ' | '+' | '˖' | '˗' | ' ' | '\u{200d}')
}
