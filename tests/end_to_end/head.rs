//! Head files: one that the program wrote is looked at, spoken with and drawn; a broken one is refused
//! in one sentence that names it.

use std::fs;
use std::path::{Path, PathBuf};

use mouthpiece_rig::Head;
use mouthpiece_tests::binary;
use serde_json::Value;

/// The built-in head as a file.
fn written(folder: &Path) -> PathBuf {
    let path = folder.join("anna.glb");
    fs::write(&path, Head::reference().unwrap().write()).unwrap();
    path
}

/// Guards `head info`: what it counts is what the head has.
#[test]
fn info_counts_what_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path());
    let name = path.to_string_lossy();
    let finished = binary::run(&["head", "info", &name, "--json"]);
    let report: Value = serde_json::from_str(&finished.expect_done().text()).unwrap();
    let head = Head::reference().unwrap();
    assert_eq!(
        report["parts"].as_array().unwrap().len(),
        head.parts.len() + 1
    );
    assert_eq!(report["parts"][0]["name"], "skin");
    let vertices = head.skin.mesh.positions.len();
    assert_eq!(report["parts"][0]["vertices"], vertices);
    assert_eq!(report["mesh"]["manifold"], true);
    let built_in = binary::run(&["head", "info"]);
    assert!(built_in.expect_done().text().contains("teeth_upper"));
}

/// Guards `head calibrate`: it says how near postures come and which mouths cannot be made, and the head that it
/// writes is one whose `head info` says the same of them.
#[test]
fn calibrate_says_what_the_head_cannot_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path());
    let new = folder.path().join("new.glb");
    let (from, to) = (path.to_string_lossy(), new.to_string_lossy());
    let said = binary::run(&["head", "calibrate", &from, "-o", &to]);
    let said = said.expect_done().text();
    for word in [
        "60 random postures",
        "aperture",
        "worst",
        "mouths of speech",
    ] {
        assert!(said.contains(word), "{said}");
    }
    let info = binary::run(&["head", "info", &to, "--json"]);
    let report: Value = serde_json::from_str(&info.expect_done().text()).unwrap();
    let mouths = &report["mouths_of_speech"];
    assert!(mouths["asked"].as_u64().unwrap() > 40);
    for miss in mouths["missed"].as_array().unwrap() {
        assert!(said.contains(miss["row"].as_str().unwrap()), "{said}");
        assert!(miss["by_mm"].as_f64().unwrap().abs() > 0.5);
    }
}

/// Guards that a head from a file speaks as the same head built in.
#[test]
fn a_head_file_is_spoken_with() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path());
    let name = path.to_string_lossy();
    let common = ["curves", "--demo", "--rate", "10"];
    let own = binary::run(&common);
    let read = binary::run(&[&common[..], &["--head", &name]].concat());
    let table = |text: &str| -> Vec<f32> {
        let rows = text.lines().skip(1).flat_map(|line| line.split(','));
        rows.map(|cell| cell.parse().unwrap()).collect()
    };
    let own = table(&own.expect_done().text());
    let read = table(&read.expect_done().text());
    assert_eq!(own.len(), read.len());
    let worst = own
        .iter()
        .zip(&read)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    assert!(worst < 0.05, "{worst} mm apart");
}

/// Guards the refusals: one sentence, status 1, the file's name in it.
#[test]
fn what_is_no_head_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let whole = fs::read(written(folder.path())).unwrap();
    let half = folder.path().join("half.glb");
    fs::write(&half, &whole[..whole.len() / 2]).unwrap();
    let sound = binary::root().join("tests/fixtures/demo.wav");
    let missing = folder.path().join("missing.glb");
    for (path, word) in [
        (half, "ends in the middle"),
        (sound, "no binary glTF"),
        (missing, "No such file"),
    ] {
        let name = path.to_string_lossy();
        for command in [
            &["still", "-o", "never.png", "--head", &name][..],
            &["curves", "--demo", "--head", &name],
            &["head", "info", &name],
            &["head", "calibrate", &name, "-o", "never.glb"],
        ] {
            let finished = binary::run(command);
            let said = finished.expect_sentence(1);
            assert!(said.contains(&*name) && said.contains(word), "{said}");
        }
    }
    assert!(!Path::new("never.png").exists() && !Path::new("never.glb").exists());
}
