//! The one place where logging is set up: to stderr, never to standard output.

use std::io::IsTerminal as _;

use tracing_subscriber::EnvFilter;

/// Starts logging. Commands that end by themselves say only what is wrong unless asked for more,
/// in plain lines; a live face also says what it chose, and when.
pub fn start(verbose: u8, live: bool) {
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| {
        EnvFilter::new(match (verbose, live) {
            // That pictures are drawn in software concerns a window; an export only takes longer.
            (0, false) => "warn,mouthpiece_render::gpu=error",
            (0, true) | (1, _) => "warn,winit=error,mouthpiece=info,mouthpiece_render=info",
            _ => "info,mouthpiece=debug,mouthpiece_render=debug",
        })
    });
    let lines = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal());
    if live {
        lines.init();
    } else {
        lines.without_time().with_target(verbose > 1).init();
    }
}
