//! What the symbols of other phonetic alphabets are among TIMIT's 61 phones.
//!
//! For readers of label formats and for engines that name phones in their own way. Every symbol
//! becomes one to four phones: known ones exactly, by tables; any other by how and where it is
//! made, as the nearest phone. Nothing here fails. A stop or affricate of another alphabet is one
//! phone, its release: speech adds the closure that only TIMIT labels apart.
//!
//! | module | holds |
//! |---|---|
//! | `codes` | TIMIT, ARPAbet and flite's and festival's radio codes; marks of silence |
//! | `ipa` | the International Phonetic Alphabet |
//! | `letters` | its letters |
//! | `xsampa` | X-SAMPA, by the IPA that it stands for |
//! | `espeak` | espeak-ng's mnemonics, in the same way |
//! | `features` | how sounds are made, and which phone is closest |
//! | `join` | segments of labels, one by one or as a stream of letters |
//! | `guess` | which alphabet a list of symbols is in |

mod codes;
mod espeak;
mod features;
mod guess;
mod ipa;
mod join;
mod letters;
mod xsampa;

use std::ops::Deref;
use std::str::FromStr;

use thiserror::Error;

pub use join::{Timed, join, segments};

use crate::{Phone, Stress};

/// A way to write phones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Alphabet {
    /// The 61 codes of TIMIT.
    Timit,
    /// ARPAbet as the CMU dictionary and Montreal's aligner write it: `AH0`, `B`.
    Arpabet,
    /// Lower-case codes of flite, festival and HTS: `ax`, `pau`.
    Radio,
    /// The International Phonetic Alphabet.
    Ipa,
    /// X-SAMPA, and the SAMPA of MBROLA's voices.
    XSampa,
    /// The mnemonics of espeak-ng's English.
    Espeak,
}

/// The user asked for an alphabet that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is no alphabet; give one of {known}", known = known())]
pub struct UnknownAlphabet(pub String);

fn known() -> String {
    let names = Alphabet::ALL.map(|alphabet| format!("`{}`", alphabet.name()));
    names.join(", ")
}

/// Most phones that one symbol becomes: `aɪɚ` has two, no alphabet's symbol more than three.
const PHONES_MAX: usize = 4;

/// One to four phones, in place.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct PhoneList {
    phones: [Phone; PHONES_MAX],
    count: u8,
}

impl PhoneList {
    /// A single phone.
    pub const fn one(phone: Phone) -> Self {
        Self {
            phones: [phone; PHONES_MAX],
            count: 1,
        }
    }

    /// The first four of `phones`; `None` where there is none.
    pub fn of(phones: &[Phone]) -> Option<Self> {
        let mut list = Self::one(*phones.first()?);
        for phone in phones.iter().skip(1) {
            list.push(*phone);
        }
        Some(list)
    }

    /// Adds one, unless there are four; whether it did.
    fn push(&mut self, phone: Phone) -> bool {
        let free = self.phones.get_mut(usize::from(self.count));
        let fits = free.is_some();
        if let Some(place) = free {
            *place = phone;
            self.count += 1;
        }
        fits
    }
}

impl Deref for PhoneList {
    type Target = [Phone];

    fn deref(&self) -> &[Phone] {
        let count = usize::from(self.count).min(PHONES_MAX);
        &self.phones[..count]
    }
}

impl std::fmt::Debug for PhoneList {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

/// What a symbol stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Spoken {
    /// The phones, one after the other.
    pub phones: PhoneList,
    /// Stress, where the symbol carries it.
    pub stress: Option<Stress>,
    /// False where the symbol is unknown or foreign and its phones are only the nearest.
    pub exact: bool,
}

impl Spoken {
    const fn exactly(phone: Phone) -> Self {
        Self {
            phones: PhoneList::one(phone),
            stress: None,
            exact: true,
        }
    }
}

impl Alphabet {
    /// Every alphabet.
    pub const ALL: [Self; 6] = [
        Self::Timit,
        Self::Arpabet,
        Self::Radio,
        Self::Ipa,
        Self::XSampa,
        Self::Espeak,
    ];

    /// The word by which users ask for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Timit => "timit",
            Self::Arpabet => "arpabet",
            Self::Radio => "radio",
            Self::Ipa => "ipa",
            Self::XSampa => "x-sampa",
            Self::Espeak => "espeak",
        }
    }

    /// What it is, for help texts and messages: a few words.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Timit => "TIMIT",
            Self::Arpabet => "ARPAbet",
            Self::Radio => "the radio codes of flite and festival",
            Self::Ipa => "the IPA",
            Self::XSampa => "X-SAMPA",
            Self::Espeak => "espeak-ng's mnemonics",
        }
    }

    /// The phones of a symbol. Never fails: what is unknown goes to the nearest phone.
    pub fn spoken(self, symbol: &str) -> Spoken {
        let symbol = symbol.trim();
        if let Some(pause) = codes::pause(symbol) {
            return pause;
        }
        let found = match self {
            Self::Timit => codes::timit(symbol),
            Self::Arpabet => codes::arpabet(symbol),
            Self::Radio => codes::radio(symbol),
            Self::Ipa => ipa::ipa(symbol),
            Self::XSampa => xsampa::xsampa(symbol),
            Self::Espeak => espeak::espeak(symbol),
        };
        found.unwrap_or_else(|| nearest(symbol))
    }

    /// The alphabet that most of the symbols fit; TIMIT where none does.
    pub fn guess<'a>(symbols: impl IntoIterator<Item = &'a str>) -> Self {
        guess::guess(symbols)
    }
}

/// What a symbol that its own alphabet does not know is like: another code, codes in a row, letters
/// by their sound; or a noise.
fn nearest(symbol: &str) -> Spoken {
    let other = || codes::timit(symbol).or_else(|| codes::arpabet(symbol));
    let found = other()
        .or_else(|| codes::spelled(symbol))
        .or_else(|| ipa::ipa(symbol));
    Spoken {
        exact: false,
        ..found.unwrap_or(Spoken::exactly(Phone::Pau))
    }
}

impl FromStr for Alphabet {
    type Err = UnknownAlphabet;

    fn from_str(name: &str) -> Result<Self, UnknownAlphabet> {
        let found = Self::ALL.into_iter().find(|a| a.name() == name);
        found.ok_or_else(|| UnknownAlphabet(name.to_owned()))
    }
}
