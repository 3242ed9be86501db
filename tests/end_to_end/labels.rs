//! Label files as people have them: every sad kind is one sentence that names file, line and mend;
//! every sound one survives being read and written.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use mouthpiece_tests::{binary, fixtures};

/// A file's content, the line that the message must name (none for the whole file) and a word that
/// it must hold.
struct Bad {
    name: &'static str,
    content: Vec<u8>,
    line: Option<usize>,
    says: &'static str,
}

fn bad(
    name: &'static str,
    content: impl Into<Vec<u8>>,
    line: Option<usize>,
    says: &'static str,
) -> Bad {
    let content = content.into();
    Bad {
        name,
        content,
        line,
        says,
    }
}

fn bad_files() -> Vec<Bad> {
    let wav = fs::read(fixtures::named("flite").sound_path).unwrap();
    let endless = "9".repeat(4 << 20);
    vec![
        bad("empty.phn", "", None, "holds no label"),
        bad("blank.phn", "\n\n  \n", None, "holds no label"),
        bad("truncated.phn", "0 1600 h#\n1600 32", Some(2), "fields"),
        bad(
            "truncated2.phn",
            "0 1600 h#\n1600 3200 a",
            Some(2),
            "cut off",
        ),
        bad(
            "unsorted.phn",
            "0 1600 h#\n3200 4800 aa\n1600 3200 b\n",
            Some(3),
            "sort",
        ),
        bad("overlap.phn", "0 1600 h#\n1500 3200 aa\n", Some(2), "1500"),
        bad("backwards.phn", "0 1600 h#\n3200 1600 aa\n", Some(2), "end"),
        bad("negative.phn", "-160 1600 h#\n", Some(1), "negative"),
        bad(
            "seconds.phn",
            "0.0 0.1 h#\n0.1 0.3 aa\n",
            Some(1),
            "whole number",
        ),
        bad("unknown.phn", "0 1600 h#\n1600 3200 xyz\n", Some(2), "xyz"),
        bad(
            "late.phn",
            "0 99999999999999999999 aa\n",
            Some(1),
            "24 hours",
        ),
        bad(
            "long.phn",
            "0 1600 h#\n1600 1000000000 aa\n",
            None,
            "minutes",
        ),
        bad(
            "wide.phn",
            format!("0 1600 h#\n1600 {endless} aa\n"),
            Some(2),
            "bytes",
        ),
        bad("binary.phn", wav, Some(1), "text"),
        bad("nulls.phn", vec![0; 100], Some(1), "text"),
        bad(
            "utf16.phn",
            b"\xff\xfe0\0 \x001\0".as_slice(),
            Some(1),
            "text",
        ),
    ]
}

/// Guards the sentences that people see most, in each command that reads labels, and that no
/// output is left behind.
#[test]
fn bad_label_files_are_one_sentence_with_the_line_and_the_mend() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.mp4");
    let out = out.to_string_lossy();
    let mut wrong = Vec::new();
    for bad in bad_files() {
        let path = folder.path().join(bad.name);
        fs::write(&path, &bad.content).unwrap();
        let path = path.to_string_lossy();
        for args in [
            vec!["curves", "--labels", &path],
            vec!["export", "--labels", &path, "-o", &out],
            vec!["say", "--labels", &path],
        ] {
            let finished = binary::run(&args);
            let sentence = finished.expect_sentence(1);
            let line = bad.line.map_or(String::new(), |n| format!("line {n}"));
            if ![bad.name, &line, bad.says]
                .iter()
                .all(|s| sentence.contains(s))
            {
                wrong.push(format!("{} {}: {sentence}", args[0], bad.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(!Path::new(&*out).exists());
}

/// Guards the commonest mistake: a name that is not there, or is a folder.
#[test]
fn a_label_file_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.phn");
    for path in [missing.as_path(), folder.path()] {
        let path = path.to_string_lossy();
        for args in [
            vec!["labels", &path],
            vec!["curves", "--labels", &path],
            vec!["say", "--labels", &path],
        ] {
            let finished = binary::run(&args);
            assert!(finished.expect_sentence(1).contains(&*path), "{args:?}");
        }
    }
}

/// Guards files from other tools: Windows line ends, a byte-order mark, tabs, no last line end; all
/// read as the plain file is.
#[test]
fn harmless_differences_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.phn");
    let read = |content: &[u8]| {
        fs::write(&path, content).unwrap();
        binary::run(&["labels", &path.to_string_lossy()])
            .expect_done()
            .text()
    };
    let plain = "0 1600 h#\n1600 3200 aa\n3200 4800 h#\n";
    for other in [
        plain.replace('\n', "\r\n"),
        plain.replace(' ', "\t"),
        format!("\u{feff}{plain}"),
        plain.trim_end().to_owned(),
        plain.replace(' ', "  "),
    ] {
        assert_eq!(read(other.as_bytes()), plain, "{other:?}");
    }
}

/// Guards the writer: what it writes is read as what it was, at any rate that divides, and a
/// fixture comes out as it went in.
#[test]
fn labels_survive_the_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    for utterance in fixtures::all() {
        let from = utterance.labels_path.to_string_lossy();
        let original = fs::read_to_string(&utterance.labels_path).unwrap();
        let finished = binary::run(&["labels", &from]);
        assert_eq!(finished.expect_done().text(), original);

        let high = folder.path().join("high.phn");
        let high = high.to_string_lossy();
        binary::run(&["labels", &from, "--out-rate", "48000", "-o", &high]).expect_done();
        assert_ne!(fs::read_to_string(&*high).unwrap(), original);
        let back = binary::run(&["labels", &high, "--rate", "48000"]);
        assert_eq!(back.expect_done().text(), original);
    }
}

/// Guards `--json` for scripts: ticks of 48 kHz, in order, one segment a line of the file.
#[test]
fn labels_as_json_hold_what_the_file_says() {
    let utterance = fixtures::named("espeak");
    let path = utterance.labels_path.to_string_lossy();
    let finished = binary::run(&["labels", &path, "--json"]);
    let report: serde_json::Value = serde_json::from_str(&finished.expect_done().text()).unwrap();
    let rate = report["tick_rate"].as_f64().unwrap();
    let segments = report["segments"].as_array().unwrap();
    assert_eq!(segments.len(), utterance.labels.len());
    for (segment, label) in segments.iter().zip(&utterance.labels) {
        let ticks = |s: f64| serde_json::json!((s * rate).round() as i64);
        assert_eq!(segment["start"], ticks(label.start), "{label:?}");
        assert_eq!(segment["end"], ticks(label.end), "{label:?}");
    }
}

/// Guards the pipe: labels on standard input are the labels of a file.
#[test]
fn labels_on_standard_input_are_read() {
    let path = fixtures::named("flite").labels_path;
    let from_file = binary::run(&[
        "curves",
        "--rate",
        "10",
        "--labels",
        &path.to_string_lossy(),
    ]);
    let mut command = binary::command(&["curves", "--rate", "10", "--labels", "-"]);
    command.stdin(fs::File::open(&path).unwrap());
    let piped = binary::start(command.stdout(Stdio::piped())).finish();
    assert_eq!(piped.expect_done().stdout, from_file.expect_done().stdout);

    let finished = binary::run(&["curves", "--labels", "-"]);
    assert!(finished.expect_sentence(1).contains("stdin"));
}

/// Guards labels of other programs from end to end: told by their content, written as another format,
/// and as TIMIT again the same.
#[test]
fn other_programs_labels_are_told_read_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let festival = "#\n0.2000 100 pau\n0.2600 100 hh\n0.4600 100 ay\n0.6000 100 pau\n";
    let flite = "pau:0.200 hh:0.260 ay:0.460 pau:0.600 \n";
    let mbrola = "_ 200\nh 60 0 120\naI 200\n_ 140\n";
    let timit = "0 3200 pau\n3200 4160 hh\n4160 7360 ay\n7360 9600 pau\n";
    for (name, text) in [("a.lab", festival), ("a.txt", flite), ("a.pho", mbrola)] {
        fs::write(file(name), text).unwrap();
        for format in ["xlabel", "textgrid", "ndjson"] {
            let (from, written) = (file(name), file("written"));
            binary::run(&["labels", &from, "--to", format, "-o", &written]).expect_done();
            let back = binary::run(&["labels", &written, "--from", "auto"]);
            assert_eq!(back.expect_done().text(), timit, "{name} by {format}");
        }
    }
}

/// Guards the choice of a tier, and what is said where there is none of the name.
#[test]
fn a_tier_is_read_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.TextGrid");
    let tier =
        |name: &str, text: &str| format!("\"IntervalTier\" \"{name}\" 0 1 1\n0 1 \"{text}\"\n");
    let head = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n0 1 <exists> 2\n";
    let text = format!(
        "{head}{}{}",
        tier("ann", "i\u{2d0}"),
        tier("bob", "u\u{2d0}")
    );
    fs::write(&path, text).unwrap();
    let path = path.to_string_lossy();
    let read = |more: &[&str]| binary::run(&[&["labels", &path][..], more].concat());
    let bob = read(&["--label-tier", "Bob", "--alphabet", "ipa"]);
    assert_eq!(bob.expect_done().text(), "0 16000 uw\n");
    assert_eq!(read(&[]).expect_done().text(), "0 16000 iy\n");
    let none = read(&["--label-tier", "eve"]);
    assert!(none.expect_sentence(1).contains("name one of `ann`, `bob`"));
}

/// Guards sources that time words alone: they get the phones of their pronunciation.
#[test]
fn words_alone_become_phones() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.json");
    let text = r#"{"words": [{"word": "bob", "start": 0.1, "end": 0.6}]}"#;
    fs::write(&path, text).unwrap();
    let finished = binary::run(&["labels", &path.to_string_lossy()]);
    let text = finished.expect_done().text();
    let phones: Vec<_> = text.lines().filter_map(|l| l.split(' ').nth(2)).collect();
    assert_eq!(phones, ["b", "aa", "b"]);
    assert!(
        text.starts_with("1600 ") && text.ends_with("9600 b\n"),
        "{text}"
    );
}
