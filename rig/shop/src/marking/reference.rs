//! The landmarks of a head as they lie on its skin as drawn: what a scan's landmarks correspond to.

use glam::Vec3;
use mouthpiece_rig::{Head, Layer, SubdivisionError, normals};

use crate::mesh::ReferencePoint;

/// The skin's landmarks with the outward normals there, mm.
///
/// # Errors
/// When the head's skin cannot be drawn.
pub fn reference_points(head: &Head) -> Result<Vec<ReferencePoint>, SubdivisionError> {
    let mesh = &head.skin.mesh;
    let mut drawn = vec![Vec3::ZERO; mesh.positions.len()];
    head.skin_limit()?.apply(&mesh.positions, &mut drawn);
    let normals = normals(&drawn, &mesh.triangles);
    Ok(head
        .landmarks
        .iter()
        .filter(|l| l.layer == Layer::Skin)
        .map(|l| ReferencePoint {
            name: l.name.clone(),
            at: l.at.on(&drawn),
            normal: l.at.on(&normals).normalize_or(Vec3::Z),
        })
        .collect())
}
