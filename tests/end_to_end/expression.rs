//! Guards expressions as a user meets them: a face that smiles still speaks, a wink shuts one eye,
//! a script does at its times what it says, and what is misspelt is explained.

use std::fs;

use mouthpiece_tests::curves::Table;
use mouthpiece_tests::{binary, fixtures};

use crate::graphics;
use crate::mouth::{CLOSED_MM, RATE_HZ, closes};

/// What `curves` measures of the demo's sentence.
fn spoken(more: &[&str]) -> Table {
    let labels = fixtures::named("demo").labels_path;
    let (labels, rate) = (labels.to_string_lossy(), format!("{RATE_HZ}"));
    let args = [&["curves", "--labels", &labels, "--rate", &rate], more].concat();
    Table::parse(&binary::run(&args).expect_done().text())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The faces that open or pull at the mouth most: they must not cost a closure, and still show.
#[test]
fn lips_meet_in_every_bilabial_under_any_expression() {
    let labels = fixtures::named("demo").labels;
    let plain = mean(&spoken(&[]).column("width_mm"));
    for name in ["happiness", "laugh", "surprise", "anger", "disgust", "fear"] {
        let table = spoken(&["--expression", name]);
        let aperture = table.column("aperture_mm");
        for (i, label) in labels.iter().enumerate() {
            if !closes(&labels, i) {
                continue;
            }
            let row = |s: f64| ((s * RATE_HZ).ceil() as usize).min(aperture.len());
            let least = aperture[row(label.start)..row(label.end)]
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min);
            let (phone, start) = (&label.phone, label.start);
            assert!(
                least <= CLOSED_MM,
                "{name}: {least} mm open in {phone} at {start} s"
            );
        }
        if name == "happiness" {
            let smiling = mean(&table.column("width_mm"));
            assert!(smiling > plain + 0.5, "{smiling} mm wide, {plain} without");
        }
    }
}

/// A script's keys are reached when it says; between them nothing jumps.
#[test]
fn a_script_leads_the_face() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("brows.ron");
    let text = r#"(keys: [
        (time_s: 0.5, expression: "neutral"),
        (time_s: 1.0, muscles: {"frontalis_outer_l": 0.8}),
        (time_s: 1.5, expression: "surprise", weight: 0.5),
    ])"#;
    fs::write(&file, text).unwrap();
    let table = spoken(&["--script", &file.to_string_lossy()]);
    let (both, side) = (
        table.column("frontalis_outer"),
        table.column("frontalis_outer_side"),
    );
    let at = |s: f64| (s * RATE_HZ).round() as usize;
    assert_eq!((both[at(0.4)], side[at(0.4)]), (0.0, 0.0));
    assert!((both[at(1.0)] - 0.4).abs() < 1e-3 && (side[at(1.0)] - 0.4).abs() < 1e-3);
    assert!(both[at(1.6)] > 0.4 && side[at(1.6)] == 0.0);
    for w in both.windows(2) {
        assert!((w[1] - w[0]).abs() < 2.5 / RATE_HZ, "{} to {}", w[0], w[1]);
    }

    fs::write(&file, text.replace("surprise", "suprise")).unwrap();
    let finished = binary::run(&["curves", "--demo", "--script", &file.to_string_lossy()]);
    let said = finished.expect_sentence(1);
    assert!(
        said.contains("line 4") && said.contains("`surprise`"),
        "{said}"
    );
}

/// An unknown expression is wrong usage, and the answer is the list.
#[test]
fn an_unknown_expression_lists_all() {
    let finished = binary::run(&["still", "--expression", "list", "-o", "x.png"]);
    let said = finished.expect_sentence(2);
    for name in ["happiness", "worry", "wink_left", "kiss"] {
        assert!(said.contains(name), "{said}");
    }
}

/// A wink shuts the eye that it names, as its picture's outline measures.
#[test]
fn a_wink_shuts_one_eye() {
    if !graphics::are_there_for("a wink") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (png, json) = (path("f.png"), path("f.json"));
    let args = [
        "still",
        "--expression",
        "wink_left",
        "--size",
        "300x360",
        "-o",
        &png,
        "--outline",
        &json,
    ];
    binary::run(&args).expect_done();
    let outline: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    let gap = |side: &str| {
        let height = |lid: &str| {
            let line = &outline["lids"][side][lid];
            let line: Vec<[f64; 2]> = serde_json::from_value(line.clone()).unwrap();
            mean(&line.iter().map(|p| p[1]).collect::<Vec<_>>())
        };
        height("lower") - height("upper")
    };
    let (left, right) = (gap("left"), gap("right"));
    assert!(
        right > 2.0 && left < 0.35 * right,
        "{left} and {right} pixels open"
    );
}
