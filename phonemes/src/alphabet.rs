//! What the symbols of other phonetic alphabets are among TIMIT's 61 phones.
//!
//! For readers of label formats and for engines that name phones in their own way. Every symbol
//! becomes one to four phones: known ones exactly, by tables; any other by how and where it is
//! made, as the nearest phone. Nothing here fails. A stop or affricate of another alphabet is one
//! phone, its release: speech adds the closure that only TIMIT labels apart.
//!
//! | module | holds |
//! |---|---|
//! | `codes` | TIMIT, ARPAbet and flite's and festival's radio codes |

mod codes;

use std::ops::Deref;
use std::str::FromStr;

use thiserror::Error;

use crate::{Phone, Segment, Stress};

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
        let found = match self {
            Self::Timit => codes::timit(symbol),
            Self::Arpabet => codes::arpabet(symbol),
            Self::Radio => codes::radio(symbol),
            Self::Ipa | Self::XSampa | Self::Espeak => None,
        };
        found.or_else(|| codes::pause(symbol)).unwrap_or_else(|| {
            let mut phones = Phone::ALL.into_iter();
            let same = phones.find(|p| !p.ipa().is_empty() && p.ipa() == symbol);
            Spoken {
                exact: same.is_some(),
                ..Spoken::exactly(same.unwrap_or(Phone::Ax))
            }
        })
    }

    /// The alphabet that most of the symbols fit.
    pub fn guess<'a>(symbols: impl IntoIterator<Item = &'a str>) -> Self {
        let mut counts = [0_u32; Self::ALL.len()];
        for symbol in symbols {
            for (count, alphabet) in counts.iter_mut().zip(Self::ALL) {
                *count += u32::from(alphabet.spoken(symbol).exact);
            }
        }
        let best = counts.iter().max().copied().unwrap_or(0);
        let at = counts.iter().position(|c| *c == best).unwrap_or(0);
        Self::ALL[at]
    }
}

impl FromStr for Alphabet {
    type Err = UnknownAlphabet;

    fn from_str(name: &str) -> Result<Self, UnknownAlphabet> {
        let found = Self::ALL.into_iter().find(|a| a.name() == name);
        found.ok_or_else(|| UnknownAlphabet(name.to_owned()))
    }
}

/// Adds the segments of one label from `start` to `end`, whose time its phones share, and says
/// what was made of the symbol. A label too short to share goes to its first phones; one without
/// any time adds nothing.
pub fn segments(
    alphabet: Alphabet,
    symbol: &str,
    start: i64,
    end: i64,
    out: &mut Vec<Segment>,
) -> Spoken {
    let spoken = alphabet.spoken(symbol);
    let ticks = end.saturating_sub(start).max(0);
    let count = spoken.phones.len() as i64;
    let mut at = start;
    for (done, phone) in (1..).zip(spoken.phones.iter()) {
        let until = start + ticks * done / count;
        if until > at {
            out.push(Segment {
                phone: *phone,
                start: at,
                end: until,
                stress: spoken.stress,
            });
            at = until;
        }
    }
    spoken
}
