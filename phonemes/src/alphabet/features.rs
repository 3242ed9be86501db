//! How sounds are made, and which phone is made most like another sound.
//!
//! One small table for TIMIT's phones; the letters of the IPA have theirs in
//! [`letters`](super::letters). Places, manners, heights and backness are those of the IPA chart
//! (2020); how much each counts is our judgement, made for faces: what lips do counts most, then
//! how far the mouth is open, and whether the voice sounds hardly at all.

use crate::Phone;

/// How a sound is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sound {
    Vowel(Vowel),
    Consonant(Consonant),
}

/// A vowel's place on the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Vowel {
    /// From 0, open, to 6, close.
    pub(super) height: i8,
    /// From 0, front, to 4, back.
    pub(super) back: i8,
    /// 0 spread or neutral, 1 a little, 2 rounded.
    pub(super) round: i8,
}

/// A consonant's cell on the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Consonant {
    pub(super) place: Place,
    pub(super) manner: Manner,
    pub(super) voiced: bool,
    /// The lips are rounded or pushed forward.
    pub(super) round: bool,
}

/// Where the mouth is narrowest. The numbers are distances along it, with a wide step after the
/// lips, since a sound of the lips must stay one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i8)]
pub(super) enum Place {
    Lips = 0,
    LipTeeth = 6,
    Teeth = 18,
    Ridge = 20,
    BehindRidge = 22,
    Curled = 23,
    Palate = 27,
    Velum = 29,
    Uvula = 30,
    Throat = 32,
    Glottis = 33,
}

/// How narrow it is there, and which way the air goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Manner {
    Stop,
    Affricate,
    Nasal,
    Tap,
    Fricative,
    SideFricative,
    Glide,
    SideGlide,
}

impl Manner {
    /// From closed to open.
    const fn openness(self) -> i16 {
        match self {
            Self::Stop | Self::Nasal => 0,
            Self::Affricate => 1,
            Self::Fricative | Self::SideFricative => 3,
            Self::Tap => 4,
            Self::Glide | Self::SideGlide => 6,
        }
    }

    const fn by_the_sides(self) -> bool {
        matches!(self, Self::SideFricative | Self::SideGlide)
    }
}

/// Shorthand for tables.
pub(super) const fn vowel(height: i8, back: i8, round: i8) -> Sound {
    Sound::Vowel(Vowel {
        height,
        back,
        round,
    })
}

/// Shorthand for tables: voiceless, not rounded.
pub(super) const fn made(place: Place, manner: Manner) -> Consonant {
    Consonant {
        place,
        manner,
        voiced: false,
        round: false,
    }
}

impl Consonant {
    pub(super) const fn voiced(self) -> Self {
        let voiced = true;
        Self { voiced, ..self }
    }

    pub(super) const fn round(self) -> Self {
        let round = true;
        Self { round, ..self }
    }
}

/// The phones that an unknown sound may become, and how they are made. Closures, syllabic
/// consonants and gliding vowels are left out (no single letter stands for them), but for `ey` and
/// `ow`, which are English's only close-mid vowels.
const PHONES: [(Phone, Sound); 41] = {
    use Manner::{Affricate, Fricative, Glide, Nasal, SideGlide, Stop, Tap};
    use Place::{BehindRidge, Glottis, LipTeeth, Lips, Palate, Ridge, Teeth, Velum};
    use Sound::Consonant as C;
    [
        (Phone::Iy, vowel(6, 0, 0)),
        (Phone::Ih, vowel(5, 1, 0)),
        (Phone::Ey, vowel(4, 0, 0)),
        (Phone::Eh, vowel(2, 0, 0)),
        (Phone::Ae, vowel(1, 0, 0)),
        (Phone::Aa, vowel(0, 4, 0)),
        (Phone::Ah, vowel(2, 3, 0)),
        (Phone::Ao, vowel(2, 4, 2)),
        (Phone::Ow, vowel(4, 4, 2)),
        (Phone::Uh, vowel(5, 3, 1)),
        (Phone::Uw, vowel(6, 4, 2)),
        (Phone::Ux, vowel(6, 2, 2)),
        (Phone::Er, vowel(3, 2, 1)),
        (Phone::Ax, vowel(3, 2, 0)),
        (Phone::Ix, vowel(6, 2, 0)),
        (Phone::L, C(made(Ridge, SideGlide).voiced())),
        (Phone::R, C(made(BehindRidge, Glide).voiced().round())),
        (Phone::W, C(made(Lips, Glide).voiced().round())),
        (Phone::Y, C(made(Palate, Glide).voiced())),
        (Phone::Hh, C(made(Glottis, Fricative))),
        (Phone::Hv, C(made(Glottis, Fricative).voiced())),
        (Phone::M, C(made(Lips, Nasal).voiced())),
        (Phone::N, C(made(Ridge, Nasal).voiced())),
        (Phone::Ng, C(made(Velum, Nasal).voiced())),
        (Phone::S, C(made(Ridge, Fricative))),
        (Phone::Z, C(made(Ridge, Fricative).voiced())),
        (Phone::Sh, C(made(BehindRidge, Fricative).round())),
        (Phone::Zh, C(made(BehindRidge, Fricative).voiced().round())),
        (Phone::F, C(made(LipTeeth, Fricative))),
        (Phone::V, C(made(LipTeeth, Fricative).voiced())),
        (Phone::Th, C(made(Teeth, Fricative))),
        (Phone::Dh, C(made(Teeth, Fricative).voiced())),
        (Phone::Ch, C(made(BehindRidge, Affricate).round())),
        (Phone::Jh, C(made(BehindRidge, Affricate).voiced().round())),
        (Phone::B, C(made(Lips, Stop).voiced())),
        (Phone::D, C(made(Ridge, Stop).voiced())),
        (Phone::G, C(made(Velum, Stop).voiced())),
        (Phone::P, C(made(Lips, Stop))),
        (Phone::T, C(made(Ridge, Stop))),
        (Phone::K, C(made(Velum, Stop))),
        (Phone::Dx, C(made(Ridge, Tap).voiced())),
    ]
};

/// The phone made most like `sound`; of equals the first in the table.
pub(super) fn closest(sound: Sound) -> Phone {
    let ranked = PHONES
        .iter()
        .map(|(phone, made)| (apart(sound, *made), phone));
    ranked
        .min_by_key(|(distance, _)| *distance)
        .map_or(Phone::Ax, |(_, phone)| *phone)
}

/// A vowel and a consonant are further apart than any two vowels or consonants, but for glides.
const OTHER_KIND: i16 = 60;

fn apart(one: Sound, other: Sound) -> i16 {
    let by = |a: i8, b: i8| i16::from(a.abs_diff(b));
    match (one, other) {
        (Sound::Vowel(a), Sound::Vowel(b)) => {
            3 * by(a.height, b.height) + 2 * by(a.back, b.back) + 5 * by(a.round, b.round)
        }
        (Sound::Consonant(a), Sound::Consonant(b)) => {
            let nasal = (a.manner == Manner::Nasal) != (b.manner == Manner::Nasal);
            let sides = a.manner.by_the_sides() != b.manner.by_the_sides();
            by(a.place as i8, b.place as i8)
                + 2 * (a.manner.openness() - b.manner.openness()).abs()
                + if nasal { 5 } else { 0 }
                + if sides { 4 } else { 0 }
                + i16::from(a.voiced != b.voiced)
                + i16::from(a.round != b.round)
        }
        _ => OTHER_KIND,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_phone_of_the_table_is_closest_to_itself() {
        for (phone, sound) in PHONES {
            assert_eq!(closest(sound), phone);
        }
    }

    #[test]
    fn sounds_of_the_lips_stay_apart_from_all_others() {
        for (phone, sound) in PHONES {
            let lips = |p: Phone| p.is_bilabial() || p.is_labiodental() || p == Phone::W;
            let mut others = PHONES.iter().filter(|(p, _)| lips(*p) != lips(phone));
            assert!(
                others.all(|(_, other)| apart(sound, *other) > 10),
                "{phone}"
            );
        }
    }
}
