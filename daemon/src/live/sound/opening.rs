//! The `sound-open` thread: opens a device, so that the sound thread, and with it the clock, never
//! waits for a sound server that does not answer.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::time::Duration;

use super::device::{self, Device};
use crate::live::clock::ClockCell;
use crate::live::time::Origin;

/// A device that is being opened.
pub(super) struct Opening(Receiver<Result<Device, String>>);

impl Opening {
    /// Begins with the device of that id, or the default one.
    pub(super) fn start(
        wanted: Option<String>,
        cell: &Arc<ClockCell>,
        origin: Origin,
    ) -> Result<Self, String> {
        let (send, result) = sync_channel(1);
        let cell = Arc::clone(cell);
        let thread = std::thread::Builder::new().name("sound-open".to_owned());
        thread
            .spawn(move || {
                // Nobody left who wants it: it is closed again.
                let _ = send.send(device::open(wanted.as_deref(), &cell, origin));
            })
            .map_err(|error| format!("no thread to open a sound device with: {error}"))?;
        Ok(Self(result))
    }

    /// What came of it; none while it goes on.
    pub(super) fn poll(&self) -> Option<Result<Device, String>> {
        match self.0.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(broken())),
        }
    }

    /// Waits for it, but no longer than `patience`.
    pub(super) fn wait(&self, patience: Duration) -> Option<Result<Device, String>> {
        use std::sync::mpsc::RecvTimeoutError;
        match self.0.recv_timeout(patience) {
            Ok(result) => Some(result),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(broken())),
        }
    }
}

fn broken() -> String {
    "opening the sound device broke down; the lines above say where".to_owned()
}
