//! The wire as strangers meet it: every transport, tokens, floods, silence, files, and labels and sound that
//! come through pipes.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::needless_pass_by_value,
    reason = "a test says what it expects, in short lines"
)]

mod harness;

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

use harness::{Client, Daemon, PATIENCE, begin, end, free_port, mouthpiece, text, vowel};
use serde_json::{Value, json};
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::{Message, WebSocket, http};

const TOKEN: &str = "0123456789abcdefghij";

/// A configuration for a daemon, in `folder`.
fn configured(folder: &Path, wire: &str) -> String {
    let file = folder.join("config.toml");
    std::fs::write(&file, format!("[wire]\n{wire}")).unwrap();
    file.display().to_string()
}

fn token_file(folder: &Path) -> String {
    let file = folder.join("token");
    std::fs::write(&file, TOKEN).unwrap();
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o600)).unwrap();
    file.display().to_string()
}

/// A WebSocket to `port`, or the status that it was refused with.
fn websocket(port: u16, path: &str, origin: Option<&str>) -> Result<WebSocket<TcpStream>, u16> {
    let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let url = format!("ws://127.0.0.1:{port}{path}");
    let mut request = url.into_client_request().unwrap();
    if let Some(origin) = origin {
        let headers = request.headers_mut();
        headers.insert(http::header::ORIGIN, origin.parse().unwrap());
    }
    match tokio_tungstenite::tungstenite::client(request, stream) {
        Ok((socket, _)) => Ok(socket),
        Err(error) => match error.to_string() {
            why if why.contains("403") => Err(403),
            why if why.contains("401") => Err(401),
            why => panic!("{why}"),
        },
    }
}

fn say(socket: &mut WebSocket<TcpStream>, line: Value) {
    socket.send(Message::text(line.to_string())).unwrap();
}

/// The next answer that is not about progress.
fn heard(socket: &mut WebSocket<TcpStream>) -> Value {
    loop {
        let Message::Text(text) = socket.read().unwrap() else {
            continue;
        };
        let answer: Value = serde_json::from_str(&text).unwrap();
        if answer["type"] != "progress" {
            return answer;
        }
    }
}

/// Guards the three transports, and that what stands before the token is kept out.
#[test]
fn the_same_words_over_every_transport_and_a_token_before_them() {
    let folder = tempfile::tempdir().unwrap();
    let (tcp, ws) = (free_port(), free_port());
    let token = token_file(folder.path());
    let config = configured(folder.path(), "origins = [\"https://kiosk.example\"]\n");
    let (at_tcp, at_ws) = (format!("127.0.0.1:{tcp}"), format!("ws://127.0.0.1:{ws}"));
    let socket = folder.path().join("face.sock");
    let daemon = Daemon::start_with(
        &socket,
        &[
            "--listen",
            &at_tcp,
            "--listen",
            &at_ws,
            "--token-file",
            &token,
            "--config",
            &config,
        ],
    );

    // The file's mode guards the Unix socket.
    let mut near = daemon.call();
    near.say(json!({"type": "hello", "version": 2, "client": "test"}));
    assert_eq!(near.answer()["version"], 2);

    let mut far = Client::tcp(tcp);
    far.say(json!({"type": "stop"}));
    assert_eq!(far.answer()["code"], "auth");
    far.say(json!({"type": "auth", "token": TOKEN}));
    assert_eq!(far.answer()["type"], "hello");
    far.say(begin("t"));
    far.say(vowel(0.1));
    far.say(end());
    for kind in ["accepted", "started", "finished"] {
        far.expect(kind, "t");
    }
    let mut wrong = Client::tcp(tcp);
    wrong.say(json!({"type": "auth", "token": "0123456789abcdefghiJ"}));
    assert_eq!(wrong.answer()["code"], "auth");
    assert_eq!(wrong.next(), None, "no second guess");

    let with_token = format!("/?token={TOKEN}");
    assert_eq!(
        websocket(ws, &with_token, Some("https://evil.example")).err(),
        Some(403)
    );
    assert_eq!(websocket(ws, "/?token=guess", None).err(), Some(401));
    websocket(ws, &with_token, Some("http://127.0.0.1:80")).unwrap();
    let mut page = websocket(ws, &with_token, Some("https://kiosk.example")).unwrap();
    say(
        &mut page,
        json!({"type": "begin", "id": "w", "audio": {"rate": 8000}}),
    );
    say(&mut page, vowel(0.1));
    for _ in 0..2 {
        page.send(Message::binary(vec![0; 400])).unwrap();
    }
    say(&mut page, end());
    for kind in ["accepted", "started", "finished"] {
        assert_eq!(heard(&mut page)["type"], kind);
    }
    let mut later = websocket(ws, "/", None).unwrap();
    later.send(Message::binary(vec![0; 2])).unwrap();
    assert_eq!(heard(&mut later)["code"], "auth");
    say(&mut later, json!({"type": "auth", "token": TOKEN}));
    assert_eq!(heard(&mut later)["type"], "hello");

    // `say` finds its way with the token, too.
    let labels = folder.path().join("a.phn");
    std::fs::write(&labels, "0 1600 aa\n").unwrap();
    let said = mouthpiece()
        .args([
            "say",
            "--listen",
            &at_tcp,
            "--token-file",
            &token,
            "--labels",
        ])
        .arg(&labels)
        .output()
        .unwrap();
    assert!(said.status.success(), "{}", text(&said));
}

/// Guards that a port beyond this machine is never open to everybody.
#[test]
fn beyond_this_machine_only_with_a_token_that_is_secret() {
    let folder = tempfile::tempdir().unwrap();
    let token = token_file(folder.path());
    let refused = |args: &[&str]| {
        let mut command = mouthpiece();
        command.args(["run", "--http", "none", "--audio-device", "none"]);
        let output = command.args(args).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        text(&output)
    };
    let why = refused(&["--listen", "0.0.0.0:0"]);
    assert!(why.contains("--token-file"), "{why}");
    let open = std::fs::Permissions::from_mode(0o644);
    std::fs::set_permissions(&token, open).unwrap();
    let why = refused(&["--listen", "127.0.0.1:0", "--token-file", &token]);
    assert!(why.contains("chmod 600"), "{why}");
    assert!(!why.contains(TOKEN));
}

/// Guards expressions, gaze, states and captions: taken, checked, and answered where wrong.
#[test]
fn a_face_is_shown_or_the_answer_says_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let daemon = Daemon::start(&folder.path().join("face.sock"));
    let mut client = daemon.call();
    for line in [
        json!({"type": "express", "expression": "happiness", "weight": 0.8, "fade_s": 0.2}),
        json!({"type": "express", "muscles": {"frontalis_outer_l": 0.8}}),
        json!({"type": "look", "at": [200, 0, 600]}),
        json!({"type": "look"}),
        json!({"type": "state", "state": "thinking"}),
        json!({"type": "caption", "text": "Hello"}),
        json!({"type": "express", "expression": "hapiness"}),
        json!({"type": "express", "muscles": {"frontalis": 1}}),
        json!({"type": "ping"}),
    ] {
        client.say(line);
    }
    for name in ["`happiness`", "`mentalis`"] {
        let answer = client.answer();
        assert_eq!(answer["code"], "face");
        assert!(
            answer["message"].as_str().unwrap().contains(name),
            "{answer}"
        );
    }
    assert_eq!(client.answer()["type"], "pong");
    client.say(json!({"type": "begin", "id": "i", "alphabet": "ipa"}));
    client.say(json!({"type": "phones", "phones": [{"start": 0, "end": 0.1, "phone": "ɬ"}]}));
    client.say(end());
    for kind in ["accepted", "warning", "started", "finished"] {
        client.expect(kind, "i");
    }
}

/// Guards the places that clients take: who says nothing, or never ends a line, is let go.
#[test]
fn silent_clients_are_told_and_let_go() {
    let folder = tempfile::tempdir().unwrap();
    let config = configured(folder.path(), "silent_seconds = 1\n");
    let port = free_port();
    let at = format!("127.0.0.1:{port}");
    let socket = folder.path().join("face.sock");
    let daemon = Daemon::start_with(&socket, &["--config", &config, "--listen", &at]);

    // Says nothing, over a connection that stays open.
    let mut silent = Client::tcp(port);
    let answer = silent.answer();
    assert_eq!(answer["code"], "limit", "{answer}");
    assert_eq!(silent.next(), None);

    // Drips a byte at a time and never ends a line.
    let mut dripping = daemon.call();
    while dripping.stream.write_all(b"x").is_ok() {
        std::thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(dripping.answer()["code"], "limit");
}

/// Guards other clients against one that floods and one that reads nothing.
#[test]
fn rude_clients_are_slowed_or_let_go_and_others_do_not_notice() {
    let folder = tempfile::tempdir().unwrap();
    let config = configured(
        folder.path(),
        "clients = 6\nlines_per_second = 200\nbytes_per_second = 100000000\nwrite_seconds = 1\nline_bytes = 100000\n",
    );
    let daemon = Daemon::start_with(&folder.path().join("face.sock"), &["--config", &config]);

    // A line of 100 MB is one error, and the connection goes on.
    let mut long = daemon.call();
    let piece = vec![b'x'; 1 << 20];
    let mut writer = long.stream.try_clone().unwrap();
    let writing = std::thread::Builder::new()
        .name("long".into())
        .spawn(move || {
            for _ in 0..100 {
                writer.write_all(&piece).unwrap();
            }
            writer.write_all(b"\n{\"type\":\"ping\"}\n").unwrap();
        })
        .unwrap();

    // Floods with garbage, and reads what comes of it; another reads nothing.
    let garbage = b"\xff\n{\n[]\n0 0 0\n".repeat(200);
    let mut flooding = daemon.call();
    flooding.stream.write_all(&garbage).unwrap();
    let mut deaf = daemon.call();
    let deaf_since = Instant::now();
    deaf.stream
        .set_write_timeout(Some(Duration::from_secs(30)))
        .unwrap();
    let mut sent = 0;
    while deaf.stream.write_all(&garbage).is_ok() && sent < 500 {
        sent += 1;
        // Somebody polite is served all the while.
        let mut client = daemon.call();
        client.say(begin("p"));
        client.say(vowel(0.05));
        client.say(end());
        for kind in ["accepted", "started", "finished"] {
            client.expect(kind, "p");
        }
        if deaf_since.elapsed() > Duration::from_secs(3) {
            break;
        }
    }
    // It took no answers meanwhile: it may have been let go, with those that were under way.
    let codes: Vec<Value> = std::iter::from_fn(|| flooding.next())
        .take(100)
        .map(|answer| answer["code"].clone())
        .collect();
    assert!(codes.contains(&json!("malformed")) && codes.contains(&json!("label")));

    writing.join().unwrap();
    let codes: Vec<Value> = (0..2).map(|_| long.answer()["code"].clone()).collect();
    assert!(codes.contains(&json!("limit")), "{codes:?}");

    // No more than six at a time.
    let crowd: Vec<_> = (0..8).map(|_| daemon.call()).collect();
    let turned_away = crowd.into_iter().filter_map(|mut client| {
        // Who was let in hears nothing.
        let patience = Duration::from_secs(1);
        client.stream.set_read_timeout(Some(patience)).unwrap();
        client.next()
    });
    assert!(turned_away.filter(|a| a["code"] == "busy").count() >= 2);
}

/// Guards whoever changes bounds against having to end the daemon: who connects from then on finds the new ones, who
/// was there keeps its own.
#[test]
fn changed_bounds_are_found_by_who_connects_from_then_on() {
    let folder = tempfile::tempdir().unwrap();
    let config = configured(folder.path(), "");
    let daemon = Daemon::start_with(&folder.path().join("face.sock"), &["--config", &config]);
    let judged = |client: &mut Client| {
        // One that was turned away takes nothing.
        let _ = writeln!(client.stream, "{}", "x".repeat(2000));
        client.next().map(|answer| answer["code"].clone())
    };
    let mut old = daemon.call();
    assert_eq!(judged(&mut old), Some(json!("malformed")));
    configured(folder.path(), "line_bytes = 1024\nclients = 2\n");
    daemon.signal("-HUP");
    let begun = Instant::now();
    let mut second = daemon.call();
    while judged(&mut second) != Some(json!("limit")) {
        assert!(begun.elapsed() < PATIENCE, "the new bounds are not found");
        std::thread::sleep(Duration::from_millis(20));
        second = daemon.call();
    }
    assert_eq!(daemon.call().answer()["code"], "busy", "there are two");
    assert_eq!(judged(&mut old), Some(json!("malformed")));
}

/// Guards files of the daemon's user against clients.
#[test]
fn sound_files_are_read_below_their_folder_only() {
    let folder = tempfile::tempdir().unwrap();
    let sounds = folder.path().join("sounds");
    std::fs::create_dir(&sounds).unwrap();
    let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/demo.wav");
    for name in ["sounds/in.wav", "out.wav"] {
        std::fs::copy(&fixture, folder.path().join(name)).unwrap();
    }
    symlink("../out.wav", sounds.join("link.wav")).unwrap();
    let config = configured(folder.path(), &format!("files = {sounds:?}\n"));
    let port = free_port();
    let at = format!("127.0.0.1:{port}");
    let socket = folder.path().join("face.sock");
    let _daemon = Daemon::start_with(&socket, &["--config", &config, "--listen", &at]);
    let mut client = Client::tcp(port);
    let mut ask = |name: &str| {
        let file = sounds.join(name).display().to_string();
        client.say(json!({"type": "begin", "id": name, "audio": {"file": file}}));
        client.expect("accepted", name);
        if name == "in.wav" {
            client.say(json!({"type": "stop", "id": name}));
        }
        client.answer()["type"].clone()
    };
    for name in ["../out.wav", "link.wav", "missing.wav"] {
        assert_eq!(ask(name), "error", "{name}");
    }
    assert_eq!(ask("in.wav"), "stopped");
}

/// Guards a face whose client was killed: the rest of the queue is spoken, and nothing waits for ever.
#[test]
fn a_killed_client_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let daemon = Daemon::start(&socket);
    let mut child = mouthpiece()
        .args(["say", "--labels", "-", "--listen"])
        .arg(&socket)
        .stdin(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"0 16000 aa\n").unwrap();
    let mut watcher = daemon.call();
    watcher.say(begin("after"));
    watcher.say(vowel(0.1));
    watcher.say(end());
    watcher.expect("accepted", "after");
    child.kill().unwrap();
    child.wait().unwrap();
    // Whether the other one had begun or not.
    watcher.expect("started", "after");
    watcher.expect("finished", "after");
}

/// The labels and the sound of the demo's first second, in `folder`.
fn first_second(fixtures: &Path, folder: &Path) -> (PathBuf, PathBuf) {
    let (labels, sound) = (folder.join("short.PHN"), folder.join("short.wav"));
    let all = std::fs::read_to_string(fixtures.join("demo.PHN")).unwrap();
    // Samples of 16 kHz.
    let ends = |line: &&str| line.split(' ').nth(1).unwrap().parse::<u32>().unwrap();
    let kept: Vec<&str> = all.lines().filter(|line| ends(line) <= 16_000).collect();
    std::fs::write(&labels, kept.join("\n")).unwrap();
    let mut wav = hound::WavReader::open(fixtures.join("demo.wav")).unwrap();
    let spec = wav.spec();
    let mut short = hound::WavWriter::create(&sound, spec).unwrap();
    for sample in wav.samples::<i16>().take(spec.sample_rate as usize) {
        short.write_sample(sample.unwrap()).unwrap();
    }
    short.finalize().unwrap();
    (labels, sound)
}

/// Guards that sound may come through a pipe while it is made, and labels through another one.
#[test]
fn labels_and_sound_come_through_pipes_as_they_are_made() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let _daemon = Daemon::start(&socket);
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    let (labels, sound) = first_second(&fixtures, folder.path());
    let shell = |script: &str| {
        let output = std::process::Command::new("sh")
            .args(["-c", script, "sh", env!("CARGO_BIN_EXE_mouthpiece")])
            .args([&socket, &labels, &sound])
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .output()
            .unwrap();
        (output.status.code(), text(&output))
    };
    for script in [
        // Sound on standard input, labels from a file, or from another descriptor.
        r#"cat "$4" | "$1" say --listen "$2" --labels "$3" --audio -"#,
        r#"cat "$4" | "$1" say --listen "$2" --labels fd:3 --audio - 3<"$3""#,
        r#"{ cat "$3" | { cat "$4" | "$1" say --listen "$2" --labels fd:3 --audio - 3<&5; } 5<&0; }"#,
        // The other way round, and both from files by descriptor.
        r#"cat "$3" | "$1" say --listen "$2" --labels - --audio fd:4 4<"$4""#,
        // Lines of JSON.
        r#""$1" labels "$3" --to ndjson | "$1" say --listen "$2" --labels - --audio "$4""#,
    ] {
        let (code, said) = shell(script);
        assert_eq!(code, Some(0), "{script}: {said}");
    }
    let (code, said) = shell(r#"cat "$3" | "$1" say --listen "$2" --labels - --audio -"#);
    assert_eq!(code, Some(2), "{said}");

    // What was piped in is heard before its pipe is closed, though it is more than fits into the pipe.
    let (labels, sound) = (fixtures.join("demo.PHN"), fixtures.join("demo.wav"));
    let mut child = mouthpiece()
        .args(["say", "--audio", "-", "--labels"])
        .arg(&labels)
        .arg("--listen")
        .arg(&socket)
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let mut bytes = Vec::new();
    std::fs::File::open(&sound)
        .unwrap()
        .read_to_end(&mut bytes)
        .unwrap();
    for piece in bytes.chunks(bytes.len() / 20) {
        input.write_all(piece).unwrap();
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(input);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
}
