//! Text that grows line by line, to a file or to standard output, so that an hour of it needs no more
//! memory than a second.

use std::fs::File;
use std::io::{self, BufWriter, StdoutLock, Write as _};
use std::path::{Path, PathBuf};

use anyhow::Context as _;

use super::output::{Output, unwritable};

/// Where text goes.
#[derive(Debug)]
pub struct TextOutput {
    to: To,
    /// Standard output's reader has left, like `head`: no failure, but nobody wants more.
    left: bool,
}

#[derive(Debug)]
enum To {
    File {
        output: Output,
        writer: BufWriter<File>,
        target: PathBuf,
    },
    Print(BufWriter<StdoutLock<'static>>),
}

impl TextOutput {
    /// Prepares to write `target`, or standard output where there is none or it is `-`.
    pub fn create(target: Option<&Path>) -> anyhow::Result<Self> {
        let to = match target {
            Some(path) if path != Path::new("-") => {
                let mut output = Output::create(path)?;
                let file = output.file().try_clone();
                To::File {
                    writer: BufWriter::new(file.map_err(|e| unwritable(path, &e))?),
                    output,
                    target: path.to_path_buf(),
                }
            }
            _ => To::Print(BufWriter::new(io::stdout().lock())),
        };
        Ok(Self { to, left: false })
    }

    /// Adds `text`; false when nobody reads it any more.
    pub fn write(&mut self, text: &str) -> anyhow::Result<bool> {
        let written = match &mut self.to {
            _ if self.left => Ok(()),
            To::File { writer, .. } => writer.write_all(text.as_bytes()),
            To::Print(writer) => writer.write_all(text.as_bytes()),
        };
        self.judge(written)?;
        Ok(!self.left)
    }

    /// Puts a file under its name.
    pub fn finish(mut self) -> anyhow::Result<()> {
        let flushed = match &mut self.to {
            _ if self.left => Ok(()),
            To::File { writer, .. } => writer.flush(),
            To::Print(writer) => writer.flush(),
        };
        self.judge(flushed)?;
        match self.to {
            To::File { output, .. } => output.commit(),
            To::Print(_) => Ok(()),
        }
    }

    fn judge(&mut self, written: io::Result<()>) -> anyhow::Result<()> {
        let Err(error) = written else { return Ok(()) };
        match &self.to {
            To::File { target, .. } => Err(unwritable(target, &error)),
            To::Print(_) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.left = true;
                Ok(())
            }
            To::Print(_) => Err(error).context("cannot write to standard output"),
        }
    }
}
