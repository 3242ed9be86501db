//! Bytes that nobody meant as a scan: an error or a sound scan, never a panic, never memory without end.

use glam::Vec2;
use mouthpiece_shop::landmarks::Landmarks;
use mouthpiece_shop::mesh::{Format, Scan, ScanColour, read_bytes, tidy};
use proptest::prelude::*;

use crate::shapes;
use crate::writers::{self, Extra, Ply};

const FORMATS: [Format; 4] = [Format::Obj, Format::Ply, Format::Stl, Format::Glb];

/// What every scan that a reader lets through keeps.
fn sound(scan: &Scan) {
    let count = scan.positions.len();
    assert!(scan.positions.iter().all(|p| p.is_finite()));
    assert!(
        scan.triangles
            .iter()
            .flatten()
            .all(|&i| (i as usize) < count)
    );
    match &scan.colour {
        None => {}
        Some(ScanColour::PerVertex(colours)) => assert_eq!(colours.len(), count),
        Some(ScanColour::Texture { image, uvs }) => {
            assert_eq!(uvs.len(), scan.triangles.len());
            assert_eq!(
                image.rgb.len(),
                image.width as usize * image.height as usize * 3
            );
            let inside = |uv: &Vec2| uv.min_element() >= 0.0 && uv.max_element() <= 1.0;
            assert!(uvs.iter().flatten().all(inside));
        }
    }
}

fn check(format: Format, bytes: &[u8]) {
    match read_bytes(format, "scan", bytes, &()) {
        Ok(reading) => {
            sound(&reading.scan);
            if let Ok((scan, _)) = tidy(reading.scan) {
                sound(&scan);
            }
        }
        Err(error) => {
            let message = error.to_string();
            assert!(
                message.starts_with("scan") && message.len() < 500,
                "{message}"
            );
        }
    }
}

/// Small valid files, to be damaged.
fn valid() -> Vec<(Format, Vec<u8>)> {
    let head = shapes::head();
    let some = Scan {
        positions: head.positions.clone(),
        triangles: head.triangles[..120].to_vec(),
        colour: None,
    };
    let (small, _) = tidy(some).unwrap();
    let uvs = vec![[0.5, 0.5]; small.positions.len()];
    let image = mouthpiece_shop::mesh::Image {
        width: 2,
        height: 1,
        rgb: vec![7; 6],
    };
    let extra = Extra {
        texture: Some((writers::png(&image), uvs)),
        node: r#""translation":[1,2,3]"#.to_owned(),
        colours: Some(vec![[1, 2, 3]; small.positions.len()]),
    };
    vec![
        (Format::Obj, writers::obj(&small)),
        (Format::Ply, writers::ply(&small, Ply::Text, false, None)),
        (Format::Ply, writers::ply(&small, Ply::Little, true, None)),
        (Format::Ply, writers::ply(&small, Ply::Big, false, None)),
        (Format::Stl, writers::stl(&small)),
        (Format::Stl, writers::stl_text(&small)),
        (Format::Glb, writers::glb(&small, &extra)),
    ]
}

proptest! {
    #[test]
    fn any_bytes_are_survived(
        format in prop::sample::select(FORMATS.to_vec()),
        start in prop::sample::select(vec![
            &b""[..], b"glTF\x02\0\0\0", b"ply\n", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n",
            b"solid \n", b"v 1 2 3\n", b"{\"asset\":{\"version\":\"2.0\"},",
        ]),
        rest in prop::collection::vec(any::<u8>(), 0..400),
    ) {
        check(format, &[start, &rest].concat());
    }

    #[test]
    fn any_words_are_survived(
        format in prop::sample::select(FORMATS.to_vec()),
        text in "((v|vt|f|usemtl|mtllib|element|property|list|face|vertex|facet|-1|0|1|2/3|1e999|nan|end_header|ply|\\\\)[ \n]){0,60}",
    ) {
        check(format, text.as_bytes());
    }

    #[test]
    fn damaged_files_are_survived(
        which in 0usize..7,
        cut in 0.0..1.3f64,
        wounds in prop::collection::vec((0.0..1.0f64, any::<u8>()), 0..6),
        early: bool,
    ) {
        let (format, mut bytes) = valid().swap_remove(which);
        bytes.truncate((bytes.len() as f64 * cut) as usize);
        // Headers are small against bodies: half of the cases damage only them.
        let reach = if early { bytes.len().min(900) } else { bytes.len() };
        for (place, value) in wounds {
            if let Some(byte) = bytes.get_mut((place * reach as f64) as usize) {
                *byte = value;
            }
        }
        check(format, &bytes);
    }

    #[test]
    fn any_text_as_landmarks_is_survived(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Err(error) = Landmarks::parse(&bytes) {
            prop_assert!(error.to_string().contains("\"unit\""));
        }
    }
}

#[test]
fn headers_that_promise_the_world_cost_nothing() {
    let promise = |kind: &str| {
        format!(
            "ply\nformat {kind} 1.0\nelement vertex 4000000\nproperty double x\nproperty double y\n\
             property double z\nelement face 4000000\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    for kind in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let message = read_bytes(Format::Ply, "scan", promise(kind).as_bytes(), &()).unwrap_err();
        assert!(message.to_string().contains("cut short"), "{message}");
    }
    let json = r#"{"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"componentType":5126,"count":4000000,"type":"VEC3","bufferView":0}],
        "bufferViews":[{"buffer":0,"byteLength":4}],"buffers":[{"byteLength":4}]}"#;
    let bytes = writers::container(json, &[0; 4]);
    let message = read_bytes(Format::Glb, "scan", &bytes, &())
        .unwrap_err()
        .to_string();
    assert!(message.contains("cut short"), "{message}");
}

#[test]
fn nodes_in_a_circle_are_refused() {
    let json = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],
        "nodes":[{"children":[1]},{"children":[0]}]}"#;
    let bytes = writers::container(json, &[]);
    let message = read_bytes(Format::Glb, "scan", &bytes, &())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("hangs on two nodes or on itself"),
        "{message}"
    );
}
