//! One line of TIMIT labels, `start end phone`, as it comes when a label file is piped in as it is.

use mouthpiece_phonemes::{Phone, SampleRate, Segment, UnknownCode};

/// The segment that a line says, or what is wrong with it.
pub(crate) fn segment(line: &str) -> Result<Segment, String> {
    let mut fields = line.split_ascii_whitespace();
    let (Some(start), Some(end), Some(code), None) =
        (fields.next(), fields.next(), fields.next(), fields.next())
    else {
        return Err("a line is a JSON object or a TIMIT label, `start end phone`".to_owned());
    };
    let code = code.to_ascii_lowercase();
    let phone = Phone::from_code(&code).ok_or_else(|| UnknownCode(clip(&code)).to_string())?;
    Ok(Segment::new(phone, ticks(start)?, ticks(end)?))
}

fn ticks(field: &str) -> Result<i64, String> {
    field
        .parse::<i64>()
        .ok()
        .and_then(|sample| SampleRate::TIMIT.ticks(sample))
        .ok_or_else(|| format!("`{}` is no sample number at 16 kHz", clip(field)))
}

/// Text of a client's as far as an answer repeats it: short, and without control characters.
pub(crate) fn clip(text: &str) -> String {
    clip_to(text, 40)
}

/// The same for up to `chars_max` characters.
pub(crate) fn clip_to(text: &str, chars_max: usize) -> String {
    let mut clipped: String = text
        .chars()
        .take(chars_max)
        .map(|c| if c.is_control() { '?' } else { c })
        .collect();
    if text.chars().nth(chars_max).is_some() {
        clipped.push('…');
    }
    clipped
}
