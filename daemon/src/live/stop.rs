//! How a live process is asked to end: Ctrl-C and its like, a closed window, an utterance that is over.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio_util::sync::CancellationToken;

/// Asked for once, seen by every thread. Clones are the same.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    token: CancellationToken,
    by_signal: Arc<AtomicBool>,
}

impl Stop {
    /// Asks for the end.
    pub fn ask(&self) {
        self.token.cancel();
    }

    /// Whether it was a signal that asked.
    pub fn by_signal(&self) -> bool {
        self.by_signal.load(Ordering::Acquire)
    }

    /// Waits until the end is asked for.
    pub async fn wait(&self) {
        self.token.cancelled().await;
    }

    /// Asks for the end when a signal comes; a second signal ends the process at once. Runs until then. SIGHUP is one
    /// of them where it `hangs_up`; else somebody else listens for it.
    pub async fn on_signals(self, hangs_up: bool) {
        use tokio::signal::unix::{SignalKind, signal};
        let kinds = [
            SignalKind::interrupt(),
            SignalKind::terminate(),
            SignalKind::hangup(),
        ];
        let [Ok(mut a), Ok(mut b), Ok(mut c)] = kinds.map(signal) else {
            tracing::warn!("signals are not handled; end the process with SIGKILL");
            return;
        };
        loop {
            tokio::select! {
                _ = a.recv() => {}
                _ = b.recv() => {}
                _ = c.recv() => if !hangs_up { continue },
            }
            if self.by_signal.swap(true, Ordering::AcqRel) {
                std::process::exit(i32::from(crate::interrupt::STATUS));
            }
            self.ask();
        }
    }
}
