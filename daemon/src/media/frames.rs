//! Frames without a container: one PNG each, or raw frames on standard output for another program.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use tempfile::TempDir;

use super::yuv::Yuv;
use super::{Clip, FrameSink, hidden, output};

/// Encodes one RGBA picture as PNG.
pub fn png(rgba: &[u8], width: u32, height: u32) -> anyhow::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.write_header()?.write_image_data(rgba)?;
    Ok(bytes)
}

/// A folder of PNGs, gathered in a hidden folder beside and moved when complete.
pub struct PngSink {
    temp: TempDir,
    folder: PathBuf,
    name: Pattern,
    size: (u32, u32),
    count: u64,
}

impl PngSink {
    /// `target` is a pattern like `out-%05d.png`, or a folder (`out/`: `out/00000.png` …).
    pub fn new(target: &Path, clip: &Clip) -> anyhow::Result<Self> {
        let (folder, name) = match Pattern::parse(target)? {
            Some(found) => found,
            None => {
                fs::create_dir_all(target).map_err(|e| output::unwritable(target, &e))?;
                (target.to_path_buf(), Pattern::plain())
            }
        };
        let temp = tempfile::Builder::new()
            .prefix(&hidden::prefix(target))
            .tempdir_in(&folder)
            .map_err(|e| output::unwritable(target, &e))?;
        let size = (clip.width, clip.height);
        Ok(Self {
            temp,
            folder,
            name,
            size,
            count: 0,
        })
    }
}

impl FrameSink for PngSink {
    fn frame(&mut self, rgba: &[u8]) -> anyhow::Result<()> {
        let path = self.temp.path().join(self.name.at(self.count));
        let bytes = png(rgba, self.size.0, self.size.1)?;
        fs::write(&path, bytes).map_err(|e| output::unwritable(&path, &e))?;
        self.count += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> anyhow::Result<()> {
        for k in 0..self.count {
            let name = self.name.at(k);
            let target = self.folder.join(&name);
            let temp = self.temp.path().join(&name);
            File::open(&temp)
                .and_then(|file| file.sync_all())
                .and_then(|()| fs::rename(&temp, &target))
                .map_err(|e| output::unwritable(&target, &e))?;
        }
        output::sync_folder(&self.folder);
        Ok(())
    }
}

/// Where the pictures of a sequence lie that was written to `target`.
pub fn paths(target: &Path, numbers: Range<u64>) -> anyhow::Result<impl Iterator<Item = PathBuf>> {
    let (folder, name) =
        Pattern::parse(target)?.unwrap_or_else(|| (target.to_path_buf(), Pattern::plain()));
    Ok(numbers.map(move |k| folder.join(name.at(k))))
}

/// A file name with a number in it.
#[derive(Debug, PartialEq)]
struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// Folder and pattern of `out-%05d.png`; none where `target` is no pattern.
    fn parse(target: &Path) -> anyhow::Result<Option<(PathBuf, Self)>> {
        let text = target.to_string_lossy();
        let Some(name) = target.file_name().map(|n| n.to_string_lossy().into_owned()) else {
            return Ok(None);
        };
        if text.ends_with('/') || target.is_dir() {
            return Ok(None);
        }
        let mend = || format!("{text} needs a number for the frame: write out-%05d.png");
        let (before, rest) = name.split_once('%').with_context(mend)?;
        let (digits, after) = rest.split_once('d').with_context(mend)?;
        // Nine digits number more frames than an hour can hold.
        let digits = match digits {
            "" => 1,
            n if n.bytes().all(|b| b.is_ascii_digit()) && n.len() <= 2 => n.parse()?,
            _ => bail!(mend()),
        };
        if digits > 9 || after.contains('%') {
            bail!(mend());
        }
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
            _ => PathBuf::from("."),
        };
        let pattern = Self {
            before: before.into(),
            digits,
            after: after.into(),
        };
        Ok(Some((folder, pattern)))
    }

    fn plain() -> Self {
        Self {
            before: String::new(),
            digits: 5,
            after: ".png".into(),
        }
    }

    fn at(&self, k: u64) -> String {
        format!(
            "{}{k:0digits$}{}",
            self.before,
            self.after,
            digits = self.digits
        )
    }
}

/// Raw frames, one behind the other.
pub struct RawSink<W: Write> {
    out: BufWriter<W>,
    format: Format,
}

/// What raw frames are.
enum Format {
    /// RGBA, no header.
    Rgba,
    /// Planes with YUV4MPEG2's header, which tells the reader size and rate.
    Y4m { header: Option<String>, yuv: Yuv },
}

impl RawSink<io::Stdout> {
    /// RGBA to standard output.
    pub fn stdout() -> Self {
        Self::new(io::stdout(), Format::Rgba)
    }

    /// YUV4MPEG2 to standard output: 4:2:0, BT.709, limited range, chroma in the middle of four pixels.
    pub fn stdout_y4m(clip: &Clip) -> anyhow::Result<Self> {
        if !(clip.width.is_multiple_of(2) && clip.height.is_multiple_of(2)) {
            let even = |side: u32| side.next_multiple_of(2);
            let (width, height) = (even(clip.width), even(clip.height));
            bail!("Y4M of 4:2:0 needs even sides: use --size {width}x{height}, or --raw rgba");
        }
        let (num, den) = clip.fps;
        let header = format!(
            "YUV4MPEG2 W{} H{} F{num}:{den} Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n",
            clip.width, clip.height
        );
        let yuv = Yuv::new(clip.width as usize, clip.height as usize);
        let header = Some(header);
        Ok(Self::new(io::stdout(), Format::Y4m { header, yuv }))
    }
}

impl<W: Write> RawSink<W> {
    fn new(out: W, format: Format) -> Self {
        let out = BufWriter::new(out);
        Self { out, format }
    }

    fn write(&mut self, rgba: &[u8]) -> io::Result<()> {
        match &mut self.format {
            Format::Rgba => self.out.write_all(rgba),
            Format::Y4m { header, yuv } => {
                if let Some(header) = header.take() {
                    self.out.write_all(header.as_bytes())?;
                }
                yuv.set(rgba);
                self.out.write_all(b"FRAME\n")?;
                for plane in [&yuv.y, &yuv.u, &yuv.v] {
                    self.out.write_all(plane)?;
                }
                Ok(())
            }
        }
    }
}

/// What became of the other end of the pipe.
fn gone(error: io::Error) -> anyhow::Error {
    if error.kind() == io::ErrorKind::BrokenPipe {
        anyhow::Error::new(error).context("the program that takes the frames has stopped reading")
    } else {
        output::unwritable(Path::new("standard output"), &error)
    }
}

impl<W: Write + Send> FrameSink for RawSink<W> {
    fn frame(&mut self, rgba: &[u8]) -> anyhow::Result<()> {
        self.write(rgba).map_err(gone)
    }

    fn finish(mut self: Box<Self>) -> anyhow::Result<()> {
        self.out.flush().map_err(gone)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip() -> Clip {
        Clip {
            width: 4,
            height: 2,
            fps: (30, 1),
            frames: 2,
            sound: None,
            bitrate: None,
        }
    }

    #[test]
    fn pictures_appear_together_at_the_end() {
        let dir = tempfile::tempdir().unwrap();
        let visible = || {
            fs::read_dir(dir.path())
                .unwrap()
                .filter(|e| {
                    !e.as_ref()
                        .unwrap()
                        .file_name()
                        .to_string_lossy()
                        .starts_with('.')
                })
                .count()
        };
        let mut sink = Box::new(PngSink::new(&dir.path().join("f-%03d.png"), &clip()).unwrap());
        sink.frame(&[9; 32]).unwrap();
        sink.frame(&[7; 32]).unwrap();
        assert_eq!(visible(), 0);
        sink.finish().unwrap();
        assert_eq!(visible(), 2);
        assert!(dir.path().join("f-001.png").exists());
        let mut sink = Box::new(PngSink::new(&dir.path().join("new/"), &clip()).unwrap());
        sink.frame(&[9; 32]).unwrap();
        sink.finish().unwrap();
        assert!(dir.path().join("new/00000.png").exists());
    }

    #[test]
    fn a_name_without_a_number_is_refused() {
        for bad in ["a.png", "%xd.png", "a%99d.png", "%d%d.png"] {
            assert!(Pattern::parse(Path::new(bad)).is_err(), "{bad}");
        }
    }
}
