//! Guards the project's own utterances: they read without a warning, fit their sound, and hold
//! the phones that the mouth is judged by.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use mouthpiece_phonemes::{
    Labels, Phone, ReadOptions, SampleRate, TICK_RATE, check, read_file, writer,
};

const NAMES: [&str; 3] = ["demo", "flite", "espeak"];

/// Vowels for which a mouth opens wide, when they last this long.
const OPEN: [Phone; 5] = [Phone::Aa, Phone::Ae, Phone::Ao, Phone::Aw, Phone::Ay];
const LONG_TICKS: i64 = TICK_RATE * 80 / 1000;

fn fixture(name: &str, extension: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    folder.join(name).with_extension(extension)
}

fn labels(name: &str, extension: &str) -> Labels {
    let path = fixture(name, extension);
    match read_file(&path, None, &ReadOptions::default()) {
        Ok(labels) => labels,
        Err(error) => panic!("{error}"),
    }
}

/// Length of a WAV file with the plain header of 44 bytes, in ticks, rounded down.
fn sound_ticks(name: &str) -> i64 {
    let bytes = std::fs::read(fixture(name, "wav")).unwrap_or_default();
    let number = |at: usize| {
        bytes[at..at + 4]
            .iter()
            .rfold(0, |n, b| n << 8 | i64::from(*b))
    };
    assert_eq!(&bytes[36..40], b"data", "{name}.wav has another header");
    assert_eq!(bytes.len() as i64, 44 + number(40), "{name}.wav is cut off");
    number(40) / 2 * TICK_RATE / number(24)
}

#[test]
fn each_reads_without_a_warning_and_ends_with_its_sound() {
    for name in NAMES {
        let mut labels = labels(name, "PHN");
        if fixture(name, "WRD").exists() {
            labels.words = self::labels(name, "WRD").words;
        }
        let sound = sound_ticks(name);
        assert_eq!(check(&labels, Some(sound)), [], "{name}");
        assert!((0..10).contains(&(sound - labels.end())), "{name}");
        let ends = [labels.segments.first(), labels.segments.last()];
        assert!(
            ends.iter()
                .all(|s| s.is_some_and(|s| s.phone == Phone::HSharp))
        );
    }
}

#[test]
fn each_is_written_back_byte_for_byte() {
    for name in NAMES {
        for (extension, format) in [("PHN", "timit"), ("WRD", "timit-words")] {
            let Ok(file) = std::fs::read(fixture(name, extension)) else {
                assert_eq!((name, extension), ("flite", "WRD"));
                continue;
            };
            let mut out = Vec::new();
            let labels = labels(name, extension);
            let written = writer(format).map(|w| w.write(&labels, SampleRate::TIMIT, &mut out));
            assert!(matches!(written, Ok(Ok(()))));
            assert!(out == file, "{name}.{extension}");
        }
    }
}

#[test]
fn together_they_hold_what_a_mouth_is_judged_by() {
    let all: Vec<_> = NAMES
        .iter()
        .flat_map(|n| labels(n, "PHN").segments)
        .collect();
    let phones: HashSet<&str> = all.iter().map(|s| s.phone.code()).collect();
    for code in "p b m f v w uw iy aa sh th r l pau h# pcl bcl tcl dcl jh".split(' ') {
        assert!(phones.contains(code), "no {code}");
    }
    let long = |phone| {
        all.iter()
            .any(|s| s.phone == phone && s.duration() >= LONG_TICKS)
    };
    assert!(OPEN.into_iter().all(long));
    assert!(all.iter().filter(|s| s.phone.is_bilabial()).count() > 40);
    // A release is never without the closure before it.
    for pair in all.windows(2) {
        if let Some(closure) = pair[1].phone.closure() {
            assert_eq!(pair[0].phone, closure, "before {:?}", pair[1]);
        }
    }
}
