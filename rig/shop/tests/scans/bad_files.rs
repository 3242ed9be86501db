//! Files that a user takes for a scan and that are none: the message names file, fault and mend.

use std::fs::File;
use std::io::Write;

use mouthpiece_shop::mesh::{Format, MAX_TRIANGLES, Scan, read, read_bytes, tidy};

use crate::shapes;
use crate::writers::{self, Ply};

/// Writes the file and returns what reading it says.
fn message(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let message = read(&path).unwrap_err().to_string();
    assert!(message.contains(name), "the file is named: {message}");
    assert!(message.lines().count() == 1, "one sentence: {message}");
    message
}

fn says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` in: {message}");
    }
}

#[test]
fn what_is_no_mesh_is_said_to_be_none() {
    for name in ["a.obj", "a.ply", "a.stl", "a.glb", "a.gltf", "a.txt"] {
        says(&message(name, b""), &["empty"]);
        let page = b"<html><body>404 Not found</body></html>";
        says(&message(name, page), &["export the scan"]);
    }
    says(&message("a.obj", &[0; 400]), &["not OBJ", "not text"]);
    says(
        &message("picture.png", b"\x89PNG\r\n"),
        &["OBJ, PLY, STL or GLB"],
    );
    says(
        &read("no/such.obj").unwrap_err().to_string(),
        &["no/such.obj", "check the path"],
    );
    let folder = tempfile::tempdir().unwrap();
    says(&read(folder.path()).unwrap_err().to_string(), &["folder"]);
}

#[test]
fn nan_and_infinity_are_named_with_line_and_vertex() {
    let text = String::from_utf8(writers::obj(&shapes::head())).unwrap();
    let nth = |n: usize, line: &str| {
        let mut lines: Vec<&str> = text.lines().collect();
        lines[n] = line;
        lines.join("\n").into_bytes()
    };
    says(
        &message("a.obj", &nth(11, "v 1 NaN 3")),
        &["line 12", "y of vertex 10", "NaN", "remove"],
    );
    says(
        &message("a.obj", &nth(11, "v 1 2 inf")),
        &["line 12", "z of vertex 10", "inf"],
    );
    says(
        &message("a.obj", &nth(11, "v 1 2 1e39000")),
        &["line 12", "inf"],
    );
    says(
        &message("a.obj", &nth(11, "v 1 2 1e30")),
        &["line 12", "beyond"],
    );
    says(
        &message("a.obj", &nth(11, "v 1 -1.#IND 3")),
        &["line 12", "1.#IND"],
    );
    says(
        &message("a.obj", &nth(11, "v 1 2,5 3")),
        &["line 12", "`2,5`", "point"],
    );
    says(
        &message("a.obj", &nth(11, "v 1 2")),
        &["line 12", "three coordinates"],
    );
    let mut scan = shapes::head();
    scan.positions[7].x = f32::NAN;
    for kind in [Ply::Text, Ply::Little, Ply::Big] {
        says(
            &message("a.ply", &writers::ply(&scan, kind, false, None)),
            &["x of vertex 8", "NaN"],
        );
    }
    says(&message("a.stl", &writers::stl(&scan)), &["byte", "NaN"]);
    says(
        &message("a.glb", &writers::glb(&scan, &Default::default())),
        &["x of vertex 8", "NaN"],
    );
}

#[test]
fn indices_out_of_range_are_named() {
    let mut text = String::from_utf8(writers::obj(&shapes::head())).unwrap();
    let count = shapes::head().positions.len();
    let line = text.lines().count() + 1;
    text += "f 1 2 99999999\n";
    let place = format!("line {line}");
    says(
        &message("a.obj", text.as_bytes()),
        &[&place, "vertex 99999999", &format!("{count}")],
    );
    for bad in ["f 0 1 2", "f 1 2 -99999999", "f 1/1 2/1 3/1"] {
        let text = text.replace("f 1 2 99999999", bad);
        says(&message("a.obj", text.as_bytes()), &[&place, "refers to"]);
    }
    let text = text.replace("f 1 2 99999999", "f 1 2");
    says(&message("a.obj", text.as_bytes()), &[&place, "2 corners"]);
    let mut scan = shapes::head();
    scan.triangles[3][1] = 123_456;
    for kind in [Ply::Text, Ply::Little, Ply::Big] {
        says(
            &message("a.ply", &writers::ply(&scan, kind, false, None)),
            &["123456"],
        );
    }
    says(
        &message("a.glb", &writers::glb(&scan, &Default::default())),
        &["123456"],
    );
}

#[test]
fn one_triangle_is_no_head() {
    let one = Scan {
        triangles: vec![[0, 1, 2]],
        ..shapes::head()
    };
    for (name, bytes) in [
        ("a.obj", writers::obj(&one)),
        ("a.ply", writers::ply(&one, Ply::Little, false, None)),
        ("a.stl", writers::stl(&one)),
        ("b.stl", writers::stl_text(&one)),
        ("a.glb", writers::glb(&one, &Default::default())),
    ] {
        says(&message(name, &bytes), &["1 triangle", "whole scan"]);
    }
}

#[test]
fn a_cloud_of_points_is_told_from_a_mesh() {
    let cloud = Scan {
        triangles: Vec::new(),
        ..shapes::head()
    };
    says(
        &message("a.ply", &writers::ply(&cloud, Ply::Little, false, None)),
        &["cloud of points"],
    );
    says(
        &message("a.obj", &writers::obj(&cloud)),
        &["cloud of points"],
    );
}

#[test]
fn files_that_were_cut_short_are_named_so() {
    let scan = shapes::head();
    let half = |bytes: Vec<u8>| bytes[..bytes.len() / 2].to_vec();
    for kind in [Ply::Text, Ply::Little, Ply::Big] {
        says(
            &message("a.ply", &half(writers::ply(&scan, kind, false, None))),
            &["cut short"],
        );
    }
    says(
        &message("a.stl", &half(writers::stl(&scan))),
        &["cut short"],
    );
    says(
        &message("a.glb", &half(writers::glb(&scan, &Default::default()))),
        &["cut short"],
    );
}

#[test]
fn ten_million_triangles_are_refused_before_they_are_loaded() {
    let folder = tempfile::tempdir().unwrap();
    // Sparse files: they have a size and take no room.
    let path = folder.path().join("a.stl");
    let mut file = File::create(&path).unwrap();
    file.write_all(&[0; 80]).unwrap();
    file.write_all(&10_000_000u32.to_le_bytes()).unwrap();
    file.set_len(84 + 500_000_000).unwrap();
    let limit = MAX_TRIANGLES.to_string();
    says(
        &read(&path).unwrap_err().to_string(),
        &["10000000", &limit, "decimate"],
    );
    let path = folder.path().join("a.ply");
    let mut file = File::create(&path).unwrap();
    file.write_all(
        b"ply\nformat binary_little_endian 1.0\nelement vertex 5000000\nproperty float x\nproperty float y\n\
          property float z\nelement face 10000000\nproperty list uchar int vertex_indices\nend_header\n",
    )
    .unwrap();
    file.set_len(200_000_000).unwrap();
    says(
        &read(&path).unwrap_err().to_string(),
        &["10000000", &limit, "decimate"],
    );
    let path = folder.path().join("a.obj");
    let mut file = File::create(&path).unwrap();
    file.write_all(b"# large\n").unwrap();
    file.set_len(700_000_000).unwrap();
    says(
        &read(&path).unwrap_err().to_string(),
        &["700000000 bytes", "decimate"],
    );
}

#[test]
fn an_obj_with_too_many_triangles_stops_at_the_limit() {
    let mut text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_vec();
    text.extend(b"f 1 2 3\n".repeat(MAX_TRIANGLES + 10));
    let message = read_bytes(Format::Obj, "scan", &text, &())
        .unwrap_err()
        .to_string();
    says(&message, &["line 4000004", "4000000", "decimate"]);
}

#[test]
fn a_flat_line_of_triangles_has_no_area() {
    let mut scan = shapes::head();
    for p in &mut scan.positions {
        *p = glam::vec3(p.x, 0.0, 0.0);
    }
    says(
        &tidy(scan.clone()).unwrap_err().to_string(),
        &["area of zero"],
    );
    scan.positions.fill(glam::Vec3::ONE);
    says(&tidy(scan).unwrap_err().to_string(), &["area of zero"]);
}

#[test]
fn compressed_and_old_gltf_is_said_to_be_unsupported() {
    let draco =
        r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]}"#;
    says(
        &message("a.glb", &writers::container(draco, &[])),
        &["KHR_draco", "without compression"],
    );
    says(
        &message("a.gltf", br#"{"asset":{"version":"1.0"}}"#),
        &["version", "2.0"],
    );
}
