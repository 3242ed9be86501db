//! Which format a file is in: exactly one reader is surest of each.

use std::path::Path;

use mouthpiece_phonemes::{Match, READERS, Source};

use super::all_samples;

/// The formats that are surest of a file, by whichever of `names` it goes.
pub(super) fn surest(name: &str, bytes: &[u8]) -> (Match, Vec<&'static str>) {
    let source = Source { name, bytes };
    let all = READERS.map(|reader| (reader.detect(&source), reader.name()));
    let best = all.iter().map(|(sure, _)| *sure).max().unwrap();
    let same = all.iter().filter(|(sure, _)| *sure == best);
    (best, same.map(|(_, name)| *name).collect())
}

/// A file of `format` is taken for it, under its own name and, but for those whose content says too
/// little, under none.
pub(super) fn is_only(format: &str, path: &Path) {
    let bytes = std::fs::read(path).unwrap();
    let name = path.display().to_string();
    assert_eq!(surest(&name, &bytes).1, [format], "{name}");
    let (sure, formats) = surest("<stdin>", &bytes);
    assert_eq!(formats, [format], "{name} without its name");
    assert!(sure > Match::No);
}

#[test]
fn each_sample_is_claimed_by_its_format_alone() {
    let all = all_samples();
    for reader in READERS.iter().filter(|r| !r.name().starts_with("timit")) {
        let has = all.iter().any(|(format, _)| format == reader.name());
        assert!(has, "no sample of {}", reader.name());
    }
    for (format, path) in &all {
        is_only(format, path);
    }
}

#[test]
fn timit_stays_timit() {
    let phn = b"0 3200 h#\n3200 4200 hh\n4200 6000 aa\n";
    assert_eq!(surest("x", phn).1, ["timit"]);
    assert_eq!(surest("x.PHN", phn).1, ["timit"]);
    assert_eq!(surest("x.lab", phn).1, ["timit"]);
    let wrd = b"0 3200 hello\n3200 4200 there\n";
    assert_eq!(surest("x.WRD", wrd), (Match::Surely, vec!["timit-words"]));
    // Whatever its numbers, a name decides.
    let slow = b"0 3200000 h#\n3200000 6200000 hh\n";
    assert_eq!(surest("x.PHN", slow).1, ["timit"]);
    assert_eq!(surest("x.lab", slow).1, ["hts"]);
}

#[test]
fn what_is_in_no_format_is_claimed_by_none() {
    for text in [
        "Dear reader,\nthis is no label file.\n",
        "this is the acoustic corpus i'm talking pretty fast here",
        "{\"name\": \"x\"}",
        "[1, 2, 3]",
        "key = 5\n",
        "# a heading\ntext\n",
    ] {
        assert_eq!(surest("notes.txt", text.as_bytes()).0, Match::No, "{text}");
    }
}
