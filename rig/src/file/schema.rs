//! The JSON of a head: what `extras.mouthpiece` of its root node holds.

use glam::Vec3;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::HeadError;
use super::document::Document;
use crate::{
    Body, Calibration, Eye, Feature, Head, Landmark, Lid, Lips, Material, MuscleGrid, Placement,
    TissueRecord,
};

/// The version that is written, and the only one that is read.
pub(super) const VERSION: u64 = 1;
/// Its key in the extras.
pub(super) const KEY: &str = "mouthpiece";

/// Everything that is not a list of vertices; lengths in mm, vertices by their `_SIM`. Some programs
/// (pygltflib) leave out empty lists.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Extras {
    pub schema: u64,
    pub skin: SkinRecord,
    #[serde(default)]
    pub parts: Vec<PartRecord>,
    #[serde(default)]
    pub features: Vec<Feature>,
    #[serde(default)]
    pub landmarks: Vec<Landmark>,
    pub lips: Lips,
    #[serde(default)]
    pub lids: Vec<Lid>,
    #[serde(default)]
    pub muscles: Vec<MuscleGrid>,
    pub eyes: [Eye; 2],
    pub bite: Placement,
    pub condyle_axis: Vec3,
    pub neck_pivot: Vec3,
    /// Files of before there was a choice have none.
    #[serde(default)]
    pub tissue: TissueRecord,
    pub calibration: Calibration,
}

/// Of the skin.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkinRecord {
    /// How many there are, welded.
    pub vertices: usize,
    #[serde(default)]
    pub creases: Vec<[u32; 2]>,
}

/// Of a part; its mesh is in the node of the same name.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartRecord {
    pub name: String,
    pub material: Material,
    pub bodies: Vec<Body>,
    pub vertices: usize,
}

impl Extras {
    /// Those of a head.
    pub(super) fn of(head: &Head) -> Self {
        Self {
            schema: VERSION,
            skin: SkinRecord {
                vertices: head.skin.mesh.positions.len(),
                creases: head.skin.creases.clone(),
            },
            parts: head
                .parts
                .iter()
                .map(|part| PartRecord {
                    name: part.name.clone(),
                    material: part.material,
                    bodies: part.bodies.clone(),
                    vertices: part.mesh.positions.len(),
                })
                .collect(),
            features: head.features.clone(),
            landmarks: head.landmarks.clone(),
            lips: head.lips.clone(),
            lids: head.lids.clone(),
            muscles: head.muscles.clone(),
            eyes: head.eyes,
            bite: head.bite,
            condyle_axis: head.condyle_axis,
            neck_pivot: head.neck_pivot,
            tissue: head.tissue,
            calibration: head.calibration.clone(),
        }
    }

    /// As JSON, with no more digits than its numbers need.
    pub(super) fn json(&self) -> Value {
        // Only lists, numbers and text with text for keys: this cannot fail.
        let text = serde_json::to_string(self).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Those in a file, and the node that holds them.
    pub(super) fn find(document: &Document) -> Result<(Self, usize), HeadError> {
        let (node, value) = document
            .nodes
            .iter()
            .enumerate()
            .find_map(|(i, node)| Some((i, node.extras.as_ref()?.get(KEY)?)))
            .ok_or(HeadError::NotAHead)?;
        let found = value.get("schema").and_then(Value::as_u64).unwrap_or(0);
        if found != VERSION {
            return Err(HeadError::Schema { found });
        }
        let extras = Self::deserialize(value).map_err(HeadError::Extras)?;
        Ok((extras, node))
    }
}
