//! Writes a head as glTF 2.0 binary.

use std::collections::{BTreeMap, HashMap};

use glam::{Vec2, Vec3};
use serde_json::json;

use super::document::{
    self, ARRAY_BUFFER, Accessor, Asset, Buffer, BufferView, Document, ELEMENT_ARRAY_BUFFER, FLOAT,
    Image, Mesh as GltfMesh, Node, Primitive, Sampler, Scene, Texture, TextureInfo, UNSIGNED_INT,
    UNSIGNED_SHORT,
};
use super::schema::{Extras, KEY};
use super::{parts, picture};
use crate::{Head, Material, Mesh};

/// The root node's name.
const ROOT: &str = "head";

/// The whole file.
pub(super) fn head(head: &Head) -> Vec<u8> {
    let mut out = Writer::default();
    let texture = head.colour.as_ref().and_then(picture::encode);
    let texture = texture.map(|png| out.texture(&png));
    out.skin(head, texture);
    for part in &head.parts {
        let mesh = &part.mesh;
        let sources: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        let mut attributes = out.common(mesh, &sources, &mesh.uvs);
        out.scalars(&mut attributes, "_WEIGHT", &part.weight, &sources);
        out.node(&part.name, attributes, &mesh.triangles, part.material, None);
    }
    out.finish(head)
}

#[derive(Default)]
struct Writer {
    document: Document,
    binary: Vec<u8>,
    /// Materials written so far.
    materials: Vec<Material>,
}

type Attributes = BTreeMap<String, usize>;

impl Writer {
    /// A vertex for every pair of a welded vertex and a texture coordinate.
    fn skin(&mut self, head: &Head, texture: Option<usize>) {
        let skin = &head.skin;
        let (mut sources, mut uvs): (Vec<u32>, Vec<Vec2>) = (Vec::new(), Vec::new());
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        let mut drawn = |vertex: u32, uv: Vec2| {
            *known
                .entry((vertex, uv.to_array().map(f32::to_bits)))
                .or_insert_with(|| {
                    sources.push(vertex);
                    uvs.push(uv);
                    sources.len() as u32 - 1
                })
        };
        let own = |v: u32| skin.mesh.uvs.get(v as usize).copied().unwrap_or_default();
        let triangles: Vec<[u32; 3]> = (skin.mesh.triangles.iter().enumerate())
            .map(|(t, corners)| {
                let wedge = skin.wedges.get(t).copied();
                std::array::from_fn(|c| {
                    let uv = wedge.map_or_else(|| own(corners[c]), |w| w[c]);
                    drawn(corners[c], uv)
                })
            })
            .collect();
        // A vertex of no triangle is still one that the rest of the head may name.
        let mut used = vec![false; skin.mesh.positions.len()];
        for v in skin.mesh.triangles.iter().flatten() {
            used[*v as usize] = true;
        }
        for (v, _) in used.iter().enumerate().filter(|(_, used)| !**used) {
            drawn(v as u32, own(v as u32));
        }
        let mut attributes = self.common(&skin.mesh, &sources, &uvs);
        let chart = sources.iter().map(|&v| own(v).to_array());
        let chart: Vec<_> = chart.collect();
        attributes.insert("_CHART".into(), self.vectors(&chart));
        let reference: Vec<_> = sources
            .iter()
            .filter_map(|&v| Some(skin.reference.get(v as usize)?.to_array()))
            .collect();
        attributes.insert("_REFERENCE".into(), self.vectors(&reference));
        for (name, values) in [
            ("_WEIGHT", &skin.weight),
            ("_VERMILION", &skin.vermilion),
            ("_WET", &skin.wet),
        ] {
            self.scalars(&mut attributes, name, values, &sources);
        }
        self.node(parts::SKIN, attributes, &triangles, Material::Skin, texture);
    }

    /// What every mesh has; `sources` says which vertex each drawn one is.
    fn common(&mut self, mesh: &Mesh, sources: &[u32], uvs: &[Vec2]) -> Attributes {
        let mut attributes = Attributes::new();
        let metres: Vec<[f32; 3]> = sources
            .iter()
            .map(|&v| {
                (mesh.positions[v as usize].as_dvec3() * 1e-3)
                    .as_vec3()
                    .to_array()
            })
            .collect();
        let positions = self.vectors(&metres);
        let accessor = &mut self.document.accessors[positions];
        accessor.min = extreme(&metres, f32::min);
        accessor.max = extreme(&metres, f32::max);
        attributes.insert("POSITION".into(), positions);
        if mesh.normals.len() == mesh.positions.len() {
            let normal = |&v: &u32| mesh.normals[v as usize].normalize_or(Vec3::Z).to_array();
            let normals: Vec<_> = sources.iter().map(normal).collect();
            attributes.insert("NORMAL".into(), self.vectors(&normals));
        }
        if uvs.len() == sources.len() {
            let uvs: Vec<_> = uvs.iter().map(Vec2::to_array).collect();
            attributes.insert("TEXCOORD_0".into(), self.vectors(&uvs));
        }
        let numbers: Vec<[f32; 1]> = sources.iter().map(|&v| [v as f32]).collect();
        attributes.insert("_SIM".into(), self.vectors(&numbers));
        self.scalars(&mut attributes, "_OCCLUSION", &mesh.occlusion, sources);
        attributes
    }

    /// One number per vertex, where there are any.
    fn scalars(&mut self, to: &mut Attributes, name: &str, values: &[f32], sources: &[u32]) {
        let all: Option<Vec<[f32; 1]>> = sources
            .iter()
            .map(|&v| Some([*values.get(v as usize)?]))
            .collect();
        if let Some(all) = all {
            to.insert(name.into(), self.vectors(&all));
        }
    }

    fn vectors<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        self.accessor(view, FLOAT, values.len(), kind)
    }

    fn accessor(&mut self, view: usize, component: u32, count: usize, kind: &str) -> usize {
        self.document.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: Some(component),
            count: Some(count),
            r#type: Some(kind.into()),
            ..Accessor::default()
        });
        self.document.accessors.len() - 1
    }

    /// Bytes on their own in the binary chunk.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.document.buffer_views.push(BufferView {
            buffer: Some(0),
            byte_offset: Some(self.binary.len()),
            byte_length: Some(bytes.len()),
            target,
            ..BufferView::default()
        });
        self.binary.extend_from_slice(bytes);
        self.document.buffer_views.len() - 1
    }

    fn texture(&mut self, png: &[u8]) -> usize {
        let view = self.view(png, None);
        self.document.images.push(Image {
            name: Some("skin_colour".into()),
            mime_type: Some("image/png".into()),
            buffer_view: Some(view),
            uri: None,
        });
        // Linear, with smaller levels; round the head u goes past 1.
        self.document.samplers.push(Sampler {
            mag_filter: Some(9729),
            min_filter: Some(9987),
            wrap_s: Some(10497),
            wrap_t: Some(33071),
        });
        self.document.textures.push(Texture {
            sampler: Some(0),
            source: Some(0),
        });
        0
    }

    fn material(&mut self, material: Material, texture: Option<usize>) -> usize {
        if let Some(known) = self.materials.iter().position(|m| *m == material) {
            return known;
        }
        self.materials.push(material);
        let mut plain = parts::material(material);
        if let (Some(index), Some(pbr)) = (texture, &mut plain.pbr_metallic_roughness) {
            pbr.base_color_factor = None;
            pbr.base_color_texture = Some(TextureInfo {
                index: Some(index),
                tex_coord: None,
            });
        }
        self.document.materials.push(plain);
        self.materials.len() - 1
    }

    fn node(
        &mut self,
        name: &str,
        attributes: Attributes,
        triangles: &[[u32; 3]],
        material: Material,
        texture: Option<usize>,
    ) {
        let corners = triangles.iter().flatten();
        let most = corners.clone().copied().max().unwrap_or(0);
        // The highest number of each type is glTF's "begin anew".
        let (bytes, component): (Vec<u8>, _) = if most < u32::from(u16::MAX) {
            let bytes = corners.flat_map(|&i| (i as u16).to_le_bytes());
            (bytes.collect(), UNSIGNED_SHORT)
        } else {
            (
                corners.flat_map(|i| i.to_le_bytes()).collect(),
                UNSIGNED_INT,
            )
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let indices = self.accessor(view, component, triangles.len() * 3, "SCALAR");
        let material = self.material(material, texture);
        self.document.meshes.push(GltfMesh {
            name: Some(name.into()),
            primitives: vec![Primitive {
                attributes: Some(attributes),
                indices: Some(indices),
                material: Some(material),
                mode: None,
            }],
        });
        self.document.nodes.push(Node {
            name: Some(name.into()),
            mesh: Some(self.document.meshes.len() - 1),
            ..Node::default()
        });
    }

    fn finish(mut self, head: &Head) -> Vec<u8> {
        let document = &mut self.document;
        let root = document.nodes.len();
        document.nodes.push(Node {
            name: Some(ROOT.into()),
            children: (0..root).collect(),
            extras: Some(json!({ KEY: Extras::of(head).json() })),
            ..Node::default()
        });
        document.scenes.push(Scene {
            name: Some(ROOT.into()),
            nodes: vec![root],
        });
        document.scene = Some(0);
        document.asset = Some(Asset {
            version: Some("2.0".into()),
            generator: Some(concat!("Mouthpiece ", env!("CARGO_PKG_VERSION")).into()),
        });
        document.buffers.push(Buffer {
            byte_length: Some(self.binary.len()),
            uri: None,
        });
        document::join(document, &self.binary)
    }
}

/// Smallest or largest of each component.
fn extreme(points: &[[f32; 3]], pick: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let all = points
        .iter()
        .copied()
        .reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i])));
    all.map(Vec::from).unwrap_or_default()
}
