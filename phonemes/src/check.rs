//! What is odd about labels that can be used all the same.
//!
//! For `mouthpiece labels` and whoever wonders why a mouth moves late: gaps, missing silence,
//! overlapping words, labels that do not fit their sound. Each kind is told once, with its count,
//! so that a strange file does not flood a terminal. Nothing here is an error and nothing is
//! changed; readers refuse what cannot be used.

use std::fmt;

use crate::{Labels, Phone, TICK_RATE};

/// Labels may outlast their sound by this much unremarked: engines round their times, flite by 5 ms.
const BEYOND_SOUND_TICKS: i64 = TICK_RATE / 100;

/// Sound may go on after the last label for this long unremarked, as it does in TIMIT.
const SHORT_OF_SOUND_TICKS: i64 = TICK_RATE / 2;

/// Something odd. Times are ticks, labels are counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// The first phone starts late.
    LateStart {
        /// Where it starts.
        start: i64,
    },
    /// The utterance begins with a sound: the mouth has no time to get there.
    BeginsWith(Phone),
    /// The utterance ends with a sound: the mouth is left as it is, or the file is cut off.
    EndsWith(Phone),
    /// Time between phones that no label covers.
    Gaps {
        /// How many.
        count: usize,
        /// The label after which the first is.
        after: usize,
        /// Where the first begins.
        start: i64,
        /// Its length.
        ticks: i64,
    },
    /// Words that share time with the one before them.
    WordsOverlap {
        /// How many.
        count: usize,
        /// The first of them.
        word: usize,
        /// How long it shares.
        ticks: i64,
    },
    /// Labels go on after the sound.
    BeyondSound {
        /// For how long.
        ticks: i64,
    },
    /// The sound goes on, by more than a pause, after the labels.
    ShortOfSound {
        /// For how long.
        ticks: i64,
    },
}

/// What is odd about `labels`, and about their fit to a sound of `sound` ticks where that is known.
pub fn check(labels: &Labels, sound: Option<i64>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if let (Some(first), Some(last)) = (labels.segments.first(), labels.segments.last()) {
        if first.start > 0 {
            let start = first.start;
            warnings.push(Warning::LateStart { start });
        }
        if !first.phone.is_silence() {
            warnings.push(Warning::BeginsWith(first.phone));
        }
        if !last.phone.is_silence() {
            warnings.push(Warning::EndsWith(last.phone));
        }
    }
    warnings.extend(gaps(labels));
    warnings.extend(overlaps(labels));
    if let Some(sound) = sound {
        let ticks = labels.end() - sound;
        if ticks > BEYOND_SOUND_TICKS {
            warnings.push(Warning::BeyondSound { ticks });
        } else if -ticks > SHORT_OF_SOUND_TICKS {
            warnings.push(Warning::ShortOfSound { ticks: -ticks });
        }
    }
    warnings
}

fn gaps(labels: &Labels) -> Option<Warning> {
    let pairs = labels.segments.windows(2).enumerate();
    let mut found = pairs.filter_map(|(index, pair)| {
        let ticks = pair[1].start - pair[0].end;
        (ticks > 0).then_some((index + 1, pair[0].end, ticks))
    });
    let (after, start, ticks) = found.next()?;
    let count = 1 + found.count();
    Some(Warning::Gaps {
        count,
        after,
        start,
        ticks,
    })
}

fn overlaps(labels: &Labels) -> Option<Warning> {
    let pairs = labels.words.windows(2).enumerate();
    let mut found = pairs.filter_map(|(index, pair)| {
        let ticks = pair[0].end.min(pair[1].end) - pair[1].start;
        (ticks > 0).then_some((index + 2, ticks))
    });
    let (word, ticks) = found.next()?;
    let count = 1 + found.count();
    Some(Warning::WordsOverlap { count, word, ticks })
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::LateStart { start } => {
                write!(f, "the first phone starts at {}, not at 0", Ms(start))
            }
            Self::BeginsWith(phone) => {
                write!(
                    f,
                    "begins with `{phone}`; silence (`h#`) first lets the mouth get there"
                )
            }
            Self::EndsWith(phone) => {
                write!(
                    f,
                    "ends with `{phone}`, not with silence (`h#`); it may have been cut off"
                )
            }
            Self::Gaps {
                count,
                after,
                start,
                ticks,
            } => write!(
                f,
                "no label covers {} after phone {after}, at {} (gaps in all: {count})",
                Ms(ticks),
                Ms(start)
            ),
            Self::WordsOverlap { count, word, ticks } => write!(
                f,
                "word {word} begins {} before the one before it ends (overlaps in all: {count})",
                Ms(ticks)
            ),
            Self::BeyondSound { ticks } => {
                write!(f, "the labels go on for {} after the sound", Ms(ticks))
            }
            Self::ShortOfSound { ticks } => {
                write!(f, "the sound goes on for {} after the labels", Ms(ticks))
            }
        }
    }
}

/// Ticks shown as milliseconds.
struct Ms(i64);

impl fmt::Display for Ms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tenths = (self.0 * 10_000 + TICK_RATE / 2).div_euclid(TICK_RATE);
        write!(f, "{}.{} ms", tenths / 10, tenths % 10)
    }
}
