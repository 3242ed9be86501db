//! `mouthpiece head info`: what a head holds, measured; as text or as JSON.

use std::collections::HashSet;
use std::fmt::Write as _;

use mouthpiece_rig::{Head, Layer, Mesh, Quality, edge_lengths, measurements};
use serde_json::{Map, Value, json};

use super::calibrate::Unreachable;
use crate::cli::InfoArgs;
use crate::media::output;

/// Runs the command.
pub fn run(args: &InfoArgs) -> anyhow::Result<()> {
    let head = match &args.file {
        Some(file) => Head::load(file)?,
        None => Head::reference()?,
    };
    let mut report = report(&head);
    let unreachable = Unreachable::of(&head.calibration)?;
    report["mouths_of_speech"] = unreachable.json();
    output::print(&if args.json {
        serde_json::to_string_pretty(&report)? + "\n"
    } else {
        text(&report) + "\n" + &unreachable.text()
    })
}

fn report(head: &Head) -> Value {
    let counted = |name: &str, mesh: &Mesh| json!({ "name": name, "vertices": mesh.positions.len(), "triangles": mesh.triangles.len() });
    let parts: Vec<Value> = std::iter::once(counted("skin", &head.skin.mesh))
        .chain(head.parts.iter().map(|p| counted(&p.name, &p.mesh)))
        .collect();
    let landmarks: Vec<Value> = head
        .landmarks
        .iter()
        .zip(head.landmark_places())
        .map(|(landmark, at)| {
            let layer = match landmark.layer {
                Layer::Skin => "skin",
                Layer::Skull => "skull",
                Layer::Mandible => "mandible",
            };
            let at = at.to_array().map(|x| rounded(x, 2));
            json!({ "name": landmark.name, "layer": layer, "at_mm": at })
        })
        .collect();
    let measured: Map<String, Value> = measurements(head)
        .into_iter()
        .map(|m| {
            let mut entry = json!({ "title": m.title, "mm": rounded(m.mm, 2) });
            if let Some([left, right]) = m.sides_mm {
                entry["left_mm"] = rounded(left, 2).into();
                entry["right_mm"] = rounded(right, 2).into();
            }
            (m.name, entry)
        })
        .collect();
    json!({
        "parts": parts,
        "muscles": head.muscles.len(),
        "fibres": head.fibres.len(),
        "colour": head.colour.as_ref().map(|c| [c.width, c.height]),
        "landmarks": landmarks,
        "measurements": measured,
        "mesh": mesh(head),
    })
}

/// How good the skin's mesh is.
fn mesh(head: &Head) -> Value {
    let skin = &head.skin.mesh;
    let q = Quality::of(skin);
    let edges = |vertices: HashSet<u32>| {
        edge_lengths(skin, &vertices).map(|e| {
            let [min, median, max] = [e.min_mm, e.median_mm, e.max_mm].map(|x| rounded(x, 2));
            json!({ "edges": e.count, "min_mm": min, "median_mm": median, "max_mm": max })
        })
    };
    let lips = head.lips.upper.iter().chain(&head.lips.lower).flatten();
    let lids = head.lids.iter().map(|lid| lid.vertex);
    let valences: Map<String, Value> = q
        .valences
        .iter()
        .map(|(valence, count)| (valence.to_string(), (*count).into()))
        .collect();
    json!({
        "angle_min_deg": rounded(q.angle_min_deg, 1),
        "angle_median_deg": rounded(q.angle_median_deg, 1),
        "aspect_max": rounded(q.aspect_max, 1),
        "valences": valences,
        "valence_5_to_7": rounded(q.valence_5_to_7, 4),
        "boundary_loops": q.boundary_loops,
        "manifold": q.manifold,
        "lips": edges(lips.copied().collect()),
        "lids": edges(lids.collect()),
    })
}

fn rounded(value: f32, digits: i32) -> f64 {
    let scale = 10_f64.powi(digits);
    (f64::from(value) * scale).round() / scale
}

fn text(report: &Value) -> String {
    let mut out = String::new();
    let list = |key: &str| report[key].as_array().into_iter().flatten();
    let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    // Writing to a String cannot fail.
    let _ = writeln!(out, "part             vertices  triangles");
    for part in list("parts") {
        let _ = writeln!(
            out,
            "{:<16} {:>8} {:>10}",
            word(&part["name"]),
            part["vertices"],
            part["triangles"]
        );
    }
    let (muscles, fibres) = (&report["muscles"], &report["fibres"]);
    let _ = writeln!(
        out,
        "\nmuscle grids     {muscles}\nfibres           {fibres}"
    );
    let colour = match report["colour"].as_array().map(Vec::as_slice) {
        Some([width, height]) => format!("{width} x {height}"),
        _ => "none".into(),
    };
    let _ = writeln!(out, "colour map       {colour}");
    out += "\nlandmark         on            x       y       z  mm\n";
    for landmark in list("landmarks") {
        let at = |i: usize| landmark["at_mm"][i].as_f64().unwrap_or(0.0);
        let _ = writeln!(
            out,
            "{:<16} {:<8} {:>7.1} {:>7.1} {:>7.1}",
            word(&landmark["name"]),
            word(&landmark["layer"]),
            at(0),
            at(1),
            at(2)
        );
    }
    out += "\nmeasurement         mm    left   right\n";
    for (name, entry) in report["measurements"].as_object().into_iter().flatten() {
        let number = |key: &str| {
            let number = entry[key].as_f64();
            number.map_or_else(String::new, |x| format!("{x:.1}"))
        };
        let _ = writeln!(
            out,
            "{name:<14} {:>7} {:>7} {:>7}  {}",
            number("mm"),
            number("left_mm"),
            number("right_mm"),
            word(&entry["title"])
        );
    }
    out += "\nskin's mesh\n";
    for (name, value) in report["mesh"].as_object().into_iter().flatten() {
        let _ = writeln!(out, "{name:<17} {}", plain(value));
    }
    out
}

/// JSON without its signs.
fn plain(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let all: Vec<_> = map
                .iter()
                .map(|(key, value)| format!("{key}: {value}"))
                .collect();
            all.join(", ")
        }
        Value::Null => "none".into(),
        value => value.to_string(),
    }
}
