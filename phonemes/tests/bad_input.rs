//! Guards what users see when a label file cannot be used: one sentence with file, line and mend;
//! and that odd but usable files are read, with warnings.

use std::path::Path;

use mouthpiece_phonemes::{
    Fault, LabelError, Labels, Phone, ReadOptions, SampleRate, Source, Word, check, limits, read,
    read_file,
};

fn read_as(name: &str, bytes: &[u8]) -> Result<Labels, LabelError> {
    read(&Source { name, bytes }, None, &ReadOptions::default())
}

fn message(name: &str, bytes: &[u8]) -> String {
    match read_as(name, bytes) {
        Ok(labels) => panic!("{labels:?} was read"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn each_bad_file_is_answered_with_file_line_and_mend() {
    let long = format!("0 10 aa\n10 20 {}\n", "a".repeat(2000));
    let digits = format!("0 {} aa\n", "9".repeat(400));
    let cases: [(&[u8], &str); 21] = [
        (
            b"",
            "a.phn: holds no label; give at least one line, such as `0 8000 h#`",
        ),
        (b" \r\n\n\t\n", "a.phn: holds no label;"),
        (
            b"0 10 h#\n10 20\n",
            "a.phn, line 2: 2 of the 3 fields `start end phone`; add what is missing",
        ),
        (
            b"0 10 h#\n10",
            "line 2: 1 of the 3 fields `start end phone`; add what is missing (the file stops in this line, so it may have been cut off)",
        ),
        (
            b"0 10 h#\n10 20 pc",
            "line 2: `pc` is not a TIMIT phone code; write one, such as `p`, `pcl`",
        ),
        (b"0 10 h#\n10 20 pc", "cut off"),
        (
            b"10 20 aa\n0 10 h#\n",
            "line 2: starts at 0, before the previous label's start 10; sort by start",
        ),
        (
            b"0 10 h#\n9 20 aa\n",
            "line 2: starts at 9, inside the previous label that ends at 10; move one",
        ),
        (
            b"-5 10 h#\n",
            "line 1: time -5 is negative; count samples from 0",
        ),
        (
            b"10 5 h#\n",
            "line 1: ends at 5 but starts at 10; put the end after the start",
        ),
        (b"10 10 h#\n", "line 1: ends at 10 but starts at 10"),
        (
            b"0 99999999999 h#\n",
            "line 1: time 99999999999 lies beyond 24 hours",
        ),
        (
            digits.as_bytes(),
            "lies beyond 24 hours; write sample indices, and check the rate",
        ),
        (
            long.as_bytes(),
            "line 2: longer than 1024 bytes; end each label with a line break",
        ),
        (
            b"0.0 0.5 h#\n",
            "line 1: `0.0` is not a whole number; write times as sample indices",
        ),
        (
            b"0 10 h#\n10 20 AH0\n",
            "line 2: `AH0` is not a TIMIT phone code; write one, such as `ah`",
        ),
        (b"0 10 sil\n", "such as `h#`, `pau`"),
        (
            b"0 10 aa b\n",
            "line 1: `b` stands after the phone; write only `start end phone`",
        ),
        (
            b"RIFF\x24\x00\x00\x00WAVEfmt \x10\x00",
            "line 1: not text; save the labels as UTF-8 text",
        ),
        (b"0 10 h#\n10 20 \xe9\n", "line 2: not text"),
        (b"\xff\xfe0\x00 \x001\x00", "line 1: not text"),
    ];
    for (bytes, wanted) in cases {
        let said = message("a.phn", bytes);
        assert!(said.contains(wanted), "{said:?} does not say {wanted:?}");
        assert!(said.starts_with("a.phn"), "{said:?} does not name the file");
        assert!(!said.contains('\n') && said.len() < 250, "{said:?}");
    }
}

#[test]
fn a_message_never_repeats_control_characters_or_a_whole_long_line() {
    let said = message("a.phn", format!("0 10 {}\n", "é".repeat(400)).as_bytes());
    assert!(said.chars().count() < 150, "{said}");
    let said = message("a.phn", "0 10 a\u{202e}b\n".as_bytes());
    assert!(!said.contains('\u{202e}'), "{said}");
}

#[test]
fn files_that_cannot_be_read_say_so() {
    let options = ReadOptions::default();
    let missing = Path::new("no such file.phn");
    let said = read_file(missing, None, &options).unwrap_err().to_string();
    assert!(
        said.starts_with("no such file.phn: cannot be read ("),
        "{said}"
    );
    let folder = tempfile::tempdir().unwrap();
    let error = read_file(folder.path(), None, &options).unwrap_err();
    assert!(matches!(error, LabelError::Unreadable { .. }), "{error}");
    let large = folder.path().join("large.phn");
    let file = std::fs::File::create(&large).unwrap();
    file.set_len(limits::FILE_BYTES_MAX + 1).unwrap();
    let error = read_file(&large, None, &options).unwrap_err();
    assert!(matches!(error, LabelError::TooLarge { .. }), "{error}");
}

#[test]
fn the_format_is_found_by_name_or_by_looking() {
    let phones = read_as("labels.txt", b"0 10 h#\n10 20 aa\n").unwrap();
    assert_eq!((phones.segments.len(), phones.words.len()), (2, 0));
    let said = message("labels.txt", b"0 10 sil\n10 20 aa\n");
    assert!(said.contains("`sil` is not a TIMIT phone"), "{said}");
    let words = read_as("labels.txt", b"0 10 hello\n").unwrap();
    assert_eq!((words.segments.len(), words.words.len()), (0, 1));
    // A name decides even where the content looks like the other.
    assert_eq!(read_as("A.WRD", b"0 10 er\n").unwrap().words.len(), 1);
    let said = message("notes.txt", b"Dear reader,\n");
    assert!(
        said.contains("name one of `timit`, `timit-words`"),
        "{said}"
    );
    let source = Source {
        name: "a.phn",
        bytes: b"0 1 h#",
    };
    let said = read(&source, Some("praat"), &ReadOptions::default()).unwrap_err();
    assert!(matches!(said, LabelError::UnknownFormat { .. }), "{said}");
}

#[test]
fn what_editors_and_other_systems_do_to_files_is_read() {
    let plain = read_as("a.phn", b"0 160 h#\n160 320 aa\n").unwrap();
    for bytes in [
        &b"0 160 h#\r\n160 320 aa\r\n"[..],
        b"\xef\xbb\xbf0 160 h#\n160 320 aa\n",
        b"0 160 h#\n160 320 aa",
        b"\n  0\t160  h# \n\n160 320 aa\n\n",
    ] {
        assert_eq!(read_as("a.phn", bytes).unwrap(), plain);
    }
    assert_eq!(plain.segments[1].phone, Phone::Aa);
    assert_eq!((plain.segments[1].start, plain.segments[1].end), (480, 960));
}

#[test]
fn numbers_count_samples_of_the_rate_that_the_user_names() {
    let source = Source {
        name: "a.phn",
        bytes: b"0 22050 h#\n22050 33075 aa\n",
    };
    let options = ReadOptions::at(SampleRate::new(22_050).unwrap());
    let labels = read(&source, None, &options).unwrap();
    assert_eq!(labels.segments[0].end, 48_000);
    assert_eq!(labels.end(), 72_000);
    assert!(SampleRate::new(0).is_err());
}

#[test]
fn words_may_overlap_but_not_run_backwards() {
    let words = read_as("a.wrd", b"0 100 did\n90 200 you\n90 210 uh huh\n").unwrap();
    assert_eq!(words.words[2].text, "uh huh");
    let said = message("a.wrd", b"50 100 did\n49 200 you\n");
    assert!(said.contains("line 2: starts at 49, before"), "{said}");
    let said = message("a.wrd", b"50 100\n");
    assert!(said.contains("`start end word`"), "{said}");
}

#[test]
fn odd_but_usable_labels_are_read_with_warnings() {
    let odd = b"160 320 aa\n480 640 b\n800 960 iy\n";
    let mut labels = read_as("a.phn", odd).unwrap();
    labels.words = read_as("a.wrd", b"0 300 did\n200 400 you\n").unwrap().words;
    let said: Vec<String> = check(&labels, Some(200))
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        said,
        [
            "the first phone starts at 10.0 ms, not at 0",
            "begins with `aa`; silence (`h#`) first lets the mouth get there",
            "ends with `iy`, not with silence (`h#`); it may have been cut off",
            "no label covers 10.0 ms after phone 1, at 20.0 ms (gaps in all: 2)",
            "word 2 begins 6.3 ms before the one before it ends (overlaps in all: 1)",
            "the labels go on for 55.8 ms after the sound",
        ]
    );
    let tidy = read_as("a.phn", b"0 160 h#\n160 320 aa\n320 640 h#\n").unwrap();
    assert!(check(&tidy, Some(tidy.end() + 20_000)).is_empty());
    assert_eq!(check(&tidy, Some(tidy.end() + 30_000)).len(), 1);
}

#[test]
fn what_cannot_be_written_is_refused() {
    use mouthpiece_phonemes::{Segment, WriteError, writer};
    let write = |format: &str, labels: &Labels| {
        let mut out = Vec::new();
        let rate = SampleRate::TIMIT;
        writer(format).unwrap().write(labels, rate, &mut out)
    };
    let phones = |spans: &[(i64, i64)]| Labels {
        segments: spans
            .iter()
            .map(|(start, end)| Segment::new(Phone::Aa, *start, *end))
            .collect(),
        ..Labels::default()
    };
    for spans in [&[(-3, 3)][..], &[(0, 1)], &[(3, 3)], &[(0, 30), (27, 60)]] {
        let error = write("timit", &phones(spans)).unwrap_err();
        assert!(matches!(error, WriteError::Label { .. }), "{error}");
    }
    let nothing = write("timit", &Labels::default()).unwrap_err();
    assert!(matches!(nothing, WriteError::Nothing("phones")));
    for text in ["", " a", "a\nb", &"a".repeat(2000)] {
        let words = Labels {
            words: vec![Word {
                text: text.to_owned(),
                start: 0,
                end: 30,
            }],
            ..Labels::default()
        };
        assert!(write("timit-words", &words).is_err(), "{text:?}");
    }
    assert!(writer("praat").is_err());
}

#[test]
fn faults_stay_comparable() {
    // Callers match on the kind of fault; the wording may change.
    let error = read_as("a.phn", b"0 1 h#\n0 2 aa\n").unwrap_err();
    let LabelError::Line { error, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(error.line, 2);
    let (start, previous) = (0, 1);
    assert_eq!(error.fault, Fault::Overlaps { start, previous });
}
