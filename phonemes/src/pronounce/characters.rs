//! Phones within the times of characters, as voices give them that know only their text
//! (ElevenLabs: an array of characters, one of start times, one of end times).
//!
//! Each phone of a word is put on the letter that it is written with: the rules say what each
//! letter sounds like, and a word's phones are matched with those by how alike they are. So the
//! times of the letters, which follow the voice, become times of phones. Words that are not
//! written as they sound (numbers, abbreviations) are spread over all of their time.

use super::{Pronouncer, Said, durations, letters, spread};
use crate::alphabet::distance;
use crate::{Labels, Phone, Segment, Word};

/// A character and when it sounds, in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Character {
    /// The character.
    pub text: char,
    /// First tick.
    pub start: i64,
    /// The tick after the last.
    pub end: i64,
}

pub(super) fn labelled(pronouncer: &Pronouncer, characters: &[Character]) -> Labels {
    let mut labels = Labels::default();
    let tokens: Vec<&[Character]> = characters
        .split(|c| c.text.is_whitespace())
        .filter(|token| !token.is_empty())
        .collect();
    for (at, token) in tokens.iter().enumerate() {
        let text: String = token.iter().map(|c| c.text).collect();
        let said = pronouncer.pronounce(&text);
        let Some(sounding) = sounding(token) else {
            continue;
        };
        let (start, end) = (sounding[0].start, sounding[sounding.len() - 1].end);
        if said.is_empty() || end <= start {
            continue;
        }
        let word: String = sounding.iter().map(|c| c.text).collect();
        let next = tokens
            .get(at + 1)
            .and_then(|next| next.first())
            .map(|c| c.start);
        match by_letters(&said, &word.to_lowercase(), sounding) {
            Some(starts) => lay(&said, &starts, end, &mut labels.segments),
            None => spread::lay(&said, start, end, next, &mut labels.segments),
        }
        labels.words.push(Word {
            text: word,
            start,
            end,
        });
    }
    labels.words.sort_by_key(|word| word.start);
    labels
}

/// A token without the signs around it: voices put the pause of a sentence into its full stop.
fn sounding(token: &[Character]) -> Option<&[Character]> {
    let sounds = |c: &Character| !c.text.is_ascii_punctuation() && !is_quote(c.text);
    let first = token.iter().position(sounds)?;
    let last = token.iter().rposition(sounds)?;
    // "$5" and "5%" are said whole.
    let said_sign = |c: &Character| matches!(c.text, '$' | '%' | '&' | '+' | '=' | '@' | '#');
    let first = token
        .iter()
        .position(said_sign)
        .map_or(first, |at| at.min(first));
    let last = token
        .iter()
        .rposition(said_sign)
        .map_or(last, |at| at.max(last));
    token.get(first..=last)
}

fn is_quote(c: char) -> bool {
    matches!(
        c,
        '“' | '”' | '‘' | '’' | '«' | '»' | '„' | '…' | '—' | '–' | '¿' | '¡'
    )
}

/// When each phone starts, by its letter; `None` where letters do not tell.
fn by_letters(said: &[Said], word: &str, characters: &[Character]) -> Option<Vec<i64>> {
    if !word
        .chars()
        .all(|c| c.is_alphabetic() || matches!(c, '\'' | '’'))
    {
        return None;
    }
    // What the letters sound like, each phone with its letter.
    let mut heard: Vec<(usize, Heard)> = Vec::new();
    let letters: Vec<char> = word.chars().collect();
    for (place, phones) in letters::sounds(word) {
        heard.extend(phones.iter().map(|said| (place, Heard::As(said.0))));
        if phones.is_empty() {
            let vowel = letters.get(place).is_some_and(|c| "aeiouy".contains(*c));
            heard.push((place, Heard::Silent { vowel }));
        }
    }
    let places = matched(said, &heard);
    let mut starts = Vec::with_capacity(said.len());
    let mut from = 0;
    while from < said.len() {
        // Phones of one letter share the time up to the letter of the next.
        let place = places[from];
        let until = (from..said.len())
            .find(|at| places[*at] != place)
            .unwrap_or(said.len());
        let first = if from == 0 { 0 } else { place };
        let start = characters.get(first).map(|c| c.start)?;
        let end = match places.get(until) {
            Some(next) => characters.get(*next)?.start,
            None => characters.last()?.end,
        };
        let ends = durations::ends(&said[from..until], end - start, false);
        // Here all time is the letter's: a long vowel is no pause.
        let used = ends.last().copied().unwrap_or(0).max(1);
        starts.push(start);
        for at in ends.iter().take(ends.len() - 1) {
            starts.push(start + (end - start).max(0) * at / used);
        }
        from = until;
    }
    Some(starts)
}

/// Costs of a phone that no letter is heard as, and of a letter's phone that is not said: more than
/// two phones of a kind differ by, less than a vowel and a consonant do.
const ALONE: i32 = 20;

/// What the rules say of a letter.
#[derive(Clone, Copy, Debug)]
enum Heard {
    As(Phone),
    /// Here it sounds nothing, but in this word it may.
    Silent {
        vowel: bool,
    },
}

impl Heard {
    /// How unlikely it is that this is said as `phone`.
    fn cost(self, phone: Phone) -> i32 {
        match self {
            Self::As(heard) => i32::from(distance(phone, heard)),
            Self::Silent { vowel } if vowel == phone.is_vowel() => ALONE / 2,
            Self::Silent { .. } => 3 * ALONE,
        }
    }

    /// The same of its not being said.
    const fn cost_alone(self) -> i32 {
        match self {
            Self::As(_) => ALONE,
            Self::Silent { .. } => 0,
        }
    }
}

/// For each phone said, the place of its letter: the alignment of least cost, in order.
fn matched(said: &[Said], heard: &[(usize, Heard)]) -> Vec<usize> {
    let width = heard.len() + 1;
    let mut cost = vec![0_i32; (said.len() + 1) * width];
    let step = |cost: &[i32], i: usize, j: usize| {
        let both = cost[(i - 1) * width + j - 1] + heard[j - 1].1.cost(said[i - 1].0);
        let said_alone = cost[(i - 1) * width + j] + ALONE;
        let heard_alone = cost[i * width + j - 1] + heard[j - 1].1.cost_alone();
        (both, said_alone, heard_alone)
    };
    for i in 0..=said.len() {
        for j in 0..width {
            cost[i * width + j] = match (i, j) {
                (0, 0) => 0,
                (0, _) => cost[j - 1] + heard[j - 1].1.cost_alone(),
                (_, 0) => i as i32 * ALONE,
                _ => {
                    let (both, one, other) = step(&cost, i, j);
                    both.min(one).min(other)
                }
            };
        }
    }
    let mut places = vec![None; said.len()];
    let (mut i, mut j) = (said.len(), heard.len());
    while i > 0 && j > 0 {
        let (both, one, other) = step(&cost, i, j);
        if both <= one && both <= other {
            (i, j) = (i - 1, j - 1);
            places[i] = Some(heard[j].0);
        } else if one <= other {
            i -= 1;
        } else {
            j -= 1;
        }
    }
    // A phone without a letter is on that of the one before it.
    let first = places.iter().flatten().next().copied().unwrap_or(0);
    let mut last = first;
    let filled = places.into_iter().map(|place| {
        last = place.unwrap_or(last);
        last
    });
    filled.collect()
}

fn lay(said: &[Said], starts: &[i64], end: i64, out: &mut Vec<Segment>) {
    let mut at = out.last().map_or(i64::MIN, |last| last.end);
    for (index, (phone, stress)) in said.iter().enumerate() {
        let start = starts.get(index).map_or(at, |start| at.max(*start));
        let until = starts.get(index + 1).copied().unwrap_or(end).min(end);
        if until > start {
            out.push(Segment {
                phone: *phone,
                start,
                end: until,
                stress: *stress,
            });
            at = until;
        }
    }
}
