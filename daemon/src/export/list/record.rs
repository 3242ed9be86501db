//! What is known of an output besides itself: which key it was made with, and who is making it.
//!
//! A small file in the hidden folder `.mouthpiece` beside the output. Whoever makes the output holds a lock on it, which
//! the system takes back when the process dies, however it dies: so what lies unfinished beside the output while
//! nobody holds the lock is left over. The key is struck out before the work and written after the output is in its place;
//! a machine that stops between the two makes the output again, which is never wrong.

use std::fs::{self, File, TryLockError};
use std::io::{Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use serde::{Deserialize, Serialize};

use crate::export::sink::Kind;
use crate::media::{frames, hidden, output};

/// The folder of records.
const FOLDER: &str = ".mouthpiece";

/// More than a record takes.
const RECORD_BYTES_MAX: u64 = 4096;

/// What a record says.
#[derive(Debug, Default, Deserialize, PartialEq, Serialize)]
struct Made {
    key: String,
    version: String,
    /// Size of the file, or how many pictures the sequence has.
    extent: u64,
}

/// An output that may be worked on, or need not be.
pub enum Claim {
    /// It is there, made with this key.
    Finished,
    /// Another process is making it.
    Taken,
    Mine(Record),
}

/// The record of an output that this process is making.
pub struct Record {
    file: File,
    target: PathBuf,
    kind: Kind,
    /// Extent of what was finished here last.
    before: u64,
}

impl Record {
    /// Claims `target`, to be made with `key`, and clears what a killed attempt has left.
    pub fn claim(target: &Path, kind: Kind, key: &str) -> anyhow::Result<Claim> {
        let (path, folder) = place(target);
        fs::create_dir_all(&folder).map_err(|e| output::unwritable(target, &e))?;
        let begun_before = path.exists();
        let mut file = File::options()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(|e| output::unwritable(&path, &e))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(Claim::Taken),
            // Where files cannot be locked, only the list's own order keeps two from one output.
            Err(TryLockError::Error(error)) => {
                tracing::debug!(%error, "{} cannot be locked", path.display());
            }
        }
        let mut text = String::new();
        // What cannot be read says nothing.
        let _ = (&mut file).take(RECORD_BYTES_MAX).read_to_string(&mut text);
        let before: Made = serde_json::from_str(&text).unwrap_or_default();
        if before.key == key && extent(target, kind, before.extent) == Some(before.extent) {
            return Ok(Claim::Finished);
        }
        if begun_before {
            hidden::clear(target).map_err(|e| output::unwritable(target, &e))?;
        }
        let mut record = Self {
            file,
            target: target.to_path_buf(),
            kind,
            before: before.extent,
        };
        record.write(&Made {
            key: String::new(),
            ..before
        })?;
        Ok(Claim::Mine(record))
    }

    /// Writes down that the output is in its place, with `count` pictures where it is a sequence.
    pub fn finish(mut self, key: &str, count: u64) -> anyhow::Result<()> {
        if self.kind == Kind::Pictures {
            // What a longer clip of before has left would be taken for this one's end.
            for path in frames::paths(&self.target, count..self.before)? {
                let _ = fs::remove_file(path);
            }
        }
        let made = Made {
            key: key.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            extent: extent(&self.target, self.kind, count).context("the output is gone again")?,
        };
        self.write(&made)
    }

    fn write(&mut self, made: &Made) -> anyhow::Result<()> {
        let text = serde_json::to_vec(made)?;
        self.file
            .set_len(0)
            .and_then(|()| self.file.rewind())
            .and_then(|()| self.file.write_all(&text))
            .and_then(|()| self.file.sync_all())
            .map_err(|e| output::unwritable(&place(&self.target).0, &e))
    }
}

/// The record's file, and its folder.
fn place(target: &Path) -> (PathBuf, PathBuf) {
    let parent = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let folder = parent.join(FOLDER);
    let name = hidden::token(target.file_name().unwrap_or_default());
    (folder.join(name + ".json"), folder)
}

/// How much there is of an output of which there should be `count`; none where it is not whole.
fn extent(target: &Path, kind: Kind, count: u64) -> Option<u64> {
    if kind == Kind::Pictures {
        let mut paths = frames::paths(target, 0..count).ok()?;
        return paths.all(|path| path.is_file()).then_some(count);
    }
    let found = fs::metadata(target).ok()?;
    found.is_file().then_some(found.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claimed(target: &Path, key: &str) -> Option<Record> {
        match Record::claim(target, Kind::Mp4, key).unwrap() {
            Claim::Mine(record) => Some(record),
            Claim::Finished | Claim::Taken => None,
        }
    }

    #[test]
    fn what_is_finished_stays_until_its_inputs_or_itself_change() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a.mp4");
        let record = claimed(&target, "k1").unwrap();
        assert!(matches!(
            Record::claim(&target, Kind::Mp4, "k1").unwrap(),
            Claim::Taken
        ));
        fs::write(&target, b"video").unwrap();
        record.finish("k1", 3).unwrap();
        assert!(claimed(&target, "k1").is_none());
        // Begun with other inputs and killed: neither key is that of what lies there.
        drop(claimed(&target, "k2").unwrap());
        assert!(claimed(&target, "k1").is_some());
        claimed(&target, "k1").unwrap().finish("k1", 3).unwrap();
        fs::write(&target, b"vid").unwrap();
        assert!(claimed(&target, "k1").is_some(), "a cut file");
        fs::remove_file(&target).unwrap();
        assert!(claimed(&target, "k1").is_some(), "no file");
    }

    #[test]
    fn the_end_of_a_longer_sequence_goes_away() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("f-%02d.png");
        let picture = |k: u64| dir.path().join(format!("f-{k:02}.png"));
        for (key, count) in [("long", 5), ("short", 2)] {
            let Claim::Mine(record) = Record::claim(&target, Kind::Pictures, key).unwrap() else {
                panic!("{key} is not there yet")
            };
            (0..count).for_each(|k| fs::write(picture(k), b"x").unwrap());
            record.finish(key, count).unwrap();
        }
        assert!(picture(1).exists() && !picture(2).exists() && !picture(4).exists());
        assert!(matches!(
            Record::claim(&target, Kind::Pictures, "short").unwrap(),
            Claim::Finished
        ));
    }
}
