//! Guards, on made-up input: writing then reading gives the same, pieces of any size give what the
//! whole gives, and no bytes make anything panic.

#![allow(clippy::unwrap_used, reason = "tests, and the helpers of tests")]

use mouthpiece_phonemes::timit::TimitStream;
use mouthpiece_phonemes::{
    LabelError, Labels, LineError, Phone, READERS, ReadOptions, SampleRate, Segment, Source, Word,
    check, limits, read, writer,
};
use proptest::prelude::*;

/// Rates that sound comes in, and any other.
fn rates() -> impl Strategy<Value = SampleRate> {
    let usual = prop::sample::select(vec![8_000, 11_025, 16_000, 22_050, 44_100, 48_000, 96_000]);
    prop_oneof![usual, 1_u32..=768_000].prop_map(|hz| SampleRate::new(hz).unwrap())
}

/// Lines of a tidy file: gap before, length, phone. In samples.
fn lines() -> impl Strategy<Value = Vec<(i64, i64, Phone)>> {
    let phone = prop::sample::select(Phone::ALL.to_vec());
    prop::collection::vec((0_i64..3, 1_i64..100, phone), 1..40)
}

fn phn(lines: &[(i64, i64, Phone)]) -> String {
    let mut at = 0;
    let mut text = String::new();
    for (gap, length, phone) in lines {
        let start = at + gap;
        at = start + length;
        text += &format!("{start} {at} {phone}\n");
    }
    text
}

fn written(format: &str, labels: &Labels, rate: SampleRate) -> String {
    let mut out = Vec::new();
    let format = writer(format).unwrap();
    format.write(labels, rate, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn stream(pieces: &[&[u8]], rate: SampleRate) -> Vec<Result<Segment, LineError>> {
    let mut parser = TimitStream::new(rate);
    let mut all = Vec::new();
    for piece in pieces {
        parser.push(piece, |one| all.push(one));
    }
    parser.finish(|one| all.push(one));
    all
}

/// Cuts `bytes` at the places that `cuts` gives, in turn, so that pieces have all sizes.
fn pieces<'a>(mut bytes: &'a [u8], cuts: &[usize]) -> Vec<&'a [u8]> {
    let mut out = Vec::new();
    for cut in cuts.iter().cycle().take(4 * bytes.len() + 1) {
        let (piece, rest) = bytes.split_at((*cut).min(bytes.len()));
        out.push(piece);
        bytes = rest;
    }
    out.push(bytes);
    out
}

/// Bytes that get further into the parser than noise does.
fn plausible() -> impl Strategy<Value = Vec<u8>> {
    let word = prop_oneof![
        "[0-9]{1,22}",
        "-?[0-9]{1,3}",
        prop::sample::select(Phone::ALL.to_vec()).prop_map(|p| p.code().to_owned()),
        "[ \t\r\n\u{feff}\u{85}.#é]{1,4}",
        Just("a".repeat(700)),
    ];
    prop::collection::vec((word, prop::sample::select(vec![" ", "\n", "\r\n"])), 0..30).prop_map(
        |words| {
            words
                .into_iter()
                .flat_map(|(a, b)| (a + b).into_bytes())
                .collect()
        },
    )
}

proptest! {
    /// File -> labels -> file is the same text, where a sample is no shorter than a tick.
    #[test]
    fn reading_then_writing_phones_gives_the_same_file(lines in lines(), hz in 1_u32..=48_000) {
        let rate = SampleRate::new(hz).unwrap();
        let text = phn(&lines);
        let source = Source { name: "a.PHN", bytes: text.as_bytes() };
        let labels = read(&source, None, &ReadOptions::at(rate)).unwrap();
        prop_assert_eq!(written("timit", &labels, rate), text);
    }

    /// Labels -> file -> labels is the same, where a tick is no shorter than a sample.
    #[test]
    fn writing_then_reading_phones_gives_the_same_labels(lines in lines(), hz in 48_000_u32..=768_000) {
        let rate = SampleRate::new(hz).unwrap();
        let mut at = 0;
        let segments = lines.iter().map(|(gap, length, phone)| {
            let start = at + gap;
            at = start + length;
            Segment::new(*phone, start, at)
        });
        let labels = Labels { segments: segments.collect(), ..Labels::default() };
        let text = written("timit", &labels, rate);
        let source = Source { name: "a.PHN", bytes: text.as_bytes() };
        prop_assert_eq!(read(&source, None, &ReadOptions::at(rate)).unwrap(), labels);
    }

    #[test]
    fn words_survive_in_any_spelling_and_overlap(
        words in prop::collection::vec((0_i64..100, 1_i64..200, "[^\\p{Cc}\\s]{1,8}( [^\\p{Cc}\\s]{1,8})?"), 1..20),
    ) {
        let mut at = 0;
        let words = words.into_iter().map(|(step, length, text)| {
            at += 3 * step;
            Word { text, start: at, end: at + 3 * length }
        });
        let labels = Labels { words: words.collect(), ..Labels::default() };
        let text = written("timit-words", &labels, SampleRate::TIMIT);
        let source = Source { name: "a.WRD", bytes: text.as_bytes() };
        prop_assert_eq!(read(&source, None, &ReadOptions::default()).unwrap(), labels);
    }

    #[test]
    fn times_go_to_ticks_and_back_unchanged(rate in rates(), value in 0_i64..3_000_000_000) {
        if let Some(ticks) = rate.ticks(value) {
            let back = rate.samples(ticks);
            if rate.hz() <= 48_000 {
                prop_assert_eq!(back, value);
            } else {
                // Half a tick at most, in samples.
                prop_assert!((back - value).abs() <= i64::from(rate.hz()) / 96_000 + 1);
            }
        }
        if rate.hz() >= 48_000 {
            prop_assert_eq!(rate.ticks(rate.samples(value)), Some(value));
        }
    }

    #[test]
    fn pieces_of_any_size_give_what_the_whole_gives(
        bytes in prop_oneof![plausible(), lines().prop_map(|l| phn(&l).into_bytes())],
        cuts in prop::collection::vec(0_usize..40, 1..10),
    ) {
        let rate = SampleRate::TIMIT;
        let whole = stream(&[&bytes], rate);
        prop_assert_eq!(&stream(&pieces(&bytes, &cuts), rate), &whole);
        // And a file of these bytes gives the same, up to the first fault.
        let from_file = read(&Source { name: "a.phn", bytes: &bytes }, None, &ReadOptions::default());
        match whole.iter().find_map(|one| one.as_ref().err()) {
            None => match from_file {
                Ok(labels) => {
                    let all: Vec<Segment> = whole.into_iter().map(Result::unwrap).collect();
                    prop_assert_eq!(labels.segments, all);
                }
                Err(error) => prop_assert!(matches!(error, LabelError::Empty { .. }), "{}", error),
            },
            Some(first) => match from_file {
                Err(LabelError::Line { error, .. }) => prop_assert_eq!(&error, first),
                other => prop_assert!(false, "{:?}", other),
            },
        }
    }

    #[test]
    fn no_bytes_make_a_reader_panic_and_what_it_gives_is_in_order(
        bytes in prop_oneof![plausible(), prop::collection::vec(any::<u8>(), 0..3000)],
        rate in rates(),
    ) {
        for reader in READERS {
            for name in ["a.phn", "a.wrd", "noname", ""] {
                let source = Source { name, bytes: &bytes };
                reader.detect(&source);
                match reader.read(&source, &ReadOptions::at(rate)) {
                    Ok(labels) => {
                        prop_assert!(labels.segments.iter().all(|s| 0 <= s.start && s.start < s.end));
                        prop_assert!(labels.segments.is_sorted_by(|a, b| a.end <= b.start));
                        prop_assert!(labels.words.is_sorted_by_key(|w| w.start));
                        check(&labels, Some(0)).iter().for_each(|w| drop(w.to_string()));
                    }
                    Err(error) => prop_assert!(error.to_string().len() < 400),
                }
            }
        }
    }
}

#[test]
fn a_stream_without_line_breaks_is_told_off_once_and_the_next_line_is_read() {
    let mut parser = TimitStream::new(SampleRate::TIMIT);
    let mut all = Vec::new();
    for _ in 0..10_000 {
        parser.push(&[b'x'; 100], |one| all.push(one));
    }
    parser.push(b"\n0 16000 aa\n", |one| all.push(one));
    assert_eq!(all.len(), 2);
    let error = all[0].clone().unwrap_err().to_string();
    let wanted = format!("line 1: longer than {} bytes", limits::LINE_BYTES_MAX);
    assert!(error.starts_with(&wanted), "{error}");
    assert_eq!(all[1], Ok(Segment::new(Phone::Aa, 0, 48_000)));
}

#[test]
fn a_bad_line_in_a_stream_leaves_the_others_as_they_are() {
    let bytes = b"0 100 h#\n100 200 xx\n50 80 aa\n100 200 aa\n";
    let all = stream(&[bytes], SampleRate::TIMIT);
    let good: Vec<_> = all.iter().filter_map(|one| one.as_ref().ok()).collect();
    let lines: Vec<u64> = all
        .iter()
        .filter_map(|one| Some(one.as_ref().err()?.line))
        .collect();
    assert_eq!(good.len(), 2);
    assert_eq!(lines, [2, 3]);
    let mut parser = TimitStream::new(SampleRate::TIMIT);
    let mut ends = Vec::new();
    parser.push(bytes, |_| {});
    parser.restart();
    parser.push(b"0 100 h#\n", |one| ends.push(one.map(|s| s.end)));
    assert_eq!(ends, [Ok(300)]);
}

/// Line ends that were converted twice: a file of nothing else is empty, not unreadable.
#[test]
fn blank_lines_of_carriage_returns_are_blank() {
    for bytes in [&b"\r\r\n"[..], b"\r \n", b" \r\t\r\n\n"] {
        assert!(stream(&[bytes], SampleRate::TIMIT).is_empty());
    }
    let with_blanks = stream(
        &[b"\r\r\n0 100 h#\r\n\r\r\n100 200 aa\n"],
        SampleRate::TIMIT,
    );
    assert_eq!(with_blanks.iter().filter(|one| one.is_ok()).count(), 2);
}
