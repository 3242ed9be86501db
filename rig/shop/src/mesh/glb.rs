//! glTF 2.0, as GLB or as JSON with its buffers inside or beside it: all triangle meshes of the
//! scene, where their nodes put them, with `COLOR_0` and the base colour's texture. Morph targets,
//! skins and animations are not applied. Of a head that Mouthpiece wrote only the skin is taken.

use std::borrow::Cow;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DMat4, DQuat, DVec3, Vec2, vec2};

use super::Side;
use super::builder::{Builder, byte};
use super::error::{Fault, Found};
use super::gltf::{Document, Loaded, Node, Primitive, entry};
use super::picture::Material;

pub(crate) fn read(bytes: &[u8], side: &dyn Side) -> Result<Builder, Found> {
    let (json, binary) = if bytes.starts_with(b"glTF") {
        chunks(bytes)?
    } else {
        (bytes, None)
    };
    let document: Document = serde_json::from_slice(json).map_err(|e| {
        let why = format!("its JSON is faulty ({})", cut(&e.to_string(), 200));
        Fault::NotThis {
            format: "glTF",
            why,
        }
    })?;
    if !document.asset.version.starts_with("2.") {
        let why = format!(
            "its version is `{}`, and 2.0 is read",
            short(&document.asset.version)
        );
        return Err(Fault::NotThis {
            format: "glTF",
            why,
        }
        .into());
    }
    for extension in &document.extensions_required {
        if extension.contains("compression") {
            let found = format!("the compression {}", short(extension));
            let mend = "export the scan without compression";
            return Err(Fault::Unsupported { found, mend }.into());
        }
    }
    let buffers = buffers(&document, binary, side)?;
    let mut reader = Reader {
        gltf: Loaded { document, buffers },
        out: Builder::default(),
        side,
    };
    reader.materials()?;
    reader.scene()?;
    Ok(reader.out)
}

/// The JSON chunk and the binary one.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Found> {
    let word = |at: usize| {
        let word = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes(word.try_into().ok()?))
    };
    let cut = |at| Found::byte(at, Fault::Truncated("a chunk"));
    if let Some(version) = word(4).filter(|&v| v != 2) {
        let why = format!("its version is {version}, and 2 is read");
        return Err(Found::byte(4, Fault::NotThis { format: "GLB", why }));
    }
    let (mut json, mut binary) = (None, None);
    let mut at = 12;
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let end = (at + 8)
            .checked_add(length as usize)
            .ok_or_else(|| cut(at))?;
        let chunk = bytes.get(at + 8..end).ok_or_else(|| cut(bytes.len()))?;
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at = end;
    }
    Ok((json.ok_or_else(|| cut(bytes.len()))?, binary))
}

fn buffers<'a>(
    document: &Document,
    binary: Option<&'a [u8]>,
    side: &dyn Side,
) -> Result<Vec<Cow<'a, [u8]>>, Fault> {
    let mut buffers = Vec::new();
    for (i, buffer) in document.buffers.iter().enumerate() {
        buffers.push(match (&buffer.uri, binary) {
            (Some(uri), _) => Cow::Owned(open(uri, side)?.ok_or_else(|| Fault::Unsupported {
                found: format!("a scan without its data ({})", short(uri)),
                mend: "put that file beside the scan, or export as GLB, which is one file",
            })?),
            (None, Some(binary)) if i == 0 => Cow::Borrowed(binary),
            (None, _) => return Err(Fault::Truncated("its binary data")),
        });
    }
    Ok(buffers)
}

/// What a file says, for a message.
fn short(text: &str) -> String {
    cut(text, 60)
}

fn cut(text: &str, longest: usize) -> String {
    text.chars()
        .filter(|c| !c.is_control())
        .take(longest)
        .collect()
}

/// What a URI means: data inside it, or a file beside the scan.
fn open(uri: &str, side: &dyn Side) -> Result<Option<Vec<u8>>, Fault> {
    let Some(data) = uri.strip_prefix("data:") else {
        return Ok(side.open(&percent(uri)));
    };
    let bytes = data
        .split_once(";base64,")
        .and_then(|(_, text)| STANDARD.decode(text).ok());
    match bytes {
        Some(bytes) => Ok(Some(bytes)),
        None => Err(Fault::Unsupported {
            found: format!("the data URI {}", short(uri)),
            mend: "export the scan as GLB",
        }),
    }
}

/// `%20` and its like as the characters that they stand for.
fn percent(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| first == b'%');
        let code = code.and_then(|c| u8::from_str_radix(std::str::from_utf8(c).ok()?, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

struct Reader<'a> {
    gltf: Loaded<'a>,
    out: Builder,
    side: &'a dyn Side,
}

impl Reader<'_> {
    fn materials(&mut self) -> Result<(), Fault> {
        for material in &self.gltf.document.materials {
            let surface = &material.pbr_metallic_roughness;
            let texture = surface.base_color_texture.as_ref();
            let texture = texture.map(|t| entry(&self.gltf.document.textures, t.index, "texture"));
            let picture = match texture.transpose()?.and_then(|t| t.source) {
                Some(source) => picture(&self.gltf, source, &mut self.out, self.side)?,
                None => None,
            };
            let [r, g, b, _] = surface.base_color_factor.unwrap_or([0.8; 4]);
            self.out.materials.push(Material {
                picture,
                solid: [r, g, b].map(|c| byte(encode(c))),
            });
        }
        // Primitives without a material.
        self.out.materials.push(Material::default());
        Ok(())
    }

    fn scene(&mut self) -> Result<(), Fault> {
        let nodes = &self.gltf.document.nodes;
        let named = |name: &str| nodes.iter().any(|n| n.name == name);
        let head = named("skin") && named("skull") && named("mandible");
        if head {
            self.out
                .note("this is a head file, so its skin was taken for the scan".to_owned());
        }
        for (mesh, place) in self.placed(head)? {
            self.mesh(mesh, place)?;
        }
        Ok(())
    }

    /// Meshes of the scene with their places; of a head file only those of the skin.
    fn placed(&self, head: bool) -> Result<Vec<(usize, DMat4)>, Fault> {
        let document = &self.gltf.document;
        let nodes = &document.nodes;
        if nodes.is_empty() {
            return Ok((0..document.meshes.len())
                .map(|m| (m, DMat4::IDENTITY))
                .collect());
        }
        let roots = match document.scenes.get(document.scene.unwrap_or(0)) {
            Some(scene) => scene.nodes.clone(),
            None => {
                let mut child = vec![false; nodes.len()];
                for &c in nodes.iter().flat_map(|n| &n.children) {
                    if let Some(child) = child.get_mut(c) {
                        *child = true;
                    }
                }
                (0..nodes.len()).filter(|&n| !child[n]).collect()
            }
        };
        let mut seen = vec![false; nodes.len()];
        let mut open: Vec<(usize, DMat4)> = roots.iter().map(|&n| (n, DMat4::IDENTITY)).collect();
        let mut found = Vec::new();
        while let Some((index, parent)) = open.pop() {
            let node = entry(nodes, index, "node")?;
            if std::mem::replace(&mut seen[index], true) {
                let why = format!("node {index} hangs on two nodes or on itself");
                return Err(Fault::NotThis {
                    format: "glTF",
                    why,
                });
            }
            let place = parent * local(node);
            open.extend(node.children.iter().map(|&child| (child, place)));
            if let Some(mesh) = node.mesh.filter(|_| !head || node.name == "skin") {
                found.push((mesh, place));
            }
        }
        // The order of the file, whatever order they were found in.
        found.reverse();
        Ok(found)
    }

    fn mesh(&mut self, index: usize, place: DMat4) -> Result<(), Fault> {
        let mesh = entry(&self.gltf.document.meshes, index, "mesh")?;
        for primitive in &mesh.primitives {
            match primitive.mode.unwrap_or(4) {
                4..=6 => add(&self.gltf, primitive, place, &mut self.out)?,
                _ => self
                    .out
                    .note("points and lines of the file are not used".to_owned()),
            }
        }
        Ok(())
    }
}

fn picture(
    gltf: &Loaded<'_>,
    source: usize,
    out: &mut Builder,
    side: &dyn Side,
) -> Result<Option<usize>, Fault> {
    let image = entry(&gltf.document.images, source, "image")?;
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) if uri.starts_with("data:") => {
            let bytes = open(uri, side)?.unwrap_or_default();
            out.decode(&format!("image {source}"), &bytes).map(Some)
        }
        (Some(uri), _) => out.picture(&percent(uri), side),
        (None, Some(view)) => {
            let bytes = gltf.view(view)?;
            out.decode(&format!("image {source}"), bytes).map(Some)
        }
        (None, None) => Ok(None),
    }
}

/// Where a node stands against its parent.
fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix);
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    let length = rotation.length();
    let rotation = if length > 0.0 {
        rotation / length
    } else {
        DQuat::IDENTITY
    };
    DMat4::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, DVec3::from_array),
        rotation,
        node.translation.map_or(DVec3::ZERO, DVec3::from_array),
    )
}

fn add(
    gltf: &Loaded<'_>,
    primitive: &Primitive,
    place: DMat4,
    out: &mut Builder,
) -> Result<(), Fault> {
    let Some(&positions) = primitive.attributes.get("POSITION") else {
        return Ok(());
    };
    let first = out.positions.len();
    for at in gltf.numbers::<3>(positions)?.0 {
        out.vertex(place.transform_point3(DVec3::from_array(at)))?;
    }
    let count = out.positions.len() - first;
    colours(gltf, primitive, first, out)?;
    let fallback = out.materials.len() - 1;
    let material = primitive.material.unwrap_or(fallback).min(fallback);
    let surface = gltf.document.materials.get(material);
    let texture = surface.and_then(|m| m.pbr_metallic_roughness.base_color_texture.as_ref());
    let set = format!("TEXCOORD_{}", texture.map_or(0, |t| t.tex_coord));
    let uvs: Vec<Vec2> = match primitive.attributes.get(&set) {
        Some(&uvs) => {
            let uvs = gltf.numbers::<2>(uvs)?.0;
            uvs.iter().map(|&[u, v]| vec2(u as f32, v as f32)).collect()
        }
        None => Vec::new(),
    };
    let indices: Vec<i64> = match primitive.indices {
        Some(indices) => {
            let numbers = gltf.numbers::<1>(indices)?.0;
            numbers.iter().map(|&[i]| i as i64).collect()
        }
        None => (0..count as i64).collect(),
    };
    let mirrored = place.determinant() < 0.0;
    let n = indices.len();
    let triangles: Box<dyn Iterator<Item = [i64; 3]>> = match primitive.mode.unwrap_or(4) {
        4 => Box::new(indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]])),
        // Every second triangle of a strip turns the other way.
        5 => Box::new((2..n).map(|i| match i % 2 {
            0 => [indices[i - 2], indices[i - 1], indices[i]],
            _ => [indices[i - 1], indices[i - 2], indices[i]],
        })),
        _ => Box::new((2..n).map(|i| [indices[0], indices[i - 1], indices[i]])),
    };
    for mut triangle in triangles {
        if mirrored {
            triangle.swap(1, 2);
        }
        let outside = triangle.iter().find(|&&i| i < 0 || i >= count as i64);
        if let Some(&index) = outside {
            let what = "vertex";
            return Err(Fault::OutOfRange { what, index, count });
        }
        let corners = triangle.map(|i| first as u32 + i as u32);
        let at = triangle.map(|i| {
            uvs.get(i as usize)
                .copied()
                .unwrap_or(Vec2::splat(f32::NAN))
        });
        out.face(&corners, &at, material as u32)?;
    }
    Ok(())
}

/// Colours of the vertices from `first` on. The standard calls them linear; scanning programs put
/// sRGB bytes there, so bytes are taken for sRGB and all else for linear.
fn colours(
    gltf: &Loaded<'_>,
    primitive: &Primitive,
    first: usize,
    out: &mut Builder,
) -> Result<(), Fault> {
    const BYTES: u32 = 5121;
    const BARE: [u8; 3] = [200; 3];
    if let Some(&colours) = primitive.attributes.get("COLOR_0") {
        let (colours, kind) = gltf.numbers::<3>(colours)?;
        out.colours.resize(first, BARE);
        let srgb = |c: f64| if kind == BYTES { c } else { encode(c) };
        out.colours
            .extend(colours.iter().map(|c| c.map(|c| byte(srgb(c)))));
    }
    if !out.colours.is_empty() {
        out.colours.resize(out.positions.len(), BARE);
    }
    Ok(())
}

/// Linear light as sRGB.
fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}
