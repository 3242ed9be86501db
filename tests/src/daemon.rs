//! A running `mouthpiece run` of a test's own: its socket, its pages of health, its log.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::process::{Child, ExitStatus, Stdio};
use std::sync::mpsc;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::binary;
use crate::screen::Screen;

/// Far longer than anything here takes on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(90);

/// A daemon without a sound device, ended with the test.
#[derive(Debug)]
pub struct Daemon {
    child: Child,
    folder: TempDir,
    /// Where health is told.
    pub http: String,
    log: Arc<Mutex<String>>,
}

/// What a page said.
#[derive(Debug)]
pub struct Answer {
    /// The status.
    pub code: u16,
    /// Names in lower case.
    pub headers: Vec<(String, String)>,
    /// The rest.
    pub body: Vec<u8>,
}

impl Answer {
    /// The body as text.
    #[must_use]
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// The body as JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|why| panic!("{why}: {}", self.text()))
    }

    /// A header by its name in lower case, or nothing.
    #[must_use]
    pub fn header(&self, name: &str) -> &str {
        let found = self.headers.iter().find(|(n, _)| n == name);
        found.map_or("", |(_, value)| value)
    }
}

/// Waits until a log holds `words` so many times.
#[track_caller]
pub fn wait_for_words(log: impl Fn() -> String, words: &str, times: usize) {
    let begun = Instant::now();
    while log().matches(words).count() < times {
        assert!(
            begun.elapsed() < PATIENCE,
            "{words:?} is not said\n{}",
            log()
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}

impl Daemon {
    /// Starts one with `more` arguments, on `screen` or without any, and waits until it tells its health. It logs JSON.
    #[must_use]
    pub fn start(screen: Option<&Screen>, more: &[&str]) -> Self {
        Self::start_at("127.0.0.1:0", screen, more)
    }

    /// The same, with its health told at `http`, a port of its own.
    #[must_use]
    pub fn start_at(http: &str, screen: Option<&Screen>, more: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder for the socket");
        let socket = folder.path().join("face.sock");
        let mut command = binary::command(&["run", "--log-json", "--http", http]);
        command
            .args(["--audio-device", "none", "--listen"])
            .arg(&socket);
        command
            .args(more)
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        if let Some(screen) = screen {
            command.env("DISPLAY", &screen.name);
        }
        let mut child = command.spawn().expect("the binary starts");
        let lines = BufReader::new(child.stderr.take().expect("a pipe was asked for")).lines();
        let log = Arc::new(Mutex::new(String::new()));
        let (found, address) = mpsc::channel();
        let all = Arc::clone(&log);
        std::thread::Builder::new()
            .name("log".to_owned())
            .spawn(move || {
                for line in lines.map_while(Result::ok) {
                    if let Some((_, rest)) = line.split_once("health is told at http://") {
                        let _ = found.send(rest.split('/').next().unwrap_or_default().to_owned());
                    }
                    let mut all = all.lock().expect("nobody panics with it");
                    all.push_str(&line);
                    all.push('\n');
                }
            })
            .expect("a thread");
        let mut daemon = Self {
            child,
            folder,
            http: String::new(),
            log,
        };
        match address.recv_timeout(PATIENCE) {
            Ok(http) => daemon.http = http,
            Err(why) => panic!("{why}: {}", daemon.log()),
        }
        daemon
    }

    /// Its socket.
    #[must_use]
    pub fn socket(&self) -> PathBuf {
        self.folder.path().join("face.sock")
    }

    /// All it has logged.
    #[must_use]
    pub fn log(&self) -> String {
        self.log.lock().expect("nobody panics with it").clone()
    }

    /// Asks for a page.
    #[must_use]
    pub fn get(&self, path: &str) -> Answer {
        self.request(&format!(
            "GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
            self.http
        ))
    }

    /// Waits until the log holds `words` so many times.
    #[track_caller]
    pub fn wait_for_log(&self, words: &str, times: usize) {
        wait_for_words(|| self.log(), words, times);
    }

    /// Sends a request as it is.
    #[must_use]
    pub fn request(&self, request: &str) -> Answer {
        let mut stream = TcpStream::connect(&self.http).expect("health is told");
        stream.set_read_timeout(Some(PATIENCE)).expect("a time-out");
        stream.write_all(request.as_bytes()).expect("sent");
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).expect("an answer");
        let at = bytes
            .windows(4)
            .position(|w| w == b"\r\n\r\n")
            .expect("a head");
        let head = String::from_utf8_lossy(&bytes[..at]).into_owned();
        let mut lines = head.lines();
        let code = lines
            .next()
            .and_then(|l| l.split(' ').nth(1))
            .and_then(|c| c.parse().ok());
        let headers = lines.filter_map(|l| l.split_once(": "));
        Answer {
            code: code.unwrap_or_else(|| panic!("{head}")),
            headers: headers
                .map(|(n, v)| (n.to_lowercase(), v.to_owned()))
                .collect(),
            body: bytes[at + 4..].to_vec(),
        }
    }

    /// What the page shows, once `wanted` of it: fails when that never comes.
    #[track_caller]
    #[must_use]
    pub fn status_when(&self, what: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let status = self.get("/status.json").json();
            if wanted(&status) {
                return status;
            }
            assert!(
                begun.elapsed() < PATIENCE,
                "{what} never: {status:#}\n{}",
                self.log()
            );
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// A connection to its socket.
    #[must_use]
    pub fn call(&self) -> Client {
        let stream = UnixStream::connect(self.socket()).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a time-out");
        Client {
            lines: BufReader::new(stream.try_clone().expect("a second handle")),
            stream,
        }
    }

    /// Sends the signal of this name (`STOP`, `CONT`, `TERM`).
    pub fn signal(&self, name: &str) {
        binary::signal(self.child.id(), name);
    }

    /// Waits for its end.
    pub fn finish(&mut self) -> ExitStatus {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().expect("a child can be asked") {
                return status;
            }
            assert!(begun.elapsed() < PATIENCE, "still running\n{}", self.log());
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A client of the wire.
#[derive(Debug)]
pub struct Client {
    stream: UnixStream,
    lines: BufReader<UnixStream>,
}

impl Client {
    /// Sends a message.
    pub fn say(&mut self, message: &Value) {
        writeln!(self.stream, "{message}").expect("it listens");
    }

    /// The next answer that is not about progress.
    #[must_use]
    pub fn answer(&mut self) -> Value {
        loop {
            let mut line = String::new();
            let read = self.lines.read_line(&mut line).expect("an answer");
            assert!(read > 0, "closed");
            let answer: Value = serde_json::from_str(&line).expect("JSON");
            if answer["type"] != "progress" {
                return answer;
            }
        }
    }

    /// The next answer, which must be of this kind.
    #[track_caller]
    pub fn expect(&mut self, kind: &str) -> Value {
        let answer = self.answer();
        assert_eq!(answer["type"], kind, "{answer}");
        answer
    }
}
