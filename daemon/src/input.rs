//! What is to be said, from files or from the built-in demo: labels, sound and how long both last.

use std::fs::File;
use std::io;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context as _, bail};
use mouthpiece_phonemes::{
    Alphabet, Labels, ReadOptions, SampleRate, Segment, Warning, check, spread,
};
use mouthpiece_rig::TICK_RATE;
use nix::fcntl::{FcntlArg, OFlag, fcntl};

use crate::cli::{InputArgs, TextArgs, Usage};
use crate::dictionary;
use crate::media::wav;
use crate::voices;

/// The sentence of the demo: as any user's, labels at 16 kHz and a WAV.
const DEMO_LABELS: &[u8] = include_bytes!("../../tests/fixtures/demo.PHN");
const DEMO_SOUND: &[u8] = include_bytes!("../../tests/fixtures/demo.wav");

/// The format that stands for any: found by name and content.
pub const AUTO: &str = "auto";

/// Longest utterance: as long as the longest sound.
const TICKS_MAX: i64 = wav::SECONDS_MAX as i64 * TICK_RATE;

/// Something to say.
#[derive(Clone, Debug)]
pub struct Utterance {
    /// Phones in order of time.
    pub segments: Vec<Segment>,
    /// Mono at 48 kHz, from tick 0 on.
    pub sound: Option<Arc<[f32]>>,
    /// How long it lasts: the longer of labels and sound.
    pub ticks: i64,
    /// What is said, where it came as a text.
    pub text: Option<String>,
}

impl Utterance {
    /// Reads what `args` name, and says on stderr what is odd about it.
    pub fn load(args: &InputArgs) -> anyhow::Result<Self> {
        if let Some(text) = &args.text.text {
            return Self::of_text(text, args);
        }
        one_use(args)?;
        let (name, labels, sound) = match &args.labels {
            Some(path) => {
                let options = options(args)?;
                let mut labels = read_labels(path, args.from.as_deref(), &options)?;
                if let (true, Some(own)) = (labels.segments.is_empty(), &options.pronouncer) {
                    labels.segments = own.spread(&labels.words);
                }
                let sound = args.audio.as_deref().map(read_sound).transpose()?;
                (path.display().to_string(), labels, sound)
            }
            None => {
                let options = ReadOptions::at(SampleRate::TIMIT);
                let labels =
                    mouthpiece_phonemes::read_from("demo.PHN", DEMO_LABELS, None, &options)?;
                (
                    "demo.PHN".into(),
                    labels,
                    Some(wav::decode(DEMO_SOUND, "demo.wav")?),
                )
            }
        };
        Self::new(&name, labels, sound.map(|sound| sound.frames))
    }

    /// What an engine makes of a text, or where a text lies in a recording.
    fn of_text(text: &str, args: &InputArgs) -> anyhow::Result<Self> {
        let words = &args.text;
        let (spoken, text) = match (words.tts, &args.audio) {
            (Some(engine), _) => {
                let text = voices::text(text)?;
                (engine.speak(&text, words.voice.as_deref())?, text)
            }
            (None, Some(path)) => {
                let sound = read_sound(path)?;
                let text = voices::text(text)?;
                let name = path.display().to_string();
                (voices::align(&text, sound, &name)?, text)
            }
            (None, None) => {
                return Err(Usage(
                    "--text needs a voice: --tts espeak-ng, flite, festival or piper (`mouthpiece doctor` says \
                     which are here), or --audio with a recording of the text"
                        .into(),
                )
                .into());
            }
        };
        let sound = Some(spoken.sound.frames);
        let utterance = Self::new(&spoken.name, spoken.labels, sound)?;
        Ok(Self {
            text: Some(text),
            ..utterance
        })
    }

    /// The built-in demo.
    pub fn demo() -> anyhow::Result<Self> {
        Self::load(&InputArgs {
            labels: None,
            audio: None,
            demo: true,
            text: TextArgs::default(),
            from: None,
            label_rate: 16_000,
            alphabet: None,
            label_tier: None,
            dictionary: None,
        })
    }

    fn new(name: &str, mut labels: Labels, sound: Option<Vec<f32>>) -> anyhow::Result<Self> {
        for note in &labels.notes {
            tracing::warn!("{name}: {note}");
        }
        if labels.segments.is_empty() {
            labels.segments = spread(&labels.words);
            tracing::info!("{name} holds words alone; their phones are those of a dictionary");
        }
        if labels.segments.is_empty() {
            bail!("{name} holds nothing that can be spoken; give phone labels, or words");
        }
        let sound_ticks = sound.as_ref().map(|frames| frames.len() as i64);
        let ticks = labels.end().max(sound_ticks.unwrap_or(0));
        if ticks > TICKS_MAX {
            bail!(
                "{name} goes on for {} minutes, longer than {}; cut it into parts, or check --label-rate",
                ticks / TICK_RATE / 60,
                wav::SECONDS_MAX / 60
            );
        }
        for warning in check(&labels, sound_ticks) {
            match warning {
                Warning::BeyondSound { .. } => {
                    tracing::warn!("{name}: {warning}; silence is added");
                }
                Warning::ShortOfSound { .. } => {
                    tracing::warn!("{name}: {warning}; the mouth rests there");
                }
                _ => tracing::info!("{name}: {warning}"),
            }
        }
        Ok(Self {
            segments: labels.segments,
            sound: sound.map(Arc::from),
            ticks,
            text: None,
        })
    }
}

/// What the user says of labels that their file does not.
pub fn read_options(
    rate: SampleRate,
    alphabet: Option<Alphabet>,
    tier: Option<&str>,
    dictionary: Option<&Path>,
) -> anyhow::Result<ReadOptions> {
    let mut options = ReadOptions::at(rate);
    options.alphabet = alphabet;
    options.tier = tier.map(str::to_owned);
    options.pronouncer = dictionary::read(dictionary)?;
    Ok(options)
}

/// What `args` say of their labels.
pub fn options(args: &InputArgs) -> anyhow::Result<ReadOptions> {
    read_options(
        SampleRate::new(args.label_rate)?,
        args.alphabet,
        args.label_tier.as_deref(),
        args.dictionary.as_deref(),
    )
}

/// Labels and sound cannot both be read from one pipe.
pub fn one_use(args: &InputArgs) -> Result<(), Usage> {
    let pipes = [&args.labels, &args.audio].map(|p| p.as_deref().and_then(pipe));
    match pipes {
        [Some(labels), Some(sound)] if labels == sound => Err(Usage(
            "--labels and --audio name the same pipe; give one of them a descriptor of its own:              --labels fd:3 3<LABELS"
                .into(),
        )),
        _ => Ok(()),
    }
}

/// What `-` and `fd:3` stand for: standard input, and an open descriptor of this process. None for a file.
pub fn pipe(path: &Path) -> Option<PathBuf> {
    if path == Path::new("-") {
        return Some(PathBuf::from("/dev/stdin"));
    }
    let number = path.to_str()?.strip_prefix("fd:")?;
    let number: u16 = number.parse().ok()?;
    Some(PathBuf::from(format!("/dev/fd/{number}")))
}

/// Opens what [`pipe`] named. A named pipe is opened anew, which would wait for a writer: one that has written all
/// and is gone never comes back, and what it wrote is still there to be read.
pub fn open_pipe(pipe: &Path) -> io::Result<File> {
    let file = File::options()
        .read(true)
        .custom_flags(OFlag::O_NONBLOCK.bits())
        .open(pipe)?;
    // Reading waits as ever.
    fcntl(&file, FcntlArg::F_SETFL(OFlag::empty()))?;
    Ok(file)
}

/// Reads a sound file; `-` and `fd:3` as [`pipe`] has them.
pub fn read_sound(path: &Path) -> Result<wav::Sound, wav::SoundError> {
    let Some(pipe) = pipe(path) else {
        return wav::read(path);
    };
    let name = path.display().to_string();
    match open_pipe(&pipe) {
        Ok(file) => wav::decode(io::BufReader::new(file), &name),
        Err(source) => Err(wav::SoundError::Io { name, source }),
    }
}

/// Reads a label file, `-` for standard input, `fd:3` for an open descriptor.
pub fn read_labels(
    path: &Path,
    from: Option<&str>,
    options: &ReadOptions,
) -> anyhow::Result<Labels> {
    let from = from.filter(|from| *from != AUTO);
    let labels = if path == Path::new("-") {
        mouthpiece_phonemes::read_from("<stdin>", io::stdin().lock(), from, options)
    } else if let Some(pipe) = pipe(path) {
        let name = path.display().to_string();
        let file = open_pipe(&pipe).with_context(|| format!("{name} cannot be read"))?;
        mouthpiece_phonemes::read_from(&name, file, from, options)
    } else {
        mouthpiece_phonemes::read_file(path, from, options)
    };
    Ok(labels?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::Phone;

    fn labels(end: i64) -> Labels {
        let segments = vec![Segment::new(Phone::Aa, 0, end)];
        Labels {
            segments,
            ..Labels::default()
        }
    }

    #[test]
    fn the_longer_of_labels_and_sound_counts() {
        let long = Utterance::new("x", labels(100), Some(vec![0.0; 900])).unwrap();
        assert_eq!(long.ticks, 900);
        let long = Utterance::new("x", labels(1000), Some(vec![0.0; 900])).unwrap();
        assert_eq!(long.ticks, 1000);
        assert_eq!(Utterance::new("x", labels(1000), None).unwrap().ticks, 1000);
    }

    #[test]
    fn what_cannot_be_spoken_is_refused_by_name() {
        let error = Utterance::new("w.WRD", Labels::default(), None).unwrap_err();
        assert!(error.to_string().contains("w.WRD"));
        assert!(Utterance::new("x", labels(TICKS_MAX + 1), None).is_err());
    }

    #[test]
    fn the_demo_can_be_read() {
        let demo = Utterance::demo().unwrap();
        assert!(demo.sound.is_some());
        assert!((TICK_RATE..20 * TICK_RATE).contains(&demo.ticks));
    }
}
