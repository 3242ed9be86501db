//! A client over TCP whose machine lost its power in mid-sentence: its half of the connection is open, and nothing
//! comes any more, nor is anything taken.
//!
//! Before the system finds out (a minute, see the daemon's `server/tcp.rs`) the wire's own bounds do: the face has
//! said what it has, the utterance ends, and the client's place is free.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};

use mouthpiece_tests::daemon::{Daemon, PATIENCE};
use serde_json::Value;

/// Guards the face and the places of others against who vanishes without a word.
#[test]
fn a_client_that_vanishes_in_mid_sentence_is_let_go() {
    let folder = tempfile::tempdir().unwrap();
    let config = folder.path().join("config.toml");
    std::fs::write(&config, "[wire]\nsilent_seconds = 1\nstarved_seconds = 1\n").unwrap();
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = free.local_addr().unwrap();
    drop(free);
    let (config, listen) = (config.to_string_lossy(), address.to_string());
    let daemon = Daemon::start(None, &["--config", &*config, "--listen", &listen]);

    let mut client = TcpStream::connect(address).unwrap();
    client
        .write_all(
            b"{\"type\":\"begin\",\"id\":\"a\"}\n\
              {\"type\":\"phones\",\"phones\":[{\"start\":0,\"end\":0.5,\"phone\":\"aa\"}]}\n",
        )
        .unwrap();
    let _ = daemon.status_when("it speaks", |s| {
        s["clients"] == 1 && s["utterances"]["queue"] == 1
    });
    let after = daemon.status_when("it is let go", |s| s["clients"] == 0);
    let utterances = &after["utterances"];
    assert_eq!(
        (&utterances["queue"], &utterances["error"]),
        (&0.into(), &1.into()),
        "{after:#}"
    );
    let text = daemon.get("/metrics").text();
    assert!(
        text.lines().any(|l| l == "mouthpiece_clients 0.0"),
        "{text}"
    );

    // Had it still been there, it would have known why; and there is nothing behind the last word.
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut heard = String::new();
    client.read_to_string(&mut heard).unwrap();
    let heard: Vec<Value> = heard
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .filter(|answer: &Value| answer["type"] != "progress")
        .collect();
    let told: Vec<_> = heard
        .iter()
        .map(|a| (&a["type"], &a["code"]))
        .map(|(kind, code)| (kind.as_str().unwrap(), code.as_str().unwrap_or("")))
        .collect();
    assert_eq!(
        told,
        [
            ("accepted", ""),
            ("started", ""),
            ("error", "busy"),
            ("error", "limit")
        ]
    );
    assert_eq!(heard[2]["fatal"], true);
}
