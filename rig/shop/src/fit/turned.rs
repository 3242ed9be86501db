//! Faces turned over: which they are, judged against the mesh as the landmarks alone warp it.

use glam::Vec3;

/// Unit normals of faces; zero where a face has no area.
pub(crate) fn face_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect()
}

/// The faces whose normal has turned further from the one it should have than `cosine` allows. A face without area
/// before cannot turn; one that lost its area has.
pub fn turned(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    should: &[Vec3],
    cosine: f32,
) -> Vec<usize> {
    face_normals(positions, triangles)
        .iter()
        .zip(should)
        .enumerate()
        .filter(|(_, (now, should))| **should != Vec3::ZERO && now.dot(**should) <= cosine)
        .map(|(face, _)| face)
        .collect()
}
