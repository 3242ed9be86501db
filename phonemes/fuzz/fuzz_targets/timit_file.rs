//! Any bytes as a TIMIT file: no panic, what is read is in order, and writing it gives a file that
//! reads as the same. The first four bytes are the rate; where they are none, it is 16 kHz.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mouthpiece_phonemes::{READERS, ReadOptions, Reader, SampleRate, Source, check, writer};

fuzz_target!(|input: (u32, &[u8])| {
    let (hz, bytes) = input;
    let name = "fuzzed";
    let rate = SampleRate::new(hz).unwrap_or(SampleRate::TIMIT);
    let options = ReadOptions::at(rate);
    for reader in READERS.iter().filter(|r| r.name().starts_with("timit")) {
        let source = Source { name, bytes };
        reader.detect(&source);
        let labels = match reader.read(&source, &options) {
            Ok(labels) => labels,
            Err(error) => {
                assert!(error.to_string().len() < 400);
                continue;
            }
        };
        assert!(labels.segments.is_sorted_by(|a, b| a.end <= b.start));
        assert!(labels.words.is_sorted_by_key(|w| w.start));
        for warning in check(&labels, Some(0)) {
            let _ = warning.to_string();
        }
        round_trip(*reader, &labels, rate);
    }
});

/// Exact wherever the rate's samples are no shorter than a tick.
fn round_trip(reader: &dyn Reader, labels: &mouthpiece_phonemes::Labels, rate: SampleRate) {
    let Ok(format) = writer(reader.name()) else {
        return;
    };
    let mut text = Vec::new();
    match format.write(labels, rate, &mut text) {
        Ok(()) => {
            let source = Source {
                name: "written",
                bytes: &text,
            };
            let again = reader.read(&source, &ReadOptions::at(rate));
            assert_eq!(again.ok().as_ref(), Some(labels));
        }
        // A word may fill its line so that longer numbers no longer fit.
        Err(error) => assert!(labels.words.iter().any(|w| w.text.len() > 900), "{error}"),
    }
}
