//! The part of glTF 2.0 that a scan needs: its JSON as types, and accessors read with every bound
//! checked, since a scan comes from strangers.

use serde::Deserialize;

use super::error::Fault;
use super::limits::MAX_VERTICES;

/// The document. What a scan does not need is passed over.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Document {
    pub(crate) asset: Asset,
    pub(crate) extensions_required: Vec<String>,
    pub(crate) scene: Option<usize>,
    pub(crate) scenes: Vec<Scene>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) accessors: Vec<Accessor>,
    pub(crate) buffer_views: Vec<View>,
    pub(crate) buffers: Vec<Buffer>,
    pub(crate) materials: Vec<Material>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) images: Vec<Image>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Asset {
    pub(crate) version: String,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Scene {
    pub(crate) nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) children: Vec<usize>,
    pub(crate) mesh: Option<usize>,
    pub(crate) matrix: Option<[f64; 16]>,
    pub(crate) translation: Option<[f64; 3]>,
    pub(crate) rotation: Option<[f64; 4]>,
    pub(crate) scale: Option<[f64; 3]>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Mesh {
    pub(crate) primitives: Vec<Primitive>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Primitive {
    pub(crate) attributes: std::collections::BTreeMap<String, usize>,
    pub(crate) indices: Option<usize>,
    pub(crate) material: Option<usize>,
    pub(crate) mode: Option<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Accessor {
    pub(crate) buffer_view: Option<usize>,
    #[serde(default)]
    pub(crate) byte_offset: usize,
    pub(crate) component_type: u32,
    #[serde(default)]
    pub(crate) normalized: bool,
    pub(crate) count: usize,
    #[serde(rename = "type")]
    pub(crate) shape: String,
    pub(crate) sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct View {
    pub(crate) buffer: usize,
    #[serde(default)]
    pub(crate) byte_offset: usize,
    pub(crate) byte_length: usize,
    pub(crate) byte_stride: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Buffer {
    pub(crate) uri: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Material {
    pub(crate) pbr_metallic_roughness: Surface,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Surface {
    pub(crate) base_color_factor: Option<[f64; 4]>,
    pub(crate) base_color_texture: Option<TextureUse>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TextureUse {
    pub(crate) index: usize,
    #[serde(default)]
    pub(crate) tex_coord: u32,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Texture {
    pub(crate) source: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Image {
    pub(crate) uri: Option<String>,
    pub(crate) buffer_view: Option<usize>,
}

/// A document with its buffers.
pub(crate) struct Loaded<'a> {
    pub(crate) document: Document,
    pub(crate) buffers: Vec<std::borrow::Cow<'a, [u8]>>,
}

fn missing(what: &'static str, index: usize, count: usize) -> Fault {
    Fault::OutOfRange {
        what,
        index: i64::try_from(index).unwrap_or(i64::MAX),
        count,
    }
}

/// The entry of a table, or the error that it is not there.
pub(crate) fn entry<'t, T>(
    table: &'t [T],
    index: usize,
    what: &'static str,
) -> Result<&'t T, Fault> {
    table
        .get(index)
        .ok_or_else(|| missing(what, index, table.len()))
}

impl Loaded<'_> {
    /// The bytes of a buffer view.
    pub(crate) fn view(&self, index: usize) -> Result<&[u8], Fault> {
        let view = entry(&self.document.buffer_views, index, "buffer view")?;
        let buffer = entry(&self.buffers, view.buffer, "buffer")?;
        let end = view.byte_offset.checked_add(view.byte_length);
        end.and_then(|end| buffer.get(view.byte_offset..end))
            .ok_or(Fault::Truncated("a buffer view"))
    }

    /// An accessor of `N` or more components as numbers; its component type beside it.
    pub(crate) fn numbers<const N: usize>(
        &self,
        index: usize,
    ) -> Result<(Vec<[f64; N]>, u32), Fault> {
        let accessor = entry(&self.document.accessors, index, "accessor")?;
        if accessor.count > MAX_VERTICES {
            return Err(Fault::ManyVertices(accessor.count as u64));
        }
        if accessor.sparse.is_some() {
            let mend = "export the scan without sparse accessors";
            let found = "a sparse accessor".to_owned();
            return Err(Fault::Unsupported { found, mend });
        }
        let columns = match accessor.shape.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        let size = match accessor.component_type {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => 0,
        };
        if columns < N || size == 0 {
            let why = format!("accessor {index} has not the type that its use asks for");
            return Err(Fault::NotThis {
                format: "glTF",
                why,
            });
        }
        let kind = accessor.component_type;
        let Some(view_index) = accessor.buffer_view else {
            return Err(Fault::Truncated("an accessor"));
        };
        let view = self.view(view_index)?;
        let stride = self.document.buffer_views[view_index].byte_stride;
        let stride = stride.filter(|&s| s > 0).unwrap_or(columns * size);
        let cut = Fault::Truncated("an accessor");
        let Some(bytes) = view.get(accessor.byte_offset..) else {
            return Err(cut);
        };
        // All but the last row take the stride, the last only what it holds.
        let needed = match accessor.count {
            0 => Some(0),
            n => stride
                .checked_mul(n - 1)
                .and_then(|all| all.checked_add(columns * size)),
        };
        if needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(cut);
        }
        let rows = (0..accessor.count).map(|row| {
            std::array::from_fn(|column| {
                let at = row * stride + column * size;
                number(&bytes[at..at + size], kind, accessor.normalized)
            })
        });
        Ok((rows.collect(), kind))
    }
}

fn number(bytes: &[u8], kind: u32, normalized: bool) -> f64 {
    let (value, most) = match (kind, bytes) {
        (5120, &[a]) => (f64::from(a as i8), 127.0),
        (5121, &[a]) => (f64::from(a), 255.0),
        (5122, &[a, b]) => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
        (5123, &[a, b]) => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
        (5125, &[a, b, c, d]) => (
            f64::from(u32::from_le_bytes([a, b, c, d])),
            f64::from(u32::MAX),
        ),
        (_, &[a, b, c, d]) => return f64::from(f32::from_le_bytes([a, b, c, d])),
        _ => return f64::NAN,
    };
    if normalized {
        (value / most).max(-1.0)
    } else {
        value
    }
}
