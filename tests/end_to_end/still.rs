//! Pictures against golden ones, by FLIP: what a viewer would see as another picture fails.
//!
//! `UPDATE_GOLDEN=1 cargo test --release -p mouthpiece-tests still` renews them; look at what git
//! then shows before you commit. A failing picture and a map of where it differs are written to
//! `target/golden/`. The golden ones were drawn by Mesa's software driver (22.3).

use std::fs;
use std::path::PathBuf;

use mouthpiece_tests::binary;
use mouthpiece_tests::picture::{Picture, TILE};

use crate::graphics;

/// Mean over the picture. Measured on the first version: OpenGL instead of Vulkan below 0.0001, a
/// head turned by 0.01 rad 0.02, another tier 0.023.
const MEAN_MAX: f32 = 0.01;
/// Mean over any tile. Measured: OpenGL 0.0002, a jaw turned by 0.01 rad 0.13, by 0.02 rad 0.20,
/// another tier 0.2.
const TILE_MAX: f32 = 0.15;

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
    if found.mean <= MEAN_MAX && found.worst_tile <= TILE_MAX {
        return;
    }
    let map = folder.join(format!("{name}-difference.png"));
    found.map.write(&map);
    panic!(
        "{name} looks different: mean {:.4} (at most {MEAN_MAX}), worst {TILE} x {TILE} pixels {:.4} (at most {TILE_MAX}).\n\
         drawn: {}\nwhere: {}\nIf it should look so: UPDATE_GOLDEN=1 cargo test --release -p mouthpiece-tests still",
        found.mean,
        found.worst_tile,
        drawn_path.display(),
        map.display()
    );
}

/// Guards the face at rest.
#[test]
fn the_face_at_rest() {
    judge("rest", &[]);
}

/// Guards the open mouth: lips, teeth, tongue and the dark behind.
#[test]
fn the_face_in_an_open_vowel() {
    judge("open", &["--phone", "aa"]);
}

/// Guards the shape from an angle: profile of nose and lips, ears, hair.
#[test]
fn the_face_half_from_the_side() {
    judge("half", &["--view", "34"]);
}
