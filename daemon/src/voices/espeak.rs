//! espeak-ng, by the phone events of its library: exact starts in samples, the last end is the sound's.
//!
//! The command line tells no times without MBROLA's voices, so a script in Python loads the library
//! (see `script`). Phones come as IPA, which all of its languages share. Voiceless stops and
//! affricates, and many voiced ones, are stamped at their burst, after 20 to 60 ms of digital
//! silence that looks like the end of the phone before: `closure` puts that right.

use mouthpiece_phonemes::{Alphabet, Labels, Notes, alphabet};

use super::error::VoiceError;
use super::script::Script;
use super::{Engine, closure, patience, rows};
use crate::media::wav::{self, Sound};

const SCRIPT: Script = Script {
    code: include_str!("espeak.py"),
    engine: Engine::EspeakNg.name(),
    install: Engine::EspeakNg.install(),
};

/// Says `text`.
pub fn speak(text: &str, voice: Option<&str>) -> Result<(Labels, Sound), VoiceError> {
    let folder = tempfile::tempdir().map_err(VoiceError::Folder)?;
    let path = folder.path().join("espeak-ng.wav");
    let outcome = SCRIPT.run(&path, voice, text.as_bytes(), patience(text))?;
    let (rows, _) = rows::read(&outcome.stdout).map_err(|why| VoiceError::Failed {
        engine: SCRIPT.engine,
        why,
    })?;
    let sound = wav::read(&path)?;
    let mut segments = Vec::new();
    let mut notes = Notes::default();
    for row in rows {
        let spoken = alphabet::segments(
            Alphabet::Ipa,
            &row.symbol,
            row.start,
            row.end,
            &mut segments,
        );
        notes.symbol(Alphabet::Ipa, &row.symbol, spoken, None);
    }
    let segments = closure::split(&segments, &sound.frames);
    let labels = Labels {
        segments,
        notes: notes.finish(),
        ..Labels::default()
    };
    Ok((labels, sound))
}
