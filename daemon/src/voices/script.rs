//! Runs our own small Python scripts, and asks Python which engines there are.
//!
//! Python because that is what two of the engines are (Piper, pocketsphinx), and because the third,
//! espeak-ng, tells its phones' times only to programs that load its library: this crate forbids
//! the unsafe code which that takes, and a fault in the library ends a child instead of the face.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use super::child::{self, Outcome, Trouble};
use super::error::VoiceError;
use super::{Engine, align, festival, flite};

/// What every script begins with.
const PRELUDE: &str = include_str!("prelude.py");

/// Status of a script whose engine is not there.
const MISSING: i32 = 3;
/// Status of a script that does not know the voice; it says on stderr which there are.
const NO_VOICE: i32 = 4;

/// How long looking for engines may take.
const LOOK_PATIENCE: Duration = Duration::from_secs(20);

/// The program that runs scripts.
const PYTHON: &str = "python3";

/// A script and whose it is.
#[derive(Clone, Copy, Debug)]
pub struct Script {
    /// Its text.
    pub code: &'static str,
    /// What messages call the engine.
    pub engine: &'static str,
    /// How to get it.
    pub install: &'static str,
}

impl Script {
    /// Runs it on `input`; it is told the path of a file in which sound comes or goes, and a voice.
    pub fn run(
        self,
        sound: &Path,
        voice: Option<&str>,
        input: &[u8],
        patience: Duration,
    ) -> Result<Outcome, VoiceError> {
        let missing = VoiceError::Missing {
            what: self.engine,
            install: self.install,
        };
        let mut command = python(self.code);
        command.arg(sound).arg(voice.unwrap_or_default());
        let outcome = child::run(self.engine, command, input, patience)
            .map_err(|t| t.or_missing(self.engine, self.install))?;
        match outcome.status.code() {
            Some(0) => Ok(outcome),
            Some(MISSING) => Err(missing),
            Some(NO_VOICE) => Err(VoiceError::NoVoice {
                engine: self.engine,
                voice: voice.unwrap_or_default().to_owned(),
                known: outcome.complaint(),
            }),
            Some(_) => Err(VoiceError::Failed {
                engine: self.engine,
                why: outcome.complaint(),
            }),
            None => Err(VoiceError::Failed {
                engine: self.engine,
                why: format!("it crashed ({})", outcome.status),
            }),
        }
    }
}

fn python(code: &str) -> Command {
    let mut command = Command::new(PYTHON);
    command.args(["-c", &format!("{PRELUDE}\n{code}")]);
    command
}

/// An engine, and what there is of it.
#[derive(Clone, Debug)]
pub struct Found {
    pub name: &'static str,
    /// Its version and voices in words, or none where it is missing.
    pub what: Option<String>,
    /// How to get it.
    pub install: &'static str,
}

/// Looks for every engine, for `doctor`.
pub fn found() -> Vec<Found> {
    let printed = child::run(
        "python3",
        python(include_str!("found.py")),
        b"",
        LOOK_PATIENCE,
    )
    .map(|outcome| String::from_utf8_lossy(&outcome.stdout).into_owned())
    .unwrap_or_default();
    let by_python = |name: &str| {
        let line = printed
            .lines()
            .find_map(|line| line.strip_prefix(name)?.strip_prefix('\t'));
        line.map(str::to_owned)
    };
    let engine = |engine: Engine| Found {
        name: engine.name(),
        what: match engine {
            Engine::Flite => flite::version(),
            Engine::Festival => festival::version(),
            Engine::EspeakNg | Engine::Piper => by_python(engine.name()),
        },
        install: engine.install(),
    };
    let aligner = Found {
        name: align::NAME,
        what: by_python(align::NAME),
        install: align::INSTALL,
    };
    Engine::ALL
        .into_iter()
        .map(engine)
        .chain([aligner])
        .collect()
}

/// The first line that a program prints about itself, none where there is no such program.
pub fn first_line(program: &'static str, argument: &str) -> Option<String> {
    let mut command = Command::new(program);
    command.arg(argument);
    let outcome = match child::run(program, command, b"", LOOK_PATIENCE) {
        Ok(outcome) => outcome,
        Err(Trouble::Absent | Trouble::Error(_)) => return None,
    };
    let text = String::from_utf8_lossy(&outcome.stdout);
    Some(text.lines().next().unwrap_or_default().trim().to_owned())
}
