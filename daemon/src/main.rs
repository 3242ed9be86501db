//! The `mouthpiece` binary: reads the command line, does the work, says what went wrong.
//!
//! | module | does |
//! |---|---|
//! | [`cli`] | the words of the command line |
//! | [`config`] | the configuration file under it, and `mouthpiece config …` |
//! | [`input`] | labels and sound, from files or the demo |
//! | [`pipeline`] | labels to key frames, offline: what export, curves and still share |
//! | [`export`], [`curves`], [`labels`], [`still`], [`bench`](mod@bench), [`doctor`] | the commands of these names |
//! | [`avatar`] | curves for other avatars: ARKit, visemes, FAPs |
//! | [`head`] | the head shop: `mouthpiece head …` |
//! | [`health`] | how the live face is, over HTTP |
//! | [`live`] | `run` and `say`: window, sound, sockets and the clock |
//! | [`voices`] | speech engines of this machine, and labels for recordings |
//! | [`media`] | sound and video files |
//! | [`interrupt`] | Ctrl-C, for work that ends by itself |
//! | [`memory`] | how much of it this process holds |
//! | [`log`] | where log lines go |

#![forbid(unsafe_code)]
#![allow(
    unreachable_pub,
    reason = "nothing is exported from a binary; pub means: for the other modules"
)]

mod avatar;
mod bench;
mod cli;
mod config;
mod curves;
mod dictionary;
mod doctor;
mod export;
mod head;
mod health;
mod input;
mod interrupt;
mod labels;
mod live;
mod log;
mod media;
mod memory;
mod pipeline;
mod still;
mod voices;

use std::process::ExitCode;

use clap::Parser as _;

use cli::{Cli, Command};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let wanted = wanted_log(&cli);
    log::start(wanted);
    if !wanted.live {
        interrupt::watch();
    }
    match dispatch(&cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if wanted.json => {
            tracing::error!("{}", sentence(&error));
            status(&error)
        }
        Err(error) => {
            eprintln!("mouthpiece: {}", sentence(&error));
            status(&error)
        }
    }
}

/// What the flags and a live face's configuration say of the log.
fn wanted_log(cli: &Cli) -> log::Wanted {
    let stage = match &cli.command {
        Command::Run(args) => Some(&args.stage),
        Command::Say(args) => Some(&args.stage),
        Command::SyncTest(args) => Some(&args.stage),
        _ => None,
    };
    // What is wrong with the configuration is said by the command itself, in the log that is set up here.
    let configured = stage.map(|stage| {
        config::Source::new(stage, &cli::WireArgs::default())
            .load()
            .unwrap_or_default()
            .log
    });
    log::Wanted::new(cli.verbose, cli.log_json, configured.as_ref())
}

/// The exit status that users script against.
fn status(error: &anyhow::Error) -> ExitCode {
    if error.is::<interrupt::Interrupted>() {
        ExitCode::from(interrupt::STATUS)
    } else if error.is::<cli::Usage>() {
        ExitCode::from(2)
    } else {
        ExitCode::FAILURE
    }
}

/// An error with its causes, without those that it has quoted already, in one line: drivers' own
/// words come in many.
fn sentence(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    if text.contains('\n') {
        text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    }
    text
}

fn dispatch(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Export(args) => export::run(args),
        Command::Curves(args) => curves::run(args),
        Command::Labels(args) => labels::run(args),
        Command::Still(args) => still::run(args),
        Command::Head(command) => head::run(command),
        Command::Bench(args) => bench::run(args),
        Command::Doctor(args) => doctor::run(args),
        Command::Config(command) => config::run(command),
        Command::Run(args) => live::run(args),
        Command::Say(args) => live::say(args),
        Command::SyncTest(args) => live::sync_test(&args.stage, args.seconds),
    }
}

/// Help and version go to standard output with status 0; wrong usage to stderr with status 2.
fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nobody is left to tell when standard output is closed.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    let text = error.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    eprint!("mouthpiece: {text}");
    ExitCode::from(2)
}
