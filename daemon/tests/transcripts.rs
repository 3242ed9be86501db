//! The conversations of the protocol's README, replayed against a running daemon: each line with `>` is sent,
//! each with `<` must come in its turn. And no message is left without one.

#![allow(
    clippy::unwrap_used,
    reason = "a test says what it expects, in short lines"
)]

mod harness;

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

use harness::{Client, Daemon, free_port};
use serde_json::Value;

/// Its blocks: what stands behind ```` ```text ````, and the lines.
fn conversations(readme: &str) -> Vec<(&str, Vec<&str>)> {
    let blocks = readme.split("\n```text").skip(1);
    let blocks = blocks.map(|block| block.split("\n```").next().unwrap());
    blocks
        .map(|block| {
            let (kind, lines) = block.split_once('\n').unwrap();
            (kind.trim(), lines.lines().collect())
        })
        .collect()
}

/// Whether `answer` is what is shown: each field that is shown, texts up to an ellipsis, positions by their
/// kind alone.
fn fits(shown: &Value, answer: &Value) -> bool {
    let shown = shown.as_object().unwrap();
    shown.iter().all(|(name, value)| match value {
        Value::Number(_) if name == "position_s" => answer[name].is_number(),
        Value::String(text) => {
            let said = answer[name].as_str().unwrap_or_default();
            match text.split_once('…') {
                Some((begin, _)) => said.starts_with(begin),
                None => said == text,
            }
        }
        value => answer[name] == *value,
    })
}

fn replay<S: Write>(mut client: Client<S>, lines: &[&str]) {
    for line in lines {
        if let Some(sent) = line.strip_prefix('>') {
            client.say(sent.trim());
        } else {
            let shown = line.strip_prefix("< ").unwrap();
            let shown: Value = serde_json::from_str(shown).unwrap();
            let answer = if shown["type"] == "progress" {
                client.any()
            } else {
                client.answer()
            };
            assert!(fits(&shown, &answer), "{answer} instead of {shown}");
        }
    }
}

#[test]
fn conversations_of_the_readme_run_as_printed_and_show_every_message() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(crate_folder.join("protocol/README.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let token = folder.path().join("token");
    std::fs::write(&token, "0123456789abcdefghij\n").unwrap();
    let private = std::os::unix::fs::PermissionsExt::from_mode(0o600);
    std::fs::set_permissions(&token, private).unwrap();
    let port = free_port();
    let at = format!("127.0.0.1:{port}");
    let socket = folder.path().join("face.sock");
    let daemon = Daemon::start_with(
        &socket,
        &["--listen", &at, "--token-file", token.to_str().unwrap()],
    );
    let mut seen = BTreeSet::new();
    for (kind, lines) in conversations(&readme) {
        for line in &lines {
            let mark = &line[..1];
            if let Ok(message) = serde_json::from_str::<Value>(line[1..].trim()) {
                seen.insert((
                    mark.to_owned(),
                    message["type"].as_str().unwrap().to_owned(),
                ));
            }
        }
        match kind {
            "token" => replay(Client::tcp(port), &lines),
            _ => replay(daemon.call(), &lines),
        }
    }

    let schema = std::fs::read_to_string(crate_folder.join("protocol/schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    for (mark, side) in [(">", "ClientMessage"), ("<", "DaemonMessage")] {
        for message in schema["$defs"][side]["oneOf"].as_array().unwrap() {
            let name = message["properties"]["type"]["const"].as_str().unwrap();
            let entry = (mark.to_owned(), name.to_owned());
            assert!(seen.contains(&entry), "no transcript shows {mark} {name}");
        }
    }
}
