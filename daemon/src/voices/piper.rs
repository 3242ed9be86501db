//! Piper, by its Python package: how long its network spent on each symbol, exact to the sample in sum.
//!
//! Symbols are code points of IPA, so marks that sound nothing have time of their own, and the
//! halves of a diphthong come apart: [`alphabet::join`] puts that right. Alignments must be asked for
//! twice, and need Piper's extra `alignment`; without them its script says so instead of guessing.

use mouthpiece_phonemes::alphabet::{self, Alphabet, Timed};
use mouthpiece_phonemes::{Labels, Notes};

use super::error::VoiceError;
use super::rows::Row;
use super::script::Script;
use super::{Engine, patience, rows};
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
    let (rows, _) = rows::read(&outcome.stdout).map_err(|why| VoiceError::Failed {
        engine: SCRIPT.engine,
        why,
    })?;
    Ok((labels(&rows), wav::read(&path)?))
}

/// Makes phones of symbols.
fn labels(rows: &[Row]) -> Labels {
    let symbols: Vec<Timed<'_>> = rows
        .iter()
        .map(|row| Timed {
            symbol: &row.symbol,
            start: row.start,
            end: row.end,
        })
        .collect();
    let mut segments = Vec::new();
    let mut notes = Notes::default();
    alphabet::join(Alphabet::Ipa, &symbols, &mut segments, &mut notes);
    Labels {
        segments,
        notes: notes.finish(),
        ..Labels::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::{Phone, Stress};
    use proptest::prelude::*;

    fn rows(symbols: &[&str]) -> Vec<Row> {
        let row = |(i, symbol): (i64, &&str)| Row {
            symbol: (*symbol).to_owned(),
            start: i * 100,
            end: i * 100 + 100,
        };
        (0..).zip(symbols).map(row).collect()
    }

    /// "Buy": the mark's time goes to the diphthong, which is one phone with stress.
    #[test]
    fn marks_and_halves_are_joined() {
        let labels = labels(&rows(&["^", "b", "ˈ", "a", "ɪ", " ", "m", ".", "$"]));
        let phones: Vec<_> = labels.segments.iter().map(|s| s.phone).collect();
        assert_eq!(phones[1..4], [Phone::B, Phone::Ay, Phone::M]);
        assert_eq!(labels.segments[2].stress, Some(Stress::Primary));
        assert!(labels.notes.is_empty(), "{:?}", labels.notes);
    }

    proptest! {
        /// No order of symbols loses time between the first phone and the last.
        #[test]
        fn labels_never_overlap(symbols in prop::collection::vec(
            prop::sample::select(vec!["^", "$", " ", "ˈ", "ː", "a", "ɪ", "b", "t", "ʃ", ",", "\u{303}", "☃"]),
            0..30,
        )) {
            let labels = labels(&rows(&symbols));
            for pair in labels.segments.windows(2) {
                prop_assert!(pair[0].end <= pair[1].start, "{:?}", pair);
            }
        }
    }
}
