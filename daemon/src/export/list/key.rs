//! What a finished video was made of, as one number: the same key means that making it again would change nothing.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::Context as _;
use sha2::{Digest as _, Sha256};

use super::row::Word;
use crate::media::hidden::hex;

/// Bytes read at once.
const BLOCK_BYTES: usize = 64 * 1024;

type Hash = [u8; 32];

/// Hashes of files by their paths, each read once in a run: many rows share a head, a script, a backdrop.
#[derive(Default)]
pub struct Keys(Mutex<HashMap<PathBuf, Hash>>);

impl Keys {
    /// The key of a video that `words` ask for: the program's version, all options and the content of all files.
    /// A file counts by its content and its ending, since readers go by that, too.
    pub fn of(&self, words: &[(String, Word)]) -> anyhow::Result<String> {
        let mut sum = Sha256::new();
        let mut add = |bytes: &[u8]| {
            // With its length before it, no text can be taken for two.
            sum.update((bytes.len() as u64).to_le_bytes());
            sum.update(bytes);
        };
        add(env!("CARGO_PKG_VERSION").as_bytes());
        for (name, word) in words {
            add(name.as_bytes());
            match word {
                Word::Text(text) => {
                    add(b"text");
                    add(text.as_bytes());
                }
                Word::File(path) => {
                    let hash = self.hash(path);
                    let hash =
                        hash.with_context(|| format!("{} cannot be read", path.display()))?;
                    add(path.extension().unwrap_or_default().as_encoded_bytes());
                    add(&hash);
                }
            }
        }
        Ok(hex(&sum.finalize()))
    }

    fn hash(&self, path: &Path) -> io::Result<Hash> {
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = known().get(path) {
            return Ok(*hash);
        }
        let mut file = File::open(path)?;
        let mut sum = Sha256::new();
        let mut block = vec![0; BLOCK_BYTES];
        loop {
            match file.read(&mut block)? {
                0 => break,
                n => sum.update(&block[..n]),
            }
        }
        let hash = Hash::from(sum.finalize());
        known().insert(path.to_path_buf(), hash);
        Ok(hash)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_and_options_make_the_key_and_the_folder_does_not() {
        let dir = tempfile::tempdir().unwrap();
        let file = |name: &str, content: &str| {
            let path = dir.path().join(name);
            std::fs::write(&path, content).unwrap();
            Word::File(path)
        };
        let key = |word: Word| Keys::default().of(&[("labels".into(), word)]).unwrap();
        let a = key(file("a.phn", "x"));
        assert_eq!(a, key(file("b.phn", "x")));
        assert_ne!(a, key(file("a.phn", "y")));
        assert_ne!(a, key(file("a.lab", "x")));
        let text = |t: &str| key(Word::Text(t.into()));
        assert_ne!(text("a"), text("b"));
        let absent = Keys::default().of(&[("labels".into(), Word::File("no/such".into()))]);
        assert!(format!("{:#}", absent.unwrap_err()).contains("no/such"));
    }
}
