//! Guards `still --outline`: what it says lies where the picture shows it.

use std::fs;

use mouthpiece_tests::binary;
use mouthpiece_tests::picture::Picture;
use serde_json::Value;

use crate::graphics;

const SIZE: [f64; 2] = [300.0, 360.0];

/// A still and its outline; none where there is nothing to draw with.
fn drawn(args: &[&str]) -> Option<(Picture, Value)> {
    if !graphics::are_there_for("outline of a still") {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let (png, json) = (folder.path().join("f.png"), folder.path().join("f.json"));
    let (png_text, json_text) = (png.to_string_lossy(), json.to_string_lossy());
    let common = ["still", "--size", "300x360", "-o", &png_text, "--outline"];
    binary::run(&[&common[..], &[&json_text], args].concat()).expect_done();
    let text = fs::read_to_string(json).unwrap();
    Some((Picture::read(&png), serde_json::from_str(&text).unwrap()))
}

fn points(line: &Value) -> Vec<[f64; 2]> {
    serde_json::from_value(line.clone()).unwrap_or_else(|e| panic!("{line}: {e}"))
}

/// Least and greatest of a line, across and down.
fn bounds(line: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let fold = |k: usize, start: f64, pick: fn(f64, f64) -> f64| {
        line.iter().map(|p| p[k]).fold(start, pick)
    };
    [
        [
            fold(0, f64::INFINITY, f64::min),
            fold(1, f64::INFINITY, f64::min),
        ],
        [
            fold(0, f64::NEG_INFINITY, f64::max),
            fold(1, f64::NEG_INFINITY, f64::max),
        ],
    ]
}

/// A compositor scales by `size`, and a point off the picture would be cut.
#[test]
fn every_point_lies_in_the_picture() {
    for view in ["front", "34", "side"] {
        let Some((_, outline)) = drawn(&["--view", view]) else {
            return;
        };
        assert_eq!(outline["size"], serde_json::json!(SIZE.map(|s| s as u32)));
        let lids = |side: &str, lid: &str| points(&outline["lids"][side][lid]);
        let mut all: Vec<_> = [
            points(&outline["lips"]["outer"]),
            points(&outline["lips"]["inner"]),
        ]
        .concat();
        for (side, lid) in [
            ("left", "upper"),
            ("left", "lower"),
            ("right", "upper"),
            ("right", "lower"),
        ] {
            assert!(lids(side, lid).len() >= 8, "{view}: {side} {lid} lid");
            all.extend(lids(side, lid));
        }
        let landmarks = outline["landmarks"].as_object().unwrap();
        assert_eq!(landmarks.len(), 60, "{view}");
        all.extend(
            landmarks
                .values()
                .map(|p| points(&serde_json::json!([p]))[0]),
        );
        for p in all {
            let inside = (0..2).all(|k| p[k] > 0.0 && p[k] < SIZE[k]);
            assert!(inside, "{view}: {p:?}");
        }
    }
}

/// The reference head is symmetric: left and right must not be swapped, nor the picture mirrored.
#[test]
fn from_the_front_the_sides_mirror_each_other() {
    let Some((_, outline)) = drawn(&[]) else {
        return;
    };
    let at = |name: &str| points(&serde_json::json!([outline["landmarks"][name]]))[0];
    for (left, right) in [
        ("en_l", "en_r"),
        ("ex_l", "ex_r"),
        ("ch_l", "ch_r"),
        ("al_l", "al_r"),
    ] {
        let (l, r) = (at(left), at(right));
        assert!(l[0] > r[0], "the subject's left is the picture's right");
        assert!((l[0] + r[0] - SIZE[0]).abs() < 1.0, "{left} {l:?} {r:?}");
        assert!((l[1] - r[1]).abs() < 0.7, "{left} {l:?} {r:?}");
    }
    let [least, most] = bounds(&points(&outline["lips"]["outer"]));
    assert!((least[0] + most[0] - SIZE[0]).abs() < 1.0);
    let mouth = [at("sn")[1], at("gn")[1]];
    assert!(
        mouth[0] < least[1] && most[1] < mouth[1],
        "lips between nose and chin"
    );
}

/// The lines are the frame's, not those of the head at rest, and the picture agrees.
#[test]
fn lips_and_lids_are_where_the_frame_has_them() {
    let Some((_, rest)) = drawn(&[]) else { return };
    let Some((picture, open)) = drawn(&["--controls", r#"{"jaw_rad":0.3,"lid_l":1}"#]) else {
        return;
    };
    let height = |outline: &Value, line: &[&str]| {
        let value = line.iter().fold(outline, |v, key| &v[*key]);
        let [least, most] = bounds(&points(value));
        most[1] - least[1]
    };
    assert!(height(&open, &["lips", "inner"]) > height(&rest, &["lips", "inner"]) + 8.0);
    // In the middle of the open mouth it is dark; on the red between the two lines it is not.
    let [least, most] = bounds(&points(&open["lips"]["inner"]));
    let brightness = |x: f64, y: f64| {
        let at = (y as usize * picture.width as usize + x as usize) * 3;
        f64::from(picture.rgb[at]) + f64::from(picture.rgb[at + 1])
    };
    let middle = (least[0] + most[0]) / 2.0;
    let lip = (most[1] + bounds(&points(&open["lips"]["outer"]))[1][1]) / 2.0;
    let gap = least[1] * 0.4 + most[1] * 0.6;
    assert!(brightness(middle, lip) > 1.5 * brightness(middle, gap));
    // The lids that closed meet; the others do not.
    let gap = |outline: &Value, side: &str| {
        let mean = |lid: &str| {
            let line = points(&outline["lids"][side][lid]);
            line.iter().map(|p| p[1]).sum::<f64>() / line.len() as f64
        };
        mean("lower") - mean("upper")
    };
    assert!(gap(&open, "left") < 0.4 * gap(&rest, "left"));
    assert!(gap(&open, "right") > 0.8 * gap(&rest, "right"));
}
