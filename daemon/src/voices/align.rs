//! Finds the phones of a text in a recording of it: forced alignment, by pocketsphinx.
//!
//! For `--audio` with `--text` and no labels. Its Python package brings an English model. Times are
//! multiples of 10 ms and up to 40 ms off, rarely more; `refine` then puts all but one of the demo's
//! nine closures of the lips within 5 ms of its labels. Words that its dictionary lacks are said by
//! ours.
//!
//! What it gets wrong, and what the script does about it: the search may end before the last words,
//! without an error, so the words are counted; it may fail to end at all, which a silence at the
//! beginning, wider beams (but not too wide) and silence around the sound mend, tried in turn.

use std::path::Path;

use anyhow::Context as _;
use mouthpiece_phonemes::{Alphabet, Labels, Note, Notes, TICK_RATE, alphabet};

use super::error::VoiceError;
use super::script::Script;
use super::{Spoken, clean, fit, patience, refine, rows};
use crate::live::Resample;
use crate::media::wav::Sound;

/// What it is called, and its package.
pub const NAME: &str = "pocketsphinx";

/// How to get it.
pub const INSTALL: &str = "in the Python that `python3` starts (pip install pocketsphinx, in a virtual environment where \
     Debian asks for one)";

const SCRIPT: Script = Script {
    code: include_str!("align.py"),
    engine: NAME,
    install: INSTALL,
};

/// The rate of its model.
const MODEL_HZ: u32 = 16_000;

/// How far its boundaries may be off: 40 ms, but for a few.
const REACH_TICKS: i64 = 40 * TICK_RATE / 1000;

/// The labels of `text` as it is said in `sound`, which messages call `name`.
pub fn align(text: &str, sound: Sound, name: &str) -> Result<Spoken, VoiceError> {
    let text = clean(text)?;
    let failed = |why: String| VoiceError::Failed { engine: NAME, why };
    let words = words(&text);
    let folder = tempfile::tempdir().map_err(VoiceError::Folder)?;
    let path = folder.path().join("sound.raw");
    write(&path, &sound).map_err(|e| failed(format!("{e:#}")))?;
    let lines: String = words
        .iter()
        .map(|word| format!("{word}\t{}\n", said(word)))
        .collect();
    // Aligning goes by the length of the sound too, some twenty times as fast as it.
    let patience = patience(&text)
        + std::time::Duration::from_secs(sound.frames.len() as u64 / TICK_RATE as u64);
    let outcome = SCRIPT
        .run(&path, None, lines.as_bytes(), patience)
        .map_err(|error| match error {
            VoiceError::NoVoice { .. } => VoiceError::NoFit {
                sound: name.to_owned(),
            },
            other => other,
        })?;
    let (rows, said) = rows::read(&outcome.stdout).map_err(failed)?;
    let (mut segments, mut notes) = (Vec::new(), Notes::default());
    for note in said {
        notes.push(Note::new(format!("aligned by {NAME}: {note}")));
    }
    for row in rows {
        let (symbol, start, end) = (&row.symbol, row.start, row.end);
        let spoken = alphabet::segments(Alphabet::Arpabet, symbol, start, end, &mut segments);
        notes.symbol(Alphabet::Arpabet, symbol, spoken, None);
    }
    fit::fit(&mut segments, sound.frames.len() as i64);
    refine::refine(&mut segments, &sound.frames, REACH_TICKS);
    Ok(Spoken {
        name: name.to_owned(),
        labels: Labels {
            segments,
            notes: notes.finish(),
            ..Labels::default()
        },
        sound,
    })
}

/// Words as dictionaries spell them: lower case, without punctuation but for apostrophes.
fn words(text: &str) -> Vec<String> {
    let text = text.to_lowercase().replace('’', "'");
    let is_letter = |c: char| c.is_alphanumeric() || c == '\'';
    let words = text
        .split(|c| !is_letter(c))
        .map(|word| word.trim_matches('\''));
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

/// How a word may be said, as the CMU dictionary writes phones but without stress.
fn said(word: &str) -> String {
    let phones = mouthpiece_phonemes::pronounce(word);
    let spelt = phones.iter().flat_map(|(phone, _)| phone.cmu());
    let bare = spelt.map(|p| p.trim_end_matches(|c: char| c.is_ascii_digit()));
    bare.collect::<Vec<_>>().join(" ")
}

/// Writes raw 16-bit samples at the model's rate.
fn write(path: &Path, sound: &Sound) -> anyhow::Result<()> {
    let mut out = Vec::new();
    let mut resample = Resample::new(TICK_RATE as u32, MODEL_HZ)?;
    resample.push(&sound.frames, &mut out)?;
    resample.finish(&mut out)?;
    let bytes: Vec<u8> = out
        .iter()
        .flat_map(|x| ((x * 32_767.0).round().clamp(-32_768.0, 32_767.0) as i16).to_le_bytes())
        .collect();
    std::fs::write(path, bytes).context("its sound cannot be written")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_dictionaries_spell_them() {
        let words = words("“Don’t,” said Bob—twice: it's 'fine'.");
        assert_eq!(words, ["don't", "said", "bob", "twice", "it's", "fine"]);
    }
}
