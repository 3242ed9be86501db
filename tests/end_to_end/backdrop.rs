//! What is behind the head: every kind of backdrop, alpha where it can be kept, and words where it cannot.

use std::fs;

use mouthpiece_tests::binary;

use crate::graphics;

const SHORT: &str = "0 800 h#\n800 1600 aa\n";

/// Raw pixels of a short export before that backdrop, 32 x 32.
fn frames(background: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let labels = folder.path().join("short.phn");
    fs::write(&labels, SHORT).unwrap();
    let labels = labels.to_string_lossy();
    let common = [
        "export", "--labels", &labels, "--size", "32x32", "--fps", "20", "--tier", "low",
    ];
    let rest = ["--background", background, "-o", "-"];
    let done = binary::run(&[&common[..], &rest].concat());
    done.expect_done();
    done.stdout
}

#[test]
fn a_pipe_of_raw_frames_keeps_what_shows_through() {
    if !graphics::are_there_for("backdrops of an export") {
        return;
    }
    let clear = frames("transparent");
    assert!(clear.len() >= 2 * 32 * 32 * 4);
    for picture in clear.chunks_exact(32 * 32 * 4) {
        assert_eq!(picture[..4], [0; 4], "the corner");
        assert_eq!(picture[(16 * 32 + 16) * 4 + 3], 255, "the nose");
    }
    let plain = frames("#102030");
    assert_eq!(plain[..4], [16, 32, 48, 255]);
    let gradient = frames("gradient:#ff0000,#0000ff");
    assert!(
        gradient[0] > 240 && gradient[2] < 15,
        "{:?}",
        &gradient[..4]
    );
}

#[test]
fn what_cannot_be_a_backdrop_or_keep_one_is_said_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (video, still) = (at("a.mp4"), at("a.png"));
    let kept = binary::run(&[
        "export",
        "--demo",
        "--background",
        "transparent",
        "-o",
        &video,
    ]);
    assert!(kept.expect_sentence(2).contains("png"));
    let word = binary::run(&["still", "--background", "transparant", "-o", &still]);
    assert!(word.expect_sentence(2).contains("gradient:"));
    let missing = binary::run(&["still", "--background", &at("none.png"), "-o", &still]);
    assert!(missing.expect_sentence(1).contains("none.png"));
    fs::write(at("text.hdr"), "no light").unwrap();
    let text = binary::run(&["still", "--environment", &at("text.hdr"), "-o", &still]);
    assert!(text.expect_sentence(1).contains("text.hdr"));
    let auto = binary::run(&["export", "--demo", "--tier", "auto", "-o", &video]);
    assert_eq!(auto.code(), 2, "an export never chooses its tier");
    assert!(!folder.path().join("a.mp4").exists() && !folder.path().join("a.png").exists());
}

/// A driver that is asked for and not there, as on a machine without any.
#[test]
#[cfg(target_os = "linux")]
fn without_a_graphics_adapter_it_says_what_to_install() {
    let folder = tempfile::tempdir().unwrap();
    let still = folder.path().join("a.png").to_string_lossy().into_owned();
    let mut command = binary::command(&["still", "-o", &still]);
    command.env("WGPU_BACKEND", "dx12");
    let ended = binary::start(&mut command).finish();
    assert!(ended.expect_sentence(1).contains("mesa-vulkan-drivers"));
}
