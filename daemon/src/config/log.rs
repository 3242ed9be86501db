//! `[log]`: what is said on stderr.

use clap::ValueEnum;

use super::section::section;

section! {
    /// What is said on stderr. -v and RUST_LOG go first.
    pub struct Log {
        /// How much: "error", "warn", "info" or "debug".
        level: Level = Level::Info,
        /// A JSON object a line instead of text.
        json: bool = false => at_start,
    }
}

/// How much is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Level {
    Error,
    Warn,
    Info,
    Debug,
}
