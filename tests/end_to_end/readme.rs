//! The README's promises, kept word for word: its commands exist with the options it shows, and its
//! conversation with the daemon runs as printed.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::net::UnixStream;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use mouthpiece_tests::binary;
use mouthpiece_tests::wav::{self, Coding};
use serde_json::Value;

/// Far more than any answer takes; a daemon that says nothing must not stop the run.
const PATIENCE: Duration = Duration::from_secs(60);

fn readme() -> String {
    fs::read_to_string(binary::root().join("README.md")).unwrap()
}

/// Guards commands that people copy: each exists and takes the options it is shown with.
#[test]
fn the_commands_of_the_readme_exist_with_their_options() {
    let text = readme();
    let blocks = text.split("```sh\n").skip(1);
    let lines = blocks.flat_map(|block| block.split("```").next().unwrap_or_default().lines());
    let mut checked = 0;
    for line in lines {
        let Some(at) = line.find("mouthpiece ") else {
            continue;
        };
        let mut words = line[at..].split_whitespace().skip(1);
        let command = words.next().unwrap_or_default();
        // The head shop's commands are two words.
        let mut called = vec![command];
        if command == "head" {
            called.extend(words.next());
        }
        called.push("--help");
        let help = binary::run(&called);
        let help = help.expect_done().text();
        for option in words
            .take_while(|w| *w != "#")
            .filter(|w| w.starts_with("--"))
        {
            assert!(help.contains(option), "{command} has no {option}: {line}");
            checked += 1;
        }
    }
    assert!(checked >= 8, "only {checked} options found in the README");
}

/// Guards the conversation: lines with `>` are sent, each line with `<` must come in its turn, with
/// the fields it shows.
#[test]
fn the_conversation_of_the_readme_runs_as_printed() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let listen = format!("unix:{}", socket.display());
    let args = ["run", "--listen", &listen, "--audio-device", "none"];
    let mut daemon = binary::start(binary::command(&args).stdout(Stdio::null()));
    let begun = Instant::now();
    while !socket.exists() {
        assert!(!daemon.has_ended(), "{}", daemon.finish().stderr);
        assert!(begun.elapsed() < PATIENCE, "no socket");
        std::thread::sleep(Duration::from_millis(10));
    }
    let mut stream = UnixStream::connect(&socket).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut answers = BufReader::new(stream.try_clone().unwrap()).lines();

    let mut heard = 0;
    for line in readme().lines() {
        if let Some(sent) = line.strip_prefix("> {") {
            writeln!(stream, "{{{sent}").unwrap();
        } else if let Some(shown) = line.strip_prefix("< {") {
            let shown: Value = serde_json::from_str(&format!("{{{shown}")).unwrap();
            let answer = loop {
                let answer = answers.next().unwrap().unwrap();
                let answer: Value = serde_json::from_str(&answer).unwrap();
                // Progress comes as often as time allows.
                if answer["type"] == shown["type"] || answer["type"] != "progress" {
                    break answer;
                }
            };
            for field in ["type", "id"] {
                assert_eq!(answer[field], shown[field], "{answer} instead of {shown}");
            }
            heard += 1;
        }
    }
    assert!(heard >= 4, "only {heard} answers in the README");
}

/// Guards sound and labels through two pipes, as printed, with an engine that has written all of its labels, and closed
/// them, before its sound is asked for.
#[test]
fn two_pipes_are_spoken_as_the_readme_prints_it() {
    let text = readme();
    let command = text.split('`').find(|code| code.contains("3>labels |"));
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let sound = wav::file(Coding::S16, 16_000, 1, &wav::tone(16_000, 200.0, 0.0, 0.5));
    fs::write(at("sound.wav"), sound).unwrap();
    let engine = "#!/bin/sh\necho 0 8000 aa >&3\nexec 3>&-\nexec cat sound.wav\n";
    fs::write(at("my-tts"), engine).unwrap();
    fs::set_permissions(at("my-tts"), fs::Permissions::from_mode(0o755)).unwrap();
    let mut daemon = binary::command(&["run", "--audio-device", "none", "--http", "none"]);
    daemon
        .env("XDG_RUNTIME_DIR", folder.path())
        .stdout(Stdio::null());
    let mut daemon = binary::start(&mut daemon);
    let begun = Instant::now();
    while !at("mouthpiece.sock").exists() {
        assert!(!daemon.has_ended(), "{}", daemon.finish().stderr);
        assert!(begun.elapsed() < PATIENCE, "no socket");
        std::thread::sleep(Duration::from_millis(10));
    }
    let path = std::env::var("PATH").unwrap_or_default();
    let program = binary::path();
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("mkfifo labels && {}", command.unwrap())])
        .current_dir(folder.path())
        .env("XDG_RUNTIME_DIR", folder.path())
        .env("XDG_CONFIG_HOME", folder.path())
        .env(
            "PATH",
            format!(
                "{}:{}:{path}",
                folder.path().display(),
                program.parent().unwrap().display()
            ),
        )
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdin(Stdio::null());
    let said = binary::start(&mut shell).finish_within(PATIENCE);
    assert_eq!(said.code(), 0, "{command:?}: {}", said.stderr);
}
