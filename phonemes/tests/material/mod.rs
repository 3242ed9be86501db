//! Files that other programs wrote, where a developer has them: in `MOUTHPIECE_MATERIAL`, or in
//! `shared/material` of a folder above this one. Tests that want one skip where there is none.

use std::path::{Path, PathBuf};

fn folder() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("MOUTHPIECE_MATERIAL") {
        return Some(named.into());
    }
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let mut places = above.map(|folder| folder.join("shared/material"));
    places.find(|folder| folder.is_dir())
}

/// A file's place; `None`, with a printed reason, where there is no material.
#[allow(dead_code, reason = "not every test file wants all of these")]
pub(crate) fn path(file: &str) -> Option<PathBuf> {
    let path = folder()
        .map(|folder| folder.join(file))
        .filter(|path| path.is_file());
    if path.is_none() {
        println!("skipped: {file} is not here; name its folder in MOUTHPIECE_MATERIAL");
    }
    path
}

/// A file's text; the same where there is none.
#[allow(dead_code, reason = "not every test file wants all of these")]
pub(crate) fn text(file: &str) -> Option<String> {
    path(file).and_then(|path| std::fs::read_to_string(path).ok())
}

/// The phone symbols of a file, found without the readers under test.
#[allow(dead_code, reason = "not every test file wants all of these")]
pub(crate) fn symbols(file: &str, text: &str) -> Vec<String> {
    let owned = |field: Option<&str>| field.unwrap_or_default().to_owned();
    let lines = text.lines();
    if file.ends_with(".psdur") {
        let pairs = text.split_whitespace();
        pairs.map(|pair| owned(pair.split(':').next())).collect()
    } else if file.ends_with(".ev") {
        let events = lines.filter(|line| line.starts_with("PHONEME"));
        events.map(|line| owned(line.split('\t').nth(3))).collect()
    } else if file.ends_with(".json") {
        text.split('"')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect()
    } else {
        let labels = lines.filter(|line| line.split_whitespace().count() == 3);
        labels
            .map(|line| owned(line.split_whitespace().last()))
            .collect()
    }
}
