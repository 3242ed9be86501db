//! The letters of the International Phonetic Alphabet (chart of 2020): how each is made, and which
//! phone it is where English has it.
//!
//! A letter with a phone is exact: it is how some transcription of English (CMU's, TIMIT's,
//! espeak-ng's, Montreal's aligner's) writes that phone or an allophone of it. All others go to
//! the closest by [`features`](super::features).

use super::features::{Consonant, Manner, Place, Sound, closest, made, vowel};
use crate::Phone;

use Manner::{Fricative, Glide, Nasal, SideFricative, SideGlide, Stop, Tap};
use Place::{BehindRidge, Curled, LipTeeth, Lips, Palate, Ridge, Teeth, Throat, Uvula, Velum};

/// What a letter stands for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Letter {
    /// A sound that English has.
    English(Phone),
    /// Any other.
    Foreign(Sound),
}

impl Letter {
    /// The phone, and whether it is exact.
    pub(super) fn phone(self) -> (Phone, bool) {
        match self {
            Self::English(phone) => (phone, true),
            Self::Foreign(sound) => (closest(sound), false),
        }
    }
}

/// The row of a letter.
pub(super) fn letter(letter: char) -> Option<Letter> {
    let row = LETTERS.iter().find(|row| row.0 == letter);
    row.map(|row| row.1)
}

const fn e(phone: Phone) -> Letter {
    Letter::English(phone)
}

const fn v(height: i8, back: i8, round: i8) -> Letter {
    Letter::Foreign(vowel(height, back, round))
}

const fn c(place: Place, manner: Manner) -> Letter {
    f(made(place, manner))
}

const fn f(consonant: Consonant) -> Letter {
    Letter::Foreign(Sound::Consonant(consonant))
}

const fn voiced(place: Place, manner: Manner) -> Letter {
    f(made(place, manner).voiced())
}

/// One row a letter, by the rows of the chart.
const LETTERS: [(char, Letter); 114] = [
    // Vowels that some English has. `a` is TRAP in Britain, `e` DRESS, `ɒ` LOT, `ɐ` STRUT.
    ('i', e(Phone::Iy)),
    ('ɪ', e(Phone::Ih)),
    ('e', e(Phone::Eh)),
    ('ɛ', e(Phone::Eh)),
    ('æ', e(Phone::Ae)),
    ('a', e(Phone::Ae)),
    ('ɑ', e(Phone::Aa)),
    ('ɒ', e(Phone::Ao)),
    ('ɔ', e(Phone::Ao)),
    ('o', e(Phone::Ow)),
    ('ʊ', e(Phone::Uh)),
    ('u', e(Phone::Uw)),
    ('ʉ', e(Phone::Ux)),
    ('ʌ', e(Phone::Ah)),
    ('ɐ', e(Phone::Ah)),
    ('ə', e(Phone::Ax)),
    ('ɨ', e(Phone::Ix)),
    ('ᵻ', e(Phone::Ix)),
    ('ᵿ', e(Phone::Uh)),
    ('ɜ', e(Phone::Er)),
    ('ɝ', e(Phone::Er)),
    ('ɚ', e(Phone::Axr)),
    // Other vowels.
    ('y', v(6, 0, 2)),
    ('ʏ', v(5, 1, 2)),
    ('ɯ', v(6, 4, 0)),
    ('ø', v(4, 0, 2)),
    ('ɘ', v(4, 2, 0)),
    ('ɵ', v(4, 2, 2)),
    ('ɤ', v(4, 4, 0)),
    ('œ', v(2, 0, 2)),
    ('ɞ', v(2, 2, 2)),
    ('ɶ', v(0, 0, 2)),
    // Stops.
    ('p', e(Phone::P)),
    ('b', e(Phone::B)),
    ('t', e(Phone::T)),
    ('d', e(Phone::D)),
    ('k', e(Phone::K)),
    ('ɡ', e(Phone::G)),
    ('ʔ', e(Phone::Q)),
    // English has these two beside front vowels.
    ('c', e(Phone::K)),
    ('ɟ', e(Phone::G)),
    ('ʈ', c(Curled, Stop)),
    ('ɖ', voiced(Curled, Stop)),
    ('q', c(Uvula, Stop)),
    ('ɢ', voiced(Uvula, Stop)),
    ('ʡ', c(Throat, Stop)),
    ('ɓ', voiced(Lips, Stop)),
    ('ɗ', voiced(Ridge, Stop)),
    ('ᶑ', voiced(Curled, Stop)),
    ('ʄ', voiced(Velum, Stop)),
    ('ɠ', voiced(Velum, Stop)),
    ('ʛ', voiced(Uvula, Stop)),
    // Nasals.
    ('m', e(Phone::M)),
    ('ɱ', e(Phone::M)),
    ('n', e(Phone::N)),
    ('ɲ', e(Phone::N)),
    ('ŋ', e(Phone::Ng)),
    ('ɳ', voiced(Curled, Nasal)),
    ('ɴ', voiced(Uvula, Nasal)),
    // Taps and trills; `r` is how most write English's.
    ('r', e(Phone::R)),
    ('ɾ', e(Phone::Dx)),
    ('ʙ', voiced(Lips, Stop)),
    ('ʀ', voiced(Uvula, Fricative)),
    ('ⱱ', voiced(LipTeeth, Tap)),
    ('ɽ', voiced(Curled, Tap)),
    ('ɺ', voiced(Ridge, SideGlide)),
    // Fricatives.
    ('f', e(Phone::F)),
    ('v', e(Phone::V)),
    ('θ', e(Phone::Th)),
    ('ð', e(Phone::Dh)),
    ('s', e(Phone::S)),
    ('z', e(Phone::Z)),
    ('ʃ', e(Phone::Sh)),
    ('ʒ', e(Phone::Zh)),
    ('h', e(Phone::Hh)),
    ('ɦ', e(Phone::Hv)),
    // The first sound of "huge".
    ('ç', e(Phone::Hh)),
    ('ɸ', c(Lips, Fricative)),
    ('β', voiced(Lips, Fricative)),
    ('ʂ', c(Curled, Fricative)),
    ('ʐ', voiced(Curled, Fricative)),
    ('ɕ', c(Curled, Fricative)),
    ('ʑ', voiced(Curled, Fricative)),
    ('ɧ', c(Curled, Fricative)),
    ('ʝ', voiced(Palate, Fricative)),
    ('x', c(Velum, Fricative)),
    ('ɣ', voiced(Velum, Fricative)),
    ('χ', c(Uvula, Fricative)),
    ('ʁ', voiced(Uvula, Fricative)),
    ('ħ', c(Throat, Fricative)),
    ('ʕ', voiced(Throat, Fricative)),
    ('ʜ', c(Throat, Fricative)),
    ('ʢ', voiced(Throat, Fricative)),
    ('ɬ', c(Ridge, SideFricative)),
    ('ɮ', voiced(Ridge, SideFricative)),
    // Glides.
    ('ɹ', e(Phone::R)),
    ('ɻ', e(Phone::R)),
    ('j', e(Phone::Y)),
    ('w', e(Phone::W)),
    ('ʍ', e(Phone::W)),
    ('l', e(Phone::L)),
    ('ɫ', e(Phone::L)),
    ('ʎ', e(Phone::L)),
    ('ʋ', voiced(LipTeeth, Glide)),
    ('ɥ', f(made(Lips, Glide).voiced().round())),
    ('ɰ', voiced(Velum, Glide)),
    ('ɭ', voiced(Curled, SideGlide)),
    ('ʟ', voiced(Velum, SideGlide)),
    // Clicks, by the closure in front.
    ('ʘ', c(Lips, Stop)),
    ('ǀ', c(Teeth, Stop)),
    ('ǃ', c(BehindRidge, Stop)),
    ('ǂ', c(Palate, Stop)),
    ('ǁ', c(Ridge, SideFricative)),
    ('ꞎ', c(Curled, SideFricative)),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_letter_has_two_rows() {
        for (index, (letter, _)) in LETTERS.iter().enumerate() {
            let mut earlier = LETTERS[..index].iter();
            assert!(earlier.all(|(other, _)| other != letter), "{letter}");
        }
    }

    #[test]
    fn foreign_sounds_go_where_an_english_ear_puts_them() {
        let rows = [
            ('ɸ', Phone::F),
            ('β', Phone::V),
            ('ʋ', Phone::V),
            ('ɓ', Phone::B),
            ('ʙ', Phone::B),
            ('x', Phone::Hh),
            ('χ', Phone::Hh),
            ('ʁ', Phone::Hv),
            ('ʂ', Phone::Sh),
            ('ɕ', Phone::Sh),
            ('ʑ', Phone::Zh),
            ('ʈ', Phone::T),
            ('ɖ', Phone::D),
            ('ɗ', Phone::D),
            ('ɳ', Phone::N),
            ('ɴ', Phone::Ng),
            ('ɽ', Phone::Dx),
            ('ɭ', Phone::L),
            ('q', Phone::K),
            ('ɢ', Phone::G),
            ('ʝ', Phone::Y),
            ('ɥ', Phone::W),
            ('y', Phone::Ux),
            ('ʏ', Phone::Ux),
            ('ø', Phone::Ow),
            ('ɯ', Phone::Ix),
            ('ɤ', Phone::Ax),
            ('ɘ', Phone::Ax),
        ];
        for (symbol, phone) in rows {
            let found = letter(symbol).unwrap().phone();
            assert_eq!(found, (phone, false), "{symbol}");
        }
    }
}
