//! Whether skin and muscles of a head that was read can be simulated: no spring without length, no
//! vertex without a neighbour, no muscle outside the skin.
//!
//! Looked at once, at load: the simulation divides by these lengths and looks again at none.

use std::time::Duration;

use glam::{Vec3, Vec3A, vec3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

use super::{ANEW, HeadError};
use crate::tissue::Numbering;
use crate::{Fibre, Head, Mesh};

/// An edge or a fibre's piece shorter than this has no length, mm: a hundredth of the shortest that a
/// fitted head has.
const LENGTH_MIN_MM: f32 = 2e-3;
/// A fibre may stand out of the skin by so much, mm: towards the corners of the mouth those that line the
/// lips pass through the slit between them, 1.8 mm in front of the next skin on the reference head.
const OUTSIDE_MM: f32 = 4.0;
/// The head's vertical axis lies this far in front of its frame's, mm: towards it is inwards.
const AXIS_Z: f32 = 30.0;

/// Edges of the skin, and its vertices that move.
pub(super) fn skin(head: &Head) -> Result<(), HeadError> {
    let mesh = &head.skin.mesh;
    let mut joined = vec![false; mesh.positions.len()];
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let length = mesh.positions[a as usize].distance(mesh.positions[b as usize]);
            if length < LENGTH_MIN_MM {
                let element = format!("skin: edge of the vertices {a} and {b}");
                let fault = "it has no length, and no spring can be made of it";
                return Err(HeadError::element(element, fault, ANEW));
            }
            joined[a as usize] = true;
        }
    }
    let numbering = Numbering::plain(head);
    let alone = (0..mesh.positions.len() as u32)
        .find(|&v| !joined[v as usize] && numbering.moving(v).is_some());
    match alone {
        Some(v) => {
            let fault = "it is a corner of no triangle, so that nothing holds it";
            let element = format!("skin: vertex {v}");
            Err(HeadError::element(element, fault, ANEW))
        }
        None => Ok(()),
    }
}

/// The fibres as they are built, in the order of the grids.
pub(super) fn fibres(head: &Head) -> Result<(), HeadError> {
    if head.fibres.is_empty() {
        return Ok(());
    }
    let outside = Outside::of(&head.skin.mesh);
    let rows = head.muscles.iter().flat_map(|g| 0..g.fibres.len());
    for (fibre, row) in head.fibres.iter().zip(rows) {
        let of = || format!("muscle {:?}, fibre {row}", fibre.muscle);
        if !has_length(fibre) {
            let fault = "its points lie on one another";
            return Err(HeadError::element(of(), fault, ANEW));
        }
        for (i, point) in fibre.points.iter().enumerate() {
            let by = outside.by_mm(*point);
            if by > OUTSIDE_MM {
                let fault = format!("it lies outside the skin by {by:.1} mm");
                return Err(HeadError::element(
                    format!("{}, point {i}", of()),
                    fault,
                    ANEW,
                ));
            }
        }
    }
    Ok(())
}

/// Whether each piece between two points can be told a direction.
fn has_length(fibre: &Fibre) -> bool {
    fibre
        .points
        .windows(2)
        .all(|w| w[0].distance(w[1]) >= LENGTH_MIN_MM)
}

/// Tells how far in front of the skin a point is.
struct Outside {
    triangles: Vec<Triangle>,
    bvh: Bvh2,
}

impl Outside {
    fn of(mesh: &Mesh) -> Self {
        let triangles: Vec<Triangle> = mesh
            .triangles
            .iter()
            .map(|t| {
                let [v0, v1, v2] = t.map(|v| Vec3A::from(mesh.positions[v as usize]));
                Triangle { v0, v1, v2 }
            })
            .collect();
        let mut spent = Duration::default();
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut spent);
        Self { triangles, bvh }
    }

    /// The way inwards to the outer side of the skin; 0 where a point has the skin's inner side, or
    /// none, before it. The skin is open at eyes, mouth and neck, so that no ray's crossings can be counted.
    fn by_mm(&self, p: Vec3) -> f32 {
        let way = vec3(0.0, p.y, AXIS_Z) - p;
        let length = way.length();
        if length < OUTSIDE_MM {
            return 0.0;
        }
        let ray = Ray::new(p.into(), (way / length).into(), 0.0, length);
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(ray, &mut hit, |ray, id| {
            self.triangles[self.bvh.primitive_indices[id] as usize].intersect(ray)
        });
        let Some(&id) = self.bvh.primitive_indices.get(hit.primitive_id as usize) else {
            return 0.0;
        };
        let t = &self.triangles[id as usize];
        let normal = (t.v1 - t.v0).cross(t.v2 - t.v0);
        if hit.t < length && normal.dot(way.into()) < 0.0 {
            hit.t
        } else {
            0.0
        }
    }
}
