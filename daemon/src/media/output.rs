//! Files that appear whole or not at all: written beside their place under another name, renamed
//! into it at the end, removed when dropped before that.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use tempfile::NamedTempFile;

use super::hidden;

/// A file in the making.
#[derive(Debug)]
pub struct Output {
    temp: NamedTempFile,
    target: PathBuf,
    /// The target is a device or a pipe: it must be written into, never replaced.
    special: bool,
}

impl Output {
    /// Prepares to write `target`, and fails now if that cannot end well.
    pub fn create(target: &Path) -> anyhow::Result<Self> {
        // Through a link to what it points at, so that the link stays one.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
        let special = match fs::metadata(&target) {
            Ok(meta) if meta.is_dir() => {
                bail!(
                    "cannot write {}: it is a folder; name a file in it",
                    target.display()
                )
            }
            Ok(meta) => !meta.is_file(),
            Err(_) => false,
        };
        let folder = if special {
            std::env::temp_dir()
        } else {
            hidden::folder(&target)
        };
        let prefix = hidden::prefix(&target);
        let temp = builder(&target, &prefix)
            .tempfile_in(&folder)
            .map_err(|e| unwritable(&target, &e))?;
        Ok(Self {
            temp,
            target,
            special,
        })
    }

    /// The file to write.
    pub fn file(&mut self) -> &mut File {
        self.temp.as_file_mut()
    }

    /// The name it has until it is complete, for programs that write it themselves.
    pub fn path(&self) -> &Path {
        self.temp.path()
    }

    /// The one sentence for a write into it that failed.
    pub fn unwritable(&self, error: &io::Error) -> anyhow::Error {
        unwritable(&self.target, error)
    }

    /// Puts what was written under its final name, once it is on the disk: a machine that loses its power leaves the
    /// file of before or all of this one.
    pub fn commit(self) -> anyhow::Result<()> {
        let target = self.target;
        if self.special {
            let mut from = File::open(self.temp.path())?;
            let mut to = File::options().write(true).open(&target)?;
            io::copy(&mut from, &mut to).map_err(|e| unwritable(&target, &e))?;
            return Ok(());
        }
        let synced = self.temp.as_file().sync_all();
        synced.map_err(|e| unwritable(&target, &e))?;
        self.temp
            .persist(&target)
            .map_err(|e| unwritable(&target, &e.error))?;
        sync_folder(&hidden::folder(&target));
        Ok(())
    }
}

/// Puts the names in a folder on the disk. Where that cannot be done, they get there a little later.
pub fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

/// Writes all of `bytes` to the file at `target`, or leaves it as it was.
pub fn write(target: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut output = Output::create(target)?;
    output
        .file()
        .write_all(bytes)
        .map_err(|e| unwritable(target, &e))?;
    output.commit()
}

/// Writes `text` to `target`, or to standard output where there is none.
pub fn write_or_print(target: Option<&Path>, text: &str) -> anyhow::Result<()> {
    match target {
        Some(path) if path != Path::new("-") => write(path, text.as_bytes()),
        _ => print(text),
    }
}

/// Writes to standard output; a reader that has left, like `head`, is no failure.
pub fn print(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(e).context("cannot write to standard output")
        }
        _ => Ok(()),
    }
}

/// The one sentence for a file that cannot be written.
pub fn unwritable(target: &Path, error: &io::Error) -> anyhow::Error {
    let why = match error.kind() {
        io::ErrorKind::NotFound => {
            "its folder does not exist or takes no files; make it first".into()
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "you may not write there; choose another folder".into()
        }
        io::ErrorKind::StorageFull => "there is no space left; free some".into(),
        io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "you may not write so much there; ask for more, or choose another folder".into()
        }
        _ => error.to_string(),
    };
    anyhow::anyhow!("cannot write {}: {why}", target.display())
}

/// Names and permissions of files in the making. The ending stays, since programs go by it.
fn builder<'a>(target: &Path, prefix: &'a str) -> tempfile::Builder<'a, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix);
    if let Some(ending) = target.extension().and_then(|e| e.to_str()) {
        let ending: &'static str = match ending {
            "mp4" => ".mp4",
            "webm" => ".webm",
            "mkv" => ".mkv",
            "mov" => ".mov",
            _ => ".part",
        };
        builder.suffix(ending);
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // The user's umask takes off what they do not want; a private file would surprise.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_there_before_commit_nor_after_a_drop() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a.mp4");
        let mut output = Output::create(&target).unwrap();
        output.file().write_all(b"half").unwrap();
        assert!(!target.exists());
        drop(output);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
        write(&target, b"whole").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"whole");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_cannot_be_written_is_said_at_once() {
        let dir = tempfile::tempdir().unwrap();
        let error = Output::create(dir.path()).unwrap_err().to_string();
        assert!(error.contains("folder"), "{error}");
        let error = Output::create(&dir.path().join("no/a.mp4"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("make it first"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_into_and_a_link_stays_a_link() {
        let dir = tempfile::tempdir().unwrap();
        write(Path::new("/dev/null"), b"x").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        let (real, link) = (dir.path().join("real"), dir.path().join("link"));
        fs::write(&real, b"old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"new");
    }
}
