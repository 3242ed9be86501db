//! Faults that tests ask for by signal, where `run` was told to allow it; nobody else meets them.

use tokio::signal::unix::{SignalKind, signal};
use winit::event_loop::EventLoopProxy;

use super::window::Wake;

/// SIGUSR2 loses the graphics device. Runs for ever.
pub async fn obey(window: EventLoopProxy<Wake>) {
    let Ok(mut asked) = signal(SignalKind::user_defined2()) else {
        tracing::warn!("faults cannot be asked for");
        return;
    };
    while asked.recv().await.is_some() {
        // Closed already: nothing to lose.
        let _ = window.send_event(Wake::LoseDevice);
    }
}
