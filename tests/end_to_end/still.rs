//! Pictures against golden ones, by FLIP: what a viewer would see as another picture fails.
//!
//! That a wrong shader would fail is shown beside the shaders (`mouthpiece-render`, `wrong_shader_tests`).
//!
//! `UPDATE_GOLDEN=1 cargo test --release -p mouthpiece-tests still` renews them; look at what git
//! then shows before you commit. A failing picture and a map of where it differs are written to
//! `target/golden/`. The golden ones were drawn by Mesa's software driver (22.3).

use std::fs;
use std::path::PathBuf;

use mouthpiece_tests::binary;
use mouthpiece_tests::picture::{Difference, Picture, TILE};

use crate::graphics;

const SIZE: &str = "240x300";

fn golden(name: &str) -> PathBuf {
    let file = format!("{name}.png");
    binary::root().join("tests/golden").join(file)
}

fn judge(name: &str, args: &[&str]) {
    if !graphics::are_there_for(&format!("golden picture {name}")) {
        return;
    }
    let folder = binary::root().join("target/golden");
    fs::create_dir_all(&folder).unwrap();
    let drawn_path = folder.join(format!("{name}.png"));
    let drawn_text = drawn_path.to_string_lossy();
    let common = ["still", "--size", SIZE, "-o", &drawn_text];
    binary::run(&[&common, args].concat()).expect_done();
    let drawn = Picture::read(&drawn_path);
    let golden = golden(name);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::create_dir_all(golden.parent().unwrap()).unwrap();
        drawn.write(&golden);
        eprintln!("renewed {}", golden.display());
        return;
    }
    assert!(
        golden.is_file(),
        "{} is not there; draw it with UPDATE_GOLDEN=1",
        golden.display()
    );
    let found = drawn.difference(&Picture::read(&golden));
    if found.is_none() {
        return;
    }
    let map = folder.join(format!("{name}-difference.png"));
    found.map.write(&map);
    panic!(
        "{name} looks different: mean {:.4} (at most {}), worst {TILE} x {TILE} pixels {:.4} (at most {}).\n\
         drawn: {}\nwhere: {}\nIf it should look so: UPDATE_GOLDEN=1 cargo test --release -p mouthpiece-tests still",
        found.mean,
        Difference::MEAN_MAX,
        found.worst_tile,
        Difference::TILE_MAX,
        drawn_path.display(),
        map.display()
    );
}

/// A room lit from the left by a low warm sun and from above by a blue sky, as a panorama in Radiance's format.
fn dusk() -> tempfile::TempPath {
    let (wide, high) = (32_usize, 16_usize);
    let mut file =
        format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {high} +X {wide}\n").into_bytes();
    for y in 0..high {
        for x in 0..wide {
            let sun = (5..11).contains(&x) && (5..9).contains(&y);
            let rgb = match (sun, y < high / 2) {
                (true, _) => [255, 150, 60],
                (false, true) => [24, 34, 60],
                (false, false) => [20, 16, 12],
            };
            file.extend(rgb);
            // The exponent that all three share: the sun is eight times as bright.
            file.push(if sun { 131 } else { 128 });
        }
    }
    let path = tempfile::Builder::new()
        .suffix(".hdr")
        .tempfile()
        .unwrap()
        .into_temp_path();
    fs::write(&path, file).unwrap();
    path
}

/// A test for each: what it guards, its name, and what is drawn.
macro_rules! guarded {
    ($($(#[doc = $guards:literal])+ $test:ident: $name:literal, $args:expr;)+) => {
        $($(#[doc = $guards])+ #[test] fn $test() { judge($name, &$args); })+
    };
}

guarded! {
    /// Guards the face at rest.
    the_face_at_rest: "rest", [];
    /// Guards the open mouth: lips, teeth, tongue and the dark behind.
    the_face_in_an_open_vowel: "open", ["--phone", "aa"];
    /// Guards the shape from an angle: profile of nose and lips, ears, hair.
    the_face_half_from_the_side: "half", ["--view", "34"];
    /// Guards the profile.
    the_face_from_the_side: "side", ["--view", "side"];
    /// Guards the low tier.
    the_face_in_the_low_tier: "low", ["--tier", "low"];
    /// Guards the high tier.
    the_face_in_the_high_tier: "high", ["--tier", "high"];
    /// Guards the forehead's wrinkles and wide eyes.
    a_surprised_face: "surprise", ["--tier", "high", "--expression", "surprise"];
    /// Guards cheeks and crow's feet from an angle.
    a_happy_face_half_from_the_side: "happy", ["--view", "34", "--tier", "high", "--expression", "happiness"];
    /// Guards rounded lips in profile, in the low tier.
    a_rounded_mouth_from_the_side: "rounded", ["--view", "side", "--tier", "low", "--phone", "uw"];
    /// Guards the other model of the skin.
    the_face_after_blinn_and_phong: "blinn-phong", ["--skin", "blinn-phong"];
    /// Guards the brow's furrows before a gradient.
    an_angry_face_before_a_gradient: "angry", ["--expression", "anger", "--background", "gradient:#806040,#101418"];
    /// Guards light from a panorama.
    the_face_at_dusk: "dusk", ["--environment", &dusk().to_string_lossy()];
}
