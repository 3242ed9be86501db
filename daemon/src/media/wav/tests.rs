//! Every kind of WAV that people have, made here byte by byte or by hound; and everything that is none.

use proptest::prelude::*;

use super::*;

/// A tone with a click at 0.1 s, in `channels` copies.
fn signal(rate: u32) -> Vec<f32> {
    let n = rate as usize / 4;
    let mut out: Vec<f32> = (0..n)
        .map(|i| (i as f32 * 300.0 / rate as f32 * std::f32::consts::TAU).sin() * 0.1)
        .collect();
    out[rate as usize / 10] = 0.9;
    out
}

fn wav(rate: u32, channels: u16, bits: u16, float: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let spec = hound::WavSpec {
        channels,
        sample_rate: rate,
        bits_per_sample: bits,
        sample_format: if float {
            hound::SampleFormat::Float
        } else {
            hound::SampleFormat::Int
        },
    };
    let mut writer = hound::WavWriter::new(io::Cursor::new(&mut bytes), spec).unwrap();
    for x in signal(rate) {
        for _ in 0..channels {
            if float {
                writer.write_sample(x).unwrap();
            } else {
                let full = f64::from(1_u32 << (bits - 1)) - 1.0;
                writer.write_sample((f64::from(x) * full) as i32).unwrap();
            }
        }
    }
    writer.finalize().unwrap();
    bytes
}

/// A header of our own for what hound does not write.
fn raw(tag: u16, channels: u16, rate: u32, bits: u16, data_len: u32, data: &[u8]) -> Vec<u8> {
    let block = channels * (bits / 8);
    let mut b = b"RIFF\xFF\xFF\xFF\xFFWAVEfmt \x10\0\0\0".to_vec();
    b.extend(tag.to_le_bytes());
    b.extend(channels.to_le_bytes());
    b.extend(rate.to_le_bytes());
    b.extend((rate * u32::from(block)).to_le_bytes());
    b.extend(block.to_le_bytes());
    b.extend(bits.to_le_bytes());
    b.extend(b"data");
    b.extend(data_len.to_le_bytes());
    b.extend(data);
    b
}

fn peak(sound: &Sound) -> usize {
    (0..sound.frames.len())
        .max_by(|&a, &b| sound.frames[a].total_cmp(&sound.frames[b]))
        .unwrap()
}

#[test]
fn every_width_rate_and_channel_count_keeps_its_time() {
    for rate in [
        8_000, 11_025, 16_000, 22_050, 44_100, 48_000, 96_000, 192_000,
    ] {
        for (bits, float) in [
            (8, false),
            (16, false),
            (24, false),
            (32, false),
            (32, true),
        ] {
            for channels in [1, 2, 6] {
                let sound = decode(&wav(rate, channels, bits, float)[..], "t.wav").unwrap();
                let what = format!("{rate} Hz, {bits} bits, {channels} channels");
                let expected = f64::from(rate / 10) * 48_000.0 / f64::from(rate);
                let at = peak(&sound);
                assert!(
                    (at as f64 - expected).abs() <= 1.0,
                    "{what}: {at}, not {expected}"
                );
                let length = (rate as usize / 4 * 48_000).div_ceil(rate as usize);
                assert_eq!(sound.frames.len(), length, "{what}");
            }
        }
    }
}

#[test]
fn doubles_mu_law_and_a_law_are_read() {
    let doubles: Vec<u8> = signal(48_000)
        .iter()
        .flat_map(|&x| f64::from(x).to_le_bytes())
        .collect();
    let sound = decode(
        &raw(3, 1, 48_000, 64, doubles.len() as u32, &doubles)[..],
        "t",
    )
    .unwrap();
    assert_eq!(sound.frames, signal(48_000));
    for tag in [6, 7] {
        let sound = decode(&raw(tag, 1, 48_000, 8, 3, &[0x2A, 0xAA, 0xD5])[..], "t").unwrap();
        assert_eq!(sound.frames.len(), 3);
        assert!(sound.frames[0] * sound.frames[1] < 0.0);
    }
}

/// Programs that write into a pipe leave 0 or the largest number where the length belongs.
#[test]
fn a_stream_without_a_length_is_read_to_its_end() {
    for len in [0, u32::MAX, 0x7FFF_FFFF, 0x7FFF_F000, 400] {
        let sound = decode(&raw(1, 1, 48_000, 16, len, &[0, 0x40, 0, 0x20, 9])[..], "t").unwrap();
        assert_eq!(sound.frames, [0.5, 0.25], "{len:#x}");
    }
}

#[test]
fn sound_is_found_behind_other_chunks_and_stops_before_them() {
    let whole = raw(1, 1, 48_000, 16, 2, &[0, 0x40]);
    let mut b = whole[..12].to_vec();
    b.extend(b"LIST\x03\0\0\0abc\0");
    b.extend(&whole[12..]);
    b.extend(b"LIST\x04\0\0\0abcd");
    assert_eq!(decode(&b[..], "t").unwrap().frames, [0.5]);
}

#[test]
fn the_corpus_own_sphere_files_are_read() {
    let mut b = b"NIST_1A\n   1024\nsample_count -i 2\nsample_rate -i 48000\nchannel_count -i 1\n\
                  sample_n_bytes -i 2\nsample_byte_format -s2 01\nend_head\n"
        .to_vec();
    b.resize(1024, b' ');
    b.extend([0, 0x40, 0, 0x20, 1, 1]);
    assert_eq!(decode(&b[..], "SA1.WAV").unwrap().frames, [0.5, 0.25]);
    assert!(decode(&b[..700], "SA1.WAV").is_err());
}

/// A SPHERE header for sound of 48 kHz with the given lines.
fn sphere(lines: &str) -> Vec<u8> {
    let mut b = format!("NIST_1A\n   1024\nsample_rate -i 48000\n{lines}end_head\n").into_bytes();
    b.resize(1024, b' ');
    b
}

#[test]
fn every_coding_of_sphere_is_read() {
    let mut big = sphere("sample_count -i 1\nsample_n_bytes -i 2\nsample_byte_format -s2 10\n");
    big.extend([0x40, 0]);
    assert_eq!(decode(&big[..], "a").unwrap().frames, [0.5]);
    let mut mu = sphere("sample_count -i 2\nsample_n_bytes -i 1\nsample_coding -s4 ulaw\n");
    mu.extend([0xFF, 0x80]);
    let mu = decode(&mu[..], "a").unwrap().frames;
    assert!(mu[0].abs() < 1e-3 && mu[1] > 0.9, "{mu:?}");
    let mut a_law = sphere("sample_count -i 1\nsample_n_bytes -i 1\nsample_coding -s4 alaw\n");
    a_law.push(0xAA);
    assert!(decode(&a_law[..], "a").unwrap().frames[0] > 0.9);
    let packed = "sample_n_bytes -i 2\nsample_byte_format -s2 01\nsample_coding -s26 pcm,embedded-shorten-v2.00\n";
    let mut packed = sphere(&format!("sample_count -i 4\n{packed}"));
    packed.extend(shorten::tests::pack(&[16_384, 0, -16_384, 8192], 1));
    assert_eq!(
        decode(&packed[..], "a").unwrap().frames,
        [0.5, 0.0, -0.5, 0.25]
    );
    let odd =
        sphere("sample_count -i 4\nsample_n_bytes -i 2\nsample_coding -s3 pcm,embedded-wavpack\n");
    let error = decode(&odd[..], "a").unwrap_err();
    assert!(error.to_string().contains("wavpack"), "{error}");
}

proptest! {
    /// Whatever follows the magic word is read or refused.
    #[test]
    fn no_sphere_file_makes_it_panic(
        lines in prop::collection::vec((
            prop::sample::select(vec![
                "sample_rate", "sample_count", "channel_count", "sample_n_bytes",
                "sample_byte_format", "sample_coding", "end_head",
            ]),
            prop_oneof![
                "-?[0-9]{1,20}",
                prop::sample::select(vec![
                    "10", "01", "ulaw", "alaw", "pcm", "16000", "1", "2", "pcm,embedded-shorten-v2.00",
                ]).prop_map(String::from),
                "\\PC{0,8}",
            ],
        ), 0..8),
        size in prop_oneof!["   1024", " +[0-9]{1,6}", "\\PC{7}"],
        rest in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let mut b = format!("NIST_1A\n{size}\n").into_bytes();
        for (key, value) in lines {
            b.extend(format!("{key} -i {value}\n").into_bytes());
        }
        b.resize(b.len().max(1024), b' ');
        b.extend(rest);
        if let Ok(sound) = decode(&b[..], "a") {
            prop_assert!(sound.frames.iter().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn what_is_no_sound_is_said_in_one_sentence_that_names_the_file() {
    let good = wav(16_000, 1, 16, false);
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (vec![], "empty"),
        (b"ID3\x04abc".to_vec(), "MP3"),
        (b"fLaC...".to_vec(), "FLAC"),
        (b"0 100 h#\n".to_vec(), "text"),
        (good[..20].to_vec(), "ends within"),
        (good[..30].to_vec(), "ends within"),
        (good[..36].to_vec(), "`data` chunk is missing"),
        (raw(1, 1, 16_000, 16, 4, &[]), "0 samples"),
        (raw(1, 0, 16_000, 16, 4, &[0; 4]), "no channels"),
        (raw(1, 1, 0, 16, 4, &[0; 4]), "absurd"),
        (raw(1, 900, 16_000, 16, 4, &[0; 4]), "absurd"),
        (raw(0x55, 1, 16_000, 16, 4, &[0; 4]), "compressed"),
        (raw(1, 1, 16_000, 48, 6, &[0; 6]), "48 bits"),
        (raw(1, 1, 16_000, 0, 4, &[0; 4]), "0 bits"),
    ];
    for (bytes, expected) in cases {
        let error = decode(&bytes[..], "voice.wav").unwrap_err().to_string();
        assert!(
            error.contains("voice.wav") && error.contains(expected),
            "{error}"
        );
        assert!(!error.contains('\n'));
    }
    let error = read(Path::new("no/such.wav")).unwrap_err().to_string();
    assert!(error.contains("no/such.wav"));
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = decode(&bytes[..], "x");
    }

    /// A good header with bytes changed reaches far deeper than noise does.
    #[test]
    fn a_damaged_header_never_panics(
        changes in proptest::collection::vec((0_usize..60, any::<u8>()), 1..6),
        cut in 0_usize..400,
    ) {
        let mut bytes = wav(8_000, 2, 24, false);
        bytes.truncate(60 + cut);
        for (at, value) in changes {
            bytes[at] = value;
        }
        if let Ok(sound) = decode(&bytes[..], "x") {
            prop_assert!(sound.frames.iter().all(|x| (-1.0..=1.0).contains(x)));
        }
    }
}
