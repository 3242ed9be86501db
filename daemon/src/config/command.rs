//! `mouthpiece config`: is the file right, and what can be in it.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use mouthpiece_rig::Head;

use super::{Config, file, print};
use crate::cli::{ConfigArgs, ConfigCommand};
use crate::media::output;

/// `mouthpiece config check` and `print`.
pub fn run(command: &ConfigCommand) -> Result<()> {
    match command {
        ConfigCommand::Check(args) => check(args),
        ConfigCommand::Print(args) => {
            let config = match named(args) {
                Some(path) => file::read(&path)?,
                None => Config::default(),
            };
            output::print(&print::toml(&config)?)
        }
    }
}

/// The file that is named, or the user's where it is there.
fn named(args: &ConfigArgs) -> Option<PathBuf> {
    args.file.clone().or_else(file::user_default)
}

fn check(args: &ConfigArgs) -> Result<()> {
    let Some(path) = named(args) else {
        bail!(
            "there is no configuration file to check: name one, or write $XDG_CONFIG_HOME/mouthpiece/config.toml \
             (mouthpiece config print shows all keys)"
        );
    };
    let config = file::read(&path)?;
    // What it names must be readable, too.
    let named = || format!("{}", path.display());
    config.look.view().with_context(named)?;
    if let Some(head) = &config.look.head {
        Head::load(head).context("look.head").with_context(named)?;
    }
    output::print(&format!("{}: as it should be\n", path.display()))
}
