//! Names of what is not finished yet, and of what is kept beside finished files.
//!
//! What is in the making lies beside its place and is called after it, `.mouthpiece-NAME-…`: after a kill
//! whoever makes NAME again knows what is left of the first attempt, and touches nobody else's.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

/// What all these names begin with.
const BEGINNING: &str = ".mouthpiece-";

/// A longer name is cut, so that with what stands round it it stays below the 255 bytes of a file's name.
const NAME_BYTES_MAX: usize = 160;

/// Bytes of a cut name's hash that stand for the rest of it.
const HASH_BYTES: usize = 8;

/// A file's name, or as much of it as fits and a hash: different names stay different.
pub fn token(name: &OsStr) -> String {
    let text = name.to_string_lossy();
    if text.len() <= NAME_BYTES_MAX && name.to_str().is_some() {
        return text.into_owned();
    }
    let hash = Sha256::digest(name.as_encoded_bytes());
    let cut = text.floor_char_boundary(NAME_BYTES_MAX - 2 * HASH_BYTES - 1);
    format!("{}-{}", &text[..cut], hex(&hash[..HASH_BYTES]))
}

/// Bytes as people write them.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What the names of `target`'s unfinished files begin with.
pub fn prefix(target: &Path) -> String {
    format!(
        "{BEGINNING}{}-",
        token(target.file_name().unwrap_or_default())
    )
}

/// The folder that `target`'s unfinished files lie in: its own, or itself where it is a folder of pictures.
pub fn folder(target: &Path) -> PathBuf {
    if target.to_string_lossy().ends_with('/') || target.is_dir() {
        return target.to_path_buf();
    }
    match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// Removes what an attempt at `target` that was killed has left. Nobody may be making it now.
pub fn clear(target: &Path) -> io::Result<()> {
    let prefix = prefix(target);
    for entry in fs::read_dir(folder(target))? {
        let entry = entry?;
        let name = entry.file_name();
        let Some(rest) = name.to_str().and_then(|name| name.strip_prefix(&prefix)) else {
            continue;
        };
        // `a.mp4-b.mp4` is another's name; what makes ours unique has no dash.
        if rest.contains('-') {
            continue;
        }
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_are_cut_and_stay_different() {
        let name = |end: &str| token(OsStr::new(&format!("{}{end}", "ü".repeat(120))));
        assert!(name("a").len() <= NAME_BYTES_MAX);
        assert_ne!(name("a"), name("b"));
        assert_eq!(token(OsStr::new("a.mp4")), "a.mp4");
    }

    #[test]
    fn only_what_is_left_of_this_target_is_cleared() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        let others = [
            "a.mp4",
            ".mouthpiece-b.mp4-x1.mp4",
            ".mouthpiece-a.mp4-b.mp4-x1.mp4",
            "x",
        ];
        for name in others.iter().chain(&[".mouthpiece-a.mp4-x1.mp4"]) {
            fs::write(at(name), b"x").unwrap();
        }
        fs::create_dir(at(".mouthpiece-a.mp4-x2")).unwrap();
        fs::write(at(".mouthpiece-a.mp4-x2/f.png"), b"x").unwrap();
        clear(&at("a.mp4")).unwrap();
        let mut left: Vec<_> = fs::read_dir(dir.path()).unwrap().collect();
        assert_eq!(left.len(), others.len());
        left.retain(|e| !others.contains(&e.as_ref().unwrap().file_name().to_str().unwrap()));
        assert!(left.is_empty());
    }
}
