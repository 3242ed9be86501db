//! flite, by its command line: `-psdur` prints `phone:END` in seconds for each phone.
//!
//! A text given by `-t` is one utterance to it, so times run through; were it to print a second
//! line, that would start at 0 again and is put behind the first. A voice that it does not know it
//! replaces by another without a word, so we ask first. Its stops are one label for closure and
//! release, which speech parts; its last pause is `fit`'s concern.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use mouthpiece_phonemes::{Alphabet, Labels, formats};

use super::error::VoiceError;
use super::{Engine, child, patience, read_labels, script};
use crate::media::wav::{self, Sound};

const NAME: &str = Engine::Flite.name();

/// The best of the voices that are built in; `kal`, its own default, has 8 kHz.
const BEST_VOICE: &str = "slt";

/// How long listing voices may take.
const LIST_PATIENCE: Duration = Duration::from_secs(10);

/// Says `text`.
pub fn speak(text: &str, voice: Option<&str>) -> Result<(Labels, Sound), VoiceError> {
    let known = voices()?;
    let voice = match voice {
        Some(voice) if known.iter().any(|k| k == voice) || Path::new(voice).is_file() => {
            Some(voice)
        }
        Some(voice) => {
            return Err(VoiceError::NoVoice {
                engine: NAME,
                voice: voice.to_owned(),
                known: format!("it has {}, or give a .flitevox file", known.join(", ")),
            });
        }
        None => known.iter().map(String::as_str).find(|k| *k == BEST_VOICE),
    };
    let folder = tempfile::tempdir().map_err(VoiceError::Folder)?;
    let path = folder.path().join("flite.wav");
    let mut command = Command::new(NAME);
    if let Some(voice) = voice {
        command.args(["-voice", voice]);
    }
    command.args(["-psdur", "-t", text, "-o"]).arg(&path);
    let outcome = child::run(NAME, command, b"", patience(text)).map_err(missing)?;
    if !outcome.status.success() || !path.exists() {
        let why = outcome.complaint();
        return Err(VoiceError::Failed { engine: NAME, why });
    }
    let printed = String::from_utf8_lossy(&outcome.stdout);
    Ok((labels(&printed)?, wav::read(&path)?))
}

/// What it calls itself.
pub fn version() -> Option<String> {
    script::first_line(NAME, "--version")?;
    Some(format!("voices {}", voices().ok()?.join(", ")))
}

fn missing(trouble: child::Trouble) -> VoiceError {
    trouble.or_missing(NAME, Engine::Flite.install())
}

/// `Voices available: kal awb_time kal16 awb rms slt`.
fn voices() -> Result<Vec<String>, VoiceError> {
    let mut command = Command::new(NAME);
    command.arg("-lv");
    let outcome = child::run(NAME, command, b"", LIST_PATIENCE).map_err(missing)?;
    let printed = String::from_utf8_lossy(&outcome.stdout);
    let names = printed.split_once(':').map_or("", |(_, names)| names);
    Ok(names.split_whitespace().map(str::to_owned).collect())
}

/// Reads what `-psdur` printed.
fn labels(printed: &str) -> Result<Labels, VoiceError> {
    read_labels(NAME, &formats::Flite, Alphabet::Radio, printed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::{Phone, Segment};
    use proptest::prelude::*;

    #[test]
    fn ends_become_segments_and_a_second_line_goes_on() {
        let labels = labels("pau:0.1 b:0.15 pau:0.2 \naa:0.25 pau:0.300\n").unwrap();
        let want = [
            Segment::new(Phone::Pau, 0, 4800),
            Segment::new(Phone::B, 4800, 7200),
            Segment::new(Phone::Pau, 7200, 9600),
            Segment::new(Phone::Aa, 9600, 21_600),
            Segment::new(Phone::Pau, 21_600, 24_000),
        ];
        assert_eq!(labels.segments, want);
    }

    proptest! {
        #[test]
        fn nothing_printed_makes_it_panic(text in "[a-z:. 0-9\n-]{0,80}|\\PC{0,80}") {
            let _ = labels(&text);
        }
    }
}
