//! The one place where logging is set up: to stderr, never to standard output.
//!
//! A line says when, how bad, which part (its module) and what; as JSON, one object a line, also which thread. The level can
//! change while the face lives. [`sparing`] keeps a fault that repeats from filling the disk.

mod sparing;

use std::io::IsTerminal as _;
use std::sync::OnceLock;

use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use tracing_subscriber::{EnvFilter, Layer as _, Registry, fmt, reload};

use crate::config::{Level, Log};
use sparing::Sparing;

/// What is wanted of the log.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// How often `-v` was given.
    pub verbose: u8,
    /// Whether the process lives on, so that lines need a time.
    pub live: bool,
    /// What the configuration says.
    pub level: Level,
    /// A JSON object a line.
    pub json: bool,
}

impl Wanted {
    /// From the flags and, for a live face, the configuration.
    pub fn new(verbose: u8, json: bool, configured: Option<&Log>) -> Self {
        Self {
            verbose,
            live: configured.is_some(),
            level: configured.map_or(Level::Warn, |log| log.level),
            json: json || configured.is_some_and(|log| log.json),
        }
    }

    /// Commands that end by themselves say only what is wrong unless asked for more; a live face also says what it chose.
    fn directives(self) -> &'static str {
        match (self.verbose, self.live, self.level) {
            // That pictures are drawn in software concerns a window; an export only takes longer.
            (0, false, _) => "warn,mouthpiece_render::gpu=error",
            (0, true, Level::Error) => "error",
            (0, true, Level::Warn) => "warn,winit=error",
            (0, true, Level::Info) | (1, ..) => {
                "warn,winit=error,mouthpiece=info,mouthpiece_render=info"
            }
            _ => "info,mouthpiece=debug,mouthpiece_render=debug",
        }
    }

    fn filter(self) -> EnvFilter {
        EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(self.directives()))
    }
}

/// The level, for [`set_level`].
static RUNNING: OnceLock<(Wanted, reload::Handle<EnvFilter, Registry>)> = OnceLock::new();

/// Starts logging.
pub fn start(wanted: Wanted) {
    let (filter, handle) = reload::Layer::new(wanted.filter());
    let lines = fmt::layer().with_writer(std::io::stderr);
    let lines = if wanted.json {
        let format = fmt::format()
            .json()
            .flatten_event(true)
            .with_thread_names(true);
        let format = format.with_span_list(false).with_current_span(false);
        let json = lines.fmt_fields(fmt::format::JsonFields::new());
        json.event_format(Sparing::new(format, true)).boxed()
    } else {
        let lines = lines.with_ansi(std::io::stderr().is_terminal());
        if wanted.live {
            lines
                .event_format(Sparing::new(fmt::format(), false))
                .boxed()
        } else {
            let format = fmt::format().without_time().with_target(wanted.verbose > 1);
            lines.event_format(Sparing::new(format, false)).boxed()
        }
    };
    tracing_subscriber::registry()
        .with(filter)
        .with(lines)
        .init();
    // Only ever set here.
    let _ = RUNNING.set((wanted, handle));
}

/// Takes over another level from the configuration; a flag or RUST_LOG goes first.
pub fn set_level(level: Level) {
    let Some((wanted, handle)) = RUNNING.get() else {
        return;
    };
    let filter = Wanted { level, ..*wanted }.filter();
    if let Err(error) = handle.reload(filter) {
        tracing::warn!(%error, "the level of the log stays");
    }
}
