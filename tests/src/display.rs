//! What is on an X server's screen, and whether it is blank.

use std::time::{Duration, Instant};

use x11rb::connection::Connection as _;
use x11rb::protocol::screensaver::{ConnectionExt as _, State};
use x11rb::protocol::xproto::{Blanking, ConnectionExt as _, Exposures, ImageFormat};
use x11rb::rust_connection::RustConnection;

use crate::screen::Screen;

/// Far longer than anything takes to appear on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often the screen is looked at.
const POLL: Duration = Duration::from_millis(20);

/// A screen that can be looked at.
#[derive(Debug)]
pub struct Display {
    /// Its server.
    pub screen: Screen,
    connection: RustConnection,
    root: u32,
}

impl Display {
    /// Starts a server with one screen of `width` x `height`.
    ///
    /// # Errors
    /// Where Xvfb is not installed.
    pub fn start(width: u16, height: u16) -> Result<Self, String> {
        let screen = Screen::sized(width, height)?;
        let (connection, number) = x11rb::connect(Some(&screen.name)).expect("it has just started");
        let root = connection.setup().roots[number].root;
        Ok(Self {
            screen,
            connection,
            root,
        })
    }

    /// The colours of a rectangle of the screen, row by row.
    #[must_use]
    pub fn pixels(&self, x: i16, y: i16, width: u16, height: u16) -> Vec<[u8; 3]> {
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.root, x, y, width, height, !0)
            .expect("the server listens")
            .reply()
            .expect("the rectangle is on the screen");
        let pixels = image.data.chunks_exact(4);
        pixels.map(|bgrx| [bgrx[2], bgrx[1], bgrx[0]]).collect()
    }

    /// Waits until the pixel at `x`, `y` is `colour`.
    #[track_caller]
    pub fn wait_for(&self, (x, y): (i16, i16), colour: [u8; 3]) {
        self.wait("a colour", |display| display.pixels(x, y, 1, 1) == [colour]);
    }

    /// Waits until `there` is true of the screen.
    #[track_caller]
    pub fn wait(&self, what: &str, there: impl Fn(&Self) -> bool) {
        let begun = Instant::now();
        while !there(self) {
            assert!(begun.elapsed() < PATIENCE, "{what} does not come");
            std::thread::sleep(POLL);
        }
    }

    /// Has the server blank its screen when nobody has touched it for a second.
    pub fn blank_soon(&self) {
        self.connection
            .set_screen_saver(1, 0, Blanking::PREFERRED, Exposures::DEFAULT)
            .expect("the server listens")
            .check()
            .expect("it has a saver");
    }

    /// Whether the screen is blank.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        let saver = self.connection.screensaver_query_info(self.root);
        let saver = saver.expect("the server listens").reply();
        State::from(saver.expect("it has a saver").state) == State::ON
    }
}
