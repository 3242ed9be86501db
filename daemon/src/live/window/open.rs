//! Opens the window: on which screen, how large, with or without a window manager.

use std::sync::Arc;

use anyhow::{Context as _, Result};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::monitor::MonitorHandle;
use winit::window::{Fullscreen, Window};

use crate::config;

/// The window's title.
const TITLE: &str = "Mouthpiece";

/// The screen that is asked for; else the primary one, else any.
pub(super) fn monitor(events: &ActiveEventLoop, wanted: &str) -> Option<MonitorHandle> {
    let all: Vec<MonitorHandle> = events.available_monitors().collect();
    if wanted != "primary" {
        let numbered = wanted.parse().ok().and_then(|n: usize| n.checked_sub(1));
        let found = all.iter().enumerate().find(|(index, monitor)| {
            numbered == Some(*index) || monitor.name().as_deref() == Some(wanted)
        });
        if let Some((_, monitor)) = found {
            return Some(monitor.clone());
        }
        let names: Vec<String> = names(&all);
        tracing::warn!(
            "there is no screen {wanted:?}, taking the primary one; there are {}",
            names.join(", ")
        );
    }
    events.primary_monitor().or_else(|| all.into_iter().next())
}

/// How screens are named: what `--monitor` takes.
pub(super) fn names(all: &[MonitorHandle]) -> Vec<String> {
    let named = all.iter().enumerate().map(|(index, monitor)| {
        let name = monitor.name().unwrap_or_default();
        let size = monitor.size();
        format!("{} {name:?} ({}x{})", index + 1, size.width, size.height)
    });
    named.collect()
}

/// A window as `wanted`, on `monitor` where it fills the screen.
pub(super) fn window(
    events: &ActiveEventLoop,
    wanted: &config::Window,
    monitor: Option<&MonitorHandle>,
) -> Result<Arc<Window>> {
    let (width, height) = (wanted.size.width, wanted.size.height);
    let mut attributes = Window::default_attributes()
        .with_title(TITLE)
        .with_inner_size(PhysicalSize::new(width, height));
    if wanted.fullscreen {
        attributes = attributes
            .with_decorations(false)
            .with_fullscreen(Some(Fullscreen::Borderless(monitor.cloned())));
        // Without a window manager nobody makes the window as large as asked for.
        if let Some(monitor) = monitor {
            attributes = attributes
                .with_inner_size(monitor.size())
                .with_position(monitor.position());
        }
    }
    let window = events
        .create_window(attributes)
        .context("no window could be opened")?;
    Ok(Arc::new(window))
}
