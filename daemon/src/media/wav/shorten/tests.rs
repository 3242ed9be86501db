//! A packer of our own makes what the unpacker reads; ffmpeg, where it is installed, judges both.

use proptest::prelude::*;

use super::*;

/// Bits being written.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    used: u32,
}

impl Writer {
    fn bit(&mut self, bit: u32) {
        if self.used.is_multiple_of(8) {
            self.bytes.push(0);
        }
        *self.bytes.last_mut().unwrap() |= (bit as u8) << (7 - self.used % 8);
        self.used += 1;
    }

    fn rice(&mut self, width: u32, value: u32) {
        for _ in 0..value >> width {
            self.bit(0);
        }
        self.bit(1);
        for k in (0..width).rev() {
            self.bit(value >> k & 1);
        }
    }

    fn signed(&mut self, width: u32, value: i32) {
        let folded = if value < 0 {
            (!value as u32) << 1 | 1
        } else {
            (value as u32) << 1
        };
        self.rice(width + 1, folded);
    }

    fn number(&mut self, value: u32) {
        let width = 32 - value.leading_zeros();
        self.rice(2, width);
        self.rice(width, value);
    }
}

const BLOCK: usize = 16;
const WEIGHTS: [i32; 2] = [50, -20];

/// Packs samples of channels in turn, each block by another command than the last.
pub fn pack(samples: &[i16], channels: usize) -> Vec<u8> {
    let mut w = Writer::default();
    for value in [5, channels as u32, BLOCK as u32, 2, 4, 0] {
        w.number(value);
    }
    let mut state: Vec<Channel> = (0..channels).map(|_| Channel::new(3, 4)).collect();
    let frames: Vec<&[i16]> = samples.chunks(channels).collect();
    for (turn, block) in frames.chunks(BLOCK).enumerate() {
        if block.len() < BLOCK {
            w.rice(2, 5);
            w.number(block.len() as u32);
        }
        for (c, channel) in state.iter_mut().enumerate() {
            let values: Vec<i32> = block.iter().map(|f| i32::from(f[c])).collect();
            let offset = channel.offset(2, 0);
            let command = match (turn + c) % 5 {
                4 => 7,
                other => other as u32,
            };
            if values.iter().all(|&x| x == 0) {
                w.rice(2, 8);
                channel.samples.extend(&values);
            } else {
                // A short residue's code is wasteful here, but any width will do.
                w.rice(2, command);
                w.rice(3, 9);
                if command == 7 {
                    w.rice(2, 2);
                    WEIGHTS.iter().for_each(|&weight| w.signed(5, weight));
                }
                for &x in &values {
                    let [a, b, d] = last(&channel.samples);
                    let expected = match command {
                        0 => offset,
                        1 => a,
                        2 => 2 * a - b,
                        3 => 3 * (a - b) + d,
                        _ => {
                            let sum = WEIGHTS[0] * (a - offset) + WEIGHTS[1] * (b - offset);
                            ((sum + 32) >> 5) + offset
                        }
                    };
                    w.signed(9, x - expected);
                    channel.samples.push(x);
                }
            }
            channel.roll(2, 0);
        }
    }
    w.rice(2, 4);
    let mut out = b"ajkg\x02".to_vec();
    out.extend(w.bytes);
    out
}

fn bytes(samples: &[i16]) -> Vec<u8> {
    samples.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// A tone with noise and a silence, in `channels` that differ.
fn tone(frames: usize, channels: usize) -> Vec<i16> {
    let mut noise = 1_u32;
    let value = |k: usize| {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let (frame, c) = (k / channels, k % channels);
        let phase = frame as f64 * (0.05 + 0.01 * c as f64);
        let x = 9000.0 * phase.sin() + 700.0 + f64::from(noise >> 24);
        if (96..160).contains(&frame) {
            0
        } else {
            x as i16
        }
    };
    (0..frames * channels).map(value).collect()
}

#[test]
fn what_is_packed_comes_out_again() {
    for channels in [1, 2, 3] {
        let samples = tone(1003, channels);
        let packed = pack(&samples, channels);
        let out = unpack(&mut &packed[..], channels as u16).unwrap();
        assert_eq!(out, bytes(&samples));
        // Cut anywhere, it is refused.
        assert!(unpack(&mut &packed[..packed.len() / 2], channels as u16).is_err());
    }
}

/// A bit of silence must not become all of the memory.
#[test]
fn a_flood_of_silence_is_refused() {
    let mut w = Writer::default();
    for value in [5, 1, BLOCK_MAX, 0, 0, 0] {
        w.number(value);
    }
    for _ in 0..BYTES_MAX / 100_000 {
        w.rice(2, 8);
    }
    let packed = [b"ajkg\x02", &w.bytes[..]].concat();
    let error = unpack(&mut &packed[..], 1).unwrap_err();
    assert!(error.contains("hour"), "{error}");
}

/// Our packer and unpacker could be wrong in the same way; ffmpeg's decoder is another's.
#[test]
fn ffmpeg_unpacks_the_same() {
    let samples = tone(1000, 1);
    let mut file =
        b"NIST_1A\n   1024\nsample_rate -i 16000\nchannel_count -i 1\nsample_count -i 1000\n\
          sample_n_bytes -i 2\nsample_byte_format -s2 01\nsample_sig_bits -i 16\n\
          sample_coding -s26 pcm,embedded-shorten-v2.00\nend_head\n"
            .to_vec();
    file.resize(1024, b' ');
    file.extend(pack(&samples, 1));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("packed.sph");
    std::fs::write(&path, &file).unwrap();
    let run = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-f", "nistsphere", "-i"])
        .arg(&path)
        .args(["-f", "s16le", "-"])
        .output();
    let Ok(run) = run else {
        return eprintln!("skipped: ffmpeg is not installed");
    };
    let complaint = String::from_utf8_lossy(&run.stderr);
    assert_eq!(run.stdout, bytes(&samples), "{complaint}");
}

proptest! {
    #[test]
    fn any_sound_survives(samples in prop::collection::vec(any::<i16>(), 2..200), channels in 1usize..4) {
        let whole = samples.len() / channels * channels;
        let packed = pack(&samples[..whole], channels);
        prop_assert_eq!(unpack(&mut &packed[..], channels as u16).unwrap(), bytes(&samples[..whole]));
    }

    #[test]
    fn no_bytes_make_it_panic(
        noise in prop::collection::vec(any::<u8>(), 0..400),
        version in 0u8..5,
        at in 0usize..400,
        byte in any::<u8>(),
    ) {
        let _ = unpack(&mut &[b"ajkg", &[version][..], &noise].concat()[..], 1);
        // A sound one byte of which is broken.
        let mut packed = pack(&tone(200, 1), 1);
        let at = 5 + at % (packed.len() - 5);
        packed[at] = byte;
        let _ = unpack(&mut &packed[..], 1);
    }
}
