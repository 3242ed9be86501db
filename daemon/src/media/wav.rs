//! Reads a user's sound file, whatever it is, into mono at 48 kHz in step with its labels.
//!
//! WAV with 8 to 32-bit integers, 32 and 64-bit floats, A-law and mu-law, any number of channels
//! (averaged), any rate; RF64; and NIST SPHERE, which is what the TIMIT corpus calls `.WAV`, packed
//! by shorten or not. Read front to back without seeking, so pipes work. Not for other compressed
//! sound: the error says how to convert it. Our own small reader rather than a library, because
//! lengths of 0 or 0xFFFFFFFF from programs that write into pipes, and a cut end, are everyday input
//! here.

mod riff;
mod samples;
mod shorten;
mod sphere;

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::resample::Resampler;
use samples::Coding;

/// Longest sound read: an hour is 690 MB in memory; a day by mistake must not take the machine down.
pub const SECONDS_MAX: usize = 3600;

/// Rates that make sense of speech; beyond them the header is broken.
const RATES: std::ops::RangeInclusive<u32> = 1_000..=768_000;

/// Most channels taken; more is a broken header.
const CHANNELS_MAX: u16 = 64;

/// Bytes read at once.
const BLOCK_BYTES: usize = 64 * 1024;

/// Mono sound at 48 kHz, -1..1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sound {
    /// One value per tick.
    pub frames: Vec<f32>,
}

/// Why a sound file was not read.
#[derive(Debug, thiserror::Error)]
pub enum SoundError {
    #[error("{name} cannot be read: {source}")]
    Io { name: String, source: io::Error },
    #[error(
        "{name} is not a WAV file but {what}; convert it first: ffmpeg -i {name} -c:a pcm_s16le OUT.wav"
    )]
    NotWav { name: String, what: &'static str },
    #[error(
        "{name} cannot be read as WAV: {why}; write it again: ffmpeg -i {name} -c:a pcm_s16le OUT.wav"
    )]
    Broken { name: String, why: String },
    #[error("{name} holds no sound (0 samples); leave the sound out to speak in silence")]
    Empty { name: String },
    #[error("{name} is longer than {seconds_max} seconds; cut it into parts")]
    TooLong { name: String, seconds_max: usize },
}

/// What stands before the sound.
#[derive(Clone, Copy, Debug)]
struct Header {
    rate: u32,
    channels: u16,
    coding: Coding,
    /// What the header says, none where it does not know.
    data_bytes: Option<u64>,
    /// Whether what follows is packed by `shorten`; the rest tells what it is then.
    shortened: bool,
}

/// Reads the file at `path`.
pub fn read(path: &Path) -> Result<Sound, SoundError> {
    let name = path.display().to_string();
    let file = File::open(path).map_err(|source| SoundError::Io {
        name: name.clone(),
        source,
    })?;
    decode(io::BufReader::with_capacity(BLOCK_BYTES, file), &name)
}

/// Reads sound from `input`, which errors call `name`.
pub fn decode(input: impl Read + Send, name: &str) -> Result<Sound, SoundError> {
    decode_at_most(input, name, SECONDS_MAX)
}

/// The same of at most `seconds_max`.
pub fn decode_at_most(
    input: impl Read + Send,
    name: &str,
    seconds_max: usize,
) -> Result<Sound, SoundError> {
    let own = || name.to_string();
    let broken = |why: String| SoundError::Broken { name: own(), why };
    let mut stream = Stream::open(input, name, BLOCK_BYTES)?;
    let mut resampler = Resampler::new(stream.rate()).map_err(|e| broken(e.to_string()))?;
    let mut mono = Vec::new();
    while stream.read(&mut mono)? {
        resampler.push(&mono).map_err(|e| broken(e.to_string()))?;
        if resampler.len() > seconds_max * 48_000 {
            return Err(SoundError::TooLong {
                name: own(),
                seconds_max,
            });
        }
    }
    let mut frames = resampler.finish().map_err(|e| broken(e.to_string()))?;
    if frames.is_empty() {
        return Err(SoundError::Empty { name: own() });
    }
    // The filter may overshoot.
    frames.iter_mut().for_each(|x| *x = x.clamp(-1.0, 1.0));
    Ok(Sound { frames })
}

/// Sound that is taken as it comes: mono, at its own rate.
pub struct Stream<'a> {
    name: String,
    input: Box<dyn Read + Send + 'a>,
    header: Header,
    /// Of sound that is still promised, bytes.
    left: u64,
    block: Vec<u8>,
}

impl<'a> Stream<'a> {
    /// Reads what stands before the sound. Of the sound as much is taken at once as fits into `block_bytes`.
    pub fn open(
        mut input: impl Read + Send + 'a,
        name: &str,
        block_bytes: usize,
    ) -> Result<Self, SoundError> {
        let own = || name.to_string();
        let broken = |why: String| SoundError::Broken { name: own(), why };
        let mut magic = [0; 4];
        let taken = fill(&mut input, &mut magic).map_err(|source| SoundError::Io {
            name: own(),
            source,
        })?;
        let header = match &magic {
            b"RIFF" | b"RF64" | b"BW64" => riff::header(magic, &mut input).map_err(broken)?,
            b"NIST" => sphere::header(&mut input).map_err(broken)?,
            _ => {
                let what = kind(&magic[..taken]);
                return Err(SoundError::NotWav { name: own(), what });
            }
        };
        if !RATES.contains(&header.rate) {
            return Err(broken(format!("its rate of {} Hz is absurd", header.rate)));
        }
        if header.channels > CHANNELS_MAX {
            let why = format!("its {} channels are absurd", header.channels);
            return Err(broken(why));
        }
        let frame_bytes = header.coding.width() * usize::from(header.channels);
        let input: Box<dyn Read + Send + 'a> = if header.shortened {
            let unpacked = shorten::unpack(&mut input, header.channels).map_err(broken)?;
            Box::new(io::Cursor::new(unpacked))
        } else {
            Box::new(input)
        };
        Ok(Self {
            name: own(),
            input,
            left: header.data_bytes.unwrap_or(u64::MAX),
            header,
            block: vec![0; (block_bytes / frame_bytes).max(1) * frame_bytes],
        })
    }

    /// Samples a second.
    pub fn rate(&self) -> u32 {
        self.header.rate
    }

    /// Puts the next samples into `mono`, in place of what is there; false when there are no more.
    pub fn read(&mut self, mono: &mut Vec<f32>) -> Result<bool, SoundError> {
        mono.clear();
        if self.left == 0 {
            return Ok(false);
        }
        let whole = self.block.len();
        let want = usize::try_from(self.left).map_or(whole, |left| left.min(whole));
        let block = &mut self.block[..want];
        let got = fill(&mut self.input, block).map_err(|source| SoundError::Io {
            name: self.name.clone(),
            source,
        })?;
        self.left -= got as u64;
        let Header {
            coding, channels, ..
        } = self.header;
        coding.mix(&block[..got], usize::from(channels), mono);
        if got < want {
            let (name, left) = (&self.name, self.left);
            // 0x7FFF0000 and above is what programs write that do not know the length.
            if self.header.data_bytes.is_some_and(|b| b < 0x7FFF_0000) {
                tracing::warn!("{name} is cut short: its header promises {left} bytes more");
            }
            self.left = 0;
        }
        Ok(true)
    }
}

/// What a file is that is not WAV, by its first bytes.
fn kind(magic: &[u8]) -> &'static str {
    match magic {
        b"" => "empty",
        b"OggS" => "Ogg",
        b"fLaC" => "FLAC",
        b"RIFX" => "big-endian RIFX",
        b"FORM" => "AIFF",
        [b'I', b'D', b'3', _] | [0xFF, 0xE0..=0xFF, ..] => "MP3",
        _ if magic
            .iter()
            .all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace()) =>
        {
            "text"
        }
        _ => "something else",
    }
}

/// Reads until `buffer` is full or the input ends; says how much there was.
fn fill(input: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut got = 0;
    while got < buffer.len() {
        match input.read(&mut buffer[got..]) {
            Ok(0) => break,
            Ok(n) => got += n,
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
    Ok(got)
}

#[cfg(test)]
mod tests;
