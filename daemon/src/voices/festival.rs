//! festival, by a script in its own Scheme: `utt.save.segs` and `utt.save.wave`.
//!
//! The segments are lines `END 100 phone` in seconds after a line `#`. They end some 30 ms before
//! the sound does, which `fit` mends. The text stands in the script as a string, where quotes and
//! backslashes are escaped; a voice is a name, so that no more than `(voice_NAME)` can be called.

use std::process::Command;

use mouthpiece_phonemes::{Alphabet, Labels, formats};

use super::error::VoiceError;
use super::{Engine, child, patience, read_labels, script};
use crate::media::wav::{self, Sound};

const NAME: &str = Engine::Festival.name();

/// Printed when all is done; festival ends with status 0 after an error too.
const DONE: &str = "mouthpiece-done";
/// Printed before the names of the voices when there is none of the wanted name.
const VOICES: &str = "mouthpiece-voices";

/// Says `text`.
pub fn speak(text: &str, voice: Option<&str>) -> Result<(Labels, Sound), VoiceError> {
    let folder = tempfile::tempdir().map_err(VoiceError::Folder)?;
    let (labels_path, sound_path) = (folder.path().join("f.lab"), folder.path().join("f.wav"));
    let no_voice = |known: String| VoiceError::NoVoice {
        engine: NAME,
        voice: voice.unwrap_or_default().to_owned(),
        known,
    };
    let choose = match voice {
        None => String::new(),
        Some(name) if is_name(name) => format!(
            "(if (not (member_string '{name} (voice.list)))\n (begin (format t \"{VOICES} %l\\n\" (voice.list)) (exit)))\n(voice_{name})\n"
        ),
        Some(_) => return Err(no_voice("names are letters, digits and _".into())),
    };
    // Quiet: the script comes by standard input, so nothing is an option.
    let script = format!(
        "{choose}(set! utt (Utterance Text {}))\n(utt.synth utt)\n(utt.save.segs utt {})\n\
         (utt.save.wave utt {} 'riff)\n(format t \"{DONE}\\n\")\n",
        string(text),
        string(&labels_path.to_string_lossy()),
        string(&sound_path.to_string_lossy()),
    );
    let mut command = Command::new(NAME);
    command.arg("--pipe");
    let outcome = child::run(NAME, command, script.as_bytes(), patience(text))
        .map_err(|t| t.or_missing(NAME, Engine::Festival.install()))?;
    let printed = String::from_utf8_lossy(&outcome.stdout);
    if let Some((_, voices)) = printed.split_once(VOICES) {
        return Err(no_voice(format!("it has {}", voices.trim())));
    }
    if !printed.contains(DONE) {
        let why = outcome.complaint();
        return Err(VoiceError::Failed { engine: NAME, why });
    }
    let text = std::fs::read_to_string(&labels_path).map_err(VoiceError::Folder)?;
    Ok((labels(&text)?, wav::read(&sound_path)?))
}

/// What it calls itself.
pub fn version() -> Option<String> {
    let line = script::first_line(NAME, "--version")?;
    Some(line.trim_start_matches("festival: ").to_owned())
}

fn is_name(name: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !name.is_empty() && name.len() <= 64 && name.chars().all(is_part)
}

/// A string of Scheme.
fn string(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Reads saved segments.
fn labels(text: &str) -> Result<Labels, VoiceError> {
    read_labels(NAME, &formats::Xlabel, Alphabet::Radio, text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::{Phone, Segment};
    use proptest::prelude::*;

    #[test]
    fn saved_segments_are_read() {
        let labels = labels("#\n0.2200 100 pau\n0.2500 100 m \n").unwrap();
        let want = [
            Segment::new(Phone::Pau, 0, 10_560),
            Segment::new(Phone::M, 10_560, 12_000),
        ];
        assert_eq!(labels.segments, want);
    }

    /// No text ends the string that it stands in.
    #[test]
    fn text_cannot_become_scheme() {
        assert_eq!(string(r#"a") (system "x\"#), r#""a\") (system \"x\\""#);
        assert!(!is_name("x) (quit"));
        assert!(is_name("kal_diphone"));
    }

    proptest! {
        #[test]
        fn nothing_saved_makes_it_panic(text in "#\n[a-z. 0-9\n-]{0,80}|\\PC{0,80}") {
            let _ = labels(&text);
        }
    }
}
