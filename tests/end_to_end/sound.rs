//! Sound files as people have them: any rate, width and number of channels is heard where it was;
//! what is no sound is one sentence that names the file.

use std::fs;
use std::path::Path;

use mouthpiece_tests::wav::{self, Coding};
use mouthpiece_tests::{binary, mp4};

use crate::graphics;

/// Where the tone of the test sound begins and ends, and its pitch.
const ONSET_S: f64 = 0.3;
const END_S: f64 = 0.6;
const TONE_HZ: f64 = 1000.0;

fn export(folder: &Path, wav: &Path, out: &Path) -> binary::Finished {
    let labels = folder.join("l.phn");
    fs::write(&labels, "0 4800 h#\n4800 8000 aa\n8000 9600 h#\n").unwrap();
    let text = |path: &Path| path.to_string_lossy().into_owned();
    binary::run(&[
        "export",
        "--labels",
        &text(&labels),
        "--audio",
        &text(wav),
        "--size",
        "32x32",
        "--fps",
        "10",
        "--tier",
        "low",
        "-o",
        &text(out),
    ])
}

/// Guards resampling and decoding: each kind of file lasts as long as it should, and (where ffmpeg
/// is there to listen) its tone begins within 2 ms of where it was, at its pitch.
#[test]
fn every_kind_of_wav_is_heard_where_it_was() {
    if !graphics::are_there_for("WAV files of every kind") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (wav, out) = (folder.path().join("s.wav"), folder.path().join("o.mp4"));
    for (coding, rate, channels) in [
        (Coding::U8, 8_000, 1),
        (Coding::S16, 22_050, 6),
        (Coding::S16, 44_100, 2),
        (Coding::S24, 48_000, 1),
        (Coding::S32, 96_000, 2),
        (Coding::F32, 192_000, 1),
    ] {
        let kind = format!("{coding:?} {rate} Hz, {channels} channels");
        let tone = wav::tone(rate, TONE_HZ, ONSET_S, END_S);
        fs::write(&wav, wav::file(coding, rate, channels, &tone)).unwrap();
        export(folder.path(), &wav, &out).expect_done();
        let sound = mp4::track_of(&fs::read(&out).unwrap(), "soun");
        assert!((sound.plays_s - END_S).abs() < 0.001, "{kind}: {sound:?}");
        assert_eq!(sound.starts_s, 0.0, "{kind}");
        listen(&out, &kind);
    }
}

fn listen(video: &Path, kind: &str) {
    let path = video.to_string_lossy();
    let args = [
        "-v", "error", "-i", &path, "-vn", "-ac", "1", "-ar", "48000", "-f", "s16le", "-",
    ];
    let Some(bytes) = binary::tool("ffmpeg", &args) else {
        eprintln!("ffmpeg is not installed: {kind} was not listened to");
        return;
    };
    let heard: Vec<f64> = bytes
        .chunks_exact(2)
        .map(|b| f64::from(i16::from_le_bytes([b[0], b[1]])) / 32768.0)
        .collect();
    // The tone's amplitude is 0.5: the onset is where a tenth of it is first passed.
    let onset = heard.iter().position(|x| x.abs() > 0.05).expect(kind);
    let onset_s = onset as f64 / 48_000.0;
    assert!(
        (onset_s - ONSET_S).abs() < 0.002,
        "{kind}: tone at {onset_s} s"
    );
    let middle = &heard[(ONSET_S * 48e3) as usize + 4800..][..4800];
    let rises = middle.windows(2).filter(|w| w[0] < 0.0 && w[1] >= 0.0);
    let hz = rises.count() as f64 * 10.0;
    assert!((hz - TONE_HZ).abs() <= 10.0, "{kind}: {hz} Hz");
    let power = middle.iter().map(|x| x * x).sum::<f64>() / middle.len() as f64;
    let amplitude = (2.0 * power).sqrt();
    assert!((0.4..0.6).contains(&amplitude), "{kind}: {amplitude}");
}

/// Guards the message for what is no sound, and that it leaves nothing behind.
#[test]
fn what_is_no_sound_is_one_sentence_with_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("o.mp4");
    let whole = wav::file(Coding::S16, 16_000, 1, &[0.25; 800]);
    let with = |at: usize, bytes: &[u8]| {
        let mut file = whole.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let files: [(&str, Vec<u8>); 12] = [
        ("empty.wav", Vec::new()),
        ("text.wav", b"this is not sound\n".to_vec()),
        ("mp3.wav", b"ID3\x04\0\0\0\0\0\0".to_vec()),
        ("ogg.wav", b"OggS\0\x02\0\0".to_vec()),
        ("noise.wav", vec![0x9c; 5000]),
        ("riff.wav", b"RIFF".to_vec()),
        ("header.wav", whole[..30].to_vec()),
        ("nosamples.wav", wav::file(Coding::S16, 16_000, 1, &[])),
        ("nochannels.wav", with(22, &[0, 0])),
        ("norate.wav", with(24, &[0; 4])),
        ("nobits.wav", with(34, &[0, 0])),
        ("coded.wav", with(20, &[0x55, 0])),
    ];
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let finished = export(folder.path(), &path, &out);
        assert_ne!(finished.code(), 0, "{name} was taken for sound");
        let sentence = finished.expect_sentence(1);
        assert!(sentence.contains(name), "{name}: {sentence}");
        assert!(!out.exists(), "{name}");
    }
    let missing = folder.path().join("missing.wav");
    let finished = export(folder.path(), &missing, &out);
    assert!(finished.expect_sentence(1).contains("missing.wav"));
}

/// Guards recordings whose program died: what there is of a cut file is used, and said to be short.
#[test]
fn a_cut_wav_is_used_as_far_as_it_goes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.wav");
    let whole = wav::file(Coding::S16, 16_000, 1, &[0.25; 16_000]);
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let labels = folder.path().join("l.phn");
    fs::write(&labels, "0 1600 h#\n1600 3200 aa\n").unwrap();
    let finished = binary::run(&[
        "curves",
        "--rate",
        "10",
        "--labels",
        &labels.to_string_lossy(),
        "--audio",
        &path.to_string_lossy(),
    ]);
    // Half of a second is left, and the table goes on as long.
    assert_eq!(finished.expect_done().text().lines().count(), 1 + 5);
    assert!(finished.stderr.contains("cut.wav"), "{}", finished.stderr);
}
