//! Words for the wire: where a daemon listens, or is found.

use std::path::PathBuf;

use clap::Args;

/// Where the daemon is. What is not said here is as the configuration file has it.
#[derive(Clone, Debug, Default, Args)]
pub struct WireArgs {
    /// Where the daemon listens: a path for a Unix socket, HOST:PORT, or ws://HOST:PORT for WebSocket;
    /// `run` takes several. `say` needs a daemon there then [default: mouthpiece.sock in
    /// $XDG_RUNTIME_DIR]
    #[arg(long, value_name = "ADDR")]
    pub listen: Vec<String>,
    /// A file with the token that clients over TCP and WebSocket have to know; needed beyond this machine
    #[arg(long, value_name = "F")]
    pub token_file: Option<PathBuf>,
}
