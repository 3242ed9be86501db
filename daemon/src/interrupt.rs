//! Ctrl-C and its like, for work that should end cleanly: a flag that loops look at once a turn.
//!
//! The daemon has its own shutdown; this is for export, curves and the other commands that end by
//! themselves. A second signal ends the process at once.

use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of a process stopped by Ctrl-C, as shells report it.
pub const STATUS: u8 = 130;

static STOP: AtomicBool = AtomicBool::new(false);

/// The user wants the work to stop.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Interrupted(pub String);

impl Default for Interrupted {
    fn default() -> Self {
        Self("stopped by a signal; nothing was written".into())
    }
}

/// Fails once a signal has come.
pub fn check() -> Result<(), Interrupted> {
    if STOP.load(Ordering::Relaxed) {
        Err(Interrupted::default())
    } else {
        Ok(())
    }
}

/// Starts watching, on a thread of its own. Where signals cannot be had, they keep doing what they do.
pub fn watch() {
    let started = std::thread::Builder::new()
        .name("signals".into())
        .spawn(|| {
            let runtime = tokio::runtime::Builder::new_current_thread()
                .enable_all()
                .build();
            match runtime {
                Ok(runtime) => runtime.block_on(async {
                    while signal().await {
                        if STOP.swap(true, Ordering::Relaxed) {
                            std::process::exit(i32::from(STATUS));
                        }
                    }
                }),
                Err(error) => tracing::warn!(%error, "Ctrl-C will not be handled"),
            }
        });
    if let Err(error) = started {
        tracing::warn!(%error, "Ctrl-C will not be handled");
    }
}

/// Waits for a signal that asks to stop; false when none can come.
#[cfg(unix)]
async fn signal() -> bool {
    use tokio::signal::unix::{SignalKind, signal};
    let kinds = [
        SignalKind::interrupt(),
        SignalKind::terminate(),
        SignalKind::hangup(),
    ];
    let [Ok(mut a), Ok(mut b), Ok(mut c)] = kinds.map(signal) else {
        return false;
    };
    tokio::select! {
        got = a.recv() => got.is_some(),
        got = b.recv() => got.is_some(),
        got = c.recv() => got.is_some(),
    }
}

/// Waits for a signal that asks to stop; false when none can come.
#[cfg(not(unix))]
async fn signal() -> bool {
    tokio::signal::ctrl_c().await.is_ok()
}
