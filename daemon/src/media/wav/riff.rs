//! The header of a WAV file: RIFF, and RF64/BW64 for those beyond 4 GB.
//!
//! Written for files as they are, not as they should be: programs that write into a pipe do not
//! know the length and put 0 or the largest number there, so lengths of the whole are ignored and
//! that of the sound is a bound, not a promise.

use std::io::{self, Read};

use super::{Coding, Header};

/// Reads up to the first byte of sound; `magic` are the four bytes already taken from `input`.
/// Errors are words that follow "…cannot be read as WAV: ".
pub fn header(magic: [u8; 4], input: &mut impl Read) -> Result<Header, String> {
    let cut = |_: io::Error| String::from("it ends within its header");
    let riff_len = u32::from_le_bytes(bytes(input).map_err(cut)?);
    if bytes(input).map_err(cut)? != *b"WAVE" {
        return Err("it is a RIFF file of another kind".into());
    }
    let streamed = magic != *b"RIFF" || riff_len == 0 || riff_len >= 0x7FFF_0000;
    let mut format = None;
    let mut long_data = None;
    loop {
        let id: [u8; 4] = bytes(input).map_err(|_| missing(format.is_some()))?;
        let len = u32::from_le_bytes(bytes(input).map_err(cut)?);
        match &id {
            b"data" => {
                let (rate, channels, coding) = format.ok_or_else(|| missing(false))?;
                let data_bytes = match (len, long_data) {
                    (u32::MAX, Some(len)) => Some(len),
                    (u32::MAX, None) => None,
                    (0, _) if streamed => None,
                    _ => Some(u64::from(len)),
                };
                return Ok(Header {
                    rate,
                    channels,
                    coding,
                    data_bytes,
                    shortened: false,
                });
            }
            b"fmt " => {
                let body = head::<40>(input, len).map_err(cut)?;
                format = Some(parse_format(&body, len)?);
            }
            b"ds64" => {
                let body = head::<16>(input, len).map_err(cut)?;
                long_data = Some(u64::from_le_bytes(std::array::from_fn(|i| body[8 + i])));
            }
            _ => skip(input, u64::from(len) + u64::from(len & 1)).map_err(cut)?,
        }
    }
}

fn missing(format: bool) -> String {
    let chunk = if format { "data" } else { "fmt" };
    format!("its `{chunk}` chunk is missing")
}

/// Rate, channels and coding from a `fmt ` chunk of `len` bytes, of which `b` are the first.
fn parse_format(b: &[u8; 40], len: u32) -> Result<(u32, u16, Coding), String> {
    if len < 16 {
        return Err("its `fmt` chunk is too short".into());
    }
    let u16_at = |i: usize| u16::from_le_bytes([b[i], b[i + 1]]);
    let channels = u16_at(2);
    let rate = u32::from_le_bytes([b[4], b[5], b[6], b[7]]);
    let (block, bits) = (u16_at(12), u16_at(14));
    let mut tag = u16_at(0);
    if tag == 0xFFFE && len >= 40 {
        tag = u16_at(24); // WAVE_FORMAT_EXTENSIBLE keeps the real one in its GUID
    }
    if channels == 0 {
        return Err("it says that it has no channels".into());
    }
    // A sample is left-justified in its container, so the container alone counts.
    let container = match block / channels {
        0 => bits.div_ceil(8),
        width => width,
    };
    if bits == 0 || u32::from(bits) > 8 * u32::from(container) {
        return Err(format!("its samples have {bits} bits in {container} bytes"));
    }
    let coding = match (tag, container) {
        (1 | 0xFFFE, 1) => Coding::U8,
        (1 | 0xFFFE, 2) => Coding::S16,
        (1 | 0xFFFE, 3) => Coding::S24,
        (1 | 0xFFFE, 4) => Coding::S32,
        (3, 4) => Coding::F32,
        (3, 8) => Coding::F64,
        (6, 1) => Coding::ALaw,
        (7, 1) => Coding::MuLaw,
        (1 | 3 | 6 | 7 | 0xFFFE, _) => return Err(format!("its samples have {bits} bits")),
        _ => return Err(format!("its sound is compressed (format {tag})")),
    };
    Ok((rate, channels, coding))
}

fn bytes<const N: usize>(input: &mut impl Read) -> io::Result<[u8; N]> {
    let mut out = [0; N];
    input.read_exact(&mut out)?;
    Ok(out)
}

/// The first `N` bytes of a chunk of `len`, zeros where it is shorter; leaves `input` behind it.
fn head<const N: usize>(input: &mut impl Read, len: u32) -> io::Result<[u8; N]> {
    let mut out = [0; N];
    let here = N.min(len as usize);
    input.read_exact(&mut out[..here])?;
    skip(input, u64::from(len) - here as u64 + u64::from(len & 1))?;
    Ok(out)
}

fn skip(input: &mut impl Read, count: u64) -> io::Result<()> {
    match io::copy(&mut input.take(count), &mut io::sink())? {
        n if n == count => Ok(()),
        _ => Err(io::ErrorKind::UnexpectedEof.into()),
    }
}
