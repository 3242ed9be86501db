//! The part of glTF 2.0 that a head needs: the container and its JSON.
//!
//! What is not listed here is ignored when read.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::HeadError;

const MAGIC: u32 = 0x4654_6C67;
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

pub(super) const FLOAT: u32 = 5126;
pub(super) const UNSIGNED_SHORT: u32 = 5123;
pub(super) const UNSIGNED_INT: u32 = 5125;
/// Use of a buffer view: vertices or indices.
pub(super) const ARRAY_BUFFER: u32 = 34962;
pub(super) const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// A type whose lists may be absent and whose other fields may too.
macro_rules! gltf {
    ($($(#[$doc:meta])* $name:ident { $($lists:ident: $list:ty,)* ; $($fields:ident: $field:ty,)* })*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug, Default, Serialize, Deserialize)]
        #[serde(rename_all = "camelCase", default)]
        pub(super) struct $name {
            $(#[serde(skip_serializing_if = "Vec::is_empty")]
            pub $lists: Vec<$list>,)*
            $(#[serde(skip_serializing_if = "Option::is_none")]
            pub $fields: Option<$field>,)*
        }
    )*};
}

gltf! {
    /// The whole JSON.
    Document {
        scenes: Scene, nodes: Node, meshes: Mesh, materials: Material, textures: Texture, images: Image,
        samplers: Sampler, accessors: Accessor, buffer_views: BufferView, buffers: Buffer,
        extensions_required: String,;
        asset: Asset, scene: usize,
    }
    Asset {; version: String, generator: String, }
    Scene { nodes: usize,; name: String, }
    /// Children come with a matrix or with translation, rotation and scale.
    Node { children: usize,; name: String, mesh: usize, matrix: [f64; 16], translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3], extras: Value, }
    Mesh { primitives: Primitive,; name: String, }
    Primitive {; attributes: std::collections::BTreeMap<String, usize>, indices: usize, material: usize, mode: u32, }
    Material {; name: String, pbr_metallic_roughness: Pbr, double_sided: bool, }
    Pbr {; base_color_factor: [f32; 4], base_color_texture: TextureInfo, metallic_factor: f32, roughness_factor: f32, }
    TextureInfo {; index: usize, tex_coord: usize, }
    Texture {; sampler: usize, source: usize, }
    Image {; name: String, mime_type: String, buffer_view: usize, uri: String, }
    Sampler {; mag_filter: u32, min_filter: u32, wrap_s: u32, wrap_t: u32, }
    /// Elements of one kind in a buffer view.
    Accessor { min: f32, max: f32,; buffer_view: usize, byte_offset: usize, component_type: u32, normalized: bool, count: usize, r#type: String, sparse: Value, }
    BufferView {; buffer: usize, byte_offset: usize, byte_length: usize, byte_stride: usize, target: u32, }
    Buffer {; byte_length: usize, uri: String, }
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

/// A file's JSON and its binary chunk.
pub(super) fn split(bytes: &[u8]) -> Result<(Document, &[u8]), HeadError> {
    if word(bytes, 0) != Some(MAGIC) {
        return Err(HeadError::NotGlb);
    }
    let header = HeadError::Truncated { part: "its header" };
    match (word(bytes, 4), word(bytes, 8)) {
        (Some(2), Some(length)) if length as usize <= bytes.len() => {}
        (Some(2), Some(_)) => return Err(HeadError::Truncated { part: "its chunks" }),
        (Some(version), Some(_)) => return Err(HeadError::GltfVersion(version)),
        _ => return Err(header),
    }
    let chunk = |at: usize| -> Option<(u32, &[u8])> {
        let length = word(bytes, at)? as usize;
        let from = at + 8;
        Some((
            word(bytes, at + 4)?,
            bytes.get(from..from.checked_add(length)?)?,
        ))
    };
    let Some((JSON, json)) = chunk(12) else {
        return Err(HeadError::Truncated { part: "its JSON" });
    };
    let document: Document = serde_json::from_slice(json).map_err(HeadError::Json)?;
    let at = 20 + json.len();
    let binary = match chunk(at) {
        Some((BIN, binary)) => binary,
        // A file without one is whole; half a one is not.
        _ if at >= bytes.len() => &[],
        _ => {
            return Err(HeadError::Truncated {
                part: "its vertices",
            });
        }
    };
    Ok((document, binary))
}

/// A file of both.
pub(super) fn join(document: &Document, binary: &[u8]) -> Vec<u8> {
    // Only lists, numbers and text with text for keys: this cannot fail.
    let mut json = serde_json::to_vec(document).unwrap_or_default();
    json.resize(json.len().next_multiple_of(4), b' ');
    let whole = binary.len().next_multiple_of(4);
    let length = 28 + json.len() + whole;
    let mut out = Vec::with_capacity(length);
    for word in [MAGIC, 2, length as u32, json.len() as u32, JSON] {
        out.extend(word.to_le_bytes());
    }
    out.extend(json);
    for word in [whole as u32, BIN] {
        out.extend(word.to_le_bytes());
    }
    out.extend(binary);
    out.resize(length, 0);
    out
}
