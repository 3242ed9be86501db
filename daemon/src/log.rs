//! The one place where logging is set up: to stderr, never to standard output.

use tracing_subscriber::EnvFilter;

/// Starts logging. Commands that end by themselves say only what is wrong unless asked for more;
/// the daemon also says what it chose.
pub fn start(verbose: u8, daemon: bool) {
    let fallback = match (verbose, daemon) {
        (0, false) => "warn",
        (0, true) | (1, _) => "warn,mouthpiece=info,mouthpiece_render=info",
        _ => "info,mouthpiece=debug,mouthpiece_render=debug",
    };
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(fallback));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_target(verbose > 0)
        .init();
}
