//! Landmarks that nobody placed (HEADSHOP 6.1): warped along with those that are known, and put onto the scan.
//!
//! A few landmarks of a face say little about the back of a head. So the corners of a box around all landmarks, moved
//! by the best similarity, take part in the warp with much room to give: they keep it from shearing what is far from
//! every known point. What lands near the scan with the normal it should have is moved onto it; the rest stays in
//! mid-air, as the paper lets it.

use glam::Vec3;

use super::align::Similarity;
use crate::closest::{Facing, Surface};
use crate::warp::{Warp, WarpError};

/// Room of the box's corners, as a share of the box: the known points decide wherever they say anything.
const CORNER_GIVE: f32 = 0.3;

/// The box is larger than the landmarks' by this factor.
const BOX: f32 = 1.6;

/// How far an estimate is moved to reach the scan, as a share of the landmarks' extent.
const NEAR: f32 = 0.05;

/// Cosine between the normals of template and scan from which an estimate is put onto the scan.
const AGREE: f32 = 0.6;

/// A landmark of the template.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// On the template, mm.
    pub at: Vec3,
    /// The skin's outward normal there.
    pub normal: Vec3,
    /// Where it is on the scan, if somebody said so.
    pub known: Option<Vec3>,
}

/// Where a landmark is on the scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The place.
    pub at: Vec3,
    /// Whether it was estimated rather than given.
    pub estimated: bool,
    /// Whether an estimate found the scan; one that did not hangs in mid-air.
    pub on_scan: bool,
}

/// Places every landmark, given at least three that do not lie on one line: the box makes a warp even of those.
pub fn estimate(sources: &[Source], scan: &Surface) -> Result<Vec<Estimate>, WarpError> {
    let known: Vec<(Vec3, Vec3)> = sources
        .iter()
        .filter_map(|s| s.known.map(|to| (s.at, to)))
        .collect();
    if known.len() < 3 {
        return Err(WarpError::TooFew(known.len()));
    }
    let (mut from, mut to): (Vec<Vec3>, Vec<Vec3>) = known.into_iter().unzip();
    let similarity = Similarity::between(&from, &to).ok_or(WarpError::OneSpot)?;
    let (low, high) = sources
        .iter()
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), s| {
            (low.min(s.at), high.max(s.at))
        });
    let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let mut give = vec![0.0; from.len()];
    for corner in 0..8_u32 {
        let side = |axis: u32| if corner >> axis & 1 == 1 { BOX } else { -BOX };
        // Never flat, whatever the landmarks are.
        let reach = half.max(Vec3::splat(half.max_element() / 2.0));
        let at = middle + reach * Vec3::new(side(0), side(1), side(2));
        from.push(at);
        to.push(similarity.point(at));
        give.push(CORNER_GIVE * half.length());
    }
    let warp = Warp::smoothed(&from, &to, &give)?;
    let near = NEAR * half.length() * 2.0 * similarity.scale;
    Ok(sources
        .iter()
        .map(|source| match source.known {
            Some(at) => Estimate {
                at,
                estimated: false,
                on_scan: true,
            },
            None => settle(
                warp.point(source.at),
                similarity.rotation * source.normal,
                scan,
                near,
            ),
        })
        .collect())
}

fn settle(at: Vec3, normal: Vec3, scan: &Surface, near: f32) -> Estimate {
    let found = [1.0, -1.0]
        .into_iter()
        .filter_map(|sense| {
            scan.closest_facing(
                at,
                near,
                Facing {
                    direction: normal * sense,
                    cosine: AGREE,
                },
            )
        })
        .find(|hit| !scan.on_border(hit));
    match found {
        Some(hit) => Estimate {
            at: hit.point,
            estimated: true,
            on_scan: true,
        },
        None => Estimate {
            at,
            estimated: true,
            on_scan: false,
        },
    }
}
