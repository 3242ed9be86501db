//! The daemon's socket as a TTS engine uses it: JSON lines and raw TIMIT lines, without a display or
//! a sound device, as on a server.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::process::Stdio;
use std::time::{Duration, Instant};

use mouthpiece_tests::binary::{self, Running};
use serde_json::{Value, json};
use tempfile::TempDir;

/// Far more than any answer takes; a daemon that says nothing must not stop the run.
const PATIENCE: Duration = Duration::from_secs(60);

/// A daemon of this test's own.
struct Daemon {
    running: Running,
    socket: PathBuf,
    _folder: TempDir,
}

impl Daemon {
    fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let socket = folder.path().join("face.sock");
        let listen = format!("unix:{}", socket.display());
        let args = ["run", "--listen", &listen, "--audio-device", "none"];
        let mut running = binary::start(binary::command(&args).stdout(Stdio::null()));
        let begun = Instant::now();
        while !socket.exists() {
            assert!(!running.has_ended(), "{}", running.finish().stderr);
            assert!(begun.elapsed() < PATIENCE, "no socket");
            std::thread::sleep(Duration::from_millis(10));
        }
        Self {
            running,
            socket,
            _folder: folder,
        }
    }

    fn connect(&self) -> Client {
        let stream = UnixStream::connect(&self.socket).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let lines = BufReader::new(stream.try_clone().unwrap());
        Client { stream, lines }
    }
}

struct Client {
    stream: UnixStream,
    lines: BufReader<UnixStream>,
}

impl Client {
    fn send(&mut self, message: &Value) {
        writeln!(self.stream, "{message}").unwrap();
    }

    fn hear(&mut self) -> Value {
        let mut line = String::new();
        self.lines.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line:?}"))
    }

    /// The next message that is no `progress`.
    fn hear_event(&mut self) -> Value {
        loop {
            let message = self.hear();
            if message["type"] != "progress" {
                return message;
            }
        }
    }

    #[track_caller]
    fn expect(&mut self, kind: &str) -> Value {
        let message = self.hear_event();
        assert_eq!(message["type"], kind, "{message}");
        message
    }
}

/// Guards the conversation that the protocol's page shows, and both ways to end the daemon.
#[test]
fn an_utterance_is_accepted_started_and_finished() {
    let daemon = Daemon::start();
    let mut client = daemon.connect();
    client.send(&json!({"type": "begin", "id": "a"}));
    assert_eq!(client.expect("accepted")["id"], "a");
    client.send(&json!({"type": "phones", "phones": [
        {"start": 0.0, "end": 0.1, "phone": "h#"},
        {"start": 0.1, "end": 0.3, "phone": "aa"},
        {"start": 0.3, "end": 0.4, "phone": "h#"},
    ]}));
    client.send(&json!({"type": "end"}));
    assert_eq!(client.expect("started")["id"], "a");
    let finished = client.expect("finished");
    let heard = finished["position_s"].as_f64().unwrap();
    assert!((heard - 0.4).abs() < 0.05, "{finished}");

    daemon.running.signal("TERM");
    let Daemon {
        running, socket, ..
    } = daemon;
    let finished = running.finish_within(PATIENCE);
    assert_eq!(finished.code(), 0, "{}", finished.stderr);
    assert!(!socket.exists(), "the socket file is left behind");
}

/// Guards the plainest client there is: a label file piped into the socket.
#[test]
fn raw_timit_lines_are_spoken() {
    let daemon = Daemon::start();
    let mut client = daemon.connect();
    client
        .stream
        .write_all(b"0 1600 h#\n1600 3200 m\n3200 4800 aa\n4800 6400 h#\n\n")
        .unwrap();
    client.expect("accepted");
    client.expect("started");
    client.expect("finished");
}

/// Guards barge-in: `stop` ends what is being said, and what comes next is said.
#[test]
fn stop_ends_an_utterance_and_the_next_one_is_spoken() {
    let daemon = Daemon::start();
    let mut client = daemon.connect();
    let begin = |client: &mut Client, id: &str, end_s: f64| {
        client.send(&json!({"type": "begin", "id": id}));
        client.send(&json!({"type": "phones", "phones": [
            {"start": 0.0, "end": end_s, "phone": "aa"},
        ]}));
        client.send(&json!({"type": "end"}));
        client.expect("accepted");
    };
    begin(&mut client, "long", 600.0);
    client.expect("started");
    client.send(&json!({"type": "stop", "id": "long"}));
    assert_eq!(client.expect("stopped")["id"], "long");
    begin(&mut client, "next", 0.2);
    client.expect("started");
    assert_eq!(client.expect("finished")["id"], "next");
}

/// Guards against clients with bugs: each mistake is answered, none ends the connection.
#[test]
fn nonsense_is_answered_and_the_connection_stays() {
    let daemon = Daemon::start();
    let mut client = daemon.connect();
    for line in [
        "{".to_owned(),
        "[]".to_owned(),
        r#"{"type":"sing"}"#.to_owned(),
        r#"{"type":"end"}"#.to_owned(),
        r#"{"type":"phones","phones":[]}"#.to_owned(),
        r#"{"type":"begin","id":"x","alphabet":"klingon"}"#.to_owned(),
        r#"{"type":"begin","id":"x","audio":{"rate":0,"channels":1}}"#.to_owned(),
        "0 1600 nosuchphone".to_owned(),
        "\u{1f600}".to_owned(),
        "x".repeat(3 << 20),
    ] {
        writeln!(client.stream, "{line}").unwrap();
        let answer = client.expect("error");
        let sentence = answer["message"].as_str().unwrap_or_default();
        assert!(sentence.len() > 10, "{answer}");
        // A token of its own, so that a late second answer to the line above is not mistaken for it.
        client.send(&json!({"type": "ping", "token": "t"}));
        loop {
            let answer = client.hear_event();
            if answer["type"] == "pong" {
                break;
            }
        }
    }
}

/// Guards `say` through a daemon, and one daemon an address.
#[test]
fn say_speaks_through_the_daemon_and_a_second_daemon_is_refused() {
    let daemon = Daemon::start();
    let folder = tempfile::tempdir().unwrap();
    let labels = folder.path().join("l.phn");
    fs::write(&labels, "0 1600 h#\n1600 3200 aa\n").unwrap();
    let labels = labels.to_string_lossy();
    let listen = format!("unix:{}", daemon.socket.display());
    let said = binary::run(&["say", "--labels", &labels, "--listen", &listen]);
    said.expect_done();

    let second = binary::run(&["run", "--listen", &listen, "--audio-device", "none"]);
    second.expect_sentence(1);
    let nowhere = format!("unix:{}", folder.path().join("no.sock").display());
    let alone = binary::run(&["say", "--labels", &labels, "--listen", &nowhere]);
    assert!(alone.expect_sentence(1).contains("no.sock"));
    let open = binary::run(&["run", "--listen", "0.0.0.0:7716"]);
    assert!(open.expect_sentence(1).contains("127.0.0.1"));
}
