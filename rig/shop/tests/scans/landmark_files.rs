//! Landmark files: what is written is read, and what is wrong is named.

use glam::DVec3;
use mouthpiece_shop::landmarks::{Landmarks, Unit};
use proptest::prelude::*;

proptest! {
    #[test]
    fn a_file_comes_back(
        unit in prop::sample::select(Unit::ALL.to_vec()),
        points in prop::collection::btree_map("[a-z]{1,4}(_[lr])?|\"\\\\", prop::array::uniform3(-1e6..1e6f64), 0..60),
    ) {
        let points = points.into_iter().map(|(n, p)| (n, DVec3::from_array(p))).collect();
        let landmarks = Landmarks { unit, points };
        let read = Landmarks::parse(landmarks.json().unwrap().as_bytes()).unwrap();
        prop_assert_eq!(read.unit, landmarks.unit);
        prop_assert!(read.points.keys().eq(landmarks.points.keys()));
        for (a, b) in read.points.values().zip(landmarks.points.values()) {
            // The last bit of a number may turn.
            prop_assert!(a.distance(*b) <= 1e-15 * b.length());
        }
    }
}

fn says(json: &str, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("marks.json");
    std::fs::write(&path, json).unwrap();
    let message = Landmarks::read(&path).unwrap_err().to_string();
    for part in ["marks.json"].iter().chain(parts) {
        assert!(message.contains(part), "`{part}` in: {message}");
    }
}

#[test]
fn faults_are_named_with_their_line() {
    says("", &["line 1", r#"{"unit": "mm""#]);
    says("[]", &["line 1"]);
    says(r#"{"unit": "mm"}"#, &["points"]);
    says(r#"{"points": {}}"#, &["unit"]);
    says(r#"{"unit": "ft", "points": {}}"#, &["`ft`", "`mm`"]);
    says(r#"{"unit": "mm", "points": {}, "colour": 1}"#, &["colour"]);
    says(
        "{\"unit\": \"mm\", \"points\": {\n\"prn\": [1, 2]}}",
        &["line 2"],
    );
    says(
        "{\"unit\": \"mm\", \"points\": {\n\"prn\": [1, 2, NaN]}}",
        &["line 2"],
    );
    says(
        r#"{"unit": "mm", "points": {"prn": [1, 2, 3], "prn": [1, 2, 4]}}"#,
        &["`prn`", "twice"],
    );
}

#[test]
fn a_wrong_name_is_answered_with_the_nearest_one() {
    let known = ["prn", "n", "gn", "en_l", "en_r", "ex_l", "ex_r"];
    let check = |name: &str| {
        let points = [(name.to_owned(), DVec3::ZERO)].into();
        let landmarks = Landmarks {
            unit: Unit::Metre,
            points,
        };
        landmarks.check(known.into_iter()).unwrap_err().to_string()
    };
    assert!(check("PRN").contains("`prn`"));
    assert!(check("en_left").contains("`en_l`"));
    let side = check("ex");
    assert!(side.contains("ex_l or ex_r"), "{side}");
}

#[test]
fn what_is_not_finite_is_not_written() {
    let points = [("prn".to_owned(), DVec3::new(0.0, f64::NAN, 0.0))].into();
    let message = Landmarks {
        unit: Unit::Metre,
        points,
    }
    .json()
    .unwrap_err()
    .to_string();
    assert!(
        message.contains("`prn`") && message.contains("NaN"),
        "{message}"
    );
}
