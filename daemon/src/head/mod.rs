//! `mouthpiece head …`: the head shop's commands.

mod calibrate;
mod fit;
mod info;
mod landmarks;

use crate::cli::HeadCommand;

/// Runs one of them.
pub fn run(command: &HeadCommand) -> anyhow::Result<()> {
    match command {
        HeadCommand::Info(args) => info::run(args),
        HeadCommand::Fit(args) => fit::run(args),
        HeadCommand::Landmarks(args) => landmarks::run(args),
        HeadCommand::Calibrate(args) => calibrate::run(args),
    }
}
