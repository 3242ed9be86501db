//! Colours of scans: of vertices and of pictures, inside the file and beside it.

use glam::{Vec2, vec2};
use mouthpiece_shop::mesh::{Format, Image, Scan, ScanColour, read, read_bytes};

use crate::shapes;
use crate::writers::{self, Extra, Ply};

fn some_colours(scan: &Scan) -> Vec<[u8; 3]> {
    (0..scan.positions.len())
        .map(|i| [i as u8, (i / 7) as u8, 255 - i as u8])
        .collect()
}

/// Left half red, right half green, upper row brighter.
fn picture() -> Image {
    let rgb = vec![255, 0, 0, 0, 255, 0, 100, 0, 0, 0, 100, 0];
    Image {
        width: 2,
        height: 2,
        rgb,
    }
}

/// The pixel of a texture at `uv`.
fn pixel(colour: &ScanColour, uv: Vec2) -> [u8; 3] {
    let ScanColour::Texture { image, .. } = colour else {
        panic!("no texture: {colour:?}")
    };
    let x = (uv.x * image.width as f32) as usize;
    let y = (uv.y * image.height as f32) as usize;
    let at = (y * image.width as usize + x) * 3;
    [image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]]
}

fn uvs(colour: &ScanColour) -> &[[Vec2; 3]] {
    let ScanColour::Texture { uvs, .. } = colour else {
        panic!("no texture: {colour:?}")
    };
    uvs
}

#[test]
fn vertex_colours_come_with_ply_obj_and_glb() {
    let scan = shapes::head();
    let colours = some_colours(&scan);
    let expected = Some(ScanColour::PerVertex(colours.clone()));
    for kind in [Ply::Text, Ply::Little, Ply::Big] {
        let bytes = writers::ply(&scan, kind, false, Some(&colours));
        let read = read_bytes(Format::Ply, "scan", &bytes, &()).unwrap().scan;
        assert_eq!(read.colour, expected);
    }
    let extra = Extra {
        colours: Some(colours.clone()),
        ..Extra::default()
    };
    let read = read_bytes(Format::Glb, "scan", &writers::glb(&scan, &extra), &())
        .unwrap()
        .scan;
    assert_eq!(read.colour, expected);
    for scale in [1.0, 255.0] {
        let text = String::from_utf8(writers::obj(&scan)).unwrap();
        let mut colour = colours.iter();
        let lines: Vec<String> = text
            .lines()
            .map(|line| match line.starts_with("v ") {
                true => {
                    let c = colour.next().unwrap().map(|c| f64::from(c) / 255.0 * scale);
                    format!("{line} {} {} {}", c[0], c[1], c[2])
                }
                false => line.to_owned(),
            })
            .collect();
        let bytes = lines.join("\n").into_bytes();
        let read = read_bytes(Format::Obj, "scan", &bytes, &()).unwrap().scan;
        assert_eq!(read.colour, expected);
    }
}

#[test]
fn a_glb_texture_is_read_with_v_downwards() {
    let scan = shapes::head();
    let at = vec![[0.25, 0.25]; scan.positions.len()];
    let extra = Extra {
        texture: Some((writers::png(&picture()), at)),
        ..Extra::default()
    };
    let read = read_bytes(Format::Glb, "scan", &writers::glb(&scan, &extra), &())
        .unwrap()
        .scan;
    let colour = read.colour.unwrap();
    assert_eq!(uvs(&colour).len(), scan.triangles.len());
    assert_eq!(pixel(&colour, uvs(&colour)[0][0]), [255, 0, 0]);
}

/// An OBJ with two pictures, a plain material and coordinates that repeat.
fn textured_obj(folder: &std::path::Path) -> std::path::PathBuf {
    let scan = shapes::head();
    let text = String::from_utf8(writers::obj(&scan)).unwrap();
    let mut out =
        String::from("mtllib my materials.mtl\nvt 0.75 0.75\nvt 3.25 -0.75\nusemtl first\n");
    for (i, line) in text.lines().enumerate() {
        if i == 5000 {
            out += "usemtl second one\n";
        }
        if i == 6000 {
            out += "usemtl plain\n";
        }
        match line.strip_prefix("f ") {
            Some(corners) => {
                let vt = if i < 5500 { 1 } else { 2 };
                let corner = |c: &str| format!("{c}/{vt}/1");
                let corners: Vec<String> = corners.split(' ').map(corner).collect();
                out += &format!("f {}\n", corners.join(" "));
            }
            None => out += &format!("{line}\n"),
        }
    }
    let materials = "newmtl first\nmap_Kd -s 1 1 1 a.png\n\nnewmtl second one\n\tKd 1 1 1\n\
         \tmap_Kd C:\\scans\\b c.png\nnewmtl plain\nKd 0 0 1\n";
    std::fs::write(folder.join("my materials.mtl"), materials).unwrap();
    std::fs::write(folder.join("a.png"), writers::png(&picture())).unwrap();
    let wide = Image {
        width: 8,
        height: 1,
        rgb: [9, 8, 7].repeat(8),
    };
    std::fs::write(folder.join("b c.png"), writers::png(&wide)).unwrap();
    let path = folder.join("scan.obj");
    std::fs::write(&path, out).unwrap();
    path
}

#[test]
fn obj_materials_become_one_picture() {
    let folder = tempfile::tempdir().unwrap();
    let reading = read(textured_obj(folder.path())).unwrap();
    assert!(reading.notes.is_empty(), "{:?}", reading.notes);
    let colour = reading.scan.colour.unwrap();
    let uvs = uvs(&colour);
    // OBJ's v grows upwards: (0.75, 0.75) is the upper right, green.
    assert_eq!(pixel(&colour, uvs[0][1]), [0, 255, 0]);
    assert!(uvs.iter().any(|uv| pixel(&colour, uv[0]) == [9, 8, 7]));
    assert_eq!(pixel(&colour, uvs[uvs.len() - 1][2]), [0, 0, 255]);
}

#[test]
fn a_missing_picture_costs_the_colour_and_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = textured_obj(folder.path());
    std::fs::remove_file(folder.path().join("a.png")).unwrap();
    std::fs::remove_file(folder.path().join("b c.png")).unwrap();
    let reading = read(path).unwrap();
    assert_eq!(reading.scan.colour, None);
    assert!(
        reading.notes.iter().any(|n| n.contains("a.png")),
        "{:?}",
        reading.notes
    );
}

#[test]
fn a_broken_picture_is_an_error_that_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = textured_obj(folder.path());
    for bytes in [
        b"GIF89a".to_vec(),
        b"\x89PNG\r\n\x1a\n".to_vec(),
        vec![0xff, 0xd8, 0xff, 0xe0],
    ] {
        std::fs::write(folder.path().join("a.png"), bytes).unwrap();
        let message = read(&path).unwrap_err().to_string();
        assert!(
            message.contains("a.png") && message.contains("PNG or JPEG"),
            "{message}"
        );
    }
}

#[test]
fn a_ply_of_meshlab_has_its_picture_per_corner() {
    let scan = shapes::head();
    let mut text = format!(
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\n\
         property list uchar float texcoord\nproperty int texnumber\nend_header\n",
        scan.positions.len(),
        scan.triangles.len()
    );
    for p in &scan.positions {
        text += &format!("{} {} {}\n", p.x, p.y, p.z);
    }
    for [a, b, c] in &scan.triangles {
        text += &format!("3 {a} {b} {c} 6 0.25 0.25 0.75 0.25 0.75 0.75 0\n");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.png"), writers::png(&picture())).unwrap();
    let path = folder.path().join("scan.ply");
    std::fs::write(&path, text).unwrap();
    let colour = Scan::read(&path).unwrap().colour.unwrap();
    let [a, b, c] = uvs(&colour)[0];
    let expected = [[100, 0, 0], [0, 100, 0], [0, 255, 0]];
    assert_eq!([a, b, c].map(|uv| pixel(&colour, uv)), expected);
    assert_eq!(a, vec2(0.25, 0.75));
}

/// 16 x 8 pixels of one colour.
const JPEG: &[u8] = include_bytes!("one_colour.jpg");

#[test]
fn jpeg_textures_are_read() {
    let scan = shapes::head();
    let at = vec![[0.5, 0.5]; scan.positions.len()];
    let extra = Extra {
        texture: Some((JPEG.to_vec(), at)),
        ..Extra::default()
    };
    let read = read_bytes(Format::Glb, "scan", &writers::glb(&scan, &extra), &())
        .unwrap()
        .scan;
    let colour = read.colour.unwrap();
    let [r, g, b] = pixel(&colour, uvs(&colour)[0][0]);
    assert!(
        r.abs_diff(180) < 4 && g.abs_diff(120) < 4 && b.abs_diff(90) < 4,
        "{r} {g} {b}"
    );
}
