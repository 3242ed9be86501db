//! A configuration that has changed is taken over by a face that lives, on the net thread.
//!
//! Wanted: a change of the file, or SIGHUP, is felt without a picture or a sample lost; a file that is
//! wrong changes nothing. So everything that a change needs is read and checked here (pictures and
//! panoramas, too), and only then handed to the thread that uses it, as a whole. What cannot change
//! while the face lives is said in the log.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use anyhow::Result;
use arc_swap::ArcSwap;
use notify::Watcher as _;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::mpsc;
use winit::event_loop::EventLoopProxy;

use super::player::Handle;
use super::rules::Rules;
use super::showing::Showing;
use super::stop::Stop;
use super::window::{Look, Wake};
use crate::config::{Config, Source};

/// Programs save a file in several steps; this long after the last of them it is read.
const SETTLE: Duration = Duration::from_millis(200);
/// Events that put this off at most.
const SETTLE_TURNS: u32 = 20;

/// The configuration in use, for whoever asks at a moment of its own.
pub type Current = Arc<ArcSwap<Config>>;

/// Who takes over what.
pub struct Reload {
    pub source: Source,
    pub current: Current,
    pub player: Handle,
    /// None without a window.
    pub window: Option<EventLoopProxy<Wake>>,
}

impl Reload {
    /// Watches the file and SIGHUP until the end is asked for. Without a file SIGHUP asks for the end, as it does
    /// to any program.
    pub async fn watch(self, stop: Stop) {
        let Some(file) = self.source.file().map(Path::to_owned) else {
            return;
        };
        let (changed, mut changes) = mpsc::channel(1);
        // Dropped with this task.
        let watcher = watcher(&file, changed);
        if let Err(error) = &watcher {
            tracing::warn!(%error, file = %file.display(), "changes of the configuration are not seen; SIGHUP still reads it");
        }
        let Ok(mut hang_up) = signal(SignalKind::hangup()) else {
            return;
        };
        let mut text = std::fs::read(&file).ok();
        loop {
            tokio::select! {
                () = stop.wait() => return,
                Some(()) = hang_up.recv() => text = read(&file).await,
                Some(()) = changes.recv() => {
                    settle(&mut changes).await;
                    // Something else in the folder, mostly.
                    let now = read(&file).await;
                    if now == text {
                        continue;
                    }
                    text = now;
                }
            }
            self.take_over().await;
        }
    }

    async fn take_over(&self) {
        let source = self.source.clone();
        let loaded = tokio::task::spawn_blocking(move || {
            let config = source.load()?;
            let look = Look::load(&config)?;
            Ok((config, look))
        });
        let loaded: Result<(Config, Look)> = match loaded.await {
            Ok(loaded) => loaded,
            Err(error) => Err(error.into()),
        };
        let (config, look) = match loaded {
            Ok(loaded) => loaded,
            Err(error) => {
                tracing::error!("{error:#}; the configuration in use stays");
                return;
            }
        };
        let old = self.current.load_full();
        let changed = old.differs_in(&config);
        if changed.is_empty() {
            // The files that it names may have changed.
            tracing::info!("the configuration is read again");
        }
        let (at_start, live): (Vec<_>, Vec<_>) = changed.into_iter().partition(|c| c.at_start);
        if !at_start.is_empty() {
            let keys = names(&at_start);
            tracing::warn!(%keys, "changed in the file; felt at the next start");
        }
        if !live.is_empty() {
            let keys = names(&live);
            tracing::info!(%keys, "the configuration has changed");
        }
        crate::log::set_level(config.log.level);
        if let Some(window) = &self.window {
            // Closed already: the process is ending.
            let _ = window.send_event(Wake::Look(Box::new(look)));
        }
        if old.life.state != config.life.state {
            let state = config.life.state.into();
            self.player.show(Showing::Rest(state)).await;
        }
        let rules = Rules::of(&config);
        if Rules::of(&old) != rules {
            self.player.rule(rules).await;
        }
        // Clients that come from now on find the new bounds.
        self.current.store(Arc::new(config));
    }
}

fn names(changed: &[crate::config::Changed]) -> String {
    let names: Vec<&str> = changed.iter().map(|c| c.name.as_str()).collect();
    names.join(", ")
}

/// The file's bytes; none where it cannot be read.
async fn read(file: &Path) -> Option<Vec<u8>> {
    let file = file.to_owned();
    let read = tokio::task::spawn_blocking(move || std::fs::read(file).ok());
    read.await.ok().flatten()
}

/// Waits until nothing has happened for a while; in a folder where something always happens, only so long.
async fn settle(changes: &mut mpsc::Receiver<()>) {
    for _ in 0..SETTLE_TURNS {
        if tokio::time::timeout(SETTLE, changes.recv()).await.is_err() {
            return;
        }
    }
}

/// Tells `changed` of everything that happens in the file's folder: programs replace files, and who watches the
/// file itself watches what is gone.
fn watcher(file: &Path, changed: mpsc::Sender<()>) -> notify::Result<notify::RecommendedWatcher> {
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        if event.is_ok_and(|event| !event.kind.is_access()) {
            // Full: somebody has been told already.
            let _ = changed.try_send(());
        }
    })?;
    watcher.watch(folder, notify::RecursiveMode::NonRecursive)?;
    Ok(watcher)
}
