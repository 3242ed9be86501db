//! An X server's own saver and its power saving are suspended (MIT-SCREEN-SAVER 1.1), and go on as they were when
//! the connection ends, however it ends.

use x11rb::connection::Connection as _;
use x11rb::protocol::screensaver::ConnectionExt as _;
use x11rb::protocol::xproto::{ConnectionExt as _, ScreenSaver};
use x11rb::rust_connection::RustConnection;

/// As long as it lives.
pub(super) struct Suspended(
    #[allow(dead_code, reason = "closed when it is dropped")] RustConnection,
);

impl Suspended {
    /// None, with a word in the log, where the server cannot do it.
    pub(super) fn new() -> Option<Self> {
        match Self::suspend() {
            Ok(suspended) => Some(suspended),
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
