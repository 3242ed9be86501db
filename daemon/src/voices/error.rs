//! What is missing or went wrong with an engine, in one sentence that says the mend.

use crate::media::wav::SoundError;

/// Why there is no speech.
#[derive(Debug, thiserror::Error)]
pub enum VoiceError {
    #[error("{what} is not installed here; install it {install}, or see `mouthpiece doctor`")]
    Missing {
        what: &'static str,
        install: &'static str,
    },
    #[error("{engine} has no voice `{voice}`; {known}")]
    NoVoice {
        engine: &'static str,
        voice: String,
        known: String,
    },
    #[error("{engine} failed: {why}")]
    Failed { engine: &'static str, why: String },
    #[error(
        "{engine} did not finish within {seconds} s and was ended; try a shorter text, or run it by itself to see what it waits for"
    )]
    Slow { engine: &'static str, seconds: u64 },
    #[error("{engine} made no sound of this text; is it in a language that the voice speaks?")]
    Speechless { engine: &'static str },
    #[error("there is nothing to say in the text of --text; give at least a word")]
    NoText,
    #[error(
        "the text is longer than {} KiB; cut it into parts",
        super::TEXT_BYTES_MAX / 1024
    )]
    TextTooLong,
    #[error("the text cannot be read from standard input: {0}")]
    Stdin(std::io::Error),
    #[error(
        "the text does not fit {sound}: pocketsphinx found no place for all its words; check that it is said there word for word, in English, with numbers spelt out"
    )]
    NoFit { sound: String },
    #[error("there is no room for a temporary file: {0}")]
    Folder(std::io::Error),
    #[error(transparent)]
    Sound(#[from] SoundError),
    #[error(transparent)]
    Interrupted(#[from] crate::interrupt::Interrupted),
}
