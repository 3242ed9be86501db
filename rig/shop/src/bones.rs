//! Puts skull and mandible under a new skin (HEADSHOP 5.2, step 2, and 6, step 6).
//!
//! The bones go with the warp of the skin first. Then every landmark on bone is put where it lies under
//! the skin landmark that it belongs to: at the reference head's vector between the two, scaled with
//! the size of the head and by how thick the skin is to be. What then comes too near to the skin
//! between the landmarks is pressed in. It does not know how a skin was fitted, nor tissue depths of
//! sex, age or weight: `thickness` is one factor for the whole head.

use glam::Vec3;
use mouthpiece_rig::{Head, Landmark, Layer, Material, Part};
use thiserror::Error;

use crate::closest::{Facing, Surface, SurfaceError};
use crate::warp::{Warp, WarpError};

/// Bone lies at least so deep under the skin, mm, where the reference head's does.
const LEAST_MM: f32 = 2.0;
/// A vertex farther out than this is not pressed in: it is a tooth row or a sinus beside an opening.
const STRAY_MM: f32 = 8.0;
/// Rounds of pressing in, and of spreading a push to the neighbours in each.
const ROUNDS: usize = 6;
const SPREADS: usize = 3;

/// Why the bones cannot follow.
#[derive(Debug, Error)]
pub enum BonesError {
    /// The head has another number of skin vertices than it is given.
    #[error(
        "the new skin has {found} vertices where the head has {wanted}: fit the head's own template"
    )]
    Skin {
        /// Of the head.
        wanted: usize,
        /// Given.
        found: usize,
    },
    /// A part that bones are made of is missing.
    #[error("the head has no part {0}: take one that was made by this version")]
    Missing(&'static str),
    /// Landmarks on bone and skin do not go together.
    #[error("the landmarks on bone define no warp: {0}")]
    Warp(#[from] WarpError),
    /// The new skin is no surface.
    #[error("the new skin is no surface to lay bones under: {0}")]
    Surface(#[from] SurfaceError),
}

/// New positions of the vertices of every bone of `head`, in the order of `head.parts`, under `skin`
/// (new positions of the head's skin). `warp` takes places on the head to the new one; `thickness` is
/// 1 for tissue as thick as the reference head's in proportion.
///
/// # Errors
/// Where skin, bones and landmarks do not belong together.
pub fn follow(
    head: &Head,
    skin: &[Vec3],
    warp: impl Fn(&[Vec3]) -> Vec<Vec3>,
    thickness: f32,
) -> Result<Vec<Vec<Vec3>>, BonesError> {
    let old = &head.skin.mesh.positions;
    if skin.len() != old.len() {
        return Err(BonesError::Skin {
            wanted: old.len(),
            found: skin.len(),
        });
    }
    let skull = part(head, "skull")?;
    let mandible = part(head, "mandible")?;
    let scale = spread(head, skin) / spread(head, old).max(1e-3);
    let (mut from, mut to) = (Vec::new(), Vec::new());
    for mark in head.landmarks.iter().filter(|m| m.layer != Layer::Skin) {
        let over = head
            .landmarks
            .iter()
            .find(|m| m.layer == Layer::Skin && Some(&m.name) == mark.of.as_ref());
        let Some(over) = over else { continue };
        let bone = if mark.layer == Layer::Skull {
            skull
        } else {
            mandible
        };
        let bone = mark.at.on(&bone.mesh.positions);
        from.push(bone);
        to.push(over.at.on(skin) + (bone - over.at.on(old)) * (scale * thickness));
    }
    let from = warp(&from);
    let settle = Warp::new(&from, &to)?;
    let dry: Vec<[u32; 3]> = head
        .skin
        .mesh
        .triangles
        .iter()
        .filter(|t| t.iter().all(|v| head.skin.wet[*v as usize] < 0.5))
        .copied()
        .collect();
    let surface = Surface::new(skin, &dry)?;
    let reference = Surface::new(old, &dry)?;
    let bones = head.parts.iter().filter(|p| p.material == Material::Bone);
    Ok(bones
        .map(|bone| {
            let warped = warp(&bone.mesh.positions);
            let mut places = warped.clone();
            settle.apply(&warped, &mut places);
            // What is shallow on the reference head (the nasal bones, tooth rows) may be so here.
            let least: Vec<f32> = bone
                .mesh
                .positions
                .iter()
                .map(|p| depth(&reference, *p).map_or(LEAST_MM, |(d, _)| d.min(LEAST_MM)))
                .collect();
            press_in(&mut places, &bone.mesh.triangles, &surface, &least);
            places
        })
        .collect())
}

fn part<'a>(head: &'a Head, name: &'static str) -> Result<&'a Part, BonesError> {
    head.parts
        .iter()
        .find(|p| p.name == name)
        .ok_or(BonesError::Missing(name))
}

/// Mean distance of the skin landmarks from their middle: the size of a head.
fn spread(head: &Head, skin: &[Vec3]) -> f32 {
    let on_skin = |m: &&Landmark| m.layer == Layer::Skin;
    let places: Vec<Vec3> = head
        .landmarks
        .iter()
        .filter(on_skin)
        .map(|m| m.at.on(skin))
        .collect();
    let count = places.len().max(1) as f32;
    let middle = places.iter().sum::<Vec3>() / count;
    places.iter().map(|p| p.distance(middle)).sum::<f32>() / count
}

/// How deep a place lies under the skin (below 0: above it), and the way out.
fn depth(skin: &Surface, place: Vec3) -> Option<(f32, Vec3)> {
    let hit = skin.closest_facing(place, STRAY_MM, Facing::ANY)?;
    let out = skin.normal(&hit);
    Some(((hit.point - place).dot(out), out))
}

/// Presses vertices in that lie less than `least` under the skin, their neighbours a little with them.
fn press_in(places: &mut [Vec3], triangles: &[[u32; 3]], skin: &Surface, least: &[f32]) {
    let mut near = vec![Vec::new(); places.len()];
    for t in triangles {
        for i in 0..3 {
            near[t[i] as usize].push(t[(i + 1) % 3] as usize);
        }
    }
    for _ in 0..ROUNDS {
        let wanted: Vec<Vec3> = places
            .iter()
            .zip(least)
            .map(|(p, least)| match depth(skin, *p) {
                Some((depth, out)) if depth < *least => out * (depth - least),
                _ => Vec3::ZERO,
            })
            .collect();
        if wanted.iter().all(|w| w.length() < 0.05) {
            return;
        }
        let mut push = wanted.clone();
        for _ in 0..SPREADS {
            let before = push.clone();
            for (i, near) in near
                .iter()
                .enumerate()
                .filter(|(i, _)| wanted[*i] == Vec3::ZERO)
            {
                push[i] = near.iter().map(|j| before[*j]).sum::<Vec3>() / near.len().max(1) as f32;
            }
        }
        for (place, push) in places.iter_mut().zip(push) {
            *place += push;
        }
    }
}
