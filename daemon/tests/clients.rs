//! The example clients, each run as its users run it; skipped, and why is said, where what runs them is not
//! installed.

#![allow(
    clippy::unwrap_used,
    reason = "a test says what it expects, in short lines"
)]

mod harness;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use harness::{Daemon, free_port, text};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// What a client printed and how it ended; none where its interpreter is not there.
fn run(command: &mut Command) -> Option<Output> {
    match command.output() {
        Ok(output) => Some(output),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let name = command.get_program().to_string_lossy();
            println!("skipped: {name} is not installed");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn expect_finished(output: &Output) {
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", text(output));
    assert!(said.contains("finished"), "{said}");
}

#[test]
fn the_shell_speaks_with_and_without_sound() {
    let temporary = tempfile::tempdir().unwrap();
    let socket = temporary.path().join("face.sock");
    let _daemon = Daemon::start(&socket);
    if run(Command::new("socat").arg("-V")).is_none() {
        return;
    }
    let fixtures = folder("../tests/fixtures");
    for sound in ["", "demo.wav"] {
        let mut command = Command::new("sh");
        command.arg(folder("clients/speak.sh"));
        command.arg(fixtures.join("demo.PHN"));
        match sound {
            "" => command.arg(""),
            name => command.arg(fixtures.join(name)),
        };
        expect_finished(&run(command.arg(&socket)).unwrap());
    }
}

#[test]
fn python_speaks_over_the_socket_and_over_tcp_with_a_token() {
    use std::os::unix::fs::PermissionsExt as _;
    let temporary = tempfile::tempdir().unwrap();
    let socket = temporary.path().join("face.sock");
    let token = temporary.path().join("token");
    std::fs::write(&token, "0123456789abcdefghij\n").unwrap();
    std::fs::set_permissions(&token, std::fs::Permissions::from_mode(0o600)).unwrap();
    let at = format!("127.0.0.1:{}", free_port());
    let token = token.to_str().unwrap();
    let _daemon = Daemon::start_with(&socket, &["--listen", &at, "--token-file", token]);
    let fixtures = folder("../tests/fixtures");
    let speak = |args: &[&str]| {
        let mut command = Command::new("python3");
        command.arg(folder("clients/speak.py"));
        command.arg(fixtures.join("demo.PHN"));
        run(command.args(args))
    };
    let near = socket.to_str().unwrap();
    let sound = fixtures.join("demo.wav");
    let Some(output) = speak(&["--at", near]) else {
        return;
    };
    expect_finished(&output);
    let sound = sound.to_str().unwrap();
    let args = [
        sound,
        "--at",
        &at,
        "--token-file",
        token,
        "--caption",
        "Hello",
    ];
    expect_finished(&speak(&args).unwrap());
    let refused = speak(&["--at", &at]).unwrap();
    assert_eq!(refused.status.code(), Some(1));
}

#[test]
fn javascript_speaks_over_a_websocket() {
    let temporary = tempfile::tempdir().unwrap();
    let port = free_port();
    let at = format!("ws://127.0.0.1:{port}");
    let socket = temporary.path().join("face.sock");
    let _daemon = Daemon::start_with(&socket, &["--listen", &at]);
    let client = folder("clients/mouthpiece.js").canonicalize().unwrap();
    let script = format!(
        r#"
        if (typeof WebSocket === "undefined") {{
            console.log("this Node has no WebSocket");
            process.exit(77);
        }}
        const {{ Mouthpiece }} = await import("file://{client}");
        const face = await Mouthpiece.connect("{at}");
        const labels = [{{ start: 0, end: 0.3, phone: "aa" }}];
        const samples = new Float32Array(8000 * 0.3);
        face.send({{ type: "express", expression: "smile" }});
        const heard = await face.speak({{ labels, sound: {{ samples, rate: 8000 }}, caption: "a" }});
        console.log(heard.type);
        await face.speak({{ labels, alphabet: "klingon" }}).then(
            () => process.exit(1),
            (error) => console.log(error.message),
        );
        face.close();
        "#,
        client = client.display()
    );
    // Node 20 has it behind this flag, which later ones take and need no more.
    let arguments = [
        "--experimental-websocket",
        "--input-type=module",
        "-e",
        &script,
    ];
    let Some(output) = run(Command::new("node").args(arguments)) else {
        return;
    };
    let said = String::from_utf8_lossy(&output.stdout);
    if output.status.code() == Some(77) || text(&output).contains("bad option") {
        println!("skipped: this Node has no WebSocket");
        return;
    }
    expect_finished(&output);
    assert!(said.contains("klingon"), "{said}");
}
