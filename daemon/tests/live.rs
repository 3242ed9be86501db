//! The daemon as its users meet it: the real binary, without window or sound device, over its socket.

#![allow(
    clippy::unwrap_used,
    clippy::needless_pass_by_value,
    reason = "a test says what it expects, in short lines"
)]

mod harness;

use std::io::{Read as _, Write as _};
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _};
use std::os::unix::net::{UnixListener, UnixStream};
use std::process::Stdio;
use std::time::Duration;

use harness::{Daemon, begin, end, mouthpiece, text, vowel};
use serde_json::json;

#[test]
fn clients_speak_in_turn_stop_fail_and_die_and_the_daemon_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let daemon = Daemon::start(&socket);
    let mode = std::fs::metadata(&socket).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);

    // Sound that is sent, cut in the middle of a sample; stereo, another rate.
    let mut client = daemon.call();
    client.say(json!({"type": "begin", "id": "a", "audio": {"rate": 8000, "channels": 2}}));
    client.say(vowel(0.2));
    for part in ["AAAA", &"AAAAAAAA".repeat(800)] {
        client.say(json!({"type": "audio", "data": part}));
    }
    client.say(end());
    client.expect("accepted", "a");
    client.expect("started", "a");
    // 3 + 4800 bytes are 1200 whole frames of 4 bytes and a rest: 0.15 s of sound, 0.2 s of labels.
    let finished = client.expect("finished", "a");
    assert_eq!(finished["position_s"], 0.2);

    // A TIMIT file as it is, with a line that is none.
    for line in ["0 3200 h#", "what?", "3200 4800 aa", ""] {
        client.say(line);
    }
    client.expect("accepted", "timit-1");
    assert_eq!(client.expect("error", "timit-1")["code"], "malformed");
    client.expect("started", "timit-1");
    client.expect("finished", "timit-1");

    // Barge-in from another client.
    client.say(begin("long"));
    client.say(vowel(100.0));
    client.say(end());
    client.say(begin("next"));
    client.expect("accepted", "long");
    client.expect("accepted", "next");
    client.expect("started", "long");
    let mut other = daemon.call();
    other.say(json!({"type": "stop"}));
    assert!(
        client.expect("stopped", "long")["position_s"]
            .as_f64()
            .unwrap()
            < 50.0
    );
    client.expect("stopped", "next");

    // Garbage is answered, and the connection goes on.
    other.stream.write_all(b"\xff\xfe\x00{\n{}\n").unwrap();
    let long = "x".repeat((1 << 20) + 1);
    other.say(long);
    other.say(json!({"type": "begin", "id": "f", "audio": {"file": "/nowhere/a.wav"}}));
    for code in ["malformed", "malformed", "limit"] {
        assert_eq!(other.answer()["code"], code);
    }
    other.expect("accepted", "f");
    let failed = other.expect("error", "f");
    assert_eq!(
        (&failed["code"], &failed["fatal"]),
        (&json!("audio"), &json!(true))
    );
    other.say(json!({"type": "ping", "token": "still here"}));
    assert_eq!(other.answer()["token"], "still here");

    // One that dies in mid sentence does not keep the next from speaking.
    let mut dying = daemon.call();
    dying.say(begin("d"));
    dying.say(vowel(0.5));
    dying.expect("accepted", "d");
    dying.expect("started", "d");
    drop(dying);
    other.say(begin("o"));
    other.say(vowel(0.1));
    other.say(end());
    for kind in ["accepted", "started", "finished"] {
        other.expect(kind, "o");
    }

    // One that sends all and closes its half still hears the end.
    let mut half = daemon.call();
    half.say("0 1600 aa");
    half.stream.shutdown(std::net::Shutdown::Write).unwrap();
    for kind in ["accepted", "started", "finished"] {
        half.expect(kind, "timit-1");
    }
    let mut rest = String::new();
    half.lines.read_to_string(&mut rest).unwrap();
    assert_eq!(rest, "", "closed after the last answer");
}

#[test]
fn one_daemon_at_a_socket_and_it_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    // A dead daemon's socket is replaced.
    drop(UnixListener::bind(&socket).unwrap());
    // A process that another test forks holds it open for a moment more.
    while UnixStream::connect(&socket).is_ok() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let mut daemon = Daemon::start(&socket);
    assert!(std::fs::metadata(&socket).unwrap().file_type().is_socket());

    let second = mouthpiece()
        .args(["run", "--http", "none", "--listen"])
        .arg(&socket)
        .output()
        .unwrap();
    assert_eq!(second.status.code(), Some(1));
    assert!(
        text(&second).contains("another mouthpiece listens"),
        "{}",
        text(&second)
    );

    daemon.signal("-TERM");
    assert_eq!(daemon.child.wait().unwrap().code(), Some(0));
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");

    // What is no socket is not touched.
    std::fs::write(&socket, "mine").unwrap();
    let refused = mouthpiece()
        .args(["run", "--http", "none", "--listen"])
        .arg(&socket)
        .output()
        .unwrap();
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        text(&refused).contains("is no socket"),
        "{}",
        text(&refused)
    );
    assert_eq!(std::fs::read_to_string(&socket).unwrap(), "mine");
}

#[test]
fn say_speaks_through_the_daemon_also_line_by_line_and_stops_when_told() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let daemon = Daemon::start(&socket);
    let say = |labels: &str| {
        let mut command = mouthpiece();
        command
            .args(["say", "--labels", labels, "--listen"])
            .arg(&socket);
        command.stdin(Stdio::piped()).stderr(Stdio::piped());
        command
    };

    let mut child = say("-").spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    for line in ["0 4800 h#\n48", "00 8000 aa\nno label\n", "8000 9600 h#"] {
        input.write_all(line.as_bytes()).unwrap();
        std::thread::sleep(Duration::from_millis(30));
    }
    drop(input);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    assert!(text(&output).contains("line 3"), "{}", text(&output));

    let labels = folder.path().join("long.phn");
    std::fs::write(&labels, "0 1600000 aa\n").unwrap();
    let mut watcher = daemon.call();
    let mut child = say(labels.to_str().unwrap()).spawn().unwrap();
    // Until one of them comes when there is something to stop.
    while child.try_wait().unwrap().is_none() {
        watcher.say(json!({"type": "stop"}));
        std::thread::sleep(Duration::from_millis(50));
    }
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text(&output).contains("stopped by another client"),
        "{}",
        text(&output)
    );

    let nobody = mouthpiece()
        .args(["say", "--demo", "--listen", "/nowhere/face.sock"])
        .output()
        .unwrap();
    assert_eq!(nobody.status.code(), Some(1));
    assert!(
        text(&nobody).contains("no daemon answers"),
        "{}",
        text(&nobody)
    );
}

#[test]
fn without_display_and_sound_say_refuses_in_one_sentence() {
    let output = mouthpiece()
        .args(["say", "--demo", "--audio-device", "none"])
        .env("XDG_RUNTIME_DIR", "/nowhere")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output);
    assert!(said.contains("mouthpiece export"), "{said}");
}
