//! Videos: sound and picture in step, the same bytes every time, whole or not there at all.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use mouthpiece_tests::picture::Picture;
use mouthpiece_tests::{binary, fixtures, mp4};

use crate::graphics;

/// Frames a second of the videos here.
const FPS: f64 = 30.0;
/// What is left between a track's length and what was asked for: half a sample at 48 kHz, and the
/// thousandths that a movie header may count in.
const ROUNDING_S: f64 = 0.001;

/// A few short labels that need no sound.
pub(crate) const SHORT: &str = "0 1600 h#\n1600 2400 m\n2400 4800 aa\n4800 6400 h#\n";

pub(crate) fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Guards issue 2's measure of the demo: both tracks start at 0 and end within a frame of each
/// other and of the sound that came in; and an independent reader agrees where there is one.
#[test]
fn the_demo_is_in_step_from_the_first_sample_to_the_last() {
    if !graphics::are_there_for("export of the demo") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("demo.mp4");
    let begun = Instant::now();
    binary::run(&[
        "export",
        "--demo",
        "--size",
        "640x480",
        "--fps",
        "30",
        "-o",
        &text(&out),
    ])
    .expect_done();
    let took = begun.elapsed().as_secs_f64();
    assert_eq!(names(folder.path()), ["demo.mp4"]);

    let file = fs::read(&out).unwrap();
    let (picture, sound) = (mp4::track_of(&file, "vide"), mp4::track_of(&file, "soun"));
    let wanted = fixtures::named("demo").sound_s();
    eprintln!("{wanted:.2} s of video took {took:.1} s; {picture:?}; {sound:?}");
    for track in [&picture, &sound] {
        assert_eq!(track.starts_s, 0.0, "{track:?}");
        assert!(
            (track.plays_s - wanted).abs() <= 1.0 / FPS + ROUNDING_S,
            "{wanted} s of sound, but {track:?}"
        );
        // Media beyond what is played would be heard or seen by players that ignore edit lists.
        let surplus = track.media_s - track.skips_s - track.plays_s;
        assert!((-ROUNDING_S..0.1).contains(&surplus), "{track:?}");
    }
    assert_eq!(picture.skips_s, 0.0);
    assert_eq!(picture.samples, (wanted * FPS).ceil() as u64);
    assert!((picture.plays_s - sound.plays_s).abs() <= 1.0 / FPS);
    ffprobe_agrees(&out, wanted);
    sound_is_where_it_was(&out);
}

/// What ffprobe reads, where it is installed.
fn ffprobe_agrees(video: &Path, wanted_s: f64) {
    let args = [
        "-v",
        "error",
        "-of",
        "json",
        "-count_packets",
        "-show_streams",
        &text(video),
    ];
    let Some(json) = binary::tool("ffprobe", &args) else {
        eprintln!("ffprobe is not installed: only our own reader was asked");
        return;
    };
    let probed: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let streams = probed["streams"].as_array().unwrap();
    assert_eq!(streams.len(), 2);
    for stream in streams {
        let number = |key: &str| stream[key].as_str().unwrap().parse::<f64>().unwrap();
        assert!(number("start_time").abs() <= ROUNDING_S, "{stream}");
        let off = number("duration") - wanted_s;
        assert!(off.abs() <= 1.0 / FPS + ROUNDING_S, "{stream}");
    }
    assert_eq!(streams[0]["codec_name"], "h264");
    assert_eq!(
        (&streams[0]["width"], &streams[0]["height"]),
        (&640.into(), &480.into())
    );
}

/// Decodes the sound with ffmpeg, where it is installed, and finds by correlation how far it has
/// moved against the WAV that went in.
fn sound_is_where_it_was(video: &Path) {
    let decode = |path: &Path| {
        let path = text(path);
        let args = [
            "-v", "error", "-i", &path, "-vn", "-ac", "1", "-ar", "48000", "-f", "s16le", "-",
        ];
        let bytes = binary::tool("ffmpeg", &args)?;
        let samples = bytes.chunks_exact(2);
        Some(
            samples
                .map(|b| f64::from(i16::from_le_bytes([b[0], b[1]])))
                .collect::<Vec<_>>(),
        )
    };
    let (Some(after), Some(before)) = (decode(video), decode(&fixtures::named("demo").sound_path))
    else {
        eprintln!("ffmpeg is not installed: the sound was not listened to");
        return;
    };
    // One second of speech, against itself moved by up to 50 ms either way.
    const REACH: usize = 2400;
    let (from, length) = (48_000, 48_000);
    let correlation = |lag: usize| -> f64 {
        let moved = &after[from + lag - REACH..][..length];
        before[from..][..length]
            .iter()
            .zip(moved)
            .map(|(a, b)| a * b)
            .sum()
    };
    let best = (0..=2 * REACH)
        .max_by(|a, b| correlation(*a).total_cmp(&correlation(*b)))
        .unwrap();
    let lag = best.abs_diff(REACH);
    assert!(lag <= 24, "the sound has moved by {lag} samples of 48 kHz");
}

/// Guards reproducible batches: same bytes whatever the number of threads; another seed differs.
#[test]
fn the_same_export_is_the_same_bytes() {
    if !graphics::are_there_for("determinism of export") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let utterance = fixtures::named("flite");
    let export = |name: &str, threads: &str, seed: &str| {
        let out = folder.path().join(name);
        let mut command = binary::command(&[
            "export",
            "--size",
            "128x96",
            "--fps",
            "15",
            "--tier",
            "low",
            "--labels",
            &text(&utterance.labels_path),
            "--audio",
            &text(&utterance.sound_path),
            "--seed",
            seed,
            "-o",
            &text(&out),
        ]);
        // The software driver's own thread count, where that driver draws.
        let command = command.env("LP_NUM_THREADS", threads);
        binary::start(command).finish().expect_done();
        fs::read(out).unwrap()
    };
    let first = export("a.mp4", "2", "1");
    assert!(first == export("b.mp4", "2", "1"), "two runs differ");
    assert!(first == export("c.mp4", "1", "1"), "threads change it");
    assert!(first != export("d.mp4", "2", "2"), "the seed does nothing");
}

/// Guards pipes and picture sequences: as many frames as the time needs, the same in both forms.
#[test]
fn raw_frames_and_png_sequence_are_the_same_pictures() {
    if !graphics::are_there_for("raw frames and PNG sequence") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let labels = folder.path().join("short.phn");
    fs::write(&labels, SHORT).unwrap();
    let labels = text(&labels);
    let common = [
        "export", "--labels", &labels, "--size", "64x48", "--fps", "15", "-o",
    ];
    let export = |to: &str| binary::run(&[&common[..], &[to]].concat());

    let raw = export("-");
    let raw = &raw.expect_done().stdout;
    let frames: Vec<_> = raw.chunks_exact(64 * 48 * 4).collect();
    // 6400 samples of 16 kHz are 0.4 s: six frames of 15 a second.
    assert_eq!((frames.len(), raw.len() % (64 * 48 * 4)), (6, 0));
    assert!(frames.windows(2).any(|w| w[0] != w[1]), "nothing moves");

    let sequence = folder.path().join("frames");
    fs::create_dir(&sequence).unwrap();
    export(&text(&sequence.join("f-%03d.png"))).expect_done();
    let wanted: Vec<_> = (0..6).map(|k| format!("f-{k:03}.png")).collect();
    assert_eq!(names(&sequence), wanted);
    for (name, raw) in wanted.iter().zip(frames) {
        let png = Picture::read(&sequence.join(name));
        assert!(png == Picture::from_rgba(64, 48, raw), "{name}");
    }
}

/// Guards labels without sound: a silent video, without an empty sound track.
#[test]
fn labels_alone_make_a_video_without_sound() {
    if !graphics::are_there_for("export without sound") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (labels, out) = (folder.path().join("short.phn"), folder.path().join("o.mp4"));
    fs::write(&labels, SHORT).unwrap();
    binary::run(&[
        "export",
        "--labels",
        &text(&labels),
        "--size",
        "64x48",
        "--fps",
        "29.97",
        "-o",
        &text(&out),
    ])
    .expect_done();
    let tracks = mp4::tracks(&fs::read(&out).unwrap());
    assert_eq!(tracks.len(), 1);
    assert_eq!(
        (tracks[0].handler.as_str(), tracks[0].samples),
        ("vide", 12)
    );
    assert!((tracks[0].plays_s - 12.0 * 1001.0 / 30_000.0).abs() <= ROUNDING_S);
}

/// Guards what is there: Ctrl-C in the middle leaves the file of before, and nothing else.
#[test]
fn ctrl_c_leaves_no_half_written_file() {
    if !graphics::are_there_for("Ctrl-C during export") {
        return;
    }
    let frames_folder = |folder: &Path| text(&folder.join("f-%04d.png"));
    let video = |folder: &Path| text(&folder.join("old.mp4"));
    for (signal, target) in [
        ("INT", &video as &dyn Fn(&Path) -> String),
        ("TERM", &video),
        ("INT", &frames_folder),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let old = folder.path().join("old.mp4");
        fs::write(&old, b"the file of before").unwrap();
        let target = target(folder.path());
        // Long enough that it cannot be done before the signal comes.
        let mut command = binary::command(&[
            "export", "--demo", "--size", "640x480", "--fps", "60", "-o", &target,
        ]);
        let mut running = binary::start(&mut command);
        // It is at work once its unfinished output stands beside the target.
        let begun = Instant::now();
        while names(folder.path()).len() < 2 && begun.elapsed() < Duration::from_secs(60) {
            assert!(!running.has_ended(), "it ended before the signal");
            std::thread::sleep(Duration::from_millis(10));
        }
        std::thread::sleep(Duration::from_millis(500));
        assert!(!running.has_ended(), "it ended before the signal");
        running.signal(signal);
        let finished = running.finish_within(Duration::from_secs(60));
        finished.expect_sentence(130);
        assert_eq!(names(folder.path()), ["old.mp4"], "SIG{signal}, {target}");
        assert_eq!(fs::read(&old).unwrap(), b"the file of before");
    }
}

/// Guards the message for an output that cannot be: said in one sentence, before the work.
#[test]
fn an_output_that_cannot_be_written_is_named() {
    if !graphics::are_there_for("export to nowhere") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (file, taken) = (folder.path().join("file"), folder.path().join("folder.mp4"));
    fs::write(&file, b"x").unwrap();
    fs::create_dir(&taken).unwrap();
    fs::write(taken.join("keep"), b"x").unwrap();
    for target in [
        text(&folder.path().join("no/such/folder/a.mp4")),
        text(&folder.path().join("no/such/folder/a-%d.png")),
        text(&file.join("a.mp4")),
    ] {
        let finished = binary::run(&["export", "--demo", "-o", &target]);
        let sentence = finished.expect_sentence(1);
        assert!(sentence.contains(&target), "{sentence}");
    }
    assert_eq!(names(folder.path()), ["file", "folder.mp4"]);
    for (target, mend) in [("a.avi", ".mp4"), ("a", ".mp4"), ("a.png", "%05d")] {
        let target = text(&folder.path().join(target));
        let finished = binary::run(&["export", "--demo", "-o", &target]);
        let code = finished.code();
        let sentence = finished.expect_sentence(code);
        assert!(code == 1 || code == 2, "{sentence}");
        assert!(sentence.contains(mend), "{sentence}");
    }
    assert_eq!(names(folder.path()), ["file", "folder.mp4"]);
    assert_eq!(names(&taken), ["keep"]);
}

/// Guards the end of a full disk: a write that fails is status 1, not a short file called done.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure() {
    if !graphics::are_there_for("export to a full disk") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let labels = folder.path().join("short.phn");
    fs::write(&labels, SHORT).unwrap();
    let labels = text(&labels);
    let full = || {
        let device = fs::OpenOptions::new().write(true).open("/dev/full");
        Stdio::from(device.unwrap())
    };
    for args in [
        vec!["export", "--labels", &labels, "--size", "64x48", "-o", "-"],
        vec!["curves", "--labels", &labels],
        vec!["labels", &labels],
    ] {
        let finished = binary::start(binary::command(&args).stdout(full())).finish();
        finished.expect_sentence(1);
    }
}

/// Guards against labels and sound that disagree: the longer of the two decides, nothing is cut.
#[test]
fn labels_and_sound_of_different_lengths_last_as_long_as_the_longer() {
    if !graphics::are_there_for("labels and sound of different lengths") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (labels, out) = (folder.path().join("l.phn"), folder.path().join("o.mp4"));
    let wav = folder.path().join("s.wav");
    for (label_end, sound_s, wanted_s) in [(8_000, 1.0, 1.0), (16_000, 0.5, 1.0)] {
        fs::write(&labels, format!("0 1600 h#\n1600 {label_end} aa\n")).unwrap();
        let tone = mouthpiece_tests::wav::tone(16_000, 440.0, 0.0, sound_s);
        let coding = mouthpiece_tests::wav::Coding::S16;
        fs::write(&wav, mouthpiece_tests::wav::file(coding, 16_000, 1, &tone)).unwrap();
        binary::run(&[
            "export",
            "--labels",
            &text(&labels),
            "--audio",
            &text(&wav),
            "--size",
            "32x32",
            "--fps",
            "10",
            "--tier",
            "low",
            "-o",
            &text(&out),
        ])
        .expect_done();
        for track in mp4::tracks(&fs::read(&out).unwrap()) {
            assert!((track.plays_s - wanted_s).abs() <= ROUNDING_S, "{track:?}");
        }
    }
}
