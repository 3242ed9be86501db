//! The skin before and after: the template that is fitted, lips that stay closed, control points of what is drawn.

use glam::Vec3;
use mouthpiece_rig::{Head, Lips, Stencils, SubdivisionError, fit_control, lip_level, normals};

use crate::closest::{Facing, Surface};

/// Light that must arrive at a vertex (share of the sky at rest) for a scanner to begin to see it, and to see it well.
const SEEN: (f32, f32) = (0.2, 0.4);
/// Wet rows of lids and lips are behind what a scanner sees.
const WET: f32 = 0.4;
/// How much of what closes the lips each level of a column takes: from the border, which stays, to the contact line
/// and the inner side, which goes along.
const CLOSING: [f32; 9] = [0.0, 0.1, 0.3, 0.55, 0.8, 1.0, 1.0, 0.9, 0.8];

/// The reference head's skin, ready to be fitted.
pub(super) struct Rest {
    /// From control points to the drawn surface.
    pub(super) limit: Stencils,
    /// The vertices where they are drawn.
    pub(super) drawn: Vec<Vec3>,
    /// How far each has a surface to find on a scan.
    pub(super) freedom: Vec<f32>,
}

impl Rest {
    pub(super) fn of(head: &Head) -> Result<Self, SubdivisionError> {
        let limit = head.skin_limit()?;
        let mut drawn = vec![Vec3::ZERO; limit.len()];
        limit.apply(&head.skin.mesh.positions, &mut drawn);
        Ok(Self {
            drawn,
            freedom: freedom(head),
            limit,
        })
    }

    /// Gives `head` the control points whose drawn surface goes through `drawn`.
    pub(super) fn control(&self, drawn: &[Vec3], head: &mut Head) {
        let skin = &mut head.skin.mesh;
        skin.positions = fit_control(&self.limit, drawn);
        // To the bit: a gap of a hair's breadth would let light through.
        for (upper, lower) in head.lips.upper.iter().zip(&head.lips.lower) {
            let [up, low] = [upper, lower].map(|c| c[lip_level::CONTACT] as usize);
            let middle = (skin.positions[up] + skin.positions[low]) / 2.0;
            skin.positions[up] = middle;
            skin.positions[low] = middle;
        }
        skin.normals = normals(&skin.positions, &skin.triangles);
    }

    /// The vertices on the face, where the scan has a surface worth comparing with.
    pub(super) fn face(&self, head: &Head, scan: &Surface, drawn: &[Vec3]) -> Vec<bool> {
        /// Cosine: what faces another way is another part of the scan, seen through where this one is missing.
        const AGREE: f32 = 0.3;
        let reference = &head.skin.reference;
        let normals = normals(drawn, &head.skin.mesh.triangles);
        let there = |v: usize| {
            let facing = Facing {
                direction: normals[v],
                cosine: AGREE,
            };
            let hit = scan.closest_facing(drawn[v], f32::INFINITY, facing);
            hit.is_some_and(|hit| !scan.on_border(&hit))
        };
        (0..drawn.len())
            .map(|v| self.freedom[v] >= 1.0 && on_face(reference[v]) && there(v))
            .collect()
    }
}

/// By the light that arrives at rest, which was baked with the head: no light, no scanner's look either.
fn freedom(head: &Head) -> Vec<f32> {
    let skin = &head.skin;
    (0..skin.mesh.positions.len())
        .map(|v| {
            let light = skin.mesh.occlusion.get(v).copied().unwrap_or(1.0);
            let seen = ((light - SEEN.0) / (SEEN.1 - SEEN.0)).clamp(0.0, 1.0);
            let dry = (1.0 - skin.wet[v] / WET).clamp(0.0, 1.0);
            seen * dry
        })
        .collect()
}

/// The part of the reference head that has a face's accuracy to keep.
fn on_face(p: Vec3) -> bool {
    p.z > 35.0 && p.y > -78.0 && p.y < 105.0 && p.x.abs() < 68.0
}

/// Both lips' contact lines are one line at rest: they meet half way, and what is near them goes along.
pub(super) fn close_lips(lips: &Lips, skin: &mut [Vec3]) {
    let mut moved = vec![None; skin.len()];
    for (upper, lower) in lips.upper.iter().zip(&lips.lower) {
        let [up, low] = [upper, lower].map(|c| skin[c[lip_level::CONTACT] as usize]);
        let middle = (up + low) / 2.0;
        for (column, shift) in [(upper, middle - up), (lower, middle - low)] {
            for (v, share) in column.iter().zip(CLOSING) {
                // The corners are of both lips: their shifts cancel out.
                moved[*v as usize].get_or_insert(shift * share);
            }
        }
    }
    for (place, shift) in skin.iter_mut().zip(moved) {
        *place += shift.unwrap_or_default();
    }
}
