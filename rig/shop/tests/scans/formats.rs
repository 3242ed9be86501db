//! What is written is read, in every format and however much of it a file uses.

use glam::{DMat4, DQuat, DVec3, Vec3};
use mouthpiece_shop::mesh::{Format, MIN_TRIANGLES, Reading, Scan, read, read_bytes};
use proptest::prelude::*;

use crate::shapes;
use crate::writers::{self, Extra, Ply};

fn parse(format: Format, bytes: &[u8]) -> Reading {
    read_bytes(format, "scan", bytes, &()).unwrap()
}

/// Any triangles over any points, large enough to pass for a scan.
fn scans() -> impl Strategy<Value = Scan> {
    let point = prop::array::uniform3(-1e4..1e4f32).prop_map(Vec3::from_array);
    prop::collection::vec(point, 40..120).prop_flat_map(|positions| {
        let count = positions.len() as u32;
        let triangle = prop::array::uniform3(0..count);
        (
            Just(positions),
            prop::collection::vec(triangle, MIN_TRIANGLES..200),
        )
            .prop_map(|(positions, triangles)| Scan {
                positions,
                triangles,
                colour: None,
            })
    })
}

/// The corners in order: what stays of a mesh whose vertices were joined.
fn corners(scan: &Scan) -> Vec<[Vec3; 3]> {
    scan.triangles
        .iter()
        .map(|t| t.map(|i| scan.positions[i as usize]))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn obj_comes_back(scan in scans()) {
        prop_assert_eq!(parse(Format::Obj, &writers::obj(&scan)).scan, scan);
    }

    #[test]
    fn ply_comes_back_in_every_dress(
        scan in scans(),
        kind in prop::sample::select(vec![Ply::Text, Ply::Little, Ply::Big]),
        double: bool,
    ) {
        prop_assert_eq!(parse(Format::Ply, &writers::ply(&scan, kind, double, None)).scan, scan);
    }

    #[test]
    fn stl_comes_back_with_its_corners_joined(scan in scans()) {
        for bytes in [writers::stl(&scan), writers::stl_text(&scan)] {
            let read = parse(Format::Stl, &bytes).scan;
            prop_assert_eq!(corners(&read), corners(&scan));
            prop_assert!(read.positions.len() <= scan.positions.len());
        }
    }

    #[test]
    fn glb_comes_back_where_its_node_puts_it(
        scan in scans(),
        turn in prop::array::uniform4(-1.0..1.0f64),
        shift in prop::array::uniform3(-100.0..100.0f64),
        scale in prop::array::uniform3(0.1..3.0f64),
    ) {
        let length = DQuat::from_array(turn).length();
        prop_assume!(length > 0.1);
        let turn = DQuat::from_array(turn) / length;
        let node = format!(
            r#""rotation":{:?},"translation":{shift:?},"scale":{scale:?}"#, turn.to_array()
        );
        let read = parse(Format::Glb, &writers::glb(&scan, &Extra { node, ..Extra::default() })).scan;
        let place = DMat4::from_scale_rotation_translation(
            DVec3::from_array(scale), turn, DVec3::from_array(shift));
        prop_assert_eq!(&read.triangles, &scan.triangles);
        for (&a, &b) in read.positions.iter().zip(&scan.positions) {
            prop_assert!((a.as_dvec3() - place.transform_point3(b.as_dvec3())).length() < 0.01);
        }
    }
}

#[test]
fn a_mirroring_node_turns_the_triangles() {
    let scan = shapes::head();
    let node = r#""matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]"#.to_owned();
    let read = parse(
        Format::Glb,
        &writers::glb(
            &scan,
            &Extra {
                node,
                ..Extra::default()
            },
        ),
    )
    .scan;
    assert_eq!(read.positions[5].x, -scan.positions[5].x);
    let [a, b, c] = scan.triangles[0];
    assert_eq!(read.triangles[0], [a, c, b]);
}

#[test]
fn gltf_reads_with_its_buffer_inside_and_beside() {
    use base64::Engine;
    let scan = shapes::head();
    let bytes = writers::glb(&scan, &Extra::default());
    let json_length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json = std::str::from_utf8(&bytes[20..20 + json_length]).unwrap();
    let bin = &bytes[28 + json_length..];
    let data = base64::engine::general_purpose::STANDARD.encode(bin);
    let inside = json.replace(
        r#""buffers":[{"#,
        &format!(r#""buffers":[{{"uri":"data:application/octet-stream;base64,{data}","#),
    );
    assert_eq!(parse(Format::Glb, inside.as_bytes()).scan, scan);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.gltf");
    std::fs::write(folder.path().join("a b.bin"), bin).unwrap();
    let beside = json.replace(r#""buffers":[{"#, r#""buffers":[{"uri":"a%20b.bin","#);
    std::fs::write(&path, beside).unwrap();
    assert_eq!(Scan::read(&path).unwrap(), scan);
}

/// A head as OBJ with its first lines replaced by what `dress` makes of the quads.
fn grid(faces: impl Fn(u32, u32, u32, u32) -> String) -> Vec<u8> {
    const SIDE: u32 = 12;
    let mut text = String::new();
    for i in 0..SIDE {
        for j in 0..SIDE {
            text += &format!("v {i} {j} 0\n");
        }
    }
    for i in 0..SIDE - 1 {
        for j in 0..SIDE - 1 {
            let a = i * SIDE + j + 1;
            text += &faces(a, a + SIDE, a + SIDE + 1, a + 1);
        }
    }
    text.into_bytes()
}

fn area(scan: &Scan) -> f32 {
    corners(scan)
        .iter()
        .map(|[a, b, c]| (*b - *a).cross(*c - *a).z / 2.0)
        .sum()
}

#[test]
fn obj_quads_negative_indices_and_normals_without_texture_read() {
    let quads = parse(
        Format::Obj,
        &grid(|a, b, c, d| format!("f {a}//1 {b}//1 {c}//1 {d}//1\n")),
    );
    assert_eq!(quads.scan.triangles.len(), 242);
    assert!((area(&quads.scan) - 121.0).abs() < 1e-3);
    let back = |i: u32| i64::from(i) - 145;
    let negative =
        grid(|a, b, c, d| format!("f {} {} {} \\\n {}\n", back(a), back(b), back(c), back(d)));
    assert_eq!(parse(Format::Obj, &negative).scan, quads.scan);
}

#[test]
fn obj_faces_may_come_before_their_vertices() {
    let text = String::from_utf8(grid(|a, b, c, d| format!("f {a} {b} {c} {d}\n"))).unwrap();
    let (vertices, faces): (Vec<_>, Vec<_>) = text.lines().partition(|l| l.starts_with('v'));
    let turned = [faces, vertices].concat().join("\r");
    let straight = parse(Format::Obj, text.as_bytes());
    assert_eq!(parse(Format::Obj, turned.as_bytes()), straight);
}

#[test]
fn a_dented_polygon_keeps_its_dent() {
    // A star with ten corners, far from the grid; its area is known by the shoelace formula.
    let mut text = String::from_utf8(grid(|a, b, c, d| format!("f {a} {b} {c} {d}\n"))).unwrap();
    let mut ring = Vec::new();
    for i in 0..10u8 {
        let radius = if i % 2 == 0 { 10.0 } else { 3.0 };
        let (y, x) = (f32::from(i) * std::f32::consts::PI / 5.0).sin_cos();
        ring.push((100.0 + radius * x, radius * y));
        text += &format!("v {} {} 0\n", 100.0 + radius * x, radius * y);
    }
    text += "f -10 -9 -8 -7 -6 -5 -4 -3 -2 -1\n";
    // And a dented quad, whose one diagonal runs outside.
    text += "v 200 0 0\nv 210 0 0\nv 203 3 0\nv 200 10 0\nf -4 -3 -2 -1\n";
    let scan = parse(Format::Obj, text.as_bytes()).scan;
    let shoelace: f32 = (0..10)
        .map(|i| {
            let ((a, b), (c, d)) = (ring[i], ring[(i + 1) % 10]);
            (a * d - c * b) / 2.0
        })
        .sum();
    assert!((area(&scan) - 121.0 - shoelace - 30.0).abs() < 0.01);
    let all_up = corners(&scan)
        .iter()
        .all(|[a, b, c]| (*b - *a).cross(*c - *a).z > 0.0);
    assert!(all_up, "no triangle may lie over the dent");
}

#[test]
fn content_rules_where_the_ending_is_wrong() {
    let scan = shapes::head();
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [
        ("a.obj", writers::glb(&scan, &Extra::default())),
        ("b.stl", writers::ply(&scan, Ply::Big, false, None)),
        ("c.OBJ", writers::obj(&scan)),
        ("d", writers::ply(&scan, Ply::Text, true, None)),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(read(&path).unwrap().scan, scan, "{name}");
    }
}
