//! Guards `still --show`: each of the things under the skin gives a picture of its own.

use mouthpiece_tests::binary;
use mouthpiece_tests::picture::Picture;

use crate::graphics;

/// A small still against plain blue.
fn drawn(args: &[&str]) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let png = folder.path().join("f.png");
    let png_text = png.to_string_lossy();
    let common = [
        "still", "--size", "160x200", "--tier", "low", "-o", &png_text,
    ];
    binary::run(&[&common[..], &["--background", "#0000ff"], args].concat()).expect_done();
    Picture::read(&png)
}

/// Share of the picture whose pixels pass.
fn share(picture: &Picture, passes: impl Fn([u8; 3]) -> bool) -> f32 {
    let (pixels, _) = picture.rgb.as_chunks::<3>();
    pixels.iter().filter(|p| passes(**p)).count() as f32 / pixels.len() as f32
}

#[test]
fn skin_muscles_skull_and_springs_are_four_pictures() {
    if !graphics::are_there_for("what lies under the skin") {
        return;
    }
    let shown = ["skin", "muscles", "skull", "springs"].map(|what| drawn(&["--show", what]));
    for (i, a) in shown.iter().enumerate() {
        let seen = share(a, |p| p != [0, 0, 255]);
        assert!((0.15..0.8).contains(&seen), "picture {i} fills {seen}");
        for (j, b) in shown.iter().enumerate().skip(i + 1) {
            assert!(a.difference(b).mean > 0.05, "{i} and {j} look alike");
        }
    }
    // Red flesh over ivory, and ivory alone.
    let red = |p: [u8; 3]| p[0] > 90 && u16::from(p[0]) > 2 * u16::from(p[1].max(p[2]));
    let [_, muscles, skull, _] = &shown;
    assert!(share(muscles, red) > 0.05, "{}", share(muscles, red));
    assert!(share(skull, red) < 0.005, "{}", share(skull, red));
}

#[test]
fn muscles_are_shown_as_they_are_contracted() {
    if !graphics::are_there_for("muscles at work") {
        return;
    }
    let rest = drawn(&["--show", "muscles"]);
    let raised = drawn(&[
        "--show",
        "muscles",
        "--controls",
        r#"{"frontalis_inner": 1}"#,
    ]);
    assert!(rest.difference(&raised).worst_tile > 0.05);
}
