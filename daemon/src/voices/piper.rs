//! Piper, by its Python package: how long its network spent on each symbol, exact to the sample in sum.
//!
//! Symbols are code points of IPA, so marks that sound nothing have time of their own, and the
//! halves of a diphthong come apart: the reader of such alignments puts that right. They must be asked for
//! twice, and need Piper's extra `alignment`; without them its script says so instead of guessing.

use mouthpiece_phonemes::{Alphabet, Labels, formats};

use super::error::VoiceError;
use super::script::Script;
use super::{Engine, patience, read_labels};
use crate::media::wav::{self, Sound};

const SCRIPT: Script = Script {
    code: include_str!("piper.py"),
    engine: Engine::Piper.name(),
    install: Engine::Piper.install(),
};

/// Says `text`.
pub fn speak(text: &str, voice: Option<&str>) -> Result<(Labels, Sound), VoiceError> {
    let folder = tempfile::tempdir().map_err(VoiceError::Folder)?;
    let path = folder.path().join("piper.wav");
    let outcome = SCRIPT.run(&path, voice, text.as_bytes(), patience(text))?;
    let printed = String::from_utf8_lossy(&outcome.stdout);
    Ok((labels(&printed)?, wav::read(&path)?))
}

/// Reads what our script printed.
fn labels(printed: &str) -> Result<Labels, VoiceError> {
    read_labels(SCRIPT.engine, &formats::Piper, Alphabet::Ipa, printed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::{Phone, Stress};

    /// "Buy me": the mark's time goes to the diphthong, which is one phone with stress; a short space is
    /// no pause, a long one is.
    #[test]
    fn marks_and_halves_are_joined_and_pauses_kept() {
        let printed = r#"[[0.0, 0.1, "^"], [0.1, 0.15, "b"], [0.15, 0.16, "ˈ"], [0.16, 0.25, "a"],
            [0.25, 0.3, "ɪ"], [0.3, 0.34, " "], [0.34, 0.4, "m"], [0.4, 0.5, " "], [0.5, 0.6, "m"]]"#;
        let labels = labels(printed).unwrap();
        let phones: Vec<_> = labels.segments.iter().map(|s| s.phone).collect();
        assert_eq!(phones[1..4], [Phone::B, Phone::Ay, Phone::M]);
        assert!(phones[4].is_silence() && phones[5] == Phone::M);
        assert_eq!(labels.segments[2].stress, Some(Stress::Primary));
        assert!(labels.notes.is_empty(), "{:?}", labels.notes);
    }

    #[test]
    fn what_is_no_alignment_is_the_engines_failure() {
        assert!(labels("Traceback").is_err());
        assert_eq!(labels("[]").unwrap().segments, []);
    }
}
