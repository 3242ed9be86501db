//! Words under the face: the text that `say --text` says.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::net::UnixListener;
use std::process::Stdio;
use std::time::Duration;

use mouthpiece_tests::binary;
use mouthpiece_tests::display::Display;
use mouthpiece_tests::or_skipped;
use serde_json::Value;

const PATIENCE: Duration = Duration::from_secs(60);
const TEXT: &str = "Bobby may keep a happy puppy. Pam buys five warm apple pies.";

fn has_flite() -> bool {
    let found = binary::run(&["doctor"]).text();
    let has = found.lines().any(|l| l.trim().starts_with("flite: "));
    if !has {
        println!("skipped: flite is not installed");
    }
    has
}

/// Guards what a daemon is sent: each sentence with the moment from which on it is heard, before all labels.
#[test]
fn a_text_goes_to_the_daemon_with_its_captions() {
    if !has_flite() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("face.sock");
    let daemon = UnixListener::bind(&socket).unwrap();
    let socket = socket.to_string_lossy();
    let say = ["say", "--text", TEXT, "--tts", "flite", "--listen", &socket];
    let say = binary::start(&mut binary::command(&say));
    let (mut client, _) = daemon.accept().unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    let lines = BufReader::new(client.try_clone().unwrap()).lines();
    let messages = lines.map(|line| serde_json::from_str::<Value>(&line.unwrap()).unwrap());
    let (mut captions, mut sentences, mut id) = (Vec::new(), Vec::new(), Value::Null);
    for message in messages {
        match message["type"].as_str().unwrap() {
            "begin" => id = message["id"].clone(),
            "caption" => {
                assert!(sentences.is_empty(), "a caption after its labels");
                captions.push((message["start"].clone(), message["text"].clone()));
            }
            "phones" => sentences.extend(message["phones"].as_array().unwrap().clone()),
            "end" => break,
            _ => {}
        }
    }
    let texts: Vec<&Value> = captions.iter().map(|(_, text)| text).collect();
    assert_eq!(
        texts,
        TEXT.split_inclusive(". ")
            .map(str::trim)
            .collect::<Vec<_>>()
    );
    assert_eq!(captions[0].0, 0.0);
    // The second one begins where the pause between both ends, in ticks of 48 kHz.
    let pauses = sentences.iter().filter(|p| p["phone"] == "pau");
    let starts = pauses.map(|p| p["end"].as_f64().unwrap() / 48_000.0);
    let at = captions[1].0.as_f64().unwrap();
    let starts: Vec<f64> = starts.collect();
    assert!(
        starts.iter().any(|s| (s - at).abs() < 1e-6),
        "{at} {starts:?}"
    );
    writeln!(
        client,
        r#"{{"type":"finished","id":{id},"position_s":3.0}}"#
    )
    .unwrap();
    say.finish().expect_done();
}

/// Guards what is seen where no daemon runs: the words come with their sound, where captions are on.
#[test]
fn a_text_is_read_under_the_face() {
    let Some(display) = or_skipped(Display::start(320, 320)) else {
        return;
    };
    if !has_flite() || !crate::graphics::are_there_for("captions") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("face.toml");
    let text = "[window]\nfullscreen = true\n[look]\ntier = \"low\"\nbackground = \"#203040\"\n\
                [captions]\nstyle = \"box\"\nsize_percent = 8\n";
    fs::write(&file, text).unwrap();
    let letters = |d: &Display| {
        let foot = d.pixels(10, 260, 300, 50);
        foot.iter().filter(|p| p.iter().all(|c| *c > 225)).count() > 20
    };
    let file = file.to_string_lossy();
    let say = ["say", "--text", TEXT, "--tts", "flite", "--config", &file];
    let mut say = binary::command(&say);
    say.args(["--audio-device", "none"])
        .env("DISPLAY", &display.screen.name)
        .stdout(Stdio::null());
    let say = binary::start(&mut say);
    display.wait("white letters", letters);
    display.wait("their end", |d| !letters(d));
    say.finish().expect_done();
}
