//! Outputs beside MP4: WebM that keeps alpha, frames for other programs, pictures for cameras that are none.

use std::fs;
use std::path::PathBuf;
use std::process::Stdio;

use mouthpiece_tests::{binary, fixtures};

use crate::export::{SHORT, text};
use crate::graphics;

/// Side of the pictures here.
const SIDE: usize = 64;

/// Guards alpha in WebM, judged by another decoder: nothing in the corner, a face in the middle, and sound.
#[test]
fn webm_keeps_alpha_and_sound() {
    if !graphics::are_there_for("WebM with alpha") {
        return;
    }
    let encoders = binary::tool("ffmpeg", &["-hide_banner", "-encoders"]).unwrap_or_default();
    if !String::from_utf8_lossy(&encoders).contains("libvpx-vp9") {
        eprintln!("skipped: there is no ffmpeg with libvpx");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = text(&folder.path().join("o.webm"));
    let utterance = fixtures::named("flite");
    let (labels, sound) = (text(&utterance.labels_path), text(&utterance.sound_path));
    let export = |more: &[&str]| {
        let args = [
            "export", "--labels", &labels, "--audio", &sound, "--size", "64x64",
        ];
        let args = [
            &args[..],
            &["--fps", "5", "--tier", "low", "-o", &out],
            more,
        ]
        .concat();
        binary::run(&args).expect_done();
    };
    let alpha = || {
        // ffmpeg's own decoder of VP9 leaves alpha out.
        let args = [
            "-v",
            "error",
            "-c:v",
            "libvpx-vp9",
            "-i",
            &out,
            "-pix_fmt",
            "rgba",
        ];
        let frames =
            binary::tool("ffmpeg", &[&args[..], &["-f", "rawvideo", "-"]].concat()).unwrap();
        assert!(frames.len() >= 5 * SIDE * SIDE * 4);
        let pictures = frames.chunks_exact(SIDE * SIDE * 4);
        pictures
            .map(|picture| [picture[3], picture[(SIDE / 2 * SIDE + SIDE / 2) * 4 + 3]])
            .collect::<Vec<_>>()
    };
    export(&["--background", "transparent"]);
    for [corner, face] in alpha() {
        assert!(corner == 0 && face == 255, "{corner} {face}");
    }
    let args = [
        "-v",
        "error",
        "-of",
        "json",
        "-show_streams",
        "-show_format",
        &out,
    ];
    let probed: serde_json::Value =
        serde_json::from_slice(&binary::tool("ffprobe", &args).unwrap()).unwrap();
    let codec = |n: usize| probed["streams"][n]["codec_name"].as_str().unwrap();
    assert_eq!((codec(0), codec(1)), ("vp9", "opus"));
    let lasts: f64 = probed["format"]["duration"]
        .as_str()
        .unwrap()
        .parse()
        .unwrap();
    assert!((lasts - utterance.sound_s()).abs() < 0.25, "{lasts} s");

    export(&["--background", "#203040"]);
    assert!(alpha().iter().all(|alpha| *alpha == [255, 255]));
}

/// Guards machines without ffmpeg, or with one that cannot: a sentence that says what to install.
#[cfg(unix)]
#[test]
fn webm_without_an_encoder_is_a_sentence() {
    use std::os::unix::fs::PermissionsExt as _;
    if !graphics::are_there_for("WebM without ffmpeg") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let labels = folder.path().join("short.phn");
    fs::write(&labels, SHORT).unwrap();
    let (labels, out) = (text(&labels), text(&folder.path().join("o.webm")));
    let programs = folder.path().join("bin");
    fs::create_dir(&programs).unwrap();
    let says = |part: &str| {
        let mut command =
            binary::command(&["export", "--labels", &labels, "--size", "64x64", "-o", &out]);
        let finished = binary::start(command.env("PATH", &programs)).finish();
        let sentence = finished.expect_sentence(1);
        assert!(
            sentence.contains("o.webm") && sentence.contains(part),
            "{sentence}"
        );
    };
    says("install");
    let fake = programs.join("ffmpeg");
    fs::write(&fake, "#!/bin/sh\necho ' V....D libx264 H.264'\n").unwrap();
    fs::set_permissions(&fake, fs::Permissions::from_mode(0o755)).unwrap();
    says("libvpx-vp9");
    assert!(!PathBuf::from(&out).exists());
}

/// Guards Y4M in a pipe: its header tells what a reader must know, and every frame is whole.
#[test]
fn y4m_tells_its_size_and_rate() {
    if !graphics::are_there_for("Y4M in a pipe") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let labels = folder.path().join("short.phn");
    fs::write(&labels, SHORT).unwrap();
    let labels = text(&labels);
    let export = |size: &str| {
        binary::run(&[
            "export",
            "--labels",
            &labels,
            "--size",
            size,
            "--fps",
            "29.97",
            "--tier",
            "low",
            "--background",
            "white",
            "--raw",
            "y4m",
            "-o",
            "-",
        ])
    };
    let finished = export("64x48");
    let bytes = &finished.expect_done().stdout;
    let line = bytes.iter().position(|b| *b == b'\n').unwrap();
    let header = String::from_utf8_lossy(&bytes[..line]);
    assert!(
        header.starts_with("YUV4MPEG2 W64 H48 F30000:1001 Ip A1:1 C420"),
        "{header}"
    );
    let frame = b"FRAME\n".len() + 64 * 48 * 3 / 2;
    let frames = &bytes[line + 1..];
    assert_eq!((frames.len() / frame, frames.len() % frame), (12, 0));
    for frame in frames.chunks_exact(frame) {
        assert!(frame.starts_with(b"FRAME\n"));
        assert_eq!(frame[6], 235, "white, in the corner");
    }
    assert!(export("63x48").expect_sentence(1).contains("64x48"));
}

/// Guards files in /dev that only look like cameras: refused in one sentence, before the work.
#[cfg(target_os = "linux")]
#[test]
fn a_camera_that_is_not_there_is_a_sentence() {
    if !graphics::are_there_for("a camera") {
        return;
    }
    let args = ["export", "--demo", "--size", "64x64", "-o", "/dev/video987"];
    let mut command = binary::command(&args);
    let finished = binary::start(command.stdout(Stdio::null())).finish();
    let sentence = finished.expect_sentence(1);
    assert!(sentence.contains("modprobe v4l2loopback"), "{sentence}");
}
