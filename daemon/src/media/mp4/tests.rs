//! What is in the file, read back box by box and packet by packet.

use std::fs;
use std::sync::Arc;

use super::*;

fn clip(seconds_x10: u64, fps: (u32, u32)) -> Clip {
    let length = seconds_x10 * 4800;
    let sound: Vec<f32> = (0..length)
        .map(|i| {
            // Noise: unlike a tone, it fits itself at one lag only.
            let x = (i as u32 ^ 0x9E37).wrapping_mul(0x85EB_CA6B);
            let x = (x ^ (x >> 13)).wrapping_mul(0xC2B2_AE35);
            (x >> 8) as f32 / 16_777_216.0 * 0.4 - 0.2
        })
        .collect();
    let frames = (u128::from(length) * u128::from(fps.0)).div_ceil(48_000 * u128::from(fps.1));
    Clip {
        width: 64,
        height: 48,
        fps,
        frames: frames as u64,
        sound: Some(Arc::from(sound)),
        bitrate: None,
    }
}

fn write(clip: &Clip, target: &Path) {
    let mut sink = Box::new(Mp4Sink::new(target, clip).unwrap());
    for k in 0..clip.frames {
        let mut rgba = vec![40; (clip.width * clip.height * 4) as usize];
        let x = (k % u64::from(clip.width)) as usize * 4;
        rgba[x..x + 3].copy_from_slice(&[255, 200, 0]);
        sink.frame(&rgba).unwrap();
    }
    sink.finish().unwrap();
}

/// The bodies of the boxes at `path`, like `moov/trak/mdia`.
fn find<'a>(bytes: &'a [u8], path: &str) -> Vec<&'a [u8]> {
    let (kind, rest) = path.split_once('/').unwrap_or((path, ""));
    let mut found = Vec::new();
    let mut at = 0;
    while at + 8 <= bytes.len() {
        let size = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (head, size) = match size {
            1 => (
                16,
                u64::from_be_bytes(bytes[at + 8..at + 16].try_into().unwrap()) as usize,
            ),
            size => (8, size),
        };
        if &bytes[at + 4..at + 8] == kind.as_bytes() {
            let body = &bytes[at + head..at + size];
            if rest.is_empty() {
                found.push(body);
            } else {
                found.extend(find(body, rest));
            }
        }
        at += size;
    }
    assert_eq!(at, bytes.len(), "boxes fill their parent exactly");
    found
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let (a, b) = (dir.path().join("a.mp4"), dir.path().join("b.mp4"));
    write(&clip(12, (30, 1)), &a);
    write(&clip(12, (30, 1)), &b);
    assert!(fs::read(&a).unwrap() == fs::read(&b).unwrap());
}

#[test]
fn picture_and_sound_begin_at_zero_and_end_within_a_frame() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.mp4");
    for fps in [(30, 1), (24_000, 1001), (25, 1), (7, 1)] {
        let clip = clip(13, fps);
        write(&clip, &path);
        let bytes = fs::read(&path).unwrap();
        let media = find(&bytes, "moov/trak/mdia/mdhd");
        let edits = find(&bytes, "moov/trak/edts/elst");
        let frame = 48_000.0 * f64::from(fps.1) / f64::from(fps.0);
        let video = f64::from(u32_at(media[0], 16)) / f64::from(u32_at(media[0], 12)) * 48_000.0;
        let (shown, skip) = (u32_at(edits[1], 8), u32_at(edits[1], 12));
        assert_eq!((u32_at(edits[0], 12), skip), (0, 312));
        assert_eq!(shown, 13 * 4800);
        assert_eq!(u32_at(media[1], 16), shown + skip);
        assert!((video - f64::from(shown)).abs() < frame, "{video} {shown}");
        // The table of contents stands in front, and the picture can be jumped to.
        assert!(
            bytes.windows(4).position(|w| w == b"moov")
                < bytes.windows(4).position(|w| w == b"mdat")
        );
        assert_eq!(
            u32_at(find(&bytes, "moov/trak/mdia/minf/stbl/stss")[0], 8),
            1
        );
    }
}

/// The packets in the file, decoded and cut as the edit list says, are the sound: same length, and
/// nothing fits better than a lag of 0.
#[test]
fn the_sound_in_the_file_is_in_step_to_the_sample() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.mp4");
    let clip = clip(20, (30, 1));
    write(&clip, &path);
    let bytes = fs::read(&path).unwrap();
    let sizes = find(&bytes, "moov/trak/mdia/minf/stbl/stsz")[1];
    let offsets = find(&bytes, "moov/trak/mdia/minf/stbl/stco")[1];
    let mut decoder = ropus::Decoder::new(48_000, ropus::Channels::Mono).unwrap();
    let mut heard = Vec::new();
    for i in 0..u32_at(sizes, 8) as usize {
        let (at, size) = (
            u32_at(offsets, 8 + 4 * i) as usize,
            u32_at(sizes, 12 + 4 * i) as usize,
        );
        let mut block = [0; 960];
        decoder
            .decode(&bytes[at..at + size], &mut block, ropus::DecodeMode::Normal)
            .unwrap();
        heard.extend(block.map(|x| f32::from(x) / 32_768.0));
    }
    let sound = clip.sound.unwrap();
    let heard = &heard[312..];
    assert!(heard.len() >= sound.len());
    let fit = |lag: isize| -> f32 {
        (1000..sound.len() - 1000)
            .map(|i| sound[i] * heard[i.checked_add_signed(lag).unwrap()])
            .sum()
    };
    let best = (-200..=200)
        .max_by(|&a, &b| fit(a).total_cmp(&fit(b)))
        .unwrap();
    assert!(best.abs() <= 1, "lag {best}");
}

#[test]
fn sizes_that_cannot_be_are_refused_with_one_that_can() {
    let dir = tempfile::tempdir().unwrap();
    let mut odd = clip(1, (30, 1));
    odd.width = 65;
    let error = Mp4Sink::new(&dir.path().join("a.mp4"), &odd)
        .err()
        .unwrap()
        .to_string();
    assert!(error.contains("66x48"), "{error}");
    odd.width = 6000;
    assert!(Mp4Sink::new(&dir.path().join("a.mp4"), &odd).is_err());
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn a_named_bitrate_is_kept_and_no_frame_is_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.mp4");
    let sizes = [300_000, 1_200_000].map(|bits| {
        let clip = Clip {
            width: 320,
            height: 240,
            bitrate: Some(bits),
            sound: None,
            ..clip(40, (30, 1))
        };
        let mut sink = Box::new(Mp4Sink::new(&path, &clip).unwrap());
        let mut noise = 1_u32;
        for _ in 0..clip.frames {
            let rgba: Vec<u8> = (0..320 * 240 * 4)
                .map(|_| {
                    noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    128 + (noise >> 28) as u8
                })
                .collect();
            sink.frame(&rgba).unwrap();
        }
        sink.finish().unwrap();
        let bytes = fs::read(&path).unwrap();
        assert_eq!(
            u32_at(find(&bytes, "moov/trak/mdia/minf/stbl/stsz")[0], 8),
            120
        );
        let rate = bytes.len() as f64 * 8.0 / 4.0;
        assert!(
            (0.5..1.6).contains(&(rate / f64::from(bits))),
            "{bits}: {rate}"
        );
        bytes.len()
    });
    assert!(sizes[1] > sizes[0] * 2);
}
