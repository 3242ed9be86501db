//! Reads a head out of a glTF, whichever program wrote it last.

use glam::{DAffine3, DMat4, DQuat, DVec3, Vec2, Vec3};

use super::accessor::Data;
use super::document::{Document, Node};
use super::schema::Extras;
use super::weld::{self, Source, Welded};
use super::{ANEW, HeadError, KEEP, check, nodes, parts, picture};
use crate::{ColourMap, Fibre, Head, LipStencils, Part, Skin};

/// Deepest nesting of nodes.
const DEPTH_MAX: usize = 64;
/// Most parts: several times what a head has.
const PARTS_MAX: usize = 64;

/// The head in a document.
pub(super) fn head(document: &Document, binary: &[u8]) -> Result<Head, HeadError> {
    let (extras, root) = Extras::find(document)?;
    if let Some(extension) = document.extensions_required.first() {
        let fault = format!("the glTF extension {extension} is needed to read it");
        let mend = "save it without compression";
        return Err(HeadError::element("file", fault, mend));
    }
    let data = Data { document, binary };
    let frames = Frames::new(document, root);
    let skin = welded(&data, &frames, parts::SKIN, extras.skin.vertices)?;
    let skin = skin_of(skin, extras.skin.creases)?;
    if extras.parts.len() > PARTS_MAX {
        let fault = format!("{} are more than {PARTS_MAX}", extras.parts.len());
        return Err(HeadError::element("parts", fault, ANEW));
    }
    let mut found = Vec::with_capacity(extras.parts.len());
    for record in extras.parts {
        let welded = welded(&data, &frames, &record.name, record.vertices)?;
        let weight = welded.scalars("_WEIGHT")?;
        let mesh = welded.mesh;
        found.push(Part {
            name: record.name,
            material: record.material,
            mesh,
            bodies: record.bodies,
            weight,
        });
    }
    let mut head = Head {
        skin,
        parts: found,
        features: extras.features,
        landmarks: extras.landmarks,
        lips: extras.lips,
        lip_stencils: LipStencils::default(),
        lids: extras.lids,
        muscles: extras.muscles,
        fibres: Vec::new(),
        eyes: extras.eyes,
        bite: extras.bite,
        condyle_axis: extras.condyle_axis,
        neck_pivot: extras.neck_pivot,
        tissue: extras.tissue,
        calibration: extras.calibration.checked()?,
        colour: None,
    };
    check::head(&head)?;
    head.colour = colour(&data)?;
    head.fibres = fibres(&head);
    nodes::fibres(&head)?;
    Ok(head)
}

/// The mesh of the node `name`, of `count` vertices.
fn welded<'a>(
    data: &'a Data<'a>,
    frames: &Frames,
    name: &'a str,
    count: usize,
) -> Result<Welded<'a>, HeadError> {
    let (node, primitives) = weld::node(data.document, name)?;
    let source = Source {
        data,
        name,
        primitives,
    };
    Welded::new(source, frames.of(node)?, count)
}

/// The fibres of a head that is otherwise whole.
fn fibres(head: &Head) -> Vec<Fibre> {
    let bones = parts::BONES.iter().filter_map(|name| head.part(name));
    let bones = bones.map(|part| &part.mesh);
    crate::rebuild(&head.muscles, &head.skin.mesh.positions, bones)
}

fn skin_of(welded: Welded<'_>, creases: Vec<[u32; 2]>) -> Result<Skin, HeadError> {
    let chart = welded.required::<2>("_CHART")?;
    let reference = welded.required::<3>("_REFERENCE")?;
    let weight = welded.scalars("_WEIGHT")?;
    let vermilion = welded.scalars("_VERMILION")?;
    let wet = welded.scalars("_WET")?;
    let mut mesh = welded.mesh;
    mesh.uvs = chart.into_iter().map(Vec2::from).collect();
    Ok(Skin {
        mesh,
        wedges: welded.wedges,
        creases,
        reference: reference.into_iter().map(Vec3::from).collect(),
        weight,
        vermilion,
        wet,
    })
}

/// Where nodes are.
struct Frames {
    worlds: Vec<Option<DAffine3>>,
    root: usize,
}

impl Frames {
    /// `root` is the node in whose frame the head is.
    fn new(document: &Document, root: usize) -> Self {
        let nodes = &document.nodes;
        let mut worlds = vec![None; nodes.len()];
        let mut children = vec![false; nodes.len()];
        for child in nodes.iter().flat_map(|n| &n.children) {
            if let Some(child) = children.get_mut(*child) {
                *child = true;
            }
        }
        let mut open: Vec<(usize, DAffine3, usize)> = (0..nodes.len())
            .filter(|&i| !children[i])
            .map(|i| (i, DAffine3::IDENTITY, 0))
            .collect();
        while let Some((i, parent, depth)) = open.pop() {
            // A node is placed once, so that a graph with cycles ends as well.
            if depth > DEPTH_MAX || worlds.get(i).is_none_or(Option::is_some) {
                continue;
            }
            let world = parent * local(&nodes[i]);
            worlds[i] = Some(world);
            open.extend(nodes[i].children.iter().map(|&c| (c, world, depth + 1)));
        }
        Self { worlds, root }
    }

    /// From a node's frame in metres to the head's in mm.
    fn of(&self, node: usize) -> Result<DAffine3, HeadError> {
        let (Some(root), Some(node)) = (self.worlds[self.root], self.worlds[node]) else {
            let fault = "nodes are nested in a circle, or too deeply";
            return Err(HeadError::element("nodes", fault, ANEW));
        };
        Ok(DAffine3::from_scale(DVec3::splat(1e3)) * root.inverse() * node)
    }
}

fn local(node: &Node) -> DAffine3 {
    if let Some(matrix) = node.matrix {
        return DAffine3::from_mat4(DMat4::from_cols_array(&matrix));
    }
    DAffine3::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, DVec3::from),
        node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array),
        node.translation.map_or(DVec3::ZERO, DVec3::from),
    )
}

/// The texture of the skin's material.
fn colour(data: &Data<'_>) -> Result<Option<ColourMap>, HeadError> {
    let document = data.document;
    let (_, primitives) = weld::node(document, parts::SKIN)?;
    let image = primitives
        .first()
        .and_then(|p| document.materials.get(p.material?))
        .and_then(|m| {
            m.pbr_metallic_roughness
                .as_ref()?
                .base_color_texture
                .as_ref()
        })
        .and_then(|t| document.textures.get(t.index?))
        .and_then(|t| document.images.get(t.source?));
    let Some(image) = image else {
        return Ok(None);
    };
    let Some(view) = image.buffer_view else {
        let fault = "it lies in another file";
        return Err(HeadError::element("colour map", fault, KEEP));
    };
    let (bytes, _) = data.view(view)?;
    picture::decode(bytes).map(Some)
}
