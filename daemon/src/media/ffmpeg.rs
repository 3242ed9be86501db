//! Video through the ffmpeg program of this machine, for codecs and containers we do not write.
//!
//! Only when asked for by `--via-ffmpeg`: what comes out depends on that program's version.
//! Frames go into its standard input; the sound lies in a temporary file beside.

use std::io::{BufWriter, Read as _, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use anyhow::{Context as _, bail};
use tempfile::NamedTempFile;

use super::output::Output;
use super::{Clip, FrameSink};

/// Of what a failing ffmpeg says, this many bytes are read; the last line is shown.
const COMPLAINT_BYTES_MAX: u64 = 16 * 1024;

/// A running ffmpeg.
pub struct FfmpegSink {
    child: Child,
    output: Option<Output>,
    _sound: Option<NamedTempFile>,
}

impl FfmpegSink {
    /// Starts ffmpeg; the container goes by `target`'s ending.
    pub fn new(target: &Path, clip: &Clip) -> anyhow::Result<Self> {
        let output = Output::create(target)?;
        let sound = clip.sound.as_deref().map(sound_file).transpose()?;
        let mut command = Command::new("ffmpeg");
        command
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pix_fmt", "rgba"])
            .args(["-s", &format!("{}x{}", clip.width, clip.height)])
            .args([
                "-r",
                &format!("{}/{}", clip.fps.0, clip.fps.1),
                "-i",
                "pipe:0",
            ]);
        if let Some(sound) = &sound {
            command
                .args(["-f", "f32le", "-ar", "48000", "-ac", "1", "-i"])
                .arg(sound.path())
                .args(["-map", "0:v", "-map", "1:a"]);
        }
        command
            .args([
                "-vf",
                "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
            ])
            .args([
                "-colorspace",
                "bt709",
                "-color_primaries",
                "bt709",
                "-color_trc",
                "bt709",
            ])
            .args([
                "-fflags",
                "+bitexact",
                "-flags:v",
                "+bitexact",
                "-flags:a",
                "+bitexact",
            ]);
        if let Some(bits) = clip.bitrate {
            command.args(["-b:v", &bits.to_string()]);
        }
        if matches!(
            target.extension().and_then(|e| e.to_str()),
            Some("mp4" | "mov" | "m4v")
        ) {
            command.args(["-movflags", "+faststart"]);
        }
        let child = command
            .arg(output.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .context("ffmpeg cannot be started; install it or leave --via-ffmpeg out")?;
        Ok(Self {
            child,
            output: Some(output),
            _sound: sound,
        })
    }

    /// Ends ffmpeg's input and waits for it; an error is its own last words.
    fn wait(&mut self) -> anyhow::Result<()> {
        drop(self.child.stdin.take());
        let mut words = Vec::new();
        if let Some(pipe) = self.child.stderr.take() {
            pipe.take(COMPLAINT_BYTES_MAX).read_to_end(&mut words)?;
        }
        if self.child.wait()?.success() {
            return Ok(());
        }
        let words = String::from_utf8_lossy(&words);
        let last = words.lines().rfind(|line| !line.trim().is_empty());
        bail!(
            "ffmpeg failed: {}",
            last.unwrap_or("it did not say why").trim()
        )
    }
}

impl FrameSink for FfmpegSink {
    fn frame(&mut self, rgba: &[u8]) -> anyhow::Result<()> {
        let written = match &mut self.child.stdin {
            Some(pipe) => pipe.write_all(rgba),
            None => Ok(()),
        };
        if written.is_err() {
            self.wait()?;
            bail!("ffmpeg has stopped before the last frame");
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> anyhow::Result<()> {
        self.wait()?;
        self.output.take().map_or(Ok(()), Output::commit)
    }
}

impl Drop for FfmpegSink {
    fn drop(&mut self) {
        // After `finish` it has ended already; before, what it wrote goes away with `output`.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The sound as ffmpeg reads it without a header: 32-bit floats.
fn sound_file(sound: &[f32]) -> anyhow::Result<NamedTempFile> {
    let mut file = tempfile::Builder::new()
        .prefix("mouthpiece-")
        .suffix(".f32")
        .tempfile()?;
    let mut out = BufWriter::new(file.as_file_mut());
    for x in sound {
        out.write_all(&x.to_le_bytes())?;
    }
    out.flush()?;
    drop(out);
    Ok(file)
}
