//! The utterances in `fixtures/`: labels as they stand in the files, times in seconds.

use std::path::{Path, PathBuf};

use crate::binary;

/// Rate that the labels count at, whatever the rate of the sound (fixtures/README.md).
const LABEL_HZ: f64 = 16_000.0;

/// One labelled phone.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where it begins, seconds.
    pub start: f64,
    /// Where it ends, exclusive, seconds.
    pub end: f64,
    /// TIMIT code.
    pub phone: String,
}

/// One utterance.
#[derive(Clone, Debug)]
pub struct Utterance {
    /// `demo`, `flite` …
    pub name: String,
    /// The label file.
    pub labels_path: PathBuf,
    /// The sound file.
    pub sound_path: PathBuf,
    /// What the label file says.
    pub labels: Vec<Label>,
}

/// The folder of fixtures.
#[must_use]
pub fn folder() -> PathBuf {
    binary::root().join("tests/fixtures")
}

/// Every `.PHN` that has its `.wav`, in order of their names.
#[must_use]
pub fn all() -> Vec<Utterance> {
    let entries = std::fs::read_dir(folder()).expect("tests/fixtures is there");
    let mut found: Vec<_> = entries
        .map(|entry| entry.expect("tests/fixtures can be listed").path())
        .filter(|path| path.extension().is_some_and(|e| e == "PHN"))
        .filter(|path| path.with_extension("wav").is_file())
        .map(|path| Utterance::read(&path))
        .collect();
    found.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(found.len() >= 3, "only {} utterances", found.len());
    found
}

/// The utterance of this name.
#[must_use]
pub fn named(name: &str) -> Utterance {
    Utterance::read(&folder().join(name).with_extension("PHN"))
}

impl Utterance {
    fn read(labels_path: &Path) -> Self {
        let text = std::fs::read_to_string(labels_path)
            .unwrap_or_else(|e| panic!("{}: {e}", labels_path.display()));
        let name = labels_path.file_stem().expect("a file has a name");
        Self {
            name: name.to_string_lossy().into_owned(),
            sound_path: labels_path.with_extension("wav"),
            labels_path: labels_path.to_path_buf(),
            labels: text.lines().map(label).collect(),
        }
    }

    /// Seconds of sound, by the WAV header.
    #[must_use]
    pub fn sound_s(&self) -> f64 {
        let bytes = std::fs::read(&self.sound_path).expect("a fixture has its sound");
        let at =
            |i: usize| u32::from_le_bytes([bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]]);
        // Plain 44-byte headers: byte rate at 28, data length at 40.
        assert_eq!(&bytes[36..40], b"data", "{}", self.sound_path.display());
        f64::from(at(40)) / f64::from(at(28))
    }
}

fn label(line: &str) -> Label {
    let fields: Vec<_> = line.split_ascii_whitespace().collect();
    let [start, end, phone] = fields[..] else {
        panic!("a fixture's label has three fields: {line}")
    };
    let seconds = |text: &str| text.parse::<f64>().expect("a sample index") / LABEL_HZ;
    Label {
        start: seconds(start),
        end: seconds(end),
        phone: phone.to_owned(),
    }
}
