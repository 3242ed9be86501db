//! How written English sounds, and when each sound falls within its word.
//!
//! For sources that time only words, as many cloud and neural voices do, and for
//! words that an aligner's dictionary lacks. A word is looked up in a dictionary of the user's, in
//! the common words built in, as a word of those with an ending or as two of them, and spelled by
//! rule last; all of it is American English. The phones then share their word's time by the
//! durations that they have in running speech. Two voices say "1990" or "Dr." in two ways: where
//! the source knows phones, they are better than these.
//!
//! | module | holds |
//! |---|---|
//! | `lexicon` | words and their phones: built in, and a user's |
//! | `endings` | words made of others |
//! | `letters` | rules from letters to phones |
//! | `stress` | one main stress a word |
//! | `text` | numbers, signs, abbreviations and letters by name as words |
//! | `numbers` | numbers as words |
//! | `scripts` | letters that English does not have |
//! | `durations` | how long each phone takes |
//! | `spread` | phones within the times of words |

mod durations;
mod endings;
mod letters;
mod lexicon;
mod numbers;
mod scripts;
mod spread;
mod stress;
mod text;

use crate::{Note, Phone, Segment, Stress, Word};
use lexicon::Lexicon;

/// A phone as it is said.
pub type Said = (Phone, Option<Stress>);

/// Longest word whose sounds are looked for; a longer one is cut there. The longest in English
/// dictionaries has 45 letters.
pub const WORD_CHARS_MAX: usize = 64;

/// Says words.
#[derive(Clone, Debug, Default)]
pub struct Pronouncer {
    own: Lexicon,
}

impl Pronouncer {
    /// One that knows the words built in.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a dictionary, which then goes before all else: lines `WORD PHONE PHONE …` as in the CMU
    /// dictionary or Montreal's aligner's (probabilities after the word are left out), in any
    /// alphabet of [`Alphabet`](crate::Alphabet). Says what of it could not be used.
    pub fn add_dictionary(&mut self, text: &str) -> Vec<Note> {
        self.own.add(text)
    }

    /// The phones of a token of text: a word, number or sign. Empty where nothing is said, as for
    /// a comma. Stops and affricates are one phone each, as
    /// [`alphabet`](crate::alphabet)'s are.
    pub fn pronounce(&self, token: &str) -> Vec<Said> {
        let mut said = Vec::new();
        for spoken in text::words(token) {
            match spoken {
                text::Spoken::Word(word) => said.extend(self.word(&word)),
                text::Spoken::Letter(letter) => said.extend(text::letter_name(letter)),
            }
        }
        said
    }

    /// The phones of one word in small letters.
    fn word(&self, word: &str) -> Vec<Said> {
        let known = |word: &str| self.own.get(word).or_else(|| lexicon::common(word));
        if let Some(said) = known(word).or_else(|| endings::made_of(word, &known)) {
            return said;
        }
        let mut said: Vec<Said> = Vec::new();
        for one in letters::sounds(word) {
            // The rules give `ar` of "vinegar" both its vowel and an r.
            let after_er = said
                .last()
                .is_some_and(|s| matches!(s.0, Phone::Er | Phone::Axr));
            if one.0 != Phone::R || !after_er {
                said.push(one);
            }
        }
        stress::settle(&mut said);
        said
    }

    /// The phones of words whose times are known. Words without sounds (signs) and words without
    /// time leave a gap; of words that overlap the later begins when the earlier has ended.
    pub fn spread(&self, words: &[Word]) -> Vec<Segment> {
        spread::spread(self, words)
    }
}

/// [`Pronouncer::pronounce`] with the words built in.
pub fn pronounce(token: &str) -> Vec<Said> {
    Pronouncer::new().pronounce(token)
}

/// [`Pronouncer::spread`] with the words built in.
pub fn spread(words: &[Word]) -> Vec<Segment> {
    Pronouncer::new().spread(words)
}
