//! What the targets of other programs' formats check: no panic, messages that fit a terminal, labels
//! in order; and what was read can be written in each format that can say it, and reads back.

use mouthpiece_phonemes::{
    Alphabet, Labels, ReadOptions, SampleRate, Source, WRITERS, check, reader,
};

/// Reads `bytes` as a file of `format`. The length of the file chooses what else is asked for, so
/// that samples are whole files.
pub fn read(format: &str, bytes: &[u8]) {
    let Ok(reader) = reader(format) else {
        panic!("{format} is no format");
    };
    let source = Source {
        name: "fuzzed",
        bytes,
    };
    reader.detect(&source);
    let mut options = ReadOptions::default();
    options.alphabet = match bytes.len() % 11 {
        0 => Some(Alphabet::Ipa),
        1 => Some(Alphabet::XSampa),
        _ => None,
    };
    options.tier = match bytes.len() % 13 {
        0 => Some("2".to_owned()),
        1 => Some("words".to_owned()),
        _ => None,
    };
    match reader.read(&source, &options) {
        Ok(labels) => {
            in_order(&labels);
            for warning in check(&labels, Some(0)) {
                let _ = warning.to_string();
            }
            for note in &labels.notes {
                assert!(note.to_string().len() < 400, "{note}");
            }
            round_trip(&labels);
        }
        Err(error) => assert!(error.to_string().len() < 500, "{error}"),
    }
}

fn in_order(labels: &Labels) {
    let segments = &labels.segments;
    assert!(segments.iter().all(|s| 0 <= s.start && s.start < s.end));
    assert!(segments.is_sorted_by(|a, b| a.end <= b.start));
    assert!(labels.words.iter().all(|w| 0 <= w.start && w.start < w.end));
    assert!(labels.words.is_sorted_by_key(|w| w.start));
}

/// Phones alone: words may hold what a format cannot say.
fn round_trip(labels: &Labels) {
    let phones = Labels {
        segments: labels.segments.clone(),
        ..Labels::default()
    };
    for writer in WRITERS.iter().filter(|w| !w.name().starts_with("timit")) {
        let mut text = Vec::new();
        if writer.write(&phones, SampleRate::TIMIT, &mut text).is_err() {
            assert!(phones.segments.is_empty());
            continue;
        }
        let Ok(reader) = reader(writer.name()) else {
            panic!("{} is written but not read", writer.name());
        };
        let source = Source {
            name: "written",
            bytes: &text,
        };
        let mut options = ReadOptions::default();
        options.alphabet = Some(Alphabet::Timit);
        match reader.read(&source, &options) {
            Ok(again) if writer.name() == "ndjson" => assert_eq!(again.segments, phones.segments),
            Ok(again) => assert_eq!(again.end(), phones.end()),
            Err(error) => panic!("{error}"),
        }
    }
}
