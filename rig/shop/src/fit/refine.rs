//! The refinement of landmarks by feature meshes: HEADSHOP Table 1, rejection heuristics included.
//!
//! Each round puts a vertex into every large triangle of the target's feature mesh and moves it to the scan, along the
//! triangle's normal. What it meets must agree in normal, be near for the triangle's size, off the scan's borders, and
//! find a partner on the warped template; then the pair joins the landmarks and everything is warped anew from rest.
//! Vertices without such a place stay in the mesh, on the template, so that islands of data beyond can still be found.
//! As every landmark is met by the warp, both feature meshes have one shape when a round begins: the barycentric
//! coordinates and the displacement of a new vertex (the paper's B and D) mean the same point in either.

use glam::Vec3;

use super::feature::{FeatureMesh, Place};
use super::turned::turned;
use super::{FitError, Options, Target, Template, place};
use crate::closest::{Facing, Surface};
use crate::warp::Warp;

/// Triangles with shorter edges on average than this are fine enough, mm: the local fit does the rest.
const FINE_MM: f32 = 8.0;

/// How far a new vertex may look, as a share of its triangle's mean edge, and within which bounds, mm.
const REACH: f32 = 0.4;
const REACH_MM: (f32, f32) = (2.0, 14.0);

/// Cosine between the normals of scan and template at a pair.
const AGREE: f32 = 0.65;

/// A pair may shift by at most this share of the distance to its triangle's nearest corner: no sudden steps.
const STEEPEST: f32 = 0.6;

/// Pairs stand no closer than this on the template, mm.
const APART_MM: f32 = 1.5;

/// Converged when new pairs were this near to the warped template on average, mm.
const SETTLED_MM: f32 = 0.15;

/// With this many pairs the local fit does better than another round, and the cost of a warp grows with their cube.
const ENOUGH: usize = 300;

/// A face turned beyond this (cosine) condemns the pairs around it.
const TURNING: f32 = 0.2;

/// How often condemned pairs may be dropped and the warp solved again, in a round.
const REPAIRS: usize = 5;

/// What refinement leads to.
pub(crate) struct Refined {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) warp: Warp,
    pub(crate) found: usize,
}

/// Landmarks and the pairs found, as the warp wants them.
struct Pairs {
    from: Vec<Vec3>,
    to: Vec<Vec3>,
    give: Vec<f32>,
    /// The leading ones are the user's: never dropped, but loosened where they fold the skin.
    given: usize,
}

#[allow(
    clippy::too_many_arguments,
    reason = "one call: the stages of `fit` share these"
)]
pub(crate) fn refine(
    template: &Template,
    target: &Target,
    rest: &Surface,
    places: &[Place],
    (from, to, give): (&[Vec3], &[Vec3], &[f32]),
    mut warp: Warp,
    should: &[Vec3],
    options: &Options,
) -> Result<Refined, FitError> {
    let normal = |p: &Place| {
        let ids = template.triangles[p.triangle as usize];
        (0..3)
            .map(|k| rest.normals()[ids[k] as usize] * p.shares[k])
            .sum::<Vec3>()
            .normalize_or_zero()
    };
    let mut feature = FeatureMesh::new(from, &places.iter().map(normal).collect::<Vec<_>>());
    let mut places = places.to_vec();
    let mut pairs = Pairs {
        from: from.to_vec(),
        to: to.to_vec(),
        give: give.to_vec(),
        given: from.len(),
    };
    let mut positions = vec![Vec3::ZERO; template.positions.len()];
    warp.apply(template.positions, &mut positions);
    for _ in 0..options.rounds {
        let warped = Surface::new(&positions, template.triangles)?;
        let mut points: Vec<Vec3> = places
            .iter()
            .map(|p| p.on(&positions, template.triangles))
            .collect();
        let before = pairs.from.len();
        let inside = sample(
            template,
            target,
            &warped,
            &feature,
            &mut places,
            &mut points,
            &mut pairs,
            options,
        );
        feature.split(&inside, &points);
        if pairs.from.len() == before {
            break;
        }
        let gap = (before..pairs.from.len())
            .map(|i| warp.point(pairs.from[i]).distance(pairs.to[i]))
            .sum::<f32>()
            / (pairs.from.len() - before) as f32;
        warp = solve(template, &mut pairs, before, should, &mut positions, warp)?;
        if gap < SETTLED_MM || pairs.from.len() >= ENOUGH {
            break;
        }
    }
    Ok(Refined {
        positions,
        warp,
        found: pairs.from.len() - pairs.given,
    })
}

/// One round's new vertices: subdivide, project, reject, transfer. Returns each triangle's vertex.
#[allow(
    clippy::too_many_arguments,
    reason = "what a round reads and what it extends"
)]
fn sample(
    template: &Template,
    target: &Target,
    warped: &Surface,
    feature: &FeatureMesh,
    places: &mut Vec<Place>,
    points: &mut Vec<Vec3>,
    pairs: &mut Pairs,
    options: &Options,
) -> Vec<Option<u32>> {
    let normals = feature.normals(points);
    let mut inside = vec![None; feature.triangles.len()];
    for (t, ids) in feature.triangles.iter().enumerate() {
        let corners = ids.map(|v| points[v as usize]);
        let [a, b, c] = corners;
        let edge = (a.distance(b) + b.distance(c) + c.distance(a)) / 3.0;
        if edge < FINE_MM {
            continue;
        }
        let centre = (a + b + c) / 3.0;
        let reach = (REACH * edge).clamp(REACH_MM.0, REACH_MM.1);
        let pair = on_scan(target, centre, normals[t], reach).and_then(|(on_scan, normal)| {
            partner(template, warped, on_scan, normal, corners).map(|p| (p, on_scan))
        });
        let at = match pair {
            Some((at, on_scan)) => {
                let from = at.on(template.positions, template.triangles);
                if pairs
                    .from
                    .iter()
                    .all(|p| p.distance_squared(from) > APART_MM * APART_MM)
                {
                    pairs.from.push(from);
                    pairs.to.push(on_scan);
                    pairs.give.push(options.give_mm.1);
                }
                at
            }
            None => match place(warped, centre) {
                Some(at) => at,
                None => continue,
            },
        };
        inside[t] = Some(points.len() as u32);
        points.push(at.on(warped.positions(), template.triangles));
        places.push(at);
    }
    inside
}

/// Where the scan lies for a new vertex: the nearer of what is in front and behind, else the nearest around.
fn on_scan(target: &Target, centre: Vec3, normal: Vec3, reach: f32) -> Option<(Vec3, Vec3)> {
    let facing = Facing {
        direction: normal,
        cosine: 0.4,
    };
    [normal, -normal]
        .into_iter()
        .filter_map(|way| target.ray(centre, way, reach, facing))
        .chain(target.closest(centre, reach * 0.6, facing))
        .min_by(|a, b| a.0.distance.total_cmp(&b.0.distance))
        .map(|(hit, normal)| (hit.point, normal))
}

/// The template's place for a point of the scan, if it is beyond doubt.
fn partner(
    template: &Template,
    warped: &Surface,
    on_scan: Vec3,
    normal: Vec3,
    corners: [Vec3; 3],
) -> Option<Place> {
    let hit = warped.closest_facing(
        on_scan,
        REACH_MM.1,
        Facing {
            direction: normal,
            cosine: AGREE,
        },
    )?;
    let ids = template.triangles[hit.triangle as usize];
    let free = ids.iter().all(|&v| template.freedom[v as usize] >= 0.5);
    let corner = corners
        .iter()
        .map(|c| c.distance(hit.point))
        .fold(f32::INFINITY, f32::min);
    let gentle = hit.distance <= STEEPEST * corner;
    let straight =
        hit.distance < 1.0 || (on_scan - hit.point).dot(normal).abs() > 0.6 * hit.distance;
    (free
        && gentle
        && straight
        && !warped.on_border(&hit)
        && warped.normal(&hit).dot(normal) > AGREE)
        .then_some(Place {
            triangle: hit.triangle,
            shares: hit.barycentric,
        })
}

/// Warps from rest with all pairs; new pairs (from `first` on) beside faces that turn over are dropped again. If that
/// does not help, all of the round's pairs go and the warp stays as it was.
fn solve(
    template: &Template,
    pairs: &mut Pairs,
    first: usize,
    should: &[Vec3],
    positions: &mut [Vec3],
    before: Warp,
) -> Result<Warp, FitError> {
    for _ in 0..REPAIRS {
        let warp = Warp::smoothed(&pairs.from, &pairs.to, &pairs.give)?;
        let mut next = vec![Vec3::ZERO; positions.len()];
        warp.apply(template.positions, &mut next);
        let bad = turned(&next, template.triangles, should, TURNING);
        if bad.is_empty() {
            positions.copy_from_slice(&next);
            return Ok(warp);
        }
        drop_near(template, pairs, first, &bad);
    }
    for list in [&mut pairs.from, &mut pairs.to] {
        list.truncate(first);
    }
    pairs.give.truncate(first);
    Ok(before)
}

/// For each bad face, the nearest of the landmarks and of this round's pairs: a pair is dropped, a landmark loosened.
fn drop_near(template: &Template, pairs: &mut Pairs, first: usize, bad: &[usize]) {
    /// What stands beside a bad face is one of this many.
    const SUSPECTS: usize = 4;
    /// How much more a suspected landmark gives way.
    const LOOSER: f32 = 6.0;
    let mut suspected = vec![false; pairs.from.len()];
    for &face in bad {
        let centre = template.triangles[face]
            .iter()
            .map(|&v| template.positions[v as usize])
            .sum::<Vec3>()
            / 3.0;
        let mut order: Vec<usize> = (0..pairs.given).chain(first..pairs.from.len()).collect();
        order.sort_by_key(|&i| pairs.from[i].distance_squared(centre).to_bits());
        for &i in order.iter().take(SUSPECTS) {
            suspected[i] = true;
        }
    }
    for (give, _) in pairs.give[..pairs.given]
        .iter_mut()
        .zip(&suspected)
        .filter(|(_, s)| **s)
    {
        *give *= LOOSER;
    }
    let kept: Vec<usize> = (0..pairs.from.len())
        .filter(|&i| i < pairs.given || !suspected[i])
        .collect();
    (pairs.from, pairs.to) = (
        kept.iter().map(|&i| pairs.from[i]).collect(),
        kept.iter().map(|&i| pairs.to[i]).collect(),
    );
    pairs.give = kept.iter().map(|&i| pairs.give[i]).collect();
}
