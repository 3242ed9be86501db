//! A screen of a test's own: an X server that draws into memory, ended with the test.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

/// A running Xvfb.
#[derive(Debug)]
pub struct Screen {
    server: Child,
    /// What `DISPLAY` is to be.
    pub name: String,
}

impl Screen {
    /// Starts one of 800 x 600 pixels.
    ///
    /// # Errors
    /// When Xvfb is not installed: a sentence that says so.
    pub fn start() -> Result<Self, String> {
        Self::sized(800, 600)
    }

    /// Starts one of `width` x `height` pixels.
    ///
    /// # Errors
    /// When Xvfb is not installed: a sentence that says so.
    pub fn sized(width: u16, height: u16) -> Result<Self, String> {
        // It writes the number that it found free to its standard output.
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0"])
            .arg(format!("{width}x{height}x24"))
            .args(["-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = server.map_err(|why| format!("Xvfb cannot be started ({why})"))?;
        let answer = server.stdout.take().expect("a pipe was asked for");
        let mut number = String::new();
        let read = BufReader::new(answer).read_line(&mut number);
        let screen = Self {
            server,
            name: format!(":{}", number.trim()),
        };
        assert!(read.is_ok() && number.len() > 1, "Xvfb gave no number");
        Ok(screen)
    }

    /// Sends the server a signal: `STOP` and it takes no pictures, until `CONT`.
    pub fn signal(&self, name: &str) {
        crate::binary::signal(self.server.id(), name);
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
