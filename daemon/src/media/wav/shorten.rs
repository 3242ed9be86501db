//! Tony Robinson's lossless `shorten` (1994), versions 1 to 3, as NIST packed SPHERE files with it.
//!
//! A bit stream of blocks: each channel in turn predicts its samples from those before (by
//! differences of order 0 to 3, or by weights that are sent along) and Rice-codes what is left. Our
//! own decoder, because the tools that read it are rare and corpora in it are not. Gives samples of
//! 16 bits, little-endian, channels in turn. Follows the report (Cambridge, CUED/F-INFENG/TR.156)
//! and was checked against ffmpeg's decoder (see the tests).

use std::io::Read;

/// Most that is unpacked: over an hour of two channels at 16 kHz. A few bits can stand for a block of
/// silence, so a small file can be a large sound.
const BYTES_MAX: usize = 256 << 20;
/// Values in a block; what the program itself takes as most.
const BLOCK_MAX: u32 = 65_535;
/// Most weights of a prediction.
const WEIGHTS_MAX: u32 = 1024;
/// Most blocks whose mean is kept.
const MEANS_MAX: u32 = 32_768;
/// Bits of a Rice code's quotient; more is no code but a broken file.
const QUOTIENT_MAX: u32 = 1 << 20;
/// Samples that differences of third order look back on.
const LOOK_BACK: usize = 3;
/// Fraction bits of weights.
const WEIGHT_BITS: u32 = 5;

/// Kinds of samples: 16 bits in either order of bytes, which no longer matters here.
const S16_BIG: u32 = 3;
const S16_LITTLE: u32 = 5;

/// Why it cannot be unpacked: words that follow "…cannot be read as WAV: ".
type Fault = String;

/// Unpacks all of `input`.
pub fn unpack(input: &mut impl Read, channels: u16) -> Result<Vec<u8>, Fault> {
    let mut magic = [0; 5];
    input.read_exact(&mut magic).map_err(|_| cut())?;
    let version = magic[4];
    if magic[..4] != *b"ajkg" || !(1..=3).contains(&version) {
        return Err("its sound is not of a shorten known here".into());
    }
    let mut bits = Bits::new(input);
    let kind = bits.number()?;
    if kind != S16_BIG && kind != S16_LITTLE {
        return Err(format!(
            "its shortened samples are not of 16 bits (kind {kind})"
        ));
    }
    let count = bits.number()?;
    if count != u32::from(channels) {
        return Err(format!(
            "its header says {channels} channels and its sound {count}"
        ));
    }
    let block = within(bits.number()?, 1..=BLOCK_MAX, "blocks")?;
    let weights = within(bits.number()?, 0..=WEIGHTS_MAX, "weights")?;
    let means = within(bits.number()?, 0..=MEANS_MAX, "means")?;
    for _ in 0..within(bits.number()?, 0..=u32::from(u16::MAX), "skipped bytes")? {
        bits.rice(8)?;
    }
    let back = LOOK_BACK.max(weights as usize);
    let mut unpacker = Unpacker {
        version,
        block: block as usize,
        weights_max: weights,
        shift: 0,
        channels: (0..channels)
            .map(|_| Channel::new(back, means as usize))
            .collect(),
        out: Vec::new(),
    };
    unpacker.run(&mut bits)?;
    Ok(unpacker.out)
}

fn within(value: u32, range: std::ops::RangeInclusive<u32>, what: &str) -> Result<u32, Fault> {
    let ok = range.contains(&value);
    ok.then_some(value)
        .ok_or_else(|| format!("its shortened sound has {value} {what}"))
}

fn cut() -> Fault {
    "its shortened sound is cut off".into()
}

struct Unpacker {
    version: u8,
    block: usize,
    weights_max: u32,
    /// Low bits that all samples lack.
    shift: u32,
    channels: Vec<Channel>,
    out: Vec<u8>,
}

/// One channel's past.
struct Channel {
    /// The samples before the block, then the block's own.
    samples: Vec<i32>,
    back: usize,
    /// Means of the last blocks, oldest first.
    means: Vec<i32>,
}

impl Channel {
    fn new(back: usize, means: usize) -> Self {
        Self {
            samples: vec![0; back],
            back,
            means: vec![0; means],
        }
    }

    /// What the block before it lets expect.
    fn offset(&self, version: u8, shift: u32) -> i32 {
        let count = i64::try_from(self.means.len()).unwrap_or(0);
        if count == 0 {
            return 0;
        }
        let half = if version < 2 { 0 } else { count / 2 };
        let mean = (half + self.means.iter().map(|&m| i64::from(m)).sum::<i64>()) / count;
        let mean = if version < 2 { mean } else { mean >> shift };
        i32::try_from(mean).unwrap_or(0)
    }

    /// Remembers the block's mean and keeps what the next one looks back on.
    fn roll(&mut self, version: u8, shift: u32) {
        let block = &self.samples[self.back..];
        let length = i64::try_from(block.len()).unwrap_or(1).max(1);
        let half = if version < 2 { 0 } else { length / 2 };
        let mean = (half + block.iter().map(|&x| i64::from(x)).sum::<i64>()) / length;
        let mean = if version < 2 { mean } else { mean << shift };
        if !self.means.is_empty() {
            self.means.rotate_left(1);
            if let Some(last) = self.means.last_mut() {
                *last = mean as i32;
            }
        }
        let gone = self.samples.len() - self.back;
        self.samples.drain(..gone);
    }
}

impl Unpacker {
    /// Block after block, until the stream says that it is over.
    fn run(&mut self, bits: &mut Bits<impl Read>) -> Result<(), Fault> {
        let mut turn = 0;
        // The blocks of one turn through all channels, shifted up.
        let mut ready: Vec<Vec<i16>> = vec![Vec::new(); self.channels.len()];
        loop {
            let command = bits.rice(2)?;
            match command {
                0..=3 | 7 | 8 => {
                    let Some(channel) = self.channels.get_mut(turn) else {
                        return Err("it has no channels".into());
                    };
                    let offset = channel.offset(self.version, self.shift);
                    match command {
                        8 => channel.samples.resize(channel.back + self.block, 0),
                        7 => weighted(
                            channel,
                            bits,
                            self.block,
                            self.weights_max,
                            self.version,
                            offset,
                        )?,
                        order => differences(channel, bits, self.block, order, offset)?,
                    }
                    let shift = self.shift;
                    let block = &channel.samples[channel.back..];
                    ready[turn].clear();
                    ready[turn].extend(
                        block.iter().map(|&x| {
                            x.checked_shl(shift).unwrap_or(0).clamp(-32_768, 32_767) as i16
                        }),
                    );
                    channel.roll(self.version, shift);
                    turn += 1;
                    if turn == self.channels.len() {
                        turn = 0;
                        self.give(&ready)?;
                    }
                }
                4 => return Ok(()),
                5 => {
                    let most = u32::try_from(self.block).unwrap_or(BLOCK_MAX);
                    self.block = within(bits.number()?, 1..=most, "values a block")? as usize;
                }
                6 => self.shift = within(bits.rice(2)?, 0..=31, "bits of shift")?,
                9 => {
                    for _ in 0..within(bits.rice(5)?, 0..=256, "bytes word for word")? {
                        bits.rice(8)?;
                    }
                }
                _ => return Err(format!("its shortened sound has a command {command}")),
            }
        }
    }

    fn give(&mut self, ready: &[Vec<i16>]) -> Result<(), Fault> {
        if self.out.len() > BYTES_MAX {
            return Err("its shortened sound is longer than an hour; cut it into parts".into());
        }
        for k in 0..self.block {
            for channel in ready {
                let sample = channel.get(k).copied().unwrap_or(0);
                self.out.extend(sample.to_le_bytes());
            }
        }
        Ok(())
    }
}

/// A block as differences from what its neighbours let expect.
fn differences(
    channel: &mut Channel,
    bits: &mut Bits<impl Read>,
    block: usize,
    order: u32,
    offset: i32,
) -> Result<(), Fault> {
    let width = bits.rice(3)?;
    for _ in 0..block {
        let left = bits.signed(width)?;
        let [a, b, c] = last(&channel.samples);
        let expected = match order {
            0 => offset,
            1 => a,
            2 => a.wrapping_mul(2).wrapping_sub(b),
            _ => a.wrapping_sub(b).wrapping_mul(3).wrapping_add(c),
        };
        channel.samples.push(left.wrapping_add(expected));
    }
    Ok(())
}

/// The last three samples, latest first.
fn last(samples: &[i32]) -> [i32; LOOK_BACK] {
    let at = |k: usize| {
        samples
            .len()
            .checked_sub(k)
            .and_then(|i| samples.get(i))
            .copied()
    };
    [1, 2, 3].map(|k| at(k).unwrap_or(0))
}

/// A block as differences from a weighted sum of the samples before.
fn weighted(
    channel: &mut Channel,
    bits: &mut Bits<impl Read>,
    block: usize,
    most: u32,
    version: u8,
    offset: i32,
) -> Result<(), Fault> {
    let width = bits.rice(3)?;
    let order = within(bits.rice(2)?, 0..=most, "weights a block")?;
    let weights = (0..order)
        .map(|_| bits.signed(5).map(i64::from))
        .collect::<Result<Vec<_>, _>>()?;
    let rounding = if version < 2 { 0 } else { 1_i64 << WEIGHT_BITS };
    for sample in &mut channel.samples {
        *sample = sample.wrapping_sub(offset);
    }
    for _ in 0..block {
        let left = bits.signed(width)?;
        let before = channel.samples.iter().rev();
        let sum: i64 = before.zip(&weights).map(|(&x, w)| i64::from(x) * w).sum();
        let expected = (sum + rounding) >> WEIGHT_BITS;
        channel.samples.push(left.wrapping_add(expected as i32));
    }
    for sample in &mut channel.samples {
        *sample = sample.wrapping_add(offset);
    }
    Ok(())
}

/// Bits, most significant first.
struct Bits<'a, R> {
    input: &'a mut R,
    byte: u8,
    left: u32,
}

impl<'a, R: Read> Bits<'a, R> {
    fn new(input: &'a mut R) -> Self {
        Self {
            input,
            byte: 0,
            left: 0,
        }
    }

    fn bit(&mut self) -> Result<u32, Fault> {
        if self.left == 0 {
            let mut byte = [0];
            self.input.read_exact(&mut byte).map_err(|_| cut())?;
            (self.byte, self.left) = (byte[0], 8);
        }
        self.left -= 1;
        Ok(u32::from(self.byte >> self.left) & 1)
    }

    /// A Rice code: zeros that count, a one, and `width` bits below.
    fn rice(&mut self, width: u32) -> Result<u32, Fault> {
        let mut high = 0;
        while self.bit()? == 0 {
            high += 1;
            if high > QUOTIENT_MAX {
                return Err("its shortened sound makes no sense".into());
            }
        }
        let mut value: u32 = high;
        for _ in 0..width.min(32) {
            value = value.wrapping_shl(1) | self.bit()?;
        }
        Ok(value)
    }

    /// The same with the sign in the lowest bit.
    fn signed(&mut self, width: u32) -> Result<i32, Fault> {
        let value = self.rice(width + 1)?;
        let magnitude = (value >> 1) as i32;
        Ok(if value & 1 == 1 {
            !magnitude
        } else {
            magnitude
        })
    }

    /// A number of any size: its own width comes before it.
    fn number(&mut self) -> Result<u32, Fault> {
        let width = self.rice(2)?;
        self.rice(width)
    }
}

#[cfg(test)]
pub mod tests;
