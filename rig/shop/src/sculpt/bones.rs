//! Skull and mandible as parts, with their landmarks: data of the project, already under the reference head's skin.

use glam::Vec3;
use mouthpiece_rig::{Body, Landmark, Layer, Material, Mesh, Part, SurfacePoint, normals};
use serde::Deserialize;

use super::SculptError;
use crate::closest::Surface;
use crate::mesh;

const SKULL: &[u8] = include_bytes!("../../data/skull.ply");
const MANDIBLE: &[u8] = include_bytes!("../../data/mandible.ply");
const LANDMARKS: &str = include_str!("../../data/skull_landmarks.json");
/// A landmark lies no farther from its bone than this, mm.
const REACH_MM: f32 = 3.0;

/// A row of the table; depths are for who fits a skull under another skin.
#[derive(Deserialize)]
struct Row {
    name: String,
    of: String,
    layer: Layer,
    at: Vec3,
}

/// Both bones, and the landmarks on them.
pub(super) fn build() -> Result<(Vec<Part>, Vec<Landmark>), SculptError> {
    let skull = part("skull", SKULL, Body::Skull)?;
    let mandible = part("mandible", MANDIBLE, Body::Mandible)?;
    let rows: Vec<Row> = serde_json::from_str(LANDMARKS).map_err(SculptError::BoneLandmarks)?;
    let mut landmarks = Vec::new();
    for (layer, bone) in [(Layer::Skull, &skull), (Layer::Mandible, &mandible)] {
        let mesh = &bone.mesh;
        let surface =
            Surface::new(&mesh.positions, &mesh.triangles).map_err(SculptError::Template)?;
        for row in rows.iter().filter(|row| row.layer == layer) {
            let Some(hit) = surface.closest(row.at, REACH_MM) else {
                return Err(SculptError::Astray(row.name.clone()));
            };
            landmarks.push(Landmark {
                name: row.name.clone(),
                layer,
                at: SurfacePoint {
                    vertices: mesh.triangles[hit.triangle as usize],
                    shares: hit.barycentric,
                },
                of: Some(row.of.clone()),
            });
        }
    }
    Ok((vec![skull, mandible], landmarks))
}

fn part(name: &str, ply: &[u8], body: Body) -> Result<Part, SculptError> {
    let file = format!("rig/shop/data/{name}.ply");
    let scan = mesh::read_bytes(mesh::Format::Ply, &file, ply, &())?.scan;
    let count = scan.positions.len();
    Ok(Part {
        name: name.into(),
        material: Material::Bone,
        mesh: Mesh {
            normals: normals(&scan.positions, &scan.triangles),
            uvs: vec![glam::Vec2::ZERO; count],
            occlusion: vec![1.0; count],
            positions: scan.positions,
            triangles: scan.triangles,
        },
        bodies: vec![body],
        weight: vec![0.0; count],
    })
}
