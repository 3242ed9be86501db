//! Noise, and samples with pieces of them changed, moved or cut: nothing panics, and what is read
//! is in order.

use mouthpiece_phonemes::{READERS, ReadOptions, Reader, Source, check};
use proptest::prelude::*;

use super::all_samples;

fn survives(reader: &dyn Reader, name: &str, bytes: &[u8], options: &ReadOptions) {
    let source = Source { name, bytes };
    reader.detect(&source);
    match reader.read(&source, options) {
        Ok(labels) => {
            let segments = &labels.segments;
            assert!(segments.iter().all(|s| 0 <= s.start && s.start < s.end));
            assert!(segments.is_sorted_by(|a, b| a.end <= b.start));
            assert!(labels.words.is_sorted_by_key(|w| w.start));
            assert!(labels.words.iter().all(|w| 0 <= w.start && w.start < w.end));
            check(&labels, Some(0))
                .iter()
                .for_each(|w| drop(w.to_string()));
        }
        Err(error) => assert!(error.to_string().len() < 500, "{error}"),
    }
}

/// One change of a file.
#[derive(Clone, Debug)]
enum Change {
    Cut(usize),
    Remove(usize, usize),
    Repeat(usize, usize),
    Write(usize, Vec<u8>),
}

fn change() -> impl Strategy<Value = Change> {
    let piece = prop_oneof![
        prop::collection::vec(any::<u8>(), 1..4),
        prop::sample::select(vec![
            "-",
            "9",
            "e9",
            ".",
            "\"",
            "[",
            "]",
            "{",
            "}",
            "\n",
            "\t",
            " ",
            "null",
            ":",
            ";",
            "#",
            "1e300",
            "-0",
            "99999999999999999999",
            "\u{feff}",
            "ʃ",
            "[[",
            "\\",
            "\\ud800",
            "_",
        ])
        .prop_map(|s| s.as_bytes().to_vec()),
    ];
    prop_oneof![
        any::<usize>().prop_map(Change::Cut),
        (any::<usize>(), 0_usize..60).prop_map(|(at, count)| Change::Remove(at, count)),
        (any::<usize>(), 0_usize..60).prop_map(|(at, count)| Change::Repeat(at, count)),
        (any::<usize>(), piece).prop_map(|(at, piece)| Change::Write(at, piece)),
    ]
}

fn apply(bytes: &mut Vec<u8>, change: &Change) {
    let place = |at: usize| at % (bytes.len() + 1);
    match change {
        Change::Cut(at) => {
            let at = place(*at);
            // Small cuts at the end tell more than none of the file.
            bytes.truncate(at.max(bytes.len() / 2));
        }
        Change::Remove(at, count) => {
            let at = place(*at);
            let end = (at + count).min(bytes.len());
            bytes.drain(at..end);
        }
        Change::Repeat(at, count) => {
            let at = place(*at);
            let end = (at + count).min(bytes.len());
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        Change::Write(at, piece) => {
            let at = place(*at);
            let end = (at + piece.len()).min(bytes.len());
            bytes.splice(at..end, piece.iter().copied());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn changed_samples_never_make_a_reader_panic(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec(change(), 1..8),
        tier in prop::option::of(prop::sample::select(vec!["phones", "2", "Mary", "word", ""])),
    ) {
        let samples = all_samples();
        let (format, path) = which.get(&samples);
        let mut bytes = std::fs::read(path).unwrap();
        for one in &changes {
            apply(&mut bytes, one);
        }
        let mut options = ReadOptions::default();
        options.tier = tier.map(str::to_owned);
        for reader in READERS {
            // Its own reader each time, the others now and then.
            if reader.name() == format || bytes.len() % 5 == 0 {
                survives(reader, "x", &bytes, &options);
            }
        }
    }

    #[test]
    fn noise_never_makes_a_reader_panic(
        bytes in prop::collection::vec(any::<u8>(), 0..400),
        mark in prop::sample::select(vec![&b""[..], b"\xff\xfe", b"\xfe\xff", b"#\n", b"[[", b"{"]),
    ) {
        let bytes = [mark, &bytes].concat();
        for reader in READERS {
            survives(reader, "x.lab", &bytes, &ReadOptions::default());
        }
    }
}
