//! Sound files that clients name: below one folder, or none at all.
//!
//! Over the Unix socket the default is any file, since only this user can open that socket, who can read
//! these files anyway. Whoever else may come in (a group, TCP, a WebSocket) has to be given a folder.

use std::fs::File;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};

/// What clients may have read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Files {
    /// Nothing.
    None,
    /// Regular files below this folder, which is written without links.
    Below(PathBuf),
}

impl Files {
    /// Whatever is below `folder`.
    pub fn below(folder: &Path) -> Result<Self> {
        let folder = folder.canonicalize().with_context(|| {
            format!(
                "`files` of [wire]: there is no folder {}; make it or name another",
                folder.display()
            )
        })?;
        Ok(Self::Below(folder))
    }

    /// Opens the file at `path`. What lies outside and what is not there are answered alike, so that
    /// nobody learns which files there are.
    pub fn open(&self, path: &Path) -> Result<File, String> {
        let refused = || format!("{} is no file that may be read here", path.display());
        let Self::Below(folder) = self else {
            return Err(refused());
        };
        // `..` and links are resolved first; the result is what is opened.
        let real = path.canonicalize().map_err(|_| refused())?;
        if !real.starts_with(folder) || !real.is_file() {
            return Err(refused());
        }
        File::open(&real).map_err(|_| refused())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_outside_the_folder_is_opened_by_any_path() {
        let outer = tempfile::tempdir().unwrap();
        let inner = outer.path().join("sounds");
        std::fs::create_dir(&inner).unwrap();
        std::fs::write(inner.join("a.wav"), "in").unwrap();
        std::fs::write(outer.path().join("b.wav"), "out").unwrap();
        std::os::unix::fs::symlink("../b.wav", inner.join("link.wav")).unwrap();
        std::os::unix::fs::symlink("a.wav", inner.join("good.wav")).unwrap();
        std::os::unix::fs::symlink("..", inner.join("up")).unwrap();
        let files = Files::below(&inner).unwrap();
        let may = |name: &str| files.open(&inner.join(name)).is_ok();
        assert!(may("a.wav") && may("good.wav") && may("../sounds/a.wav"));
        for name in ["../b.wav", "link.wav", "up/b.wav", "missing.wav", "up", ""] {
            assert!(!may(name), "{name}");
        }
        // A folder whose name only begins alike.
        let beside = outer.path().join("sounds-of-others");
        std::fs::create_dir(&beside).unwrap();
        std::fs::write(beside.join("c.wav"), "out").unwrap();
        assert!(files.open(&beside.join("c.wav")).is_err());
        assert!(Files::None.open(&inner.join("a.wav")).is_err());
        assert!(Files::below(&outer.path().join("nowhere")).is_err());
    }

    #[test]
    fn what_is_no_regular_file_is_refused() {
        let any = Files::below(Path::new("/")).unwrap();
        assert!(any.open(Path::new("/dev/zero")).is_err());
    }
}
