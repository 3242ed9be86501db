//! `mouthpiece head fit`: a scan becomes a head that speaks; what is no scan of one head, and landmarks that are not
//! where they should be, end in one sentence that names the fault, and never in a file.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use mouthpiece_rig::{Head, Layer};
use mouthpiece_tests::binary::{self, Finished};
use serde_json::{Map, Value, json};

/// Longest that a refusal by a file's header may take, and any other one: nobody waits for a no.
const AT_ONCE: Duration = Duration::from_secs(5);

/// The built-in head as if it had been scanned: its skin without the insides, and its landmarks.
struct Bench {
    folder: tempfile::TempDir,
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    points: Map<String, Value>,
}

impl Bench {
    fn new() -> Self {
        let head = Head::reference().unwrap();
        let skin = &head.skin;
        let limit = head.skin_limit().unwrap();
        let mut drawn = vec![skin.mesh.positions[0]; limit.len()];
        limit.apply(&skin.mesh.positions, &mut drawn);
        let dry = |t: &&[u32; 3]| t.iter().all(|v| skin.wet[*v as usize] < 0.3);
        let marks = head.landmarks.iter().filter(|l| l.layer == Layer::Skin);
        Self {
            folder: tempfile::tempdir().unwrap(),
            points: marks
                .map(|l| (l.name.clone(), json!(l.at.on(&drawn).to_array())))
                .collect(),
            positions: drawn.into_iter().map(Into::into).collect(),
            triangles: skin.mesh.triangles.iter().filter(dry).copied().collect(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).unwrap();
        path
    }

    /// The scan as OBJ.
    fn scan(&self) -> PathBuf {
        self.write("scan.obj", obj(&self.positions, &self.triangles))
    }

    fn landmarks(&self, points: &Map<String, Value>) -> PathBuf {
        let text = json!({ "unit": "mm", "points": points }).to_string();
        self.write("landmarks.json", text)
    }

    fn fit(&self, scan: &Path, landmarks: &Path) -> Finished {
        let out = self.path("new.glb");
        let words = [scan, landmarks, &out].map(|p| p.to_string_lossy().into_owned());
        let [scan, landmarks, out] = &words;
        binary::run(&["head", "fit", scan, "--landmarks", landmarks, "-o", out])
    }

    /// Fails unless the fit is refused in one sentence with these words, at once, without a file.
    #[track_caller]
    fn refused(&self, scan: &Path, landmarks: &Path, words: &[&str]) {
        let begun = Instant::now();
        let finished = self.fit(scan, landmarks);
        let took = begun.elapsed();
        let said = finished.expect_sentence(1);
        for word in words {
            assert!(said.contains(word), "no `{word}` in: {said}");
        }
        assert!(took < AT_ONCE, "took {took:?} to say: {said}");
        assert!(!self.path("new.glb").exists());
    }
}

fn obj(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> String {
    let rows = positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = triangles.iter().map(|t| {
        let [a, b, c] = t.map(|i| i + 1);
        format!("f {a} {b} {c}\n")
    });
    rows.chain(faces).collect()
}

/// Guards the whole way: a scan is fitted, reported on, looked at and spoken with.
#[test]
fn a_scan_becomes_a_head_that_speaks() {
    let bench = Bench::new();
    // Another size and unit, somewhere else.
    let scaled: Vec<[f32; 3]> = bench
        .positions
        .iter()
        .map(|[x, y, z]| [x * 0.0009 + 2.0, y * 0.00085, z * 0.0009 - 1.0])
        .collect();
    let scan = bench.write("scan.obj", obj(&scaled, &bench.triangles));
    let moved = |at: &Value| {
        let [x, y, z] = [0, 1, 2].map(|i| at[i].as_f64().unwrap());
        json!([x * 0.0009 + 2.0, y * 0.00085, z * 0.0009 - 1.0])
    };
    let mut points: Map<String, Value> = bench
        .points
        .iter()
        .map(|(name, at)| (name.clone(), moved(at)))
        .collect();
    points.remove("op");
    let text = json!({ "unit": "m", "points": points }).to_string();
    let landmarks = bench.write("landmarks.json", text);
    let [out, report] = ["new.glb", "report.json"].map(|n| bench.path(n));
    let [scan, landmarks, out, report] =
        [scan, landmarks, out, report].map(|p| p.to_string_lossy().into_owned());
    let finished = binary::run(&[
        "head",
        "fit",
        &scan,
        "--landmarks",
        &landmarks,
        "-o",
        &out,
        "--report",
        &report,
        "--json",
    ]);
    let printed: Value = serde_json::from_str(&finished.expect_done().text()).unwrap();
    let written: Value = serde_json::from_slice(&fs::read(&report).unwrap()).unwrap();
    assert_eq!(printed, written);
    assert!(
        finished.stderr.contains("estimated: op"),
        "{}",
        finished.stderr
    );
    for (key, most) in [
        ("landmark_error_mm", 1.5),
        ("skin_to_scan_mm", 0.3),
        ("scan_to_skin_mm", 0.7),
    ] {
        let mean = written[key]["mean"].as_f64().unwrap();
        assert!(mean <= most, "{key}: {mean}");
    }
    assert!(written["seconds"]["total"].as_f64().unwrap() > 0.0);
    assert!(written["turned_faces"].as_f64().unwrap() <= 0.0005);
    assert_eq!(written["estimated_landmarks"], json!(["op"]));
    // Metres of the scan from millimetres of the head.
    let scale = written["scan_from_head"][0][0].as_f64().unwrap();
    assert!((scale - 0.001).abs() < 1e-5, "{scale}");
    let info = binary::run(&["head", "info", &out]);
    assert!(info.expect_done().text().contains("teeth_upper"));
    let curves = binary::run(&["curves", "--demo", "--rate", "50", "--head", &out]);
    let text = curves.expect_done().text();
    let mut rows = text.lines();
    let column = rows
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "aperture_mm")
        .unwrap();
    let gaps: Vec<f32> = rows
        .map(|row| row.split(',').nth(column).unwrap().parse().unwrap())
        .collect();
    let least = gaps.iter().copied().fold(f32::MAX, f32::min);
    let most = gaps.iter().copied().fold(f32::MIN, f32::max);
    assert!(least < 0.05 && most > 6.0, "gaps of {least} to {most} mm");
}

/// Guards the refusals of files that are no scan of a head.
#[test]
fn what_is_no_scan_is_refused() {
    let bench = Bench::new();
    let landmarks = bench.landmarks(&bench.points);
    let refused = |name: &str, bytes: &[u8], words: &[&str]| {
        let scan = bench.write(name, bytes);
        let named: Vec<&str> = words.iter().copied().chain([name]).collect();
        bench.refused(&scan, &landmarks, &named);
    };
    refused("sound.wav", b"RIFF....WAVEfmt ", &["not a mesh"]);
    refused("empty.ply", b"", &["empty"]);
    refused("text.obj", b"hello\nworld\n", &[]);
    refused(
        "one.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &["1 triangle"],
    );
    let mut hurt = bench.positions.clone();
    hurt[100][1] = f32::NAN;
    refused(
        "nan.obj",
        obj(&hurt, &bench.triangles).as_bytes(),
        &["line 101"],
    );
    let claim = b"ply\nformat binary_little_endian 1.0\nelement vertex 5000000\nproperty float x\n\
        property float y\nproperty float z\nelement face 10000000\n\
        property list uchar int vertex_indices\nend_header\n";
    refused("huge.ply", claim, &["decimate"]);
    let mut stl = vec![0; 80];
    stl.extend(10_000_000_u32.to_le_bytes());
    refused("short.stl", &stl, &["export the scan again"]);
    // As large as it says, but with nothing in it: a file of holes.
    let huge = bench.write("huge.stl", &stl);
    let size = 84 + 50 * 10_000_000;
    let file = fs::OpenOptions::new().write(true).open(&huge).unwrap();
    file.set_len(size).unwrap();
    bench.refused(&huge, &landmarks, &["huge.stl", "10000000", "decimate"]);
    let cut = obj(&bench.positions, &bench.triangles);
    refused("cut.glb", &[b"glTF", &cut.as_bytes()[..200]].concat(), &[]);
    let missing = bench.path("missing.ply");
    bench.refused(&missing, &landmarks, &["missing.ply"]);
}

/// Guards that two heads are not made into one.
#[test]
fn two_heads_are_refused() {
    let bench = Bench::new();
    let beside = bench.positions.iter().map(|[x, y, z]| [x + 400.0, *y, *z]);
    let positions: Vec<[f32; 3]> = bench.positions.iter().copied().chain(beside).collect();
    let first = bench.positions.len() as u32;
    let again = bench.triangles.iter().map(|t| t.map(|v| v + first));
    let triangles: Vec<[u32; 3]> = bench.triangles.iter().copied().chain(again).collect();
    let scan = bench.write("two.obj", obj(&positions, &triangles));
    let landmarks = bench.landmarks(&bench.points);
    bench.refused(&scan, &landmarks, &["two.obj", "two heads"]);
}

/// Guards the refusals of landmarks: each names the landmark and the mend.
#[test]
fn wrong_landmarks_are_refused() {
    let bench = Bench::new();
    let scan = bench.scan();
    let refused = |points: &Map<String, Value>, words: &[&str]| {
        let landmarks = bench.landmarks(points);
        let named: Vec<&str> = words.iter().copied().chain(["landmarks.json"]).collect();
        bench.refused(&scan, &landmarks, &named);
    };
    let with = |change: &dyn Fn(&mut Map<String, Value>)| {
        let mut points = bench.points.clone();
        change(&mut points);
        points
    };
    let unknown = with(&|p| {
        p.insert("pronasale".into(), json!([0.0, 0.0, 130.0]));
    });
    refused(&unknown, &["pronasale"]);
    let swapped: Map<String, Value> = bench
        .points
        .iter()
        .map(|(name, at)| {
            let other = match (name.strip_suffix("_l"), name.strip_suffix("_r")) {
                (Some(base), _) => format!("{base}_r"),
                (_, Some(base)) => format!("{base}_l"),
                _ => name.clone(),
            };
            (other, at.clone())
        })
        .collect();
    refused(&swapped, &["left and right"]);
    let spot: Map<String, Value> = bench
        .points
        .keys()
        .map(|name| (name.clone(), json!([0.0, 0.0, 100.0])))
        .collect();
    refused(&spot, &["one spot"]);
    let outside = with(&|p| {
        p.insert("prn".into(), json!([0.0, 0.0, 260.0]));
    });
    refused(&outside, &["`prn`", "estimated"]);
    let away: Map<String, Value> = bench
        .points
        .iter()
        .map(|(name, at)| {
            (
                name.clone(),
                json!([at[0], at[1], at[2].as_f64().unwrap() + 900.0]),
            )
        })
        .collect();
    refused(&away, &["off the scan"]);
    let few: Map<String, Value> = bench.points.clone().into_iter().take(3).collect();
    refused(&few, &["at least 4"]);
    let no_json = bench.write("broken.json", "{\"unit\": \"mm\"");
    bench.refused(&scan, &no_json, &["broken.json"]);
}

/// Guards usage: status 2 for words that are none, and a place that cannot be written is said before the work.
#[test]
fn usage_is_checked_first() {
    let bench = Bench::new();
    let scan = bench.scan();
    let landmarks = bench.landmarks(&bench.points);
    let [scan, landmarks] = [scan, landmarks].map(|p| p.to_string_lossy().into_owned());
    let whole = [
        "head",
        "fit",
        &scan,
        "--landmarks",
        &landmarks,
        "-o",
        "x.glb",
    ];
    for words in [
        &whole[..3],
        &whole[..5],
        &[&whole[..], &["--unit", "ell"]].concat(),
    ] {
        let finished = binary::run(words);
        assert_eq!(finished.code(), 2, "{}", finished.stderr);
    }
    let nowhere = bench.path("nowhere/new.glb").to_string_lossy().into_owned();
    let finished = binary::run(&[
        "head",
        "fit",
        &scan,
        "--landmarks",
        &landmarks,
        "-o",
        &nowhere,
    ]);
    assert!(finished.expect_sentence(1).contains("nowhere"));
}
