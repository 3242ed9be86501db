//! Keeps the screen from blanking while this lives.
//!
//! | module | asks |
//! |---|---|
//! | [`server`] | the X server, where the window is on one |
//!
//! On Wayland a compositor decides by itself: `cage`, of our recipe, never blanks. A desktop's own saver is no part of
//! an X server, either: switch it off in the desktop's settings.

use winit::raw_window_handle::{HasDisplayHandle as _, RawDisplayHandle};
use winit::window::Window;

mod server;

/// While it lives, the screen does.
pub(super) struct Awake {
    _server: Option<server::Suspended>,
}

impl Awake {
    /// For the screen that `window` is on.
    pub(super) fn new(window: &Window) -> Self {
        let handle = window.display_handle().map(|handle| handle.as_raw());
        // A Wayland compositor may have an X server, too, whose saver is nobody's.
        let on_x = matches!(
            handle,
            Ok(RawDisplayHandle::Xlib(_) | RawDisplayHandle::Xcb(_))
        );
        Self {
            _server: on_x.then(server::Suspended::new).flatten(),
        }
    }
}
