//! Text instead of labels: engines of this machine speak it, or a recording is searched for it. A test
//! whose engine is not installed says so and is skipped.

use std::fs;

use mouthpiece_tests::curves::Table;
use mouthpiece_tests::{binary, mp4};

use crate::graphics;

/// Seven bilabials with a vowel between each and the next.
const TEXT: &str = "Bobby may keep a happy puppy.";
const BILABIALS: usize = 7;
/// Between two closures the lips come at least this far apart.
const APART_MM: f64 = 0.3;

/// Whether `mouthpiece doctor` finds the engine.
fn has(engine: &str) -> bool {
    // Its status is about graphics, not engines.
    let found = binary::run(&["doctor"]).text();
    let has = found
        .lines()
        .any(|line| line.trim().starts_with(&format!("{engine}: ")));
    if !has {
        eprintln!("skipped: {engine} is not installed");
    }
    has
}

/// How often the lips closed: runs of rows without a gap, with lips apart in between.
fn closures(table: &Table) -> usize {
    let (mut count, mut closed) = (0, false);
    for gap in table.column("aperture_mm") {
        if gap <= 0.0 && !closed {
            count += 1;
            closed = true;
        } else if gap > APART_MM {
            closed = false;
        }
    }
    count
}

/// Guards what `--text` is for: every engine's labels close the lips as often as its words do, and
/// last as long as its sound.
#[test]
fn every_engine_that_is_here_closes_every_bilabial() {
    for engine in ["flite", "espeak-ng", "festival", "piper"] {
        if !has(engine) {
            continue;
        }
        let run = binary::run(&["curves", "--text", TEXT, "--tts", engine, "--rate", "200"]);
        let table = Table::parse(&run.expect_done().text());
        let count = closures(&table);
        assert!(count >= BILABIALS, "{engine}: {count} closures");
        assert!(run.stderr.is_empty(), "{engine}: {}", run.stderr);
    }
}

/// Guards the length of labels against that of the sound, through a whole export.
#[test]
fn a_spoken_video_is_as_long_as_its_sound() {
    if !graphics::are_there_for("a video of a text") {
        return;
    }
    for engine in ["flite", "espeak-ng"] {
        if !has(engine) {
            continue;
        }
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("o.mp4").to_string_lossy().into_owned();
        let size = ["--size", "64x64", "--tier", "low", "--fps", "25"];
        let say = ["export", "--text", TEXT, "--tts", engine, "-o", &out];
        binary::run(&[&say[..], &size[..]].concat()).expect_done();
        let curves = binary::run(&["curves", "--text", TEXT, "--tts", engine, "--rate", "240"]);
        let times = Table::parse(&curves.expect_done().text()).column("time_s");
        let file = fs::read(&out).unwrap();
        let (picture, sound) = (mp4::track_of(&file, "vide"), mp4::track_of(&file, "soun"));
        let spoken_s = times.last().copied().unwrap_or(0.0);
        assert!((1.0..5.0).contains(&spoken_s), "{engine}: {spoken_s}");
        // The last frame may reach past the sound, and the sound past the last row, by less than itself.
        for (what, track) in [("picture", picture), ("sound", sound)] {
            let over = track.plays_s - spoken_s;
            assert!((-0.002..0.047).contains(&over), "{engine}: {what} {over}");
        }
    }
}

/// Guards recordings without labels: the demo's own words, found in its sound.
#[test]
fn a_recording_needs_only_its_text() {
    if !has("pocketsphinx") {
        return;
    }
    let wav = binary::root().join("tests/fixtures/flite.wav");
    let wav = wav.to_string_lossy();
    let text = "Bob saw Pam buy five warm apple pies. My father saw the blue moon above the shop.";
    let run = binary::run(&["curves", "--text", text, "--audio", &wav]);
    let count = closures(&Table::parse(&run.expect_done().text()));
    // b b p m b m p p m b m b p, of which `m b` and `p p` may be one.
    assert!(count >= 11, "{count} closures");
    assert!(run.stderr.contains("pocketsphinx"), "{}", run.stderr);
    let run = binary::run(&[
        "curves",
        "--text",
        "Nothing of the kind was ever said in here, I am sure.",
        "--audio",
        &wav,
    ]);
    assert!(run.expect_sentence(1).contains("flite.wav"));
}

/// Guards the way out for who has no engine, or asks for two things at once.
#[test]
fn what_is_missing_is_said_in_one_sentence() {
    for engine in ["flite", "espeak-ng", "festival", "piper"] {
        let mut command = binary::command(&["curves", "--text", "Hello", "--tts", engine]);
        command.env("PATH", "").stdout(std::process::Stdio::piped());
        let run = binary::start(&mut command).finish();
        let sentence = run.expect_sentence(1);
        assert!(sentence.contains("install"), "{sentence}");
        assert!(sentence.contains(engine), "{sentence}");
    }
    let run = binary::run(&["curves", "--text", "Hello"]);
    assert!(run.expect_sentence(2).contains("--tts"));
    for wrong in [
        &["curves", "--text", "Hello", "--tts", "nobody"][..],
        &[
            "curves", "--text", "Hello", "--tts", "flite", "--labels", "x.phn",
        ],
        &["curves", "--tts", "flite"],
        &["curves", "--demo", "--text", "Hello", "--tts", "flite"],
    ] {
        assert_eq!(binary::run(wrong).code(), 2, "{wrong:?}");
    }
}
