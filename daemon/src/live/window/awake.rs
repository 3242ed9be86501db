//! Keeps an X screen from blanking while this lives: the server's own saver and its power saving are
//! suspended (MIT-SCREEN-SAVER 1.1), and go on as they were when the connection ends, however it ends.
//!
//! A Wayland compositor decides by itself; `cage`, of our recipe, never blanks. A desktop's own saver on X
//! is no part of the server: there, switch it off in the desktop's settings.

use x11rb::connection::Connection as _;
use x11rb::protocol::screensaver::ConnectionExt as _;
use x11rb::protocol::xproto::{ConnectionExt as _, ScreenSaver};
use x11rb::rust_connection::RustConnection;

/// While it lives, the screen does.
pub(super) struct Awake(#[allow(dead_code, reason = "closed when it is dropped")] RustConnection);

impl Awake {
    /// None, with a word in the log, where there is no such server.
    pub(super) fn new() -> Option<Self> {
        if std::env::var_os("DISPLAY").is_none_or(|v| v.is_empty()) {
            return None;
        }
        match Self::suspend() {
            Ok(awake) => Some(awake),
            Err(error) => {
                tracing::warn!("the screen may go blank: {error}");
                None
            }
        }
    }

    fn suspend() -> Result<Self, Box<dyn std::error::Error>> {
        let (connection, _) = x11rb::connect(None)?;
        let version = connection.screensaver_query_version(1, 1)?.reply()?;
        if (version.server_major_version, version.server_minor_version) < (1, 1) {
            return Err("the X server's saver cannot be suspended".into());
        }
        // What is blank already would stay so.
        connection.force_screen_saver(ScreenSaver::RESET)?.check()?;
        connection.screensaver_suspend(1)?.check()?;
        connection.flush()?;
        Ok(Self(connection))
    }
}
