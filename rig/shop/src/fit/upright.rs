//! Keeping faces upright: landmarks that fold the skin give way, and what the local fit turned over is relaxed.

use glam::{Vec3, Vec3A};

use super::align::Similarity;
use super::local::Local;
use super::turned::{face_normals, turned};
use super::{Options, Target, Template};
use crate::warp::{Warp, WarpError};

/// A face this near to lying on its side (cosine) is already relaxed, so that none ends turned over.
const NEARLY_TURNED: f32 = 0.25;

/// How often turned faces are relaxed before their displacements are simply evened out.
const RELAX_ROUNDS: usize = 3;

/// How often evening out may widen its region. Each time, a ring more follows the warp.
const EVEN_ROUNDS: usize = 6;

/// How often landmarks around folds may be loosened.
const LOOSENED: usize = 5;

/// How much each time.
const LOOSER: f32 = 6.0;

/// Landmarks taken to be the cause of a fold: this many, the nearest.
const SUSPECTS: usize = 4;

/// A first warp that folds nothing.
pub(super) struct Steady {
    pub(super) warp: Warp,
    /// The template, warped.
    pub(super) positions: Vec<Vec3>,
    /// How far each landmark gives way, mm on the ridge.
    pub(super) give: Vec<f32>,
}

/// Warps by the landmarks. Two that a hand put into the wrong order fold the skin between them: those nearest to faces
/// that turn over against the template, brought into the scan's frame as it is, are loosened until none does.
pub(super) fn by_landmarks(
    template: &Template,
    (from, to): (&[Vec3], &[Vec3]),
    give: f32,
) -> Result<Steady, WarpError> {
    let turn = Similarity::between(from, to)
        .map(|s| s.rotation)
        .unwrap_or_default();
    let rest: Vec<Vec3> = face_normals(template.positions, template.triangles)
        .into_iter()
        .map(|n| turn * n)
        .collect();
    let mut give = vec![give; from.len()];
    let mut positions = vec![Vec3::ZERO; template.positions.len()];
    for round in 0.. {
        let warp = Warp::smoothed(from, to, &give)?;
        warp.apply(template.positions, &mut positions);
        let bad = turned(&positions, template.triangles, &rest, 0.0);
        if bad.is_empty() || round == LOOSENED {
            return Ok(Steady {
                warp,
                positions,
                give,
            });
        }
        let mut loosen = vec![false; from.len()];
        for &face in &bad {
            let at = template.triangles[face][0] as usize;
            let mut order: Vec<usize> = (0..from.len()).collect();
            order.sort_by_key(|&i| from[i].distance_squared(template.positions[at]).to_bits());
            for &i in order.iter().take(SUSPECTS) {
                loosen[i] = true;
            }
        }
        for (give, _) in give.iter_mut().zip(loosen).filter(|(_, loosen)| *loosen) {
            *give *= LOOSER;
        }
    }
    Err(WarpError::Singular)
}

/// Lets faces that turned over follow their surroundings; returns how many were treated at first.
pub(super) fn relax(
    template: &Template,
    local: &mut Local,
    start: &[Vec3],
    moved: &mut [Vec3A],
    target: &Target,
    should: &[Vec3],
    options: &Options,
) -> usize {
    let marked = |moved: &[Vec3A]| {
        let bad = turned(
            &displaced(start, moved),
            template.triangles,
            should,
            NEARLY_TURNED,
        );
        let mut set = vec![false; start.len()];
        for &face in &bad {
            for v in template.triangles[face] {
                set[v as usize] = true;
            }
        }
        (bad.len(), set)
    };
    let (first, mut set) = marked(moved);
    let mut left = first;
    for _ in 0..RELAX_ROUNDS {
        if left == 0 {
            return first;
        }
        local.grow(&mut set);
        local.relax(start, moved, &set, target, options);
        (left, set) = marked(moved);
    }
    let mut region = vec![false; start.len()];
    for round in 0..EVEN_ROUNDS {
        if left == 0 {
            break;
        }
        for (r, s) in region.iter_mut().zip(&set) {
            *r |= s;
        }
        local.grow(&mut region);
        local.even_out(moved, &region, 5 * (round + 1));
        (left, set) = marked(moved);
    }
    first
}

pub(super) fn displaced(start: &[Vec3], moved: &[Vec3A]) -> Vec<Vec3> {
    start
        .iter()
        .zip(moved)
        .map(|(s, d)| *s + Vec3::from(*d))
        .collect()
}
