//! Writing labels and reading what was written gives the same labels.

use mouthpiece_phonemes::{
    Labels, Phone, ReadOptions, SampleRate, Segment, Source, Stress, Word, read, writer,
};
use proptest::prelude::*;

fn written(format: &str, labels: &Labels) -> Vec<u8> {
    let mut out = Vec::new();
    let writer = writer(format).unwrap();
    writer.write(labels, SampleRate::TIMIT, &mut out).unwrap();
    out
}

fn back(format: &str, labels: &Labels) -> Labels {
    let bytes = written(format, labels);
    let source = Source {
        name: "x",
        bytes: &bytes,
    };
    let told = super::detect::surest("x", &bytes).1;
    assert_eq!(told, [format], "{}", String::from_utf8_lossy(&bytes));
    read(&source, None, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Phones in ticks, with gaps or without, with stress or without.
fn segments(gap: i64) -> impl Strategy<Value = Vec<Segment>> {
    let phone = prop::sample::select(Phone::ALL.to_vec());
    prop::collection::vec((0..=gap, 1_i64..100_000, phone, 0..4_u8), 1..40).prop_map(|all| {
        let mut at = 0;
        let all = all.into_iter().map(|(gap, length, phone, stress)| {
            let start = at + gap;
            at = start + length;
            let stress = match stress {
                1 => Some(Stress::Unstressed),
                2 => Some(Stress::Primary),
                3 => Some(Stress::Secondary),
                _ => None,
            };
            Segment {
                stress,
                ..Segment::new(phone, start, at)
            }
        });
        all.collect()
    })
}

fn some_words() -> impl Strategy<Value = Vec<Word>> {
    // Marks of silence are no words.
    let text = "[a-zA-Z0-9é\"\\\\{}:,']{0,6}[a-z]".prop_filter("a mark of silence", |text| {
        !matches!(
            &*text.to_lowercase(),
            "sil" | "sp" | "pau" | "spn" | "brth" | "ssil"
        )
    });
    let word = (0_i64..10_000, 1_i64..50_000, text);
    prop::collection::vec(word, 0..10).prop_map(|all| {
        let mut at = 0;
        let all = all.into_iter().map(|(gap, length, text)| {
            let start = at + gap;
            at = start + length;
            Word {
                text,
                start,
                end: at,
            }
        });
        all.collect()
    })
}

/// What a format without gaps makes of them.
fn filled(segments: &[Segment]) -> Vec<Segment> {
    let mut at = 0;
    let mut all = Vec::new();
    for segment in segments {
        if segment.start > at {
            all.push(Segment::new(Phone::Pau, at, segment.start));
        }
        all.push(Segment {
            stress: None,
            ..*segment
        });
        at = segment.end;
    }
    all
}

proptest! {
    #[test]
    fn ndjson_keeps_all(segments in segments(1000), words in some_words()) {
        let labels = Labels { segments, words, notes: Vec::new() };
        prop_assert_eq!(back("ndjson", &labels), labels);
    }

    #[test]
    fn textgrids_keep_all_but_stress_and_gaps(segments in segments(1000), words in some_words()) {
        let labels = Labels { segments, words, notes: Vec::new() };
        let end = labels.end();
        let mut read = back("textgrid", &labels);
        // A tier goes on to the end of the other.
        let last = labels.segments.last().unwrap().end;
        if last < end {
            let rest = read.segments.pop().unwrap();
            prop_assert_eq!(rest, Segment::new(Phone::Pau, last, end));
        }
        for segment in &mut read.segments {
            segment.stress = None;
        }
        prop_assert_eq!(read.segments, filled(&labels.segments));
        prop_assert_eq!(read.words, labels.words);
    }

    #[test]
    fn xlabel_keeps_all_but_stress_and_gaps(segments in segments(1000)) {
        let labels = Labels { segments, ..Labels::default() };
        let mut read = back("xlabel", &labels);
        for segment in &mut read.segments {
            segment.stress = None;
        }
        prop_assert_eq!(read.segments, filled(&labels.segments));
    }
}

#[test]
fn what_a_format_cannot_say_is_refused() {
    let word = |text: &str, start, end| Word {
        text: text.to_owned(),
        start,
        end,
    };
    let overlapping = [
        Segment::new(Phone::Aa, 0, 100),
        Segment::new(Phone::B, 99, 200),
    ];
    let mut out = Vec::new();
    for format in ["xlabel", "textgrid", "ndjson"] {
        let format = writer(format).unwrap();
        let mut refuses = |labels: &Labels| {
            let error = format.write(labels, SampleRate::TIMIT, &mut out);
            let said = error.unwrap_err().to_string();
            assert!(said.contains("; "), "{said} names no mend");
        };
        refuses(&Labels::default());
        refuses(&Labels {
            segments: overlapping.to_vec(),
            ..Labels::default()
        });
        refuses(&Labels {
            words: vec![word("a", 5, 5)],
            ..Labels::default()
        });
    }
    for format in ["xlabel", "ndjson"] {
        let labels = Labels {
            words: vec![word("a\nb", 0, 5)],
            ..Labels::default()
        };
        let format = writer(format).unwrap();
        assert!(format.write(&labels, SampleRate::TIMIT, &mut out).is_err());
    }
}
