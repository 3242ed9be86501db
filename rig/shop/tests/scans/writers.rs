//! Writers of the formats that the product only reads, for tests; each writes what the format allows,
//! not only what is usual.

use std::fmt::Write;
use std::io::Cursor;

use glam::Vec3;
use mouthpiece_shop::mesh::{Image, Scan};

pub(crate) fn obj(scan: &Scan) -> Vec<u8> {
    let mut text = String::from("# a scan\no head\n");
    for p in &scan.positions {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    for t in &scan.triangles {
        let [a, b, c] = t.map(|i| i + 1);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text.into_bytes()
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Ply {
    Text,
    Little,
    Big,
}

/// With foreign properties before, between and after; `double` coordinates where asked.
pub(crate) fn ply(scan: &Scan, kind: Ply, double: bool, colours: Option<&[[u8; 3]]>) -> Vec<u8> {
    let format = match kind {
        Ply::Text => "ascii",
        Ply::Little => "binary_little_endian",
        Ply::Big => "binary_big_endian",
    };
    let real = if double { "double" } else { "float" };
    let mut out = format!("ply\nformat {format} 1.0\ncomment made for a test\n");
    writeln!(out, "element note 2\nproperty short size").unwrap();
    writeln!(out, "element vertex {}", scan.positions.len()).unwrap();
    writeln!(
        out,
        "property list uchar ushort links\nproperty {real} z\nproperty {real} y"
    )
    .unwrap();
    if colours.is_some() {
        out +=
            "property uchar green\nproperty uchar red\nproperty uchar alpha\nproperty uchar blue\n";
    }
    writeln!(out, "property {real} x\nproperty int quality").unwrap();
    writeln!(
        out,
        "element face {}\nproperty uchar flags",
        scan.triangles.len()
    )
    .unwrap();
    out += "property list ushort uint vertex_indices\nend_header\n";
    let mut body = Body {
        out: out.into_bytes(),
        kind,
    };
    body.put(&7i16.to_le_bytes(), "7");
    body.put(&(-7i16).to_le_bytes(), "-7");
    body.end();
    for (i, p) in scan.positions.iter().enumerate() {
        body.put(&[2], "2");
        body.put(&5u16.to_le_bytes(), "5");
        body.put(&6u16.to_le_bytes(), "6");
        body.real(p.z, double);
        body.real(p.y, double);
        if let Some(colours) = colours {
            let [r, g, b] = colours[i];
            for channel in [g, r, 9, b] {
                body.put(&[channel], &channel.to_string());
            }
        }
        body.real(p.x, double);
        body.put(&(-1i32).to_le_bytes(), "-1");
        body.end();
    }
    for t in &scan.triangles {
        body.put(&[1], "1");
        body.put(&3u16.to_le_bytes(), "3");
        for i in t {
            body.put(&i.to_le_bytes(), &i.to_string());
        }
        body.end();
    }
    body.out
}

struct Body {
    out: Vec<u8>,
    kind: Ply,
}

impl Body {
    fn put(&mut self, little: &[u8], text: &str) {
        match self.kind {
            Ply::Text => self.out.extend(format!("{text} ").bytes()),
            Ply::Little => self.out.extend(little),
            Ply::Big => self.out.extend(little.iter().rev()),
        }
    }

    fn real(&mut self, value: f32, double: bool) {
        match double {
            true => self.put(&f64::from(value).to_le_bytes(), &value.to_string()),
            false => self.put(&value.to_le_bytes(), &value.to_string()),
        }
    }

    fn end(&mut self) {
        if matches!(self.kind, Ply::Text) {
            self.out.push(b'\n');
        }
    }
}

pub(crate) fn stl(scan: &Scan) -> Vec<u8> {
    let mut out = b"solid in name only".to_vec();
    out.resize(80, b' ');
    out.extend((scan.triangles.len() as u32).to_le_bytes());
    for t in &scan.triangles {
        out.extend([0; 12]);
        for i in t {
            out.extend(
                scan.positions[*i as usize]
                    .to_array()
                    .iter()
                    .flat_map(|c| c.to_le_bytes()),
            );
        }
        out.extend([0; 2]);
    }
    out
}

pub(crate) fn stl_text(scan: &Scan) -> Vec<u8> {
    let mut out = String::from("solid head\r\n");
    for t in &scan.triangles {
        out += "  facet normal 0 0 0\r\n    outer loop\r\n";
        for i in t {
            let p = scan.positions[*i as usize];
            write!(out, "      vertex {} {} {:e}\r\n", p.x, p.y, p.z).unwrap();
        }
        out += "    endloop\r\n  endfacet\r\n";
    }
    out += "endsolid head\r\n";
    out.into_bytes()
}

/// What a GLB holds besides the triangles.
#[derive(Default)]
pub(crate) struct Extra {
    /// JSON members of the node.
    pub(crate) node: String,
    pub(crate) colours: Option<Vec<[u8; 3]>>,
    /// A PNG and one coordinate per vertex.
    pub(crate) texture: Option<(Vec<u8>, Vec<[f32; 2]>)>,
}

pub(crate) fn glb(scan: &Scan, extra: &Extra) -> Vec<u8> {
    let (mut bin, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
    let mut add = |bytes: Vec<u8>, accessor: Option<(u32, usize, &str)>| {
        let view = views.len();
        views.push(format!(
            r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#,
            bin.len(),
            bytes.len()
        ));
        bin.extend(bytes);
        bin.resize(bin.len().next_multiple_of(4), 0);
        if let Some((kind, count, shape)) = accessor {
            accessors.push(format!(
                r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"{shape}","normalized":{}}}"#,
                kind == 5121
            ));
        }
        view
    };
    let n = scan.positions.len();
    let floats = |v: &[f32]| v.iter().flat_map(|c| c.to_le_bytes()).collect::<Vec<u8>>();
    let positions: Vec<f32> = scan.positions.iter().flat_map(Vec3::to_array).collect();
    add(floats(&positions), Some((5126, n, "VEC3")));
    let indices = scan
        .triangles
        .iter()
        .flatten()
        .flat_map(|i| i.to_le_bytes())
        .collect();
    add(indices, Some((5125, scan.triangles.len() * 3, "SCALAR")));
    let mut attributes = r#""POSITION":0"#.to_owned();
    let mut next = 2;
    let mut materials = String::new();
    if let Some(colours) = &extra.colours {
        let bytes = colours
            .iter()
            .flat_map(|&[r, g, b]| [r, g, b, 255])
            .collect();
        add(bytes, Some((5121, n, "VEC4")));
        write!(attributes, r#","COLOR_0":{next}"#).unwrap();
        next += 1;
    }
    if let Some((png, uvs)) = &extra.texture {
        add(floats(uvs.as_flattened()), Some((5126, n, "VEC2")));
        write!(attributes, r#","TEXCOORD_0":{next}"#).unwrap();
        let view = add(png.clone(), None);
        materials = format!(
            r#""materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
            "textures":[{{"source":0}}],"images":[{{"bufferView":{view},"mimeType":"image/png"}}],"#
        );
    }
    let material = if materials.is_empty() {
        ""
    } else {
        r#","material":0"#
    };
    let node = if extra.node.is_empty() {
        String::new()
    } else {
        format!(",{}", extra.node)
    };
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"primitives":[{{"attributes":{{{attributes}}},"indices":1{material}}}]}}],{materials}
        "accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#,
        accessors.join(","),
        views.join(","),
        bin.len()
    );
    container(&json, &bin)
}

/// A GLB of these chunks.
pub(crate) fn container(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + 8 + bin.len();
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((total as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_slice()), (b"BIN\0", bin)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

pub(crate) fn png(image: &Image) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    let mut encoder = png::Encoder::new(&mut out, image.width, image.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
        .write_header()
        .unwrap()
        .write_image_data(&image.rgb)
        .unwrap();
    out.into_inner()
}
