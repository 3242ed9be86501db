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
    #[error("{name} is longer than {} minutes; cut it into parts", SECONDS_MAX / 60)]
    TooLong { name: String },
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
pub fn decode(mut input: impl Read, name: &str) -> Result<Sound, SoundError> {
    let own = || name.to_string();
    let broken = |why: String| SoundError::Broken { name: own(), why };
    let io = |source| SoundError::Io {
        name: own(),
        source,
    };

    let mut magic = [0; 4];
    let taken = fill(&mut input, &mut magic).map_err(io)?;
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
        return Err(broken(format!(
            "its {} channels are absurd",
            header.channels
        )));
    }

    if header.shortened {
        let unpacked = shorten::unpack(&mut input, header.channels).map_err(broken)?;
        return gather(&header, &mut &unpacked[..], name);
    }
    gather(&header, &mut input, name)
}

/// Brings the sound that is in `input` to 48 kHz.
fn gather(header: &Header, input: &mut impl Read, name: &str) -> Result<Sound, SoundError> {
    let own = || name.to_string();
    let broken = |why: String| SoundError::Broken { name: own(), why };
    let io = |source| SoundError::Io {
        name: own(),
        source,
    };
    let frame_bytes = header.coding.width() * usize::from(header.channels);
    let mut block = vec![0; (BLOCK_BYTES / frame_bytes).max(1) * frame_bytes];
    let mut mono = Vec::new();
    let mut resampler = Resampler::new(header.rate).map_err(|e| broken(e.to_string()))?;
    let mut left = header.data_bytes.unwrap_or(u64::MAX);
    while left > 0 {
        let want = usize::try_from(left).map_or(block.len(), |left| left.min(block.len()));
        let got = fill(input, &mut block[..want]).map_err(io)?;
        left -= got as u64;
        mono.clear();
        header
            .coding
            .mix(&block[..got], usize::from(header.channels), &mut mono);
        resampler.push(&mono).map_err(|e| broken(e.to_string()))?;
        if resampler.len() > SECONDS_MAX * 48_000 {
            return Err(SoundError::TooLong { name: own() });
        }
        if got < want {
            break;
        }
    }
    // 0x7FFF0000 and above is what programs write that do not know the length.
    if left > 0 && header.data_bytes.is_some_and(|bytes| bytes < 0x7FFF_0000) {
        tracing::warn!("{name} is cut short: its header promises {left} bytes more");
    }
    let mut frames = resampler.finish().map_err(|e| broken(e.to_string()))?;
    if frames.is_empty() {
        return Err(SoundError::Empty { name: own() });
    }
    // The filter may overshoot.
    frames.iter_mut().for_each(|x| *x = x.clamp(-1.0, 1.0));
    Ok(Sound { frames })
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
