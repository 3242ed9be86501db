//! Video through the ffmpeg program of this machine, for codecs, containers and devices we do not write.
//!
//! What comes out depends on that program's version. Frames go into its standard input; the sound lies in a
//! temporary file beside. VP9 in WebM keeps alpha as a second picture, which browsers lay over the page.

use std::ffi::{OsStr, OsString};
use std::io::{BufWriter, Read as _, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

use anyhow::{Context as _, bail};
use tempfile::NamedTempFile;

use super::output::{self, Output};
use super::{Clip, FrameSink};

/// Of what a failing ffmpeg says, this many bytes are read; the last line is shown.
const COMPLAINT_BYTES_MAX: u64 = 16 * 1024;

/// libvpx's constant quality where no bitrate is asked for: 640x480 at 30 a second takes some 300 kbit/s.
const VP9_QUALITY: &str = "24";

/// libvpx's speed, 0 (slow) to 5: beyond 4 quality drops faster than time.
const VP9_SPEED: &str = "4";

/// What ffmpeg is to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recipe {
    /// What it takes the target's ending for.
    ByName,
    /// VP9 and Opus, with alpha or without.
    Webm { alpha: bool },
    /// Pictures at their own pace into a loopback device. No sound: the device takes none.
    Camera,
}

/// A running ffmpeg.
pub struct FfmpegSink {
    child: Child,
    /// None where it writes into a device.
    output: Option<Output>,
    _sound: Option<NamedTempFile>,
}

impl FfmpegSink {
    /// Starts ffmpeg.
    pub fn new(target: &Path, clip: &Clip, recipe: Recipe) -> anyhow::Result<Self> {
        if let Recipe::Webm { .. } = recipe {
            for encoder in ["libvpx-vp9", "libopus"] {
                has_encoder(encoder)
                    .with_context(|| format!("{} cannot be written", target.display()))?;
            }
        }
        let device = recipe == Recipe::Camera;
        let output = (!device).then(|| Output::create(target)).transpose()?;
        let sound = clip.sound.as_deref().filter(|_| !device);
        let sound = sound.map(sound_file).transpose()?;
        let to = output.as_ref().map_or(target, Output::path);
        let child = Command::new("ffmpeg")
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(input(clip, sound.as_ref().map(NamedTempFile::path), recipe))
            .args(coding(target, clip, recipe))
            .arg(to)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .context(
                "ffmpeg cannot be started; install it, or write .mp4 or .png, which need none",
            )?;
        Ok(Self {
            child,
            output,
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
        // Its last line says what it did about the trouble, not what the trouble was.
        if words.contains("No space left on device") {
            let full = std::io::Error::from(std::io::ErrorKind::StorageFull);
            return Err(match &self.output {
                Some(output) => output.unwritable(&full),
                None => full.into(),
            });
        }
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

fn words<const N: usize>(words: [&str; N]) -> impl Iterator<Item = OsString> {
    words.map(OsString::from).into_iter()
}

/// What ffmpeg reads.
fn input(clip: &Clip, sound: Option<&Path>, recipe: Recipe) -> Vec<OsString> {
    let mut args = Vec::new();
    if recipe == Recipe::Camera {
        args.extend(words(["-re"]));
    }
    let size = format!("{}x{}", clip.width, clip.height);
    let rate = format!("{}/{}", clip.fps.0, clip.fps.1);
    args.extend(words([
        "-f", "rawvideo", "-pix_fmt", "rgba", "-s", &size, "-r", &rate,
    ]));
    args.extend(words(["-i", "pipe:0"]));
    if let Some(sound) = sound {
        args.extend(words(["-f", "f32le", "-ar", "48000", "-ac", "1", "-i"]));
        args.push(sound.into());
        args.extend(words(["-map", "0:v", "-map", "1:a"]));
    }
    args
}

/// What ffmpeg makes of it.
fn coding(target: &Path, clip: &Clip, recipe: Recipe) -> Vec<OsString> {
    let pixels = match recipe {
        Recipe::Webm { alpha: true } => "yuva420p",
        _ => "yuv420p",
    };
    let filter = format!("scale=out_color_matrix=bt709:out_range=tv,format={pixels}");
    let mut args: Vec<OsString> = words(["-vf", &filter]).collect();
    for entry in ["-colorspace", "-color_primaries", "-color_trc"] {
        args.extend(words([entry, "bt709"]));
    }
    args.extend(words(["-fflags", "+bitexact"]));
    args.extend(words(["-flags:v", "+bitexact", "-flags:a", "+bitexact"]));
    if let Some(bits) = clip.bitrate {
        args.extend(words(["-b:v", &bits.to_string()]));
    }
    match recipe {
        Recipe::Webm { alpha } => {
            args.extend(words(["-c:v", "libvpx-vp9", "-deadline", "good"]));
            args.extend(words(["-cpu-used", VP9_SPEED]));
            if alpha {
                // The frames that libvpx makes up for itself have no alpha.
                args.extend(words(["-auto-alt-ref", "0"]));
            }
            if clip.bitrate.is_none() {
                args.extend(words(["-crf", VP9_QUALITY, "-b:v", "0"]));
            }
            args.extend(words(["-c:a", "libopus", "-f", "webm"]));
        }
        Recipe::Camera => args.extend(words(["-f", "v4l2"])),
        Recipe::ByName => {
            let ending = target.extension().and_then(OsStr::to_str);
            if let Some("mp4" | "mov" | "m4v") = ending {
                args.extend(words(["-movflags", "+faststart"]));
            }
        }
    }
    args
}

/// Fails where this machine's ffmpeg has not this encoder. It is asked once.
fn has_encoder(name: &str) -> anyhow::Result<()> {
    static ENCODERS: OnceLock<Option<String>> = OnceLock::new();
    let encoders = ENCODERS.get_or_init(|| {
        let mut ask = Command::new("ffmpeg");
        ask.args(["-hide_banner", "-encoders"]).stdin(Stdio::null());
        let told = ask.output().ok().filter(|told| told.status.success())?;
        Some(String::from_utf8_lossy(&told.stdout).into_owned())
    });
    match encoders {
        None => bail!(
            "it takes the ffmpeg program, which cannot be started; install it (Debian: apt install ffmpeg), or write \
             .png, which needs none"
        ),
        Some(encoders) if !encoders.split_whitespace().any(|word| word == name) => bail!(
            "this machine's ffmpeg was built without {name}; install one that has it, or write .png, which needs none"
        ),
        Some(_) => Ok(()),
    }
}

/// The sound as ffmpeg reads it without a header: 32-bit floats.
fn sound_file(sound: &[f32]) -> anyhow::Result<NamedTempFile> {
    let mut file = tempfile::Builder::new()
        .prefix("mouthpiece-")
        .suffix(".f32")
        .tempfile()?;
    let path = file.path().to_path_buf();
    let mut out = BufWriter::new(file.as_file_mut());
    let written = sound
        .iter()
        .try_for_each(|x| out.write_all(&x.to_le_bytes()))
        .and_then(|()| out.flush());
    written.map_err(|e| output::unwritable(&path, &e))?;
    drop(out);
    Ok(file)
}
