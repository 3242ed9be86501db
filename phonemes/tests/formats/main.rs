//! Guards the readers and writers of other programs' label formats: on samples written by hand for
//! this project (`tests/samples`), on files that the programs themselves wrote (skipped where
//! they are absent), and on noise.

#![allow(clippy::unwrap_used, reason = "tests, and the helpers of tests")]

mod detect;
mod hostile;
mod material;
mod round_trip;
mod samples;
mod stream;

use std::path::{Path, PathBuf};

use mouthpiece_phonemes::{Labels, ReadOptions, TICK_RATE, read_file};

/// The folder of samples, one folder a format.
fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples")
}

/// Every sample: the format that it is in, and the file.
fn all_samples() -> Vec<(String, PathBuf)> {
    let mut all = Vec::new();
    for folder in std::fs::read_dir(samples()).unwrap() {
        let folder = folder.unwrap().path();
        let format = folder.file_name().unwrap().to_string_lossy().into_owned();
        for file in std::fs::read_dir(&folder).unwrap() {
            all.push((format.clone(), file.unwrap().path()));
        }
    }
    all.sort();
    all
}

/// A sample, read in the format that it seems to be in.
fn sample(name: &str) -> Labels {
    let labels = read_file(&samples().join(name), None, &ReadOptions::default());
    labels.unwrap_or_else(|error| panic!("{error}"))
}

/// `start phone end` for each phone, in milliseconds.
fn phones(labels: &Labels) -> String {
    let one =
        |s: &mouthpiece_phonemes::Segment| format!("{} {} {}", ms(s.start), s.phone, ms(s.end));
    labels
        .segments
        .iter()
        .map(one)
        .collect::<Vec<_>>()
        .join(", ")
}

/// The same for words.
fn words(labels: &Labels) -> String {
    let one = |w: &mouthpiece_phonemes::Word| format!("{} {} {}", ms(w.start), w.text, ms(w.end));
    labels.words.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn ms(ticks: i64) -> i64 {
    (ticks * 1000 + TICK_RATE / 2).div_euclid(TICK_RATE)
}

/// What the reader said of it, in one text.
fn notes(labels: &Labels) -> String {
    let all = labels.notes.iter().map(ToString::to_string);
    all.collect::<Vec<_>>().join("; ")
}
