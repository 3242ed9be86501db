//! Which screens there are, for `doctor` and for whoever writes `monitor` into a configuration.

use anyhow::{Context as _, Result};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::WindowId;

use super::open;

/// The screens by number, name and size; an error where there is no display. Main thread only, once a process.
pub fn screens() -> Result<Vec<String>> {
    let events = EventLoop::new().context("the display cannot be opened")?;
    let mut lister = Lister(Vec::new());
    events
        .run_app(&mut lister)
        .context("the display cannot be asked")?;
    Ok(lister.0)
}

struct Lister(Vec<String>);

impl ApplicationHandler for Lister {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.0 = open::names(&events.available_monitors().collect::<Vec<_>>());
        events.exit();
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, _: WindowEvent) {}
}
