//! The phone inventory: the 61 codes of the TIMIT corpus (its `phoncode.doc`), as one enum.
//!
//! For everyone who speaks of phones: speech keeps one row of targets per phone, label readers map
//! their symbols to it. Each phone knows its code, class, IPA symbol and CMU dictionary (ARPAbet)
//! spelling. What a mouth does for a phone is not here; that is speech's table.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The classes of TIMIT's documentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// Vowels and diphthongs, full and reduced.
    Vowel,
    /// Semivowels and glides; syllabic `el` too.
    Semivowel,
    /// Nasals, syllabic ones and the nasal flap.
    Nasal,
    /// Fricatives.
    Fricative,
    /// The release of an affricate; its closure is a segment of its own.
    Affricate,
    /// The release of a stop; its closure is a segment of its own. Flap and glottal stop too.
    Stop,
    /// The closed part of a stop or affricate.
    Closure,
    /// Pauses, the silence at both ends and epenthetic silence.
    Silence,
}

/// No phone has this code.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not a TIMIT phone code; nearest: {near}", near = crate::nearest::listed(.0))]
pub struct UnknownCode(pub String);

/// One row per phone: variant, code, class, IPA, CMU symbols, example.
macro_rules! phones {
    ($($name:ident, $code:literal, $class:ident, $ipa:literal, [$($cmu:literal),*], $example:literal;)*) => {
        /// A phone of TIMIT. Written, read and shown by its code.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(try_from = "String", into = "&'static str")]
        #[repr(u8)]
        pub enum Phone {
            $(#[doc = concat!("`", $code, "`: ", $example, ".")] $name,)*
        }

        impl Phone {
            /// Every phone, in the order of [`Phone::index`].
            pub const ALL: [Self; 61] = [$(Self::$name),*];

            /// The code that TIMIT's label files use.
            pub const fn code(self) -> &'static str {
                match self { $(Self::$name => $code),* }
            }

            /// The class by TIMIT's documentation.
            pub const fn class(self) -> Class {
                match self { $(Self::$name => Class::$class),* }
            }

            /// The symbol of the International Phonetic Alphabet; empty for silence.
            pub const fn ipa(self) -> &'static str {
                match self { $(Self::$name => $ipa),* }
            }

            /// The phones of the CMU dictionary that this one is written as. Reduced vowels carry
            /// their stress mark 0, full vowels none (TIMIT does not say). Closures have none,
            /// since their release already stands for the whole stop; `q` and `epi` have none at
            /// all; pauses are `SIL`.
            pub const fn cmu(self) -> &'static [&'static str] {
                match self { $(Self::$name => &[$($cmu),*]),* }
            }

            /// The phone with this code, in TIMIT's lower case.
            pub fn from_code(code: &str) -> Option<Self> {
                match code { $($code => Some(Self::$name),)* _ => None }
            }
        }
    };
}

phones! {
    Iy, "iy", Vowel, "i", ["IY"], "as in beet";
    Ih, "ih", Vowel, "ɪ", ["IH"], "as in bit";
    Eh, "eh", Vowel, "ɛ", ["EH"], "as in bet";
    Ey, "ey", Vowel, "eɪ", ["EY"], "as in bait";
    Ae, "ae", Vowel, "æ", ["AE"], "as in bat";
    Aa, "aa", Vowel, "ɑ", ["AA"], "as in bott";
    Aw, "aw", Vowel, "aʊ", ["AW"], "as in bout";
    Ay, "ay", Vowel, "aɪ", ["AY"], "as in bite";
    Ah, "ah", Vowel, "ʌ", ["AH"], "as in but";
    Ao, "ao", Vowel, "ɔ", ["AO"], "as in bought";
    Oy, "oy", Vowel, "ɔɪ", ["OY"], "as in boy";
    Ow, "ow", Vowel, "oʊ", ["OW"], "as in boat";
    Uh, "uh", Vowel, "ʊ", ["UH"], "as in book";
    Uw, "uw", Vowel, "u", ["UW"], "as in boot";
    Ux, "ux", Vowel, "ʉ", ["UW"], "as in toot, fronted";
    Er, "er", Vowel, "ɝ", ["ER"], "as in bird";
    Ax, "ax", Vowel, "ə", ["AH0"], "as in about";
    Ix, "ix", Vowel, "ɨ", ["IH0"], "as in debit";
    Axr, "axr", Vowel, "ɚ", ["ER0"], "as in butter";
    AxH, "ax-h", Vowel, "ə̥", ["AH0"], "as in suspect, devoiced";
    L, "l", Semivowel, "l", ["L"], "as in lay";
    R, "r", Semivowel, "ɹ", ["R"], "as in ray";
    W, "w", Semivowel, "w", ["W"], "as in way";
    Y, "y", Semivowel, "j", ["Y"], "as in yacht";
    Hh, "hh", Semivowel, "h", ["HH"], "as in hay";
    Hv, "hv", Semivowel, "ɦ", ["HH"], "as in ahead, voiced";
    El, "el", Semivowel, "l̩", ["AH0", "L"], "as in bottle, syllabic";
    M, "m", Nasal, "m", ["M"], "as in mom";
    N, "n", Nasal, "n", ["N"], "as in noon";
    Ng, "ng", Nasal, "ŋ", ["NG"], "as in sing";
    Em, "em", Nasal, "m̩", ["AH0", "M"], "as in bottom, syllabic";
    En, "en", Nasal, "n̩", ["AH0", "N"], "as in button, syllabic";
    Eng, "eng", Nasal, "ŋ̍", ["IH0", "NG"], "as in Washington, syllabic";
    Nx, "nx", Nasal, "ɾ̃", ["N"], "as in winner, flapped";
    S, "s", Fricative, "s", ["S"], "as in sea";
    Sh, "sh", Fricative, "ʃ", ["SH"], "as in she";
    Z, "z", Fricative, "z", ["Z"], "as in zone";
    Zh, "zh", Fricative, "ʒ", ["ZH"], "as in azure";
    F, "f", Fricative, "f", ["F"], "as in fin";
    Th, "th", Fricative, "θ", ["TH"], "as in thin";
    V, "v", Fricative, "v", ["V"], "as in van";
    Dh, "dh", Fricative, "ð", ["DH"], "as in then";
    Jh, "jh", Affricate, "dʒ", ["JH"], "as in joke, after `dcl`";
    Ch, "ch", Affricate, "tʃ", ["CH"], "as in choke, after `tcl`";
    B, "b", Stop, "b", ["B"], "as in bee, after `bcl`";
    D, "d", Stop, "d", ["D"], "as in day, after `dcl`";
    G, "g", Stop, "ɡ", ["G"], "as in gay, after `gcl`";
    P, "p", Stop, "p", ["P"], "as in pea, after `pcl`";
    T, "t", Stop, "t", ["T"], "as in tea, after `tcl`";
    K, "k", Stop, "k", ["K"], "as in key, after `kcl`";
    Dx, "dx", Stop, "ɾ", ["D"], "as in muddy, flapped";
    Q, "q", Stop, "ʔ", [], "glottal stop, as in some speakers' bat";
    Bcl, "bcl", Closure, "b̚", [], "closure before `b`";
    Dcl, "dcl", Closure, "d̚", [], "closure before `d` or `jh`";
    Gcl, "gcl", Closure, "ɡ̚", [], "closure before `g`";
    Pcl, "pcl", Closure, "p̚", [], "closure before `p`";
    Tcl, "tcl", Closure, "t̚", [], "closure before `t` or `ch`";
    Kcl, "kcl", Closure, "k̚", [], "closure before `k`";
    Pau, "pau", Silence, "", ["SIL"], "pause";
    Epi, "epi", Silence, "", [], "epenthetic silence, between sounds of one word";
    HSharp, "h#", Silence, "", ["SIL"], "silence at the beginning or end of an utterance";
}

impl Phone {
    /// A number below 61, for tables with one row per phone.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The lips are, or have just been, pressed together: `p b m em pcl bcl`.
    pub const fn is_bilabial(self) -> bool {
        matches!(
            self,
            Self::P | Self::B | Self::M | Self::Em | Self::Pcl | Self::Bcl
        )
    }

    /// The lower lip touches the upper teeth: `f v`.
    pub const fn is_labiodental(self) -> bool {
        matches!(self, Self::F | Self::V)
    }

    /// The closed part of a stop or affricate: `bcl dcl gcl pcl tcl kcl`.
    pub const fn is_closure(self) -> bool {
        matches!(self.class(), Class::Closure)
    }

    /// `pau`, `epi` or `h#`.
    pub const fn is_silence(self) -> bool {
        matches!(self.class(), Class::Silence)
    }

    /// Full and reduced vowels and diphthongs; syllabic consonants are not among them.
    pub const fn is_vowel(self) -> bool {
        matches!(self.class(), Class::Vowel)
    }

    /// The closure that comes before this release, for stops and affricates that have one.
    pub const fn closure(self) -> Option<Self> {
        match self {
            Self::B => Some(Self::Bcl),
            Self::D | Self::Jh => Some(Self::Dcl),
            Self::G => Some(Self::Gcl),
            Self::P => Some(Self::Pcl),
            Self::T | Self::Ch => Some(Self::Tcl),
            Self::K => Some(Self::Kcl),
            _ => None,
        }
    }
}

impl std::fmt::Display for Phone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.code())
    }
}

impl std::str::FromStr for Phone {
    type Err = UnknownCode;

    fn from_str(code: &str) -> Result<Self, UnknownCode> {
        Self::from_code(code).ok_or_else(|| UnknownCode(code.to_owned()))
    }
}

impl TryFrom<String> for Phone {
    type Error = UnknownCode;

    fn try_from(code: String) -> Result<Self, UnknownCode> {
        code.parse()
    }
}

impl From<Phone> for &'static str {
    fn from(phone: Phone) -> Self {
        phone.code()
    }
}
