//! Which kind of output a name stands for, and where its frames go.

use std::path::Path;

use crate::cli::{BackgroundArg, ExportArgs, RawArg, Usage};
use crate::media::ffmpeg::{FfmpegSink, Recipe};
use crate::media::frames::{PngSink, RawSink};
use crate::media::mp4::Mp4Sink;
use crate::media::{Clip, FrameSink, camera};

/// A kind of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Standard output.
    Raw(RawArg),
    Pictures,
    Mp4,
    Ffmpeg(Recipe),
}

impl Kind {
    /// By the name of the output; a name that says nothing, or what it would lose, is wrong usage.
    pub fn of(output: &Path, args: &ExportArgs) -> anyhow::Result<Self> {
        let transparent = args.look.scene.background == Some(BackgroundArg::Transparent);
        let kind = Self::named(output, args, transparent)?;
        if transparent && !kind.keeps_alpha() {
            return Err(Usage(format!(
                "--background transparent: {} would not keep it; write .webm, out-%05d.png, a folder/ or - (raw RGBA)",
                output.display()
            ))
            .into());
        }
        Ok(kind)
    }

    fn named(output: &Path, args: &ExportArgs, alpha: bool) -> anyhow::Result<Self> {
        let ending = output.extension().and_then(|e| e.to_str());
        let ending = ending.map(str::to_ascii_lowercase);
        let folder = output.is_dir() || output.to_string_lossy().ends_with('/');
        Ok(match ending.as_deref() {
            _ if output == Path::new("-") => Self::Raw(args.raw),
            _ if camera::is_named(output) => Self::Ffmpeg(Recipe::Camera),
            Some("webm") if !folder => Self::Ffmpeg(Recipe::Webm { alpha }),
            _ if args.via_ffmpeg => Self::Ffmpeg(Recipe::ByName),
            _ if folder => Self::Pictures,
            Some("mp4" | "m4v") => Self::Mp4,
            Some("png") => Self::Pictures,
            _ => {
                return Err(Usage(format!(
                    "--output: what {} should be is not known; name it .mp4, .webm, out-%05d.png or a folder/, or give \
                     --via-ffmpeg for other kinds",
                    output.display()
                ))
                .into());
            }
        })
    }

    fn keeps_alpha(self) -> bool {
        matches!(
            self,
            Self::Raw(RawArg::Rgba) | Self::Pictures | Self::Ffmpeg(Recipe::Webm { .. })
        )
    }

    /// Whether what was written stays where it is, to be found again.
    pub fn stays(self) -> bool {
        !matches!(self, Self::Raw(_) | Self::Ffmpeg(Recipe::Camera))
    }

    /// Where the frames go.
    pub fn open(self, output: &Path, clip: &Clip) -> anyhow::Result<Box<dyn FrameSink>> {
        Ok(match self {
            Self::Raw(RawArg::Rgba) => Box::new(RawSink::stdout()),
            Self::Raw(RawArg::Y4m) => Box::new(RawSink::stdout_y4m(clip)?),
            Self::Pictures => Box::new(PngSink::new(output, clip)?),
            Self::Mp4 => Box::new(Mp4Sink::new(output, clip)?),
            Self::Ffmpeg(recipe) => {
                if recipe == Recipe::Camera {
                    camera::check(output)?;
                }
                Box::new(FfmpegSink::new(output, clip, recipe)?)
            }
        })
    }
}
