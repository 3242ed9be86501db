//! A running daemon without window and sound device, and clients of it, for the tests beside this folder.

#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::needless_pass_by_value,
    clippy::should_implement_trait,
    missing_docs,
    reason = "a part of each test program beside it, each of which uses what it needs"
)]

use std::io::{BufRead as _, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Far longer than anything here takes on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(60);

pub fn mouthpiece() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mouthpiece"));
    command
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        // No configuration of the user's.
        .env("XDG_CONFIG_HOME", "/nowhere")
        .stdin(Stdio::null());
    command
}

pub fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A running daemon; ended with the test whatever happens.
pub struct Daemon {
    pub child: Child,
    pub socket: PathBuf,
}

impl Daemon {
    pub fn start(socket: &Path) -> Self {
        Self::start_with(socket, &[])
    }

    /// One that is told more.
    pub fn start_with(socket: &Path, args: &[&str]) -> Self {
        let child = mouthpiece()
            .args([
                "run",
                "--audio-device",
                "none",
                "--http",
                "none",
                "--listen",
            ])
            .arg(socket)
            .args(args)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let daemon = Self {
            child,
            socket: socket.to_owned(),
        };
        let until = Instant::now() + PATIENCE;
        while UnixStream::connect(socket).is_err() {
            assert!(Instant::now() < until, "the daemon does not listen");
            std::thread::sleep(Duration::from_millis(20));
        }
        daemon
    }

    pub fn call(&self) -> Client {
        let stream = UnixStream::connect(&self.socket).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Client {
            lines: BufReader::new(Box::new(stream.try_clone().unwrap())),
            stream,
        }
    }

    pub fn signal(&self, name: &str) {
        let id = self.child.id().to_string();
        assert!(
            Command::new("kill")
                .args([name, &id])
                .status()
                .unwrap()
                .success()
        );
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A client of lines over any stream.
pub struct Client<S = UnixStream> {
    pub stream: S,
    pub lines: BufReader<Box<dyn Read>>,
}

impl Client<TcpStream> {
    pub fn tcp(port: u16) -> Self {
        let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Self {
            lines: BufReader::new(Box::new(stream.try_clone().unwrap())),
            stream,
        }
    }
}

impl<S: Write> Client<S> {
    pub fn say(&mut self, line: impl ToString) {
        writeln!(self.stream, "{}", line.to_string()).unwrap();
    }

    /// The next answer, whatever it is about; none when the connection was closed.
    fn line(&mut self) -> Option<Value> {
        let mut line = String::new();
        // A client that was let go may find its connection reset.
        if self.lines.read_line(&mut line).unwrap_or(0) == 0 {
            return None;
        }
        Some(serde_json::from_str(&line).unwrap())
    }

    /// The same where the connection must be open.
    pub fn any(&mut self) -> Value {
        self.line().expect("closed")
    }

    /// The next answer that is not about progress; none when the connection was closed.
    pub fn next(&mut self) -> Option<Value> {
        std::iter::from_fn(|| self.line()).find(|answer| answer["type"] != "progress")
    }

    /// The next answer that is not about progress.
    pub fn answer(&mut self) -> Value {
        self.next().expect("closed")
    }

    pub fn expect(&mut self, kind: &str, id: &str) -> Value {
        let answer = self.answer();
        assert_eq!(
            (answer["type"].as_str(), answer["id"].as_str()),
            (Some(kind), Some(id)),
            "{answer}"
        );
        answer
    }
}

pub fn begin(id: &str) -> Value {
    json!({"type": "begin", "id": id})
}

pub fn vowel(seconds: f64) -> Value {
    json!({"type": "phones", "phones": [{"start": 0, "end": seconds, "phone": "aa"}]})
}

pub fn end() -> Value {
    json!({"type": "end"})
}

/// A port of 127.0.0.1 that nobody listens at.
pub fn free_port() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    listener.local_addr().unwrap().port()
}
