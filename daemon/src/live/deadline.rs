//! An end that is asked for comes in time: whatever hangs (a graphics card, a sound device, a network disk) is
//! left behind.

use std::path::PathBuf;
use std::time::Duration;

/// How long an orderly end may take; service managers and people wait a second.
const PATIENCE: Duration = Duration::from_millis(850);

/// From now on the process has so long to end by itself. `socket` is a file to be removed in any case.
pub fn arm(socket: Option<PathBuf>) {
    let armed = std::thread::Builder::new()
        .name("deadline".into())
        .spawn(move || {
            // Only the end of the process ends this earlier.
            std::thread::sleep(PATIENCE);
            if let Some(socket) = socket {
                // Gone already, mostly.
                let _ = std::fs::remove_file(socket);
            }
            tracing::warn!("something hangs and is left behind");
            std::process::exit(0);
        });
    if let Err(error) = armed {
        tracing::warn!(%error, "no thread to watch over the end");
    }
}
