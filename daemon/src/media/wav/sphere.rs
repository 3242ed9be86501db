//! The header of a NIST SPHERE file: what the TIMIT corpus itself calls `.WAV`.
//!
//! A text header of `key -type value` lines in a block whose size is on its second line. Read are
//! samples of 16 bits in either order of bytes, mu-law and A-law, and 16 bits packed by `shorten`,
//! which is what TIMIT and its relatives hold. Not the rare `wavpack` and `shortpack`.

use std::io::Read;

use super::{Coding, Header};

/// Headers are 1024 bytes in every corpus known; more than this is no header.
const HEADER_BYTES_MAX: usize = 64 * 1024;

/// Reads up to the first byte of sound; `NIST` is already taken from `input`.
pub fn header(input: &mut impl Read) -> Result<Header, String> {
    let cut = |_| String::from("it ends within its header");
    let mut intro = [0; 12]; // "_1A\n   1024\n" after NIST
    input.read_exact(&mut intro).map_err(cut)?;
    let size: usize = std::str::from_utf8(&intro[4..])
        .ok()
        .and_then(|text| text.trim().parse().ok())
        .filter(|size| (16..=HEADER_BYTES_MAX).contains(size))
        .ok_or("its SPHERE header has no size")?;
    let mut text = vec![0; size - 16];
    input.read_exact(&mut text).map_err(cut)?;
    let text = String::from_utf8_lossy(&text);
    let value = |key: &str| {
        text.lines().find_map(|line| {
            let mut words = line.split_whitespace();
            (words.next() == Some(key)).then(|| words.nth(1)).flatten()
        })
    };
    let number = |key: &str| value(key).and_then(|v| v.parse::<u64>().ok());
    let rate = number("sample_rate")
        .and_then(|rate| u32::try_from(rate).ok())
        .ok_or("its SPHERE header has no sample_rate")?;
    let channels = u16::try_from(number("channel_count").unwrap_or(1))
        .ok()
        .filter(|&n| n > 0)
        .ok_or("its channel_count is absurd")?;
    let coding = match (
        value("sample_coding").unwrap_or("pcm"),
        value("sample_byte_format"),
    ) {
        ("pcm", Some("10")) => Coding::S16Be,
        ("pcm", Some("01") | None) => Coding::S16,
        ("ulaw" | "mu-law", _) => Coding::MuLaw,
        ("alaw", _) => Coding::ALaw,
        (packed, _) if packed.starts_with("pcm,embedded-shorten-") => Coding::S16,
        (other, _) => return Err(format!("its sound is coded as `{other}`")),
    };
    if number("sample_n_bytes").is_some_and(|n| n != coding.width() as u64) {
        return Err(format!(
            "its samples are not of {} bits",
            8 * coding.width()
        ));
    }
    let shortened = value("sample_coding").is_some_and(|c| c.contains("shorten"));
    let data_bytes = number("sample_count")
        .and_then(|n| n.checked_mul(coding.width() as u64 * u64::from(channels)));
    Ok(Header {
        rate,
        channels,
        coding,
        data_bytes,
        shortened,
    })
}
