//! Health: what a supervisor, Prometheus and a person with a browser are told, and faults that must heal.

use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;
use std::time::{Duration, Instant};

use mouthpiece_tests::daemon::Daemon;
use mouthpiece_tests::picture::Picture;
use mouthpiece_tests::screen::Screen;
use mouthpiece_tests::{binary, or_skipped};
use serde_json::json;

/// Small and cheap: these tests are about what is told of the picture.
const SMALL: [&str; 5] = ["--size", "240x240", "--tier", "low", "--test"];

fn healthy(status: &serde_json::Value) -> bool {
    status["ok"] == json!(true)
}

/// Guards a supervisor against a process that runs but shows nothing, the figures' format, and the door.
#[test]
fn without_a_screen_a_face_is_ill_and_its_figures_count() {
    let daemon = Daemon::start(None, &[]);
    let _ = daemon.status_when("the simulation runs", |s| {
        s["parts"]["simulation"]["ok"] == json!(true)
    });
    let health = daemon.get("/healthz");
    assert_eq!(health.code, 503);
    let told = health.json();
    assert_eq!(
        (&told["ok"], &told["parts"]["window"]["ok"]),
        (&json!(false), &json!(false))
    );
    let why = told["parts"]["window"]["why"].as_str().unwrap();
    assert!(why.contains("no picture"), "{why}");

    let mut client = daemon.call();
    for id in ["a", "b"] {
        client.say(&json!({"type": "begin", "id": id}));
        let phones = json!([{"start": 0, "end": 0.2, "phone": "aa"}]);
        client.say(&json!({"type": "phones", "phones": phones}));
        client.say(&json!({"type": "end"}));
        for kind in ["accepted", "started", "finished"] {
            client.expect(kind);
        }
    }
    let _ = daemon.status_when("nothing waits", |s| s["utterances"]["queue"] == 0);
    let metrics = daemon.get("/metrics");
    assert!(
        metrics
            .header("content-type")
            .starts_with("application/openmetrics-text")
    );
    let text = metrics.text();
    for line in [
        "mouthpiece_utterances_accepted_total 2",
        "mouthpiece_utterances_ended_total{end=\"finished\"} 2",
        "mouthpiece_utterances_ended_total{end=\"error\"} 0",
        "mouthpiece_clients 1.0",
        "mouthpiece_well 0.0",
    ] {
        assert!(text.lines().any(|l| l == line), "{line} is not in\n{text}");
    }
    well_formed(&text);

    // The door: only this machine's names, only what there is, only reading.
    for (host, path, code) in [
        ("evil.example", "/healthz", 403),
        ("localhost", "/healthz", 503),
        ("localhost", "/nothing", 404),
    ] {
        let asked = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        let answer = daemon.request(&asked);
        assert_eq!(answer.code, code, "{host}{path}");
        assert!(
            answer
                .header("content-security-policy")
                .contains("default-src 'none'")
        );
    }
    let posted = "POST /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    assert_eq!(daemon.request(posted).code, 405);

    // Taken: the second daemon says so and lives; whoever asks at the port gets the first one's health.
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("b.sock");
    let mut second = binary::command(&["run", "--audio-device", "none", "--http", &daemon.http]);
    let second = binary::start(second.arg("--listen").arg(&socket));
    let begun = Instant::now();
    while std::os::unix::net::UnixStream::connect(&socket).is_err() {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "the second does not listen"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
    second.signal("TERM");
    let second = second.finish();
    assert_eq!(second.code(), 0, "{}", second.stderr);
    assert!(
        second.stderr.contains("health is not told"),
        "{}",
        second.stderr
    );

    // Its log is JSON to the last line, and names the part.
    daemon.signal("TERM");
    let mut daemon = daemon;
    assert!(daemon.finish().success());
    let log = daemon.log();
    assert!(log.lines().count() > 2, "{log}");
    for line in log.lines() {
        let line: serde_json::Value =
            serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"));
        for key in ["timestamp", "level", "target", "threadName", "message"] {
            assert!(line[key].is_string(), "no {key}: {line}");
        }
    }
}

/// Guards figures against being told to other machines.
#[test]
fn other_machines_are_let_in_with_a_token_only() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let args = [
        "run",
        "--http",
        "0.0.0.0:0",
        "--audio-device",
        "none",
        "--listen",
    ];
    let ended = binary::start(binary::command(&args).arg(&socket)).finish();
    assert!(
        ended.expect_sentence(2).contains("token"),
        "{}",
        ended.stderr
    );

    let (file, token) = (folder.path().join("token"), "0123456789abcdefghij");
    std::fs::write(&file, token).unwrap();
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o600)).unwrap();
    let file = file.to_string_lossy();
    let daemon = Daemon::start_at("0.0.0.0:0", None, &["--token-file", &*file]);
    let ask = |path: &str, header: &str| {
        let head = format!("GET {path} HTTP/1.1\r\nHost: kiosk.example\r\n");
        daemon.request(&format!("{head}{header}Connection: close\r\n\r\n"))
    };
    for path in ["/", "/healthz", "/metrics", "/status.json", "/preview.png"] {
        for header in ["", "Authorization: Bearer 0123456789abcdefghiJ\r\n"] {
            let refused = ask(path, header);
            assert_eq!(refused.code, 401, "{path} {header}");
            assert!(refused.header("www-authenticate").contains("Basic"));
            assert!(!refused.text().contains("mouthpiece_"));
        }
    }
    let bearer = format!("Authorization: Bearer {token}\r\n");
    for path in ["/", "/metrics", "/status.json"] {
        assert_eq!(ask(path, &bearer).code, 200, "{path}");
    }
    assert!(!daemon.log().contains(token));
}

/// Each line is a comment, or a name, perhaps labels, and a number; the last one is the end.
fn well_formed(text: &str) {
    assert_eq!(text.lines().last(), Some("# EOF"));
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let (name, value) = line.rsplit_once(' ').unwrap_or_default();
        assert!(
            name.starts_with("mouthpiece_") && value.parse::<f64>().is_ok(),
            "{line}"
        );
    }
}

/// Guards the whole of it with a face on a screen: health, the picture, the page in a browser; and that a process that
/// was suspended, and one whose graphics device is lost, go on as if nothing had been.
#[test]
fn a_face_on_a_screen_is_well_can_be_looked_at_and_heals() {
    let Some(screen) = or_skipped(Screen::start()) else {
        return;
    };
    let daemon = Daemon::start(Some(&screen), &SMALL);
    let before = daemon.status_when("well", healthy);
    assert_eq!(daemon.get("/healthz").code, 200);
    assert_eq!(before["window"]["tier"], "low");

    let preview = daemon.get("/preview.png");
    assert_eq!(
        (preview.code, preview.header("content-type")),
        (200, "image/png")
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("preview.png");
    std::fs::write(&file, &preview.body).unwrap();
    let picture = Picture::read(&file);
    assert_eq!((picture.width, picture.height), (240, 240));
    let skin = picture
        .rgb
        .chunks_exact(3)
        .filter(|p| p[0] > p[1] && p[1] > p[2])
        .count();
    assert!(skin > 240 * 240 / 10, "{skin} pixels of skin");

    in_a_browser(&daemon);
    suspended(&daemon);
    without_graphics(&daemon);
    assert!(
        !daemon.log().contains("\"level\":\"ERROR\""),
        "{}",
        daemon.log()
    );
}

/// The page, where a Chromium is installed.
fn in_a_browser(daemon: &Daemon) {
    let names = [
        "chromium-headless-shell",
        "chromium",
        "chromium-browser",
        "google-chrome",
    ];
    let folder = tempfile::tempdir().unwrap();
    let page = format!("http://{}/", daemon.http);
    let profile = format!("--user-data-dir={}", folder.path().display());
    let found = names.iter().find_map(|name| {
        Command::new(name)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                &profile,
                // Time in the page waits for what it asks for, so that the first answer is shown.
                "--virtual-time-budget=4000",
            ])
            .args(["--dump-dom", &page])
            .output()
            .ok()
    });
    let Some(output) = found else {
        println!("skipped: no Chromium is installed to show the page ({names:?})");
        return;
    };
    let dom = String::from_utf8_lossy(&output.stdout);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        dom.contains("A face is on the screen and moving"),
        "{dom}\n{said}"
    );
    assert!(dom.contains("src=\"preview.png?"), "{dom}");
    assert!(!said.contains("Content Security Policy"), "{said}");
}

/// SIGSTOP in the middle of an utterance, three seconds, SIGCONT.
fn suspended(daemon: &Daemon) {
    let mut client = daemon.call();
    client.say(&json!({"type": "begin", "id": "long"}));
    let phones = json!([{"start": 0, "end": 8, "phone": "aa"}]);
    client.say(&json!({"type": "phones", "phones": phones}));
    client.say(&json!({"type": "end"}));
    client.expect("accepted");
    client.expect("started");
    let before = daemon.get("/status.json").json();
    daemon.signal("STOP");
    std::thread::sleep(Duration::from_secs(3));
    daemon.signal("CONT");
    let after = daemon.status_when("well again", healthy);
    // What nobody could see is skipped: 120 key frames are made for each second that is seen, and the lead.
    let frames = |s: &serde_json::Value| s["simulation"]["key_frames"].as_u64().unwrap();
    let seconds = |s: &serde_json::Value| s["uptime_s"].as_f64().unwrap();
    let awake_s = seconds(&after) - seconds(&before) - 3.0;
    let made = (frames(&after) - frames(&before)) as f64;
    assert!(
        made < 120.0 * (awake_s + 1.3),
        "{made} key frames in {awake_s} s"
    );
    client.expect("finished");
    client.say(&json!({"type": "ping", "token": "still here"}));
    assert_eq!(client.answer()["token"], "still here");
}

/// The graphics device is destroyed: the window is set up again and the face is back.
fn without_graphics(daemon: &Daemon) {
    let before = daemon.get("/status.json").json();
    daemon.signal("USR2");
    let failures = before["window"]["failures"].as_u64().unwrap();
    let lost = daemon.status_when("the device is lost", |s| {
        s["window"]["failures"].as_u64() > Some(failures)
    });
    let shown = lost["window"]["pictures"].as_u64();
    let _ = daemon.status_when("pictures again", |s| {
        healthy(s) && s["window"]["pictures"].as_u64() > shown.map(|n| n + 10)
    });
}
