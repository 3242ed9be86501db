//! The `mouthpiece` binary: reads the command line, does the work, says what went wrong.
//!
//! | module | does |
//! |---|---|
//! | [`cli`] | the words of the command line |
//! | [`media`] | sound and video files |

#![forbid(unsafe_code)]
#![allow(
    unreachable_pub,
    reason = "nothing is exported from a binary; pub means: for the other modules"
)]

mod cli;
mod log;
mod media;

use std::process::ExitCode;

use clap::Parser as _;

use cli::{Cli, Command};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    log::start(cli.verbose, matches!(cli.command, Command::Run(_)));
    match dispatch(&cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("mouthpiece: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn dispatch(command: &Command) -> anyhow::Result<()> {
    anyhow::bail!("{command:?} is not in this build")
}

/// Help and version go to standard output with status 0; wrong usage to stderr with status 2.
fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nobody is left to tell when standard output is closed.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    let text = error.to_string();
    eprint!(
        "mouthpiece: {}",
        text.strip_prefix("error: ").unwrap_or(&text)
    );
    ExitCode::from(2)
}
